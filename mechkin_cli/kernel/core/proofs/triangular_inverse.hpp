// C, an approximate inverse of the Jacobian of all blocks at once: block lower triangular, as the Jacobian is.
//
//     C_bb = J_bb^-1,    C_ba = -J_bb^-1 (sum over a <= k < b of J_bk C_ka)
//
// With it I - C J is small in all blocks: what an earlier block's unknowns move a later one's by is subtracted with its
// sign, and only how far the Jacobian varies over the box counts with its size.
#pragma once

#include "proofs/proof_memory.hpp"

namespace {

constexpr double CURVE_PLACE = 0.70710678118654752;  // where C is exact on a curve: the least largest error of a line

// The value of a model at a parameter, rounded.
inline Real value_at(const Pack& a, double t) {
  Real sum = a.c[ORDER];
  for (int k = ORDER - 1; k >= 0; --k) sum = sum * Real(t) + a.c[k];
  return sum;
}

// A block's rows of C at a parameter into `lines`, which has those of the blocks before. The equations that are solved for
// are the same all along a curve; what follows from others is none of them.
inline void invert_at(const Plan& p, Proof& w, const BlockPart& part, double t, Real* lines) {
  const int n = part.b.size, m = part.b.rows;
  const auto at = [&](double t) {
    return [&w, &p, &part, t](int i, int u) {
      return value_at(w.at.jacobian[(part.first + i) * p.columns + part.unknown[u]], t);
    };
  };
  const auto chooser = [&](int i, int u) { return does_follow(w, part.first + i) ? Real(0.0) : at(0.0)(i, u); };
  invert_lanes(n, m, at(t), chooser, w.scalar, w.square);
  Real* const own = lines + part.inverse;
  for (int e = 0; e < m * part.first; ++e) w.carried[e] = 0.0;
  for (int a = 0; a < part.index; ++a) {
    if (!w.reads[part.index * p.blocks + a]) continue;
    const BlockPart before = part_of_block(p, a);
    for (int i = 0; i < m; ++i)
      for (int u = 0; u < before.b.size; ++u) {
        const Real slope = value_at(w.at.jacobian[(part.first + i) * p.columns + before.unknown[u]], t);
        const Real* const row = lines + before.inverse + u * before.end;
        for (int e = 0; e < before.end; ++e) w.carried[i * part.first + e] += slope * row[e];
      }
  }
  for (int u = 0; u < n; ++u) {
    Real* const row = own + u * part.end;
    for (int e = 0; e < part.first; ++e) {
      Real sum = 0.0;
      for (int i = 0; i < m; ++i) sum -= w.square[u * m + i] * w.carried[i * part.first + e];
      row[e] = sum;
    }
    for (int i = 0; i < m; ++i) row[part.first + i] = w.square[u * m + i];
  }
}

// A block's rows of C: at the middle of a point, on a curve the line through its values at two places.
inline void find_inverse(const Plan& p, Proof& w, const BlockPart& part) {
  invert_at(p, w, part, ORDER ? -CURVE_PLACE : 0.0, w.line);
  if (ORDER) invert_at(p, w, part, CURVE_PLACE, w.other_line);
  for (long e = part.inverse; e < part.inverse + part.b.size * part.end; ++e) {
    w.inverse[e] = Pack(w.line[e]);
    if constexpr (ORDER > 0) {
      w.inverse[e].c[0] = Real(0.5) * (w.line[e] + w.other_line[e]);
      w.inverse[e].c[1] = (w.other_line[e] - w.line[e]) * Real(0.5 / CURVE_PLACE);
    }
  }
}

}  // namespace
