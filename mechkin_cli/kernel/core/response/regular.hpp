// Whether a block's Jacobian is joined with that of a place before by a segment of regular matrices: the spectral
// radius of J^+ J_0 - I is at most a limit (judge.cpp has the same test in doubles, docs/numerics.md what it shows).
#pragma once

#include "rows/position.hpp"

namespace {

inline Pack frobenius(const Pack* e, int n) {
  Pack sum = 0.0;
  for (int k = 0; k < n * n; ++k) sum += e[k] * e[k];
  return sqrt(sum);
}

// |E^k|^(1/k) bounds the radius for k = 1, 2, 4 ... 16; the norm is kept as a power of the limit, so that no root is
// needed. E is lost.
inline Mask radius_within(Pack* e, Pack* square, int n, Pack limit) {
  Mask within = frobenius(e, n) <= limit;
  for (int k = 2; k <= 16 && !all(within); k *= 2) {
    limit = limit * limit;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        Pack sum = 0.0;
        for (int l = 0; l < n; ++l) sum += e[i * n + l] * e[l * n + j];
        square[i * n + j] = sum;
      }
    for (int k2 = 0; k2 < n * n; ++k2) e[k2] = square[k2];
    within = within | (frobenius(e, n) <= limit);
  }
  return within;
}

// Unknowns of blocks whose sizes the compiler knows: they are solved for column after column.
constexpr int MOST_BY_COLUMNS = 6;

// Of a factored block against its Jacobian at the origin (rows x size); `room` for two square matrices.
// Kept apart: inlined into its caller GCC 12 fails on it (internal error in gimple_expand_vec_cond_expr) with two lanes.
__attribute__((noinline)) Mask is_regular(const Plan& p, Workspace& w, int block, const Pack* origin, double limit, Pack* room) {
  const BlockMatrices at = matrices_of(p, w, block);
  const int n = at.n;
  if (n > MOST_BY_COLUMNS && at.m == n) {
    for (int e = 0; e < n * n; ++e) room[e] = origin[e];
    solve_columns(at.lu(), room, n);
  } else {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < at.m; ++i) w.right[i] = origin[i * n + j];
      at.solve_equations(w.right);
      for (int i = 0; i < n; ++i) room[i * n + j] = w.right[i];
    }
  }
  for (int j = 0; j < n; ++j) room[j * n + j] -= Pack(1.0);
  return radius_within(room, room + n * n, n, Pack(limit));
}

}  // namespace
