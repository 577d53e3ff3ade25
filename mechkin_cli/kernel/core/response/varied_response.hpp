// A response with other parameters: its first assembly is continued from that of the base, as variants of a sweep are, the
// motion goes on from there, and its rows are read off.
#pragma once

#include "response/response.hpp"
#include "stepping/variants.hpp"

// What does not change from variant to variant. The inputs of the start's plan are the coordinates that the response names
// at its first moment; all of them are left to move, so that the plan of the motion has a chart and no inputs.
struct ResponseBase {
  std::vector<double> times;  // rows (s), rising; the motion begins at the first
  std::vector<MotionStop> stops;
  IntegratorSettings settings;
  MotionLimits limits;
  std::vector<int> start_states;  // of the start's inputs, in the plan of the motion
  unsigned demand;                // of the run that reads the rows
  std::vector<ClosingAngle> angles;
  double same_moment;  // a stop so near to a row, in parts of its time, is at that row
  double clear;        // up to this condition of the start, rates that are given there are those of the mechanism
};

struct VariedResponse {
  const Variants& start;
  const TapeStore& tape;
  const FrozenPlan& plan;
  const OutputList& outputs;
  const ResponseBase& base;
};

// Refuses what does not fit the plan.
Refusal check_response(const ResponseBase& base, const TapeStore* tape, const FrozenPlan& plan, const OutputList& outputs);
// Refuses a start with other states, columns or freedoms.
Refusal check_start(const VariedResponse& response);

// Arrays of a variant's rows; those that are not reached get nan.
struct ResponseArrays {
  double* outputs;      // slots x rows
  double* residual;     // rows
  double* condition;    // rows
  double* power_error;  // rows, or null
  double* work;         // 2 x rows: put in, lost; J
};

struct PlayedResponse {
  VariantEnd end = VariantEnd::incomplete;
  LaneEnd why = LaneEnd::STUCK;  // how the motion ended; a response is complete at its last row or at a stop
  long rows = 0;       // of its table: all, or up to a stop
  long reached = 0;    // of these
  long moments = 0;    // of the base's that were reached: a stop's own row may be one more
  int stop = -1;       // that ended it, -1: none
  double time = 0.0;   // s: how far it came
  double energy = 0.0; // J: the largest kinetic energy at the ends of its steps
};

// The variant with some parameters (inputs of the tape).
Result<PlayedResponse> play_response(const VariedResponse& response, const double* parameters, const ResponseArrays& out);
