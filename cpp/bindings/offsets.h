// Offset policies by their names.
#pragma once

#include <stdexcept>
#include <string>

#include "raybound/frame/offsets.h"

namespace raybound::python {

inline Offsets offsets_named(const std::string& who, const std::string& name) {
    if (name == "bounded") return Offsets::bounded;
    if (name == "epsilon") return Offsets::epsilon;
    if (name == "scaled-epsilon") return Offsets::scaled_epsilon;
    if (name == "whole-epsilon") return Offsets::whole_epsilon;
    throw std::invalid_argument(
        who + ": offsets must be 'bounded', 'epsilon', 'scaled-epsilon' or 'whole-epsilon', got '" + name + "'");
}

}  // namespace raybound::python
