// Branch points on the way of a charted motion of one freedom: looked for where steps are refused, and passed along the
// smooth continuation (crossing_curve.hpp).
#include <cmath>

#include "charted_motion.hpp"

namespace {

// Refused stages (rad, parts of the size from the origin) that are too far for a branch point to be what refuses them.
constexpr double TOO_FAR = 1.0;
// Of a refused stage's way: the first place that is looked at.
constexpr double PROBE = 0.1;
// Of states at the end of a motion from a branch point that it has come to.
constexpr double CLOSE = 0.05;
// Stages so near to their origin are refused next to a singular place alone.
constexpr double SINGULAR_NEAR = 1e-2;

}  // namespace

// Places of a lane that lie on its curve come from there.
void ChartedMotion::put_on_curve(int lane) {
  placed_[lane] = PREDICTED;
  const Crossing& c = crossing_[lane];
  const double s = place_[lane];
  if (!c.engaged || !c.curve.covers(s)) return;
  for (int i = 0; i < plan_.inputs; ++i)
    if (at(inputs_, i, lane) != c.inputs[i]) return;
  std::vector<double> state(plan_.states), first(plan_.columns), second(plan_.columns);
  c.curve.place(s, state.data(), first.data(), second.data());
  placed_[lane] = PLACED;
  for (int k = 0; k < plan_.states; ++k) placed_state_[k * lanes_ + lane] = state[k];
  for (int k = 0; k < plan_.columns; ++k) {
    placed_first_[k * lanes_ + lane] = first[k];
    placed_second_[k * lanes_ + lane] = second[k];
  }
}

// Guesses are polynomials of states: orientations are given their length again.
void ChartedMotion::put_guess(int lane, std::vector<double> guess) {
  for (int k = 0; k < plan_.links; ++k) {
    if (plan_.joints[k].type != TREE_S) continue;
    double* const q = guess.data() + plan_.joints[k].state;
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; ++i) q[i] /= size;
  }
  placed_[lane] = GUESSED;
  for (int k = 0; k < plan_.states; ++k) placed_state_[k * lanes_ + lane] = guess[k];
}

bool ChartedMotion::look_at(int lane, double s, const std::vector<double>& guess, CurvePlace* found) {
  const std::vector<unsigned char> none(lanes_, 0);
  set_places({origin_time_.data(), nullptr, none.data(), nullptr, false});
  place_[lane] = s, rate_[lane] = 1.0;
  placed_[lane] = PREDICTED;
  if (!guess.empty()) put_guess(lane, guess);
  if (!looked_.flags.size()) looked_ = make_stage(), bend_.assign((std::size_t)(plan_.columns * lanes_), 0.0);
  evaluate(place_.data(), rate_.data(), &looked_, bend_.data());
  if (looked_.flags[lane] & STAGE_NOT_CLOSED) return false;
  const Block& block = plan_.block[0];
  found->s = s;
  found->jacobian = Matrix(block.rows, block.size);
  for (long e = 0; e < entries_; ++e) found->jacobian.a[e] = at(looked_.jacobian, e, lane);
  const auto column = [&](const Packed& from, int count, std::vector<double>* to) {
    to->resize(count);
    for (int k = 0; k < count; ++k) (*to)[k] = at(from, k, lane);
  };
  column(looked_.state, plan_.states, &found->state);
  column(looked_.tangent, plan_.columns, &found->first), column(bend_, plan_.columns, &found->second);
  return true;
}

// Asked where a stage at a place (charts x lanes) of the chart was refused.
void ChartedMotion::look_ahead(int lane, const double* places) {
  Crossing& c = crossing_[lane];
  const double place = places[lane];
  double way = 0.0;
  for (int i = 0; i < plan_.charts; ++i) way = std::fmax(way, std::fabs(places[i * lanes_ + lane]));
  if (way < SINGULAR_NEAR) c.refused_at = last_place(lane);
  if (plan_.charts != 1 || plan_.blocks != 1 || c.looked || c.engaged || !(way > 0.0 && way < TOO_FAR)) return;
  c.looked = true;
  if (!branch_point_near(lane).empty()) return;
  CrossingCurve curve;
  const auto look = [&](double s, const std::vector<double>& guess, CurvePlace* found) {
    return look_at(lane, s, guess, found);
  };
  if (!curve.find(look, place > 0.0 ? 1.0 : -1.0, PROBE * way)) return;
  std::vector<double> first(plan_.columns), second(plan_.columns);
  c.branch_point.resize(plan_.states);
  curve.place(curve.at(), c.branch_point.data(), first.data(), second.data());
  // friction reads reactions, which are not unique there
  if (!limits_.straight || plan_.frictions) return;
  c.engaged = true, c.curve = std::move(curve), c.offset = 0.0;
  c.inputs.resize(plan_.inputs);
  for (int i = 0; i < plan_.inputs; ++i) c.inputs[i] = at(inputs_, i, lane);
}

// At the end of a step of a lane on its curve: whether the chart is kept, as the branch point is near.
bool ChartedMotion::keeps_curve(int lane, double time, double moved) {
  Crossing& c = crossing_[lane];
  if (!c.engaged) return false;
  const double before = c.offset, now = before + moved, point = c.curve.at();
  if ((before < point) != (now < point)) crossings_[lane].push_back({time, c.branch_point});
  const bool comes_near = (point > 0.0) == (now < point);
  c.offset = now;
  if (c.curve.covers(now) && (comes_near || !c.curve.is_clear(now))) return true;
  c.engaged = false, c.offset = 0.0;
  return false;
}

std::vector<double> ChartedMotion::last_place(int lane) const {
  const Crossing& c = crossing_[lane];
  std::vector<double> state(plan_.states), first(plan_.columns), second(plan_.columns);
  for (int k = 0; k < plan_.states; ++k) state[k] = at(origin_, k, lane);
  if (c.engaged && c.curve.covers(c.offset)) c.curve.place(c.offset, state.data(), first.data(), second.data());
  return state;
}

// Whether a lane stands next to some states (states, or none).
bool ChartedMotion::is_near(int lane, const std::vector<double>& state, double within) const {
  const std::vector<double> last = last_place(lane);
  for (std::size_t k = 0; k < state.size(); ++k)
    if (!(std::fabs(state[k] - last[k]) <= within)) return false;
  return !state.empty();
}

bool ChartedMotion::is_next_to_singular(int lane) const {
  return is_near(lane, crossing_[lane].refused_at, SINGULAR_NEAR);
}

// The branch point that a lane has ended next to; empty without one.
std::vector<double> ChartedMotion::branch_point_near(int lane) const {
  const std::vector<double>& point = crossing_[lane].branch_point;
  return !crossing_[lane].engaged && is_near(lane, point, CLOSE) ? point : std::vector<double>();
}
