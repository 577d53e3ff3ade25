#include "integrator/crossing_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace {

constexpr int SCAN = 8;                         // parts in which a step is looked into
constexpr int DEEPER = 8;                       // more places where values are least
constexpr double EDGE = 0.999;                  // of an interval in which the least value is looked for
constexpr double NEAR_ZERO = 0.25;              // of the range of three values: a least value that may be below zero
constexpr double EARLY[] = {1e-3, 1e-6, 1e-9};  // of the step: where a switch is asked that begins at a zero
constexpr double ZERO_PART = 1e-12;             // in parts of the value at the other end
constexpr double MUCH = 4.0;                    // times as bad as where a kink was found to make a difference
constexpr int MOST_TRIES = 80;
constexpr double FOUND = 1e-10;                 // of the step; what is left is done by steps
constexpr int BISECT_EVERY = 3;

}  // namespace

CrossingSearch::CrossingSearch(LaneStates& states, Method& method, Flags* ignored, IsSame is_same)
    : states_(states), method_(method), ignored_(*ignored), is_same_(std::move(is_same)),
      compared_(states.side.size(), 0.0), bracket_(states.lanes), found_(states.lanes), seen_(states.lanes), open_(states.lanes), part_(states.lanes), at_(states.lanes), place_(states.entries),
      slope_(states.entries), switches_(states.kinds.size() * states.lanes) {}

std::size_t CrossingSearch::Samples::insert(double at, const std::vector<double>& seen) {
  const std::size_t k = std::lower_bound(part.begin(), part.end(), at) - part.begin();
  part.insert(part.begin() + (long)k, at);
  values.insert(values.begin() + (long)k, seen);
  return k;
}

// Where the least of all parabolas through three neighbours is, within a thousandth of an interval from its ends, where the
// next parabola tells more; false where none comes near zero or where it was looked at before.
bool CrossingSearch::Samples::deepest(double* at) const {
  double least = __builtin_inf();
  for (std::size_t k = 1; k + 1 < part.size(); ++k)
    for (std::size_t s = 0; s < values[k].size(); ++s) {
      const double a = values[k - 1][s], b = values[k][s], c = values[k + 1][s];
      const double left = part[k] - part[k - 1], right = part[k + 1] - part[k];
      const double fall = (b - a) / left, rise = (c - b) / right, bend = (rise - fall) / (left + right);
      if (!(bend > 0.0)) continue;
      const double slope = fall + bend * left, low = -EDGE * left, high = EDGE * right;
      const double shift = std::max(low, std::min(high, -0.5 * slope / bend)), found = b + shift * (slope + bend * shift);
      const double range = std::max({a, b, c}) - std::min({a, b, c});
      if (!(found < least) || found > NEAR_ZERO * range) continue;
      least = found;
      *at = part[k] + shift;
    }
  return least < __builtin_inf() && !std::binary_search(part.begin(), part.end(), *at);
}

// The bad switch whose zero is the first by the secant, and where that is. A kink comes before what it moves at the same place,
// other kinks and events, which are listed behind it: their values beyond are those of the other side. One that rests at its
// zero leaves it with another kink, which then comes first; alone it is bisected, as its values tell nothing of where it does.
int CrossingSearch::first(int lane, double* where) const {
  const Bracket& b = bracket_[lane];
  const std::vector<SwitchKind>& kinds = states_.kinds;
  int which = -1, resting = -1;
  for (std::size_t s = 0; s < kinds.size(); ++s) {
    if (!(b.at_high[s] < 0.0)) continue;
    if (!states_.side[s * states_.lanes + lane]) {
      resting = (int)s;
      continue;
    }
    const double above = std::max(b.at_low[s], 0.0) * b.low_weight, below = b.at_high[s] * b.high_weight;
    const double x = b.low + (b.high - b.low) * (above / (above - below));
    // those before come first
    const double margin = which >= 0 && kinds[which].bends_event ? FOUND : 0.0;
    if (which >= 0 && !(x < *where - margin)) continue;
    *where = x;
    which = (int)s;
  }
  if (which >= 0 || resting < 0) return which;
  *where = 0.5 * (b.low + b.high);
  return resting;
}

// Whether a switch is bad at the place that a lane was looked at.
bool CrossingSearch::is_bad(int lane) const {
  for (double v : seen_[lane])
    if (v < 0.0) return true;
  return false;
}

// The event that is rounding at a place of a step that was looked at, and more on both sides: at one end alone it begins at a
// zero that it has passed, or comes to one that it may pass.
void CrossingSearch::find_touch(int lane, const Samples& samples) {
  for (std::size_t s = 0; s < states_.kinds.size(); ++s) {
    if (!states_.kinds[s].is_event()) continue;
    const double begin = samples.values.front()[s], end = samples.values.back()[s], none = TOUCH * std::max(begin, end);
    if (!(std::min(begin, end) > none)) continue;
    for (std::size_t k = 1; k + 1 < samples.part.size(); ++k)
      if (samples.values[k][s] <= none) found_[lane].touched = (int)s, found_[lane].touched_part = samples.part[k];
  }
}

std::vector<double> CrossingSearch::values(const std::vector<double>& switches, int lane) const {
  std::vector<double> own(states_.kinds.size());
  for (std::size_t s = 0; s < own.size(); ++s) {
    const std::size_t k = s * states_.lanes + lane;
    own[s] = ignored_[k] ? 0.0 : states_.good(k, switches[k]);
  }
  return own;
}

void CrossingSearch::look() {
  for (int i = 0; i < states_.lanes; ++i) {
    if (!open_[i]) part_[i] = 0.0;
    at_[i] = states_.time[i] + part_[i] * states_.step[i];
  }
  const Flags asked = open_;
  method_.dense(states_, open_, part_.data(), place_.data());
  states_.evaluate(at_.data(), place_.data(), false, &open_, slope_.data(), switches_.data());
  for (int i = 0; i < states_.lanes; ++i) {
    if (open_[i]) {
      forget_kinks(i);
      seen_[i] = values(switches_, i);
    } else if (asked[i]) {
      states_.reached[i] = part_[i];
      found_[i].kind = Crossing::FAULT;
    }
  }
}

// Kinks that are bad at the place that was looked at, and make no difference, are ignored.
void CrossingSearch::forget_kinks(int lane) {
  for (std::size_t s = 0; s < states_.kinds.size(); ++s) {
    const std::size_t k = s * states_.lanes + lane;
    const double bad = -states_.good(k, switches_[k]);
    if (!states_.kinds[s].may_be_nothing() || ignored_[k] || !(bad > compared_[k])) continue;
    compared_[k] = MUCH * bad;
    ignored_[k] = is_same_(lane, (int)s, at_.data(), place_.data(), slope_.data(), switches_.data());
    if (ignored_[k]) bracket_[lane].at_low[s] = bracket_[lane].at_high[s] = 0.0;
  }
}

void CrossingSearch::end(int lane, Crossing::Kind kind) {
  const Bracket& b = bracket_[lane];
  Crossing& c = found_[lane];
  open_[lane] = 0;
  c.kind = kind;
  if (kind == Crossing::NONE) return;
  c.which = first(lane, &c.part);
  // all that was bad is ignored
  if (c.which < 0) return (void)(c.kind = Crossing::NONE);
  // beyond a kink that is passed before its zero events have values that they never take
  const double near = states_.kinds[c.which].moves ? EARLY[2] * states_.step[lane] : states_.time_rounding(lane);
  c.kind = c.part * states_.step[lane] <= near ? Crossing::AT_ONCE : Crossing::WITHIN;
  c.slope = (b.at_high[c.which] - b.at_low[c.which]) / (b.high - b.low);
}

// The bracket of a lane becomes the side of part_ where the first zero is.
void CrossingSearch::move(int lane, bool bad) {
  Bracket& b = bracket_[lane];
  (bad ? b.high : b.low) = part_[lane];
  (bad ? b.at_high : b.at_low) = seen_[lane];
}

std::vector<Crossing> CrossingSearch::run(const Flags& crossed, const Flags& suspected) {
  for (int i = 0; i < states_.lanes; ++i) {
    open_[i] = crossed[i] || suspected[i];
    if (!open_[i]) continue;
    bracket_[i].at_low = values(states_.switch_value, i);
    bracket_[i].at_high = values(states_.switch_end, i);
  }
  const Flags asked = open_;
  method_.prepare_dense(states_, &open_);
  for (int i = 0; i < states_.lanes; ++i)
    if (asked[i] && !open_[i]) found_[i].kind = Crossing::FAULT;
  scan(crossed, suspected);
  look_early();
  close_in();
  return found_;
}

// Looks into the suspected lanes at equal parts, then where their values are likely to be least, and narrows them to the
// first bad place that it meets; those without one that are crossed keep the step's end.
void CrossingSearch::scan(const Flags& crossed, const Flags& suspected) {
  Flags waiting(states_.lanes, 0);
  std::vector<Samples> samples(states_.lanes);
  for (int i = 0; i < states_.lanes; ++i) {
    if (!suspected[i]) std::swap(open_[i], waiting[i]);
    samples[i].insert(0.0, bracket_[i].at_low);
    samples[i].insert(1.0, bracket_[i].at_high);
  }
  for (int k = 1; k < SCAN + DEEPER && any(open_); ++k) {
    for (int i = 0; i < states_.lanes; ++i) {
      part_[i] = (double)k / SCAN;
      if (open_[i] && k >= SCAN && !samples[i].deepest(&part_[i])) crossed[i] ? std::swap(open_[i], waiting[i]) : end(i, Crossing::NONE);
    }
    look();
    for (int i = 0; i < states_.lanes; ++i) {
      if (!open_[i]) continue;
      const std::size_t at = samples[i].insert(part_[i], seen_[i]);
      // what an event has below its zero by rounding
      for (std::size_t e = 0; e < seen_[i].size(); ++e) {
        const double ends = std::max(samples[i].values.front()[e], samples[i].values.back()[e]);
        if (states_.kinds[e].is_event() && seen_[i][e] < 0.0 && seen_[i][e] >= -TOUCH * ends)
          seen_[i][e] = samples[i].values[at][e] = 0.0;
      }
      if (!is_bad(i)) continue;
      Bracket& b = bracket_[i];
      b.low = samples[i].part[at - 1];
      b.at_low = samples[i].values[at - 1];
      b.high = part_[i];
      b.at_high = seen_[i];
      waiting[i] = 1;
      open_[i] = 0;
    }
  }
  for (int i = 0; i < states_.lanes; ++i) {
    if (open_[i]) crossed[i] ? (void)(waiting[i] = 1) : end(i, Crossing::NONE);
    if (suspected[i] && !waiting[i]) find_touch(i, samples[i]);
    open_[i] = waiting[i];
  }
}

// Where a switch begins at a zero its value there is rounding: whether it is good a moment later tells a step that comes
// back from one that leaves the wrong way.
void CrossingSearch::look_early() {
  Flags waiting(states_.lanes, 0);
  for (int i = 0; i < states_.lanes; ++i) {
    if (!open_[i]) continue;
    const Bracket& b = bracket_[i];
    bool begins = false;
    for (std::size_t s = 0; s < b.at_high.size(); ++s)
      begins = begins || (b.at_high[s] < 0.0 && b.at_low[s] <= -ZERO_PART * b.at_high[s]);
    if (begins && b.low == 0.0) continue;
    waiting[i] = 1;
    open_[i] = 0;
  }
  for (double early : EARLY) {
    if (!any(open_)) break;
    std::fill(part_.begin(), part_.end(), early);
    look();
    for (int i = 0; i < states_.lanes; ++i) {
      if (!open_[i]) continue;
      const bool bad = is_bad(i);
      move(i, bad);
      if (bad) continue;
      waiting[i] = 1;
      open_[i] = 0;
    }
  }
  for (int i = 0; i < states_.lanes; ++i) {
    if (open_[i]) end(i, Crossing::AT_ONCE);
    open_[i] = waiting[i];
  }
}

void CrossingSearch::close_in() {
  for (int k = 1; k <= MOST_TRIES && any(open_); ++k) {
    for (int i = 0; i < states_.lanes; ++i) {
      if (!open_[i]) continue;
      Bracket& b = bracket_[i];
      if (first(i, &part_[i]) < 0) {
        end(i, Crossing::NONE);
        continue;
      }
      // a value that is small at the low end draws the secant there, wherever it is that another kink makes it bad
      if (b.high - b.low > 2.0 * FOUND) part_[i] = std::max(part_[i], b.low + 2.0 * FOUND);
      const bool is_near = std::fabs(part_[i] - b.tried) <= FOUND || b.high - b.low <= FOUND;
      if (is_near) end(i, Crossing::WITHIN);
      b.tried = part_[i];
      if (k % BISECT_EVERY == 0) part_[i] = 0.5 * (b.low + b.high);
    }
    if (!any(open_)) return;
    look();
    for (int i = 0; i < states_.lanes; ++i) {
      if (!open_[i]) continue;
      Bracket& b = bracket_[i];
      const bool bad = is_bad(i);
      // an end that stays twice weighs half
      (bad ? b.high_weight : b.low_weight) = 1.0;
      (bad ? b.low_weight : b.high_weight) *= 0.5;
      move(i, bad);
    }
  }
  for (int i = 0; i < states_.lanes; ++i)
    if (open_[i]) end(i, Crossing::WITHIN);
}
