// The kernel's linear algebra for one pack, behind plain C functions for the tests.
#include "rows/condition_estimate.hpp"
#include "rows/factors.hpp"

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

// `packs` matrices a (n x n, row-major), one pack after the other, with weights of their rows and columns -> the largest
// singular values of the weighted inverses.
EXPORTED void largest_inverses(int packs, int n, const double* a, const double* rows, const double* columns, double* norm) {
  struct Room {
    Pack matrix[LARGEST * LARGEST], weight[LARGEST], scratch[3 * LARGEST * LARGEST];
    Mask swap[LARGEST * LARGEST];
  } room[PACKS_OF_ESTIMATE];
  InverseNorm found[PACKS_OF_ESTIMATE];
  int unknown[LARGEST];
  for (int i = 0; i < n; ++i) unknown[i] = i;
  for (int k = 0; k < packs; ++k) {
    load(n * n, a + (long)k * LANES * n * n, room[k].matrix);
    for (int i = 0; i < n; ++i) room[k].weight[i] = 1.0 / rows[i];
    found[k] = {{room[k].matrix, room[k].swap, n}, room[k].weight, room[k].scratch, Pack(0.0)};
    factor(found[k].f);
  }
  find_inverse_norms(found, packs, columns, unknown);
  for (int k = 0; k < packs; ++k) store(1, &found[k].value, norm + k * LANES);
}
