// exp, log and pow of doubles, errors below 0.8, 0.51 and 0.8 units in the last place.
//
// exp: x = k ln 2 + r, |r| <= ln 2 / 2, exp r from the rational function of fdlibm (Sun Microsystems,
// 1993; e_exp.c). log: x = 2^k m with m in [sqrt 1/2, sqrt 2], log m = 2 artanh((m - 1) / (m + 1)), in
// double-double, so that pow = exp(y log x) keeps its last bit where y log x reaches 700.
#pragma once

#include "arithmetic/double_double.hpp"

namespace {

// 2^n for an integral n in [-1022, 1023].
MECHKIN_INLINE Real power_of_two(Real n) {
  return from_bits(shift_left(plus(bits(n + Real(ROUNDER)), Words{} + 1023), 52));
}

// exp(high + low), |low| <= ulp(high); infinity from 709.79 on, 0 below -745.14, NaN for NaN.
MECHKIN_INLINE Real exp_of_sum(Real high, Real low) {
  const Real x = max(min(high, Real(710.0)), Real(-746.0));
  const Real tail = select(x == high, low, Real(0.0));
  const Real k = nearest_integer(x * Real(0x1.71547652b82fep+0));
  // ln 2 in two parts; the first has 32 bits, so that its product with k and the difference are exact
  const Real hi = x - k * Real(0x1.62e42fee00000p-1);
  const Real lo = k * Real(0x1.a39ef35793c76p-33) - tail;
  const Real r = hi - lo, z = r * r;
  Real p = Real(4.13813679705723846039e-08);
  p = p * z + Real(-1.65339022054652515390e-06);
  p = p * z + Real(6.61375632143793436117e-05);
  p = p * z + Real(-2.77777777770155933842e-03);
  p = p * z + Real(1.66666666666666019037e-01);
  const Real c = r - z * p;
  const Real quotient = r * c / (Real(2.0) - c);
  const DoubleDouble sum = fast_two_sum(Real(1.0), hi);
  const Real mantissa = sum.high + (sum.low + (quotient - lo));
  // two steps: 2^k alone leaves the range of doubles; only the second step can round
  const Real k1 = nearest_integer(k * Real(0.5));
  const Real result = mantissa * power_of_two(k1) * power_of_two(k - k1);
  return select(high == high, result, high);
}

MECHKIN_INLINE Real exp(Real x) { return exp_of_sum(x, Real(0.0)); }

// log x for finite x > 0, relative error below 2^-72.
MECHKIN_INLINE DoubleDouble log_parts(Real x) {
  const Mask subnormal = x < Real(0x1p-1022);
  const Words word = bits(select(subnormal, x * Real(0x1p54), x));
  const Words biased = shift_right(minus(word, bits(Real(0x1.6a09e667f3bcdp-1)) - bits(Real(1.0))), 52);
  const Real m = from_bits(minus(word, shift_left(minus(biased, Words{} + 1023), 52)));
  const Real k = (from_bits(biased | bits(Real(0x1p52))) - Real(0x1p52 + 1023)) -
                 select(subnormal, Real(54.0), Real(0.0));

  const DoubleDouble s = quotient({m - Real(1.0), Real(0.0)}, two_sum(m, Real(1.0)));
  const DoubleDouble z = product(s, s);
  // artanh s = s (1 + z/3 + z^2/5 + ...); from z^4/9 on, below 2^-23, plain doubles are enough
  Real p = Real(1.0 / 27);
  p = p * z.high + Real(1.0 / 25);
  p = p * z.high + Real(1.0 / 23);
  p = p * z.high + Real(1.0 / 21);
  p = p * z.high + Real(1.0 / 19);
  p = p * z.high + Real(1.0 / 17);
  p = p * z.high + Real(1.0 / 15);
  p = p * z.high + Real(1.0 / 13);
  p = p * z.high + Real(1.0 / 11);
  p = p * z.high + Real(1.0 / 9);
  DoubleDouble series = product(z, {p, Real(0.0)});
  series = agreeing_sum({Real(0x1.2492492492492p-3), Real(0x1.2492492492492p-57)}, series);  // 1/7
  series = agreeing_sum({Real(0x1.999999999999ap-3), Real(-0x1.999999999999ap-57)}, product(series, z));  // 1/5
  series = agreeing_sum({Real(0x1.5555555555555p-2), Real(0x1.5555555555555p-56)}, product(series, z));  // 1/3
  const DoubleDouble twice = {s.high + s.high, s.low + s.low};
  const DoubleDouble log_m = agreeing_sum(twice, product(twice, product(series, z)));

  // ln 2 in two parts; the first has 42 bits, so that its product with k is exact
  const DoubleDouble log_power =
      fast_two_sum(k * Real(0x1.62e42fefa3800p-1), k * Real(0x1.ef35793c76730p-45));
  return agreeing_sum(log_power, log_m);
}

// -infinity at 0, NaN below.
MECHKIN_INLINE Real log(Real x) {
  const Real infinity = __builtin_inf();
  const DoubleDouble parts = log_parts(x);
  Real result = parts.high + parts.low;
  result = select(x == Real(0.0), -infinity, result);
  result = select(x < Real(0.0), Real(__builtin_nan("")), result);
  return select(x < infinity, result, x);
}

// Whether y is an integer, and an odd one; no infinity is odd.
struct Parity {
  Mask integer, odd;
};

MECHKIN_INLINE Mask is_integer(Real magnitude) {
  const Real limit = Real(0x1p52);
  return (magnitude >= limit) | ((magnitude + limit) - limit == magnitude);
}

MECHKIN_INLINE Parity parity(Real y) {
  const Mask integer = is_integer(abs(y));
  return {integer, integer & ~is_integer(Real(0.5) * abs(y))};
}

// x^y with the special values of C (Annex F): pow(x, 0) = pow(1, y) = 1 even for NaN; a negative base
// needs an integral exponent.
MECHKIN_INLINE Real pow(Real x, Real y) {
  const Real infinity = __builtin_inf(), zero = Real(0.0), one = Real(1.0);
  const Real base = abs(x);
  const Parity exponent = parity(y);

  // beyond 2^65 even the base nearest to 1 over- or underflows
  const Real bounded = max(min(y, Real(0x1p65)), Real(-0x1p65));
  const DoubleDouble logarithm = log_parts(base);
  const DoubleDouble product = two_product(bounded, logarithm.high);
  Real result = exp_of_sum(product.high, product.low + bounded * logarithm.low);

  const Mask falling = y < zero;
  result = select(base == zero, select(falling, infinity, zero), result);
  result = select(base == infinity, select(falling, zero, infinity), result);
  const Mask growing = ((base > one) & ~falling) | ((base < one) & falling);
  result = select(abs(y) == infinity, select(growing, infinity, zero), result);
  result = select((abs(y) == infinity) & (base == one), one, result);

  const Words sign = bits(x) & words(exponent.odd) & (Words{} + INT64_MIN);
  result = from_bits(bits(result) ^ sign);
  const Mask undefined = (x < zero) & (base < infinity) & ~exponent.integer;
  result = select(undefined | ~(x == x) | ~(y == y), Real(__builtin_nan("")), result);
  return select((y == zero) | (x == one), one, result);
}

}  // namespace
