// Elementary functions of intervals: those of the midpoints in double-double, their stated error, and a bound of what the
// radius makes.
//
// The functions of double-doubles are off by less than 2e-31 of their value, pow by that many times 1 + |y log x|
// (double_double_trigonometric.hpp, double_double_exponential.hpp); here fifteen times that is granted. The bounds over the
// radius hold for every radius, not to first order: each names its inequality. Where the function has no value somewhere in
// the interval, or none that is bounded, the radius is infinite or not a number.
#pragma once

#include "arithmetic/double_double_functions.hpp"
#include "arithmetic/interval.hpp"

namespace {

constexpr double FUNCTION_ERROR = 0x1p-98;
// Slopes are taken of high parts.
constexpr double SLOPE_ERROR = 0x1p-51;

// The function's value at the midpoint with its error and how far the radius moves it.
MECHKIN_INLINE Interval evaluated(const DoubleDouble& value, Real moved) {
  return {value, widened(moved + (Real(FUNCTION_ERROR) * abs(value.high) + Real(LEAST)))};
}

// |sin(m + d) - sin m| <= |d cos m| + d^2 / 2, <= |d| and <= 2; the same with the two exchanged.
MECHKIN_INLINE void sincos(const Interval& x, Interval& s, Interval& c) {
  DoubleDouble sine, cosine;
  sincos(x.midpoint, sine, cosine);
  const Real r = x.radius, bend = Real(0.5) * r * r, most = min(r, Real(2.0));
  const auto moved = [&](const DoubleDouble& slope) {
    const Real first = widened(r * (abs(slope.high) + Real(SLOPE_ERROR)) + bend);
    return if_finite(r, min(first, most));
  };
  s = evaluated(sine, moved(cosine));
  c = evaluated(cosine, moved(sine));
}
MECHKIN_INLINE Interval sin(const Interval& x) {
  Interval s, c;
  sincos(x, s, c);
  return s;
}
MECHKIN_INLINE Interval cos(const Interval& x) {
  Interval s, c;
  sincos(x, s, c);
  return c;
}
MECHKIN_INLINE Interval tan(const Interval& x) {
  Interval s, c;
  sincos(x, s, c);
  return s / c;
}

// The angle of (x, y), whole turns beyond [-pi, pi] where the interval passes the cut there: that of the midpoint and all
// that it goes over into. The turn a from p to q has tan a = |p x q| / p.q, and |a| <= |tan a| while p.q > 0.
MECHKIN_INLINE Interval atan2(const Interval& y, const Interval& x) {
  const Real ax = x.size(), ay = y.size();
  // by a power of two near the larger, so that no square leaves the range of doubles
  const Real larger = max(ax, ay);
  const Real power = from_bits(bits(larger) & (Words{} + 0x7ff0000000000000));
  const Real scale = Real(1.0) / select(power > Real(0x1p-1000), power, Real(0x1p-1000));
  const Real sx = ax * scale, sy = ay * scale, rx = x.radius * scale + Real(LEAST), ry = y.radius * scale + Real(LEAST);
  const Real across = sx * ry + sy * rx;
  const Real along = narrowed(sx * sx + sy * sy) - widened(sx * rx + sy * ry);
  const Real moved = widened(across + Real(LEAST)) / narrowed(positive_or_zero(along - Real(LEAST)));
  // so scaled, products of double-doubles lose below the normal range less than is added
  const DoubleDouble angle = atan2(scaled(y.midpoint, scale), scaled(x.midpoint, scale));
  return evaluated(angle, if_finite(larger + rx + ry, moved + Real(0x1p-990)));
}
MECHKIN_INLINE Interval atan(const Interval& x) { return atan2(x, Interval(1.0)); }
// The angle of (x, y) in (-pi, pi], where a whole turn more would be another number: all of [-pi, pi] where the interval meets
// the cut and goes below it. A zero is +0 here, whatever its sign.
MECHKIN_INLINE Interval principal_angle(const Interval& y, const Interval& x) {
  const Real zero = 0.0;
  const Interval angle = atan2({DoubleDouble(y.midpoint.high + zero, y.midpoint.low), y.radius}, x);
  const Mask on_axis = (y.radius == zero) & (y.midpoint.high == zero);
  const Mask both_sides = (lower(x) < zero) & (lower(y) < zero) & (upper(y) >= zero) & ~on_axis;
  // nothing is known of the angle of what may be the origin
  const Real known = angle.radius - angle.radius, half_turn = 0x1.921fb54442d19p+1;
  return {{select(both_sides, zero, angle.midpoint.high), select(both_sides, zero, angle.midpoint.low)},
          select(both_sides, half_turn + known, angle.radius)};
}

// How far asin and acos go over the radius: by the largest slope, 1 / sqrt(1 - e^2) at the end e nearest to 1 or -1, and
// by |acos a - acos b| <= 2 asin sqrt(|a - b| / 2) <= pi / sqrt 2 sqrt|a - b|, which holds there, too.
MECHKIN_INLINE Real arc_moved(const Interval& x) {
  const Real off = accurate_sum(Real(1.0), -abs(x.midpoint)).high;
  const Real rest = (off - x.radius) - Real(0x1p-51) * (abs(off) + x.radius);
  const Real slope = sqrt(narrowed(positive_or_zero(rest) * (Real(1.0) + x.size())));
  const Real first = widened(x.radius / slope), other = widened(Real(2.2215) * sqrt(x.radius));
  const Mask inside = rest >= Real(0.0);
  return select(inside, select(first < other, first, other), Real(__builtin_nan("")));
}
MECHKIN_INLINE Interval asin(const Interval& x) { return evaluated(asin(x.midpoint), arc_moved(x)); }
MECHKIN_INLINE Interval acos(const Interval& x) { return evaluated(acos(x.midpoint), arc_moved(x)); }

// exp r - 1 <= r + r^2 for r <= 1.
MECHKIN_INLINE Real exp_less_one(Real r) {
  return select(r <= Real(1.0), widened(r + r * r), widened(widened(exp(r))));
}

// |exp(m + d) - exp m| <= exp m (exp|d| - 1).
MECHKIN_INLINE Interval exp(const Interval& x) {
  const DoubleDouble value = exp(x.midpoint);
  return evaluated(value, (widened(value.high) + Real(LEAST)) * exp_less_one(x.radius));
}

// |log x - log m| <= |x - m| / min(x, m).
MECHKIN_INLINE Interval log(const Interval& x) {
  const Real high = x.midpoint.high, least = narrowed(positive_or_zero(narrowed(high) - x.radius));
  return evaluated(log(x.midpoint), if_finite(high + x.radius, x.radius / least));
}

// x^y = m^n exp(n log(x/m) + (y - n) log x) for x/m > 0, and |log(x/m)| <= |x - m| / (|m| - |x - m|). Where the base
// reaches zero, an exponent that is a natural number gives |x|^n at most.
MECHKIN_INLINE Interval pow(const Interval& x, const Interval& y) {
  const Real zero = Real(0.0), size = x.size(), exponent = y.midpoint.high;
  const DoubleDouble value = pow(x.midpoint, y.midpoint);
  const Mask exact = y.radius == zero;
  const Real least = narrowed(positive_or_zero(narrowed(size) - x.radius));
  const Real turn = widened(x.radius / least);
  // of the whole base
  const Real logarithm = widened(abs(log(size)) + Real(0x1p-52)), known = select(exact, zero, widened(y.radius * (logarithm + turn)));
  const Real change = widened(abs(exponent) * turn + known), height = widened(abs(value.high));
  Real moved = (height + Real(LEAST)) * exp_less_one(change) + Real(FUNCTION_ERROR) * height * abs(exponent) * logarithm;
  const Mask whole = parity(exponent).integer & (y.midpoint.low == zero);
  // a negative base has values at exponents that are whole numbers alone
  const Mask defined = (x.midpoint.high > zero) | (exact & whole);
  moved = select(defined, moved, Real(__builtin_nan("")));
  const Mask natural = exact & whole & (exponent > zero) & ~(least > zero);
  const Real largest = pow(widened(size + x.radius), exponent);
  moved = select(natural, widened(widened(largest) + height), moved);
  moved = select(exact & (exponent == zero), zero, moved);
  return evaluated(value, if_finite(x.radius, moved));
}

}  // namespace
