// What a motion under forces is measured by: its energies, its inertia, and how fast its rates grow.
#include <algorithm>
#include <cmath>

#include "response/charted_motion.hpp"

namespace {

constexpr double PART_OF_FORCE = 0.1;
// Forces of what sticks are told to 1e4 tolerances: they need be seen, their events are met exactly anyway.
constexpr double HELD = 1e4;

}  // namespace

// Works matter in parts of the energy that the motion has, or that its forces would give it over a tenth of a unit of its
// chart: what a damper within a rigid part takes is rounding.
void ChartedMotion::sizes(const unsigned char* lanes, double* size) {
  const int n = plan_.charts;
  for (int l = 0; l < lanes_; ++l) {
    if (!lanes[l]) continue;
    double energy = 0.0, coming = 0.0;
    for (int i = 0; i < n; ++i) {
      double rate = 0.0, force = 0.0;
      for (int j = 0; j < n; ++j) {
        const double m = at(end_.inertia, i * n + j, l);
        rate += m * at(end_.chart_rate, j, l), force += m * at(end_.chart_second, j, l);
      }
      energy += 0.5 * at(end_.chart_rate, i, l) * rate;
      coming += PART_OF_FORCE * std::fabs(force);
    }
    energy_[l] = std::max(energy_[l], energy);
    weigh(l);
    for (int k = 1; k <= works(); ++k) size[k * lanes_ + l] = std::max(size[k * lanes_ + l], energy + coming);
    if (plan_.frictions && at(end_.slip.level, 0, l) > 0.0) slips_.measured[l] = 1;
    const double duration = size[l] > 0.0 ? SLOWEST / size[l] : 0.0;
    if (plan_.frictions) slips_.duration[l] = duration;
    for (int k = 0; k < plan_.frictions; ++k) {
      const double held = HELD * duration * held_size(l, k);
      for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c)
        size[(1 + works() + c) * lanes_ + l] = std::max(size[(1 + works() + c) * lanes_ + l], held);
      double& limit = size[(1 + works() + slips_.columns + k) * lanes_ + l];
      limit = std::max(limit, held);
    }
  }
}

// The pivots of the inertia where a lane stands, and how fast its rates grow.
void ChartedMotion::weigh(int lane) {
  const int n = plan_.charts;
  std::vector<double> m((std::size_t)n * n);
  for (int k = 0; k < n * n; ++k) m[k] = at(end_.inertia, k, lane);
  lightest_[lane] = __builtin_inf();
  double rate = 0.0, second = 0.0;
  for (int i = 0; i < n; ++i) {
    rate = std::max(rate, std::fabs(at(end_.chart_rate, i, lane)));
    second = std::max(second, std::fabs(at(end_.chart_second, i, lane)));
  }
  growth_[lane] = rate > 0.0 ? second / rate : 0.0;
  for (int j = 0; j < n; ++j) {
    const double pivot = m[j * n + j];
    lightest_[lane] = std::min(lightest_[lane], pivot);
    // symmetric: the upper half alone
    for (int r = j + 1; r < n; ++r)
      for (int c = r; c < n; ++c) m[r * n + c] -= m[j * n + r] * m[j * n + c] / pivot;
  }
  if (lightest_start_[lane] == 0.0) lightest_start_[lane] = lightest_[lane];
}
