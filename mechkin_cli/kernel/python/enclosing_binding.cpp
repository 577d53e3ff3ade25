// Python's view of enclosures: what rows write, over boxes that hold their positions.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "bindings.hpp"
#include "plan/frozen_plan.hpp"
#include "plan/output_list.hpp"
#include "plan/program_store.hpp"
#include "proofs/enclosing_unit.hpp"
#include "rows/units.hpp"
#include "stepping/stepper.hpp"

namespace nb = nanobind;

namespace {

// A plan with other parts of its constants in their place; nothing where these are zero.
std::optional<FrozenPlan> part_of(Arguments& given, const char* name, const FrozenPlan& plan) {
  const double* const numbers = given.numbers(name, plan.constants());
  if (!numbers) return {};
  if (!all_finite(numbers, plan.constants())) throw nb::value_error((std::string(name) + ": not finite").c_str());
  return plan.with_numbers(numbers);
}

std::optional<OutputList> part_of(Arguments& given, const char* name, const OutputList* outputs) {
  const double* const numbers = given.numbers(name, outputs ? outputs->constants() : 0);
  if (!numbers || !outputs) return {};
  std::optional<OutputList> part(*outputs);
  if (!part->assign(numbers)) throw nb::value_error((std::string(name) + ": not finite").c_str());
  return part;
}

const OutputList* outputs_of(Arguments& given, const FrozenPlan& plan) {
  const nb::object object = given.other("outputs");
  if (object.is_none()) return nullptr;
  const OutputList* const outputs = nb::cast<const OutputList*>(object);
  if (!outputs->fits(plan)) throw nb::value_error("outputs: of a plan with another structure");
  return outputs;
}

void check(const EnclosingRequest& r, const OutputList* outputs, const Plan& p) {
  const auto refuse = [](bool condition, const char* message) {
    if (condition) throw nb::value_error(message);
  };
  unsigned demand = 0;
  if (r.rates) demand |= DEMAND_VELOCITY;
  if (r.accelerations) demand |= DEMAND_ACCELERATION;
  if (r.jerks) demand |= DEMAND_JERK;
  if (r.forces) demand |= DEMAND_FORCES;
  refuse(p.charts > 0, "plans with a chart are not enclosed");
  refuse(!outputs != !r.outputs, "outputs and values are given together");
  refuse(outputs && (outputs->demand() & (DEMAND_VELOCITY | DEMAND_ACCELERATION | DEMAND_JERK | DEMAND_FORCES) & ~demand),
         "the outputs need more than is given");
  refuse(r.forces && program_demand(p.law) & ~demand, "loads that vary need more than is given");
  refuse(r.accelerations && !r.rates, "accelerations need rates of the inputs");
  refuse(r.jerks && !r.accelerations, "jerks need accelerations of the inputs");
  refuse(r.velocities && !r.rates, "first derivatives need rates of the inputs");
  refuse(r.second && !r.accelerations, "second derivatives need accelerations of the inputs");
}

void enclose(const FrozenPlan& plan, const nb::kwargs& keywords) {
  const Plan& p = plan.view();
  long equations = 0;
  for (int b = 0; b < p.blocks; ++b) equations += p.block[b].rows;
  Arguments given(keywords);
  EnclosingRequest r = {};
  r.states = given.read_required("states", p.states);
  r.inputs = given.read_required("inputs", 3L * p.inputs);
  r.radius = given.read("radius", p.columns);
  r.rates = given.read("rates", 3L * p.inputs);
  r.accelerations = given.read("accelerations", 3L * p.inputs);
  r.jerks = given.read("jerks", 3L * p.inputs);
  r.constraint_rates = given.read("constraint_rates", 3L * p.input_constraints);
  r.turned = given.read("turned", turn_slots(p, *kernel_unit(2)));
  r.whole = given.read("whole", p.inputs);
  r.time = given.read("time", 3);
  r.position = given.write("position", 3L * p.columns);
  r.velocities = given.write("first", 3L * p.columns);
  r.second = given.write("second", 3L * p.columns);
  r.equations = given.write("equations", 3 * equations);
  r.derivatives = given.write("derivatives", 3 * equations * p.columns);
  r.sides = given.write("sides", 3L * p.closings);
  r.forces = given.integer("forces", 0, 1, 0);
  r.box = (EnclosedBox)given.integer("contract", 0, 2, 0);
  const EnclosingUnit& unit = enclosing_unit((int)given.integer("lanes", 0, 8, 0));
  const OutputList* const outputs = outputs_of(given, plan);
  const std::optional<OutputList> output_low = part_of(given, "output_low", outputs);
  const std::optional<OutputList> output_radii = part_of(given, "output_radii", outputs);
  const OutputsView wanted = outputs ? outputs->view() : OutputsView{};
  const OutputsView wanted_low = output_low ? output_low->view() : OutputsView{};
  const OutputsView wanted_radii = output_radii ? output_radii->view() : OutputsView{};
  r.outputs = given.write("values", 3L * wanted.slots);
  const std::optional<FrozenPlan> low = part_of(given, "low", plan), radii = part_of(given, "radii", plan);
  given.finish();
  r.wanted = outputs ? &wanted : nullptr;
  r.wanted_low = output_low ? &wanted_low : nullptr;
  r.wanted_radii = output_radii ? &wanted_radii : nullptr;
  r.rows = given.rows();
  check(r, outputs, p);
  std::vector<char> memory((std::size_t)unit.workspace_size(p));
  nb::gil_scoped_release released;
  FloatingPointState state;
  unit.enclose(p, low ? &low->view() : nullptr, radii ? &radii->view() : nullptr, r, memory.data());
}

}  // namespace

void bind_enclosing(nb::module_& m) { m.def("enclose", &enclose, nb::arg("plan"), nb::arg("arguments")); }
