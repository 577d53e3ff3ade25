#include "response/varied_response.hpp"

#include <algorithm>
#include <cmath>

#include "plan/program_store.hpp"
#include "rows/run.hpp"
#include "rows/units.hpp"

namespace {

// Arrays of a motion, columns of so many rows.
struct MotionArrays {
  MotionArrays(const Plan& p, long rows, int turns)
      : state(p.states * rows, __builtin_nan("")), direction((long)p.charts * p.columns * rows), rate(p.charts * rows),
        second(p.charts * rows), turn(turns * rows), friction((long)p.frictions * TOLD_NUMBERS * rows), work(2 * rows),
        flags(rows) {}

  MotionRows view(long rows) {
    return {rows, state.data(), direction.data(), rate.data(), second.data(), turn.data(), friction.data(), work.data(),
            flags.data()};
  }

  std::vector<double> state, direction, rate, second, turn, friction, work;
  std::vector<unsigned char> flags;
};

// How a motion begins: states, rates of the columns, and of these where one freedom after the other has unit rate.
struct Beginning {
  std::vector<double> state, first, unit_rates;
  bool is_clear = true;
};

bool is_moving(const std::vector<double>& rates) {
  return std::any_of(rates.begin(), rates.end(), [](double rate) { return rate != 0.0; });
}

Beginning beginning(const Plan& p, const VariantStart& start, const VariantBase& of, const ResponseBase& base) {
  const long count = p.inputs;
  std::vector<double> inputs(count * count), guess(p.states * count), rates(count * count), states(p.states * count);
  std::vector<double> first(p.columns * count), residual(count), correction(count), condition(count), side(p.blocks * count, 1.0);
  std::vector<unsigned char> flags(count);
  for (long row = 0; row < count; ++row) {
    for (long i = 0; i < count; ++i) inputs[i * count + row] = start.inputs[i], rates[i * count + row] = i == row;
    for (long s = 0; s < p.states; ++s) guess[s * count + row] = start.state[s];
  }
  Request r = {};
  r.rows = count;
  r.inputs = inputs.data(), r.guess = guess.data(), r.rates = rates.data();
  r.states = states.data(), r.velocities = first.data(), r.residual = residual.data(), r.correction = correction.data();
  r.condition = condition.data(), r.side = side.data(), r.flags = flags.data();
  r.demand = DEMAND_VELOCITY | DEMAND_CONDITION;
  r.iterations = of.iterations;
  r.tight = base.limits.tight, r.coarse = base.limits.coarse, r.accept = base.limits.accept;
  run_rows(p, r, *kernel_unit(), 1);
  Beginning found;
  found.state = start.state;
  for (long i = 0; i < count; ++i) found.state[base.start_states[i]] = start.full[i];
  found.first.assign(p.columns, 0.0), found.unit_rates.resize(p.columns * count);
  for (long i = 0; i < count; ++i)
    for (long c = 0; c < p.columns; ++c) {
      const double rate = first[c * count + i];
      found.unit_rates[i * p.columns + c] = rate;
      found.first[c] += start.rates[i] * rate;
    }
  found.is_clear = !is_moving(start.rates) || !p.blocks || condition[0] <= base.clear;
  return found;
}

// Copies `count` rows of some columns from rows that are one more.
void take_rows(const std::vector<double>& from, long columns, long rows, long count, std::vector<double>* to) {
  for (long c = 0; c < columns; ++c) std::copy_n(&from[c * (rows + 1)], count, &(*to)[c * rows]);
}

// Angles with their whole turns: of closing joints as the motion has carried them along; those of the tree are states,
// which have them.
void add_turns(const ResponseBase& base, const std::vector<double>& turn, long rows, long count, double* outputs) {
  for (const ClosingAngle& a : base.angles) {
    double* const value = outputs + a.slot * rows;
    for (long r = 0; r < count; ++r)
      if (a.closing) value[r] -= std::rint((value[r] - turn[a.turn * rows + r]) / FULL_TURN) * FULL_TURN;
  }
}

}  // namespace

Refusal check_response(const ResponseBase& base, const TapeStore* tape, const FrozenPlan& plan, const OutputList& outputs) {
  const Plan& p = plan.view();
  REQUIRE(tape, "a response stands behind the tape");
  REQUIRE((std::size_t)tape->view().outputs == plan.constants() + outputs.constants(),
          "the tape does not give the constants of plan and outputs");
  REQUIRE(p.inputs == 0 && p.charts > 0, "the plan of a motion has a chart and no inputs");
  REQUIRE(base.times.size() > 1 && base.times.size() < (std::size_t)MOST_ROWS, "rows: 2 to 100000000");
  REQUIRE(p.law.outputs - p.load_values == (int)base.stops.size(), "stops: one for each watched value");
  REQUIRE((int)base.start_states.size() == p.charts, "start: as many coordinates as freedoms");
  for (int state : base.start_states) REQUIRE(state >= 0 && state < p.states, "start: no such state");
  REQUIRE(!(base.demand & ~(unsigned)DEMAND_EVERYTHING) && !(base.demand & DEMAND_JERK), "demand: unknown, or jerks");
  REQUIRE(!(outputs.demand() & ~base.demand), "the outputs need more than is demanded");
  REQUIRE(!(base.demand & DEMAND_FORCES) || !(program_demand(p.law) & ~base.demand), "loads that vary need more than is demanded");
  const int turns = turn_slots(p, *kernel_unit(2));
  for (const ClosingAngle& a : base.angles)
    REQUIRE(a.slot >= 0 && a.slot < outputs.view().slots && a.turn >= 0 && a.turn < turns, "angles: unknown slot");
  return {};
}

Refusal check_start(const VariedResponse& response) {
  const Plan &begin = response.start.plan().view(), &p = response.plan.view();
  REQUIRE(begin.states == p.states && begin.columns == p.columns && begin.inputs == p.charts, "the start is of another mechanism");
  REQUIRE(response.start.parameters() == response.tape.view().inputs, "start and motion have other parameters");
  return {};
}

Result<PlayedResponse> play_response(const VariedResponse& response, const double* parameters, const ResponseArrays& out) {
  const ResponseBase& base = response.base;
  const long rows = (long)base.times.size(), slots = response.outputs.view().slots;
  PlayedResponse played;
  std::fill_n(out.outputs, slots * rows, __builtin_nan("")), std::fill_n(out.work, 2 * rows, __builtin_nan(""));
  for (double* column : {out.residual, out.condition, out.power_error})
    if (column) std::fill_n(column, rows, __builtin_nan(""));

  const VariantStart start = response.start.start(parameters);
  played.end = start.end;
  if (start.turns) played.end = VariantEnd::other_way;
  if (played.end != VariantEnd::complete) return played;
  FrozenPlan begin(response.start.plan()), plan(response.plan);
  OutputList outputs(response.outputs);
  const KernelUnit& unit = *kernel_unit(2);
  const Tape& tape = response.tape.view();
  std::vector<char> memory((std::size_t)unit.replay_size(tape));
  std::vector<double> constants((std::size_t)tape.outputs);
  std::uint8_t verdict = TAPE_SAME;
  unit.replay(tape, {1, parameters, constants.data(), &verdict}, memory.data());
  played.end = VariantEnd::other_way;
  if (verdict == TAPE_OTHER_WAY || !begin.assign(start.constants.data()) || !begin.assign_size(start.size)) return played;
  if (!plan.assign(constants.data()) || !plan.assign_size(start.size) || !outputs.assign(&constants[plan.constants()]))
    return played;
  played.end = VariantEnd::incomplete;
  const Beginning begun = beginning(begin.view(), start, response.start.base(), base);
  if (!begun.is_clear) return played;

  const Plan& p = plan.view();
  const int turns = turn_slots(p, unit);
  MotionArrays all(p, rows + 1, turns), kept(p, rows, turns);
  ResponseTask task;
  task.starts.push_back({&p, begun.state.data(), begun.first.data(), base.times[0], begun.unit_rates.data()});
  task.rows.push_back(all.view(rows));
  task.times = base.times.data(), task.stops = base.stops, task.driven = nullptr;
  task.limits = base.limits, task.settings = base.settings;
  Result<std::vector<ResponseReport>> reports = respond(task, 2, 1);
  CHECK(reports.refusal());
  const ResponseReport& report = (*reports)[0];
  played.why = report.lane.end, played.stop = report.stop, played.time = report.lane.time;
  const double unit_of_energy = p.length * p.length;
  played.energy = unit_of_energy * report.energy;
  const long between = std::isfinite(all.state[report.lane.rows]) ? 1 : 0;  // a stop's own place
  played.reached = report.lane.rows + between, played.moments = report.lane.rows;
  played.rows = rows;
  const bool is_stopped = report.lane.end == LaneEnd::STOPPED;
  if (is_stopped) {
    const double row = report.lane.rows ? base.times[report.lane.rows - 1] : 0.0;
    // a stop at the moment of the last row before it has that row
    if (report.lane.rows && std::fabs(played.time - row) <= base.same_moment * std::fabs(row)) --played.reached;
    played.rows = played.reached;
  }
  const long count = played.reached = std::min(played.reached, rows);
  if (!count) return played;

  std::vector<double> times = base.times;
  if (is_stopped && count > report.lane.rows) times[count - 1] = played.time;
  const std::pair<const std::vector<double>*, std::vector<double>*> columns[] = {
      {&all.state, &kept.state}, {&all.direction, &kept.direction}, {&all.rate, &kept.rate}, {&all.second, &kept.second},
      {&all.turn, &kept.turn}, {&all.friction, &kept.friction}, {&all.work, &kept.work}};
  for (const auto& [from, to] : columns) take_rows(*from, (long)from->size() / (rows + 1), rows, count, to);
  std::vector<double> states(kept.state.size()), correction(rows), side(p.blocks * rows, 1.0);
  const std::vector<double> guess = kept.state;
  Request r = {};
  r.rows = rows, r.guess = guess.data(), r.turned = kept.turn.data(), r.time = times.data();
  r.chart = kept.direction.data(), r.chart_rates = kept.rate.data(), r.chart_accelerations = kept.second.data();
  r.friction_told = p.frictions ? kept.friction.data() : nullptr;
  const double nothing = 0.0;  // of inputs, of which there are none
  r.inputs = r.rates = r.accelerations = &nothing;
  r.wanted = outputs.view(), r.outputs = slots ? out.outputs : nullptr;
  r.states = states.data(), r.residual = out.residual, r.correction = correction.data(), r.side = side.data();
  r.condition = base.demand & DEMAND_CONDITION ? out.condition : nullptr;
  r.power_error = base.demand & DEMAND_POWER ? out.power_error : nullptr;
  r.flags = kept.flags.data(), r.demand = base.demand, r.iterations = base.limits.iterations;
  r.tight = base.limits.tight, r.coarse = base.limits.coarse, r.accept = base.limits.accept;
  std::vector<char> workspace((std::size_t)unit.workspace_size(p));
  unit.run_rows(p, r, 0, count, workspace.data());
  add_turns(base, kept.turn, rows, count, out.outputs);
  for (long k = 0; k < 2; ++k)
    for (long row = 0; row < count; ++row) out.work[k * rows + row] = unit_of_energy * kept.work[k * rows + row];
  const bool is_closed = std::all_of(kept.flags.begin(), kept.flags.begin() + count, [](unsigned char flag) { return flag == ROW_GOOD; });
  const bool is_done = is_stopped || report.lane.end == LaneEnd::DONE;
  if (is_closed && is_done) played.end = VariantEnd::complete;
  if (!is_closed) played.reached = 0;
  return played;
}
