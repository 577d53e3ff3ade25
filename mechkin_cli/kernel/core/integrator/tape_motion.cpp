#include "integrator/tape_motion.hpp"

#include <cmath>
#include <limits>
#include <utility>

TapeMotion::TapeMotion(const TapeStore& tape, Shape shape, const std::vector<double>& state,
                       std::vector<double> parameters, std::vector<double> scales, long rows)
    : tape_(tape), shape_(std::move(shape)), parameters_(std::move(parameters)), scales_(std::move(scales)),
      row_count_(rows), start_(state), now_(state) {}

Refusal TapeMotion::prepare() {
  const Tape& t = tape_.view();
  const std::size_t lanes = shape_.lanes, switches = shape_.switches.size();
  REQUIRE(shape_.lanes > 0 && shape_.freedoms >= 0 && shape_.quadratures >= 0, "no such motion");
  REQUIRE(start_.size() == size() * lanes, "one state for each lane");
  REQUIRE(parameters_.size() % lanes == 0, "parameters for each lane");
  REQUIRE(shape_.stops.size() == switches, "each switch stops or does not");
  REQUIRE(!scales_.empty(), "a chart has a scale");
  for (double s : scales_) REQUIRE(s > 0.0, "a chart's scale is positive");
  REQUIRE(t.inputs == 1 + size() + (int)switches + (int)(parameters_.size() / lanes) &&
              t.outputs == shape_.freedoms + shape_.quadratures + (int)switches + 1,
          "the tape is of another motion");
  origin_.assign(start_.begin(), start_.begin() + shape_.freedoms * lanes);
  for (int f = 0; f < shape_.freedoms; ++f)
    for (std::size_t i = 0; i < lanes; ++i) {
      start_[f * lanes + i] = 0.0;
      start_[(shape_.freedoms + f) * lanes + i] /= scales_[0];
    }
  scale_.assign(lanes, scales_[0]);
  accepted_.assign(lanes, 0);
  moved_.assign(switches * lanes, 0);
  inputs_.resize(t.inputs * lanes);
  outputs_.resize(t.outputs * lanes);
  verdict_.resize(lanes);
  memory_.resize(kernel_unit()->replay_size(t));
  rows_.assign(row_count_ * size() * lanes, std::numeric_limits<double>::quiet_NaN());
  return {};
}

double TapeMotion::state(int component, int lane, const double* y) const {
  const double value = y[component * shape_.lanes + lane];
  if (component < shape_.freedoms) return origin_[component * shape_.lanes + lane] + scale_[lane] * value;
  return component < 2 * shape_.freedoms ? scale_[lane] * value : value;
}

void TapeMotion::rates(const Places& p, const Rates& r) {
  const int lanes = shape_.lanes, switches = (int)shape_.switches.size(), q = shape_.quadratures, n = shape_.freedoms;
  const Tape& t = tape_.view();
  double* in = inputs_.data();
  for (int i = 0; i < lanes; ++i) *in++ = p.time[i];
  for (int k = 0; k < size(); ++k)
    for (int i = 0; i < lanes; ++i) *in++ = state(k, i, p.y);
  for (int k = 0; k < switches * lanes; ++k)
    *in++ = shape_.switches[k / lanes].moves ? (double)moved_[k] : (double)p.side[k];
  for (double x : parameters_) *in++ = x;
  kernel_unit()->replay(t, {(long)lanes, inputs_.data(), outputs_.data(), verdict_.data()}, memory_.data());
  for (int i = 0; i < lanes; ++i) {
    const double* const out = outputs_.data() + (long)i * t.outputs;
    for (int k = 0; k < n + q; ++k) r.rates[k * lanes + i] = k < n ? out[k] / scale_[i] : out[k];
    for (int s = 0; s < switches; ++s) r.switches[s * lanes + i] = out[n + q + s];
    const double fault = out[n + q + switches];
    r.fault[i] = fault > 0.0 && fault < OUT_OF_REACH ? (unsigned char)fault : 0;
    for (int f = 0; f < n; ++f)
      if (std::fabs(scale_[i] * p.y[f * lanes + i]) > shape_.reach) r.fault[i] = OUT_OF_REACH;
  }
}

void TapeMotion::accept(const unsigned char* mask, const double*, double* y, double* rates, double*) {
  const int lanes = shape_.lanes, n = shape_.freedoms;
  for (int i = 0; i < lanes; ++i) {
    if (!mask[i]) continue;
    const double scale = scales_[++accepted_[i] % scales_.size()];
    for (int f = 0; f < n; ++f) {
      origin_[f * lanes + i] = state(f, i, y);
      y[f * lanes + i] = 0.0;
      y[(n + f) * lanes + i] = scale_[i] * y[(n + f) * lanes + i] / scale;
      rates[f * lanes + i] = scale_[i] * rates[f * lanes + i] / scale;
    }
    scale_[i] = scale;
    for (int k = 0; k < size(); ++k) now_[k * lanes + i] = state(k, i, y);
  }
}

void TapeMotion::row(const unsigned char* mask, const long* row, const double*, const double* y, bool inside) {
  for (int i = 0; i < shape_.lanes; ++i) {
    if (!mask[i]) continue;
    inside_ += inside;
    for (int k = 0; k < size(); ++k) rows_[(row[i] * size() + k) * shape_.lanes + i] = state(k, i, y);
  }
}

bool TapeMotion::move(int lane, int which, double, double* y) {
  ++moved_[which * shape_.lanes + lane];
  for (int k = shape_.freedoms; k < 2 * shape_.freedoms; ++k) y[k * shape_.lanes + lane] *= shape_.bounce;
  return false;
}

bool TapeMotion::event(int lane, int which, bool rising, double time) {
  TapeEvent event{lane, which, rising, time, {}};
  for (int k = 0; k < size(); ++k) event.state.push_back(now_[k * shape_.lanes + lane]);
  events_.push_back(std::move(event));
  return shape_.stops[which];
}
