// exp, log and pow in double-double; relative errors below 2e-31, of pow that many times 1 + |y log x|.
//
// exp: x = k ln 2 + r with |r| <= ln 2 / 2, and Taylor's series. log: x = 2^k m with m in [sqrt 1/2, sqrt 2],
// log m = 2 artanh((m - 1) / (m + 1)). Where the doubles' function is zero, infinite or no number, so is this one. Parts
// below 2^-1022 round as doubles there do, so that results below 2^-916 have fewer digits.
#pragma once

#include "arithmetic/double_double_trigonometric.hpp"
#include "arithmetic/exponential.hpp"

namespace {

constexpr TwoParts EXPONENTIAL_TERMS[] = {
    {0x1.0000000000000p-1, 0x0.0p+0},
    {0x1.5555555555555p-3, 0x1.5555555555555p-57},
    {0x1.5555555555555p-5, 0x1.5555555555555p-59},
    {0x1.1111111111111p-7, 0x1.1111111111111p-63},
    {0x1.6c16c16c16c17p-10, -0x1.f49f49f49f49fp-65},
    {0x1.a01a01a01a01ap-13, 0x1.a01a01a01a01ap-73},
    {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76},
    {0x1.71de3a556c734p-19, -0x1.c154f8ddc6c00p-73},
    {0x1.27e4fb7789f5cp-22, 0x1.cbbc05b4fa99ap-76},
    {0x1.ae64567f544e4p-26, -0x1.c062e06d1f209p-80},
    {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83}};
constexpr double EXPONENTIAL_REST[] = {1.6059043836821613e-10, 1.1470745597729725e-11, 7.647163731819816e-13,
                                       4.779477332387385e-14,  2.8114572543455206e-15, 1.5619206968586225e-16,
                                       8.22063524662433e-18,   4.110317623312165e-19,  1.9572941063391263e-20,
                                       8.896791392450574e-22,  3.868170170630684e-23,  1.6117375710961184e-24};

MECHKIN_APART DoubleDouble exp(const DoubleDouble& x) {
  const Real plain = exp(x.high);
  const Real bounded = max(min(x.high, Real(710.0)), Real(-746.0));
  const Real k = nearest_integer(bounded * Real(0x1.71547652b82fep+0));
  // ln 2 in three parts, of which two have 42 bits, so that their products with k are exact
  const Real first = bounded - k * Real(0x1.62e42fefa3800p-1);
  const DoubleDouble rest = two_sum(-(k * Real(0x1.ef35793c76000p-45)), -(k * Real(0x1.cc01f97b57a08p-87)));
  const DoubleDouble r = accurate_sum(two_sum(first, x.low), rest);
  const DoubleDouble bend = product(product(r, r), series(EXPONENTIAL_TERMS, EXPONENTIAL_REST, r));
  const DoubleDouble mantissa = accurate_sum(Real(1.0), accurate_sum(r, bend));
  const Real k1 = nearest_integer(k * Real(0.5)), half = power_of_two(k1), other = power_of_two(k - k1);
  const DoubleDouble result = {mantissa.high * half * other, mantissa.low * half * other};
  const Mask proper = (plain > Real(0.0)) & is_finite(plain);
  return {select(proper, result.high, plain), select(proper, result.low, Real(0.0))};
}

// 1 / (2 k + 1) from k = 1 on
constexpr TwoParts LOGARITHM_TERMS[] = {{0x1.5555555555555p-2, 0x1.5555555555555p-56},
                                        {0x1.999999999999ap-3, -0x1.999999999999ap-57},
                                        {0x1.2492492492492p-3, 0x1.2492492492492p-57},
                                        {0x1.c71c71c71c71cp-4, 0x1.c71c71c71c71cp-58},
                                        {0x1.745d1745d1746p-4, -0x1.745d1745d1746p-59},
                                        {0x1.3b13b13b13b14p-4, -0x1.3b13b13b13b14p-58},
                                        {0x1.1111111111111p-4, 0x1.1111111111111p-60},
                                        {0x1.e1e1e1e1e1e1ep-5, 0x1.e1e1e1e1e1e1ep-61},
                                        {0x1.af286bca1af28p-5, 0x1.af286bca1af28p-59},
                                        {0x1.8618618618618p-5, 0x1.8618618618618p-59}};
constexpr double LOGARITHM_REST[] = {1.0 / 23, 1.0 / 25, 1.0 / 27, 1.0 / 29, 1.0 / 31, 1.0 / 33,
                                     1.0 / 35, 1.0 / 37, 1.0 / 39, 1.0 / 41, 1.0 / 43};

MECHKIN_APART DoubleDouble log(const DoubleDouble& x) {
  const Real plain = log(x.high);
  const Mask subnormal = x.high < Real(0x1p-1022);
  const DoubleDouble lifted = {select(subnormal, x.high * Real(0x1p54), x.high), select(subnormal, x.low * Real(0x1p54), x.low)};
  const Words word = bits(lifted.high);
  const Words biased = shift_right(minus(word, bits(Real(0x1.6a09e667f3bcdp-1)) - bits(Real(1.0))), 52);
  const Real exponent = from_bits(biased | bits(Real(0x1p52))) - Real(0x1p52 + 1023);
  const Real k1 = nearest_integer(exponent * Real(0.5)), half = power_of_two(-k1), other = power_of_two(k1 - exponent);
  const DoubleDouble m = {lifted.high * half * other, lifted.low * half * other};
  const Real k = exponent - select(subnormal, Real(54.0), Real(0.0));

  const DoubleDouble s = accurate_sum(m, Real(-1.0)) / accurate_sum(m, Real(1.0)), z = product(s, s);
  const DoubleDouble twice = {s.high + s.high, s.low + s.low};
  const DoubleDouble log_m = sum_to_larger(twice, product(product(twice, z), series(LOGARITHM_TERMS, LOGARITHM_REST, z)));
  const DoubleDouble first = k * Real(0x1.62e42fefa3800p-1), second = k * Real(0x1.ef35793c76000p-45);
  const DoubleDouble power = accurate_sum(first, accurate_sum(second, k * Real(0x1.cc01f97b57a08p-87)));
  const DoubleDouble result = accurate_sum(power, log_m);
  const Mask proper = (x.high > Real(0.0)) & is_finite(x.high);
  return {select(proper, result.high, plain), select(proper, result.low, Real(0.0))};
}

MECHKIN_APART DoubleDouble pow(const DoubleDouble& x, const DoubleDouble& y) {
  const Real plain = pow(x.high, y.high), base = abs(x.high);
  const DoubleDouble result = copysign(exp(y * log(abs(x))), plain);
  const Mask proper = (base > Real(0.0)) & is_finite(base) & is_finite(y.high) & (abs(plain) > Real(0.0)) & is_finite(plain);
  const Mask no_integer = (x.high < Real(0.0)) & ~(y.low == Real(0.0)) & (abs(y.high) < Real(0x1p53));
  const Real value = select(no_integer, Real(__builtin_nan("")), select(proper, result.high, plain));
  return {value, select(proper & ~no_integer, result.low, Real(0.0))};
}

}  // namespace
