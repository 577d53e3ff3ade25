// The first zero of the switches within a step that was tried, on its interpolation.
//
// Values here are taken times the side: good where they are not negative.
#pragma once

#include <functional>
#include <vector>

#include "integrator/lane_states.hpp"

// Of an event's values at the ends of a step: a dip below its zero that is none.
constexpr double TOUCH = 1e-12;

struct Crossing {
  enum Kind {
    NONE,
    AT_ONCE,  // the switch begins at a zero and goes the bad way from there
    WITHIN,
    FAULT,    // a place within could not be told
  };
  Kind kind = NONE;
  int which = -1;
  double part = 0.0;   // of the step
  double slope = 0.0;  // of the value by that part, negative
  int touched = -1;           // NONE: an event that comes to its zero within the step and goes back
  double touched_part = 0.0;  // of the step: where
};

class CrossingSearch {
 public:
  // Whether the other side of kink `which` makes no difference at a place (entries, with its slope and the values of all
  // switches) where a lane's value of it is bad.
  using IsSame = std::function<bool(int lane, int which, const double* time, const double* place, const double* slope,
                                    const double* values)>;
  // `ignored`: switches x lanes; kinks that are found to make no difference are added.
  CrossingSearch(LaneStates& states, Method& method, Flags* ignored, IsSame is_same);
  // Lanes that are bad at the end of their step, and such as may be bad inside alone.
  std::vector<Crossing> run(const Flags& crossed, const Flags& suspected);

 private:
  struct Bracket {
    double low = 0.0, high = 1.0;
    std::vector<double> at_low, at_high;
    double low_weight = 1.0, high_weight = 1.0;  // Illinois' rule: of an end that stays
    double tried = -1.0;
  };
  // Places that were looked at, in order.
  struct Samples {
    std::vector<double> part;
    std::vector<std::vector<double>> values;
    std::size_t insert(double at, const std::vector<double>& seen);
    bool deepest(double* at) const;
  };

  std::vector<double> values(const std::vector<double>& switches, int lane) const;
  // Asks the open lanes at part_; lanes with a fault are closed.
  void look();
  void forget_kinks(int lane);
  int first(int lane, double* where) const;
  bool is_bad(int lane) const;
  void find_touch(int lane, const Samples& samples);
  void scan(const Flags& crossed, const Flags& suspected);
  void look_early();
  void close_in();
  void move(int lane, bool is_bad);
  void end(int lane, Crossing::Kind kind);

  LaneStates& states_;
  Method& method_;
  Flags& ignored_;
  const IsSame is_same_;
  std::vector<double> compared_;  // switches x lanes: how bad a kink's value was where it made a difference
  std::vector<Bracket> bracket_;
  std::vector<Crossing> found_;
  std::vector<std::vector<double>> seen_;  // lanes: values at part_
  Flags open_;
  std::vector<double> part_, at_, place_, slope_, switches_;
};
