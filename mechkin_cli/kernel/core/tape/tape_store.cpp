#include "tape/tape_store.hpp"

#include <utility>

namespace {

constexpr std::size_t LONGEST_TAPE = 1 << 30;  // registers, outputs and guards are counted by int

}  // namespace

int TapeStore::switches() const {
  int count = 0;
  for (std::uint8_t o : operations_)
    count += o == TAPE_MAGNITUDE || o == TAPE_SIGN || o == TAPE_LARGER || o == TAPE_SMALLER ||
             (o >= TAPE_LESS && o <= TAPE_WHOLE);
  return count;
}

Result<TapeStore> TapeStore::make(int inputs, std::vector<double> constants, std::vector<std::uint8_t> operations,
                                  std::vector<std::int32_t> operands, std::vector<std::int32_t> outputs,
                                  std::vector<std::int32_t> guards, std::vector<std::uint8_t> expected,
                                  std::vector<std::uint8_t> advice) {
  TapeStore t;
  t.constants_ = std::move(constants), t.operations_ = std::move(operations), t.operands_ = std::move(operands);
  t.outputs_ = std::move(outputs), t.guards_ = std::move(guards);
  t.expected_ = std::move(expected), t.advice_ = std::move(advice);
  CHECK(t.check(inputs));
  t.tape_ = {inputs, (int)t.constants_.size(), (int)t.operations_.size(), (int)t.outputs_.size(),
             (int)t.expected_.size(), t.constants_.data(), t.operations_.data(), t.operands_.data(),
             t.outputs_.data(), t.guards_.data(), t.expected_.data(), t.advice_.data()};
  return t;
}

Refusal TapeStore::check(int inputs) const {
  REQUIRE(inputs > 0, "a tape has inputs");
  for (std::size_t size : {constants_.size(), operations_.size(), outputs_.size(), expected_.size()})
    REQUIRE(size < LONGEST_TAPE, "the tape is too long");
  REQUIRE(operands_.size() == 3 * operations_.size(), "three operands an instruction");
  REQUIRE(guards_.size() == 3 * expected_.size() && advice_.size() == expected_.size(), "three numbers a guard");
  const long first = inputs + (long)constants_.size(), last = first + (long)operations_.size();
  REQUIRE(last < (long)LONGEST_TAPE, "the tape is too long");
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    REQUIRE(operations_[i] < TAPE_OPERATIONS, "unknown operation");
    for (int k = 0; k < 3; ++k) {
      const std::int32_t r = operands_[3 * i + k];
      REQUIRE(r >= 0 && r < first + (long)i, "an operand lies before its instruction");
    }
  }
  for (std::int32_t r : outputs_) REQUIRE(r >= 0 && r < last, "unknown register");
  for (std::size_t g = 0; g < expected_.size(); ++g) {
    const int condition = guards_[3 * g];
    REQUIRE(condition >= TAPE_LESS && condition <= TAPE_EQUAL, "a guard asks for a comparison");
    for (int k = 1; k < 3; ++k) REQUIRE(guards_[3 * g + k] >= 0 && guards_[3 * g + k] < last, "unknown register");
  }
  return {};
}
