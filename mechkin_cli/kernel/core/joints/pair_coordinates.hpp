// Coordinates of closing pairs with their derivatives from PairMotion::from to PairMotion::order, read off the frames A
// and B; `axes` are those of them that a coordinate reads.
#pragma once

#include "joints/closing_equations.hpp"

namespace {

// axis.d and its derivatives, for an axis carried by a link with motion m.
MECHKIN_APART void along(const Vec3& axis, const LinkMotion& m, const Closure& k, const PairMotion& p, Pack* out) {
  const Motion &a = p.a.motion, &b = p.b.motion;
  out[0] = dot(axis, k.d);
  if (p.order < 1) return;
  if (p.from < 2) out[1] = dot(axis, first_of_d(k, a, b)) + dot(m.motion.rate(axis), k.d);
  if (p.order < 2) return;
  out[2] = second_along(axis, m.motion, k, a, b);
  if (p.order < 3) return;
  out[3] = third_along(axis, m.to_jerk(), k, p.a.to_jerk(), p.b.to_jerk());
}
// Angle of B.X against A.X about the common axis, and its derivatives.
MECHKIN_APART void about(const Closure& k, const PairMotion& p, Pack* out) {
  const Motion& a = p.a.motion;
  if (p.from < 1) out[0] = atan2(dot(k.A.Y, k.B.X), dot(k.A.X, k.B.X));
  if (p.order < 1) return;
  if (p.from < 2) out[1] = dot(k.A.Z, p.relative_omega());
  if (p.order < 2) return;
  out[2] = dot(k.A.Z, p.relative_alpha()) + dot(a.rate(k.A.Z), p.relative_omega());
  if (p.order < 3) return;
  out[3] = dot(k.A.Z, p.relative_jerk()) + Pack(2.0) * dot(a.rate(k.A.Z), p.relative_alpha()) +
           dot(a.second_rate(k.A.Z), p.relative_omega());
}

// Turns about z_A, fixed in the first link, and then about z_B, fixed in the second; x_A = x_B square to both at home:
// B = Rz(theta1) Rx(angle of the axes) Rz(theta2). Rates from the dual basis of the two axes.
MECHKIN_APART void of_two_turns(const Closure& k, Pack c, const PairMotion& p, int turn, Pack* out) {
  const Pack scale = Pack(1.0) / (Pack(1.0) - c * c);
  const Pose &A = k.A, &B = k.B;
  if (p.from < 1) {
    const Pack sine = turn == 0 ? dot(A.X, B.Z) : dot(B.X, A.Z);
    out[0] = atan2(sine, turn == 0 ? -dot(A.Y, B.Z) : dot(B.Y, A.Z));
  }
  if (p.order < 1) return;
  const Vec3 one = turn == 0 ? A.Z : B.Z, other = turn == 0 ? B.Z : A.Z;
  const Motion &m = turn == 0 ? p.a.motion : p.b.motion, &n = turn == 0 ? p.b.motion : p.a.motion;
  const Vec3 dual = scale * (one - c * other);
  out[1] = dot(dual, p.relative_omega());
  if (p.order < 2) return;
  const Vec3 dual_rate = scale * (m.rate(one) - c * n.rate(other));
  out[2] = dot(dual, p.relative_alpha()) + dot(dual_rate, p.relative_omega());
  if (p.order < 3) return;
  const Vec3 dual_second = scale * (m.second_rate(one) - c * n.second_rate(other));
  out[3] = dot(dual, p.relative_jerk()) + Pack(2.0) * dot(dual_rate, p.relative_alpha()) +
           dot(dual_second, p.relative_omega());
}

// A freedom without a coordinate: the turns of a ball, the slides of a sphere on a plane.
struct Nameless {
  static constexpr unsigned axes = NO_AXES;
  static MECHKIN_INLINE void of(const Closure&, const PairMotion& p, Pack* out) {
    for (int order = 0; order <= p.order; ++order) out[order] = Pack(__builtin_nan(""));
  }
};
template <class Coordinate>
constexpr bool has_name = true;
template <>
constexpr bool has_name<Nameless> = false;

// Whether a coordinate is an angle; slides specialise it below.
template <class Coordinate>
constexpr bool is_turn = has_name<Coordinate>;

struct About {
  static constexpr unsigned axes = X_OF_A | Y_OF_A | Z_OF_A | X_OF_B;
  static MECHKIN_INLINE void of(const Closure& k, const PairMotion& p, Pack* out) { about(k, p, out); }
};
template <class U>
struct Along {
  static constexpr unsigned axes = U::axes;
  static MECHKIN_INLINE void of(const Closure& k, const PairMotion& p, Pack* out) {
    along(U::vector(k), U::of(p.a, p.b), k, p, out);
  }
};
template <class U>
constexpr bool is_turn<Along<U>> = false;

template <class Cosine>
struct FirstTurn {
  static constexpr unsigned axes = X_OF_A | Y_OF_A | Z_OF_A | Z_OF_B;
  static MECHKIN_INLINE void of(const Closure& k, const PairMotion& p, Pack* out) {
    of_two_turns(k, Cosine::value(k), p, 0, out);
  }
};
template <class Cosine>
struct SecondTurn {
  static constexpr unsigned axes = X_OF_B | Y_OF_B | Z_OF_A | Z_OF_B;
  static MECHKIN_INLINE void of(const Closure& k, const PairMotion& p, Pack* out) {
    of_two_turns(k, Cosine::value(k), p, 1, out);
  }
};

}  // namespace
