// Enclosures of what rows write, over boxes that hold their positions.
#pragma once

template <class Number>
struct PlanOf;
struct OutputsView;

// Numbers are midpoint and radius, [(2 * k + part) * rows + row]; a radius that is not finite says that nothing is known.
struct EnclosingRequest {
  long rows;
  const double* states;         // states x rows: the box's middle; an orientation needs no unit length
  const double* inputs;         // inputs x 2 x rows, instead of their states
  const double* radius;         // columns x rows, may be null: of the box about it (ProvingRequest::radius)
  const double* rates;          // inputs x 2 x rows, may be null: no velocities
  const double* accelerations;  // inputs x 2 x rows, may be null: no accelerations
  const double* ties;           // ties x 2 x rows, may be null
  const double* turned;         // as in Request: turn slots x rows, inputs x rows
  const double* whole;
  const double* time;           // 2 x rows, may be null: what laws of loads read as time (s)
  bool forces;
  const OutputsView* wanted;        // may be null
  const OutputsView* wanted_radii;  // the radii of its constants in the same places; null: zero
  double* outputs;              // slots x 2 x rows
  double* velocities;           // columns x 2 x rows, may be null
  double* second;               // columns x 2 x rows, may be null
  double* equations;            // equations of all blocks x 2 x rows, may be null
  double* derivatives;          // equations x columns x 2 x rows, may be null: by increments of the columns, anywhere in the box
  double* sides;                // closing joints x 2 x rows, may be null: positive in an assembly
};

struct EnclosingUnit {
  long (*workspace_size)(const PlanOf<double>&);
  // `radii`: of the plan's constants, as a plan with these instead of them; null where they are exact.
  void (*enclose)(const PlanOf<double>&, const PlanOf<double>* radii, const EnclosingRequest&, char* workspace);
};

extern "C" const EnclosingUnit* mechkin_enclosing();
