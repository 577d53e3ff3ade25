// One step along a path of the inputs, or of the plan itself: predict, close, judge.
//
// A path maps a parameter sigma to the inputs and their first and second derivatives by sigma. A node is a place on
// the branch over the path, closed to rounding, with the branch's own derivatives by sigma. Following, dead centres,
// branch points and continuation in a mechanism's dimensions are made of these steps. Where the path itself turns back,
// at a dead centre, the branch goes on in its own arclength (arc.hpp).
#pragma once

#include <vector>

#include "arithmetic/dense.hpp"
#include "arithmetic/numbers.hpp"
#include "rows/unit.hpp"

struct StepLimits {
  double turn_cosine;   // least cosine of the tangent's turn in a step
  double turn;          // wanted turn of the tangent in a step, rad
  double bend;          // wanted ratio of the quadratic to twice the linear part of a step
  double jump;          // largest Newton correction in parts of the step's length
  double infill;        // largest correction of an infilled row in parts of the nodes' distance
  double longest_step;  // largest step, rad or length units of the path
  double least_step;    // smallest step in parts of max(1, |sigma|)
  int most_steps;       // attempts of steps within a longest step's way
  double tight, coarse, accept;  // Newton's tests, see Request
  double pivot;         // least pivot of a node: the tangent next to a singular place is rounding
  double arc_pivot;     // the same of the matrix by arclength, whose derivatives are used to tell a dead centre
  double radius;        // largest spectral radius of J_a^+ J_b - I over a step, and to its middle
  double narrow;        // step (rad, length units of the inputs) below which a refusal is looked into by arclength
  int arc_steps;        // attempts of steps in one such look, at most
  double arc_work;      // likewise their product with the cube of the equations that are walked together
  bool straight;        // whether a branch point is passed along the smooth continuation
  int iterations;
  double same_line;     // distance from a straight line, in parts of the inputs, up to which rows lie on it
  double knot;          // distance (rad, length units) of the rows from which the path's derivatives are read
  double corner_cosine; // cosine of the turn between neighbouring rows from which on the path has a corner
  double stray;         // distance of a row's inputs from the smooth path, in parts of the step
  double angle_step;    // a step longer than this is halved where a closing joint's turns are not sure
  double angle_miss;    // rad: largest change of a closing joint's angle against the integral of its rate
  double angle_bend;    // rad: largest part of that integral by the rate's derivatives that is not looked into
  double plan_step;     // sigma: largest distance of the places from which the derivatives by the plan's change are read
};

// What a path says at one sigma; arrays over the inputs.
struct PathPoint {
  std::vector<double> inputs, first, second;
};

class Path {
 public:
  virtual ~Path() = default;
  virtual void at(double sigma, PathPoint* point) const = 0;
  // The plan at sigma, valid until the next call. Its structure (joints, blocks, unknowns) is the same everywhere; the
  // plan of the first call must outlive the path, for its structure is read later, too.
  virtual const Plan& plan(double sigma) const = 0;
  // Whether the plan's constants change along the path: its derivatives are then read from places nearby,
  // in 0 <= sigma <= 1.
  virtual bool varies() const { return false; }
  // Whether the inputs are linear in sigma, so that the ends of a step tell all of them between.
  virtual bool is_straight() const { return true; }
};

// x0 + sigma u on one plan.
class Line : public Path {
 public:
  Line(const Plan& plan, const double* x0, const double* u) : plan_(plan), x0_(x0), u_(u) {}
  void at(double sigma, PathPoint* point) const override;
  const Plan& plan(double) const override { return plan_; }

 private:
  const Plan& plan_;
  const double *x0_, *u_;
};

struct Node {
  using Few = Numbers<8>;  // of most loops without memory of their own
  double sigma;
  double place;                                   // the parameter that derivatives are by: sigma, or an arclength
  double rate, bend;                              // sigma's derivatives by it: 1 and 0 where it is sigma
  double correction;                              // largest change of an unknown against the guess
  double apart = 0.0;                             // distance of the places from which derivatives by the plan are read
  double least = __builtin_inf();                 // at most the blocks' least singular value; infinite where not looked at
  double own = 0.0, own_second = 0.0;             // sigma's part in the tangent besides the inputs', and its derivative
  Few inputs;
  Few state, first, second;                            // states, columns, columns
  Few state_first, state_second;                  // derivatives of the raw states
  Few side, pivot;                                // blocks: sign of a square block's determinant; least pivot
  Few singular;                                   // blocks: at most the least singular value; infinite where not looked at
  Numbers<36> jacobian;                           // blocks, one after the other, rows x size
  mutable std::vector<Factored> factored;         // blocks: the same with factors, from when they are first asked for
  Matrix extended;                                // by arclength: [J g] of its own equations
  Few danger;                                     // blocks: radius of J^+ J_a - I by a unit of the step that led here from a;
                                                  // about 1 / the distance to a singular place
  // of closing joints, see ClosingTurn, as the kernel has them; then whole turns of the tree's angles, see TreeTurn
  Few turn, turn_first, turn_second;
};

// An unknown angle of the tree that may turn for ever: its state is kept within half a turn, and `slot` of a node's
// turns counts its whole turns. Threads advance with each turn and keep theirs.
struct TreeTurn {
  int state, slot;
};
constexpr double FULL_TURN = 2.0 * 3.14159265358979323846;
// Whether all are integers that doubles count by one.
bool are_whole_turns(const double* numbers, std::size_t count);

// Nodes that were closed before it is known whether steps lead there, one after the other from a node on; the judge's
// Jacobians half way to each from the one before.
class NodesAhead {
 public:
  static constexpr int MOST = 4;  // extrapolation tells no more
  Node* node[MOST] = {nodes_, nodes_ + 1, nodes_ + 2, nodes_ + 3};  // whose places others may take
  std::vector<double> half_way;                                     // Jacobian after Jacobian
  int next = 0, count = 0;                                          // those that are left
  NodesAhead() = default;
  NodesAhead(const NodesAhead&) = delete;
  bool any() const { return next < count; }
  void clear() { next = count = 0; }

 private:
  Node nodes_[MOST];
};

class Stepper {
 public:
  virtual ~Stepper() = default;
  // Path, unit and limits must outlive the stepper, whose workspace points into itself.
  Stepper(const Path& path, const KernelUnit& unit, const StepLimits& limits);
  Stepper(const Stepper&) = delete;

  // Closes the loops at sigma from a guess (states); false if they do not close or a derivative is not finite.
  bool close(double sigma, const double* guess, Node* node) { return close(sigma, guess, limits_.plan_step, node); }
  // The same at the start of a path: next to a fold derivatives by the plan are read from places as near as it takes.
  bool begin(double sigma, const double* guess, Node* node);
  // The same without derivatives: on a fold there are none.
  bool rest(double sigma, const double* guess, Node* node) { return solve(sigma, guess, false, node); }
  // The same with the sides of the blocks.
  bool stand(double sigma, const double* guess, Node* node) { return solve(sigma, guess, true, node); }
  // The same as `close`, with derivatives by the plan from places that suit a step as long as h.
  bool close_after(double h, double sigma, const double* guess, Node* node) {
    return close(sigma, guess, PART_OF_STEP * h, node);
  }
  // Reads a node's derivatives by the plan from places that suit steps as short as h; false as `close`, or where they do.
  bool suit(double h, Node* node);
  // Second-order prediction of the states a step h away; quaternions have unit length.
  void predict(const Node& node, double h, std::vector<double>* guess) const;
  // Whether b lies on a's branch (judge.cpp); notes the blocks' danger in b.
  bool judge(const Node& a, Node* b);
  // Predict, close and judge a node a step h on. `sigma` is where it ends: a.sigma + h, unless a step shall end exactly
  // on a given place.
  bool step(const Node& a, double h, double sigma, Node* b);
  bool step(const Node& a, double h, Node* b) { return step(a, h, a.sigma + h, b); }
  // Closes nodes at `count` places sigma beyond a, all at once, from the curve through `before` and a; of a path along
  // which the plan does not change. Keeps those up to the first that does not close.
  void close_ahead(const Node& before, const Node& a, const double* sigma, int count, NodesAhead* ahead);
  // Judges the next of the nodes ahead, which a has become the neighbour of, as `step` does.
  bool judge_ahead(const Node& a, NodesAhead* ahead);
  // The step that keeps prediction, turn of the tangent and change of the Jacobians within what is wanted.
  double wanted_step(const Node& node) const;
  // Closes the place half way between two nodes, near where their derivatives say.
  virtual bool close_middle(const Node& a, const Node& b, Node* node) {
    middle(a, b, &guess_);
    const std::vector<double> guess = guess_;
    return close(0.5 * (a.sigma + b.sigma), guess.data(), node);
  }

  const Plan& plan() const { return plan_; }
  const StepLimits& limits() const { return limits_; }
  const std::vector<ClosingTurn>& turns() const { return turns_; }
  const std::vector<TreeTurn>& tree_turns() const { return tree_turns_; }
  // States: the slot of its whole turns, -1 where it has none.
  const std::vector<int>& turn_of_state() const { return turn_of_state_; }
  // Brings the tree's angles within half a turn and counts what was taken off.
  void reduce(Node* node) const;
  int turn_slots() const { return turn_slots_; }
  // Numbers of a node's Jacobians.
  long jacobian_entries() const { return entries_; }
  // Of some rows of states, column after column; a row's numbers are `stride` apart.
  void normalise_quaternions(double* state, long stride, long rows = 1) const;

 protected:
  // The states half way between two nodes, by quintic Hermite interpolation.
  void middle(const Node& a, const Node& b, std::vector<double>* state) const;
  // A block's matrix among those of a node.
  Matrix block_matrix(const double* jacobian, int block) const;
  bool has_band(int block) const { return plan_.block[block].band_entries > 0; }
  // As is_regular_segment, of a block with a band.
  bool is_regular_band(int block, const double* from, const double* middle, const double* to, double* danger, double* least);
  bool turned_too_far(const Node& a, const Node& b) const;
  bool looks_back(const Node& a, const Node& b, double tolerance);
  void size_node(Node* node) const;
  virtual double longest_step(const Node& node) const;
  void differentiate_states(Node* node) const;
  void differentiate_turns(Node* node) const;

  const Path& path_;
  const Plan& plan_;
  const KernelUnit& unit_;
  const StepLimits& limits_;
  std::vector<char> memory_;
  PathPoint point_;

 private:
  // Of a step, for the places from which its derivatives are read: their differences are wrong by its square, a hundredth,
  // and rounding is seen sixty times as large.
  static constexpr double PART_OF_STEP = 0.125;

  bool close(double sigma, const double* guess, double apart, Node* node);
  double apart_for(double h) const;
  bool solve(double sigma, const double* guess, bool moving, Node* node);
  static bool has_derivatives(const Node& node);
  bool finish(Node* node) const;
  bool same_side(const Node& a, Node* b);
  bool judge_by(const Node& a, Node* b, const double* half_way);
  bool same_side(const Node& a, Node* b, const double* half_way);
  double missed(const Node& a, const Node& b);
  void extrapolate(const Node& before, const Node& a, double place, double* guess, long stride) const;
  void run_ahead(const Request& request);
  const std::vector<Factored>& factors(const Node& node) const;
  bool is_told(const Node& node);
  bool differentiate_by_plan(Node* node);
  void columns_of_states(Node* node) const;

  std::vector<ClosingTurn> turns_;
  std::vector<TreeTurn> tree_turns_;
  std::vector<int> turn_of_state_;
  int turn_slots_ = 0;
  long entries_ = 0;
  std::vector<char> upstream_;  // blocks x blocks, where it was needed
  // room for the states that are guessed, for those that a node looks back at, and for the Jacobians half way
  std::vector<double> guess_, ahead_, back_, half_way_;
  std::vector<char> band_room_;  // from when it is first asked for
  // of what runs nodes ahead: a workspace of its width, and the arrays of its rows
  const KernelUnit* wide_ = nullptr;
  std::vector<char> wide_memory_;
  std::vector<double> rows_ahead_;
};

// Whether the segments from one matrix to another, by way of a third half way, hold no singular one: the least of the
// spectral radii of A^+ B - I and B^+ A - I, and both to the middle, are at most `limit`. `danger`: a bound of the radius of
// B^+ A - I; `least`: at most the least singular value of B, if that is less.
bool is_regular_segment(const Factored& a, const Matrix& middle, const Factored& b, double limit, double* danger,
                        double* least);

double tangent_product(const Node& a, const Node& b);

// The blocks that each block hangs on, directly or not (blocks x blocks, row by row).
std::vector<char> upstream_blocks(const Plan& plan, const KernelUnit& unit);

// The closing joints' angles and orientations of a plan, in the order of the joints.
std::vector<ClosingTurn> closing_turns(const Plan& plan, const KernelUnit& unit);
int slots_of(const std::vector<ClosingTurn>& turns);
// The unknown angles of the tree's R and C; their slots follow those of the closing joints.
std::vector<TreeTurn> tree_turns(const Plan& plan, const KernelUnit& unit);
// Numbers of a node's turns.
int turn_slots(const Plan& plan, const KernelUnit& unit);
