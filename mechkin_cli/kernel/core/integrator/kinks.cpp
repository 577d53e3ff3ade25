// Kinks that bend nothing: where what is taken the magnitude of, or compared, is rounding alone, as is a rate that the
// loops forbid, both sides of the kink give the same motion. A step goes through such a kink as if it were not there.
#include <algorithm>
#include <cmath>

#include "integrator/march.hpp"

namespace {

// What the other side of a kink may do to a step, in parts of the error that a step may have; at least so many roundings.
constexpr double NOTHING = 1e-2, ROUNDINGS = 1e3 * 2.220446049250313e-16;
constexpr double SLOPE_ROUNDING = 2.220446049250313e-16;  // of a rate
constexpr double SHIFT = 1e-9;  // of a kink's largest value so far: what another kink does to it
constexpr double KINK_NOISE = 16.0;  // times the rounding of a kink's value: what may be a sign of rounding alone

}  // namespace

// Whether a lane moves by less than what is told of its rates.
bool March::rests(int lane, const double* y) const {
  const int n = states_.freedoms;
  return states_.speed_in(y, lane) <= scale_[(std::size_t)n * states_.lanes + lane] && !states_.motion.is_driven();
}

// Whether two slopes at y differ by no more than makes no difference to a step; `scale_` is that of the place. Powers of what
// rests are rounding.
bool March::bends_nothing(int lane, const double* y, const double* a, const double* b, double step) const {
  const int n = states_.freedoms, lanes = states_.lanes;
  const double most = std::max(NOTHING, ROUNDINGS / states_.settings.tolerance);
  const int works = rests(lane, y) ? states_.motion.works() : 0;
  for (int c = n; c < states_.size; ++c) {
    if (c >= 2 * n && c < 2 * n + works) continue;
    const std::size_t k = (std::size_t)c * lanes + lane;
    // a difference that is lost in the rates' rounding may be as large
    const double jump = step * (std::fabs(a[k] - b[k]) + SLOPE_ROUNDING * std::fabs(a[k]));
    if (jump > 0.0 && !(jump <= most * scale_[k])) return false;
  }
  return true;
}

// The rates at a place on the other side of kinks (lanes: their numbers, rising), and of the kinks around them that turn with
// them there, in `other_slope_`; `values` are those there on this side. Lanes with a fault leave `told`.
void March::turn_with_outer(const std::vector<std::vector<int>>& which, const double* time, const double* place,
                            const double* values, const Flags& mask, Flags* told) {
  const int lanes = states_.lanes, switches = (int)states_.kinds.size();
  const std::vector<std::int8_t> kept = states_.side;
  Flags open = mask;
  for (int i = 0; i < lanes; ++i)
    for (std::size_t n = 0; open[i] && n < which[i].size(); ++n) {
      const std::size_t at = (std::size_t)which[i][n] * lanes + i;
      states_.turn(at, values[at]);
    }
  for (int k = 0; k <= switches && any(open); ++k) {
    Flags asked = open;
    states_.evaluate(time, place, false, &asked, other_slope_.data(), values_.data());
    for (int i = 0; i < lanes; ++i) {
      if (!open[i]) continue;
      (*told)[i] = asked[i];
      open[i] = 0;
      for (int s = which[i].front() + 1; s < switches && !open[i]; ++s) {
        const std::size_t at = (std::size_t)s * lanes + i;
        if (!states_.kinds[s].may_be_nothing() || values_[at] == values[at]) continue;
        const bool rests = states_.kinds[s].may_rest && values_[at] == 0.0 && states_.side[at];
        open[i] = rests || states_.good(at, values_[at]) < 0.0;
        if (open[i]) rests ? (void)(states_.side[at] = 0) : states_.turn(at, values_[at]);
      }
    }
  }
  states_.side = kept;
}

// Whether the other side of a kink makes no difference to the step that was tried, where `slope` is known at a place of it
// and the switches' values are `values`: as far from zero as that there, elsewhere as far as the stages tell. Asks all lanes
// in the mask, which keeps those where it makes none. `scale_` is the step's.
void March::compare_sides(int which, const double* time, const double* place, const double* slope, const double* values,
                          Flags* mask) {
  const int lanes = states_.lanes;
  const double* const value = values + (std::size_t)which * lanes;
  Flags told(lanes, 0), seen(lanes, 0), asked(lanes, 0);
  std::vector<double> depth(lanes, 0.0);
  turn_with_outer(std::vector<std::vector<int>>(lanes, {which}), time, place, values, *mask, &told);
  for (int i = 0; i < lanes; ++i) {
    if (!(*mask)[i]) continue;
    const std::size_t at = (std::size_t)which * lanes + i;
    const double at_end = -states_.good(at, states_.switch_end[at]);
    const double deepest = std::max(-least_inside(i, which, false), at_end), here = std::fabs(value[i]);
    // one that is zero at the place tells nothing of the rates farther on
    const double ratio = deepest > here && here > 0.0 ? deepest / here : 1.0;
    (*mask)[i] = told[i] && bends_nothing(i, place, slope, other_slope_.data(), ratio * states_.step[i]);
    // events and other kinks see it whatever the rates do
    seen[i] = states_.kinds[which].bends_event || shifts_kinks(i, which, values) || (deepest > 0.0 && here == 0.0);
    asked[i] = (*mask)[i] && seen[i];
    depth[i] = std::max(deepest, here);
    states_.fault[i] = 0;
  }
  if (!any(asked)) return;
  const std::vector<double> rounding = roundings(asked, states_.switch_value);
  for (int i = 0; i < lanes; ++i) {
    if (!asked[i]) continue;
    // one place may show none by chance
    double& noise = control_[i].noise[which];
    noise = std::max(noise, rounding[(std::size_t)which * lanes + i]);
    (*mask)[i] = depth[i] <= KINK_NOISE * noise;
  }
}

// Whether the values of other kinks in `values_`, beyond the kink `which`, differ from those before it.
bool March::shifts_kinks(int lane, int which, const double* values) const {
  for (int s = 0; s < (int)states_.kinds.size(); ++s) {
    const std::size_t at = (std::size_t)s * states_.lanes + lane;
    if (s == which || !states_.kinds[s].may_be_nothing()) continue;
    if (std::fabs(values_[at] - values[at]) > SHIFT * control_[lane].largest[s]) return true;
  }
  return false;
}

// Finds the kinks that lanes pass within the step, or may pass, without its making a difference: their rates at its end are
// compared with those of the other side. A kink that is let alone and makes a difference shortens the step.
void March::mute(Flags* mask) {
  const int lanes = states_.lanes;
  std::fill(muted_.begin(), muted_.end(), 0);
  states_.error_scales(states_.y.data(), states_.y_end.data(), scale_.data());
  for (int s = 0; s < (int)states_.kinds.size(); ++s) {
    if (!states_.kinds[s].may_be_nothing()) continue;
    const std::size_t at = (std::size_t)s * lanes;
    Flags asked(lanes, 0);
    for (int i = 0; i < lanes; ++i)
      asked[i] = (*mask)[i] && control_[i].landing != s && (is_crossed_by(i, s) || least_inside(i, s, false) < 0.0);
    if (!any(asked)) continue;
    Flags same = asked;
    compare_sides(s, states_.until.data(), states_.y_end.data(), states_.slope_end.data(), states_.switch_end.data(),
                  &same);
    compare_where_passed(s, &same);
    for (int i = 0; i < lanes; ++i) {
      if (!asked[i]) continue;
      muted_[at + i] = same[i] || (control_[i].let_alone[s] && states_.settings.fixed_step > 0.0);
      if (muted_[at + i] || !control_[i].let_alone[s]) continue;
      (*mask)[i] = 0;
      refuse(i, 0.5 * states_.step[i]);
      if (!control_[i].running) finish(i, LaneEnd::HELD, s);
    }
  }
  compare_together(*mask);
}

// Both sides may give the same at the step's end by chance, as those of if(v < 1, t, 2) do at t = 2: lanes whose step passes the
// kink are asked about the place where it does, too, on the cubic between the ends.
void March::compare_where_passed(int which, Flags* mask) {
  const int lanes = states_.lanes;
  Flags passed(lanes, 0), told(lanes, 0);
  for (int i = 0; i < lanes; ++i) {
    passed[i] = (*mask)[i] && is_crossed_by(i, which);
    part_[i] = 0.0, at_[i] = states_.time[i];
    if (!passed[i]) continue;
    const std::size_t at = (std::size_t)which * lanes + i;
    const double begin = std::max(states_.good(at, states_.switch_value[at]), 0.0);
    part_[i] = begin / (begin - states_.good(at, states_.switch_end[at]));
    at_[i] += part_[i] * states_.step[i];
  }
  if (!any(passed)) return;
  for (long k = 0; k < states_.entries; ++k) {
    const double x = part_[k % lanes], step = states_.step[k % lanes], rise = states_.y_end[k] - states_.y[k];
    const double first = step * states_.slope[k] - rise, second = rise - step * states_.slope_end[k];
    place_[k] = passed[k % lanes] ? states_.y[k] + x * (rise + (1.0 - x) * ((1.0 - x) * first + x * second)) : states_.y[k];
  }
  std::vector<double> slope(states_.entries), values(states_.side.size());
  const Flags asked = passed;
  states_.evaluate(at_.data(), place_.data(), false, &passed, slope.data(), values.data());
  if (any(passed)) turn_with_outer(std::vector<std::vector<int>>(lanes, {which}), at_.data(), place_.data(), values.data(), passed, &told);
  for (int i = 0; i < lanes; ++i) {
    if (!asked[i]) continue;
    states_.fault[i] = 0;
    if (passed[i] && told[i] && !bends_nothing(i, place_.data(), slope.data(), other_slope_.data(), states_.step[i]))
      (*mask)[i] = 0;
  }
}

// Kinks that bend nothing one by one may bend something together, as in if(x < 1, floor(x), 0) where a step passes 1 and 0:
// those that are passed first, the first two, three ..., are turned together. Where that makes a difference none of them is
// muted.
void March::compare_together(const Flags& mask) {
  const int lanes = states_.lanes, switches = (int)states_.kinds.size();
  std::vector<std::vector<int>> passed(lanes), first(lanes);
  std::size_t most = 0;
  for (int i = 0; i < lanes; ++i) {
    std::vector<double> part(switches, 0.0);
    for (int s = 0; s < switches; ++s) {
      const std::size_t at = (std::size_t)s * lanes + i;
      if (!mask[i] || !muted_[at] || !is_crossed_by(i, s)) continue;
      const double begin = std::max(states_.good(at, states_.switch_value[at]), 0.0), end = -states_.good(at, states_.switch_end[at]);
      part[s] = begin / (begin + end);
      passed[i].push_back(s);
    }
    std::stable_sort(passed[i].begin(), passed[i].end(), [&](int a, int b) { return part[a] < part[b]; });
    most = std::max(most, passed[i].size());
  }
  for (std::size_t count = 2; count <= most; ++count) {
    Flags asked(lanes, 0), told(lanes, 0);
    for (int i = 0; i < lanes; ++i) {
      asked[i] = passed[i].size() >= count;
      if (!asked[i]) continue;
      first[i].assign(passed[i].begin(), passed[i].begin() + (long)count);
      std::sort(first[i].begin(), first[i].end());
    }
    turn_with_outer(first, states_.until.data(), states_.y_end.data(), states_.switch_end.data(), asked, &told);
    for (int i = 0; i < lanes; ++i) {
      if (!asked[i]) continue;
      states_.fault[i] = 0;
      const double* const end = states_.y_end.data();
      if (told[i] && bends_nothing(i, end, states_.slope_end.data(), other_slope_.data(), states_.step[i])) continue;
      for (int s : passed[i]) muted_[(std::size_t)s * lanes + i] = 0;
      passed[i].clear();
    }
  }
}
