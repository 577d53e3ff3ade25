// Curves of functions where numbers are enclosed: their knots are rounded and say not by how much, so nothing is known of them.
#pragma once

#include "arithmetic/pack.hpp"
#include "plan/functions.hpp"

namespace {

inline void knots_at(const FunctionCurve&, const Knot*, const Pack&, Pack* out) {
  for (int k = 0; k < FUNCTION_ORDERS; ++k) out[k] = Pack(__builtin_nan(""));
}

}  // namespace
