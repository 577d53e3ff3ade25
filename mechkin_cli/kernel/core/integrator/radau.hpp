// Radau IIA of three stages, order 5, for stiff lanes (Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd
// edition, IV.8): simplified Newton on the transformed stages, an error estimate of order 3, predictive step control.
//
// As u' = v, the matrices (m I - J) of the unknowns (u, v) shrink to m^2 I - m Jv - Ju of u alone, one real and one
// complex a step, where v' = f(u, v), Ju = df/du, Jv = df/dv. Quadratures follow from the stages and are no unknowns.
#pragma once

#include "integrator/lane_states.hpp"
#include "arithmetic/small_lu.hpp"

class Radau : public Method {
 public:
  explicit Radau(const LaneStates& states);
  void attempt(LaneStates& states, const Flags& mask) override;
  void taken(LaneStates& states, int lane) override;
  void refused(LaneStates& states, int lane) override;
  void forget(int lane) override { lane_[lane].has_jacobian = false; }
  void prepare_dense(LaneStates&, Flags*) override {}
  void dense(const LaneStates& states, const Flags& mask, const double* part, double* y) const override;

 private:
  // What one lane's Newton iteration works with; vectors over (u, v), stages by their transforms.
  struct Lane {
    bool has_jacobian = false;
    bool is_doubtful = false, differs = false;  // Jacobians: to be checked by shorter probes; one was another by them
    std::vector<double> jacobian;  // (v', w') by (u, v), row-major
    SmallLu<double> real;
    SmallLu<Complex> complex;
    double real_shift = 0.0;
    Complex complex_shift;
    std::vector<double> w[3], dw[3];
    double change = 0.0;           // of the last iteration, in tolerances
    int iterations = 0;
    bool is_solved = false;
    double error_before = 0.0, step_before = 0.0;
    bool was_refused = false;
  };

  void differentiate(LaneStates& s, Flags* mask);
  Flags differentiate_column(LaneStates& s, int column, double probe, Flags* open);
  void factorise(LaneStates& s, Flags* mask);
  void iterate(LaneStates& s, Flags* mask);
  bool ask_stages(LaneStates& s, Flags* mask);
  void update(LaneStates& s, int lane, Flags* mask, Flags* solved);
  bool converges(const LaneStates& s, int lane, double change);
  void integrate_quadratures(LaneStates& s, int lane);
  void end(LaneStates& s, Flags* mask);
  void estimate(LaneStates& s, const Flags& mask);
  void lane_error(const LaneStates& s, int lane, const double* slope, std::vector<double>* error) const;
  double size_of(const LaneStates& s, int lane, const std::vector<double>& error) const;
  void solve(const Lane& l, double* u, double* v) const;
  void solve(const Lane& l, Complex* u, Complex* v) const;
  void fail(LaneStates& s, int lane, Flags* mask);

  const int n_, q_, lanes_;
  const long entries_;
  std::vector<Lane> lane_;
  std::vector<double> increment_[3], slope_[3];  // stages: components x lanes
  std::vector<double> place_, at_, probe_, scale_, switches_, shift_;
};
