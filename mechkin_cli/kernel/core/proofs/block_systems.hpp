// The linear systems of all blocks: where they stand, and what solves them.
#pragma once

#include "proofs/enclosed_solution.hpp"
#include "proofs/inverse_lanes.hpp"
#include "rows/workspace.hpp"

namespace {

// What the solutions of one pack of rows need beside a workspace, block after block.
struct Solving {
  Real* inverse;  // blocks' size x rows
  Real* error;    // blocks' size x size
  Real* across;   // largest block: rows x rows
  Pack* derivatives;  // largest block: rows x columns
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

// An approximate inverse of the block's matrix in w.jacobian, and |I - C A|.
inline void invert_block(const EnclosedMatrix& f, const Solving& s, Real* inverse) {
  const auto midpoint = [&](int i, int u) { return f.a[i * f.n + u].midpoint.high; };
  invert_lanes(f.n, f.m, midpoint, midpoint, s.scalar, inverse);
  find_error(f);
}

}  // namespace
