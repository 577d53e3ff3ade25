// The largest singular value of the inverse of a weighted matrix with a band, by Lanczos' method for B B^T (Golub and Kahan
// 1965): two solutions a step, where the powers of condition_estimate.hpp cost a product of full matrices.
//
// From a start at random, k steps miss the largest eigenvalue of any B B^T by no more than a part 0.103 (ln(n (k - 1)^4) /
// (k - 1))^2 of it on average (Kuczynski and Wozniakowski, SIAM J. Matrix Anal. Appl. 13, 1992, theorem 3.2): with 64 steps
// 2 % for 4096 unknowns, a singular value by half as much. Vectors that rounding leaves less than orthogonal repeat
// what was found, and make nothing larger.
#pragma once

#include "rows/position.hpp"

namespace {

constexpr int LANCZOS_STEPS = 64;
// Halvings of the range of the eigenvalue, which is at most threefold.
constexpr int HALVINGS = 12;
// A vector of this size, in parts of the largest before, is rounding: all that its start can show was found.
constexpr double NO_VECTOR = 1e-10;

// Signs in no order that a mechanism could have (a linear congruence; Knuth 1998, 3.3.4).
inline void put_signs(Pack* x, int n) {
  std::uint64_t state = 88172645463325252u;
  for (int i = 0; i < n; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    x[i] = state >> 63 ? 1.0 : -1.0;
  }
}

// Divides a vector by its length, which it returns: zero, as the vector then is, where it is no more than rounding.
inline Pack divide_by_length(Pack* x, int n, Pack rounding) {
  Pack square = 0.0;
  for (int i = 0; i < n; ++i) square += x[i] * x[i];
  const Pack length = sqrt(square);
  const Mask is_there = length > rounding;
  const Pack inverse = select(is_there, Pack(1.0) / select(is_there, length, Pack(1.0)), Pack(0.0));
  for (int i = 0; i < n; ++i) x[i] = select(is_there, x[i] * inverse, Pack(0.0));
  return select(is_there, length, Pack(0.0));
}

// The largest eigenvalue of the symmetric matrix with `diagonal` and, above and below it, `beside` (count - 1), from Sturm's
// sequences.
inline Pack largest_of_tridiagonal(const Pack* diagonal, const Pack* beside, int count) {
  Pack low = 0.0, high = 0.0;
  for (int i = 0; i < count; ++i) {
    const Pack sum = (i ? beside[i - 1] : Pack(0.0)) + diagonal[i] + (i + 1 < count ? beside[i] : Pack(0.0));
    low = max(low, diagonal[i]), high = max(high, sum);
  }
  for (int h = 0; h < HALVINGS; ++h) {
    const Pack middle = Pack(0.5) * (low + high);
    // all pivots of the matrix less `middle` are negative where no eigenvalue is above it
    Mask is_above = all_lanes(false);
    Pack pivot = diagonal[0] - middle;
    for (int i = 1;; ++i) {
      is_above = is_above | (pivot >= Pack(0.0));
      if (i == count) break;
      pivot = diagonal[i] - middle - beside[i - 1] * beside[i - 1] / select(is_above, Pack(-1.0), pivot);
    }
    low = select(is_above, middle, low), high = select(is_above, high, middle);
  }
  return Pack(0.5) * (low + high);
}

// Of B = C^-1 J^-1 R with `row` the entries of R and the columns' weights C; J is factored in `at`. `room`: three vectors and
// twice the steps.
inline Pack inverse_norm(const BlockMatrices& at, const Pack* row, const double* column_weight, const int* unknown, Pack* room) {
  const int n = at.n, steps = n < LANCZOS_STEPS ? n : LANCZOS_STEPS;
  Pack *const left = room, *const right = left + n, *const image = right + n;
  Pack *const diagonal = image + n, *const beside = diagonal + steps;
  put_signs(right, n);
  divide_by_length(right, n, Pack(0.0));
  for (int i = 0; i < n; ++i) left[i] = 0.0;
  Pack alpha = 0.0, beta = 0.0, most = 0.0;
  for (int k = 0; k < steps; ++k) {
    // B right = beta left + alpha (the next left one)
    for (int j = 0; j < n; ++j) image[j] = row[j] * right[j];
    at.solve_equations(image);
    for (int i = 0; i < n; ++i) left[i] = image[i] / Pack(column_weight[unknown[i]]) - beta * left[i];
    alpha = divide_by_length(left, n, Pack(NO_VECTOR) * most);
    most = max(most, alpha);
    diagonal[k] = alpha * alpha + beta * beta;
    // B^T left = alpha right + beta (the next right one)
    for (int i = 0; i < n; ++i) image[i] = left[i] / Pack(column_weight[unknown[i]]);
    at.solve_multipliers(image, 0, Pack(0.0));
    for (int j = 0; j < n; ++j) right[j] = row[j] * image[j] - alpha * right[j];
    beta = divide_by_length(right, n, Pack(NO_VECTOR) * most);
    beside[k] = alpha * beta;
  }
  return sqrt(largest_of_tridiagonal(diagonal, beside, steps));
}

}  // namespace
