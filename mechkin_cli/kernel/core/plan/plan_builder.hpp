// Collects the records of a plan, checks each, and freezes them.
//
// Wrong indices, codes, sizes and numbers that are not finite are refused, as is every call after finish(); what is
// refused leaves the builder as it was. The order of the calls numbers the plan's constants (frozen_plan.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "plan/frozen_plan.hpp"
#include "plan/function_store.hpp"
#include "plan/program_store.hpp"
#include "result.hpp"

using Triple = std::array<double, 3>;
using FrameData = std::array<double, 12>;  // x, y, z axes, origin
using Loop = std::vector<std::pair<int, double>>;  // tree joint and sign
using TermTuple = std::tuple<int, double, int, int, int>;  // tree joint and sign, freedom, axis and function of a Term
// Register, range, and number of knots.
using CurveTuple = std::tuple<int, double, double, int>;
// Argument, whether it repeats itself, and number of knots.
using FunctionCurveTuple = std::tuple<int, bool, int>;

class PlanBuilder {
 public:
  // The length unit (m), the kernel's origin (m) and the mechanism's size (m).
  static Result<PlanBuilder> make(double length, const Triple& origin, double size);

  Refusal add_tree_joint(int type, int parent, double pitch, const FrameData& at);
  Refusal add_closing_joint(int type, int first, int second, const FrameData& on_first, const FrameData& on_second,
                         double parameter, const Loop& loop);
  // The next closing equation: a hung body of the tree's bodies `body` and `rod` (-1: none) from `first` to `second`.
  Refusal add_hung_links(int body, int rod, int first, int second, const FrameData& on_first, const FrameData& on_second,
               double length, const Triple& line, double slide_sign, const Loop& loop);
  // The next function, see Function; returns its number. Knots, those of one curve behind those of another, are x, y, b, c, d.
  Result<int> add_function(int arguments, const std::vector<FunctionCurveTuple>& curves,
                           const std::vector<double>& knots, const std::vector<double>& constants, const std::vector<int>& operations,
                           const std::vector<std::array<int, 3>>& operands, const std::vector<int>& instructions,
                           const std::vector<int>& outputs, const std::vector<int>& output_ends);
  // The next closing equation: the sum of terms, each with its factor and what its coordinate is in a function's argument, is
  // `sum`; a length, or an angle. Axes may come later.
  Refusal add_relation(bool length, const std::vector<TermTuple>& terms, const std::vector<double>& factors,
                       const std::vector<double>& arguments, double sum);
  // The last relation acts by a force, see ClosingJoint, at a point of `carrier`, on the end of the way `path`.
  Refusal add_mesh(int carrier, const Triple& point, const Triple& along, const Triple& apart, const Loop& path);
  // And by another one, at another point of the same link.
  Refusal add_force(const Triple& point, const Triple& along, const Triple& apart);
  // The next joint as its user knows it, see JointPlace; returns its number.
  Result<int> add_place(int reference, int first, int second, int point_on, const Triple& point, double sign);
  // An axis of a joint's coordinate, see CoordinateAxis; returns its number.
  Result<int> add_axis(int place, bool slide, int link, const Triple& vector, int other, const Triple& other_vector);
  // What TREE_G or TREE_A goes along: a function, the signs and scale of which are the joint's pitch, and the axes of the
  // parameters in their order.
  Refusal set_course(int joint, int function, const std::vector<int>& axes);
  // The next free motion of a joint, see FreeMotion; those of one joint in a row.
  Refusal add_free_motion(int place, bool slide, int code, int link, const Triple& vector);
  // The next closing joints, the tree joints that they place, parents first, and the columns that they solve for.
  // `charts`: coordinates of a chart that take the place of inputs; of one block, which may then close no joint.
  Refusal add_block(int closing_joints, const std::vector<int>& joints, const std::vector<int>& unknown, int charts);
  // The tree joints that no block places, parents first.
  Refusal set_rest(const std::vector<int>& joints);
  // `axis` -1: a coordinate that no user knows; `scale`: effort along the axis per generalised force of the column.
  Refusal add_input(int column, int axis, double scale);
  Refusal set_inertia(int link, double mass, const Triple& centre, const std::array<double, 6>& tensor);
  Refusal set_gravity(const Triple& g);
  // A varying load takes its value from the next outputs of the load program: one along a coordinate, else three.
  Refusal add_load(int type, int link, int other, int freedom, const Triple& point, const Triple& other_point,
                const Triple& vector, bool varying);
  // The next load: a spring or a damper between two frames, see Bushing; ground is -1.
  Refusal add_bushing(bool damps, int first, int second, const FrameData& on_first, const FrameData& on_second,
                      const std::array<double, 21>& matrix, const std::array<double, 6>& free);
  // The values of the loads that vary: kind, then type, index, freedom and order of what is read, and its data (3) and
  // factor; curves, and knots as of functions; then the instructions, as in ProgramRecord.
  Refusal set_load_program(const std::vector<std::array<int, 5>>& reads, const std::vector<double>& numbers,
                           const std::vector<CurveTuple>& curves, const std::vector<double>& knots,
                           const std::vector<double>& constants, const std::vector<int>& operations,
                           const std::vector<std::array<int, 3>>& operands, const std::vector<int>& outputs,
                           const std::vector<int>& kinks);
  // The first `inputs` inputs are driven by motors; the others are held.
  Refusal set_driven(int inputs);
  // The next actuator: a coordinate as that of a load along it.
  Refusal add_actuator(int axis, int reference, int freedom);
  // Input `input` is moved by the motor of input `leader`, see InputConstraint.
  Refusal add_input_constraint(int input, int leader);
  // The friction of a joint, see Friction; at most one a joint. Where neither turns nor slides rub, what the place's relation
  // pushes its links apart with, of the coefficient 1.
  Refusal add_friction(int place, int turns, int slides, int link, bool falls, const Triple& axis, double radius,
                    double pitch, double at_rest, double sliding, double speed, int course);
  // The next contact of the last friction, see Contact.
  Refusal add_contact(int code, double weight, double share, double tilt, double roll, const Triple& direction);
  // A joint's point, see Plan::size_point: in the link's frame and length units, of ground in m from the origin.
  Refusal add_size_point(int link, const Triple& point);
  // Checks that the parts fit together; the builder is spent after it.
  Result<FrozenPlan> finish();

  int states() const { return plan_.states; }
  int columns() const { return plan_.columns; }

 private:
  static constexpr int NOT_PLACED = -1, REST = -2;

  PlanBuilder(double length, const Triple& origin, double size);
  Refusal open() const;
  Refusal check_link(int link) const;
  Refusal check_joint(int joint, const char* message) const;
  Refusal check_load(int type, int link, int other, int freedom, bool varying) const;
  Refusal check_loop(const Loop& loop) const;
  std::pair<int, int> add_loop(const Loop& loop);
  // The next `count` constants stand in a row from here on.
  std::size_t in_plan(const double* number) const;
  void number_force(std::size_t frame);
  void number(int array, std::size_t offset, int count);
  Refusal place_joints(int block, const std::vector<int>& joints, std::vector<int>* placed_by) const;
  Refusal check_order() const;
  Refusal check_actuators() const;
  void sort_drives();
  void find_turns();
  void find_relations();
  void find_loop_columns();
  void find_band(Block* block);
  void find_bands();
  Plan arrays() const;

  Plan plan_{};
  bool spent_ = false, gravity_ = false, rest_set_ = false, program_set_ = false, driven_set_ = false;
  std::vector<ConstantPlace> constants_;
  std::vector<std::pair<int, ConstantPlace>> repeated_;
  std::vector<TreeJoint> joints_;
  std::vector<JointPlace> place_;
  std::vector<CoordinateAxis> axis_;
  std::vector<Drive> drive_;
  std::vector<FreeMotion> free_;
  std::vector<ClosingJoint> closing_;
  std::vector<HungBody> hung_;
  std::vector<LoopEntry> loop_;
  std::vector<LoopColumn> loop_column_;
  std::vector<Term> term_;
  std::vector<Block> block_;
  std::vector<int> order_, unknown_, rest_, input_column_;
  std::vector<BandRow> band_;   // unknowns
  std::vector<int> column_state_, column_joint_, column_block_, column_place_;
  std::vector<int> placed_by_;  // tree joint -> block, NOT_PLACED, or REST
  std::vector<double> column_weight_;
  std::vector<LinkInertia> inertia_;
  std::vector<Load> load_;
  std::vector<Bushing> bushing_;
  std::vector<Actuator> actuator_;
  std::vector<InputConstraint> input_constraint_;
  std::vector<Friction> friction_;
  std::vector<Contact> contact_;
  std::vector<Output> size_point_;
  ProgramStore program_;
  FunctionStore functions_;
};
