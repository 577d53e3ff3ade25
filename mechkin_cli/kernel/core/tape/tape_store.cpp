#include "tape/tape_store.hpp"

#include <utility>

#include "plan/requirements.hpp"

namespace {

constexpr std::size_t LONGEST = 1 << 30;  // registers, outputs and guards are counted by int

}  // namespace

int TapeStore::switches() const {
  int count = 0;
  for (std::uint8_t o : operations_)
    count += o == TAPE_MAGNITUDE || o == TAPE_SIGN || o == TAPE_LARGER || o == TAPE_SMALLER ||
             (o >= TAPE_LESS && o <= TAPE_WHOLE);
  return count;
}

TapeStore::TapeStore(int inputs, std::vector<double> constants, std::vector<std::uint8_t> operations,
                     std::vector<std::int32_t> operands, std::vector<std::int32_t> outputs,
                     std::vector<std::int32_t> guards, std::vector<std::uint8_t> expected,
                     std::vector<std::uint8_t> advice)
    : constants_(std::move(constants)), operations_(std::move(operations)), operands_(std::move(operands)),
      outputs_(std::move(outputs)), guards_(std::move(guards)), expected_(std::move(expected)),
      advice_(std::move(advice)) {
  require(inputs > 0, "a tape has inputs");
  for (std::size_t size : {constants_.size(), operations_.size(), outputs_.size(), expected_.size()})
    require(size < LONGEST, "the tape is too long");
  require(operands_.size() == 3 * operations_.size(), "three operands an instruction");
  require(guards_.size() == 3 * expected_.size() && advice_.size() == expected_.size(), "three numbers a guard");
  const long first = inputs + (long)constants_.size(), last = first + (long)operations_.size();
  require(last < (long)LONGEST, "the tape is too long");
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    require(operations_[i] < TAPE_OPERATIONS, "unknown operation");
    for (int k = 0; k < 3; ++k) {
      const std::int32_t r = operands_[3 * i + k];
      require(r >= 0 && r < first + (long)i, "an operand lies before its instruction");
    }
  }
  for (std::int32_t r : outputs_) require(r >= 0 && r < last, "unknown register");
  for (std::size_t g = 0; g < expected_.size(); ++g) {
    const int condition = guards_[3 * g];
    require(condition >= TAPE_LESS && condition <= TAPE_EQUAL, "a guard asks for a comparison");
    for (int k = 1; k < 3; ++k) require(guards_[3 * g + k] >= 0 && guards_[3 * g + k] < last, "unknown register");
  }
  tape_ = {inputs, (int)constants_.size(), (int)operations_.size(), (int)outputs_.size(), (int)expected_.size(),
           constants_.data(), operations_.data(), operands_.data(), outputs_.data(), guards_.data(), expected_.data(),
           advice_.data()};
}
