// Owns the arrays of a plan while it is built and hands out the plain view that the units read.
#pragma once

#include <array>
#include <vector>

#include "plan.hpp"

using Triple = std::array<double, 3>;
using FrameData = std::array<double, 12>;  // x, y, z axes, origin

// Which links a joint joins, as its user sees it: point and axis in the second link's frame (ground axes
// if that is ground), sign +1 if the kernel's joint runs from the first link to the second.
struct PlaceData {
  int first, second;
  Triple point, axis;
  double sign;
};

class PlanStore {
 public:
  PlanStore(double length, Triple origin, double size);

  void add_tree_joint(int type, int parent, double pitch, const FrameData& at, const PlaceData& place);
  void add_closing_joint(int type, int first, int second, const FrameData& on_first, const FrameData& on_second,
                         const std::vector<std::pair<int, double>>& loop, const PlaceData& place);
  void add_block(int closing_joints, const std::vector<int>& joints, const std::vector<int>& unknown);
  void set_rest(const std::vector<int>& joints);
  // The drive acts on s rather than theta: a force along the axis, for H as well.
  void add_input(int column, bool along_s);
  void set_inertia(int link, double mass, const Triple& centre, const std::array<double, 6>& tensor);
  void set_gravity(const Triple& g);
  void add_load(int type, int link, int other, const Triple& point, const Triple& other_point, const Triple& vector);
  int add_output(int type, int index, int order, const Triple& data, double factor);
  // Checks that the parts fit together (std::invalid_argument otherwise); no changes but outputs after it.
  void finish();

  const Plan& view() const { return plan_; }
  bool finished() const { return finished_; }
  // What a run that fills the outputs must demand.
  unsigned demand() const { return demand_; }

 private:
  void point_view_at_arrays();
  void check_reference(int joint) const;

  Plan plan_{};
  bool finished_ = false;
  unsigned demand_ = 0;
  double size_;
  std::vector<TreeJoint> joints_;
  std::vector<JointPlace> tree_places_, closing_places_;
  std::vector<ClosingJoint> closing_;
  std::vector<LoopEntry> loop_;
  std::vector<Block> block_;
  std::vector<int> order_, unknown_, rest_, input_column_;
  std::vector<int> column_state_, column_joint_, column_block_, column_place_;
  std::vector<double> column_weight_;
  std::vector<LinkInertia> inertia_;
  std::vector<Load> load_;
  std::vector<Output> output_;
};
