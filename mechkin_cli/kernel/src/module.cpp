// Python's view of the kernel: arrays in, arrays out, the GIL released while it works.
//
// Batched arrays are (columns, rows), C-contiguous, so that a column is contiguous; the Python wrapper shows
// their transpose, batch axis first.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "number_text.hpp"
#include "operations.hpp"
#include "plan_store.hpp"
#include "stepper_binding.hpp"
#include "tape_store.hpp"
#include "units.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Array2 = nb::ndarray<nb::numpy, double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Array1 = nb::ndarray<nb::numpy, double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<nb::numpy, unsigned char, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

const KernelUnit& unit_or_throw(int lanes) {
  const KernelUnit* unit = kernel_unit(lanes);
  if (!unit) throw nb::value_error("this width is not available on this machine; 0 asks for the widest");
  return *unit;
}

double* columns(const std::optional<Array2>& a, long count, long rows, const char* name) {
  if (!a) return nullptr;
  if ((long)a->shape(0) != count || (long)a->shape(1) != rows)
    throw nb::value_error((std::string(name) + ": wrong shape").c_str());
  return a->data();
}
double* per_row(const std::optional<Array1>& a, long rows, const char* name) {
  if (!a) return nullptr;
  if ((long)a->shape(0) != rows) throw nb::value_error((std::string(name) + ": wrong length").c_str());
  return a->data();
}
unsigned char* row_flags(const Flags& a, long rows) {
  if ((long)a.shape(0) != rows) throw nb::value_error("flags: wrong length");
  return a.data();
}

void check_demand(const PlanStore& store, const Request& r) {
  if (!store.finished()) throw nb::value_error("the plan is not finished");
  if (r.outputs && (store.demand() & ~r.demand)) throw nb::value_error("the outputs need more than is demanded");
  const bool moving = r.demand & DEMAND_VELOCITY;
  if (moving && !r.rates) throw nb::value_error("velocities need rates of the inputs");
  if (r.demand & DEMAND_ACCELERATION && (!moving || !r.accelerations))
    throw nb::value_error("accelerations need rates and accelerations of the inputs");
  if (r.demand & DEMAND_JERK && (!(r.demand & DEMAND_ACCELERATION) || !r.jerks))
    throw nb::value_error("jerks need accelerations, and jerks of the inputs");
  if (r.demand & DEMAND_FORCES && store.view().load_values && !r.loads)
    throw nb::value_error("forces need the values of varying loads");
  if (r.demand & DEMAND_CONDITION && !r.condition) throw nb::value_error("no array for the condition");
  if (r.demand & DEMAND_POWER && !r.power_error) throw nb::value_error("no array for the power error");
}

void run(const PlanStore& store, Array2 inputs, std::optional<Array2> rates, std::optional<Array2> accelerations,
         Array2 guess, Array2 states, std::optional<Array2> outputs, std::optional<Array2> first,
         std::optional<Array2> second, Array1 residual, Array1 correction, std::optional<Array1> orientation,
         std::optional<Array1> condition, std::optional<Array1> power_error, Flags flags, unsigned demand, int shift,
         int iterations, std::array<double, 3> tests, int lanes, std::optional<Array2> loads,
         std::optional<Array2> jerks) {
  const Plan& p = store.view();
  const KernelUnit& unit = unit_or_throw(lanes);
  Request r = {};
  r.rows = (long)inputs.shape(1);
  r.inputs = columns(inputs, p.inputs, r.rows, "inputs");
  r.rates = columns(rates, p.inputs, r.rows, "rates");
  r.accelerations = columns(accelerations, p.inputs, r.rows, "accelerations");
  r.guess = columns(guess, p.states, r.rows, "guess");
  r.jerks = columns(jerks, p.inputs, r.rows, "jerks");
  r.loads = columns(loads, p.load_values, r.rows, "loads");
  r.states = columns(states, p.states, r.rows, "states");
  r.outputs = columns(outputs, p.slots, r.rows, "outputs");
  r.velocities = columns(first, p.columns, r.rows, "first");
  r.second = columns(second, p.columns, r.rows, "second");
  r.residual = per_row(residual, r.rows, "residual");
  r.correction = per_row(correction, r.rows, "correction");
  r.orientation = per_row(orientation, r.rows, "orientation");
  r.condition = per_row(condition, r.rows, "condition");
  r.power_error = per_row(power_error, r.rows, "power_error");
  r.flags = row_flags(flags, r.rows);
  r.demand = demand;
  r.shift = shift;
  r.iterations = iterations;
  r.tight = tests[0], r.coarse = tests[1], r.accept = tests[2];
  check_demand(store, r);
  std::vector<char> memory(unit.workspace_size(p));
  nb::gil_scoped_release released;
  FloatingPointState state;
  unit.run(p, r, memory.data());
}

void search(const PlanStore& store, int block, Array2 inputs, Array2 states, Array1 residual, Flags flags,
            int iterations, double accept, int lanes) {
  const Plan& p = store.view();
  const KernelUnit& unit = unit_or_throw(lanes);
  if (block < 0 || block >= p.blocks) throw nb::value_error("no such block");
  SearchRequest r = {};
  r.rows = (long)inputs.shape(1);
  r.block = block;
  r.inputs = columns(inputs, p.inputs, r.rows, "inputs");
  r.states = columns(states, p.states, r.rows, "states");
  r.residual = per_row(residual, r.rows, "residual");
  r.flags = row_flags(flags, r.rows);
  r.iterations = iterations;
  r.accept = accept;
  std::vector<char> memory(unit.workspace_size(p));
  nb::gil_scoped_release released;
  FloatingPointState state;
  unit.search(p, r, memory.data());
}

using Values = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using NewValues = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

NewValues elementwise(int operation, Values x, Values y, int lanes) {
  const KernelUnit& unit = unit_or_throw(lanes);
  const std::size_t n = x.shape(0);
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
  for (int code = 0; code < PAIR_CODES; ++code) {
    const PairType& t = kernel_unit()->pair_types[code];
    nb::dict entry;
    entry["letter"] = t.letter;
    entry["code"] = code;
    entry["parts"] = t.parts;
    entry["coordinates"] = t.coordinates;
    entry["equations"] = t.equations;
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

NB_MODULE(_kernel, m) {
  m.doc() = "Compiled core of mechkin: closure, motion and reactions of a planned mechanism, in lanes.";
  m.attr("widest") = kernel_unit()->lanes;
  m.def("joint_table", &joint_table);
  m.def("tree_table", &tree_table);
  m.def("elementwise", &elementwise, "operation"_a, "x"_a, "y"_a, "lanes"_a = 0);
  bind_text(m);
  bind_tape(m);

  nb::class_<PlanStore>(m, "Plan")
      .def(nb::init<double, Triple, double>(), "length"_a, "origin"_a, "size"_a)
      .def("add_tree_joint", &PlanStore::add_tree_joint, "type"_a, "parent"_a, "pitch"_a, "at"_a)
      .def("add_closing_joint", &PlanStore::add_closing_joint, "type"_a, "first"_a, "second"_a, "on_first"_a,
           "on_second"_a, "parameter"_a, "loop"_a)
      .def("add_leg", &PlanStore::add_leg, "body"_a, "rod"_a, "first"_a, "second"_a, "on_first"_a, "on_second"_a,
           "length"_a, "line"_a, "slide_sign"_a, "loop"_a)
      .def("add_place", &PlanStore::add_place, "reference"_a, "first"_a, "second"_a, "point_on"_a, "point"_a, "sign"_a)
      .def("add_axis", &PlanStore::add_axis, "place"_a, "slide"_a, "link"_a, "vector"_a, "other"_a, "other_vector"_a)
      .def("add_block", &PlanStore::add_block, "closing_joints"_a, "joints"_a, "unknown"_a)
      .def("set_rest", &PlanStore::set_rest, "joints"_a)
      .def("add_input", &PlanStore::add_input, "column"_a, "axis"_a, "scale"_a)
      .def("set_inertia", &PlanStore::set_inertia, "link"_a, "mass"_a, "centre"_a, "tensor"_a)
      .def("set_gravity", &PlanStore::set_gravity, "g"_a)
      .def("add_load", &PlanStore::add_load, "type"_a, "link"_a, "other"_a, "freedom"_a, "point"_a, "other_point"_a, "vector"_a,
           "varying"_a = false)
      .def("add_output", &PlanStore::add_output, "type"_a, "index"_a, "freedom"_a, "order"_a, "data"_a, "factor"_a)
      .def("finish", &PlanStore::finish)
      .def_prop_ro("states", [](const PlanStore& s) { return s.view().states; })
      .def_prop_ro("columns", [](const PlanStore& s) { return s.view().columns; })
      .def_prop_ro("slots", [](const PlanStore& s) { return s.view().slots; })
      .def("run", &run, "inputs"_a, "rates"_a.none(), "accelerations"_a.none(), "guess"_a, "states"_a,
           "outputs"_a.none(), "first"_a.none(), "second"_a.none(), "residual"_a, "correction"_a,
           "orientation"_a.none(), "condition"_a.none(), "power_error"_a.none(), "flags"_a, "demand"_a, "shift"_a,
           "iterations"_a, "tests"_a, "lanes"_a,
           "loads"_a.none() = nb::none(), "jerks"_a.none() = nb::none())
      .def("search", &search, "block"_a, "inputs"_a, "states"_a, "residual"_a, "flags"_a, "iterations"_a,
           "accept"_a, "lanes"_a);
  bind_stepper(m);
}
