#include "raybound/numbers/number_bench.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
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

// Arrays whose starts are spread over the 4096 bytes by which the processor first compares addresses: a load that
// follows a store of the same ones would wait for it, by chance of the heap. The first is for results.
template <class T, int count>
class SpreadArrays {
  public:
    explicit SpreadArrays(std::size_t n)
        : stride_((n * sizeof(T) + page - 1) / page * page + page / count), memory_(stride_ * count + page) {
        void* start = memory_.data();
        std::size_t space = memory_.size();
        first_ = static_cast<std::byte*>(std::align(page, stride_ * count, start, space));
        for (int k = 0; k < count; ++k) std::uninitialized_value_construct_n((*this)[k], n);
    }
    T* operator[](int k) { return reinterpret_cast<T*>(first_ + stride_ * static_cast<std::size_t>(k)); }

  private:
    static constexpr std::size_t page = 4096;
    std::size_t stride_;
    std::vector<std::byte> memory_;
    std::byte* first_ = nullptr;
};

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
    SpreadArrays<Number, 4> arrays(n);
    Operands operands;
    for (int k = 1; k < 4; ++k)
        for (std::size_t i = 0; i < n; ++i) arrays[k][i] = make(operands.next());
    return best_nanoseconds(
        [n, r = arrays[0], a = arrays[1], b = arrays[2], c = arrays[3]] {
            for (std::size_t i = 0; i < n; ++i) {
                r[i] = a[i] * b[i] + c[i];
                keep(r[i]);
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
    SpreadArrays<double, 8> ends(n);
    Operands operands;
    for (int k = 2; k < 8; k += 2)
        for (std::size_t i = 0; i < n; ++i) {
            const double x = operands.next();
            ends[k][i] = x - radius, ends[k + 1][i] = x + radius;
        }
    const auto in = [&](int k) { return IntervalArray<const double>{ends[k], ends[k + 1]}; };
    return best_nanoseconds(
        [&] {
            interval_array_operation<double>("multiply_add", in(2), in(4), in(6), {ends[0], ends[1]}, n);
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
