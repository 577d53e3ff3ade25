// Python's view of enclosures: what rows write, over boxes that hold their positions.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <vector>

#include "arguments.hpp"
#include "bindings.hpp"
#include "enclosing_unit.hpp"
#include "frozen_plan.hpp"
#include "output_list.hpp"
#include "program_store.hpp"
#include "stepper.hpp"
#include "units.hpp"

namespace nb = nanobind;

namespace {

// A plan of the same structure with radii instead of constants, or null.
const FrozenPlan* radii_of(Arguments& given, const FrozenPlan& plan) {
  const nb::object object = given.other("radii");
  if (object.is_none()) return nullptr;
  const FrozenPlan* const radii = nb::cast<const FrozenPlan*>(object);
  if (radii->structure() != plan.structure()) throw nb::value_error("radii: of a plan with another structure");
  return radii;
}

const OutputList* outputs_of(Arguments& given, const char* name, const FrozenPlan& plan) {
  const nb::object object = given.other(name);
  if (object.is_none()) return nullptr;
  const OutputList* const outputs = nb::cast<const OutputList*>(object);
  if (!outputs->fits(plan)) throw nb::value_error((std::string(name) + ": of a plan with another structure").c_str());
  return outputs;
}

void check(const EnclosingRequest& r, const OutputList* outputs, const Plan& p) {
  const auto refuse = [](bool condition, const char* message) {
    if (condition) throw nb::value_error(message);
  };
  unsigned demand = 0;
  if (r.rates) demand |= DEMAND_VELOCITY;
  if (r.accelerations) demand |= DEMAND_ACCELERATION;
  if (r.forces) demand |= DEMAND_FORCES;
  refuse(p.charts > 0, "plans with a chart are not enclosed");
  refuse(!outputs != !r.outputs, "outputs and values are given together");
  refuse(outputs && (outputs->demand() & (DEMAND_VELOCITY | DEMAND_ACCELERATION | DEMAND_FORCES) & ~demand),
         "the outputs need more than is given");
  refuse(outputs && outputs->demand() & DEMAND_JERK, "third derivatives are not enclosed");
  refuse(r.forces && program_demand(p.law) & ~demand, "loads that vary need more than is given");
  refuse(r.accelerations && !r.rates, "accelerations need rates of the inputs");
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
  r.inputs = given.read_required("inputs", 2L * p.inputs);
  r.radius = given.read("radius", p.columns);
  r.rates = given.read("rates", 2L * p.inputs);
  r.accelerations = given.read("accelerations", 2L * p.inputs);
  r.ties = given.read("ties", 2L * p.ties);
  r.turned = given.read("turned", turn_slots(p, *kernel_unit(2)));
  r.whole = given.read("whole", p.inputs);
  r.time = given.read("time", 2);
  r.velocities = given.write("first", 2L * p.columns);
  r.second = given.write("second", 2L * p.columns);
  r.equations = given.write("equations", 2 * equations);
  r.derivatives = given.write("derivatives", 2 * equations * p.columns);
  r.sides = given.write("sides", 2L * p.closings);
  r.forces = given.integer("forces", 0, 1, 0);
  const OutputList* const outputs = outputs_of(given, "outputs", plan);
  const OutputList* const output_radii = outputs_of(given, "output_radii", plan);
  if (output_radii && (!outputs || outputs->constants() != output_radii->constants()))
    throw nb::value_error("output_radii: of other outputs");
  const OutputsView wanted = outputs ? outputs->view() : OutputsView{};
  const OutputsView wanted_radii = output_radii ? output_radii->view() : OutputsView{};
  r.outputs = given.write("values", 2L * wanted.slots);
  const FrozenPlan* const radii = radii_of(given, plan);
  given.finish();
  r.wanted = outputs ? &wanted : nullptr;
  r.wanted_radii = output_radii ? &wanted_radii : nullptr;
  r.rows = given.rows();
  check(r, outputs, p);
  const EnclosingUnit& unit = *mechkin_enclosing();
  std::vector<char> memory((std::size_t)unit.workspace_size(p));
  nb::gil_scoped_release released;
  FloatingPointState state;
  unit.enclose(p, radii ? &radii->view() : nullptr, r, memory.data());
}

}  // namespace

void bind_enclosing(nb::module_& m) { m.def("enclose", &enclose, nb::arg("plan"), nb::arg("arguments")); }
