#include "precise_binding.hpp"

#include <optional>

#include "refusals.hpp"
#include "rows/units.hpp"
#include "run_request.hpp"

namespace nb = nanobind;

void run_precise(const FrozenPlan& plan, const nb::kwargs& keywords) {
  Arguments given(keywords, 2);
  Request r = {};
  const OutputList* const outputs = read_request(given, plan, r);
  const double* const low = given.numbers("low", plan.constants());
  const double* const low_outputs = given.numbers("low_outputs", outputs ? outputs->constants() : 0);
  const DoubleDoubleUnit& unit = double_double_unit((int)given.integer("lanes", 0, 8, 0));
  const int threads = (int)given.integer("threads", 1, MOST_THREADS, 1);
  given.finish();
  if (low && !all_finite(low, plan.constants())) throw nb::value_error("low: not finite");
  if (r.demand & DEMAND_CONDITION) throw nb::value_error("the condition is told by a run in doubles");
  if (r.rows == 0) return;
  value_of(check_demand(r, outputs, plan.view()));
  std::optional<FrozenPlan> second;
  if (low) second.emplace(plan.with_numbers(low));
  std::optional<OutputList> second_outputs;
  if (low_outputs) {
    second_outputs.emplace(*outputs);
    if (!second_outputs->assign(low_outputs)) throw nb::value_error("low_outputs: not finite");
    r.wanted_second = second_outputs->view();
  }
  nb::gil_scoped_release released;
  run_rows(plan.view(), second ? &second->view() : nullptr, r, unit, threads);
}
