// The sides of kinks where lanes stand, decided anew in program order: what a kink compares may hold other kinks, which
// come before it. A value that is not zero tells its side; a zero tells it a moment later, by where the motion goes.
#include <algorithm>
#include <cmath>

#include "integrator/march.hpp"

namespace {

// Roundings of places: rad and parts of the size, parts of the speed, parts of the time.
constexpr double PLACE_ROUNDING = 1e-14, RATE_ROUNDING = 1e-14, TIME_ROUNDING = 1e-15;
// Looks ahead, in parts of the time in which the motion goes 1 (rad, part of the size): the first that is clear tells.
constexpr double AHEAD[] = {1e-6, 1e-4, 1e-2};
constexpr double CLEAR = 4.0;    // times the rounding
constexpr int TURNS = 4;         // for each switch: more than its own and those that inner ones cause, each way

}  // namespace

// What roundings of the place and the time may do to the switches' values there, switches x lanes.
std::vector<double> March::roundings(const Flags& mask, const std::vector<double>& values) {
  const int lanes = states_.lanes;
  const long moved = (long)states_.freedoms * lanes;
  std::vector<double> found(values.size(), 0.0), seen(values.size()), slope(states_.entries);
  for (int way : {1, -1}) {
    for (int i = 0; i < lanes; ++i)
      at_[i] = states_.time[i] + TIME_ROUNDING * std::max(std::fabs(states_.time[i]), states_.duration[i]);
    place_ = states_.y;
    for (long k = 0; k < 2 * moved; ++k) {
      // a rate that is zero is exact: of what starts from rest, or has come to it by friction
      if (k >= moved && place_[k] == 0.0) continue;
      const double off = k < moved ? PLACE_ROUNDING : RATE_ROUNDING * states_.speed[k % lanes];
      place_[k] += k / lanes % 2 ? way * off : off;
    }
    Flags asked = mask;
    states_.evaluate(at_.data(), place_.data(), false, &asked, slope.data(), seen.data());
    for (std::size_t k = 0; k < found.size(); ++k)
      if (mask[k % lanes]) found[k] += std::fabs(seen[k] - values[k]);
  }
  for (std::size_t k = 0; k < found.size(); ++k)
    if (states_.kinds[k / lanes].moves) found[k] = 0.0;
  return found;
}

// The sides that values which are zero have a moment later, switches x lanes, 0 where nothing is told; `slope` is that where
// the lanes stand.
std::vector<std::int8_t> March::sides_ahead(const Flags& mask, const std::vector<double>& slope,
                                            const std::vector<double>& values, const std::vector<double>& rounding) {
  const int lanes = states_.lanes;
  const long moved = (long)states_.freedoms * lanes;
  std::vector<std::int8_t> side(values.size(), 0);
  std::vector<double> seen(values.size()), other(states_.entries);
  for (double part : AHEAD) {
    std::vector<double> h(lanes);
    for (int i = 0; i < lanes; ++i) {
      const double rate = states_.speed_in(states_.y.data(), i), bend = states_.speed_in(slope.data(), i);
      h[i] = part / std::max(1.0 / states_.duration[i], std::max(rate, std::sqrt(bend)));
      at_[i] = states_.time[i] + h[i];
    }
    for (long k = 0; k < states_.entries; ++k) {
      const double t = h[k % lanes], bend = k < moved ? 0.5 * t * t * slope[k + moved] : 0.0;
      place_[k] = states_.y[k] + (t * slope[k] + bend);
    }
    Flags asked = mask;
    states_.evaluate(at_.data(), place_.data(), false, &asked, other.data(), seen.data());
    for (std::size_t k = 0; k < side.size(); ++k) {
      const bool is_clear = std::fabs(seen[k]) > CLEAR * (rounding[k] + std::fabs(values[k]));
      if (asked[k % lanes] && !side[k] && is_clear) side[k] = seen[k] < 0.0 ? -1 : 1;
    }
  }
  return side;
}

// Decides the sides of the lanes in the mask where they stand: of kinks that stay where they are, at the start of all
// switches. `known` (lanes): a kink that was passed there, whose side is known as long as those before it stay; -1 for none.
void March::settle_sides(Flags mask, std::vector<int> known, bool is_start) {
  const int lanes = states_.lanes, switches = (int)states_.kinds.size();
  std::vector<double> slope(states_.entries), values(states_.side.size());
  Flags turned(states_.side.size(), 0);
  const auto is_open = [&](int s, int i) {
    return s != known[i] && (states_.kinds[s].may_be_nothing() || (is_start && !states_.kinds[s].moves));
  };
  const auto turn = [&](int s, int i) {
    const std::size_t at = (std::size_t)s * lanes + i;
    states_.turn(at, values[at]);
    if (s < known[i]) known[i] = -1;
  };
  for (int k = 0; k < TURNS * switches && any(mask); ++k) {
    Flags stands = mask;
    // a fault on wrong sides is none yet
    states_.evaluate(states_.time.data(), states_.y.data(), false, &stands, slope.data(), values.data());
    const std::vector<double> rounding = roundings(mask, values);
    Flags agrees(lanes, 0), has_zero(lanes, 0);
    for (int i = 0; i < lanes; ++i) {
      if (!mask[i]) continue;
      agrees[i] = 1;
      for (int s = 0; s < switches && agrees[i]; ++s) {
        const std::size_t at = (std::size_t)s * lanes + i;
        if (!is_open(s, i)) continue;
        agrees[i] = !(states_.good(at, values[at]) < -rounding[at]);
        if (!agrees[i]) turn(s, i);
        has_zero[i] |= std::fabs(values[at]) <= rounding[at];
      }
      has_zero[i] = has_zero[i] && agrees[i] && stands[i];
      if (agrees[i] && !has_zero[i]) mask[i] = 0;
    }
    if (!any(has_zero)) continue;
    const std::vector<std::int8_t> ahead = sides_ahead(has_zero, slope, values, rounding);
    for (int i = 0; i < lanes; ++i) {
      if (!has_zero[i]) continue;
      mask[i] = 0;
      for (int s = 0; s < switches && !mask[i]; ++s) {
        const std::size_t at = (std::size_t)s * lanes + i;
        if (!is_open(s, i) || turned[at] || !(std::fabs(values[at]) <= rounding[at])) continue;
        const bool rests = states_.kinds[s].may_rest && values[at] == 0.0 && rounding[at] == 0.0 && !ahead[at];
        const std::int8_t side = rests ? 0 : ahead[at] ? ahead[at] : states_.side[at] ? states_.side[at] : 1;
        if (side == states_.side[at]) continue;
        turned[at] = mask[i] = 1;
        states_.side[at] = side;
        if (s < known[i]) known[i] = -1;
      }
    }
  }
  std::fill(states_.fault.begin(), states_.fault.end(), 0);
}

// Whether a kink has another value than at the last place: it holds one that was passed; or none where a rate has come to
// rest, which it then rests with.
bool March::has_changed(int lane, int but, const std::vector<double>& values) const {
  for (int s = 0; s < (int)states_.kinds.size(); ++s) {
    const std::size_t k = (std::size_t)s * states_.lanes + lane;
    if (s == but || !states_.kinds[s].may_be_nothing()) continue;
    if (values[k] != states_.switch_value[k] || (values[k] == 0.0 && states_.kinds[but].moves)) return true;
  }
  return false;
}

// No step begins with a side that its value contradicts.
void March::check_sides(const Flags& mask) {
  const int lanes = states_.lanes;
  Flags wrong(lanes, 0);
  for (int i = 0; i < lanes; ++i) {
    LaneControl& c = control_[i];
    if (!mask[i] || c.sides_checked) continue;
    c.sides_checked = true;
    wrong[i] = c.sides_stale;
    c.sides_stale = false;
    for (int s = 0; s < (int)states_.kinds.size(); ++s)
      wrong[i] |= states_.kinds[s].may_be_nothing() && is_wrong(i, s);
  }
  if (!any(wrong)) return;
  settle_sides(wrong, std::vector<int>(lanes, -1), false);
  const Flags asked = wrong;
  states_.evaluate(states_.time.data(), states_.y.data(), false, &wrong, other_slope_.data(), values_.data());
  for (int i = 0; i < lanes; ++i)
    if (asked[i]) wrong[i] ? renew(i) : finish(i, LaneEnd::STUCK);
}

bool March::is_wrong(int lane, int which) const {
  const std::size_t k = (std::size_t)which * states_.lanes + lane;
  return states_.good(k, states_.switch_value[k]) < 0.0;
}

// The rates and values in `other_slope_` and `values_` are those where a lane stands.
void March::renew(int lane) {
  const int lanes = states_.lanes;
  if (implicit_) implicit_->forget(lane);
  for (long k = lane; k < states_.entries; k += lanes) states_.slope[k] = other_slope_[k];
  for (std::size_t k = lane; k < values_.size(); k += lanes) states_.switch_value[k] = values_[k];
}
