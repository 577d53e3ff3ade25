// Double-double as the scalar of a unit: everything that `Real` can, with the same names.
//
// A sum is bounded whatever the signs are: |error| <= 3 u^2 |a + b| (Joldes, Muller and Popescu, algorithm 6), which
// closing equations need, for they cancel. Sums, products and quotients stand apart: inlined they would fill the module.
#pragma once

#include "arithmetic/double_double.hpp"

namespace {

MECHKIN_INLINE DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

MECHKIN_INLINE DoubleDouble accurate_sum(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high), low = two_sum(a.low, b.low);
  const DoubleDouble near = fast_two_sum(high.high, high.low + low.high);
  return fast_two_sum(near.high, low.low + near.low);
}
MECHKIN_APART DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) { return accurate_sum(a, b); }
MECHKIN_APART DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return accurate_sum(a, -b); }
MECHKIN_APART DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) { return product(a, b); }

MECHKIN_INLINE Mask is_finite(Real a) { return abs(a) < Real(__builtin_inf()); }

// With an infinity or zero where the doubles' quotient is one.
MECHKIN_APART DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const Real first = a.high / b.high;
  const DoubleDouble r = quotient(a, b);
  const Mask proper = is_finite(first) & is_finite(b.high);
  return {select(proper, r.high, first), select(proper, r.low, Real(0.0))};
}

// Sums of products at once, in which only the high parts' sums are exact: relative errors of a few u^2, measured by the
// sum of the products' magnitudes, as those of the products themselves are.

// What the low parts add to a * b beside the product of the high ones.
MECHKIN_INLINE Real mixed_products(const DoubleDouble& a, const DoubleDouble& b) { return a.high * b.low + a.low * b.high; }

// x + a b, x - a b
MECHKIN_APART void add_product(DoubleDouble& x, const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.high, b.high), sum = two_sum(x.high, p.high);
  x = two_sum(sum.high, sum.low + (x.low + (p.low + mixed_products(a, b))));
}
MECHKIN_APART void subtract_product(DoubleDouble& x, const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.high, b.high), sum = two_sum(x.high, -p.high);
  x = two_sum(sum.high, sum.low + (x.low - (p.low + mixed_products(a, b))));
}
// a b + c d + e f
MECHKIN_APART DoubleDouble sum_of_products(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                                           const DoubleDouble& d, const DoubleDouble& e, const DoubleDouble& f) {
  const DoubleDouble p = two_product(a.high, b.high), q = two_product(c.high, d.high), r = two_product(e.high, f.high);
  const DoubleDouble two = two_sum(p.high, q.high), three = two_sum(two.high, r.high);
  const Real low = (p.low + mixed_products(a, b)) + (q.low + mixed_products(c, d)) + (r.low + mixed_products(e, f));
  return two_sum(three.high, (two.low + three.low) + low);
}
// a b - c d
MECHKIN_APART DoubleDouble difference_of_products(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                                                  const DoubleDouble& d) {
  const DoubleDouble p = two_product(a.high, b.high), q = two_product(c.high, d.high), sum = two_sum(p.high, -q.high);
  return two_sum(sum.high, sum.low + ((p.low + mixed_products(a, b)) - (q.low + mixed_products(c, d))));
}

MECHKIN_INLINE DoubleDouble& DoubleDouble::operator+=(const DoubleDouble& b) { return *this = *this + b; }
MECHKIN_INLINE DoubleDouble& DoubleDouble::operator-=(const DoubleDouble& b) { return *this = *this - b; }
MECHKIN_INLINE DoubleDouble& DoubleDouble::operator*=(const DoubleDouble& b) { return *this = *this * b; }

// One step of Newton's method from the doubles' root (A. H. Karp and P. Markstein, High-precision division and square
// root, ACM Transactions on Mathematical Software 23, 1997): relative error below 4 u^2.
MECHKIN_APART DoubleDouble sqrt(const DoubleDouble& a) {
  const Real root = sqrt(a.high);
  const DoubleDouble back = two_product(root, root);
  const Real rest = ((a.high - back.high) - back.low) + a.low;
  const Mask proper = (root > Real(0.0)) & is_finite(root);
  const DoubleDouble r = fast_two_sum(root, rest / select(proper, root + root, Real(1.0)));
  return {select(proper, r.high, root), select(proper, r.low, Real(0.0))};
}

MECHKIN_INLINE Mask operator<(const DoubleDouble& a, const DoubleDouble& b) {
  return (a.high < b.high) | ((a.high == b.high) & (a.low < b.low));
}
MECHKIN_INLINE Mask operator<=(const DoubleDouble& a, const DoubleDouble& b) {
  return (a.high < b.high) | ((a.high == b.high) & (a.low <= b.low));
}
MECHKIN_INLINE Mask operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
MECHKIN_INLINE Mask operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }
MECHKIN_INLINE Mask operator==(const DoubleDouble& a, const DoubleDouble& b) {
  return (a.high == b.high) & (a.low == b.low);
}

MECHKIN_INLINE DoubleDouble select(Mask c, const DoubleDouble& a, const DoubleDouble& b) {
  return {select(c, a.high, b.high), select(c, a.low, b.low)};
}
MECHKIN_INLINE DoubleDouble max(const DoubleDouble& a, const DoubleDouble& b) { return select(a > b, a, b); }
MECHKIN_INLINE DoubleDouble min(const DoubleDouble& a, const DoubleDouble& b) { return select(a < b, a, b); }

// Both parts with the sign bits of `sign` changed.
MECHKIN_INLINE DoubleDouble flipped(const DoubleDouble& a, Words sign) {
  return {from_bits(bits(a.high) ^ sign), from_bits(bits(a.low) ^ sign)};
}
constexpr std::int64_t SIGN_BIT = INT64_MIN;
MECHKIN_INLINE DoubleDouble abs(const DoubleDouble& a) { return flipped(a, bits(a.high) & (Words{} + SIGN_BIT)); }
MECHKIN_INLINE DoubleDouble copysign(const DoubleDouble& a, const DoubleDouble& b) {
  return flipped(a, (bits(a.high) ^ bits(b.high)) & (Words{} + SIGN_BIT));
}

// For |a| < 2^51, ties to even.
MECHKIN_INLINE DoubleDouble nearest_integer(const DoubleDouble& a) {
  const Real near = nearest_integer(a.high), off = a.high - near, zero = 0.0;
  // the low part decides where the high one lies half way between two
  const Real up = select((off == Real(0.5)) & (a.low > zero), Real(1.0), zero);
  const Real down = select((off == Real(-0.5)) & (a.low < zero), Real(1.0), zero);
  return {near + (up - down), zero};
}

}  // namespace
