// Python's view of responses; needs the class Plan bound before.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "new_array.hpp"
#include "plan/frozen_plan.hpp"
#include "refusals.hpp"
#include "response/response.hpp"
#include "rows/run.hpp"
#include "rows/units.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

const double* checked(const Rows& a, std::size_t variants, long width, const char* name) {
  if (a.shape(0) != variants || (long)a.shape(1) != width)
    throw nb::value_error((std::string(name) + ": not of the shape (variants, " + std::to_string(width) + ")").c_str());
  if (!all_finite(a.data(), a.shape(0) * a.shape(1)))
    throw nb::value_error((std::string(name) + ": not finite").c_str());
  return a.data();
}

nb::dict report_of(const ResponseReport& report) {
  const LaneReport& r = report.lane;
  nb::dict d;
  d["first"] = report.first;
  d["stop"] = report.stop, d["joints"] = report.joints;
  nb::list crossings;
  for (const PassedBranchPoint& p : report.crossings) crossings.append(nb::make_tuple(p.time, p.state));
  nb::list touches;
  for (const TouchedStop& t : report.touches) touches.append(nb::make_tuple(t.stop, t.time));
  d["touches"] = touches;
  d["last"] = report.last, d["crossings"] = crossings, d["branch_point"] = report.branch_point;
  d["singular"] = report.singular;
  d["energy"] = report.energy;
  d["lightest"] = report.lightest;
  d["growth"] = report.growth;
  d["met"] = r.met;
  d["step"] = r.step;
  d["value"] = r.value;
  d["end"] = (int)r.end, d["fault"] = (int)r.fault, d["which"] = r.which;
  d["stiff"] = r.stiff, d["stiff_from"] = r.stiff_from, d["time"] = r.time, d["rows"] = r.rows;
  d["evaluations"] = r.evaluations, d["steps"] = r.steps, d["rejections"] = r.rejections;
  return d;
}

using Stops = std::vector<std::tuple<int, int, int, double, int, int>>;
constexpr int MOST_POWER = 64, MOST_PARTS = 1 << 20;

// The plans of some objects, which must outlive them.
std::vector<const FrozenPlan*> plans_of(const std::vector<nb::object>& objects) {
  std::vector<const FrozenPlan*> plans;
  for (const nb::object& object : objects) {
    const FrozenPlan* plan = nullptr;
    if (!nb::try_cast(object, plan, false) || !plan) throw nb::type_error("plans: not a Plan");
    plans.push_back(plan);
    need(plan->structure() == plans[0]->structure(), "plans: not of one structure");
  }
  need(!plans.empty(), "plans: none");
  return plans;
}

MotionLimits limits_of(const std::vector<double>& tests, int iterations, double jump, double radius, bool straight) {
  need(tests.size() == 3, "tests: three");
  for (double limit : {tests[0], tests[1], tests[2], jump, radius}) need(limit >= 0.0, "a limit is a number from 0 on");
  need(iterations >= 0 && iterations <= MOST_ITERATIONS, "iterations: 0 to 10000");
  return {tests[0], tests[1], tests[2], jump, radius, iterations, straight};
}

std::vector<MotionStop> stops_of(const Stops& stops) {
  std::vector<MotionStop> made;
  for (const auto& [kind, direction, count, at, lengths, rates] : stops) {
    need(kind >= STOP_CROSSING && kind <= STOP_CONDITION, "stops: unknown kind");
    need(direction >= -1 && direction <= 1, "stops: a direction is -1, 0 or 1");
    need(all_finite(&at, 1), "stops: not finite");
    need(std::abs(lengths) <= MOST_POWER && rates <= MOST_POWER, "stops: a power is too large");
    made.push_back({kind, direction, count, at, lengths, rates});
  }
  return made;
}

// The arrays of a block of rows, which Python takes as often as it is full.
constexpr double MOST_EXACT = 0x1p54;  // far from where whole numbers of 64 bits end

class TakenByPython : public RowTaker {
 public:
  TakenByPython(nb::object taker, nb::list arrays) : taker_(std::move(taker)), arrays_(std::move(arrays)) {}

  // An exception ends the motion, and is raised behind it.
  bool take(long first, long rows) override {
    nb::gil_scoped_acquire acquired;
    try {
      return nb::cast<bool>(taker_(first, rows, arrays_));
    } catch (nb::python_error& error) {
      raised_.emplace(std::move(error));
      return false;
    }
  }

  void raise() {
    if (raised_) {
      nb::python_error error = std::move(*raised_);
      raised_.reset();
      throw error;
    }
  }

 private:
  nb::object taker_;
  nb::list arrays_;
  std::optional<nb::python_error> raised_;
};

// `held` are plans; references, for another thread may change the list meanwhile.
nb::tuple run_response(const std::vector<nb::object>& held, const Rows& state, const Rows& first, const Rows& tangent,
              double begin, const Row& times, const SpacedTimes* spaced, const Stops& stops, const DrivenLaws* driven, double tolerance,
              double fixed_step, long most_steps, int dense_rows, int method, const std::vector<double>& tests,
              int iterations, double jump, double radius, bool straight, int lanes, int threads, long block,
              const nb::object& taker, const std::tuple<long, long>& some, int parts, const std::optional<double>& last) {
  const std::vector<const FrozenPlan*> plans = plans_of(held);
  if (!motion_unit(lanes)) throw nb::value_error("lanes: this width is not available on this machine");
  if (threads < 1 || threads > 1024) throw nb::value_error("threads: 1 to 1024");
  need(method >= 0 && method <= (int)MethodChoice::IMPLICIT, "method: unknown");
  const Plan& p = plans[0]->view();
  need(taker.is_none() || (plans.size() == 1 && block > 0), "taker: of one motion, in blocks of rows");
  need(!spaced || !taker.is_none(), "spaced: with a taker");
  const auto [skipped, among] = some;
  const long most = spaced ? spaced->count : (long)times.shape(0);
  const long left = among < 0 ? most : among;
  need(skipped >= 0 && skipped <= most && left <= most - skipped, "some: of the times");
  need(parts > 0 && parts <= MOST_PARTS && (!last || std::isfinite(*last)), "parts: 1 to 1048576; last: a finite number");
  const std::size_t count = plans.size(), every = (std::size_t)left * parts + last.has_value();
  const std::size_t rows = taker.is_none() ? every : std::min(every, (std::size_t)block);
  int slots = 0;
  for (const ClosingTurn& t : closing_turns(p, *kernel_unit(2))) slots += t.width;
  const std::size_t wide = (std::size_t)p.charts * p.columns;
  const double* const given[3] = {checked(state, count, p.states, "state"), checked(first, count, p.columns, "first"),
                                  checked(tangent, count, (long)wide, "tangent")};
  ResponseTask task;
  if (p.law.outputs - p.load_values != (int)stops.size()) throw nb::value_error("stops: one for each watched value");
  if ((driven ? driven->inputs() : 0) != p.inputs) throw nb::value_error("driven: one law for each input");
  // a copy: another thread may change the array; who takes blocks keeps it as it is, as there may be many moments
  std::vector<double> moments;
  if (taker.is_none()) moments.assign(times.data(), times.data() + most);
  task.moments = (long)every, task.spaced = spaced;
  task.part = {skipped, parts, begin, last.has_value(), last.value_or(0.0)};
  task.times = taker.is_none() ? moments.data() : times.data(), task.driven = driven, task.stops = stops_of(stops);
  task.limits = limits_of(tests, iterations, jump, radius, straight);
  task.settings.tolerance = tolerance, task.settings.fixed_step = fixed_step;
  task.settings.dense_rows = dense_rows, task.settings.most_steps = most_steps, task.settings.method = (MethodChoice)method;
  MotionRows all = {};
  auto states = new_array<double>(&all.state, {count, (std::size_t)p.states, rows + 1});
  auto directions = new_array<double>(&all.direction, {count, wide, rows + 1});
  auto rates = new_array<double>(&all.chart_rate, {count, (std::size_t)p.charts, rows + 1});
  auto seconds = new_array<double>(&all.chart_second, {count, (std::size_t)p.charts, rows + 1});
  auto turns = new_array<double>(&all.turn, {count, (std::size_t)slots, rows + 1});
  const std::size_t numbers = (std::size_t)p.frictions * TOLD_NUMBERS;
  auto frictions = new_array<double>(&all.friction_told, {count, numbers, rows + 1});
  auto work = new_array<double>(&all.work, {count, 2, rows + 1});
  auto flags = new_array<unsigned char>(&all.flags, {count, rows + 1});
  for (std::size_t v = 0; v < count; ++v) {
    task.starts.push_back(
        {&plans[v]->view(), given[0] + v * p.states, given[1] + v * p.columns, begin,
         given[2] + v * wide});
    task.rows.push_back({(long)rows, all.state + v * p.states * (rows + 1), all.direction + v * wide * (rows + 1),
                         all.chart_rate + v * p.charts * (rows + 1), all.chart_second + v * p.charts * (rows + 1),
                         all.turn + v * slots * (rows + 1),
                         all.friction_told + v * numbers * (rows + 1), all.work + v * 2 * (rows + 1), all.flags + v * (rows + 1)});
  }
  nb::list arrays;
  for (const auto& a : {states, directions, rates, seconds, turns, frictions, work}) arrays.append(a);
  arrays.append(flags);
  TakenByPython taken(taker, arrays);
  if (!taker.is_none()) task.rows[0].taker = &taken;
  const std::vector<ResponseReport> reports = value_of([&] {
    nb::gil_scoped_release released;
    FloatingPointState floating;
    return respond(task, lanes, threads);
  }());
  taken.raise();
  nb::list told;
  for (const ResponseReport& r : reports) told.append(report_of(r));
  return nb::make_tuple(told, states, directions, rates, seconds, turns, frictions, work, flags);
}

}  // namespace

void bind_response(nb::module_& m) {
  nb::class_<SpacedTimes>(m, "SpacedTimes", "Equally spaced moments, which are never held.")
      .def("__init__",
           [](SpacedTimes* self, long count, double first, double step, double over, double last, double multiplier,
              double divisor) {
             const double numbers[] = {first, step, over, last, multiplier, divisor};
             need(count > 0 && all_finite(numbers, 6) && over >= 0.0 && multiplier > 0.0 && divisor > 0.0,
                  "moments: finite numbers, and units above zero");
             need(over == 0.0 || std::abs(first) + std::abs(step) * (double)count <= MOST_EXACT,
                  "moments: whole numbers that doubles hold exactly");
             new (self) SpacedTimes{count, first, step, over, last, multiplier, divisor};
           },
           "count"_a, "first"_a, "step"_a, "over"_a, "last"_a, "multiplier"_a, "divisor"_a)
      .def("at", [](const SpacedTimes& times, long row) {
        if (row < 0 || row >= times.count) throw nb::index_error("no such row");
        return times.at(row);
      }, "row"_a);
  nb::class_<DrivenLaws>(m, "DrivenLaws", "Coordinates driven by laws of time.")
      .def("__init__",
           [](DrivenLaws* self, const TapeStore* tape, std::vector<double> edges, std::vector<double> constants,
              std::vector<double> ways, std::vector<double> units, double time_unit, std::vector<double> held) {
             new (self) DrivenLaws(value_of(make<DrivenLaws>(tape, std::move(edges), std::move(constants),
                                                             std::move(ways), std::move(units), time_unit,
                                                             std::move(held))));
           },
           "tape"_a.none(), "edges"_a, "constants"_a, "ways"_a, "units"_a, "time_unit"_a, "held"_a, nb::keep_alive<1, 2>())
      .def("at", [](const DrivenLaws& laws, double time) {
        // value, rate and acceleration of each input at a moment (s)
        int cell = 0;
        for (double edge : laws.edges()) cell += time >= edge;
        std::vector<double> value(laws.inputs()), rate(laws.inputs()), second(laws.inputs());
        FloatingPointState floating;
        DrivenLaws::Memory memory = laws.memory();
        laws.at(cell, time, 0, 1, value.data(), rate.data(), second.data(), &memory);
        std::vector<std::tuple<double, double, double>> all;
        for (int i = 0; i < laws.inputs(); ++i) all.emplace_back(value[i], rate[i], second[i]);
        return all;
      }, "time"_a)
      .def("over", [](const DrivenLaws& laws, const Row& times) {
        // values, rates and accelerations (3, inputs, moments) at some moments (s)
        const long inputs = laws.inputs(), count = (long)times.shape(0);
        double* to = nullptr;
        auto found = new_array<double>(&to, {3, (std::size_t)inputs, (std::size_t)count});
        std::vector<double> orders(3 * (std::size_t)inputs);
        FloatingPointState floating;
        DrivenLaws::Memory memory = laws.memory();
        for (long k = 0; k < count; ++k) {
          const double time = times.data()[k];
          int cell = 0;
          for (double edge : laws.edges()) cell += time >= edge;
          laws.at(cell, time, 0, 1, orders.data(), orders.data() + inputs, orders.data() + 2 * inputs, &memory);
          for (long n = 0; n < 3 * inputs; ++n) to[n * count + k] = orders[(std::size_t)n];
        }
        return found;
      }, "times"_a);
  // Reports, then arrays (variants, columns, rows): states, chart directions, rates and accelerations of the chart,
  // turns, friction told to rows, work put in and lost; flags (variants, rows). One row more is for the place of a stop. Rows that were not
  // reached hold nan.
  m.def("respond", &run_response, nb::kw_only(), "plans"_a, "state"_a, "first"_a, "tangent"_a, "begin"_a, "times"_a, "spaced"_a.none() = nb::none(), "stops"_a, "driven"_a.none(),
        "tolerance"_a, "fixed_step"_a, "most_steps"_a, "dense_rows"_a, "method"_a, "tests"_a, "iterations"_a, "jump"_a, "radius"_a, "straight"_a,
        "lanes"_a, "threads"_a, "block"_a = 0, "taker"_a.none() = nb::none(), "some"_a = std::make_tuple(0L, -1L), "parts"_a = 1, "last"_a.none() = nb::none());
}
