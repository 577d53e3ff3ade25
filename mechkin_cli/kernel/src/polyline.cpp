// Following rows whose inputs move along any path.
//
// Rows in one line make a run, which is followed as a line with nodes anywhere on it. Between such runs the rows are
// taken for points of a smooth curve as long as the path turns little from row to row: nodes stand at rows, as far
// apart as the branch's bend allows, and the rows between are filled in where they lie on the curve between two nodes.
// Where the path has a corner or the branch bends too much between two rows, the chord is followed as a line. The work
// is linear in the rows: each row is looked at a bounded number of times.
#include <algorithm>
#include <cmath>

#include "row_curve.hpp"
#include "tracker.hpp"

namespace {

enum class Way { rest, line, curve, course };

constexpr double ROUNDING = 0x1p-50;  // some units in the last place

// Rows (first, last] that are reached one way from row `first`.
struct Piece {
  Way way;
  long first, last;
  long number = -1;  // of the course's piece
};

class RowFollower {
 public:
  RowFollower(const Plan& plan, const KernelUnit& unit, const InputRows& rows, const StepLimits& limits,
              const RowGuesses& out, const Course* course)
      : plan_(plan), unit_(unit), rows_(rows), limits_(limits), out_(out), course_(course), scale_(rows.inputs, 0.0),
        result_{TrackEnd::finished, 1, 0, 0, {}, {}, {}, std::vector<double>(rows.inputs, 0.0), {}, {}, {}} {
    for (int i = 0; i < rows.inputs; ++i)
      for (long r = 0; r < rows.rows; ++r) scale_[i] = std::fmax(scale_[i], std::fabs(rows.at(i, r)));
  }

  Followed follow(const double* start, const std::vector<double>& turn, bool every_row) {
    result_.state.assign(start, start + plan_.states), result_.turn = turn;
    for (int s = 0; s < plan_.states; ++s) out_.guess[s * out_.rows] = start[s];
    out_.limit[0] = limits_.jump;
    if (!place_start()) return result_;
    for (const Piece& piece : pieces(every_row)) {
      if (piece.way == Way::rest) rest(piece);
      if (piece.way == Way::line && !line(piece.first, piece.last)) return result_;
      if (piece.way == Way::curve && !curve(piece)) return result_;
      if (piece.way == Way::course && !along_course(piece, every_row)) return result_;
    }
    place_inputs(rows_.rows - 1);
    return result_;
  }

 private:
  // The closing joints' turns at the first row, where they are asked for.
  bool place_start() {
    if (!out_.turn) return true;
    place_inputs(0);
    const Line standing(plan_, result_.inputs.data(), result_.direction.data());
    Stepper stepper(standing, unit_, limits_);
    Node node;
    if (!stepper.close(0.0, result_.state.data(), &node)) {
      result_.end = TrackEnd::start_not_closed;
      return false;
    }
    if (!result_.turn.empty()) adopt_turns(stepper, result_.turn, &node);
    result_.turn = node.turn;
    for (int s = 0; s < stepper.turn_slots(); ++s) out_.turn[s * out_.rows] = node.turn[s];
    return true;
  }
  void place_inputs(long row) {
    result_.inputs.resize(rows_.inputs);
    for (int i = 0; i < rows_.inputs; ++i) result_.inputs[i] = rows_.at(i, row);
  }

  // Direction from a row to the next, its largest part 1 (or -1), and which part that is; false where they coincide but
  // for roundings of the inputs, which are no way to go.
  bool direction_from(long row, std::vector<double>* u, int* leading) const {
    u->assign(rows_.inputs, 0.0), *leading = 0;
    double size = 0.0;
    bool moves = false;
    for (int i = 0; i < rows_.inputs; ++i) {
      (*u)[i] = rows_.at(i, row + 1) - rows_.at(i, row);
      moves = moves || !(std::fabs((*u)[i]) <= ROUNDING * scale_[i]);
      if (std::fabs((*u)[i]) > size) size = std::fabs((*u)[i]), *leading = i;
    }
    if (size == 0.0 || !moves) return false;
    for (double& part : *u) part /= size;
    return true;
  }

  // The last row that lies on the straight way from `first` through the row after it.
  long end_of_line(long first, long end, const std::vector<double>& u, int leading) const {
    double before = 0.0;
    long row = first + 1;
    for (; row <= end; ++row) {
      const double along = (rows_.at(leading, row) - rows_.at(leading, first)) * u[leading];
      bool onward = along > before;
      for (int i = 0; onward && rows_.inputs > 1 && i < rows_.inputs; ++i) {
        const double off = rows_.at(i, row) - (rows_.at(i, first) + u[i] * along);
        onward = std::fabs(off) <= limits_.same_line * (1.0 + scale_[i]);
      }
      if (!onward) break;
      before = along;
    }
    return std::max(row - 1, first + 1);
  }

  std::vector<Piece> pieces(bool every_row) const {
    std::vector<Piece> found;
    std::vector<double> u;
    int leading = 0;
    long next = 0;  // piece of the course
    const long courses = course_ ? (long)course_->pieces().size() : 0;
    for (long first = 0, last = 0; first + 1 < rows_.rows; first = last) {
      if (next < courses && course_->pieces()[next].first == first) {
        last = course_->pieces()[next].last;
        found.push_back({Way::course, first, last, next});
        ++next;
        continue;
      }
      last = first + 1;
      Way way = Way::rest;
      if (direction_from(first, &u, &leading)) {
        const long end = next < courses ? course_->pieces()[next].first : rows_.rows - 1;
        if (!every_row) last = end_of_line(first, end, u, leading);
        const bool whole = first == 0 && last == rows_.rows - 1;
        const bool far = last > first + 1 && rows_.distance(first, last) >= limits_.knot;
        way = every_row || whole || far || rows_.inputs == 1 ? Way::line : Way::curve;
      }
      if (way == Way::curve && !found.empty() && found.back().way == Way::curve)
        found.back().last = last;
      else
        found.push_back({way, first, last});
    }
    return found;
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

  bool line(long first, long last) {
    int leading = 0;
    direction_from(first, &result_.direction, &leading);
    std::vector<double> origin(rows_.inputs), sigma(last - first);
    for (int i = 0; i < rows_.inputs; ++i) origin[i] = rows_.at(i, first);
    for (long row = first + 1; row <= last; ++row)
      sigma[row - first - 1] = std::fabs(rows_.at(leading, row) - origin[leading]);
    const Track track = follow_line(plan_, unit_, origin.data(), result_.direction.data(), last - first, sigma.data(),
                                    result_.state.data(), result_.turn, limits_, out_, first + 1);
    for (double place : track.crossings) {
      std::vector<double> inputs = origin;
      for (int i = 0; i < rows_.inputs; ++i) inputs[i] += place * result_.direction[i];
      note_crossing(inputs, place, sigma.data(), first, last);
    }
    return adopt(track, first, last, origin);
  }
  // The end of a way along rows (first, last]; whether it reached the last.
  bool adopt(const Track& track, long first, long last, const std::vector<double>& origin) {
    // a row that is no number ends nothing, and is not reached either
    const bool missed = track.end == TrackEnd::finished && track.reached < last - first;
    result_.end = missed ? TrackEnd::stalled : track.end;
    result_.steps += track.steps, result_.rejected += track.rejected;
    result_.reached = first + 1 + track.reached;
    result_.limit = track.limit;
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
    std::vector<double> sigma(piece.last - piece.first + 1);
    for (long row = piece.first; row <= piece.last; ++row)
      sigma[row - piece.first] = course_->sigma_of_row(piece.number, row);
    const CoursePath path(plan_, *course_, piece.number,
                          {sigma.data(), (long)sigma.size(), rows_.values + piece.first, rows_.rows});
    PathPoint point;
    for (long first = piece.first, last = first; first < piece.last; first = last) {
      last = every_row ? first + 1 : piece.last;
      const double begin = sigma[first - piece.first], *const places = &sigma[first + 1 - piece.first];
      std::vector<double> origin(rows_.inputs);
      for (int i = 0; i < rows_.inputs; ++i) origin[i] = rows_.at(i, first);
      const Track track = follow_path(path, unit_, begin, last - first, places, result_.state.data(), result_.turn,
                                      limits_, out_, first + 1);
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
        if (placed && !result_.turn.empty()) adopt_turns(stepper, result_.turn, &node);
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
    return stray(stepper, node, *next, path.lengths(begin), target - begin, rows_.values + begin, rows_.rows) <=
           limits_.stray * h;
  }

  const Plan& plan_;
  const KernelUnit& unit_;
  const InputRows& rows_;
  const StepLimits& limits_;
  const RowGuesses& out_;
  const Course* course_;
  std::vector<double> scale_;
  Followed result_;
};

}  // namespace

Followed follow_rows(const Plan& plan, const KernelUnit& unit, const double* inputs, const double* start,
                     const std::vector<double>& turn, bool every_row, const StepLimits& limits,
                     const RowGuesses& out, const Course* course) {
  const InputRows rows = {inputs, plan.inputs, out.rows};
  return RowFollower(plan, unit, rows, limits, out, course).follow(start, turn, every_row);
}
