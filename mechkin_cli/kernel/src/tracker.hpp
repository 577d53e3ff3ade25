// Following a branch along a straight path of the inputs: skeleton and infill.
//
// x(sigma) = x0 + sigma u. Few careful steps (second-order predictor, Newton, jump and turning tests)
// give nodes with first and second derivatives; the guesses for all rows come from quintic Hermite
// interpolation between them and are left for one batched run to finish.
#pragma once

#include <vector>

#include "unit.hpp"

struct TrackLimits {
  double turn_cosine;   // least cosine of the tangent's turn in a step
  double turn;          // wanted turn of the tangent in a step, rad
  double bend;          // wanted ratio of the quadratic to twice the linear part of a step
  double jump;          // largest Newton correction in parts of the step's length
  double infill;        // largest correction of an infilled row in parts of the nodes' distance
  double longest_step;  // largest step, rad or length units of the path
  double least_step;    // smallest step in parts of max(1, |sigma|)
  int most_steps;
  double tight, coarse, accept;
  double pivot;         // least pivot of a node: the tangent next to a singular place is rounding
  int iterations;
};

enum class TrackEnd : int { finished = 0, stalled = 1, exhausted = 2, start_not_closed = 3 };

struct Node {
  double sigma, orientation, pivot;
  std::vector<double> state, first, second;              // states, columns, columns
  std::vector<double> jacobian;                          // blocks, one after the other
  std::vector<double> state_first, state_second;         // derivatives of the raw states
};

struct Track {
  TrackEnd end;
  long reached;     // rows that have a guess
  long steps, rejected;
  Node last;
  double refused_step;  // the step that could not be taken, if stalled
};

// sigma must increase; guess: states x rows, limit: rows (largest correction that infill may make).
Track follow(const Plan& plan, const KernelUnit& unit, const double* x0, const double* u, long rows,
             const double* sigma, const double* start, const TrackLimits& limits, double* guess,
             double* limit);
