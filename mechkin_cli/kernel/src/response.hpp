// Responses of many variants: packs of lanes, shared out to threads.
#pragma once

#include "charted_motion.hpp"

struct ResponseTask {
  std::vector<MotionStart> starts;  // one a variant, plans of one structure
  std::vector<MotionRows> rows;     // likewise
  const double* times;              // rows: all variants have the same
  double begin;                     // time of the starts
  MotionLimits limits;
  IntegratorSettings settings;
};

// How each variant ended; they do not depend on `lanes` and `threads`.
std::vector<LaneReport> respond(const ResponseTask& task, int lanes, int threads);
