// Curves of programs where numbers are enclosed: their knots are rounded and say not by how much, so nothing is known of them.
#pragma once

#include "rows/outputs.hpp"

namespace {

inline Pack curve_value(const ProgramCurve&, const Knot*, Pack) { return Pack(__builtin_nan("")); }

}  // namespace
