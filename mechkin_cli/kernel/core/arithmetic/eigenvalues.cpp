#include "arithmetic/eigenvalues.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace {

constexpr double EPSILON = std::numeric_limits<double>::epsilon();
// Sweeps of Jacobi rotations, and QR steps for each value: half a dozen and two are usual.
constexpr int MOST_SWEEPS = 60, MOST_QR_STEPS = 60;

using Entry = std::vector<double>;

bool is_finite(const double* a, std::size_t count) {
  return std::all_of(a, a + count, [](double x) { return std::isfinite(x); });
}

// Rotates columns p and q of a matrix with n columns.
void rotate_columns(Entry& a, int n, int p, int q, double c, double s) {
  for (int i = 0; i < n; ++i) {
    const double x = a[i * n + p], y = a[i * n + q];
    a[i * n + p] = c * x - s * y, a[i * n + q] = s * x + c * y;
  }
}

void rotate_rows(Entry& a, int n, int p, int q, double c, double s) {
  for (int j = 0; j < n; ++j) {
    const double x = a[p * n + j], y = a[q * n + j];
    a[p * n + j] = c * x - s * y, a[q * n + j] = s * x + c * y;
  }
}

// Diagonalises a symmetric matrix in place; v becomes its vectors as columns.
bool rotate_to_diagonal(int n, Entry& a, Entry& v) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) v[i * n + j] = i == j ? 1.0 : 0.0;
  double size = 0.0;
  for (double x : a) size = std::max(size, std::abs(x));
  for (int sweep = 0; sweep < MOST_SWEEPS; ++sweep) {
    bool rotated = false;
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) {
        const double off = a[p * n + q];
        const double level = std::sqrt(std::abs(a[p * n + p])) * std::sqrt(std::abs(a[q * n + q]));
        if (!(std::abs(off) > 0.25 * EPSILON * std::max(level, 0.25 * EPSILON * size))) continue;
        rotated = true;
        const double theta = (a[q * n + q] - a[p * n + p]) / (2.0 * off);
        const double t = std::isinf(theta * theta)
                             ? 0.5 / theta
                             : (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        const double pp = a[p * n + p] - t * off, qq = a[q * n + q] + t * off;
        rotate_columns(a, n, p, q, c, s), rotate_rows(a, n, p, q, c, s), rotate_columns(v, n, p, q, c, s);
        a[p * n + p] = pp, a[q * n + q] = qq, a[p * n + q] = a[q * n + p] = 0.0;
      }
    if (!rotated) return true;
  }
  return false;
}

// Number of the largest entry of column j, the first of equal ones.
int largest_of_column(const Entry& a, int n, int j) {
  int at = 0;
  for (int i = 1; i < n; ++i)
    if (std::abs(a[i * n + j]) > std::abs(a[at * n + j])) at = i;
  return at;
}

struct Complex {
  double re = 0.0, im = 0.0;
};
Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
Complex operator*(double a, Complex b) { return {a * b.re, a * b.im}; }
Complex conjugate(Complex a) { return {a.re, -a.im}; }

double magnitude(Complex a) {
  const double x = std::abs(a.re), y = std::abs(a.im), most = std::max(x, y), least = std::min(x, y);
  if (!(most > 0.0)) return 0.0;
  const double ratio = least / most;
  return most * std::sqrt(1.0 + ratio * ratio);
}

Complex operator/(Complex a, Complex b) {
  if (std::abs(b.re) >= std::abs(b.im)) {
    const double ratio = b.im / b.re, d = b.re + ratio * b.im;
    return {(a.re + ratio * a.im) / d, (a.im - ratio * a.re) / d};
  }
  const double ratio = b.re / b.im, d = ratio * b.re + b.im;
  return {(ratio * a.re + a.im) / d, (ratio * a.im - a.re) / d};
}

Complex root(Complex a) {
  const double size = magnitude(a);
  if (!(size > 0.0)) return {};
  const double half = std::sqrt(0.5 * (size + std::abs(a.re)));
  const double other = a.im / (2.0 * half);
  if (a.re >= 0.0) return {half, other};
  return {std::abs(other), a.im < 0.0 ? -half : half};
}

// Scales rows and columns by powers of two until their norms are alike: D^-1 A D with the returned D.
Entry balanced(int n, Entry& a) {
  Entry scale((std::size_t)n, 1.0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < n; ++i) {
      double column = 0.0, row = 0.0;
      for (int j = 0; j < n; ++j)
        if (j != i) column += std::abs(a[j * n + i]), row += std::abs(a[i * n + j]);
      if (!(column > 0.0) || !(row > 0.0)) continue;
      const double sum = column + row;
      double f = 1.0;
      while (column < 0.5 * row) f *= 2.0, column *= 4.0;
      while (column >= 2.0 * row) f *= 0.5, column *= 0.25;
      if (!((column + row) / f < 0.95 * sum)) continue;
      changed = true, scale[i] *= f;
      for (int j = 0; j < n; ++j) a[i * n + j] /= f;
      for (int j = 0; j < n; ++j) a[j * n + i] *= f;
    }
  }
  return scale;
}

// Q^T A Q with zeros below the first subdiagonal, by reflections.
void to_hessenberg(int n, Entry& a, Entry& q) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) q[i * n + j] = i == j ? 1.0 : 0.0;
  Entry v((std::size_t)n);
  for (int k = 0; k + 2 < n; ++k) {
    double most = 0.0;
    for (int i = k + 1; i < n; ++i) most = std::max(most, std::abs(a[i * n + k]));
    double below = 0.0;
    for (int i = k + 2; i < n; ++i) below = std::max(below, std::abs(a[i * n + k]));
    if (!(below > 0.0)) continue;
    double square = 0.0;
    for (int i = k + 1; i < n; ++i) v[i] = a[i * n + k] / most, square += v[i] * v[i];
    const double length = v[k + 1] < 0.0 ? -std::sqrt(square) : std::sqrt(square);
    v[k + 1] += length;
    const double beta = 1.0 / (length * v[k + 1]);
    for (int j = k; j < n; ++j) {
      double sum = 0.0;
      for (int i = k + 1; i < n; ++i) sum += v[i] * a[i * n + j];
      for (int i = k + 1; i < n; ++i) a[i * n + j] -= beta * sum * v[i];
    }
    for (Entry* matrix : {&a, &q})
      for (int i = 0; i < n; ++i) {
        double sum = 0.0;
        for (int j = k + 1; j < n; ++j) sum += (*matrix)[i * n + j] * v[j];
        for (int j = k + 1; j < n; ++j) (*matrix)[i * n + j] -= beta * sum * v[j];
      }
    for (int i = k + 2; i < n; ++i) a[i * n + k] = 0.0;
  }
}

// Schur's triangle of a complex Hessenberg matrix by QR steps with Wilkinson's shift; z takes part.
bool to_triangle(int n, std::vector<Complex>& h, std::vector<Complex>& z) {
  std::vector<Complex> cosine((std::size_t)n), sine((std::size_t)n);
  int steps = 0;
  double size = 0.0;
  for (Complex x : h) size = std::max(size, magnitude(x));
  for (int last = n - 1; last > 0;) {
    int first = last;
    for (; first > 0; --first) {
      const double beside = magnitude(h[first * n + first]) + magnitude(h[(first - 1) * n + first - 1]);
      if (magnitude(h[first * n + first - 1]) <= EPSILON * std::max(beside, EPSILON * size)) break;
    }
    if (first > 0) h[first * n + first - 1] = {};
    if (first == last) {
      --last, steps = 0;
      continue;
    }
    if (++steps > MOST_QR_STEPS) return false;
    const Complex a = h[(last - 1) * n + last - 1], b = h[(last - 1) * n + last], c = h[last * n + last - 1],
                  d = h[last * n + last];
    const Complex half = 0.5 * (a - d), square = root(half * half + b * c);
    const Complex sum = half + square, difference = half - square;
    const Complex far = magnitude(sum) >= magnitude(difference) ? sum : difference;
    // of the two values of the last corner, that nearer to its last entry
    Complex shift = magnitude(far) > 0.0 ? d - b * c / far : d;
    if (steps % 10 == 0) shift = {magnitude(c) + shift.re, shift.im};  // out of a circle of steps
    for (int i = first; i <= last; ++i) h[i * n + i] = h[i * n + i] - shift;
    for (int k = first; k < last; ++k) {
      const Complex x = h[k * n + k], y = h[(k + 1) * n + k];
      const double xs = magnitude(x), ys = magnitude(y), most = std::max(xs, ys);
      if (!(most > 0.0)) {
        cosine[k] = {1.0, 0.0}, sine[k] = {};
        continue;
      }
      const double xr = xs / most, yr = ys / most, r = most * std::sqrt(xr * xr + yr * yr);
      cosine[k] = {x.re / r, x.im / r}, sine[k] = {y.re / r, y.im / r};
      for (int j = k; j < n; ++j) {
        const Complex p = h[k * n + j], q = h[(k + 1) * n + j];
        h[k * n + j] = conjugate(cosine[k]) * p + conjugate(sine[k]) * q;
        h[(k + 1) * n + j] = cosine[k] * q - sine[k] * p;
      }
      h[(k + 1) * n + k] = {};
    }
    for (int k = first; k < last; ++k) {
      const auto turn = [&](Complex& p, Complex& q) {
        const Complex x = p, y = q;
        p = x * cosine[k] + y * sine[k], q = y * conjugate(cosine[k]) - x * conjugate(sine[k]);
      };
      for (int i = 0; i <= std::min(k + 1, last); ++i) turn(h[i * n + k], h[i * n + k + 1]);
      for (int i = 0; i < n; ++i) turn(z[i * n + k], z[i * n + k + 1]);
    }
    for (int i = first; i <= last; ++i) h[i * n + i] = h[i * n + i] + shift;
  }
  return true;
}

// Vectors of a triangle as columns, by substitution; near-equal values are kept apart by rounding's size.
std::vector<Complex> triangle_vectors(int n, const std::vector<Complex>& t) {
  double size = 0.0;
  for (Complex x : t) size = std::max(size, magnitude(x));
  const double least = std::max(EPSILON * size, std::numeric_limits<double>::min());
  std::vector<Complex> x((std::size_t)n * n);
  for (int k = 0; k < n; ++k) {
    x[k * n + k] = {1.0, 0.0};
    for (int i = k - 1; i >= 0; --i) {
      Complex sum = {};
      for (int j = i + 1; j <= k; ++j) sum = sum + t[i * n + j] * x[j * n + k];
      Complex apart = t[k * n + k] - t[i * n + i];
      if (magnitude(apart) < least) apart = {least, 0.0};
      x[i * n + k] = sum / apart;
      const double most = magnitude(x[i * n + k]);
      if (most > 1e100)  // of a value that is nearly there twice
        for (int j = i; j <= k; ++j) x[j * n + k] = (1.0 / most) * x[j * n + k];
    }
  }
  return x;
}

}  // namespace

bool symmetric_eigen(int n, const double* a, const double* b, SymmetricEigen* found) {
  const std::size_t count = (std::size_t)n * n;
  if (!is_finite(a, count) || !is_finite(b, count)) return false;
  Entry l(count, 0.0), c(count), v(count);
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) {
      double x = b[i * n + j];
      for (int k = 0; k < j; ++k) x -= l[i * n + k] * l[j * n + k];
      if (i == j && !(x > 0.0)) return false;
      l[i * n + j] = i == j ? std::sqrt(x) : x / l[j * n + j];
    }
  // L^-1 A L^-T: columns of A, then rows
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) c[i * n + j] = i >= j ? a[i * n + j] : a[j * n + i];
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) c[i * n + j] -= l[i * n + k] * c[k * n + j];
      c[i * n + j] /= l[i * n + i];
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < j; ++k) c[i * n + j] -= l[j * n + k] * c[i * n + k];
      c[i * n + j] /= l[j * n + j];
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) c[i * n + j] = c[j * n + i] = 0.5 * (c[i * n + j] + c[j * n + i]);
  if (!rotate_to_diagonal(n, c, v)) return false;
  for (int j = 0; j < n; ++j)
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) v[i * n + j] -= l[k * n + i] * v[k * n + j];
      v[i * n + j] /= l[i * n + i];
    }
  std::vector<int> order((std::size_t)n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return c[i * n + i] < c[j * n + j]; });
  found->values.resize((std::size_t)n), found->vectors.resize(count);
  for (int j = 0; j < n; ++j) {
    const int from = order[j];
    found->values[j] = c[from * n + from];
    const double sign = v[largest_of_column(v, n, from) * n + from] < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < n; ++i) found->vectors[i * n + j] = sign * v[i * n + from];
  }
  return true;
}

bool general_eigen(int n, const double* matrix, GeneralEigen* found) {
  const std::size_t count = (std::size_t)n * n;
  if (!is_finite(matrix, count)) return false;
  Entry a(matrix, matrix + count), q(count);
  const Entry scale = balanced(n, a);
  to_hessenberg(n, a, q);
  std::vector<Complex> h(count), z(count);
  for (std::size_t e = 0; e < count; ++e) h[e] = {a[e], 0.0}, z[e] = {q[e], 0.0};
  if (!to_triangle(n, h, z)) return false;
  const std::vector<Complex> of_triangle = triangle_vectors(n, h);
  std::vector<Complex> value((std::size_t)n), x(count);
  double size = 0.0;
  for (int k = 0; k < n; ++k) value[k] = h[k * n + k], size = std::max(size, magnitude(value[k]));
  for (int j = 0; j < n; ++j) {
    double most = 0.0, square = 0.0;
    for (int i = 0; i < n; ++i) {
      Complex sum = {};
      for (int k = 0; k <= j; ++k) sum = sum + z[i * n + k] * of_triangle[k * n + j];
      x[i * n + j] = scale[i] * sum, most = std::max(most, magnitude(x[i * n + j]));
    }
    int largest = -1;
    for (int i = 0; i < n; ++i) {
      x[i * n + j] = (1.0 / most) * x[i * n + j];
      const double part = magnitude(x[i * n + j]);
      square += part * part;
      // the first of those that are largest but for rounding
      if (largest < 0 && part > 1.0 - 1e-9) largest = i;
    }
    const Complex lead = x[largest * n + j];
    const Complex by = (1.0 / (magnitude(lead) * std::sqrt(square))) * conjugate(lead);
    for (int i = 0; i < n; ++i) x[i * n + j] = x[i * n + j] * by;
    x[largest * n + j].im = 0.0;
  }
  // a real matrix has complex values in pairs: each with a positive imaginary part stands for both
  std::vector<int> order((std::size_t)n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return value[i].im > value[j].im; });
  std::vector<bool> used((std::size_t)n, false);
  struct Found {
    Complex value;
    int column;
    bool paired;
  };
  std::vector<Found> list;
  for (int i : order) {
    if (used[i]) continue;
    used[i] = true;
    int partner = -1;
    double nearest = std::abs(value[i].im);  // the real axis, if no conjugate is nearer
    for (int j = 0; j < n; ++j) {
      if (used[j]) continue;
      const double off = magnitude(value[j] - conjugate(value[i]));
      if (off < nearest) nearest = off, partner = j;
    }
    const bool real = partner < 0 || !(value[i].im > EPSILON * size);
    if (!real) used[partner] = true;
    list.push_back({real ? Complex{value[i].re, 0.0} : value[i], i, !real});
  }
  std::stable_sort(list.begin(), list.end(), [](const Found& one, const Found& other) {
    return magnitude(one.value) < magnitude(other.value);
  });
  for (Entry* part : {&found->real, &found->imaginary}) part->clear();
  found->vectors_real.assign(count, 0.0), found->vectors_imaginary.assign(count, 0.0);
  for (const Found& one : list)
    for (int side = 0; side < (one.paired ? 2 : 1); ++side) {
      const int to = (int)found->real.size();
      const double sign = side ? -1.0 : 1.0;
      found->real.push_back(one.value.re), found->imaginary.push_back(sign * one.value.im);
      for (int i = 0; i < n; ++i) {
        found->vectors_real[i * n + to] = x[i * n + one.column].re;
        found->vectors_imaginary[i * n + to] = one.paired ? sign * x[i * n + one.column].im : 0.0;
      }
    }
  return (int)found->real.size() == n;
}
