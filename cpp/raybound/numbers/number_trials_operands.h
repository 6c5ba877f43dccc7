// Operands for number_trials.h: ordinary ones, and those that directed rounding is likely to get wrong.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace raybound::trials {

// splitmix64 (Steele, Lea and Flood 2014).
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    }
    template <class T>
    T with_sign(T x) {
        return bits() & 1 ? -x : x;
    }

  private:
    std::uint64_t state_;
};

template <class T>
T stepped(T x, int steps) {
    const T target = steps > 0 ? std::numeric_limits<T>::infinity() : -std::numeric_limits<T>::infinity();
    for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, target);
    return x;
}

template <class T>
T of_bits(std::uint64_t bits) {
    if constexpr (sizeof(T) == 4)
        return std::bit_cast<float>(static_cast<std::uint32_t>(bits >> 32));
    else
        return std::bit_cast<double>(bits);
}

template <class T>
T operand(Random& random) {
    using Limits = std::numeric_limits<T>;
    switch (random.below(12)) {
        case 0:
            return of_bits<T>(random.bits());
        case 1:
            return random.with_sign(T(random.uniform(0, 1)) * Limits::min());  // subnormal
        case 2:
            return random.with_sign(stepped(Limits::min(), random.below(7) - 3));  // where they begin
        case 3:
            return random.with_sign(stepped(Limits::max(), -random.below(4)));  // the largest
        case 4:
            return random.with_sign(Limits::max() * T(random.uniform(0.1, 1)));
        case 5:  // around powers of two
            return random.with_sign(stepped(
                std::ldexp(T(1), random.below(2 * Limits::max_exponent) - Limits::max_exponent), random.below(5) - 2));
        case 6:
            return T(random.below(65) - 32);
        case 7: {
            const T values[] = {T(0), Limits::infinity(), Limits::quiet_NaN(), Limits::denorm_min(), Limits::min()};
            return random.with_sign(values[random.below(5)]);
        }
        default:
            return random.with_sign(T(std::pow(10.0, random.uniform(-6, 6))));
    }
}

// A tuple of them, sometimes close to each other's negatives.
template <class T>
struct Tuple {
    T a, b, c;

    static Tuple random(Random& random) {
        Tuple t{operand<T>(random), operand<T>(random), operand<T>(random)};
        if (random.below(8) == 0) t.b = random.with_sign(stepped(t.a, random.below(9) - 4));
        if (random.below(8) == 0) t.b = random.with_sign(t.a * T(random.uniform(0.4, 2.1)));
        if (random.below(4) == 0) t.c = stepped(-(t.a * t.b), random.below(9) - 4);
        if (random.below(8) == 0) t.c = -(t.a * t.b) * T(random.uniform(0.4, 2.1));
        return t;
    }
};

}  // namespace raybound::trials
