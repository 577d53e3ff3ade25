#include "response/slip_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

// Accelerations, in parts of the largest of a trial, up to which there is none, or two are one.
constexpr double NO_SLIP = 1e-9, SAME = 1e-7;

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

int trial_that_holds(const std::vector<SlipTrial>& trials, const std::vector<int>& open, int forced) {
  double scale = 0.0;
  std::vector<double> level(trials.empty() ? 0 : trials[0].sense.size(), 0.0);
  for (const SlipTrial& t : trials) {
    if (!t.decided && !goes_anyway(trials, t, open)) return -1;
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
        holds = holds && t.second[k] <= none && (t.loose[k] || t.holds[k]);
      is_loose = is_loose || (!t.sense[k] && t.loose[k]);
    }
    for (int other : good) holds = holds && !(is_loose && extends(trials[other], t));
    if (holds) good.push_back(number);
  }
  for (int number : good)
    if (!same_motion(trials[number], trials[good.back()], scale)) return -1;
  return good.empty() ? -1 : good.back();
}
