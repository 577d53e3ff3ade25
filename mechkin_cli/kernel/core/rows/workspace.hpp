// What a pack of rows is computed in: poses, screws, motions, Jacobians and wrenches, all in one allocation.
#pragma once

#include "forces/actuation_memory.hpp"
#include "rows/chart.hpp"
#include "forces/friction_memory.hpp"
#include "joints/hung_bodies.hpp"
#include "joints/pairs.hpp"

namespace {

constexpr int MAX_CLOSING_ROWS = 6;

// Data of one pack of rows; every array lies in one allocation, see workspace_size.
struct Workspace {
  Pack *q, *rate, *acceleration, *jerk;  // states, columns, columns, columns
  Pose* pose;                     // links
  Twist* screw;                   // columns
  Motion* motion;                 // links; before them, at -1, ground's, which is zero
  Twist* convective;              // links: acceleration against the parent by its motion alone
  Twist* link_jerk;               // likewise: second derivative of the twist
  Wrench* carried;                // links: wrench on the link and all that the tree hangs on it
  Closure* closure;               // closing joints
  unsigned char* placed;          // closing joints: axes that the closure has
  Wrench* reaction;               // closing joints: on the second link
  Pack* jacobian;                 // per block rows x size, or a band's entries, factored in place
  Mask* swap;
  Pack* reflector;                // per block 2 x size: pivots and betas of a QR
  Pack* multiplier;               // closing rows
  Pack* right;                    // largest block
  Pack* scratch;                  // three times the largest full block squared, one with a band squared
  Pack* effort;                   // inputs
  Actuation actuation;
  Rubbing rubbing;
  Vec3* across;                   // hung bodies: what its end needs across its line
  Pack* holding;                  // hung bodies: couple about its line
  Pack* saved;                    // states before a trial step
  Pack* kept;                     // largest Jacobian: factors of lanes that are done
  Mask* kept_swap;
  Pack* load;                     // load values: of loads that vary
  Pack* law;                      // registers of Plan::law
  TermCurve* curve;               // terms: of those that are functions
  Pack* function;                 // registers of the largest function
  Course* course;                 // links, where there are functions: of those along curves and over surfaces
  bool* moves;                    // links: whether Newton on the link's block moves it (find_moving)
  bool* stands;                   // links: whether it moves against a parent that carries it and does not
  Pose* frame;                    // links: the frames of such joints on their parents
  Pack *direction, *origin;       // charts x columns, states: the chart's, see Chart
  Pack *place, *place_rate, *place_acceleration;  // charts

  MECHKIN_INLINE Chart chart() const { return {direction, origin, place, place_rate, place_acceleration}; }
};

// Gives the arrays of a workspace their places from `at` on; returns the bytes used.
inline long lay_out(const Plan& p, char* at, Workspace* w) {
  long used = 0;
  const auto take = [&](long bytes) {
    char* here = at + used;
    used += (bytes + 63) / 64 * 64;
    return here;
  };
  long squares = 0, pairs = 0, rows = 0, unknowns = 0, scratch = 0, kept = 0;
  const auto raise = [](long& most, long x) { most = x > most ? x : most; };
  for (int b = 0; b < p.blocks; ++b) {
    const Block& block = p.block[b];
    const long n = block.size, m = block.rows, entries = block.band_entries;
    squares += entries ? entries : m * n, pairs += entries ? p.band[block.column_end - 1].swaps : n * (n - 1) / 2;
    rows += m, unknowns += n;
    raise(scratch, entries ? m * n : 3 * m * m), raise(kept, entries ? entries : m * m);
  }
  const long pack = sizeof(Pack), largest = p.largest_block;
  w->q = (Pack*)take(p.states * pack);
  w->rate = (Pack*)take(p.columns * pack);
  w->acceleration = (Pack*)take(p.columns * pack);
  w->jerk = (Pack*)take(p.columns * pack);
  w->link_jerk = (Twist*)take((p.links + 1) * sizeof(Twist)) + 1;
  w->pose = (Pose*)take(p.links * sizeof(Pose));
  w->screw = (Twist*)take(p.columns * sizeof(Twist));
  w->motion = (Motion*)take((p.links + 1) * sizeof(Motion)) + 1;
  w->convective = (Twist*)take(p.links * sizeof(Twist));
  w->carried = (Wrench*)take(p.links * sizeof(Wrench));
  w->closure = (Closure*)take(p.closings * sizeof(Closure));
  w->placed = (unsigned char*)take(p.closings);
  w->reaction = (Wrench*)take(p.closings * sizeof(Wrench));
  w->jacobian = (Pack*)take(squares * pack);
  w->swap = (Mask*)take(pairs * sizeof(Mask));
  w->reflector = (Pack*)take(2 * unknowns * pack);
  w->multiplier = (Pack*)take(rows * pack);
  w->right = (Pack*)take((largest + MAX_CLOSING_ROWS) * pack);
  w->scratch = (Pack*)take(scratch * pack);
  w->kept = (Pack*)take(kept * pack);
  w->kept_swap = (Mask*)take(kept * sizeof(Mask));
  w->moves = (bool*)take(p.links * sizeof(bool));
  w->stands = (bool*)take(p.links * sizeof(bool));
  w->frame = (Pose*)take(p.links * sizeof(Pose));
  w->effort = (Pack*)take((p.inputs + 1) * pack);
  lay_out_actuation(p, take, &w->actuation);
  lay_out_friction(p, take, &w->rubbing);
  w->across = (Vec3*)take((p.hung_bodies + 1) * sizeof(Vec3));
  w->holding = (Pack*)take((p.hung_bodies + 1) * pack);
  w->saved = (Pack*)take(p.states * pack);
  w->direction = (Pack*)take(p.charts * p.columns * pack);
  w->origin = (Pack*)take((p.charts ? p.states : 0) * pack);
  w->place = (Pack*)take(p.charts * pack);
  w->place_rate = (Pack*)take(p.charts * pack);
  w->place_acceleration = (Pack*)take(p.charts * pack);
  if (at) w->motion[-1] = {zero_twist(), zero_twist()}, w->link_jerk[-1] = zero_twist();
  w->load = (Pack*)take(p.load_values * pack);
  w->law = (Pack*)take((long)p.law.registers() * pack);
  w->curve = (TermCurve*)take((p.functions.functions ? p.terms : 0) * sizeof(TermCurve));
  w->function = (Pack*)take((long)p.functions.registers * pack);
  w->course = (Course*)take((p.functions.functions ? p.links : 0) * sizeof(Course));
  return used;
}

}  // namespace
