// A common point and a common orientation of the two frames of a pair, in space in the axes of the first, and in the plane x y.
//
// Residuals and columns are functions of the frames' relative pose alone, and the columns are the residuals' derivatives
// wherever the frames are, not only where the joint is closed: what enclosures over boxes need. Where the joint is
// closed, derivatives and wrenches are those of ground_conditions.hpp in other axes.
#pragma once

#include "joints/closing_equations.hpp"

namespace {

// x_A.d = y_A.d = z_A.d = 0.
struct CommonPoint : LengthCondition<3> {
  static constexpr unsigned axes = X_OF_A | Y_OF_A | Z_OF_A;
  static MECHKIN_INLINE void put(const Closure& k, const Vec3& a, Pack* r) {
    r[0] = dot(k.A.X, a), r[1] = dot(k.A.Y, a), r[2] = dot(k.A.Z, a);
  }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { put(k, k.d, r); }
  // d' - omega_A x d is the velocity against A of the point that passes B.o
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) { put(k, s.at(k.B.o), r); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    InPlane<AX>::second(k, a, b, r), InPlane<AY>::second(k, a, b, r + 1), InPlane<AZ>::second(k, a, b, r + 2);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    InPlane<AX>::third(k, a, b, r), InPlane<AY>::third(k, a, b, r + 1), InPlane<AZ>::third(k, a, b, r + 2);
  }
  static MECHKIN_INLINE Vec3 force(const Closure& k, const Pack* l) { return k.A.vector(Vec3{l[0], l[1], l[2]}); }
  static MECHKIN_INLINE Vec3 point(const Closure& k) { return k.B.o; }
};

// The skew part of the rotation from A to B, sin(angle) times its axis. It vanishes at half a turn as well, where the
// trace, 1 + 2 cos(angle), is -1: a proof needs that positive beside it.
struct SameOrientation : DirectionCondition<3> {
  static constexpr unsigned axes = ALL_AXES;
  // half of z_A.y - y_A.z, x_A.z - z_A.x, y_A.x - x_A.y
  static MECHKIN_INLINE void put(const Closure& k, const Vec3& x, const Vec3& y, const Vec3& z, Pack* r) {
    const Pack half = 0.5;
    r[0] = half * (dot(k.A.Z, y) - dot(k.A.Y, z));
    r[1] = half * (dot(k.A.X, z) - dot(k.A.Z, x));
    r[2] = half * (dot(k.A.Y, x) - dot(k.A.X, y));
  }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { put(k, k.B.X, k.B.Y, k.B.Z, r); }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) {
    const Vec3 omega = s.angular;
    put(k, cross(omega, k.B.X), cross(omega, k.B.Y), cross(omega, k.B.Z), r);
  }
  // Where the joint is closed, and moves closed: then the two links turn alike.
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 e = k.A.components(b.acceleration.angular - a.acceleration.angular);
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    const Vec3 e = k.A.components(b.jerk.angular - a.jerk.angular);
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE Vec3 moment(const Closure& k, const Pack* l) { return k.A.vector(Vec3{l[0], l[1], l[2]}); }
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure& k, Meet&& meet) {
    meet(dot(k.A.X, k.B.X) + dot(k.A.Y, k.B.Y) + dot(k.A.Z, k.B.Z));
  }
};

// Of links that stay in the plane x y of the ground: x_A.d = y_A.d = 0, z_A the plane's normal.
struct CommonPointInPlane : LengthCondition<2> {
  static constexpr unsigned axes = X_OF_A | Y_OF_A;
  static MECHKIN_INLINE void put(const Closure& k, const Vec3& a, Pack* r) { r[0] = dot(k.A.X, a), r[1] = dot(k.A.Y, a); }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { put(k, k.d, r); }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) { put(k, s.at(k.B.o), r); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    InPlane<AX>::second(k, a, b, r), InPlane<AY>::second(k, a, b, r + 1);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    InPlane<AX>::third(k, a, b, r), InPlane<AY>::third(k, a, b, r + 1);
  }
  static MECHKIN_INLINE Vec3 force(const Closure& k, const Pack* l) { return l[0] * k.A.X + l[1] * k.A.Y; }
  static MECHKIN_INLINE Vec3 point(const Closure& k) { return k.B.o; }
};

// The sine of the angle about z from A to B, which turns of both about z leave as it is. As above, a proof needs the trace
// positive beside it.
struct SameHeading : DirectionCondition<1> {
  static constexpr unsigned axes = ALL_AXES;
  static MECHKIN_INLINE void put(const Closure& k, const Vec3& x, const Vec3& y, const Vec3& z, Pack* r) {
    r[0] = Pack(0.5) * (cross(k.A.X, x).z + cross(k.A.Y, y).z + cross(k.A.Z, z).z);
  }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { put(k, k.B.X, k.B.Y, k.B.Z, r); }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) {
    const Vec3 omega = s.angular;
    put(k, cross(omega, k.B.X), cross(omega, k.B.Y), cross(omega, k.B.Z), r);
  }
  // Where the joint is closed, and moves closed.
  static MECHKIN_INLINE void second(const Closure&, const Motion& a, const Motion& b, Pack* r) {
    r[0] = b.acceleration.angular.z - a.acceleration.angular.z;
  }
  static MECHKIN_INLINE void third(const Closure&, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = b.jerk.angular.z - a.jerk.angular.z;
  }
  static MECHKIN_INLINE Vec3 moment(const Closure&, const Pack* l) { return {Pack(0.0), Pack(0.0), l[0]}; }
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure& k, Meet&& meet) {
    SameOrientation::sides(k, meet);
  }
};

}  // namespace
