// The value of a program's curve.
#pragma once

#include "joints/knots.hpp"
#include "rows/outputs.hpp"

namespace {

inline Pack curve_value(const ProgramCurve& c, const Knot* knot, Pack at) {
  const Knot* const first = knot + c.begin;
  const int count = c.end - c.begin;
  const Pack start = first->x, end = first[count - 1].x;
  const Mask inside = (at >= Pack(c.low)) & (at <= Pack(c.high));
  const Pack within = select(at < start, start, select(at > end, end, at));
  const PieceOfLanes piece(first, count, within);
  const Pack u = within - piece(&Knot::x);
  const Pack value = piece(&Knot::y) + u * (piece(&Knot::b) + u * (piece(&Knot::c) + u * piece(&Knot::d)));
  return select(inside, value, Pack(__builtin_nan("")));
}

}  // namespace
