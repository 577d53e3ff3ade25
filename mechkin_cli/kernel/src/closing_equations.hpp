// What the closing equations of the pairs are made of, between the frame A on the first link and B on the second.
//
// Each constraint has its residual, its Jacobian column for a unit twist of B against A, its second derivative and
// the wrench it transmits; d = B.o - A.o. The Jacobian of an equation is the product of its wrench with that twist,
// exact where the joint is closed.
#pragma once

#include "tree_joints.hpp"

namespace {

// Frames of a closing joint in ground axes; `parameter` as in ClosingJoint.
struct Closure {
  Pose A, B;
  Vec3 d;
  Pack parameter;
};

// Motion of the two links and how many derivatives of a coordinate are wanted.
struct PairMotion {
  MotionToJerk a, b;
  int order;
  MECHKIN_INLINE Vec3 relative_omega() const { return b.velocity.angular - a.velocity.angular; }
  MECHKIN_INLINE Vec3 relative_alpha() const { return b.acceleration.angular - a.acceleration.angular; }
  MECHKIN_INLINE Vec3 relative_jerk() const { return b.jerk.angular - a.jerk.angular; }
};

// Derivatives of d.
MECHKIN_INLINE Vec3 first_of_d(const Closure& k, const Motion& a, const Motion& b) {
  return b.velocity.at(k.B.o) - a.velocity.at(k.A.o);
}
MECHKIN_INLINE Vec3 second_of_d(const Closure& k, const Motion& a, const Motion& b) {
  return b.point_acceleration(k.B.o) - a.point_acceleration(k.A.o);
}
MECHKIN_INLINE Vec3 third_of_d(const Closure& k, const MotionToJerk& a, const MotionToJerk& b) {
  return b.point_jerk(k.B.o) - a.point_jerk(k.A.o);
}
// Second derivative of axis.d for an axis carried by a link with motion m.
MECHKIN_INLINE Pack second_along(Vec3 axis, const Motion& m, const Closure& k, const Motion& a, const Motion& b) {
  return dot(axis, second_of_d(k, a, b)) + Pack(2.0) * dot(m.rate(axis), first_of_d(k, a, b)) +
         dot(m.second_rate(axis), k.d);
}
MECHKIN_INLINE Pack third_along(Vec3 axis, const MotionToJerk& m, const Closure& k, const MotionToJerk& a,
                               const MotionToJerk& b) {
  return dot(axis, third_of_d(k, a, b)) + Pack(3.0) * dot(m.rate(axis), second_of_d(k, a, b)) +
         Pack(3.0) * dot(m.second_rate(axis), first_of_d(k, a, b)) + dot(m.third_rate(axis), k.d);
}
// Third derivative of x.z for vectors carried by links with motions a and b.
MECHKIN_INLINE Pack third_of_product(Vec3 x, const MotionToJerk& a, Vec3 z, const MotionToJerk& b) {
  return dot(a.third_rate(x), z) + Pack(3.0) * dot(a.second_rate(x), b.rate(z)) +
         Pack(3.0) * dot(a.rate(x), b.second_rate(z)) + dot(x, b.third_rate(z));
}
// axis.d and its derivatives, for an axis carried by a link with motion m.
MECHKIN_INLINE void along(Vec3 axis, const MotionToJerk& m, const Closure& k, const PairMotion& p, Pack* out) {
  out[0] = dot(axis, k.d);
  if (p.order < 1) return;
  out[1] = dot(axis, first_of_d(k, p.a, p.b)) + dot(m.rate(axis), k.d);
  if (p.order < 2) return;
  out[2] = second_along(axis, m, k, p.a, p.b);
  if (p.order < 3) return;
  out[3] = third_along(axis, m, k, p.a, p.b);
}
// Angle of B.X against A.X about the common axis, and its derivatives.
MECHKIN_INLINE void about(const Closure& k, const PairMotion& p, Pack* out) {
  out[0] = atan2(dot(k.A.Y, k.B.X), dot(k.A.X, k.B.X));
  if (p.order < 1) return;
  out[1] = dot(k.A.Z, p.relative_omega());
  if (p.order < 2) return;
  out[2] = dot(k.A.Z, p.relative_alpha()) + dot(p.a.rate(k.A.Z), p.relative_omega());
  if (p.order < 3) return;
  out[3] = dot(k.A.Z, p.relative_jerk()) + Pack(2.0) * dot(p.a.rate(k.A.Z), p.relative_alpha()) +
           dot(p.a.second_rate(k.A.Z), p.relative_omega());
}

// d = 0: a common point, in ground axes.
struct CommonPoint {
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = k.d.x, r[1] = k.d.y, r[2] = k.d.z; }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    const Vec3 v = s.at(k.B.o);
    r[0] = v.x, r[1] = v.y, r[2] = v.z;
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 d2 = second_of_d(k, a, b);
    r[0] = d2.x, r[1] = d2.y, r[2] = d2.z;
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    const Vec3 d3 = third_of_d(k, a, b);
    r[0] = d3.x, r[1] = d3.y, r[2] = d3.z;
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) { return force_at(k.B.o, {l[0], l[1], l[2]}); }
};

// x_A.d = y_A.d = 0: B's origin on A's axis.
struct PointOnAxis {
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = dot(k.A.X, k.d), r[1] = dot(k.A.Y, k.d); }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    const Vec3 v = s.at(k.B.o);
    r[0] = dot(k.A.X, v), r[1] = dot(k.A.Y, v);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.A.X, a, k, a, b), r[1] = second_along(k.A.Y, a, k, a, b);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(k.A.X, a, k, a, b), r[1] = third_along(k.A.Y, a, k, a, b);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    return force_at(k.B.o, l[0] * k.A.X + l[1] * k.A.Y);
  }
};

// x_A.z_B = y_A.z_B = 0: parallel axes, with z_A.z_B > 0 beside them.
struct ParallelAxes {
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(k.A.X, k.B.Z);
    r[1] = dot(k.A.Y, k.B.Z);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    const Vec3 n = cross(k.B.Z, s.angular);  // omega.(z_B x x_A) = -x_A.(z_B x omega)
    r[0] = -dot(k.A.X, n);
    r[1] = -dot(k.A.Y, n);
  }
  static MECHKIN_INLINE Vec3 moment(const Closure& k, const Pack* l) {
    return cross(k.B.Z, l[0] * k.A.X + l[1] * k.A.Y);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 z1 = b.rate(k.B.Z), z2 = b.second_rate(k.B.Z);
    r[0] = dot(a.second_rate(k.A.X), k.B.Z) + Pack(2.0) * dot(a.rate(k.A.X), z1) + dot(k.A.X, z2);
    r[1] = dot(a.second_rate(k.A.Y), k.B.Z) + Pack(2.0) * dot(a.rate(k.A.Y), z1) + dot(k.A.Y, z2);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_of_product(k.A.X, a, k.B.Z, b), r[1] = third_of_product(k.A.Y, a, k.B.Z, b);
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return dot(k.A.Z, k.B.Z) > Pack(0.0); }
};

// Equal orientation: the rotation that carries A onto B, as a rotation vector in ground axes. Its skew part alone
// would vanish at half a turn as well and give false assemblies.
struct SameOrientation {
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    const Vec3 skew = Pack(0.5) * (cross(k.A.X, k.B.X) + cross(k.A.Y, k.B.Y) + cross(k.A.Z, k.B.Z));
    const Pack c = Pack(0.5) * (dot(k.A.X, k.B.X) + dot(k.A.Y, k.B.Y) + dot(k.A.Z, k.B.Z) - Pack(1.0));
    const Pack s = sqrt(dot(skew, skew));
    const Pack angle = atan2(s, c);
    // at exactly half a turn the axis is lost; any axis keeps the residual at pi
    const Mask tiny = s < Pack(1e-150);
    const Vec3 lost = {select(c < Pack(0.0), angle, Pack(0.0)), Pack(0.0), Pack(0.0)};
    const Vec3 e = select(tiny, lost, (angle / select(tiny, Pack(1.0), s)) * skew);
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE void column(Twist s, Pack* r) {
    r[0] = s.angular.x, r[1] = s.angular.y, r[2] = s.angular.z;
  }
  static MECHKIN_INLINE void second(const Motion& a, const Motion& b, Pack* r) {
    const Vec3 e = b.acceleration.angular - a.acceleration.angular;
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE void third(const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    const Vec3 e = b.jerk.angular - a.jerk.angular;
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE Vec3 moment(const Pack* l) { return {l[0], l[1], l[2]}; }
};

// Turns about z_A, fixed in the first link, and then about z_B, fixed in the second: z_A.z_B keeps its cosine.
// x_A = x_B square to both at home.
struct TwoTurns {
  static MECHKIN_INLINE void residual(const Closure& k, Pack cosine, Pack* r) { r[0] = dot(k.A.Z, k.B.Z) - cosine; }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    r[0] = dot(s.angular, cross(k.B.Z, k.A.Z));
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = dot(a.second_rate(k.A.Z), k.B.Z) + Pack(2.0) * dot(a.rate(k.A.Z), b.rate(k.B.Z)) +
           dot(k.A.Z, b.second_rate(k.B.Z));
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_of_product(k.A.Z, a, k.B.Z, b);
  }
  static MECHKIN_INLINE Vec3 moment(const Closure& k, const Pack* l) { return l[0] * cross(k.B.Z, k.A.Z); }
  // B = Rz(theta1) Rx(angle of the axes) Rz(theta2); rates from the dual basis of the two axes.
  static MECHKIN_INLINE void coordinate(const Closure& k, Pack c, const PairMotion& p, int turn, Pack* out) {
    const Pack scale = Pack(1.0) / (Pack(1.0) - c * c);
    const Pose &A = k.A, &B = k.B;
    out[0] = turn == 0 ? atan2(dot(A.X, B.Z), -dot(A.Y, B.Z)) : atan2(dot(B.X, A.Z), dot(B.Y, A.Z));
    if (p.order < 1) return;
    const Vec3 one = turn == 0 ? A.Z : B.Z, other = turn == 0 ? B.Z : A.Z;
    const Motion &m = turn == 0 ? p.a : p.b, &n = turn == 0 ? p.b : p.a;
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
};

}  // namespace
