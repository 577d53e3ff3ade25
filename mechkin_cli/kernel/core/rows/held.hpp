// A block that is looked at instead of solved (Held, plan.hpp): its equations and their derivatives by the path, with
// unknowns, rates and accelerations as given. Beyond a dead centre nothing else can be had of it.
#pragma once

#include "rows/motion.hpp"

namespace {

// A block that is neither solved nor looked at: its joints are placed as they are, for others may hang on them, and its
// unknowns stand still.
inline void leave_block(const Plan& p, Workspace& w, int index) {
  const Block& b = p.block[index];
  place_block(p, w, b);
  block_screws(p, w, b);
  for (int u = 0; u < b.size; ++u) {
    const int column = p.unknown[b.column_begin + u];
    w.rate[column] = w.acceleration[column] = 0.0;
  }
}

// Equations and Jacobian (not factored) at the states as they are.
template <class Out>
inline Residual hold_block(const Plan& p, Workspace& w, int index, Out&& equations) {
  const Block& b = p.block[index];
  place_block(p, w, b);
  const Residual residual = block_residual(p, w, b);
  for (int i = 0; i < b.rows; ++i) equations.put(i, w.right[i]);
  block_screws(p, w, b);
  find_jacobian(p, w, index, matrices_of(p, w, index));
  return residual;
}

template <class In, class Out>
inline void hold_velocities(const Plan& p, Workspace& w, int index, In&& rate, Out&& first) {
  const Block& b = p.block[index];
  const BlockMatrices at = matrices_of(p, w, index);
  known_rates(p, w, index, w.right);
  for (int u = 0; u < b.size; ++u) w.rate[p.unknown[b.column_begin + u]] = rate(u);
  for (int i = 0; i < b.rows; ++i) {
    Pack sum = -w.right[i];
    for (int u = 0; u < b.size; ++u) sum += at.entry(i, u) * w.rate[p.unknown[b.column_begin + u]];
    first.put(i, sum);
  }
  move_block(p, w, b);
}

template <class In, class Out>
inline void hold_accelerations(const Plan& p, Workspace& w, int index, In&& acceleration, Out&& second) {
  const Block& b = p.block[index];
  for (int u = 0; u < b.size; ++u) w.acceleration[p.unknown[b.column_begin + u]] = acceleration(u);
  accelerate_block(p, w, b, false);
  second_of_equations(p, w, b);
  for (int i = 0; i < b.rows; ++i) second.put(i, -w.right[i]);
}

}  // namespace
