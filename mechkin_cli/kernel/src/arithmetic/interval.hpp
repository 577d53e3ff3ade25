// Intervals in lanes as midpoint and radius: every number x with |x - midpoint| <= radius.
//
// Rounding is to nearest throughout, and no mode is changed: a midpoint is what doubles give, and the radius an upper
// bound of what the operands' radii and the rounding of the midpoint make of it (S. M. Rump, Fast and parallel interval
// arithmetic, BIT 39, 1999). A bound is computed with at most nine roundings one after the other, each of which takes off
// at most u = 2^-53 of it; the factor WIDEN gives back what sixteen take. Sums are exact below the normal range. What
// products and quotients lose there is at most 2^-1075 each, and LEAST, added once, is more than all of it.
//
// A radius that is infinite or not a number says nothing of the value, not even that there is one: so are the quotient
// by an interval that reaches zero, the root of one that reaches below it or is zero, and all that is computed of
// either. There is no comparison and no choice by values; what has to choose does so among doubles, and says why that is
// right.
#pragma once

#include "doubles.hpp"
#include "two_parts.hpp"

namespace {

constexpr double UNIT_ROUNDOFF = 0x1p-53;
constexpr double WIDEN = 1.0 + 0x1p-49, NARROW = 1.0 - 0x1p-49;
constexpr double LEAST = 0x1p-1070;

// Upper bound of a sum of nonnegative numbers whose computed value is `a`, see above; lower bound, for a > 0.
MECHKIN_INLINE Real widened(Real a) { return a * Real(WIDEN); }
MECHKIN_INLINE Real narrowed(Real a) { return a * Real(NARROW); }
// Zero where a bound from below is not above zero, or not a number: dividing by it leaves no finite radius.
MECHKIN_INLINE Real positive_or_zero(Real a) { return select(a > Real(0.0), a, Real(0.0)); }
// A bound that holds only of what is known.
MECHKIN_INLINE Real if_finite(Real a, Real bound) {
  return select(a < Real(__builtin_inf()), bound, Real(__builtin_nan("")));
}

struct Interval {
  Real midpoint, radius;
  Interval() = default;
  // The double itself. A decimal number or pi is none: see rounded().
  MECHKIN_INLINE Interval(double x) : midpoint(x), radius(0.0) {}
  MECHKIN_INLINE Interval(Real m, Real r) : midpoint(m), radius(r) {}
  MECHKIN_INLINE explicit Interval(Real x) : midpoint(x), radius(0.0) {}
  MECHKIN_INLINE Interval(TwoParts x) : midpoint(x.first), radius(x.second) {}

  friend MECHKIN_INLINE Interval operator+(Interval a, Interval b) {
    const Real m = a.midpoint + b.midpoint;
    return {m, widened((a.radius + b.radius) + Real(UNIT_ROUNDOFF) * abs(m))};
  }
  friend MECHKIN_INLINE Interval operator-(Interval a, Interval b) { return a + -b; }
  friend MECHKIN_INLINE Interval operator-(Interval a) { return {-a.midpoint, a.radius}; }
  friend MECHKIN_INLINE Interval operator*(Interval a, Interval b) {
    const Real m = a.midpoint * b.midpoint;
    const Real spread = abs(a.midpoint) * b.radius + a.radius * (abs(b.midpoint) + b.radius);
    return {m, widened(spread + (Real(UNIT_ROUNDOFF) * abs(m) + Real(LEAST)))};
  }
  // With q the rounded quotient of the midpoints, |x/y - q| <= (|x - m_x| + |q| |y - m_y| + |m_x - q m_y|) / |y|.
  friend MECHKIN_INLINE Interval operator/(Interval a, Interval b) {
    const Real q = a.midpoint / b.midpoint, size = abs(b.midpoint);
    const Real least = narrowed(positive_or_zero(size - b.radius));
    const Real inverse = Real(1.0) / least + Real(LEAST);
    // a quotient below the normal range is off by more than u of itself, but not of 2^-1020
    const Real spread = a.radius * inverse +
                        (abs(q) + Real(0x1p-1020)) * (b.radius * inverse + Real(UNIT_ROUNDOFF) * (size * inverse));
    return {q, widened(spread + Real(LEAST))};
  }
  MECHKIN_INLINE Interval& operator+=(Interval b) { return *this = *this + b; }
  MECHKIN_INLINE Interval& operator-=(Interval b) { return *this = *this - b; }
  MECHKIN_INLINE Interval& operator*=(Interval b) { return *this = *this * b; }

  friend Mask operator<(Interval, Interval) = delete;
  friend Mask operator<=(Interval, Interval) = delete;
  friend Mask operator>(Interval, Interval) = delete;
  friend Mask operator>=(Interval, Interval) = delete;
  friend Mask operator==(Interval, Interval) = delete;
};
Interval select(Mask, Interval, Interval) = delete;

// |sqrt x - s| <= |x - m| / (sqrt x + sqrt m) + |sqrt m - s|, s the rounded root of the midpoint m.
MECHKIN_INLINE Interval sqrt(Interval a) {
  const Real s = sqrt(a.midpoint), least = sqrt(narrowed(a.midpoint - a.radius));
  return {s, widened(a.radius / (least + s) + Real(UNIT_ROUNDOFF) * s + Real(LEAST))};
}

// a a, of one and the same number.
MECHKIN_INLINE Interval square(Interval a) {
  const Real m = a.midpoint * a.midpoint, size = abs(a.midpoint);
  return {m, widened(a.radius * ((size + size) + a.radius) + (Real(UNIT_ROUNDOFF) * m + Real(LEAST)))};
}

MECHKIN_INLINE Interval abs(Interval a) { return {abs(a.midpoint), a.radius}; }

// What rounds to the double x.
MECHKIN_INLINE Interval rounded(double x) { return {Real(x), widened(Real(UNIT_ROUNDOFF) * abs(Real(x)) + Real(LEAST))}; }

// Bounds of an interval from above and below.
MECHKIN_INLINE Real upper(Interval a) {
  const Real sum = a.midpoint + a.radius;
  return sum + (Real(2.0 * UNIT_ROUNDOFF) * abs(sum) + Real(LEAST));
}
MECHKIN_INLINE Real lower(Interval a) { return -upper(-a); }
// Largest size of a number of the interval.
MECHKIN_INLINE Real magnitude(Interval a) { return widened(abs(a.midpoint) + a.radius); }

// An interval that contains all from `low` to `high`; unknown if either is.
MECHKIN_INLINE Interval between(Real low, Real high) {
  const Real m = Real(0.5) * low + Real(0.5) * high;
  const Real above = high - m, below = m - low;
  const Real half = select(above > below, above, below) + (above - above) + (below - below);
  return {m, widened(half + Real(LEAST))};
}
MECHKIN_INLINE Interval hull(Interval a, Interval b) {
  const Real la = lower(a), lb = lower(b), ua = upper(a), ub = upper(b);
  // minimum and maximum of two numbers, unknown where either is
  const Real unknown = (la - la) + (lb - lb);
  return between(min(la, lb) + unknown, max(ua, ub) + unknown);
}
// The narrower of two enclosures of one and the same number, lane by lane.
MECHKIN_INLINE Interval narrower(Interval a, Interval b) {
  const Mask first = (a.radius <= b.radius) | ~(b.radius == b.radius);
  return {select(first, a.midpoint, b.midpoint), select(first, a.radius, b.radius)};
}

}  // namespace
