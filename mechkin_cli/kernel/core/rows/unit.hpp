// The one entry that each compiled unit of the kernel exports.
#pragma once

#include "plan/plan.hpp"
#include "tape/tape.hpp"

// The constants of a tree displacement and of a pair, read off their entries.
struct TreeType {
  int freedoms, states;
  int slides;  // bit f: freedom f is a length
};
struct PairType {
  const char* letter;
  int equations, lengths;  // how many close it, and how many of them, the first ones, are lengths
  int coordinates, turns;  // bit f: freedom f is a coordinate; is one and an angle
};

// Rows between two places of a curve, a step apart: of each column a polynomial of degree five, by its value and its first
// and second derivative at both places.
struct Hermite {
  double begin, step;
  long rows;
  const double* place;  // rows
  int columns;
  const double* ends;   // columns x 6: value, first and second derivative where the step begins, the same where it ends
  double* const* out;   // columns: rows each
  double* const* whole;  // columns: null, or rows of whole turns, in whose rows `out` is within half a turn
  const double* counted;  // columns: turns that all of these have besides
  const double* rest;   // null, or columns x 3: numbers of t^3 (1 - t)^3 (r0 + u r1 + u^2 r2), t the part of the step and
                        // u = t - third, by which a third place is met as well
  double third;
};

// A step of a block with a band from one place to another by way of a third half way, their Jacobians full and row by row.
struct BandStep {
  const double *from, *middle, *to;
  double limit;
  bool is_regular;  // whether no matrix of the segments between them is singular
  double danger;    // about the spectral radius of J_to^-1 J_from - I
  double least;     // at most the least singular value of J_to
};

struct KernelUnit {
  int lanes;
  const TreeType* tree_types;  // TREE_CODES
  const PairType* pair_types;
  int pair_codes;
  long (*workspace_size)(const Plan&);
  // One row after another, of plans of one structure: `prepare` lays the workspace out once for all calls of `run_row`.
  void (*prepare)(const Plan&, char* workspace);
  void (*run_row)(const Plan&, const Request&, char* workspace);
  // Rows [begin, end) alone; what a row gets does not depend on the cut.
  void (*run_rows)(const Plan&, const Request&, long begin, long end, char* workspace);
  void (*search_rows)(const Plan&, const SearchRequest&, long begin, long end, char* workspace);
  // Of a block with a band; the room is for any of them, none where there are none.
  long (*band_room)(const Plan&);
  void (*judge_band_step)(const Plan&, int block, BandStep*, char* room);
  void (*elementwise)(int operation, const double* x, const double* y, double* out, long n);
  void (*interpolate)(const Hermite&);
  long (*replay_size)(const Tape&);
  void (*replay)(const Tape&, const TapeRequest&, char* workspace);
  // Of one set of inputs, with first and second derivatives by the first of them (tape_jets.hpp): of the narrowest unit,
  // null in the others.
  long (*jets_size)(const Tape&);
  void (*replay_jets)(const Tape&, const double* given, const double* way, double* out, char* workspace);
};

extern "C" {
const KernelUnit* mechkin_unit_sse2();
const KernelUnit* mechkin_unit_avx2();
const KernelUnit* mechkin_unit_avx512();
}
