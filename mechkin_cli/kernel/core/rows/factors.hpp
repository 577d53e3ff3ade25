// Factorisation of a block's Jacobian: LU where it is square, Householder QR on all rows where it has more rows
// than columns (overconstrained loops).
//
// One factorisation serves Newton, velocities, accelerations and, transposed, the reactions. With QR the
// transposed solution is the one of least norm; `shift` adds a fixed combination of the null space, by which
// reactions that are not unique give themselves away.
#pragma once

#include "arithmetic/linear.hpp"

namespace {

// Matrix in place: reflectors below and on the diagonal, R above; `pivot` holds R's diagonal, `beta` 2 / v.v.
struct Reflectors {
  Pack* a;  // m x n, row-major
  Pack *pivot, *beta;
  int m, n;
};

inline void reflect(Reflectors f) {
  for (int k = 0; k < f.n; ++k) {
    Pack square = 0.0;
    for (int i = k; i < f.m; ++i) add_product(square, f.a[i * f.n + k], f.a[i * f.n + k]);
    const Pack first = f.a[k * f.n + k], length = copysign(sqrt(square), first);
    f.pivot[k] = -length;
    f.a[k * f.n + k] = first + length;
    const Pack v2 = Pack(2.0) * (square + abs(first * length));
    f.beta[k] = select(v2 > Pack(0.0), Pack(2.0) / v2, Pack(0.0));
    for (int j = k + 1; j < f.n; ++j) {
      Pack s = 0.0;
      for (int i = k; i < f.m; ++i) add_product(s, f.a[i * f.n + k], f.a[i * f.n + j]);
      s *= f.beta[k];
      for (int i = k; i < f.m; ++i) subtract_product(f.a[i * f.n + j], s, f.a[i * f.n + k]);
    }
  }
}

inline Pack least_pivot(Reflectors f) {
  Pack least = abs(f.pivot[0]);
  for (int k = 1; k < f.n; ++k) least = min(least, abs(f.pivot[k]));
  return least;
}

MECHKIN_INLINE void apply_reflector(Reflectors f, int k, Pack* b) {
  Pack s = 0.0;
  for (int i = k; i < f.m; ++i) add_product(s, f.a[i * f.n + k], b[i]);
  s *= f.beta[k];
  for (int i = k; i < f.m; ++i) subtract_product(b[i], s, f.a[i * f.n + k]);
}

// The least-squares solution replaces the first n entries of b (m).
inline void solve(Reflectors f, Pack* b) {
  for (int k = 0; k < f.n; ++k) apply_reflector(f, k, b);
  for (int k = f.n - 1; k >= 0; --k) {
    for (int j = k + 1; j < f.n; ++j) subtract_product(b[k], f.a[k * f.n + j], b[j]);
    b[k] = b[k] / f.pivot[k];
  }
}

// Fixed, incommensurate parts of the null space that the shifts 1 and 2 add.
MECHKIN_INLINE Pack shift_part(int shift, int index) {
  const double parts[2][3] = {{0.731, -0.517, 0.389}, {-0.443, 0.829, 0.617}};
  return shift == 0 ? Pack(0.0) : Pack(parts[shift - 1][index % 3] * (1.0 + index / 3));
}

// The least-norm solution of the transposed system, plus the shift, which is as large as the solution and as `level`;
// b has n entries in, m out.
inline void solve_transposed(Reflectors f, Pack* b, int shift, Pack level = 0.0) {
  Pack largest = level;
  for (int k = 0; k < f.n; ++k) {
    for (int j = 0; j < k; ++j) subtract_product(b[k], f.a[j * f.n + k], b[j]);
    b[k] = b[k] / f.pivot[k];
    largest = max(abs(b[k]), largest);
  }
  const Pack size = select(largest > Pack(0.0), largest, Pack(1.0));
  for (int i = f.n; i < f.m; ++i) b[i] = size * shift_part(shift, i - f.n);
  for (int k = f.n - 1; k >= 0; --k) apply_reflector(f, k, b);
}

}  // namespace
