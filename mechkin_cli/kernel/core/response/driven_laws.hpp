// Coordinates that are driven along a motion: their laws of time, value, rate and acceleration at any moment.
//
// The laws are a tape over the time in the file's unit, smooth between edges (the cells of a Course); beyond an edge the
// formula of its cell goes on.
#pragma once

#include <vector>

#include "tape/tape_store.hpp"

class DrivenLaws {
 public:
  // `edges`: moments (s), rising, between cells; `constants` (cells x inputs of the tape but the first) and `ways` (cells
  // x switches of the tape); `units` (inputs): what the tape's outputs are divided by; `time_unit` (s); `held`: values of
  // further inputs, at rest. Without a tape there are only these. By `make`, which refuses what does not fit together.
  DrivenLaws(const TapeStore* tape, std::vector<double> edges, std::vector<double> constants, std::vector<double> ways,
             std::vector<double> units, double time_unit, std::vector<double> held);
  DrivenLaws(const DrivenLaws&) = delete;
  DrivenLaws(DrivenLaws&&) = default;
  Refusal prepare() const;

  const std::vector<double>& edges() const { return edges_; }
  int inputs() const { return (int)(units_.size() + held_.size()); }
  // What `at` works in: one for each thread.
  struct Memory {
    std::vector<double> given, found;
    std::vector<char> replay;
  };
  Memory memory() const;
  // Of a cell at a time (s), into arrays [input * lanes + lane].
  void at(int cell, double time, int lane, int lanes, double* value, double* rate, double* second, Memory* memory) const;

 private:
  const TapeStore* tape_;
  std::vector<double> edges_, constants_, ways_, units_;
  double time_unit_;
  std::vector<double> held_;
};
