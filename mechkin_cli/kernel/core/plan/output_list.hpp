// The quantities that runs of a plan write: immutable, checked against the plan, shared by all plans of its structure.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "plan/frozen_plan.hpp"
#include "result.hpp"

// One quantity as it is asked for; `order`: which derivative (closing coordinates and points).
struct OutputRecord {
  int type, index, freedom, order;
  std::array<double, 3> data;
  double factor;
};

class OutputList {
 public:
  // Refuses a record that the plan cannot serve.
  static Result<OutputList> make(const FrozenPlan& plan, const std::vector<OutputRecord>& records);

  OutputsView view() const { return {(int)output_.size(), slots_, output_.data()}; }
  // What a run that writes them must demand.
  unsigned demand() const { return demand_; }
  bool fits(const FrozenPlan& plan) const { return plan.structure() == structure_; }

  // Numbered as FrozenPlan's: data (3), factor, record after record.
  std::size_t constants() const { return 4 * output_.size(); }
  void read_constants(double* out) const;
  // False, and nothing changed, if one is not finite.
  bool assign(const double* constants) noexcept;

 private:
  OutputList() = default;

  std::shared_ptr<const PlanStructure> structure_;
  std::vector<Output> output_;
  int slots_ = 0;
  unsigned demand_ = 0;
};

// Columns that an output fills, and what it demands beyond positions; `type` and `order` are valid.
int output_width(int type);
unsigned output_demand(int type, int order);
// Whether a type is one of OutputCode.
bool is_output(int type);
// Refuses a record that the plan cannot serve.
Refusal check_output(const Plan& p, const OutputRecord& r);
// Refuses if closing joint `c` has no coordinate that is its freedom's.
Refusal check_closing_coordinate(const Plan& p, int c, int freedom);
