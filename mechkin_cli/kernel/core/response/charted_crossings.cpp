// Branch points on the way of a charted motion: looked for where stages are refused, and passed along the smooth
// continuation (crossing_curve.hpp).
//
// A stage is a place z = (u, x - x_0) of the chart's coordinates and the driven inputs. What it is asked for is smooth in z
// over the branch point, and is read off the line z + s `way` through it; with one freedom and inputs at rest that is one
// line for all stages.
#include <cmath>

#include "response/charted_motion.hpp"

namespace {

// Refused stages (rad, parts of the size from the origin) that are too far for a branch point to be what refuses them.
constexpr double TOO_FAR = 1.0;
// Of a refused stage's way: the first place that is looked at.
constexpr double PROBE = 0.1;
// Of states at the end of a motion with friction from a branch point that it has come to.
constexpr double CLOSE = 0.05;
// Stages so near to their origin are refused next to a singular place alone.
constexpr double SINGULAR_NEAR = 1e-2;
// So many of them at one place end the motion: rounding leaves no step that is exact and short enough. A way around a gap of
// 1e-6 between two branches takes about 200.
constexpr int MOST_REFUSALS = 2000;

}  // namespace

// The line through a stage's place; `s` is where on it the stage lies.
ChartedMotion::Line ChartedMotion::line_through(int lane, double* s) const {
  const Crossing& c = crossing_[lane];
  const int n = plan_.charts, inputs = plan_.inputs;
  Line line = {std::vector<double>(n + inputs), n == 1};
  for (int i = 0; i < n; ++i) line.base[i] = at(place_, i, lane);
  for (int i = 0; i < inputs; ++i) line.base[n + i] = at(inputs_, i, lane) - c.inputs[i];
  *s = 0.0;
  for (int i = 0; i < n + inputs; ++i) *s += c.way[i] * line.base[i];
  for (int i = 0; i < n + inputs; ++i) {
    line.base[i] -= *s * c.way[i];
    line.is_only = line.is_only && line.base[i] == 0.0;
  }
  for (int i = 0; i < inputs; ++i)
    line.is_only = line.is_only && at(input_rates_, i, lane) == 0.0 && at(input_seconds_, i, lane) == 0.0;
  return line;
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

// A place of a line, with the rates of the stage; of the only line, with the rate 1. The lane's stage is lost.
bool ChartedMotion::look_at(int lane, const Line& line, double s, const std::vector<double>& guess, CurvePlace* found) {
  const Crossing& c = crossing_[lane];
  const int n = plan_.charts;
  for (int i = 0; i < n; ++i) place_[i * lanes_ + lane] = line.base[i] + s * c.way[i];
  for (int i = 0; i < plan_.inputs; ++i) inputs_[i * lanes_ + lane] = c.inputs[i] + line.base[n + i] + s * c.way[n + i];
  if (line.is_only) rate_[lane] = 1.0;
  elapsed_[lane] = 0.0, placed_[lane] = PREDICTED;
  if (!guess.empty()) put_guess(lane, guess);
  if (!looked_.flags.size()) looked_ = make_stage(), bend_.assign((std::size_t)(plan_.columns * lanes_), 0.0);
  evaluate(place_.data(), rate_.data(), &looked_, bend_.data());
  if (looked_.flags[lane] & STAGE_NOT_CLOSED) return false;
  found->s = s;
  found->jacobian = jacobian_of(looked_.jacobian, lane);
  if (guess.empty() && s == 0.0 && !is_joined(lane, found->jacobian)) return false;
  const auto column = [&](const Packed& from, int count, std::vector<double>* to) {
    to->resize(count);
    for (int k = 0; k < count; ++k) (*to)[k] = at(from, k, lane);
  };
  column(looked_.state, plan_.states, &found->state);
  column(looked_.tangent, (n + plan_.inputs) * plan_.columns, &found->tangent);
  column(bend_, plan_.columns, &found->bend);
  return true;
}

// Whether the Jacobian of a place just looked at is told to be on the origin's side.
bool ChartedMotion::is_joined(int lane, const ChartMatrix& jacobian) const {
  if (plan_.block[0].band_entries) return !(looked_.flags[lane] & STAGE_OFF_BRANCH);
  return jacobian.is_joined(jacobian_of(jacobian_, lane), limits_.radius);
}

// The way in which regularity is lost fastest, by differences.
bool ChartedMotion::find_way(int lane, const Line& line, double probe) {
  std::vector<double>& way = crossing_[lane].way;
  const std::size_t size = line.base.size();
  std::vector<double> slope(size);
  way.assign(size, 0.0);
  CurvePlace place;
  double square = 0.0, least = 0.0;
  for (std::size_t i = 0; i <= size; ++i) {
    Line off = line;
    if (i) off.base[i - 1] += probe;
    if (!look_at(lane, off, 0.0, {}, &place)) break;
    const double regular = place.jacobian.regularity();
    if (!i) least = regular;
    if (i) slope[i - 1] = least - regular, square += slope[i - 1] * slope[i - 1];
    if (i == size && square > 0.0) way = slope;
  }
  for (double& x : way) x /= std::sqrt(square);
  return square > 0.0;
}

// The way over the branch point on a line. The lane's stage stays as it is.
bool ChartedMotion::find_curve(int lane, const Line& line, double probe, CrossingCurve* curve) {
  const auto put = [&](Packed& to, const Packed& from) {
    for (std::size_t k = lane; k < from.size(); k += lanes_) to[k] = from[k];
  };
  const Packed place = place_, rate = rate_, inputs = inputs_, elapsed = elapsed_;
  if (crossing_[lane].way.empty() && !find_way(lane, line, probe)) return false;
  const auto look = [&](double s, const std::vector<double>& guess, CurvePlace* found) {
    return look_at(lane, line, s, guess, found);
  };
  double pace = line.is_only ? 1.0 : 0.0;
  for (int i = 0; i < plan_.charts && !line.is_only; ++i) pace += at(rate_, i, lane) * at(rate_, i, lane);
  for (int i = 0; i < plan_.inputs; ++i)
    pace += at(input_rates_, i, lane) * at(input_rates_, i, lane) + std::fabs(at(input_seconds_, i, lane));
  const bool found = curve->find(look, probe, pace);
  put(place_, place), put(rate_, rate), put(inputs_, inputs), put(elapsed_, elapsed);
  placed_[lane] = PREDICTED;
  return found;
}

// Places of a lane that lie on their curve come from there.
void ChartedMotion::put_on_curve(int lane) {
  Crossing& c = crossing_[lane];
  c.here = {};
  if (!c.engaged) return;
  double s;
  const Line line = line_through(lane, &s);
  CrossingCurve own;
  if (!line.is_only && !find_curve(lane, line, c.probe, &own)) return;
  const CrossingCurve& curve = line.is_only ? c.curve : own;
  if (line.is_only && !c.has_only) return;
  double pace = 0.0;
  for (std::size_t i = 0; i < c.way.size(); ++i)
    pace += c.way[i] * ((int)i < plan_.charts ? at(rate_, i, lane) : at(input_rates_, i - plan_.charts, lane));
  const bool is_behind = s > curve.at();
  c.here = {true, curve.covers(s), is_behind, curve.is_clear(s) && is_behind == (pace > 0.0)};
  if (!c.here.is_covered) return;
  const int n = plan_.charts, columns = plan_.columns, entries = (n + plan_.inputs) * columns;
  std::vector<double> state(plan_.states), tangent(entries), bend(columns);
  if (!line.is_only) curve.place(curve.at(), c.branch_point.data(), tangent.data(), bend.data());
  curve.place(s, state.data(), tangent.data(), bend.data());
  // of a rate 1
  const double square = line.is_only ? rate_[lane] * rate_[lane] : 1.0;
  placed_[lane] = PLACED;
  for (int k = 0; k < plan_.states; ++k) placed_state_[k * lanes_ + lane] = state[k];
  for (int k = 0; k < entries; ++k) placed_tangent_[k * lanes_ + lane] = tangent[k];
  for (int k = 0; k < columns; ++k) placed_bend_[k * lanes_ + lane] = square * bend[k];
}

// Asked where a stage of the chart was refused.
void ChartedMotion::look_ahead(int lane) {
  Crossing& c = crossing_[lane];
  const int n = plan_.charts, size = n + plan_.inputs;
  double square = 0.0;
  std::vector<double> way(size);
  for (int i = 0; i < size; ++i) {
    way[i] = i < n ? at(place_, i, lane) : at(inputs_, i - n, lane) - at(origin_inputs_, i - n, lane);
    square += way[i] * way[i];
  }
  const double length = std::sqrt(square);
  if (length < SINGULAR_NEAR) {
    const bool is_same = is_near(lane, c.refused_at, SINGULAR_NEAR);
    c.refusals = is_same ? c.refusals + 1 : 1;
    if (!is_same) c.refused_at = last_place(lane);
  }
  if (c.looked || c.engaged || !(length > 0.0 && length < TOO_FAR)) return;
  c.looked = true;
  if (plan_.frictions && is_near(lane, c.branch_point, CLOSE)) return;
  c.probe = PROBE * length;
  c.inputs.resize(plan_.inputs);
  for (int i = 0; i < plan_.inputs; ++i) c.inputs[i] = at(origin_inputs_, i, lane);
  bool is_only = n == 1;
  for (int i = 0; i < plan_.inputs; ++i)
    is_only = is_only && way[n + i] == 0.0 && at(input_rates_, i, lane) == 0.0 && at(input_seconds_, i, lane) == 0.0;
  const Line line = {std::vector<double>(size, 0.0), is_only};
  c.way.clear();
  if (is_only) c.way.assign(size, 0.0), c.way[0] = way[0] > 0.0 ? 1.0 : -1.0;
  if (!find_curve(lane, line, c.probe, &c.curve)) return;
  std::vector<double> tangent((std::size_t)size * plan_.columns), bend(plan_.columns);
  c.branch_point.resize(plan_.states);
  c.curve.place(c.curve.at(), c.branch_point.data(), tangent.data(), bend.data());
  // friction reads reactions, which are not unique there
  if (plan_.frictions) return;
  c.engaged = c.is_new = true, c.has_only = line.is_only, c.was_behind = false;
  c.offset.assign(n, 0.0);
}

// Whether a place on its curve lies behind the branch point of a motion that ends there.
bool ChartedMotion::is_beyond(int lane) const {
  const Crossing& c = crossing_[lane];
  return c.engaged && !limits_.straight && c.here.is_found && c.here.is_behind;
}

bool ChartedMotion::finds_more(int lane) {
  const bool found = crossing_[lane].is_new;
  crossing_[lane].is_new = false;
  return found && limits_.straight;
}

bool ChartedMotion::gives_up(int lane) const {
  return crossing_[lane].refusals > MOST_REFUSALS && is_next_to_singular(lane);
}

// At the end of a step of a lane with a curve: whether the chart is kept, as the branch point is near. `moved` is u.
bool ChartedMotion::keeps_curve(int lane, double time, const double* moved) {
  Crossing& c = crossing_[lane];
  if (!c.engaged) return false;
  const auto& end = c.at_end;
  if (end.is_found && end.is_behind != c.was_behind) crossings_[lane].push_back({time, c.branch_point});
  if (end.is_found) c.was_behind = end.is_behind;
  for (int i = 0; i < plan_.charts; ++i) c.offset[i] += moved[i * lanes_ + lane];
  if (end.is_found && end.is_covered && !end.leaves) return true;
  c.engaged = false;
  c.offset.assign(plan_.charts, 0.0);
  return false;
}

std::vector<double> ChartedMotion::last_place(int lane) const {
  std::vector<double> state(plan_.states);
  for (int k = 0; k < plan_.states; ++k) state[k] = at(last_, k, lane);
  return state;
}

// Whether a lane stands next to some states (states, or none).
bool ChartedMotion::is_near(int lane, const std::vector<double>& state, double within) const {
  for (std::size_t k = 0; k < state.size(); ++k)
    if (!(std::fabs(state[k] - at(last_, (long)k, lane)) <= within)) return false;
  return !state.empty();
}

bool ChartedMotion::is_next_to_singular(int lane) const {
  return is_near(lane, crossing_[lane].refused_at, SINGULAR_NEAR);
}

// The branch point that a lane has ended at; empty without one.
std::vector<double> ChartedMotion::branch_point_near(int lane) const {
  const Crossing& c = crossing_[lane];
  const bool is_end = plan_.frictions ? is_near(lane, c.branch_point, CLOSE) : c.engaged && !limits_.straight;
  return is_end ? c.branch_point : std::vector<double>();
}
