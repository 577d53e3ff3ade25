#include "stepping/variants.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "plan/program_store.hpp"
#include "rows/assembly_size.hpp"
#include "rows/run.hpp"
#include "rows/threads.hpp"
#include "rows/units.hpp"
#include "stepping/dimension_path.hpp"

namespace {

constexpr long VARIANTS_AT_A_TIME = 16;

// What one thread works with; allocated once a call.
class Worker {
 public:
  Worker(const Tape& tape, const FrozenPlan& plan, const OutputList& outputs, const VariantBase& base,
         const KernelUnit& wide)
      : tape_(tape), base_(base), wide_(wide), narrow_(*kernel_unit(2)), plan_(plan), outputs_(outputs),
        constants_((long)plan.constants()), moving_(constants_ + (long)outputs.constants()),
        moves_(tape.outputs > moving_),
        path_(tape, wide, base.parameters.data(), &plan_, moves_ ? nullptr : first_inputs(), moving_ + base.start_row,
              base.rows),
        memory_(std::max(wide.workspace_size(plan.view()), narrow_.workspace_size(plan.view()))),
        replay_memory_(wide.replay_size(tape)), size_memory_(plan.view(), narrow_), guess_(plan.view().states * base.rows), way_(guess_.size()),
        limit_(base.rows), way_limit_(base.rows), correction_(base.rows), side_(plan.view().blocks * base.rows),
        flags_(base.rows), section_(base.rows, 0), way_inputs_(plan.view().inputs * base.rows) {
    turn_slots_ = turn_slots(plan.view(), narrow_);
    turn_.resize(turn_slots_ * base.rows), way_turn_.resize(turn_.size());
    way_whole_.resize(way_inputs_.size()), nothing_.resize(way_inputs_.size());
    if (base.demand & DEMAND_POWER) power_.resize(base.rows);
  }

  // Variants [begin, end) of `count`.
  void run(long begin, long end, long count, const double* parameters, const VariantArrays& out) {
    const int given = tape_.inputs;
    const long number = end - begin;
    parameters_.resize(number * given), by_tape_.resize(number * given);
    for (long v = 0; v < number; ++v)
      for (int k = 0; k < given; ++k)
        by_tape_[k * number + v] = parameters_[v * given + k] = parameters[k * count + begin + v];
    replayed_.resize(number * tape_.outputs), verdict_.resize(number);
    wide_.replay(tape_, {number, by_tape_.data(), replayed_.data(), verdict_.data()}, replay_memory_.data());
    for (long v = 0; v < number; ++v) {
      const VariantEnd ended = verdict_[v] == TAPE_OTHER_WAY
                                   ? VariantEnd::other_way
                                   : one(&parameters_[v * given], &replayed_[v * tape_.outputs], begin + v, out);
      out.end[begin + v] = (int)ended;
      const bool partly = ended == VariantEnd::incomplete && out.reach;
      if (ended != VariantEnd::complete && !partly) clear(begin + v, out, 0, base_.rows);
    }
  }

  VariantStart start(const double* parameters) {
    VariantStart found = {VariantEnd::other_way, 0.0, {}, {}, {}, {}, {}, false};
    replayed_.resize(tape_.outputs), verdict_.resize(1);
    wide_.replay(tape_, {1, parameters, replayed_.data(), verdict_.data()}, replay_memory_.data());
    if (verdict_[0] == TAPE_OTHER_WAY) return found;
    found.end = assemble(parameters, replayed_.data()) ? VariantEnd::complete : VariantEnd::lost;
    found.size = plan_.view().size, found.state = state_;
    const double *const moved = replayed_.data() + moving_;
    const long table = (long)plan_.view().inputs * base_.rows;
    found.constants.assign(replayed_.data(), replayed_.data() + constants_);
    const auto take = [&](const double* orders, std::vector<double>* to) {
      for (int i = 0; i < plan_.view().inputs; ++i) to->push_back(orders[i * base_.rows + base_.start_row]);
    };
    take(moves_ ? moved : base_.inputs.data(), &found.inputs), take(moves_ ? moved : base_.full.data(), &found.full);
    take(moves_ ? moved + table : base_.rates.data(), &found.rates);
    found.turns = moves_ && turns(moved);
    return found;
  }

 private:
  const double* first_inputs() {
    for (int i = 0; i < plan_.view().inputs; ++i) start_inputs_.push_back(base_.inputs[i * base_.rows + base_.start_row]);
    return start_inputs_.data();
  }

  // Nothing in rows [first, last) of what a variant left behind that did not end well there.
  void clear(long number, const VariantArrays& out, long first, long last) const {
    const long rows = base_.rows, slots = outputs_.view().slots;
    const auto nothing = [&](double* column) {
      if (column) std::fill(column + first, column + last, __builtin_nan(""));
    };
    for (long s = 0; s < slots; ++s) nothing(out.outputs + (number * slots + s) * rows);
    for (double* column : {out.residual, out.condition, out.power_error}) nothing(column ? column + number * rows : column);
  }

  VariantEnd one(const double* parameters, const double* replayed, long number, const VariantArrays& out) {
    if (!assemble(parameters, replayed)) return VariantEnd::lost;
    if (!outputs_.assign(replayed + constants_)) return VariantEnd::other_way;
    const long rows = base_.rows, table = (long)plan_.view().inputs * rows;
    const double* const moved = replayed + moving_;
    const double* const inputs = moves_ ? moved : base_.inputs.data();
    const double* const whole = moves_ ? nothing_.data() : base_.whole.data();
    reach_ = out.reach ? out.reach + number : nullptr;
    if (reach_) *reach_ = {base_.start_row, base_.start_row, {}};
    if (moves_ && turns(inputs)) return nowhere(number, out);
    const bool followed = follow_all(inputs, whole);
    if (!followed && !reach_) return VariantEnd::incomplete;
    const long first = followed ? 0 : reach_->first, last = followed ? rows : reach_->last;
    count_from(first, last);
    Request r = {};
    r.rows = rows;
    r.inputs = inputs;
    r.rates = moves_ ? moved + table : base_.rates.data();
    r.accelerations = moves_ ? moved + 2 * table : base_.accelerations.data();
    r.jerks = moves_ ? moved + 3 * table : base_.jerks.data();
    r.guess = guess_.data();
    r.turned = turn_.data(), r.whole = whole;
    r.full = moves_ ? moved : base_.full.data();
    r.time = base_.time.empty() ? nullptr : base_.time.data();
    r.wanted = outputs_.view();
    r.outputs = out.outputs + number * (long)r.wanted.slots * rows;
    r.residual = out.residual + number * rows, r.condition = out.condition + number * rows;
    r.power_error = out.power_error ? out.power_error + number * rows : power_.data();
    r.correction = correction_.data(), r.side = side_.data(), r.flags = flags_.data();
    r.demand = base_.demand;
    r.iterations = base_.iterations;
    r.tight = base_.following.tight, r.coarse = base_.following.coarse, r.accept = base_.following.accept;
    std::fill(side_.begin(), side_.end(), 1.0);
    if (first < last) wide_.run_rows(plan_.view(), r, first, last, memory_.data());
    long from = base_.start_row, to = from;
    while (from > first && is_good(from - 1, to > from ? from : -1)) --from;
    while (to < last && is_good(to, to > from ? to - 1 : -1)) ++to;
    const bool complete = from == 0 && to == rows;
    if (!complete && !reach_) return VariantEnd::incomplete;
    add_turns(r.outputs, whole, from, to);
    if (!(r.demand & DEMAND_CONDITION)) std::fill_n(r.condition, rows, __builtin_nan(""));
    if (complete) return VariantEnd::complete;
    reach_->first = from, reach_->last = to;
    clear(number, out, 0, from), clear(number, out, to, rows);
    return VariantEnd::incomplete;
  }

  VariantEnd nowhere(long number, const VariantArrays& out) const {
    if (out.reach) clear(number, out, 0, base_.rows);
    return VariantEnd::incomplete;
  }

  // Whether a row closed near its guess, and on the branch of its `neighbour` (-1: none); sides change where a branch
  // point is passed.
  bool is_good(long row, long neighbour) const {
    if (flags_[row] || !(correction_[row] <= limit_[row])) return false;
    if (neighbour < 0 || section_[row] != section_[neighbour]) return true;
    for (int b = 0; b < plan_.view().blocks; ++b)
      if (side_[b * base_.rows + row] != side_[b * base_.rows + neighbour]) return false;
    return true;
  }

  // The plan with the variant's constants and size, and its first assembly in `state_`.
  bool assemble(const double* parameters, const double* replayed) {
    if (std::memcmp(parameters, base_.parameters.data(), sizeof(double) * tape_.inputs) == 0) {
      state_ = base_.state;
      return plan_.assign(replayed) && plan_.assign_size(base_.size);
    }
    const double d = base_.continuation.plan_step;
    path_.aim(parameters, {0.0, d, 2.0 * d, 1.0, 1.0 - d, 1.0 - 2.0 * d});
    Stepper stepper(path_, narrow_, base_.continuation);
    Node node;
    if (!follow_to_target(stepper, base_.state.data(), &node)) return false;
    state_ = node.state;
    if (!plan_.assign(replayed)) return false;
    const StepLimits& l = base_.following;
    const NewtonLimits limits = {l.tight, l.coarse, l.accept, base_.iterations};
    return plan_.assign_size(assembly_size(plan_.view(), narrow_, node.inputs.data(), state_.data(), limits, size_memory_));
  }

  // Guesses of all rows, both ways from the start's.
  bool follow_all(const double* inputs, const double* whole) {
    const long rows = base_.rows, start = base_.start_row;
    const bool back = !start || follow_way(inputs, whole, start, -1, start + 1);
    if (!back && !reach_) return false;
    return follow_way(inputs, whole, start, 1, rows - start) && back;
  }

  // Whether a way came to its end; if not, where it stopped.
  bool has_ended(const Followed& found, long step) {
    if (found.end == TrackEnd::finished) return true;
    if (reach_) {
      const bool known = found.limit.kind == PassageEnd::dead_centre || found.limit.kind == PassageEnd::branch_point;
      reach_->stops[step > 0] = {known ? found.limit.kind : PassageEnd::lost,
                                 known ? (std::vector<double>)found.limit.at.inputs : found.inputs};
    }
    return false;
  }

  void note_reached(long row) {
    if (reach_) reach_->first = std::min(reach_->first, row), reach_->last = std::max(reach_->last, row + 1);
  }

  bool follow_way(const double* inputs, const double* whole, long first, long direction, long count) {
    for (const VariantWay& way : base_.ways)
      if (way.step == direction) return follow_course(way);
    const Plan& p = plan_.view();
    const long rows = base_.rows;
    for (int i = 0; i < p.inputs; ++i)
      for (long k = 0; k < count; ++k) {
        way_inputs_[i * count + k] = inputs[i * rows + first + direction * k];
        way_whole_[i * count + k] = whole[i * rows + first + direction * k];
      }
    const RowGuesses guesses = {count, way_.data(), way_limit_.data(), way_turn_.data()};
    const Followed found = follow_rows(p, narrow_, way_inputs_.data(), way_whole_.data(), state_.data(), {}, false, base_.following, guesses);
    const bool ended = has_ended(found, direction);
    const long known = ended ? count : found.reached;
    if (!ended && !reach_) return false;
    for (long k = 0; k < known; ++k) note_reached(first + direction * k);
    const auto put = [&](const std::vector<double>& from, long columns, std::vector<double>* to) {
      for (long c = 0; c < columns; ++c)
        for (long k = 0; k < known; ++k) (*to)[c * rows + first + direction * k] = from[c * count + k];
    };
    put(way_, p.states, &guess_), put(way_limit_, 1, &limit_);
    for (long k = 0; k < known; ++k) section_[first + direction * k] = direction * sections_before(found, k);
    put(way_turn_, turn_slots_, &turn_);
    return ended;
  }

  // Branch points that a way passed before a row of it.
  static long sections_before(const Followed& found, long row) {
    return std::count_if(found.crossed_before.begin(), found.crossed_before.end(),
                         [&](long behind) { return behind <= row; });
  }

  bool follow_course(const VariantWay& way) {
    const Plan& p = plan_.view();
    const long rows = base_.rows, count = (long)way.rows.size();
    way_.resize(p.states * count), way_limit_.resize(count), way_turn_.resize(turn_slots_ * count);
    const RowGuesses guesses = {count, way_.data(), way_limit_.data(), way_turn_.data()};
    const Followed found = follow_rows(p, narrow_, way.values.data(), nullptr, state_.data(), {}, false,
                                       base_.following, guesses, way.course.get());
    const bool ended = has_ended(found, way.step);
    const long known = ended ? count : found.reached;
    if (!ended && !reach_) return false;
    for (long k = 0; k < known; ++k)
      if (way.rows[k] >= 0) note_reached(way.rows[k]);
    const auto put = [&](const std::vector<double>& from, long columns, std::vector<double>* to) {
      for (long c = 0; c < columns; ++c)
        for (long k = 0; k < known; ++k)
          if (way.rows[k] >= 0) (*to)[c * rows + way.rows[k]] = from[c * count + k];
    };
    put(way_, p.states, &guess_), put(way_limit_, 1, &limit_), put(way_turn_, turn_slots_, &turn_);
    for (long k = 0; k < known; ++k)
      if (way.rows[k] >= 0) section_[way.rows[k]] = way.step * sections_before(found, k);
    return ended;
  }

  // Whether an input that moves with the parameters turns farther than half a turn: its whole turns are taken off in the
  // file's unit, where it is built anew.
  bool turns(const double* inputs) const {
    const Plan& p = plan_.view();
    for (int i = 0; i < p.inputs; ++i) {
      const int type = p.joints[p.column_joint[p.input_column[i]]].type;
      if (type != TREE_R && type != TREE_C) continue;
      for (long r = 0; r < base_.rows; ++r)
        if (std::fabs(inputs[i * base_.rows + r]) > 0.5 * FULL_TURN) return true;
    }
    return false;
  }

  // Turns of rows [from, to) count from the first of them, whose angles lie in (-pi, pi].
  void count_from(long from, long to) {
    if (from == to) return;
    const long rows = base_.rows;
    for (const TreeTurn& t : tree_turns(plan_.view(), narrow_)) {
      double* const turn = &turn_[t.slot * rows];
      const double first = turn[from] - (guess_[t.state * rows + from] <= base_.half_turn_side - 0.5 * FULL_TURN ? 1.0 : 0.0);
      for (long r = from; r < to; ++r) turn[r] -= first;
    }
    for (const ClosingTurn& t : closing_turns(plan_.view(), narrow_)) {
      if (t.freedom < 0) continue;
      double* const turn = &turn_[t.slot * rows];
      const double first = std::ceil((turn[from] - 0.5 * FULL_TURN - base_.half_turn_side) / FULL_TURN);
      for (long r = from; r < to; ++r) turn[r] -= first * FULL_TURN;
    }
  }

  // Angles of rows [from, to) with their whole turns.
  void add_turns(double* outputs, const double* whole, long from, long to) const {
    const long rows = base_.rows;
    for (const ClosingAngle& a : base_.angles) {
      double* const value = outputs + a.slot * rows;
      const double* const known = a.turn >= 0 ? &turn_[a.turn * rows] : whole + (-2 - a.turn) * rows;
      for (long r = from; r < to; ++r)
        value[r] = a.closing ? value[r] - std::rint((value[r] - known[r]) / FULL_TURN) * FULL_TURN
                             : value[r] + known[r] * FULL_TURN;
    }
  }

  const Tape& tape_;
  const VariantBase& base_;
  const KernelUnit &wide_, &narrow_;
  FrozenPlan plan_;
  OutputList outputs_;
  std::vector<double> start_inputs_;
  const long constants_, moving_;
  const bool moves_;
  DimensionPath path_;
  std::vector<char> memory_, replay_memory_;
  SizeMemory size_memory_;
  std::vector<double> guess_, way_, limit_, way_limit_, correction_, side_, power_;
  std::vector<unsigned char> flags_;
  VariantReach* reach_ = nullptr;  // of the variant at hand, where it is asked for
  std::vector<long> section_;  // of each row: branch points passed before it
  std::vector<double> way_inputs_, way_whole_, nothing_, turn_, way_turn_, state_;
  std::vector<double> parameters_, by_tape_, replayed_;
  std::vector<std::uint8_t> verdict_;
  long turn_slots_ = 0;
};

}  // namespace

Variants::Variants(const TapeStore& tape, const FrozenPlan& plan, const OutputList& outputs, VariantBase base)
    : tape_(tape), plan_(plan), outputs_(outputs), base_(std::move(base)) {}

Refusal Variants::prepare() const {
  const Tape& t = tape_.view();
  const Plan& p = plan_.view();
  const std::size_t table = (std::size_t)p.inputs * base_.rows;
  const std::size_t constants = plan_.constants() + outputs_.constants();
  REQUIRE(outputs_.fits(plan_), "outputs: of a plan with another structure");
  REQUIRE((int)base_.parameters.size() == t.inputs, "parameters: one for each input of the tape");
  REQUIRE((std::size_t)t.outputs == constants || (std::size_t)t.outputs == constants + 4 * table,
          "the tape does not give the constants of plan and outputs");
  REQUIRE(base_.rows <= MOST_ROWS, "rows: more than 100000000");
  REQUIRE(base_.rows > 0 && base_.start_row >= 0 && base_.start_row < base_.rows, "rows: none, or no start among them");
  for (const auto* values : {&base_.inputs, &base_.full, &base_.rates, &base_.accelerations, &base_.jerks})
    REQUIRE(values->size() == table, "inputs: wrong shape");
  REQUIRE((int)base_.state.size() == p.states, "state: wrong length");
  REQUIRE(base_.size > 0.0 && std::isfinite(base_.size), "size: not positive");
  REQUIRE(!(outputs_.demand() & ~base_.demand), "the outputs need more than is demanded");
  REQUIRE(!(base_.demand & DEMAND_FORCES) || !(program_demand(p.law) & ~base_.demand), "loads that vary need more than is demanded");
  REQUIRE(!(base_.demand & DEMAND_FORCES) || p.input_constraints == 0, "rates of led inputs by row have no place here");
  REQUIRE(base_.time.empty() || (long)base_.time.size() == base_.rows, "time: one for each row");
  const unsigned demand = base_.demand;
  REQUIRE(!(demand & ~(unsigned)DEMAND_EVERYTHING), "demand: unknown");
  REQUIRE(!(demand & DEMAND_ACCELERATION) || demand & DEMAND_VELOCITY, "accelerations need velocities");
  REQUIRE(!(demand & DEMAND_JERK) || demand & DEMAND_ACCELERATION, "jerks need accelerations");
  REQUIRE(base_.iterations >= 0 && base_.iterations <= 10000, "iterations: 0 to 10000");
  for (const VariantWay& w : base_.ways) {
    const std::size_t places = w.rows.size();
    REQUIRE(places > 0 && w.values.size() == p.inputs * places, "ways: wrong shape");
    for (long row : w.rows) REQUIRE(row < base_.rows, "ways: no such row");
    REQUIRE(!w.course || (w.course->rows() == (long)places && w.course->inputs() <= p.inputs),
            "ways: a course of other rows or inputs");
    REQUIRE((std::size_t)t.outputs == constants, "ways: of inputs that do not move with the parameters");
  }
  REQUIRE(base_.whole.size() == table, "whole: wrong shape");
  REQUIRE(are_whole_turns(base_.whole.data(), table), "whole: numbers of turns");
  const int turns = turn_slots(p, *kernel_unit(2));
  for (const ClosingAngle& a : base_.angles)
    REQUIRE(a.slot >= 0 && a.slot < outputs_.view().slots && a.turn != -1 && a.turn >= -1 - p.inputs && a.turn < turns,
            "angles: unknown slot");
  return {};
}

void Variants::run(long count, const double* parameters, const KernelUnit& unit, int threads,
                   const VariantArrays& out) const {
  const long chunks = (count + VARIANTS_AT_A_TIME - 1) / VARIANTS_AT_A_TIME;
  std::vector<std::unique_ptr<Worker>> workers;
  for (long k = 0; k < std::clamp<long>(threads, 1, std::max(chunks, 1L)); ++k)
    workers.push_back(std::make_unique<Worker>(tape_.view(), plan_, outputs_, base_, unit));
  over_rows(count, VARIANTS_AT_A_TIME, threads, [&](long begin, long end, int thread) {
    workers[thread]->run(begin, end, count, parameters, out);
  });
}

VariantStart Variants::start(const double* parameters) const {
  return Worker(tape_.view(), plan_, outputs_, base_, *kernel_unit(2)).start(parameters);
}
