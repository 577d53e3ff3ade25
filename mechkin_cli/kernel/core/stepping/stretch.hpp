// A stretch of a path that no plain step takes: the passages of all blocks in trouble there, put together.
#pragma once

#include "stepping/passage.hpp"

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
