// Arrays of numbers as rows of doubles.
#pragma once

#include <array>

#include "bindings/arrays.h"

namespace raybound::python {

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
