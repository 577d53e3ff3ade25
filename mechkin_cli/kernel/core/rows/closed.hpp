// Whether rows that were closed have something to be judged one by one: in long runs next to none has.
#pragma once

#include "plan/plan.hpp"

// What a row may have: the largest correction of its guess (rows), and the largest condition.
struct RowLimits {
  const double* correction;
  double condition;
};

// Whether rows [begin, end) of a request are good, were corrected by no more than their limits, lie on the side of row
// `begin` in every block, and have no larger condition, if it was asked for. The request has sides.
bool all_closed(const Request& r, int blocks, const RowLimits& limits, long begin, long end);

// Whether two rows lie on one side of every block.
bool on_one_side(const Request& r, int blocks, long row, long other);
