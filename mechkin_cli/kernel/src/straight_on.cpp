// Whether a motion goes straight through a branch point that its steps shrink towards.
//
// Where two branches cross, the one that the motion is on is smooth: quintic interpolation between a place before the
// crossing and one behind it closes the loops to rounding all along. Where they only come near each other, F = x y = e^2
// with a gap of e, the way straight over the gap misses closure by e^2 between its ends, and the motion turns off.
#include <cmath>

#include "charted_motion.hpp"
#include "units.hpp"

namespace {

constexpr double FAR_SIDE = 16.0;     // a place so many times as far as stages may stand is behind the crossing
constexpr int PLACES = 8;             // where closure is tested, between both
constexpr double STRAIGHT = 1e-12;    // of closure there: gaps of 1e-6 are seen; interpolation leaves 1e-13

// 1/2 (0, w) q.
void half_turned(const double* w, const double* q, double* found) {
  found[0] = -0.5 * (w[0] * q[1] + w[1] * q[2] + w[2] * q[3]);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    found[i + 1] = 0.5 * (w[i] * q[0] + w[j] * q[k + 1] - w[k] * q[j + 1]);
  }
}

// q' = 1/2 (0, w) q, q'' = 1/2 (0, w') q - 1/4 |w|^2 q.
void differentiate(const double* q, const double* w, const double* w_rate, double* first, double* second) {
  const double square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
  half_turned(w, q, first);
  half_turned(w_rate, q, second);
  for (int i = 0; i < 4; ++i) second[i] -= 0.25 * square * q[i];
}

}  // namespace

AtPlace ChartedMotion::pass_over(int lane, double reach) {
  over_[lane] = 0.0;
  // driven coordinates would have to go on in time, too
  if (plan_.inputs || reach == 0.0) return AtPlace::GOES_ON;
  const Packed origin = origin_, elapsed = elapsed_, miss_elapsed = miss_elapsed_;
  over_[lane] = 1.0;
  const bool is_crossing = goes_straight(lane, FAR_SIDE * reach);
  origin_ = origin, elapsed_ = elapsed, miss_elapsed_ = miss_elapsed;
  if (!is_crossing || !limits_.straight) over_[lane] = 0.0;
  if (!is_crossing) return AtPlace::GOES_ON;
  return limits_.straight ? AtPlace::PASSES : AtPlace::ENDS;
}

// The other lanes stand at their origins.
bool ChartedMotion::goes_straight(int lane, double time) {
  const int n = plan_.charts;
  Packed place((std::size_t)(n * lanes_), 0.0), rate = place;
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < plan_.columns; ++c)
      rate[i * lanes_ + lane] += at(direction_, i * plan_.columns + c, lane) * at(origin_first_, c, lane);
  elapsed_.assign(elapsed_.size(), 0.0), miss_elapsed_.assign(miss_elapsed_.size(), 0.0);
  evaluate(place.data(), rate.data(), &found_);
  if (found_.flags[lane]) return false;
  const NodeStates near = differentiated(found_, lane);
  elapsed_[lane] = time;
  for (int i = 0; i < n; ++i) place[i * lanes_ + lane] = time * rate[i * lanes_ + lane];
  evaluate(place.data(), rate.data(), &found_);
  if (found_.flags[lane]) return false;
  const NodeStates far = differentiated(found_, lane);

  elapsed_[lane] = 0.0;
  place.assign(place.size(), 0.0);
  MotionLimits only_tested = limits_;
  only_tested.iterations = 0, only_tested.accept = STRAIGHT;
  for (int k = 1; k < PLACES; ++k) {
    // quintic Hermite interpolation
    const double x = (double)k / PLACES, y = 1.0 - x, x3 = x * x * x, y3 = y * y * y;
    const double value0 = y3 * (1.0 + 3.0 * x + 6.0 * x * x), value1 = x3 * (1.0 + 3.0 * y + 6.0 * y * y);
    const double first0 = time * y3 * x * (1.0 + 3.0 * x), first1 = -time * x3 * y * (1.0 + 3.0 * y);
    const double second0 = 0.5 * time * time * y3 * x * x, second1 = 0.5 * time * time * x3 * y * y;
    for (int s = 0; s < plan_.states; ++s)
      origin_[(long)s * lanes_ + lane] = value0 * near.state[s] + value1 * far.state[s] + first0 * near.first[s] +
                                         first1 * far.first[s] + second0 * near.second[s] + second1 * far.second[s];
    evaluate(place.data(), rate.data(), only_tested, &found_);
    if (found_.flags[lane] & STAGE_NOT_CLOSED) return false;
  }
  return true;
}

ChartedMotion::NodeStates ChartedMotion::differentiated(const Stage& stage, int lane) const {
  const int columns = plan_.columns;
  std::vector<double> first(columns), second(columns);
  for (int c = 0; c < columns; ++c) {
    first[c] = at(stage.first, c, lane), second[c] = at(stage.second, c, lane);
    // without what the forces make of it
    for (int i = 0; i < plan_.charts; ++i)
      second[c] -= at(stage.tangent, i * columns + c, lane) * at(stage.chart_second, i, lane);
  }
  NodeStates found = {std::vector<double>(plan_.states), std::vector<double>(plan_.states, 0.0),
                      std::vector<double>(plan_.states, 0.0)};
  for (int s = 0; s < plan_.states; ++s) found.state[s] = at(stage.state, s, lane);
  for (int k = 0; k < plan_.links; ++k) {
    const TreeJoint& j = plan_.joints[k];
    if (j.type == TREE_S) {
      differentiate(&found.state[j.state], &first[j.column], &second[j.column], &found.first[j.state],
                    &found.second[j.state]);
      continue;
    }
    for (int f = 0; f < kernel_unit(2)->tree_types[j.type].freedoms; ++f) {
      found.first[j.state + f] = first[j.column + f];
      found.second[j.state + f] = second[j.column + f];
    }
  }
  return found;
}
