// The straight line in the parameters from the base variant to another: a path on which the plan changes.
#pragma once

#include <vector>

#include "plan/frozen_plan.hpp"
#include "stepping/stepper.hpp"
#include "tape/tape.hpp"

// The inputs stand as they do at one row; where they depend on the parameters they move with them.
class DimensionPath : public Path {
 public:
  // `plan` is the path's to change; `inputs` (inputs) or nullptr: out of the tape's outputs from number `moving` on,
  // `stride` apart.
  DimensionPath(const Tape& tape, const KernelUnit& unit, const double* base, FrozenPlan* plan, const double* inputs,
                long moving, long stride);

  // Begins a line to other parameters; `near` are places that will be asked for.
  void aim(const double* target, const std::vector<double>& near);
  void at(double sigma, PathPoint* point) const override;
  const Plan& plan(double sigma) const override;
  bool varies() const override { return true; }

 private:
  const double* outputs(double sigma) const;
  void replay(const std::vector<double>& places) const;

  const Tape& tape_;
  const KernelUnit& unit_;
  const double* base_;
  const double* target_ = nullptr;
  FrozenPlan* plan_;
  const double* inputs_;
  long moving_, stride_;
  mutable std::vector<double> places_, outputs_, values_;  // places, places x outputs, inputs x new places
  mutable std::vector<std::uint8_t> verdict_;
  mutable std::vector<char> memory_;
  mutable bool is_plan_ = true;  // whether the constants of the place asked for last are a plan's
};

// Follows the branch from `start` at sigma 0 to sigma 1; false where it ends before.
bool follow_to_target(Stepper& stepper, const double* start, Node* node);
