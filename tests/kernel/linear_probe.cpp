// The kernel's linear algebra for one pack, behind a plain C function for the tests.
#include "linear.hpp"

namespace {
constexpr int LARGEST = 16;
}

// Arrays lane after lane: a (n x n, row-major), b (n) -> x = A^-1 b, y = A^-T b, sigma.
extern "C" __attribute__((visibility("default"))) void linear_probe(int n, const double* a, const double* b, double* x,
                                                                    double* y, double* sigma) {
  Pack matrix[LARGEST * LARGEST], copy[LARGEST * LARGEST], first[LARGEST], second[LARGEST];
  Mask swap[LARGEST * LARGEST];
  for (int lane = 0; lane < LANES; ++lane) {
    for (int i = 0; i < n * n; ++i) matrix[i].v[lane] = a[lane * n * n + i];
    for (int i = 0; i < n; ++i) first[i].v[lane] = second[i].v[lane] = b[lane * n + i];
  }
  for (int i = 0; i < n * n; ++i) copy[i] = matrix[i];
  const Factors factors = {matrix, swap, n};
  factor(factors);
  solve(factors, first);
  solve_transposed(factors, second);
  const Pack least = smallest_singular_value(copy, n);
  for (int lane = 0; lane < LANES; ++lane) {
    for (int i = 0; i < n; ++i) x[lane * n + i] = first[i].v[lane], y[lane * n + i] = second[i].v[lane];
    sigma[lane] = least.v[lane];
  }
}
