#include "raybound/numbers/number_trials.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "raybound/numbers/number_trials_judge.h"
#include "raybound/numbers/number_trials_operands.h"
#include "raybound/numbers/rounding.h"

namespace raybound {

namespace trials {

namespace {

template <class Rounding, class V>
V directed(Operation operation, bool up, V a, V b, V c) {
    switch (operation) {
        case Operation::add:
            return up ? Rounding::add_up(a, b) : Rounding::add_down(a, b);
        case Operation::subtract:
            return up ? Rounding::subtract_up(a, b) : Rounding::subtract_down(a, b);
        case Operation::multiply:
            return up ? Rounding::multiply_up(a, b) : Rounding::multiply_down(a, b);
        case Operation::divide:
            return up ? Rounding::divide_up(a, b) : Rounding::divide_down(a, b);
        case Operation::sqrt:
            return up ? Rounding::sqrt_up(a) : Rounding::sqrt_down(a);
        case Operation::fma:
            return up ? Rounding::fma_up(a, b, c) : Rounding::fma_down(a, b, c);
        case Operation::square:
            break;
    }
    return up ? Rounding::multiply_up(a, a) : Rounding::multiply_down(a, a);
}

template <class T>
bool same_bits(T a, T b) {
    return (a != a && b != b) || std::memcmp(&a, &b, sizeof(T)) == 0;
}

template <class T>
void count_trial(TrialCounts& counts, Operation operation, bool up, const Tuple<T>& t, T result) {
    ++counts.trials;
    Judgement j;
    if (is_special(operation, t.a, t.b, t.c)) {
        ++counts.special;
        const T nearest = apply(operation, t.a, t.b, t.c);
        j = same_bits(nearest, result) ? Judgement::tight : Judgement::wrong;
    } else {
        j = judge(operation, up, t.a, t.b, t.c, result);
        const T nearest = apply(operation, t.a, t.b, t.c), size = std::abs(nearest);
        const bool exact = sign_of_excess(operation, t.a, t.b, t.c, nearest) == 0;
        ++(exact ? counts.exact : counts.inexact);
        counts.underflows += !exact && size < std::numeric_limits<T>::min();
        counts.overflows += size > std::numeric_limits<T>::max();
        const bool adds =
            operation == Operation::add || operation == Operation::subtract || operation == Operation::fma;
        const T largest = std::max(std::abs(operation == Operation::fma ? t.c : t.a), T(0));
        counts.cancellations += adds && size < T(0x1p-20) * largest;
    }
    counts.violations += j == Judgement::wrong;
    counts.not_tight += j == Judgement::not_tight;
    if (j != Judgement::tight && counts.first_failure.empty()) {
        char text[200];
        std::snprintf(text, sizeof text, "%s of %a, %a, %a: %a", up ? "up" : "down", double(t.a), double(t.b),
                      double(t.c), double(result));
        counts.first_failure = text;
    }
}

template <class Rounding, int n, class T>
void count_lanes(TrialCounts& counts, Operation operation, bool up, const std::array<Tuple<T>, 8>& tuples,
                 const std::array<T, 8>& results) {
    for (int first = 0; first < 8; first += n) {
        Lanes<T, n> a, b, c;
        for (int i = 0; i < n; ++i) a[i] = tuples[first + i].a, b[i] = tuples[first + i].b, c[i] = tuples[first + i].c;
        const Lanes<T, n> together = directed<Rounding>(operation, up, a, b, c);
        for (int i = 0; i < n; ++i) counts.differences += !same_bits(T(together[i]), results[first + i]);
    }
}

template <class Rounding, class T>
TrialCounts run(Operation operation, std::uint64_t seed, std::uint64_t count) {
    TrialCounts counts;
    Random random(seed);
    for (std::uint64_t i = 0; i < count; i += 8) {
        std::array<Tuple<T>, 8> tuples;
        for (auto& t : tuples) t = Tuple<T>::random(random);
        for (const bool up : {false, true}) {
            std::array<T, 8> results;
            for (int k = 0; k < 8; ++k) {
                results[k] = directed<Rounding>(operation, up, tuples[k].a, tuples[k].b, tuples[k].c);
                count_trial(counts, operation, up, tuples[k], results[k]);
            }
            count_lanes<Rounding, 2>(counts, operation, up, tuples, results);
            count_lanes<Rounding, native_lanes>(counts, operation, up, tuples, results);
        }
    }
    return counts;
}

}  // namespace

}  // namespace trials

TrialCounts rounding_trials(const std::string& operation, bool wide, const std::string& implementation,
                            std::uint64_t seed, std::uint64_t count) {
    using namespace trials;
    const Operation op = operation_named(operation);
    return with_rounding("rounding_trials", implementation, [&]<class Rounding>(Rounding) {
        return wide ? run<Rounding, double>(op, seed, count) : run<Rounding, float>(op, seed, count);
    });
}

}  // namespace raybound
