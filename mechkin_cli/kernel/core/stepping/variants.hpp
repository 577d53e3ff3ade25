// Many variants of one plan: constants replayed from a tape, the first assembly by continuation from the base's, all
// rows followed, closed and read off.
//
// Every variant starts from the base variant, along the straight line in the parameters between the two, never from a
// neighbour: what it gives does not depend on the other variants, their order, chunks, lanes or threads.
#pragma once

#include <memory>
#include <vector>

#include "plan/frozen_plan.hpp"
#include "plan/output_list.hpp"
#include "tape/tape_store.hpp"
#include "stepping/tracker.hpp"

// How a variant ended.
enum class VariantEnd : int {
  complete = 0,    // every row is closed, on the branch of the first
  other_way = 1,   // a guard failed: to be built anew
  lost = 2,        // the continuation from the base ended before it came to the variant
  incomplete = 3,  // some row was not reached or did not close near its guess: to be looked at row by row
};

// An output that is an angle, of a closing joint or of the tree, and the slot of its turn as following carries it along;
// of an input -2 - its number.
struct ClosingAngle {
  int slot, turn;
  bool closing;
};

// The way of the inputs from the first assembly's row on (step 1) or back (-1): rows, and between them (row -1) the places
// where they turn or bend; `values` (inputs x places).
struct VariantWay {
  long step;
  std::vector<long> rows;
  std::vector<double> values;
  std::shared_ptr<const Course> course;  // of the inputs, where it is not straight
};

// What does not change from variant to variant. The tape's outputs are the plan's constants, then those of the outputs,
// then, where the inputs move with the parameters, their values, rates, accelerations and jerks (4 x inputs x rows).
struct VariantBase {
  std::vector<double> parameters;                            // the tape's inputs
  std::vector<double> inputs, rates, accelerations, jerks;   // inputs x rows each; angles without their
  std::vector<double> whole;                                 // whole turns
  std::vector<double> full;                                  // inputs x rows, with their whole turns
  std::vector<double> time;                                  // rows (s), or none
  std::vector<double> state;                                 // states, the first assembly
  double size;                                               // m, as the first assembly has it
  long rows, start_row;                                      // the first assembly stands at this row
  unsigned demand;
  int iterations;
  StepLimits continuation, following;
  std::vector<ClosingAngle> angles;
  double half_turn_side;                                     // rad: first angles so near to half a turn are +pi
  std::vector<VariantWay> ways;  // none where the inputs run straight from row to row
};

// A variant's first assembly.
struct VariantStart {
  VariantEnd end;
  double size;
  std::vector<double> state;
  std::vector<double> constants;            // of the plan
  std::vector<double> inputs, full, rates;  // of its row; `full` with whole turns
  bool turns;  // whether an input that moves with the parameters has whole turns, which the file takes off
};

// Where the rows of an incomplete variant end on one side of the first assembly: a dead centre or a branch point, or
// `lost` where nothing is known; `through` where they come to their last row.
struct VariantStop {
  PassageEnd kind = PassageEnd::through;
  std::vector<double> inputs;  // there, or where the branch was seen last; angles without whole turns
};

// How far an incomplete variant comes: rows [first, last) about the start's, and where it stops before and behind them.
struct VariantReach {
  long first, last;
  VariantStop stops[2];
};

// Arrays over variants, one after the other; nan for those that are not complete, but for the rows of `reach`.
struct VariantArrays {
  double* outputs;    // slots x rows each
  double* residual;   // rows each
  double* condition;  // rows each
  int* end;
  double* power_error = nullptr;  // rows each, with DEMAND_POWER, or null
  VariantReach* reach = nullptr;  // null: incomplete variants need no rows
};

class Variants {
 public:
  // By `make`, which refuses sizes that do not fit together.
  Variants(const TapeStore& tape, const FrozenPlan& plan, const OutputList& outputs, VariantBase base);
  Refusal prepare() const;

  // parameters: tape inputs x count. Variants that are not complete get nan.
  void run(long count, const double* parameters, const KernelUnit& unit, int threads, const VariantArrays& out) const;
  // The first assembly of one variant.
  VariantStart start(const double* parameters) const;

  long rows() const { return base_.rows; }
  unsigned demand() const { return base_.demand; }
  int slots() const { return outputs_.view().slots; }
  int parameters() const { return tape_.view().inputs; }
  const VariantBase& base() const { return base_; }
  const FrozenPlan& plan() const { return plan_; }

 private:
  const TapeStore& tape_;
  const FrozenPlan& plan_;
  const OutputList& outputs_;
  VariantBase base_;
};
