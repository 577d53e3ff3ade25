// LU decomposition of a small matrix of real or complex numbers, in plain doubles and fixed order.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// A complex number by real arithmetic, without the library's cases for infinities.
struct Complex {
  double re = 0.0, im = 0.0;
  friend Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
  friend Complex operator/(Complex a, Complex b) {
    const double square = b.re * b.re + b.im * b.im;
    return {(a.re * b.re + a.im * b.im) / square, (a.im * b.re - a.re * b.im) / square};
  }
};
inline double magnitude(double a) { return std::fabs(a); }
inline double magnitude(Complex a) { return std::fabs(a.re) + std::fabs(a.im); }

template <class Number>
class SmallLu {
 public:
  // Row-major, n x n; rows are interchanged. False where a pivot is zero or no number.
  bool decompose(std::vector<Number> matrix, int n) {
    a_ = std::move(matrix);
    n_ = n;
    row_.resize(n);
    for (int k = 0; k < n; ++k) {
      int best = k;
      for (int i = k + 1; i < n; ++i)
        if (magnitude(at(i, k)) > magnitude(at(best, k))) best = i;
      if (!(magnitude(at(best, k)) > 0.0)) return false;
      row_[k] = best;
      for (int j = 0; j < n && best != k; ++j) std::swap(at(k, j), at(best, j));
      for (int i = k + 1; i < n; ++i) {
        at(i, k) = at(i, k) / at(k, k);
        for (int j = k + 1; j < n; ++j) at(i, j) = at(i, j) - at(i, k) * at(k, j);
      }
    }
    return true;
  }
  // In place.
  void solve(Number* b) const {
    for (int k = 0; k < n_; ++k) {
      std::swap(b[k], b[row_[k]]);
    }
    for (int i = 1; i < n_; ++i)
      for (int j = 0; j < i; ++j) b[i] = b[i] - at(i, j) * b[j];
    for (int i = n_ - 1; i >= 0; --i) {
      for (int j = i + 1; j < n_; ++j) b[i] = b[i] - at(i, j) * b[j];
      b[i] = b[i] / at(i, i);
    }
  }

 private:
  Number& at(int i, int j) { return a_[(std::size_t)i * n_ + j]; }
  const Number& at(int i, int j) const { return a_[(std::size_t)i * n_ + j]; }

  std::vector<Number> a_;
  std::vector<int> row_;
  int n_ = 0;
};
