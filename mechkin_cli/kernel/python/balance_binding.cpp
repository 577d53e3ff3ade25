#include "balance_binding.hpp"

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "arguments.hpp"
#include "bindings.hpp"
#include "refusals.hpp"
#include "rows/balance.hpp"
#include "stepping/stepper.hpp"

namespace nb = nanobind;

long balance_places(const FrozenPlan& plan, const nb::kwargs& keywords) {
  const Plan& p = plan.view();
  Arguments given(keywords);
  Request r = {};
  BalanceRequest b = {};
  std::vector<FreeInput> free;
  std::vector<std::tuple<int, int, double>> records;
  std::vector<int> numbers;
  if (!nb::try_cast(given.other("free"), records)) throw nb::type_error("free: not records of an input, a slot and a unit");
  if (!nb::try_cast(given.other("cyclic"), numbers)) throw nb::type_error("cyclic: not numbers of inputs");
  for (const auto& [input, slot, unit] : records) free.push_back({input, slot, unit});
  b.inputs = given.write_required("inputs", p.inputs);
  b.states = given.write_required("states", p.states);
  b.stiffness = given.write_required("stiffness", (long)(free.size() * free.size()));
  r.turned = given.read_required("turned", turn_slots(p, *kernel_unit(2)));
  r.time = given.read_required("time", Arguments::ONE_PER_ROW);
  r.constraint_rates = given.read("constraint_rates", p.input_constraints);
  b.is_stiffness_given = given.integer("given", 0, 1, 0) != 0;
  b.is_first_known = given.integer("known", 0, 1, 0) != 0;
  const std::vector<double> limits = given.limits("limits", 4);
  b.limits = {limits[0], limits[1], limits[2], limits[3], (int)given.integer("steps", 1, MOST_ITERATIONS, 1)};
  const OutputList* outputs = nullptr;
  const nb::object list = given.other("outputs");
  if (!nb::try_cast(list, outputs, false)) throw nb::type_error("outputs: not Outputs of a plan");
  r.iterations = (int)given.integer("iterations", 0, MOST_ITERATIONS, 0);
  const std::vector<double> tests = given.limits("tests", 3);
  const KernelUnit& unit = unit_or_throw((int)given.integer("lanes", 0, 8, 0));
  const int threads = (int)given.integer("threads", 1, MOST_THREADS, 1);
  given.finish();
  need(outputs->fits(plan), "outputs: of a plan with another structure");
  r.wanted = outputs->view();
  r.tight = tests[0], r.coarse = tests[1], r.accept = tests[2];
  r.demand = DEMAND_VELOCITY | DEMAND_ACCELERATION | DEMAND_FORCES;
  need(!p.charts, "a chart has equilibria of its own");
  for (const FreeInput& one : free)
    need(one.input >= 0 && one.input < p.inputs && one.slot >= 0 && one.slot < r.wanted.slots, "free: no such input or slot");
  std::vector<unsigned char> cyclic((std::size_t)p.inputs);
  for (const int number : numbers) {
    need(number >= 0 && number < p.inputs, "cyclic: no such input");
    cyclic[(std::size_t)number] = 1;
  }
  b.places = r.rows = given.rows();
  b.free = free.data(), b.free_count = (int)free.size(), b.cyclic = cyclic.data();
  if (!b.places) return 0;
  Request checked = r;
  checked.rates = checked.accelerations = checked.outputs = b.inputs;  // those of the rows come with these
  value_of(check_demand(checked, outputs, p));
  nb::gil_scoped_release released;
  return balance(p, r, unit, threads, b);
}
