// Whether the Jacobian of many loops is joined with that of a place before by a segment of regular matrices: no pivot of
// the elimination along it comes near zero (docs/numerics.md).
//
// Powers of J^-1 J_0 - I, as of small blocks (regular.hpp), would be full, and the longer a row of loops the higher the power
// that says anything: what one loop's change does to all behind it is no eigenvalue. Pivots stand loop by loop, each
// with its own unknowns, and the last with the direction of the whole motion. They need not be those of the factors.
#pragma once

#include "plan/room.hpp"
#include "rows/band.hpp"

namespace {

// A number that goes with t from -1 to 1: a polynomial, a bound of what that leaves out, and its value at the stage.
constexpr int ORDER = 3;
struct OnSegment {
  Pack c[ORDER + 1], rest, now;
};

MECHKIN_INLINE OnSegment constant_on_segment(double x) {
  return {{Pack(x), Pack(0.0), Pack(0.0), Pack(0.0)}, Pack(0.0), Pack(x)};
}
MECHKIN_INLINE OnSegment negative(const OnSegment& a) {
  return {{-a.c[0], -a.c[1], -a.c[2], -a.c[3]}, a.rest, -a.now};
}

// The largest size of its polynomial.
MECHKIN_INLINE Pack size_of(const OnSegment& a) { return abs(a.c[0]) + abs(a.c[1]) + abs(a.c[2]) + abs(a.c[3]); }
MECHKIN_INLINE bool is_zero(const OnSegment& a) { return all(size_of(a) + a.rest + abs(a.now) == Pack(0.0)); }

// Bound of what the product of two polynomials has beyond ORDER.
MECHKIN_INLINE Pack beyond_order(const Pack* a, const Pack* b) {
  return abs(a[1] * b[3] + a[2] * b[2] + a[3] * b[1]) + abs(a[2] * b[3] + a[3] * b[2]) + abs(a[3] * b[3]);
}

inline void add_product(OnSegment& x, const OnSegment& a, const OnSegment& b) {
  if (is_zero(a) || is_zero(b)) return;
  for (int k = 0; k <= ORDER; ++k)
    for (int l = 0; l <= k; ++l) x.c[k] += a.c[l] * b.c[k - l];
  x.rest += beyond_order(a.c, b.c) + size_of(a) * b.rest + a.rest * (size_of(b) + b.rest);
  x.now += a.now * b.now;
}

// 1 / p, with `least` a lower bound of |p|.
inline OnSegment reciprocal(const OnSegment& p, Pack least) {
  OnSegment q;
  q.c[0] = Pack(1.0) / p.c[0], q.now = Pack(1.0) / p.now;
  for (int k = 1; k <= ORDER; ++k) {
    Pack sum = p.c[1] * q.c[k - 1];
    for (int l = 2; l <= k; ++l) sum += p.c[l] * q.c[k - l];
    q.c[k] = -(q.c[0] * sum);
  }
  // 1 / p - q = (1 - p q) / p
  q.rest = (beyond_order(p.c, q.c) + p.rest * size_of(q)) / least;
  return q;
}

MECHKIN_INLINE void exchange(Mask lanes, OnSegment& a, OnSegment& b) {
  for (int o = 0; o <= ORDER; ++o) PackEntries::exchange(lanes, a.c[o], b.c[o]);
  PackEntries::exchange(lanes, a.rest, b.rest), PackEntries::exchange(lanes, a.now, b.now);
}

// Equations of one closing joint, most of them, which are eliminated together: those with the same rows.
constexpr int MOST_TOGETHER = 6;
inline int end_of_panel(Band f, int begin) {
  int end = begin + 1;
  while (end < f.n && end < begin + MOST_TOGETHER && end != f.inner() && f.row[end].reach == f.row[begin].reach) ++end;
  return end;
}

// What the elimination along a segment is computed in.
struct SegmentRoom {
  OnSegment* entry;   // as the band has them
  OnSegment* mixed;   // what rows of a panel have become of what they were
  OnSegment* before;  // rows of a panel: one column
  Pack* last;         // rows: one more than the last equation of the band that each holds
};

inline long lay_out_segment(const BandRow* row, int n, long entries, char* memory, SegmentRoom* to) {
  Room room = {memory};
  long most = 0;
  for (int k = 0; k < n; ++k) most = row[k].reach - k > most ? row[k].reach - k : most;
  to->entry = room.take<OnSegment>(entries);
  to->mixed = room.take<OnSegment>(most * most);
  to->before = room.take<OnSegment>(most);
  to->last = room.take<Pack>(n);
  return room.used;
}

// Of rows with entries of about one size that which ends with the panel is its pivot: what is left is then a row as the plan
// has it, whose bounds nothing before has widened.
constexpr double ENDING_ROWS_FIRST = 2.0;

// The elimination of J + s (J_0 - J) along a part of the way.
struct Elimination {
  const Band f;
  const SegmentRoom& at;
  const double limit;
  Mask within = all_lanes(true);

  MECHKIN_INLINE OnSegment& entry(int i, int j) const { return at.entry[f.place(i, j)]; }

  void begin(const Pack* here, const Pack* origin, int entries, double from, double to) {
    const Pack middle = 0.5 * (from + to), half = 0.5 * (to - from);
    for (int e = 0; e < entries; ++e) {
      const Pack way = origin[e] - here[e];
      at.entry[e] = {{here[e] + middle * way, half * way, Pack(0.0), Pack(0.0)}, Pack(0.0), here[e]};
    }
    for (int i = 0; i < f.n; ++i) at.last[i] = f.row[i].last;
  }

  // Brings the pivot of column k of a panel of `rows` rows from `first` on to its row; `end`: of its columns.
  void exchange_rows(int k, int first, int rows, int panel, int end) const {
    const auto weight = [&](int i) __attribute__((always_inline)) {
      return select(at.last[i] <= Pack(panel), Pack(ENDING_ROWS_FIRST), Pack(1.0)) * abs(entry(i, k).now);
    };
    OnSegment* const own = at.mixed + (long)(k - first) * rows;
    for (int i = k + 1; i < first + rows; ++i) {
      const Mask c = weight(i) > weight(k);
      if (!any(c)) continue;
      OnSegment* const other = at.mixed + (long)(i - first) * rows;
      for (int j = k; j < end; ++j) exchange(c, entry(k, j), entry(i, j));
      for (int a = 0; a < rows; ++a) exchange(c, own[a], other[a]);
      PackEntries::exchange(c, at.last[k], at.last[i]);
    }
  }

  // A lower bound of the size of a pivot, which is to stay within its range.
  Pack judge(const OnSegment& pivot) {
    const Pack size = abs(pivot.now), sign = copysign(Pack(1.0), pivot.now);
    const Pack bend = sign * pivot.c[2], off = abs(pivot.c[1]) + abs(pivot.c[3]) + pivot.rest;
    const Pack low = sign * pivot.c[0] - off + min(bend, Pack(0.0)), high = sign * pivot.c[0] + off + max(bend, Pack(0.0));
    within = within & (low >= Pack(1.0 - limit) * size) & (Pack(1.0 - limit) * high <= size) & (size > Pack(0.0));
    return low;
  }

  // The columns of a panel. Those of the border, which pass all loops, are told apart: each panel's rows are mixed by
  // numbers of their own, and then with the border. Bounds by one factor after the other would grow from loop to loop, even
  // where the motion goes on as it came.
  void eliminate(int first, int panel) {
    const int inner = f.inner(), rows = f.row[first].reach - first;
    for (int i = 0; i < rows; ++i)
      for (int a = 0; a < rows; ++a) at.mixed[i * rows + a] = constant_on_segment(i == a);
    for (int k = first; k < panel; ++k) {
      const int end = k < inner ? f.row[k].end : panel;
      exchange_rows(k, first, rows, panel, end);
      const Pack low = judge(entry(k, k));
      if (!any(within)) return;
      const OnSegment inverse = negative(reciprocal(entry(k, k), low)), *const own = at.mixed + (long)(k - first) * rows;
      for (int i = k + 1; i < first + rows; ++i) {
        OnSegment factor = constant_on_segment(0.0);
        add_product(factor, entry(i, k), inverse);
        if (is_zero(factor)) continue;
        OnSegment* const other = at.mixed + (long)(i - first) * rows;
        for (int j = k + 1; j < end; ++j) add_product(entry(i, j), factor, entry(k, j));
        for (int a = 0; a < rows; ++a) add_product(other[a], factor, own[a]);
        at.last[i] = select(size_of(factor) > Pack(0.0), max(at.last[i], at.last[k]), at.last[i]);
      }
    }
    for (int j = panel > inner ? panel : inner; j < f.n; ++j) {
      for (int a = 0; a < rows; ++a) at.before[a] = entry(first + a, j);
      for (int i = panel; i < first + rows; ++i) {
        entry(i, j) = constant_on_segment(0.0);
        for (int a = 0; a < rows; ++a) add_product(entry(i, j), at.mixed[(i - first) * rows + a], at.before[a]);
      }
    }
  }
};

// The way to the origin is looked at in one piece, or in so many where bounds are too wide.
constexpr int MOST_PIECES = 4;

// Whether the Jacobian `here` of a block with a band is joined with that of the origin: no pivot of the elimination of J + s
// (J_0 - J) leaves the range from 1 - limit to 1 / (1 - limit) of what it is at s = 0, for all s from 0 to 1.
// Kept apart: see is_regular.
__attribute__((noinline)) Mask is_regular_band(const Band f, int entries, const Pack* here, const Pack* origin, double limit,
                                               const SegmentRoom& room) {
  Mask within = all_lanes(false);
  for (int pieces = 1; pieces <= MOST_PIECES && !all(within); pieces *= 2) {
    Mask kept = all_lanes(true);
    for (int piece = 0; piece < pieces && any(kept); ++piece) {
      Elimination e = {f, room, limit};
      e.begin(here, origin, entries, (double)piece / pieces, (double)(piece + 1) / pieces);
      for (int first = 0, panel; first < f.n && any(e.within); first = panel) {
        panel = end_of_panel(f, first);
        e.eliminate(first, panel);
      }
      kept = kept & e.within;
    }
    within = within | kept;
  }
  return within;
}

}  // namespace
