// Elementary functions of intervals: the kernel's functions of the midpoints, their stated error, and a bound of what the
// radius makes.
//
// The functions of doubles are off by less than 0.8 (sin, cos, exp, pow, acos), 0.9 (tan), 1.5 (atan2), 0.7 (asin) and
// 0.51 (log) units in the last place (trigonometric.hpp, inverse_trigonometric.hpp, exponential.hpp); here two are
// granted, 2^-51 of the value. The bounds over the radius hold for every radius, not to first order: each names its
// inequality. Where the function has no value somewhere in the interval, or none that is bounded, the radius is infinite
// or not a number.
#pragma once

#include "exponential.hpp"
#include "interval.hpp"
#include "inverse_trigonometric.hpp"
#include "trigonometric.hpp"

namespace {

constexpr double FUNCTION_ERROR = 0x1p-51;

// The function's value at the midpoint with its error and how far the radius moves it.
MECHKIN_INLINE Interval evaluated(Real value, Real moved) {
  return {value, widened(moved + (Real(FUNCTION_ERROR) * abs(value) + Real(LEAST)))};
}

// |sin(m + d) - sin m| <= |d cos m| + d^2 / 2, <= |d| and <= 2; the same with the two exchanged.
MECHKIN_INLINE void sincos(Interval x, Interval& s, Interval& c) {
  Real sine, cosine;
  sincos(x.midpoint, sine, cosine);
  const Real r = x.radius, bend = Real(0.5) * r * r, most = min(r, Real(2.0));
  const auto moved = [&](Real slope) {
    const Real first = widened(r * (abs(slope) + Real(FUNCTION_ERROR)) + bend);
    return if_finite(r, min(first, most));
  };
  s = evaluated(sine, moved(cosine));
  c = evaluated(cosine, moved(sine));
}
MECHKIN_INLINE Interval sin(Interval x) {
  Interval s, c;
  sincos(x, s, c);
  return s;
}
MECHKIN_INLINE Interval cos(Interval x) {
  Interval s, c;
  sincos(x, s, c);
  return c;
}
MECHKIN_INLINE Interval tan(Interval x) {
  Interval s, c;
  sincos(x, s, c);
  return s / c;
}

// The angle of (x, y), whole turns beyond [-pi, pi] where the interval passes the cut there: that of the midpoint and all
// that it goes over into. The turn a from p to q has tan a = |p x q| / p.q, and |a| <= |tan a| while p.q > 0.
MECHKIN_INLINE Interval atan2(Interval y, Interval x) {
  const Real ax = abs(x.midpoint), ay = abs(y.midpoint);
  // by a power of two near the larger, so that no square leaves the range of doubles
  const Real larger = max(ax, ay);
  const Real power = from_bits(bits(larger) & (Words{} + 0x7ff0000000000000));
  const Real scale = Real(1.0) / select(power > Real(0x1p-1000), power, Real(0x1p-1000));
  const Real sx = ax * scale, sy = ay * scale, rx = x.radius * scale + Real(LEAST), ry = y.radius * scale + Real(LEAST);
  const Real across = sx * ry + sy * rx;
  const Real along = narrowed(sx * sx + sy * sy) - widened(sx * rx + sy * ry);
  const Real moved = widened(across + Real(LEAST)) / narrowed(positive_or_zero(along - Real(LEAST)));
  return evaluated(atan2(y.midpoint, x.midpoint), if_finite(larger + rx + ry, moved));
}
MECHKIN_INLINE Interval atan(Interval x) { return atan2(x, Interval(1.0)); }

// How far asin and acos go over the radius: by the largest slope, 1 / sqrt(1 - e^2) at the end e nearest to 1 or -1, and
// by |acos a - acos b| <= 2 asin sqrt(|a - b| / 2) <= pi / sqrt 2 sqrt|a - b|, which holds there, too.
MECHKIN_INLINE Real arc_moved(Interval x) {
  const Real size = abs(x.midpoint), end = size + x.radius;
  // 1 - |m| is exact from 1/2 on, and off by less than 2^-53 below
  const Real rest = ((Real(1.0) - size) - x.radius) - select(size < Real(0.5), Real(0x1p-52), Real(0.0));
  const Real slope = sqrt(narrowed(positive_or_zero(rest) * (Real(1.0) + end)));
  const Real first = widened(x.radius / slope), other = widened(Real(2.2215) * sqrt(x.radius));
  const Mask inside = rest >= Real(0.0);
  return select(inside, select(first < other, first, other), Real(__builtin_nan("")));
}
MECHKIN_INLINE Interval asin(Interval x) { return evaluated(asin(x.midpoint), arc_moved(x)); }
MECHKIN_INLINE Interval acos(Interval x) { return evaluated(acos(x.midpoint), arc_moved(x)); }

// exp r - 1 <= r + r^2 for r <= 1.
MECHKIN_INLINE Real exp_less_one(Real r) {
  return select(r <= Real(1.0), widened(r + r * r), widened(widened(exp(r))));
}

// |exp(m + d) - exp m| <= exp m (exp|d| - 1).
MECHKIN_INLINE Interval exp(Interval x) {
  const Real value = exp(x.midpoint);
  return evaluated(value, (widened(value) + Real(LEAST)) * exp_less_one(x.radius));
}

// |log x - log m| <= |x - m| / min(x, m).
MECHKIN_INLINE Interval log(Interval x) {
  const Real least = narrowed(positive_or_zero(x.midpoint - x.radius));
  return evaluated(log(x.midpoint), if_finite(x.midpoint + x.radius, x.radius / least));
}

// x^y = m^n exp(n log(x/m) + (y - n) log x) for x/m > 0, and |log(x/m)| <= |x - m| / (|m| - |x - m|). Where the base
// reaches zero, an exponent that is a natural number gives |x|^n at most.
MECHKIN_INLINE Interval pow(Interval x, Interval y) {
  const Real zero = Real(0.0), size = abs(x.midpoint), value = pow(x.midpoint, y.midpoint);
  const Mask exact = y.radius == zero;
  const Real least = narrowed(positive_or_zero(size - x.radius));
  const Real turn = widened(x.radius / least);
  const Real logarithm = abs(log(size)), known = select(exact, zero, widened(y.radius * (widened(logarithm) + turn)));
  const Real change = widened(abs(y.midpoint) * turn + known);
  Real moved = (widened(abs(value)) + Real(LEAST)) * exp_less_one(change);
  const Parity exponent = parity(y.midpoint);
  // a negative base has values at exponents that are whole numbers alone
  const Mask defined = (x.midpoint > zero) | (exact & exponent.integer);
  moved = select(defined, moved, Real(__builtin_nan("")));
  const Mask natural = exact & exponent.integer & (y.midpoint > zero) & ~(least > zero);
  const Real largest = pow(widened(size + x.radius), y.midpoint);
  moved = select(natural, widened(widened(largest) + abs(value)), moved);
  moved = select(exact & (y.midpoint == zero), zero, moved);
  return evaluated(value, if_finite(x.radius, moved));
}

}  // namespace
