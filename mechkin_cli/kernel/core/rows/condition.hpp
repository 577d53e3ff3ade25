// The condition of a block: 1 / smallest singular value of its Jacobian with lengths in parts of the size.
//
// It is estimated to 1 % from the factors that Newton or the velocities need anyway. A lane where that is not enough (a
// block near singular, or factors of a place too far from the closed one) is computed by Jacobi rotations to rounding;
// so is every overconstrained block, and every one where it is asked for, but for bands: those below the limit are known
// well enough to say that they are below it.
#pragma once

#include "rows/condition_estimate.hpp"
#include "rows/inverse_norm.hpp"
#include "rows/position.hpp"

namespace {

// The largest condition that the estimate stands for: well below 1e7, where rows count as near singular
// (tolerances.CONDITION_NEAR_SINGULAR), so that no row's verdict hangs on the estimate's 1 %.
constexpr double ESTIMATED_CONDITION = 1e6;
// Unknowns of a band up to which it is computed to rounding beyond that. Rotations take the cube of their number; and one
// singular value that lies so far below most others comes out of Lanczos' method long before its last step.
constexpr int MOST_ROTATED = 120;
// The largest product of the condition and the way from the factored to the closed place, which is about the relative
// error of the smallest singular value that it causes: a twentieth of the 1 % that the estimate promises.
constexpr double FACTORS_OFF = 5e-4;

// A number for each equation of a block, `length` for those that are lengths, else 1.
inline void per_row(const Plan& p, const Block& b, double length, Pack* weight) {
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    with_closing_joint(j.type, [&](auto entry) {
      for (int i = 0; i < entry.equations; ++i) weight[j.row + i] = i < entry.lengths ? length : 1.0;
    });
  }
  for (int i = b.rows - b.charts; i < b.rows; ++i) weight[i] = 1.0;
}

// To 1 % from the factors of the packs that go together.
inline void estimate_conditions(const Plan& p, int index, Judged* pack, int count) {
  const Block& b = p.block[index];
  for (int k = 0; k < count && b.band_entries; ++k) {
    Workspace& w = pack[k].w;
    per_row(p, b, 1.0 / p.row_weight, w.right);
    pack[k].condition = inverse_norm(matrices_of(p, w, index), w.right, p.column_weight, p.unknown + b.column_begin, w.scratch);
  }
  if (b.band_entries) return;
  InverseNorm norm[PACKS_OF_ESTIMATE];
  for (int k = 0; k < count; ++k) {
    Workspace& w = pack[k].w;
    per_row(p, b, 1.0 / p.row_weight, w.right);
    norm[k] = {matrices_of(p, w, index).lu(), w.right, w.scratch, Pack(0.0)};
  }
  find_inverse_norms(norm, count, p.column_weight, p.unknown + b.column_begin);
  for (int k = 0; k < count; ++k) pack[k].condition = norm[k].value;
}

// To rounding, from the screws at the closed place.
inline Pack exact_condition(const Plan& p, Workspace& w, int index) {
  const Block& b = p.block[index];
  const int m = b.rows, n = b.size;
  block_jacobian(p, w, index, w.scratch);
  per_row(p, b, p.row_weight, w.right);
  for (int u = 0; u < n; ++u) {
    const Pack weight = p.column_weight[p.unknown[b.column_begin + u]];
    for (int i = 0; i < m; ++i) w.scratch[i * n + u] = w.scratch[i * n + u] * w.right[i] * weight;
  }
  return Pack(1.0) / smallest_singular_value(w.scratch, m, n, w.right);
}

// A block's factors at its closed place.
template <class F>
inline void factor_closed(const Plan& p, Workspace& w, int index, F&& keep_jacobian) {
  const BlockMatrices at = matrices_of(p, w, index);
  block_screws(p, w, p.block[index]);
  find_jacobian(p, w, index, at);
  keep_jacobian(at);
  at.factor_jacobian();
}

// Of the packs that go together. Each is factored at its closed place, unless only its verdict is wanted and Newton's last
// factors serve; `keep_jacobian` sees its matrix before.
template <class F>
inline void judge_blocks(const Plan& p, int index, const Request& r, Judged* pack, int count, F&& keep_jacobian) {
  const bool square = p.block[index].rows == p.block[index].size;
  const bool has_band = p.block[index].band_entries > 0, is_large = has_band && p.block[index].size > MOST_ROTATED;
  const bool by_newton = square && !is_large && r.demand == DEMAND_CONDITION && !r.pivot && !r.jacobian;
  const auto side_of = [&](const Judged& j) { return matrices_of(p, j.w, index).side(); };
  for (int k = 0; k < count; ++k) {
    if (!by_newton) factor_closed(p, pack[k].w, index, [&](const BlockMatrices& at) { keep_jacobian(k, at); });
    pack[k].side = side_of(pack[k]), pack[k].condition = Pack(0.0);
  }
  if (!(r.demand & DEMAND_CONDITION)) return;
  const bool estimates = square && (has_band || !(r.demand & DEMAND_SINGULAR));
  if (estimates) estimate_conditions(p, index, pack, count);
  for (Judged* j = pack; j < pack + count; ++j) {
    Mask serves = all_lanes(estimates);
    if (estimates && !is_large) serves = j->condition <= Pack(ESTIMATED_CONDITION);
    if (by_newton) serves = serves & (j->condition * j->closed.last_step <= Pack(FACTORS_OFF));
    if (all(serves)) continue;
    if (by_newton) block_screws(p, j->w, p.block[index]);
    j->condition = select(serves, j->condition, exact_condition(p, j->w, index));
    if (!by_newton) continue;
    const BlockMatrices at = matrices_of(p, j->w, index);
    find_jacobian(p, j->w, index, at);
    at.factor_jacobian();
    j->side = select(serves, j->side, side_of(*j));
  }
}

}  // namespace
