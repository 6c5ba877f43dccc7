#include "raybound/numbers/number_bench.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "raybound/numbers/interval.h"
#include "raybound/numbers/interval_arrays.h"

namespace raybound {

namespace {

// Uniform in (-1, 1), always the same ones (a linear congruential generator: Knuth's MMIX).
class Operands {
  public:
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(static_cast<std::int64_t>(state_)) * 0x1p-63;
    }

  private:
    std::uint64_t state_ = 1;
};

// The compiler must suppose that everything in memory is read and written here.
template <class T>
void keep(T& x) {
    asm volatile("" : : "r"(&x) : "memory");
}

template <class Pass>
double best_nanoseconds(Pass pass, std::size_t n, int repeats) {
    double best = std::numeric_limits<double>::infinity();
    const std::size_t passes = 1 + 20'000 / n;  // so many in a row that the clock's own steps do not count
    for (int i = 0; i < repeats; ++i) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t k = 0; k < passes; ++k) pass();
        const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
        best = std::min(best, spent.count() / static_cast<double>(passes * n));
    }
    return best;
}

template <class Number, class Make>
double time_one_by_one(std::size_t n, int repeats, Make make) {
    std::vector<Number> a(n), b(n), c(n), r(n);
    Operands operands;
    for (auto* v : {&a, &b, &c})
        for (Number& x : *v) x = make(operands.next());
    return best_nanoseconds(
        [n, x = a.data(), y = b.data(), z = c.data(), out = r.data()] {
            for (std::size_t i = 0; i < n; ++i) {
                out[i] = x[i] * y[i] + z[i];
                keep(out[i]);
            }
        },
        n, repeats);
}

constexpr double radius = 0.5e-3;

template <class Rounding>
double time_intervals(std::size_t n, int repeats) {
    using I = Interval<double, Arithmetic::real, Rounding>;
    return time_one_by_one<I>(n, repeats, [](double x) { return I(x - radius, x + radius); });
}

double time_array(std::size_t n, int repeats) {
    std::vector<double> ends[8];
    for (auto& v : ends) v.resize(n);
    Operands operands;
    for (int operand = 0; operand < 3; ++operand)
        for (std::size_t i = 0; i < n; ++i) {
            const double x = operands.next();
            ends[2 * operand][i] = x - radius, ends[2 * operand + 1][i] = x + radius;
        }
    const auto in = [&](int i) { return IntervalArray<const double>{ends[2 * i].data(), ends[2 * i + 1].data()}; };
    return best_nanoseconds(
        [&] {
            interval_array_operation<double>("multiply_add", in(0), in(1), in(2), {ends[6].data(), ends[7].data()}, n);
            keep(ends);
        },
        n, repeats);
}

}  // namespace

double time_multiply_add(const std::string& kind, std::size_t n, int repeats) {
    if (n == 0) throw std::invalid_argument("time_multiply_add: n must be > 0, got 0");
    if (kind == "double") return time_one_by_one<double>(n, repeats, [](double x) { return x; });
    if (kind == "interval portable") return time_intervals<PortableRounding>(n, repeats);
#ifdef __AVX512F__
    if (kind == "interval hardware") return time_intervals<HardwareRounding>(n, repeats);
#endif
    if (kind == "interval best") return time_intervals<DirectedRounding>(n, repeats);
    if (kind == "interval array") return time_array(n, repeats);
    throw std::invalid_argument(
        "time_multiply_add: kind must be 'double', 'interval portable', 'interval hardware' "
        "(with AVX-512), 'interval best' or 'interval array', got '" +
        kind + "'");
}

}  // namespace raybound
