// The size of a mechanism as it is assembled: what residual and condition are measured by.
#pragma once

#include <vector>

#include "rows/unit.hpp"

// Memory of `assembly_size`, kept by a caller that measures many variants of one plan, whose workspace points
// into itself.
struct SizeMemory {
  SizeMemory(const Plan& plan, const KernelUnit& unit);
  SizeMemory(const SizeMemory&) = delete;
  std::vector<char> workspace;
  std::vector<double> states, points;
};

// Limits of Newton's method, see Request.
struct NewtonLimits {
  double tight, coarse, accept;
  int iterations;
};

// Diagonal (m) of the box of the plan's size points in the assembly at some inputs (inputs) near a state (states); 1
// where they coincide, as for a plan without size points. No allocation.
double assembly_size(const Plan& plan, const KernelUnit& unit, const double* inputs, const double* state,
                     const NewtonLimits& limits, SizeMemory& memory);
