// The joint table: everything the kernel knows about a pair stands in its one entry.
//
// `parts` tells the pair as a chain of tree displacements from the first link to the second, `coordinates` the
// names of its freedoms in that order (- for one without a name). As a closing joint a pair has 6 - f
// equations between the frame A on the first link and B on the second, their derivatives, the wrenches it
// transmits, its coordinates, and the side condition that tells an assembly from a false root of the equations.
//
// Equations that are lengths come first, then angles; d = B.o - A.o. The Jacobian of an equation is the product of
// its wrench with the relative twist of B against A, exact where the joint is closed.
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

struct Pair {
  static constexpr int equations = 0, lengths = 0;
  static MECHKIN_INLINE Mask side(const Closure&) { return all_lanes(true); }
  static MECHKIN_INLINE void coordinate(const Closure&, const PairMotion&, int, Pack*) {}
};

struct Revolute : Pair {
  static constexpr char letter[] = "R", parts[] = "R", coordinates[] = "theta";
  static constexpr int equations = 5, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    CommonPoint::residual(k, r);
    ParallelAxes::residual(k, r + 3);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    CommonPoint::column(k, s, r);
    ParallelAxes::column(k, s, r + 3);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
    ParallelAxes::second(k, a, b, r + 3);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
    ParallelAxes::third(k, a, b, r + 3);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = CommonPoint::wrench(k, l);
    w.moment += ParallelAxes::moment(k, l + 3);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int, Pack* out) { about(k, p, out); }
};

struct Prismatic : Pair {
  static constexpr char letter[] = "P", parts[] = "P", coordinates[] = "s";
  static constexpr int equations = 5, lengths = 2;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    PointOnAxis::residual(k, r);
    SameOrientation::residual(k, r + 2);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    PointOnAxis::column(k, s, r);
    SameOrientation::column(s, r + 2);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    PointOnAxis::second(k, a, b, r);
    SameOrientation::second(a, b, r + 2);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    PointOnAxis::third(k, a, b, r);
    SameOrientation::third(a, b, r + 2);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = PointOnAxis::wrench(k, l);
    w.moment += SameOrientation::moment(l + 2);
    return w;
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int, Pack* out) {
    along(k.A.Z, p.a, k, p, out);
  }
};

// H closes no loop: its turn count would be lost. Its s is its theta times the pitch.
struct Helical : Pair {
  static constexpr char letter[] = "H", parts[] = "H", coordinates[] = "theta";
};

struct Cylindric : Pair {
  static constexpr char letter[] = "C", parts[] = "C", coordinates[] = "theta s";
  static constexpr int equations = 4, lengths = 2;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    PointOnAxis::residual(k, r);
    ParallelAxes::residual(k, r + 2);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    PointOnAxis::column(k, s, r);
    ParallelAxes::column(k, s, r + 2);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    PointOnAxis::second(k, a, b, r);
    ParallelAxes::second(k, a, b, r + 2);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    PointOnAxis::third(k, a, b, r);
    ParallelAxes::third(k, a, b, r + 2);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = PointOnAxis::wrench(k, l);
    w.moment += ParallelAxes::moment(k, l + 2);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    if (freedom == 0) return about(k, p, out);
    along(k.A.Z, p.a, k, p, out);
  }
};

struct Spheric : Pair {
  static constexpr char letter[] = "S", parts[] = "S", coordinates[] = "- - -";
  static constexpr int equations = 3, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { CommonPoint::residual(k, r); }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) { CommonPoint::column(k, s, r); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) { return CommonPoint::wrench(k, l); }
};

// Sphere A.o of the first link on the plane square to z_B through B.o of the second.
struct SphereOnPlane : Pair {
  static constexpr char letter[] = "Sp", parts[] = "SPP", coordinates[] = "- - - - -";
  static constexpr int equations = 1, lengths = 1;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = dot(k.B.Z, k.d); }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) { r[0] = dot(k.B.Z, s.at(k.A.o)); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.B.Z, b, k, a, b);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(k.B.Z, b, k, a, b);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) { return force_at(k.A.o, l[0] * k.B.Z); }
};

// Sphere A.o of the first link in the groove along z_B through B.o of the second: R - R' = z_B s.
struct SphereInGroove : Pair {
  static constexpr char letter[] = "Sg", parts[] = "SP", coordinates[] = "- - - s";
  static constexpr int equations = 2, lengths = 2;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = dot(k.B.X, k.d), r[1] = dot(k.B.Y, k.d); }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    const Vec3 v = s.at(k.A.o);
    r[0] = dot(k.B.X, v), r[1] = dot(k.B.Y, v);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.B.X, b, k, a, b), r[1] = second_along(k.B.Y, b, k, a, b);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(k.B.X, b, k, a, b), r[1] = third_along(k.B.Y, b, k, a, b);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    return force_at(k.A.o, l[0] * k.B.X + l[1] * k.B.Y);
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int, Pack* out) {
    along(-k.B.Z, p.b, k, p, out);
  }
};

// Hooke joint: z_A fixed in the first link, z_B in the second, x_A = x_B square to both at home;
// the parameter is the cosine of the angle between the axes, which stays.
struct Universal : Pair {
  static constexpr char letter[] = "U", parts[] = "RR", coordinates[] = "theta1 theta2";
  static constexpr int equations = 4, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    CommonPoint::residual(k, r);
    r[3] = dot(k.A.Z, k.B.Z) - k.parameter;
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    CommonPoint::column(k, s, r);
    r[3] = dot(s.angular, cross(k.B.Z, k.A.Z));
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
    r[3] = dot(a.second_rate(k.A.Z), k.B.Z) + Pack(2.0) * dot(a.rate(k.A.Z), b.rate(k.B.Z)) +
           dot(k.A.Z, b.second_rate(k.B.Z));
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
    r[3] = third_of_product(k.A.Z, a, k.B.Z, b);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = CommonPoint::wrench(k, l);
    w.moment += l[3] * cross(k.B.Z, k.A.Z);
    return w;
  }
  // B = Rz(theta1) Rx(angle of the axes) Rz(theta2); rates from the dual basis of the two axes.
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    const Pack c = k.parameter, scale = Pack(1.0) / (Pack(1.0) - c * c);
    const Pose &A = k.A, &B = k.B;
    out[0] = freedom == 0 ? atan2(dot(A.X, B.Z), -dot(A.Y, B.Z)) : atan2(dot(B.X, A.Z), dot(B.Y, A.Z));
    if (p.order < 1) return;
    const Vec3 one = freedom == 0 ? A.Z : B.Z, other = freedom == 0 ? B.Z : A.Z;
    const Motion &m = freedom == 0 ? p.a : p.b, &n = freedom == 0 ? p.b : p.a;
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

// Plane on plane: z the normal, x and y in the plane, theta about the normal.
struct Planar : Pair {
  static constexpr char letter[] = "E", parts[] = "PPR", coordinates[] = "x y theta";
  static constexpr int equations = 3, lengths = 1;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(k.A.Z, k.d);
    ParallelAxes::residual(k, r + 1);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    r[0] = dot(k.A.Z, s.at(k.B.o));
    ParallelAxes::column(k, s, r + 1);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.A.Z, a, k, a, b);
    ParallelAxes::second(k, a, b, r + 1);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(k.A.Z, a, k, a, b);
    ParallelAxes::third(k, a, b, r + 1);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = force_at(k.B.o, l[0] * k.A.Z);
    w.moment += ParallelAxes::moment(k, l + 1);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    if (freedom == 2) return about(k, p, out);
    along(freedom == 0 ? k.A.X : k.A.Y, p.a, k, p, out);
  }
};

struct Weld : Pair {
  static constexpr char letter[] = "W", parts[] = "W", coordinates[] = "";
  static constexpr int equations = 6, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    CommonPoint::residual(k, r);
    SameOrientation::residual(k, r + 3);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    CommonPoint::column(k, s, r);
    SameOrientation::column(s, r + 3);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
    SameOrientation::second(a, b, r + 3);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
    SameOrientation::third(a, b, r + 3);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = CommonPoint::wrench(k, l);
    w.moment += SameOrientation::moment(l + 3);
    return w;
  }
};

// Two points at a given distance: |d| = length. Not a pair of its own, but two spheres with a leg between them.
struct Distance : Pair {
  static constexpr char letter[] = "", parts[] = "", coordinates[] = "";
  static constexpr int equations = 1, lengths = 1;
  static MECHKIN_INLINE Pack length(const Closure& k) { return sqrt(dot(k.d, k.d)); }
  static MECHKIN_INLINE Vec3 line(const Closure& k) { return (Pack(1.0) / length(k)) * k.d; }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = length(k) - k.parameter; }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) { r[0] = dot(line(k), s.at(k.B.o)); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 e = line(k), d1 = first_of_d(k, a, b);
    const Pack along = dot(e, d1);
    r[0] = dot(e, second_of_d(k, a, b)) + (dot(d1, d1) - along * along) / length(k);
  }
  // |d| |d|''' = 3 d'.d'' + d.d''' - 3 |d|' |d|''
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    const Vec3 d1 = first_of_d(k, a, b), d2 = second_of_d(k, a, b);
    Pack bend = 0.0;
    second(k, a, b, &bend);
    r[0] = (Pack(3.0) * dot(d1, d2) + dot(k.d, third_of_d(k, a, b)) - Pack(3.0) * dot(line(k), d1) * bend) / length(k);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) { return force_at(k.B.o, l[0] * line(k)); }
};

// Calls f with the entry of a pair that closes loops.
template <class F>
MECHKIN_INLINE void with_closing_joint(int type, F&& f) {
  switch (type) {
    case PAIR_R: return f(Revolute{});
    case PAIR_P: return f(Prismatic{});
    case PAIR_C: return f(Cylindric{});
    case PAIR_S: return f(Spheric{});
    case PAIR_SP: return f(SphereOnPlane{});
    case PAIR_SG: return f(SphereInGroove{});
    case PAIR_U: return f(Universal{});
    case PAIR_E: return f(Planar{});
    case PAIR_W: return f(Weld{});
    case PAIR_LEG: return f(Distance{});
  }
}

}  // namespace
