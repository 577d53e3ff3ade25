// How the states of tree joints move by increments of their columns.
#pragma once

#include "joints/tree_joints.hpp"

namespace {

// Moves a joint's state by increments of its columns.
template <class Joint>
MECHKIN_INLINE void advance(Joint, Pack* q, const Pack* delta, Mask moving) {
  for (int i = 0; i < Joint::freedoms; ++i) q[i] = select(moving, q[i] + delta[i], q[i]);
}
MECHKIN_INLINE void advance(Orientation, Pack* q, const Pack* delta, Mask moving) {
  const Vec3 half = Pack(0.5) * Vec3{delta[0], delta[1], delta[2]};
  const Pack angle = sqrt(dot(half, half));
  Pack s, c;
  sincos(angle, s, c);
  const Mask tiny = angle < Pack(1e-150);  // just above the root of the least normal double; sin x = x long before
  const Pack f = select(tiny, Pack(1.0), s / select(tiny, Pack(1.0), angle));
  const Quaternion turned = normalised(product({c, f * half.x, f * half.y, f * half.z}, {q[0], q[1], q[2], q[3]}));
  q[0] = select(moving, turned.w, q[0]);
  q[1] = select(moving, turned.x, q[1]);
  q[2] = select(moving, turned.y, q[2]);
  q[3] = select(moving, turned.z, q[3]);
}

}  // namespace
