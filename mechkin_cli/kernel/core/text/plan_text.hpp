// A plan, the quantities that its runs write and the tape of its constants, as text from elsewhere.
//
//   mechkin plan 1
//   plan x3ff0000000000000 [x0000000000000000 x0000000000000000 x0000000000000000] x3ff0000000000000
//   add_tree_joint 0 -1 x0000000000000000 [x3ff0000000000000 ...]
//   ...
//   output 3 0 1 0 [x0000000000000000 x0000000000000000 x0000000000000000] x3ff0000000000000
//   tape 1 [x3ff0000000000000] [2] [[0 1 0]] [2] [] [] []
//   variants [x3fe0000000000000] [...] ...
//   way 1 [0 1 2] [...]
//   course 1 [] ...
//
// A record a line: a call of PlanBuilder by its name (`plan` makes the builder) with its arguments in their order, then the
// OutputRecords, then a TapeStore, then what variants of the plan have in common: a VariantBase (`variants`, its numbers in
// their order, limits of steps as lists), its ways, and behind a way its course with the tape of that; or, of the plan of a
// free motion, a ResponseBase (`response`). Integers are decimal; a real number is `x` and the sixteen hexadecimal digits of its
// bits, or an integer; a list stands in brackets. So a text says the same bits everywhere, and what it says is checked as
// every plan is.
#pragma once

#include <deque>
#include <optional>
#include <string_view>

#include "plan/plan_builder.hpp"
#include "response/varied_response.hpp"
#include "stepping/variants.hpp"
#include "tape/tape_store.hpp"

struct PlanText {
  FrozenPlan plan;
  OutputList outputs;
  std::optional<TapeStore> tape;
  std::optional<VariantBase> variants;
  std::deque<TapeStore> course_tapes;  // which the courses of the ways refer to
  std::optional<ResponseBase> response;
};

// Refuses what is no such text, with the number of the line.
Result<PlanText> read_plan(std::string_view text);

// A tape alone: the line `mechkin tape 1`, then its record.
Result<TapeStore> read_tape(std::string_view text);
