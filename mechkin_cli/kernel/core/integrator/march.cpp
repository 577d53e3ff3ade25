#include "integrator/march.hpp"

#include <algorithm>
#include <cmath>

#include "integrator/crossing_search.hpp"

namespace {

constexpr long MOST_STEPS = 1000000;
constexpr double FAULT_MARGIN = 0.85;  // of the way to a fault, for the next try
constexpr double FAULT_FACTOR = 0.5;   // of it where that failed, too
constexpr double ROOM_GROWTH = 0.02;   // of the room after a fault, doubled with each step taken since

Refusal check(const Motion& motion, const IntegratorSettings& s, const double* time, const std::vector<double>& y,
              const RowTimes& rows) {
  REQUIRE(motion.lanes() > 0 && motion.freedoms() + motion.quadratures() > 0, "at least one lane, and one freedom or quadrature");
  REQUIRE(s.tolerance > 0.0 && s.least_step > 0.0 && s.fixed_step >= 0.0 && s.dense_rows > 0 && s.most_steps > 0,
          "tolerance, least step, steps and rows are positive numbers");
  REQUIRE(s.most_steps <= MOST_STEPS, "1 to 1000000 steps");
  const std::size_t entries = 2 * (std::size_t)motion.freedoms() + motion.quadratures();
  REQUIRE(y.size() == entries * motion.lanes(), "one y for each lane");
  for (int i = 0; i < motion.lanes(); ++i) {
    double before = time[i];
    REQUIRE(std::isfinite(before), "times are finite");
    // of very many only those are looked at that may not rise
    const bool rises = rows.spaced && rows.part.parts == 1 && rows.spaced->surely_rise();
    const long known = rises ? rows.count - rows.part.has_last - 1 : 0;
    const long parts = rows.part.parts, whole_rows = rows.count - rows.part.has_last;
    for (long r = 0; r < rows.count; r = std::max(r + 1, known)) {
      if (parts > 1 && r % parts == 0 && r + parts <= whole_rows) {
        // parts of a way that is far above their rounding rise with it
        const double from = r ? rows.given(i, r / parts - 1) : rows.part.begin, to = rows.given(i, r / parts);
        const double largest = std::max(std::fabs(from), std::fabs(to));
        if (from >= before && to - from > 8.0 * 0x1p-52 * (double)parts * largest) r += parts - 1;
      }
      const double t = rows.at(i, r);
      REQUIRE(std::isfinite(t) && (r ? t > before : t >= before), "the times of rows rise from the start on");
      before = t;
    }
  }
  return {};
}

}  // namespace

Result<std::vector<LaneReport>> integrate(Motion& motion, const IntegratorSettings& settings, const double* time,
                                          const std::vector<double>& y, const RowTimes& rows) {
  CHECK(check(motion, settings, time, y, rows));
  return March(motion, settings, time, y, rows).run();
}

March::March(Motion& motion, const IntegratorSettings& settings, const double* time, const std::vector<double>& y,
             const RowTimes& rows)
    : states_(motion, settings), rows_(rows), explicit_(states_), control_(states_.lanes),
      size_((1 + states_.quadratures) * (std::size_t)states_.lanes),
      place_(states_.entries), values_(states_.side.size()), part_(states_.lanes), at_(states_.lanes),
      other_slope_(states_.entries), scale_(states_.entries), muted_(states_.side.size(), 0), row_(states_.lanes) {
  for (LaneControl& c : control_) {
    c.passed.assign(states_.kinds.size(), 0);
    c.met.assign(states_.kinds.size(), 0);
    c.largest.assign(states_.kinds.size(), 0.0);
    c.noise.assign(states_.kinds.size(), 0.0);
    c.let_alone.assign(states_.kinds.size(), 0);
    c.before.assign(states_.kinds.size(), 0.0);
    c.implicit = settings.method == MethodChoice::IMPLICIT;
  }
  start(time, y);
}

std::vector<LaneReport> March::run() {
  Flags explicit_lanes(states_.lanes), implicit_lanes(states_.lanes);
  for (;;) {
    for (int i = 0; i < states_.lanes; ++i) {
      const LaneControl& c = control_[i];
      explicit_lanes[i] = c.running && !c.implicit;
      implicit_lanes[i] = c.running && c.implicit;
    }
    const bool is_explicit = any(explicit_lanes), is_implicit = any(implicit_lanes);
    if (!is_explicit && !is_implicit) return states_.report;
    if (is_explicit) round(explicit_, explicit_lanes);
    if (is_implicit && !implicit_) implicit_ = std::make_unique<Radau>(states_);
    if (is_implicit) round(*implicit_, implicit_lanes);
  }
}

double March::least(int lane) const {
  return states_.settings.least_step * std::max(std::fabs(states_.time[lane]), states_.duration[lane]);
}

void March::finish(int lane, LaneEnd end, int which) {
  LaneReport& report = states_.report[lane];
  control_[lane].running = false;
  report.end = end;
  const std::vector<long>& met = control_[lane].met;
  const bool asks = end == LaneEnd::STEP_LIMIT || end == LaneEnd::STUCK;
  if (asks && !met.empty()) which = (int)(std::max_element(met.begin(), met.end()) - met.begin());
  report.which = which;
  report.met = which < 0 ? 0 : met[which];
  report.step = states_.step[lane];
  report.value = which < 0 ? 0.0 : control_[lane].largest[which];
  report.fault = end == LaneEnd::STUCK && states_.fault[lane] != NOT_SOLVED ? states_.fault[lane] : 0;
  report.time = states_.time[lane];
  report.evaluations = states_.evaluations[lane];
}

// Chooses the next step of a lane and its end.
void March::plan(int lane) {
  LaneControl& c = control_[lane];
  double& step = states_.step[lane];
  double& until = states_.until[lane];
  c.is_cut = false;
  if (c.landing >= 0) {
    step = c.landing_step;
    until = states_.time[lane] + step;
    return;
  }
  const double to_row = row_time(lane, c.next_row) - states_.time[lane];
  const double fixed = states_.settings.fixed_step;
  if (fixed > 0.0) {
    const double steps = std::ceil(to_row / fixed * (1.0 - 1e-12));
    step = steps > 1.0 ? to_row / steps : to_row;
    until = steps > 1.0 ? states_.time[lane] + step : row_time(lane, c.next_row);
    return;
  }
  step = std::min({c.wanted, c.room, c.longest});
  until = cut_for_rows(lane, step);
  const double wanted = step;
  step = until - states_.time[lane];
  c.is_cut = step < wanted;
}

// One try of a step in each of these lanes.
void March::round(Method& method, Flags mask) {
  for (int i = 0; i < states_.lanes; ++i) {
    if (!mask[i]) continue;
    if (control_[i].attempts++ >= states_.settings.most_steps) {
      finish(i, LaneEnd::STEP_LIMIT);
      mask[i] = 0;
    } else {
      plan(i);
      states_.fault[i] = 0;
    }
  }
  if (!states_.kinds.empty()) {
    check_sides(mask);
    for (int i = 0; i < states_.lanes; ++i) mask[i] = mask[i] && control_[i].running;
  }
  if (!any(mask)) return;
  method.attempt(states_, mask);
  judge(method, &mask);
  if (!states_.kinds.empty() && any(mask)) look_for_crossings(method, &mask);
  if (any(mask)) take(method, std::move(mask));
}

// Leaves the lanes whose steps stand and are exact enough.
void March::judge(Method& method, Flags* mask) {
  for (int i = 0; i < states_.lanes; ++i) {
    if (!(*mask)[i]) continue;
    if (states_.fault[i]) {
      shorten_for_fault(i);
    } else if (states_.settings.fixed_step > 0.0 || states_.error[i] <= 1.0) {
      continue;
    } else {
      method.refused(states_, i);
      refuse(i, states_.step[i] * states_.factor[i]);
    }
    (*mask)[i] = 0;
  }
}

void March::shorten_for_fault(int lane) {
  const double step = states_.step[lane];
  control_[lane].room = (control_[lane].was_refused ? FAULT_FACTOR : FAULT_MARGIN) * states_.reached[lane] * step;
  control_[lane].room_growth = ROOM_GROWTH;
  if (states_.settings.fixed_step > 0.0)
    return states_.motion.finds_more(lane) ? refuse(lane, step) : finish(lane, LaneEnd::STUCK);
  states_.motion.gives_up(lane) ? finish(lane, LaneEnd::STUCK) : refuse(lane, control_[lane].room);
}

void March::refuse(int lane, double step) {
  LaneControl& c = control_[lane];
  ++states_.report[lane].rejections;
  c.landing = -1;
  c.landed = false;
  c.was_refused = true;
  c.wanted = step;
  if (!(step > least(lane))) finish(lane, LaneEnd::STUCK);
}

// The steps of these lanes are taken.
void March::take(Method& method, Flags mask) {
  rows_inside(method, &mask);
  if (!any(mask)) return;
  for (int i = 0; i < states_.lanes; ++i)
    if (mask[i]) method.taken(states_, i);
  move_on(mask);
  if (!states_.kinds.empty()) pass_landed(mask);
  rows_here(mask);
  for (int i = 0; i < states_.lanes; ++i) {
    LaneControl& c = control_[i];
    if (!mask[i]) continue;
    if (c.landed && c.running) tell(i, c.landing);
    c.landed = false;
    c.landing = -1;
    if (c.running && !has_row(c)) finish(i, LaneEnd::DONE);
    if (c.running && states_.motion.is_left(i)) finish(i, LaneEnd::STUCK);
    if (c.running) rewiden(i);
  }
}

// An event that rested at its zero, or a kink that bends nothing, goes on from the side where the step has led it.
void March::settle_ignored(int lane) {
  std::vector<int>& passed = control_[lane].passed;
  control_[lane].sides_checked = false;
  for (int s = 0; s < (int)passed.size(); ++s) {
    const std::size_t k = (std::size_t)s * states_.lanes + lane;
    if (is_ignored(lane, s)) {
      const std::int8_t side = states_.switch_end[k] < 0.0 ? -1 : 1;
      control_[lane].sides_stale |= states_.kinds[s].may_be_nothing() && side != states_.side[k] && passed.size() > 1;
      states_.side[k] = side;
    }
    passed[s] = 0;
    control_[lane].let_alone[s] = 0;
  }
}

// Events that a step has left at their zero, as one that ends at a row may, and that go back in the next.
void March::find_touch(int lane) {
  std::vector<double>& before = control_[lane].before;
  for (int s = 0; s < (int)before.size(); ++s) {
    const std::size_t k = (std::size_t)s * states_.lanes + lane;
    const double here = std::fabs(states_.switch_value[k]), end = states_.good(k, states_.switch_end[k]);
    const double beside = std::min(before[s], end);
    if (states_.kinds[s].is_event() && !control_[lane].passed[s] && beside > 0.0 && here <= TOUCH * beside)
      states_.motion.touch(lane, s, states_.time[lane]);
    before[s] = here;
  }
}

void March::move_on(const Flags& mask) {
  const int lanes = states_.lanes;
  const long moved = (long)states_.freedoms * lanes;
  for (int i = 0; i < lanes; ++i) {
    if (!mask[i]) continue;
    ++states_.report[i].steps;
    find_touch(i);
    states_.time[i] = states_.until[i];
    states_.speed[i] = std::max(states_.speed[i], states_.speed_in(states_.y_end.data(), i));
    at_[i] = __builtin_inf();
    settle_ignored(i);
  }
  states_.motion.accept(mask.data(), states_.time.data(), states_.y_end.data(), states_.slope_end.data() + moved,
                        at_.data());
  for (int i = 0; i < lanes; ++i) {
    if (!mask[i]) continue;
    control_[i].longest = at_[i];
    for (long k = i; k < moved; k += lanes) states_.slope_end[k] = states_.y_end[moved + k];
    for (long k = i; k < states_.entries; k += lanes) {
      states_.y[k] = states_.y_end[k];
      states_.slope[k] = states_.slope_end[k];
    }
    for (std::size_t k = i; k < states_.switch_end.size(); k += lanes) states_.switch_value[k] = states_.switch_end[k];
    for (long k = i; k < (long)states_.quadratures * lanes; k += lanes)
      states_.work[k] = std::max(states_.work[k], std::fabs(states_.y[2 * moved + k]));
  }
  size_up(mask);
}

// The next step of a lane whose step was taken.
void March::rewiden(int lane) {
  LaneControl& c = control_[lane];
  const double wanted = states_.step[lane] * states_.factor[lane];
  // a step that a row or a crossing cut says little of the next one
  const bool is_short = (c.is_cut || states_.step[lane] < c.wanted) && !c.was_refused;
  // one that a crossing made so short that the time stays as it is would never grow
  c.wanted = std::max(is_short ? std::max(c.wanted, wanted) : wanted, least(lane));
  c.room *= 1.0 + c.room_growth;
  c.room_growth *= 2.0;
  c.was_refused = false;
  if (explicit_.is_stiff(lane)) go_implicit(lane);
}

// The implicit method takes over for good, where it may.
void March::go_implicit(int lane) {
  LaneControl& c = control_[lane];
  if (c.implicit || states_.settings.method != MethodChoice::AUTOMATIC) return;
  c.implicit = true;
  states_.report[lane].stiff = true;
  states_.report[lane].stiff_from = states_.time[lane];
}
