// Curves of knots where numbers are enclosed: the cubics of all pieces that the argument may lie in are kept.
#pragma once

#include "joints/knot_fields.hpp"

#if MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
#include "tape/enclosed_tape.hpp"
#else
#include "tape/modelled_tape.hpp"
#endif

namespace {

#if MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
MECHKIN_INLINE Real least_of(const Pack& a) { return lower(a); }
MECHKIN_INLINE Real most_of(const Pack& a) { return upper(a); }
#else
MECHKIN_INLINE Real least_of(const Pack& a) { return lower_bound(a); }
MECHKIN_INLINE Real most_of(const Pack& a) { return upper_bound(a); }
#endif

// An argument that may lie in more pieces is not told apart.
constexpr double MOST_PIECES = 64.0;

// A curve over an argument: hulls of its value and derivatives in all its pieces that the argument meets.
template <class Number>
class PiecesMet {
 public:
  using K = KnotOf<Number>;

  PiecesMet(const K* first, int count) : first_(first), count_(count), known_(all_lanes(false)), lost_(known_) {
    for (Pack& order : hull_) order = Pack(0.0);
  }
  const K& begin() const { return *first_; }
  const K& end() const { return first_[count_ - 1]; }
  // Takes in values where a lane may have them.
  void take(const Pack* value, Mask holds) {
    for (int k = 0; k < FUNCTION_ORDERS; ++k)
      hull_[k] = chosen(holds, chosen(known_, hull(hull_[k], value[k]), value[k]), hull_[k]);
    known_ = known_ | holds;
  }
  // Takes in the pieces between the first and the last knot.
  void take_pieces(const Pack& at) {
    const Real least = least_of(at), most = most_of(at);
    const Mask meets = (most >= least_of(Pack(begin().x))) & (least <= most_of(Pack(end().x)));
    int low[LANES], high[LANES], most_pieces = 0;
    double pieces[LANES];
    for (int i = 0; i < LANES; ++i) {
      low[i] = last_knot(lane(least, i), true), high[i] = last_knot(lane(most, i), false);
      const int met = lane(meets, i) ? high[i] - low[i] + 1 : 0;
      pieces[i] = met;
      if (met <= MOST_PIECES && met > most_pieces) most_pieces = met;
    }
    const Real count = load(pieces);
    lose(count > Real(MOST_PIECES));
    for (int n = 0; n < most_pieces; ++n) {
      const K* piece[LANES];
      for (int i = 0; i < LANES; ++i) piece[i] = first_ + (low[i] + n < high[i] ? low[i] + n : high[i]);
      Pack value[FUNCTION_ORDERS];
      values_of(piece, at, value);
      take(value, Real(n) < count);
    }
  }
  // Nothing is known of these lanes.
  void lose(Mask lanes) { lost_ = lost_ | lanes; }
  void write(Pack* out) const {
    const Real unknown = select(known_ & ~lost_, Real(0.0), Real(__builtin_nan("")));
    for (int k = 0; k < FUNCTION_ORDERS; ++k) out[k] = hull_[k], out[k].radius = out[k].radius + unknown;
  }

 private:
  // The last knot that is not above x for certain, or that may not be; the first one where there is none.
  int last_knot(double x, bool certain) const {
    int low = 0, high = count_ - 1;
    while (low < high) {
      const int middle = (low + high + 1) / 2;
      const Pack from = first_[middle].x;
      if (lane(certain ? most_of(from) : least_of(from), 0) <= x)
        low = middle;
      else
        high = middle - 1;
    }
    return low;
  }
  // Value and derivatives of the lanes' pieces.
  static void values_of(const K* const* piece, const Pack& at, Pack* value) {
    const auto field = [piece](Number K::*of) { return field_of_lanes(piece, of); };
    const Pack u = at - field(&K::x), b = field(&K::b), c = field(&K::c), d = field(&K::d);
    value[0] = field(&K::y) + u * (b + u * (c + u * d));
    value[1] = b + u * (Pack(2.0) * c + Pack(3.0) * u * d);
    value[2] = Pack(2.0) * c + Pack(6.0) * u * d;
    value[3] = Pack(6.0) * d;
  }

  const K* first_;
  int count_;
  Pack hull_[FUNCTION_ORDERS];
  Mask known_, lost_;
};

template <class Number>
inline void straight_values(const KnotOf<Number>& end, const Pack& at, Pack* value) {
  value[0] = Pack(end.y) + Pack(end.b) * (at - Pack(end.x));
  value[1] = Pack(end.b), value[2] = Pack(0.0), value[3] = Pack(0.0);
}

// Value and three derivatives of a function's curve; unknown where the argument is too wide.
template <class Number>
inline void knots_at(const FunctionCurve& curve, const KnotOf<Number>* knot, const Pack& given, Pack* out) {
  PiecesMet<Number> met(knot + curve.begin, curve.end - curve.begin);
  const Pack start = met.begin().x, end = met.end().x;
  Pack at = given;
  if (curve.repeats) {
    const Pack period = end - start;
    const Real half = 0.5, span = least_of(period);
    const Real off = half * (least_of(given) + most_of(given)) - half * (least_of(start) + most_of(end));
    at = given - period * Pack(nearest_integer(off / span));
    // beyond the neighbouring periods
    met.lose((least_of(at) < least_of(start) - span) | (most_of(at) > most_of(end) + span));
    met.take_pieces(at - period);
    met.take_pieces(at + period);
  } else {
    Pack value[FUNCTION_ORDERS];
    straight_values(met.begin(), at, value);
    met.take(value, least_of(at) < most_of(start));
    straight_values(met.end(), at, value);
    met.take(value, most_of(at) > least_of(end));
  }
  met.take_pieces(at);
  met.write(out);
}

}  // namespace
