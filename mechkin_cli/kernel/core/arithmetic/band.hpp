// LU of the Jacobian of many loops in a chain or tree, each of whose equations holds few of the unknowns.
//
// The transposed matrix is factored: its rows are unknowns, its columns equations, loop after loop, and those of the chart,
// which hold all unknowns, stand last as a border. So rows are exchanged among the unknowns of a loop and of those next to
// it, whichever of them has a dead centre, and nothing fills but a band and the border. Where entries can be follows from
// the plan (Plan::band) and is the same for all lanes; pivots are exchanged lane by lane, as in linear.hpp.
#pragma once

#include "arithmetic/band_row.hpp"

namespace {

// Doubles one at a time, for BandOf; packs are in rows/band.hpp.
struct DoubleEntries {
  using Number = double;
  using Swap = unsigned char;
  static Swap is_larger(double a, double b) { return (a < 0.0 ? -a : a) > (b < 0.0 ? -b : b); }
  static bool any(Swap s) { return s; }
  static bool is_zero(double a) { return a == 0.0; }
  static void exchange(Swap s, double& a, double& b) {
    if (!s) return;
    const double x = a;
    a = b, b = x;
  }
  static void subtract_product(double& x, double a, double b) { x -= a * b; }
};

// Row i has the columns of its part of the band, then those of the border; L below the diagonal, U above it, reciprocal
// pivots on it.
template <class Entries>
struct BandOf {
  using Number = typename Entries::Number;
  using Swap = typename Entries::Swap;
  Number* a;
  Swap* swap;  // of each column in turn, the rows that are exchanged with the pivot's
  const BandRow* row;
  int n, border;  // unknowns, and equations of the chart

  int inner() const { return n - border; }
  // The entry of row i and column j, and the rows' beginnings in the band and in the border, from column 0 on.
  int place(int i, int j) const { return row[i].at - row[i].begin + (j < inner() ? j : row[i].end + j - inner()); }
  Number* in_column(int i, int j) const { return a + place(i, j); }
  Number* inside(int i) const { return a + row[i].at - row[i].begin; }
  Number* beyond(int i) const { return a + row[i].at + (row[i].end - row[i].begin) - inner(); }
};

template <class Entries>
inline void factor(BandOf<Entries> f) {
  using Number = typename Entries::Number;
  const int inner = f.inner();
  typename Entries::Swap* swap = f.swap;
  for (int k = 0; k < f.n; ++k) {
    const int reach = f.row[k].reach, end = f.row[k].end, border = k < inner ? inner : k;
    Number *const own = f.inside(k), *const own_border = f.beyond(k), *const pivot = f.in_column(k, k);
    for (int i = k + 1; i < reach; ++i) {
      const typename Entries::Swap c = Entries::is_larger(*f.in_column(i, k), *pivot);
      *swap++ = c;
      if (!Entries::any(c)) continue;
      Number *const other = f.inside(i), *const other_border = f.beyond(i);
      for (int j = k; j < end; ++j) Entries::exchange(c, own[j], other[j]);
      for (int j = border; j < f.n; ++j) Entries::exchange(c, own_border[j], other_border[j]);
    }
    const Number inverse = Number(1.0) / *pivot;
    *pivot = inverse;
    for (int i = k + 1; i < reach; ++i) {
      Number& entry = *f.in_column(i, k);
      const Number l = entry * inverse;
      entry = l;
      if (Entries::is_zero(l)) continue;
      Number *const other = f.inside(i), *const other_border = f.beyond(i);
      for (int j = k + 1; j < end; ++j) Entries::subtract_product(other[j], l, own[j]);
      for (int j = k < inner ? inner : k + 1; j < f.n; ++j) Entries::subtract_product(other_border[j], l, own_border[j]);
    }
  }
}

// The unknowns from the equations' right-hand sides, in place.
template <class Entries>
inline void solve(BandOf<Entries> f, typename Entries::Number* b) {
  using Number = typename Entries::Number;
  const int inner = f.inner();
  for (int k = 0; k < f.n; ++k) {
    const Number *const own = f.inside(k), *const own_border = f.beyond(k);
    const Number x = b[k] * *f.in_column(k, k);
    b[k] = x;
    for (int j = k + 1; j < f.row[k].end; ++j) Entries::subtract_product(b[j], own[j], x);
    for (int j = k < inner ? inner : k + 1; j < f.n; ++j) Entries::subtract_product(b[j], own_border[j], x);
  }
  const typename Entries::Swap* swap = f.swap + f.row[f.n - 1].swaps;
  for (int k = f.n - 1; k >= 0; --k) {
    const int reach = f.row[k].reach;
    for (int i = k + 1; i < reach; ++i) Entries::subtract_product(b[k], *f.in_column(i, k), b[i]);
    for (int i = reach - 1; i > k; --i) Entries::exchange(*--swap, b[k], b[i]);
  }
}

// The equations' multipliers from the unknowns' right-hand sides, in place.
template <class Entries>
inline void solve_transposed(BandOf<Entries> f, typename Entries::Number* b) {
  using Number = typename Entries::Number;
  const int inner = f.inner();
  const typename Entries::Swap* swap = f.swap;
  for (int k = 0; k < f.n; ++k) {
    const int reach = f.row[k].reach;
    for (int i = k + 1; i < reach; ++i) Entries::exchange(*swap++, b[k], b[i]);
    for (int i = k + 1; i < reach; ++i) Entries::subtract_product(b[i], *f.in_column(i, k), b[k]);
  }
  for (int k = f.n - 1; k >= 0; --k) {
    const Number *const own = f.inside(k), *const own_border = f.beyond(k);
    for (int j = k + 1; j < f.row[k].end; ++j) Entries::subtract_product(b[k], own[j], b[j]);
    for (int j = k < inner ? inner : k + 1; j < f.n; ++j) Entries::subtract_product(b[k], own_border[j], b[j]);
    b[k] *= *f.in_column(k, k);
  }
}

// The equations' values y = J x of an unfactored matrix.
template <class Entries>
inline void multiply(BandOf<Entries> f, const typename Entries::Number* x, typename Entries::Number* y) {
  for (int j = 0; j < f.n; ++j) y[j] = 0.0;
  for (int i = 0; i < f.n; ++i) {
    for (int j = f.row[i].begin; j < f.row[i].end; ++j) y[j] += f.inside(i)[j] * x[i];
    for (int j = f.inner(); j < f.n; ++j) y[j] += f.beyond(i)[j] * x[i];
  }
}

}  // namespace
