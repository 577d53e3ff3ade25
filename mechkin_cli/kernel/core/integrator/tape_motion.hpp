// A motion whose rates are a tape: any equations written down, without a mechanism.
#pragma once

#include <vector>

#include "integrator/integrator.hpp"
#include "rows/units.hpp"
#include "tape/tape_store.hpp"

struct TapeEvent {
  int lane, which;
  bool rising;
  double time;
  std::vector<double> state;  // x, v, w
};

// The tape's inputs are time, x [n], v [n], w [q], sides of the switches [s] and parameters; its outputs v' [n], w' [q],
// switches [s] and a number that is a fault where it is not zero. The chart of a lane is x = origin + scale u, with the
// scales one after the other, one step each. For a switch that moves the tape is given how often it did, not its side.
constexpr unsigned char OUT_OF_REACH = 253;

class TapeMotion : public Motion {
 public:
  struct Shape {
    int lanes, freedoms, quadratures;
    std::vector<SwitchKind> switches;
    std::vector<bool> stops;  // switches: whether they end a lane
    double bounce;            // what v is multiplied by where a switch moves
    double reach;             // distance from the chart's origin, in x, from which on a place is a fault OUT_OF_REACH
  };
  // `state` (x, v, w) and `parameters`, each x lanes. By `make`, which refuses a tape of other numbers.
  TapeMotion(const TapeStore& tape, Shape shape, const std::vector<double>& state, std::vector<double> parameters,
             std::vector<double> scales, long rows);
  Refusal prepare();

  int lanes() const override { return shape_.lanes; }
  int freedoms() const override { return shape_.freedoms; }
  int quadratures() const override { return shape_.quadratures; }
  std::vector<SwitchKind> switches() const override { return shape_.switches; }
  void rates(const Places& places, const Rates& rates) override;
  void accept(const unsigned char* lanes, const double* time, double* y, double* rates, double* longest) override;
  void row(const unsigned char* lanes, const long* row, const double* time, const double* y, bool inside) override;
  bool event(int lane, int which, bool rising, double time) override;

  bool move(int lane, int which, double time, double* y) override;

  // The first y.
  const std::vector<double>& start() const { return start_; }
  // (x, v, w) x lanes of each row, NaN where none was reached.
  const std::vector<double>& rows() const { return rows_; }
  const std::vector<TapeEvent>& events() const { return events_; }
  long inside() const { return inside_; }

 private:
  int size() const { return 2 * shape_.freedoms + shape_.quadratures; }
  double state(int component, int lane, const double* y) const;

  const TapeStore& tape_;
  Shape shape_;
  std::vector<double> parameters_, scales_;
  long row_count_;
  std::vector<double> start_, origin_, scale_, now_, inputs_, outputs_, rows_;
  std::vector<long> accepted_, moved_;
  std::vector<std::uint8_t> verdict_;
  std::vector<char> memory_;
  std::vector<TapeEvent> events_;
  long inside_ = 0;
};
