// Owns the arrays of a program of quantities, checked against the plan whose rows it reads.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/output_list.hpp"
#include "plan/plan.hpp"

// What a program reads: a quantity by `kind`, with numbers in parts of which a parameter may vary (data and factor).
struct ReadRecord {
  int kind;
  OutputRecord output;
};
struct CurveRecord {
  int over;
  double low, high;
  std::vector<Knot> knots;  // x rising
};
struct ProgramRecord {
  std::vector<ReadRecord> reads;
  std::vector<CurveRecord> curves;
  std::vector<double> constants;
  std::vector<std::uint8_t> operations;
  std::vector<std::int32_t> operands, outputs, kinks;
};

// What a run whose rows a program reads must demand.
unsigned program_demand(const ProgramOf<double>& program);

class ProgramStore {
 public:
  ProgramStore() = default;
  // Refuses a record that the plan cannot serve, and registers that are none.
  static Result<ProgramStore> make(const Plan& plan, const ProgramRecord& record);

  ProgramOf<double> view() const;
  // Where the angles' whole turns are counted; for a plan whose inputs and blocks are all there.
  void find_turns(const Plan& plan);

 private:
  Refusal fill(const Plan& plan, const ProgramRecord& record);
  Refusal add_reads(const Plan& plan, const ProgramRecord& record);
  Refusal add_curves(const ProgramRecord& record);

  int inputs_ = 0;
  std::vector<ReadOf<double>> read_;
  std::vector<ProgramCurve> curve_;
  std::vector<Knot> knot_;
  std::vector<double> constant_;
  std::vector<std::uint8_t> operation_;
  std::vector<std::int32_t> operand_, output_, kink_;
};
