#include "stepping/positions.hpp"

#include <cmath>
#include <utility>

#include "plan/program_store.hpp"
#include "rows/run.hpp"
#include "rows/units.hpp"

Positions::Positions(const FrozenPlan& plan, const OutputList& outputs, KnownRows rows, unsigned demand,
                     int iterations, const StepLimits& limits, std::vector<TurningOutput> angles)
    : plan_(plan), outputs_(outputs), rows_(std::move(rows)), demand_(demand), iterations_(iterations),
      limits_(limits), angles_(std::move(angles)) {}

Refusal Positions::prepare() {
  const Plan& p = plan_.view();
  turn_slots_ = ::turn_slots(p, *kernel_unit(2));
  const std::size_t n = rows_.rows, table = n * p.inputs;
  const unsigned demand = demand_;
  REQUIRE(n > 0, "rows: none");
  REQUIRE(rows_.rows <= MOST_ROWS, "rows: more than 100000000");
  REQUIRE(outputs_.fits(plan_), "outputs: of a plan with another structure");
  for (const auto* values : {&rows_.inputs, &rows_.rates, &rows_.accelerations, &rows_.jerks, &rows_.whole})
    REQUIRE(values->size() == table, "inputs: wrong shape");
  REQUIRE(are_whole_turns(rows_.whole.data(), rows_.whole.size()), "whole: numbers of turns");
  REQUIRE(rows_.state.size() == n * p.states, "states: wrong shape");
  REQUIRE(rows_.turn.size() == n * turn_slots_, "turns: wrong shape");
  REQUIRE(!(outputs_.demand() & ~demand), "the outputs need more than is demanded");
  REQUIRE(!(demand & DEMAND_FORCES) || !(program_demand(p.law) & ~demand), "loads that vary need more than is demanded");
  REQUIRE(!(demand & DEMAND_FORCES) || p.input_constraints == 0, "rates of led inputs by row have no place here");
  REQUIRE(!(demand & DEMAND_POWER), "no place for a power error");
  REQUIRE(!(demand & ~(unsigned)DEMAND_EVERYTHING), "demand: unknown");
  REQUIRE(!(demand & DEMAND_ACCELERATION) || demand & DEMAND_VELOCITY, "accelerations need velocities");
  REQUIRE(!(demand & DEMAND_JERK) || demand & DEMAND_ACCELERATION, "jerks need accelerations");
  REQUIRE(iterations_ >= 0 && iterations_ <= 10000, "iterations: 0 to 10000");
  for (const TurningOutput& a : angles_)
    REQUIRE(a.slot >= 0 && a.slot < outputs_.view().slots && a.turn != -1 && a.turn >= -1 - p.inputs &&
                a.turn < turn_slots_,
            "angles: no slot");
  memory_.resize(kernel_unit(2)->workspace_size(p));
  kernel_unit(2)->prepare(p, memory_.data());
  path_.resize(2 * p.inputs), path_whole_.resize(2 * p.inputs), start_.resize(p.states), turn_.resize(turn_slots_);
  guess_.resize(2 * p.states), limit_.resize(2), way_turn_.resize(2 * turn_slots_);
  rates_.resize(p.inputs), accelerations_.resize(p.inputs), jerks_.resize(p.inputs);
  return {};
}

long Positions::nearest(const double* inputs, const double* whole) const {
  long best = 0;
  double least = HUGE_VAL;
  for (long row = 0; row < rows_.rows; ++row) {
    double distance = 0.0;
    for (int i = 0; i < plan_.view().inputs; ++i)
      distance = std::fmax(distance, std::fabs(rows_.inputs[i * rows_.rows + row] - inputs[i] +
                                               FULL_TURN * (rows_.whole[i * rows_.rows + row] - whole[i])));
    if (distance < least) least = distance, best = row;
  }
  return best;
}

bool Positions::solve(const double* inputs, const double* whole, const double* full, double* outputs, double* condition) {
  const Plan& p = plan_.view();
  const KernelUnit& unit = *kernel_unit(2);
  const long row = nearest(inputs, whole), n = rows_.rows;
  for (int i = 0; i < p.inputs; ++i) {
    path_[2 * i] = rows_.inputs[i * n + row], path_[2 * i + 1] = inputs[i];
    path_whole_[2 * i] = rows_.whole[i * n + row], path_whole_[2 * i + 1] = whole[i];
    rates_[i] = rows_.rates[i * n + row], accelerations_[i] = rows_.accelerations[i * n + row];
    jerks_[i] = rows_.jerks[i * n + row];
  }
  for (int s = 0; s < p.states; ++s) start_[s] = rows_.state[s * n + row];
  for (int s = 0; s < turn_slots_; ++s) turn_[s] = rows_.turn[s * n + row];
  const RowGuesses out = {2, guess_.data(), limit_.data(), way_turn_.data()};
  const Followed way = follow_rows(p, unit, path_.data(), path_whole_.data(), start_.data(), turn_, false, limits_, out);
  if (way.end != TrackEnd::finished) return false;
  for (int s = 0; s < p.states; ++s) start_[s] = guess_[2 * s + 1];
  double residual = 0.0, correction = 0.0;
  unsigned char flags = 0;
  Request r = {};
  r.rows = 1;
  r.inputs = inputs, r.rates = rates_.data(), r.accelerations = accelerations_.data(), r.jerks = jerks_.data();
  r.guess = start_.data();
  std::vector<double> turned(turn_slots_);
  for (int s = 0; s < turn_slots_; ++s) turned[s] = way_turn_[2 * s + 1];
  r.turned = turned.data(), r.whole = whole, r.full = full;
  r.wanted = outputs_.view(), r.outputs = outputs;
  r.residual = &residual, r.correction = &correction, r.flags = &flags, r.condition = condition;
  r.demand = demand_, r.iterations = iterations_;
  r.tight = limits_.tight, r.coarse = limits_.coarse, r.accept = limits_.accept;
  unit.run_row(p, r, memory_.data());
  for (const TurningOutput& a : angles_) {
    const double known = a.turn >= 0 ? turned[a.turn] : whole[-2 - a.turn];
    outputs[a.slot] += FULL_TURN * (a.closing ? std::rint((known - outputs[a.slot]) / FULL_TURN) : known);
  }
  return flags == 0 && correction <= limit_[1];
}
