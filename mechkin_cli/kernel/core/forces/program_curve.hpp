// The value of a program's curve.
#pragma once

#include "joints/knots.hpp"
#include "rows/outputs.hpp"

namespace {

template <class Number>
inline Pack curve_value(const ProgramCurve& c, const KnotOf<Number>* knot, Pack at) {
  using K = KnotOf<Number>;
  const K* const first = knot + c.begin;
  const int count = c.end - c.begin;
  const Pack start = first->x, end = first[count - 1].x;
  const Mask inside = (at >= Pack(c.low)) & (at <= Pack(c.high));
  const Pack within = select(at < start, start, select(at > end, end, at));
  const PieceOfLanes<Number> piece(first, count, within);
  const Pack u = within - piece(&K::x);
  const Pack value = piece(&K::y) + u * (piece(&K::b) + u * (piece(&K::c) + u * piece(&K::d)));
  return select(inside, value, Pack(__builtin_nan("")));
}

}  // namespace
