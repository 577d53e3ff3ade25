// Zeros of switches: noticed at the ends of steps and within them, met exactly by steps that end there, and passed.
//
// Values here are taken times the side: good where they are not negative. Of several zeros in one step the first counts.
#include <algorithm>
#include <cmath>

#include "integrator/crossing_search.hpp"
#include "integrator/cubic.hpp"
#include "integrator/march.hpp"

namespace {

constexpr double SMALL = 1e-12;         // of the values at the ends: what is no dip
constexpr double DOUBT = 0.1;           // of the values' range: about the cubic's least value
constexpr double OUTSIDE = 0.1;         // of the step: how far beyond it the cubic may have it
constexpr int LANDINGS = 5;             // corrections of a step that shall end at a zero
constexpr int SEARCHES = 6;             // new searches, as something else came first in it
constexpr double MOST_CHANGE = 0.1;     // of the step, in one correction
constexpr int RETURNS = 3;              // passes at one place that hold a motion

// The least that the values at four places may have between them: of the cubic through all, whose extrema and whose values
// are doubted by parts of the step and of the values' range. Without an extremum, of the inner values.
double least_between(const double* x, const double* y) {
  const Cubic cubic(x, y);
  double least = std::min(y[1], y[2]);
  // the extremum where the second derivative is positive: of a slope a + b t + c t^2
  const double third = cubic.third, c = 3.0 * third, b = 2.0 * (cubic.bend - third * (x[0] + x[1] + x[2])),
               a = cubic.slope - cubic.bend * (x[0] + x[1]) + third * (x[0] * x[1] + x[0] * x[2] + x[1] * x[2]);
  const double root = b * b - 4.0 * a * c;
  if (!(root >= 0.0)) return least;
  const double below = b + std::copysign(std::sqrt(root), b), one = -2.0 * a / below, other = -0.5 * below / c;
  const double most = std::max({y[0], y[1], y[2], y[3]}), range = most - std::min({y[0], y[3], least});
  for (double at : {one, other}) {
    if (!(at > x[0] - OUTSIDE && at < x[3] + OUTSIDE) || !(b + 2.0 * c * at > 0.0)) continue;
    least = std::min(least, cubic(std::max(x[0], std::min(x[3], at))) - DOUBT * range);
  }
  return least;
}

}  // namespace

// An event that is met again and again at one place is let alone there: it rests at its zero. So is a kink that bends
// nothing.
bool March::is_ignored(int lane, int which) const {
  const SwitchKind kind = states_.kinds[which];
  if (kind.may_be_nothing()) return muted_[(std::size_t)which * states_.lanes + lane];
  return !kind.moves && control_[lane].passed[which] >= RETURNS;
}

bool March::is_crossed_by(int lane, int which) const {
  const std::size_t k = (std::size_t)which * states_.lanes + lane;
  return states_.good(k, states_.switch_end[k]) < 0.0;
}

bool March::is_crossed(int lane, int but) const {
  for (int s = 0; s < (int)states_.kinds.size(); ++s)
    if (s != but && is_crossed_by(lane, s) && !is_ignored(lane, s)) return true;
  return false;
}

// The least value of a switch within the step, as far as its stages and, where asked, what lies between them tell.
double March::least_inside(int lane, int which, bool stages_alone) const {
  const std::size_t k = (std::size_t)which * states_.lanes + lane;
  const double x[4] = {0.0, states_.inner[0], states_.inner[1], 1.0};
  const double y[4] = {states_.good(k, states_.switch_value[k]), states_.good(k, states_.switch_inner[0][k]),
                       states_.good(k, states_.switch_inner[1][k]), states_.good(k, states_.switch_end[k])};
  double least = states_.switch_least[k];
  if (!stages_alone) least = std::min(least, least_between(x, y));
  return least < -SMALL * std::max(std::fabs(y[0]), std::fabs(y[3])) ? least : 0.0;
}

// Whether a switch may be bad within the step although both ends are good. Of one at whose zero the step shall end
// (`landing`) only the stages' own values count.
bool March::may_dip(int lane, int landing) const {
  for (int s = 0; s < (int)states_.kinds.size(); ++s)
    if (!is_ignored(lane, s) && least_inside(lane, s, s == landing) < 0.0) return true;
  return false;
}

// The same of those that are not passed at the end.
bool March::may_dip_beside(int lane) const {
  for (int s = 0; s < (int)states_.kinds.size(); ++s)
    if (!is_ignored(lane, s) && !is_crossed_by(lane, s) && least_inside(lane, s, false) < 0.0) return true;
  return false;
}

void March::look_for_crossings(Method& method, Flags* mask) {
  Flags crossed(states_.lanes, 0), suspected(states_.lanes, 0);
  for (std::size_t k = 0; k < states_.switch_end.size(); ++k) {
    double& largest = control_[k % states_.lanes].largest[k / states_.lanes];
    if ((*mask)[k % states_.lanes]) largest = std::max(largest, std::fabs(states_.switch_end[k]));
  }
  mute(mask);
  for (int i = 0; i < states_.lanes; ++i) {
    if (!(*mask)[i]) continue;
    LaneControl& c = control_[i];
    if (c.landing >= 0) {
      const bool is_first = !is_crossed(i, c.landing) && !may_dip(i, c.landing);
      if (is_first || c.landing_searches >= SEARCHES) {
        land(i, mask);
        continue;
      }
    }
    crossed[i] = is_crossed(i, -1);
    // beside one that is passed at the end another may be passed there and back before
    suspected[i] = crossed[i] ? may_dip_beside(i) : may_dip(i, -1);
    if (!crossed[i] && !suspected[i]) c.landing = -1;
  }
  if (any(crossed) || any(suspected)) search(method, crossed, suspected, mask);
}

// A step that shall end at a zero is taken where no better end is known, else tried again.
void March::land(int lane, Flags* mask) {
  LaneControl& c = control_[lane];
  const std::size_t at = (std::size_t)c.landing * states_.lanes + lane;
  const double value = states_.good(at, states_.switch_end[at]), step = states_.step[lane];
  const double change = step - c.landing_before;
  if (c.landing_tries > 0 && std::fabs(change) > 1e-9 * step) {
    const double slope = (value - c.landing_value) / change;
    if (slope < 0.0) c.landing_slope = slope;
  }
  const double wanted = c.landing_slope < 0.0 ? -value / c.landing_slope : 0.0;
  if (std::fabs(wanted) <= states_.time_rounding(lane) || c.landing_tries >= LANDINGS) {
    c.landed = true;
    return;
  }
  ++c.landing_tries;
  c.landing_value = value;
  c.landing_before = step;
  c.landing_step = step + std::max(-MOST_CHANGE * step, std::min(MOST_CHANGE * step, wanted));
  (*mask)[lane] = 0;
}

void March::search(Method& method, const Flags& crossed, const Flags& suspected, Flags* mask) {
  Flags ignored(states_.side.size());
  for (std::size_t k = 0; k < ignored.size(); ++k)
    ignored[k] = is_ignored((int)(k % states_.lanes), (int)(k / states_.lanes));
  const auto is_same = [&](int lane, int which, const double* time, const double* place, const double* slope,
                           const double* values) {
    // one that is passed at the step's end makes a difference there (`mute`), if another hides it before
    if (is_crossed_by(lane, which)) return false;
    Flags here(states_.lanes, 0);
    here[lane] = 1;
    compare_sides(which, time, place, slope, values, &here);
    muted_[(std::size_t)which * states_.lanes + lane] |= here[lane];
    return here[lane] != 0;
  };
  const std::vector<Crossing> found = CrossingSearch(states_, method, &ignored, is_same).run(crossed, suspected);
  Flags here(states_.lanes, 0);
  std::vector<int> which(states_.lanes, -1);
  for (int i = 0; i < states_.lanes; ++i) {
    LaneControl& c = control_[i];
    if (!crossed[i] && !suspected[i]) continue;
    if (found[i].kind == Crossing::NONE) {
      c.landing = -1;
      const double at = states_.time[i] + found[i].touched_part * states_.step[i];
      if (found[i].touched >= 0) states_.motion.touch(i, found[i].touched, at);
      continue;
    }
    (*mask)[i] = 0;
    if (found[i].kind == Crossing::FAULT) {
      shorten_for_fault(i);
    } else if (found[i].kind == Crossing::AT_ONCE) {
      c.landing = -1;
      which[i] = found[i].which;
      here[i] = 1;
    } else {
      const double step = states_.step[i];
      c.landing_searches = c.landing < 0 ? 0 : c.landing_searches + 1;
      c.landing = found[i].which;
      c.landing_tries = 0;
      c.landing_step = c.landing_before = found[i].part * step;
      c.landing_slope = found[i].slope / step;
    }
  }
  if (!any(here)) return;
  // what stops, and slips that end, are read off the place where the lanes stand, not off the step's end
  Flags standing = here;
  states_.evaluate(states_.time.data(), states_.y.data(), true, &standing, other_slope_.data(), values_.data());
  pass(here, which);
  for (int i = 0; i < states_.lanes; ++i)
    if (here[i] && control_[i].running) tell(i, which[i]);
}

// Switches are passed where the lanes stand: the side changes, and the rates of a kink with it.
void March::pass(const Flags& mask, const std::vector<int>& which) {
  const int lanes = states_.lanes;
  Flags anew(lanes, 0);
  for (int i = 0; i < lanes; ++i) {
    if (!mask[i]) continue;
    const std::size_t k = (std::size_t)which[i] * lanes + i;
    const bool moves = states_.kinds[which[i]].moves, is_kink = states_.kinds[which[i]].kink || moves;
    if (!moves)
      states_.turn(k, states_.switch_end[k]);
    else if (states_.motion.move(i, which[i], states_.time[i], states_.y.data()))
      go_implicit(i);
    ++control_[i].passed[which[i]];
    ++control_[i].met[which[i]];
    anew[i] = is_kink;
    if (is_kink) control_[i].sides_checked = true;
  }
  if (!any(anew)) return;
  const Flags asked = anew;
  std::vector<double>& slope = other_slope_;
  const auto evaluate = [&](Flags* lanes_there) {
    states_.evaluate(states_.time.data(), states_.y.data(), false, lanes_there, slope.data(), values_.data());
  };
  evaluate(&anew);
  Flags changed(lanes, 0);
  for (int i = 0; i < lanes; ++i) changed[i] = asked[i] && has_changed(i, which[i], values_);
  if (any(changed)) {
    settle_sides(changed, which, false);
    anew = asked;
    evaluate(&anew);
  }
  meet_events(anew);
  states_.error_scales(states_.y.data(), states_.y.data(), scale_.data());
  for (int i = 0; i < lanes; ++i) {
    if (asked[i] && !anew[i]) finish(i, LaneEnd::STUCK);
    if (!anew[i]) continue;
    if (control_[i].passed[which[i]] >= RETURNS) hold(i, which[i]);
    renew(i);
    states_.speed[i] = std::max(states_.speed[i], states_.speed_in(states_.y.data(), i));
  }
}

// Events of lanes that stand at kinks: their values may have jumped over their zero there, or have come to it, which is a
// passage unless they go back. `other_slope_` and `values_` are those behind the kinks.
void March::meet_events(const Flags& mask) {
  const int lanes = states_.lanes, switches = (int)states_.kinds.size();
  Flags at_zero(lanes, 0);
  std::vector<double> rounding;
  for (int s = 0; s < switches; ++s)
    for (int i = 0; i < lanes; ++i) {
      const std::size_t k = (std::size_t)s * lanes + i;
      if (!mask[i] || !states_.kinds[s].is_event()) continue;
      if (rounding.empty()) rounding = roundings(mask, values_);
      const double value = states_.side[k] * values_[k];
      if (value < -rounding[k]) {
        jump(i, s);
      } else if (value <= rounding[k]) {
        // an event that has rested at its zero is none
        const double before = std::max(std::fabs(states_.switch_inner[0][k]), std::fabs(states_.switch_inner[1][k]));
        at_zero[i] |= before > rounding[k];
      }
    }
  if (!any(at_zero)) return;
  const std::vector<std::int8_t> ahead = sides_ahead(at_zero, other_slope_, values_, rounding);
  for (int s = 0; s < switches; ++s)
    for (int i = 0; i < lanes; ++i) {
      const std::size_t k = (std::size_t)s * lanes + i;
      if (!at_zero[i] || !states_.kinds[s].is_event() || std::fabs(values_[k]) > rounding[k]) continue;
      if (std::max(std::fabs(states_.switch_inner[0][k]), std::fabs(states_.switch_inner[1][k])) <= rounding[k]) continue;
      // one that was passed at this place lies at its zero, too
      const int goes = ahead[k] * states_.side[k];
      if (goes < 0 || (goes == 0 && !control_[i].passed[s])) jump(i, s);
    }
}

void March::jump(int lane, int which) {
  const std::size_t k = (std::size_t)which * states_.lanes + lane;
  states_.side[k] = (std::int8_t)-states_.side[k];
  ++control_[lane].passed[which];
  ++control_[lane].met[which];
  control_[lane].jumped.push_back(which);
}

// A kink that the motion comes back to holds it, if the rates jump there: `other_slope_` and `slope` are those of both sides.
void March::hold(int lane, int which) {
  if (!states_.kinds[which].may_be_nothing() ||
      !bends_nothing(lane, states_.y.data(), states_.slope.data(), other_slope_.data(), states_.step[lane]))
    return finish(lane, LaneEnd::HELD, which);
  control_[lane].let_alone[which] = 1;
}

void March::pass_landed(const Flags& mask) {
  Flags landed(states_.lanes);
  std::vector<int> which(states_.lanes, -1);
  for (int i = 0; i < states_.lanes; ++i) {
    landed[i] = mask[i] && control_[i].landed;
    which[i] = control_[i].landing;
  }
  pass(landed, which);
}

// Tells the motion of a switch that was passed, and of events that were passed with it; they may end the lane.
void March::tell(int lane, int which) {
  std::vector<int> passed;
  passed.swap(control_[lane].jumped);
  passed.insert(passed.begin(), which);
  for (int s : passed) {
    if (states_.kinds[s].moves || !control_[lane].running) continue;
    const bool rising = states_.side[(std::size_t)s * states_.lanes + lane] > 0;
    if (states_.motion.event(lane, s, rising, states_.time[lane])) finish(lane, LaneEnd::STOPPED, s);
  }
}
