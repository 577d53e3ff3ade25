// Curves of functions where numbers are enclosed: the cubics of all pieces that the argument may lie in are kept. Knots are
// the numbers that they are.
#pragma once

#include "arithmetic/pack.hpp"
#include "plan/functions.hpp"

namespace {

#if MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
MECHKIN_INLINE Real least_of(const Pack& a) { return lower(a); }
MECHKIN_INLINE Real most_of(const Pack& a) { return upper(a); }
#else
MECHKIN_INLINE Real least_of(const Pack& a) { return lower_bound(a); }
MECHKIN_INLINE Real most_of(const Pack& a) { return upper_bound(a); }
#endif

// An argument that may lie in more pieces is not told apart.
constexpr int MOST_PIECES = 64;

// The number of the last knot that is not above x, or of the first one.
inline int piece_below(const Knot* first, int count, double x) {
  int low = 0, high = count - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (first[middle].x <= x)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

// Takes values of the lanes that `holds` names in, beside what is known of them.
inline void take_in(Pack* out, const Pack* value, Mask holds, Mask known) {
  for (int k = 0; k < FUNCTION_ORDERS; ++k)
    out[k] = chosen(holds, chosen(known, hull(out[k], value[k]), value[k]), out[k]);
}

// Value and derivatives of the lanes' pieces.
inline void piece_values(const Knot* const* piece, const Pack& at, Pack* value) {
  const auto field = [piece](double Knot::*of) {
    double lanes[LANES];
    for (int i = 0; i < LANES; ++i) lanes[i] = piece[i]->*of;
    return Pack(load(lanes));
  };
  const Pack u = at - field(&Knot::x), b = field(&Knot::b), c = field(&Knot::c), d = field(&Knot::d);
  value[0] = field(&Knot::y) + u * (b + u * (c + u * d));
  value[1] = b + u * (Pack(2.0) * c + Pack(3.0) * u * d);
  value[2] = Pack(2.0) * c + Pack(6.0) * u * d;
  value[3] = Pack(6.0) * d;
}

// Takes in all pieces of the curve between its first and last knot that meet the argument; the lanes in which there are too many.
inline Mask take_pieces(const Knot* first, int count, const Pack& at, Pack* out, Mask* known) {
  const Real least = least_of(at), most = most_of(at);
  const Mask meets = (most >= Real(first->x)) & (least <= Real(first[count - 1].x));
  int begin[LANES], end[LANES], most_pieces = 0;
  for (int i = 0; i < LANES; ++i) {
    begin[i] = piece_below(first, count, lane(least, i)), end[i] = piece_below(first, count, lane(most, i));
    if (lane(meets, i) && end[i] - begin[i] > most_pieces) most_pieces = end[i] - begin[i];
  }
  if (most_pieces >= MOST_PIECES) return meets;
  for (int n = 0; n <= most_pieces; ++n) {
    const Knot* piece[LANES];
    for (int i = 0; i < LANES; ++i) piece[i] = first + (begin[i] + n < end[i] ? begin[i] + n : end[i]);
    Pack value[FUNCTION_ORDERS];
    piece_values(piece, at, value);
    take_in(out, value, meets, *known);
    *known = *known | meets;
  }
  return all_lanes(false);
}

// Value and three derivatives of a function's curve; unknown where the argument may lie outside its range.
inline void knots_at(const FunctionCurve& curve, const Knot* knot, const Pack& given, Pack* out) {
  const Knot* const first = knot + curve.begin;
  const int count = curve.end - curve.begin;
  const Knot& last = first[count - 1];
  const Real half = 0.5, none = 0.0;
  Mask known = all_lanes(false), lost = known;
  for (int k = 0; k < FUNCTION_ORDERS; ++k) out[k] = Pack(0.0);
  Pack at = given;
  if (curve.period > 0.0) {
    const Real middle = half * (least_of(given) + most_of(given)), centre = half * Real(first->x + last.x);
    const Pack period = curve.period;
    at = given - period * Pack(nearest_integer((middle - centre) / Real(curve.period)));
    lost = (least_of(at) < Real(first->x - curve.period)) | (most_of(at) > Real(last.x + curve.period));
    lost = lost | take_pieces(first, count, at - period, out, &known);
    lost = lost | take_pieces(first, count, at + period, out, &known);
  } else {
    lost = (least_of(at) < Real(curve.low)) | (most_of(at) > Real(curve.high));
    // beyond the ends, within the range, the value is the end's
    Pack value[FUNCTION_ORDERS] = {Pack(first->y), Pack(0.0), Pack(0.0), Pack(0.0)};
    const Mask before = least_of(at) < Real(first->x), behind = most_of(at) > Real(last.x);
    take_in(out, value, before, known);
    known = known | before;
    value[0] = Pack(last.y);
    take_in(out, value, behind, known);
    known = known | behind;
  }
  lost = lost | take_pieces(first, count, at, out, &known);
  const Real unknown = select(known & ~lost, none, Real(__builtin_nan("")));
  for (int k = 0; k < FUNCTION_ORDERS; ++k) out[k].radius = out[k].radius + unknown;
}

}  // namespace
