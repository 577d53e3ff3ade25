// The march of the lanes: steps are planned, tried, judged and taken, lane by lane but all lanes at once.
#pragma once

#include <memory>
#include <vector>

#include "integrator/dop853.hpp"
#include "integrator/lane_states.hpp"
#include "integrator/radau.hpp"

// How a lane goes on.
struct LaneControl {
  bool running = true;
  bool implicit = false;
  double wanted = 0.0;                   // the step that errors want
  double room = __builtin_inf();         // the step that faults leave, wider again with each step taken
  double room_growth = 1.0;
  double longest = __builtin_inf();      // the step that the chart bears, as the motion says
  bool is_cut = false;                   // the step was made shorter for a row
  bool was_refused = false;
  long next_row = 0;
  long attempts = 0;
  // The way to end a step at a zero of a switch: number, derivative of side * value by time, the step to try,
  // the one tried before and its value.
  int landing = -1;
  int landing_tries = 0, landing_searches = 0;
  double landing_slope = 0.0, landing_step = 0.0, landing_before = 0.0, landing_value = 0.0;
  bool landed = false;
  bool sides_checked = true;             // against their values where the lane stands
  bool sides_stale = false;              // a side has changed since the values were told
  std::vector<int> passed;               // switches: how often they were passed at this place
  std::vector<long> met;                 // switches: how often they were passed at all
  std::vector<double> largest;           // switches: their largest values at the ends of steps
  std::vector<double> before;            // switches: their values' sizes where the last step began
  std::vector<double> noise;             // switches: the largest rounding of theirs that was measured
  std::vector<int> jumped;               // events that were passed as a kink was
  // Switches that are let alone until a step is taken: kinks met again and again where both sides give the same.
  Flags let_alone;
};

class March {
 public:
  March(Motion& motion, const IntegratorSettings& settings, const double* time, const std::vector<double>& y,
        const RowTimes& rows);
  std::vector<LaneReport> run();

 private:
  // march.cpp: steps
  void plan(int lane);
  void round(Method& method, Flags mask);
  void judge(Method& method, Flags* mask);
  void shorten_for_fault(int lane);
  void refuse(int lane, double step);
  void take(Method& method, Flags mask);
  void move_on(const Flags& mask);
  void settle_ignored(int lane);
  void rewiden(int lane);
  void go_implicit(int lane);
  void finish(int lane, LaneEnd end, int which = -1);
  double least(int lane) const;

  // march_start.cpp
  void start(const double* time, const std::vector<double>& y);
  void first_sides(Flags* mask);
  void first_steps(const Flags& mask);
  void size_up(const Flags& mask);

  // march_rows.cpp
  double row_time(int lane, long row) const { return rows_.at(lane, row); }
  bool has_row(const LaneControl& c) const { return c.next_row < rows_.count; }
  double cut_for_rows(int lane, double step);
  void rows_inside(Method& method, Flags* mask);
  void rows_here(const Flags& mask);

  // crossings.cpp
  bool is_ignored(int lane, int which) const;
  bool is_crossed(int lane, int but) const;
  bool is_crossed_by(int lane, int which) const;
  bool may_dip(int lane, int landing) const;
  bool may_dip_beside(int lane) const;
  double least_inside(int lane, int which, bool stages_alone) const;
  void hold(int lane, int which);
  void find_touch(int lane);
  void meet_events(const Flags& mask);
  void jump(int lane, int which);

  // sides.cpp
  std::vector<double> roundings(const Flags& mask, const std::vector<double>& values);
  std::vector<std::int8_t> sides_ahead(const Flags& mask, const std::vector<double>& slope,
                                       const std::vector<double>& values, const std::vector<double>& rounding);
  void settle_sides(Flags mask, std::vector<int> known, bool is_start);
  bool has_changed(int lane, int but, const std::vector<double>& values) const;
  void check_sides(const Flags& mask);
  bool is_wrong(int lane, int which) const;
  void renew(int lane);

  // kinks.cpp
  void mute(Flags* mask);
  bool shifts_kinks(int lane, int which, const double* values) const;
  void compare_where_passed(int which, Flags* mask);
  void compare_together(const Flags& mask);
  void turn_with_outer(const std::vector<std::vector<int>>& which, const double* time, const double* place,
                       const double* values, const Flags& mask, Flags* told);
  void compare_sides(int which, const double* time, const double* place, const double* slope, const double* values,
                     Flags* mask);
  bool bends_nothing(int lane, const double* y, const double* a, const double* b, double step) const;
  bool rests(int lane, const double* y) const;
  void look_for_crossings(Method& method, Flags* mask);
  void land(int lane, Flags* mask);
  void search(Method& method, const Flags& crossed, const Flags& suspected, Flags* mask);
  void pass(const Flags& mask, const std::vector<int>& which);
  void pass_landed(const Flags& mask);
  void tell(int lane, int which);

  LaneStates states_;
  const RowTimes rows_;
  Dop853 explicit_;
  std::unique_ptr<Radau> implicit_;  // made when it is first needed
  std::vector<LaneControl> control_;
  std::vector<double> size_, place_, values_, part_, at_;
  std::vector<double> other_slope_, scale_;  // entries: on the other side of a kink; what an error of one tolerance is
  Flags muted_;  // switches x lanes: kinks that bend nothing within the step that was tried
  std::vector<long> row_;
};
