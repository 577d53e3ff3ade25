// The shortest turn from one direction to another.
#pragma once

#include "arithmetic/vector_choice.hpp"

namespace {

// Turns a pose that stands as drawn by the shortest turn from the unit vector a to the unit vector b
// (Rodrigues' formula); opposite vectors: half a turn about a vector square to a.
MECHKIN_INLINE void turn_shortest(Pose& pose, const Vec3& a, const Vec3& b) {
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
  const auto turned = [&](const Vec3& r) -> Vec3 {
    const Vec3 turn = c * r + cross(v, r) + (dot(v, r) * inverse) * v;
    const Vec3 half = (Pack(2.0) * dot(p, r)) * p - r;
    return select(opposite, half, turn);
  };
  pose.X = turned(pose.X), pose.Y = turned(pose.Y), pose.Z = turned(pose.Z);
}

}  // namespace
