// A step of Radau IIA: its end, its error and its interpolation; radau_newton.cpp solves for its stages.
#include "integrator/radau.hpp"

#include <algorithm>
#include <cmath>

#include "integrator/radau_tableau.hpp"

using namespace radau;

namespace {

constexpr double SAFETY = 0.9, LEAST_FACTOR = 0.2, MOST_FACTOR = 8.0;
constexpr double LEAST_ERROR = 1e-10;

double fourth_root(double x) { return std::sqrt(std::sqrt(x)); }

}  // namespace

Radau::Radau(const LaneStates& s)
    : n_(s.freedoms), q_(s.quadratures), lanes_(s.lanes), entries_(s.entries), lane_(s.lanes), place_(entries_),
      at_(lanes_), probe_(entries_), scale_(entries_), switches_(s.kinds.size() * lanes_), shift_(lanes_) {
  for (int k = 0; k < 3; ++k) {
    increment_[k].assign(entries_, 0.0);
    slope_[k].assign(entries_, 0.0);
    for (Lane& l : lane_) {
      l.w[k].assign(2 * n_, 0.0);
      l.dw[k].assign(2 * n_, 0.0);
    }
  }
  for (Lane& l : lane_) l.jacobian.assign((std::size_t)(n_ + q_) * 2 * n_, 0.0);
}

void Radau::attempt(LaneStates& s, const Flags& asked) {
  Flags mask = asked;
  std::fill(s.switch_least.begin(), s.switch_least.end(), __builtin_inf());
  differentiate(s, &mask);
  factorise(s, &mask);
  iterate(s, &mask);
  if (any(mask)) end(s, &mask);
  if (any(mask)) estimate(s, mask);
}

// The third stage is the end of the step.
void Radau::end(LaneStates& s, Flags* mask) {
  for (long j = 0; j < entries_; ++j) s.y_end[j] = s.y[j] + increment_[2][j];
  for (int i = 0; i < lanes_; ++i)
    if ((*mask)[i]) s.reached[i] = 1.0;
  s.evaluate(s.until.data(), s.y_end.data(), true, mask, s.slope_end.data(), s.switch_end.data());
  for (std::size_t j = 0; j < switches_.size(); ++j)
    s.switch_least[j] = std::min(s.good(j, s.switch_inner[0][j]), s.good(j, s.switch_inner[1][j]));
}

// (m I - J)^-1 (slope + the increments' weighted sum / step), of all components. (IV.8.19)
void Radau::lane_error(const LaneStates& s, int i, const double* slope, std::vector<double>* error) const {
  const Lane& l = lane_[i];
  std::vector<double>& e = *error;
  e.resize(2 * n_ + q_);
  for (int c = 0; c < 2 * n_ + q_; ++c) {
    const long at = (long)c * lanes_ + i;
    const double sum = E[0] * increment_[0][at] + E[1] * increment_[1][at] + E[2] * increment_[2][at];
    e[c] = slope[at] + sum / s.step[i];
  }
  solve(l, e.data(), e.data() + n_);
  for (int j = 0; j < q_; ++j) {
    double sum = e[2 * n_ + j];
    for (int c = 0; c < 2 * n_; ++c) sum += l.jacobian[(std::size_t)(n_ + j) * 2 * n_ + c] * e[c];
    e[2 * n_ + j] = sum / l.real_shift;
  }
}

double Radau::size_of(const LaneStates& s, int i, const std::vector<double>& error) const {
  double largest = 0.0;
  for (int c = 0; c < 2 * n_ + s.quadratures; ++c) {
    const double part = error[c] == 0.0 ? 0.0 : std::fabs(error[c]) / scale_[(long)c * lanes_ + i];
    largest = part <= largest ? largest : part;
  }
  return largest;
}

// The step's error, and the next step by what this and the last one tell (IV.8.21, Gustafsson's predictive control).
void Radau::estimate(LaneStates& s, const Flags& mask) {
  s.error_scales(s.y.data(), s.y_end.data(), scale_.data());
  std::vector<std::vector<double>> error(lanes_);
  Flags again(lanes_, 0);
  place_ = s.y;
  for (int i = 0; i < lanes_; ++i) {
    if (!mask[i]) continue;
    lane_error(s, i, s.slope.data(), &error[i]);
    s.error[i] = size_of(s, i, error[i]);
    again[i] = !(s.error[i] <= 1.0) && (lane_[i].was_refused || lane_[i].step_before == 0.0);
    for (int c = 0; again[i] && c < s.size; ++c) place_[(long)c * lanes_ + i] += error[i][c];
  }
  // filtered once more where a stiff transient makes the first estimate far too large (IV.8.20)
  if (any(again)) s.evaluate(s.time.data(), place_.data(), false, &again, probe_.data(), switches_.data());
  for (int i = 0; i < lanes_; ++i) {
    if (!mask[i]) continue;
    s.fault[i] = 0;
    const Lane& l = lane_[i];
    if (again[i]) {
      lane_error(s, i, probe_.data(), &error[i]);
      s.error[i] = size_of(s, i, error[i]);
    }
    const double safety = SAFETY * (2.0 * ITERATIONS + 1.0) / (2.0 * ITERATIONS + l.iterations);
    double factor = 1.0 / fourth_root(std::max(s.error[i], LEAST_ERROR));
    if (s.error[i] <= 1.0 && l.step_before > 0.0) {
      const double trend = s.step[i] / l.step_before * fourth_root(l.error_before / std::max(s.error[i], LEAST_ERROR));
      factor *= std::min(1.0, trend);
    }
    s.factor[i] = std::max(LEAST_FACTOR, std::min(MOST_FACTOR, safety * factor));
    if (!(s.error[i] < __builtin_inf())) s.factor[i] = LEAST_FACTOR;
  }
}

void Radau::taken(LaneStates& s, int lane) {
  Lane& l = lane_[lane];
  l.has_jacobian = false;
  l.was_refused = false;
  l.error_before = std::max(s.error[lane], LEAST_ERROR);
  l.step_before = s.step[lane];
}

void Radau::refused(LaneStates&, int lane) { lane_[lane].was_refused = true; }

void Radau::dense(const LaneStates& s, const Flags&, const double* part, double* y) const {
  for (long at = 0; at < entries_; ++at) {
    const double x = part[at % lanes_];
    double sum = 0.0;
    for (int power = 2; power >= 0; --power)
      sum = (sum + (P[0][power] * increment_[0][at] + P[1][power] * increment_[1][at] + P[2][power] * increment_[2][at])) * x;
    y[at] = s.y[at] + sum;
  }
}
