// Velocities and accelerations: the closing equations once and twice differentiated, solved with the
// factors of the converged position (docs/numerics.md, Rates).
//
// The third derivatives follow the same way, where they are asked for.
// With input rates 1 and accelerations 0 the results are the first and second influence coefficients.
#pragma once

#include "rows/moving.hpp"
#include "rows/position.hpp"

namespace {

inline void block_velocities(const Plan& p, Workspace& w, int index) {
  const Block& b = p.block[index];
  const BlockMatrices at = matrices_of(p, w, index);
  known_rates(p, w, index, w.right);
  at.solve_equations(w.right);
  for (int u = 0; u < b.size; ++u) w.rate[p.unknown[b.column_begin + u]] = w.right[u];
  move_block(p, w, b);
}

// First with the block's unknown second derivatives at zero, which leaves the convective part of the
// closing equations, then with the ones that cancel it. Relations alone do not wait for their links' motion.
inline void block_accelerations(const Plan& p, Workspace& w, int index) {
  const Block& b = p.block[index];
  const BlockMatrices at = matrices_of(p, w, index);
  for (int u = 0; u < b.size; ++u) w.acceleration[p.unknown[b.column_begin + u]] = 0.0;
  if (!b.placeless) accelerate_block(p, w, b, false);
  second_of_equations(p, w, b);
  at.solve_equations(w.right);
  for (int u = 0; u < b.size; ++u) w.acceleration[p.unknown[b.column_begin + u]] = w.right[u];
  if (b.placeless) return accelerate_block(p, w, b, false);
  // what no unknown moves is accelerated as it was
  for (int o = b.joint_begin; o < b.joint_end; ++o)
    if (w.moves[p.order[o]]) accelerate_link(p, w, p.order[o], true);
}

// As block_accelerations, one order higher.
inline void block_jerks(const Plan& p, Workspace& w, int index) {
  const Block& b = p.block[index];
  for (int u = 0; u < b.size; ++u) w.jerk[p.unknown[b.column_begin + u]] = 0.0;
  if (!b.placeless)
    for (int o = b.joint_begin; o < b.joint_end; ++o) jerk_link(p, w, p.order[o]);
  third_of_equations(p, w, b);
  matrices_of(p, w, index).solve_equations(w.right);
  for (int u = 0; u < b.size; ++u) w.jerk[p.unknown[b.column_begin + u]] = w.right[u];
  for (int o = b.joint_begin; o < b.joint_end; ++o) jerk_link(p, w, p.order[o]);
}

}  // namespace
