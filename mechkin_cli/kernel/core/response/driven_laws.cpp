#include "response/driven_laws.hpp"

#include <cmath>
#include <utility>

#include "rows/units.hpp"

DrivenLaws::DrivenLaws(const TapeStore* tape, std::vector<double> edges, std::vector<double> constants,
                       std::vector<double> ways, std::vector<double> units, double time_unit, std::vector<double> held)
    : tape_(tape), edges_(std::move(edges)), constants_(std::move(constants)), ways_(std::move(ways)),
      units_(std::move(units)), time_unit_(time_unit), held_(std::move(held)) {}

Refusal DrivenLaws::prepare() const {
  REQUIRE(tape_ || (units_.empty() && edges_.empty()), "laws are a tape");
  REQUIRE(time_unit_ > 0.0 && std::isfinite(time_unit_), "the time's unit is positive");
  if (!tape_) return {};
  const Tape& t = tape_->view();
  const std::size_t cells = edges_.size() + 1;
  REQUIRE(t.outputs == (int)units_.size(), "units: one for each output of the tape");
  REQUIRE(constants_.size() == cells * (t.inputs - 1), "constants: one for each further input and cell");
  REQUIRE(ways_.size() == cells * tape_->switches(), "ways: one for each switch and cell");
  for (std::size_t e = 1; e < edges_.size(); ++e) REQUIRE(edges_[e] > edges_[e - 1], "edges rise");
  return {};
}

DrivenLaws::Memory DrivenLaws::memory() const {
  if (units_.empty()) return {};
  const Tape& t = tape_->view();
  return {std::vector<double>((std::size_t)t.inputs), std::vector<double>(3 * units_.size()),
          std::vector<char>((std::size_t)kernel_unit(2)->jets_size(t))};
}

void DrivenLaws::at(int cell, double time, int lane, int lanes, double* value, double* rate, double* second,
                    Memory* memory) const {
  const int n = (int)units_.size();
  for (std::size_t h = 0; h < held_.size(); ++h) {
    const std::size_t to = (n + h) * lanes + lane;
    value[to] = held_[h], rate[to] = second[to] = 0.0;
  }
  if (!n) return;
  const Tape& t = tape_->view();
  const KernelUnit& unit = *kernel_unit(2);
  const int more = t.inputs - 1, switches = tape_->switches();
  double *const given = memory->given.data(), *const out = memory->found.data();
  given[0] = time / time_unit_;
  for (int k = 0; k < more; ++k) given[k + 1] = constants_[(std::size_t)cell * more + k];
  unit.replay_jets(t, given, ways_.data() + (std::size_t)cell * switches, out, memory->replay.data());
  for (int i = 0; i < n; ++i) {
    value[i * lanes + lane] = out[3 * i] / units_[i];
    rate[i * lanes + lane] = out[3 * i + 1] / (units_[i] * time_unit_);
    second[i * lanes + lane] = out[3 * i + 2] / (units_[i] * time_unit_ * time_unit_);
  }
}
