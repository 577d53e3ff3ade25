// Owns the arrays of a plan while it is built and hands out the plain view that the units read.
#pragma once

#include <array>
#include <vector>

#include "plan.hpp"

using Triple = std::array<double, 3>;
using FrameData = std::array<double, 12>;  // x, y, z axes, origin

class PlanStore {
 public:
  PlanStore(double length, Triple origin, double size);

  void add_tree_joint(int type, int parent, double pitch, const FrameData& at);
  void add_closing_joint(int type, int first, int second, const FrameData& on_first, const FrameData& on_second,
                         double parameter, const std::vector<std::pair<int, double>>& loop);
  // The next closing equation: a leg of the tree's bodies `body` and `rod` (-1: none) from `first` to `second`.
  void add_leg(int body, int rod, int first, int second, const FrameData& on_first, const FrameData& on_second,
               double length, const Triple& line, double slide_sign, const std::vector<std::pair<int, double>>& loop);
  // The next joint as its user knows it, see JointPlace; returns its number.
  int add_place(int reference, int first, int second, int point_on, const Triple& point, double sign);
  // An axis of a joint's coordinate, see CoordinateAxis; returns its number.
  int add_axis(int place, bool slide, int link, const Triple& vector, int other, const Triple& other_vector);
  void add_block(int closing_joints, const std::vector<int>& joints, const std::vector<int>& unknown);
  void set_rest(const std::vector<int>& joints);
  // `axis` -1: a coordinate that no user knows; `scale`: effort along the axis per generalised force of the column.
  void add_input(int column, int axis, double scale);
  void set_inertia(int link, double mass, const Triple& centre, const std::array<double, 6>& tensor);
  void set_gravity(const Triple& g);
  // A varying load takes its value from the next columns of Request::loads: one along a coordinate, else three.
  void add_load(int type, int link, int other, int freedom, const Triple& point, const Triple& other_point,
                const Triple& vector, bool varying);
  int add_output(int type, int index, int freedom, int order, const Triple& data, double factor);
  // Checks that the parts fit together (std::invalid_argument otherwise); no changes but outputs after it.
  void finish();

  const Plan& view() const { return plan_; }
  bool finished() const { return finished_; }
  // What a run that fills the outputs must demand.
  unsigned demand() const { return demand_; }

 private:
  void point_view_at_arrays();
  void check_link(int link) const;
  std::pair<int, int> add_loop(const std::vector<std::pair<int, double>>& loop);

  Plan plan_{};
  bool finished_ = false;
  unsigned demand_ = 0;
  double size_;
  std::vector<TreeJoint> joints_;
  std::vector<JointPlace> place_;
  std::vector<CoordinateAxis> axis_;
  std::vector<Drive> drive_;
  std::vector<ClosingJoint> closing_;
  std::vector<Leg> leg_;
  std::vector<LoopEntry> loop_;
  std::vector<Block> block_;
  std::vector<int> order_, unknown_, rest_, input_column_;
  std::vector<int> column_state_, column_joint_, column_block_, column_place_;
  std::vector<double> column_weight_;
  std::vector<LinkInertia> inertia_;
  std::vector<Load> load_;
  std::vector<Output> output_;
};
