// Taylor models: functions of one parameter t in [-1, 1], known as polynomials but for a radius.
//
//     f(t) in c_0 + c_1 t + ... + c_K t^K + [-radius, radius]   for every t
//
// Sums, products and quotients of enclosed functions are enclosed: what a polynomial of order K leaves out, and every
// rounding, goes into the radius (M. Berz, K. Makino, Verified integration of ODEs and flows using differential algebraic
// methods on high-order Taylor models, Reliable Computing 4, 1998). Nothing is compared: a model only evaluates. Where a
// value cannot be enclosed the radius is infinite or NaN, which no proof accepts. What is exactly zero stays so.
#pragma once

#include "arithmetic/doubles.hpp"
#include "arithmetic/two_parts.hpp"

#ifndef MECHKIN_ORDER
#define MECHKIN_ORDER 4
#endif

// Operations on models of more than a radius are long: inlined in all of a unit they would fill megabytes.
#if MECHKIN_ORDER > 0
#define MECHKIN_MODEL __attribute__((noinline))
#else
#define MECHKIN_MODEL MECHKIN_INLINE
#endif

namespace {

constexpr int ORDER = MECHKIN_ORDER;

// Half a unit in the last place of 1: a rounded result is off by at most this part of itself.
constexpr double HALF_PLACE = 0x1p-53;
// Radii are sums of at most a few dozen positive terms, each rounded: their relative error is far below this.
constexpr double OUTWARD = 1.0 + 0x1p-45;
// What a product may lose by underflow, with room for sums of a few dozen.
constexpr double UNDERFLOW_LOSS = 0x1p-1060;

struct Taylor {
  Real c[ORDER + 1];
  Real radius;

  Taylor() = default;
  MECHKIN_INLINE Taylor(Real value) : radius(0.0) {
    c[0] = value;
    for (int k = 1; k <= ORDER; ++k) c[k] = 0.0;
  }
  MECHKIN_INLINE Taylor(double value) : Taylor(Real(value)) {}
  MECHKIN_INLINE Taylor(Real middle, Real off) : Taylor(middle) { radius = off; }
  MECHKIN_INLINE Taylor(TwoParts value) : Taylor(Real(value.first), Real(value.second)) {}
};

// The largest of the polynomial's sizes over all t, but for rounding.
MECHKIN_INLINE Real polynomial_bound(const Taylor& a) {
  Real sum = abs(a.c[0]);
  for (int k = 1; k <= ORDER; ++k) sum += abs(a.c[k]);
  return sum;
}
// At least the largest size.
MECHKIN_INLINE Real bound(const Taylor& a) { return (polynomial_bound(a) + a.radius) * Real(OUTWARD); }

// At most the least value.
MECHKIN_INLINE Real lower_bound(const Taylor& a) {
  Real sum = a.radius;
  for (int k = 1; k <= ORDER; ++k) sum += abs(a.c[k]);
  return a.c[0] - (sum + Real(HALF_PLACE) * abs(a.c[0])) * Real(OUTWARD);
}

MECHKIN_MODEL Taylor operator-(const Taylor& a) {
  Taylor r;
  for (int k = 0; k <= ORDER; ++k) r.c[k] = -a.c[k];
  r.radius = a.radius;
  return r;
}
// A sum is exact where it is subnormal.
MECHKIN_MODEL Taylor operator+(const Taylor& a, const Taylor& b) {
  Taylor r;
  for (int k = 0; k <= ORDER; ++k) r.c[k] = a.c[k] + b.c[k];
  r.radius = (a.radius + b.radius + Real(HALF_PLACE) * polynomial_bound(r)) * Real(OUTWARD);
  return r;
}
MECHKIN_MODEL Taylor operator-(const Taylor& a, const Taylor& b) { return a + (-b); }

// What products of polynomials and radii of these sizes may lose by underflow; nothing where a factor is zero.
MECHKIN_INLINE Real lost_below(Real a, Real b) {
  const Real zero = 0.0;
  return select((a > zero) & (b > zero), Real(UNDERFLOW_LOSS), zero);
}

MECHKIN_MODEL Taylor scaled(Real s, const Taylor& a) {
  Taylor r;
  for (int k = 0; k <= ORDER; ++k) r.c[k] = s * a.c[k];
  const Real size = abs(s);
  r.radius = (size * a.radius + Real(HALF_PLACE) * polynomial_bound(r)) * Real(OUTWARD) +
             lost_below(size, polynomial_bound(a) + a.radius);
  return r;
}

MECHKIN_MODEL Taylor operator*(const Taylor& a, const Taylor& b) {
  Taylor r;
  for (int k = 0; k <= ORDER; ++k) {
    Real sum = a.c[0] * b.c[k];
    for (int i = 1; i <= k; ++i) sum += a.c[i] * b.c[k - i];
    r.c[k] = sum;
  }
  // |b_k| + ... + |b_K|
  Real tail[ORDER + 2];
  tail[ORDER + 1] = 0.0;
  for (int k = ORDER; k >= 0; --k) tail[k] = tail[k + 1] + abs(b.c[k]);
  Real size = abs(a.c[0]), beyond = 0.0;
  for (int k = 1; k <= ORDER; ++k) {
    const Real part = abs(a.c[k]);
    size += part;
    beyond += part * tail[ORDER + 1 - k];
  }
  const Real rounding = Real((ORDER + 1) * HALF_PLACE) * size * tail[0];
  r.radius = (beyond + rounding + a.radius * (tail[0] + b.radius) + size * b.radius) * Real(OUTWARD) +
             lost_below(size + a.radius, tail[0] + b.radius);
  return r;
}
MECHKIN_INLINE Taylor& operator+=(Taylor& a, const Taylor& b) { return a = a + b; }
MECHKIN_INLINE Taylor& operator-=(Taylor& a, const Taylor& b) { return a = a - b; }
MECHKIN_INLINE Taylor& operator*=(Taylor& a, const Taylor& b) { return a = a * b; }

// A radius that is added.
MECHKIN_INLINE Taylor widened(Taylor a, Real by) {
  a.radius = (a.radius + by) * Real(OUTWARD);
  return a;
}

// sum of f_k e^k, k = 0 ... K.
MECHKIN_MODEL Taylor power_series(const double* f, const Taylor& e) {
  Taylor sum = f[ORDER];
  for (int k = ORDER - 1; k >= 0; --k) sum = sum * e + Taylor(f[k]);
  return sum;
}
// d^(K+1)
MECHKIN_INLINE Real next_power(Real d) {
  Real power = d;
  for (int k = 0; k < ORDER; ++k) power *= d;
  return power;
}
// The rest of a power series with falling coefficients behind order K, where d < 1 bounds its argument.
MECHKIN_INLINE Real geometric_rest(Real d) {
  return select(d < Real(1.0), next_power(d) / (Real(1.0) - d) * Real(OUTWARD), Real(__builtin_inf()));
}

// 1 / b = i / (1 - e) with i = 1 / b_0 rounded and e = 1 - i b.
MECHKIN_MODEL Taylor inverse(const Taylor& b) {
  double ones[ORDER + 1];
  for (double& one : ones) one = 1.0;
  const Real i = Real(1.0) / b.c[0];
  const Taylor e = Taylor(1.0) - scaled(i, b);
  return scaled(i, widened(power_series(ones, e), geometric_rest(bound(e))));
}
MECHKIN_INLINE Taylor operator/(const Taylor& a, const Taylor& b) { return a * inverse(b); }

// sqrt a = sqrt(a_0) sqrt(1 + e), 1 + e = a / a_0.
MECHKIN_MODEL Taylor sqrt(const Taylor& a) {
  double binomial[ORDER + 2];
  binomial[0] = 1.0;
  for (int k = 1; k <= ORDER + 1; ++k) binomial[k] = binomial[k - 1] * (1.5 - k) / k;  // exact: few bits
  const Taylor e = scaled(Real(1.0) / a.c[0], a) - Taylor(1.0);
  const double next = binomial[ORDER + 1] < 0 ? -binomial[ORDER + 1] : binomial[ORDER + 1];
  const Real root = sqrt(a.c[0]);
  // 1 / a_0 was rounded, and its root
  const Taylor factor = {root, Real(4 * HALF_PLACE) * root};
  return factor * widened(power_series(binomial, e), Real(next) * geometric_rest(bound(e)));
}

// Enough for every order up to this one.
static_assert(ORDER <= 8, "binomial coefficients are exact doubles up to here");

}  // namespace
