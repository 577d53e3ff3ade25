#include "run_request.hpp"

#include "plan/program_store.hpp"
#include "stepping/stepper.hpp"
#include "rows/units.hpp"

namespace nb = nanobind;

const OutputList* read_request(Arguments& given, const FrozenPlan& plan, Request& r) {
  const Plan& p = plan.view();
  r.inputs = given.read_required("inputs", p.inputs);
  r.guess = given.read_required("guess", p.states);
  r.rates = given.read("rates", p.inputs);
  r.accelerations = given.read("accelerations", p.inputs);
  r.jerks = given.read("jerks", p.inputs);
  r.ties = given.read("ties", p.ties);
  const KernelUnit& narrow = *kernel_unit(2);
  r.turned = given.read("turned", turn_slots(p, narrow));
  r.whole = given.read("whole", p.inputs);
  r.chart = given.read("chart", p.charts * p.columns);
  r.chart_rates = given.read("chart_rates", p.charts);
  r.chart_accelerations = given.read("chart_accelerations", p.charts);
  r.friction_told = given.read("friction_told", p.charts ? p.frictions * TOLD_NUMBERS : 0);
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
  r.undefined = given.write_flags("undefined");
  r.rows = given.rows();
  r.demand = (unsigned)given.integer("demand", 0, DEMAND_EVERYTHING, 0);
  r.shift = (int)given.integer("shift", 0, 2, 0);
  r.iterations = (int)given.integer("iterations", 0, MOST_ITERATIONS, 0);
  const std::vector<double> tests = given.limits("tests", 3);
  r.tight = tests[0], r.coarse = tests[1], r.accept = tests[2];
  return outputs;
}

// What is demanded goes with what is given.
void check_demand(const Request& r, const OutputList* outputs, const Plan& p) {
  const auto refuse = [](bool condition, const char* message) {
    if (condition) throw nb::value_error(message);
  };
  const bool velocity = r.demand & DEMAND_VELOCITY, acceleration = r.demand & DEMAND_ACCELERATION;
  refuse(r.demand && p.columns && !p.blocks && !p.inputs, "a tree without inputs and blocks has poses only");
  refuse(!outputs != !r.outputs, "outputs and values are given together");
  refuse(outputs && (outputs->demand() & ~r.demand), "the outputs need more than is demanded");
  refuse(p.charts && !r.chart, "a plan with a chart needs its directions");
  refuse(p.charts && velocity && !r.chart_rates, "velocities need rates of the chart");
  refuse(p.charts && acceleration && !r.chart_accelerations, "accelerations need accelerations of the chart");
  refuse(p.charts && r.demand & DEMAND_JERK, "a chart has no jerks");
  refuse(velocity && !r.rates, "velocities need rates of the inputs");
  refuse(acceleration && (!velocity || !r.accelerations),
         "accelerations need rates and accelerations of the inputs");
  refuse(r.demand & DEMAND_JERK && (!acceleration || !r.jerks), "jerks need accelerations, and jerks of the inputs");
  refuse((r.loads || r.undefined) && !(r.demand & DEMAND_FORCES), "the values of loads go with forces");
  refuse(r.demand & DEMAND_FORCES && program_demand(p.law) & ~r.demand, "loads that vary need more than is demanded");
  refuse(r.demand & DEMAND_FORCES && p.ties && !r.ties, "forces need the rates of tied inputs");
  refuse(r.demand & DEMAND_FORCES && p.frictions && !acceleration, "forces with friction need accelerations");
  refuse(r.demand & DEMAND_POWER && !(r.demand & DEMAND_FORCES), "the power error needs forces");
  refuse(!(r.demand & DEMAND_CONDITION) != !r.condition, "an array for the condition goes with its demand");
  refuse(!(r.demand & DEMAND_POWER) != !r.power_error, "an array for the power error goes with its demand");
  refuse(r.velocities && !velocity, "first derivatives are not demanded");
  refuse(r.second && !acceleration, "second derivatives are not demanded");
}

// Rows that a thread takes at a time: several chunks a thread, since threads are not equally fast; whole packs of
// every width.
long chunk_of(long rows, int threads) {
  const long share = rows / (8L * threads);
  const long chunk = share < 64 ? 64 : share > 4096 ? 4096 : share;
  return (chunk + 63) / 64 * 64;
}

int threads_for(long rows, long threads) {
  const long chunks = (rows + 63) / 64;
  return (int)(chunks < 1 ? 1 : threads < chunks ? threads : chunks);
}
