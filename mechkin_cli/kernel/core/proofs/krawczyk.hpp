// Krawczyk's operator on all unknowns of the mechanism at once (R. Krawczyk, Newton-Algorithmen zur Bestimmung von
// Nullstellen mit Fehlerschranken, Computing 4, 1969): with y the middle of a box X = y + [-r, r] and any matrix C, if
//
//     |C F(y)| + |I - C J(X)| r < r
//
// in every unknown, F has exactly one zero in X. As C and J are block lower triangular, the radii are found block by block.
// Along a curve all of it are functions of the parameter, C is linear in it, and the bound is taken over all of its values.
#pragma once

#include "proofs/triangular_inverse.hpp"

namespace {

// A box is made wider than what is to be found in it by this factor: over it the Jacobian varies.
constexpr double INFLATION = 1.5;
// It is wider than nothing.
constexpr double LEAST_RADIUS = 0x1p-70;
// Steps in which the radii are found; a proof that needs more is too weak to be one.
constexpr int RADIUS_STEPS = 12;
// Above the rounding of sums of at most 2^10 terms.
constexpr double SUM_OUTWARD = 1.0 + 0x1p-40;

// |C F| into w.residual.
inline void find_residual(const Plan& p, Proof& w, const BlockPart& part) {
  for (int u = 0; u < part.b.size; ++u) {
    const Pack* const row = w.inverse + part.inverse + u * part.end;
    Pack sum = 0.0;
    each_block_below(p, w, part.index, [&](int, int begin, int end) {
      for (int e = begin; e < end; ++e) sum += row[e] * w.at.equation[e];
    });
    w.residual[part.unknown[u]] = bound(sum);
  }
}

// |I - C J| of a block's unknowns by those of the blocks that it hangs on and its own, into w.influence.
inline void find_influence_of_radii(const Plan& p, Proof& w, const BlockPart& part) {
  for (int u = 0; u < part.b.size; ++u) {
    const Pack* const row = w.inverse + part.inverse + u * part.end;
    for (int c = 0; c < p.columns; ++c) {
      Real& to = w.influence[u * p.columns + c];
      to = 0.0;
      const int of = p.column_block[c];
      if (of < 0 || of > part.index || !w.hangs[part.index * p.blocks + of]) continue;
      Pack sum = c == part.unknown[u] ? -1.0 : 0.0;
      each_block_below(p, w, part.index, [&](int k, int begin, int end) {
        if (!w.reads[k * p.blocks + of]) return;
        for (int e = begin; e < end; ++e) sum += row[e] * w.at.jacobian[e * p.columns + c];
      });
      to = bound(sum);
    }
  }
}

// |C F(y)| + |I - C J| r of one unknown.
inline Real image_radius(const Plan& p, const Proof& w, const BlockPart& part, int u) {
  Real sum = w.residual[part.unknown[u]];
  for (int c = 0; c < p.columns; ++c) sum += w.influence[u * p.columns + c] * w.radius[c];
  return sum * Real(SUM_OUTWARD);
}

// A box that has a chance, from the Jacobian at the middle.
template <class Least>
inline void guess_radii(const Plan& p, Proof& w, const BlockPart& part, Least&& least) {
  const int* const unknown = part.unknown;
  for (int u = 0; u < part.b.size; ++u) w.radius[unknown[u]] = w.residual[unknown[u]];
  for (int step = 0; step < RADIUS_STEPS; ++step)
    for (int u = 0; u < part.b.size; ++u) w.radius[unknown[u]] = image_radius(p, w, part, u);
  for (int u = 0; u < part.b.size; ++u) {
    Real& r = w.radius[unknown[u]];
    r = max(r * Real(INFLATION) + Real(LEAST_RADIUS), least(unknown[u]));
  }
}

// At most the size of the equations without a part in C that do not follow from the others, anywhere in the box.
inline Real size_beyond(const Plan& p, const Proof& w, const BlockPart& part) {
  Real worst = 0.0;
  if (part.b.rows == part.b.size) return worst;
  for (int e = part.first; e < part.end; ++e) {
    if (does_follow(w, e)) continue;
    Real share = 0.0, size = w.size[e];
    for (int u = 0; u < part.b.size; ++u) share += polynomial_bound(w.inverse[part.inverse + u * part.end + e]);
    for (int c = 0; c < p.columns; ++c)
      if (p.column_block[c] >= 0) size += bound(w.at.jacobian[e * p.columns + c]) * w.radius[c];
    size = size * Real(SUM_OUTWARD);
    worst = select(share > Real(0.0), worst, select(size <= worst, worst, size));  // a NaN wins
  }
  return worst;
}

struct Verdict {
  Mask proven;
  Real contraction, beyond;
};

// Whether the operator maps the box of all unknowns, w.radius, into itself; at a point w.residual gets what it leaves.
inline Verdict judge_boxes(const Plan& p, Proof& w) {
  Verdict verdict = {w.at.side > Real(0.0), 0.0, 0.0};
  for (int b = 0; b < p.blocks; ++b) {
    const BlockPart part = part_of_block(p, b);
    find_influence_of_radii(p, w, part);
    for (int u = 0; u < part.b.size; ++u) {
      const int column = part.unknown[u];
      const Real image = image_radius(p, w, part, u), r = w.radius[column];
      verdict.proven = verdict.proven & (image < r);
      const Real share = (image - w.residual[column]) / r;
      verdict.contraction = select(share <= verdict.contraction, verdict.contraction, share);
      if (ORDER == 0) w.residual[column] = image;  // the box contracted once
    }
    const Real beyond = size_beyond(p, w, part);
    verdict.beyond = select(beyond <= verdict.beyond, verdict.beyond, beyond);
  }
  return verdict;
}

}  // namespace
