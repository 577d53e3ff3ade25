// The value of a program's curve where numbers are enclosed.
#pragma once

#include "joints/enclosed_knots.hpp"
#include "rows/outputs.hpp"

namespace {

// Beyond the first and last knot, within the range, the value is the end's; unknown where the argument may lie outside.
template <class Number>
inline Pack curve_value(const ProgramCurve& c, const KnotOf<Number>* knot, const Pack& at) {
  PiecesMet<Number> met(knot + c.begin, c.end - c.begin);
  Pack value[FUNCTION_ORDERS] = {met.begin().y, Pack(0.0), Pack(0.0), Pack(0.0)};
  met.lose((least_of(at) < Real(c.low)) | (most_of(at) > Real(c.high)));
  met.take(value, least_of(at) < most_of(Pack(met.begin().x)));
  value[0] = met.end().y;
  met.take(value, most_of(at) > least_of(Pack(met.end().x)));
  met.take_pieces(at);
  met.write(value);
  return value[0];
}

}  // namespace
