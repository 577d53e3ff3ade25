// What sticks in a motion: the forces that keep slips at zero, eliminated by Cholesky's factors (sliding.hpp).
#pragma once

#include "response/slips.hpp"

namespace {

// Parts of a pivot up to which what sticks depends on what sticks before it, and of forces up to which one has no part in
// such a dependence.
constexpr double DEPENDENT = 1e-12, NO_PART = 1e-7;

// Where column j sticks and depends on columns before it: whose forces are not unique, and what slips with loads that
// change with them, which has no answer.
inline Mask mark_loose(const Plan& p, const Slips& s, int j, Mask dependent, Pack* null, const SlipsGiven& given,
                       Pack* loose) {
  const int m = s.columns;
  for (int k = j - 1; k >= 0; --k) {
    Pack x = -s.factor[j * m + k];
    for (int i = k + 1; i < j; ++i) x -= s.factor[i * m + k] * null[i];
    null[k] = select(s.kept[k], x / s.factor[k * m + k], Pack(0.0));
  }
  null[j] = 1.0;
  const Pack own = s.inverse[j * m + j];
  Mask undecided = all_lanes(false);
  for (int f = 0; f < p.frictions; ++f) {
    Mask has = all_lanes(false);
    for (int c = s.first[f]; c < s.first[f + 1] && c <= j; ++c)
      has = has | (null[c] * null[c] * s.inverse[c * m + c] > Pack(NO_PART * NO_PART) * own);
    loose[f] = select(dependent & has, Pack(1.0), loose[f]);
    const Mask slips = dependent & ~(given.sense[f] == Pack(0.0));
    for (int e = p.friction[f].contact_begin; e < p.friction[f].contact_end; ++e) {
      Vec3 sum = zero3();
      Pack size = 0.0;
      for (int c = 0; c <= j; ++c) {
        sum += null[c] * s.load[e * m + c];
        size += abs(null[c]) * sum_of_components(s.load[e * m + c]);
      }
      undecided = undecided | (slips & (sum_of_components(sum) > Pack(NO_PART) * size));
    }
  }
  return undecided;
}

// Cholesky's factor of what sticks and is independent; lanes in which what slips is reached by forces that are not unique.
inline Mask factor_held(const Plan& p, const Slips& s, const SlipsGiven& given, Pack* loose) {
  const int m = s.columns, n = p.charts, d = directions(p);
  Mask undecided = all_lanes(false);
  Pack* const l = s.factor;
  for (int j = 0; j < m; ++j) {
    for (int k = 0; k <= j; ++k) {
      Pack sum = 0.0;
      for (int i = 0; i < n; ++i) sum -= s.along[j * d + i] * s.by[k * n + i];
      s.inverse[j * m + k] = s.inverse[k * m + j] = sum;
    }
    const Mask bears = s.sticks[j] & s.mobile[j];
    Pack pivot = s.inverse[j * m + j];
    for (int k = 0; k < j; ++k) {
      Pack x = s.inverse[j * m + k];
      for (int i = 0; i < k; ++i) x -= l[j * m + i] * l[k * m + i];
      l[j * m + k] = select(bears & s.kept[k], x / l[k * m + k], Pack(0.0));
      pivot -= l[j * m + k] * l[j * m + k];
    }
    const Mask free = pivot > Pack(DEPENDENT) * s.inverse[j * m + j];
    s.kept[j] = bears & free;
    l[j * m + j] = sqrt(select(s.kept[j], pivot, Pack(1.0)));
    const Mask dependent = bears & ~free;
    if (!any(dependent)) continue;
    undecided = undecided | mark_loose(p, s, j, dependent, s.force, given, loose);
    for (int k = 0; k < j; ++k) l[j * m + k] = select(s.kept[j], l[j * m + k], Pack(0.0));
  }
  return undecided;
}

// x := the forces that make a slip's derivative x vanish, of columns `stride` apart.
inline void solve_held(const Slips& s, Pack* x, int stride) {
  const int m = s.columns;
  for (int i = 0; i < m; ++i) {
    Pack sum = x[i * stride];
    for (int k = 0; k < i; ++k) sum -= s.factor[i * m + k] * x[k * stride];
    x[i * stride] = select(s.kept[i], sum / s.factor[i * m + i], Pack(0.0));
  }
  for (int i = m - 1; i >= 0; --i) {
    Pack sum = x[i * stride];
    for (int k = i + 1; k < m; ++k) sum -= s.factor[k * m + i] * x[k * stride];
    x[i * stride] = select(s.kept[i], sum / s.factor[i * m + i], Pack(0.0));
  }
}

// Loads of contacts and accelerations with the forces of what sticks, without friction and by a unit of each that slips.
inline void hold_slips(const Plan& p, const Slips& s, Rubbing& r) {
  const int m = s.columns, n = p.frictions;
  for (int c = 0; c < m; ++c) s.hold[c * (n + 1)] = s.start[c];
  solve_held(s, s.hold, n + 1);
  for (int e = 0; e < p.contacts; ++e) {
    r.base[e] = s.base[e];
    for (int c = 0; c < m; ++c) r.base[e] += s.hold[c * (n + 1)] * s.load[e * m + c];
  }
  for (int f = 0; f < n; ++f) {
    const int own = s.first[f];
    const Mask slips = ~s.sticks[own];
    Pack* const hold = s.hold + f + 1;
    for (int c = 0; c < m; ++c) hold[c * (n + 1)] = select(slips, -s.inverse[c * m + own], Pack(0.0));
    solve_held(s, hold, n + 1);
    for (int e = 0; e < p.contacts; ++e) {
      Vec3 load = select(slips, s.load[e * m + own], zero3());
      for (int c = 0; c < m; ++c) load += hold[c * (n + 1)] * s.load[e * m + c];
      r.gain[e * n + f] = load;
    }
  }
}

}  // namespace
