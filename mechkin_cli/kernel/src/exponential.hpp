// exp, log and pow of a pack, errors below 0.8, 0.51 and 0.8 units in the last place.
//
// exp: x = k ln 2 + r, |r| <= ln 2 / 2, exp r from the rational function of fdlibm (Sun Microsystems,
// 1993; e_exp.c). log: x = 2^k m with m in [sqrt 1/2, sqrt 2], log m = 2 artanh((m - 1) / (m + 1)), in
// double-double, so that pow = exp(y log x) keeps its last bit where y log x reaches 700.
#pragma once

#include "double_double.hpp"

namespace {

// 2^n for an integral n in [-1022, 1023].
MECHKIN_INLINE Pack power_of_two(Pack n) {
  return from_bits(shift_left(plus(bits(n + Pack(ROUNDER)), Words{} + 1023), 52));
}

// exp(high + low), |low| <= ulp(high); infinity from 709.79 on, 0 below -745.14, NaN for NaN.
MECHKIN_INLINE Pack exp_of_sum(Pack high, Pack low) {
  const Pack x = max(min(high, Pack(710.0)), Pack(-746.0));
  const Pack tail = select(x == high, low, Pack(0.0));
  const Pack k = nearest_integer(x * Pack(0x1.71547652b82fep+0));
  // ln 2 in two parts; the first has 32 bits, so that its product with k and the difference are exact
  const Pack hi = x - k * Pack(0x1.62e42fee00000p-1);
  const Pack lo = k * Pack(0x1.a39ef35793c76p-33) - tail;
  const Pack r = hi - lo, z = r * r;
  Pack p = Pack(4.13813679705723846039e-08);
  p = p * z + Pack(-1.65339022054652515390e-06);
  p = p * z + Pack(6.61375632143793436117e-05);
  p = p * z + Pack(-2.77777777770155933842e-03);
  p = p * z + Pack(1.66666666666666019037e-01);
  const Pack c = r - z * p;
  const Pack quotient = r * c / (Pack(2.0) - c);
  const DoubleDouble sum = fast_two_sum(Pack(1.0), hi);
  const Pack mantissa = sum.high + (sum.low + (quotient - lo));
  // two steps: 2^k alone leaves the range of doubles; only the second step can round
  const Pack k1 = nearest_integer(k * Pack(0.5));
  const Pack result = mantissa * power_of_two(k1) * power_of_two(k - k1);
  return select(high == high, result, high);
}

MECHKIN_INLINE Pack exp(Pack x) { return exp_of_sum(x, Pack(0.0)); }

// log x for finite x > 0, relative error below 2^-72.
MECHKIN_INLINE DoubleDouble log_parts(Pack x) {
  const Mask subnormal = x < Pack(0x1p-1022);
  const Words word = bits(select(subnormal, x * Pack(0x1p54), x));
  const Words biased = shift_right(minus(word, bits(Pack(0x1.6a09e667f3bcdp-1)) - bits(Pack(1.0))), 52);
  const Pack m = from_bits(minus(word, shift_left(minus(biased, Words{} + 1023), 52)));
  const Pack k = (from_bits(biased | bits(Pack(0x1p52))) - Pack(0x1p52 + 1023)) -
                 select(subnormal, Pack(54.0), Pack(0.0));

  const DoubleDouble s = DoubleDouble{m - Pack(1.0), Pack(0.0)} / two_sum(m, Pack(1.0));
  const DoubleDouble z = s * s;
  // artanh s = s (1 + z/3 + z^2/5 + ...); from z^4/9 on, below 2^-23, plain doubles are enough
  Pack p = Pack(1.0 / 27);
  p = p * z.high + Pack(1.0 / 25);
  p = p * z.high + Pack(1.0 / 23);
  p = p * z.high + Pack(1.0 / 21);
  p = p * z.high + Pack(1.0 / 19);
  p = p * z.high + Pack(1.0 / 17);
  p = p * z.high + Pack(1.0 / 15);
  p = p * z.high + Pack(1.0 / 13);
  p = p * z.high + Pack(1.0 / 11);
  p = p * z.high + Pack(1.0 / 9);
  DoubleDouble series = z * DoubleDouble{p, Pack(0.0)};
  series = DoubleDouble{Pack(0x1.2492492492492p-3), Pack(0x1.2492492492492p-57)} + series;  // 1/7
  series = DoubleDouble{Pack(0x1.999999999999ap-3), Pack(-0x1.999999999999ap-57)} + series * z;  // 1/5
  series = DoubleDouble{Pack(0x1.5555555555555p-2), Pack(0x1.5555555555555p-56)} + series * z;  // 1/3
  const DoubleDouble twice = {s.high + s.high, s.low + s.low};
  const DoubleDouble log_m = twice + twice * (series * z);

  // ln 2 in two parts; the first has 42 bits, so that its product with k is exact
  const DoubleDouble log_power =
      fast_two_sum(k * Pack(0x1.62e42fefa3800p-1), k * Pack(0x1.ef35793c76730p-45));
  return log_power + log_m;
}

// -infinity at 0, NaN below.
MECHKIN_INLINE Pack log(Pack x) {
  const Pack infinity = __builtin_inf();
  const DoubleDouble parts = log_parts(x);
  Pack result = parts.high + parts.low;
  result = select(x == Pack(0.0), -infinity, result);
  result = select(x < Pack(0.0), Pack(__builtin_nan("")), result);
  return select(x < infinity, result, x);
}

// Whether y is an integer, and an odd one; no infinity is odd.
struct Parity {
  Mask integer, odd;
};

MECHKIN_INLINE Mask is_integer(Pack magnitude) {
  const Pack limit = Pack(0x1p52);
  return (magnitude >= limit) | ((magnitude + limit) - limit == magnitude);
}

MECHKIN_INLINE Parity parity(Pack y) {
  const Mask integer = is_integer(abs(y));
  return {integer, integer & ~is_integer(Pack(0.5) * abs(y))};
}

// x^y with the special values of C (Annex F): pow(x, 0) = pow(1, y) = 1 even for NaN; a negative base
// needs an integral exponent.
MECHKIN_INLINE Pack pow(Pack x, Pack y) {
  const Pack infinity = __builtin_inf(), zero = Pack(0.0), one = Pack(1.0);
  const Pack base = abs(x);
  const Parity exponent = parity(y);

  // beyond 2^65 even the base nearest to 1 over- or underflows
  const Pack bounded = max(min(y, Pack(0x1p65)), Pack(-0x1p65));
  const DoubleDouble logarithm = log_parts(base);
  const DoubleDouble product = two_product(bounded, logarithm.high);
  Pack result = exp_of_sum(product.high, product.low + bounded * logarithm.low);

  const Mask falling = y < zero;
  result = select(base == zero, select(falling, infinity, zero), result);
  result = select(base == infinity, select(falling, zero, infinity), result);
  const Mask growing = ((base > one) & ~falling) | ((base < one) & falling);
  result = select(abs(y) == infinity, select(growing, infinity, zero), result);
  result = select((abs(y) == infinity) & (base == one), one, result);

  const Words sign = bits(x) & exponent.odd.w & (Words{} + INT64_MIN);
  result = from_bits(bits(result) ^ sign);
  const Mask undefined = (x < zero) & (base < infinity) & ~exponent.integer;
  result = select(undefined | ~(x == x) | ~(y == y), Pack(__builtin_nan("")), result);
  return select((y == zero) | (x == one), one, result);
}

}  // namespace
