// The plan of a mechanism: plain constant data that every compiled unit of the kernel reads.
//
// Lengths are scaled by a power of two near the mechanism's size and measured from the kernel's
// origin; angles are radians, masses kg, times s. Moving links are numbered in tree order and link k is
// carried by tree joint k; ground is -1. Link frames: the frame of the link's tree joint, moved.
//
// The constants that parameters reach are of the type `Number`: a double, or a pack where each lane has a plan of its
// own with the same structure, or a number of two parts (wide_plan.hpp). `Plan`, `Frame` ... are those of the constants of this compiled unit.
#pragma once

#include "arithmetic/band_row.hpp"
#include "plan/friction_records.hpp"
#include "plan/functions.hpp"
#include "plan/program.hpp"

// Displacements that carry links in the tree; other pairs are chains of these (joint_table.py).
// TREE_L hangs the hung body between two points (hung_bodies.hpp); TREE_G carries along a curve, TREE_A over a surface.
enum TreeCode : int {
  TREE_R = 0,
  TREE_P = 1,
  TREE_H = 2,
  TREE_C = 3,
  TREE_S = 4,
  TREE_W = 5,
  TREE_L = 6,
  TREE_G = 7,
  TREE_A = 8,
  TREE_CODES = 9
};

// Pairs that close loops have their place in the list of pairs.hpp as code. PAIR_DISTANCE is no pair of the file format: the
// distance of two points that a hung body keeps; nor are relations between coordinates, whose equation is an angle, or a length.
enum PairCode : int { PAIR_DISTANCE = 0, RELATION_OF_ANGLES = 1, RELATION_OF_LENGTHS = 2 };
inline bool is_relation(int type) { return type == RELATION_OF_ANGLES || type == RELATION_OF_LENGTHS; }

// Axes (columns of the rotation) and origin of a frame, in a link's frame or in ground axes.
template <class Number>
struct FrameOf {
  Number x[3], y[3], z[3], o[3];
};

template <class Number>
struct TreeJointOf {
  int type;
  int parent;  // link, -1: ground
  int state;   // first entry of the state vector
  int column;  // first column (freedom)
  Number pitch;  // H: slide per radian; TREE_G, TREE_A: length units per m, negative where it carries backwards
  int hung;       // TREE_L: into Plan::hung
  int function;   // TREE_G, TREE_A: of Plan::functions, places (m) along the frame's axes; else -1
  FrameOf<Number> at;    // the joint's frame in the parent link
};

template <class Number>
struct ClosingJointOf {
  int type;
  int first, second;        // links, -1: ground
  FrameOf<Number> on_first, on_second;
  Number parameter;         // U: cosine of the angle between its axes; Sc: of axis and pin at home, where the two
                            // frames coincide in x; a distance: its length, the slide at zero; a relation: its sum
  int slide;                // a distance: tree joint of its slide, -1 without one
  double slide_sign;        // a distance: rate of its length by the slide
  int row;                  // first closing equation within its block
  int loop_begin, loop_end;  // into Plan::loop
  int path_begin, path_end;  // likewise, where a relation acts by a force between two links: the way from one to the other.
                             // `first` carries the point of contact o and the force on the latter per multiplier, x, and
                             // per its magnitude, y, in on_first
  int is_pair_of_forces;     // and another such force in on_second
  int is_pushed;             // what goes by the magnitude stands among the frictions, which are solved for together
  int columns_begin, known_begin, columns_end;  // into Plan::loop_column: its block's unknowns, then what is known
  int meets_all;             // whether these are all unknowns of its block
};

// One freedom of a loop: a tree joint on the way to the closing joint's second link (+1) or first link (-1). Of a relation
// between coordinates: a part of a joint in it, passed from its first link to its second (+1) or back, and its term; else -1.
struct LoopEntry {
  int joint;
  double sign;
  int term;
};

// A column of the tree that a loop passes, in the order of its entries.
struct LoopColumn {
  int loop, freedom;  // the entry, into Plan::loop, and the freedom of its joint
  int column;
  int place;          // among the unknowns of the closing joint's block, -1: it is known there
};

// A term of a relation: `factor` times the coordinate of an axis, which is the freedom of the entry's tree joint; -1: of
// another part of the same joint. With a function, `factor` times its value at the coordinate, which is `argument` of it in SI.
template <class Number>
struct TermOf {
  int freedom, axis;
  Number factor;
  int function;  // of Plan::functions; -1: none
  Number argument;
};

// A hung body: a body from a point of `first` (the origin of its tree joint) to a point of `second`, where it has a rod that
// slides along the body, too. It turns with its line and does not spin about it.
template <class Number>
struct HungBodyOf {
  int body, rod;      // links; rod -1: one rigid body
  int first, second;  // links, -1: ground
  int closing;
  Number point[3];    // on `second`
  Number line[3];     // from point to point in the body's frame, unit vector
};

// A smallest set of closing equations and unknowns that is solved together: `rows` equations, `size` unknowns.
struct Block {
  int joint_begin, joint_end;    // into Plan::order: tree joints placed by this block
  int closing_begin, closing_end;  // closing joints
  int column_begin, column_end;  // into Plan::unknown
  int rows, size;                // rows > size: overconstrained
  int charts;                    // the last of its rows are those of a chart (chart.hpp)
  bool placeless;                // as many relations between coordinates as unknowns, which do not go by places
  bool is_explicit;              // one such whose unknown is no function's argument, so that it gives the unknown
  int band_entries;              // of its Jacobian as a band, with a border of charts (arithmetic/band.hpp); 0: a full matrix
  long jacobian_at, swap_at;     // where its matrix and the exchanges of its rows begin among those of all blocks
  int equation_at;               // its first equation among those of all blocks
  long full_at;                  // where its matrix begins if all are full ones, as Request::jacobian has them
};

template <class Number>
struct LinkInertiaOf {
  int present;
  Number mass;
  Number centre[3];  // in the link's frame
  Number tensor[6];  // xx yy zz xy xz yz about the mass centre, link axes, divided by length unit^2
};

enum LoadCode : int {
  LOAD_FORCE_GROUND = 0,  // force in ground axes at a point of a link
  LOAD_FORCE_LINK = 1,    // force in link axes
  LOAD_TORQUE_GROUND = 2,
  LOAD_TORQUE_LINK = 3,
  LOAD_COORDINATE = 4,  // along a joint's coordinate, on the second link, opposite on the first
  LOAD_SPRING = 5,      // between two points; data: stiffness, free length, preload
  LOAD_DAMPER = 6,      // between two points; data: damping
  LOAD_COORDINATE_SPRING = 7,
  LOAD_COORDINATE_DAMPER = 8,
  LOAD_BUSHING = 9,         // between two frames, in all six directions (forces/bushings.hpp)
  LOAD_BUSHING_DAMPER = 10
};

template <class Number>
struct LoadOf {
  int type;
  int link, other;    // LOAD_COORDINATE*: link = axis, other = joint reference of the coordinate
  int freedom;        // of the coordinate in that joint; LOAD_BUSHING*: into Plan::bushing
  Number point[3], other_point[3];
  Number vector[3];   // force, torque, or the data of springs and dampers
  int varying;        // first of its values among the outputs of Plan::law instead of `vector`, -1: constant
  int turn;           // LOAD_COORDINATE_SPRING on an angle: its slot in Request::turned; of an input -2 - its number in
                      // Request::whole; -1: turns do not matter
};

// Frames that coincide in the drawing, unless it is not assembled; the upper half of a symmetric matrix, row after row, of
// forces and moments per deflection or its rate; where a spring has no force. In length units.
template <class Number>
struct BushingOf {
  FrameOf<Number> on_first, on_second;
  Number matrix[21], free[6];
};

// What a run writes, in the order of its slots.
struct OutputsView {
  int count, slots;
  const Output* output;
};

// What a run has to do beyond positions (the demand plan).
enum Demand : unsigned {
  DEMAND_POSITION = 0,
  DEMAND_VELOCITY = 1,
  DEMAND_ACCELERATION = 2,
  DEMAND_FORCES = 4,  // closing wrenches, wrenches of tree joints, efforts
  DEMAND_CONDITION = 8,
  DEMAND_POWER = 16,
  DEMAND_JERK = 32,
  DEMAND_SINGULAR = 64,  // with DEMAND_CONDITION: to rounding instead of to 1 %
  DEMAND_EVERYTHING = 127,  // that can be asked for from outside
  DEMAND_JACOBIAN = 128     // the blocks' Jacobians alone, which a Request without a demand does not get
};

// A joint as its user knows it: where its wrench is read off, and where its point rides.
template <class Number>
struct JointPlaceOf {
  int reference;        // tree joint k >= 0 (of a chain of parts, any), or closing joint c as -1-c
  int first, second;    // links
  int point_on;         // link that carries the point (a sphere's centre rides on the first link)
  Number point[3];
  double sign;          // -1: the tree or the body passes the joint from its second link to its first
  int drive_begin, drive_end;  // into Plan::drive
  int free_begin, free_end;    // into Plan::free
};

enum FreeCode : int {
  FREE_ALONG = 0,   // along, or about, a direction
  FREE_SQUARE = 1,  // in, or about, all directions square to it
  FREE_ALL = 2,
  FREE_CODES = 3
};

// Directions of slides, or of turns through its point, that a joint leaves free whatever its coordinates are: it
// transmits no force along, and no moment about, them.
template <class Number>
struct FreeMotionOf {
  int place, slide, code;
  int link;  // that carries the direction
  Number vector[3];
};

// The unit wrench on the second link that does work on one coordinate of a joint and none on its others: a couple or,
// for a slide, a force through the joint's point, along the sum of two vectors carried by two links.
template <class Number>
struct CoordinateAxisOf {
  int place;
  int slide;
  int link[2];
  Number vector[2][3];
  int carrier, freedom;  // of a parameter of a curve or surface, its tree joint: the force does work along that; else -1
};

// A drive: input and the axis it works on, -1 for a coordinate that no user knows; an H driven along s has
// force = effort / pitch.
template <class Number>
struct DriveOf {
  int input, axis;
  Number scale;
};

// An input that the motor of another one, which follows none, moves through a constraint.
struct InputConstraint {
  int input, leader;
};

// A coordinate at which an effort acts instead of at the inputs (actuation.hpp): its axis, and where its value is.
struct Actuator {
  int axis, reference, freedom;
};

// What plans of one structure share.
struct PlanShape {
  int links, states, columns, closings, hung_bodies, blocks, inputs, loads, load_values;
  int places, axes, drives, frees, loop_entries, loop_columns, terms, order_count, unknowns, size_points, frictions, contacts, bushings;
  int largest_block;  // rows
  int charts;         // coordinates of the one block's chart, whose unknowns they determine; 0: inputs do
  int driven;         // inputs, the first ones, that motors or actuators answer for; the others are held
  int actuators, input_constraints;
  const Actuator* actuator;
  const InputConstraint* input_constraint;
  const LoopEntry* loop;
  const LoopColumn* loop_column;  // closing joint after closing joint
  const Block* block;
  const int* order;
  const int* unknown;        // columns solved for, grouped by block
  const BandRow* band;       // unknowns: of blocks with a band
  const int* rest;           // tree joints that no block places
  int rest_count;
  const int* input_column;   // inputs
  const int* column_state;   // state of a scalar column, -1 for a column of S
  const int* column_joint;   // tree joint of a column
  const int* column_block;   // block that solves for a column, -1: input
  const int* column_place;   // its place among that block's unknowns
  FunctionTable functions;
};

template <class Number>
struct PlanOf : PlanShape {
  const TreeJointOf<Number>* joints;
  const ClosingJointOf<Number>* closing;
  const HungBodyOf<Number>* hung;
  const TermOf<Number>* term;
  const KnotOf<Number>* function_knot;
  const Number* function_constant;
  const JointPlaceOf<Number>* place;
  const CoordinateAxisOf<Number>* axis;
  const DriveOf<Number>* drive;
  const FreeMotionOf<Number>* free;
  const Number* column_weight;  // scaled-block weight of a column: size / length unit for slides, 1 for angles
  const LinkInertiaOf<Number>* inertia;
  const LoadOf<Number>* load;
  const BushingOf<Number>* bushing;
  ProgramOf<Number> law;     // the values of loads that vary
  const FrictionOf<Number>* friction;
  const ContactOf<Number>* contact;
  const Output* size_point;  // joint points, whose box at the first assembly tells the size; of ground: in m, about the origin
  Number gravity[3];         // in length units
  Number length;             // the length unit in m, a power of two
  Number origin[3];          // the kernel's origin in m
  Number size;               // of the mechanism in m: what residual and condition are measured by
  Number row_weight;         // length unit / size: closure lengths to parts of the size
};

#ifndef MECHKIN_WIDE_PLAN  // else wide_plan.hpp says what they are: of packs, or of numbers of two parts
using Frame = FrameOf<double>;
using TreeJoint = TreeJointOf<double>;
using ClosingJoint = ClosingJointOf<double>;
using HungBody = HungBodyOf<double>;
using Term = TermOf<double>;
using LinkInertia = LinkInertiaOf<double>;
using Load = LoadOf<double>;
using Bushing = BushingOf<double>;
using JointPlace = JointPlaceOf<double>;
using FreeMotion = FreeMotionOf<double>;
using CoordinateAxis = CoordinateAxisOf<double>;
using Drive = DriveOf<double>;
using Friction = FrictionOf<double>;
using Contact = ContactOf<double>;
using Plan = PlanOf<double>;
#endif

// An angle of a closing joint, which is known up to whole turns only, or with freedom < 0 its orientation, the second
// link against the first, a quaternion that is known up to its sign.
struct ClosingTurn {
  int closing, freedom;
  int slot, width;  // first of its values, and how many: 1 or 4
};

enum BlockUse : unsigned char {
  BLOCK_LEFT = 0,    // its unknowns stay as they are
  BLOCK_SOLVED = 1,
  BLOCK_HELD = 2     // they are given, and its equations looked at, which need not hold
};

// Blocks whose unknowns are given instead of solved for; the arrays as in a Request, unknowns and equations of the held
// blocks one after the other.
struct Held {
  const unsigned char* use;      // blocks: BlockUse
  bool complete;                 // whether no block is left that the plan's remaining joints hang on
  const double* rates;           // unknowns x rows
  const double* accelerations;
  double* equations;             // equations x rows
  double* first;                 // their first derivatives, with DEMAND_VELOCITY
  double* second;                // their second ones, with DEMAND_ACCELERATION
};

// One call: arrays are stored column after column ([k * rows + row]).
struct Request {
  long rows;
  const double* inputs;         // inputs x rows
  const double* rates;          // inputs x rows, may be null without DEMAND_VELOCITY
  const double* accelerations;  // inputs x rows, likewise
  const double* jerks;          // inputs x rows, with DEMAND_JERK
  const double* guess;          // states x rows
  const double* constraint_rates;           // constraints x rows: rates of led inputs by those of their leaders, may be null without
                                // DEMAND_FORCES
  const double* turned;         // turn slots x rows, may be null: closing joints' continuous angles to less than half a
                                // turn, whole turns of the tree's angles; springs go by them
  const double* whole;          // inputs x rows, may be null: whole turns that the inputs are without, likewise
  const double* full;           // inputs x rows, may be null: inputs with their whole turns, as laws of loads read them
  const double* time;           // rows, may be null: what laws of loads read as time (s)
  OutputsView wanted;           // what `outputs` receives
  OutputsView wanted_second;    // the second parts of their numbers, where these have two; empty: zero
  double* states;               // states x rows
  double* outputs;              // slots x rows, may be null
  double* velocities;           // columns x rows, may be null
  double* second;               // columns x rows, may be null
  double* residual;             // rows
  double* correction;           // rows: largest change of an unknown against its guess, lengths in units
  double* side;                 // blocks x rows, may be null: sign of a square block's determinant, else 1. Needs a
                                // demand.
  double* pivot;                // blocks x rows, may be null: least pivot of each block's Jacobian. Needs a demand.
  double* jacobian;             // blocks' entries x rows, may be null: Jacobians of the blocks. Needs a demand.
  const ClosingTurn* turns;     // turn_count: what the next three hold, widths x rows; with DEMAND_ACCELERATION
  int turn_count;
  double* turn;                 // angles and quaternions as the kernel finds them, a quaternion scalar first
  double* turn_first;           // derivatives; of a quaternion the angular velocity about the first link's axes
  double* turn_second;          // (its fourth value is zero), and that one's derivative
  double* condition;            // rows, with DEMAND_CONDITION
  double* power_error;          // rows, with DEMAND_POWER
  double* loads;                // load_values x rows, may be null: values of varying loads, with DEMAND_FORCES
  unsigned char* undefined;     // rows, may be null: whether some of them has no value, likewise
  unsigned char* flags;         // rows
  unsigned demand;
  int shift;                    // 0, or 1 and 2: parts of the null space added to reactions
  int iterations;               // at most
  double tight, coarse, accept;  // residual, step, residual: see tolerances/closing.py
  const Held* held;             // null: every block is solved
  const double* chart;          // charts x columns x rows: the chart's directions, see chart.hpp; null without charts
  const double* chart_origin;   // states x rows; null: the guess
  const double* chart_place;    // charts x rows; null: zero
  const double* chart_rates;    // charts x rows, may be null without DEMAND_VELOCITY
  const double* chart_accelerations;  // charts x rows, likewise
  const double* friction_told;  // frictions x TOLD_NUMBERS x rows, see FrictionTold; null: rates tell all
  double* chart_forces;         // charts x rows, may be null: what would have to act along u, with DEMAND_FORCES
};

enum RowFlag : unsigned char {
  ROW_GOOD = 0,
  ROW_NOT_CONVERGED = 1,
  ROW_SIDE_CONDITION = 2
};

// Levenberg-Marquardt from many starts on one block; states of earlier blocks and inputs as given.
struct SearchRequest {
  long rows;
  int block;
  const double* inputs;  // inputs x rows
  double* states;        // states x rows: starts in, end points out
  double* residual;      // rows
  unsigned char* flags;  // rows
  int iterations;
  double accept;
};
