#include "raybound/numbers/interval_arrays.h"

#include <algorithm>
#include <stdexcept>

#include "raybound/numbers/interval_pack.h"

namespace raybound {

namespace {

constexpr int width = IntervalPack<double>::width;

// The last few elements: a pack that repeats the last of them.
template <class T>
IntervalPack<T> load_some(IntervalArray<const T> x, std::size_t n) {
    T inf[width], sup[width];
    for (std::size_t i = 0; i < width; ++i) {
        inf[i] = x.inf[std::min(i, n - 1)];
        sup[i] = x.sup[std::min(i, n - 1)];
    }
    return IntervalPack<T>::load(inf, sup);
}
template <class T>
void store_some(const IntervalPack<T>& x, IntervalArray<T> result, std::size_t n) {
    T inf[width], sup[width];
    x.store(inf, sup);
    std::copy_n(inf, n, result.inf);
    std::copy_n(sup, n, result.sup);
}

template <class T, class Function, class... Arrays>
void map(Function f, IntervalArray<T> result, std::size_t n, Arrays... operands) {
    const auto at = [](auto x, std::size_t i) { return decltype(x){x.inf + i, x.sup + i}; };
    std::size_t i = 0;
    for (; i + width <= n; i += width)
        f(IntervalPack<T>::load(operands.inf + i, operands.sup + i)...).store(result.inf + i, result.sup + i);
    if (i < n) store_some(f(load_some<T>(at(operands, i), n - i)...), at(result, i), n - i);
}

}  // namespace

template <class T>
void interval_array_operation(const std::string& name, IntervalArray<const T> a, IntervalArray<const T> b,
                              IntervalArray<const T> c, IntervalArray<T> result, std::size_t n) {
    using P = IntervalPack<T>;
    if (name == "add") return map([](const P& x, const P& y) { return x + y; }, result, n, a, b);
    if (name == "subtract") return map([](const P& x, const P& y) { return x - y; }, result, n, a, b);
    if (name == "multiply") return map([](const P& x, const P& y) { return x * y; }, result, n, a, b);
    if (name == "divide") return map([](const P& x, const P& y) { return x / y; }, result, n, a, b);
    if (name == "sqrt") return map([](const P& x) { return sqrt(x); }, result, n, a);
    if (name == "square") return map([](const P& x) { return square(x); }, result, n, a);
    if (name == "fma") return map([](const P& x, const P& y, const P& z) { return fma(x, y, z); }, result, n, a, b, c);
    if (name == "multiply_add")
        return map([](const P& x, const P& y, const P& z) { return x * y + z; }, result, n, a, b, c);
    throw std::invalid_argument("interval_array_operation: unknown operation '" + name + "'");
}

template void interval_array_operation(const std::string&, IntervalArray<const float>, IntervalArray<const float>,
                                       IntervalArray<const float>, IntervalArray<float>, std::size_t);
template void interval_array_operation(const std::string&, IntervalArray<const double>, IntervalArray<const double>,
                                       IntervalArray<const double>, IntervalArray<double>, std::size_t);

}  // namespace raybound
