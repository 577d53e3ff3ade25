// The enumerations of the plan as Python enumerations: said once, in plan.hpp, tracker.hpp and operations.hpp.
#include <nanobind/nanobind.h>

#include "arithmetic/operations.hpp"
#include "bindings.hpp"
#include "plan/plan.hpp"
#include "stepping/tracker.hpp"

namespace nb = nanobind;

namespace {

void bind_plan_codes(nb::module_& m) {
  nb::enum_<TreeCode>(m, "TreeCode", nb::is_arithmetic(), "Displacements that carry links in the tree.")
      .value("R", TREE_R)
      .value("P", TREE_P)
      .value("H", TREE_H)
      .value("C", TREE_C)
      .value("S", TREE_S)
      .value("W", TREE_W)
      .value("L", TREE_L)
      .value("G", TREE_G)
      .value("A", TREE_A);
  nb::enum_<LoadCode>(m, "LoadCode", nb::is_arithmetic(), "Kinds of loads.")
      .value("FORCE_GROUND", LOAD_FORCE_GROUND)
      .value("FORCE_LINK", LOAD_FORCE_LINK)
      .value("TORQUE_GROUND", LOAD_TORQUE_GROUND)
      .value("TORQUE_LINK", LOAD_TORQUE_LINK)
      .value("COORDINATE", LOAD_COORDINATE)
      .value("SPRING", LOAD_SPRING)
      .value("DAMPER", LOAD_DAMPER)
      .value("COORDINATE_SPRING", LOAD_COORDINATE_SPRING)
      .value("COORDINATE_DAMPER", LOAD_COORDINATE_DAMPER)
      .value("BUSHING", LOAD_BUSHING)
      .value("BUSHING_DAMPER", LOAD_BUSHING_DAMPER);
  nb::enum_<OutputCode>(m, "OutputCode", nb::is_arithmetic(), "Kinds of outputs.")
      .value("STATE", OUT_STATE)
      .value("RATE", OUT_RATE)
      .value("ACCELERATION", OUT_ACCELERATION)
      .value("CLOSING", OUT_CLOSING)
      .value("SLIP", OUT_SLIP)
      .value("POINT", OUT_POINT)
      .value("VECTOR", OUT_VECTOR)
      .value("OMEGA", OUT_OMEGA)
      .value("ALPHA", OUT_ALPHA)
      .value("JOINT_FORCE", OUT_JOINT_FORCE)
      .value("JOINT_MOMENT", OUT_JOINT_MOMENT)
      .value("JOINT_MOMENT_ORIGIN", OUT_JOINT_MOMENT_ORIGIN)
      .value("EFFORT", OUT_EFFORT)
      .value("SHAKING_FORCE", OUT_SHAKING_FORCE)
      .value("SHAKING_MOMENT", OUT_SHAKING_MOMENT)
      .value("INERTIA_FORCE", OUT_INERTIA_FORCE)
      .value("INERTIA_MOMENT", OUT_INERTIA_MOMENT)
      .value("HOLDING_MOMENT", OUT_HOLDING_MOMENT)
      .value("JERK", OUT_JERK)
      .value("REACTION_LEVEL", OUT_REACTION_LEVEL)
      .value("KINETIC_ENERGY", OUT_KINETIC_ENERGY)
      .value("POTENTIAL_ENERGY", OUT_POTENTIAL_ENERGY)
      .value("LOAD_POWER", OUT_LOAD_POWER)
      .value("MOTOR", OUT_MOTOR)
      .value("ACTUATION", OUT_ACTUATION)
      .value("TOTAL_FORCE", OUT_TOTAL_FORCE)
      .value("TOTAL_MOMENT", OUT_TOTAL_MOMENT)
      .value("CARRIED_FORCE", OUT_CARRIED_FORCE)
      .value("CARRIED_MOMENT", OUT_CARRIED_MOMENT)
      .value("NORMAL_LOAD", OUT_NORMAL_LOAD)
      .value("FRICTION_FORCE", OUT_FRICTION_FORCE)
      .value("FRICTION_MOMENT", OUT_FRICTION_MOMENT)
      .value("FRICTION_POWER", OUT_FRICTION_POWER)
      .value("FRICTION_STATE", OUT_FRICTION_STATE)
      .value("SELF_LOCKING", OUT_SELF_LOCKING)
      .value("MULTIPLIER", OUT_MULTIPLIER)
      .value("MESH_FORCE", OUT_MESH_FORCE)
      .value("TENSION", OUT_TENSION)
      .value("BUSHING_FORCE", OUT_BUSHING_FORCE)
      .value("BUSHING_MOMENT", OUT_BUSHING_MOMENT)
      .value("BUSHING_SHIFT", OUT_BUSHING_SHIFT)
      .value("BUSHING_TURN", OUT_BUSHING_TURN)
      .value("REST_SHARE", OUT_REST_SHARE);
  nb::enum_<ReadCode>(m, "ReadCode", nb::is_arithmetic(), "What programs of quantities read.")
      .value("OUTPUT", READ_OUTPUT)
      .value("ANGLE", READ_ANGLE)
      .value("TIME", READ_TIME);
  nb::enum_<ContactCode>(m, "ContactCode", nb::is_arithmetic(), "Kinds of contacts that rub.")
      .value("RADIAL", CONTACT_RADIAL)
      .value("ALONG", CONTACT_ALONG)
      .value("TOTAL", CONTACT_TOTAL)
      .value("TRANSMITTED", CONTACT_TRANSMITTED);
  nb::enum_<FrictionState>(m, "FrictionState", nb::is_arithmetic(), "What is known of a joint's friction in a row.")
      .value("DECIDED", FRICTION_DECIDED)
      .value("AT_REST", FRICTION_AT_REST)
      .value("NOT_UNIQUE", FRICTION_NOT_UNIQUE)
      .value("NOT_SOLVED", FRICTION_NOT_SOLVED);
  nb::enum_<FreeCode>(m, "FreeCode", nb::is_arithmetic(), "Kinds of free motions.")
      .value("ALONG", FREE_ALONG)
      .value("SQUARE", FREE_SQUARE)
      .value("ALL", FREE_ALL);
}

void bind_run_codes(nb::module_& m) {
  nb::enum_<Demand>(m, "Demand", nb::is_arithmetic(), nb::is_flag(), "What a run computes beyond positions.")
      .value("POSITION", DEMAND_POSITION)
      .value("VELOCITY", DEMAND_VELOCITY)
      .value("ACCELERATION", DEMAND_ACCELERATION)
      .value("FORCES", DEMAND_FORCES)
      .value("CONDITION", DEMAND_CONDITION)
      .value("POWER", DEMAND_POWER)
      .value("JERK", DEMAND_JERK)
      .value("SINGULAR", DEMAND_SINGULAR);
  nb::enum_<RowFlag>(m, "RowFlag", nb::is_arithmetic(), nb::is_flag(), "Why a row of a run is not good.")
      .value("GOOD", ROW_GOOD)
      .value("NOT_CONVERGED", ROW_NOT_CONVERGED)
      .value("SIDE_CONDITION", ROW_SIDE_CONDITION);
  nb::enum_<FrictionTold>(m, "FrictionTold", nb::is_arithmetic(), "What a motion tells of a friction before its moment and force.")
      .value("NOTHING", TOLD_NOTHING)
      .value("FORCE", TOLD_FORCE)
      .value("OPEN", TOLD_OPEN)
      .value("IMMOBILE", TOLD_IMMOBILE);
  nb::enum_<TrackEnd>(m, "TrackEnd", nb::is_arithmetic(), "How following a branch ended.")
      .value("FINISHED", TrackEnd::finished)
      .value("STALLED", TrackEnd::stalled)
      .value("EXHAUSTED", TrackEnd::exhausted)
      .value("START_NOT_CLOSED", TrackEnd::start_not_closed);
  nb::enum_<PassageEnd>(m, "PassageEnd", nb::is_arithmetic(), "What a walk by arclength came to.")
      .value("THROUGH", PassageEnd::through)
      .value("DEAD_CENTRE", PassageEnd::dead_centre)
      .value("BRANCH_POINT", PassageEnd::branch_point)
      .value("LOST", PassageEnd::lost);
  nb::enum_<Operation>(m, "Operation", nb::is_arithmetic(), "Elementary functions of `elementwise`.")
      .value("SIN", OPERATION_SIN)
      .value("COS", OPERATION_COS)
      .value("TAN", OPERATION_TAN)
      .value("ASIN", OPERATION_ASIN)
      .value("ACOS", OPERATION_ACOS)
      .value("ATAN", OPERATION_ATAN)
      .value("ATAN2", OPERATION_ATAN2)
      .value("EXP", OPERATION_EXP)
      .value("LOG", OPERATION_LOG)
      .value("POWER", OPERATION_POWER);
}

}  // namespace

void bind_codes(nb::module_& m) {
  bind_plan_codes(m);
  bind_run_codes(m);
}
