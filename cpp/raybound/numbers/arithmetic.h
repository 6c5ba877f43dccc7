// Whose results an enclosure holds.
#pragma once

namespace raybound {

// real: those of real-number arithmetic. float32: also those of every execution of the same formula in float32, rounded
// to nearest operation by operation, underflow and overflow included, as long as it meets no NaN. float64: of those in
// float64, as the base tracer decides where its rays hit.
enum class Arithmetic : unsigned char { real, float32, float64 };

}  // namespace raybound
