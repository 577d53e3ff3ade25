#include "integrator/dop853.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "integrator/cubic.hpp"
#include "integrator/dop853_tableau.hpp"

namespace {

using dop853::Sum;

template <int ROW>
struct Stage {
  static constexpr Sum sum = dop853::A[ROW];
};
template <int ROW>
struct Upper {
  static constexpr Sum sum = dop853::D[ROW];
};
struct Fifth {
  static constexpr Sum sum = dop853::E5;
};
struct Third {
  static constexpr Sum sum = dop853::B3;
};

// The weighted sum of slopes in entry i, from the first term to the last.
template <class Row, std::size_t... T>
inline double sum_at(const double* slopes, long entries, long i, std::index_sequence<T...>) {
  return (... + (Row::sum.term[T].factor * slopes[Row::sum.term[T].stage * entries + i]));
}
template <class Row>
inline double sum_at(const double* slopes, long entries, long i) {
  return sum_at<Row>(slopes, entries, i, std::make_index_sequence<Row::sum.count>());
}

template <int ROW>
void stage_place(const double* y, const double* step, const double* slopes, long entries, double* __restrict place) {
  for (long i = 0; i < entries; ++i) place[i] = y[i] + step[i] * sum_at<Stage<ROW>>(slopes, entries, i);
}
using StagePlace = void (*)(const double*, const double*, const double*, long, double*);
template <int... ROW>
constexpr void fill_stages(StagePlace* table, std::integer_sequence<int, ROW...>) {
  ((table[ROW] = &stage_place<ROW>), ...);
}
struct StagePlaces {
  StagePlace of[dop853::ALL_STAGES];
  StagePlaces() : of() { fill_stages(of, std::make_integer_sequence<int, dop853::ALL_STAGES>()); }
};
const StagePlaces PLACES;

template <class Row>
void weigh(const double* slopes, long entries, double* __restrict out) {
  for (long i = 0; i < entries; ++i) out[i] = sum_at<Row>(slopes, entries, i);
}

constexpr double SAFETY = 0.9, LEAST_FACTOR = 1.0 / 3.0, MOST_FACTOR = 6.0;
constexpr double LEAST_ROOT = 0.8659643233600653;  // of an error of 1e-4 before
constexpr double STABLE = 6.1;  // about the boundary of stability on the negative real axis
constexpr double NOISE = 1e-15;  // a distance of two places that rounding alone makes says nothing
constexpr int INNER_STAGE[2] = {5, 8};
// A step follows the values of switches: in parts of their range in it, how far they may be from the cubic through its ends
// and inner places; in parts of the duration, the longest step for which that does not matter.
constexpr double RESOLVED = 0.1, SHORT = 1e-5;

}  // namespace

Dop853::Dop853(const LaneStates& lanes)
    : slopes_(dop853::ALL_STAGES * lanes.entries), steps_(lanes.entries), place_(lanes.entries), last_(lanes.entries),
      stage_time_(lanes.lanes), mean_(lanes.entries), fifth_(lanes.entries), third_(lanes.entries),
      scale_(lanes.entries), worst_fifth_(lanes.lanes), worst_third_(lanes.lanes),
      switches_(lanes.kinds.size() * lanes.lanes), staged_(dop853::STAGES * switches_.size()), coefficients_(7 * lanes.entries),
      wanted_(lanes.lanes), root_(lanes.lanes), root_before_(lanes.lanes, LEAST_ROOT), was_refused_(lanes.lanes, 0), stiff_(lanes.lanes, 0),
      not_stiff_(lanes.lanes, 0) {}

void Dop853::attempt(LaneStates& s, const Flags& asked) {
  const long entries = s.entries;
  Flags mask = asked;
  for (long k = 0; k < entries; k += s.lanes) std::copy(s.step.begin(), s.step.end(), steps_.begin() + k);
  std::copy(s.slope.begin(), s.slope.end(), slopes_.begin());
  std::fill(s.switch_least.begin(), s.switch_least.end(), __builtin_inf());
  for (int stage = 1; stage <= dop853::STAGES; ++stage) {
    const bool is_end = stage == dop853::STAGES;
    double* const place = is_end ? s.y_end.data() : stage + 1 == dop853::STAGES ? last_.data() : place_.data();
    PLACES.of[stage](s.y.data(), steps_.data(), slopes_.data(), entries, place);
    for (int i = 0; i < s.lanes; ++i) {
      stage_time_[i] = is_end ? s.until[i] : s.time[i] + dop853::C[stage] * s.step[i];
      if (mask[i]) s.reached[i] = dop853::C[stage];
    }
    double* const switches = is_end ? s.switch_end.data() : switches_.data();
    const bool left =
        s.evaluate(stage_time_.data(), place, is_end, &mask, slopes_.data() + stage * entries, switches);
    if (!left) return;
    if (dop853::C[stage] < 1.0 && !s.kinds.empty()) note_switches(s, stage);
  }
  std::copy_n(slopes_.data() + dop853::STAGES * entries, entries, s.slope_end.data());
  estimate(s, mask);
  if (!s.kinds.empty()) resolve_switches(s, mask);
}

void Dop853::note_switches(LaneStates& s, int stage) {
  std::copy(switches_.begin(), switches_.end(), staged_.begin() + (long)(stage * switches_.size()));
  for (std::size_t k = 0; k < switches_.size(); ++k) {
    const double inward = s.good(k, switches_[k]);
    if (inward < s.switch_least[k]) s.switch_least[k] = inward;
  }
  for (int k = 0; k < 2; ++k)
    if (stage == INNER_STAGE[k]) {
      s.inner[k] = dop853::C[stage];
      s.switch_inner[k] = switches_;
    }
}

// A value that swings faster than the motion, which may pass its zero and come back between the places of a step, makes the
// step shorter: by the order of the cubic that it leaves.
void Dop853::resolve_switches(LaneStates& s, const Flags& mask) {
  if (s.settings.fixed_step > 0.0) return;
  for (int which = 0; which < (int)s.kinds.size(); ++which) {
    if (s.kinds[which].moves) continue;
    for (int i = 0; i < s.lanes; ++i) {
      if (!mask[i] || !(s.step[i] > SHORT * s.duration[i])) continue;
      const double part = unresolved(s, which, i);
      if (!(part > 0.0)) continue;
      const double factor = std::max(LEAST_FACTOR, SAFETY * std::sqrt(std::sqrt(RESOLVED / part)));
      s.factor[i] = std::min(s.factor[i], factor);
      if (part > RESOLVED) s.error[i] = std::max(s.error[i], part / RESOLVED);
    }
  }
}

// How far the values of a switch are from the cubic through the step's ends and inner places, in parts of their range; 0
// where that is too small for a zero between them.
double Dop853::unresolved(const LaneStates& s, int which, int lane) const {
  const std::size_t k = (std::size_t)which * s.lanes + lane;
  const double x[4] = {0.0, s.inner[0], s.inner[1], 1.0};
  const double y[4] = {s.switch_value[k], s.switch_inner[0][k], s.switch_inner[1][k], s.switch_end[k]};
  const Cubic cubic(x, y);
  double least = std::min({y[0], y[1], y[2], y[3]}), most = std::max({y[0], y[1], y[2], y[3]}), off = 0.0;
  for (int stage = 2; stage < dop853::STAGES - 1; ++stage) {
    const double value = staged_[(std::size_t)stage * switches_.size() + k];
    off = std::max(off, std::fabs(value - cubic(dop853::C[stage])));
    least = std::min(least, value), most = std::max(most, value);
  }
  const double range = most - least, nearest = std::min(std::fabs(least), std::fabs(most));
  const bool reaches = least * most <= 0.0 || nearest <= range;
  return reaches && range < __builtin_inf() && off > 0.0 ? off / range : 0.0;
}

// The error of the step by the estimates of orders 5 and 3 together, the largest of all components. (II.10.17)
void Dop853::estimate(LaneStates& s, const Flags& mask) {
  const long entries = s.entries;
  const double* const slopes = slopes_.data();
  weigh<Fifth>(slopes, entries, fifth_.data());
  weigh<Third>(slopes, entries, third_.data());
  weigh<Stage<dop853::STAGES>>(slopes, entries, mean_.data());
  s.error_scales(s.y.data(), s.y_end.data(), scale_.data());
  std::fill(worst_fifth_.begin(), worst_fifth_.end(), 0.0);
  std::fill(worst_third_.begin(), worst_third_.end(), 0.0);
  for (long k = 0; k < entries; k += s.lanes)
    for (int i = 0; i < s.lanes; ++i) {
      const double fifth = std::fabs(fifth_[k + i]), third = std::fabs(mean_[k + i] - third_[k + i]);
      const double of_fifth = fifth > 0.0 ? fifth / scale_[k + i] : 0.0;
      const double of_third = third > 0.0 ? third / scale_[k + i] : 0.0;
      worst_fifth_[i] = of_fifth > worst_fifth_[i] ? of_fifth : worst_fifth_[i];
      worst_third_[i] = of_third > worst_third_[i] ? of_third : worst_third_[i];
    }
  for (int i = 0; i < s.lanes; ++i) {
    const double a = worst_fifth_[i], ratio = a > 0.0 ? worst_third_[i] / a : 0.0;
    worst_fifth_[i] = s.step[i] * a / std::sqrt(1.0 + 0.01 * ratio * ratio);
  }
  control(s, mask);
}

// The step that the error wants next, by a proportional and integral controller: error^(-7/64) times the 64th root of the
// error before; after a refusal no longer one. Its powers are halves of halves, roots that IEEE rounds.
void Dop853::control(LaneStates& s, const Flags& mask) {
  const double* const error = worst_fifth_.data();
  double* const eighth = worst_third_.data();
  for (int i = 0; i < s.lanes; ++i) eighth[i] = std::sqrt(std::sqrt(std::sqrt(error[i])));
  for (int i = 0; i < s.lanes; ++i) {
    const double r16 = std::sqrt(eighth[i]), r32 = std::sqrt(r16), r64 = std::sqrt(r32);
    wanted_[i] = SAFETY * root_before_[i] / (r16 * r32 * r64);
    root_[i] = r64 > LEAST_ROOT ? r64 : LEAST_ROOT;
  }
  for (int i = 0; i < s.lanes; ++i) {
    if (!mask[i]) continue;
    s.error[i] = error[i];
    const bool is_good = error[i] <= 1.0;
    const double most = is_good && !was_refused_[i] ? MOST_FACTOR : 1.0;
    const double wanted = is_good ? wanted_[i] : SAFETY / eighth[i];
    s.factor[i] = wanted < most ? std::max(LEAST_FACTOR, wanted) : most;
    // an error that is no number
    if (!(error[i] < __builtin_inf())) s.factor[i] = LEAST_FACTOR;
  }
}

void Dop853::refused(LaneStates&, int lane) { was_refused_[lane] = 1; }

void Dop853::taken(LaneStates& s, int lane) {
  root_before_[lane] = root_[lane];
  was_refused_[lane] = 0;
  if (stability(s, lane) > STABLE) {
    not_stiff_[lane] = 0;
    ++stiff_[lane];
  } else if (++not_stiff_[lane] >= 6) {
    stiff_[lane] = 0;
  }
}

// Step times |f(end) - f(last stage)| / |end - last stage|, both at the step's end: a bound of the largest eigenvalue that
// counts (Hairer and Wanner II, IV.2, 2.23). Rates in parts of the largest.
double Dop853::stability(const LaneStates& s, int lane) const {
  const double* const f = slopes_.data() + dop853::STAGES * s.entries;
  const double* const g = slopes_.data() + (dop853::STAGES - 1) * s.entries;
  const double speed = s.speed[lane];
  double slopes = 0.0, places = 0.0;
  for (int k = 0; k < 2 * s.freedoms; ++k) {
    const long at = (long)k * s.lanes + lane;
    const double part = k < s.freedoms ? 1.0 : speed;
    const double a = (f[at] - g[at]) / part, b = (s.y_end[at] - last_[at]) / part;
    slopes += a * a;
    places += b * b;
  }
  return places > NOISE * NOISE ? s.step[lane] * std::sqrt(slopes / places) : 0.0;
}

void Dop853::prepare_dense(LaneStates& s, Flags* mask) {
  const long entries = s.entries;
  for (int stage = dop853::STAGES + 1; stage < dop853::ALL_STAGES; ++stage) {
    PLACES.of[stage](s.y.data(), steps_.data(), slopes_.data(), entries, place_.data());
    for (int i = 0; i < s.lanes; ++i) {
      stage_time_[i] = s.time[i] + dop853::C[stage] * s.step[i];
      if ((*mask)[i]) s.reached[i] = dop853::C[stage];
    }
    if (!s.evaluate(stage_time_.data(), place_.data(), false, mask, slopes_.data() + stage * entries,
                    switches_.data()))
      return;
  }
  double* const c = coefficients_.data();
  const double* const slopes = slopes_.data();
  weigh<Upper<0>>(slopes, entries, c + 3 * entries);
  weigh<Upper<1>>(slopes, entries, c + 4 * entries);
  weigh<Upper<2>>(slopes, entries, c + 5 * entries);
  weigh<Upper<3>>(slopes, entries, c + 6 * entries);
  for (long i = 0; i < entries; ++i) {
    const double change = s.y_end[i] - s.y[i], h = steps_[i];
    const double first = h * slopes[i] - change;
    c[i] = change;
    c[entries + i] = first;
    c[2 * entries + i] = change - h * slopes[dop853::STAGES * entries + i] - first;
    for (int k = 3; k < 7; ++k) c[k * entries + i] *= h;
  }
}

void Dop853::dense(const LaneStates& s, const Flags&, const double* part, double* y) const {
  const long entries = s.entries;
  const double* const c = coefficients_.data();
  for (long k = 0; k < entries; k += s.lanes)
    for (int i = 0; i < s.lanes; ++i) {
      const double x = part[i], rest = 1.0 - x;
      double sum = c[6 * entries + k + i] * x;
      for (int power = 5; power >= 0; --power) sum = (sum + c[power * entries + k + i]) * (power % 2 ? rest : x);
      y[k + i] = s.y[k + i] + sum;
    }
}
