// Reactions by transposition (virtual power with the screws of the motion).
//
// Every link needs the wrench (inertia - applied loads) from its joints. Summed over subtrees and
// projected on the screws of the unknown freedoms, it gives the wrenches of the closing joints from the
// transposed Jacobian; with these taken into the sums, `carried[k]` is what tree joint k transmits, and its
// product with an input's screw is the effort of the drive.
#pragma once

#include "rows/motion.hpp"
#include "arithmetic/vector_choice.hpp"
#include "forces/wrenches.hpp"

namespace {

// The value of a closing joint's angle or orientation (ClosingTurn) and its derivatives up to `order`, 0 or 2.
inline void closing_turn(const Plan& p, const Workspace& w, const ClosingTurn& turn, int order, Pack (*out)[4]) {
  if (turn.freedom >= 0) {
    Pack k[4];
    closing_coordinate(p, w, turn.closing, turn.freedom, 0, order, k);
    for (int n = 0; n <= order; ++n) out[n][0] = k[n];
    return;
  }
  const ClosingJoint& j = p.closing[turn.closing];
  const Closure& k = closure_with(p, w, turn.closing, ALL_AXES);
  const Pose &A = k.A, &B = k.B;
  const Quaternion q = quaternion_of(A.components(B.X), A.components(B.Y), A.components(B.Z));
  out[0][0] = q.w, out[0][1] = q.x, out[0][2] = q.y, out[0][3] = q.z;
  if (order < 2) return;
  const Motion &a = motion_of(w, j.first), &b = motion_of(w, j.second);
  const Vec3 omega = b.velocity.angular - a.velocity.angular;
  const Vec3 alpha = b.acceleration.angular - a.acceleration.angular - cross(a.velocity.angular, omega);
  const Vec3 first = A.components(omega), second = A.components(alpha);
  out[1][0] = first.x, out[1][1] = first.y, out[1][2] = first.z, out[1][3] = 0.0;
  out[2][0] = second.x, out[2][1] = second.y, out[2][2] = second.z, out[2][3] = 0.0;
}

// The largest component of some wrenches: what their rounding is measured by, in whatever joint it is met.
MECHKIN_INLINE Pack component_level(Pack level, const Wrench& r) {
  const Vec3 f = r.force, m = r.moment;
  level = max(max(level, abs(f.x)), max(abs(f.y), abs(f.z)));
  return max(max(level, abs(m.x)), max(abs(m.y), abs(m.z)));
}
inline Pack tree_level(const Plan& p, const Workspace& w) {
  Pack level = 0.0;
  for (int k = 0; k < p.links; ++k) level = component_level(level, w.carried[k]);
  return level;
}
inline Pack reaction_level(const Plan& p, const Workspace& w) {
  Pack level = tree_level(p, w);
  for (int c = 0; c < p.closings; ++c) level = component_level(level, w.reaction[c]);
  return level;
}

// Closing wrenches block by block, last first: the unknowns of a block appear only in its own equations
// and in those of later blocks, whose wrenches are in the sums already.
// `level` is that of the wrenches, see reaction_level.
inline void closing_wrenches(const Plan& p, Workspace& w, int shift, Pack level) {
  for (int index = p.blocks - 1; index >= 0; --index) {
    const BlockMatrices at = matrices_of(p, w, index);
    unknown_efforts(p, w, index, at.multiplier);
    at.solve_multipliers(at.multiplier, shift, level);
    take_closing_wrenches(p, w, index, at.multiplier);
  }
}

// From these sums over the tree (w.carried) to what the joints transmit: closing wrenches, efforts.
inline void distribute_sums(const Plan& p, Workspace& w, int shift) {
  closing_wrenches(p, w, shift, shift ? tree_level(p, w) : Pack(0.0));
  stretch_hung_bodies(p, w);
  input_efforts(p, w);
}
// The same from what each link needs of its joints.
inline void distribute(const Plan& p, Workspace& w, int shift) {
  sum_over_tree(p, w);
  distribute_sums(p, w, shift);
}

// The largest component of the links' twists.
inline Pack twist_level(const Plan& p, const Workspace& w) {
  Pack level = 0.0;
  for (int k = 0; k < p.links; ++k) {
    const Twist& t = w.motion[k].velocity;
    level = component_level(level, {t.angular, t.linear});
  }
  return level;
}

// Powers in parts of the largest wrench by the largest twist up to which nothing works: efforts and rates are off by
// up to about 1e-12 of those (tolerances.REACTION_ROUNDING), so that smaller powers are rounding alone.
constexpr double NOTHING_WORKS = 1e-12;

}  // namespace
