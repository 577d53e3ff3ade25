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
  std::vector<double> motion;      // accelerations of the chart
};

// The trial that holds, -1 for none or several. What moves goes its way, what sticks is held; where forces of some that stick
// are not unique these stay where no trial that moves some of them holds. `open` are the joints that were tried, `forced` one
// that starts to slip at the border of what it can hold, or -1. A trial without one answer leaves none, unless what sticks in
// it goes one way with its friction either way.
int trial_that_holds(const std::vector<SlipTrial>& trials, const std::vector<int>& open, int forced);
