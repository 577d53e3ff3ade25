// Curves of knots at packs of places.
#pragma once

#include "joints/knot_fields.hpp"

namespace {

// Whether a knot is not above lane i of x.
template <class Number>
inline bool is_reached(const KnotOf<Number>& knot, Pack x, int i) {
  const Pack from = knot.x;
  const double leading = lane(part_of(x, 0), i), start = lane(part_of(from, 0), i);
  if (PARTS == 1 || start != leading) return start <= leading;
  return lane(part_of(from, PARTS - 1), i) <= lane(part_of(x, PARTS - 1), i);
}

// The piece from the last knot that is not above lane i of x.
template <class Number>
inline const KnotOf<Number>* piece_at(const KnotOf<Number>* first, int count, Pack x, int i) {
  int low = 0, high = count - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (is_reached(first[middle], x, i))
      low = middle;
    else
      high = middle - 1;
  }
  return first + low;
}

// The pieces of all lanes, field by field.
template <class Number>
struct PieceOfLanes {
  const KnotOf<Number>* piece[LANES];
  PieceOfLanes(const KnotOf<Number>* first, int count, Pack within) {
    for (int i = 0; i < LANES; ++i) piece[i] = piece_at(first, count, within, i);
  }
  Pack operator()(Number KnotOf<Number>::*of) const { return field_of_lanes(piece, of); }
};

// Value and three derivatives of a function's curve.
template <class Number>
inline void knots_at(const FunctionCurve& curve, const KnotOf<Number>* knot, Pack at, Pack* out) {
  using K = KnotOf<Number>;
  const K* const first = knot + curve.begin;
  const int count = curve.end - curve.begin;
  const Pack start = first->x, end = first[count - 1].x, zero = 0.0;
  if (curve.repeats) {
    const Pack period = end - start, middle = Pack(0.5) * (start + end);
    at = at - period * nearest_integer((at - middle) / period);
  }
  const Mask before = at < start, straight = before | (at > end);
  const Pack within = select(before, start, select(straight, end, at));
  const PieceOfLanes<Number> piece(first, count, within);
  const Pack u = at - piece(&K::x), b = piece(&K::b);
  const Pack c = select(straight, zero, piece(&K::c)), d = select(straight, zero, piece(&K::d));
  out[0] = piece(&K::y) + u * (b + u * (c + u * d));
  out[1] = b + u * (Pack(2.0) * c + Pack(3.0) * u * d);
  out[2] = Pack(2.0) * c + Pack(6.0) * u * d;
  out[3] = Pack(6.0) * d;
}

}  // namespace
