// Exact sums of products of floating-point numbers as long integers: the judge of number_trials.h.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace raybound::trials {

// A fixed-point number of 4608 bits in two's complement, of which the lowest counts 2^-2304: any product of two doubles
// fits, subnormals included.
class ExactNumber {
  public:
    // + sign a b. Both finite.
    ExactNumber& add_product(double a, double b, int sign = 1) {
        if (a == 0 || b == 0) return *this;
        int a_exponent = 0, b_exponent = 0;
        const auto x = static_cast<std::int64_t>(std::ldexp(std::frexp(a, &a_exponent), 53));
        const auto y = static_cast<std::int64_t>(std::ldexp(std::frexp(b, &b_exponent), 53));
        add(static_cast<Integer>(x) * y * sign, a_exponent + b_exponent - 106 + origin);
        return *this;
    }
    ExactNumber& add(double a, int sign = 1) { return add_product(a, 1, sign); }

    int sign() const {
        if (words_[count - 1] >> 63) return -1;
        for (const std::uint64_t w : words_)
            if (w != 0) return 1;
        return 0;
    }

  private:
    __extension__ typedef __int128 Integer;
    static constexpr int origin = 2304, count = 72;

    // Adds value 2^shift, shift >= 0: the 128 bits and their sign in place.
    void add(Integer value, int shift) {
        const std::size_t first = static_cast<std::size_t>(shift) / 64;
        const int bits = shift % 64;
        const auto low = static_cast<std::uint64_t>(value), high = static_cast<std::uint64_t>(value >> 64);
        const std::uint64_t filler = value < 0 ? ~std::uint64_t(0) : 0;
        std::uint64_t carry = 0;
        for (std::size_t i = first; i < count; ++i) {
            const std::uint64_t upper = i == first ? low : i == first + 1 ? high : filler;
            const std::uint64_t lower = i == first ? 0 : i == first + 1 ? low : i == first + 2 ? high : filler;
            const std::uint64_t part = bits == 0 ? upper : (upper << bits) | (lower >> (64 - bits));
            const std::uint64_t sum = words_[i] + part, total = sum + carry;
            carry = (sum < part) | (total < sum);
            words_[i] = total;
        }
    }

    std::array<std::uint64_t, count> words_{};
};

}  // namespace raybound::trials
