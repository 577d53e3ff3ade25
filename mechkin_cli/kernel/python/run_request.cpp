#include "run_request.hpp"

#include "rows/units.hpp"
#include "stepping/stepper.hpp"

namespace nb = nanobind;

const OutputList* read_request(Arguments& given, const FrozenPlan& plan, Request& r) {
  const Plan& p = plan.view();
  r.inputs = given.read_required("inputs", p.inputs);
  r.guess = given.read_required("guess", p.states);
  r.rates = given.read("rates", p.inputs);
  r.accelerations = given.read("accelerations", p.inputs);
  r.jerks = given.read("jerks", p.inputs);
  r.constraint_rates = given.read("constraint_rates", p.input_constraints);
  const KernelUnit& narrow = *kernel_unit(2);
  r.turned = given.read("turned", turn_slots(p, narrow));
  r.whole = given.read("whole", p.inputs);
  r.chart = given.read("chart", p.charts * p.columns);
  r.chart_rates = given.read("chart_rates", p.charts);
  r.chart_accelerations = given.read("chart_accelerations", p.charts);
  r.friction_told = given.read("friction_told", p.frictions * TOLD_NUMBERS);
  r.full = given.read("full", p.inputs);
  r.time = given.read("time", Arguments::ONE_PER_ROW);
  const OutputList* outputs = nullptr;
  nb::object list = given.other("outputs");
  if (!list.is_none()) {
    if (!nb::try_cast(list, outputs, false)) throw nb::type_error("outputs: not Outputs of a plan");
    if (!outputs->fits(plan)) throw nb::value_error("outputs: of a plan with another structure");
    r.wanted = outputs->view();
  }
  r.states = given.write_required("states", p.states);
  r.outputs = given.write("values", r.wanted.slots);
  r.velocities = given.write("first", p.columns);
  r.second = given.write("second", p.columns);
  r.residual = given.write_required("residual", Arguments::ONE_PER_ROW);
  r.correction = given.write_required("correction", Arguments::ONE_PER_ROW);
  r.side = given.write("side", p.blocks);
  r.condition = given.write("condition", Arguments::ONE_PER_ROW);
  r.power_error = given.write("power_error", Arguments::ONE_PER_ROW);
  r.flags = given.write_flags_required("flags");
  r.loads = given.write("loads", p.load_values);
  r.chart_forces = given.write("chart_forces", p.charts);
  r.undefined = given.write_flags("undefined");
  r.rows = given.rows();
  r.demand = (unsigned)given.integer("demand", 0, DEMAND_EVERYTHING, 0);
  r.shift = (int)given.integer("shift", 0, 2, 0);
  r.iterations = (int)given.integer("iterations", 0, MOST_ITERATIONS, 0);
  const std::vector<double> tests = given.limits("tests", 3);
  r.tight = tests[0], r.coarse = tests[1], r.accept = tests[2];
  return outputs;
}
