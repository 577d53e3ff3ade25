#include "plan/output_list.hpp"

#include <cstring>
#include <string>

#include "rows/units.hpp"

namespace {

Refusal check_index(int index, int least, int end, const char* what) {
  REQUIRE(index >= least && index < end,
          "output of " + std::string(what) + " " + std::to_string(index) + ": the plan has " + std::to_string(end));
  return {};
}

}  // namespace

Refusal check_output(const Plan& p, const OutputRecord& r) {
  REQUIRE(is_output(r.type), "unknown kind of output");
  REQUIRE(r.order >= 0 && r.order <= 3, "outputs go to third order");
  const bool orders = r.type == OUT_CLOSING || r.type == OUT_POINT;
  REQUIRE(orders || r.order == 0, "only closing coordinates and points have derivatives of an order");
  const bool freedoms = r.type == OUT_CLOSING || r.type == OUT_MULTIPLIER || (r.type >= OUT_BUSHING_FORCE && r.type <= OUT_BUSHING_MOMENT);
  REQUIRE(freedoms || r.freedom == 0, "only closing coordinates have a freedom");
  REQUIRE(all_finite(r.data.data(), 3) && all_finite(&r.factor, 1), "an output's numbers must be finite");
  switch (r.type) {
    case OUT_STATE: return check_index(r.index, 0, p.states, "state");
    case OUT_RATE:
    case OUT_JERK:
    case OUT_ACCELERATION: return check_index(r.index, 0, p.columns, "column");
    case OUT_CLOSING:
      CHECK(check_index(r.index, 0, p.closings, "closing joint"));
      return check_closing_coordinate(p, r.index, r.freedom);
    case OUT_POINT:
    case OUT_VECTOR: return check_index(r.index, -1, p.links, "link");
    case OUT_OMEGA:
    case OUT_ALPHA: return check_index(r.index, 0, p.links, "link");
    case OUT_SLIP:
    case OUT_JOINT_FORCE:
    case OUT_JOINT_MOMENT:
    case OUT_TOTAL_FORCE:
    case OUT_TOTAL_MOMENT:
    case OUT_CARRIED_FORCE:
    case OUT_CARRIED_MOMENT:
    case OUT_JOINT_MOMENT_ORIGIN: return check_index(r.index, 0, p.places, "place");
    case OUT_HOLDING_MOMENT: return check_index(r.index, 0, p.hung_bodies, "body");
    case OUT_TENSION:
      CHECK(check_index(r.index, 0, p.closings, "relation"));
      REQUIRE(is_relation(p.closing[r.index].type), "an output of a tension of a closing joint that is no relation");
      return {};
    case OUT_MULTIPLIER:
      CHECK(check_index(r.index, 0, p.closings, "relation"));
      REQUIRE(is_relation(p.closing[r.index].type), "an output of a multiplier of a closing joint that is no relation");
      REQUIRE(r.freedom >= 0 && r.freedom < p.closing[r.index].loop_end - p.closing[r.index].loop_begin,
              "an output of an unknown term of a relation");
      return {};
    case OUT_MESH_FORCE:
      CHECK(check_index(r.index, 0, p.closings, "relation"));
      REQUIRE(p.closing[r.index].path_end > 0, "an output of the force of a relation that acts by none");
      return {};
    case OUT_EFFORT: return check_index(r.index, 0, p.inputs, "input");
    case OUT_LOAD_POWER: return check_index(r.index, -1, p.loads, "load");
    case OUT_BUSHING_FORCE:
    case OUT_BUSHING_MOMENT:
    case OUT_BUSHING_SHIFT:
    case OUT_BUSHING_TURN:
      CHECK(check_index(r.index, 0, p.loads, "load"));
      REQUIRE(p.load[r.index].type >= LOAD_BUSHING, "an output of a bushing of a load that is none");
      REQUIRE(r.freedom == 0 || (r.freedom == 1 && r.index + 1 < p.loads && p.load[r.index + 1].type == LOAD_BUSHING_DAMPER),
              "an output of a bushing's damper, which has none");
      return {};
    case OUT_MOTOR: return check_index(r.index, 0, p.actuators ? p.actuators : p.inputs, "motor");
    case OUT_ACTUATION:
      REQUIRE(p.actuators && r.index == 0, "an output of actuators, of which there are none");
      return {};
    case OUT_NORMAL_LOAD:
    case OUT_FRICTION_FORCE:
    case OUT_FRICTION_MOMENT:
    case OUT_FRICTION_POWER:
    case OUT_FRICTION_STATE: return check_index(r.index, 0, p.frictions, "friction");
    default:
      REQUIRE(r.index == 0, "an output of the whole mechanism has index 0");
      return {};
  }
}

bool is_output(int type) { return type >= 0 && type <= OUT_REST_SHARE; }

int output_width(int type) {
  switch (type) {
    case OUT_STATE:
    case OUT_RATE:
    case OUT_ACCELERATION:
    case OUT_JERK:
    case OUT_CLOSING:
    case OUT_HOLDING_MOMENT:
    case OUT_MULTIPLIER:
    case OUT_TENSION:
    case OUT_REACTION_LEVEL:
    case OUT_KINETIC_ENERGY:
    case OUT_POTENTIAL_ENERGY:
    case OUT_LOAD_POWER:
    case OUT_MOTOR:
    case OUT_ACTUATION:
    case OUT_NORMAL_LOAD:
    case OUT_FRICTION_POWER:
    case OUT_FRICTION_STATE:
    case OUT_SELF_LOCKING:
    case OUT_REST_SHARE:
    case OUT_EFFORT: return 1;
    default: return 3;
  }
}

unsigned output_demand(int type, int order) {
  const unsigned to_order[] = {DEMAND_POSITION, DEMAND_VELOCITY, DEMAND_VELOCITY | DEMAND_ACCELERATION,
                               DEMAND_VELOCITY | DEMAND_ACCELERATION | DEMAND_JERK};
  switch (type) {
    case OUT_NORMAL_LOAD:
    case OUT_FRICTION_FORCE:
    case OUT_FRICTION_MOMENT:
    case OUT_FRICTION_POWER:
    case OUT_FRICTION_STATE:
    case OUT_SELF_LOCKING:
    case OUT_REST_SHARE: return DEMAND_FORCES | to_order[2];
    case OUT_JERK: return to_order[3];
    case OUT_RATE:
    case OUT_BUSHING_FORCE:
    case OUT_BUSHING_MOMENT:
    case OUT_KINETIC_ENERGY:
    case OUT_OMEGA: return to_order[1];
    case OUT_LOAD_POWER: return to_order[1] | DEMAND_FORCES;
    case OUT_ACCELERATION:
    case OUT_ALPHA: return to_order[2];
    case OUT_JOINT_FORCE:
    case OUT_JOINT_MOMENT:
    case OUT_JOINT_MOMENT_ORIGIN:
    case OUT_MOTOR:
    case OUT_ACTUATION:
    case OUT_TOTAL_FORCE:
    case OUT_TOTAL_MOMENT:
    case OUT_CARRIED_FORCE:
    case OUT_CARRIED_MOMENT:
    case OUT_EFFORT:
    case OUT_SHAKING_FORCE:
    case OUT_SHAKING_MOMENT:
    case OUT_INERTIA_FORCE:
    case OUT_INERTIA_MOMENT:
    case OUT_REACTION_LEVEL:
    case OUT_MULTIPLIER:
    case OUT_MESH_FORCE:
    case OUT_TENSION:
    case OUT_HOLDING_MOMENT: return DEMAND_FORCES;
    default: return to_order[order];
  }
}

Refusal check_closing_coordinate(const Plan& p, int c, int freedom) {
  const int type = p.closing[c].type;
  REQUIRE(type != PAIR_DISTANCE, "a hung body has no coordinates");
  REQUIRE(!is_relation(type), "a relation has no coordinates of its own");
  REQUIRE(freedom >= 0 && freedom < 6 && kernel_unit()->pair_types[type].coordinates >> freedom & 1,
          "closing joint " + std::to_string(c) + " has no coordinate " + std::to_string(freedom));
  return {};
}

Result<OutputList> OutputList::make(const FrozenPlan& plan, const std::vector<OutputRecord>& records) {
  OutputList list;
  list.structure_ = plan.structure();
  list.output_.reserve(records.size());
  for (const OutputRecord& r : records) {
    CHECK(check_output(plan.view(), r));
    REQUIRE(list.slots_ <= (1 << 24), "too many outputs");
    Output o = {r.type, r.index, r.order, r.freedom, list.slots_, {}, r.factor};
    std::memcpy(o.data, r.data.data(), sizeof o.data);
    list.output_.push_back(o);
    list.slots_ += output_width(r.type);
    list.demand_ |= output_demand(r.type, r.order);
  }
  return list;
}

void OutputList::read_constants(double* out) const {
  for (const Output& o : output_) {
    std::memcpy(out, o.data, sizeof o.data);
    out[3] = o.factor;
    out += 4;
  }
}

bool OutputList::assign(const double* constants) noexcept {
  if (!all_finite(constants, this->constants())) return false;
  for (Output& o : output_) {
    std::memcpy(o.data, constants, sizeof o.data);
    o.factor = constants[3];
    constants += 4;
  }
  return true;
}
