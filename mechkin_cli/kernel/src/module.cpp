// Python's view of the kernel: arrays in, arrays out, the GIL released while it works.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "number_text.hpp"
#include "operations.hpp"
#include "frozen_plan.hpp"
#include "tracker.hpp"
#include "units.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Array2 = nb::ndarray<nb::numpy, double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Values = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Array1 = nb::ndarray<nb::numpy, double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

double* columns(const Array2& a, long count, long rows, const char* name) {
  if ((long)a.shape(0) != count || (long)a.shape(1) != rows)
    throw nb::value_error((std::string(name) + ": wrong shape").c_str());
  return a.data();
}
double* per_row(const Array1& a, long rows, const char* name) {
  if ((long)a.shape(0) != rows) throw nb::value_error((std::string(name) + ": wrong length").c_str());
  return a.data();
}

// limits in the order of TrackLimits; returns (end, rows reached, steps, rejected, sigma, refused step);
// `last` receives the states of the last node.
nb::tuple track(const FrozenPlan& plan, const std::vector<double>& x0, const std::vector<double>& u, const Values& sigma,
                const Values& start, const Array2& guess, const Array1& limit, const Array1& last,
                const std::array<double, 12>& l) {
  const Plan& p = plan.view();
  const long rows = (long)sigma.shape(0);
  if ((int)x0.size() != p.inputs || (int)u.size() != p.inputs) throw nb::value_error("one start and rate per input");
  if ((long)start.shape(0) != p.states) throw nb::value_error("start: wrong length");
  double* const end_state = per_row(last, p.states, "last");
  double* const guess_data = columns(guess, p.states, rows, "guess");
  double* const limit_data = per_row(limit, rows, "limit");
  for (double value : l)
    if (!(value >= -1.0 && value <= 1e9)) throw nb::value_error("limits: a number out of range");
  for (long row = 1; row < rows; ++row)
    if (!(sigma.data()[row] >= sigma.data()[row - 1])) throw nb::value_error("sigma must increase");
  const TrackLimits limits = {l[0], l[1], l[2], l[3], l[4], l[5], l[6], (int)l[7], l[8], l[9], l[10], l[11], 6};
  const KernelUnit& unit = unit_or_throw(2);
  Track t;
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    t = follow(p, unit, x0.data(), u.data(), rows, sigma.data(), start.data(), limits, guess_data, limit_data);
  }
  if ((long)t.last.state.size() == p.states)
    for (int s = 0; s < p.states; ++s) end_state[s] = t.last.state[s];
  return nb::make_tuple((int)t.end, t.reached, t.steps, t.rejected, t.last.sigma, t.refused_step);
}

using NewValues = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

NewValues elementwise(int operation, Values x, Values y, int lanes) {
  const KernelUnit& unit = unit_or_throw(lanes);
  const std::size_t n = x.shape(0);
  if (operation < 0 || operation >= OPERATION_COUNT) throw nb::value_error("unknown operation");
  if (y.shape(0) != n) throw nb::value_error("arguments of different length");
  double* out = new double[n ? n : 1];
  nb::capsule owner(out, [](void* data) noexcept { delete[] static_cast<double*>(data); });
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    unit.elementwise(operation, x.data(), y.data(), out, (long)n);
  }
  return NewValues(out, {n}, owner);
}

// The joint table and the tree displacements that its pairs are chains of.
nb::list joint_table() {
  nb::list table;
  for (int code = 0; code < kernel_unit()->pair_codes; ++code) {
    const PairType& t = kernel_unit()->pair_types[code];
    nb::dict entry;
    entry["letter"] = t.letter;
    entry["code"] = code;
    entry["equations"] = t.equations;
    entry["lengths"] = t.lengths;
    table.append(entry);
  }
  return table;
}

nb::list tree_table() {
  nb::list table;
  for (int code = 0; code < TREE_CODES; ++code) {
    const TreeType& t = kernel_unit()->tree_types[code];
    nb::dict entry;
    entry["code"] = code;
    entry["freedoms"] = t.freedoms;
    entry["states"] = t.states;
    entry["slides"] = t.slides;
    table.append(entry);
  }
  return table;
}

}  // namespace

const KernelUnit& unit_or_throw(int lanes) {
  const KernelUnit* unit = kernel_unit(lanes);
  if (!unit) throw nb::value_error("lanes: this width is not available on this machine; 0 asks for the widest");
  return *unit;
}

NB_MODULE(_kernel, m) {
  m.doc() = "Compiled core of mechkin: closure, motion and reactions of a planned mechanism, in lanes.";
  m.attr("widest") = kernel_unit()->lanes;
  m.def("joint_table", &joint_table);
  m.def("tree_table", &tree_table);
  m.def("elementwise", &elementwise, "operation"_a, "x"_a, "y"_a, "lanes"_a = 0);
  bind_text(m);
  bind_codes(m);
  bind_plan(m);
  nb::cast<nb::class_<FrozenPlan>>(m.attr("Plan"))
      .def("track", &track, "x0"_a, "u"_a, "sigma"_a, "start"_a, "guess"_a.noconvert(),
           "limit"_a.noconvert(), "last"_a.noconvert(), "limits"_a);
}
