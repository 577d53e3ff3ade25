// Poses of the links, the closing equations of the loops and their Jacobian at the states as they are.
#pragma once

#include "rows/workspace.hpp"

namespace {

MECHKIN_INLINE const Pose* pose_of(const Workspace& w, int link) { return link < 0 ? nullptr : &w.pose[link]; }

template <class Number>
MECHKIN_INLINE Vec3 carried_point(const Workspace& w, int link, const Number* at) {
  return link < 0 ? constant(at) : w.pose[link].point(at);
}
template <class Number>
MECHKIN_INLINE Vec3 carried_vector(const Workspace& w, int link, const Number* a) {
  return link < 0 ? constant(a) : w.pose[link].vector(a);
}

// Only hung bodies are placed through memory; the pose of any other joint stays in registers until it is whole.
inline void place_hung(const Plan& p, Workspace& w, int k) {
  const HungBody& hung = p.hung[p.joints[k].hung];
  Pose pose = placed(p.joints[k].at, pose_of(w, p.joints[k].parent));
  aim(pose, hung, carried_point(w, hung.second, hung.point));
  w.pose[k] = pose;
}
inline void place_joint(const Plan& p, Workspace& w, int k) {
  const TreeJoint& j = p.joints[k];
  if (j.type == TREE_L) return place_hung(p, w, k);
  Pose pose = placed(j.at, pose_of(w, j.parent));
  if (w.stands[k]) w.frame[k] = pose;
  if (j.function >= 0) find_course(p, j, w.q, 1, w.function, w.course + k);
  with_tree_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
    entry.place(pose, j, w.course + k, w.q + j.state);
  });
  w.pose[k] = pose;
}

// Places a joint anew whose frame on its parent stands still.
inline void place_standing(const Plan& p, Workspace& w, int k) {
  const TreeJoint& j = p.joints[k];
  Pose pose = w.frame[k];
  if (j.function >= 0) find_course(p, j, w.q, 1, w.function, w.course + k);
  with_tree_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
    entry.place(pose, j, w.course + k, w.q + j.state);
  });
  w.pose[k] = pose;
}

inline void find_screws(const Plan& p, Workspace& w, int k) {
  const TreeJoint& j = p.joints[k];
  with_tree_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
    entry.screws(w.pose[k], j, pose_of(w, j.parent), w.course + k, w.screw + j.column);
  });
}

// Those axes of a frame on a link that the lowest three bits of `axes` name.
MECHKIN_INLINE void place_axes(const Frame& f, const Pose* link, unsigned axes, Pose& at) {
  if (axes & X_OF_A) at.X = link ? link->vector(f.x) : constant(f.x);
  if (axes & Y_OF_A) at.Y = link ? link->vector(f.y) : constant(f.y);
  if (axes & Z_OF_A) at.Z = link ? link->vector(f.z) : constant(f.z);
}
MECHKIN_INLINE Vec3 placed_origin(const Frame& f, const Pose* link) { return link ? link->point(f.o) : constant(f.o); }
// The closure of a closing joint at the poses as they are, as far as `axes` are read.
inline void place_closure(const Plan& p, const Workspace& w, int c, unsigned axes) {
  const ClosingJoint& j = p.closing[c];
  Closure& k = w.closure[c];
  place_axes(j.on_first, pose_of(w, j.first), axes, k.A);
  place_axes(j.on_second, pose_of(w, j.second), axes / X_OF_B, k.B);
  k.A.o = placed_origin(j.on_first, pose_of(w, j.first));
  k.B.o = placed_origin(j.on_second, pose_of(w, j.second));
  k.d = k.B.o - k.A.o;
  k.parameter = j.parameter;
  if (j.slide >= 0) k.parameter += Pack(j.slide_sign) * w.q[p.joints[j.slide].state];
  w.placed[c] = (unsigned char)axes;
}
// The closure for coordinates, which read other axes than the equations do; the poses are those of the equations.
inline const Closure& closure_with(const Plan& p, const Workspace& w, int c, unsigned axes) {
  const unsigned missing = axes & ~w.placed[c];
  if (!missing) return w.closure[c];
  const ClosingJoint& j = p.closing[c];
  place_axes(j.on_first, pose_of(w, j.first), missing, w.closure[c].A);
  place_axes(j.on_second, pose_of(w, j.second), missing / X_OF_B, w.closure[c].B);
  w.placed[c] |= (unsigned char)missing;
  return w.closure[c];
}

inline void place_block(const Plan& p, Workspace& w, const Block& b) {
  for (int o = b.joint_begin; o < b.joint_end; ++o) place_joint(p, w, p.order[o]);
}
inline void block_screws(const Plan& p, Workspace& w, const Block& b) {
  for (int o = b.joint_begin; o < b.joint_end; ++o) find_screws(p, w, p.order[o]);
}

// Closing equations of a block into w.right, its charts' after the pairs'; `meet` gets each pair's entry with its own.
template <class Meet>
MECHKIN_INLINE void closing_equations(const Plan& p, Workspace& w, const Block& b, Meet&& meet) {
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    unsigned axes = ALL_AXES;
    with_closing_joint(j.type, [&](auto entry) { axes = entry.axes; });
    if (!is_relation(j.type)) place_closure(p, w, c, axes);
    Pack* r = w.right + j.row;
    with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      if constexpr (entry.is_relation) find_curves(p, j, w.q, 1, w.function, w.curve);
      closing_residual(p, w.q, w.curve, j, w.closure[c], entry, r);
      meet(entry, r);
    });
  }
  if (b.charts) chart_equations(p, b, w.chart(), w.q, w.right + b.rows - b.charts);
}

// Entries of the columns of tree joint k in the equations of closing joint c.
MECHKIN_INLINE void closing_columns(const Plan& p, const Workspace& w, int c, const LoopEntry& e, Pack* out) {
  const TreeJoint& t = p.joints[e.joint];
  const Closure& k = w.closure[c];
  with_tree_joint(t.type, [&](auto tree) __attribute__((always_inline)) {
    for (int i = 0; i < tree.freedoms; ++i) {
      with_closing_joint(p.closing[c].type, [&](auto entry) __attribute__((always_inline)) {
        closing_column(p, w.curve, k, e, i, w.screw[t.column + i], entry, out + i * MAX_CLOSING_ROWS);
      });
    }
  });
}

// Position of a column among the unknowns of a block, or -1.
MECHKIN_INLINE int unknown_index(const Plan& p, int block, int column) {
  return p.column_block[column] == block ? p.column_place[column] : -1;
}

// Jacobian of a block's equations with respect to its unknowns (rows x size, row-major).
inline void block_jacobian(const Plan& p, Workspace& w, int index, Pack* a) {
  const Block& b = p.block[index];
  const int n = b.size;
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    const Closure& k = w.closure[c];
    with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      Pack* const rows = a + j.row * n;
      if (!j.meets_all)
        for (int e = 0; e < entry.equations * n; ++e) rows[e] = 0.0;
      for (int at = j.columns_begin; at < j.known_begin; ++at) {
        const LoopColumn& met = p.loop_column[at];
        Pack column[entry.equations];
        closing_column(p, w.curve, k, p.loop[met.loop], met.freedom, w.screw[met.column], entry, column);
        for (int i = 0; i < entry.equations; ++i) rows[i * n + met.place] = column[i];
      }
    });
  }
  if (!b.charts) return;
  Pack* const rows = a + (b.rows - b.charts) * n;
  for (int e = 0; e < b.charts * n; ++e) rows[e] = 0.0;
  chart_rows(p, b, w.chart(), w.q, [&](int i, int column, Pack x) {
    const int u = unknown_index(p, index, column);
    if (u >= 0) rows[i * n + u] = x;
  });
}

}  // namespace
