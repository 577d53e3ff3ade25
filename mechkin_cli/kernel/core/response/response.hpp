// Responses of many variants: packs of lanes, shared out to threads.
#pragma once

#include "response/charted_motion.hpp"

struct ResponseTask {
  std::vector<MotionStart> starts;  // one a variant, plans of one structure
  std::vector<MotionRows> rows;     // likewise
  const double* times;              // rows: all variants have the same
  const SpacedTimes* spaced = nullptr;  // these instead, where there is one
  PartOfTimes part = {};            // which of them
  long moments = -1;                // how many; -1: as many as the first variant's rows
  std::vector<MotionStop> stops;
  const DrivenLaws* driven;         // null: nothing is driven
  MotionLimits limits;
  IntegratorSettings settings;
};

struct ResponseReport {
  LaneReport lane;
  long first;  // the number of the first row in its arrays
  int stop;  // that ended it, -1: none
  std::vector<int> joints;  // frictions that it ended by
  double lightest;  // see ChartedMotion::lightest
  double growth;    // see ChartedMotion::growth
  double energy;  // the largest kinetic energy at the ends of steps; kg, length units, s
  std::vector<double> last;  // states at the end
  std::vector<PassedBranchPoint> crossings;
  std::vector<TouchedStop> touches;
  std::vector<double> branch_point;  // states at the one that it has ended next to, empty without one
  bool singular;                     // steps were refused there, however short
};

// How each variant ended; they do not depend on `lanes` and `threads`. Refuses what `integrate` does.
Result<std::vector<ResponseReport>> respond(const ResponseTask& task, int lanes, int threads);
