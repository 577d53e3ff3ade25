// What a motion keeps of the joints that rub: how each slips, lane by lane.
#pragma once

#include <vector>

#include "rows/aligned.hpp"
#include "response/sign_vectors.hpp"

// A stage's slips, as StageFound has them.
struct SlipStage {
  Packed rate, second, force, row, limit, loose, state, answer, level, told, span, way;
  Packed system;  // empty where nothing asks
};

struct SlipMemory {
  int columns = 0;
  std::vector<int> first;            // frictions + 1: of their columns
  Packed sense, quiet, aim, armed, span, way;  // as StageGiven has them
  std::vector<signed char> pushed;   // frictions x lanes: the sign of a force that was last more than friction holds
  std::vector<double> started;       // frictions x lanes: s: when a slip of one direction was let go, NaN once it goes
  std::vector<double> left;          // frictions x lanes: a slip back that is rounding of the rates where it has just begun
  std::vector<double> fastest;       // lanes: the largest rate of a chart so far
  std::vector<double> duration;      // lanes: of the motion, s
  std::vector<std::vector<Signs>> ways;  // lanes: senses in which what rests with forces that are not unique could go
  std::vector<unsigned char> measured;  // lanes: joints have carried a load by which forces are measured
  std::vector<unsigned char> rests;  // lanes: what sticks leaves nothing to move
  std::vector<unsigned char> blocked;  // lanes: at rest friction has no answer, or several
  std::vector<std::vector<int>> doubtful;  // lanes: whose friction was met last without an answer
};
