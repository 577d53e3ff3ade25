// Whether two plans have the same layout, wherever they come from.
#pragma once

#include "plan/plan.hpp"

// The same joints in the same order, the same blocks with the same unknowns, the same inputs: what a stepper that
// began on one of them keeps sizes and offsets of. Constants, loads and places may differ.
bool same_layout(const Plan& a, const Plan& b);
