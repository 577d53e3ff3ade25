// Python's view of the integration of a tape.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "integrator/tape_motion.hpp"
#include "new_array.hpp"
#include "refusals.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

nb::dict lane_report(const LaneReport& r) {
  nb::dict d;
  d["end"] = (int)r.end;
  d["fault"] = (int)r.fault;
  d["which"] = r.which;
  d["stiff"] = r.stiff;
  d["stiff_from"] = r.stiff_from;
  d["time"] = r.time;
  d["rows"] = r.rows;
  d["evaluations"] = r.evaluations;
  d["steps"] = r.steps;
  d["rejections"] = r.rejections;
  return d;
}

nb::tuple integrate_tape(const TapeStore& tape, int freedoms, int quadratures,
                         const std::vector<std::tuple<bool, bool, bool>>& switches, Row time, Rows state, Rows parameters,
                         Row rows, const std::vector<double>& scales, double bounce, double reach, double tolerance, double fixed_step,
                         double least_step, long most_steps, int dense_rows, int method) {
  const std::size_t lanes = time.shape(0), size = 2 * (std::size_t)freedoms + quadratures;
  if (state.shape(0) != size || state.shape(1) != lanes || parameters.shape(1) != lanes)
    throw nb::value_error("one column for each lane");
  if (method < 0 || method > 2) throw nb::value_error("unknown method");
  TapeMotion::Shape shape{(int)lanes, freedoms, quadratures, {}, {}, bounce, reach};
  for (const auto& [kink, moves, stop] : switches) {
    shape.switches.push_back({kink, moves});
    shape.stops.push_back(stop);
  }
  const IntegratorSettings settings{tolerance, fixed_step, least_step, most_steps, dense_rows, (MethodChoice)method};
  TapeMotion motion = value_of(
      make<TapeMotion>(tape, shape, copy_of(state), copy_of(parameters), scales, (long)rows.shape(0)));
  const std::vector<LaneReport> reports = value_of([&] {
    nb::gil_scoped_release released;
    FloatingPointState floating;
    return integrate(motion, settings, time.data(), motion.start(), {rows.data(), (long)rows.shape(0), 0});
  }());
  double* out;
  auto states = new_array<double>(&out, {rows.shape(0), size, lanes});
  std::copy(motion.rows().begin(), motion.rows().end(), out);
  nb::list lane_reports, events;
  for (const LaneReport& r : reports) lane_reports.append(lane_report(r));
  for (const TapeEvent& e : motion.events())
    events.append(nb::make_tuple(e.lane, e.which, e.rising, e.time, nb::cast(e.state)));
  return nb::make_tuple(states, lane_reports, events, motion.inside());
}

}  // namespace

void bind_integrator(nb::module_& m) {
  // (states (rows, components, lanes), a report for each lane, events (lane, switch, rising, time, state), rows that
  // were interpolated)
  m.def("integrate_tape", &integrate_tape, "tape"_a, "freedoms"_a, "quadratures"_a, "switches"_a, "time"_a, "state"_a,
        "parameters"_a, "rows"_a, "scales"_a, "bounce"_a, "reach"_a, "tolerance"_a, "fixed_step"_a, "least_step"_a, "most_steps"_a,
        "dense_rows"_a, "method"_a);
}
