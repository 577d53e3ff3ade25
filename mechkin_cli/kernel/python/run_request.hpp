// A run as Python asks for it: the arguments that runs in every arithmetic have.
#pragma once

#include "arguments.hpp"
#include "plan/frozen_plan.hpp"
#include "rows/run.hpp"

// Fills a request from the arguments, all but those that one arithmetic alone has; the outputs, null without any. TypeError,
// ValueError.
const OutputList* read_request(Arguments& given, const FrozenPlan& plan, Request& r);
