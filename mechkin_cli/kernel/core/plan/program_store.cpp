#include "plan/program_store.hpp"

#include <cmath>
#include <cstring>

#include "rows/units.hpp"
#include "stepping/stepper.hpp"
#include "tape/tape.hpp"

namespace {

constexpr std::size_t LONGEST = 1 << 24;  // of each list: registers are counted by int

bool is_kink(int operation) {
  return operation == TAPE_MAGNITUDE || operation == TAPE_SIGN || operation == TAPE_LARGER ||
         operation == TAPE_SMALLER || operation == TAPE_WHOLE;
}

}  // namespace

unsigned program_demand(const ProgramOf<double>& program) {
  unsigned demand = 0;
  for (int k = 0; k < program.reads; ++k)
    if (const ReadOf<double>& read = program.read[k]; read.kind != READ_TIME)
      demand |= output_demand(read.output.type, read.output.order);
  return demand;
}

Result<ProgramStore> ProgramStore::make(const Plan& plan, const ProgramRecord& record) {
  ProgramStore store;
  CHECK(store.fill(plan, record));
  return store;
}

Refusal ProgramStore::fill(const Plan& plan, const ProgramRecord& record) {
  constant_ = record.constants, operation_ = record.operations, operand_ = record.operands, output_ = record.outputs;
  kink_ = record.kinks;
  for (std::size_t size : {record.reads.size(), record.curves.size(), constant_.size(), operation_.size(),
                           output_.size(), kink_.size()})
    REQUIRE(size < LONGEST, "the program is too long");
  CHECK(add_reads(plan, record));
  CHECK(add_curves(record));
  REQUIRE(all_finite(constant_.data(), constant_.size()), "a program's numbers must be finite");
  REQUIRE(operand_.size() == 3 * operation_.size(), "three operands an instruction");
  const long first = inputs_ + (long)constant_.size(), last = first + (long)operation_.size();
  for (std::size_t i = 0; i < operation_.size(); ++i) {
    REQUIRE(operation_[i] < TAPE_OPERATIONS, "unknown operation");
    for (int k = 0; k < 3; ++k) {
      const std::int32_t r = operand_[3 * i + k];
      REQUIRE(r >= 0 && r < first + (long)i, "an operand lies before its instruction");
    }
  }
  for (std::int32_t r : output_) REQUIRE(r >= 0 && r < last, "unknown register");
  for (std::int32_t k : kink_)
    REQUIRE(k >= 0 && k < (long)operation_.size() && is_kink(operation_[k]), "a kink is an instruction that chooses");
  return {};
}

Refusal ProgramStore::add_reads(const Plan& plan, const ProgramRecord& record) {
  for (const ReadRecord& r : record.reads) {
    const OutputRecord& o = r.output;
    REQUIRE(r.kind >= READ_OUTPUT && r.kind <= READ_TIME, "unknown kind of reading");
    ReadOf<double> read = {r.kind, -1, {}};
    read.output.slot = inputs_;
    if (r.kind == READ_TIME) {
      inputs_ += 1;
    } else {
      CHECK(check_output(plan, o));
      REQUIRE(!(output_demand(o.type, o.order) & ~(unsigned)DEMAND_VELOCITY),
              "a program reads positions and rates alone");
      const bool coordinate = o.type == OUT_STATE || (o.type == OUT_CLOSING && o.order == 0);
      REQUIRE(r.kind != READ_ANGLE || coordinate, "an angle is a coordinate");
      read.output = {o.type, o.index, o.order, o.freedom, inputs_, {}, o.factor};
      std::memcpy(read.output.data, o.data.data(), sizeof read.output.data);
      inputs_ += r.kind == READ_ANGLE ? 2 : output_width(o.type);
    }
    read_.push_back(read);
  }
  return {};
}

Refusal ProgramStore::add_curves(const ProgramRecord& record) {
  for (const CurveRecord& c : record.curves) {
    REQUIRE(c.over >= 0 && c.over < inputs_, "a curve runs over what is read");
    REQUIRE(!c.knots.empty() && knot_.size() + c.knots.size() < LONGEST, "a curve has points, and not too many");
    REQUIRE(std::isfinite(c.low) && std::isfinite(c.high), "a curve's range is finite");
    const int begin = (int)knot_.size();
    for (const Knot& k : c.knots) {
      const double numbers[] = {k.x, k.y, k.b, k.c, k.d};
      REQUIRE(all_finite(numbers, 5), "a curve's numbers must be finite");
      REQUIRE((int)knot_.size() == begin || k.x > knot_.back().x, "a curve's points rise");
      knot_.push_back(k);
    }
    curve_.push_back({c.over, begin, (int)knot_.size(), c.low, c.high});
  }
  inputs_ += (int)curve_.size();
  return {};
}

void ProgramStore::find_turns(const Plan& p) {
  for (ReadOf<double>& read : read_) {
    if (read.kind != READ_ANGLE) continue;
    const Output& o = read.output;
    read.turn = -1;
    if (o.type == OUT_CLOSING) {
      for (const ClosingTurn& t : closing_turns(p, *kernel_unit(2)))
        if (t.closing == o.index && t.freedom == o.freedom) read.turn = t.slot;
      continue;
    }
    for (const TreeTurn& t : tree_turns(p, *kernel_unit(2)))
      if (t.state == o.index) read.turn = t.slot;
    for (int i = 0; i < p.inputs; ++i)
      if (p.column_state[p.input_column[i]] == o.index) read.turn = -2 - i;
  }
}

ProgramOf<double> ProgramStore::view() const {
  ProgramOf<double> p = {};
  p.reads = (int)read_.size(), p.curves = (int)curve_.size(), p.knots = (int)knot_.size();
  p.constants = (int)constant_.size(), p.instructions = (int)operation_.size();
  p.outputs = (int)output_.size(), p.kinks = (int)kink_.size(), p.inputs = inputs_;
  p.read = read_.data(), p.curve = curve_.data(), p.knot = knot_.data(), p.constant = constant_.data();
  p.operation = operation_.data(), p.operand = operand_.data(), p.output = output_.data(), p.kink = kink_.data();
  return p;
}
