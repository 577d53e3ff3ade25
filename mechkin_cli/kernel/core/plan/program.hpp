// Quantities of a row as data: what a run writes, and programs that compute with what they read. `Number` as in plan.hpp.
#pragma once

#include <cstdint>

enum OutputCode : int {
  OUT_STATE = 0,         // index: state
  OUT_RATE = 1,          // index: column
  OUT_ACCELERATION = 2,  // index: column
  OUT_CLOSING = 3,       // index: closing joint; freedom; order 0 to 3
  OUT_SLIP = 4,          // index: place; its point minus the point `data` of the second link
  OUT_POINT = 5,         // index: link; order 0 to 3
  OUT_VECTOR = 6,        // index: link
  OUT_OMEGA = 7,
  OUT_ALPHA = 8,
  OUT_JOINT_FORCE = 9,   // index: place
  OUT_JOINT_MOMENT = 10,  // about the joint's point
  OUT_JOINT_MOMENT_ORIGIN = 11,
  OUT_EFFORT = 12,       // index: input
  OUT_SHAKING_FORCE = 13,
  OUT_SHAKING_MOMENT = 14,
  OUT_INERTIA_FORCE = 15,
  OUT_INERTIA_MOMENT = 16,
  OUT_HOLDING_MOMENT = 17,  // index: hung body; about its line, on its body
  OUT_JERK = 18,            // index: column
  OUT_REACTION_LEVEL = 19,  // largest component of force or moment (in length units) of all joints
  OUT_KINETIC_ENERGY = 20,
  OUT_POTENTIAL_ENERGY = 21,  // of gravity from the ground's origin, of springs from their free length or angle
  OUT_LOAD_POWER = 22,        // index: load, -1: gravity; what it puts in
  OUT_MOTOR = 23,             // index: actuator, or where there are none input; with what constraints transmit
  OUT_ACTUATION = 24,         // least rate of the actuators, all together, in a motion of length one
  OUT_TOTAL_FORCE = 25,       // index: place; constraint, drive and actuators
  OUT_TOTAL_MOMENT = 26,      // about the joint's point
  OUT_CARRIED_FORCE = 27,     // index: place of a joint that holds nothing: what its drives exert
  OUT_CARRIED_MOMENT = 28,
  OUT_NORMAL_LOAD = 29,       // index: friction
  OUT_FRICTION_FORCE = 30,    // on the second link
  OUT_FRICTION_MOMENT = 31,   // about the joint's point
  OUT_FRICTION_POWER = 32,    // that it takes
  OUT_FRICTION_STATE = 33,    // FrictionState
  OUT_SELF_LOCKING = 34,      // 1 where a drive that would brake without friction has to push
  OUT_MULTIPLIER = 35,        // index: closing joint that is a relation; freedom: one of its terms, along which it acts
  OUT_MESH_FORCE = 36,        // index: closing joint that is a relation and acts by a force
  OUT_TENSION = 37,           // index: closing joint that is a relation; data: per multiplier, its magnitude, and beside
  OUT_BUSHING_FORCE = 38,     // index: load; freedom 1: and its damper, the next load; on the second link
  OUT_BUSHING_MOMENT = 39,    // about the second frame's origin
  OUT_BUSHING_SHIFT = 40,     // its deflection, in the axes of the first frame
  OUT_BUSHING_TURN = 41,
  OUT_REST_SHARE = 42         // of friction at rest, so that nothing has to drive
};

// One quantity that a run writes; outputs are no part of the plan (OutputsView).
template <class Number>
struct OutputOf {
  int type;
  int index;
  int order;
  int freedom;
  int slot;        // first column of the output array, or first register of a program
  Number data[3];  // local point or vector
  Number factor;   // to SI
};
using Output = OutputOf<double>;

enum ReadCode : int {
  READ_OUTPUT = 0,
  READ_ANGLE = 1,  // two registers: with its whole turns, and without
  READ_TIME = 2
};

// What a program reads into its first registers, of a row whose positions, or rates, are known.
template <class Number>
struct ReadOf {
  int kind;
  int turn;  // READ_ANGLE: its slot in Request::turned; of an input -2 - its number; -1: its whole turns are not counted
  OutputOf<Number> output;
};

// A curve of a table over a register; outside [low, high] it has no value, beyond its ends within them the end's.
struct ProgramCurve {
  int over;        // register
  int begin, end;  // into Program::knot
  double low, high;
};
// From x on: y + b u + c u^2 + d u^3 with u from x.
template <class Number>
struct KnotOf {
  Number x, y, b, c, d;
};
using Knot = KnotOf<double>;

// Arithmetic over quantities as data: registers of what is read, then one of each curve, then constants, then results of
// instructions, which are those of a tape (tape.hpp).
template <class Number>
struct ProgramOf {
  int reads, curves, knots, constants, instructions, outputs, kinks;
  int inputs;  // registers of reads and curves
  const ReadOf<Number>* read;
  const ProgramCurve* curve;
  const KnotOf<Number>* knot;
  const Number* constant;
  const std::uint8_t* operation;
  const std::int32_t* operand;  // instructions x 3
  const std::int32_t* output;   // registers
  const std::int32_t* kink;     // instructions that choose: where the outputs may bend or jump
  int registers() const { return inputs + constants + instructions; }
};
