#include "response/charted_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "rows/units.hpp"

namespace {

constexpr double FULL = 2.0 * 3.14159265358979323846;
// Of rad, sizes and speeds: what closing leaves of a coordinate that cannot move is some ten roundings.
constexpr double NO_VALUE = 1e-14;
// What a stage has missed says nothing of one so many times as far from the origin: asked for a rounding beside the origin it
// missed by rounding, 1e-14, and that goes with the square.
constexpr double TOO_FAR = 1e4;

std::vector<char, AlignedAllocator<char>> wide_plan(const MotionUnit& unit, const std::vector<MotionStart>& starts) {
  std::vector<const Plan*> plans;
  for (const MotionStart& s : starts) plans.push_back(s.plan);
  std::vector<char, AlignedAllocator<char>> memory((std::size_t)unit.widen(plans.data(), nullptr));
  unit.widen(plans.data(), memory.data());
  return memory;
}

long entries_of(const Block& b) { return b.band_entries ? b.band_entries : (long)b.rows * b.size; }

}  // namespace

ChartedMotion::ChartedMotion(const MotionUnit& unit, const std::vector<MotionStart>& starts, const MotionLimits& limits,
                             const std::vector<MotionRows>& rows, const std::vector<MotionStop>& stops,
                             const DrivenLaws* driven)
    : unit_(unit), starts_(starts), lanes_(unit.lanes), plan_(*starts[0].plan), limits_(limits), rows_(rows),
      turns_(closing_turns(plan_, *kernel_unit(2))), turn_slots_(slots_of(turns_)), wide_(wide_plan(unit, starts)),
      workspace_((std::size_t)unit.workspace_size(wide_.data())), stops_(stops), driven_(driven) {
  for (int b = 0; b < plan_.blocks; ++b) entries_ += entries_of(plan_.block[b]);
  const auto make = [&](Packed& a, long count) { a.assign((std::size_t)(count * lanes_), 0.0); };
  make(origin_, plan_.states), make(origin_first_, plan_.columns), make(origin_second_, plan_.columns);
  make(direction_, (long)plan_.charts * plan_.columns), make(jacobian_, entries_), make(turn_, turn_slots_);
  make(elapsed_, 1), make(origin_time_, 1), make(place_, plan_.charts), make(rate_, plan_.charts);
  make(inputs_, plan_.inputs), make(input_rates_, plan_.inputs), make(input_seconds_, plan_.inputs);
  make(miss_, plan_.columns), make(miss_elapsed_, 1);
  unit_.prepare(wide_.data(), workspace_.data());
  make(time_, 1), make(side_, plan_.law.kinks), make(done_, 2);
  if (driven_) laws_memory_ = driven_->memory();
  make(chart_time_, 1), make(placed_, 1), make(placed_state_, plan_.states);
  make(placed_tangent_, (long)(plan_.charts + plan_.inputs) * plan_.columns), make(placed_bend_, plan_.columns);
  make(origin_inputs_, plan_.inputs), make(last_, plan_.states);
  crossing_.resize(lanes_), crossings_.resize(lanes_), touches_.resize(lanes_);
  for (Crossing& c : crossing_) c.offset.assign(plan_.charts, 0.0);
  cell_.assign(lanes_, 0), stopped_.assign(lanes_, -1), next_row_.assign(lanes_, 0);
  first_row_.assign(lanes_, 0), left_.assign(lanes_, false);
  for (auto* a : {&energy_, &lightest_, &lightest_start_, &growth_}) a->assign(lanes_, 0.0);
  stop_start_.assign(stops_.size() * lanes_, 0.0), passed_.assign(stops_.size() * lanes_, 0);
  found_ = make_stage(), end_ = make_stage();
  if (plan_.frictions) {
    trial_ = make_stage();
    trial_.slip.system.assign((std::size_t)(SlipSystem::numbers(plan_.frictions, plan_.contacts) * lanes_), 0.0);
  }
  for (int l = 0; l < lanes_; ++l) {
    const MotionStart& s = starts_[l];
    for (int k = 0; k < plan_.states; ++k) origin_[k * lanes_ + l] = s.state[k];
    for (int k = 0; k < plan_.columns; ++k) origin_first_[k * lanes_ + l] = s.first[k];
    origin_time_[l] = chart_time_[l] = time_[l] = s.time;
    for (int e = 0; e < edges(); ++e) cell_[l] += s.time >= driven_->edges()[e];
    drive(l, s.time);
    for (int k = 0; k < plan_.charts * plan_.columns; ++k) end_.tangent[k * lanes_ + l] = s.tangent[k];
    lay_chart(l);
  }
  last_ = origin_, origin_inputs_ = inputs_;
  const std::vector<double> y = start();
  std::copy(y.begin() + (long)plan_.charts * lanes_, y.begin() + 2L * plan_.charts * lanes_, rate_.begin());
  std::fill(side_.begin(), side_.end(), 1.0);
  decided_by_ = side_;
  if (plan_.frictions) begin_slips();
  evaluate(place_.data(), rate_.data(), &found_);
  jacobian_ = found_.jacobian, origin_second_ = found_.second, turn_ = found_.turned;
  for (std::size_t k = 0; k < stop_start_.size(); ++k)
    stop_start_[k] = found_.watched[(std::size_t)plan_.law.kinks * lanes_ + k];
}

ChartedMotion::Stage ChartedMotion::make_stage() const {
  const auto make = [&](long count) { return Packed((std::size_t)(count * lanes_), 0.0); };
  const long n = plan_.charts;
  return {make(plan_.states), make(plan_.columns), make(plan_.columns), make(plan_.columns), make(entries_),
          make((n + plan_.inputs) * plan_.columns), make(n), make(n), make(n * n), make(plan_.law.kinks + plan_.law.outputs - plan_.load_values), make(2),
          make(turn_slots_), make_slips(), std::vector<unsigned char>((std::size_t)lanes_)};
}

std::vector<double> ChartedMotion::start() const {
  const int n = plan_.charts;
  std::vector<double> y((std::size_t)((2 * n + quadratures()) * lanes_), 0.0);
  for (int l = 0; l < lanes_; ++l)
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < plan_.columns; ++c)
        y[(n + i) * lanes_ + l] += at(direction_, i * plan_.columns + c, l) * at(origin_first_, c, l);
  return y;
}

void ChartedMotion::evaluate(const double* place, const double* rate, Stage* found, double* bend, bool turns) {
  StageGiven given = {};
  given.sense = slips_.sense.data(), given.quiet = slips_.quiet.data(), given.aim = slips_.aim.data();
  given.armed = slips_.armed.data(), given.span = slips_.span.data(), given.way = slips_.way.data();
  given.origin = origin_.data(), given.origin_rate = origin_first_.data(), given.origin_second = origin_second_.data();
  given.miss = miss_.data(), given.miss_elapsed = miss_elapsed_.data();
  given.direction = direction_.data(), given.origin_jacobian = jacobian_.data(), given.elapsed = elapsed_.data();
  given.place = place, given.rate = rate;
  given.inputs = inputs_.data(), given.input_rates = input_rates_.data(), given.input_seconds = input_seconds_.data();
  given.time = time_.data(), given.side = side_.data(), given.turned = turn_.data();
  given.turns = turns_.data(), given.turn_count = turns ? (int)turns_.size() : 0;
  given.tight = limits_.tight, given.coarse = limits_.coarse, given.accept = limits_.accept;
  given.iterations = limits_.iterations, given.jump = limits_.jump, given.radius = limits_.radius;
  bool any_placed = false;
  for (int l = 0; l < lanes_; ++l) any_placed = any_placed || placed_[l] != PREDICTED;
  if (any_placed) {
    given.placed = placed_.data(), given.placed_state = placed_state_.data();
    given.placed_tangent = placed_tangent_.data(), given.placed_bend = placed_bend_.data();
  }
  const StageFound out = {found->state.data(), found->first.data(), found->second.data(), found->miss.data(),
                          found->jacobian.data(), found->tangent.data(), found->chart_second.data(), bend,
                          found->inertia.data(), found->watched.data(), found->power.data(), found->turned.data(),
                          found->slip.rate.data(), found->slip.second.data(), found->slip.force.data(),
                          found->slip.row.data(), found->slip.limit.data(), found->slip.loose.data(),
                          found->slip.state.data(), found->slip.answer.data(), found->slip.span.data(), found->slip.way.data(),
                          found->slip.level.data(), found->slip.told.data(),
                          found->slip.system.empty() ? nullptr : found->slip.system.data(),
                          found->flags.data()};
  unit_.evaluate(wide_.data(), given, out, workspace_.data());
}

std::vector<SwitchKind> ChartedMotion::switches() const {
  std::vector<SwitchKind> kinds(plan_.law.kinks, {true});
  const std::vector<bool> read = kinks_of_stops();
  for (int k = 0; k < plan_.law.kinks; ++k) kinds[k].may_rest = true, kinds[k].bends_event = read[k];
  // all motions begin at one time
  for (int e = 0; e < edges(); ++e)
    kinds.push_back({true, false, (signed char)(starts_[0].time < driven_->edges()[e] ? -1 : 1)});
  kinds.insert(kinds.end(), slip_switches(), {false, true});
  kinds.insert(kinds.end(), stops_.size(), {false});
  return kinds;
}

// Which kinks of the plan's program the values of stops depend on.
std::vector<bool> ChartedMotion::kinks_of_stops() const {
  const auto& law = plan_.law;
  const int leaves = law.inputs + law.constants;
  std::vector<bool> needed(law.registers(), false), read(law.kinks, false);
  for (int o = plan_.load_values; o < law.outputs; ++o) needed[law.output[o]] = true;
  for (int k = law.instructions - 1; k >= 0; --k)
    if (needed[leaves + k])
      for (int a = 0; a < 3; ++a) needed[law.operand[3 * k + a]] = true;
  for (int k = 0; k < law.kinks; ++k) read[k] = needed[leaves + law.kink[k]];
  return read;
}

// The driven inputs of a lane at a time, on the piece of their laws that the lane is on.
void ChartedMotion::drive(int lane, double time) {
  if (!driven_) return;
  driven_->at(cell_[lane], time, lane, lanes_, inputs_.data(), input_rates_.data(), input_seconds_.data(),
              &laws_memory_);
}

// Lanes that are not asked for stand at their origin.
void ChartedMotion::set_places(const Places& places) {
  const int n = plan_.charts, kinks = plan_.law.kinks, edges = this->edges();
  for (int l = 0; l < lanes_; ++l) {
    const bool active = places.active[l];
    time_[l] = active ? places.time[l] : origin_time_[l];
    elapsed_[l] = time_[l] - chart_time_[l];
    if (elapsed_[l] > TOO_FAR * miss_elapsed_[l]) miss_elapsed_[l] = 0.0;
    if (active && places.side) {
      for (int k = 0; k < kinks; ++k) side_[k * lanes_ + l] = places.side[k * lanes_ + l];
      cell_[l] = 0;
      for (int e = 0; e < edges; ++e) cell_[l] += places.side[(kinks + e) * lanes_ + l] > 0;
    }
    drive(l, time_[l]);
    for (int i = 0; i < n; ++i) {
      place_[i * lanes_ + l] = (active ? places.y[i * lanes_ + l] : 0.0) + crossing_[l].offset[i];
      rate_[i * lanes_ + l] = active ? places.y[(n + i) * lanes_ + l] : 0.0;
    }
    placed_[l] = PREDICTED;
    if (active) put_on_curve(l);
    if (active && places.is_end) crossing_[l].at_end = crossing_[l].here;
  }
}

void ChartedMotion::rates(const Places& places, const Rates& rates) {
  const int n = plan_.charts;
  set_places(places);
  Stage* const found = places.is_end ? &end_ : &found_;
  // turns are kept of places that may become origins or rows
  evaluate(place_.data(), rate_.data(), found, nullptr, places.is_end);
  found->chart_rate = rate_;
  if (plan_.frictions)
    for (int l = 0; l < lanes_; ++l) stand_still(found, l);
  for (int l = 0; l < lanes_; ++l) {
    if (!places.active[l]) continue;
    for (int i = 0; i < n; ++i) rates.rates[i * lanes_ + l] = found->chart_second[i * lanes_ + l];
    for (int k = 0; k < 2; ++k) rates.rates[(n + k) * lanes_ + l] = found->power[k * lanes_ + l];
    if (plan_.frictions) write_held(*found, l, rates.rates + (long)(n + works()) * lanes_);
    rates.fault[l] = found->flags[l];
    if (plan_.frictions && slips_.blocked[l]) rates.fault[l] |= STAGE_FRICTION;
    if (found->flags[l] & STAGE_FRICTION) tell_undecided(*found, l);
    if (!found->flags[l]) keep_miss(l, *found);
    if (found->flags[l] & STAGE_UNDEFINED_STOP) find_undefined(*found, l);
    write_switches(*found, l, time_[l], rates.switches);
  }
  if (plan_.frictions) look_for_ways(places, rates);
  for (int l = 0; l < lanes_; ++l) {
    if (!places.active[l]) continue;
    if (is_beyond(l)) rates.fault[l] |= STAGE_OFF_BRANCH;
    if (rates.fault[l] & (STAGE_OFF_BRANCH | STAGE_NOT_CLOSED)) look_ahead(l);
  }
}

// The next stage is predicted with what the prediction of this one missed.
void ChartedMotion::keep_miss(int lane, const Stage& found) {
  miss_elapsed_[lane] = elapsed_[lane];
  for (int c = 0; c < plan_.columns; ++c) miss_[(long)c * lanes_ + lane] = at(found.miss, c, lane);
}

// The first stop whose value there is none is what ends the lane, if nothing helps.
void ChartedMotion::find_undefined(const Stage& found, int lane) {
  for (std::size_t s = stops_.size(); s-- > 0;) {
    const double value = at(found.watched, plan_.law.kinks + (long)s, lane);
    if (!(value == value)) stopped_[lane] = (int)s;
  }
}

// What changes its sign where a stop is met.
double ChartedMotion::stop_value(int stop, int lane, double watched) const {
  const MotionStop& s = stops_[stop];
  if (s.kind == STOP_CROSSING) return watched - s.at;
  if (s.kind == STOP_TURNING) return watched;
  if (s.kind == STOP_CONDITION) return watched - 0.5;
  return std::fabs(watched - stop_start_[(std::size_t)stop * lanes_ + lane]) - FULL * s.count;
}

void ChartedMotion::write_switches(const Stage& found, int lane, double time, double* switches) {
  const int kinks = plan_.law.kinks, edges = this->edges(), stops = kinks + edges + slip_switches();
  if (plan_.frictions) write_slip_switches(found, lane, switches + (long)(kinks + edges) * lanes_);
  for (int k = 0; k < kinks; ++k) switches[k * lanes_ + lane] = at(found.watched, k, lane);
  for (int e = 0; e < edges; ++e) switches[(kinks + e) * lanes_ + lane] = time - driven_->edges()[e];
  const double speed = stops_.empty() ? 0.0 : speed_of(found, lane);
  for (int s = 0; s < (int)stops_.size(); ++s) {
    const double value = stop_value(s, lane, at(found.watched, kinks + s, lane));
    switches[(stops + s) * lanes_ + lane] = is_rounding(stops_[s], lane, value, speed) ? 0.0 : value;
  }
}

// The fastest coordinate, in rad and parts of the size.
double ChartedMotion::speed_of(const Stage& found, int lane) const {
  double speed = 0.0;
  for (int c = 0; c < plan_.columns; ++c)
    speed = std::max(speed, std::fabs(at(found.first, c, lane)) / starts_[lane].plan->column_weight[c]);
  return speed;
}

// What never moves is zero but for rounding, whose signs are no passages.
bool ChartedMotion::is_rounding(const MotionStop& stop, int lane, double value, double speed) const {
  if (stop.kind == STOP_TURNS || stop.rates < 0) return false;
  double unit = NO_VALUE;
  for (int k = 0; k < stop.rates; ++k) unit *= speed;
  for (int k = 0; k < std::abs(stop.lengths); ++k)
    unit = stop.lengths > 0 ? unit * starts_[lane].plan->size : unit / starts_[lane].plan->size;
  return std::fabs(value) <= unit;
}

// The tangents of the old chart, made orthonormal in the columns in parts of their weights (Gram-Schmidt, twice).
void ChartedMotion::lay_chart(int lane) {
  const int n = plan_.charts, columns = plan_.columns;
  const double* const weight = starts_[lane].plan->column_weight;
  const auto entry = [&](int i, int c) -> double& { return direction_[(long)(i * columns + c) * lanes_ + lane]; };
  std::vector<double> rows((std::size_t)n * columns);
  // of each row the columns that it moves, as far as it is done: of trees without loops mostly one
  std::vector<std::vector<int>> moved((std::size_t)n);
  for (int i = 0; i < n; ++i) {
    double* const row = rows.data() + (long)i * columns;
    for (int c = 0; c < columns; ++c)
      row[c] = plan_.column_block[c] < 0 ? 0.0 : at(end_.tangent, i * columns + c, lane) / weight[c];
    for (int pass = 0; pass < 2; ++pass) {
      for (int j = 0; j < i; ++j) {
        const double* const other = rows.data() + (long)j * columns;
        double along = 0.0;
        for (int c : moved[j]) along += row[c] * other[c];
        if (along == 0.0) continue;
        for (int c : moved[j]) row[c] -= along * other[c];
      }
      double square = 0.0;
      for (int c = 0; c < columns; ++c) square += row[c] * row[c];
      const double size = std::sqrt(square);
      for (int c = 0; c < columns; ++c) row[c] /= size;
    }
    for (int c = 0; c < columns; ++c)
      if (row[c] != 0.0) moved[i].push_back(c);
  }
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < columns; ++c) entry(i, c) = rows[(std::size_t)i * columns + c] / weight[c];
  // the chart's rows at the new origin
  long base = 0;
  for (int b = 0; b < plan_.blocks; ++b) {
    const Block& block = plan_.block[b];
    for (int i = 0; i < block.charts; ++i)
      for (int u = 0; u < block.size; ++u)
        jacobian_[(base + jacobian_place(block, block.rows - block.charts + i, u)) * lanes_ + lane] =
            entry(i, plan_.unknown[block.column_begin + u]);
    base += entries_of(block);
  }
}

// Where an equation's derivative by an unknown stands among a block's entries.
long ChartedMotion::jacobian_place(const Block& block, int equation, int unknown) const {
  if (!block.band_entries) return (long)equation * block.size + unknown;
  return place_in_band(plan_.band[block.column_begin + unknown], equation, block.rows - block.charts);
}

// A lane's Jacobian of the block that has the chart.
ChartMatrix ChartedMotion::jacobian_of(const Packed& entries, int lane) const {
  const Block& block = plan_.block[0];
  if (block.band_entries) {
    std::vector<double> band((std::size_t)block.band_entries);
    for (int e = 0; e < block.band_entries; ++e) band[e] = at(entries, e, lane);
    return ChartMatrix(std::move(band), plan_.band + block.column_begin, block.size, block.charts);
  }
  Matrix full(block.rows, block.size);
  for (long e = 0; e < entries_; ++e) full.a[e] = at(entries, e, lane);
  return ChartMatrix(std::move(full));
}

// Angles within half a turn of those before, orientations of their sign.
void ChartedMotion::continue_turns(int lane, const Packed& found) {
  for (const ClosingTurn& t : turns_) {
    const auto now = [&](int k) { return found[(long)(t.slot + k) * lanes_ + lane]; };
    const auto kept = [&](int k) -> double& { return turn_[(long)(t.slot + k) * lanes_ + lane]; };
    if (t.freedom >= 0) {
      kept(0) = now(0) + FULL * std::nearbyint((kept(0) - now(0)) / FULL);
      continue;
    }
    double along = 0.0;
    for (int k = 0; k < 4; ++k) along += now(k) * kept(k);
    for (int k = 0; k < 4; ++k) kept(k) = along < 0.0 ? -now(k) : now(k);
  }
}

void ChartedMotion::accept(const unsigned char* lanes, const double* time, double* y, double* rates, double* longest) {
  const int n = plan_.charts, columns = plan_.columns;
  for (int l = 0; l < lanes_; ++l) {
    if (!lanes[l]) continue;
    const auto take = [&](const Packed& from, long count, Packed& to) {
      for (long k = 0; k < count; ++k) to[k * lanes_ + l] = from[k * lanes_ + l];
    };
    longest[l] = limits_.longest;
    origin_time_[l] = time[l], miss_elapsed_[l] = 0.0;
    for (int k = 0; k < 2; ++k) done_[k * lanes_ + l] = y[(2 * n + k) * lanes_ + l];
    if (plan_.frictions) hold_sticking(l);
    continue_turns(l, end_.turned);
    if (plan_.frictions) take(end_.slip.way, 2L * slips_.columns, slips_.way);
    take(end_.state, plan_.states, last_);
    const bool is_kept = keeps_curve(l, time[l], y);
    for (int i = 0; i < n; ++i) y[i * lanes_ + l] = 0.0;
    if (is_kept) continue;
    take(end_.state, plan_.states, origin_), take(end_.first, columns, origin_first_);
    take(end_.second, columns, origin_second_), take(end_.jacobian, entries_, jacobian_);
    chart_time_[l] = time[l], crossing_[l].looked = false;
    drive(l, time[l]);
    take(inputs_, plan_.inputs, origin_inputs_);
    lay_chart(l);
    for (int i = 0; i < n; ++i) {
      double first = 0.0, second = 0.0;
      for (int c = 0; c < columns; ++c) {
        first += at(direction_, i * columns + c, l) * at(end_.first, c, l);
        second += at(direction_, i * columns + c, l) * at(end_.second, c, l);
      }
      y[(n + i) * lanes_ + l] = first, rates[i * lanes_ + l] = second;
    }
  }
}

// Where a row is in the arrays of its lane, whose block is handed on when it is full.
long ChartedMotion::place_of(int lane, long row) {
  const MotionRows& out = rows_[lane];
  if (!out.taker || row - first_row_[lane] < out.rows) return row - first_row_[lane];
  left_[lane] = !out.taker->take(first_row_[lane], out.rows);
  first_row_[lane] += out.rows;
  return row - first_row_[lane];
}

void ChartedMotion::write_row(int lane, long number, const Stage& at_row, const double* done) {
  const MotionRows& out = rows_[lane];
  if (!out.rows || left_[lane]) return;
  const long row = place_of(lane, number);
  if (left_[lane]) return;
  const int n = plan_.charts, columns = plan_.columns;
  const auto put = [&](double* to, long column, double x) { to[column * (out.rows + 1) + row] = x; };
  for (int k = 0; k < plan_.states; ++k) put(out.state, k, at(at_row.state, k, lane));
  for (int i = 0; i < n; ++i) {
    double first = 0.0, second = 0.0;
    for (int c = 0; c < columns; ++c) {
      const double along = at(direction_, i * columns + c, lane);
      put(out.direction, i * columns + c, along);
      first += along * at(at_row.first, c, lane), second += along * at(at_row.second, c, lane);
    }
    put(out.chart_rate, i, first), put(out.chart_second, i, second);
  }
  for (int k = 0; k < plan_.frictions * TOLD_NUMBERS; ++k) put(out.friction_told, k, at(at_row.slip.told, k, lane));
  for (int k = 0; k < turn_slots_; ++k) put(out.turn, k, at(turn_, k, lane));
  for (int k = 0; k < 2; ++k) put(out.work, k, done ? done[(long)k * lanes_ + lane] : at(done_, k, lane));
  out.flags[row] = at_row.flags[lane];
}

void ChartedMotion::row(const unsigned char* lanes, const long* row, const double* time, const double* y, bool inside) {
  const double* const done = y + 2L * plan_.charts * lanes_;
  if (inside) {
    const Places places = {time, y, lanes, nullptr, false};
    set_places(places);
    evaluate(place_.data(), rate_.data(), &found_);
    found_.chart_rate = rate_;
    for (int l = 0; l < lanes_ && plan_.frictions; ++l) stand_still(&found_, l);
  }
  for (int l = 0; l < lanes_; ++l) {
    if (!lanes[l]) continue;
    if (inside) continue_turns(l, found_.turned);
    write_row(l, row[l], inside ? found_ : end_, done);
    next_row_[l] = row[l] + 1;
  }
}

bool ChartedMotion::event(int lane, int which, bool rising, double) {
  const int stop = which - plan_.law.kinks - edges() - slip_switches();
  if (stop < 0) return false;
  const MotionStop& s = stops_[stop];
  const int direction = s.kind == STOP_CONDITION ? 1 : s.kind == STOP_CROSSING ? s.direction : 0;
  if (direction * (rising ? 1 : -1) < 0) return false;
  if (++passed_[(std::size_t)stop * lanes_ + lane] < (s.kind == STOP_TURNS ? 1 : s.count)) return false;
  stopped_[lane] = stop;
  write_row(lane, next_row_[lane], end_, nullptr);
  return true;
}

// A condition that holds from the start on.
int ChartedMotion::event_at_start(int lane) {
  for (int s = 0; s < (int)stops_.size(); ++s) {
    const int which = plan_.law.kinks + edges() + slip_switches() + s;
    const bool holds = stops_[s].kind == STOP_CONDITION && at(end_.watched, plan_.law.kinks + (long)s, lane) > 0.5;
    if (holds && event(lane, which, true, time_[lane])) return which;
  }
  return -1;
}

void ChartedMotion::touch(int lane, int which, double time) {
  const int stop = which - plan_.law.kinks - edges() - slip_switches();
  if (stop >= 0 && stops_[stop].kind == STOP_CROSSING) touches_[lane].push_back({stop, time});
}

void ChartedMotion::stand_still() {
  std::fill(place_.begin(), place_.end(), 0.0), std::fill(rate_.begin(), rate_.end(), 0.0);
  for (int l = 0; l < lanes_; ++l) {
    time_[l] = origin_time_[l], elapsed_[l] = 0.0;
    drive(l, time_[l]);
  }
}
