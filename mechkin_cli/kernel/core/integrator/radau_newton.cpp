// The stages of a step of Radau IIA: Jacobian, factors, simplified Newton.
#include <algorithm>
#include <cmath>
#include <utility>

#include "integrator/radau.hpp"
#include "integrator/radau_tableau.hpp"

using namespace radau;

namespace {

constexpr double PROBE = 0x1p-26;  // of a difference, in parts of 1 or of the largest rate
constexpr double SHORTER_PROBE = 0x1p-10, LEAST_PROBE = 0x1p-46;  // of it, where the derivative changes within it
constexpr double ROUGH = 1e-3, NOISE = 1e-10;  // changes that are none, in parts of a derivative; of the rates it comes from
constexpr double STALLED = 0.03;   // tolerances: changes below it that do not shrink do a step no harm
constexpr double EPSILON = 2.220446049250313e-16;

// How far the stages are solved for, in tolerances of the step.
double newton_limit(double tolerance) {
  return std::max(10.0 * EPSILON / tolerance, std::min(0.03, std::sqrt(tolerance)));
}

}  // namespace

void Radau::fail(LaneStates& s, int lane, Flags* mask) {
  // the next try has a Jacobian that is checked
  if (!lane_[lane].is_doubtful) lane_[lane].is_doubtful = true, lane_[lane].has_jacobian = false;
  s.fault[lane] = NOT_SOLVED;
  s.reached[lane] = 1.0;
  (*mask)[lane] = 0;
}

// A column of the rates' derivatives in the open lanes, by a difference over this probe, which is turned where it leads to a
// fault; lanes that have one both ways are returned. Open stay doubtful ones without a column before, or with another, as
// that of friction is if the probe is longer than the slip.
Flags Radau::differentiate_column(LaneStates& s, int column, double probe, Flags* open) {
  Flags waiting = *open;
  for (double sign : {1.0, -1.0}) {
    Flags here = waiting;
    if (!any(here)) break;
    place_ = s.y;
    for (int i = 0; i < lanes_; ++i) {
      double& x = place_[(long)column * lanes_ + i];
      const double before = x;
      x += sign * probe * (column < n_ ? 1.0 : s.speed[i]);
      shift_[i] = x - before;
    }
    s.evaluate(s.time.data(), place_.data(), false, &here, probe_.data(), switches_.data());
    for (int i = 0; i < lanes_; ++i) {
      if (!here[i]) continue;
      waiting[i] = 0;
      bool is_same = probe < PROBE;
      for (int k = 0; k < n_ + q_; ++k) {
        const long at = (long)(n_ + k) * lanes_ + i;
        const double slope = (probe_[at] - s.slope[at]) / shift_[i];
        const double noise = NOISE * std::max(std::fabs(probe_[at]), std::fabs(s.slope[at])) / std::fabs(shift_[i]);
        const double known = lane_[i].jacobian[(std::size_t)k * 2 * n_ + column];
        is_same = is_same && std::fabs(slope - known) <= ROUGH * std::fabs(slope) + noise;
      }
      lane_[i].differs = lane_[i].differs || (probe < PROBE && !is_same);
      (*open)[i] = !is_same && lane_[i].is_doubtful;
      for (int k = 0; k < n_ + q_ && !is_same; ++k) {
        const long at = (long)(n_ + k) * lanes_ + i;
        lane_[i].jacobian[(std::size_t)k * 2 * n_ + column] = (probe_[at] - s.slope[at]) / shift_[i];
      }
    }
  }
  for (int i = 0; i < lanes_; ++i)
    if (waiting[i]) (*open)[i] = 0;
  return waiting;
}

// The rates' derivatives where lanes do not have them.
void Radau::differentiate(LaneStates& s, Flags* mask) {
  Flags lacking(lanes_);
  for (int i = 0; i < lanes_; ++i) lacking[i] = (*mask)[i] && !lane_[i].has_jacobian;
  if (!any(lacking)) return;
  for (Lane& l : lane_) l.differs = false;
  for (int column = 0; column < 2 * n_; ++column) {
    Flags open = lacking;
    for (double probe = PROBE; any(open) && probe >= LEAST_PROBE; probe *= SHORTER_PROBE) {
      const Flags waiting = differentiate_column(s, column, probe, &open);
      for (int i = 0; i < lanes_; ++i) {
        if (!waiting[i] || probe < PROBE) continue;
        s.reached[i] = 1.0;
        (*mask)[i] = lacking[i] = 0;
      }
    }
  }
  for (int i = 0; i < lanes_; ++i) {
    if (!(*mask)[i]) continue;
    lane_[i].has_jacobian = true;
    if (lacking[i]) lane_[i].is_doubtful = lane_[i].differs;
    s.fault[i] = 0;
  }
}

// m^2 I - m Jv - Ju for the real eigenvalue and one of the pair, over the step.
void Radau::factorise(LaneStates& s, Flags* mask) {
  for (int i = 0; i < lanes_; ++i) {
    if (!(*mask)[i]) continue;
    Lane& l = lane_[i];
    l.real_shift = REAL / s.step[i];
    l.complex_shift = {PAIR.re / s.step[i], PAIR.im / s.step[i]};
    const Complex m = l.complex_shift, square = m * m;
    std::vector<double> real((std::size_t)n_ * n_);
    std::vector<Complex> complex((std::size_t)n_ * n_);
    for (int r = 0; r < n_; ++r)
      for (int c = 0; c < n_; ++c) {
        const double by_u = l.jacobian[(std::size_t)r * 2 * n_ + c];
        const double by_v = l.jacobian[(std::size_t)r * 2 * n_ + n_ + c];
        const double one = r == c ? 1.0 : 0.0;
        real[(std::size_t)r * n_ + c] = l.real_shift * (l.real_shift * one - by_v) - by_u;
        complex[(std::size_t)r * n_ + c] = {square.re * one - m.re * by_v - by_u, square.im * one - m.im * by_v};
      }
    if (!l.real.decompose(std::move(real), n_) || !l.complex.decompose(std::move(complex), n_)) fail(s, i, mask);
  }
}

// (m I - J) (du, dv) = (u, v), in place: du from (m^2 - m Jv - Ju) du = v + (m - Jv) u, then dv = m du - u.
void Radau::solve(const Lane& l, double* u, double* v) const {
  std::vector<double> right(n_);
  for (int r = 0; r < n_; ++r) {
    double sum = v[r] + l.real_shift * u[r];
    for (int c = 0; c < n_; ++c) sum -= l.jacobian[(std::size_t)r * 2 * n_ + n_ + c] * u[c];
    right[r] = sum;
  }
  l.real.solve(right.data());
  for (int r = 0; r < n_; ++r) {
    v[r] = l.real_shift * right[r] - u[r];
    u[r] = right[r];
  }
}

void Radau::solve(const Lane& l, Complex* u, Complex* v) const {
  std::vector<Complex> right(n_);
  for (int r = 0; r < n_; ++r) {
    const Complex product = l.complex_shift * u[r];
    Complex sum = {v[r].re + product.re, v[r].im + product.im};
    for (int c = 0; c < n_; ++c) {
      const double by_v = l.jacobian[(std::size_t)r * 2 * n_ + n_ + c];
      sum = sum - Complex{by_v * u[c].re, by_v * u[c].im};
    }
    right[r] = sum;
  }
  l.complex.solve(right.data());
  for (int r = 0; r < n_; ++r) {
    v[r] = l.complex_shift * right[r] - u[r];
    u[r] = right[r];
  }
}

// Simplified Newton for the stages of all lanes; those that do not converge get a fault.
void Radau::iterate(LaneStates& s, Flags* mask) {
  s.error_scales(s.y.data(), s.y.data(), scale_.data());
  for (int i = 0; i < lanes_; ++i) {
    if (!(*mask)[i]) continue;
    Lane& l = lane_[i];
    l.iterations = 0;
    l.is_solved = false;
    // the stages begin with the present rates
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 2 * n_; ++c)
        increment_[k][(long)c * lanes_ + i] = c < n_ ? C[k] * s.step[i] * s.y[(long)(n_ + c) * lanes_ + i] : 0.0;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 2 * n_; ++c) {
        double sum = 0.0;
        for (int j = 0; j < 3; ++j) sum += BACK[k][j] * increment_[j][(long)c * lanes_ + i];
        l.w[k][c] = sum;
      }
  }
  Flags open = *mask;
  Flags solved(lanes_, 0);
  while (any(open)) {
    const Flags asked = open;
    ask_stages(s, &open);
    for (int i = 0; i < lanes_; ++i) {
      if (asked[i] && !open[i]) (*mask)[i] = 0;
      if (open[i]) update(s, i, &open, &solved);
      if (asked[i] && !open[i] && !solved[i]) (*mask)[i] = 0;
    }
  }
}

// Rates at the three stages; lanes with a fault leave the mask.
bool Radau::ask_stages(LaneStates& s, Flags* mask) {
  for (int k = 0; k < 3; ++k) {
    for (long j = 0; j < entries_; ++j) place_[j] = s.y[j] + increment_[k][j];
    for (int i = 0; i < lanes_; ++i) {
      at_[i] = k == 2 ? s.until[i] : s.time[i] + C[k] * s.step[i];
      if ((*mask)[i]) s.reached[i] = C[k];
    }
    if (!s.evaluate(at_.data(), place_.data(), false, mask, slope_[k].data(), switches_.data())) return false;
    for (std::size_t j = 0; k < 2 && j < switches_.size(); ++j) {
      s.inner[k] = C[k];
      if ((*mask)[j % lanes_]) s.switch_inner[k][j] = switches_[j];
    }
  }
  return true;
}

// One iteration of a lane from its stages' rates. It leaves the open ones when it is solved or fails.
void Radau::update(LaneStates& s, int i, Flags* open, Flags* solved) {
  Lane& l = lane_[i];
  std::vector<Complex> pair(2 * n_);
  for (int c = 0; c < 2 * n_; ++c) {
    const long at = (long)c * lanes_ + i;
    double sum[3];
    for (int k = 0; k < 3; ++k)
      sum[k] = BACK[k][0] * slope_[0][at] + BACK[k][1] * slope_[1][at] + BACK[k][2] * slope_[2][at];
    l.dw[0][c] = sum[0] - l.real_shift * l.w[0][c];
    pair[c] = Complex{sum[1], sum[2]} - l.complex_shift * Complex{l.w[1][c], l.w[2][c]};
  }
  solve(l, l.dw[0].data(), l.dw[0].data() + n_);
  solve(l, pair.data(), pair.data() + n_);
  double change = 0.0;
  for (int c = 0; c < 2 * n_; ++c) {
    l.dw[1][c] = pair[c].re;
    l.dw[2][c] = pair[c].im;
    const double scale = scale_[(long)c * lanes_ + i];
    for (int k = 0; k < 3; ++k) {
      l.w[k][c] += l.dw[k][c];
      const double part = std::fabs(l.dw[k][c]) / scale;
      change = part <= change ? change : part;  // keeps what is no number
    }
    for (int k = 0; k < 3; ++k)
      increment_[k][(long)c * lanes_ + i] = T[k][0] * l.w[0][c] + T[k][1] * l.w[1][c] + T[k][2] * l.w[2][c];
  }
  if (!converges(s, i, change)) return fail(s, i, open);
  if (!l.is_solved) return;
  integrate_quadratures(s, i);
  (*open)[i] = 0;
  (*solved)[i] = 1;
}

// Whether the iteration may go on; notes where it is done. (IV.8.10, 8.11)
bool Radau::converges(const LaneStates& s, int i, double change) {
  Lane& l = lane_[i];
  const double limit = newton_limit(s.settings.tolerance), before = l.change;
  l.change = change;
  ++l.iterations;
  if (!(change < __builtin_inf())) return false;
  if (change == 0.0) return l.is_solved = true;
  if (l.iterations == 1) return true;
  const double rate = change / before;
  // a change that shrinks no more is the rounding of places that are closed
  if (rate >= 1.0 && std::max(change, before) < STALLED) return l.is_solved = true;
  if (change < limit || (rate < 1.0 && rate / (1.0 - rate) * change < limit)) return l.is_solved = true;
  return rate < 1.0 && l.iterations < ITERATIONS;
}

// The quadratures' increments from the stages' rates, which the last iteration moves by their derivatives.
void Radau::integrate_quadratures(LaneStates& s, int i) {
  const Lane& l = lane_[i];
  std::vector<double> last[3];
  for (int k = 0; k < 3; ++k) {
    last[k].resize(2 * n_);
    for (int c = 0; c < 2 * n_; ++c)
      last[k][c] = T[k][0] * l.dw[0][c] + T[k][1] * l.dw[1][c] + T[k][2] * l.dw[2][c];
  }
  for (int j = 0; j < q_; ++j) {
    const long at = (long)(2 * n_ + j) * lanes_ + i;
    double rate[3];
    for (int k = 0; k < 3; ++k) {
      rate[k] = slope_[k][at];
      for (int c = 0; c < 2 * n_; ++c) rate[k] += l.jacobian[(std::size_t)(n_ + j) * 2 * n_ + c] * last[k][c];
    }
    for (int k = 0; k < 3; ++k)
      increment_[k][at] = s.step[i] * (A[k][0] * rate[0] + A[k][1] * rate[1] + A[k][2] * rate[2]);
  }
}
