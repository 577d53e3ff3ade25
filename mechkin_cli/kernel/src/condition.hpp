// The condition of a block: 1 / smallest singular value of its Jacobian with lengths in parts of the size.
//
// From the factors that Newton or the velocities need anyway: with B the inverse of the scaled Jacobian and G = B^T B,
// the sixteenth power of G (by repeated squaring) is nearly the projector on its dominant directions, and the largest
// eigenvalue follows from its traces to 1 %, for every spectrum: no starting vector that could miss a direction, and
// clusters do no harm. A lane where that is not enough (a block near singular, or factors of a place too far from
// the closed one) is computed by Jacobi rotations to rounding; so is every overconstrained block.
#pragma once

#include "position.hpp"

namespace {

constexpr double ESTIMATED_CONDITION = 1e6;  // largest condition that the estimate stands for
constexpr double FACTORS_OFF = 5e-4;  // largest product of the condition and the way from the factored to the closed place

// A number for each equation of a block, `length` for those that are lengths, else 1.
inline void per_row(const Plan& p, const Block& b, double length, Pack* weight) {
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    with_closing_joint(j.type, [&](auto entry) {
      for (int i = 0; i < entry.equations; ++i) weight[j.row + i] = i < entry.lengths ? length : 1.0;
    });
  }
}

// C = U^-1 L^-1 D^-1 for the factors P A = L U, D the equations' weights in the order of the pivots; row i
// of C over the weight of unknown i. Its singular values are those of the inverse of the weighted matrix.
template <int N>
MECHKIN_INLINE void weighted_inverse(Factors f, int runtime, Pack* inverse_weight, const double* column_weight,
                                     const int* unknown, Pack* c) {
  const int n = N ? N : runtime;
  int s = 0;
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const Mask swapped = f.swap[s++];
      const Pack x = inverse_weight[k], y = inverse_weight[i];
      inverse_weight[k] = select(swapped, y, x);
      inverse_weight[i] = select(swapped, x, y);
    }
  for (int j = 0; j < n; ++j) {
    c[j * n + j] = inverse_weight[j];
    for (int i = 0; i < j; ++i) c[i * n + j] = 0.0;
    for (int i = j + 1; i < n; ++i) {
      Pack sum = 0.0;
      for (int k = j; k < i; ++k) sum -= f.a[i * n + k] * c[k * n + j];
      c[i * n + j] = sum;
    }
  }
  for (int i = n - 1; i >= 0; --i)
    for (int j = 0; j < n; ++j) {
      Pack sum = c[i * n + j];
      for (int k = i + 1; k < n; ++k) sum -= f.a[i * n + k] * c[k * n + j];
      c[i * n + j] = sum * f.a[i * n + i];
    }
  for (int i = 0; i < n; ++i) {
    const Pack scale = 1.0 / column_weight[unknown[i]];
    for (int j = 0; j < n; ++j) c[i * n + j] *= scale;
  }
}

// Half as wide numbers: seven digits are plenty for 1 %, and the powers below take half the time.
typedef float Singles __attribute__((vector_size(4 * LANES)));
MECHKIN_INLINE Singles root(Singles a) {
  Singles r;
  for (int i = 0; i < LANES; ++i) r[i] = __builtin_sqrtf(a[i]);
  return r;
}
MECHKIN_INLINE Doubles root(Doubles a) { return sqrt(Pack(a)).v; }
MECHKIN_INLINE Doubles doubles(Singles a) { return __builtin_convertvector(a, Doubles); }
MECHKIN_INLINE Doubles doubles(Doubles a) { return a; }
MECHKIN_INLINE Singles larger(Singles a, Singles b) { return a < b ? b : a; }
MECHKIN_INLINE Doubles larger(Doubles a, Doubles b) { return a < b ? b : a; }

// out = a^T a, symmetric (n x n); returns its trace.
template <int N, class Numbers>
MECHKIN_INLINE Numbers gram(const Numbers* a, int runtime, Numbers* out) {
  const int n = N ? N : runtime;
  Numbers trace = {};
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      Numbers sum = a[i] * a[j];
      for (int k = 1; k < n; ++k) sum += a[k * n + i] * a[k * n + j];
      out[i * n + j] = sum, out[j * n + i] = sum;
      if (i == j) trace += sum;
    }
  return trace;
}

// The factor t of T2 = l^2p t, l the largest eigenvalue, from the traces T1 and T2 of the powers p and 2 p of a
// symmetric matrix. r = T1^2 / T2 counts the eigenvalues that matter; for a given r, t lies between r (r equal
// eigenvalues) and 1 + (n - 1) y^2 (one above n - 1 equal ones). The middle is off by at most a factor of 1.72 for
// n = 6, and the error of the singular value is the 4 p-th root of that: 0.9 % for p = 16.
template <class Numbers>
MECHKIN_INLINE Numbers multiplicity(Numbers t1, Numbers t2, int n) {
  const Numbers none = {}, one = none + 1, others = none + (float)(n - 1);
  const Numbers r = larger(one, t1 * t1 / t2);
  const Numbers y = (r - one) / (others + root(larger(none, others * others + (r - one) * others * (others - r))));
  return n == 1 ? one : root(r * (one + others * y * y));
}

// Of the n x n matrix c, to 1 %; `power` and `other` are room for n x n numbers each.
template <int N, class Numbers>
MECHKIN_INLINE Pack largest_singular_value(const Pack* c, int runtime, Pack* g, Numbers* power, Numbers* other) {
  const int n = N ? N : runtime, squarings = n > 6 ? 5 : 4;
  const Pack trace = gram<N>(&c->v, runtime, &g->v), inverse = Pack(1.0) / trace;
  // the largest eigenvalue is now between 1 / n and 1
  for (int e = 0; e < n * n; ++e) power[e] = __builtin_convertvector((g[e] * inverse).v, Numbers);
  Numbers t1 = {}, t2 = {};
  for (int s = 0; s < squarings; ++s) {
    t1 = gram<N>(power, runtime, other);
    Numbers* const before = power;
    power = other, other = before;
  }
  for (int e = 0; e < n * n; ++e) t2 += power[e] * power[e];
  Numbers value = t2 / multiplicity(t1, t2, n);
  for (int s = 0; s <= squarings; ++s) value = root(value);
  return sqrt(Pack(doubles(value)) * trace);
}

template <int N>
MECHKIN_INLINE void estimate_condition(Factors f, int runtime, Pack* weight, const double* column_weight,
                                       const int* unknown, Pack* scratch, Pack* result) {
  const int n = N ? N : runtime;
  weighted_inverse<N>(f, runtime, weight, column_weight, unknown, scratch);
  Pack* const g = scratch + n * n;
  if constexpr (N > 0) {
    Singles power[2][N * N];
    *result = largest_singular_value<N>(scratch, runtime, g, power[0], power[1]);
  } else {
    *result = largest_singular_value<N>(scratch, runtime, g, &scratch[2 * n * n].v, &scratch->v);
  }
}

// To 1 % from the block's factors.
inline Pack estimated_condition(const Plan& p, Workspace& w, int index) {
  const Block& b = p.block[index];
  const Factors f = matrices_of(p, w, index).lu();
  const int* unknown = p.unknown + b.column_begin;
  Pack result;
  per_row(p, b, 1.0 / p.row_weight, w.right);
  switch (f.n) {
    case 1: estimate_condition<1>(f, 1, w.right, p.column_weight, unknown, w.scratch, &result); break;
    case 2: estimate_condition<2>(f, 2, w.right, p.column_weight, unknown, w.scratch, &result); break;
    case 3: estimate_condition<3>(f, 3, w.right, p.column_weight, unknown, w.scratch, &result); break;
    case 4: estimate_condition<4>(f, 4, w.right, p.column_weight, unknown, w.scratch, &result); break;
    case 5: estimate_condition<5>(f, 5, w.right, p.column_weight, unknown, w.scratch, &result); break;
    case 6: estimate_condition<6>(f, 6, w.right, p.column_weight, unknown, w.scratch, &result); break;
    default: estimate_condition<0>(f, f.n, w.right, p.column_weight, unknown, w.scratch, &result);
  }
  return result;
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
  const bool by_newton = square && r.demand == DEMAND_CONDITION && !r.side && !r.pivot && !r.jacobian;
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
