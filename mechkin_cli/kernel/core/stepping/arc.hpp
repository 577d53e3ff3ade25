// Steps along a branch by its own arclength, where the path of the inputs may turn back.
//
// One block, or several that hang on one another, and the path's parameter sigma are the unknowns of
//
//     f(y, z(sigma)) = 0,     t.(y - y_0, sigma - sigma_0) = 0
//
// where z are the inputs and the blocks before, which follow the path as they do elsewhere. Their matrix [J g; t^T],
// g = df/dsigma, is regular at a dead centre and singular only at a branch point. Other blocks are carried along: they
// hang on y and sigma.
#pragma once

#include "stepping/stepper.hpp"

// Nodes are by arclength here: `place` is it, `rate` and `bend` are derivatives of sigma by it.
class Arc : public Stepper {
 public:
  // `own` (blocks): those whose unknowns the arc is of; `carried`: those to be followed besides them and the ones that
  // they hang on. `weight`: of sigma in the arclength against the inputs' own way; at least 1.
  Arc(const Path& path, const KernelUnit& unit, const StepLimits& limits, std::vector<char> own,
      std::vector<char> carried, double weight = 1.0);

  // The arc through a place of the path, with sigma rising; false if there is none.
  bool enter(const Node& node, Node* start);
  // Predict, close and judge a node a step h on; false with the block that is to `blame`.
  bool step(const Node& a, double h, Node* b, int* blame);
  // Closes at a step h from a node without judging.
  bool close_from(const Node& a, double h, Node* b);
  bool close_middle(const Node& a, const Node& b, Node* node) override {
    return close_from(a, 0.5 * (b.place - a.place), node);
  }
  // The step that its own blocks alone would want.
  double own_step(const Node& node) const;
  // The step over which each of its own blocks by itself would stay as regular as it has to, seen from that between two nodes.
  double step_of_blocks(const Node& a, const Node& b) const;

  bool owns(int block) const { return own_[block]; }
  bool carries(int block) const { return own_[block] || before_[block] || carried_[block]; }
  // Danger and least pivot of its own matrix.
  int equations() const { return rows_; }
  double own_danger(const Node& node) const { return node.danger[first_]; }
  double own_pivot(const Node& node) const { return node.pivot[first_]; }
  const std::vector<char>& before() const { return before_; }
  // [J g; t^T] of a node.
  Matrix bordered(const Node& node) const;
  // [J g] of a node: equations x (unknowns, sigma in parts of its scale).
  const Matrix& extended(const Node& node) const { return node.extended; }
  // Second derivative of the equations along v = (unknowns, sigma) at a node, for v with [J g] v = 0.
  std::vector<double> second_along(const Node& node, const std::vector<double>& v);
  // The node's tangent (unknowns, sigma in parts of its scale), of length 1.
  std::vector<double> tangent(const Node& node) const;
  // Of the inputs by sigma where the arc begins; times sigma's weight in the arclength.
  double speed() const { return speed_; }
  double scale() const { return scale_; }
  double weight() const { return weight_; }
  std::vector<double> inputs_at(double sigma);
  // [J g] at states that need not close.
  Matrix extended_at(const Node& near, const std::vector<double>& state, double sigma);

 private:
  struct Looked {
    std::vector<double> equations, first, second;
  };
  // Runs the kernel with its own blocks held: `complete` with all that is carried, else with what comes before alone.
  bool look(const double* guess, bool complete, const std::vector<double>& rates, double sigma_rate,
            const std::vector<double>& accelerations, double sigma_bend, int iterations, unsigned demand, Node* node,
            Looked* out);
  // The equations' derivatives by the unknowns at a node's states.
  Matrix own_jacobian(const Node& node);
  bool close_by(std::vector<double> state, double sigma, const std::vector<double>& border, double target, Node* node);
  bool differentiate(Node* node);
  double longest_step(const Node& node) const override;
  double rounding_of_matrix(const Node& node, const LeastSquares& matrix, const std::vector<double>& border);
  bool same_side(const Node& a, Node* b, int* blame);
  void advance(const std::vector<double>& step, double* state) const;
  void clear_uncarried(Node* node) const;

  int rows_ = 0, size_ = 0, first_ = -1;  // equations, unknowns, the first of its own blocks
  std::vector<int> unknown_;              // columns
  std::vector<char> own_, before_, carried_;
  std::vector<ClosingTurn> carried_turns_;
  double weight_, speed_ = 1.0, scale_ = 1.0;
};
