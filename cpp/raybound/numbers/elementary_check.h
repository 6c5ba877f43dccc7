// The accuracy of the elementary functions, measured over ranges of bit patterns: what the tests assert.
#pragma once

#include <cstdint>
#include <string>

namespace raybound {

struct ElementaryError {
    double ulp = 0;            // the largest error seen, in units in the last place of the true value
    std::uint32_t bits = 0;    // where
    std::uint64_t tested = 0;  // arguments in the function's domain
};

// Runs "exp", "acos" or "sqrt" over the floats with the bit patterns first, first + stride, ... (count of them) and
// compares with the C library's double, whose own error is 2^-29 float ulp. Special values must match exactly: a wrong
// one counts as an infinite error. Throws std::invalid_argument for other names.
ElementaryError check_elementary(const std::string& name, std::uint32_t first, std::uint64_t count,
                                 std::uint32_t stride);

}  // namespace raybound
