// Solutions of linear systems whose matrix and right-hand side are enclosed, in residual form.
//
// With A x = b, any matrix C and any x~ (S. M. Rump, Verification methods, Acta Numerica 19, 2010, section 10):
//
//     x - x~ = C (b - A x~) + (I - C A) (x - x~)
//
// The remainder b - A x~ is small, and enclosed in double-double; what C makes of it needs the digits of doubles alone.
//
// so that with z = C (b - A x~) and E >= |I - C A|, |x - x~| <= |z| + E |x - x~|. For any v >= |z| with E v <= k v, k < 1,
// that gives |x - x~| <= v / (1 - k), and x in x~ + z +- E v / (1 - k). Where k is not below 1 the radius is not finite.
#pragma once

#include "arithmetic/pack.hpp"

namespace {

// Sums of products with doubles c in doubles: the computed one, and how far those of all that the intervals hold are off.
struct SumOfDoubles {
  Real sum = 0.0, sizes = 0.0, radius = 0.0;
  int terms = 0;
  MECHKIN_INLINE void add(Real c, const Interval& a) {
    const Real size = abs(c);
    sum += c * a.midpoint.high, sizes += size * a.size(), radius += size * radius_about_high(a), ++terms;
  }
  // Each term is rounded once as a product, and with each sum after it.
  MECHKIN_INLINE Real off() const {
    const Real rounded = Real((terms + 2) * 0x1p-53) * sizes + Real((terms + 1) * LEAST);
    return widened((radius + rounded) * Real(1.0 + (terms + 4) * 0x1p-52));
  }
  MECHKIN_INLINE Interval interval() const { return {sum, off()}; }
  MECHKIN_INLINE Real size() const { return widened(abs(sum) + off()); }
};

// x[k] (count) from z[k] and the midpoints near[k]; error(k, l) is E, `spread` room for twice `count`.
template <class Error>
inline void enclose_solution(int count, const Real* near, const Pack* z, const Error& error, Real* spread, Pack* x) {
  // sums of `count` products, each rounded: the last of them gives all of it back, as WIDEN does for nine roundings
  const Real more = 1.0 + (count + 4) * 0x1p-52;
  const auto by_errors = [&](int k, const Real* v) {
    Real sum = LEAST * (1 + count);
    for (int l = 0; l < count; ++l) sum += error(k, l) * v[l];
    return sum * more;
  };
  Real *const size = spread, *const v = spread + count;
  for (int k = 0; k < count; ++k) size[k] = magnitude(z[k]);
  // what stands for lost digits is no part of it
  for (int k = 0; k < count; ++k) v[k] = widened(size[k] + by_errors(k, size)) + Real(0x1p-1000);
  Real factor = 0.0;
  for (int k = 0; k < count; ++k) {
    const Real share = widened(by_errors(k, v) / v[k]);
    factor = select(share <= factor, factor, share);  // a NaN wins
  }
  const Real rest = narrowed(positive_or_zero(narrowed(Real(1.0) - factor) - Real(0x1p-52)));
  for (int k = 0; k < count; ++k) size[k] = widened(by_errors(k, v) / rest);
  for (int k = 0; k < count; ++k) x[k] = {two_sum(near[k], z[k].midpoint.high), widened(z[k].radius + size[k])};
}

// An enclosed matrix of m equations and n unknowns (row-major) with what solves systems of it: C (n x m), in whose
// columns of equations that are not needed there is nothing, and |I - C A| (n x n).
struct EnclosedMatrix {
  const Pack* a;
  const Real* inverse;
  Real* error;
  int m, n;
};

inline void find_error(const EnclosedMatrix& f) {
  for (int u = 0; u < f.n; ++u)
    for (int v = 0; v < f.n; ++v) {
      SumOfDoubles sum;
      if (u == v) sum.add(Real(1.0), Pack(-1.0));
      for (int i = 0; i < f.m; ++i) sum.add(f.inverse[u * f.m + i], f.a[i * f.n + v]);
      f.error[u * f.n + v] = sum.size();
    }
}

// C b into x (n), for a small b (m).
inline void apply_inverse(const EnclosedMatrix& f, const Pack* b, Pack* x) {
  for (int u = 0; u < f.n; ++u) {
    SumOfDoubles sum;
    for (int i = 0; i < f.m; ++i) sum.add(f.inverse[u * f.m + i], b[i]);
    x[u] = sum.interval();
  }
}

// Room, in packs, that the solutions need.
inline long solution_room(int m, int n) { return 4L * (m + n); }

// A x = b into x (n); b has m.
inline void solve_enclosed(const EnclosedMatrix& f, const Pack* b, Pack* room, Pack* x) {
  Pack *const z = room, *const rest = room + f.n;
  Real *const near = (Real*)(rest + f.m), *const spread = near + f.n;
  for (int u = 0; u < f.n; ++u) {
    near[u] = 0.0;
    for (int i = 0; i < f.m; ++i) near[u] += f.inverse[u * f.m + i] * b[i].midpoint.high;
  }
  for (int i = 0; i < f.m; ++i) {
    rest[i] = b[i];
    for (int u = 0; u < f.n; ++u) subtract_product(rest[i], f.a[i * f.n + u], Pack(near[u]));
  }
  apply_inverse(f, rest, z);
  enclose_solution(f.n, near, z, [&](int u, int v) { return f.error[u * f.n + v]; }, spread, x);
}

// A^T l = f into l (m), zero for the equations that are not needed; `effort` has n.
inline void solve_enclosed_transposed(const EnclosedMatrix& f, const Pack* effort, Pack* room, Real* error, Pack* l) {
  Pack *const z = room, *const rest = room + f.m;
  Real *const near = (Real*)(rest + f.n), *const spread = near + f.m;
  for (int i = 0; i < f.m; ++i) {
    near[i] = 0.0;
    for (int u = 0; u < f.n; ++u) near[i] += f.inverse[u * f.m + i] * effort[u].midpoint.high;
  }
  for (int u = 0; u < f.n; ++u) {
    rest[u] = effort[u];
    for (int i = 0; i < f.m; ++i) subtract_product(rest[u], f.a[i * f.n + u], Pack(near[i]));
  }
  for (int i = 0; i < f.m; ++i) {
    SumOfDoubles of_rest;
    Real used = 0.0;
    for (int u = 0; u < f.n; ++u) {
      of_rest.add(f.inverse[u * f.m + i], rest[u]);
      used += abs(f.inverse[u * f.m + i]);
    }
    const Mask needed = ~(used == Real(0.0));
    for (int k = 0; k < f.m; ++k) {
      SumOfDoubles sum;
      if (i == k) sum.add(Real(1.0), Pack(-1.0));
      for (int u = 0; u < f.n; ++u) sum.add(f.inverse[u * f.m + i], f.a[k * f.n + u]);
      error[i * f.m + k] = select(needed, sum.size(), Real(0.0));
    }
    z[i] = {select(needed, of_rest.sum, Real(0.0)), select(needed, of_rest.off(), Real(0.0))};
  }
  enclose_solution(f.m, near, z, [&](int i, int k) { return error[i * f.m + k]; }, spread, l);
}

}  // namespace
