// Sticking and sliding of a motion by events (docs/friction.md, Motions).
#include <algorithm>
#include <cmath>

#include "arithmetic/dense.hpp"
#include "response/charted_motion.hpp"
#include "response/slip_components.hpp"

namespace {

// Slips in several directions, in parts of what the fastest motion so far would give, up to which they are at their end:
// what that leaves out is of second order.
constexpr double SLIP_AT_END = 1e-9;
// A slip in several directions is watched from so many times SLIP_AT_END on.
constexpr double ARMED = 10.0;
// Rows of slips, in parts of the largest, and parts of a row that those before have left, which are rounding.
constexpr double NO_ROW = 1e-8, DEPENDENT = 1e-12;
// Forces of what sticks, in parts of the largest wrench, that are rounding.
constexpr double NO_FORCE = 1e-12;
// Accelerations of a slip that was just let go, in parts of that by its friction, that are rounding; and how many times
// more tells that it goes.
constexpr double NO_START = 1e-9, GOES = 10.0;

// Where the slips' independent directions are counted beside the start: from it so far, in rad and parts of the size, so many
// places.
constexpr double NEAR_START[] = {1e-4, 1e-2};
constexpr int PLACES_NEAR = 2;
constexpr double GOLDEN = 0.6180339887498949;

// What friction can hold, in parts of the largest wrench without it, from which on it feeds itself.
constexpr double JAMS = 1e3;
// What friction can hold, in parts of the largest wrench, below which it does not matter how exactly.
constexpr double LEAST_LIMIT = 1e-6;
constexpr double LEAST = 1e-300;

}  // namespace

SlipStage ChartedMotion::make_slips() const {
  const auto make = [&](long count) { return Packed((std::size_t)(count * lanes_), 0.0); };
  const long m = ::slip_columns(plan_), n = plan_.frictions;
  return {make(m), make(m), make(m), make(m * plan_.charts), make(n), make(n), make(n), make(n), make(1),
          make(n * TOLD_NUMBERS), make(n), make(2 * m), {}};
}

// What pushes has no friction: it always goes as it does.
bool ChartedMotion::rubs(int lane, int k) const {
  const Friction& f = starts_[lane].plan->friction[k];
  return !f.pushes && (f.at_rest > 0.0 || f.sliding > 0.0);
}

// What rubs goes as it slips, or as it starts to.
void ChartedMotion::begin_slips() {
  const int n = plan_.frictions;
  SlipMemory& s = slips_;
  s.first.assign(1, 0);
  for (int k = 0; k < n; ++k) s.first.push_back(s.first.back() + slip_components(plan_, plan_.friction[k]));
  s.columns = s.first.back();
  s.sense.assign((std::size_t)n * lanes_, 1.0), s.quiet.assign((std::size_t)n * lanes_, 0.0);
  s.span.assign((std::size_t)n * lanes_, 0.0), s.way.assign(2 * (std::size_t)s.columns * lanes_, 0.0);
  s.aim.assign((std::size_t)s.columns * lanes_, 0.0), s.armed.assign((std::size_t)n * lanes_, 0.0);
  s.started.assign((std::size_t)n * lanes_, NAN), s.left.assign((std::size_t)n * lanes_, 0.0);
  s.pushed.assign((std::size_t)n * lanes_, 1);
  s.fastest.assign(lanes_, 0.0), s.duration.assign(lanes_, 0.0), s.ways.resize(lanes_), s.doubtful.resize(lanes_);
  s.rests.assign(lanes_, 0), s.blocked.assign(lanes_, 0), s.measured.assign(lanes_, 0);
  const Packed rate = rate_;
  find_spans();
  for (int l = 0; l < lanes_; ++l) begin_slips(l);
  place_.assign(place_.size(), 0.0), rate_ = rate;
  for (int l = 0; l < lanes_; ++l) elapsed_[l] = 0.0;
}

void ChartedMotion::begin_slips(int lane) {
  SlipMemory& s = slips_;
  const std::vector<double> y = start();
  std::vector<double> v;
  for (int i = 0; i < plan_.charts; ++i) v.push_back(y[(std::size_t)(plan_.charts + i) * lanes_ + lane]);
  for (double x : v) s.fastest[lane] = std::max(s.fastest[lane], std::fabs(x));
  for (int k = 0; k < plan_.frictions; ++k) sense(lane, k) = 1.0;
  evaluate_here(lane, v, &trial_);
  for (int k = 0; k < plan_.frictions; ++k)
    if (rubs(lane, k) && has_sign(lane, k)) sense(lane, k) = at(trial_.slip.rate, s.first[k], lane) < 0.0 ? -1.0 : 1.0;
  settle(lane, -1, &v);
  arm(trial_, lane);
}

// The forces that decide what sticks are those on the sides of kinks where the lanes start.
void ChartedMotion::begin(const signed char* side, unsigned char* lanes) {
  const int kinks = plan_.law.kinks;
  const Packed place = place_, rate = rate_, elapsed = elapsed_;
  for (int l = 0; l < lanes_; ++l) {
    if (!lanes[l]) continue;
    bool is_other = false;
    for (int k = 0; k < kinks; ++k) {
      const double now = side[k * lanes_ + l];
      is_other = is_other || now != decided_by_[k * lanes_ + l];
      decided_by_[k * lanes_ + l] = side_[k * lanes_ + l] = now;
    }
    lanes[l] = plan_.frictions && is_other;
    if (lanes[l]) begin_slips(l);
  }
  place_ = place, rate_ = rate, elapsed_ = elapsed;
}

// In how many independent directions the mechanism lets each joint slip: of places near the start the most, as it may stand
// where there are fewer.
void ChartedMotion::find_spans() {
  const int n = plan_.charts;
  Packed span((std::size_t)plan_.frictions * lanes_, 0.0);
  std::fill(rate_.begin(), rate_.end(), 0.0), std::fill(elapsed_.begin(), elapsed_.end(), 0.0);
  evaluate(place_.data(), rate_.data(), &trial_);
  jacobian_ = trial_.jacobian;
  const auto count = [&] {
    evaluate(place_.data(), rate_.data(), &trial_);
    for (int l = 0; l < lanes_; ++l) {
      if (trial_.flags[l] & (STAGE_NOT_CLOSED | STAGE_OFF_BRANCH)) continue;
      for (int k = 0; k < plan_.frictions; ++k) {
        double& most = span[(std::size_t)k * lanes_ + l];
        most = std::max(most, at(trial_.slip.span, k, l));
      }
    }
  };
  count();
  for (double far : NEAR_START)
    for (int which = 0; which < PLACES_NEAR; ++which) {
      for (int i = 0; i < n; ++i) {
        const double part = (i + 1) * GOLDEN + which * GOLDEN * GOLDEN;
        for (int l = 0; l < lanes_; ++l) place_[(long)i * lanes_ + l] = far * (part - std::floor(part) - 0.5);
      }
      count();
    }
  std::fill(place_.begin(), place_.end(), 0.0);
  slips_.span = span;
  evaluate(place_.data(), rate_.data(), &trial_);
  slips_.way = trial_.slip.way;
}

// Of a joint's columns.
double ChartedMotion::slip_size(const Packed& of, int lane, int k) const {
  double square = 0.0;
  for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c) square += at(of, c, lane) * at(of, c, lane);
  return std::sqrt(square);
}

// The largest slip by a unit of the chart.
double ChartedMotion::lever(const Stage& found, int lane, int k) const {
  double largest = 0.0;
  for (int e = slips_.first[k] * plan_.charts; e < slips_.first[k + 1] * plan_.charts; ++e)
    largest = std::max(largest, std::fabs(at(found.slip.row, e, lane)));
  return largest;
}

// What of a slip's speed is rounding, where it has just begun. Where friction has let it go a load that barely grows leaves no
// acceleration that tells the sense.
double ChartedMotion::unsure(const Stage& found, int lane, int k) const {
  const double started = slips_.started[(std::size_t)k * lanes_ + lane], left = slips_.left[(std::size_t)k * lanes_ + lane];
  if (!(started <= time_[lane])) return left;
  return left + NO_START * at(found.slip.limit, k, lane) * at(found.slip.answer, k, lane) * (time_[lane] - started);
}

// Not negative as long as a joint goes on to slip, or to stick.
double ChartedMotion::slip_switch(const Stage& found, int lane, int k) const {
  if (!rubs(lane, k)) return 1.0;
  const double sense = slips_.sense[(std::size_t)k * lanes_ + lane];
  if (sense != 0.0 && has_sign(lane, k)) return sense * at(found.slip.rate, slips_.first[k], lane) + unsure(found, lane, k);
  if (sense != 0.0) {
    if (slips_.armed[(std::size_t)k * lanes_ + lane] == 0.0) return slip_size(found.slip.rate, lane, k);
    double ahead = 0.0;
    for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c)
      ahead += slips_.aim[(std::size_t)c * lanes_ + lane] * at(found.slip.rate, c, lane);
    return ahead;
  }
  if (at(found.slip.loose, k, lane) != 0.0) return 1.0;
  const double force = slip_size(found.slip.force, lane, k), limit = at(found.slip.limit, k, lane);
  // a slip that starts where nothing jumps has no acceleration yet: that of this little more is not lost in rounding
  const double most = limit + NO_FORCE * at(found.slip.level, 0, lane);
  return (most - force) * (most + force);
}

// What rests shows nothing of a load that comes and goes. The forces of what sticks, and what friction can hold, are
// integrated beside the motion, so that its steps are as short as these want it; from where a load tells what is rounding.
void ChartedMotion::write_held(const Stage& found, int lane, double* rates) const {
  const long m = slips_.columns;
  for (int k = 0; k < plan_.frictions; ++k) {
    const bool sticks = slips_.sense[(std::size_t)k * lanes_ + lane] == 0.0 && rubs(lane, k) && slips_.measured[lane];
    for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c)
      rates[(long)c * lanes_ + lane] = sticks ? at(found.slip.force, c, lane) : 0.0;
    rates[(m + k) * lanes_ + lane] = sticks ? at(found.slip.limit, k, lane) : 0.0;
  }
}

// Of a joint at the end of a step: the force by which its integrals are measured.
double ChartedMotion::held_size(int lane, int k) const {
  return std::max(at(end_.slip.limit, k, lane), LEAST_LIMIT * at(end_.slip.level, 0, lane));
}

void ChartedMotion::write_slip_switches(const Stage& found, int lane, double* switches) {
  const int n = plan_.frictions;
  for (int k = 0; k < n; ++k) {
    const double value = slip_switch(found, lane, k);
    // a zero has no side, and this is the good one
    switches[(long)k * lanes_ + lane] = value == 0.0 ? LEAST : value;
    if (sense(lane, k) == 0.0 && value < 0.0)
      slips_.pushed[(std::size_t)k * lanes_ + lane] = at(found.slip.force, slips_.first[k], lane) < 0.0 ? -1 : 1;
  }
  switches[(long)n * lanes_ + lane] = 1.0;
}

// What rests with forces that are not unique stays as long as no way out of it holds.
void ChartedMotion::look_for_ways(const Places& places, const Rates& rates) {
  double* const switches = rates.switches + (long)(plan_.law.kinks + edges() + plan_.frictions) * lanes_;
  for (int l = 0; l < lanes_; ++l) {
    if (!places.active[l] || slips_.ways[l].empty()) continue;
    double most = -__builtin_inf();
    bool decided = true;
    for (const Signs& way : slips_.ways[l])
      most = std::max(most, margin(l, way, place_.data(), rate_.data(), &decided));
    switches[l] = -most;
    if (!decided) rates.fault[l] |= STAGE_FRICTION, tell_undecided(trial_, l);
  }
}

std::vector<int> ChartedMotion::sticking(int lane) const {
  std::vector<int> joints;
  for (int k = 0; k < plan_.frictions; ++k)
    if (slips_.sense[(std::size_t)k * lanes_ + lane] == 0.0) joints.push_back(k);
  return joints;
}

// The joints that a stage without an answer is owed to: those whose forces are not told, or all that stick.
void ChartedMotion::tell_undecided(const Stage& found, int lane) {
  std::vector<int> joints;
  for (int k = 0; k < plan_.frictions; ++k)
    if (rubs(lane, k) && at(found.slip.state, k, lane) != 0.0) joints.push_back(k);
  slips_.doubtful[lane] = joints.empty() ? sticking(lane) : joints;
}

// A slip in several directions ends where it has become small, not where it begins. Its direction is kept for its end.
void ChartedMotion::arm(const Stage& found, int lane) {
  for (int k = 0; k < plan_.frictions; ++k) {
    const std::size_t e = (std::size_t)k * lanes_ + lane;
    if (has_sign(lane, k) && slips_.sense[e] * at(found.slip.rate, slips_.first[k], lane) > GOES * unsure(found, lane, k)) {
      slips_.left[e] = 0.0;
      if (time_[lane] > slips_.started[e]) slips_.started[e] = NAN;
    }
    if (has_sign(lane, k) || slips_.sense[(std::size_t)k * lanes_ + lane] == 0.0) continue;
    const double size = slip_size(found.slip.rate, lane, k), least = slips_.armed[e] != 0.0 ? 1.0 : ARMED;
    if (size > least * SLIP_AT_END * slips_.fastest[lane] * lever(found, lane, k)) aim_along(found, lane, k);
  }
}

// A slip in several directions has begun, and goes where its rate does.
void ChartedMotion::aim_along(const Stage& found, int lane, int k) {
  const double size = slip_size(found.slip.rate, lane, k);
  slips_.armed[(std::size_t)k * lanes_ + lane] = 1.0;
  for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c)
    slips_.aim[(std::size_t)c * lanes_ + lane] = at(found.slip.rate, c, lane) / size;
}

Matrix ChartedMotion::inertia_matrix(const Stage& found, int lane) const {
  Matrix m(plan_.charts, plan_.charts);
  for (int k = 0; k < plan_.charts * plan_.charts; ++k) m.a[k] = at(found.inertia, k, lane);
  return m;
}

// Takes the slips of joints out of the rates v of a chart, by the impulses that stop them; as many as are independent.
// Where nothing is left to move and nothing is driven, the rates are zero.
int ChartedMotion::hold_rates(Stage* found, int lane, const std::vector<int>& joints, double* v) {
  const int n = plan_.charts;
  const LeastSquares inertia(inertia_matrix(*found, lane));
  std::vector<std::vector<double>> rows, answers;
  std::vector<double> change((std::size_t)n, 0.0);
  double largest = 0.0;
  for (int k = 0; k < plan_.frictions; ++k) largest = std::max(largest, lever(*found, lane, k));
  for (int k : joints)
    for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c) {
      std::vector<double> row;
      for (int i = 0; i < n; ++i) row.push_back(at(found->slip.row, (long)c * n + i, lane));
      const std::vector<double> whole = row;
      const double full = product(row, inertia.solve(row));
      double size = 0.0;
      for (double x : row) size = std::max(size, std::fabs(x));
      if (!(size > NO_ROW * largest)) continue;
      for (std::size_t j = 0; j < rows.size(); ++j) {
        const double along = product(row, answers[j]);
        for (int i = 0; i < n; ++i) row[i] -= along * rows[j][i];
      }
      std::vector<double> answer = inertia.solve(row);
      const double left = product(row, answer);
      if (!(left > DEPENDENT * full)) continue;
      const double per = 1.0 / std::sqrt(left);
      for (int i = 0; i < n; ++i) row[i] *= per, answer[i] *= per;
      const double slip = at(found->slip.rate, c, lane) + product(whole, change);
      const double step = slip * per;
      for (int i = 0; i < n; ++i) change[i] -= step * answer[i];
      rows.push_back(row), answers.push_back(answer);
    }
  for (int i = 0; i < n; ++i) v[i] += change[i];
  bool driven = false;
  for (int i = 0; i < plan_.inputs; ++i) driven = driven || at(input_rates_, i, lane) != 0.0;
  if ((int)rows.size() == n && !driven) std::fill_n(v, n, 0.0);
  return (int)rows.size();
}

// At the end of a step what sticks has no slip: rounding and errors of the step are taken out of the rates.
void ChartedMotion::hold_sticking(int lane) {
  const int n = plan_.charts, columns = plan_.columns;
  double fastest = slips_.fastest[lane];
  for (int i = 0; i < n; ++i) fastest = std::max(fastest, std::fabs(at(end_.chart_rate, i, lane)));
  slips_.fastest[lane] = fastest;
  arm(end_, lane);
  const std::vector<int> joints = sticking(lane);
  if (joints.empty()) return;
  std::vector<double> before, v;
  for (int i = 0; i < n; ++i) before.push_back(at(end_.chart_rate, i, lane));
  v = before;
  hold_rates(&end_, lane, joints, v.data());
  for (int i = 0; i < n; ++i) {
    end_.chart_rate[(long)i * lanes_ + lane] = v[i];
    for (int c = 0; c < columns; ++c)
      end_.first[(long)c * lanes_ + lane] += (v[i] - before[i]) * at(end_.tangent, (long)i * columns + c, lane);
  }
}

// Where all that moves sticks, and nothing is driven, it stands still: the accelerations are rounding.
void ChartedMotion::stand_still(Stage* found, int lane) const {
  if (!slips_.rests[lane]) return;
  for (int i = 0; i < plan_.charts; ++i)
    if (at(found->chart_rate, i, lane) != 0.0) return;
  for (int i = 0; i < plan_.inputs; ++i)
    if (at(input_rates_, i, lane) != 0.0 || at(input_seconds_, i, lane) != 0.0) return;
  for (int i = 0; i < plan_.charts; ++i) found->chart_second[(long)i * lanes_ + lane] = 0.0;
  for (int c = 0; c < plan_.columns; ++c) found->second[(long)c * lanes_ + lane] = 0.0;
}

// At the origin, with rates v of one lane.
void ChartedMotion::evaluate_here(int lane, const std::vector<double>& v, Stage* found) {
  stand_still();
  for (std::size_t i = 0; i < v.size(); ++i) rate_[(long)i * lanes_ + lane] = v[i];
  evaluate(place_.data(), rate_.data(), found);
  found->chart_rate = rate_;
  stand_still(found, lane);
}

// Whether what friction can hold at the end of the last step is far more than all forces without friction make of it.
bool ChartedMotion::feeds_itself(int lane, int k) const {
  return at(end_.slip.limit, k, lane) > JAMS * at(end_.slip.level, 0, lane);
}

std::vector<int> ChartedMotion::undecided_joints(int lane, const LaneReport& report) const {
  if (!plan_.frictions) return {};
  // what was met most often is what ends a lane only where it is held
  const int k = report.end == LaneEnd::HELD ? report.which - plan_.law.kinks - edges() : -1;
  if (k >= 0 && k < plan_.frictions) return {k};
  if (k >= 0 && k < slip_switches()) return sticking(lane);
  if (report.fault & STAGE_FRICTION && report.fault != NOT_FINITE) return slips_.doubtful[lane];
  std::vector<int> starting;
  if (report.end != LaneEnd::STUCK || report.fault) return starting;
  for (int f = 0; f < plan_.frictions; ++f) {
    const std::size_t at = (std::size_t)f * lanes_ + lane;
    const bool starts = !has_sign(lane, f) && slips_.sense[at] != 0.0 && slips_.armed[at] == 0.0;
    if (rubs(lane, f) && (starts || feeds_itself(lane, f))) starting.push_back(f);
  }
  return starting;
}
