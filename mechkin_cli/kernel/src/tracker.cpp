#include "tracker.hpp"

#include <cmath>
#include <utility>

Track follow_line(const Plan& plan, const KernelUnit& unit, const double* x0, const double* u, long rows,
                  const double* sigma, double end, const double* start, const std::vector<double>& turn,
                  const StepLimits& limits, const RowGuesses& out, long first, std::vector<Stretch>* kept) {
  const Line line(plan, x0, u);
  Stepper stepper(line, unit, limits);
  Track track = {TrackEnd::finished, 0, 0, 0, {}, 0.0};
  Node node, next;
  if (!stepper.close(0.0, start, &node)) {
    track.end = TrackEnd::start_not_closed;
    return track;
  }
  if (!turn.empty()) adopt_turns(stepper, turn, &node);
  if (out.turn) stepper.reduce(&node);
  long row = 0;
  for (; row < rows && sigma[row] <= 0.0; ++row) put_row(node, limits.jump, first + row, out);
  double h = stepper.wanted_step(node);
  // longest steps alone would be too many
  if (!(end <= MOST_PATH_STEPS * limits.longest_step)) {
    track.end = TrackEnd::exhausted, track.reached = row, track.last = node;
    return track;
  }
  Progress progress(limits);
  while (node.sigma < end) {
    if (!progress.goes_on(node.sigma)) {
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
                      (continue_turns(stepper, node, &next) || step <= limits.angle_step);
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
    if (kept) {
      kept->push_back({node, next});
      // rows need no Jacobians, which are the largest part of a node
      kept->back().from.jacobian = kept->back().to.jacobian = {};
    }
    if (out.turn) stepper.reduce(&next);
    h = std::fmin(stepper.wanted_step(next), 4.0 * step);
    std::swap(node, next);
  }
  track.reached = row;
  track.last = node;
  return track;
}
