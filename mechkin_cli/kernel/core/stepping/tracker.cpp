#include "stepping/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace {

// Rounding of a dead centre's place in parts of max(1, |sigma|): a row so near lies on it.
constexpr double ON_DEAD_CENTRE = 1e-14;
// What may be left of a way after whole turns of written numbers, in parts of the largest state (threads count their
// turns): steps so short are no longer than what rounding corrects.
constexpr double AT_END = 1e-12;
// The rounding of a branch point's place, which is extrapolated: a row so near has no branch of its own.
constexpr double ON_BRANCH_POINT = 1e-11;
// How near steps as short as they may be come to a place that ends a branch: the root of the square of a pivot.
constexpr double NEAR_LIMIT = 1e-10;

// A step (rad, length units of the inputs) across a jump of a function's slope: beside it rounding and curvature are as small.
constexpr double KINK_STEP = 1e-7;
// What a step across it may differ from the two tangents, in parts of these.
constexpr double KINK_MISS = 1e-4;
// Halvings down to it, and steps between them, are fewer.
constexpr int KINK_TRIES = 200;

// The first of the steps that are closed ahead, in parts of the step behind: extrapolation tells no longer ones. Those
// after it grow as steps do that have no dead centre near.
constexpr double AHEAD_FIRST = 2.0;
constexpr double AHEAD_GROWTH = 1.15;
// What such a step may be, in parts of the one that is wanted once the node before it is known: not so long that it would
// be refused, which is a quarter more than wanted; not so short that there are many more steps.
constexpr double AHEAD_LONGER = 1.2;
constexpr double AHEAD_SHORTER = 0.6;

// Whether functions of a plan choose: their slopes may jump.
bool has_kinks(const FunctionTable& functions) {
  const std::uint8_t* const end = functions.operation + functions.instructions;
  return std::any_of(functions.operation, end, [](std::uint8_t operation) {
    switch (operation) {
      case TAPE_MAGNITUDE:
      case TAPE_SIGN:
      case TAPE_LARGER:
      case TAPE_SMALLER:
      case TAPE_WHOLE:
      case TAPE_CHOOSE: return true;
      default: return false;
    }
  });
}

// Where between two near nodes the branch turns from the tangent of the first into that of the second, in parts of the step
// h; -1 where it does not, or where a determinant changes its sign: there the two tangents lead away from one another.
double turning_place(const Node& a, const Node& b, double h) {
  if (a.side != b.side) return -1.0;
  double along = 0.0, square = 0.0, size = 0.0;
  for (std::size_t s = 0; s < a.state.size(); ++s) {
    const double turn = a.state_first[s] - b.state_first[s], way = (b.state[s] - a.state[s]) / h - b.state_first[s];
    along += turn * way, square += turn * turn;
    size += a.state_first[s] * a.state_first[s] + b.state_first[s] * b.state_first[s];
  }
  const double least = KINK_MISS * std::sqrt(size);
  if (!(std::sqrt(square) > least)) return -1.0;
  const double part = along / square;
  double off = 0.0;
  for (std::size_t s = 0; s < a.state.size(); ++s) {
    const double slope = part * a.state_first[s] + (1.0 - part) * b.state_first[s];
    const double miss = (b.state[s] - a.state[s]) / h - slope;
    off += miss * miss;
  }
  const bool between = part >= -KINK_MISS && part <= 1.0 + KINK_MISS && std::sqrt(off) <= least;
  return between ? std::fmin(std::fmax(part, 0.0), 1.0) : -1.0;
}

// Whether the inputs between two nodes are where the nodes' derivatives say: what the path does between them is seen.
bool sees_between(const Path& path, const Stepper& stepper, const Node& a, const Node& b) {
  if (path.is_straight()) return true;
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

// A walk along one path: careful steps while they are long, by arclength where they are refused (passage.hpp).
class Tracker {
 public:
  Tracker(const Path& path, const KernelUnit& unit, long rows, const double* sigma, const StepLimits& limits,
          const RowGuesses& out, long first, std::vector<Segment>* kept)
      : path_(path), unit_(unit), rows_(rows), sigma_(sigma), limits_(limits), out_(out), first_(first),
        kept_(kept), stepper_(path, unit, limits), progress_(limits),
        track_{TrackEnd::finished, 0, 0, 0, {}, 0.0, {}, {}}, has_kinks_(has_kinks(stepper_.plan().functions)) {}

  Track follow(double begin, double end, const double* start, const std::vector<double>& turn) {
    if (!stepper_.close(begin, start, node_)) {
      track_.end = TrackEnd::start_not_closed;
      return std::move(track_);
    }
    if (!turn.empty()) adopt_turns(stepper_, turn, node_);
    reduce(node_);
    for (; row_ < rows_ && sigma_[row_] <= begin; ++row_) put_row(*node_, limits_.jump, first_ + row_, out_);
    end_ = end;
    step_ = stepper_.wanted_step(*node_);
    // longest steps alone would be too many
    if (!(end_ - begin <= MOST_PATH_STEPS * limits_.longest_step)) track_.end = TrackEnd::exhausted;
    while (track_.end == TrackEnd::finished && node_->sigma < end_ && go_on()) {
    }
    track_.reached = row_;
    track_.last = std::move(*node_);
    return std::move(track_);
  }

 private:
  bool stop(TrackEnd end, double refused) {
    track_.end = end, track_.refused_step = refused;
    // what was seen ahead ended the branch only if it came there
    for (const Limit& seen : seen_)
      if (refused > 0.0 && std::fabs(seen.at.sigma - node_->sigma) <= NEAR_LIMIT) track_.limit = seen;
    return false;
  }

  bool go_on() {
    if (!progress_.goes_on(node_->sigma)) return stop(TrackEnd::exhausted, 0.0);
    const double least = limits_.least_step * std::fmax(1.0, std::fabs(node_->sigma));
    if (end_ - node_->sigma <= AT_END * largest()) return arrive();
    // the last step ends exactly on the last row
    // a rest of a millionth of a step is taken along
    const bool last = node_->sigma + 1.000001 * step_ >= end_;
    const double h = last ? end_ - node_->sigma : step_;
    if (!last && h < least) return stop(TrackEnd::stalled, h);
    if (h * speed() < limits_.narrow && !last && looks()) return look();
    if (ahead_.any() && !suits(ahead_.node[ahead_.next]->sigma - node_->sigma, h)) ahead_.clear();
    if (!ahead_.any() && !last && looks_ahead(h)) close_ahead(h);
    const bool is_ahead = ahead_.any(), is_told = is_ahead && ahead_.next > 0;
    Node*& next = is_ahead ? ahead_.node[ahead_.next] : spare_;
    if (is_ahead ? steps_ahead() : steps_to(*node_, h, last ? end_ : node_->sigma + h, next)) {
      const double taken = is_ahead ? next->sigma - node_->sigma : h;
      ahead_.next += is_ahead;
      advance(next);
      step_ = std::fmin(stepper_.wanted_step(*node_), 4.0 * taken);
      looks_ = looks_ || step_ * speed() >= limits_.narrow;
      return true;
    }
    if (is_ahead) ahead_.clear();
    // what was extrapolated too far says nothing
    if (is_told) return true;
    ++track_.rejected;
    step_ = 0.5 * h;
    if (has_kinks_ && looks_ && step_ * speed() < limits_.narrow && over_kink(h)) return true;
    if (looks() && step_ * speed() < limits_.narrow) return look();
    return step_ >= least || stop(TrackEnd::stalled, h);
  }

  // Whether a node ahead is about as far away as a step should be.
  static bool suits(double way, double h) { return way <= AHEAD_LONGER * h && way >= AHEAD_SHORTER * h; }
  // Whether the steps that follow are told well enough by the way behind to be closed at once.
  bool looks_ahead(double h) {
    if (!has_before_ || has_kinks_ || path_.varies() || plan().blocks == 0) return false;
    return h <= AHEAD_FIRST * (node_->place - before_->place);
  }
  void close_ahead(double h) {
    double sigma[NodesAhead::MOST], at = node_->sigma;
    const double growth = std::fmin(std::fmax(h / (node_->place - before_->place), AHEAD_SHORTER), AHEAD_GROWTH);
    int count = 0;
    for (double step = h; count < NodesAhead::MOST && at < end_; step *= growth) {
      if (count && step * speed() < limits_.narrow) break;
      at = at + 1.000001 * step >= end_ ? end_ : at + step;
      sigma[count++] = at;
    }
    stepper_.close_ahead(*before_, *node_, sigma, count, &ahead_);
  }
  bool steps_ahead() {
    Node* const next = ahead_.node[ahead_.next];
    next->least = HUGE_VAL;
    return stepper_.judge_ahead(*node_, &ahead_) &&
           (continue_turns(stepper_, *node_, next) || next->sigma - node_->sigma <= limits_.angle_step) &&
           sees_between(path_, stepper_, *node_, *next);
  }

  bool steps_to(const Node& from, double h, double sigma, Node* next) {
    next->least = HUGE_VAL;
    return stepper_.step(from, h, sigma, next) && (continue_turns(stepper_, from, next) || h <= limits_.angle_step) &&
           sees_between(path_, stepper_, from, *next);
  }
  // Goes on to a node, with the rows before it; the one whose room is free takes its place.
  void advance(Node*& next) {
    ++track_.steps;
    const long from = row_;
    while (row_ < rows_ && sigma_[row_] <= next->sigma) ++row_;
    infill(stepper_, *node_, *next, sigma_ + from, first_ + from, first_ + row_, out_, nullptr,
           has_before_ && goes_straight_through() ? before_ : nullptr);
    go_to(next);
  }
  // Whether this is the way of all rows. Ways of several, which may come by equal inputs, go by the two nodes about a row
  // alone, whatever led there.
  bool goes_straight_through() const { return !kept_ && first_ <= 1 && first_ + rows_ == out_.rows; }
  void go_to(Node*& next) {
    if (kept_) keep(*next);
    for (const TreeTurn& t : stepper_.tree_turns()) {
      const double whole = out_.turn ? std::rint(next->state[t.state] / FULL_TURN) : 0.0;
      for (int k = ahead_.next; whole != 0.0 && k < ahead_.count; ++k)
        ahead_.node[k]->state[t.state] -= FULL_TURN * whole;
    }
    reduce(next);
    Node* const free = before_;
    before_ = node_, node_ = next, next = free;
    has_before_ = true;
  }

  // Over a place within a refused step at which the slope of a function jumps, if that is what refuses it: steps up to it, and
  // one across. Rows within that one are closed from the tangent of their side. Without such a place nothing is changed.
  bool over_kink(double h) {
    std::vector<Node> way;
    for (int tries = 0; h * speed() > KINK_STEP; ++tries) {
      const Node& from = way.empty() ? *node_ : way.back();
      Node next;
      if (tries >= KINK_TRIES || !(from.sigma + 0.5 * h < end_)) return false;
      if (steps_to(from, 0.5 * h, from.sigma + 0.5 * h, &next))
        way.push_back(std::move(next));
      else
        h *= 0.5;
    }
    const Node before = way.empty() ? *node_ : way.back();
    const double sigma = std::fmin(before.sigma + 2.0 * h, end_), step = sigma - before.sigma;
    Node behind;
    std::vector<double> guess;
    stepper_.predict(before, step, &guess);
    if (!(step > 0.0) || !stepper_.close_after(step, sigma, guess.data(), &behind)) return false;
    const double part = turning_place(before, behind, step);
    if (part < 0.0 || !(continue_turns(stepper_, before, &behind) || step <= limits_.angle_step)) return false;
    std::vector<Node> row;
    for (long k = row_; k < rows_ && sigma_[k] <= sigma; ++k) {
      if (sigma_[k] <= before.sigma) continue;
      const bool first = sigma_[k] - before.sigma < part * step;
      stepper_.predict(first ? before : behind, sigma_[k] - (first ? before : behind).sigma, &guess);
      row.emplace_back();
      if (!stepper_.close_after(step, sigma_[k], guess.data(), &row.back())) return false;
      adopt_turns(stepper_, behind.turn, &row.back());
    }
    for (Node& each : way) {
      *spare_ = std::move(each);
      advance(spare_);
    }
    ++track_.steps;
    for (Node& at : row) {
      reduce(&at);
      put_row(at, limits_.jump, first_ + row_++, out_);
    }
    *spare_ = std::move(behind);
    go_to(spare_);
    has_before_ = false;
    step_ = stepper_.wanted_step(*node_);
    return true;
  }

  // What is left of the way is a rounding, as it is of a whole turn: no step is that short.
  bool arrive() {
    const double limit = std::fmin(limits_.jump, 0.125 * node_->least);
    for (; row_ < rows_ && sigma_[row_] <= end_; ++row_) put_row(*node_, limit, first_ + row_, out_);
    node_->sigma = end_;
    return false;
  }

  // The largest number of the node that rounds: its place on the path, or a state.
  double largest() const {
    double most = std::fmax(1.0, std::fabs(node_->sigma));
    for (double state : node_->state) most = std::fmax(most, std::fabs(state));
    return most;
  }

  // The tree's angles within half a turn, where their turns are counted.
  void reduce(Node* node) const {
    if (out_.turn) stepper_.reduce(node);
  }
  void keep(const Node& next) {
    kept_->push_back({*node_, next});
    // rows need no Jacobians, which are the largest part of a node
    for (Node* node : {&kept_->back().from, &kept_->back().to}) node->jacobian.resize(0), node->factored = {};
  }
  bool looks() const { return looks_ && !path_.varies() && plan().blocks > 0; }
  const Plan& plan() const { return stepper_.plan(); }
  // Speed of the inputs along the path at the node.
  double speed() const {
    double square = 0.0;
    for (int i = 0; i < plan().inputs; ++i) {
      const double rate = node_->first[plan().input_column[i]];
      square += rate * rate;
    }
    return square > 0.0 ? std::sqrt(square) : 1.0;
  }

  // What refuses the steps, by arclength.
  bool look() {
    has_before_ = false, ahead_.clear();
    const Stretch stretch = walk_stretch(path_, unit_, limits_, *node_, step_, end_);
    track_.steps += stretch.steps, track_.rejected += stretch.rejected;
    const PassageEnd kind = stretch.end();
    const bool ends = kind == PassageEnd::dead_centre || kind == PassageEnd::branch_point;
    if (stretch.last().unbounded) {
      *node_ = stretch.last().nodes.back();
      return stop(TrackEnd::stalled, 0.0);
    }
    note_ends(stretch);
    if (!stretch.carries_all(plan().blocks)) {
      // blocks that nobody carried are followed by steps as short as it takes, and what was seen ends them
      looks_ = false;
      return true;
    }
    if (!ends && !(stretch.reach() > node_->sigma)) {
      looks_ = false;
      return true;
    }
    const double reach = stretch.reach(), about = std::fmax(1.0, std::fabs(reach));
    const double until = kind == PassageEnd::dead_centre    ? reach + ON_DEAD_CENTRE * about
                         : kind == PassageEnd::branch_point ? reach - ON_BRANCH_POINT * about
                                                            : reach;
    for (; row_ < rows_ && sigma_[row_] <= until; ++row_)
      if (!place_row(stretch, std::fmin(sigma_[row_], reach))) break;
    for (double sigma : stretch.last().crossings) track_.crossings.push_back(sigma);
    if (ends && (row_ < rows_ || until < end_)) {
      track_.limit = limit_of(stretch.last());
      return stop(TrackEnd::stalled, 0.0);
    }
    Node guess, next;
    double limit = 0.0;
    const double target = std::fmin(reach, end_);
    if (!stretch.at(plan(), unit_, stepper_.turns(), target, &guess, &limit)) return stop(TrackEnd::stalled, 0.0);
    if (!stepper_.close(target, guess.state.data(), &next)) {
      if (row_ < rows_) return stop(TrackEnd::stalled, 0.0);
      next = guess, next.sigma = target, next.inputs = node_->inputs;
      path_inputs(target, &next.inputs);
    } else {
      adopt_turns(stepper_, guess.turn, &next);
      for (int b = 0; b < plan().blocks; ++b) {
        const Node& last = stretch.of_block(b).nodes.back();
        next.danger[b] = last.danger[b] / std::fmax(last.rate, 1e-3);
      }
    }
    if (kept_) kept_->clear(), kept_ = nullptr;
    // a way whose last row lies on a dead centre is at its end
    if (ends && until >= end_) next.sigma = end_;
    reduce(&next);
    *node_ = next;
    step_ = stepper_.wanted_step(*node_);
    return true;
  }

  static Limit limit_of(const Passage& p) { return {p.end, p.block, p.nodes.back(), p.beyond}; }
  // Keeps the ends that blocks have ahead, even where another block's walk comes to nothing before.
  void note_ends(const Stretch& stretch) {
    const auto passed = [this](const Limit& seen) { return seen.at.sigma < node_->sigma - NEAR_LIMIT; };
    seen_.erase(std::remove_if(seen_.begin(), seen_.end(), passed), seen_.end());
    for (const Passage& p : stretch.passages)
      if (p.end == PassageEnd::dead_centre || p.end == PassageEnd::branch_point) seen_.push_back(limit_of(p));
  }

  void path_inputs(double sigma, Node::Few* inputs) const {
    PathPoint point;
    path_.at(sigma, &point);
    *inputs = point.inputs;
  }

  bool place_row(const Stretch& stretch, double sigma) {
    Node guess;
    double limit = 0.0;
    if (!stretch.at(plan(), unit_, stepper_.turns(), sigma, &guess, &limit)) return false;
    reduce(&guess);
    put_row(guess, limit, first_ + row_, out_);
    return true;
  }

  const Path& path_;
  const KernelUnit& unit_;
  long rows_;
  const double* sigma_;
  const StepLimits& limits_;
  const RowGuesses& out_;
  long first_;
  std::vector<Segment>* kept_;
  Stepper stepper_;
  Progress progress_;
  Track track_;
  Node nodes_[3];
  Node* node_ = nodes_;
  Node* before_ = nodes_ + 1;  // the node before, where the last step led from there
  Node* spare_ = nodes_ + 2;   // one that was refused, or nothing: its room is used again
  bool has_before_ = false;
  NodesAhead ahead_;
  long row_ = 0;
  double end_ = 0.0, step_ = 0.0;
  std::vector<Limit> seen_;  // ends that were seen ahead
  bool has_kinks_;
  bool looks_ = true;  // whether a refusal is looked into: not again where that led nowhere
};

}  // namespace

Track follow_line(const Plan& plan, const KernelUnit& unit, const double* x0, const double* u, long rows,
                  const double* sigma, double end, const double* start, const std::vector<double>& turn,
                  const StepLimits& limits, const RowGuesses& out, long first, std::vector<Segment>* kept) {
  return follow_path(Line(plan, x0, u), unit, 0.0, rows, sigma, end, start, turn, limits, out, first, kept);
}

Track follow_path(const Path& path, const KernelUnit& unit, double begin, long rows, const double* sigma, double end,
                  const double* start, const std::vector<double>& turn, const StepLimits& limits, const RowGuesses& out,
                  long first, std::vector<Segment>* kept) {
  return Tracker(path, unit, rows, sigma, limits, out, first, kept).follow(begin, end, start, turn);
}
