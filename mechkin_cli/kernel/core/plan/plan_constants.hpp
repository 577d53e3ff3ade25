// Plans whose constants are no doubles: of all lanes side by side (wide_plan.hpp), or of parts (parted_plan.hpp).
//
// What is structure is read where a plan of doubles has it, which must outlive the copy. A unit that runs such plans
// defines MECHKIN_WIDE_PLAN and includes one of the two headers first, which says what a `PlanNumber` is, and how the
// constants at one place of a plan are gathered:
//
//     number(at)             of at(plan)
//     numbers(to, count, at)  of at(plan)[0], at(plan)[1] ...
//     frame(to, at)          of at(plan).x, y, z and o
#pragma once

#include "arithmetic/pack.hpp"
#include "plan/plan.hpp"
#include "plan/room.hpp"

#ifndef MECHKIN_WIDE_PLAN
#error "MECHKIN_WIDE_PLAN must be defined before plan.hpp is read"
#endif

namespace {

using Frame = FrameOf<PlanNumber>;
using TreeJoint = TreeJointOf<PlanNumber>;
using ClosingJoint = ClosingJointOf<PlanNumber>;
using HungBody = HungBodyOf<PlanNumber>;
using Term = TermOf<PlanNumber>;
using LinkInertia = LinkInertiaOf<PlanNumber>;
using Load = LoadOf<PlanNumber>;
using Bushing = BushingOf<PlanNumber>;
using JointPlace = JointPlaceOf<PlanNumber>;
using FreeMotion = FreeMotionOf<PlanNumber>;
using CoordinateAxis = CoordinateAxisOf<PlanNumber>;
using Drive = DriveOf<PlanNumber>;
using Friction = FrictionOf<PlanNumber>;
using Contact = ContactOf<PlanNumber>;
using Plan = PlanOf<PlanNumber>;
using LanePlan = PlanOf<double>;

template <class Constants, class At>
inline void gather_frame(const Constants& from, Frame* to, At&& at) {
  from.numbers(to->x, 3, [&](const LanePlan& p) { return at(p).x; });
  from.numbers(to->y, 3, [&](const LanePlan& p) { return at(p).y; });
  from.numbers(to->z, 3, [&](const LanePlan& p) { return at(p).z; });
  from.numbers(to->o, 3, [&](const LanePlan& p) { return at(p).o; });
}

template <class Constants, class At>
inline void gather_knots(const Constants& from, KnotOf<PlanNumber>* to, int count, At&& at) {
  for (int k = 0; k < count; ++k) {
    const auto field = [&](double Knot::*of) {
      return from.number([&](const LanePlan& p) { return at(p)[k].*of; });
    };
    to[k] = {field(&Knot::x), field(&Knot::y), field(&Knot::b), field(&Knot::c), field(&Knot::d)};
  }
}

template <class Constants>
inline void widen_joints(const LanePlan& first, const Constants& lanes, Plan* w, Room& room) {
  TreeJoint* const joint = room.take<TreeJoint>(first.links);
  ClosingJoint* const closing = room.take<ClosingJoint>(first.closings);
  HungBody* const hung = room.take<HungBody>(first.hung_bodies);
  Term* const term = room.take<Term>(first.terms);
  KnotOf<PlanNumber>* const knot = room.take<KnotOf<PlanNumber>>(first.functions.knots);
  PlanNumber* const constant = room.take<PlanNumber>(first.functions.constants);
  if (!room.memory) return;
  for (int k = 0; k < first.links; ++k) {
    const auto& j = first.joints[k];
    joint[k] = {j.type, j.parent, j.state, j.column, lanes.number([&](const LanePlan& p) { return p.joints[k].pitch; }),
                j.hung, j.function, {}};
    lanes.frame(&joint[k].at, [&](const LanePlan& p) -> const auto& { return p.joints[k].at; });
  }
  for (int c = 0; c < first.closings; ++c) {
    const auto& j = first.closing[c];
    closing[c] = {j.type, j.first, j.second, {}, {},
                  lanes.number([&](const LanePlan& p) { return p.closing[c].parameter; }),
                  j.slide, j.slide_sign, j.row, j.loop_begin, j.loop_end, j.path_begin, j.path_end,
                  j.is_pair_of_forces, j.is_pushed, j.columns_begin, j.known_begin, j.columns_end, j.meets_all};
    lanes.frame(&closing[c].on_first, [&](const LanePlan& p) -> const auto& { return p.closing[c].on_first; });
    lanes.frame(&closing[c].on_second, [&](const LanePlan& p) -> const auto& { return p.closing[c].on_second; });
  }
  for (int l = 0; l < first.hung_bodies; ++l) {
    const auto& from = first.hung[l];
    hung[l] = {from.body, from.rod, from.first, from.second, from.closing, {}, {}};
    lanes.numbers(hung[l].point, 3, [&](const LanePlan& p) { return p.hung[l].point; });
    lanes.numbers(hung[l].line, 3, [&](const LanePlan& p) { return p.hung[l].line; });
  }
  for (int t = 0; t < first.terms; ++t)
    term[t] = {first.term[t].freedom, first.term[t].axis,
               lanes.number([&](const LanePlan& p) { return p.term[t].factor; }), first.term[t].function,
               lanes.number([&](const LanePlan& p) { return p.term[t].argument; })};
  gather_knots(lanes, knot, first.functions.knots, [](const LanePlan& p) { return p.function_knot; });
  lanes.numbers(constant, first.functions.constants, [&](const LanePlan& p) { return p.function_constant; });
  w->joints = joint, w->closing = closing, w->hung = hung, w->term = term;
  w->function_knot = knot, w->function_constant = constant;
}

template <class Constants>
inline void widen_places(const LanePlan& first, const Constants& lanes, Plan* w, Room& room) {
  JointPlace* const place = room.take<JointPlace>(first.places);
  CoordinateAxis* const axis = room.take<CoordinateAxis>(first.axes);
  Drive* const drive = room.take<Drive>(first.drives);
  FreeMotion* const free = room.take<FreeMotion>(first.frees);
  if (!room.memory) return;
  for (int j = 0; j < first.places; ++j) {
    const auto& from = first.place[j];
    place[j] = {from.reference, from.first, from.second, from.point_on, {}, from.sign,
                from.drive_begin, from.drive_end, from.free_begin, from.free_end};
    lanes.numbers(place[j].point, 3, [&](const LanePlan& p) { return p.place[j].point; });
  }
  for (int a = 0; a < first.axes; ++a) {
    const auto& from = first.axis[a];
    axis[a] = {from.place, from.slide, {from.link[0], from.link[1]}, {}, from.carrier, from.freedom};
    for (int term = 0; term < 2; ++term)
      lanes.numbers(axis[a].vector[term], 3, [&](const LanePlan& p) { return p.axis[a].vector[term]; });
  }
  for (int d = 0; d < first.drives; ++d)
    drive[d] = {first.drive[d].input, first.drive[d].axis,
                lanes.number([&](const LanePlan& p) { return p.drive[d].scale; })};
  for (int f = 0; f < first.frees; ++f) {
    const auto& from = first.free[f];
    free[f] = {from.place, from.slide, from.code, from.link, {}};
    lanes.numbers(free[f].vector, 3, [&](const LanePlan& p) { return p.free[f].vector; });
  }
  w->place = place, w->axis = axis, w->drive = drive, w->free = free;
}

template <class Constants>
inline void widen_masses_and_loads(const LanePlan& first, const Constants& lanes, Plan* w, Room& room) {
  PlanNumber* const weight = room.take<PlanNumber>(first.columns);
  LinkInertia* const inertia = room.take<LinkInertia>(first.links);
  Load* const load = room.take<Load>(first.loads);
  Bushing* const bushing = room.take<Bushing>(first.bushings);
  if (!room.memory) return;
  lanes.numbers(weight, first.columns, [&](const LanePlan& p) { return p.column_weight; });
  for (int k = 0; k < first.links; ++k) {
    inertia[k].present = first.inertia[k].present;
    inertia[k].mass = lanes.number([&](const LanePlan& p) { return p.inertia[k].mass; });
    lanes.numbers(inertia[k].centre, 3, [&](const LanePlan& p) { return p.inertia[k].centre; });
    lanes.numbers(inertia[k].tensor, 6, [&](const LanePlan& p) { return p.inertia[k].tensor; });
  }
  for (int l = 0; l < first.loads; ++l) {
    const auto& from = first.load[l];
    load[l] = {from.type, from.link, from.other, from.freedom, {}, {}, {}, from.varying, from.turn};
    lanes.numbers(load[l].point, 3, [&](const LanePlan& p) { return p.load[l].point; });
    lanes.numbers(load[l].other_point, 3, [&](const LanePlan& p) { return p.load[l].other_point; });
    lanes.numbers(load[l].vector, 3, [&](const LanePlan& p) { return p.load[l].vector; });
  }
  for (int b = 0; b < first.bushings; ++b) {
    lanes.frame(&bushing[b].on_first, [&](const LanePlan& p) -> const auto& { return p.bushing[b].on_first; });
    lanes.frame(&bushing[b].on_second, [&](const LanePlan& p) -> const auto& { return p.bushing[b].on_second; });
    lanes.numbers(bushing[b].matrix, 21, [&](const LanePlan& p) { return p.bushing[b].matrix; });
    lanes.numbers(bushing[b].free, 6, [&](const LanePlan& p) { return p.bushing[b].free; });
  }
  w->column_weight = weight, w->inertia = inertia, w->load = load, w->bushing = bushing;
}

template <class Constants>
inline void widen_program(const LanePlan& first, const Constants& lanes, Plan* w, Room& room) {
  const ProgramOf<double>& from = first.law;
  ReadOf<PlanNumber>* const read = room.take<ReadOf<PlanNumber>>(from.reads);
  KnotOf<PlanNumber>* const knot = room.take<KnotOf<PlanNumber>>(from.knots);
  PlanNumber* const constant = room.take<PlanNumber>(from.constants);
  if (!room.memory) return;
  for (int k = 0; k < from.reads; ++k) {
    const OutputOf<double>& o = from.read[k].output;
    read[k] = {from.read[k].kind, from.read[k].turn, {o.type, o.index, o.order, o.freedom, o.slot, {}, {}}};
    lanes.numbers(read[k].output.data, 3, [&](const LanePlan& p) { return p.law.read[k].output.data; });
    read[k].output.factor = lanes.number([&](const LanePlan& p) { return p.law.read[k].output.factor; });
  }
  gather_knots(lanes, knot, from.knots, [](const LanePlan& p) { return p.law.knot; });
  lanes.numbers(constant, from.constants, [&](const LanePlan& p) { return p.law.constant; });
  w->law = {from.reads, from.curves, from.knots, from.constants, from.instructions, from.outputs, from.kinks,
            from.inputs, read, from.curve, knot, constant, from.operation, from.operand, from.output, from.kink};
}

template <class Constants>
inline void widen_frictions(const LanePlan& first, const Constants& lanes, Plan* w, Room& room) {
  Friction* const friction = room.take<Friction>(first.frictions);
  Contact* const contact = room.take<Contact>(first.contacts);
  if (!room.memory) return;
  for (int f = 0; f < first.frictions; ++f) {
    const auto& from = first.friction[f];
    friction[f] = {from.place, from.turns, from.slides, from.link, from.falls, from.screws, from.course, from.pushes, {},
                   lanes.number([&](const LanePlan& p) { return p.friction[f].radius; }),
                   lanes.number([&](const LanePlan& p) { return p.friction[f].pitch; }),
                   lanes.number([&](const LanePlan& p) { return p.friction[f].at_rest; }),
                   lanes.number([&](const LanePlan& p) { return p.friction[f].sliding; }),
                   lanes.number([&](const LanePlan& p) { return p.friction[f].speed; }),
                   from.contact_begin, from.contact_end};
    lanes.numbers(friction[f].axis, 3, [&](const LanePlan& p) { return p.friction[f].axis; });
  }
  for (int c = 0; c < first.contacts; ++c) {
    contact[c] = {first.contact[c].code,
                  lanes.number([&](const LanePlan& p) { return p.contact[c].weight; }),
                  lanes.number([&](const LanePlan& p) { return p.contact[c].share; }),
                  lanes.number([&](const LanePlan& p) { return p.contact[c].tilt; }),
                  lanes.number([&](const LanePlan& p) { return p.contact[c].roll; }),
                  {}};
    lanes.numbers(contact[c].direction, 3, [&](const LanePlan& p) { return p.contact[c].direction; });
  }
  w->friction = friction, w->contact = contact;
}

// Writes the plan of the structure of `first` with the constants that `lanes` gathers into a room; the bytes it takes.
// Without memory they are only counted.
template <class Constants>
inline long widen_by(const LanePlan& first, const Constants& lanes, char* memory) {
  Room room = {memory};
  Plan* const w = room.take<Plan>(1);
  Plan counted;
  Plan* const to = memory ? w : &counted;
  if (memory) {
    static_cast<PlanShape&>(*to) = first;
    to->size_point = first.size_point;
    lanes.numbers(to->gravity, 3, [](const LanePlan& p) { return p.gravity; });
    lanes.numbers(to->origin, 3, [](const LanePlan& p) { return p.origin; });
    to->length = lanes.number([](const LanePlan& p) { return p.length; });
    to->size = lanes.number([](const LanePlan& p) { return p.size; });
    to->row_weight = lanes.number([](const LanePlan& p) { return p.row_weight; });
  }
  widen_joints(first, lanes, to, room);
  widen_places(first, lanes, to, room);
  widen_masses_and_loads(first, lanes, to, room);
  widen_program(first, lanes, to, room);
  widen_frictions(first, lanes, to, room);
  return room.used;
}

}  // namespace
