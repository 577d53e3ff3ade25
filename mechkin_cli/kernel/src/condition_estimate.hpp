// The largest singular value of the inverse of a factored and weighted square matrix, to 1 %.
//
// With B the inverse and G = B^T B over its trace, the sixteenth power of G (by repeated squaring) is nearly the
// projector on its dominant directions, and the largest eigenvalue follows from its traces, for every spectrum: there
// is no starting vector that could miss a direction, and clusters of singular values do no harm.
#pragma once

#include "linear.hpp"

namespace {

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

// The largest singular value of the inverse of diag(1 / inverse_weight) A diag(column_weight), A as factored;
// `inverse_weight` (n) is used up, `scratch` is room for 3 n x n packs.
inline Pack inverse_norm(Factors f, Pack* inverse_weight, const double* column_weight, const int* unknown,
                         Pack* scratch) {
  Pack r;
  switch (f.n) {
    case 1: estimate_condition<1>(f, 1, inverse_weight, column_weight, unknown, scratch, &r); break;
    case 2: estimate_condition<2>(f, 2, inverse_weight, column_weight, unknown, scratch, &r); break;
    case 3: estimate_condition<3>(f, 3, inverse_weight, column_weight, unknown, scratch, &r); break;
    case 4: estimate_condition<4>(f, 4, inverse_weight, column_weight, unknown, scratch, &r); break;
    case 5: estimate_condition<5>(f, 5, inverse_weight, column_weight, unknown, scratch, &r); break;
    case 6: estimate_condition<6>(f, 6, inverse_weight, column_weight, unknown, scratch, &r); break;
    default: estimate_condition<0>(f, f.n, inverse_weight, column_weight, unknown, scratch, &r);
  }
  return r;
}

}  // namespace
