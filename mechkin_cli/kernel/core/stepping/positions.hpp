// Single positions near the rows of a finished run: continued from the nearest row that has a solution, straight in
// the inputs, so that an answer does not depend on what was asked before.
#pragma once

#include <vector>

#include "plan/frozen_plan.hpp"
#include "plan/output_list.hpp"
#include "stepping/tracker.hpp"

// Rows to start from; tables are columns x rows.
struct KnownRows {
  long rows;
  std::vector<double> inputs, rates, accelerations, jerks;  // inputs x rows; angles without their
  std::vector<double> whole;                                // whole turns
  std::vector<double> state;                                // states x rows
  std::vector<double> turn;                                 // turn slots x rows: continuous over the rows
};

// An output that is an angle, of a closing joint or of the tree, and its turn's slot; of an input -2 - its number.
struct TurningOutput {
  int slot, turn;
  bool closing;
};

class Positions {
 public:
  // By `make`, which refuses sizes that do not fit together.
  Positions(const FrozenPlan& plan, const OutputList& outputs, KnownRows rows, unsigned demand, int iterations,
            const StepLimits& limits, std::vector<TurningOutput> angles);
  Refusal prepare();

  // Fills `outputs` (slots); false where the branch ends before the inputs (inputs, their whole turns, and with them), or no row
  // closes there; and the condition, where it is demanded. Rates are those of the nearest row. One call at a time.
  bool solve(const double* inputs, const double* whole, const double* full, double* outputs, double* condition);

  int inputs() const { return plan_.view().inputs; }
  int slots() const { return outputs_.view().slots; }

 private:
  long nearest(const double* inputs, const double* whole) const;

  const FrozenPlan& plan_;
  const OutputList& outputs_;
  KnownRows rows_;
  unsigned demand_;
  int iterations_;
  StepLimits limits_;
  std::vector<TurningOutput> angles_;
  int turn_slots_ = 0;
  std::vector<char> memory_;
  std::vector<double> path_, path_whole_, start_, turn_, guess_, limit_, way_turn_, rates_, accelerations_, jerks_;
};
