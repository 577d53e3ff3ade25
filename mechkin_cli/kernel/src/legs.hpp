// The body of a leg: aimed from one point at another, without spin.
//
// Pose: the shortest turn that carries the leg's line as drawn onto its line now. (Zero spin all along a motion is no
// pose: after a closed motion the leg would come back turned, by the area that its line went round.) Motion: zero
// spin, omega = d x d' / d.d, the least angular velocity that turns the line.
#pragma once

#include "pairs.hpp"

namespace {

// Turns a pose that stands as drawn by the shortest turn from the unit vector a to the unit vector b
// (Rodrigues' formula); opposite vectors: half a turn about a vector square to a.
MECHKIN_INLINE void turn_shortest(Pose& pose, Vec3 a, Vec3 b) {
  const Vec3 v = cross(a, b);
  const Pack c = dot(a, b), square = dot(v, v), one = 1.0;
  // 1 / (1 + c), from |v|^2 = (1 + c)(1 - c) where 1 + c cancels
  // nine roundings from -1: nearer, a x b has no direction (tolerances.OPPOSITE_COSINE)
  const Mask opposite = c <= Pack(-1.0 + 1e-15);
  const Mask beyond = c < Pack(0.0);
  const Pack inverse = select(beyond, (one - c) / select(opposite, one, square), one / select(beyond, one, one + c));
  const Mask flat = (abs(a.x) <= abs(a.y)) & (abs(a.x) <= abs(a.z));
  const Vec3 x = {one, Pack(0.0), Pack(0.0)}, y = {Pack(0.0), one, Pack(0.0)};
  const Vec3 square_to = cross(a, select(flat, x, y));
  const Vec3 p = (one / sqrt(dot(square_to, square_to))) * square_to;
  const auto turned = [&](Vec3 r) -> Vec3 {
    const Vec3 turn = c * r + cross(v, r) + (dot(v, r) * inverse) * v;
    const Vec3 half = (Pack(2.0) * dot(p, r)) * p - r;
    return select(opposite, half, turn);
  };
  pose.X = turned(pose.X), pose.Y = turned(pose.Y), pose.Z = turned(pose.Z);
}

// Places a leg's body: its start where the pose's origin is, its line towards `end`.
MECHKIN_INLINE void aim(Pose& pose, const Leg& leg, Vec3 end) {
  const Vec3 d = end - pose.o;
  const Pack one = 1.0, none = 0.0;
  pose.X = {one, none, none}, pose.Y = {none, one, none}, pose.Z = {none, none, one};
  turn_shortest(pose, constant(leg.line), (one / sqrt(dot(d, d))) * d);
}

// Motion of the body between A on a link with motion a and B on one with motion b.
MECHKIN_INLINE Motion leg_motion(Vec3 A, Vec3 B, Motion a, Motion b, bool second) {
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
MECHKIN_INLINE Twist leg_jerk(Vec3 A, Vec3 B, Motion leg, const MotionToJerk& a, const MotionToJerk& b) {
  const Vec3 d = B - A, d1 = b.velocity.at(B) - a.velocity.at(A),
             d2 = b.point_acceleration(B) - a.point_acceleration(A), start = a.point_jerk(A),
             d3 = b.point_jerk(B) - start;
  const Vec3 omega = leg.velocity.angular, alpha = leg.acceleration.angular;
  const Pack two = 2.0, scale = Pack(1.0) / dot(d, d);
  const Vec3 jerk = scale * (cross(d1, d2) + cross(d, d3) - (two * (dot(d1, d1) + dot(d, d2))) * omega -
                             (Pack(4.0) * dot(d, d1)) * alpha);
  return {jerk, start - cross(jerk, A) - two * cross(alpha, leg.velocity.at(A)) -
                    cross(omega, leg.point_acceleration(A))};
}

}  // namespace
