// The operations that all number types share, by name, over arrays of any type's representation.
#pragma once

#include <array>

#include "bindings/arrays.h"

namespace raybound::python {

// The operation `name` of up to three operands; `parameter` is power's exponent and ward_lobe's sigma.
template <class T>
T operate(const std::string& name, const std::array<T, 3>& x, double parameter) {
    const auto& [a, b, c] = x;
    if (name == "negate") return -a;
    if (name == "sqrt") return sqrt(a);
    if (name == "rsqrt") return rsqrt(a);
    if (name == "square") return square(a);
    if (name == "reciprocal") return reciprocal(a);
    if (name == "exp") return exp(a);
    if (name == "log") return log(a);
    if (name == "sin") return sin(a);
    if (name == "cos") return cos(a);
    if (name == "tan") return tan(a);
    if (name == "asin") return asin(a);
    if (name == "acos") return acos(a);
    if (name == "atan") return atan(a);
    if (name == "abs") return abs(a);
    if (name == "power") return power(a, static_cast<int>(parameter));
    if (name == "ward_lobe") return ward_lobe(a, parameter);
    if (name == "add") return a + b;
    if (name == "subtract") return a - b;
    if (name == "multiply") return a * b;
    if (name == "divide") return a / b;
    if (name == "minimum") return minimum(a, b);
    if (name == "maximum") return maximum(a, b);
    if (name == "fma") return fma(a, b, c);
    throw std::invalid_argument("operate: name must be that of an operation, got '" + name + "'");
}

// Rows of `size` doubles, each a number as `Load` reads it; one to three arrays alike.
struct Operands {
    Operands(const std::vector<Doubles>& arrays, py::ssize_t size) : arrays_(arrays) {
        if (arrays.empty() || arrays.size() > 3) throw std::invalid_argument("operands: must be one, two or three");
        for (const Doubles& a : arrays)
            if (a.ndim() != 2 || a.shape(1) != size || a.shape(0) != arrays[0].shape(0))
                throw std::invalid_argument("operands: must all have shape (n, " + std::to_string(size) + ")");
    }
    py::ssize_t count() const { return arrays_[0].shape(0); }
    // Operand k of row i; the last one again where there are fewer.
    const double* at(py::ssize_t i, std::size_t k) const {
        const Doubles& a = arrays_[std::min(k, arrays_.size() - 1)];
        return a.data() + i * a.shape(1);
    }

  private:
    const std::vector<Doubles>& arrays_;
};

}  // namespace raybound::python
