// The verdict on a block where no condition is wanted: its factors at the closed place.
#pragma once

#include "rows/position.hpp"

namespace {

// Of the packs that go together; `keep_jacobian` sees each one's matrix before it is factored.
template <class F>
inline void judge_blocks(const Plan& p, int index, const Request&, Judged* pack, int count, F&& keep_jacobian) {
  for (int k = 0; k < count; ++k) {
    Workspace& w = pack[k].w;
    const BlockMatrices at = matrices_of(p, w, index);
    block_screws(p, w, p.block[index]);
    find_jacobian(p, w, index, at);
    keep_jacobian(k, at);
    at.factor_jacobian();
    pack[k].side = at.side();
    pack[k].condition = Pack(__builtin_nan(""));
  }
}

}  // namespace
