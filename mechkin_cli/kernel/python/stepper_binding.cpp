// Python's view of the stepper and of following rows.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "bindings.hpp"
#include "plan/frozen_plan.hpp"
#include "plan/same_layout.hpp"
#include "refusals.hpp"
#include "rows/run.hpp"
#include "rows/units.hpp"
#include "stepping/dimension_path.hpp"
#include "stepping/tracker.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using WrittenTable = nb::ndarray<nb::numpy, double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using WrittenColumn = nb::ndarray<nb::numpy, double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Vector = std::vector<double>;

constexpr int MOST_STEPS = 1000000;

// An array that is written overlaps no other one.
template <class Written, class Other>
void need_apart(const Written& a, const Other& b, const char* message) {
  const char* const one = reinterpret_cast<const char*>(a.data());
  const char* const other = reinterpret_cast<const char*>(b.data());
  need(!(one < other + b.nbytes() && other < one + a.nbytes()), message);
}
void need_length(const Vector& a, long length, const char* name) {
  need((long)a.size() == length, std::string(name) + ": wrong length");
}
double* table(const WrittenTable& a, long columns, long rows, const char* name) {
  need((long)a.shape(0) == columns && (long)a.shape(1) == rows, std::string(name) + ": wrong shape");
  return a.data();
}
// Single positions run on the narrowest unit, whose latency is the least.
const KernelUnit& narrow_unit() { return *kernel_unit(2); }

template <class List>
nb::object copied(const List& values) {
  double* data = new double[values.empty() ? 1 : values.size()];
  std::copy(values.begin(), values.end(), data);
  nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<1>>(data, {values.size()}, owner));
}

// A path whose points, and whose plan where that changes, come from Python functions. Where one raises there is no place
// from then on, nothing closes, and the call that asked raises once the stepper has come back.
class GivenPath : public Path {
 public:
  GivenPath(nb::object at, nb::object plan, bool varies)
      : at_(std::move(at)), plan_(std::move(plan)), varies_(varies), first_(varies ? plan_(0.0) : plan_) {
    plan_of(first_);
  }
  void at(double sigma, PathPoint* point) const override {
    const std::size_t n = (std::size_t)plan_of(first_).inputs;
    if (!raised_ && asked([&] { ask(sigma, (long)n, point); })) return;
    point->inputs.assign(n, std::numeric_limits<double>::quiet_NaN());
    point->first.assign(n, 0.0), point->second.assign(n, 0.0);
  }
  const Plan& plan(double sigma) const override {
    const bool begins = !current_.is_valid();  // with the plan that is there already
    if (begins) current_ = first_;
    if (!varies_ || begins || raised_) return plan_of(first_);
    const Plan* found = &plan_of(first_);
    asked([&] {
      current_ = plan_(sigma);
      const Plan& p = plan_of(current_);
      need(same_layout(p, plan_of(first_)), "the plans of a path must have one structure");
      found = &p;
    });
    return *found;
  }
  // What a function raised since the last time.
  void raise() const {
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
  }
  bool varies() const override { return varies_; }

  int traverse(visitproc visit, void* arg) const {
    for (PyObject* held : {at_.ptr(), plan_.ptr(), first_.ptr(), current_.ptr()}) Py_VISIT(held);
    return 0;
  }
  // The functions alone: plans hold nothing of Python's, and the stepper reads the first one's structure.
  void clear() {
    at_ = nb::none();
    if (varies_) plan_ = nb::none();
  }

 private:
  void ask(double sigma, long inputs, PathPoint* point) const {
    const nb::object found = at_(sigma);
    std::tuple<Vector, Vector, Vector> numbers;
    if (!nb::try_cast(found, numbers)) throw nb::type_error("at: does not give three lists of numbers");
    std::tie(point->inputs, point->first, point->second) = std::move(numbers);
    need_length(point->inputs, inputs, "the path's inputs");
    need_length(point->first, inputs, "the path's first derivatives");
    need_length(point->second, inputs, "the path's second derivatives");
  }
  template <class Question>
  bool asked(const Question& question) const {
    try {
      question();
    } catch (...) {
      raised_ = std::current_exception();
    }
    return !raised_;
  }
  static const Plan& plan_of(const nb::object& object) {
    const FrozenPlan* plan = nullptr;
    if (!nb::try_cast(object, plan, false) || !plan) throw nb::type_error("plan: not a Plan, or none at this sigma");
    return plan->view();
  }

  nb::object at_, plan_;
  bool varies_;
  nb::object first_;
  mutable nb::object current_;
  mutable std::exception_ptr raised_;
};

// A stepper that owns its path and limits. A straight path keeps its numbers here.
struct OwnedStepper {
  Vector x0, u;
  std::unique_ptr<Path> path;
  StepLimits limits;
  std::unique_ptr<Stepper> stepper;
  GivenPath* given = nullptr;  // the path, where it is one of Python's
  bool busy = false;           // in a call that may ask Python for the path
};

// A path's functions may call anything, from any thread, but not the stepper that waits for them. The flag needs no
// more than Python's lock, which is held wherever it is read.
class Turn {
 public:
  explicit Turn(OwnedStepper& s) : stepper_(s) {
    need(!s.busy, "the stepper is in a call; a path's functions cannot use the stepper that asks them");
    s.busy = true;
  }
  ~Turn() { stepper_.busy = false; }
  void end() const {
    if (stepper_.given) stepper_.given->raise();
  }

 private:
  OwnedStepper& stepper_;
};

// Python's collector of cycles: a path's functions may well hold their stepper.
int traverse_stepper(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  const OwnedStepper* const s = nb::inst_ptr<OwnedStepper>(self);
  return s->given ? s->given->traverse(visit, arg) : 0;
}
int clear_stepper(PyObject* self) {
  if (!nb::inst_ready(self)) return 0;
  OwnedStepper* const s = nb::inst_ptr<OwnedStepper>(self);
  if (s->given) s->given->clear();
  return 0;
}
const PyType_Slot STEPPER_SLOTS[] = {
    {Py_tp_traverse, (void*)traverse_stepper}, {Py_tp_clear, (void*)clear_stepper}, {0, nullptr}};

std::unique_ptr<OwnedStepper> straight(const FrozenPlan& store, Vector inputs, Vector direction, StepLimits limits) {
  const Plan& plan = store.view();
  need_length(inputs, plan.inputs, "inputs");
  need_length(direction, plan.inputs, "direction");
  auto s = std::make_unique<OwnedStepper>();
  s->x0 = std::move(inputs), s->u = std::move(direction), s->limits = limits;
  s->path = std::make_unique<Line>(plan, s->x0.data(), s->u.data());
  s->stepper = std::make_unique<Stepper>(*s->path, narrow_unit(), s->limits);
  return s;
}

std::unique_ptr<OwnedStepper> along(nb::object plan, nb::object at, bool varies, StepLimits limits) {
  const auto need_function = [](const nb::object& given, const char* message) {
    if (!PyCallable_Check(given.ptr())) throw nb::type_error(message);
  };
  need_function(at, "at: not a function");
  if (varies) need_function(plan, "plan: not a function, though it varies");
  auto s = std::make_unique<OwnedStepper>();
  s->limits = limits;
  auto path = std::make_unique<GivenPath>(std::move(at), std::move(plan), varies);
  s->given = path.get();
  s->path = std::move(path);
  s->stepper = std::make_unique<Stepper>(*s->path, narrow_unit(), s->limits);
  return s;
}

std::optional<Node> close_at(OwnedStepper& s, double sigma, const Vector& guess) {
  need_length(guess, s.stepper->plan().states, "guess");
  const Turn turn(s);
  FloatingPointState state;
  Node node;
  const bool closes = s.stepper->close(sigma, guess.data(), &node);
  turn.end();
  return closes ? std::optional<Node>(node) : std::nullopt;
}

void need_node(const OwnedStepper& s, const Node& node) {
  const Stepper& stepper = *s.stepper;
  const Plan& p = stepper.plan();
  const auto has = [](const auto& values, long count) { return (long)values.size() == count; };
  need(has(node.state, p.states) && has(node.state_first, p.states) && has(node.state_second, p.states) &&
           has(node.first, p.columns) && has(node.second, p.columns) && has(node.side, p.blocks) &&
           has(node.pivot, p.blocks) && has(node.jacobian, stepper.jacobian_entries()) &&
           has(node.danger, p.blocks) && has(node.turn, stepper.turn_slots()),
       "the node is of another plan");
}

std::optional<Node> step_from(OwnedStepper& s, const Node& node, double h) {
  need_node(s, node);
  const Turn turn(s);
  FloatingPointState state;
  Node next;
  const bool taken = s.stepper->step(node, h, &next);
  turn.end();
  if (!taken) return std::nullopt;
  continue_turns(*s.stepper, node, &next);
  return next;
}

std::optional<Node> to_target(OwnedStepper& s, const Vector& start) {
  need_length(start, s.stepper->plan().states, "start");
  const Turn turn(s);
  FloatingPointState state;
  Node node;
  const bool reached = follow_to_target(*s.stepper, start.data(), &node);
  turn.end();
  return reached ? std::optional<Node>(node) : std::nullopt;
}

// (kind, block, inputs, states, derivatives of the columns by arclength, second ones, sigma's second; inputs and states
// of a place beyond), or None.
nb::object limit_of(const Followed& found) {
  const Limit& limit = found.limit;
  if (limit.kind != PassageEnd::dead_centre && limit.kind != PassageEnd::branch_point) return nb::none();
  const Node &at = limit.at, &beyond = limit.beyond;
  return nb::make_tuple((int)limit.kind, limit.block, copied(at.inputs), copied(at.state), copied(at.first),
                        copied(at.second), at.bend, copied(beyond.inputs), copied(beyond.state));
}

// Rows from `begin` on, which nothing has reached, are no numbers.
void forget(const RowGuesses& out, long states, long slots, long begin) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const long rows = out.rows - begin;
  if (rows <= 0) return;
  for (long s = 0; s < states; ++s) std::fill_n(out.guess + s * out.rows + begin, rows, nothing);
  for (long s = 0; out.turn && s < slots; ++s) std::fill_n(out.turn + s * out.rows + begin, rows, nothing);
  std::fill_n(out.limit + begin, rows, nothing);
}

nb::tuple follow_table(const FrozenPlan& store, WrittenTable inputs, std::optional<WrittenTable> whole, const Vector& start,
                       const Vector& turn, bool every_row, const StepLimits& limits, WrittenTable guess, WrittenColumn limit,
                       std::optional<WrittenTable> turns, const Course* course) {
  const Plan& plan = store.view();
  const long rows = (long)inputs.shape(1);
  need(rows > 0, "inputs: no rows");
  table(inputs, plan.inputs, rows, "inputs");
  const double* const turned = whole ? table(*whole, plan.inputs, rows, "whole") : nullptr;
  need(!turned || are_whole_turns(turned, plan.inputs * rows), "whole: numbers of turns");
  need_length(start, plan.states, "start");
  need((long)limit.shape(0) == rows, "limit: wrong length");
  const long slots = turn_slots(plan, narrow_unit());
  if (!turn.empty()) need_length(turn, slots, "turn");
  if (course) need(course->rows() == rows && course->inputs() <= plan.inputs, "course: of other rows or inputs");
  const RowGuesses out = {rows, table(guess, plan.states, rows, "guess"), limit.data(),
                          turns ? table(*turns, slots, rows, "turns") : nullptr};
  const char* const shared = "guess, limit and turns share no memory with one another or with inputs";
  need_apart(guess, inputs, shared), need_apart(limit, inputs, shared), need_apart(guess, limit, shared);
  if (whole) need_apart(guess, *whole, shared), need_apart(limit, *whole, shared);
  if (turns && whole) need_apart(*turns, *whole, shared);
  if (turns) need_apart(*turns, inputs, shared), need_apart(*turns, guess, shared), need_apart(*turns, limit, shared);
  Followed found;
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    found = follow_rows(plan, narrow_unit(), inputs.data(), turned, start.data(), turn, every_row, limits, out, course);
    forget(out, plan.states, slots, found.reached);
  }
  nb::list crossings;
  for (std::size_t k = 0; k < found.crossings.size(); ++k)
    crossings.append(nb::make_tuple(found.crossed_before[k], copied(found.crossings[k])));
  return nb::make_tuple((int)found.end, found.reached, found.steps, found.rejected, copied(found.inputs),
                        copied(found.state), copied(found.turn), copied(found.direction), limit_of(found), crossings,
                        found.piece, found.parameter);
}

nb::list turn_table(const FrozenPlan& store) {
  nb::list list;
  for (const ClosingTurn& t : closing_turns(store.view(), narrow_unit()))
    list.append(nb::make_tuple(t.closing, t.freedom, t.slot, t.width));
  return list;
}

// State and slot of each angle of the tree whose whole turns are counted.
nb::list tree_turn_table(const FrozenPlan& store) {
  nb::list list;
  for (const TreeTurn& t : tree_turns(store.view(), narrow_unit())) list.append(nb::make_tuple(t.state, t.slot));
  return list;
}

template <auto Member>
nb::object member(const Node& node) {
  return copied(node.*Member);
}

}  // namespace

void bind_stepper(nb::module_& m) {
  nb::class_<StepLimits>(m, "StepLimits")
      .def("__init__",
           [](StepLimits* at, double turn_cosine, double turn, double bend, double jump, double infill,
              double longest_step, double least_step, int most_steps, double tight, double coarse, double accept,
              double pivot, int iterations, double same_line, double knot, double corner_cosine, double stray,
              double angle_step, double angle_miss, double angle_bend, double plan_step, double arc_pivot, double radius, double narrow,
              int arc_steps, double arc_work, bool straight) {
             for (double cosine : {turn_cosine, corner_cosine})
               need(cosine >= -1.0 && cosine <= 1.0, "limits: a cosine is a number from -1 to 1");
             for (double limit : {turn, bend, jump, infill, longest_step, least_step, tight, coarse, accept, pivot,
                                  same_line, knot, stray, angle_step, angle_miss, angle_bend, plan_step, arc_pivot,
                                  radius, narrow, arc_work})
               need(limit >= 0.0, "limits: a limit is a number from 0 on");
             need(most_steps >= 0 && most_steps <= MOST_STEPS, "limits: 0 to 1000000 steps");
             need(iterations >= 0 && iterations <= MOST_ITERATIONS, "limits: 0 to 10000 iterations");
             need(arc_steps >= 0 && arc_steps <= MOST_STEPS, "limits: 0 to 1000000 steps of an arc");
             StepLimits limits = {};
             limits.turn_cosine = turn_cosine, limits.turn = turn, limits.bend = bend, limits.jump = jump;
             limits.infill = infill, limits.longest_step = longest_step, limits.least_step = least_step;
             limits.most_steps = most_steps, limits.tight = tight, limits.coarse = coarse, limits.accept = accept;
             limits.pivot = pivot, limits.arc_pivot = arc_pivot, limits.radius = radius, limits.narrow = narrow, limits.arc_steps = arc_steps, limits.arc_work = arc_work;
             limits.straight = straight;
             limits.iterations = iterations, limits.same_line = same_line, limits.knot = knot;
             limits.corner_cosine = corner_cosine, limits.stray = stray, limits.angle_step = angle_step;
             limits.angle_miss = angle_miss, limits.angle_bend = angle_bend, limits.plan_step = plan_step;
             new (at) StepLimits(limits);
           },
           nb::kw_only(), "turn_cosine"_a, "turn"_a, "bend"_a, "jump"_a, "infill"_a, "longest_step"_a, "least_step"_a,
           "most_steps"_a, "tight"_a, "coarse"_a, "accept"_a, "pivot"_a, "iterations"_a, "same_line"_a, "knot"_a,
           "corner_cosine"_a, "stray"_a, "angle_step"_a, "angle_miss"_a, "angle_bend"_a, "plan_step"_a, "arc_pivot"_a, "radius"_a, "narrow"_a,
           "arc_steps"_a, "arc_work"_a, "straight"_a);

  nb::class_<Node>(m, "Node")
      .def_ro("sigma", &Node::sigma)
      .def_ro("correction", &Node::correction)
      .def_prop_ro("inputs", &member<&Node::inputs>)
      .def_prop_ro("state", &member<&Node::state>)
      .def_prop_ro("first", &member<&Node::first>)
      .def_prop_ro("second", &member<&Node::second>)
      .def_prop_ro("side", &member<&Node::side>)
      .def_prop_ro("pivot", &member<&Node::pivot>)
      .def_prop_ro("jacobian", &member<&Node::jacobian>)
      .def_prop_ro("turn", &member<&Node::turn>);

  nb::class_<OwnedStepper>(m, "Stepper", nb::type_slots(STEPPER_SLOTS))
      .def_static("straight", &straight, "plan"_a, "inputs"_a, "direction"_a, "limits"_a, nb::keep_alive<0, 1>())
      .def_static("along", &along, "plan"_a, "at"_a, "varies"_a, "limits"_a)
      .def("close", &close_at, "sigma"_a, "guess"_a)
      .def("predict", [](const OwnedStepper& s, const Node& node, double h) {
             need_node(s, node);
             Vector guess;
             s.stepper->predict(node, h, &guess);
             return copied(guess);
           }, "node"_a, "h"_a)
      .def("judge", [](OwnedStepper& s, const Node& a, Node& b) {
             need_node(s, a), need_node(s, b);
             const Turn turn(s);
             FloatingPointState state;
             const bool is_on_branch = s.stepper->judge(a, &b);
             turn.end();
             return is_on_branch;
           }, "a"_a, "b"_a)
      .def("step", &step_from, "node"_a, "h"_a)
      .def("to_target", &to_target, "start"_a)
      .def("wanted_step", [](const OwnedStepper& s, const Node& node) {
             need_node(s, node);
             return s.stepper->wanted_step(node);
           }, "node"_a);

  m.attr("MOST_PATH_STEPS") = MOST_PATH_STEPS;
  m.def("closing_turns", &turn_table, "plan"_a);
  m.def("tree_turns", &tree_turn_table, "plan"_a);
  m.def("follow_rows", &follow_table, "plan"_a, "inputs"_a, "whole"_a.none(), "start"_a, "turn"_a, "every_row"_a,
        "limits"_a, "guess"_a, "limit"_a, "turns"_a.none(), "course"_a.none() = nb::none());
}
