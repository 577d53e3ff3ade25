// LU of the Jacobian of many loops in a chain or tree, each of whose equations holds few of the unknowns.
//
// The transposed matrix is factored: its rows are unknowns, its columns equations, loop after loop, and those of the chart,
// which hold all unknowns, stand last as a border. So rows are exchanged among the unknowns of a loop and of those next to
// it, whichever of them has a dead centre, and nothing fills but a band and the border. Where entries can be follows from
// the plan (Plan::band) and is the same for all lanes; pivots are exchanged lane by lane, as in linear.hpp.
#pragma once

#include "arithmetic/linear.hpp"
#include "plan/plan.hpp"

namespace {

// Row i has the columns of its part of the band, then those of the border; L below the diagonal, U above it, reciprocal
// pivots on it.
struct Band {
  Pack* a;
  Mask* swap;  // of each column in turn, the rows that are exchanged with the pivot's
  const BandRow* row;
  int n, border;  // unknowns, and equations of the chart

  int inner() const { return n - border; }
  // The entries of row i from column j on, where they are in the band, and in the border.
  MECHKIN_INLINE Pack* inside(int i) const { return a + row[i].at - row[i].begin; }
  MECHKIN_INLINE Pack* beyond(int i) const { return a + row[i].at + (row[i].end - row[i].begin) - inner(); }
  MECHKIN_INLINE Pack* in_column(int i, int j) const { return (j < inner() ? inside(i) : beyond(i)) + j; }
};

// The entry of an equation and an unknown.
inline Pack band_entry(Band f, int equation, int unknown) {
  const BandRow& r = f.row[unknown];
  const bool is_there = equation >= f.inner() || (equation >= r.begin && equation < r.end);
  return is_there ? *f.in_column(unknown, equation) : Pack(0.0);
}

inline void exchange(Mask lanes, Pack& a, Pack& b) {
  const Pack x = a, y = b;
  a = select(lanes, y, x), b = select(lanes, x, y);
}

inline void factor(Band f) {
  const int inner = f.inner();
  Mask* swap = f.swap;
  for (int k = 0; k < f.n; ++k) {
    const int reach = f.row[k].reach, end = f.row[k].end, border = k < inner ? inner : k;
    Pack *const own = f.inside(k), *const own_border = f.beyond(k), *const pivot = f.in_column(k, k);
    for (int i = k + 1; i < reach; ++i) {
      const Mask c = abs(*f.in_column(i, k)) > abs(*pivot);
      *swap++ = c;
      if (!any(c)) continue;
      Pack *const other = f.inside(i), *const other_border = f.beyond(i);
      for (int j = k; j < end; ++j) exchange(c, own[j], other[j]);
      for (int j = border; j < f.n; ++j) exchange(c, own_border[j], other_border[j]);
    }
    const Pack inverse = Pack(1.0) / *pivot;
    *pivot = inverse;
    for (int i = k + 1; i < reach; ++i) {
      Pack& entry = *f.in_column(i, k);
      const Pack l = entry * inverse;
      entry = l;
      if (is_passed_over<0>(l)) continue;
      Pack *const other = f.inside(i), *const other_border = f.beyond(i);
      for (int j = k + 1; j < end; ++j) subtract_product(other[j], l, own[j]);
      for (int j = k < inner ? inner : k + 1; j < f.n; ++j) subtract_product(other_border[j], l, own_border[j]);
    }
  }
}

// The unknowns from the equations' right-hand sides, in place.
inline void solve(Band f, Pack* b) {
  const int inner = f.inner();
  for (int k = 0; k < f.n; ++k) {
    const Pack *const own = f.inside(k), *const own_border = f.beyond(k);
    const Pack x = b[k] * *f.in_column(k, k);
    b[k] = x;
    for (int j = k + 1; j < f.row[k].end; ++j) subtract_product(b[j], own[j], x);
    for (int j = k < inner ? inner : k + 1; j < f.n; ++j) subtract_product(b[j], own_border[j], x);
  }
  const Mask* swap = f.swap + f.row[f.n - 1].swaps;
  for (int k = f.n - 1; k >= 0; --k) {
    const int reach = f.row[k].reach;
    for (int i = k + 1; i < reach; ++i) subtract_product(b[k], *f.in_column(i, k), b[i]);
    for (int i = reach - 1; i > k; --i) exchange(*--swap, b[k], b[i]);
  }
}

// The equations' multipliers from the unknowns' right-hand sides, in place.
inline void solve_transposed(Band f, Pack* b) {
  const int inner = f.inner();
  const Mask* swap = f.swap;
  for (int k = 0; k < f.n; ++k) {
    const int reach = f.row[k].reach;
    for (int i = k + 1; i < reach; ++i) exchange(*swap++, b[k], b[i]);
    for (int i = k + 1; i < reach; ++i) subtract_product(b[i], *f.in_column(i, k), b[k]);
  }
  for (int k = f.n - 1; k >= 0; --k) {
    const Pack *const own = f.inside(k), *const own_border = f.beyond(k);
    for (int j = k + 1; j < f.row[k].end; ++j) subtract_product(b[k], own[j], b[j]);
    for (int j = k < inner ? inner : k + 1; j < f.n; ++j) subtract_product(b[k], own_border[j], b[j]);
    b[k] *= *f.in_column(k, k);
  }
}

// +1 or -1: the sign of the determinant of a factored matrix.
inline Pack determinant_sign(Band f) {
  Pack sign = 1.0;
  for (int k = 0; k < f.n; ++k) sign *= copysign(Pack(1.0), *f.in_column(k, k));
  for (int s = 0; s < f.row[f.n - 1].swaps; ++s) sign = select(f.swap[s], -sign, sign);
  return sign;
}

// As that of linear.hpp.
inline Pack least_pivot(Band f) {
  Pack largest = abs(*f.in_column(0, 0));
  for (int k = 1; k < f.n; ++k) largest = max(abs(*f.in_column(k, k)), largest);
  return Pack(1.0) / largest;
}

}  // namespace
