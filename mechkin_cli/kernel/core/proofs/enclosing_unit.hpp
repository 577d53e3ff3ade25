// Enclosures of what rows write, over boxes that hold their positions.
#pragma once

template <class Number>
struct PlanOf;
struct OutputsView;

// What boxes hold, and which blocks are so drawn together: none; a zero of as many equations as there are unknowns, the
// blocks that have no more; a position at which every equation holds, all of them.
enum class EnclosedBox { GIVEN, SOLVED, CLOSED };

// Numbers are high and low part of a midpoint and a radius, [(3 * k + part) * rows + row]; a part that is not finite says that
// nothing is known.
struct EnclosingRequest {
  long rows;
  const double* states;         // states x rows: the box's middle; an orientation needs no unit length
  const double* inputs;         // inputs x 3 x rows, instead of their states
  const double* radius;         // columns x rows, may be null: of the box about it (ProvingRequest::radius)
  EnclosedBox box;              // what the box is known to hold
  const double* rates;          // inputs x 3 x rows, may be null: no velocities
  const double* accelerations;  // inputs x 3 x rows, may be null: no accelerations
  const double* jerks;          // inputs x 3 x rows, may be null: no third derivatives
  const double* constraint_rates;           // constraints x 3 x rows, may be null
  const double* turned;         // as in Request: turn slots x rows, inputs x rows
  const double* whole;
  const double* time;           // 3 x rows, may be null: what laws of loads read as time (s)
  bool forces;
  const OutputsView* wanted;        // may be null
  const OutputsView *wanted_low, *wanted_radii;  // those parts of its constants in the same places; null: zero
  double* outputs;              // slots x 3 x rows
  double* position;             // columns x 3 x rows, may be null: unknowns drawn together; an orientation's increments
  double* velocities;           // columns x 3 x rows, may be null
  double* second;               // columns x 3 x rows, may be null
  double* equations;            // equations of all blocks x 3 x rows, may be null
  double* derivatives;          // equations x columns x 3 x rows, may be null: by increments of the columns, anywhere in the box
  double* sides;                // closing joints x 3 x rows, may be null: positive in an assembly
};

struct EnclosingUnit {
  long (*workspace_size)(const PlanOf<double>&);
  // `low`, `radii`: these parts of the plan's constants, as plans with them in their place; null: zero.
  void (*enclose)(const PlanOf<double>&, const PlanOf<double>* low, const PlanOf<double>* radii, const EnclosingRequest&,
                  char* workspace);
};

extern "C" {
const EnclosingUnit* mechkin_enclosing_sse2();
const EnclosingUnit* mechkin_enclosing_avx512();
}

// The widest that the machine has, or the widest of at most `lanes`; nothing that it computes depends on it.
const EnclosingUnit& enclosing_unit(int lanes = 0);
