// Bands of many loops for one pack, behind plain C functions for the tests.
#include "rows/regular_band.hpp"
#include "rows/position.hpp"
#include "rows/inverse_norm.hpp"

namespace {

constexpr int MOST = 64, MOST_ENTRIES = 64 * MOST;

// A band with its memory; entries lie lane after lane.
struct Probe {
  Pack entry[MOST_ENTRIES], here[MOST_ENTRIES], origin[MOST_ENTRIES];
  Mask swap[MOST * MOST];
  Pack vector[MOST], room[8 * MOST];
  alignas(64) char segment[8 * MOST_ENTRIES * sizeof(OnSegment)];

  BlockMatrices matrices(int n, int border, int entries, const BandRow* row) {
    return {entry, nullptr, nullptr, swap, n, n, row, border, entries};
  }
};

void load(int count, const double* from, Pack* to) {
  for (int lane = 0; lane < LANES; ++lane)
    for (int i = 0; i < count; ++i) to[i].v[lane] = from[lane * count + i];
}
void store(int count, const Pack* from, double* to) {
  for (int lane = 0; lane < LANES; ++lane)
    for (int i = 0; i < count; ++i) to[lane * count + i] = from[i].v[lane];
}

}  // namespace

#define EXPORTED extern "C" __attribute__((visibility("default")))

// Entries of J (as `row` has them), b (n) -> x of J x = b, y of J^T y = b, the sign of the determinant, and the least
// pivot.
EXPORTED void solve_band(int n, int border, int entries, const BandRow* row, const double* a, const double* b, double* x,
                         double* y, double* sign, double* least) {
  static Probe p;
  const BlockMatrices at = p.matrices(n, border, entries, row);
  load(entries, a, p.entry);
  at.factor_jacobian();
  load(n, b, p.vector);
  at.solve_equations(p.vector);
  store(n, p.vector, x);
  load(n, b, p.vector);
  at.solve_multipliers(p.vector, 0, Pack(0.0));
  store(n, p.vector, y);
  const Pack found = at.side(), pivot = at.least();
  store(1, &found, sign);
  store(1, &pivot, least);
}

// The same by doubles, one lane after the other; and z = J b.
EXPORTED void solve_doubles(int n, int border, int entries, const BandRow* row, const double* a, const double* b, double* x,
                            double* y, double* z) {
  for (int lane = 0; lane < LANES; ++lane) {
    static double entry[MOST_ENTRIES];
    static unsigned char swap[MOST * MOST];
    const BandOf<DoubleEntries> band = {entry, swap, row, n, border};
    for (int e = 0; e < entries; ++e) entry[e] = a[lane * entries + e];
    multiply(band, b + lane * n, z + lane * n);
    factor(band);
    for (int i = 0; i < n; ++i) x[lane * n + i] = y[lane * n + i] = b[lane * n + i];
    solve(band, x + lane * n);
    solve_transposed(band, y + lane * n);
  }
}

// Whether J is told to be joined with that of the origin.
EXPORTED void is_joined(int n, int border, int entries, const BandRow* row, const double* a, const double* origin, double limit,
                        double* found) {
  static Probe p;
  load(entries, a, p.here);
  load(entries, origin, p.origin);
  SegmentRoom room;
  lay_out_segment(row, n, entries, p.segment, &room);
  const Band band = {nullptr, nullptr, row, n, border};
  const Pack joined = select(is_regular_band(band, entries, p.here, p.origin, limit, room), Pack(1.0), Pack(0.0));
  store(1, &joined, found);
}

// The largest singular value of C^-1 J^-1 R, with the entries of R and C.
EXPORTED void largest_inverse(int n, int border, int entries, const BandRow* row, const double* a, const double* rows,
                              const double* columns, double* found) {
  static Probe p;
  const BlockMatrices at = p.matrices(n, border, entries, row);
  load(entries, a, p.entry);
  at.factor_jacobian();
  int unknown[MOST];
  for (int i = 0; i < n; ++i) unknown[i] = i, p.vector[i] = rows[i];
  const Pack norm = inverse_norm(at, p.vector, columns, unknown, p.room);
  store(1, &norm, found);
}
