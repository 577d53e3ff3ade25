// Whether a block's Jacobian is joined with that of a place before by a segment of regular matrices: the spectral
// radius of J^+ J_0 - I is at most a limit (judge.cpp has the same test in doubles, docs/numerics.md what it shows).
#pragma once

#include "response/equations_of_motion.hpp"
#include "rows/position.hpp"

namespace {

inline Pack frobenius(const Pack* e, int n) {
  Pack sum = 0.0;
  for (int k = 0; k < n * n; ++k) sum += e[k] * e[k];
  return sqrt(sum);
}

// |E^k|^(1/k) bounds the radius for k = 1, 2, 4 ... 16; the norm is kept as a power of the limit, so that no root is
// needed. E is lost.
inline Mask radius_within(Pack* e, Pack* square, int n, Pack limit) {
  Mask within = frobenius(e, n) <= limit;
  for (int k = 2; k <= 16 && !all(within); k *= 2) {
    limit = limit * limit;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        Pack sum = 0.0;
        for (int l = 0; l < n; ++l) sum += e[i * n + l] * e[l * n + j];
        square[i * n + j] = sum;
      }
    for (int k2 = 0; k2 < n * n; ++k2) e[k2] = square[k2];
    within = within | (frobenius(e, n) <= limit);
  }
  return within;
}

// Unknowns of blocks whose sizes the compiler knows: they are solved for column after column.
constexpr int MOST_BY_COLUMNS = 6;

// A number that goes with t from -1 to 1: a polynomial, and a bound of what that leaves out.
constexpr int ORDER = 3;
struct OnSegment {
  Pack c[ORDER + 1], rest;
};
static_assert(sizeof(OnSegment) == NUMBERS_ON_SEGMENT * sizeof(Pack));

// The largest size of its polynomial.
MECHKIN_INLINE Pack size_of(const OnSegment& a) { return abs(a.c[0]) + abs(a.c[1]) + abs(a.c[2]) + abs(a.c[3]); }

// Bound of what the product of two polynomials has beyond ORDER.
MECHKIN_INLINE Pack beyond_order(const Pack* a, const Pack* b) {
  return abs(a[1] * b[3] + a[2] * b[2] + a[3] * b[1]) + abs(a[2] * b[3] + a[3] * b[2]) + abs(a[3] * b[3]);
}

MECHKIN_INLINE void put_product(const OnSegment& a, const OnSegment& b, OnSegment* to) {
  for (int k = 0; k <= ORDER; ++k) {
    to->c[k] = a.c[0] * b.c[k];
    for (int l = 1; l <= k; ++l) to->c[k] += a.c[l] * b.c[k - l];
  }
  to->rest = beyond_order(a.c, b.c) + size_of(a) * b.rest + a.rest * (size_of(b) + b.rest);
}

// 1 / p, with `least` a lower bound of |p|.
MECHKIN_INLINE OnSegment reciprocal(const OnSegment& p, Pack least) {
  OnSegment q;
  q.c[0] = Pack(1.0) / p.c[0];
  for (int k = 1; k <= ORDER; ++k) {
    Pack sum = p.c[1] * q.c[k - 1];
    for (int l = 2; l <= k; ++l) sum += p.c[l] * q.c[k - l];
    q.c[k] = -(q.c[0] * sum);
  }
  // 1 / p - q = (1 - p q) / p
  q.rest = (beyond_order(p.c, q.c) + p.rest * size_of(q)) / least;
  return q;
}

// Whether no pivot of the elimination of J + s (J_0 - J) leaves the range from 1 - limit to 1 / (1 - limit) of what it is at
// s = 0, for all s from `begin` to `end` at once; J is factored in `at`, whose exchanges of rows are those of all s.
inline Mask keeps_pivots(const BlockMatrices& at, const Pack* here, const Pack* origin, double begin, double end,
                         double limit, OnSegment* room) {
  const Band f = at.band();
  const int inner = f.inner(), n = f.n;
  const Pack middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  for (int e = 0; e < at.entries; ++e) {
    const Pack way = origin[e] - here[e];
    room[e] = {{here[e] + middle * way, half * way, Pack(0.0), Pack(0.0)}, Pack(0.0)};
  }
  const auto place = [&](int i, int j) { return room + (f.in_column(i, j) - f.a); };
  const auto is_zero = [](const OnSegment& a) __attribute__((always_inline)) {
    return all((size_of(a) == Pack(0.0)) & (a.rest == Pack(0.0)));
  };
  Mask within = all_lanes(true);
  const Mask* swap = f.swap;
  for (int k = 0; k < n; ++k) {
    const int reach = f.row[k].reach, band_end = f.row[k].end, border = k < inner ? inner : k + 1;
    const auto each_column = [&](auto&& visit) __attribute__((always_inline)) {
      for (int j = k + 1; j < band_end; ++j) visit(j);
      for (int j = border; j < n; ++j) visit(j);
    };
    for (int i = k + 1; i < reach; ++i) {
      const Mask c = *swap++;
      if (!any(c)) continue;
      const auto exchange_entries = [&](int j) __attribute__((always_inline)) {
        OnSegment &a = *place(k, j), &b = *place(i, j);
        for (int o = 0; o <= ORDER; ++o) exchange(c, a.c[o], b.c[o]);
        exchange(c, a.rest, b.rest);
      };
      exchange_entries(k);
      each_column(exchange_entries);
    }
    const OnSegment pivot = *place(k, k);
    const Pack now = Pack(1.0) / *f.in_column(k, k), size = abs(now), sign = copysign(Pack(1.0), now);
    const Pack bend = sign * pivot.c[2], off = abs(pivot.c[1]) + abs(pivot.c[3]) + pivot.rest;
    const Pack low = sign * pivot.c[0] - off + min(bend, Pack(0.0)), high = sign * pivot.c[0] + off + max(bend, Pack(0.0));
    within = within & (low >= Pack(1.0 - limit) * size) & (Pack(1.0 - limit) * high <= size);
    if (!any(within)) return within;
    const OnSegment inverse = reciprocal(pivot, low);
    for (int i = k + 1; i < reach; ++i) {
      const OnSegment& entry = *place(i, k);
      if (is_zero(entry)) continue;
      OnSegment factor, product;
      put_product(entry, inverse, &factor);
      each_column([&](int j) __attribute__((always_inline)) {
        const OnSegment& above = *place(k, j);
        if (is_zero(above)) return;
        put_product(factor, above, &product);
        OnSegment& to = *place(i, j);
        for (int o = 0; o <= ORDER; ++o) to.c[o] -= product.c[o];
        to.rest += product.rest;
      });
    }
  }
  return within;
}

// The way to the origin is looked at in one piece, or in so many where bounds are too wide.
constexpr int MOST_PIECES = 4;

// As is_regular, of a block with a band whose Jacobian is `here`: pivot by pivot (docs/numerics.md).
__attribute__((noinline)) Mask is_regular_band(const BlockMatrices& at, const Pack* here, const Pack* origin, double limit,
                                               OnSegment* room) {
  Mask within = all_lanes(false);
  for (int pieces = 1; pieces <= MOST_PIECES && !all(within); pieces *= 2) {
    Mask kept = all_lanes(true);
    for (int k = 0; k < pieces && any(kept); ++k)
      kept = kept & keeps_pivots(at, here, origin, (double)k / pieces, (double)(k + 1) / pieces, limit, room);
    within = within | kept;
  }
  return within;
}

// Of a factored block against its Jacobian at the origin (rows x size); `room` for two square matrices.
// Kept apart: inlined into its caller GCC 12 fails on it (internal error in gimple_expand_vec_cond_expr) with two lanes.
__attribute__((noinline)) Mask is_regular(const Plan& p, Workspace& w, int block, const Pack* origin, double limit, Pack* room) {
  const BlockMatrices at = matrices_of(p, w, block);
  const int n = at.n;
  if (n > MOST_BY_COLUMNS && at.m == n) {
    for (int e = 0; e < n * n; ++e) room[e] = origin[e];
    solve_columns(at.lu(), room);
  } else {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < at.m; ++i) w.right[i] = origin[i * n + j];
      at.solve_equations(w.right);
      for (int i = 0; i < n; ++i) room[i * n + j] = w.right[i];
    }
  }
  for (int j = 0; j < n; ++j) room[j * n + j] -= Pack(1.0);
  return radius_within(room, room + n * n, n, Pack(limit));
}

}  // namespace
