// sin, cos and atan2 of Taylor models, by the constant part and the series of the rest.
#pragma once

#include "arithmetic/inverse_trigonometric.hpp"
#include "arithmetic/taylor.hpp"
#include "arithmetic/trigonometric.hpp"

namespace {

// sin and cos of the kernel are off by less than 0.8 units in the last place.
constexpr double SINE_ERROR = 0x1p-52;

// sin(m + e) = sin m cos e + cos m sin e; series behind order K are smaller than their first term (Lagrange).
MECHKIN_MODEL void sincos(const Taylor& x, Taylor& s, Taylor& c) {
  Taylor e = x;
  e.c[0] = 0.0;
  const Taylor square = e * e;
  const Real size = bound(e);
  // coefficients of sin e / e and of cos e by powers of e^2, signs included
  Taylor sine = 0.0, cosine = 0.0;
  double factorial[ORDER + 3];
  factorial[0] = 1.0;
  for (int k = 1; k <= ORDER + 2; ++k) factorial[k] = factorial[k - 1] * k;
  constexpr int odd = ORDER >= 1 ? (ORDER - 1) / 2 * 2 + 1 : -1, even = ORDER / 2 * 2;
  for (int k = odd; k >= 1; k -= 2) {
    const double sign = k / 2 % 2 ? -1.0 : 1.0;
    const Real coefficient = sign / factorial[k];
    sine = sine * square + Taylor(coefficient, Real(HALF_PLACE) * abs(coefficient));
  }
  sine = sine * e;
  for (int k = even; k >= 0; k -= 2) {
    const double sign = k / 2 % 2 ? -1.0 : 1.0;
    const Real coefficient = sign / factorial[k];
    cosine = cosine * square + Taylor(coefficient, Real(HALF_PLACE) * abs(coefficient));
  }
  Real power[ORDER + 3];
  power[0] = 1.0;
  for (int k = 1; k <= ORDER + 2; ++k) power[k] = power[k - 1] * size * Real(OUTWARD);
  sine = widened(sine, power[odd + 2] / Real(factorial[odd + 2]) * Real(OUTWARD));
  cosine = widened(cosine, power[even + 2] / Real(factorial[even + 2]) * Real(OUTWARD));
  Real sin_middle, cos_middle;
  sincos(x.c[0], sin_middle, cos_middle);
  const Taylor sin_known = {sin_middle, Real(SINE_ERROR) * abs(sin_middle)},
               cos_known = {cos_middle, Real(SINE_ERROR) * abs(cos_middle)};
  s = sin_known * cosine + cos_known * sine;
  c = cos_known * cosine - sin_known * sine;
}

// The angle of (x, y), without a cut: m + atan(v / u), with m the middle's angle and (u, v) turned back by it.
MECHKIN_MODEL Taylor atan2(const Taylor& y, const Taylor& x) {
  const Real middle = atan2(y.c[0], x.c[0]);
  Taylor s, c;
  sincos(Taylor(middle), s, c);
  const Taylor u = x * c + y * s, e = (y * c - x * s) / u, square = e * e;
  const Real size = bound(e);
  constexpr int odd = ORDER >= 1 ? (ORDER - 1) / 2 * 2 + 1 : -1;
  Taylor sum = 0.0;
  for (int k = odd; k >= 1; k -= 2) {
    const Real coefficient = (k / 2 % 2 ? -1.0 : 1.0) / k;
    sum = sum * square + Taylor(coefficient, Real(HALF_PLACE) * abs(coefficient));
  }
  Real rest = size;
  for (int k = 1; k < odd + 2; ++k) rest = rest * size * Real(OUTWARD);
  // a rest of alternating terms that fall, and u > 0
  const Mask holds = (size < Real(1.0)) & (lower_bound(u) > Real(0.0));
  return Taylor(middle) + widened(sum * e, select(holds, rest, Real(__builtin_inf())));
}

}  // namespace
