// Vectors, rotations, quaternions, twists and wrenches of packs.
//
// Spatial vectors stand at the kernel's origin in ground axes, angular part first: a twist is
// (omega, velocity of the body-fixed point that passes the origin), a wrench is (moment about the
// origin, force). See Featherstone, Rigid Body Dynamics Algorithms (2008), chapter 2.
#pragma once

#include "arithmetic/pack.hpp"

namespace {

struct Vec3 {
  Pack x, y, z;
  friend MECHKIN_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend MECHKIN_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend MECHKIN_INLINE Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend MECHKIN_INLINE Vec3 operator*(const Pack& s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
  MECHKIN_INLINE Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  MECHKIN_INLINE Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
};

MECHKIN_INLINE Pack dot(const Vec3& a, const Vec3& b) {
  return sum_of_products(a.x, b.x, a.y, b.y, a.z, b.z);
}
MECHKIN_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
          difference_of_products(a.x, b.y, a.y, b.x)};
}
// Constants of a plan: doubles that all lanes share, or packs.
template <class Number>
MECHKIN_INLINE Vec3 constant(const Number* c) {
  return {Pack(c[0]), Pack(c[1]), Pack(c[2])};
}
MECHKIN_INLINE Vec3 zero3() { return {Pack(0.0), Pack(0.0), Pack(0.0)}; }

// Pose of a frame in ground axes: columns X, Y, Z of the rotation and the origin o.
struct Pose {
  Vec3 X, Y, Z, o;
  // A constant vector given in this frame, in ground axes.
  template <class Number>
  MECHKIN_INLINE Vec3 vector(const Number* c) const {
    return vector(Vec3{Pack(c[0]), Pack(c[1]), Pack(c[2])});
  }
  MECHKIN_INLINE Vec3 vector(const Vec3& c) const {
    return {sum_of_products(c.x, X.x, c.y, Y.x, c.z, Z.x), sum_of_products(c.x, X.y, c.y, Y.y, c.z, Z.y),
            sum_of_products(c.x, X.z, c.y, Y.z, c.z, Z.z)};
  }
  // A constant point given in this frame, in ground axes.
  template <class Number>
  MECHKIN_INLINE Vec3 point(const Number* c) const { return o + vector(c); }
  // Components in this frame of a vector given in ground axes.
  MECHKIN_INLINE Vec3 components(const Vec3& a) const { return {dot(X, a), dot(Y, a), dot(Z, a)}; }
};

// Unit quaternion, scalar part first.
struct Quaternion {
  Pack w, x, y, z;
};

MECHKIN_INLINE Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
MECHKIN_INLINE Quaternion normalised(const Quaternion& a) {
  const Pack s = Pack(1.0) / sqrt(a.w * a.w + a.x * a.x + a.y * a.y + a.z * a.z);
  return {a.w * s, a.x * s, a.y * s, a.z * s};
}

struct Twist {
  Vec3 angular, linear;
  friend MECHKIN_INLINE Twist operator+(const Twist& a, const Twist& b) {
    return {a.angular + b.angular, a.linear + b.linear};
  }
  friend MECHKIN_INLINE Twist operator-(const Twist& a, const Twist& b) {
    return {a.angular - b.angular, a.linear - b.linear};
  }
  friend MECHKIN_INLINE Twist operator*(const Pack& s, const Twist& a) { return {s * a.angular, s * a.linear}; }
  MECHKIN_INLINE Twist& operator+=(const Twist& b) { return *this = *this + b; }
  // Velocity of the body-fixed point that is at p.
  MECHKIN_INLINE Vec3 at(const Vec3& p) const { return linear + cross(angular, p); }
};
MECHKIN_INLINE Twist zero_twist() { return {zero3(), zero3()}; }

// Lie bracket: the rate of a screw b that is carried by a body moving with twist a.
MECHKIN_INLINE Twist bracket(const Twist& a, const Twist& b) {
  return {cross(a.angular, b.angular), cross(a.angular, b.linear) + cross(a.linear, b.angular)};
}

struct Wrench {
  Vec3 moment, force;
  friend MECHKIN_INLINE Wrench operator+(const Wrench& a, const Wrench& b) {
    return {a.moment + b.moment, a.force + b.force};
  }
  friend MECHKIN_INLINE Wrench operator-(const Wrench& a, const Wrench& b) {
    return {a.moment - b.moment, a.force - b.force};
  }
  friend MECHKIN_INLINE Wrench operator*(const Pack& s, const Wrench& a) { return {s * a.moment, s * a.force}; }
  MECHKIN_INLINE Wrench& operator+=(const Wrench& b) { return *this = *this + b; }
  MECHKIN_INLINE Wrench& operator-=(const Wrench& b) { return *this = *this - b; }
};
MECHKIN_INLINE Wrench zero_wrench() { return {zero3(), zero3()}; }
// A force whose line of action passes through p.
MECHKIN_INLINE Wrench force_at(const Vec3& p, const Vec3& force) { return {cross(p, force), force}; }

// Power of a wrench on a twist.
MECHKIN_INLINE Pack power(const Twist& t, const Wrench& w) {
  return dot(t.angular, w.moment) + dot(t.linear, w.force);
}

// Motion of a link: twist and its first derivative (the spatial acceleration).
struct Motion {
  Twist velocity, acceleration;
  // Second derivative of the position of the body-fixed point at p.
  MECHKIN_INLINE Vec3 point_acceleration(const Vec3& p) const {
    return acceleration.at(p) + cross(velocity.angular, velocity.at(p));
  }
  // Derivatives of a vector carried by the link.
  MECHKIN_INLINE Vec3 rate(const Vec3& a) const { return cross(velocity.angular, a); }
  MECHKIN_INLINE Vec3 second_rate(const Vec3& a) const {
    return cross(acceleration.angular, a) + cross(velocity.angular, cross(velocity.angular, a));
  }
};

// Motion with the second derivative of the twist (the spatial jerk).
struct MotionToJerk : Motion {
  Twist jerk;
  // Third derivative of the position of the body-fixed point at p.
  MECHKIN_INLINE Vec3 point_jerk(const Vec3& p) const {
    return jerk.at(p) + Pack(2.0) * cross(acceleration.angular, velocity.at(p)) +
           cross(velocity.angular, point_acceleration(p));
  }
  // Third derivative of a vector carried by the link.
  MECHKIN_INLINE Vec3 third_rate(const Vec3& a) const {
    return cross(jerk.angular, a) + Pack(2.0) * cross(acceleration.angular, rate(a)) +
           cross(velocity.angular, second_rate(a));
  }
};

}  // namespace
