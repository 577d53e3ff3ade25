// The verdict on a block where no condition is wanted: its factors at the closed place.
#pragma once

#include "position.hpp"

namespace {

struct BlockVerdict {
  Pack side, condition;  // sign of a square block's determinant; no number
};

// `keep_jacobian` sees the matrix before it is factored.
template <class F>
inline BlockVerdict judge_block(const Plan& p, Workspace& w, int index, const Request&, const Closed&, F&& keep_jacobian) {
  const BlockMatrices at = matrices_of(p, w, index);
  block_screws(p, w, p.block[index]);
  block_jacobian(p, w, index, at.jacobian);
  keep_jacobian(at);
  at.factor_jacobian();
  return {at.m == at.n ? determinant_sign(at.lu()) : Pack(1.0), Pack(__builtin_nan(""))};
}

}  // namespace
