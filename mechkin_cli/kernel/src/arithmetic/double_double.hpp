// Unevaluated sums of two doubles, high + low with |low| <= ulp(high) / 2.
//
// The error-free transformations of T. J. Dekker (Numerische Mathematik 18, 1971) and D. E. Knuth
// (The Art of Computer Programming, vol. 2, 4.2.2). Valid while nothing overflows or underflows;
// products need factors below 2^995.
#pragma once

#include "doubles.hpp"

namespace {

struct DoubleDouble {
  Real high, low;
};

// a + b exactly, for |a| >= |b| or a = 0.
MECHKIN_INLINE DoubleDouble fast_two_sum(Real a, Real b) {
  const Real sum = a + b;
  return {sum, b - (sum - a)};
}

// a + b exactly.
MECHKIN_INLINE DoubleDouble two_sum(Real a, Real b) {
  const Real sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

// a cut into two halves of 26 bits, the second signed (G. W. Veltkamp; Dekker, section 5).
MECHKIN_INLINE DoubleDouble split(Real a) {
  const Real scaled = a * Real(134217729.0);  // 2^27 + 1
  const Real high = scaled - (scaled - a);
  return {high, a - high};
}

// a * b exactly.
MECHKIN_INLINE DoubleDouble two_product(Real a, Real b) {
  const Real product = a * b;
  const DoubleDouble p = split(a), q = split(b);
  return {product, (((p.high * q.high - product) + p.high * q.low) + p.low * q.high) + p.low * q.low};
}

// Relative error below 2^-103 when the signs agree.
MECHKIN_INLINE DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble sum = two_sum(a.high, b.high);
  return fast_two_sum(sum.high, sum.low + (a.low + b.low));
}

// Relative error below 2^-100.
MECHKIN_INLINE DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

// Relative error below 2^-99.
MECHKIN_INLINE DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const Real quotient = a.high / b.high;
  const DoubleDouble back = two_product(quotient, b.high);
  const Real remainder = ((a.high - back.high) - back.low) + (a.low - quotient * b.low);
  return fast_two_sum(quotient, remainder / b.high);
}

}  // namespace
