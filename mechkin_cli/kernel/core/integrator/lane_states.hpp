// Where the lanes of an integration stand, and the one way in which a motion is asked.
//
// Arrays over components are [component][lane]: y = (u, v, w), slopes y' = (v, v', w').
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "integrator/integrator.hpp"

// The fault where the stages of an implicit step cannot be solved for. Reported as 0: a shorter step has them.
constexpr unsigned char NOT_SOLVED = 254;

using Flags = std::vector<unsigned char>;

bool any(const Flags& flags);

struct LaneStates {
  LaneStates(Motion& motion, const IntegratorSettings& settings);

  // Asks the motion about places of the lanes in `mask`, which keeps those that stand; the others get their fault.
  // Returns whether any is left. `slope` and `switches` are whole arrays.
  bool evaluate(const double* time, const double* y, bool is_end, Flags* mask, double* slope, double* switches);

  // The value of a switch (k of switches x lanes) times its side, negative where it is bad: one that rests at its zero is
  // bad where it has left it.
  double good(std::size_t k, double value) const { return side[k] ? side[k] * value : value == 0.0 ? 0.0 : -std::fabs(value); }
  // Turns a switch to its other side; from rest to that of a value.
  void turn(std::size_t k, double value) { side[k] = (std::int8_t)(side[k] ? -side[k] : value < 0.0 ? -1 : 1); }

  // What of a time about the lane's step is rounding.
  double time_rounding(int lane) const;
  // Largest |v| of a lane in y.
  double speed_in(const double* y, int lane) const;
  // What an error of one tolerance is in each component, (size) x lanes, for a step from one y to another; of quadratures
  // with their rates at y and y_end.
  void error_scales(const double* a, const double* b, double* scale) const;

  Motion& motion;
  const IntegratorSettings& settings;
  const int lanes, freedoms, quadratures, size;  // size: components of y
  const std::vector<SwitchKind> kinds;
  const long entries;  // size x lanes

  std::vector<double> time, y, slope;              // where the lanes stand
  std::vector<double> duration;                    // lanes: from the start to the last row
  std::vector<double> switch_value;                // switches x lanes, there
  std::vector<std::int8_t> side;                   // switches x lanes
  std::vector<double> speed, work;                 // lanes; quadratures x lanes: the largest so far
  std::vector<double> step, until;                 // lanes: the step that is tried, and its end

  // What a step that was tried left; of lanes without a fault.
  Flags fault;
  std::vector<double> y_end, slope_end, switch_end;
  std::vector<double> error;                       // lanes: in tolerances, at most 1 is good
  std::vector<double> factor;                      // lanes: the next step in parts of this one, as the errors want it
  std::vector<double> reached;                     // lanes: where a fault was met, in parts of the step
  // Switch values of the step's inside: at two places, `inner` parts of the step, and the least side * value anywhere.
  double inner[2] = {0.0, 0.0};
  std::vector<double> switch_inner[2], switch_least;

  std::vector<LaneReport> report;
  std::vector<long> evaluations;                   // lanes

 private:
  bool drop_faults(Flags* mask);

  Flags fresh_fault_;
  std::vector<double> finite_;
};

// A way to make a step. Arrays of the lanes in LaneStates.
class Method {
 public:
  virtual ~Method() = default;
  // Tries the steps of these lanes. Leaves y_end, slope_end, error ..., or a fault.
  virtual void attempt(LaneStates& lanes, const Flags& mask) = 0;
  // The step of these lanes was taken, or refused for its error; called before y is moved on.
  virtual void taken(LaneStates& lanes, int lane) = 0;
  virtual void refused(LaneStates& lanes, int lane) = 0;
  // The rates where a lane stands have changed.
  virtual void forget(int lane) { (void)lane; }
  // Makes the last tried step ready to be interpolated; lanes that get a fault leave the mask.
  virtual void prepare_dense(LaneStates& lanes, Flags* mask) = 0;
  // y at `part` (lanes) of that step, for the lanes in the mask.
  virtual void dense(const LaneStates& lanes, const Flags& mask, const double* part, double* y) const = 0;
};
