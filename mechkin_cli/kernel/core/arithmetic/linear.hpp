// Small dense linear algebra on packs: LU with partial pivoting, its transpose, singular values.
//
// Matrices are n x n, row-major, each lane its own system; n is small (a block's size) and is made a
// compile-time constant for 1 ... 6. Rows are exchanged lane by lane with selects, so that every lane
// pivots as if it were alone.
#pragma once

#include "arithmetic/pack.hpp"

namespace {

// Whether a size known to the compiler pays: not where each operation is many.
constexpr bool SIZED_BLOCKS = PARTS == 1;

struct Factors {
  Pack* a;     // n x n: L below the diagonal, U above it, reciprocal pivots on it
  Mask* swap;  // n (n - 1) / 2 exchanges in order
  int n;
};

// Whether a factor is zero in all lanes, so that what it multiplies need not be looked at. Large matrices, of many loops,
// are mostly zeros; in small ones asking takes as long as the product.
template <int N>
MECHKIN_INLINE bool is_passed_over(const Pack& factor) {
  if constexpr (N == 0 && PARTS == 1) return all(factor == Pack(0.0));
  return false;
}

template <int N>
MECHKIN_INLINE void factor_sized(Factors f, int runtime) {
  // short rows are exchanged in less time than a branch takes that is guessed wrong
  constexpr bool BRANCH = N == 0 || N > 3;
  const int n = N ? N : runtime;
  int s = 0;
  for (int k = 0; k < n; ++k) {
    for (int i = k + 1; i < n; ++i) {
      const Mask c = abs(f.a[i * n + k]) > abs(f.a[k * n + k]);
      f.swap[s++] = c;
      if (BRANCH && !any(c)) continue;
      for (int j = 0; j < n; ++j) {
        const Pack x = f.a[k * n + j], y = f.a[i * n + j];
        f.a[k * n + j] = select(c, y, x);
        f.a[i * n + j] = select(c, x, y);
      }
    }
    const Pack inverse = Pack(1.0) / f.a[k * n + k];
    f.a[k * n + k] = inverse;
    for (int i = k + 1; i < n; ++i) {
      const Pack l = f.a[i * n + k] * inverse;
      f.a[i * n + k] = l;
      if (is_passed_over<N>(l)) continue;
      for (int j = k + 1; j < n; ++j) subtract_product(f.a[i * n + j], l, f.a[k * n + j]);
    }
  }
}

template <int N>
MECHKIN_INLINE void solve_sized(Factors f, int runtime, Pack* b) {
  const int n = N ? N : runtime;
  int s = 0;
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const Mask c = f.swap[s++];
      const Pack x = b[k], y = b[i];
      b[k] = select(c, y, x);
      b[i] = select(c, x, y);
    }
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) subtract_product(b[i], f.a[i * n + k], b[k]);
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) subtract_product(b[k], f.a[k * n + j], b[j]);
    b[k] *= f.a[k * n + k];
  }
}

template <int N>
MECHKIN_INLINE void solve_transposed_sized(Factors f, int runtime, Pack* b) {
  const int n = N ? N : runtime;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < k; ++j) subtract_product(b[k], f.a[j * n + k], b[j]);
    b[k] *= f.a[k * n + k];
  }
  for (int k = n - 1; k >= 0; --k)
    for (int i = k + 1; i < n; ++i) subtract_product(b[k], f.a[i * n + k], b[i]);
  int s = n * (n - 1) / 2;
  for (int k = n - 1; k >= 0; --k)
    for (int i = n - 1; i > k; --i) {
      const Mask c = f.swap[--s];
      const Pack x = b[k], y = b[i];
      b[k] = select(c, y, x);
      b[i] = select(c, x, y);
    }
}

#define MECHKIN_SIZED(FUNCTION, ...)                 \
  switch (SIZED_BLOCKS ? f.n : 0) {                  \
    case 1: return FUNCTION<1>(f, 1 __VA_ARGS__);    \
    case 2: return FUNCTION<2>(f, 2 __VA_ARGS__);    \
    case 3: return FUNCTION<3>(f, 3 __VA_ARGS__);    \
    case 4: return FUNCTION<4>(f, 4 __VA_ARGS__);    \
    case 5: return FUNCTION<5>(f, 5 __VA_ARGS__);    \
    case 6: return FUNCTION<6>(f, 6 __VA_ARGS__);    \
    default: return FUNCTION<0>(f, f.n __VA_ARGS__); \
  }
// +1 or -1: the sign of the determinant of a factored matrix.
inline Pack determinant_sign(Factors f) {
  Pack sign = 1.0;
  for (int k = 0; k < f.n; ++k) sign *= copysign(Pack(1.0), f.a[k * f.n + k]);
  for (int s = 0; s < f.n * (f.n - 1) / 2; ++s) sign = select(f.swap[s], -sign, sign);
  return sign;
}

// The least pivot's size, near zero where the matrix is singular; the factors hold the pivots' reciprocals.
inline Pack least_pivot(Factors f) {
  Pack largest = abs(f.a[0]);
  for (int k = 1; k < f.n; ++k) largest = max(abs(f.a[k * f.n + k]), largest);
  return Pack(1.0) / largest;
}

#define MECHKIN_AND_B , b
// Factors f.a in place.
inline void factor(Factors f) { MECHKIN_SIZED(factor_sized, ) }
// b := A^-1 b.
inline void solve(Factors f, Pack* b) { MECHKIN_SIZED(solve_sized, MECHKIN_AND_B) }
// b := A^-T b.
inline void solve_transposed(Factors f, Pack* b) { MECHKIN_SIZED(solve_transposed_sized, MECHKIN_AND_B) }
#undef MECHKIN_AND_B
#undef MECHKIN_SIZED

// B := A^-1 B, of n x `columns` entries: as `solve` each of its columns, entry for entry.
inline void solve_columns(Factors f, Pack* b, int columns) {
  const int n = f.n;
  int s = 0;
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const Mask c = f.swap[s++];
      if (!any(c)) continue;
      for (int j = 0; j < columns; ++j) {
        const Pack x = b[k * columns + j], y = b[i * columns + j];
        b[k * columns + j] = select(c, y, x);
        b[i * columns + j] = select(c, x, y);
      }
    }
  const auto subtract_row = [&](int i, int k) {
    const Pack factor = f.a[i * n + k];
    if (is_passed_over<0>(factor)) return;
    for (int j = 0; j < columns; ++j) subtract_product(b[i * columns + j], factor, b[k * columns + j]);
  };
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) subtract_row(i, k);
  for (int k = n - 1; k >= 0; --k) {
    for (int i = k + 1; i < n; ++i) subtract_row(k, i);
    for (int j = 0; j < columns; ++j) b[k * columns + j] *= f.a[k * n + k];
  }
}

inline Pack column_square(const Pack* a, int m, int n, int column) {
  Pack sum = 0.0;
  for (int i = 0; i < m; ++i) sum += a[i * n + column] * a[i * n + column];
  return sum;
}

// Smallest singular value of the m x n matrix a (destroyed), by one-sided Jacobi rotations of its
// columns (Demmel and Veselic 1992: accurate to high relative precision). A pair of columns that is
// orthogonal to rounding is left alone, lane by lane. Cosines between columns that were below its root throughout
// a sweep are below rounding after it (quadratic convergence), so no sweep is needed to see that.
// `square` is room for n packs.
inline Pack smallest_singular_value(Pack* a, int m, int n, Pack* square) {
  // squared cosines: of about ten roundings, and of the root of one
  const Pack negligible = PARTS == 1 ? 1e-30 : 1e-61, last = PARTS == 1 ? 1e-16 : 1e-32;
  // against turning to and fro by rounding without an end: convergence takes some six to ten sweeps
  for (int sweep = 0; sweep < 30; ++sweep) {
    bool again = false;
    for (int j = 0; j < n; ++j) square[j] = column_square(a, m, n, j);
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) {
        Pack gamma = 0.0;
        for (int i = 0; i < m; ++i) gamma += a[i * n + p] * a[i * n + q];
        const Pack size = square[p] * square[q], cosine = gamma * gamma;
        const Mask turn = cosine > negligible * size;
        if (!any(turn)) continue;
        again = again || any(cosine > last * size);
        const Pack zeta = (square[q] - square[p]) / (Pack(2.0) * select(turn, gamma, Pack(1.0)));
        const Pack t = select(turn, copysign(Pack(1.0), zeta) / (abs(zeta) + sqrt(Pack(1.0) + zeta * zeta)), Pack(0.0));
        const Pack c = Pack(1.0) / sqrt(Pack(1.0) + t * t), s = c * t;
        square[p] -= t * gamma, square[q] += t * gamma;
        for (int i = 0; i < m; ++i) {
          const Pack x = a[i * n + p], y = a[i * n + q];
          a[i * n + p] = c * x - s * y;
          a[i * n + q] = s * x + c * y;
        }
      }
    if (!again) break;
  }
  Pack least = 0.0;
  for (int j = 0; j < n; ++j) {
    const Pack square_now = column_square(a, m, n, j);
    least = j ? min(least, square_now) : square_now;
  }
  return sqrt(least);
}

}  // namespace
