// Whose results an enclosure holds.
#pragma once

namespace raybound {

// real: those of real-number arithmetic. float32: also those of every execution of the same formula in float32, rounded
// to nearest operation by operation, underflow and overflow included, as long as it meets no NaN.
enum class Arithmetic : unsigned char { real, float32 };

}  // namespace raybound
