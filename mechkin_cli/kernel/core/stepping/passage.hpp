// A stretch of a path where a block comes near a singular place, walked through by arclength (arc.hpp): it is passed, or
// the branch turns back there (a dead centre), or crosses another one (a branch point).
#pragma once

#include <memory>

#include "stepping/arc.hpp"

enum class PassageEnd : int { through = 0, dead_centre = 1, branch_point = 2, lost = 3 };

// The walk of a block in trouble with all that could be carried along.
struct Passage {
  PassageEnd end = PassageEnd::lost;
  int block = 0;                  // and those in trouble that it hangs on
  int blame = -1;                 // lost: the block that stood in the way
  bool unbounded = false;         // lost: it went on and on while the path stood still
  std::unique_ptr<Arc> arc;
  std::vector<Node> nodes;        // sigma does not fall from one to the next
  Node beyond;                    // dead centre: the first node on its other side
  std::vector<double> crossings;  // sigma of the branch points that were passed
  long steps = 0, rejected = 0;

  double reach() const { return nodes.back().sigma; }
  // The branch at a sigma between the first node and the last: states and turns of closing joints, as a guess or,
  // where the path hardly moves, closed; `limit`: the largest correction that the guess may still need.
  bool at(double sigma, Node* node, double* limit) const;
};

// Walks from a node; `refused`: the step that could not be taken; `until`: the path's end.
void walk_passage(const StepLimits& limits, const Node& from, double refused, double until, Passage* passage);
