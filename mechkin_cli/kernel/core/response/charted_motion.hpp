// The motion of mechanisms under forces as the integrator sees it: in the coordinates of a chart (chart.hpp) that is laid
// anew at the end of each step, with the loops closed at every stage. Lanes are variants with plans of one structure.
//
// The origin's tangent space gives the chart's directions, lengths in parts of the size; a stage whose Jacobian is not
// told to be joined with the origin's by regular ones is a fault, and the step is tried again shorter: the test that
// steps of a sweep use (judge.cpp).
#pragma once

#include <vector>

#include "integrator/integrator.hpp"
#include "response/charted_friction.hpp"
#include "response/crossing_curve.hpp"
#include "response/driven_laws.hpp"
#include "response/motion_unit.hpp"
#include "response/slip_trial.hpp"
#include "rows/aligned.hpp"
#include "stepping/stepper.hpp"

// Where a lane begins.
struct MotionStart {
  const Plan* plan;         // with a chart, valid as long as the motion
  const double* state;      // states, closed
  const double* first;      // columns: their rates
  double time;              // s
  const double* tangent;    // charts x columns: rates that the loops allow, as many as freedoms, independent
};

enum StopKind : int {
  STOP_CROSSING = 0,  // the value passes `at` the `count`th time, up (+1), down (-1) or either way (0)
  STOP_TURNING = 1,   // the value, a rate, changes its sign the `count`th time
  STOP_TURNS = 2,     // the value lies `count` turns from where it began
  STOP_CONDITION = 3  // the value, 1 where a condition holds and else 0, is 1 the `count`th time, the start counted
};

// What ends a motion, by one of the watched values of the plan's program.
struct MotionStop {
  int kind, direction, count;
  double at;
  // Powers of length and of rate in the value's dimension: what rounding leaves of a value that is zero goes by the size
  // (m) and by the speed. `rates` below zero: not known.
  int lengths, rates;
};

struct MotionLimits {
  double tight, coarse, accept, jump, radius;
  int iterations;
  bool straight;  // branch points are passed along the smooth continuation
  double longest;  // s: a step
};

// A branch point that was passed: the end of the step, and the states (states) at the point.
struct PassedBranchPoint {
  double time;
  std::vector<double> state;
};

// A stop whose value came to `at` and went back, and when (s).
struct TouchedStop {
  int stop;
  double time;
};

// Takes the rows of a lane in blocks, as they are reached: the first `rows` of its arrays, of which the first has the number
// `first`. False: no more are wanted, and the motion may end.
class RowTaker {
 public:
  virtual ~RowTaker() = default;
  virtual bool take(long first, long rows) = 0;
};

// Rows of a lane, column after column; rows that are not reached stay as they are. Without rows nothing is written.
// One row more is for the place where a stop ends the motion between rows.
struct MotionRows {
  long rows;
  double* state;          // states
  double* direction;      // charts x columns
  double* chart_rate;     // charts
  double* chart_second;   // charts
  double* turn;           // turn slots
  double* friction_told;  // frictions x TOLD_NUMBERS
  double* work;           // 2: put in, lost; kg, length units, s
  unsigned char* flags;   // StageFlag
  // Where there are more rows than these, which then are a block: it is handed on whenever it is full and another row
  // comes, so that the last rows stay here. Null: all rows are here.
  RowTaker* taker = nullptr;
};

class ChartedMotion : public Motion {
 public:
  // `unit` has as many lanes as there are starts; a lane without a variant of its own repeats another's.
  ChartedMotion(const MotionUnit& unit, const std::vector<MotionStart>& starts, const MotionLimits& limits,
                const std::vector<MotionRows>& rows, const std::vector<MotionStop>& stops, const DrivenLaws* driven);

  int lanes() const override { return lanes_; }
  int freedoms() const override { return plan_.charts; }
  int quadratures() const override { return works() + (plan_.frictions ? slips_.columns + plan_.frictions : 0); }
  int works() const override { return 2; }
  std::vector<SwitchKind> switches() const override;
  void begin(const signed char* side, unsigned char* lanes) override;
  void rates(const Places& places, const Rates& rates) override;
  void accept(const unsigned char* lanes, const double* time, double* y, double* rates, double* longest) override;
  void sizes(const unsigned char* lanes, double* size) override;
  double longest() const override { return limits_.longest; }
  bool is_driven() const override { return plan_.inputs > 0; }
  void row(const unsigned char* lanes, const long* row, const double* time, const double* y, bool inside) override;
  bool event(int lane, int which, bool rising, double time) override;
  int event_at_start(int lane) override;
  void touch(int lane, int which, double time) override;
  bool move(int lane, int which, double time, double* y) override;
  bool finds_more(int lane) override;
  bool gives_up(int lane) const override;
  // A lane that repeats the first one, without rows of its own, is left with it.
  bool is_left(int lane) const override { return left_[rows_[lane].rows ? lane : 0]; }

  // Joints (numbers of frictions) that a lane ends by: without an answer, met again and again, or just starting to slip.
  std::vector<int> undecided_joints(int lane, const LaneReport& report) const;
  // The stop that ended a lane, or that had no value where it ended; -1 without one.
  int stopped_by(int lane) const { return stopped_[lane]; }
  // The least inertia of a lane at the end of its last step, a pivot, in parts of that at its start.
  double lightest(int lane) const { return lightest_[lane] / lightest_start_[lane]; }
  // The largest acceleration of a lane in parts of the largest rate at the end of its last step, 1/s.
  double growth(int lane) const { return growth_[lane]; }
  // States where a lane has come to.
  std::vector<double> last_place(int lane) const;
  // The branch points that a lane has passed, and the states at the one that it has ended next to (none: empty).
  const std::vector<PassedBranchPoint>& crossings(int lane) const { return crossings_[lane]; }
  std::vector<double> branch_point_near(int lane) const;
  // The stops whose value a lane has touched without passing it.
  const std::vector<TouchedStop>& touches(int lane) const { return touches_[lane]; }
  // Whether steps were refused, however short, where a lane has come to.
  bool is_next_to_singular(int lane) const;
  // The largest kinetic energy of a lane at the ends of its steps so far.
  double energy(int lane) const { return energy_[lane]; }
  // The number of the first row that is in the arrays of a lane.
  long first_row(int lane) const { return first_row_[lane]; }
  // y at the start: u = 0, the rates of u, nothing done.
  std::vector<double> start() const;

 private:
  // Arrays of packs, as the unit takes them.
  struct Stage {
    Packed state, first, second, miss, jacobian, tangent, chart_rate, chart_second, inertia, watched, power, turned;
    SlipStage slip;
    std::vector<unsigned char> flags;
  };

  Stage make_stage() const;
  // Without `turns` those of `found` stay as they are.
  void evaluate(const double* place, const double* rate, Stage* found, double* bend = nullptr, bool turns = true);
  void set_places(const Places& places);
  void drive(int lane, double time);
  int edges() const { return driven_ ? (int)driven_->edges().size() : 0; }
  void stand_still();
  void weigh(int lane);
  void find_undefined(const Stage& found, int lane);
  std::vector<bool> kinks_of_stops() const;

  // charted_friction.cpp
  SlipStage make_slips() const;
  void begin_slips();
  void begin_slips(int lane);
  void find_spans();
  // A switch for each friction, and one for those that rest with forces that are not unique.
  int slip_switches() const { return plan_.frictions ? plan_.frictions + 1 : 0; }
  bool rubs(int lane, int k) const;
  int slip_columns(int k) const { return slips_.first[k + 1] - slips_.first[k]; }
  // Whether a joint slips along a line, so that its slip, in its first column, has a sign.
  bool has_sign(int lane, int k) const {
    return slip_columns(k) == 1 || slips_.span[(std::size_t)k * lanes_ + lane] == 1.0;
  }
  double& sense(int lane, int k) { return slips_.sense[(std::size_t)k * lanes_ + lane]; }
  double& quiet(int lane, int k) { return slips_.quiet[(std::size_t)k * lanes_ + lane]; }
  double slip_size(const Packed& of, int lane, int k) const;
  double lever(const Stage& found, int lane, int k) const;
  double unsure(const Stage& found, int lane, int k) const;
  double slip_switch(const Stage& found, int lane, int k) const;
  void write_held(const Stage& found, int lane, double* rates) const;
  double held_size(int lane, int k) const;
  void write_slip_switches(const Stage& found, int lane, double* switches);
  void look_for_ways(const Places& places, const Rates& rates);
  bool feeds_itself(int lane, int k) const;
  void tell_undecided(const Stage& found, int lane);
  std::vector<int> sticking(int lane) const;
  void arm(const Stage& found, int lane);
  void aim_along(const Stage& found, int lane, int k);
  Matrix inertia_matrix(const Stage& found, int lane) const;
  int hold_rates(Stage* found, int lane, const std::vector<int>& joints, double* v);
  void hold_sticking(int lane);
  void stand_still(Stage* found, int lane) const;
  void evaluate_here(int lane, const std::vector<double>& v, Stage* found);
  
  // charted_sticking.cpp
  // A row of a slip by the chart, what stays of the slip's derivative without it, and the row's size.
  struct SlipRow {
    std::vector<double> row;
    double rest = 0.0, size = 0.0;
  };
  SlipRow slip_row(int lane, int k, int c, const std::vector<SlipRow>& basis) const;
  std::vector<SlipRow> held_rows(int lane, const std::vector<int>& joints) const;
  bool slips_beside(int lane, const Signs& way, const std::vector<int>& joints) const;
  bool aim(int lane, const std::vector<int>& joints, const Signs& way, const double* place, const double* rate,
           Stage* found);
  double turn_aim(int lane, int k, double step, const Stage& found);
  bool rules_out(int lane, const Signs& way, const std::vector<int>& joints) const;
  SlipTrial trial(int lane, const Signs& way, const std::vector<int>& open, const std::vector<double>& v);
  std::vector<Signs> ways_of(int lane, const std::vector<int>& open, int forced);
  void take_senses(int lane, const Signs& senses);
  Signs senses(int lane) const;
  double along_sense(const Stage& found, int lane, int k) const;
  std::vector<int> resting(int lane, int event);
  bool set_going(int lane, int forced, std::vector<int>* open, const std::vector<double>& v);
  bool go_first_way(int lane, std::vector<int>* open, const std::vector<double>& v);
  void list_ways(int lane, const std::vector<double>& v);
  double margin(int lane, const Signs& way, const double* place, const double* rate, bool* decided);
  void settle(int lane, int event, std::vector<double>* v);
  bool give_rates(int lane, std::vector<double>* v);
  bool turns_aside(int lane, int event) const;
  bool settled(int lane, int event, std::vector<double>* v);
  double stop_value(int stop, int lane, double watched) const;
  bool is_rounding(const MotionStop& stop, int lane, double value, double speed) const;
  double speed_of(const Stage& found, int lane) const;
  void write_switches(const Stage& found, int lane, double time, double* switches);
  void keep_miss(int lane, const Stage& found);
  void lay_chart(int lane);
  long jacobian_place(const Block& block, int equation, int unknown) const;
  ChartMatrix jacobian_of(const Packed& entries, int lane) const;
  void continue_turns(int lane, const Packed& found);
  long place_of(int lane, long row);
  void write_row(int lane, long row, const Stage& at, const double* done);

  // charted_crossings.cpp
  // Where a stage lies on its curve.
  struct OnCurve {
    bool is_found = false, is_covered = false, is_behind = false, leaves = false;
  };
  struct Crossing {
    bool looked = false;   // since the origin was laid
    bool engaged = false;  // the chart goes on over the branch point, on curves
    bool is_new = false;   // engaged, and no step was tried since
    bool has_only = false, was_behind = false;
    std::vector<double> way, inputs;  // of lines, see charted_crossings.cpp; inputs at the origin
    double probe = 0.0;
    CrossingCurve curve;              // of the only line, or of the first
    OnCurve here, at_end;
    std::vector<double> offset;       // u where the last step ended
    std::vector<double> branch_point;
    std::vector<double> refused_at;   // states where a short step was refused last
    int refusals = 0;                 // there
  };
  struct Line {
    std::vector<double> base;
    bool is_only;  // all stages lie on it, and inputs rest
  };
  Line line_through(int lane, double* s) const;
  void put_on_curve(int lane);
  void put_guess(int lane, std::vector<double> guess);
  bool look_at(int lane, const Line& line, double s, const std::vector<double>& guess, CurvePlace* found);
  bool is_joined(int lane, const ChartMatrix& jacobian) const;
  bool find_way(int lane, const Line& line, double probe);
  bool find_curve(int lane, const Line& line, double probe, CrossingCurve* curve);
  void look_ahead(int lane);
  bool is_beyond(int lane) const;
  bool is_near(int lane, const std::vector<double>& state, double within) const;
  bool keeps_curve(int lane, double time, const double* moved);

  double at(const Packed& a, long k, int lane) const { return a[k * lanes_ + lane]; }

  const MotionUnit& unit_;
  const std::vector<MotionStart> starts_;
  const int lanes_;
  const Plan& plan_;
  const MotionLimits limits_;
  const std::vector<MotionRows> rows_;
  const std::vector<ClosingTurn> turns_;
  int turn_slots_;
  long entries_ = 0;
  std::vector<char, AlignedAllocator<char>> wide_, workspace_;
  Packed origin_, origin_first_, origin_second_, direction_, jacobian_, turn_, elapsed_, miss_, miss_elapsed_, place_, rate_, origin_time_;
  Packed inputs_, input_rates_, input_seconds_, time_, side_;
  Packed decided_by_;  // kinks x lanes: the sides by which it was decided at the start what sticks
  const std::vector<MotionStop> stops_;
  const DrivenLaws* driven_;
  DrivenLaws::Memory laws_memory_;
  SlipMemory slips_;
  std::vector<int> cell_;           // lanes: of the driven laws
  std::vector<double> stop_start_;  // stops x lanes: the values at the start
  std::vector<int> passed_;         // stops x lanes: how often a stop's value has passed
  std::vector<int> stopped_;        // lanes
  std::vector<long> next_row_;      // lanes
  std::vector<long> first_row_;     // lanes: of the block
  std::vector<bool> left_;          // lanes: whose rows are wanted no more
  std::vector<double> energy_, lightest_, lightest_start_, growth_;  // lanes
  Packed done_;                     // 2: work put in and lost at the origin
  Stage found_, end_, trial_;
  std::vector<Crossing> crossing_;  // lanes
  std::vector<std::vector<PassedBranchPoint>> crossings_;
  std::vector<std::vector<TouchedStop>> touches_;
  Packed chart_time_;               // when the chart was laid
  Packed origin_inputs_, last_;     // inputs at the origin; states at the end of the last step
  Packed placed_, placed_state_, placed_tangent_, placed_bend_, bend_;
  Stage looked_;
};
