// DOP853: Dormand and Prince's explicit Runge-Kutta method of order 8 with Hairer's error estimate and interpolation of
// order 7 (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, II.5, II.6 and II.10).
#pragma once

#include "integrator/lane_states.hpp"

class Dop853 : public Method {
 public:
  explicit Dop853(const LaneStates& lanes);
  void attempt(LaneStates& lanes, const Flags& mask) override;
  void taken(LaneStates& lanes, int lane) override;
  void refused(LaneStates& lanes, int lane) override;
  void prepare_dense(LaneStates& lanes, Flags* mask) override;
  void dense(const LaneStates& lanes, const Flags& mask, const double* part, double* y) const override;

  // Whether the steps of a lane are found to be short for stability alone; asked once after each step that was taken.
  bool is_stiff(int lane) const { return stiff_[lane] >= 15; }

 private:
  void estimate(LaneStates& lanes, const Flags& mask);
  void control(LaneStates& lanes, const Flags& mask);
  void note_switches(LaneStates& lanes, int stage);
  void resolve_switches(LaneStates& lanes, const Flags& mask);
  double unresolved(const LaneStates& lanes, int which, int lane) const;
  double stability(const LaneStates& lanes, int lane) const;

  std::vector<double> slopes_;            // stages, [stage][component][lane]
  std::vector<double> steps_;             // the steps, for each component
  std::vector<double> place_, last_;      // a stage's y; that of the last stage
  std::vector<double> stage_time_, mean_, fifth_, third_, scale_, worst_fifth_, worst_third_;
  std::vector<double> switches_, staged_; // values of a stage; of all stages, [stage][switch][lane]
  std::vector<double> coefficients_;      // of the interpolation, 7 x components x lanes
  std::vector<double> wanted_, root_, root_before_;  // lanes: see `control`; of the last step taken
  Flags was_refused_;
  std::vector<int> stiff_, not_stiff_;    // lanes: counts of Hairer's test
};
