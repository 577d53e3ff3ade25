// The kernel's linear algebra for one pack, behind plain C functions for the tests.
#include "condition_estimate.hpp"
#include "factors.hpp"

namespace {

constexpr int LARGEST = 16;

// Arrays lie lane after lane.
void load(int count, const double* from, Pack* to) {
  for (int lane = 0; lane < LANES; ++lane)
    for (int i = 0; i < count; ++i) to[i].v[lane] = from[lane * count + i];
}
void store(int count, const Pack* from, double* to) {
  for (int lane = 0; lane < LANES; ++lane)
    for (int i = 0; i < count; ++i) to[lane * count + i] = from[i].v[lane];
}

}  // namespace

#define EXPORTED extern "C" __attribute__((visibility("default")))

// a (n x n, row-major), b (n) -> x = A^-1 b, y = A^-T b.
EXPORTED void solve_square(int n, const double* a, const double* b, double* x, double* y) {
  Pack matrix[LARGEST * LARGEST], first[LARGEST], second[LARGEST];
  Mask swap[LARGEST * LARGEST];
  load(n * n, a, matrix);
  load(n, b, first);
  load(n, b, second);
  const Factors factors = {matrix, swap, n};
  factor(factors);
  solve(factors, first);
  solve_transposed(factors, second);
  store(n, first, x);
  store(n, second, y);
}

// a (m x n, row-major), b (m), c (n) -> least-squares x (n) of a x = b, y (m) of a^T y = c with a shift.
EXPORTED void solve_tall(int m, int n, const double* a, const double* b, const double* c, int shift, double* x,
                         double* y) {
  Pack matrix[LARGEST * LARGEST], first[LARGEST], second[LARGEST], pivot[LARGEST], beta[LARGEST];
  load(m * n, a, matrix);
  load(m, b, first);
  load(n, c, second);
  const Reflectors factors = {matrix, pivot, beta, m, n};
  reflect(factors);
  solve(factors, first);
  solve_transposed(factors, second, shift);
  store(n, first, x);
  store(m, second, y);
}

// a (m x n, row-major) -> its smallest singular value.
EXPORTED void least_singular_value(int m, int n, const double* a, double* sigma) {
  Pack matrix[LARGEST * LARGEST];
  load(m * n, a, matrix);
  Pack squares[LARGEST];
  const Pack least = smallest_singular_value(matrix, m, n, squares);
  store(1, &least, sigma);
}

// a (n x n, row-major) with weights of its rows and columns -> the largest singular value of the weighted inverse.
EXPORTED void largest_inverse(int n, const double* a, const double* rows, const double* columns, double* norm) {
  Pack matrix[LARGEST * LARGEST], weight[LARGEST], scratch[3 * LARGEST * LARGEST];
  Mask swap[LARGEST * LARGEST];
  int unknown[LARGEST];
  load(n * n, a, matrix);
  for (int i = 0; i < n; ++i) weight[i] = 1.0 / rows[i], unknown[i] = i;
  const Factors factors = {matrix, swap, n};
  factor(factors);
  const Pack found = inverse_norm(factors, weight, columns, unknown, scratch);
  store(1, &found, norm);
}
