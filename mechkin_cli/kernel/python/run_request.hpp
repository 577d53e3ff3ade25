// A run as Python asks for it: the arguments that runs in every arithmetic have.
#pragma once

#include "arguments.hpp"
#include "plan/frozen_plan.hpp"
#include "plan/output_list.hpp"

constexpr long MOST_ITERATIONS = 10000;
constexpr long MOST_THREADS = 1024;

// Fills a request from the arguments, all but those that one arithmetic alone has; the outputs, null without any. TypeError,
// ValueError.
const OutputList* read_request(Arguments& given, const FrozenPlan& plan, Request& r);
// What is demanded goes with what is given. ValueError.
void check_demand(const Request& r, const OutputList* outputs, const Plan& p);

// Rows that a thread takes at a time, and how many threads there is work for.
long chunk_of(long rows, int threads);
int threads_for(long rows, long threads);
