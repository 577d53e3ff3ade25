#include "response/slip_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

// Accelerations, in parts of the largest of a trial, up to which there is none, or two are one.
constexpr double NO_SLIP = 1e-9, SAME = 1e-7;
// Boxes of friction forces that are looked at; what of a load is rounding.
constexpr int MOST_BOXES = 1000;
constexpr double LOAD_ROUNDING = 1e-12;

// Friction forces: from low to high.
struct Box {
  std::vector<double> low, high;
  bool is_bounded() const {
    for (double x : high)
      if (!(x < __builtin_inf())) return false;
    return true;
  }
};

// What of a box lets each that starts go its way; false where nothing is left.
bool cut_by_seconds(const SlipSystem& s, Box* box) {
  const std::size_t n = s.coefficient.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (!s.starts[k]) continue;
    const double* const by = &s.second[k * (n + 1)];
    double most = by[0];
    for (std::size_t j = 0; j < n; ++j)
      if (by[j + 1] != 0.0) most += by[j + 1] * (by[j + 1] > 0.0 ? box->high[j] : box->low[j]);
    if (most <= 0.0) return false;
    for (std::size_t j = 0; j < n; ++j)
      if (by[j + 1] < 0.0) box->high[j] = std::min(box->high[j], box->low[j] - most / by[j + 1]);
  }
  return true;
}

// What of a box may solve z = mu N(z): N, which is convex, lies above its tangent planes; false where nothing is left.
bool cut_by_loads(const SlipSystem& s, Box* box) {
  const std::size_t n = s.coefficient.size();
  std::vector<double> middle(n), radius(n), slope(n), steepest(n), at(3);
  for (std::size_t k = 0; k < n; ++k) {
    if (s.coefficient[k] == 0.0) continue;
    double normal = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      middle[j] = 0.5 * (box->low[j] + box->high[j]), radius[j] = 0.5 * (box->high[j] - box->low[j]);
      slope[j] = steepest[j] = 0.0;
    }
    for (const SlipSystem::Contact& c : s.contacts) {
      if (c.friction != (int)k) continue;
      const auto length = [](const double* a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); };
      for (int i = 0; i < 3; ++i) {
        at[i] = c.load[i];
        for (std::size_t j = 0; j < n; ++j) at[i] += middle[j] * c.load[3 * (j + 1) + i];
      }
      const double size = length(at.data());
      normal += c.weight * size;
      for (std::size_t j = 0; j < n; ++j) {
        const double* const unit = &c.load[3 * (j + 1)];
        if (size > 0.0) slope[j] += c.weight * (at[0] * unit[0] + at[1] * unit[1] + at[2] * unit[2]) / size;
        steepest[j] += c.weight * length(unit);
      }
    }
    const double mu = s.coefficient[k], scale = mu * normal + middle[k];
    double most = normal, least = normal, above = mu * normal - middle[k];
    for (std::size_t j = 0; j < n; ++j) {
      most += steepest[j] * radius[j], least -= std::fabs(slope[j]) * radius[j];
      above -= std::fabs(mu * slope[j] - (j == k)) * radius[j];
    }
    if (above > LOAD_ROUNDING * scale) return false;
    box->low[k] = std::max(box->low[k], mu * least - LOAD_ROUNDING * scale);
    box->high[k] = std::min(box->high[k], mu * most + LOAD_ROUNDING * scale);
    if (box->low[k] > box->high[k]) return false;
  }
  return true;
}

int movers(const SlipTrial& t) {
  int count = 0;
  for (signed char s : t.sense) count += s != 0;
  return count;
}

// Whether b moves as a does, and more of what is loose in a.
bool extends(const SlipTrial& b, const SlipTrial& a) {
  bool more = false;
  for (std::size_t k = 0; k < a.sense.size(); ++k) {
    if (a.sense[k] == b.sense[k]) continue;
    if (a.sense[k] != 0) return false;
    more = more || a.loose[k];
  }
  return more;
}

bool same_motion(const SlipTrial& a, const SlipTrial& b, double scale) {
  for (std::size_t i = 0; i < a.motion.size(); ++i)
    if (!(std::fabs(a.motion[i] - b.motion[i]) <= SAME * scale)) return false;
  return true;
}

const SlipTrial* with_sense(const std::vector<SlipTrial>& trials, const SlipTrial& t, int k, signed char sense) {
  Signs way = t.way;
  way[k] = sense;
  for (const SlipTrial& other : trials)
    if (other.way == way) return other.decided ? &other : nullptr;
  return nullptr;
}

// Whether a joint that sticks in a trial goes the same way whether its friction pushes it forth or back: then it does with
// all that lies between, and does not stick.
bool goes_anyway(const std::vector<SlipTrial>& trials, const SlipTrial& t, const std::vector<int>& open) {
  for (int k : open) {
    if (t.sense[k] != 0) continue;
    const SlipTrial *const forth = with_sense(trials, t, k, 1), *const back = with_sense(trials, t, k, -1);
    if (!forth || !back) continue;
    const double a = forth->second[k], b = back->second[k];
    if ((a > forth->rounding[k] && b < -back->rounding[k]) || (a < -forth->rounding[k] && b > back->rounding[k])) return true;
  }
  return false;
}

}  // namespace

bool has_no_slip(const SlipSystem& s) {
  Box all;
  for (double mu : s.coefficient) all.low.push_back(0.0), all.high.push_back(mu > 0.0 ? __builtin_inf() : 0.0);
  std::vector<Box> boxes = {all};
  for (int k = 0; k < MOST_BOXES && !boxes.empty(); ++k) {
    Box box = boxes.back();
    boxes.pop_back();
    if (!cut_by_seconds(s, &box)) continue;
    if (s.is_open || !box.is_bounded()) return false;
    if (!cut_by_loads(s, &box)) continue;
    if (k == 0) all = box;
    std::size_t widest = 0;
    double part = 0.0;
    for (std::size_t j = 0; j < box.low.size(); ++j) {
      const double whole = all.high[j] - all.low[j], own = whole > 0.0 ? (box.high[j] - box.low[j]) / whole : 0.0;
      if (own > part) part = own, widest = j;
    }
    if (!(part > LOAD_ROUNDING)) return false;
    Box half = box;
    box.high[widest] = half.low[widest] = 0.5 * (box.low[widest] + box.high[widest]);
    boxes.push_back(box), boxes.push_back(half);
  }
  return boxes.empty();
}

int trial_that_holds(const std::vector<SlipTrial>& trials, const std::vector<int>& open, int forced) {
  double scale = 0.0;
  std::vector<double> level(trials.empty() ? 0 : trials[0].sense.size(), 0.0);
  for (const SlipTrial& t : trials) {
    if (!t.decided) continue;
    for (double x : t.motion) scale = std::max(scale, std::fabs(x));
    for (std::size_t k = 0; k < level.size(); ++k) level[k] = std::max(level[k], std::fabs(t.second[k]));
  }
  std::vector<int> order(trials.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return movers(trials[a]) > movers(trials[b]); });
  std::vector<int> good;
  for (int number : order) {
    const SlipTrial& t = trials[number];
    if (!t.decided) continue;
    bool holds = true, is_loose = false;
    for (int k : open) {
      const double none = std::max(NO_SLIP * level[k], t.rounding[k]);
      if (k == forced) continue;
      if (t.sense[k])
        holds = holds && t.second[k] > none;
      else
        // what is lost to rest is none that would go: friction at most halves it
        holds = holds && t.second[k] <= none && (t.loose[k] || t.holds[k] || t.excess[k] <= 2.0 * none);
      is_loose = is_loose || (!t.sense[k] && t.loose[k]);
    }
    for (int other : good) holds = holds && !(is_loose && extends(trials[other], t));
    if (holds) good.push_back(number);
  }
  for (const SlipTrial& t : trials) {
    if (t.decided || t.is_ruled_out || goes_anyway(trials, t, open)) continue;
    bool is_left = false;
    for (int other : good) is_left = is_left || extends(trials[other], t);
    if (!is_left) return -1;
  }
  for (int number : good)
    if (!same_motion(trials[number], trials[good.back()], scale)) return -1;
  return good.empty() ? -1 : good.back();
}
