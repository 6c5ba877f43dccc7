// Three-valued truth: what a predicate over a set of values answers (Kleene's strong logic).
#pragma once

namespace raybound {

// no: false for every value of the set; yes: true for every value; unknown: nothing is promised, and it is never read
// as no.
enum class Verdict : unsigned char { no, yes, unknown };

constexpr Verdict verdict(bool truth) { return truth ? Verdict::yes : Verdict::no; }

constexpr bool none(Verdict v) { return v == Verdict::no; }  // certainly not
constexpr bool certain(Verdict v) { return v == Verdict::yes; }

constexpr Verdict operator!(Verdict v) { return v == Verdict::unknown ? Verdict::unknown : verdict(v == Verdict::no); }
constexpr Verdict operator&(Verdict a, Verdict b) {
    if (a == Verdict::no || b == Verdict::no) return Verdict::no;
    return a == Verdict::yes ? b : Verdict::unknown;
}
constexpr Verdict operator|(Verdict a, Verdict b) { return !((!a) & (!b)); }

}  // namespace raybound
