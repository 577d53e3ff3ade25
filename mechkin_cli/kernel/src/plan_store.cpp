#include "plan_store.hpp"

#include <cstring>
#include <stdexcept>

#include "units.hpp"

namespace {

const JointType& joint_type(int code) { return kernel_unit()->joint_types[code]; }

void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

void copy(const Triple& from, double* to) { std::memcpy(to, from.data(), sizeof from); }

Frame frame(const FrameData& f) {
  Frame r;
  std::memcpy(&r, f.data(), sizeof r);
  return r;
}

JointPlace joint_place(const PlaceData& p) {
  JointPlace r = {p.first, p.second, {}, {}, p.sign, -1, -1, 1.0};
  copy(p.point, r.point);
  copy(p.axis, r.axis);
  return r;
}

bool is_slide(int type, int freedom) { return joint_type(type).slides >> freedom & 1; }

// Columns of the output array that an output fills.
int width(int type) {
  switch (type) {
    case OUT_STATE:
    case OUT_RATE:
    case OUT_ACCELERATION:
    case OUT_CLOSING_THETA:
    case OUT_CLOSING_S:
    case OUT_EFFORT: return 1;
    default: return 3;
  }
}

// What an output needs beyond positions.
unsigned demand_of(int type, int order) {
  const unsigned motion = order == 0 ? 0 : order == 1 ? DEMAND_VELOCITY : DEMAND_VELOCITY | DEMAND_ACCELERATION;
  switch (type) {
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
    case OUT_INERTIA_MOMENT: return DEMAND_FORCES;
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

void PlanStore::add_tree_joint(int type, int parent, double pitch, const FrameData& at, const PlaceData& place) {
  require(!finished_, "the plan is finished");
  require(type >= 0 && type < JOINT_CODES, "unknown joint type");
  const int k = (int)joints_.size();
  require(parent >= -1 && parent < k, "a tree joint's parent must come before it");
  const int state = plan_.states, column = plan_.columns;
  joints_.push_back({type, parent, state, column, pitch, frame(at)});
  tree_places_.push_back(joint_place(place));
  for (int f = 0; f < joint_type(type).freedoms; ++f) {
    column_state_.push_back(type == JOINT_S ? -1 : state + f);
    column_joint_.push_back(k);
    column_weight_.push_back(is_slide(type, f) ? size_ / plan_.length : 1.0);
    column_block_.push_back(-1);
    column_place_.push_back(-1);
  }
  plan_.states += joint_type(type).states;
  plan_.columns += joint_type(type).freedoms;
  inertia_.push_back({});
}

void PlanStore::add_closing_joint(int type, int first, int second, const FrameData& on_first,
                                  const FrameData& on_second, const std::vector<std::pair<int, double>>& loop,
                                  const PlaceData& place) {
  require(!finished_, "the plan is finished");
  require(type >= 0 && type < JOINT_CODES && joint_type(type).equations > 0, "this joint type cannot close a loop");
  const int links = (int)joints_.size();
  require(first >= -1 && first < links && second >= -1 && second < links, "closing joint on an unknown link");
  const int begin = (int)loop_.size();
  for (const auto& entry : loop) {
    require(entry.first >= 0 && entry.first < links, "loop through an unknown joint");
    loop_.push_back({entry.first, entry.second});
  }
  closing_.push_back({type, first, second, frame(on_first), frame(on_second), 0, begin, (int)loop_.size()});
  closing_places_.push_back(joint_place(place));
}

void PlanStore::add_block(int closing_joints, const std::vector<int>& joints, const std::vector<int>& unknown) {
  require(!finished_, "the plan is finished");
  const int index = (int)block_.size();
  const int closing_begin = block_.empty() ? 0 : block_.back().closing_end;
  require(closing_joints > 0 && closing_begin + closing_joints <= (int)closing_.size(), "block of unknown joints");
  Block b = {(int)order_.size(), 0, closing_begin, closing_begin + closing_joints, (int)unknown_.size(), 0, 0};
  int rows = 0;
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    closing_[c].row = rows;
    rows += joint_type(closing_[c].type).equations;
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
  b.size = rows;
  require(rows == (int)unknown.size(), "a block needs as many unknowns as equations");
  block_.push_back(b);
}

void PlanStore::set_rest(const std::vector<int>& joints) {
  for (int k : joints) require(k >= 0 && k < (int)joints_.size(), "unknown joint");
  rest_ = joints;
}

void PlanStore::add_input(int column, bool along_s) {
  require(!finished_, "the plan is finished");
  require(column >= 0 && column < plan_.columns && column_state_[column] >= 0, "an input must be a scalar coordinate");
  JointPlace& place = tree_places_[column_joint_[column]];
  const TreeJoint& joint = joints_[column_joint_[column]];
  const int input = (int)input_column_.size();
  if (!along_s) {
    place.effort_theta = input;
  } else {
    place.effort_s = input;
    // the effort of an H is a torque: the force along s that does its work is torque / pitch
    if (joint.type == JOINT_H) place.force_per_effort = 1.0 / joint.pitch;
  }
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

void PlanStore::check_reference(int joint) const {
  require(joint >= -(int)closing_.size() && joint < (int)joints_.size(), "unknown joint reference");
}

void PlanStore::add_load(int type, int link, int other, const Triple& point, const Triple& other_point,
                         const Triple& vector) {
  const int links = (int)joints_.size();
  const bool on_joint = type == LOAD_JOINT_TORQUE || type == LOAD_JOINT_FORCE || type >= LOAD_JOINT_SPRING_THETA;
  require(!finished_, "the plan is finished");
  const bool between = type == LOAD_SPRING || type == LOAD_DAMPER;
  if (on_joint)
    check_reference(link);
  else
    require(link >= (between ? -1 : 0) && link < links && other >= -1 && other < links, "load on an unknown link");
  Load l = {type, link, other, {}, {}, {}};
  copy(point, l.point);
  copy(other_point, l.other_point);
  copy(vector, l.vector);
  load_.push_back(l);
}

int PlanStore::add_output(int type, int index, int order, const Triple& data, double factor) {
  require(order >= 0 && order <= 2, "outputs go to second order");
  const int links = (int)joints_.size();
  switch (type) {
    case OUT_STATE: require(index >= 0 && index < plan_.states, "unknown state"); break;
    case OUT_RATE:
    case OUT_ACCELERATION: require(index >= 0 && index < plan_.columns, "unknown column"); break;
    case OUT_CLOSING_THETA:
    case OUT_CLOSING_S: require(index >= 0 && index < (int)closing_.size(), "unknown closing joint"); break;
    case OUT_POINT:
    case OUT_VECTOR: require(index >= -1 && index < links, "unknown link"); break;
    case OUT_OMEGA:
    case OUT_ALPHA: require(index >= 0 && index < links, "unknown link"); break;
    case OUT_JOINT_FORCE:
    case OUT_JOINT_MOMENT:
    case OUT_JOINT_MOMENT_ORIGIN: check_reference(index); break;
    case OUT_EFFORT: require(index >= 0 && index < (int)input_column_.size(), "unknown input"); break;
    default: break;
  }
  Output o = {type, index, order, plan_.slots, {}, factor};
  copy(data, o.data);
  output_.push_back(o);
  demand_ |= demand_of(type, order);
  plan_.slots += width(type);
  point_view_at_arrays();
  return o.slot;
}

void PlanStore::finish() {
  for (int c = 0; c < plan_.columns; ++c) {
    bool input = false;
    for (int i : input_column_) input = input || i == c;
    require(input != (column_block_[c] >= 0), "every column must be an input or an unknown, not both");
  }
  require(block_.empty() ? closing_.empty() : block_.back().closing_end == (int)closing_.size(),
          "every closing joint must belong to a block");
  finished_ = true;
  point_view_at_arrays();
}

void PlanStore::point_view_at_arrays() {
  Plan& p = plan_;
  p.links = (int)joints_.size();
  p.closings = (int)closing_.size();
  p.blocks = (int)block_.size();
  p.inputs = (int)input_column_.size();
  p.loads = (int)load_.size();
  p.outputs = (int)output_.size();
  p.rest_count = (int)rest_.size();
  p.largest_block = 0;
  for (const Block& b : block_) p.largest_block = b.size > p.largest_block ? b.size : p.largest_block;
  p.joints = joints_.data(), p.tree_places = tree_places_.data();
  p.closing = closing_.data(), p.closing_places = closing_places_.data();
  p.loop = loop_.data(), p.block = block_.data();
  p.order = order_.data(), p.unknown = unknown_.data(), p.rest = rest_.data();
  p.input_column = input_column_.data();
  p.column_state = column_state_.data(), p.column_joint = column_joint_.data();
  p.column_block = column_block_.data(), p.column_place = column_place_.data();
  p.column_weight = column_weight_.data();
  p.inertia = inertia_.data(), p.load = load_.data(), p.output = output_.data();
}
