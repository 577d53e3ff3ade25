// Approximate inverses in doubles, each lane by itself.
#pragma once

#include "arithmetic/pack.hpp"

namespace {

// Doubles that invert_lanes needs for blocks of up to `rows` equations.
inline long inverse_numbers(long rows) { return 4 * rows * rows + 2 * rows; }

// Chooses n of m equations of the m x n matrix a by Gauss's elimination with the largest pivot of all: `chosen` (n).
inline void choose_equations(int n, int m, double* a, int* chosen, unsigned char* used) {
  for (int i = 0; i < m; ++i) used[i] = false;
  for (int u = 0; u < n; ++u) {
    int row = -1, column = u;
    double best = -1.0;
    for (int i = 0; i < m; ++i)
      for (int k = u; k < n && !used[i]; ++k) {
        const double size = a[i * n + k] < 0 ? -a[i * n + k] : a[i * n + k];
        if (size > best) best = size, row = i, column = k;
      }
    if (row < 0) row = u;  // all that is left is NaN: nothing will be proven
    used[row] = true, chosen[u] = row;
    for (int i = 0; i < m; ++i) {
      const double x = a[i * n + u];
      a[i * n + u] = a[i * n + column], a[i * n + column] = x;
    }
    for (int i = 0; i < m; ++i) {
      if (used[i]) continue;
      const double f = a[i * n + u] / a[row * n + u];
      for (int k = u; k < n; ++k) a[i * n + k] -= f * a[row * n + k];
    }
  }
}

// Inverse of the n x n matrix a by Gauss and Jordan's elimination with the largest pivot of a column; a is spent.
inline void invert(int n, double* a, double* inverse) {
  for (int e = 0; e < n * n; ++e) inverse[e] = e % (n + 1) ? 0.0 : 1.0;
  for (int u = 0; u < n; ++u) {
    int row = u;
    for (int i = u + 1; i < n; ++i)
      if (a[i * n + u] * a[i * n + u] > a[row * n + u] * a[row * n + u]) row = i;
    const double pivot = 1.0 / a[row * n + u];
    for (int k = 0; k < n; ++k) {
      const double x = a[row * n + k], y = inverse[row * n + k];
      a[row * n + k] = a[u * n + k], inverse[row * n + k] = inverse[u * n + k];
      a[u * n + k] = x * pivot, inverse[u * n + k] = y * pivot;
    }
    for (int i = 0; i < n; ++i) {
      const double f = a[i * n + u];
      if (i == u || f == 0.0) continue;
      for (int k = 0; k < n; ++k) a[i * n + k] -= f * a[u * n + k], inverse[i * n + k] -= f * inverse[u * n + k];
    }
  }
}

// The n x m matrix C with C A = I, zero in the columns of equations that are not chosen, into `to`. A by lanes:
// entry(equation, unknown); where there are more equations than unknowns they are chosen by the matrix `chooser`.
template <class Entry, class Chooser>
inline void invert_lanes(int n, int m, Entry&& entry, Chooser&& chooser, double* memory, Real* to) {
  double *const a = memory, *const square = a + m * m, *const inverse = square + m * m;
  int* const chosen = (int*)(inverse + m * m);
  unsigned char* const used = (unsigned char*)(chosen + m);
  for (int e = 0; e < n * m; ++e) to[e] = 0.0;
  for (int l = 0; l < LANES; ++l) {
    for (int i = 0; i < n; ++i) chosen[i] = i;
    if (m > n) {
      for (int i = 0; i < m; ++i)
        for (int u = 0; u < n; ++u) a[i * n + u] = lane(chooser(i, u), l);
      choose_equations(n, m, a, chosen, used);
    }
    for (int i = 0; i < n; ++i)
      for (int u = 0; u < n; ++u) square[i * n + u] = lane(entry(chosen[i], u), l);
    invert(n, square, inverse);
    for (int u = 0; u < n; ++u)
      for (int i = 0; i < n; ++i) to[u * m + chosen[i]].v[l] = inverse[u * n + i];
  }
}

}  // namespace
