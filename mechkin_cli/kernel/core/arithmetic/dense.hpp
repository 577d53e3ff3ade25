// Small dense matrices in plain doubles, for what a branch is judged by: least squares, the bound of a spectral radius,
// singular vectors. Row-major; sums in fixed order.
#pragma once

#include <cstddef>
#include <vector>

// Numbers of a matrix or of a column of one: in place up to those of 6 x 6, which is what most blocks have, since the
// matrices of every step come and go.
class Entries {
 public:
  Entries() = default;
  explicit Entries(std::size_t size, double value = 0.0) : size_(size) {
    if (size > MOST_IN_PLACE) more_.resize(size);
    for (double& x : *this) x = value;
  }
  Entries(const Entries& other) { *this = other; }
  Entries& operator=(const Entries& other) {
    size_ = other.size_, more_ = other.more_;
    if (size_ <= MOST_IN_PLACE)
      for (std::size_t k = 0; k < size_; ++k) place_[k] = other.place_[k];
    return *this;
  }
  std::size_t size() const { return size_; }
  double* begin() { return size_ > MOST_IN_PLACE ? more_.data() : place_; }
  const double* begin() const { return size_ > MOST_IN_PLACE ? more_.data() : place_; }
  double* end() { return begin() + size_; }
  const double* end() const { return begin() + size_; }
  double& operator[](std::size_t k) { return begin()[k]; }
  double operator[](std::size_t k) const { return begin()[k]; }

 private:
  static constexpr std::size_t MOST_IN_PLACE = 36;
  std::size_t size_ = 0;
  double place_[MOST_IN_PLACE];
  std::vector<double> more_;
};

struct Matrix {
  int rows = 0, columns = 0;
  Entries a;
  Matrix() = default;
  Matrix(int m, int n) : rows(m), columns(n), a((std::size_t)m * n, 0.0) {}
  double& operator()(int i, int j) { return a[(std::size_t)i * columns + j]; }
  double operator()(int i, int j) const { return a[(std::size_t)i * columns + j]; }
};

// Householder's QR of a matrix with at least as many rows as columns.
class LeastSquares {
 public:
  explicit LeastSquares(Matrix matrix);
  // The least-squares solution of A x = b; b has as many entries as A has rows.
  std::vector<double> solve(std::vector<double> b) const;
  // A^+ B.
  Matrix solve(const Matrix& b) const;
  // Bounds of the spectral radius of A^+ B - I, as those of a matrix below.
  bool change_within(const Matrix& b, double limit) const;
  double change_bound(const Matrix& b) const;
  // Size of the least pivot: zero where columns are dependent.
  double least_pivot() const;
  // 1 / |A^+| in Frobenius' norm: at most the least singular value, and at least it over the root of the columns.
  double least_singular_bound() const;

 private:
  template <class Use>
  void bound_change(const Matrix& b, Use& use) const;

  Matrix a_;
  Entries pivot_, beta_;
};

// A matrix with its factors.
struct Factored {
  Matrix matrix;
  LeastSquares squares;
  explicit Factored(const Matrix& m) : matrix(m), squares(m) {}
};

// Whether a bound of the spectral radius of E is at most `limit`: |E^k|^(1/k) in Frobenius' norm for k = 1, 2, 4 ... 32.
// The powers' norms come near the radius, which changes neither with units nor with the order of equations and unknowns
// nor where independent parts stand in one matrix.
bool spectral_radius_within(Matrix e, double limit);
// The same bound, as near as powers still lower it by a tenth.
double spectral_radius_bound(Matrix e);

// As fmin and fmax, which are calls: what is no number loses.
inline double lesser(double a, double b) { return a < b || b != b ? a : b; }
inline double greater(double a, double b) { return a > b || b != b ? a : b; }

// Singular values, falling, with the right singular vectors as columns of `v`, by one-sided Jacobi rotations.
struct Singular {
  std::vector<double> value;
  Matrix v;
};
Singular singular_vectors(const Matrix& matrix);

Matrix transposed(const Matrix& a);
// The matrix with one row, or a multiple of one column, more.
Matrix with_row(const Matrix& a, const std::vector<double>& row);
Matrix with_column(const Matrix& a, const std::vector<double>& column, double factor);
// Minus the identity, in place.
void subtract_identity(Matrix* a);
double determinant(Matrix a);

// Scalar product.
template <class List>
double product(const List& a, const List& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}
