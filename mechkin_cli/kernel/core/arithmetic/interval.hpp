// Intervals in lanes as midpoint and radius: every number x with |x - midpoint| <= radius. The midpoint is double-double.
//
// Rounding is to nearest throughout, and no mode is changed: a midpoint is what double-double gives, and the radius an upper
// bound of what the operands' radii and the rounding of the midpoint make of it (S. M. Rump, Fast and parallel interval
// arithmetic, BIT 39, 1999). What operations of midpoints are off is bounded in parts of their result, of sums of products in
// parts of the products' sizes (double_double.hpp; at least 1.5 times what is shown there). A bound is computed with at most
// nine roundings one after the other, each of which takes off at most 2^-53 of it; the factor WIDEN gives back what sixteen
// take, and with them the low part of a midpoint whose high part alone is counted. Sums are exact below the normal range.
// What products and quotients lose there is less than 2^-1071, and LEAST, added once, is more than all of it.
//
// A radius that is infinite or not a number says nothing of the value, not even that there is one, and neither does such a
// midpoint: so are the quotient by an interval that reaches zero, the root of one that reaches below it or is zero, and all
// that is computed of either. There is no comparison and no choice by values; what has to choose does so among doubles, and
// says why that is right.
#pragma once

#include "arithmetic/double_double_scalar.hpp"
#include "arithmetic/three_parts.hpp"

namespace {

constexpr double UNIT_ROUNDOFF = 0x1p-53;
// Of sums (3 u^2) and products (5 u^2), of quotients and roots (10 u^2), of sums of three products (40 u^2 of their sizes).
constexpr double SUM_ERROR = 0x1p-104, PRODUCT_ERROR = 0x1p-103, QUOTIENT_ERROR = 0x1p-98, PRODUCTS_ERROR = 0x1p-100;
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
  DoubleDouble midpoint;
  Real radius;
  Interval() = default;
  // The double itself. A decimal number or pi is none: see rounded().
  MECHKIN_INLINE Interval(double x) : midpoint(x), radius(0.0) {}
  MECHKIN_INLINE Interval(const DoubleDouble& m, Real r) : midpoint(m), radius(r) {}
  MECHKIN_INLINE explicit Interval(Real x) : midpoint(x), radius(0.0) {}
  MECHKIN_INLINE Interval(ThreeParts x) : midpoint(x.first, x.second), radius(x.radius) {}
  // Size of the midpoint, but for its low part.
  MECHKIN_INLINE Real size() const { return abs(midpoint.high); }
  MECHKIN_INLINE Interval& operator+=(const Interval& b);
  MECHKIN_INLINE Interval& operator-=(const Interval& b);
  MECHKIN_INLINE Interval& operator*=(const Interval& b);

  friend Mask operator<(const Interval&, const Interval&) = delete;
  friend Mask operator<=(const Interval&, const Interval&) = delete;
  friend Mask operator>(const Interval&, const Interval&) = delete;
  friend Mask operator>=(const Interval&, const Interval&) = delete;
  friend Mask operator==(const Interval&, const Interval&) = delete;
};
Interval select(Mask, const Interval&, const Interval&) = delete;

MECHKIN_INLINE Interval operator-(const Interval& a) { return {-a.midpoint, a.radius}; }

MECHKIN_INLINE Interval sum_of(const DoubleDouble& a, const DoubleDouble& b, Real spread) {
  const DoubleDouble m = accurate_sum(a, b);
  return {m, widened(spread + Real(SUM_ERROR) * abs(m.high))};
}
MECHKIN_APART Interval operator+(const Interval& a, const Interval& b) {
  return sum_of(a.midpoint, b.midpoint, a.radius + b.radius);
}
MECHKIN_APART Interval operator-(const Interval& a, const Interval& b) {
  return sum_of(a.midpoint, -b.midpoint, a.radius + b.radius);
}

// How far the radii move a product.
MECHKIN_INLINE Real product_spread(const Interval& a, const Interval& b) {
  return a.size() * b.radius + a.radius * (b.size() + b.radius);
}
MECHKIN_APART Interval operator*(const Interval& a, const Interval& b) {
  const DoubleDouble m = product(a.midpoint, b.midpoint);
  return {m, widened(product_spread(a, b) + (Real(PRODUCT_ERROR) * abs(m.high) + Real(LEAST)))};
}

// With q the rounded quotient of the midpoints, |x/y - q| <= (|x - m_x| + |q| |y - m_y| + |m_x - q m_y|) / |y|.
MECHKIN_APART Interval operator/(const Interval& a, const Interval& b) {
  const DoubleDouble q = quotient(a.midpoint, b.midpoint);
  const Real size = b.size(), least = narrowed(positive_or_zero(size - b.radius));
  const Real inverse = Real(1.0) / least + Real(LEAST);
  // what is left of a dividend below the normal range is lost
  const Real spread = (a.radius + Real(LEAST)) * inverse +
                      (abs(q.high) + Real(0x1p-1020)) * (b.radius * inverse + Real(QUOTIENT_ERROR) * (size * inverse));
  return {q, widened(spread + Real(LEAST))};
}

// x + a b, x - a b
MECHKIN_APART void add_product(Interval& x, const Interval& a, const Interval& b) {
  const Real sizes = x.size() + a.size() * b.size(), spread = x.radius + product_spread(a, b);
  add_product(x.midpoint, a.midpoint, b.midpoint);
  x.radius = widened(spread + (Real(PRODUCTS_ERROR) * sizes + Real(LEAST)));
}
MECHKIN_INLINE void subtract_product(Interval& x, const Interval& a, const Interval& b) { add_product(x, -a, b); }
// a b + c d + e f
MECHKIN_APART Interval sum_of_products(const Interval& a, const Interval& b, const Interval& c, const Interval& d,
                                       const Interval& e, const Interval& f) {
  const DoubleDouble m = sum_of_products(a.midpoint, b.midpoint, c.midpoint, d.midpoint, e.midpoint, f.midpoint);
  const Real sizes = a.size() * b.size() + c.size() * d.size() + e.size() * f.size();
  const Real spread = product_spread(a, b) + product_spread(c, d) + product_spread(e, f);
  return {m, widened(spread + (Real(PRODUCTS_ERROR) * sizes + Real(LEAST)))};
}
// a b - c d
MECHKIN_APART Interval difference_of_products(const Interval& a, const Interval& b, const Interval& c, const Interval& d) {
  const DoubleDouble m = difference_of_products(a.midpoint, b.midpoint, c.midpoint, d.midpoint);
  const Real sizes = a.size() * b.size() + c.size() * d.size(), spread = product_spread(a, b) + product_spread(c, d);
  return {m, widened(spread + (Real(PRODUCTS_ERROR) * sizes + Real(LEAST)))};
}

MECHKIN_INLINE Interval& Interval::operator+=(const Interval& b) { return *this = *this + b; }
MECHKIN_INLINE Interval& Interval::operator-=(const Interval& b) { return *this = *this - b; }
MECHKIN_INLINE Interval& Interval::operator*=(const Interval& b) { return *this = *this * b; }

// |sqrt x - s| <= |x - m| / (sqrt x + sqrt m) + |sqrt m - s|, s the rounded root of the midpoint m.
MECHKIN_INLINE Interval sqrt(const Interval& a) {
  const DoubleDouble s = sqrt(a.midpoint);
  const Real least = sqrt(narrowed(narrowed(a.midpoint.high) - a.radius));
  const Real spread = (a.radius + Real(LEAST)) / narrowed(least + s.high);
  return {s, widened(spread + Real(QUOTIENT_ERROR) * s.high + Real(LEAST))};
}

// a a, of one and the same number.
MECHKIN_INLINE Interval square(const Interval& a) {
  const DoubleDouble m = product(a.midpoint, a.midpoint);
  const Real size = a.size();
  return {m, widened(a.radius * ((size + size) + a.radius) + (Real(PRODUCT_ERROR) * m.high + Real(LEAST)))};
}

MECHKIN_INLINE Interval abs(const Interval& a) { return {abs(a.midpoint), a.radius}; }

// What rounds to the double x.
MECHKIN_INLINE Interval rounded(double x) { return {Real(x), widened(Real(UNIT_ROUNDOFF) * abs(Real(x)) + Real(LEAST))}; }

// Radius of the interval about the high part of its midpoint.
MECHKIN_INLINE Real radius_about_high(const Interval& a) { return widened(abs(a.midpoint.low) + a.radius); }
// Bounds of an interval from above and below.
MECHKIN_INLINE Real upper(const Interval& a) {
  const Real sum = a.midpoint.high + radius_about_high(a);
  return sum + (Real(2.0 * UNIT_ROUNDOFF) * abs(sum) + Real(LEAST));
}
MECHKIN_INLINE Real lower(const Interval& a) { return -upper(-a); }
// Largest size of a number of the interval.
MECHKIN_INLINE Real magnitude(const Interval& a) { return widened(a.size() + radius_about_high(a)); }

// An interval that contains all from `low` to `high`; unknown if either is.
MECHKIN_INLINE Interval between(Real low, Real high) {
  const Real m = Real(0.5) * low + Real(0.5) * high;
  const Real above = high - m, below = m - low;
  const Real half = select(above > below, above, below) + (above - above) + (below - below);
  return {DoubleDouble(m), widened(half + Real(LEAST))};
}
MECHKIN_INLINE Interval hull(const Interval& a, const Interval& b) {
  const Real la = lower(a), lb = lower(b), ua = upper(a), ub = upper(b);
  // minimum and maximum of two numbers, unknown where either is
  const Real unknown = (la - la) + (lb - lb);
  return between(min(la, lb) + unknown, max(ua, ub) + unknown);
}
// The narrower of two enclosures of one and the same number, lane by lane.
MECHKIN_INLINE Interval narrower(const Interval& a, const Interval& b) {
  const Mask first = (a.radius <= b.radius) | ~(b.radius == b.radius);
  return {select(first, a.midpoint, b.midpoint), select(first, a.radius, b.radius)};
}

}  // namespace
