#include "raybound/numbers/elementary_range_reduction.h"

#include <bit>
#include <cstdint>

#include "raybound/numbers/elementary_range_tables.h"

namespace raybound {

namespace {

using Word = std::uint64_t;
__extension__ using TwoWords = unsigned __int128;

// A fraction of 192 bits below 1, given by its words, the largest first, at least 2^-64: its first 106 bits.
DoubleDouble to_double_double(Word w0, Word w1, Word w2) {
    const int zeros = std::countl_zero(w0);
    TwoWords top = (TwoWords(w0) << 64 | w1) << zeros;
    if (zeros > 0) top |= w2 >> (64 - zeros);
    const double high = double(Word(top >> 75)), low = double(Word(top >> 22) & ((Word(1) << 53) - 1));
    return fast_two_sum(high * power_of_two(-53 - zeros), low * power_of_two(-106 - zeros));
}

// For x >= 0.75. With x = m 2^e, m < 2^53, bits of 2/pi above 2^(6-e) add multiples of 64 to x 2/pi and are left out;
// the 256 that follow are F: x 2/pi = m F 2^-250 modulo 64, short of the truth by less than m 2^-250 < 2^-197.
QuarterTurns reduce(double x) {
    const auto bits = std::bit_cast<Word>(x);
    const Word m = (bits & ((Word(1) << 52) - 1)) | Word(1) << 52;
    const int e = int(bits >> 52) - 1075;
    const int first = e - 6 + 64;  // counted in bits of the table, which begins with 64 zeros
    const auto word = [&](int i) {
        const Word* const w = &elementary_tables::two_over_pi[std::size_t(first / 64 + i)];
        return first % 64 == 0 ? w[0] : w[0] << first % 64 | w[1] >> (64 - first % 64);
    };
    const TwoWords p3 = TwoWords(m) * word(3);
    const TwoWords p2 = TwoWords(m) * word(2) + Word(p3 >> 64);
    const TwoWords p1 = TwoWords(m) * word(1) + Word(p2 >> 64);
    const Word p0 = m * word(0) + Word(p1 >> 64);

    // p0 begins with the six bits of the integer; the rest is the fraction, which is made to lie in [-1/2, 1/2).
    Word f0 = p0 << 6 | Word(p1) >> 58, f1 = Word(p1) << 6 | Word(p2) >> 58, f2 = Word(p2) << 6 | Word(p3) >> 58;
    const bool above = f0 >> 63 != 0;
    if (above) f0 = ~f0, f1 = ~f1, f2 = ~f2;  // the negative, short by less than 2^-192
    const DoubleDouble rest = to_double_double(f0, f1, f2) * elementary_tables::half_pi;
    return {int(p0 >> 58) + above, above ? -rest : rest};
}

}  // namespace

QuarterTurns quarter_turns(double x) {
    if (std::abs(x) < 0.75) return {0, {x, 0}};
    const QuarterTurns turns = reduce(std::abs(x));
    return x > 0 ? turns : QuarterTurns{-turns.nearest, -turns.rest};
}

}  // namespace raybound
