// A plan, the quantities that its runs write and the tape of its constants, as text from elsewhere.
//
//   mechkin plan 1
//   plan x3ff0000000000000 [x0000000000000000 x0000000000000000 x0000000000000000] x3ff0000000000000
//   add_tree_joint 0 -1 x0000000000000000 [x3ff0000000000000 ...]
//   ...
//   output 3 0 1 0 [x0000000000000000 x0000000000000000 x0000000000000000] x3ff0000000000000
//   tape 1 [x3ff0000000000000] [2] [[0 1 0]] [2] [] [] []
//
// A record a line: a call of PlanBuilder by its name (`plan` makes the builder) with its arguments in their order, then the
// OutputRecords, then a TapeStore. Integers are decimal; a real number is `x` and the sixteen hexadecimal digits of its
// bits, or an integer; a list stands in brackets. So a text says the same bits everywhere, and what it says is checked as
// every plan is.
#pragma once

#include <optional>
#include <string_view>

#include "plan/plan_builder.hpp"
#include "tape/tape_store.hpp"

struct PlanText {
  FrozenPlan plan;
  OutputList outputs;
  std::optional<TapeStore> tape;
};

// Refuses what is no such text, with the number of the line.
Result<PlanText> read_plan(std::string_view text);
