// How joints go on where a slip has come to its zero, or friction holds no longer (docs/friction.md, Motions).
#include <algorithm>
#include <cmath>

#include "response/charted_motion.hpp"

namespace {

// Slips, in parts of what the fastest motion so far would give, up to which a joint is at rest beside one that is.
constexpr double SLIP_AT_REST = 1e-9;
// Forces of what sticks, in parts of what it can hold and of the largest wrench, that are rounding; accelerations, in parts
// of those by the largest wrench, likewise.
constexpr double JUST_HELD = 1e-9, NO_FORCE = 1e-12;
// A slip in several directions that begins without an acceleration: accelerations, in parts of that by its friction, that are
// none; and what it begins with, in parts of what that would make of it over the duration, and of what the rates give.
constexpr double NO_START = 1e-9, GIVEN = 1e-12, BESIDE_RATES = 1e-11;
// A slip that has just begun, in parts of what the fastest motion so far would give, and times what it begins with, that is
// rounding of the rates.
constexpr double NO_SLIP = 1e-14, NOISE = 4.0;
// The margin of a way that nothing can go.
constexpr double RULED_OUT = -1.0;

}  // namespace

Signs ChartedMotion::senses(int lane) const {
  Signs all;
  for (int k = 0; k < plan_.frictions; ++k) all.push_back((signed char)slips_.sense[(std::size_t)k * lanes_ + lane]);
  return all;
}

void ChartedMotion::take_senses(int lane, const Signs& senses) {
  for (int k = 0; k < plan_.frictions; ++k) sense(lane, k) = senses[k];
}

// The derivative of a slip along its sense; of what sticks its size.
double ChartedMotion::along_sense(const Stage& found, int lane, int k) const {
  const double sense = slips_.sense[(std::size_t)k * lanes_ + lane];
  const int begin = slips_.first[k], end = slips_.first[k + 1];
  if (sense == 0.0) return slip_size(found.slip.second, lane, k);
  if (has_sign(lane, k)) return sense * at(found.slip.second, begin, lane);
  double sum = 0.0;
  for (int c = begin; c < end; ++c) sum += at(slips_.aim, c, lane) * at(found.slip.second, c, lane);
  return sum;
}

// Whether joints cannot start as a way says, whatever their friction, of the stage in trial_. The direction of one with
// several is that of one friction force alone, which rules out no other.
bool ChartedMotion::rules_out(int lane, const Signs& way, const std::vector<int>& joints) const {
  const int n = plan_.frictions;
  long number = 0;
  const auto next = [&] { return at(trial_.slip.system, number++, lane); };
  SlipSystem s;
  s.is_open = next() != 0.0;
  for (int k = 0; k < n; ++k) s.coefficient.push_back(next()), s.starts.push_back(0);
  for (int k = 0; k < n * (n + 1); ++k) s.second.push_back(next());
  for (int k = 0; k < n; ++k)
    for (int c = plan_.friction[k].contact_begin; c < plan_.friction[k].contact_end; ++c) {
      s.contacts.push_back({k, starts_[lane].plan->contact[c].weight, {}});
      for (int i = 0; i < 3 * (n + 1); ++i) s.contacts.back().load.push_back(next());
    }
  for (int k : joints) {
    if (way[k] != 0 && !has_sign(lane, k)) return false;
    s.starts[k] = way[k] != 0;
  }
  return has_no_slip(s);
}

// What joints would do with some senses; `open` start from rest.
SlipTrial ChartedMotion::trial(int lane, const Signs& way, const std::vector<int>& open, const std::vector<double>& v) {
  SlipTrial t;
  t.way = t.sense = way;
  take_senses(lane, way);
  std::vector<int> starting;
  for (int k : open)
    if (!has_sign(lane, k) && way[k] != 0) starting.push_back(k), t.sense[k] = 1;
  stand_still();
  for (std::size_t i = 0; i < v.size(); ++i) rate_[(long)i * lanes_ + lane] = v[i];
  const bool aimed = aim(lane, starting, way, place_.data(), rate_.data(), &trial_);
  t.decided = aimed && !(trial_.flags[lane] & STAGE_FRICTION);
  t.is_ruled_out = aimed && !t.decided && rules_out(lane, way, open);
  if (aimed && !t.decided && !t.is_ruled_out) tell_undecided(trial_, lane);
  const double level = at(trial_.slip.level, 0, lane);
  for (int k = 0; k < plan_.frictions; ++k) {
    const double force = slip_size(trial_.slip.force, lane, k), limit = at(trial_.slip.limit, k, lane);
    t.second.push_back(along_sense(trial_, lane, k));
    t.rounding.push_back(NO_FORCE * level * at(trial_.slip.answer, k, lane));
    t.loose.push_back(at(trial_.slip.loose, k, lane) != 0.0);
    t.excess.push_back((force - limit) * at(trial_.slip.answer, k, lane));
    t.holds.push_back(force <= (1.0 + JUST_HELD) * limit + NO_FORCE * level);
  }
  for (int i = 0; i < plan_.charts; ++i) t.motion.push_back(at(trial_.chart_second, i, lane));
  return t;
}

// How far what a way sets going would go along it; negative where it would not. `decided` turns false where friction has no
// answer.
double ChartedMotion::margin(int lane, const Signs& way, const double* place, const double* rate, bool* decided) {
  const Signs before = senses(lane);
  take_senses(lane, way);
  std::vector<int> starting, open;
  for (int k = 0; k < plan_.frictions; ++k) {
    if (way[k] == before[k]) continue;
    open.push_back(k);
    quiet(lane, k) = 1.0;
    if (!has_sign(lane, k)) starting.push_back(k);
  }
  const bool aimed = aim(lane, starting, way, place, rate, &trial_), one = aimed && !(trial_.flags[lane] & STAGE_FRICTION);
  const bool is_ruled_out = aimed && !one && rules_out(lane, way, open);
  *decided = *decided && (one || is_ruled_out);
  double least = is_ruled_out ? RULED_OUT : __builtin_inf();
  for (int k = 0; k < plan_.frictions; ++k)
    if (way[k] != before[k]) {
      const double none = NO_FORCE * at(trial_.slip.level, 0, lane) * at(trial_.slip.answer, k, lane);
      quiet(lane, k) = 0.0, least = std::min(least, along_sense(trial_, lane, k) - none);
    }
  take_senses(lane, before);
  return least;
}

// The joints that are at rest where one is.
std::vector<int> ChartedMotion::resting(int lane, int event) {
  std::vector<int> joints;
  for (int k = 0; k < plan_.frictions; ++k) {
    if (!rubs(lane, k)) continue;
    const double none = SLIP_AT_REST * slips_.fastest[lane] * lever(trial_, lane, k);
    if (sense(lane, k) == 0.0 || k == event || slip_size(trial_.slip.rate, lane, k) <= none) joints.push_back(k);
  }
  return joints;
}

// Sets going what does not hold, with the coefficients of rest, then what that of sliding lets go; `open` keeps what sticks.
// False where there is no answer, or several.
bool ChartedMotion::set_going(int lane, int forced, std::vector<int>* open, const std::vector<double>& v) {
  while (!open->empty()) {
    for (int k : *open) quiet(lane, k) = 1.0;
    slips_.doubtful[lane] = *open;
    std::vector<SlipTrial> trials;
    for (const Signs& way : ways_of(lane, *open, forced)) trials.push_back(trial(lane, way, *open, v));
    const int found = trial_that_holds(trials, *open, forced);
    for (int k : *open) quiet(lane, k) = 0.0;
    if (found < 0) return false;
    const SlipTrial again = trial(lane, trials[found].way, *open, v);
    std::vector<int> kept;
    bool falls = false;
    for (int k : *open) {
      const Friction& f = starts_[lane].plan->friction[k];
      if (again.sense[k] == 0) kept.push_back(k);
      else falls = falls || (!f.falls && f.at_rest != f.sliding);
    }
    *open = kept;
    forced = -1;
    if (!falls) break;
  }
  return true;
}

// The way out of a rest that holds first.
bool ChartedMotion::go_first_way(int lane, std::vector<int>* open, const std::vector<double>& v) {
  stand_still();
  for (std::size_t i = 0; i < v.size(); ++i) rate_[(long)i * lanes_ + lane] = v[i];
  const std::vector<Signs> ways = slips_.ways[lane];
  double most = -__builtin_inf();
  Signs best;
  bool decided = true;
  for (const Signs& way : ways) {
    const double far = margin(lane, way, place_.data(), rate_.data(), &decided);
    if (far > most) most = far, best = way;
  }
  if (best.empty() || !decided) return false;
  trial(lane, best, *open, v);
  std::vector<int> kept;
  for (int k : *open)
    if (best[k] == 0) kept.push_back(k);
  *open = kept;
  return true;
}

// Ways out of a rest whose forces are not unique.
void ChartedMotion::list_ways(int lane, const std::vector<double>& v) {
  slips_.ways[lane].clear();
  evaluate_here(lane, v, &trial_);
  std::vector<int> loose;
  for (int k = 0; k < plan_.frictions; ++k)
    if (sense(lane, k) == 0.0 && at(trial_.slip.loose, k, lane) != 0.0) loose.push_back(k);
  if (loose.empty()) return;
  const Signs now = senses(lane);
  for (const Signs& way : ways_of(lane, loose, -1))
    if (way != now) slips_.ways[lane].push_back(way);
}

// Whether a slip in several directions that has no speed left along its last direction has some beside it, in trial_.
bool ChartedMotion::turns_aside(int lane, int event) const {
  if (event < 0 || event >= plan_.frictions || has_sign(lane, event)) return false;
  const double none = SLIP_AT_REST * slips_.fastest[lane] * lever(trial_, lane, event);
  return slips_.sense[(std::size_t)event * lanes_ + lane] != 0.0 && slip_size(trial_.slip.rate, lane, event) > none;
}

bool ChartedMotion::settled(int lane, int event, std::vector<double>* v) {
  const int n = plan_.frictions;
  evaluate_here(lane, *v, &trial_);
  const bool breaks = event >= 0 && event < n && sense(lane, event) == 0.0;
  if (turns_aside(lane, event)) {
    aim_along(trial_, lane, event);
    return true;
  }
  std::vector<int> open = resting(lane, event);
  if (open.empty()) return true;
  // where nothing pushes yet, it goes as it was pushed beyond
  double push = breaks ? at(trial_.slip.force, slips_.first[event], lane) : 0.0;
  if (breaks && !(std::fabs(push) > NO_FORCE * at(trial_.slip.level, 0, lane)))
    push = slips_.pushed[(std::size_t)event * lanes_ + lane];
  hold_rates(&trial_, lane, open, v->data());
  for (int k : open) {
    sense(lane, k) = 0.0;
    slips_.armed[(std::size_t)k * lanes_ + lane] = 0.0;
    slips_.started[(std::size_t)k * lanes_ + lane] = NAN;
  }
  if (breaks) slips_.started[(std::size_t)event * lanes_ + lane] = origin_time_[lane];
  if (breaks) sense(lane, event) = !has_sign(lane, event) || push > 0.0 ? 1.0 : -1.0;
  evaluate_here(lane, *v, &trial_);
  const std::vector<int> rested = open;
  if (event == n && !go_first_way(lane, &open, *v)) return false;
  if (!set_going(lane, breaks ? event : -1, &open, *v)) return false;
  // beside rounding also what the rates could not be freed of, as in a dead centre of a joint's own
  for (int k : rested) {
    const double none = NO_SLIP * slips_.fastest[lane] * lever(trial_, lane, k);
    slips_.left[(std::size_t)k * lanes_ + lane] = std::max(NOISE * slip_size(trial_.slip.rate, lane, k), none);
  }
  return true;
}

// Where a lane stands, `event` being the joint whose slip has ended or that friction holds no longer, as many as there are
// frictions for those that rest together, or -1: what sticks, what slips, and the rates v with it.
void ChartedMotion::settle(int lane, int event, std::vector<double>* v) {
  slips_.rests[lane] = 0;
  slips_.blocked[lane] = !settled(lane, event, v);
  if (slips_.blocked[lane]) return;
  list_ways(lane, *v);
  const std::vector<int> joints = sticking(lane);
  if (joints.empty()) return;
  slips_.rests[lane] = hold_rates(&trial_, lane, joints, v->data()) == plan_.charts;
  evaluate_here(lane, *v, &trial_);
}

// A slip in several directions that begins at the limit of its friction, where nothing jumps, has neither a rate nor an
// acceleration, and no step tells its direction: it is given a rate in the one found for it, of which its direction depends stiffly. Of the stage in trial_, as v.
bool ChartedMotion::give_rates(int lane, std::vector<double>* v) {
  const int n = plan_.charts;
  const LeastSquares inertia(inertia_matrix(trial_, lane));
  bool given = false;
  for (int k = 0; k < plan_.frictions; ++k) {
    if (has_sign(lane, k) || sense(lane, k) == 0.0 || !rubs(lane, k)) continue;
    const double by_friction = at(trial_.slip.limit, k, lane) * at(trial_.slip.answer, k, lane);
    const double unit = lever(trial_, lane, k) * slips_.fastest[lane];
    if (slip_size(trial_.slip.rate, lane, k) > SLIP_AT_REST * unit || along_sense(trial_, lane, k) > NO_START * by_friction) continue;
    std::vector<double> row(n, 0.0);
    for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c)
      for (int i = 0; i < n; ++i)
        row[i] += at(slips_.aim, c, lane) * at(trial_.slip.row, (long)c * n + i, lane);
    const std::vector<double> answer = inertia.solve(row);
    double square = 0.0;
    for (int i = 0; i < n; ++i) square += row[i] * answer[i];
    if (!(square > 0.0)) continue;
    const double rate = std::max(GIVEN * by_friction * slips_.duration[lane], BESIDE_RATES * unit);
    for (int i = 0; i < n; ++i) (*v)[i] += rate / square * answer[i];
    given = true;
  }
  if (!given) return false;
  evaluate_here(lane, *v, &trial_);
  hold_rates(&trial_, lane, sticking(lane), v->data());
  return true;
}

// The rates and accelerations at a chart's origin become those of what goes on from there.
bool ChartedMotion::move(int lane, int which, double, double* y) {
  std::vector<double> v;
  for (int i = 0; i < plan_.charts; ++i) v.push_back(y[(long)(plan_.charts + i) * lanes_ + lane]);
  settle(lane, which - plan_.law.kinks - edges(), &v);
  const bool is_stiff = !slips_.blocked[lane] && give_rates(lane, &v);
  for (int i = 0; i < plan_.charts; ++i) y[(long)(plan_.charts + i) * lanes_ + lane] = v[i];
  evaluate_here(lane, v, &trial_);
  for (int c = 0; c < plan_.columns; ++c) {
    const long e = (long)c * lanes_ + lane;
    origin_first_[e] = end_.first[e] = trial_.first[e];
    origin_second_[e] = end_.second[e] = trial_.second[e];
  }
  for (int k = 0; k < plan_.frictions * TOLD_NUMBERS; ++k) {
    const std::size_t e = (std::size_t)k * lanes_ + lane;
    end_.slip.told[e] = trial_.slip.told[e];
  }
  return is_stiff;
}
