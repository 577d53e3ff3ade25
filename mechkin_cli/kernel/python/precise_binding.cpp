#include "precise_binding.hpp"

#include <optional>

#include "rows/aligned.hpp"
#include "run_request.hpp"
#include "rows/threads.hpp"
#include "rows/units.hpp"

namespace nb = nanobind;

namespace {

using Bytes = std::vector<char, AlignedAllocator<char>>;

// High and low constants as one plan, which refers to `high` and is good as long as that.
Bytes joined(const DoubleDoubleUnit& unit, const Plan& high, const Plan* low) {
  Bytes memory((std::size_t)unit.join(high, low, nullptr));
  unit.join(high, low, memory.data());
  return memory;
}

}  // namespace

void run_precise(const FrozenPlan& plan, const nb::kwargs& keywords) {
  Arguments given(keywords, 2);
  Request r = {};
  const OutputList* const outputs = read_request(given, plan, r);
  r.chart_forces = given.write("chart_forces", plan.view().charts);
  const double* const low = given.numbers("low", plan.constants());
  const double* const low_outputs = given.numbers("low_outputs", outputs ? outputs->constants() : 0);
  const DoubleDoubleUnit& unit = double_double_unit((int)given.integer("lanes", 0, 8, 0));
  const int threads = threads_for(r.rows, given.integer("threads", 1, MOST_THREADS, 1));
  given.finish();
  if (low && !all_finite(low, plan.constants())) throw nb::value_error("low: not finite");
  if (r.demand & DEMAND_CONDITION) throw nb::value_error("the condition is told by a run in doubles");
  if (r.rows == 0) return;
  check_demand(r, outputs, plan.view());
  std::optional<FrozenPlan> second;
  if (low) second.emplace(plan.with_numbers(low));
  std::optional<OutputList> second_outputs;
  if (low_outputs) {
    second_outputs.emplace(*outputs);
    if (!second_outputs->assign(low_outputs)) throw nb::value_error("low_outputs: not finite");
    r.wanted_second = second_outputs->view();
  }
  const Bytes both = joined(unit, plan.view(), second ? &second->view() : nullptr);
  const long size = unit.workspace_size(both.data());
  std::vector<char> memory((std::size_t)size * threads);
  nb::gil_scoped_release released;
  FloatingPointState state;
  over_rows(r.rows, chunk_of(r.rows, threads), threads, [&](long begin, long end, int thread) {
    unit.run_rows(both.data(), r, begin, end, memory.data() + thread * size);
  });
}
