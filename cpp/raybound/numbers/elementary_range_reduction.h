// Multiples of pi/2: where any double lies between them, with integers alone (Payne and Hanek 1983).
#pragma once

#include "raybound/numbers/double_double.h"

namespace raybound {

// x = nearest pi/2 + rest, |rest| <= pi/4 (1 + 2^-50). Counts of multiples are modulo 64.
struct QuarterTurns {
    int nearest = 0;
    DoubleDouble rest;

    // The last multiple of pi/2 that is not above x. It is exact: only x = 0 is a multiple, and the sign of any other
    // rest is certain, as no double is closer to a multiple than 2^-61.6 pi/2 (D10).
    int below() const { return nearest - (rest.high < 0); }
};

// Any finite x; rest has a relative error below 2^-101.
QuarterTurns quarter_turns(double x);

}  // namespace raybound
