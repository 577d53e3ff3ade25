// Boxes of all unknowns as the closing equations take them: those of orientations are boxes of increments.
#pragma once

#include "proofs/proof_memory.hpp"

namespace {

// Calls orientation(first column, first state) for what the blocks find of the tree's balls.
template <class Found>
void each_found_orientation(const Plan& p, Found&& found) {
  for (int b = 0; b < p.blocks; ++b)
    for (int o = p.block[b].joint_begin; o < p.block[b].joint_end; ++o) {
      const TreeJoint& t = p.joints[p.order[o]];
      with_tree_joint(t.type, [&](auto entry) {
        if (entry.states != entry.freedoms && p.column_block[t.column] >= 0) found(t.column, t.state);
      });
    }
}

// The box into w.at.q. The product (1, x / 2) q moves each part of q by halves of the others times x.
void widen_states(const Plan& p, Proof& w) {
  for (int s = 0; s < p.states; ++s) w.at.q[s] = w.middle[s];
  for (int c = 0; c < p.columns; ++c)
    if (p.column_block[c] >= 0 && p.column_state[c] >= 0)
      w.at.q[p.column_state[c]] = widened(w.middle[p.column_state[c]], w.radius[c]);
  each_found_orientation(p, [&](int c, int s) {
    Real size[4], half[3];
    for (int i = 0; i < 4; ++i) size[i] = bound(w.middle[s + i]);
    for (int i = 0; i < 3; ++i) half[i] = Real(0.5) * w.radius[c + i];
    const Real by[4] = {half[0] * size[1] + half[1] * size[2] + half[2] * size[3],
                        half[0] * size[0] + half[1] * size[3] + half[2] * size[2],
                        half[1] * size[0] + half[0] * size[3] + half[2] * size[1],
                        half[2] * size[0] + half[0] * size[2] + half[1] * size[1]};
    for (int i = 0; i < 4; ++i) w.at.q[s + i] = widened(w.middle[s + i], by[i] * Real(OUTWARD));
  });
}

// Columns of an orientation are by rotations omega; increments x have omega = (x' + x/2 x x') / (1 + |x|^2 / 4).
void columns_by_increments(const Plan& p, Proof& w) {
  each_found_orientation(p, [&](int c, int) {
    Real half[3], square = 0.0;
    for (int i = 0; i < 3; ++i) half[i] = Real(0.5) * w.radius[c + i], square += half[i] * half[i];
    for (int e = 0; e < equations_of(p); ++e) {
      Pack* const j = w.at.jacobian + e * p.columns + c;
      const Real size[3] = {bound(j[0]), bound(j[1]), bound(j[2])};
      for (int i = 0; i < 3; ++i) {
        const int k = (i + 1) % 3, l = (i + 2) % 3;
        j[i] = widened(j[i], (square * size[i] + half[l] * size[k] + half[k] * size[l]) * Real(OUTWARD));
      }
    }
  });
}

}  // namespace
