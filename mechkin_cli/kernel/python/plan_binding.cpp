// Python's view of plans: a builder that collects records, the immutable plan, the outputs of its runs.
//
// Batched arrays are (columns, rows), C-contiguous, so that a column is contiguous; the GIL is released while the
// kernel works, and a finished plan may run in several threads at once.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>

#include "arguments.hpp"
#include "balance_binding.hpp"
#include "bindings.hpp"
#include "plan/output_list.hpp"
#include "plan/plan_builder.hpp"
#include "precise_binding.hpp"
#include "refusals.hpp"
#include "rows/assembly_size.hpp"
#include "rows/threads.hpp"
#include "rows/units.hpp"
#include "run_request.hpp"
#include "stepping/stepper.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Constants = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using NewConstants = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

template <class Owner>
NewConstants constants_of(const Owner& owner) {
  const std::size_t n = owner.constants();
  double* const out = new double[n ? n : 1];
  nb::capsule capsule(out, [](void* data) noexcept { delete[] static_cast<double*>(data); });
  owner.read_constants(out);
  return NewConstants(out, {n}, capsule);
}

template <class Owner>
Owner with_constants(const Owner& owner, const Constants& constants) {
  if (constants.shape(0) != owner.constants())
    throw nb::value_error(("constants: " + std::to_string(constants.shape(0)) + " instead of " +
                           std::to_string(owner.constants())).c_str());
  Owner other(owner);
  if (!other.assign(constants.data()))
    throw nb::value_error("constants must be finite, length unit and size positive");
  return other;
}

FrozenPlan with_size(const FrozenPlan& plan, double size) {
  FrozenPlan other(plan);
  if (!other.assign_size(size)) throw nb::value_error("the size must be finite and positive");
  return other;
}

double measured_size(const FrozenPlan& plan, const nb::kwargs& keywords) {
  const Plan& p = plan.view();
  Arguments given(keywords);
  const double* const inputs = given.read_required("inputs", p.inputs);
  const double* const guess = given.read_required("guess", p.states);
  const int iterations = (int)given.integer("iterations", 0, MOST_ITERATIONS, 0);
  const std::vector<double> tests = given.limits("tests", 3);
  given.finish();
  if (given.rows() != 1) throw nb::value_error("the size is that of one assembly");
  const KernelUnit& unit = *kernel_unit(2);
  SizeMemory memory(p, unit);
  nb::gil_scoped_release released;
  FloatingPointState state;
  return assembly_size(p, unit, inputs, guess, {tests[0], tests[1], tests[2], iterations}, memory);
}

// Whether all rows closed within the limits that are given; false without any.
bool run_plan(const FrozenPlan& plan, const nb::kwargs& keywords) {
  const Plan& p = plan.view();
  Arguments given(keywords);
  Request r = {};
  const OutputList* const outputs = read_request(given, plan, r);
  const int only = (int)given.integer("only", 0, p.blocks - 1, -1);
  const KernelUnit& unit = unit_or_throw((int)given.integer("lanes", 0, 8, 0));
  const int slots = turn_slots(p, unit);
  r.turn = given.write("turn", slots);
  r.chart_origin = given.read("chart_origin", p.states);
  r.chart_place = given.read("chart_place", p.charts);
  RowLimits limits = {given.read("limit", Arguments::ONE_PER_ROW), 0.0};
  if (limits.correction) limits.condition = given.limits("most_condition", 1)[0];
  const int threads = (int)given.integer("threads", 1, MOST_THREADS, 1);
  given.finish();
  if (r.turn && !(r.demand & DEMAND_ACCELERATION)) throw nb::value_error("turn: told with accelerations");
  if (only >= 0 && (r.demand & ~DEMAND_CONDITION || r.outputs))
    throw nb::value_error("one block alone has its closing and its condition");
  if (limits.correction && !r.side) throw nb::value_error("limit: goes with sides");
  if (r.rows == 0) return false;
  value_of(check_demand(r, outputs, p));
  std::vector<unsigned char> use((std::size_t)p.blocks, BLOCK_LEFT);
  Held others = {};
  others.use = use.data();
  if (only >= 0) use[(std::size_t)only] = BLOCK_SOLVED, r.held = &others;
  std::vector<ClosingTurn> turns;
  std::vector<double> moving;
  if (r.turn) {
    turns = closing_turns(p, unit);
    r.turns = turns.data(), r.turn_count = (int)turns.size();
    moving.resize((std::size_t)(2 * slots * r.rows));
    r.turn_first = moving.data(), r.turn_second = moving.data() + slots * r.rows;
    std::fill(r.turn, r.turn + slots * r.rows, 0.0);  // the states of the tree have their turns
  }
  nb::gil_scoped_release released;
  if (limits.correction) return run_rows(p, r, unit, threads, limits);
  run_rows(p, r, unit, threads);
  return false;
}

void search(const FrozenPlan& plan, const nb::kwargs& keywords) {
  const Plan& p = plan.view();
  Arguments given(keywords);
  SearchRequest r = {};
  r.inputs = given.read_required("inputs", p.inputs);
  r.states = given.write_required("states", p.states);
  r.residual = given.write_required("residual", Arguments::ONE_PER_ROW);
  r.flags = given.write_flags_required("flags");
  r.rows = given.rows();
  r.block = (int)given.integer("block", 0, p.blocks - 1, -1);
  if (r.block < 0) throw nb::type_error("block: missing");
  r.iterations = (int)given.integer("iterations", 0, MOST_ITERATIONS, 0);
  r.accept = given.limits("tests", 1)[0];
  const KernelUnit& unit = unit_or_throw((int)given.integer("lanes", 0, 8, 0));
  const int threads = (int)given.integer("threads", 1, MOST_THREADS, 1);
  given.finish();
  if (r.rows == 0) return;
  nb::gil_scoped_release released;
  search_rows(p, r, unit, threads);
}

using OutputTuple = std::tuple<int, int, int, int, Triple, double>;

OutputRecord output_record(const OutputTuple& given) {
  const auto& [type, index, freedom, order, data, factor] = given;
  return {type, index, freedom, order, data, factor};
}

// name, type, parent: as PlanBuilder names them
void bind_builder(nb::module_& m) {
  nb::class_<PlanBuilder>(m, "PlanBuilder", "Collects the records of a plan; spent by finish().")
      .def("__init__", [](PlanBuilder* self, double length, const Triple& origin, double size) {
        new (self) PlanBuilder(value_of(PlanBuilder::make(length, origin, size)));
      }, "length"_a, "origin"_a, "size"_a)
      .def("add_tree_joint", raising(&PlanBuilder::add_tree_joint), "type"_a, "parent"_a, "pitch"_a, "at"_a)
      .def("add_closing_joint", raising(&PlanBuilder::add_closing_joint), "type"_a, "first"_a, "second"_a, "on_first"_a,
           "on_second"_a, "parameter"_a, "loop"_a)
      .def("add_hung_links", raising(&PlanBuilder::add_hung_links), "body"_a, "rod"_a, "first"_a, "second"_a, "on_first"_a, "on_second"_a,
           "length"_a, "line"_a, "slide_sign"_a, "loop"_a)
      .def("add_function", raising(&PlanBuilder::add_function), "arguments"_a, "curves"_a, "knots"_a, "constants"_a, "operations"_a,
           "operands"_a, "instructions"_a, "outputs"_a, "output_ends"_a)
      .def("add_relation", raising(&PlanBuilder::add_relation), "length"_a, "terms"_a, "factors"_a, "arguments"_a, "sum"_a)
      .def("add_mesh", raising(&PlanBuilder::add_mesh), "carrier"_a, "point"_a, "along"_a, "apart"_a, "path"_a)
      .def("add_force", raising(&PlanBuilder::add_force), "point"_a, "along"_a, "apart"_a)
      .def("add_place", raising(&PlanBuilder::add_place), "reference"_a, "first"_a, "second"_a, "point_on"_a, "point"_a,
           "sign"_a)
      .def("add_axis", raising(&PlanBuilder::add_axis), "place"_a, "slide"_a, "link"_a, "vector"_a, "other"_a,
           "other_vector"_a)
      .def("set_course", raising(&PlanBuilder::set_course), "joint"_a, "function"_a, "axes"_a)
      .def("add_free_motion", raising(&PlanBuilder::add_free_motion), "place"_a, "slide"_a, "code"_a, "link"_a, "vector"_a)
      .def("add_block", raising(&PlanBuilder::add_block), "closing_joints"_a, "joints"_a, "unknown"_a,
           "charts"_a = 0)
      .def("set_rest", raising(&PlanBuilder::set_rest), "joints"_a)
      .def("add_input", raising(&PlanBuilder::add_input), "column"_a, "axis"_a, "scale"_a)
      .def("set_inertia", raising(&PlanBuilder::set_inertia), "link"_a, "mass"_a, "centre"_a, "tensor"_a)
      .def("set_gravity", raising(&PlanBuilder::set_gravity), "g"_a)
      .def("add_load", raising(&PlanBuilder::add_load), "type"_a, "link"_a, "other"_a, "freedom"_a, "point"_a,
           "other_point"_a, "vector"_a, "varying"_a = false)
      .def("add_bushing", raising(&PlanBuilder::add_bushing), "damps"_a, "first"_a, "second"_a, "on_first"_a, "on_second"_a,
           "matrix"_a, "free"_a)
      .def("set_load_program", raising(&PlanBuilder::set_load_program), "reads"_a, "numbers"_a, "curves"_a, "knots"_a, "constants"_a, "operations"_a, "operands"_a, "outputs"_a, "kinks"_a)
      .def("set_driven", raising(&PlanBuilder::set_driven), "inputs"_a)
      .def("add_actuator", raising(&PlanBuilder::add_actuator), "axis"_a, "reference"_a, "freedom"_a)
      .def("add_input_constraint", raising(&PlanBuilder::add_input_constraint), "input"_a, "leader"_a)
      .def("add_friction", raising(&PlanBuilder::add_friction), "place"_a, "turns"_a, "slides"_a, "link"_a, "falls"_a, "axis"_a,
           "radius"_a, "pitch"_a, "at_rest"_a, "sliding"_a, "speed"_a, "course"_a)
      .def("add_contact", raising(&PlanBuilder::add_contact), "code"_a, "weight"_a, "share"_a, "tilt"_a, "roll"_a,
           "direction"_a)
      .def("add_size_point", raising(&PlanBuilder::add_size_point), "link"_a, "point"_a)
      .def("finish", raising(&PlanBuilder::finish))
      .def_prop_ro("states", &PlanBuilder::states)
      .def_prop_ro("columns", &PlanBuilder::columns);
}

void bind_outputs(nb::module_& m) {
  nb::class_<OutputList>(m, "Outputs", "Quantities that runs of a plan write, checked against it.")
      .def("__init__", [](OutputList* self, const FrozenPlan& plan, const std::vector<OutputTuple>& records) {
        std::vector<OutputRecord> list;
        for (const OutputTuple& record : records) list.push_back(output_record(record));
        new (self) OutputList(value_of(OutputList::make(plan, list)));
      }, "plan"_a, "records"_a)
      .def_prop_ro("slots", [](const OutputList& o) { return o.view().slots; })
      .def_prop_ro("demand", [](const OutputList& o) { return (Demand)o.demand(); })
      .def_prop_ro("constants", &constants_of<OutputList>, nb::rv_policy::automatic)
      .def("with_constants", &with_constants<OutputList>, "constants"_a);
  const auto check = [](int type, int order) {
    if (!is_output(type) || order < 0 || order > 3) throw nb::value_error("unknown kind or order of output");
  };
  m.def("output_width", [check](int type) {
    check(type, 0);
    return output_width(type);
  }, "type"_a);
  m.def("output_demand", [check](int type, int order) {
    check(type, order);
    return (Demand)output_demand(type, order);
  }, "type"_a, "order"_a = 0);
}

}  // namespace

void bind_plan(nb::module_& m) {
  bind_builder(m);
  nb::class_<FrozenPlan>(m, "Plan", "An immutable plan; PlanBuilder.finish() makes it.")
      .def_prop_ro("states", [](const FrozenPlan& p) { return p.view().states; })
      .def_prop_ro("columns", [](const FrozenPlan& p) { return p.view().columns; })
      .def_prop_ro("inputs", [](const FrozenPlan& p) { return p.view().inputs; })
      .def_prop_ro("charts", [](const FrozenPlan& p) { return p.view().charts; })
      .def_prop_ro("load_values", [](const FrozenPlan& p) { return p.view().load_values; })
      .def_prop_ro("input_constraints", [](const FrozenPlan& p) { return p.view().input_constraints; })
      .def_prop_ro("blocks", [](const FrozenPlan& p) { return p.view().blocks; })
      .def_prop_ro("equations", [](const FrozenPlan& p) {
        int count = 0;
        for (int b = 0; b < p.view().blocks; ++b) count += p.view().block[b].rows;
        return count;
      })
      .def_prop_ro("size", [](const FrozenPlan& p) { return p.view().size; })
      .def_prop_ro("constants", &constants_of<FrozenPlan>, nb::rv_policy::automatic)
      .def("with_constants", &with_constants<FrozenPlan>, "constants"_a)
      .def("with_size", &with_size, "size"_a)
      .def("assembly_size", &measured_size, "arguments"_a)
      .def("run", &run_plan, "arguments"_a)
      .def("run_precise", &run_precise, "arguments"_a)
      .def("balance", &balance_places, "arguments"_a)
      .def("search", &search, "arguments"_a);
  bind_outputs(m);
  m.def("available_processors", &available_processors);
}
