// Operations on arrays of intervals, element by element.
#pragma once

#include <cstddef>
#include <string>

namespace raybound {

// n intervals as two arrays of their ends.
template <class T>
struct IntervalArray {
    T* inf;
    T* sup;
};

// result[i] = operation of a[i], b[i], c[i], with the same bits as Interval<T>: "add", "subtract", "multiply",
// "divide", "fma", "multiply_add" (a b + c, rounded twice), and of a alone "sqrt" and "square" (operands that an
// operation does not take may be null). The result may be one of the operands, but not overlap them otherwise. Throws
// std::invalid_argument for other names.
template <class T>
void interval_array_operation(const std::string& name, IntervalArray<const T> a, IntervalArray<const T> b,
                              IntervalArray<const T> c, IntervalArray<T> result, std::size_t n);

}  // namespace raybound
