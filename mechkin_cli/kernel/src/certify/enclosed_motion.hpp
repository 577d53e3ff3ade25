// Rates, accelerations and the wrenches of closing joints over a box that holds the position, block by block.
//
// The position is that of the mechanism: the loops are closed there, and so the closing equations' first and second
// derivatives hold, whose coefficients are enclosed over the box. Of more equations than unknowns those are solved that
// the inverse needs; the multipliers of the others are taken as zero, which is one of the many solutions that the loops'
// redundant constraints leave, and gives what all of them agree in.
#pragma once

#include "enclosed_position.hpp"
#include "enclosed_solution.hpp"
#include "inverse_lanes.hpp"
#include "wrenches.hpp"

namespace {

// What the solutions of one pack of rows need beside a workspace, block after block.
struct Solving {
  Real* inverse;  // blocks' size x rows
  Real* error;    // blocks' size x size
  Real* across;   // largest block: rows x rows
  Pack* room;
  double* scalar;
};

// Offsets of a block in arrays that hold all blocks'.
struct BlockPlace {
  long rows, inverse, error;
};
inline BlockPlace place_of_block(const Plan& p, int index) {
  BlockPlace at = {0, 0, 0};
  for (int b = 0; b < index; ++b) {
    const long m = p.block[b].rows, n = p.block[b].size;
    at.rows += m, at.inverse += m * n, at.error += n * n;
  }
  return at;
}

inline EnclosedMatrix matrix_of(const Plan& p, const Workspace& w, const Solving& s, int index) {
  const BlockPlace at = place_of_block(p, index);
  return {w.jacobian + at.inverse, s.inverse + at.inverse, s.error + at.error, p.block[index].rows, p.block[index].size};
}

// The block's Jacobian by rates over the box, and what solves with it; poses and closures are there.
inline void prepare_block(const Plan& p, Workspace& w, const Solving& s, int index) {
  const EnclosedMatrix f = matrix_of(p, w, s, index);
  Pack* const a = w.jacobian + place_of_block(p, index).inverse;
  block_jacobian(p, w, index, a);
  const auto midpoint = [&](int i, int u) { return a[i * f.n + u].midpoint; };
  invert_lanes(f.n, f.m, midpoint, midpoint, s.scalar, s.inverse + place_of_block(p, index).inverse);
  find_error(f);
}

inline void enclose_rates(const Plan& p, Workspace& w, const Solving& s, int index) {
  const Block& b = p.block[index];
  known_rates(p, w, index, w.right);
  Pack* const x = w.scratch;
  solve_enclosed(matrix_of(p, w, s, index), w.right, s.room, x);
  for (int u = 0; u < b.size; ++u) w.rate[p.unknown[b.column_begin + u]] = x[u];
  for (int o = b.joint_begin; o < b.joint_end; ++o) move_link(p, w, p.order[o], false);
}

// With the block's own accelerations at zero the second derivatives are what these have to cancel.
inline void enclose_accelerations(const Plan& p, Workspace& w, const Solving& s, int index) {
  const Block& b = p.block[index];
  for (int u = 0; u < b.size; ++u) w.acceleration[p.unknown[b.column_begin + u]] = 0.0;
  for (int o = b.joint_begin; o < b.joint_end; ++o) move_link(p, w, p.order[o], true);
  second_of_equations(p, w, b);
  Pack* const x = w.scratch;
  solve_enclosed(matrix_of(p, w, s, index), w.right, s.room, x);
  for (int u = 0; u < b.size; ++u) w.acceleration[p.unknown[b.column_begin + u]] = x[u];
  for (int o = b.joint_begin; o < b.joint_end; ++o) move_link(p, w, p.order[o], true);
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
  stretch_legs(p, w);
  input_efforts(p, w);
}

}  // namespace
