#include "raybound/numbers/rounding_power.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace raybound {

namespace {

// A number of [1, 1 + error 2^(1-N)] mantissa 2^exponent. The mantissa has N = 64 limbs bits, of which the highest is
// set; the lowest limb comes first.
template <int limbs>
struct Enclosed {
    std::array<std::uint64_t, limbs> mantissa{};
    std::int64_t exponent = 0;
    std::uint64_t error = 0;  // 0: exact
};

__extension__ typedef unsigned __int128 Wide128;

// Relative errors add, in units of 2^(1-N). Truncation is one more, and their products together less than one more, as
// long as errors stay below 2^60: x^n has at most 4 n < 2^33.
template <int limbs>
Enclosed<limbs> multiply(const Enclosed<limbs>& a, const Enclosed<limbs>& b) {
    std::array<std::uint64_t, 2 * limbs> product{};
    for (int i = 0; i < limbs; ++i) {
        std::uint64_t carry = 0;
        for (int j = 0; j < limbs; ++j) {
            const Wide128 sum = Wide128(a.mantissa[i]) * b.mantissa[j] + product[i + j] + carry;
            product[i + j] = static_cast<std::uint64_t>(sum);
            carry = static_cast<std::uint64_t>(sum >> 64);
        }
        product[i + limbs] = carry;
    }
    Enclosed<limbs> result;
    const int shift = product[2 * limbs - 1] >> 63 ? 0 : 1;
    bool exact = (product[limbs - 1] << shift) == 0;
    for (int i = 0; i < limbs - 1; ++i) exact = exact && product[i] == 0;
    for (int i = 0; i < limbs; ++i)
        result.mantissa[i] = (product[limbs + i] << shift) | (shift ? product[limbs + i - 1] >> 63 : 0);
    result.exponent = a.exponent + b.exponent + 64 * limbs - shift;
    const std::uint64_t inherited = a.error + b.error;
    result.error = inherited + (exact ? 0 : 1) + (inherited ? 1 : 0);
    return result;
}

// x, or 1 / x by long division.
template <int limbs>
Enclosed<limbs> start(double x, bool inverse) {
    int exponent = 0;
    const auto scaled = static_cast<std::uint64_t>(std::ldexp(std::frexp(x, &exponent), 53)) << 11;  // highest bit set
    exponent -= 64;
    Enclosed<limbs> result;
    if (!inverse || std::has_single_bit(scaled)) {
        result.mantissa[limbs - 1] = scaled;
        result.exponent = inverse ? -(exponent + 63) - 63 - 64 * (limbs - 1) : exponent - 64 * (limbs - 1);
        return result;
    }
    // 2^(64 limbs + 63) / scaled lies between 2^(64 limbs - 1) and 2^(64 limbs).
    Wide128 remainder = std::uint64_t(1) << 63;
    for (int i = limbs - 1; i >= 0; --i) {
        remainder <<= 64;
        result.mantissa[i] = static_cast<std::uint64_t>(remainder / scaled);
        remainder %= scaled;
    }
    result.exponent = -std::int64_t(exponent) - 64 * limbs - 63;
    result.error = 1;
    return result;
}

template <int limbs>
Enclosed<limbs> power(double x, int n) {
    const Enclosed<limbs> base = start<limbs>(x, n < 0);
    const auto count = static_cast<std::uint32_t>(n < 0 ? -std::int64_t(n) : n);
    Enclosed<limbs> result = base;
    for (int bit = 30 - std::countl_zero(count); bit >= 0; --bit) {
        result = multiply(result, result);
        if (count >> bit & 1) result = multiply(result, base);
    }
    return result;
}

// The upper end: mantissa (1 + error 2^(1-N)) <= mantissa + 2 error.
template <int limbs>
Enclosed<limbs> upper_end(Enclosed<limbs> x) {
    std::uint64_t carry = 2 * x.error;
    for (auto& limb : x.mantissa) {
        limb += carry;
        carry = limb < carry;
    }
    if (carry) {  // just above the next power of two: the other limbs are 0
        x.mantissa[0] = x.mantissa[0] / 2 + 1;
        x.mantissa.back() |= std::uint64_t(1) << 63;
        ++x.exponent;
    }
    return x;
}

// mantissa 2^exponent rounded to T.
template <class T, int limbs>
T rounded(const Enclosed<limbs>& x, bool up) {
    using Limits = std::numeric_limits<T>;
    const std::int64_t top = x.exponent + 64 * limbs;  // the number lies in [2^(top-1), 2^top)
    if (top > Limits::max_exponent) return up ? Limits::infinity() : Limits::max();
    const auto bits = std::min<std::int64_t>(Limits::digits, top - Limits::min_exponent + Limits::digits);
    if (bits < 0) return up ? Limits::denorm_min() : T(0);
    const std::uint64_t head = x.mantissa[limbs - 1];
    const std::uint64_t kept = bits == 0 ? 0 : head >> (64 - bits);
    bool exact = bits != 0 && (head << bits) == 0;
    for (int i = 0; i < limbs - 1; ++i) exact = exact && x.mantissa[i] == 0;
    return static_cast<T>(std::ldexp(T(kept + (up && !exact)), int(top - bits)));
}

template <class T>
T directed_power(T x, int n, bool up) {
    if (n == 0 || x == 1) return 1;
    const auto ends = [&]<int limbs>(const Enclosed<limbs>& p) {
        return std::array{rounded<T>(p, up), rounded<T>(upper_end(p), up)};
    };
    const auto quick = ends(power<2>(double(x), n));
    if (quick[0] == quick[1]) return quick[0];
    const auto slow = ends(power<6>(double(x), n));
    return up ? slow[1] : slow[0];
}

}  // namespace

template <std::floating_point T>
T power_down(T x, int n) {
    return directed_power(x, n, false);
}
template <std::floating_point T>
T power_up(T x, int n) {
    return directed_power(x, n, true);
}

template float power_down(float, int);
template float power_up(float, int);
template double power_down(double, int);
template double power_up(double, int);

}  // namespace raybound
