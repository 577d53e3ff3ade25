// Unevaluated sums of two doubles, high + low with |low| <= ulp(high) / 2: about 32 digits.
//
// The error-free transformations of T. J. Dekker (Numerische Mathematik 18, 1971) and D. E. Knuth
// (The Art of Computer Programming, vol. 2, 4.2.2); sums, products and quotients as analysed by M. Joldes, J.-M. Muller
// and V. Popescu (Tight and rigorous error bounds for basic building blocks of double-word arithmetic, ACM Transactions
// on Mathematical Software 44, 2017). u = 2^-53.
//
// Valid while nothing overflows or underflows: factors below 2^995 and products above 2^-968, or zero. There the bits are
// the same whether an exact product is taken by a fused multiply-add or by splitting. An infinity in a sum or product
// leaves NaN; quotients, roots and the functions give one where doubles do. The sign of a zero is not kept.
#pragma once

#include "arithmetic/doubles.hpp"
#include "arithmetic/two_parts.hpp"

#if MECHKIN_FUSED
#include <immintrin.h>
#endif

namespace {

struct DoubleDouble {
  Real high, low;
  DoubleDouble() = default;
  MECHKIN_INLINE DoubleDouble(Real h, Real l) : high(h), low(l) {}
  MECHKIN_INLINE DoubleDouble(Real x) : high(x), low(0.0) {}
  MECHKIN_INLINE DoubleDouble(double x) : high(x), low(0.0) {}
  MECHKIN_INLINE DoubleDouble(TwoParts x) : high(x.first), low(x.second) {}
  MECHKIN_INLINE DoubleDouble& operator+=(const DoubleDouble& b);
  MECHKIN_INLINE DoubleDouble& operator-=(const DoubleDouble& b);
  MECHKIN_INLINE DoubleDouble& operator*=(const DoubleDouble& b);
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

// What a * b is more than `product`, its rounded value. MECHKIN_FUSED is of units that have the instruction.
MECHKIN_INLINE Real product_error(Real a, Real b, Real product) {
#if MECHKIN_FUSED && MECHKIN_LANES == 8
  return (Doubles)_mm512_fmsub_pd((__m512d)a.v, (__m512d)b.v, (__m512d)product.v);
#elif MECHKIN_FUSED && MECHKIN_LANES == 4
  return (Doubles)_mm256_fmsub_pd((__m256d)a.v, (__m256d)b.v, (__m256d)product.v);
#else
  const DoubleDouble p = split(a), q = split(b);
  return (((p.high * q.high - product) + p.high * q.low) + p.low * q.high) + p.low * q.low;
#endif
}

// a * b exactly.
MECHKIN_INLINE DoubleDouble two_product(Real a, Real b) {
  const Real product = a * b;
  return {product, product_error(a, b, product)};
}

// Of numbers whose signs agree, or of which one is at most half as large: relative error below 2^-102.
MECHKIN_INLINE DoubleDouble agreeing_sum(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = two_sum(a.high, b.high);
  return fast_two_sum(sum.high, sum.low + (a.low + b.low));
}

// The same for |a| >= |b|.
MECHKIN_INLINE DoubleDouble sum_to_larger(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = fast_two_sum(a.high, b.high);
  return fast_two_sum(sum.high, sum.low + (a.low + b.low));
}

// Relative error below 5 u^2.
MECHKIN_INLINE DoubleDouble product(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

// Relative error below 2^-99 (10 u^2 where no operand is near its limits).
MECHKIN_INLINE DoubleDouble quotient(const DoubleDouble& a, const DoubleDouble& b) {
  const Real quotient = a.high / b.high;
  const DoubleDouble back = two_product(quotient, b.high);
  const Real remainder = ((a.high - back.high) - back.low) + (a.low - quotient * b.low);
  return fast_two_sum(quotient, remainder / b.high);
}

}  // namespace
