#include "rows/balance.hpp"

#include "stepping/stepper.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace {

// The solution of a system (n x n, and a right side, row-major), by elimination with rows scaled before they are ranked;
// the determinant, zero where it is singular or no number.
double eliminate(std::vector<double>& a, double* x, int n) {
  const int width = n + 1;
  double determinant = 1.0;
  for (int i = 0; i < n; ++i) {
    double most = 0.0;
    for (int j = 0; j < n; ++j) most = std::fmax(most, std::fabs(a[i * width + j]));
    if (!(most > 0.0)) return 0.0;
    for (int j = 0; j < width; ++j) a[i * width + j] /= most;
    determinant *= most;
  }
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(a[i * width + k]) > std::fabs(a[best * width + k])) best = i;
    if (!(std::fabs(a[best * width + k]) > 0.0)) return 0.0;
    if (best != k) {
      for (int j = 0; j < width; ++j) std::swap(a[k * width + j], a[best * width + j]);
      determinant = -determinant;
    }
    determinant *= a[k * width + k];
    for (int i = k + 1; i < n; ++i) {
      const double factor = a[i * width + k] / a[k * width + k];
      for (int j = k; j < width; ++j) a[i * width + j] -= factor * a[k * width + j];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    double rest = a[k * width + n];
    for (int j = k + 1; j < n; ++j) rest -= a[k * width + j] * x[j];
    x[k] = rest / a[k * width + k];
  }
  return determinant;
}

// The efforts along what nothing drives, at places and beside them.
class Efforts {
 public:
  Efforts(const Plan& plan, const Request& like, const KernelUnit& unit, int threads, const BalanceRequest& wanted)
      : plan_(plan), like_(like), unit_(unit), threads_(threads), wanted_(wanted),
        kinds_(wanted.is_stiffness_given ? 1 : 1 + 2 * wanted.free_count) {
    const long rows = wanted.places * kinds_;
    const long numbers = 4l * plan.inputs + 2l * plan.states + like.wanted.slots + plan.input_constraints + turned() + 3;
    numbers_.resize((std::size_t)(numbers * rows));
    flags_.resize((std::size_t)(2 * rows));
  }

  // At the first `count` places; kind 0 stands at them, 1 + 2k and 2 + 2k to either side along the k-th free input.
  void measure(long count) {
    count_ = count;
    const long rows = count * kinds_;
    double* next = numbers_.data();
    const auto take = [&next, rows](int numbers) {
      double* const array = next;
      next += numbers * rows;
      return array;
    };
    double *const reduced = take(plan_.inputs), *const whole = take(plan_.inputs), *const full = take(plan_.inputs);
    double *const still = take(plan_.inputs), *const guess = take(plan_.states), *const tied = take(plan_.input_constraints);
    double *const turns = take(turned()), *const time = take(1);
    for (long i = 0; i < plan_.inputs * rows; ++i) still[i] = 0.0;
    repeat(wanted_.inputs, plan_.inputs, full);
    for (int k = 0; k < wanted_.free_count && kinds_ > 1; ++k) {
      double* const moved = full + wanted_.free[k].input * rows;
      for (long p = 0; p < count; ++p) {
        moved[(1 + 2 * k) * count + p] += wanted_.limits.difference;
        moved[(2 + 2 * k) * count + p] -= wanted_.limits.difference;
      }
    }
    for (int k = 0; k < plan_.inputs; ++k)
      for (long i = k * rows; i < (k + 1) * rows; ++i) {
        whole[i] = wanted_.cyclic[k] ? std::rint(full[i] / FULL_TURN) : 0.0;
        reduced[i] = full[i] - whole[i] * FULL_TURN;
      }
    repeat(wanted_.states, plan_.states, guess);
    if (like_.constraint_rates) repeat(like_.constraint_rates, plan_.input_constraints, tied);
    if (like_.turned) repeat(like_.turned, turned(), turns);
    repeat(like_.time, 1, time);
    Request r = like_;
    r.rows = rows;
    r.inputs = reduced, r.whole = whole, r.full = full, r.rates = still, r.accelerations = still;
    r.guess = guess, r.constraint_rates = like_.constraint_rates ? tied : nullptr;
    r.turned = like_.turned ? turns : nullptr, r.time = time;
    r.states = states_ = take(plan_.states);
    r.outputs = outputs_ = take(like_.wanted.slots);
    r.residual = take(1), r.correction = take(1);
    r.flags = flags_.data();
    r.undefined = plan_.load_values ? undefined() : nullptr;
    run_rows(plan_, r, unit_, threads_);
  }

  // Whether a place and those beside it are closed and have efforts.
  bool are_known(long place) const {
    for (int kind = 0; kind < kinds_; ++kind) {
      const long row = kind * count_ + place;
      if (flags_[(std::size_t)row] != ROW_GOOD || (plan_.load_values && undefined()[row])) return false;
      for (int k = 0; k < wanted_.free_count; ++k)
        if (!std::isfinite(at(k, kind, place))) return false;
    }
    return true;
  }
  double at(int k, int kind, long place) const {
    const FreeInput& free = wanted_.free[k];
    return outputs_[(free.slot * kinds_ + kind) * count_ + place] * free.unit;
  }
  double state(int number, long place) const { return states_[number * kinds_ * count_ + place]; }

 private:
  int turned() const { return like_.turned ? turn_slots(plan_, unit_) : 0; }
  const unsigned char* undefined() const { return flags_.data() + flags_.size() / 2; }
  unsigned char* undefined() { return flags_.data() + flags_.size() / 2; }
  // Numbers of the first places, for one kind after the other.
  void repeat(const double* from, int numbers, double* to) const {
    for (int i = 0; i < numbers; ++i)
      for (int kind = 0; kind < kinds_; ++kind)
        for (long p = 0; p < count_; ++p) *to++ = from[i * wanted_.places + p];
  }

  const Plan& plan_;
  const Request& like_;
  const KernelUnit& unit_;
  int threads_;
  const BalanceRequest& wanted_;
  int kinds_;
  long count_ = 0;
  double *states_ = nullptr, *outputs_ = nullptr;
  std::vector<double> numbers_;
  std::vector<unsigned char> flags_;
};

}  // namespace

long balance(const Plan& plan, const Request& like, const KernelUnit& unit, int threads, const BalanceRequest& wanted) {
  const int n = wanted.free_count;
  const long places = wanted.places, least = wanted.is_first_known ? 1 : 0;
  const BalanceLimits& limits = wanted.limits;
  Efforts efforts(plan, like, unit, threads, wanted);
  std::vector<double> before((std::size_t)places), left((std::size_t)places), side((std::size_t)places);
  std::vector<double> system((std::size_t)(n * (n + 1))), step((std::size_t)n);
  long count = places;
  for (int round = 0; round < limits.steps && count > least; ++round) {
    efforts.measure(count);
    bool is_done = true;
    for (long p = 0; p < count; ++p) {
      bool is_good = efforts.are_known(p);
      double size = 0.0;
      if (is_good) {
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < n; ++j) {
            double& slope = wanted.stiffness[(i * n + j) * places + p];
            if (!wanted.is_stiffness_given)
              slope = (efforts.at(i, 1 + 2 * j, p) - efforts.at(i, 2 + 2 * j, p)) / (2.0 * limits.difference);
            system[(std::size_t)(i * (n + 1) + j)] = slope;
          }
          system[(std::size_t)(i * (n + 1) + n)] = -efforts.at(i, 0, p);
        }
        side[p] = eliminate(system, step.data(), n);
        is_good = side[p] != 0.0;
        for (int k = 0; k < n && is_good; ++k) {
          is_good = std::isfinite(step[k]);
          size = std::fmax(size, std::fabs(step[k]));
        }
      }
      if (p < least && is_good) size = 0.0;
      // steps shrink, by squares where each goes by its own slopes, until rounding alone is left
      const bool shrinks = round == 0 || size <= limits.gain * before[p];
      if (!is_good || !(shrinks || size <= limits.rounding)) {
        count = p;
        break;
      }
      for (int k = 0; k < n && shrinks && p >= least; ++k) wanted.inputs[wanted.free[k].input * places + p] += step[k];
      for (int k = 0; k < plan.states; ++k) wanted.states[k * places + p] = efforts.state(k, p);
      const double gain = round ? size / std::fmax(before[p], limits.enough) : 1.0;
      left[p] = !shrinks ? 0.0 : wanted.is_stiffness_given ? size : size * gain * gain;
      before[p] = size;
      is_done = is_done && left[p] <= limits.enough;
    }
    if (is_done) break;
  }
  for (long p = 0; p < count; ++p) {
    const bool is_beside = !wanted.is_stiffness_given && !(side[p] * side[0] > 0.0);
    if (is_beside || !(left[p] <= limits.enough)) return p;
  }
  return count;
}
