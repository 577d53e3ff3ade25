// sincos, sin, cos, tan, atan2, atan, asin and acos in double-double; relative errors below 2e-31.
//
// sin and cos of a reduced angle from their Taylor series, whose last terms doubles hold. An angle is that of the doubles'
// atan2, turned to the point by the tangent of what is left of it.
#pragma once

#include "arithmetic/double_double_reduction.hpp"
#include "arithmetic/inverse_trigonometric.hpp"

namespace {

// c_0 + c_1 z + ... with `exact` in double-double and from there `rest` in doubles; terms fall by at least a half.
template <int EXACT, int REST>
MECHKIN_INLINE DoubleDouble series(const TwoParts (&exact)[EXACT], const double (&rest)[REST], const DoubleDouble& z) {
  Real tail = rest[REST - 1];
  for (int i = REST - 2; i >= 0; --i) tail = tail * z.high + Real(rest[i]);
  DoubleDouble sum = tail;
  for (int i = EXACT - 1; i >= 0; --i) sum = sum_to_larger(exact[i], product(sum, z));
  return sum;
}

// (-1)^k / (2 k + 1)! from k = 1 on
constexpr TwoParts SINE_TERMS[] = {{-0x1.5555555555555p-3, -0x1.5555555555555p-57},
                                   {0x1.1111111111111p-7, 0x1.1111111111111p-63},
                                   {-0x1.a01a01a01a01ap-13, -0x1.a01a01a01a01ap-73},
                                   {0x1.71de3a556c734p-19, -0x1.c154f8ddc6c00p-73},
                                   {-0x1.ae64567f544e4p-26, 0x1.c062e06d1f209p-80},
                                   {0x1.6124613a86d09p-33, 0x1.f28e0cc748ebep-87},
                                   {-0x1.ae7f3e733b81fp-41, -0x1.1d8656b0ee8cbp-97}};
constexpr double SINE_REST[] = {2.8114572543455206e-15, -8.22063524662433e-18,  1.9572941063391263e-20,
                                -3.868170170630684e-23, 6.446950284384474e-26,  -9.183689863795546e-29,
                                1.1309962886447716e-31};
// (-1)^k / (2 k)! from k = 2 on
constexpr TwoParts COSINE_TERMS[] = {{0x1.5555555555555p-5, 0x1.5555555555555p-59},
                                     {-0x1.6c16c16c16c17p-10, 0x1.f49f49f49f49fp-65},
                                     {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76},
                                     {-0x1.27e4fb7789f5cp-22, -0x1.cbbc05b4fa99ap-76},
                                     {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83},
                                     {-0x1.93974a8c07c9dp-37, -0x1.05d6f8a2efd1fp-92},
                                     {0x1.ae7f3e733b81fp-45, 0x1.1d8656b0ee8cbp-101}};
constexpr double COSINE_REST[] = {-1.5619206968586225e-16, 4.110317623312165e-19,  -8.896791392450574e-22,
                                  1.6117375710961184e-24,  -2.4795962632247976e-27, 3.279889237069838e-30};

MECHKIN_APART void sincos(const DoubleDouble& x, DoubleDouble& s, DoubleDouble& c) {
  const ReducedDoubleDouble angle = reduce_angle(x);
  const DoubleDouble r = angle.r, z = product(r, r), half = {Real(0.5) * z.high, Real(0.5) * z.low};
  const DoubleDouble sine = sum_to_larger(r, product(product(r, z), series(SINE_TERMS, SINE_REST, z)));
  const DoubleDouble bend = product(product(z, z), series(COSINE_TERMS, COSINE_REST, z));
  const DoubleDouble cosine = accurate_sum(accurate_sum(Real(1.0), -half), bend);
  const Words one = Words{} + 1, two = Words{} + 2, q = angle.quadrant;
  const Mask odd = mask_of(-(q & one));
  s = flipped(select(odd, cosine, sine), (q & two) << 62);
  c = flipped(select(odd, sine, cosine), ((q + one) & two) << 62);
}

inline DoubleDouble sin(const DoubleDouble& x) {
  DoubleDouble s, c;
  sincos(x, s, c);
  return s;
}
inline DoubleDouble cos(const DoubleDouble& x) {
  DoubleDouble s, c;
  sincos(x, s, c);
  return c;
}
inline DoubleDouble tan(const DoubleDouble& x) {
  DoubleDouble s, c;
  sincos(x, s, c);
  return s / c;
}

MECHKIN_INLINE DoubleDouble scaled(const DoubleDouble& a, Real by) { return {a.high * by, a.low * by}; }

// Angle of (x, y) in [-pi, pi]: theta + atan((y cos theta - x sin theta) / (x cos theta + y sin theta)).
MECHKIN_APART DoubleDouble atan2(const DoubleDouble& y, const DoubleDouble& x) {
  const Real larger = max(abs(x.high), abs(y.high)), theta = atan2(y.high, x.high);
  // products stay where they are exact
  const Real by = select(larger < Real(0x1p-300), Real(0x1p400), select(larger > Real(0x1p300), Real(0x1p-400), Real(1.0)));
  const DoubleDouble a = scaled(x, by), b = scaled(y, by);
  DoubleDouble s, c;
  sincos(DoubleDouble(theta), s, c);
  const Real across = (product(b, c) - product(a, s)).high, along = a.high * c.high + b.high * s.high;
  const Mask proper = (along > Real(0.0)) & is_finite(along);
  const Real rest = across / select(proper, along, Real(1.0));
  const DoubleDouble r = fast_two_sum(theta, rest);
  return {select(proper, r.high, theta), select(proper, r.low, Real(0.0))};
}

inline DoubleDouble atan(const DoubleDouble& x) { return atan2(x, DoubleDouble(1.0)); }

// The other side of a right triangle with hypotenuse 1; NaN beyond 1.
inline DoubleDouble other_side(const DoubleDouble& x) {
  return sqrt((DoubleDouble(1.0) - x) * (DoubleDouble(1.0) + x));
}
inline DoubleDouble asin(const DoubleDouble& x) { return atan2(x, other_side(x)); }
inline DoubleDouble acos(const DoubleDouble& x) { return atan2(other_side(x), x); }

}  // namespace
