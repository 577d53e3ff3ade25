// Python's view of variants.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <string>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "new_array.hpp"
#include "refusals.hpp"
#include "rows/units.hpp"
#include "stepping/variants.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using WayRecord = std::tuple<long, std::vector<long>, Rows, std::shared_ptr<Course>>;

// Outputs (count, slots, rows), residual and condition (count, rows), and how each variant ended (count,). Rows of
// variants that are not complete hold nan.
nb::tuple run_variants(const Variants& variants, const Rows& parameters, int lanes, int threads) {
  if (parameters.shape(0) != (std::size_t)variants.parameters())
    throw nb::value_error("parameters: one row for each");
  if (threads < 1 || threads > 1024) throw nb::value_error("threads: 1 to 1024");
  const KernelUnit& unit = unit_or_throw(lanes);
  const std::size_t count = parameters.shape(1), rows = variants.rows(), slots = variants.slots();
  VariantArrays out;
  auto outputs = new_array<double>(&out.outputs, {count, slots, rows});
  auto residual = new_array<double>(&out.residual, {count, rows});
  auto condition = new_array<double>(&out.condition, {count, rows});
  auto end = new_array<int>(&out.end, {count});
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    variants.run((long)count, parameters.data(), unit, threads, out);
  }
  return nb::make_tuple(outputs, residual, condition, end);
}

// How the continuation ended, the size (m) and the states of the first assembly.
nb::tuple start(const Variants& variants, const Row& parameters) {
  if (parameters.shape(0) != (std::size_t)variants.parameters()) throw nb::value_error("parameters: one for each");
  VariantStart found;
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    found = variants.start(parameters.data());
  }
  double* data;
  auto states = new_array<double>(&data, {found.state.size()});
  std::copy(found.state.begin(), found.state.end(), data);
  return nb::make_tuple((int)found.end, found.size, states);
}

}  // namespace

void bind_variants(nb::module_& m) {
  nb::enum_<VariantEnd>(m, "VariantEnd", nb::is_arithmetic())
      .value("COMPLETE", VariantEnd::complete)
      .value("OTHER_WAY", VariantEnd::other_way)
      .value("LOST", VariantEnd::lost)
      .value("INCOMPLETE", VariantEnd::incomplete);
  nb::class_<Variants>(m, "Variants")
      .def("__init__",
           [](Variants* at, const TapeStore& tape, const FrozenPlan& plan, const OutputList& outputs,
              const Row& parameters, const Rows& inputs, const Rows& whole, const Rows& full, const Row& time, const Rows& rates, const Rows& accelerations,
              const Rows& jerks, const Row& state, double size, long start_row, unsigned demand, int iterations,
              const StepLimits& continuation, const StepLimits& following,
              const std::vector<std::tuple<int, int, bool>>& angles, double half_turn_side,
              const std::vector<WayRecord>& ways) {
             const long rows = (long)inputs.shape(1);
             VariantBase base = {copy_of(parameters), copy_of(inputs, rows, "inputs"), copy_of(rates, rows, "rates"),
                                 copy_of(accelerations, rows, "accelerations"), copy_of(jerks, rows, "jerks"),
                                 copy_of(whole, rows, "whole"), copy_of(full, rows, "full"), copy_of(time),
                                 copy_of(state), size, rows, start_row, demand, iterations, continuation, following, {},
                                 half_turn_side, {}};
             for (const auto& [slot, turn, closing] : angles) base.angles.push_back({slot, turn, closing});
             for (const auto& [step, places, values, course] : ways)
               base.ways.push_back({step, places, copy_of(values, (long)places.size(), "ways"), course});
             new (at) Variants(value_of(make<Variants>(tape, plan, outputs, std::move(base))));
           },
           nb::kw_only(), "tape"_a, "plan"_a, "outputs"_a, "parameters"_a, "inputs"_a, "whole"_a, "full"_a, "time"_a, "rates"_a, "accelerations"_a,
           "jerks"_a, "state"_a, "size"_a, "start_row"_a, "demand"_a, "iterations"_a, "continuation"_a, "following"_a,
           "angles"_a, "half_turn_side"_a, "ways"_a = nb::list(), nb::keep_alive<1, 2>(), nb::keep_alive<1, 3>(),
           nb::keep_alive<1, 4>())
      .def("run", &run_variants, "parameters"_a, "lanes"_a = 0, "threads"_a = 1)
      .def("start", &start, "parameters"_a);
}
