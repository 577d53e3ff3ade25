// Elementary conditions between the frame A on the first link of a pair and B on the second, of which the pairs'
// closing equations are composed (pairs.hpp).
//
// Each condition has its residual, its Jacobian column for a unit twist of B against A, its second and third derivative
// and what it transmits: a force at a point, or a moment; d = B.o - A.o. The Jacobian of an equation is the product of
// its wrench with that twist. `sides` meets what is positive in an assembly and not in a false root. The conditions here hold
// of the relative pose, and their columns wherever the frames are; a common point and a common orientation:
// ground_conditions.hpp, relative_conditions.hpp.
#pragma once

#include "joints/tree_joints.hpp"

namespace {

// The axes of a closure's frames, a bit each: conditions tell which of them they read.
enum Axes : unsigned { NO_AXES = 0, X_OF_A = 1, Y_OF_A = 2, Z_OF_A = 4, X_OF_B = 8, Y_OF_B = 16, Z_OF_B = 32, ALL_AXES = 63 };

// Frames of a closing joint in ground axes; `parameter` as in ClosingJoint.
struct Closure {
  Pose A, B;
  Vec3 d;
  Pack parameter;
};

// Motion of a link, which is read where it stands, as far as it is known.
struct LinkMotion {
  const Motion& motion;
  const Twist& jerk;
  MECHKIN_INLINE MotionToJerk to_jerk() const { return {motion, jerk}; }
};
// Motion of the two links and how many derivatives of a coordinate are wanted.
struct PairMotion {
  LinkMotion a, b;
  int from, order;  // the least derivative wanted, for a value is dearer than they are, and the highest
  MECHKIN_INLINE Vec3 relative_omega() const {
    return b.motion.velocity.angular - a.motion.velocity.angular;
  }
  MECHKIN_INLINE Vec3 relative_alpha() const {
    return b.motion.acceleration.angular - a.motion.acceleration.angular;
  }
  MECHKIN_INLINE Vec3 relative_jerk() const { return b.jerk.angular - a.jerk.angular; }
};

// Derivatives of d.
MECHKIN_INLINE Vec3 first_of_d(const Closure& k, const Motion& a, const Motion& b) {
  return b.velocity.at(k.B.o) - a.velocity.at(k.A.o);
}
MECHKIN_INLINE Vec3 second_of_d(const Closure& k, const Motion& a, const Motion& b) {
  return b.point_acceleration(k.B.o) - a.point_acceleration(k.A.o);
}
MECHKIN_APART Vec3 third_of_d(const Closure& k, const MotionToJerk& a, const MotionToJerk& b) {
  return b.point_jerk(k.B.o) - a.point_jerk(k.A.o);
}
// Second derivative of axis.d for an axis carried by a link with motion m.
MECHKIN_APART Pack second_along(const Vec3& axis, const Motion& m, const Closure& k, const Motion& a, const Motion& b) {
  return dot(axis, second_of_d(k, a, b)) + Pack(2.0) * dot(m.rate(axis), first_of_d(k, a, b)) +
         dot(m.second_rate(axis), k.d);
}
MECHKIN_APART Pack third_along(const Vec3& axis, const MotionToJerk& m, const Closure& k, const MotionToJerk& a,
                              const MotionToJerk& b) {
  return dot(axis, third_of_d(k, a, b)) + Pack(3.0) * dot(m.rate(axis), second_of_d(k, a, b)) +
         Pack(3.0) * dot(m.second_rate(axis), first_of_d(k, a, b)) + dot(m.third_rate(axis), k.d);
}
// Third derivative of x.z for vectors carried by links with motions a and b.
MECHKIN_APART Pack third_of_product(const Vec3& x, const MotionToJerk& a, const Vec3& z, const MotionToJerk& b) {
  return dot(a.third_rate(x), z) + Pack(3.0) * dot(a.second_rate(x), b.rate(z)) +
         Pack(3.0) * dot(a.rate(x), b.second_rate(z)) + dot(x, b.third_rate(z));
}
// Directions that ride on a link.
struct OnFirst {
  static MECHKIN_INLINE const MotionToJerk& of(const MotionToJerk& a, const MotionToJerk&) { return a; }
  static MECHKIN_INLINE const Motion& of(const Motion& a, const Motion&) { return a; }
  static MECHKIN_INLINE const LinkMotion& of(const LinkMotion& a, const LinkMotion&) { return a; }
  static MECHKIN_INLINE Vec3 opposite(const Closure& k) { return k.B.o; }
};
struct OnSecond {
  static MECHKIN_INLINE const MotionToJerk& of(const MotionToJerk&, const MotionToJerk& b) { return b; }
  static MECHKIN_INLINE const Motion& of(const Motion&, const Motion& b) { return b; }
  static MECHKIN_INLINE const LinkMotion& of(const LinkMotion&, const LinkMotion& b) { return b; }
  static MECHKIN_INLINE Vec3 opposite(const Closure& k) { return k.A.o; }
};
struct AX : OnFirst {
  static constexpr unsigned axes = X_OF_A;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return k.A.X; }
};
struct AY : OnFirst {
  static constexpr unsigned axes = Y_OF_A;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return k.A.Y; }
};
struct AZ : OnFirst {
  static constexpr unsigned axes = Z_OF_A;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return k.A.Z; }
};
struct BX : OnSecond {
  static constexpr unsigned axes = X_OF_B;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return k.B.X; }
};
struct BY : OnSecond {
  static constexpr unsigned axes = Y_OF_B;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return k.B.Y; }
};
struct BZ : OnSecond {
  static constexpr unsigned axes = Z_OF_B;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return k.B.Z; }
};
template <class Direction>
struct Reverse : Direction { static MECHKIN_INLINE Vec3 vector(const Closure& k) { return -Direction::vector(k); } };

// In the plane x_A y_A, at an angle from -y_A whose cosine is the pair's parameter, and square to that.
MECHKIN_INLINE Pack sine_of_parameter(const Closure& k) { return sqrt(Pack(1.0) - k.parameter * k.parameter); }
struct AlongCylinder : OnFirst {
  static constexpr unsigned axes = X_OF_A | Y_OF_A;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return sine_of_parameter(k) * k.A.X - k.parameter * k.A.Y; }
};
struct AcrossCylinder : OnFirst {
  static constexpr unsigned axes = X_OF_A | Y_OF_A;
  static MECHKIN_INLINE Vec3 vector(const Closure& k) { return k.parameter * k.A.X + sine_of_parameter(k) * k.A.Y; }
};

// Cosines that an angle keeps.
struct Parameter { static MECHKIN_INLINE Pack value(const Closure& k) { return k.parameter; } };
struct Square { static MECHKIN_INLINE Pack value(const Closure&) { return Pack(0.0); } };

// Conditions on lengths, which transmit a force, and on directions, which transmit a moment.
template <int COUNT>
struct LengthCondition {
  static constexpr int equations = COUNT, lengths = COUNT;
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure&, Meet&&) {}
};
template <int COUNT>
struct DirectionCondition {
  static constexpr int equations = COUNT, lengths = 0;
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure&, Meet&&) {}
};

// u.d = 0: the other link's origin in the plane square to u through the origin of the link that carries u.
template <class U>
struct InPlane : LengthCondition<1> {
  static constexpr unsigned axes = U::axes;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = dot(U::vector(k), k.d); }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) { r[0] = dot(U::vector(k), s.at(point(k))); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(U::vector(k), U::of(a, b), k, a, b);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(U::vector(k), U::of(a, b), k, a, b);
  }
  static MECHKIN_INLINE Vec3 force(const Closure& k, const Pack* l) { return l[0] * U::vector(k); }
  static MECHKIN_INLINE Vec3 point(const Closure& k) { return U::opposite(k); }
};

// x_A.z_B = y_A.z_B = 0: parallel axes, with z_A.z_B > 0 beside them.
struct ParallelAxes : DirectionCondition<2> {
  static constexpr unsigned axes = X_OF_A | Y_OF_A | Z_OF_A | Z_OF_B;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(k.A.X, k.B.Z);
    r[1] = dot(k.A.Y, k.B.Z);
  }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) {
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
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure& k, Meet&& meet) {
    meet(dot(k.A.Z, k.B.Z));
  }
};

// z_A.z_B keeps its cosine.
template <class Cosine>
struct KeptAngle : DirectionCondition<1> {
  static constexpr unsigned axes = Z_OF_A | Z_OF_B;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = dot(k.A.Z, k.B.Z) - Cosine::value(k); }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) {
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
};

// |d| = parameter: two points at a given distance.
struct Distance : LengthCondition<1> {
  static constexpr unsigned axes = NO_AXES;
  static MECHKIN_INLINE Pack length(const Closure& k) { return sqrt(dot(k.d, k.d)); }
  static MECHKIN_INLINE Vec3 line(const Closure& k) { return (Pack(1.0) / length(k)) * k.d; }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = length(k) - k.parameter; }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) { r[0] = dot(line(k), s.at(k.B.o)); }
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
  static MECHKIN_INLINE Vec3 force(const Closure& k, const Pack* l) { return l[0] * line(k); }
  static MECHKIN_INLINE Vec3 point(const Closure& k) { return k.B.o; }
};

}  // namespace
