#include "tracker.hpp"

#include <cmath>
#include <utility>

namespace {

// Whether the inputs between two nodes are where the nodes' derivatives say: what the path does between them is seen.
bool sees_between(const Path& path, const Stepper& stepper, const Node& a, const Node& b) {
  constexpr int PLACES = 3;
  const double h = b.sigma - a.sigma;
  double sigma[PLACES];
  std::vector<double> inputs(stepper.plan().inputs * PLACES);
  PathPoint point;
  for (int k = 0; k < PLACES; ++k) {
    sigma[k] = a.sigma + h * (k + 1) / (PLACES + 1);
    path.at(sigma[k], &point);
    for (std::size_t i = 0; i < point.inputs.size(); ++i) inputs[i * PLACES + k] = point.inputs[i];
  }
  return stray(stepper, a, b, sigma, PLACES, inputs.data(), PLACES) <= stepper.limits().stray * h;
}

}  // namespace

Track follow_line(const Plan& plan, const KernelUnit& unit, const double* x0, const double* u, long rows,
                  const double* sigma, const double* start, const std::vector<double>& turn, const StepLimits& limits,
                  const RowGuesses& out, long first) {
  return follow_path(Line(plan, x0, u), unit, 0.0, rows, sigma, start, turn, limits, out, first);
}

Track follow_path(const Path& path, const KernelUnit& unit, double begin, long rows, const double* sigma,
                  const double* start, const std::vector<double>& turn, const StepLimits& limits, const RowGuesses& out, long first) {
  Stepper stepper(path, unit, limits);
  Track track = {TrackEnd::finished, 0, 0, 0, {}, 0.0};
  Node node, next;
  if (!stepper.close(begin, start, &node)) {
    track.end = TrackEnd::start_not_closed;
    return track;
  }
  if (!turn.empty()) adopt_turns(stepper, turn, &node);
  long row = 0;
  for (; row < rows && sigma[row] <= begin; ++row) put_row(node, limits.jump, first + row, out);
  const double end = rows ? sigma[rows - 1] : begin;
  double h = stepper.wanted_step(node);
  while (node.sigma < end) {
    if (track.steps + track.rejected >= limits.most_steps) {
      track.end = TrackEnd::exhausted;
      break;
    }
    const double least = limits.least_step * std::fmax(1.0, std::fabs(node.sigma));
    // the last step ends exactly on the last row
    // a rest of a millionth of a step is taken along
    const bool last = node.sigma + 1.000001 * h >= end;
    const double step = last ? end - node.sigma : h;
    if (!last && step < least) {
      track.end = TrackEnd::stalled;
      track.refused_step = step;
      break;
    }
    const bool good = stepper.step(node, step, last ? end : node.sigma + step, &next) &&
                      (continue_turns(stepper, node, &next) || step <= limits.angle_step) &&
                      (path.is_straight() || sees_between(path, stepper, node, next));
    if (!good) {
      ++track.rejected;
      h = 0.5 * step;
      if (h < least) {
        track.end = TrackEnd::stalled;
        track.refused_step = step;
        break;
      }
      continue;
    }
    ++track.steps;
    const long from = row;
    while (row < rows && sigma[row] <= next.sigma) ++row;
    infill(stepper, node, next, sigma + from, first + from, first + row, out);
    h = std::fmin(stepper.wanted_step(next), 4.0 * step);
    std::swap(node, next);
  }
  track.reached = row;
  track.last = node;
  return track;
}
