// A stretch of a path where a block comes near a singular place, walked through by arclength (arc.hpp): it is passed, or
// the branch turns back there (a dead centre), or crosses another one (a branch point).
#pragma once

#include <memory>

#include "arc.hpp"

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

// How far and how the branch goes on from a node, block by block.
struct Stretch {
  std::vector<Passage> passages;  // of each block in trouble
  int ends = -1;                  // the passage that reaches the least far
  long steps = 0, rejected = 0;
  const Passage& last() const { return passages[ends]; }
  PassageEnd end() const { return ends < 0 ? PassageEnd::lost : last().end; }
  double reach() const { return last().reach(); }
  // The passage that tells a block's unknowns.
  const Passage& of_block(int block) const;
  // Whether every block was carried along by one: none that hangs on two blocks in trouble is.
  bool carries_all(int blocks) const;
  bool at(const Plan& plan, const KernelUnit& unit, const std::vector<ClosingTurn>& turns, double sigma,
          Node* node, double* limit) const;
};

// `refused`: the step that could not be taken; `until`: the path's end.
Stretch walk_stretch(const Path& path, const KernelUnit& unit, const StepLimits& limits, const Node& from,
                     double refused, double until);
