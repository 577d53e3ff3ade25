// Levenberg-Marquardt on the closing equations of one block, from many starts at once.
//
// Minimises the sum of squared closing equations; each lane keeps its own damping (Marquardt's scaling by
// the diagonal of J^T J). A lane ends when it is closed or when its damping says that it is stuck.
#pragma once

#include "rows/position.hpp"

namespace {

// Damping at the start, its least, and where a lane is stuck; its factors after a step that lowers the sum of squares
// and after one that does not. Least and stuck leave fourteen decades of room, as much as double precision tells.
struct SearchScales {
  double start = 1e-2, least = 1e-12, stuck = 1e10, success = 0.15, failure = 5.0;
};

MECHKIN_INLINE Pack sum_of_squares(const Pack* r, int n) {
  Pack s = 0.0;
  for (int i = 0; i < n; ++i) s += r[i] * r[i];
  return s;
}

// One damped step from the Jacobian in `a` and the residual in w.right; the step replaces w.right.
inline void damped_step(Workspace& w, const BlockMatrices& at, Pack damping) {
  const Pack* a = at.jacobian;
  const int m = at.m, n = at.n;
  Pack* normal = w.scratch;
  Pack* gradient = at.multiplier;
  for (int i = 0; i < n; ++i) {
    Pack g = 0.0;
    for (int k = 0; k < m; ++k) g += a[k * n + i] * w.right[k];
    gradient[i] = -g;
    for (int j = 0; j < n; ++j) {
      Pack s = 0.0;
      for (int k = 0; k < m; ++k) s += a[k * n + i] * a[k * n + j];
      normal[i * n + j] = s;
    }
  }
  // 1e-6 of a unit screw's square: an unknown that no equation moves (a zero column) is damped, too
  for (int i = 0; i < n; ++i) normal[i * n + i] += damping * (normal[i * n + i] + Pack(1e-6));
  const Factors f = {normal, at.swap, n};
  factor(f);
  solve(f, gradient);
  for (int i = 0; i < n; ++i) w.right[i] = gradient[i];
}

// The same with a band: the normal equations hold two unknowns where some equation holds both. They are positive definite, so
// that no rows are exchanged.
inline void damped_step_by_band(Workspace& w, const BlockMatrices& at, Pack damping) {
  const Band f = at.band();
  const int n = at.n, closing = at.m - at.charts;
  int wide = 1;  // entries of a row up to the diagonal
  for (int e = 0, u = 0; e < closing; ++e) {
    while (f.row[u].end <= e) ++u;
    wide = f.row[e].reach - u > wide ? f.row[e].reach - u : wide;
  }
  Pack *const normal = w.scratch, *const gradient = at.multiplier;
  const auto entry = [&](int i, int j) -> Pack& { return normal[i * wide + j - i + wide - 1]; };
  for (int k = 0; k < n * wide; ++k) normal[k] = 0.0;
  for (int u = 0; u < n; ++u) gradient[u] = 0.0;
  for (int e = 0, first = 0; e < closing; ++e) {
    while (f.row[first].end <= e) ++first;
    const int reach = f.row[e].reach;
    for (int i = first; i < reach; ++i) {
      if (f.row[i].begin > e || f.row[i].end <= e) continue;
      const Pack a = *f.in_column(i, e);
      gradient[i] -= a * w.right[e];
      for (int j = first; j <= i; ++j)
        if (f.row[j].begin <= e && f.row[j].end > e) entry(i, j) += a * *f.in_column(j, e);
    }
  }
  for (int i = 0; i < n; ++i) entry(i, i) += damping * (entry(i, i) + Pack(1e-6));  // as in damped_step
  for (int k = 0; k < n; ++k) {
    const Pack inverse = Pack(1.0) / entry(k, k);
    const int end = k + wide < n ? k + wide : n;
    for (int i = k + 1; i < end; ++i) {
      const Pack l = entry(i, k) * inverse;
      for (int j = k + 1; j <= i; ++j) subtract_product(entry(i, j), l, entry(j, k));
      subtract_product(gradient[i], l, gradient[k]);
    }
    // the columns above the diagonal of L^T are those below it of L D
    gradient[k] *= inverse;
    entry(k, k) = inverse;
  }
  for (int k = n - 1; k >= 0; --k) {
    const int end = k + wide < n ? k + wide : n;
    Pack sum = 0.0;
    for (int i = k + 1; i < end; ++i) sum += entry(i, k) * gradient[i];
    gradient[k] -= sum * entry(k, k);
  }
  for (int i = 0; i < n; ++i) w.right[i] = gradient[i];
}

// Rows of a chart that say nothing: the loops of a free motion close anywhere along it, by damping near the start.
inline void leave_free(const Plan& p, Workspace& w) {
  for (int e = 0; e < p.charts * p.columns; ++e) w.direction[e] = 0.0;
  for (int s = 0; s < p.states; ++s) w.origin[s] = 0.0;
  for (int i = 0; i < p.charts; ++i) w.place[i] = 0.0;
}

// Runs one pack of starts in w.q to the end; returns the residuals.
inline Pack search_block(const Plan& p, Workspace& w, int index, int iterations, double accept) {
  const Block& b = p.block[index];
  const BlockMatrices at = matrices_of(p, w, index);
  const SearchScales scale;
  Pack damping = scale.start, residual = 0.0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    place_block(p, w, b);
    residual = block_residual(p, w, b).size;
    const Mask ended = (residual <= Pack(accept)) | (damping > Pack(scale.stuck));
    if (all(ended)) break;
    block_screws(p, w, b);
    find_jacobian(p, w, index, at);
    const Pack before = sum_of_squares(w.right, b.rows);
    at.row ? damped_step_by_band(w, at, damping) : damped_step(w, at, damping);
    for (int s = 0; s < p.states; ++s) w.saved[s] = w.q[s];
    advance_block(p, w, index, w.right, ~ended);
    place_block(p, w, b);
    block_residual(p, w, b);
    const Mask better = sum_of_squares(w.right, b.rows) < before;
    for (int s = 0; s < p.states; ++s) w.q[s] = select(better, w.q[s], w.saved[s]);
    damping = select(better, max(Pack(scale.success) * damping, Pack(scale.least)), Pack(scale.failure) * damping);
  }
  place_block(p, w, b);
  return block_residual(p, w, b).size;
}

}  // namespace
