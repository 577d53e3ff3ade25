// The box that holds a position, drawn together about it.
//
// With y the middle of a box X that holds a zero of F, J its Jacobian over X and any C, that zero lies in Krawczyk's image
// y - C F(y) + (I - C J(X)) (X - y) as well (R. Krawczyk, Computing 4, 1969). F(y) is known to the digits of double-double,
// so that the image is as much narrower than X as |I - C J| is below 1.
#pragma once

#include "proofs/block_systems.hpp"
#include "proofs/enclosed_position.hpp"

namespace {

// An unknown between middle + off -+ radius.
inline void set_unknown(const Plan& p, Workspace& w, const Box& box, int column, DoubleDouble middle, Real off, Real radius) {
  const int state = p.column_state[column];
  Pack& to = state < 0 ? box.turn[column] : w.q[state];
  to = {accurate_sum(middle, off), radius};
}

// Draws the block's own unknowns together; those of the blocks before are. Of more equations than unknowns, which all hold
// at the position, as many are taken.
inline void contract_block(const Plan& p, Workspace& w, const Box& box, const Solving& s, int index) {
  const Block& b = p.block[index];
  const int n = b.size, rows = b.rows, *const unknown = p.unknown + b.column_begin;
  const BlockPlace at = place_of_block(p, index);
  const auto middle = [&](int c) { return p.column_state[c] < 0 ? DoubleDouble(0.0) : w.q[p.column_state[c]].midpoint; };
  for (int u = 0; u < n; ++u) set_unknown(p, w, box, unknown[u], middle(unknown[u]), 0.0, 0.0);
  close_enclosed_block(p, w, box, index);
  Pack *const equations = s.room, *const image = equations + rows;
  for (int i = 0; i < rows; ++i) equations[i] = w.right[i];

  for (int u = 0; u < n; ++u) set_unknown(p, w, box, unknown[u], middle(unknown[u]), 0.0, box.radius[unknown[u]]);
  close_enclosed_block(p, w, box, index);
  enclosed_derivatives(p, w, box, index, s.derivatives);
  for (int i = 0; i < rows; ++i)
    for (int u = 0; u < n; ++u) w.jacobian[at.inverse + i * n + u] = s.derivatives[i * p.columns + unknown[u]];
  const EnclosedMatrix f = matrix_of(p, w, s, index);
  invert_block(f, s, s.inverse + at.inverse);
  apply_inverse(f, equations, image);

  for (int u = 0; u < n; ++u) {
    SumOfDoubles moved;
    for (int v = 0; v < n; ++v) moved.add(f.error[u * n + v], Pack(DoubleDouble(0.0), box.radius[unknown[v]]));
    const Real given = box.radius[unknown[u]], radius = widened(image[u].radius + moved.off());
    const Mask better = radius < given;
    set_unknown(p, w, box, unknown[u], middle(unknown[u]), select(better, -image[u].midpoint.high, Real(0.0)),
                select(better, radius, given));
  }
}

}  // namespace
