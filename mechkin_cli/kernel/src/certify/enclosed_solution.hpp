// Solutions of linear systems whose matrix and right-hand side are enclosed, in residual form.
//
// With A x = b, any matrix C and any x~ (S. M. Rump, Verification methods, Acta Numerica 19, 2010, section 10):
//
//     x - x~ = C (b - A x~) + (I - C A) (x - x~)
//
// so that with z = C (b - A x~) and E >= |I - C A|, |x - x~| <= |z| + E |x - x~|. For any v >= |z| with E v <= k v, k < 1,
// that gives |x - x~| <= v / (1 - k), and x in x~ + z +- E v / (1 - k). Where k is not below 1 the radius is not finite.
#pragma once

#include "pack.hpp"

namespace {

// |a| at most, of all that an interval holds.
MECHKIN_INLINE Real size_of(Interval a) { return magnitude(a); }

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
  for (int k = 0; k < count; ++k) size[k] = size_of(z[k]);
  // what stands for lost digits is no part of it
  for (int k = 0; k < count; ++k) v[k] = widened(size[k] + by_errors(k, size)) + Real(0x1p-1000);
  Real factor = 0.0;
  for (int k = 0; k < count; ++k) {
    const Real share = widened(by_errors(k, v) / v[k]);
    factor = select(share <= factor, factor, share);  // a NaN wins
  }
  const Real rest = narrowed(positive_or_zero(narrowed(Real(1.0) - factor) - Real(0x1p-52)));
  for (int k = 0; k < count; ++k) size[k] = widened(by_errors(k, v) / rest);
  for (int k = 0; k < count; ++k) x[k] = Pack(near[k]) + z[k] + Pack(Real(0.0), size[k]);
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
      Pack sum = u == v ? -1.0 : 0.0;
      for (int i = 0; i < f.m; ++i) sum += Pack(f.inverse[u * f.m + i]) * f.a[i * f.n + v];
      f.error[u * f.n + v] = size_of(sum);
    }
}

// Room, in packs, that the solutions need.
inline long solution_room(int m, int n) { return 4L * (m + n); }

// A x = b into x (n); b has m.
inline void solve_enclosed(const EnclosedMatrix& f, const Pack* b, Pack* room, Pack* x) {
  Pack* const z = room;
  Real *const near = (Real*)(z + f.n), *const spread = near + f.n;
  for (int u = 0; u < f.n; ++u) {
    near[u] = 0.0;
    for (int i = 0; i < f.m; ++i) near[u] += f.inverse[u * f.m + i] * b[i].midpoint;
    z[u] = 0.0;
  }
  for (int i = 0; i < f.m; ++i) {
    Pack rest = b[i];
    for (int u = 0; u < f.n; ++u) rest -= f.a[i * f.n + u] * Pack(near[u]);
    for (int u = 0; u < f.n; ++u) z[u] += Pack(f.inverse[u * f.m + i]) * rest;
  }
  enclose_solution(f.n, near, z, [&](int u, int v) { return f.error[u * f.n + v]; }, spread, x);
}

// A^T l = f into l (m), zero for the equations that are not needed; `effort` has n.
inline void solve_enclosed_transposed(const EnclosedMatrix& f, const Pack* effort, Pack* room, Real* error, Pack* l) {
  Pack *const z = room, *const rest = room + f.m;
  Real *const near = (Real*)(rest + f.n), *const spread = near + f.m;
  for (int i = 0; i < f.m; ++i) {
    near[i] = 0.0;
    for (int u = 0; u < f.n; ++u) near[i] += f.inverse[u * f.m + i] * effort[u].midpoint;
  }
  for (int u = 0; u < f.n; ++u) {
    rest[u] = effort[u];
    for (int i = 0; i < f.m; ++i) rest[u] -= f.a[i * f.n + u] * Pack(near[i]);
  }
  for (int i = 0; i < f.m; ++i) {
    z[i] = 0.0;
    Real used = 0.0;
    for (int u = 0; u < f.n; ++u) {
      z[i] += Pack(f.inverse[u * f.m + i]) * rest[u];
      used += abs(f.inverse[u * f.m + i]);
    }
    const Mask needed = ~(used == Real(0.0));
    for (int k = 0; k < f.m; ++k) {
      Pack sum = i == k ? -1.0 : 0.0;
      for (int u = 0; u < f.n; ++u) sum += Pack(f.inverse[u * f.m + i]) * f.a[k * f.n + u];
      error[i * f.m + k] = select(needed, size_of(sum), Real(0.0));
    }
    z[i] = {select(needed, z[i].midpoint, Real(0.0)), select(needed, z[i].radius, Real(0.0))};
  }
  enclose_solution(f.m, near, z, [&](int i, int k) { return error[i * f.m + k]; }, spread, l);
}

}  // namespace
