// Closing equations and their Jacobian of a whole mechanism in the unit's arithmetic.
#pragma once

#include <cstdint>

#include "joints/pairs.hpp"
#include "proofs/proving_unit.hpp"

namespace {

constexpr int MAX_EQUATIONS = 6;

// What one pack of places is computed in.
struct Enclosures {
  Pack* q;         // states
  Pose* pose;      // links
  Twist* screw;    // columns
  Pack* equation;  // of all blocks, one block after the other
  Real side;       // least of what is positive in an assembly and not in a false root
  Pack* jacobian;  // equations x columns
  TermCurve* curve;  // terms: of those that are functions
  Pack* function;    // registers of the largest function
  Course* course;    // links, where there are functions
};

inline int equations_of(const Plan& p) {
  int count = 0;
  for (int b = 0; b < p.blocks; ++b) count += p.block[b].rows;
  return count;
}

inline const Pose* pose_at(const Enclosures& w, int link) { return link < 0 ? nullptr : &w.pose[link]; }

// The hung body and its rod, which close no loop.
inline bool is_hung(const Plan& p, int k) {
  const int parent = p.joints[k].parent;
  return p.joints[k].type == TREE_L || (parent >= 0 && p.joints[parent].type == TREE_L);
}

inline void place_links(const Plan& p, Enclosures& w) {
  for (int b = 0; b < p.blocks; ++b)
    for (int o = p.block[b].joint_begin; o < p.block[b].joint_end; ++o) {
      const int k = p.order[o];
      const TreeJoint& j = p.joints[k];
      if (is_hung(p, k)) continue;
      const Pose* const parent = pose_at(w, j.parent);
      w.pose[k] = placed(j.at, parent);
      find_course(p, j, w.q, 1, w.function, w.course + k);
      with_tree_joint(j.type, [&](auto entry) {
        entry.place(w.pose[k], j, w.course + k, w.q + j.state);
        entry.screws(w.pose[k], j, parent, w.course + k, w.screw + j.column);
      });
    }
}

inline Closure enclosed_closure(const Plan& p, const Enclosures& w, const ClosingJoint& j) {
  Closure k;
  k.A = placed(j.on_first, pose_at(w, j.first));
  k.B = placed(j.on_second, pose_at(w, j.second));
  k.d = k.B.o - k.A.o;
  k.parameter = j.parameter;
  if (j.slide >= 0) k.parameter += Pack(j.slide_sign) * w.q[p.joints[j.slide].state];
  return k;
}

inline int freedoms_of(const TreeJoint& t) {
  int count = 0;
  with_tree_joint(t.type, [&](auto tree) { count = tree.freedoms; });
  return count;
}

// Equations and Jacobian at w.q.
inline void enclose_closing(const Plan& p, Enclosures& w) {
  place_links(p, w);
  w.side = __builtin_inf();
  for (int e = 0; e < equations_of(p) * p.columns; ++e) w.jacobian[e] = Pack(0.0);
  int first = 0;
  for (int b = 0; b < p.blocks; first += p.block[b].rows, ++b)
    for (int c = p.block[b].closing_begin; c < p.block[b].closing_end; ++c) {
      const ClosingJoint& j = p.closing[c];
      const Closure k = enclosed_closure(p, w, j);
      const int equation = first + j.row;
      with_closing_joint(j.type, [&](auto entry) {
        if constexpr (entry.is_relation) find_curves(p, j, w.q, 1, w.function, w.curve);
        closing_residual(p, w.q, w.curve, j, k, entry, w.equation + equation);
        entry.sides(k, [&](const Pack& x) { w.side = min(w.side, lower_bound(x)); });
        for (int l = j.loop_begin; l < j.loop_end; ++l) {
          const TreeJoint& t = p.joints[p.loop[l].joint];
          if (p.loop[l].joint == j.slide) {  // whose length it is
            w.jacobian[equation * p.columns + t.column] = Pack(-j.slide_sign);
            continue;
          }
          for (int f = t.column; f < t.column + freedoms_of(t); ++f) {
            Pack column[MAX_EQUATIONS];
            closing_column(p, w.curve, k, p.loop[l], f - t.column, w.screw[f], entry, column);
            for (int i = 0; i < entry.equations; ++i) w.jacobian[(equation + i) * p.columns + f] = column[i];
          }
        }
      });
    }
}

}  // namespace
