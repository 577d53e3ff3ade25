// Poses, closing equations and their Jacobian over boxes of positions.
//
// A box is about a point: scalar coordinates q + [-r, r], and orientations (1, x / 2) q with increments |x_k| <= r_k about
// the axes of the joint's frame in the parent (Cayley's parametrisation; q of any length). The columns of increments are
// those of rotations by omega = (x' + x/2 x x') / (1 + |x|^2 / 4).
#pragma once

#include "rows/moving.hpp"

namespace {

// What a box adds to a workspace.
struct Box {
  Pack* turn;    // columns: their increments, zero for scalar ones, which their states have
  Real* radius;  // columns: of the box as it was given
};

MECHKIN_INLINE Pack cayley_scale(Vec3 x) { return Pack(1.0) / (Pack(1.0) + Pack(0.25) * (square(x.x) + square(x.y) + square(x.z))); }

MECHKIN_INLINE bool is_orientation(const TreeJoint& t) {
  bool is = false;
  with_tree_joint(t.type, [&](auto entry) { is = entry.states != entry.freedoms; });
  return is;
}

// The turn by increments x of vectors in the same axes: a + (x x a + x/2 x (x x a)) / (1 + |x|^2 / 4).
inline void turn_by_increments(Pose& pose, Vec3 x, Pack scale) {
  Vec3* const axes[] = {&pose.X, &pose.Y, &pose.Z};
  for (Vec3* a : axes) {
    const Vec3 across = cross(x, *a);
    *a += scale * (across + Pack(0.5) * cross(x, across));
  }
}

inline void place_enclosed(const Plan& p, Workspace& w, const Box& box, int k) {
  const TreeJoint& j = p.joints[k];
  place_joint(p, w, k);
  if (is_orientation(j)) {
    const Vec3 x = {box.turn[j.column], box.turn[j.column + 1], box.turn[j.column + 2]};
    turn_by_increments(w.pose[k], placed(j.at, pose_of(w, j.parent)).vector(x), cayley_scale(x));
  }
  find_screws(p, w, k);
}

inline void place_enclosed_block(const Plan& p, Workspace& w, const Box& box, int index) {
  const Block& b = p.block[index];
  for (int o = b.joint_begin; o < b.joint_end; ++o) place_enclosed(p, w, box, p.order[o]);
}

// Places of a block's links, and its closing equations into w.right.
inline void close_enclosed_block(const Plan& p, Workspace& w, const Box& box, int index) {
  place_enclosed_block(p, w, box, index);
  closing_equations(p, w, p.block[index], [](auto, const Pack*) {});
}

// Columns of rotations about an orientation's axes into those of increments, one equation's three entries.
MECHKIN_INLINE void by_increments(Vec3 x, Pack scale, Pack* entry) {
  const Vec3 j = {entry[0], entry[1], entry[2]}, by = scale * (j + Pack(0.5) * cross(j, x));
  entry[0] = by.x, entry[1] = by.y, entry[2] = by.z;
}

// Derivatives of a block's equations by all columns, as increments, into out[equation * columns + column] (rows of the
// block x columns).
inline void enclosed_derivatives(const Plan& p, const Workspace& w, const Box& box, int index, Pack* out) {
  const Block& b = p.block[index];
  for (int e = 0; e < b.rows * p.columns; ++e) out[e] = 0.0;
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    int equations = 0;
    with_closing_joint(j.type, [&](auto entry) { equations = entry.equations; });
    for (int l = j.loop_begin; l < j.loop_end; ++l) {
      const TreeJoint& t = p.joints[p.loop[l].joint];
      const int freedoms = freedoms_of(t.type);
      Pack column[3 * MAX_CLOSING_ROWS];
      closing_columns(p, w, c, p.loop[l], column);
      // a hung body's length goes by its slide exactly
      if (p.loop[l].joint == j.slide) column[0] = -j.slide_sign;
      for (int i = 0; i < equations; ++i) {
        Pack* const row = out + (j.row + i) * p.columns + t.column;
        for (int f = 0; f < freedoms; ++f) row[f] = column[f * MAX_CLOSING_ROWS + i];
        if (!is_orientation(t)) continue;
        const Vec3 x = {box.turn[t.column], box.turn[t.column + 1], box.turn[t.column + 2]};
        by_increments(x, cayley_scale(x), row);
      }
    }
  }
}

}  // namespace
