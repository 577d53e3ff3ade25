// The hung body: aimed from one point at another, without spin.
//
// Pose: the shortest turn that carries the body's line as drawn onto its line now. (Zero spin all along a motion is no
// pose: after a closed motion the body would come back turned, by the area that its line went round.) Motion: zero
// spin, omega = d x d' / d.d, the least angular velocity that turns the line.
#pragma once

#include "joints/pairs.hpp"
#if MECHKIN_ENCLOSES
#include "arithmetic/enclosed_turn.hpp"
#else
#include "arithmetic/shortest_turn.hpp"
#endif

namespace {

// Places a hung body: its start where the pose's origin is, its line towards `end`.
MECHKIN_INLINE void aim(Pose& pose, const HungBody& hung, const Vec3& end) {
  const Vec3 d = end - pose.o;
  const Pack one = 1.0, none = 0.0;
  pose.X = {one, none, none}, pose.Y = {none, one, none}, pose.Z = {none, none, one};
  turn_shortest(pose, constant(hung.line), (one / sqrt(dot(d, d))) * d);
}

// Motion of the body between A on a link with motion a and B on one with motion b.
MECHKIN_INLINE Motion hung_motion(const Vec3& A, const Vec3& B, Motion a, Motion b, bool second) {
  const Vec3 d = B - A, at_start = a.velocity.at(A), d1 = b.velocity.at(B) - at_start;
  const Pack scale = Pack(1.0) / dot(d, d);
  const Vec3 omega = scale * cross(d, d1);
  Motion m;
  m.velocity = {omega, at_start - cross(omega, A)};
  m.acceleration = zero_twist();
  if (!second) return m;
  const Vec3 second_at_start = a.point_acceleration(A), d2 = b.point_acceleration(B) - second_at_start;
  const Vec3 alpha = scale * (cross(d, d2) - (Pack(2.0) * dot(d, d1)) * omega);
  m.acceleration = {alpha, second_at_start - cross(alpha, A) - cross(omega, at_start)};
  return m;
}

// Its spatial jerk, from its motion and those of its ends.
MECHKIN_INLINE Twist hung_jerk(const Vec3& A, const Vec3& B, Motion hung, const MotionToJerk& a, const MotionToJerk& b) {
  const Vec3 d = B - A, d1 = b.velocity.at(B) - a.velocity.at(A),
             d2 = b.point_acceleration(B) - a.point_acceleration(A), start = a.point_jerk(A),
             d3 = b.point_jerk(B) - start;
  const Vec3 omega = hung.velocity.angular, alpha = hung.acceleration.angular;
  const Pack two = 2.0, scale = Pack(1.0) / dot(d, d);
  const Vec3 jerk = scale * (cross(d1, d2) + cross(d, d3) - (two * (dot(d1, d1) + dot(d, d2))) * omega -
                             (Pack(4.0) * dot(d, d1)) * alpha);
  return {jerk, start - cross(jerk, A) - two * cross(alpha, hung.velocity.at(A)) -
                    cross(omega, hung.point_acceleration(A))};
}

}  // namespace
