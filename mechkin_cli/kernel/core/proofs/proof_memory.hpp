// What a proof works with: the memory of one pack of places, and how the blocks hang on each other.
#pragma once

#include <cstdint>

#include "proofs/closing_enclosures.hpp"
#include "proofs/inverse_lanes.hpp"

namespace {

struct Proof {
  Enclosures at;
  const unsigned char* follows;  // equations: ProvingRequest::follows
  unsigned char *reads, *hangs;  // blocks x blocks: whether a block's equations read another's unknowns, and whether they
                                 // do so at all, by way of blocks between; of itself it does
  Pack* inverse;      // C, block by block: size x the equations up to its last
  Pack* middle;       // states
  Real *line, *other_line;  // C at two places of a curve, as `inverse`
  Real* carried;      // largest block x equations
  Real* square;       // largest block squared
  Real* size;         // equations: |F(y)|
  Real *radius, *residual;  // columns: r, |C F(y)|
  Real* influence;    // size x columns of the largest block: |I - C J|
  double* scalar;     // for one lane's inverse
};

// Whether an equation holds where those of its joint that do not follow hold.
inline bool does_follow(const Proof& w, int equation) { return w.follows && w.follows[equation]; }

struct Ledger {
  char* at;
  long used = 0;
  template <class T>
  T* take(long count) {
    T* const here = (T*)(at ? at + used : nullptr);
    used += (count * (long)sizeof(T) + 63) / 64 * 64;
    return here;
  }
};

// Numbers of C in the blocks before one.
inline long inverse_begin(const Plan& p, int block) {
  long numbers = 0, equations = 0;
  for (int b = 0; b < block; ++b) equations += p.block[b].rows, numbers += p.block[b].size * equations;
  return numbers;
}

inline Proof lay_out_proof(const Plan& p, Ledger& ledger) {
  Proof w;
  const long equations = equations_of(p), largest = p.largest_block, inverse = inverse_begin(p, p.blocks);
  w.at.q = ledger.take<Pack>(p.states);
  w.at.pose = ledger.take<Pose>(p.links);
  w.at.screw = ledger.take<Twist>(p.columns);
  w.at.equation = ledger.take<Pack>(equations);
  w.at.jacobian = ledger.take<Pack>(equations * p.columns);
  w.at.curve = ledger.take<TermCurve>(p.functions.functions ? p.terms : 0);
  w.at.function = ledger.take<Pack>(p.functions.registers);
  w.at.course = ledger.take<Course>(p.functions.functions ? p.links : 0);
  w.reads = ledger.take<unsigned char>(p.blocks * p.blocks);
  w.hangs = ledger.take<unsigned char>(p.blocks * p.blocks);
  w.inverse = ledger.take<Pack>(inverse);
  w.middle = ledger.take<Pack>(p.states);
  w.line = ledger.take<Real>(inverse);
  w.other_line = ledger.take<Real>(ORDER ? inverse : 0);
  w.carried = ledger.take<Real>(largest * equations);
  w.square = ledger.take<Real>(largest * largest);
  w.size = ledger.take<Real>(equations);
  w.radius = ledger.take<Real>(p.columns);
  w.residual = ledger.take<Real>(p.columns);
  w.influence = ledger.take<Real>(largest * p.columns);
  w.scalar = ledger.take<double>(inverse_numbers(largest));
  return w;
}

// A block with its rows of C, of which an unknown's has `end` numbers.
struct BlockPart {
  const Block& b;
  int index, first, end;  // equations: its first, and one behind its last
  long inverse;           // where its rows begin
  const int* unknown;     // columns
};
inline BlockPart part_of_block(const Plan& p, int index) {
  int first = 0;
  for (int b = 0; b < index; ++b) first += p.block[b].rows;
  const Block& b = p.block[index];
  return {b, index, first, first + b.rows, inverse_begin(p, index), p.unknown + b.column_begin};
}

// Which blocks hang on which: `reads` and `hangs`.
inline void find_dependence(const Plan& p, Proof& w) {
  for (int k = 0; k < p.blocks * p.blocks; ++k) w.reads[k] = w.hangs[k] = false;
  for (int b = 0; b < p.blocks; ++b) {
    unsigned char *const reads = w.reads + b * p.blocks, *const hangs = w.hangs + b * p.blocks;
    for (int c = p.block[b].closing_begin; c < p.block[b].closing_end; ++c)
      for (int l = p.closing[c].loop_begin; l < p.closing[c].loop_end; ++l) {
        const TreeJoint& t = p.joints[p.loop[l].joint];
        for (int f = t.column; f < t.column + freedoms_of(t); ++f)
          if (p.column_block[f] >= 0) reads[p.column_block[f]] = true;
      }
    hangs[b] = true;
    for (int a = 0; a < b; ++a)
      for (int k = 0; reads[a] && k <= a; ++k) hangs[k] = hangs[k] || w.hangs[a * p.blocks + k];
  }
}

// Calls with the part of every block that a block hangs on, in order, itself last.
template <class Found>
inline void each_block_below(const Plan& p, const Proof& w, int block, Found&& found) {
  for (int first = 0, b = 0; b <= block; first += p.block[b].rows, ++b)
    if (w.hangs[block * p.blocks + b]) found(b, first, first + p.block[b].rows);
}

}  // namespace
