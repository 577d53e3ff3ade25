// Curves of knots at packs of places.
#pragma once

#include "arithmetic/pack.hpp"
#include "plan/functions.hpp"

namespace {

// The piece from the last knot that is not above lane i of x.
inline const Knot& piece_at(const Knot* first, int count, Pack x, int i) {
  const double leading = lane(part_of(x, 0), i), rest = PARTS == 1 ? 0.0 : lane(part_of(x, PARTS - 1), i);
  int low = 0, high = count - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (first[middle].x < leading || (first[middle].x == leading && rest >= 0.0))
      low = middle;
    else
      high = middle - 1;
  }
  return first[low];
}

// The pieces of all lanes, field by field.
struct PieceOfLanes {
  Knot piece[LANES];
  PieceOfLanes(const Knot* first, int count, Pack within) {
    for (int i = 0; i < LANES; ++i) piece[i] = piece_at(first, count, within, i);
  }
  Pack operator()(double Knot::*of) const {
    double values[LANES];
    for (int i = 0; i < LANES; ++i) values[i] = piece[i].*of;
    return Pack(load(values));
  }
};

// Value and three derivatives of a function's curve.
inline void knots_at(const FunctionCurve& curve, const Knot* knot, Pack at, Pack* out) {
  const Knot* const first = knot + curve.begin;
  const int count = curve.end - curve.begin;
  const Pack start = first->x, end = first[count - 1].x, zero = 0.0;
  if (curve.period > 0.0) {
    const Pack period = curve.period, middle = Pack(0.5) * (start + end);
    at = at - period * nearest_integer((at - middle) / period);
  }
  const Mask before = at < start, straight = before | (at > end);
  const Pack within = select(before, start, select(straight, end, at));
  const PieceOfLanes piece(first, count, within);
  const Pack u = at - piece(&Knot::x), b = piece(&Knot::b);
  const Pack c = select(straight, zero, piece(&Knot::c)), d = select(straight, zero, piece(&Knot::d));
  out[0] = piece(&Knot::y) + u * (b + u * (c + u * d));
  out[1] = b + u * (Pack(2.0) * c + Pack(3.0) * u * d);
  out[2] = Pack(2.0) * c + Pack(6.0) * u * d;
  out[3] = Pack(6.0) * d;
}

}  // namespace
