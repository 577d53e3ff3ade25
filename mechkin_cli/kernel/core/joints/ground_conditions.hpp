// A common point and a common orientation of the two frames of a pair, in space and in the plane x y, in ground axes: no axes
// of the pair's enter, and the columns are those of rigid motion. These are the derivatives of the residual where the joint is closed.
#pragma once

#include "joints/closing_equations.hpp"
#include "arithmetic/vector_choice.hpp"

namespace {

// d = 0: a common point, in ground axes.
struct CommonPoint : LengthCondition<3> {
  static constexpr unsigned axes = NO_AXES;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = k.d.x, r[1] = k.d.y, r[2] = k.d.z; }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) {
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
  static MECHKIN_INLINE Vec3 force(const Closure&, const Pack* l) { return {l[0], l[1], l[2]}; }
  static MECHKIN_INLINE Vec3 point(const Closure& k) { return k.B.o; }
};

// Equal orientation: the rotation that carries A onto B, as a rotation vector in ground axes. Its skew part alone
// would vanish at half a turn as well and give false assemblies.
struct SameOrientation : DirectionCondition<3> {
  static constexpr unsigned axes = ALL_AXES;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    const Vec3 skew = Pack(0.5) * (cross(k.A.X, k.B.X) + cross(k.A.Y, k.B.Y) + cross(k.A.Z, k.B.Z));
    const Pack c = Pack(0.5) * (dot(k.A.X, k.B.X) + dot(k.A.Y, k.B.Y) + dot(k.A.Z, k.B.Z) - Pack(1.0));
    const Pack s = sqrt(dot(skew, skew));
    const Pack angle = atan2(s, c);
    // at exactly half a turn the axis is lost; any axis keeps the residual at pi
    const Mask tiny = s < Pack(1e-150);  // just above the root of the least normal double
    const Vec3 lost = {select(c < Pack(0.0), angle, Pack(0.0)), Pack(0.0), Pack(0.0)};
    const Vec3 e = select(tiny, lost, (angle / select(tiny, Pack(1.0), s)) * skew);
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE void column(const Closure&, const Twist& s, Pack* r) {
    r[0] = s.angular.x, r[1] = s.angular.y, r[2] = s.angular.z;
  }
  static MECHKIN_INLINE void second(const Closure&, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 e = b.acceleration.angular - a.acceleration.angular;
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE void third(const Closure&, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    const Vec3 e = b.jerk.angular - a.jerk.angular;
    r[0] = e.x, r[1] = e.y, r[2] = e.z;
  }
  static MECHKIN_INLINE Vec3 moment(const Closure&, const Pack* l) { return {l[0], l[1], l[2]}; }
};

// d = 0 of links that stay in the plane x y of the ground: CommonPoint without what the plane holds.
struct CommonPointInPlane : LengthCondition<2> {
  static constexpr unsigned axes = NO_AXES;
  static MECHKIN_INLINE void put(const Vec3& v, Pack* r) { r[0] = v.x, r[1] = v.y; }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { put(k.d, r); }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) { put(s.at(k.B.o), r); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    put(second_of_d(k, a, b), r);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    put(third_of_d(k, a, b), r);
  }
  static MECHKIN_INLINE Vec3 force(const Closure&, const Pack* l) { return {l[0], l[1], Pack(0.0)}; }
  static MECHKIN_INLINE Vec3 point(const Closure& k) { return k.B.o; }
};

// Equal orientation of such links: the angle about z from A to B, whichever axes of the frames lie in the plane.
struct SameHeading : DirectionCondition<1> {
  static constexpr unsigned axes = ALL_AXES;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    const Pack s = Pack(0.5) * (cross(k.A.X, k.B.X).z + cross(k.A.Y, k.B.Y).z + cross(k.A.Z, k.B.Z).z);
    const Pack c = Pack(0.5) * (dot(k.A.X, k.B.X) + dot(k.A.Y, k.B.Y) + dot(k.A.Z, k.B.Z) - Pack(1.0));
    r[0] = atan2(s, c);
  }
  static MECHKIN_INLINE void column(const Closure&, const Twist& s, Pack* r) { r[0] = s.angular.z; }
  static MECHKIN_INLINE void second(const Closure&, const Motion& a, const Motion& b, Pack* r) {
    r[0] = b.acceleration.angular.z - a.acceleration.angular.z;
  }
  static MECHKIN_INLINE void third(const Closure&, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = b.jerk.angular.z - a.jerk.angular.z;
  }
  static MECHKIN_INLINE Vec3 moment(const Closure&, const Pack* l) { return {Pack(0.0), Pack(0.0), l[0]}; }
};

}  // namespace
