// Steps along a branch by its own arclength, where the path of the inputs may turn back.
//
// One block and the path's parameter sigma are the unknowns of
//
//     f(y, z(sigma)) = 0,     t.(y - y_0, sigma - sigma_0) = 0
//
// where z are the inputs and the blocks before it, which follow the path as they do elsewhere. Their matrix
// [J g; t^T], g = df/dsigma, is regular at a dead centre and singular only at a branch point. Other blocks are carried
// along: they hang on y and sigma.
#pragma once

#include "stepper.hpp"

// Nodes are by arclength here: `place` is it, `rate` and `bend` are derivatives of sigma by it.
class Arc : public Stepper {
 public:
  // `carried` (blocks): those to be followed besides the block itself and the ones it hangs on.
  Arc(const Path& path, const KernelUnit& unit, const StepLimits& limits, int block, std::vector<char> carried);

  // The arc through a place of the path, with sigma rising; false if there is none.
  bool enter(const Node& node, Node* start);
  // Predict, close and judge a node a step h on; false with the block that is to `blame`.
  bool step(const Node& a, double h, Node* b, int* blame);
  // Closes at a step h from a node without judging.
  bool close_from(const Node& a, double h, Node* b);

  int block() const { return block_; }
  bool carries(int block) const { return block == block_ || before_[block] || carried_[block]; }
  const std::vector<char>& before() const { return before_; }
  // [J g; t^T] of a node.
  Matrix bordered(const Node& node) const;
  // [J g] of a node: equations x (unknowns, sigma in parts of the inputs' speed).
  Matrix extended(const Node& node) const;
  // Second derivative of the equations along v = (unknowns, sigma) at a node, for v with [J g] v = 0.
  std::vector<double> second_along(const Node& node, const std::vector<double>& v);
  // The node's tangent (unknowns, sigma in parts of the inputs' speed), of length 1.
  std::vector<double> tangent(const Node& node) const;
  double speed() const { return speed_; }
  std::vector<double> inputs_at(double sigma);
  // [J g] at states that need not close.
  Matrix extended_at(const Node& near, const std::vector<double>& state, double sigma);

 private:
  struct Looked {
    std::vector<double> equations, first, second;
  };
  // Runs the kernel with the block held: `complete` with all that is carried, else with what comes before alone.
  bool look(const double* guess, bool complete, const std::vector<double>& rates, double sigma_rate,
            const std::vector<double>& accelerations, double sigma_bend, int iterations, unsigned demand, Node* node,
            Looked* out);
  bool close_by(std::vector<double> state, double sigma, const std::vector<double>& border, double target, Node* node);
  bool differentiate(Node* node);
  bool same_side(const Node& a, Node* b, int* blame);
  void advance(const std::vector<double>& step, double* state) const;
  void clear_uncarried(Node* node) const;
  int unknown(int u) const { return plan_.unknown[plan_.block[block_].column_begin + u]; }

  int block_, rows_, size_;
  std::vector<char> before_, carried_;
  std::vector<ClosingTurn> carried_turns_;
  double speed_ = 1.0;  // of the inputs by sigma, where the arc begins
};

// The blocks that each block hangs on, directly or not (blocks x blocks, row by row).
std::vector<char> upstream_blocks(const Plan& plan, const KernelUnit& unit);
