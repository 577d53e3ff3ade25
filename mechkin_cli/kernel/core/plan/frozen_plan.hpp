// A finished plan: immutable, in one allocation, so that a copy is a memcpy and a shift of its pointers.
//
// Constants. Every double that a record of PlanBuilder carries is a constant of the plan. They are numbered from 0 in
// the order of the builder's calls and, within a call, of its arguments:
//   PlanBuilder        length, origin (3), size
//   add_tree_joint     pitch, at (12: axes x, y, z, origin)
//   add_closing_joint  on_first (12), on_second (12), parameter
//   add_hung_links     on_first (12), on_second (12), length, line (3)
//   add_function       knots (x, y, b, c, d of each), constants
//   add_relation       factors, arguments, sum
//   add_mesh           point (3), along (3), apart (3)
//   add_force          point (3), along (3), apart (3)
//   add_place          point (3)
//   add_axis           vector (3), other_vector (3)
//   add_input          scale
//   set_inertia        mass, centre (3), tensor (6: xx yy zz xy xz yz)
//   set_gravity        g (3)
//   add_load           point (3), other_point (3), vector (3)
//   add_bushing        on_first (12), on_second (12), matrix (21), free (6)
//   set_load_program   of each read data (3) and factor, then knots (x, y, b, c, d of each), then its own constants
//   add_friction       axis (3), radius, pitch, at_rest, sliding, speed
//   add_contact        weight, share, tilt, roll, direction (3)
//   add_size_point     point (3)
// Signs (+1, -1), codes and indices are structure. `assign` gives a plan other constants and recomputes what is derived
// from them (row_weight, column_weight): no allocation, no exception, so a loop over variants keeps one copy a thread.
// Outputs (outputs.hpp keeps the kinds) are numbered alike: data (3), factor, record after record.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "plan/plan.hpp"

// The arrays of a plan, in the order in which they lie in the arena behind the Plan itself.
enum PlanArray : int {
  ARRAY_PLAN = -1,
  ARRAY_JOINT = 0,
  ARRAY_CLOSING,
  ARRAY_HUNG_BODY,
  ARRAY_PLACE,
  ARRAY_AXIS,
  ARRAY_DRIVE,
  ARRAY_FREE,
  ARRAY_LOOP,
  ARRAY_LOOP_COLUMN,
  ARRAY_TERM,
  ARRAY_BLOCK,
  ARRAY_ORDER,
  ARRAY_UNKNOWN,
  ARRAY_BAND,
  ARRAY_REST,
  ARRAY_INPUT_COLUMN,
  ARRAY_COLUMN_STATE,
  ARRAY_COLUMN_JOINT,
  ARRAY_COLUMN_BLOCK,
  ARRAY_COLUMN_PLACE,
  ARRAY_COLUMN_WEIGHT,
  ARRAY_INERTIA,
  ARRAY_LOAD,
  ARRAY_BUSHING,
  ARRAY_ACTUATOR,
  ARRAY_INPUT_CONSTRAINT,
  ARRAY_FRICTION,
  ARRAY_CONTACT,
  ARRAY_SIZE_POINT,
  ARRAY_READ,
  ARRAY_CURVE,
  ARRAY_KNOT,
  ARRAY_PROGRAM_CONSTANT,
  ARRAY_OPERATION,
  ARRAY_OPERAND,
  ARRAY_PROGRAM_OUTPUT,
  ARRAY_KINK,
  ARRAY_FUNCTION,
  ARRAY_FUNCTION_CURVE,
  ARRAY_FUNCTION_KNOT,
  ARRAY_FUNCTION_CONSTANT,
  ARRAY_FUNCTION_OPERATION,
  ARRAY_FUNCTION_OPERAND,
  ARRAY_FUNCTION_OUTPUT,
  ARRAY_COUNT
};

// A double of a plan: its array and its offset in bytes there.
struct ConstantPlace {
  int array;
  std::size_t offset;
};

// What plans with the same records but other constants share; outputs fit every plan of their structure.
struct PlanStructure {
  std::size_t bytes = 0;
  std::vector<std::size_t> constant;                          // offset in the arena, by number
  std::vector<std::pair<std::size_t, std::size_t>> repeated;  // a second place of a constant: number, offset
};

// Numbers of the constants that the builder is made with.
enum PlanConstant : int { CONSTANT_LENGTH = 0, CONSTANT_ORIGIN = 1, CONSTANT_SIZE = 4 };

class FrozenPlan {
 public:
  // From a plan whose pointers lead to the builder's arrays. `repeated`: (number of the constant, its second place).
  FrozenPlan(const Plan& plan, const std::vector<ConstantPlace>& constants,
             const std::vector<std::pair<int, ConstantPlace>>& repeated);
  FrozenPlan(const FrozenPlan& other);
  FrozenPlan(FrozenPlan&&) noexcept = default;
  FrozenPlan& operator=(const FrozenPlan&) = delete;
  FrozenPlan& operator=(FrozenPlan&&) noexcept = default;

  const Plan& view() const { return *reinterpret_cast<const Plan*>(arena_.get()); }
  const std::shared_ptr<const PlanStructure>& structure() const { return structure_; }

  std::size_t constants() const { return structure_->constant.size(); }
  void read_constants(double* out) const;
  // False, and nothing changed, if a constant is not finite or length or size not positive.
  bool assign(const double* constants) noexcept;
  bool assign_size(double size) noexcept;
  // A plan with other numbers in the places of the constants, whatever they are and without what follows from them: the
  // low parts of this one's constants.
  FrozenPlan with_numbers(const double* numbers) const;

 private:
  struct Free {
    void operator()(char* arena) const;
  };
  Plan& plan() { return *reinterpret_cast<Plan*>(arena_.get()); }
  void derive() noexcept;
  void write(const double* constants) noexcept;

  std::shared_ptr<const PlanStructure> structure_;
  std::unique_ptr<char, Free> arena_;
};

// Whether all of some numbers are finite.
bool all_finite(const double* x, std::size_t n);
