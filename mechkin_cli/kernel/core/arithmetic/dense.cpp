#include "arithmetic/dense.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace {

// Calls f with a size known to the compiler up to 6, else with 0.
template <class F>
void with_size(int n, F&& f) {
  switch (n) {
    case 1: return f(std::integral_constant<int, 1>());
    case 2: return f(std::integral_constant<int, 2>());
    case 3: return f(std::integral_constant<int, 3>());
    case 4: return f(std::integral_constant<int, 4>());
    case 5: return f(std::integral_constant<int, 5>());
    case 6: return f(std::integral_constant<int, 6>());
    default: return f(std::integral_constant<int, 0>());
  }
}

// LeastSquares::solve for all columns of x at once, N x N or, with 0, of any size; the first rows are the solution.
template <int N>
void solve_columns(const Matrix& matrix, const Entries& pivots, const Entries& betas, double* x, int x_columns) {
  const int m = N ? N : matrix.rows, n = N ? N : matrix.columns, columns = N ? N : x_columns;
  const double *const a = matrix.a.begin(), *const pivot = pivots.begin(), *const beta = betas.begin();
  Entries sums(N ? 0 : columns);
  double sized[N ? N : 1];
  double* const sum = N ? sized : sums.begin();
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < columns; ++j) sum[j] = 0.0;
    for (int i = k; i < m; ++i) {
      if (!N && a[i * n + k] == 0.0) continue;
      for (int j = 0; j < columns; ++j) sum[j] += a[i * n + k] * x[i * columns + j];
    }
    for (int j = 0; j < columns; ++j) sum[j] *= beta[k];
    for (int i = k; i < m; ++i) {
      if (!N && a[i * n + k] == 0.0) continue;
      for (int j = 0; j < columns; ++j) x[i * columns + j] -= sum[j] * a[i * n + k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int i = k + 1; i < n; ++i) {
      if (!N && a[k * n + i] == 0.0) continue;
      for (int j = 0; j < columns; ++j) x[k * columns + j] -= a[k * n + i] * x[i * columns + j];
    }
    const double inverse = 1.0 / pivot[k];
    for (int j = 0; j < columns; ++j) x[k * columns + j] *= inverse;
  }
}

// The factors of LeastSquares, likewise.
template <int N>
void reflect(Matrix* matrix, Entries* pivots, Entries* betas) {
  const int m = N ? N : matrix->rows, n = N ? N : matrix->columns;
  double *const a = matrix->a.begin(), *const pivot = pivots->begin(), *const beta = betas->begin();
  for (int k = 0; k < n; ++k) {
    double square = 0.0;
    for (int i = k; i < m; ++i) square += a[i * n + k] * a[i * n + k];
    const double first = a[k * n + k], length = std::copysign(std::sqrt(square), first);
    pivot[k] = -length;
    a[k * n + k] = first + length;
    const double v2 = 2.0 * (square + std::fabs(first * length));
    beta[k] = v2 > 0.0 ? 2.0 / v2 : 0.0;
    for (int j = k + 1; j < n; ++j) {
      double s = 0.0;
      for (int i = k; i < m; ++i) s += a[i * n + k] * a[i * n + j];
      s *= beta[k];
      for (int i = k; i < m; ++i) a[i * n + j] -= s * a[i * n + k];
    }
  }
}

// Sum of the squares of R^-1, column by column.
template <int N>
double inverse_square(const Matrix& matrix, const Entries& pivots) {
  const int n = N ? N : matrix.columns;
  const double *const a = matrix.a.begin(), *const pivot = pivots.begin();
  Entries entries(N ? 0 : n);
  double sized[N ? N : 1];
  double* const x = N ? sized : entries.begin();
  double square = 0.0;
  for (int c = 0; c < n; ++c) {
    for (int k = 0; k < c; ++k) x[k] = 0.0;
    x[c] = 1.0;
    for (int k = c; k >= 0; --k) {
      for (int j = k + 1; j <= c; ++j) x[k] -= a[k * n + j] * x[j];
      x[k] /= pivot[k];
      square += x[k] * x[k];
    }
  }
  return square;
}

// Rows of a large matrix that are read together, by as many others at once: each number is brought from the cache for more
// products, whose sums are those of one row after the other.
constexpr int TOGETHER = 4;

void add_products(const double* a, int n, int i, int rows, int k, double* out) {
  double factor[TOGETHER][TOGETHER];
  bool none = true;
  for (int r = 0; r < rows; ++r)
    for (int l = 0; l < TOGETHER; ++l) {
      factor[r][l] = k + l < n ? a[(i + r) * n + k + l] : 0.0;
      none = none && factor[r][l] == 0.0;
    }
  if (none) return;  // loops that do not act on each other
  const double* row[TOGETHER];
  for (int l = 0; l < TOGETHER; ++l) row[l] = a + (k + l < n ? k + l : k) * n;
  for (int r = 0; r < rows; ++r) {
    double* const to = out + (i + r) * n;
    const double f0 = factor[r][0], f1 = factor[r][1], f2 = factor[r][2], f3 = factor[r][3];
    for (int j = 0; j < n; ++j) to[j] = to[j] + f0 * row[0][j] + f1 * row[1][j] + f2 * row[2][j] + f3 * row[3][j];
  }
}

// The square of a matrix, N x N or of n x n, into another.
template <int N>
void square_into(const double* a, int size, double* out) {
  const int n = N ? N : size;
  for (int e = 0; e < n * n; ++e) out[e] = 0.0;
  if (!N) {
    for (int i = 0; i < n; i += TOGETHER)
      for (int k = 0; k < n; k += TOGETHER) add_products(a, n, i, i + TOGETHER <= n ? TOGETHER : n - i, k, out);
    return;
  }
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j) out[i * n + j] += a[i * n + k] * a[k * n + j];
}

// Calls use(bound) with one bound of the spectral radius after the other until it says that this is enough. `power` holds
// the matrix, and `room` takes as many numbers; both change. The powers are kept near 1: bounds as 2^-k of the logarithm
// would need one, roots do not.
template <int N, class Use>
void spectral_bounds(double* power, double* room, int size, Use&& use) {
  const int entries = N ? N * N : size * size;
  double scale = 1.0;  // of the power so far: |E^(2^k)|^(1/2^k) = scale |power|^(1/2^k)
  for (int k = 0;; ++k) {
    double square = 0.0;
    for (int e = 0; e < entries; ++e) square += power[e] * power[e];
    const double norm = std::sqrt(square);
    if (!(norm < HUGE_VAL)) return;
    double root = norm;
    for (int i = 0; i < k; ++i) root = std::sqrt(root);
    if (use(scale * root) || k == 5 || norm == 0.0) return;
    const double inverse = 1.0 / norm;
    for (int e = 0; e < entries; ++e) power[e] *= inverse;
    scale *= root;
    square_into<N>(power, size, room);
    std::swap(power, room);
  }
}
// What takes the bounds: whether one is within a limit, and the least of them.
struct Within {
  double limit;
  bool found = false;
  bool operator()(double bound) { return found = bound <= limit; }
};
struct Least {
  double found = HUGE_VAL;
  bool operator()(double bound) {
    const bool enough = bound > 0.9 * found;
    found = lesser(found, bound);
    return enough;
  }
};

}  // namespace

LeastSquares::LeastSquares(Matrix matrix) : a_(std::move(matrix)), pivot_(a_.columns), beta_(a_.columns) {
  with_size(a_.rows == a_.columns ? a_.columns : 0,
            [this](auto size) { reflect<size()>(&a_, &pivot_, &beta_); });
}

std::vector<double> LeastSquares::solve(std::vector<double> b) const {
  const int m = a_.rows, n = a_.columns;
  for (int k = 0; k < n; ++k) {
    double s = 0.0;
    for (int i = k; i < m; ++i) s += a_(i, k) * b[i];
    s *= beta_[k];
    for (int i = k; i < m; ++i) b[i] -= s * a_(i, k);
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= a_(k, j) * b[j];
    b[k] /= pivot_[k];
  }
  b.resize(n);
  return b;
}

Matrix LeastSquares::solve(const Matrix& b) const {
  const int n = a_.columns;
  Matrix x = b;
  if (a_.rows == n && b.columns == n) {
    with_size(n, [&](auto size) { solve_columns<size()>(a_, pivot_, beta_, x.a.begin(), n); });
    return x;
  }
  solve_columns<0>(a_, pivot_, beta_, x.a.begin(), x.columns);
  Matrix solution(n, b.columns);
  std::copy(x.a.begin(), x.a.begin() + solution.a.size(), solution.a.begin());
  return solution;
}

// Small square matrices stay on the stack, with sizes that are known.
template <class Use>
void LeastSquares::bound_change(const Matrix& b, Use& use) const {
  with_size(a_.rows == a_.columns ? a_.columns : 0, [&](auto size) {
    constexpr int N = size();
    if constexpr (N > 0) {
      double power[N * N], room[N * N];
      std::copy(b.a.begin(), b.a.end(), power);
      solve_columns<N>(a_, pivot_, beta_, power, N);
      for (int i = 0; i < N; ++i) power[i * N + i] -= 1.0;
      spectral_bounds<N>(power, room, N, use);
    } else {
      Matrix change = solve(b), room(change.rows, change.rows);
      subtract_identity(&change);
      spectral_bounds<0>(change.a.begin(), room.a.begin(), change.rows, use);
    }
  });
}

bool LeastSquares::change_within(const Matrix& b, double limit) const {
  Within within = {limit};
  bound_change(b, within);
  return within.found;
}

double LeastSquares::change_bound(const Matrix& b) const {
  Least least;
  bound_change(b, least);
  return least.found;
}

double LeastSquares::least_pivot() const {
  double least = pivot_.size() == 0 ? 1.0 : std::fabs(pivot_[0]);
  for (double p : pivot_) least = std::fmin(least, std::fabs(p));
  return least;
}

double LeastSquares::least_singular_bound() const {
  const int n = a_.columns;
  double square = 0.0;
  with_size(n, [&](auto size) { square = inverse_square<size()>(a_, pivot_); });
  return square > 0.0 ? 1.0 / std::sqrt(square) : n ? 0.0 : HUGE_VAL;
}

bool spectral_radius_within(Matrix e, double limit) {
  Within within = {limit};
  Matrix room = e;
  with_size(e.rows, [&](auto size) { spectral_bounds<size()>(e.a.begin(), room.a.begin(), e.rows, within); });
  return within.found;
}

double spectral_radius_bound(Matrix e) {
  Least least;
  Matrix room = e;
  with_size(e.rows, [&](auto size) { spectral_bounds<size()>(e.a.begin(), room.a.begin(), e.rows, least); });
  return least.found;
}

Singular singular_vectors(const Matrix& matrix) {
  const int n = matrix.columns;
  // columns as rows, which are read one after the other
  Matrix a = transposed(matrix), v(n, n);
  for (int i = 0; i < n; ++i) v(i, i) = 1.0;
  const auto product = [&](int p, int q) {
    double s = 0.0;
    for (int i = 0; i < a.columns; ++i) s += a(p, i) * a(q, i);
    return s;
  };
  const auto rotate = [](Matrix& x, int p, int q, double c, double s) {
    for (int i = 0; i < x.columns; ++i) {
      const double one = x(p, i), other = x(q, i);
      x(p, i) = c * one - s * other, x(q, i) = s * one + c * other;
    }
  };
  bool again = true;
  // convergence takes some six to ten sweeps
  for (int sweep = 0; again && sweep < 30; ++sweep) {
    again = false;
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) {
        const double gamma = product(p, q), one = product(p, p), other = product(q, q);
        // orthogonal to ten roundings
        if (!(std::fabs(gamma) > 1e-15 * std::sqrt(one * other)) || !(std::fabs(gamma) > 1e-300)) continue;
        again = true;
        const double zeta = (other - one) / (2.0 * gamma);
        const double t = std::copysign(1.0, zeta) / (std::fabs(zeta) + std::sqrt(1.0 + zeta * zeta));
        const double c = 1.0 / std::sqrt(1.0 + t * t);
        rotate(a, p, q, c, c * t), rotate(v, p, q, c, c * t);
      }
  }
  std::vector<double> size(n);
  for (int j = 0; j < n; ++j) size[j] = std::sqrt(product(j, j));
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return size[i] > size[j]; });
  Singular found = {std::vector<double>(n), Matrix(n, n)};
  for (int j = 0; j < n; ++j) {
    found.value[j] = size[order[j]];
    for (int i = 0; i < n; ++i) found.v(i, j) = v(order[j], i);
  }
  return found;
}

Matrix with_row(const Matrix& a, const std::vector<double>& row) {
  Matrix b(a.rows + 1, a.columns);
  std::copy(a.a.begin(), a.a.end(), b.a.begin());
  std::copy(row.begin(), row.end(), b.a.begin() + a.a.size());
  return b;
}

Matrix with_column(const Matrix& a, const std::vector<double>& column, double factor) {
  Matrix b(a.rows, a.columns + 1);
  for (int i = 0; i < a.rows; ++i) {
    for (int j = 0; j < a.columns; ++j) b(i, j) = a(i, j);
    b(i, a.columns) = column[i] * factor;
  }
  return b;
}

Matrix transposed(const Matrix& a) {
  Matrix t(a.columns, a.rows);
  for (int i = 0; i < a.rows; ++i)
    for (int j = 0; j < a.columns; ++j) t(j, i) = a(i, j);
  return t;
}

void subtract_identity(Matrix* a) {
  for (int i = 0; i < a->rows; ++i) (*a)(i, i) -= 1.0;
}

double determinant(Matrix a) {
  const int n = a.rows;
  double product = 1.0;
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(a(i, k)) > std::fabs(a(best, k))) best = i;
    if (best != k) {
      for (int j = 0; j < n; ++j) std::swap(a(k, j), a(best, j));
      product = -product;
    }
    product *= a(k, k);
    for (int i = k + 1; i < n; ++i) {
      const double f = a(i, k) / a(k, k);
      for (int j = k; j < n; ++j) a(i, j) -= f * a(k, j);
    }
  }
  return product;
}
