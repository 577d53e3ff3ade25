// The start of a march: sides, sizes and first steps.
#include <algorithm>
#include <cmath>

#include "integrator/march.hpp"

namespace {

constexpr int BEGINNINGS = 4;  // how often sides and what the motion decides by them may change each other

double eighth_root(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

}  // namespace

void March::start(const double* time, const std::vector<double>& y) {
  const int lanes = states_.lanes;
  std::copy_n(time, lanes, states_.time.begin());
  states_.y = y;
  Flags mask(lanes, 1);
  for (int i = 0; i < lanes; ++i) {
    states_.duration[i] = rows_.count ? row_time(i, rows_.count - 1) - time[i] : 0.0;
    states_.speed[i] = states_.speed_in(y.data(), i);
  }
  states_.evaluate(time, y.data(), true, &mask, states_.slope.data(), states_.switch_value.data());
  size_up(mask);
  first_sides(&mask);
  for (int i = 0; i < lanes; ++i)
    if (!mask[i]) finish(i, LaneEnd::STUCK);
  for (int i = 0; i < lanes; ++i) mask[i] = control_[i].running;
  rows_here(mask);
  for (int i = 0; i < lanes; ++i) {
    const int event = mask[i] ? states_.motion.event_at_start(i) : -1;
    if (event >= 0) finish(i, LaneEnd::STOPPED, event);
    if (mask[i] && control_[i].running && !has_row(control_[i])) finish(i, LaneEnd::DONE);
    mask[i] = control_[i].running;
  }
  if (any(mask) && states_.settings.fixed_step == 0.0) first_steps(mask);
}

// A switch begins on the side that its value tells, or that it has a moment later where it is zero; one that moves on its
// good side, and is met at once where that is not so. Rates that were
// taken on another side are taken anew; lanes that had a fault on that side alone come into the mask.
void March::first_sides(Flags* mask) {
  const int lanes = states_.lanes;
  if (states_.kinds.empty()) return;
  for (std::size_t k = 0; k < states_.side.size(); ++k)
    states_.side[k] = states_.switch_value[k] < 0.0 && !states_.kinds[k / lanes].moves ? -1 : 1;
  Flags open(lanes, 1);
  for (int k = 0; k < BEGINNINGS && any(open); ++k) {
    settle_sides(open, std::vector<int>(lanes, -1), true);
    states_.motion.begin(states_.side.data(), open.data());
  }
  Flags stands(lanes, 1);
  states_.evaluate(states_.time.data(), states_.y.data(), true, &stands, states_.slope.data(),
                   states_.switch_value.data());
  Flags recovered(lanes, 0);
  for (int i = 0; i < lanes; ++i) recovered[i] = stands[i] && !(*mask)[i];
  *mask = stands;
  if (any(recovered)) size_up(recovered);
}

void March::size_up(const Flags& mask) {
  const int lanes = states_.lanes;
  for (int i = 0; i < lanes; ++i) size_[i] = states_.duration[i] > 0.0 ? SLOWEST / states_.duration[i] : 0.0;
  std::fill(size_.begin() + lanes, size_.end(), 0.0);
  states_.motion.sizes(mask.data(), size_.data());
  for (int i = 0; i < lanes; ++i) {
    if (!mask[i]) continue;
    states_.speed[i] = std::max(states_.speed[i], size_[i]);
    for (long k = i; k < (long)states_.work.size(); k += lanes)
      states_.work[k] = std::max(states_.work[k], size_[lanes + k]);
  }
}

// Hairer's first step (Hairer, Norsett, Wanner I, II.4, p. 169) from y and its first two derivatives, the second one by a
// step of a hundredth of the time in which the motion goes 1 (rad, part of the size) at its rate or from rest.
void March::first_steps(const Flags& mask) {
  const int lanes = states_.lanes;
  const long moved = (long)states_.freedoms * lanes, moving = 2 * moved;
  std::vector<double> scale(states_.entries), slope(states_.entries), first(lanes, 0.0), second(lanes, 0.0);
  for (int i = 0; i < lanes; ++i) {
    const double rate = states_.speed_in(states_.y.data(), i), bend = states_.speed_in(states_.slope.data(), i);
    const double quickest = std::max(1.0 / states_.duration[i], std::max(rate, std::sqrt(bend)));
    part_[i] = 0.01 / quickest;
    at_[i] = states_.time[i] + part_[i];
  }
  for (long k = 0; k < states_.entries; ++k) place_[k] = states_.y[k] + part_[k % lanes] * states_.slope[k];
  Flags ahead = mask;
  states_.evaluate(at_.data(), place_.data(), false, &ahead, slope.data(), values_.data());
  // rates that begin at zero count against what they come to
  states_.error_scales(states_.y.data(), place_.data(), scale.data());
  const auto part = [&](double x, long k) { return x == 0.0 ? 0.0 : std::fabs(x) / scale[k]; };
  for (long k = 0; k < moving; ++k) {
    first[k % lanes] = std::max(first[k % lanes], part(states_.slope[k], k));
    second[k % lanes] = std::max(second[k % lanes], part(slope[k] - states_.slope[k], k));
  }
  for (int i = 0; i < lanes; ++i) {
    if (!mask[i]) continue;
    const double most = ahead[i] ? std::max(first[i], second[i] / part_[i]) : first[i];
    const double told = most > 1e-15 ? eighth_root(0.01 / most) : states_.duration[i];
    control_[i].wanted = std::min({100.0 * part_[i], told, states_.duration[i]});
    control_[i].longest = states_.motion.longest();
    states_.fault[i] = 0;
  }
}
