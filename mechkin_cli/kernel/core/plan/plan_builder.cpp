#include "plan/plan_builder.hpp"

#include <cmath>
#include <cstring>

#include "plan/output_list.hpp"
#include "rows/units.hpp"

namespace {

const TreeType& tree_type(int code) { return kernel_unit()->tree_types[code]; }

bool is_sign(double sign) { return sign == 1.0 || sign == -1.0; }
constexpr char NO_SIGN[] = "a sign is 1 or -1";

bool is_finite(double x) { return std::isfinite(x); }
template <std::size_t N>
bool is_finite(const std::array<double, N>& numbers) {
  return all_finite(numbers.data(), N);
}
template <class... Numbers>
Refusal check_finite(const Numbers&... numbers) {
  REQUIRE((is_finite(numbers) && ...), "a plan's numbers must be finite");
  return {};
}

void copy(const Triple& from, double* to) { std::memcpy(to, from.data(), sizeof from); }

Frame frame(const FrameData& f) {
  Frame r;
  std::memcpy(&r, f.data(), sizeof r);
  return r;
}

bool along_coordinate(int type) {
  return type == LOAD_COORDINATE || type == LOAD_COORDINATE_SPRING || type == LOAD_COORDINATE_DAMPER;
}

// The next knots of a list of five numbers each; fewer where it ends.
std::vector<Knot> take_knots(const std::vector<double>& numbers, int count, std::size_t* used) {
  std::vector<Knot> knots;
  for (; count > 0 && *used + 5 <= numbers.size(); --count, *used += 5) {
    const double* const n = &numbers[*used];
    knots.push_back({n[0], n[1], n[2], n[3], n[4]});
  }
  return knots;
}
constexpr char NO_KNOTS[] = "five numbers a knot, as many knots as the curves have";

bool is_carriage(int type) { return type == TREE_G || type == TREE_A; }

}  // namespace

Result<PlanBuilder> PlanBuilder::make(double length, const Triple& origin, double size) {
  CHECK(check_finite(length, size, origin));
  REQUIRE(length > 0 && size > 0, "length unit and size must be positive");
  return PlanBuilder(length, origin, size);
}

PlanBuilder::PlanBuilder(double length, const Triple& origin, double size) {
  plan_.length = length;
  plan_.size = size;
  copy(origin, plan_.origin);
  number(ARRAY_PLAN, in_plan(&plan_.length), 1);
  number(ARRAY_PLAN, in_plan(plan_.origin), 3);
  number(ARRAY_PLAN, in_plan(&plan_.size), 1);
}

Refusal PlanBuilder::open() const {
  REQUIRE(!spent_, "the plan is finished, and its builder spent");
  return {};
}

// Bytes from the plan's beginning to one of its numbers.
std::size_t PlanBuilder::in_plan(const double* number) const {
  return (std::size_t)(reinterpret_cast<const char*>(number) - reinterpret_cast<const char*>(&plan_));
}

void PlanBuilder::number(int array, std::size_t offset, int count) {
  for (int i = 0; i < count; ++i) constants_.push_back({array, offset + i * sizeof(double)});
}

Refusal PlanBuilder::check_link(int link) const {
  REQUIRE(link >= -1 && link < (int)joints_.size(), "unknown link");
  return {};
}

Refusal PlanBuilder::check_joint(int joint, const char* message) const {
  REQUIRE(joint >= 0 && joint < (int)joints_.size(), message);
  return {};
}

Refusal PlanBuilder::add_tree_joint(int type, int parent, double pitch, const FrameData& at) {
  CHECK(open());
  REQUIRE(type >= 0 && type < TREE_CODES, "unknown displacement");
  CHECK(check_finite(pitch, at));
  const int k = (int)joints_.size();
  REQUIRE(parent >= -1 && parent < k, "a tree joint's parent must come before it");
  const int state = plan_.states, column = plan_.columns;
  joints_.push_back({type, parent, state, column, pitch, -1, -1, frame(at)});
  number(ARRAY_JOINT, k * sizeof(TreeJoint) + offsetof(TreeJoint, pitch), 1);
  number(ARRAY_JOINT, k * sizeof(TreeJoint) + offsetof(TreeJoint, at), 12);
  for (int f = 0; f < tree_type(type).freedoms; ++f) {
    column_state_.push_back(type == TREE_S ? -1 : state + f);
    column_joint_.push_back(k);
    column_weight_.push_back(1.0);
    column_block_.push_back(-1);
    column_place_.push_back(-1);
  }
  plan_.states += tree_type(type).states;
  plan_.columns += tree_type(type).freedoms;
  inertia_.push_back({});
  placed_by_.push_back(NOT_PLACED);
  return {};
}

Refusal PlanBuilder::add_closing_joint(int type, int first, int second, const FrameData& on_first,
                                    const FrameData& on_second, double parameter, const Loop& loop) {
  CHECK(open());
  REQUIRE(type > PAIR_DISTANCE && !is_relation(type) && type < kernel_unit()->pair_codes, "this pair cannot close a loop");
  CHECK(check_link(first));
  CHECK(check_link(second));
  CHECK(check_finite(on_first, on_second, parameter));
  CHECK(check_loop(loop));
  const auto [begin, end] = add_loop(loop);
  const std::size_t at = closing_.size() * sizeof(ClosingJoint);
  closing_.push_back({type, first, second, frame(on_first), frame(on_second), parameter, -1, 0.0, 0, begin, end, 0, 0, 0, 0, 0, 0, 0, 0});
  number(ARRAY_CLOSING, at + offsetof(ClosingJoint, on_first), 12);
  number(ARRAY_CLOSING, at + offsetof(ClosingJoint, on_second), 12);
  number(ARRAY_CLOSING, at + offsetof(ClosingJoint, parameter), 1);
  return {};
}

Refusal PlanBuilder::check_loop(const Loop& loop) const {
  for (const auto& [joint, sign] : loop) {
    CHECK(check_joint(joint, "loop through an unknown joint"));
    REQUIRE(is_sign(sign), NO_SIGN);
  }
  return {};
}

std::pair<int, int> PlanBuilder::add_loop(const Loop& loop) {
  const int begin = (int)loop_.size();
  for (const auto& [joint, sign] : loop) loop_.push_back({joint, sign, -1});
  return {begin, (int)loop_.size()};
}

Result<int> PlanBuilder::add_function(int arguments, const std::vector<FunctionCurveTuple>& curves,
                                      const std::vector<double>& knots, const std::vector<double>& constants,
                                      const std::vector<int>& operations,
                                      const std::vector<std::array<int, 3>>& operands,
                                      const std::vector<int>& instructions, const std::vector<int>& outputs,
                                      const std::vector<int>& output_ends) {
  CHECK(open());
  FunctionRecord record = {arguments, {}, constants, {}, {}, instructions, {outputs.begin(), outputs.end()}, output_ends};
  std::size_t used = 0;
  for (const auto& [over, repeats, count] : curves) {
    record.curves.push_back({over, repeats, take_knots(knots, count, &used)});
    REQUIRE((int)record.curves.back().knots.size() == count, NO_KNOTS);
  }
  REQUIRE(used == knots.size(), NO_KNOTS);
  for (int o : operations) {
    REQUIRE(o >= 0 && o <= 255, "unknown operation");
    record.operations.push_back((std::uint8_t)o);
  }
  for (const auto& [a, b, c] : operands) record.operands.insert(record.operands.end(), {a, b, c});
  const int first = functions_.view().constants, first_knot = functions_.view().knots;
  Result<int> added = functions_.add(record);
  CHECK(added.refusal());
  number(ARRAY_FUNCTION_KNOT, first_knot * sizeof(Knot), (int)knots.size());
  number(ARRAY_FUNCTION_CONSTANT, first * sizeof(double), (int)constants.size());
  return added;
}

Refusal PlanBuilder::add_relation(bool length, const std::vector<TermTuple>& terms, const std::vector<double>& factors,
                                  const std::vector<double>& arguments, double sum) {
  CHECK(open());
  REQUIRE(!terms.empty() && terms.size() == factors.size() && terms.size() == arguments.size(),
          "a relation has terms, each with a factor and an argument");
  CHECK(check_finite(sum));
  REQUIRE(all_finite(factors.data(), factors.size()) && all_finite(arguments.data(), arguments.size()),
          "a plan's numbers must be finite");
  for (std::size_t k = 0; k < terms.size(); ++k)
    for (std::size_t other = 0; other < k; ++other)
      REQUIRE(std::get<0>(terms[k]) != std::get<0>(terms[other]) || std::get<2>(terms[k]) < 0 ||
                  std::get<2>(terms[k]) != std::get<2>(terms[other]), "a relation has one term of a freedom");
  for (const auto& [joint, sign, freedom, axis, function] : terms) {
    CHECK(check_joint(joint, "a relation of an unknown joint"));
    REQUIRE(function == -1 || (function >= 0 && function < functions_.view().functions), "a term of an unknown function");
    REQUIRE(function == -1 || functions_.has_shape(function, 1, 1), "a term is a function of its coordinate alone");
    REQUIRE(is_sign(sign), NO_SIGN);
    const TreeType& tree = tree_type(joints_[joint].type);
    REQUIRE(freedom == -1 || (freedom >= 0 && freedom < tree.freedoms && tree.states == tree.freedoms),
            "a relation is between coordinates");
    REQUIRE(axis >= 0, "a relation's coordinates have axes");
  }
  // a column of a relation is that of the last entry of its tree joint
  for (std::size_t k = 1; k < terms.size(); ++k)
    REQUIRE(std::get<2>(terms[k]) >= 0 || std::get<2>(terms[k - 1]) < 0, "parts that a relation only leads through come first");
  const int begin = (int)loop_.size(), first_term = (int)term_.size();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto& [joint, sign, freedom, axis, function] = terms[k];
    loop_.push_back({joint, sign, (int)term_.size()});
    term_.push_back({freedom, axis, factors[k], function, arguments[k]});
  }
  for (std::size_t part : {offsetof(Term, factor), offsetof(Term, argument)})
    for (int t = first_term; t < (int)term_.size(); ++t) number(ARRAY_TERM, t * sizeof(Term) + part, 1);
  const std::size_t at = closing_.size() * sizeof(ClosingJoint);
  const Frame none = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}};
  const int type = length ? RELATION_OF_LENGTHS : RELATION_OF_ANGLES;
  closing_.push_back({type, -1, -1, none, none, sum, -1, 0.0, 0, begin, (int)loop_.size(), 0, 0, 0, 0, 0, 0, 0, 0});
  number(ARRAY_CLOSING, at + offsetof(ClosingJoint, parameter), 1);
  return {};
}

Refusal PlanBuilder::add_mesh(int carrier, const Triple& point, const Triple& along, const Triple& apart, const Loop& path) {
  CHECK(open());
  REQUIRE(!closing_.empty() && is_relation(closing_.back().type) && closing_.back().path_end == 0, "a relation acts by one force");
  CHECK(check_link(carrier));
  CHECK(check_finite(point, along, apart));
  CHECK(check_loop(path));
  REQUIRE(!path.empty(), "a force acts between two links");
  ClosingJoint& j = closing_.back();
  j.first = carrier;
  copy(point, j.on_first.o), copy(along, j.on_first.x), copy(apart, j.on_first.y);
  std::tie(j.path_begin, j.path_end) = add_loop(path);
  number_force(offsetof(ClosingJoint, on_first));
  return {};
}

Refusal PlanBuilder::add_force(const Triple& point, const Triple& along, const Triple& apart) {
  CHECK(open());
  REQUIRE(!closing_.empty() && closing_.back().path_end > 0 && !closing_.back().is_pair_of_forces,
          "a relation acts by two forces at most, the first with its way");
  CHECK(check_finite(point, along, apart));
  ClosingJoint& j = closing_.back();
  j.is_pair_of_forces = 1;
  copy(point, j.on_second.o), copy(along, j.on_second.x), copy(apart, j.on_second.y);
  number_force(offsetof(ClosingJoint, on_second));
  return {};
}

// The constants of the last relation's force in the frame at `frame`.
void PlanBuilder::number_force(std::size_t frame) {
  const std::size_t at = (closing_.size() - 1) * sizeof(ClosingJoint) + frame;
  for (std::size_t part : {offsetof(Frame, o), offsetof(Frame, x), offsetof(Frame, y)}) number(ARRAY_CLOSING, at + part, 3);
}

Refusal PlanBuilder::add_hung_links(int body, int rod, int first, int second, const FrameData& on_first,
                          const FrameData& on_second, double length, const Triple& line, double slide_sign,
                          const Loop& loop) {
  CHECK(open());
  CHECK(check_joint(body, "unknown hung body"));
  REQUIRE(joints_[body].type == TREE_L && joints_[body].hung < 0, "a hung body hangs by a TREE_L of its own");
  REQUIRE(joints_[body].parent == first && second >= -1 && second < body, "a hung body comes after its ends");
  REQUIRE(rod == -1 || (rod > body && rod < (int)joints_.size() && joints_[rod].type == TREE_P &&
                        joints_[rod].parent == body), "a hung body's rod slides on its body");
  CHECK(check_finite(on_first, on_second, length, line));
  REQUIRE(rod == -1 || slide_sign == 1.0 || slide_sign == -1.0, "the sign of a hung body's slide is 1 or -1");
  CHECK(check_finite(slide_sign));
  CHECK(check_loop(loop));
  const auto [begin, end] = add_loop(loop);
  HungBody hung = {body, rod, first, second, (int)closing_.size(), {}, {}};
  const Frame at_end = frame(on_second);
  std::memcpy(hung.point, at_end.o, sizeof hung.point);
  copy(line, hung.line);
  joints_[body].hung = (int)hung_.size();
  const std::size_t at = closing_.size() * sizeof(ClosingJoint), hung_at = hung_.size() * sizeof(HungBody);
  hung_.push_back(hung);
  closing_.push_back({PAIR_DISTANCE, first, second, frame(on_first), at_end, length, rod, slide_sign, 0, begin, end, 0, 0, 0, 0, 0, 0, 0, 0});
  number(ARRAY_CLOSING, at + offsetof(ClosingJoint, on_first), 12);
  const int end_point = (int)constants_.size() + 9;
  number(ARRAY_CLOSING, at + offsetof(ClosingJoint, on_second), 12);
  for (int i = 0; i < 3; ++i)
    repeated_.push_back({end_point + i, {ARRAY_HUNG_BODY, hung_at + offsetof(HungBody, point) + i * sizeof(double)}});
  number(ARRAY_CLOSING, at + offsetof(ClosingJoint, parameter), 1);
  number(ARRAY_HUNG_BODY, hung_at + offsetof(HungBody, line), 3);
  return {};
}

Result<int> PlanBuilder::add_place(int reference, int first, int second, int point_on, const Triple& point, double sign) {
  CHECK(open());
  REQUIRE(reference >= -(int)closing_.size() && reference < (int)joints_.size(), "unknown joint reference");
  CHECK(check_link(first));
  CHECK(check_link(second));
  CHECK(check_link(point_on));
  CHECK(check_finite(point));
  REQUIRE(is_sign(sign), NO_SIGN);
  JointPlace place = {reference, first, second, point_on, {}, sign, 0, 0, 0, 0};
  copy(point, place.point);
  number(ARRAY_PLACE, place_.size() * sizeof(JointPlace) + offsetof(JointPlace, point), 3);
  place_.push_back(place);
  return (int)place_.size() - 1;
}

Result<int> PlanBuilder::add_axis(int place, bool slide, int link, const Triple& vector, int other,
                          const Triple& other_vector) {
  CHECK(open());
  REQUIRE(place >= 0 && place < (int)place_.size(), "axis of an unknown joint");
  CHECK(check_link(link));
  CHECK(check_link(other));
  CHECK(check_finite(vector, other_vector));
  CoordinateAxis axis = {place, slide, {link, other}, {}, -1, 0};
  copy(vector, axis.vector[0]);
  copy(other_vector, axis.vector[1]);
  number(ARRAY_AXIS, axis_.size() * sizeof(CoordinateAxis) + offsetof(CoordinateAxis, vector), 6);
  axis_.push_back(axis);
  return (int)axis_.size() - 1;
}

Refusal PlanBuilder::set_course(int joint, int function, const std::vector<int>& axes) {
  CHECK(open());
  CHECK(check_joint(joint, "a course of an unknown joint"));
  REQUIRE(is_carriage(joints_[joint].type) && joints_[joint].function < 0, "a course is set once, of a joint that needs it");
  REQUIRE(function >= 0 && function < functions_.view().functions, "a course along an unknown function");
  const int parameters = tree_type(joints_[joint].type).freedoms;
  REQUIRE(functions_.has_shape(function, parameters, 3), "a course is a place by the joint's freedoms");
  REQUIRE(axes.empty() || (int)axes.size() == parameters, "each parameter has its axis");
  for (int a : axes) REQUIRE(a >= 0 && a < (int)axis_.size(), "a parameter's axis is none");
  joints_[joint].function = function;
  for (int f = 0; f < (int)axes.size(); ++f) axis_[axes[f]].carrier = joint, axis_[axes[f]].freedom = f;
  return {};
}

Refusal PlanBuilder::add_free_motion(int place, bool slide, int code, int link, const Triple& vector) {
  CHECK(open());
  REQUIRE(place >= 0 && place < (int)place_.size(), "free motion of an unknown joint");
  REQUIRE(code >= 0 && code < FREE_CODES, "unknown kind of free motion");
  CHECK(check_link(link));
  CHECK(check_finite(vector));
  JointPlace& at = place_[place];
  const int next = (int)free_.size();
  REQUIRE(at.free_begin == at.free_end || at.free_end == next, "the free motions of a joint stand in a row");
  if (at.free_begin == at.free_end) at.free_begin = next;
  at.free_end = next + 1;
  FreeMotion free = {place, slide, code, link, {}};
  copy(vector, free.vector);
  number(ARRAY_FREE, next * sizeof(FreeMotion) + offsetof(FreeMotion, vector), 3);
  free_.push_back(free);
  return {};
}

Refusal PlanBuilder::add_input(int column, int axis, double scale) {
  CHECK(open());
  REQUIRE(column >= 0 && column < plan_.columns && column_state_[column] >= 0, "an input must be a scalar coordinate");
  REQUIRE(axis >= -1 && axis < (int)axis_.size(), "unknown axis");
  CHECK(check_finite(scale));
  for (int c : input_column_) REQUIRE(c != column, "a column is an input once");
  number(ARRAY_DRIVE, drive_.size() * sizeof(Drive) + offsetof(Drive, scale), 1);
  drive_.push_back({(int)input_column_.size(), axis, scale});
  input_column_.push_back(column);
  return {};
}

Refusal PlanBuilder::set_inertia(int link, double mass, const Triple& centre, const std::array<double, 6>& tensor) {
  CHECK(open());
  CHECK(check_joint(link, "inertia of an unknown link"));
  CHECK(check_finite(mass, centre, tensor));
  LinkInertia& m = inertia_[link];
  REQUIRE(!m.present, "a link's inertia is set once");
  m.present = 1;
  m.mass = mass;
  copy(centre, m.centre);
  std::memcpy(m.tensor, tensor.data(), sizeof m.tensor);
  const std::size_t at = link * sizeof(LinkInertia);
  number(ARRAY_INERTIA, at + offsetof(LinkInertia, mass), 1);
  number(ARRAY_INERTIA, at + offsetof(LinkInertia, centre), 3);
  number(ARRAY_INERTIA, at + offsetof(LinkInertia, tensor), 6);
  return {};
}

Refusal PlanBuilder::set_gravity(const Triple& g) {
  CHECK(open());
  CHECK(check_finite(g));
  REQUIRE(!gravity_, "gravity is set once");
  gravity_ = true;
  copy(g, plan_.gravity);
  number(ARRAY_PLAN, in_plan(plan_.gravity), 3);
  return {};
}

Refusal PlanBuilder::check_load(int type, int link, int other, int freedom, bool varying) const {
  REQUIRE(type >= 0 && type <= LOAD_COORDINATE_DAMPER, "unknown kind of load");
  REQUIRE(!varying || type <= LOAD_COORDINATE, "springs and dampers vary by themselves");
  if (!along_coordinate(type)) {
    CHECK(check_link(link));
    CHECK(check_link(other));
    REQUIRE(link >= 0 || type == LOAD_SPRING || type == LOAD_DAMPER, "a load on ground moves nothing");
    REQUIRE(freedom == 0, "only a load along a coordinate has a freedom");
    return {};
  }
  REQUIRE(link >= 0 && link < (int)axis_.size(), "load along an unknown axis");
  REQUIRE(other >= -(int)closing_.size() && other < (int)joints_.size(), "load on an unknown joint");
  if (other < 0) {
    return check_closing_coordinate(arrays(), -1 - other, freedom);
  }
  const int of = joints_[other].type;
  REQUIRE(of != TREE_S && freedom >= 0 && freedom < tree_type(of).freedoms, "load along an unknown coordinate");
  return {};
}

Refusal PlanBuilder::add_load(int type, int link, int other, int freedom, const Triple& point, const Triple& other_point,
                           const Triple& vector, bool varying) {
  CHECK(open());
  CHECK(check_load(type, link, other, freedom, varying));
  CHECK(check_finite(point, other_point, vector));
  Load l = {type, link, other, freedom, {}, {}, {}, varying ? plan_.load_values : -1, -1};
  if (varying) plan_.load_values += type == LOAD_COORDINATE ? 1 : 3;
  copy(point, l.point);
  copy(other_point, l.other_point);
  copy(vector, l.vector);
  const std::size_t at = load_.size() * sizeof(Load);
  load_.push_back(l);
  number(ARRAY_LOAD, at + offsetof(Load, point), 3);
  number(ARRAY_LOAD, at + offsetof(Load, other_point), 3);
  number(ARRAY_LOAD, at + offsetof(Load, vector), 3);
  return {};
}

Refusal PlanBuilder::add_bushing(bool damps, int first, int second, const FrameData& on_first, const FrameData& on_second,
                                 const std::array<double, 21>& matrix, const std::array<double, 6>& free) {
  CHECK(open());
  CHECK(check_link(first));
  CHECK(check_link(second));
  CHECK(check_finite(on_first, on_second, matrix, free));
  const std::size_t at = bushing_.size() * sizeof(Bushing);
  load_.push_back({damps ? LOAD_BUSHING_DAMPER : LOAD_BUSHING, first, second, (int)bushing_.size(), {}, {}, {}, -1, -1});
  Bushing b = {frame(on_first), frame(on_second), {}, {}};
  std::memcpy(b.matrix, matrix.data(), sizeof b.matrix);
  std::memcpy(b.free, free.data(), sizeof b.free);
  bushing_.push_back(b);
  number(ARRAY_BUSHING, at + offsetof(Bushing, on_first), 12);
  number(ARRAY_BUSHING, at + offsetof(Bushing, on_second), 12);
  number(ARRAY_BUSHING, at + offsetof(Bushing, matrix), 21);
  number(ARRAY_BUSHING, at + offsetof(Bushing, free), 6);
  return {};
}

Refusal PlanBuilder::set_driven(int inputs) {
  CHECK(open());
  REQUIRE(!driven_set_, "the driven inputs are said once");
  REQUIRE(inputs >= 0 && inputs <= (int)input_column_.size(), "more driven inputs than inputs");
  plan_.driven = inputs;
  driven_set_ = true;
  return {};
}

Refusal PlanBuilder::add_actuator(int axis, int reference, int freedom) {
  CHECK(open());
  REQUIRE(driven_set_, "actuators come after the driven inputs");
  CHECK(check_load(LOAD_COORDINATE, axis, reference, freedom, false));
  actuator_.push_back({axis, reference, freedom});
  return {};
}

Refusal PlanBuilder::add_input_constraint(int input, int leader) {
  CHECK(open());
  REQUIRE(driven_set_, "constraints come after the driven inputs");
  REQUIRE(input >= 0 && input < plan_.driven && leader >= 0 && leader < plan_.driven && input != leader,
          "a constraint joins two driven inputs");
  for (const InputConstraint& t : input_constraint_) {
    REQUIRE(t.leader != input && t.input != leader, "a led input leads no other");
    REQUIRE(t.input != input || t.leader != leader, "a constraint is said once");
  }
  input_constraint_.push_back({input, leader});
  return {};
}

Refusal PlanBuilder::set_load_program(const std::vector<std::array<int, 5>>& reads, const std::vector<double>& numbers,
                                      const std::vector<CurveTuple>& curves, const std::vector<double>& knots,
                                      const std::vector<double>& constants, const std::vector<int>& operations,
                                      const std::vector<std::array<int, 3>>& operands,
                                      const std::vector<int>& outputs, const std::vector<int>& kinks) {
  CHECK(open());
  REQUIRE(!program_set_, "the load program is set once");
  REQUIRE(numbers.size() == 4 * reads.size(), "four numbers a read");
  ProgramRecord program;
  for (std::size_t k = 0; k < reads.size(); ++k) {
    const auto& [kind, type, index, freedom, order] = reads[k];
    const double* const n = &numbers[4 * k];
    program.reads.push_back({kind, {type, index, freedom, order, {n[0], n[1], n[2]}, n[3]}});
  }
  std::size_t used = 0;
  for (const auto& [over, low, high, count] : curves) {
    program.curves.push_back({over, low, high, take_knots(knots, count, &used)});
    REQUIRE((int)program.curves.back().knots.size() == count, NO_KNOTS);
  }
  REQUIRE(used == knots.size(), NO_KNOTS);
  program.constants = constants;
  for (int o : operations) {
    REQUIRE(o >= 0 && o <= 255, "unknown operation");
    program.operations.push_back((std::uint8_t)o);
  }
  for (const auto& [a, b, c] : operands) program.operands.insert(program.operands.end(), {a, b, c});
  program.outputs.assign(outputs.begin(), outputs.end()), program.kinks.assign(kinks.begin(), kinks.end());
  Result<ProgramStore> store = ProgramStore::make(arrays(), program);
  CHECK(store.refusal());
  program_ = std::move(*store);
  program_set_ = true;
  for (std::size_t k = 0; k < program.reads.size(); ++k) {
    const std::size_t at = k * sizeof(ReadOf<double>) + offsetof(ReadOf<double>, output);
    number(ARRAY_READ, at + offsetof(Output, data), 3);
    number(ARRAY_READ, at + offsetof(Output, factor), 1);
  }
  number(ARRAY_KNOT, 0, (int)knots.size());
  number(ARRAY_PROGRAM_CONSTANT, 0, (int)program.constants.size());
  return {};
}

Refusal PlanBuilder::add_friction(int place, int turns, int slides, int link, bool falls, const Triple& axis,
                               double radius, double pitch, double at_rest, double sliding, double speed, int course) {
  CHECK(open());
  REQUIRE(place >= 0 && place < (int)place_.size(), "friction of an unknown joint");
  const auto motion = [](int code) { return code >= -1 && code < FREE_CODES; };
  REQUIRE(motion(turns) && motion(slides), "friction of an unknown motion");
  CHECK(check_link(link));
  CHECK(check_finite(axis, radius, pitch, at_rest, sliding, speed));
  REQUIRE(course == -1 || (course >= 0 && course < (int)joints_.size() && is_carriage(joints_[course].type)),
          "friction along the course of a joint that has none");
  for (const Friction& other : friction_) REQUIRE(other.place != place, "a joint has one friction");
  const bool pushes = turns < 0 && slides < 0;
  if (pushes) {
    const int of = -1 - place_[place].reference;
    REQUIRE(of >= 0 && is_relation(closing_[of].type) && closing_[of].path_end > 0, "a relation that acts by a force pushes");
    REQUIRE(!closing_[of].is_pushed, "a relation pushes once");
    closing_[of].is_pushed = 1;
  }
  const int contacts = (int)contact_.size();
  Friction f = {place, turns, slides, link, falls, pitch != 0.0, course, pushes, {}, radius, pitch, at_rest, sliding, speed, contacts, contacts};
  copy(axis, f.axis);
  const std::size_t at = friction_.size() * sizeof(Friction);
  friction_.push_back(f);
  number(ARRAY_FRICTION, at + offsetof(Friction, axis), 3);
  number(ARRAY_FRICTION, at + offsetof(Friction, radius), 1);
  number(ARRAY_FRICTION, at + offsetof(Friction, pitch), 1);
  number(ARRAY_FRICTION, at + offsetof(Friction, at_rest), 1);
  number(ARRAY_FRICTION, at + offsetof(Friction, sliding), 1);
  number(ARRAY_FRICTION, at + offsetof(Friction, speed), 1);
  return {};
}

Refusal PlanBuilder::add_contact(int code, double weight, double share, double tilt, double roll,
                              const Triple& direction) {
  CHECK(open());
  REQUIRE(!friction_.empty(), "contact of no friction");
  REQUIRE(code >= 0 && code < CONTACT_CODES, "unknown kind of contact");
  const int of = place_[friction_.back().place].reference;
  REQUIRE(code != CONTACT_TRANSMITTED || (of < 0 && is_relation(closing_[-1 - of].type)), "a relation transmits, no joint");
  CHECK(check_finite(weight, share, tilt, roll, direction));
  Contact c = {code, weight, share, tilt, roll, {}};
  copy(direction, c.direction);
  const std::size_t at = contact_.size() * sizeof(Contact);
  contact_.push_back(c);
  friction_.back().contact_end = (int)contact_.size();
  number(ARRAY_CONTACT, at + offsetof(Contact, weight), 4);
  number(ARRAY_CONTACT, at + offsetof(Contact, direction), 3);
  return {};
}

Refusal PlanBuilder::add_size_point(int link, const Triple& point) {
  CHECK(open());
  CHECK(check_link(link));
  CHECK(check_finite(point));
  const int number_of_point = (int)size_point_.size();
  Output o = {OUT_POINT, link, 0, 0, 3 * number_of_point, {}, 1.0};
  copy(point, o.data);
  size_point_.push_back(o);
  number(ARRAY_SIZE_POINT, number_of_point * sizeof(Output) + offsetof(Output, data), 3);
  return {};
}
