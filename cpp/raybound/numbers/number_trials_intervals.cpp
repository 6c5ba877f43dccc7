#include <algorithm>
#include <array>
#include <cstdio>

#include "raybound/numbers/interval_pack.h"
#include "raybound/numbers/number_trials.h"
#include "raybound/numbers/number_trials_judge.h"
#include "raybound/numbers/number_trials_operands.h"

namespace raybound {

namespace trials {

namespace {

// Ends in order, both finite.
template <class T>
struct Ends {
    T inf, sup;
};

// Points, a few ulps wide, up to 10 % wide, and anything: mostly around zero.
template <class T>
Ends<T> interval_operand(Random& random, bool positive) {
    constexpr T largest = std::numeric_limits<T>::max();
    const auto finite = [&] {
        const T x = operand<T>(random);
        return std::isfinite(x) ? x : T(1);
    };
    const T x = finite();
    T y = x;
    switch (random.below(4)) {
        case 0:
            break;
        case 1:
            y = stepped(x, random.below(7) - 3);
            break;
        case 2:
            y = x * T(random.uniform(0.9, 1.1));
            break;
        default:
            y = random.below(2) ? finite() : -x * T(random.uniform(0, 2));
    }
    y = std::clamp(y, -largest, largest);
    if (!positive) return {std::min(x, y), std::max(x, y)};
    const T p = std::abs(x), q = std::abs(y);
    return {std::min(p, q), std::max(p, q)};
}

// Quotients need divisors without 0, roots arguments that are not negative.
template <class T>
std::array<Ends<T>, 3> operands(Operation operation, Random& random) {
    std::array<Ends<T>, 3> e{interval_operand<T>(random, operation == Operation::sqrt),
                             interval_operand<T>(random, operation == Operation::divide),
                             interval_operand<T>(random, false)};
    if (operation == Operation::divide) {
        if (e[1].inf == 0) e[1] = {T(1), std::max(T(1), e[1].sup)};
        if (random.below(2)) e[1] = {-e[1].sup, -e[1].inf};
    }
    return e;
}

// The range is that of the corners, and of 0 for squares: no corner may lie outside, and one must lie within an ulp.
template <class T>
Judgement judge_end(Operation operation, bool up, const std::array<Ends<T>, 3>& e, T end) {
    if (end != end) return Judgement::wrong;
    const T inward = std::nextafter(end, up ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::infinity());
    bool tight = false;
    const auto test = [&](T a, T b, T c) {
        const int excess = sign_of_excess(operation, a, b, c, end);
        const int inner = sign_of_excess(operation, a, b, c, inward);
        tight = tight || excess == 0 || (inner != 0 && (inner > 0) == up);
        return excess == 0 || (excess > 0) != up;
    };
    bool inside = true;
    for (const T a : {e[0].inf, e[0].sup})
        for (const T b : {e[1].inf, e[1].sup})
            for (const T c : {e[2].inf, e[2].sup}) inside = test(a, b, c) && inside;
    const bool has_zero = e[0].inf <= 0 && e[0].sup >= 0;
    if (operation == Operation::square && has_zero) inside = test(0, 0, 0) && inside;
    return !inside ? Judgement::wrong : tight ? Judgement::tight : Judgement::not_tight;
}

template <class T>
void count_result(TrialCounts& counts, Operation operation, const std::array<Ends<T>, 3>& e, T inf, T sup) {
    ++counts.trials;
    counts.straddling += e[0].inf < 0 && e[0].sup > 0;
    counts.points += e[0].inf == e[0].sup;
    counts.overflows += std::isinf(inf) || std::isinf(sup);
    counts.underflows += std::max(std::abs(inf), std::abs(sup)) < std::numeric_limits<T>::min();
    for (const bool up : {false, true}) {
        const Judgement j = judge_end(operation, up, e, up ? sup : inf);
        counts.violations += j == Judgement::wrong;
        counts.not_tight += j == Judgement::not_tight;
        if (j == Judgement::tight || !counts.first_failure.empty()) continue;
        char text[400];
        std::snprintf(text, sizeof text, "[%a, %a], [%a, %a], [%a, %a]: [%a, %a]", double(e[0].inf), double(e[0].sup),
                      double(e[1].inf), double(e[1].sup), double(e[2].inf), double(e[2].sup), double(inf), double(sup));
        counts.first_failure = text;
    }
}

template <class Rounding, class T>
TrialCounts run(Operation operation, std::uint64_t seed, std::uint64_t count) {
    using P = IntervalPack<T, Rounding>;
    using I = Interval<T, Arithmetic::real, Rounding>;
    TrialCounts counts;
    Random random(seed);
    for (std::uint64_t i = 0; i < count; i += P::width) {
        T infs[3][P::width], sups[3][P::width], pack_inf[P::width], pack_sup[P::width];
        std::array<std::array<Ends<T>, 3>, P::width> tuples;
        for (int k = 0; k < P::width; ++k) {
            tuples[k] = operands<T>(operation, random);
            for (int j = 0; j < 3; ++j) infs[j][k] = tuples[k][j].inf, sups[j][k] = tuples[k][j].sup;
        }
        apply(operation, P::load(infs[0], sups[0]), P::load(infs[1], sups[1]), P::load(infs[2], sups[2]))
            .store(pack_inf, pack_sup);
        for (int k = 0; k < P::width; ++k) {
            const auto at = [&](int j) { return I(infs[j][k], sups[j][k]); };
            const I result = apply(operation, at(0), at(1), at(2));
            count_result(counts, operation, tuples[k], result.inf(), result.sup());
            counts.differences += std::bit_cast<Bits<T>>(result.inf()) != std::bit_cast<Bits<T>>(pack_inf[k]);
            counts.differences += std::bit_cast<Bits<T>>(result.sup()) != std::bit_cast<Bits<T>>(pack_sup[k]);
        }
    }
    return counts;
}

}  // namespace

}  // namespace trials

TrialCounts interval_trials(const std::string& operation, bool wide, const std::string& implementation,
                            std::uint64_t seed, std::uint64_t count) {
    using namespace trials;
    const Operation op = operation_named(operation);
    return with_rounding("interval_trials", implementation, [&]<class Rounding>(Rounding) {
        return wide ? run<Rounding, double>(op, seed, count) : run<Rounding, float>(op, seed, count);
    });
}

}  // namespace raybound
