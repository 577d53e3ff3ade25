// Rates, accelerations, jerks and the wrenches of closing joints over a box that holds the position, block by block.
//
// The position is that of the mechanism: the loops are closed there, and so the closing equations' first and second
// derivatives hold, whose coefficients are enclosed over the box. Of more equations than unknowns those are solved that
// the inverse needs; the multipliers of the others are taken as zero, which is one of the many solutions that the loops'
// redundant constraints leave, and gives what all of them agree in.
#pragma once

#include "proofs/block_systems.hpp"
#include "proofs/enclosed_position.hpp"
#include "forces/wrenches.hpp"

namespace {

// The block's Jacobian by rates over the box, and what solves with it; poses and closures are there.
inline void prepare_block(const Plan& p, Workspace& w, const Solving& s, int index) {
  const BlockPlace at = place_of_block(p, index);
  block_jacobian(p, w, index, w.jacobian + at.inverse);
  invert_block(matrix_of(p, w, s, index), s, s.inverse + at.inverse);
}

inline void enclose_rates(const Plan& p, Workspace& w, const Solving& s, int index) {
  const Block& b = p.block[index];
  known_rates(p, w, index, w.right);
  Pack* const x = w.scratch;
  solve_enclosed(matrix_of(p, w, s, index), w.right, s.room, x);
  for (int u = 0; u < b.size; ++u) w.rate[p.unknown[b.column_begin + u]] = x[u];
  move_block(p, w, b);
}

// With the block's own accelerations at zero the second derivatives are what these have to cancel.
inline void enclose_accelerations(const Plan& p, Workspace& w, const Solving& s, int index) {
  const Block& b = p.block[index];
  for (int u = 0; u < b.size; ++u) w.acceleration[p.unknown[b.column_begin + u]] = 0.0;
  accelerate_block(p, w, b, false);
  second_of_equations(p, w, b);
  Pack* const x = w.scratch;
  solve_enclosed(matrix_of(p, w, s, index), w.right, s.room, x);
  for (int u = 0; u < b.size; ++u) w.acceleration[p.unknown[b.column_begin + u]] = x[u];
  accelerate_block(p, w, b, true);
}

// As enclose_accelerations, one order higher.
inline void enclose_jerks(const Plan& p, Workspace& w, const Solving& s, int index) {
  const Block& b = p.block[index];
  for (int u = 0; u < b.size; ++u) w.jerk[p.unknown[b.column_begin + u]] = 0.0;
  for (int o = b.joint_begin; o < b.joint_end; ++o) jerk_link(p, w, p.order[o]);
  third_of_equations(p, w, b);
  Pack* const x = w.scratch;
  solve_enclosed(matrix_of(p, w, s, index), w.right, s.room, x);
  for (int u = 0; u < b.size; ++u) w.jerk[p.unknown[b.column_begin + u]] = x[u];
  for (int o = b.joint_begin; o < b.joint_end; ++o) jerk_link(p, w, p.order[o]);
}

// From what each link needs of its joints (w.carried) to what the joints transmit, as `distribute` in doubles.
inline void enclose_distribution(const Plan& p, Workspace& w, const Solving& s) {
  sum_over_tree(p, w);
  for (int index = p.blocks - 1; index >= 0; --index) {
    Pack *const effort = w.scratch, *const multiplier = w.multiplier + place_of_block(p, index).rows;
    unknown_efforts(p, w, index, effort);
    solve_enclosed_transposed(matrix_of(p, w, s, index), effort, s.room, s.across, multiplier);
    take_closing_wrenches(p, w, index, multiplier);
  }
  stretch_hung_bodies(p, w);
  input_efforts(p, w);
}

}  // namespace
