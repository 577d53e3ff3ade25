#include "rows/assembly_size.hpp"

#include <cmath>

namespace {

// In parts of the length unit: far below any length of a mechanism and far above the rounding that slides at zero leave
// between points that coincide.
constexpr double COINCIDENT = 1e-12;

}  // namespace

SizeMemory::SizeMemory(const Plan& plan, const KernelUnit& unit)
    : workspace(unit.workspace_size(plan)), states(plan.states), points(3 * plan.size_points) {
  unit.prepare(plan, workspace.data());
}

double assembly_size(const Plan& plan, const KernelUnit& unit, const double* inputs, const double* state,
                     const NewtonLimits& limits, SizeMemory& memory) {
  if (plan.size_points == 0) return 1.0;
  // differences alone count: places about the kernel's own origin, wherever that lies
  Plan about = plan;
  for (double& x : about.origin) x = 0.0;
  double residual = 0.0, correction = 0.0;
  unsigned char flags = 0;
  Request r = {};
  r.rows = 1;
  r.inputs = inputs, r.guess = state;
  r.wanted = {plan.size_points, 3 * plan.size_points, plan.size_point};
  r.states = memory.states.data(), r.outputs = memory.points.data();
  r.residual = &residual, r.correction = &correction, r.flags = &flags;
  r.iterations = limits.iterations;
  r.tight = limits.tight, r.coarse = limits.coarse, r.accept = limits.accept;
  unit.run_row(about, r, memory.workspace.data());

  double extent[3];
  for (int i = 0; i < 3; ++i) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < plan.size_points; ++k) {
      const Output& o = plan.size_point[k];
      // points of ground stand in m
      const double x = o.index < 0 ? o.data[i] : memory.points[o.slot + i];
      least = x < least ? x : least;
      most = x > most ? x : most;
    }
    extent[i] = most - least;
  }
  const double size = std::sqrt(extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2]);
  return size > COINCIDENT * plan.length ? size : 1.0;
}
