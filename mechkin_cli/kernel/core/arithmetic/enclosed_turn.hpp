// The shortest turn from one direction to another where directions are enclosed.
#pragma once

#include "arithmetic/vector.hpp"

namespace {

// Turns a pose that stands as drawn by the shortest turn from the unit vector a to the unit vector b (Rodrigues' formula);
// unknown where they may be opposite.
MECHKIN_INLINE void turn_shortest(Pose& pose, const Vec3& a, const Vec3& b) {
  const Vec3 v = cross(a, b);
  const Pack c = dot(a, b), inverse = Pack(1.0) / (Pack(1.0) + c);
  const auto turned = [&](Vec3 r) -> Vec3 { return c * r + cross(v, r) + (dot(v, r) * inverse) * v; };
  pose.X = turned(pose.X), pose.Y = turned(pose.Y), pose.Z = turned(pose.Z);
}

}  // namespace
