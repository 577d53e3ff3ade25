// Whether a step of a block with a band stays on its branch (stepping/judge.cpp), by pivots of the band instead of powers of
// full matrices, and how near to a singular place it ends.
#pragma once

#include "rows/inverse_norm.hpp"
#include "rows/regular_band.hpp"

namespace {

// Products by which the largest eigenvalue of the change comes out near enough to choose the next step by.
constexpr int MOST_CHANGES = 16;
// What Lanczos' method may overrate the least singular value by, and as much again.
constexpr double SURELY = 0.96;

// What a step is judged in.
struct BandRoom {
  Pack *here, *origin, *factor;  // entries: of the place, of the one looked at, and the factors of the place
  Mask* swap;
  Pack* vector;  // five of as many numbers as unknowns, and twice the steps of Lanczos' method
  double* one;   // unknowns: weights
  int* number;   // unknowns: their own numbers
  SegmentRoom segment;
};

inline long lay_out_band(const Plan& p, const Block& b, char* memory, BandRoom* to) {
  Room room = {memory};
  const BandRow* const row = p.band + b.column_begin;
  to->here = room.take<Pack>(b.band_entries), to->origin = room.take<Pack>(b.band_entries);
  to->factor = room.take<Pack>(b.band_entries);
  to->swap = room.take<Mask>(row[b.size - 1].swaps);
  to->vector = room.take<Pack>(5 * b.size + 2 * LANCZOS_STEPS);
  to->one = room.take<double>(b.size), to->number = room.take<int>(b.size);
  const long used = lay_out_segment(row, b.size, b.band_entries, nullptr, &to->segment);
  lay_out_segment(row, b.size, b.band_entries, room.take<char>((int)used), &to->segment);
  return room.used;
}

long band_room(const Plan& p) {
  long most = 0;
  BandRoom room;
  for (int k = 0; k < p.blocks; ++k) {
    if (!p.block[k].band_entries) continue;
    const long used = lay_out_band(p, p.block[k], nullptr, &room) + 64;
    most = used > most ? used : most;
  }
  return most;
}

// The matrix `even` in the lanes 0, 2 ..., and `odd` in the others.
inline void load_band(const BlockMatrices& at, const double* even, const double* odd, Pack* to) {
  for (int u = 0; u < at.n; ++u) {
    const auto put = [&](int equation) {
      double x[LANES];
      for (int lane = 0; lane < LANES; ++lane) x[lane] = (lane % 2 ? odd : even)[equation * at.n + u];
      to[place_in_band(at.row[u], equation, at.m - at.charts)] = load(x);
    };
    for (int e = at.row[u].begin; e < at.row[u].end; ++e) put(e);
    for (int e = at.m - at.charts; e < at.m; ++e) put(e);
  }
}

// |E^k x|^(1/k) of E = J^-1 J_0 - I, k changes on: what the next step is chosen by.
inline Pack size_of_change(const BlockMatrices& at, const Band& origin, Pack* x, Pack* y) {
  put_signs(x, at.n);
  Pack growth = 1.0;
  for (int k = 0; k <= MOST_CHANGES; ++k) {
    if (k) {
      multiply(origin, x, y);
      at.solve_equations(y);
      for (int i = 0; i < at.n; ++i) x[i] = y[i] - x[i];
    }
    Pack square = 0.0;
    for (int i = 0; i < at.n; ++i) square += x[i] * x[i];
    const Pack length = sqrt(square), inverse = Pack(1.0) / max(length, Pack(1e-300));
    for (int i = 0; i < at.n; ++i) x[i] *= inverse;
    if (k) growth *= length;
  }
  static_assert(MOST_CHANGES == 16, "the root below");
  return sqrt(sqrt(sqrt(sqrt(growth))));
}

// `danger` and `least` are those of the step's end, whose matrix is in the even lanes.
void judge_band_step(const Plan& p, int index, BandStep* s, char* memory) {
  const Block& b = p.block[index];
  BandRoom room;
  lay_out_band(p, b, memory + (64 - (std::uintptr_t)memory % 64) % 64, &room);
  const BlockMatrices at = {room.factor, nullptr, nullptr, room.swap, b.rows, b.size, p.band + b.column_begin, b.charts, b.band_entries};
  const Band band = at.band();
  load_band(at, s->to, s->from, room.here);
  load_band(at, s->middle, s->middle, room.origin);
  const Mask to_middle = is_regular_band(band, at.entries, room.here, room.origin, s->limit, room.segment);
  load_band(at, s->from, s->to, room.origin);
  const Mask along = is_regular_band(band, at.entries, room.here, room.origin, s->limit, room.segment);
  s->is_regular = all(to_middle) && any(along);
  for (int e = 0; e < at.entries; ++e) room.factor[e] = room.here[e];
  at.factor_jacobian();
  const Band origin = {room.origin, nullptr, at.row, at.n, at.charts};
  s->danger = lane(size_of_change(at, origin, room.vector, room.vector + at.n), 0);
  for (int u = 0; u < at.n; ++u) room.one[u] = 1.0, room.number[u] = u, room.vector[u] = 1.0;
  s->least = SURELY / lane(inverse_norm(at, room.vector, room.one, room.number, room.vector + at.n), 0);
}

}  // namespace
