// The plan of a mechanism: plain constant data that every compiled unit of the kernel reads.
//
// Lengths are scaled by a power of two near the mechanism's size and measured from the kernel's
// origin; angles are radians, masses kg, times s. Moving links are numbered in tree order and link k is
// carried by tree joint k; ground is -1. Link frames: the frame of the link's tree joint, moved.
#pragma once

enum JointCode : int { JOINT_R = 0, JOINT_P = 1, JOINT_H = 2, JOINT_C = 3, JOINT_S = 4, JOINT_CODES = 5 };

// Axes (columns of the rotation) and origin of a frame, in a link's frame or in ground axes.
struct Frame {
  double x[3], y[3], z[3], o[3];
};

struct TreeJoint {
  int type;
  int parent;  // link, -1: ground
  int state;   // first entry of the state vector
  int column;  // first column (freedom)
  double pitch;  // H: slide per radian
  Frame at;    // the joint's frame in the parent link
};

struct ClosingJoint {
  int type;
  int first, second;        // links, -1: ground
  Frame on_first, on_second;
  int row;                  // first closing equation within its block
  int loop_begin, loop_end;  // into Plan::loop
};

// One freedom of a loop: a tree joint on the way to the closing joint's second link (+1) or first link (-1).
struct LoopEntry {
  int joint;
  double sign;
};

// A smallest set of closing equations and unknowns that is solved together: n equations, n columns.
struct Block {
  int joint_begin, joint_end;    // into Plan::order: tree joints placed by this block
  int closing_begin, closing_end;  // closing joints
  int column_begin, column_end;  // into Plan::unknown
  int size;
};

struct LinkInertia {
  int present;
  double mass;
  double centre[3];  // in the link's frame
  double tensor[6];  // xx yy zz xy xz yz about the mass centre, link axes, divided by length unit^2
};

enum LoadCode : int {
  LOAD_FORCE_GROUND = 0,  // force in ground axes at a point of a link
  LOAD_FORCE_LINK = 1,    // force in link axes
  LOAD_TORQUE_GROUND = 2,
  LOAD_TORQUE_LINK = 3,
  LOAD_JOINT_TORQUE = 4,  // couple about a joint's axis, on the second link, opposite on the first
  LOAD_JOINT_FORCE = 5,   // force along a joint's axis, likewise
  LOAD_SPRING = 6,        // between two points; data: stiffness, free length, preload
  LOAD_DAMPER = 7,        // between two points; data: damping
  LOAD_JOINT_SPRING_THETA = 8,
  LOAD_JOINT_SPRING_S = 9,
  LOAD_JOINT_DAMPER_THETA = 10,
  LOAD_JOINT_DAMPER_S = 11
};

struct Load {
  int type;
  int link, other;    // LOAD_JOINT_*: link = joint reference (tree k >= 0, closing c as -1-c)
  double point[3], other_point[3];
  double vector[3];   // force, torque, or the data of springs and dampers
};

enum OutputCode : int {
  OUT_STATE = 0,         // index: state
  OUT_RATE = 1,          // index: column
  OUT_ACCELERATION = 2,  // index: column
  OUT_CLOSING_THETA = 3,  // index: closing joint; order 0, 1, 2
  OUT_CLOSING_S = 4,
  OUT_POINT = 5,         // index: link; order 0, 1, 2
  OUT_VECTOR = 6,        // index: link
  OUT_OMEGA = 7,
  OUT_ALPHA = 8,
  OUT_JOINT_FORCE = 9,   // index: joint reference
  OUT_JOINT_MOMENT = 10,  // about the joint's point
  OUT_JOINT_MOMENT_ORIGIN = 11,
  OUT_EFFORT = 12,       // index: input
  OUT_SHAKING_FORCE = 13,
  OUT_SHAKING_MOMENT = 14,
  OUT_INERTIA_FORCE = 15,
  OUT_INERTIA_MOMENT = 16
};

struct Output {
  int type;
  int index;
  int order;
  int slot;        // first column of the output array
  double data[3];  // local point or vector
  double factor;   // to SI
};

// What a run has to do beyond positions (the demand plan).
enum Demand : unsigned {
  DEMAND_VELOCITY = 1,
  DEMAND_ACCELERATION = 2,
  DEMAND_FORCES = 4,  // closing wrenches, wrenches of tree joints, efforts
  DEMAND_CONDITION = 8,
  DEMAND_POWER = 16
};

// The joint as users know it: which frame carries its point and axis, which way it is in the tree.
struct JointPlace {
  int first, second;         // links
  double point[3], axis[3];  // in the second link's frame
  double sign;               // +1: the tree (or the closing joint) goes from the first link to the second
  int effort_theta, effort_s;  // input whose drive acts on this coordinate, or -1
  double force_per_effort;     // of a drive on s
};

struct Plan {
  int links, states, columns, closings, blocks, inputs, loads, outputs, slots;
  int largest_block;
  const TreeJoint* joints;
  const JointPlace* tree_places;
  const ClosingJoint* closing;
  const JointPlace* closing_places;
  const LoopEntry* loop;
  const Block* block;
  const int* order;
  const int* unknown;        // columns solved for, grouped by block
  const int* rest;           // tree joints that no block places
  int rest_count;
  const int* input_column;   // inputs
  const int* column_state;   // state of a scalar column, -1 for a column of S
  const int* column_joint;   // tree joint of a column
  const int* column_block;   // block that solves for a column, -1: input
  const int* column_place;   // its place among that block's unknowns
  const double* column_weight;  // scaled-block weight of a column: size / length unit for slides, 1 for angles
  const LinkInertia* inertia;
  const Load* load;
  const Output* output;
  double gravity[3];         // in length units
  double length;             // the length unit in m, a power of two
  double origin[3];          // the kernel's origin in m
  double row_weight;         // length unit / size: closure lengths to parts of the size
};

// One call: arrays are stored column after column ([k * rows + row]).
struct Request {
  long rows;
  const double* inputs;         // inputs x rows
  const double* rates;          // inputs x rows, may be null without DEMAND_VELOCITY
  const double* accelerations;  // inputs x rows, likewise
  const double* guess;          // states x rows
  double* states;               // states x rows
  double* outputs;              // slots x rows, may be null
  double* velocities;           // columns x rows, may be null
  double* second;               // columns x rows, may be null
  double* residual;             // rows
  double* correction;           // rows: largest change of an unknown against its guess, lengths in units
  double* orientation;          // rows, may be null: product of the signs of the square blocks' determinants;
                                // it changes where a fold lies between two places. Needs a demand.
  double* condition;            // rows, with DEMAND_CONDITION
  double* power_error;          // rows, with DEMAND_POWER
  unsigned char* flags;         // rows
  unsigned demand;
  int iterations;               // at most
  double tight, coarse, accept;  // residual, step, residual: see tolerances.py
};

enum RowFlag : unsigned char {
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
