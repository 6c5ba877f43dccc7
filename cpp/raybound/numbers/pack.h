// Four numbers side by side: the compiler's vector types, for slab tests. Lane by lane the same bits as scalars.
#pragma once

#include "raybound/numbers/number.h"

namespace raybound {

template <class T>
struct PackOf;
template <>
struct PackOf<float> {
    typedef float type __attribute__((vector_size(16)));
};
template <>
struct PackOf<double> {
    typedef double type __attribute__((vector_size(32)));
};

template <class T>
using Pack4 = typename PackOf<T>::type;

template <class V>
concept Pack = std::is_same_v<V, Pack4<float>> || std::is_same_v<V, Pack4<double>>;

template <Pack V>
inline V minimum(V a, V b) {
    return b < a ? b : a;
}
template <Pack V>
inline V maximum(V a, V b) {
    return b > a ? b : a;
}

}  // namespace raybound
