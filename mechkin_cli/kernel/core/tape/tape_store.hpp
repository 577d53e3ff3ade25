// Owns the arrays of a tape, checked once.
#pragma once

#include <vector>

#include "result.hpp"
#include "tape/tape.hpp"

class TapeStore {
 public:
  // Refuses an operation or a register that is none.
  static Result<TapeStore> make(int inputs, std::vector<double> constants, std::vector<std::uint8_t> operations,
                                std::vector<std::int32_t> operands, std::vector<std::int32_t> outputs,
                                std::vector<std::int32_t> guards, std::vector<std::uint8_t> expected,
                                std::vector<std::uint8_t> advice);
  TapeStore(const TapeStore&) = delete;
  TapeStore(TapeStore&&) = default;  // the arrays stay where they are
  const Tape& view() const { return tape_; }
  // Instructions that choose: their ways are given where a tape is replayed with derivatives.
  int switches() const;

 private:
  TapeStore() = default;
  Refusal check(int inputs) const;

  std::vector<double> constants_;
  std::vector<std::uint8_t> operations_;
  std::vector<std::int32_t> operands_, outputs_, guards_;
  std::vector<std::uint8_t> expected_, advice_;
  Tape tape_{};
};
