// Python's view of proofs: boxes about places, and tubes between them.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <vector>

#include "arguments.hpp"
#include "bindings.hpp"
#include "plan/frozen_plan.hpp"
#include "proofs/tubes.hpp"
#include "rows/threads.hpp"
#include "rows/unit.hpp"
#include "rows/units.hpp"

namespace nb = nanobind;

namespace {

const FrozenPlan* radii_of(Arguments& given, const FrozenPlan& plan) {
  const nb::object object = given.other("radii");
  if (object.is_none()) return nullptr;
  const FrozenPlan* const radii = nb::cast<const FrozenPlan*>(object);
  if (radii->structure() != plan.structure()) throw nb::value_error("radii are those of another structure");
  return radii;
}

// A chart's equations are of motions, not of the mechanism.
void refuse_charts(const Plan& p) {
  if (p.charts) throw nb::value_error("a plan with a chart has no proofs");
}

// Which closing equations follow from others, one byte each; null where none does.
const unsigned char* follows_of(Arguments& given, const Plan& p) {
  const nb::object object = given.other("follows");
  if (object.is_none()) return nullptr;
  const nb::bytes flags = nb::cast<nb::bytes>(object);
  long equations = 0;
  for (int b = 0; b < p.blocks; ++b) equations += p.block[b].rows;
  if ((long)flags.size() != equations) throw nb::value_error("follows has one byte for each closing equation");
  return (const unsigned char*)flags.data();
}

// States with the radii of inputs (inputs x places), as the unit of points takes them.
std::vector<double> with_radii(const Plan& p, const double* states, const double* off, long places) {
  std::vector<double> parts(2 * p.states * places, 0.0);
  for (int s = 0; s < p.states; ++s) std::copy_n(states + s * places, places, &parts[2 * s * places]);
  for (int i = 0; i < p.inputs; ++i)
    std::copy_n(off + i * places, places, &parts[(2 * p.column_state[p.input_column[i]] + 1) * places]);
  return parts;
}

void prove_boxes(const FrozenPlan& plan, const nb::kwargs& keywords) {
  const Plan& p = plan.view();
  refuse_charts(p);
  const ProvingUnit& unit = *mechkin_proving_points();
  Arguments given(keywords);
  ProvingRequest r = {};
  const double* const states = given.read_required("states", p.states);
  const double* const off = given.read_required("off", p.inputs);
  r.least = given.read("least", p.columns);
  r.radius = given.write_required("radius", p.columns);
  r.contraction = given.write_required("contraction", Arguments::ONE_PER_ROW);
  r.beyond = given.write_required("beyond", Arguments::ONE_PER_ROW);
  r.proven = given.write_flags_required("proven");
  r.follows = follows_of(given, p);
  const FrozenPlan* const radii = radii_of(given, plan);
  given.finish();
  r.places = given.rows();
  const std::vector<double> parts = with_radii(p, states, off, r.places);
  r.states = parts.data();
  std::vector<char> memory(unit.workspace_size(p));
  nb::gil_scoped_release released;
  FloatingPointState state;
  unit.prove(p, radii ? &radii->view() : nullptr, r, memory.data());
}

nb::tuple prove_tubes(const FrozenPlan& plan, const nb::kwargs& keywords) {
  const Plan& p = plan.view();
  refuse_charts(p);
  Arguments given(keywords);
  WayOfRows way = {};
  way.place = given.read_required("place", Arguments::ONE_PER_ROW);
  way.inputs = given.read_required("inputs", p.inputs);
  way.off = given.read_required("off", p.inputs);
  way.states = given.read_required("states", p.states);
  way.after = given.read_required("after", p.columns);
  way.before = given.read_required("before", p.columns);
  way.radius = given.read_required("radius", p.columns);
  way.proven = given.write_flags_required("proven");
  way.bends = given.write_flags_required("bends");
  Tubes tubes = {given.write_flags_required("joined"), given.write_required("width", Arguments::ONE_PER_ROW), 0, 0};
  way.follows = follows_of(given, p);
  const FrozenPlan* const radii = radii_of(given, plan);
  given.finish();
  way.rows = given.rows();
  for (long row = 1; row < way.rows; ++row)
    if (!(way.place[row] >= way.place[row - 1])) throw nb::value_error("places along a way do not fall");
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    TubeProver(p, radii ? &radii->view() : nullptr, *mechkin_proving_curves()).prove(way, &tubes);
  }
  return nb::make_tuple(tubes.count, tubes.tried);
}

}  // namespace

void bind_certify(nb::module_& m) {
  m.attr("CONSTANT_LENGTH") = (int)CONSTANT_LENGTH;
  m.attr("CONSTANT_SIZE") = (int)CONSTANT_SIZE;
  m.def("prove_boxes", &prove_boxes, nb::arg("plan"), nb::arg("arguments"));
  m.def("prove_tubes", &prove_tubes, nb::arg("plan"), nb::arg("arguments"));
}
