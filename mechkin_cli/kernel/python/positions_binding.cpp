// Python's view of single positions.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "refusals.hpp"
#include "rows/units.hpp"
#include "stepping/positions.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

// The outputs at some inputs in kernel units and the condition there, 0 where it is not demanded; None where there is no
// position.
nb::object solve(Positions& positions, const std::vector<double>& inputs, const std::vector<double>& whole,
                 const std::vector<double>& full) {
  for (const auto* values : {&inputs, &whole, &full})
    if ((int)values->size() != positions.inputs()) throw nb::value_error("one number for each input");
  if (!are_whole_turns(whole.data(), whole.size()))
    throw nb::value_error("whole: numbers of turns");
  std::vector<double> outputs(positions.slots());
  double condition = 0.0;
  FloatingPointState state;
  if (!positions.solve(inputs.data(), whole.data(), full.data(), outputs.data(), &condition)) return nb::none();
  return nb::make_tuple(outputs, condition);
}

}  // namespace

void bind_positions(nb::module_& m) {
  nb::class_<Positions>(m, "Positions")
      .def("__init__",
           [](Positions* at, const FrozenPlan& plan, const OutputList& outputs, const Rows& inputs,
              const Rows& whole, const Rows& rates, const Rows& accelerations, const Rows& jerks, const Rows& states,
              const Rows& turns, unsigned demand, int iterations, const StepLimits& limits,
              const std::vector<std::tuple<int, int, bool>>& angles) {
             const long n = (long)inputs.shape(1);
             KnownRows rows = {n,
                               copy_of(inputs, n, "inputs"),
                               copy_of(rates, n, "rates"),
                               copy_of(accelerations, n, "accelerations"),
                               copy_of(jerks, n, "jerks"),
                               copy_of(whole, n, "whole"),
                               copy_of(states, n, "states"),
                               copy_of(turns, n, "turns")};
             std::vector<TurningOutput> turning;
             for (const auto& [slot, turn, closing] : angles) turning.push_back({slot, turn, closing});
             new (at) Positions(value_of(make<Positions>(plan, outputs, std::move(rows), demand, iterations, limits,
                                                         std::move(turning))));
           },
           nb::kw_only(), "plan"_a, "outputs"_a, "inputs"_a, "whole"_a, "rates"_a, "accelerations"_a, "jerks"_a, "states"_a,
           "turns"_a, "demand"_a, "iterations"_a, "limits"_a, "angles"_a, nb::keep_alive<1, 2>(),
           nb::keep_alive<1, 3>())
      .def("solve", &solve, "inputs"_a, "whole"_a, "full"_a);
}
