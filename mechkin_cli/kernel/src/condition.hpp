// The condition of a block: 1 / smallest singular value of its Jacobian with lengths in parts of the size.
//
// It is estimated to 1 % from the factors that Newton or the velocities need anyway. A lane where that is not enough (a
// block near singular, or factors of a place too far from the closed one) is computed by Jacobi rotations to rounding;
// so is every overconstrained block.
#pragma once

#include "condition_estimate.hpp"
#include "position.hpp"

namespace {

// The largest condition that the estimate stands for: well below 1e7, where rows count as near singular
// (tolerances.CONDITION_NEAR_SINGULAR), so that no row's verdict hangs on the estimate's 1 %.
constexpr double ESTIMATED_CONDITION = 1e6;
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

// To 1 % from the block's factors.
inline Pack estimated_condition(const Plan& p, Workspace& w, int index) {
  const Block& b = p.block[index];
  const Factors f = matrices_of(p, w, index).lu();
  per_row(p, b, 1.0 / p.row_weight, w.right);
  return inverse_norm(f, w.right, p.column_weight, p.unknown + b.column_begin, w.scratch);
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

struct BlockVerdict {
  Pack side, condition;  // sign of a square block's determinant
};

// Factors of a block at its closed place, unless only its verdict is wanted and Newton's last ones serve;
// `keep_jacobian` sees the matrix before it is factored.
template <class F>
MECHKIN_INLINE BlockVerdict judge_block(const Plan& p, Workspace& w, int index, const Request& r, const Closed& closed,
                                        F&& keep_jacobian) {
  const BlockMatrices at = matrices_of(p, w, index);
  const bool square = at.m == at.n, rounding = r.demand & DEMAND_SINGULAR;
  const bool by_newton = square && r.demand == DEMAND_CONDITION && !r.pivot && !r.jacobian;
  BlockVerdict verdict = {Pack(1.0), Pack(0.0)};
  if (by_newton) {
    verdict = {determinant_sign(at.lu()), estimated_condition(p, w, index)};
    const Mask serves = (verdict.condition <= Pack(ESTIMATED_CONDITION)) &
                        (verdict.condition * closed.last_step <= Pack(FACTORS_OFF));
    if (all(serves)) return verdict;
    block_screws(p, w, p.block[index]);
    verdict.condition = select(serves, verdict.condition, exact_condition(p, w, index));
    block_jacobian(p, w, index, at.jacobian);
    at.factor_jacobian();
    verdict.side = select(serves, verdict.side, determinant_sign(at.lu()));
    return verdict;
  }
  block_screws(p, w, p.block[index]);
  block_jacobian(p, w, index, at.jacobian);
  keep_jacobian(at);
  at.factor_jacobian();
  if (square) verdict.side = determinant_sign(at.lu());
  if (!(r.demand & DEMAND_CONDITION)) return verdict;
  Mask serves = all_lanes(false);
  if (square && !rounding) {
    verdict.condition = estimated_condition(p, w, index);
    serves = verdict.condition <= Pack(ESTIMATED_CONDITION);
  }
  if (!all(serves)) verdict.condition = select(serves, verdict.condition, exact_condition(p, w, index));
  return verdict;
}

}  // namespace
