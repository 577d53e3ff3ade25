// The rows of a request, checked and shared out to threads.
#pragma once

#include "plan/output_list.hpp"
#include "result.hpp"
#include "rows/closed.hpp"
#include "rows/units.hpp"

// Bounds of what one call may ask for. Rows of a table that has no columns may be any number, and take no memory where
// they come from.
constexpr long MOST_ROWS = 100000000;
constexpr long MOST_ITERATIONS = 10000;
constexpr long MOST_THREADS = 1024;

// Refuses a demand that does not go with what is given; `outputs` may be null.
Refusal check_demand(const Request& r, const OutputList* outputs, const Plan& p);

// All rows of a request that is checked, by at most so many threads. What a row gets does not depend on them.
void run_rows(const Plan& p, const Request& r, const KernelUnit& unit, int threads);
// Likewise, and whether all of them closed within limits, on one side (closed.hpp): each thread looks at its own rows
// while it has them.
bool run_rows(const Plan& p, const Request& r, const KernelUnit& unit, int threads, const RowLimits& limits);
void search_rows(const Plan& p, const SearchRequest& r, const KernelUnit& unit, int threads);
// In double-double, with the high and, unless they are zero, the low parts of the plan's constants.
void run_rows(const Plan& high, const Plan* low, const Request& r, const DoubleDoubleUnit& unit, int threads);
