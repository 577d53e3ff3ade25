// The entry of a unit that gives the equations of motion of wide plans (equations_of_motion.hpp).
#pragma once

#include "plan/plan.hpp"

// What a stage of an integration is computed from, one lane a variant; arrays are packs, [k * lanes + lane], 64-byte
// aligned. The origin is the place that the chart is about.
struct StageGiven {
  const double* origin;           // states
  const double* origin_rate;      // columns
  const double* origin_second;    // columns: their derivatives
  const double* miss;             // columns: what the prediction missed at another stage since the origin, and
  const double* miss_elapsed;     // 1: its time since then, zero for none
  const double* direction;        // charts x columns, see chart.hpp
  const double* origin_jacobian;  // blocks' entries, the chart's rows included
  const double* elapsed;          // 1: time since the origin
  const double* time;             // 1
  const double* side;             // kinks of the plan's program: +1 or -1
  const double *sense, *quiet, *aim, *armed, *span, *way;  // how joints slip, see SlipsGiven
  const double* place;            // charts: u
  const double* rate;             // charts: its rate
  const double *inputs, *input_rates, *input_seconds;  // inputs: of what is driven
  const double* turned;           // turn slots, see Request::turned, of the origin
  const ClosingTurn* turns;       // turn_count: what StageFound::turned holds
  int turn_count;
  double tight, coarse, accept;   // of closing, as in a Request
  int iterations;
  double jump, radius;            // what a stage may differ from the origin, as in StepLimits
  // Places that are not predicted from the origin; null where there are none.
  const double* placed;           // lanes: StagePlace
  const double *placed_state, *placed_tangent, *placed_bend;  // states; as StageFound::tangent and bend
};

// Where a lane's place comes from.
constexpr double PREDICTED = 0.0;  // the origin's derivatives
constexpr double GUESSED = 1.0;    // placed_state is closed, whatever the Jacobian at the origin
constexpr double PLACED = 2.0;     // placed_state and its derivatives are the place: the equations are singular near it

enum StageFlag : unsigned char {
  STAGE_GOOD = 0,
  STAGE_NOT_CLOSED = 1,      // nor a side condition kept
  STAGE_OFF_BRANCH = 2,      // not told to lie on the origin's branch
  STAGE_SINGULAR_INERTIA = 4,
  STAGE_UNDEFINED_LOAD = 8,  // a law of a load has no value
  STAGE_FRICTION = 16,       // friction has no answer, or not one alone
  STAGE_UNDEFINED_STOP = 32  // what is watched beside the loads has no value
};

struct StageFound {
  double* state;      // states
  double* first;      // columns
  double* second;     // columns
  double* miss;       // columns: closed less predicted, of scalar coordinates
  double* jacobian;   // blocks' entries, not factored
  double* tangent;    // directions x columns: rates of the columns by those of u, then of the inputs
  double* chart_second;  // charts: u''
  double* bend;       // columns: their accelerations at u'' = 0; null where nothing asks
  double* inertia;    // charts x charts: reduced inertia
  double* watched;    // kinks of the plan's program, then its outputs beyond the loads' values
  double* power;      // 2: of efforts and loads without a potential; lost in dampers
  double* turned;        // turn slots: angles and quaternions of the closing joints as the kernel finds them
  double *slip_rate, *slip_second, *slip_force;  // slips: see SlipsFound
  double* slip_row;      // slips x charts
  double *slip_limit, *slip_loose, *slip_state, *slip_answer, *slip_span;  // frictions
  double* slip_way;      // 2 x slips
  double* level;         // 1
  double* told;          // frictions x TOLD_NUMBERS: see FrictionTold
  double* system;        // see SlipSystem; null where nothing asks
  unsigned char* flags;  // lanes: StageFlag
};

struct MotionUnit {
  int lanes;
  // Bytes of the wide plan of some plans (lanes) of one structure; writes it, where there is memory.
  long (*widen)(const PlanOf<double>* const* plans, char* memory);
  long (*workspace_size)(const char* wide);
  // Before the first stage in a workspace.
  void (*prepare)(const char* wide, char* workspace);
  void (*evaluate)(const char* wide, const StageGiven&, const StageFound&, char* workspace);
};

extern "C" {
const MotionUnit* mechkin_motion_sse2();
const MotionUnit* mechkin_motion_avx2();
const MotionUnit* mechkin_motion_avx512();
}
