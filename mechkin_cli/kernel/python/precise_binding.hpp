// Runs in double-double.
#pragma once

#include <nanobind/nanobind.h>

#include "plan/frozen_plan.hpp"

// As Plan.run, every number with a high and a low part: arrays (numbers, 2, rows), of one number a row (2, rows). `low` are
// those of the plan's constants, `low_outputs` of the outputs'; left out they are zero. No condition is told.
void run_precise(const FrozenPlan& plan, const nanobind::kwargs& keywords);
