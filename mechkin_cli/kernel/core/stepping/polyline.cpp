// Following rows whose inputs move along any path.
//
// Rows in one line make a run, which is followed as a line with nodes anywhere on it. Between such runs the rows are
// taken for points of a smooth curve as long as the path turns little from row to row: nodes stand at rows, as far
// apart as the branch's bend allows, and the rows between are filled in where they lie on the curve between two nodes.
// Where the path has a corner or the branch bends too much between two rows, the chord is followed as a line. The work
// is linear in the rows: each row is looked at a bounded number of times.
//
// A line whose leading input is an angle is followed turn by turn, each from the angles within half a turn, until the
// branch repeats itself (orbit.hpp). Inputs that move no loop count as held: where no other moves, no step is taken.
#include <algorithm>
#include <cmath>
#include <optional>

#include "stepping/orbit.hpp"
#include "stepping/row_pieces.hpp"

namespace {

// Inputs whose joints no block places.
std::vector<char> still_inputs(const Plan& plan) {
  std::vector<char> still(plan.inputs, 1);
  for (int b = 0; b < plan.blocks; ++b)
    for (int o = plan.block[b].joint_begin; o < plan.block[b].joint_end; ++o)
      for (int i = 0; i < plan.inputs; ++i)
        if (plan.column_joint[plan.input_column[i]] == plan.order[o]) still[i] = 0;
  return still;
}

// Whether an input is an angle that turns for ever without going anywhere.
bool is_cyclic(const Plan& plan, int input) {
  const int column = plan.input_column[input];
  const TreeJoint& j = plan.joints[plan.column_joint[column]];
  return (j.type == TREE_R || j.type == TREE_C) && column == j.column;
}

class RowFollower {
 public:
  RowFollower(const Plan& plan, const KernelUnit& unit, const InputRows& rows, const StepLimits& limits,
               const RowGuesses& out, const Course* course)
      : plan_(plan), unit_(unit), rows_(rows), limits_(limits), out_(out), course_(course), cut_(rows, limits, course),
        result_{TrackEnd::finished, 1, 0, 0, {}, {}, {}, std::vector<double>(rows.inputs, 0.0), {}, {}, {}} {
    for (int i = 0; i < rows.inputs; ++i) cyclic_.push_back(out.turn && rows.whole && is_cyclic(plan, i));
  }

  Followed follow(const double* start, const std::vector<double>& turn, bool every_row) {
    result_.state.assign(start, start + plan_.states), result_.turn = turn;
    out_.limit[0] = limits_.jump;
    const bool placed = place_start();
    for (int s = 0; s < plan_.states; ++s) out_.guess[s * out_.rows] = result_.state[s];
    if (!placed) return std::move(result_);
    for (const Piece& piece : cut_.pieces(every_row)) {
      if (piece.way == Way::rest) rest(piece);
      if (piece.way == Way::line && !line(piece.first, piece.last, every_row)) return ended();
      if (piece.way == Way::curve && !curve(piece)) return ended();
      if (piece.way == Way::course && !along_course(piece, every_row)) return ended();
    }
    place_inputs(rows_.rows - 1);
    return ended();
  }

 private:
  // The closing joints' turns at the first row, where they are asked for.
  bool place_start() {
    place_inputs(0);
    if (!out_.turn) return true;
    const std::vector<double> x0 = line_start(0);
    const Line standing(plan_, x0.data(), result_.direction.data());
    Stepper stepper(standing, unit_, limits_);
    Node node;
    if (!stepper.close(0.0, result_.state.data(), &node)) {
      result_.end = TrackEnd::start_not_closed;
      return false;
    }
    if (!result_.turn.empty()) adopt_turns(stepper, result_.turn, &node);
    node.state = result_.state;
    stepper.reduce(&node);
    result_.state = node.state, result_.turn = node.turn;
    for (int s = 0; s < stepper.turn_slots(); ++s) out_.turn[s * out_.rows] = node.turn[s];
    return true;
  }
  void place_inputs(long row) {
    result_.inputs.resize(rows_.inputs);
    for (int i = 0; i < rows_.inputs; ++i) result_.inputs[i] = rows_.at(i, row);
  }
  // The result; inputs that move no loop are where the last row reached has them.
  Followed ended() {
    const long row = std::min(result_.reached, rows_.rows) - 1;
    for (int i = 0; i < rows_.inputs; ++i)
      if (rows_.still[i] && row >= 0) result_.inputs[i] = rows_.true_at(i, row);
    // the inputs' states are the inputs, whole turns and all
    for (int i = 0; i < rows_.inputs; ++i) result_.state[plan_.column_state[plan_.input_column[i]]] = result_.inputs[i];
    return std::move(result_);
  }
  // The inputs at a row, angles within half a turn.
  std::vector<double> line_start(long row) const {
    std::vector<double> x0(rows_.inputs);
    for (int i = 0; i < rows_.inputs; ++i)
      x0[i] = cyclic_[i] && !rows_.still[i] ? rows_.values[i * rows_.rows + row] : rows_.at(i, row);
    return x0;
  }

  bool direction_from(long row, std::vector<double>* u, int* leading) const {
    return cut_.direction_from(row, u, leading);
  }

  void rest(const Piece& piece) {
    for (long row = piece.first + 1; row <= piece.last; ++row) {
      for (int s = 0; s < plan_.states; ++s) out_.guess[s * out_.rows + row] = result_.state[s];
      out_.limit[row] = limits_.jump;
      for (std::size_t s = 0; out_.turn && s < result_.turn.size(); ++s)
        out_.turn[s * out_.rows + row] = result_.turn[s];
    }
    std::fill(result_.direction.begin(), result_.direction.end(), 0.0);
    result_.reached = piece.last + 1;
  }

  // Places of rows on a straight way: whole turns of the leading input, none where it does not turn for ever, and the rest.
  struct Places {
    std::vector<long> turn;
    std::vector<double> rest;
  };
  // Of rows (first, last], from `first` on.
  Places places_of(long first, long last, int leading, double sense) const {
    const long count = last - first;
    Places places = {std::vector<long>(cyclic_[leading] ? count : 0), std::vector<double>(count)};
    const double from = rows_.at(leading, first);
    if (!cyclic_[leading]) {
      rows_.each(leading, first + 1, last + 1, [&](long row, double x) {
        return places.rest[row - first - 1] = std::fabs(x - from), true;
      });
      return places;
    }
    const double *value = rows_.values + leading * rows_.rows, *whole = rows_.whole + leading * rows_.rows;
    for (long k = 0; k < count; ++k) {
      const long row = first + 1 + k;
      places.rest[k] = sense * (value[row] - value[first]), places.turn[k] = (long)(sense * (whole[row] - whole[first]));
      if (places.rest[k] < 0.0) places.rest[k] += FULL_TURN, --places.turn[k];
    }
    return places;
  }

  bool line(long first, long last, bool alone = false) {
    int leading = 0;
    direction_from(first, &result_.direction, &leading);
    const std::vector<double> u = result_.direction, origin = line_start(first);
    const Places places = places_of(first, last, leading, u[leading]);
    if (orbit_ && !stays_on_orbit(first, last)) orbit_.reset();
    if (orbit_ && !alone) return go_round(first, last);
    std::vector<double> x0 = origin;
    long row = first + 1;
    for (long turn = 0;; ++turn) {
      long stop = places.turn.empty() ? last + 1 : row;
      while (stop <= last && places.turn[stop - first - 1] <= turn) ++stop;
      const double* const sigma = places.rest.data() + (row - first - 1);
      const bool goes_on = stop <= last;
      const bool records = goes_on && !alone && (turn == 0 || (orbit_ && orbit_->records()));
      const double end = goes_on ? FULL_TURN : places.rest.back();
      std::vector<Segment> kept;
      const Track track = follow_line(plan_, unit_, x0.data(), u.data(), stop - row, sigma, end,
                                      result_.state.data(), result_.turn, limits_, out_, row,
                                      records ? &kept : nullptr);
      const auto true_inputs = [&](double place, std::vector<double> inputs) {
        inputs.resize(rows_.inputs);
        for (int i = 0; i < rows_.inputs; ++i)
          if (cyclic_[i]) inputs[i] = rows_.at(i, first) + u[i] * (FULL_TURN * turn + place);
        return inputs;
      };
      adopt(track, row - 1, stop - 1, origin);
      if (result_.steps > MOST_PATH_STEPS && result_.end == TrackEnd::finished) result_.end = TrackEnd::exhausted;
      if (track.end == TrackEnd::start_not_closed)
        for (int i = 0; i < rows_.inputs; ++i) result_.inputs[i] = rows_.at(i, first) + u[i] * (FULL_TURN * turn);
      else
        result_.inputs = true_inputs(track.last.sigma, result_.inputs);
      for (Node* node : {&result_.limit.at, &result_.limit.beyond})
        if (!node->inputs.empty()) node->inputs = true_inputs(node->sigma, node->inputs);
      for (double place : track.crossings) {
        std::vector<double> inputs = x0;
        for (int i = 0; i < rows_.inputs; ++i) inputs[i] += place * u[i];
        note_crossing(true_inputs(place, inputs), place, sigma, row - 1, stop - 1);
      }
      if (result_.end != TrackEnd::finished) return false;
      row = stop;
      if (!goes_on) break;
      bool back = true;
      for (int i = 0; i < rows_.inputs; ++i) {
        if (i == leading || u[i] == 0.0) continue;
        x0[i] = origin[i] + u[i] * (FULL_TURN * (turn + 1));
        if (cyclic_[i]) x0[i] -= FULL_TURN * std::rint(x0[i] / FULL_TURN);
        const double off = std::fabs(x0[i] - origin[i]);
        back = back && cyclic_[i] && std::fmin(off, std::fabs(off - FULL_TURN)) <= Orbit::SAME_PLACE;
      }
      if (!records || kept.empty()) continue;
      const Line standing(plan_, origin.data(), u.data());
      const Stepper stepper(standing, unit_, limits_);
      if (turn == 0)
        orbit_.emplace(stepper, kept.front().from, leading, u[leading], rows_.whole[leading * rows_.rows + first]),
            orbit_begin_ = first;
      orbit_->add_turn(std::move(kept), track.last, back);
      if (!orbit_->complete()) continue;
      go_round(first, last), before_orbit(first);
      if (std::count(u.begin(), u.end(), 0.0) < rows_.inputs - 1) orbit_.reset();
      return true;
    }
    if (orbit_ && orbit_->repeats_some()) fill_from_orbit(first, last);
    orbit_.reset();
    return true;
  }

  // Whether rows [first, last] go round on the orbit alone: its leading input moves, and no other has since.
  bool stays_on_orbit(long first, long last) const {
    if (first < orbit_begin_) return false;
    for (int i = 0; i < rows_.inputs; ++i) {
      if (i == orbit_->leading() || rows_.still[i]) continue;
      for (long row : {first, last})
        if (line_start(row)[i] != orbit_->inputs()[i]) return false;
    }
    return true;
  }
  // Guesses of rows [first, last] by the orbit.
  void fill_from_orbit(long first, long last) {
    const int leading = orbit_->leading();
    const Line standing(plan_, orbit_->inputs().data(), result_.direction.data());
    const Stepper stepper(standing, unit_, limits_);
    std::vector<Orbit::Place> places;
    places.reserve(last - first + 1);
    for (long row = first; row <= last; ++row) {
      const long k = leading * rows_.rows + row;
      places.push_back(orbit_->place(rows_.values[k], rows_.whole[k]));
    }
    orbit_->fill(stepper, places, first, out_);
  }
  bool go_round(long first, long last) {
    fill_from_orbit(first, last);
    for (int s = 0; s < plan_.states; ++s) result_.state[s] = out_.guess[s * out_.rows + last];
    for (std::size_t s = 0; s < result_.turn.size(); ++s) result_.turn[s] = out_.turn[s * out_.rows + last];
    place_inputs(last);
    result_.reached = last + 1, result_.end = TrackEnd::finished;
    return true;
  }
  // Rows before the first turn that lie on it, too.
  void before_orbit(long first) {
    const auto is_held = [&](long row) {
      for (int i = 0; i < rows_.inputs; ++i)
        if (i != orbit_->leading() && rows_.at(i, row) != rows_.at(i, row + 1)) return false;
      return true;
    };
    long row = first;
    while (row > 0 && is_held(row - 1)) --row;
    if (row < first) fill_from_orbit(row, first - 1);
  }
  // The end of a way along rows (first, last]; whether it reached the last.
  bool adopt(const Track& track, long first, long last, const std::vector<double>& origin) {
    // a row that is no number ends nothing, and is not reached either
    const bool missed = track.end == TrackEnd::finished && track.reached < last - first;
    result_.end = missed ? TrackEnd::stalled : track.end;
    result_.steps += track.steps, result_.rejected += track.rejected;
    result_.reached = first + 1 + track.reached;
    // only what stops a track has a limit, whose nodes take long to copy
    if (track.limit.kind != PassageEnd::lost) result_.limit = track.limit;
    if (track.end == TrackEnd::start_not_closed)
      result_.inputs = origin;
    else
      take(track.last);
    return result_.end == TrackEnd::finished;
  }
  // A branch point that was passed at a place of the way along rows (first, last], whose places are `sigma`.
  void note_crossing(const std::vector<double>& inputs, double place, const double* sigma, long first, long last) {
    const long behind = std::upper_bound(sigma, sigma + (last - first), place) - sigma;
    result_.crossings.push_back(inputs), result_.crossed_before.push_back(first + 1 + behind);
  }
  void take(const Node& node) {
    result_.inputs = node.inputs, result_.state = node.state, result_.turn = node.turn;
  }

  // Rows (first, last] of a piece of the course, all in one way or each for itself.
  bool along_course(const Piece& piece, bool every_row) {
    orbit_.reset();
    const long count = piece.last - piece.first + 1;
    std::vector<double> sigma(count), inputs(count * rows_.inputs);
    for (long row = piece.first; row <= piece.last; ++row) {
      sigma[row - piece.first] = course_->sigma_of_row(piece.number, row);
      for (int i = 0; i < rows_.inputs; ++i) inputs[i * count + row - piece.first] = rows_.true_at(i, row);
    }
    const CoursePath path(plan_, *course_, piece.number, {sigma.data(), count, inputs.data(), count});
    PathPoint point;
    for (long first = piece.first, last = first; first < piece.last; first = last) {
      last = every_row ? first + 1 : piece.last;
      const double begin = sigma[first - piece.first], *const places = &sigma[first + 1 - piece.first];
      std::vector<double> origin(rows_.inputs);
      for (int i = 0; i < rows_.inputs; ++i) origin[i] = rows_.at(i, first);
      const Track track = follow_path(path, unit_, begin, last - first, places, sigma[last - piece.first],
                                      result_.state.data(), result_.turn, limits_, out_, first + 1);
      const bool on = adopt(track, first, last, origin);
      for (double place : track.crossings) {
        path.at(place, &point);
        note_crossing(point.inputs, place, places, first, last);
      }
      const double end = track.last.state.empty() ? begin : track.last.sigma;
      path.at(end, &point);
      double size = 0.0;
      for (double part : point.first) size = std::fmax(size, std::fabs(part));
      for (int i = 0; i < rows_.inputs; ++i) result_.direction[i] = size > 0.0 ? point.first[i] / size : 0.0;
      if (on) continue;
      const bool known = track.limit.kind != PassageEnd::lost;
      result_.piece = piece.number, result_.parameter = course_->parameter(piece.number, known ? track.limit.at.sigma : end);
      return false;
    }
    return true;
  }

  bool curve(const Piece& piece) {
    for (long first = piece.first, last = first; first < piece.last; first = last) {
      for (last = first + 1; last < piece.last && rows_.turn_cosine(last) >= limits_.corner_cosine;) ++last;
      if (!(last == first + 1 ? line(first, last) : stretch(first, last))) return false;
    }
    return true;
  }

  // Rows (first, last] without a corner between them.
  bool stretch(long first, long last) {
    orbit_.reset();
    RowCurve path(plan_, rows_, first, last, limits_.knot);
    Stepper stepper(path, unit_, limits_);
    Node node, next;
    long row = first;
    bool placed = false;  // whether `node` stands at `row`
    double h = limits_.longest_step;
    // tries from one row; lengths that overflow would let a step be tried for ever
    for (long tries = 0; row < last; ++tries) {
      if (!placed && tries <= limits_.most_steps) {
        placed = stepper.close(path.length(row), result_.state.data(), &node);
        if (placed && !result_.turn.empty()) adopt_turns(stepper, result_.turn, &node), stepper.reduce(&node);
        const double wanted = placed ? stepper.wanted_step(node) : h;
        if (wanted < 0.5 * h) {
          // the derivatives were read over too long a way
          h = wanted, placed = false;
          path.read_for_step(h);
          continue;
        }
        h = std::fmin(h, wanted);
      }
      const long target = placed ? std::min(last, path.row_before(node.sigma + h)) : row;
      const bool tired = tries > limits_.most_steps;
      const bool good = !tired && target > row && step(stepper, path, node, target, &next);
      if (good) {
        const double taken = next.sigma - node.sigma;
        infill(stepper, node, next, path.lengths(row + 1), row + 1, target + 1, out_);
        if (out_.turn) stepper.reduce(&next);
        std::swap(node, next);
        take(node);
        row = target, result_.reached = row + 1, ++result_.steps, tries = 0;
        h = std::fmin(stepper.wanted_step(node), 4.0 * taken);
        path.read_for_step(h);
      } else if (!tired && target > row + 1) {
        h = 0.5 * (path.length(target) - node.sigma);
        h = std::fmax(h, path.length(row + 1) - node.sigma), ++result_.rejected;
        path.read_for_step(h), placed = false;
      } else {
        if (!line(row, row + 1)) return false;
        ++row, tries = 0, placed = false, h = 4.0 * (path.length(row) - path.length(row - 1));
      }
    }
    int leading = 0;
    direction_from(last - 1, &result_.direction, &leading);
    return true;
  }

  bool step(Stepper& stepper, const RowCurve& path, const Node& node, long target, Node* next) const {
    if (!stepper.step(node, path.length(target) - node.sigma, path.length(target), next)) return false;
    const double h = next->sigma - node.sigma;
    if (!continue_turns(stepper, node, next) && h > limits_.angle_step) return false;
    const long begin = path.row_before(node.sigma) + 1;
    if (begin > target) return false;  // lengths that overflow are in no order
    const long count = target - begin;
    std::vector<double> inputs(count * rows_.inputs);
    for (int i = 0; i < rows_.inputs; ++i)
      for (long k = 0; k < count; ++k) inputs[i * count + k] = rows_.at(i, begin + k);
    return stray(stepper, node, *next, path.lengths(begin), count, inputs.data(), count) <= limits_.stray * h;
  }

  const Plan& plan_;
  const KernelUnit& unit_;
  const InputRows& rows_;
  const StepLimits& limits_;
  const RowGuesses& out_;
  const Course* course_;
  RowPieces cut_;
  Followed result_;
  std::vector<char> cyclic_;      // inputs whose angles are reduced
  std::optional<Orbit> orbit_;    // of the turns that came last
  long orbit_begin_ = 0;          // row where its first turn began
};

}  // namespace

Followed follow_rows(const Plan& plan, const KernelUnit& unit, const double* inputs, const double* whole,
                     const double* start,
                     const std::vector<double>& turn, bool every_row, const StepLimits& limits,
                     const RowGuesses& out, const Course* course) {
  const InputRows rows = {inputs, whole, plan.inputs, out.rows, still_inputs(plan)};
  return RowFollower(plan, unit, rows, limits, out, course).follow(start, turn, every_row);
}
