// How joints that rub may slip from rest: trials of senses, and the one that holds (docs/friction.md, Motions).
#pragma once

#include <vector>

#include "response/sign_vectors.hpp"

// A trial: the senses of all joints, and what they would do. Vectors over joints.
struct SlipTrial {
  Signs way, sense;                // as it was tried, and as it came out
  bool decided = true;             // friction has one answer
  std::vector<double> second;      // the slip's derivative along the sense, of what sticks its size
  std::vector<double> rounding;    // what of it is none
  std::vector<char> loose, holds;  // of what sticks: its force is not unique; is within what it can hold
  std::vector<double> excess;      // of what sticks: the slip's derivative by what of its force is beyond that
  bool is_ruled_out = false;       // no friction forces, however many there may be, let all that starts go its way
  std::vector<double> motion;      // accelerations of the chart
};

// The friction forces z of what slips, before they are solved for: with z = mu N(z), N a sum of magnitudes of what contacts
// carry, what starts from rest is to go its way.
struct SlipSystem {
  struct Contact {
    int friction;
    double weight;
    std::vector<double> load;  // 3 x (1 + frictions): without friction, by a unit of each
  };
  // Numbers of a stage for that many frictions and contacts: whether loads are not unique, coefficients, accelerations, loads.
  static long numbers(long frictions, long contacts) {
    return 1 + frictions + (frictions + 3 * contacts) * (1 + frictions);
  }
  bool is_open;                     // what sticks loads what slips with forces that are not unique
  std::vector<double> coefficient;  // of what sticks zero
  std::vector<double> second;       // frictions x (1 + frictions): a slip's derivative along its unit, and by units of z
  std::vector<char> starts;         // frictions: is to go along its unit
  std::vector<Contact> contacts;
};

// Whether no z solves it: boxes of z are cut, and halved, until none is left.
bool has_no_slip(const SlipSystem& system);

// The trial that holds, -1 for none or several. What moves goes its way, what sticks is held; where forces of some that stick
// are not unique these stay where no trial that moves some of them holds. `open` are the joints that were tried, `forced` one
// that starts to slip at the border of what it can hold, or -1. A trial without one answer leaves none, unless it is ruled out,
// or what sticks in it goes one way with its friction either way, or not where a trial that holds moves some of it.
int trial_that_holds(const std::vector<SlipTrial>& trials, const std::vector<int>& open, int forced);
