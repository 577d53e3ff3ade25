#include "plan_store.hpp"

#include <cstring>
#include <stdexcept>

#include "units.hpp"

namespace {

const TreeType& tree_type(int code) { return kernel_unit()->tree_types[code]; }
const PairType& pair_type(int code) { return kernel_unit()->pair_types[code]; }

void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

void copy(const Triple& from, double* to) { std::memcpy(to, from.data(), sizeof from); }

Frame frame(const FrameData& f) {
  Frame r;
  std::memcpy(&r, f.data(), sizeof r);
  return r;
}

bool is_slide(int type, int freedom) { return tree_type(type).slides >> freedom & 1; }

// Columns of the output array that an output fills.
int width(int type) {
  switch (type) {
    case OUT_STATE:
    case OUT_RATE:
    case OUT_ACCELERATION:
    case OUT_JERK:
    case OUT_CLOSING:
    case OUT_HOLDING_MOMENT:
    case OUT_EFFORT: return 1;
    default: return 3;
  }
}

// What an output needs beyond positions.
unsigned demand_of(int type, int order) {
  const unsigned to_order[] = {0, DEMAND_VELOCITY, DEMAND_VELOCITY | DEMAND_ACCELERATION,
                               DEMAND_VELOCITY | DEMAND_ACCELERATION | DEMAND_JERK};
  const unsigned motion = to_order[order];
  switch (type) {
    case OUT_JERK: return to_order[3];
    case OUT_RATE:
    case OUT_OMEGA: return DEMAND_VELOCITY;
    case OUT_ACCELERATION:
    case OUT_ALPHA: return DEMAND_VELOCITY | DEMAND_ACCELERATION;
    case OUT_JOINT_FORCE:
    case OUT_JOINT_MOMENT:
    case OUT_JOINT_MOMENT_ORIGIN:
    case OUT_EFFORT:
    case OUT_SHAKING_FORCE:
    case OUT_SHAKING_MOMENT:
    case OUT_INERTIA_FORCE:
    case OUT_INERTIA_MOMENT:
    case OUT_HOLDING_MOMENT: return DEMAND_FORCES;
    default: return motion;
  }
}

}  // namespace

PlanStore::PlanStore(double length, Triple origin, double size) : size_(size) {
  require(length > 0 && size > 0, "length unit and size must be positive");
  plan_.length = length;
  copy(origin, plan_.origin);
  plan_.row_weight = length / size;
}

void PlanStore::add_tree_joint(int type, int parent, double pitch, const FrameData& at) {
  require(!finished_, "the plan is finished");
  require(type >= 0 && type < TREE_CODES, "unknown displacement");
  const int k = (int)joints_.size();
  require(parent >= -1 && parent < k, "a tree joint's parent must come before it");
  const int state = plan_.states, column = plan_.columns;
  joints_.push_back({type, parent, state, column, pitch, -1, frame(at)});
  for (int f = 0; f < tree_type(type).freedoms; ++f) {
    column_state_.push_back(type == TREE_S ? -1 : state + f);
    column_joint_.push_back(k);
    column_weight_.push_back(is_slide(type, f) ? size_ / plan_.length : 1.0);
    column_block_.push_back(-1);
    column_place_.push_back(-1);
  }
  plan_.states += tree_type(type).states;
  plan_.columns += tree_type(type).freedoms;
  inertia_.push_back({});
}

void PlanStore::add_closing_joint(int type, int first, int second, const FrameData& on_first,
                                  const FrameData& on_second, double parameter,
                                  const std::vector<std::pair<int, double>>& loop) {
  require(!finished_, "the plan is finished");
  require(type > PAIR_LEG && type < kernel_unit()->pair_codes, "this pair cannot close a loop");
  check_link(first);
  check_link(second);
  const auto [begin, end] = add_loop(loop);
  closing_.push_back({type, first, second, frame(on_first), frame(on_second), parameter, -1, 0.0, 0, begin, end});
}

std::pair<int, int> PlanStore::add_loop(const std::vector<std::pair<int, double>>& loop) {
  const int begin = (int)loop_.size();
  for (const auto& entry : loop) {
    require(entry.first >= 0 && entry.first < (int)joints_.size(), "loop through an unknown joint");
    loop_.push_back({entry.first, entry.second});
  }
  return {begin, (int)loop_.size()};
}

void PlanStore::add_leg(int body, int rod, int first, int second, const FrameData& on_first,
                        const FrameData& on_second, double length, const Triple& line, double slide_sign,
                        const std::vector<std::pair<int, double>>& loop) {
  require(!finished_, "the plan is finished");
  require(body >= 0 && body < (int)joints_.size() && joints_[body].type == TREE_L, "a leg hangs by TREE_L");
  require(joints_[body].parent == first && first < body && second < body, "a leg comes after its ends");
  require(rod == -1 || (rod > body && rod < (int)joints_.size() && joints_[rod].type == TREE_P &&
                        joints_[rod].parent == body), "a leg's rod slides on its body");
  check_link(first);
  check_link(second);
  const auto [begin, end] = add_loop(loop);
  Leg leg = {body, rod, first, second, (int)closing_.size(), {}, {}};
  const Frame at_end = frame(on_second);
  std::memcpy(leg.point, at_end.o, sizeof leg.point);
  copy(line, leg.line);
  joints_[body].leg = (int)leg_.size();
  leg_.push_back(leg);
  closing_.push_back({PAIR_LEG, first, second, frame(on_first), at_end, length, rod, slide_sign, 0, begin, end});
}

int PlanStore::add_place(int reference, int first, int second, int point_on, const Triple& point, double sign) {
  require(reference >= -(int)closing_.size() && reference < (int)joints_.size(), "unknown joint reference");
  check_link(first);
  check_link(second);
  check_link(point_on);
  JointPlace place = {reference, first, second, point_on, {}, sign, 0, 0};
  copy(point, place.point);
  place_.push_back(place);
  return (int)place_.size() - 1;
}

int PlanStore::add_axis(int place, bool slide, int link, const Triple& vector, int other, const Triple& other_vector) {
  require(place >= 0 && place < (int)place_.size(), "axis of an unknown joint");
  check_link(link);
  check_link(other);
  CoordinateAxis axis = {place, slide, {link, other}, {}};
  copy(vector, axis.vector[0]);
  copy(other_vector, axis.vector[1]);
  axis_.push_back(axis);
  return (int)axis_.size() - 1;
}

void PlanStore::add_block(int closing_joints, const std::vector<int>& joints, const std::vector<int>& unknown) {
  require(!finished_, "the plan is finished");
  const int index = (int)block_.size();
  const int closing_begin = block_.empty() ? 0 : block_.back().closing_end;
  require(closing_joints > 0 && closing_begin + closing_joints <= (int)closing_.size(), "block of unknown joints");
  Block b = {(int)order_.size(), 0, closing_begin, closing_begin + closing_joints, (int)unknown_.size(), 0, 0, 0};
  int rows = 0;
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    closing_[c].row = rows;
    rows += pair_type(closing_[c].type).equations;
  }
  for (int k : joints) {
    require(k >= 0 && k < (int)joints_.size(), "block places an unknown joint");
    order_.push_back(k);
  }
  for (int c : unknown) {
    require(c >= 0 && c < plan_.columns && column_block_[c] < 0, "a column must belong to one block");
    column_block_[c] = index;
    column_place_[c] = (int)unknown_.size() - b.column_begin;
    unknown_.push_back(c);
  }
  b.joint_end = (int)order_.size();
  b.column_end = (int)unknown_.size();
  b.rows = rows;
  b.size = (int)unknown.size();
  require(b.rows >= b.size, "a block needs as many equations as unknowns");
  block_.push_back(b);
}

void PlanStore::set_rest(const std::vector<int>& joints) {
  for (int k : joints) require(k >= 0 && k < (int)joints_.size(), "unknown joint");
  rest_ = joints;
}

void PlanStore::add_input(int column, int axis, double scale) {
  require(!finished_, "the plan is finished");
  require(column >= 0 && column < plan_.columns && column_state_[column] >= 0, "an input must be a scalar coordinate");
  require(axis >= -1 && axis < (int)axis_.size(), "unknown axis");
  drive_.push_back({(int)input_column_.size(), axis, scale});
  input_column_.push_back(column);
}

void PlanStore::set_inertia(int link, double mass, const Triple& centre, const std::array<double, 6>& tensor) {
  require(link >= 0 && link < (int)inertia_.size(), "inertia of an unknown link");
  LinkInertia& m = inertia_[link];
  m.present = 1;
  m.mass = mass;
  copy(centre, m.centre);
  std::memcpy(m.tensor, tensor.data(), sizeof m.tensor);
}

void PlanStore::set_gravity(const Triple& g) { copy(g, plan_.gravity); }

void PlanStore::check_link(int link) const {
  require(link >= -1 && link < (int)joints_.size(), "unknown link");
}

void PlanStore::add_load(int type, int link, int other, int freedom, const Triple& point, const Triple& other_point,
                         const Triple& vector, bool varying) {
  require(!finished_, "the plan is finished");
  require(!varying || type <= LOAD_COORDINATE, "springs and dampers vary by themselves");
  if (type == LOAD_COORDINATE || type == LOAD_COORDINATE_SPRING || type == LOAD_COORDINATE_DAMPER) {
    require(link >= 0 && link < (int)axis_.size(), "load along an unknown axis");
    require(other >= -(int)closing_.size() && other < (int)joints_.size(), "load on an unknown joint");
  } else {
    check_link(link);
    check_link(other);
    require(link >= 0 || type == LOAD_SPRING || type == LOAD_DAMPER, "a load on ground moves nothing");
  }
  Load l = {type, link, other, freedom, {}, {}, {}, varying ? plan_.load_values : -1};
  if (varying) plan_.load_values += type == LOAD_COORDINATE ? 1 : 3;
  copy(point, l.point);
  copy(other_point, l.other_point);
  copy(vector, l.vector);
  load_.push_back(l);
}

int PlanStore::add_output(int type, int index, int freedom, int order, const Triple& data, double factor) {
  require(order >= 0 && order <= 3, "outputs go to third order");
  const int links = (int)joints_.size();
  switch (type) {
    case OUT_STATE: require(index >= 0 && index < plan_.states, "unknown state"); break;
    case OUT_RATE:
    case OUT_JERK:
    case OUT_ACCELERATION: require(index >= 0 && index < plan_.columns, "unknown column"); break;
    case OUT_CLOSING: require(index >= 0 && index < (int)closing_.size(), "unknown closing joint"); break;
    case OUT_POINT:
    case OUT_VECTOR: check_link(index); break;
    case OUT_OMEGA:
    case OUT_ALPHA: require(index >= 0 && index < links, "unknown link"); break;
    case OUT_SLIP:
    case OUT_JOINT_FORCE:
    case OUT_JOINT_MOMENT:
    case OUT_JOINT_MOMENT_ORIGIN: require(index >= 0 && index < (int)place_.size(), "unknown joint"); break;
    case OUT_HOLDING_MOMENT: require(index >= 0 && index < (int)leg_.size(), "unknown leg"); break;
    case OUT_EFFORT: require(index >= 0 && index < (int)input_column_.size(), "unknown input"); break;
    default: break;
  }
  Output o = {type, index, order, freedom, plan_.slots, {}, factor};
  copy(data, o.data);
  output_.push_back(o);
  demand_ |= demand_of(type, order);
  plan_.slots += width(type);
  point_view_at_arrays();
  return o.slot;
}

void PlanStore::finish() {
  // a tree whose states are given whole: only its poses are asked for
  const bool posed = block_.empty() && input_column_.empty();
  for (int c = 0; c < plan_.columns; ++c) {
    bool input = false;
    for (int i : input_column_) input = input || i == c;
    require(posed || input != (column_block_[c] >= 0), "every column must be an input or an unknown, not both");
  }
  require(block_.empty() ? closing_.empty() : block_.back().closing_end == (int)closing_.size(),
          "every closing joint must belong to a block");
  for (const TreeJoint& j : joints_) require((j.type == TREE_L) == (j.leg >= 0), "TREE_L hangs a leg");
  std::vector<Drive> by_place;
  for (std::size_t j = 0; j < place_.size(); ++j) {
    place_[j].drive_begin = (int)by_place.size();
    for (const Drive& d : drive_)
      if (d.axis >= 0 && axis_[d.axis].place == (int)j) by_place.push_back(d);
    place_[j].drive_end = (int)by_place.size();
  }
  drive_ = by_place;
  finished_ = true;
  point_view_at_arrays();
}

void PlanStore::point_view_at_arrays() {
  Plan& p = plan_;
  p.links = (int)joints_.size();
  p.closings = (int)closing_.size();
  p.legs = (int)leg_.size();
  p.blocks = (int)block_.size();
  p.inputs = (int)input_column_.size();
  p.loads = (int)load_.size();
  p.outputs = (int)output_.size();
  p.rest_count = (int)rest_.size();
  p.largest_block = 0;
  for (const Block& b : block_) p.largest_block = b.rows > p.largest_block ? b.rows : p.largest_block;
  p.joints = joints_.data(), p.closing = closing_.data(), p.leg = leg_.data();
  p.place = place_.data(), p.axis = axis_.data(), p.drive = drive_.data();
  p.loop = loop_.data(), p.block = block_.data();
  p.order = order_.data(), p.unknown = unknown_.data(), p.rest = rest_.data();
  p.input_column = input_column_.data();
  p.column_state = column_state_.data(), p.column_joint = column_joint_.data();
  p.column_block = column_block_.data(), p.column_place = column_place_.data();
  p.column_weight = column_weight_.data();
  p.inertia = inertia_.data(), p.load = load_.data(), p.output = output_.data();
}
