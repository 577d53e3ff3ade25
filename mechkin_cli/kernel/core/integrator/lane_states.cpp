#include "integrator/lane_states.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

bool any(const Flags& flags) {
  for (unsigned char f : flags)
    if (f) return true;
  return false;
}

LaneStates::LaneStates(Motion& m, const IntegratorSettings& s)
    : motion(m), settings(s), lanes(m.lanes()), freedoms(m.freedoms()), quadratures(m.quadratures()),
      size(2 * freedoms + quadratures), kinds(m.switches()), entries((long)size * lanes) {
  const std::size_t switches = kinds.size() * lanes;
  for (auto* a : {&time, &duration, &speed, &step, &until, &error, &factor, &reached}) a->assign(lanes, 0.0);
  for (auto* a : {&y, &slope, &y_end, &slope_end}) a->assign(entries, 0.0);
  for (auto* a : {&switch_value, &switch_end, &switch_inner[0], &switch_inner[1], &switch_least})
    a->assign(switches, 0.0);
  for (const SwitchKind& kind : kinds) side.insert(side.end(), lanes, kind.first);
  work.assign((std::size_t)quadratures * lanes, 0.0);
  evaluations.assign(lanes, 0);
  fault.assign(lanes, 0);
  fresh_fault_.assign(lanes, 0);
  finite_.assign(lanes, 0.0);
  report.resize(lanes);
}

bool LaneStates::evaluate(const double* at, const double* place, bool is_end, Flags* mask, double* slope_there,
                          double* switches) {
  const long moved = (long)freedoms * lanes, rest = entries - moved;
  double* const rates = slope_there + moved;
  std::memset(fresh_fault_.data(), 0, lanes);
  motion.rates({at, place, mask->data(), side.data(), is_end}, {rates, switches, fresh_fault_.data()});
  std::memcpy(slope_there, place + moved, sizeof(double) * moved);
  // 0 x is 0 unless x is infinite or no number
  std::fill(finite_.begin(), finite_.end(), 0.0);
  for (long k = 0; k < rest; k += lanes)
    for (int i = 0; i < lanes; ++i) finite_[i] += 0.0 * rates[k + i];
  int bad = 0;
  for (int i = 0; i < lanes; ++i) {
    evaluations[i] += (*mask)[i];
    bad |= (int)fresh_fault_[i] | (int)(finite_[i] != 0.0);
  }
  return !bad || drop_faults(mask);
}

// Takes the lanes with a fault out of the mask.
bool LaneStates::drop_faults(Flags* mask) {
  bool left = false;
  for (int i = 0; i < lanes; ++i) {
    if (!(*mask)[i]) continue;
    if (!fresh_fault_[i] && !(finite_[i] == 0.0)) fresh_fault_[i] = NOT_FINITE;
    if (fresh_fault_[i]) {
      fault[i] = fresh_fault_[i];
      (*mask)[i] = 0;
    } else {
      left = true;
    }
  }
  return left;
}

double LaneStates::time_rounding(int lane) const {
  return 4.0 * 2.220446049250313e-16 * std::max(std::fabs(until[lane]), step[lane]);
}

double LaneStates::speed_in(const double* place, int lane) const {
  double largest = 0.0;
  for (int k = freedoms; k < 2 * freedoms; ++k) largest = std::max(largest, std::fabs(place[(long)k * lanes + lane]));
  return largest;
}

void LaneStates::error_scales(const double* a, const double* b, double* scale) const {
  const double tolerance = settings.tolerance;
  const long moved = (long)freedoms * lanes;
  std::fill_n(scale, moved, tolerance);
  double* const of_v = scale + moved;
  std::copy(speed.begin(), speed.end(), of_v);
  for (long k = moved; k < 2 * moved; k += lanes)
    for (int i = 0; i < lanes; ++i) {
      const double larger = std::fabs(a[k + i]) > std::fabs(b[k + i]) ? std::fabs(a[k + i]) : std::fabs(b[k + i]);
      of_v[i] = larger > of_v[i] ? larger : of_v[i];
    }
  for (int i = 0; i < lanes && freedoms; ++i) of_v[i] *= tolerance;
  for (int f = 1; f < freedoms; ++f) std::copy_n(of_v, lanes, of_v + (long)f * lanes);
  // what begins at zero with a power of time has no size of its own yet: part of what its rate makes of the duration
  for (long k = 2 * moved; k < entries; ++k) {
    const double larger = std::fabs(a[k]) > std::fabs(b[k]) ? std::fabs(a[k]) : std::fabs(b[k]);
    const double first = std::fabs(slope[k]), second = std::fabs(slope_end[k]);
    const double coming = SLOWEST * duration[k % lanes] * (first > second ? first : second);
    const double known = work[k - 2 * moved] > coming ? work[k - 2 * moved] : coming;
    scale[k] = tolerance * (larger > known ? larger : known);
  }
  // where nothing is free no energy tells the size of works: by the largest of them what is lost where nothing moves is
  // rounding
  for (int i = 0; i < lanes && !freedoms; ++i) {
    double most = 0.0;
    for (int k = 0; k < motion.works(); ++k) most = std::max(most, scale[(long)k * lanes + i]);
    for (int k = 0; k < motion.works(); ++k) scale[(long)k * lanes + i] = most;
  }
}
