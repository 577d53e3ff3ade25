#include "plan/frozen_plan.hpp"

#include <cmath>
#include <cstring>
#include <new>

#include "rows/units.hpp"

namespace {

constexpr std::size_t ALIGNMENT = 64;

std::size_t aligned(std::size_t bytes) { return (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

char* allocate(std::size_t bytes) {
  return static_cast<char*>(::operator new(bytes, std::align_val_t(ALIGNMENT)));
}

// Calls visit(array, pointer, elements) for every array of a plan.
template <class Visit>
void each_array(Plan& p, const Visit& visit) {
  visit(ARRAY_JOINT, p.joints, p.links);
  visit(ARRAY_CLOSING, p.closing, p.closings);
  visit(ARRAY_HUNG_BODY, p.hung, p.hung_bodies);
  visit(ARRAY_PLACE, p.place, p.places);
  visit(ARRAY_AXIS, p.axis, p.axes);
  visit(ARRAY_DRIVE, p.drive, p.drives);
  visit(ARRAY_FREE, p.free, p.frees);
  visit(ARRAY_LOOP, p.loop, p.loop_entries);
  visit(ARRAY_LOOP_COLUMN, p.loop_column, p.loop_columns);
  visit(ARRAY_TERM, p.term, p.terms);
  visit(ARRAY_BLOCK, p.block, p.blocks);
  visit(ARRAY_ORDER, p.order, p.order_count);
  visit(ARRAY_UNKNOWN, p.unknown, p.unknowns);
  visit(ARRAY_BAND, p.band, p.unknowns);
  visit(ARRAY_REST, p.rest, p.rest_count);
  visit(ARRAY_INPUT_COLUMN, p.input_column, p.inputs);
  visit(ARRAY_COLUMN_STATE, p.column_state, p.columns);
  visit(ARRAY_COLUMN_JOINT, p.column_joint, p.columns);
  visit(ARRAY_COLUMN_BLOCK, p.column_block, p.columns);
  visit(ARRAY_COLUMN_PLACE, p.column_place, p.columns);
  visit(ARRAY_COLUMN_WEIGHT, p.column_weight, p.columns);
  visit(ARRAY_INERTIA, p.inertia, p.links);
  visit(ARRAY_LOAD, p.load, p.loads);
  visit(ARRAY_BUSHING, p.bushing, p.bushings);
  visit(ARRAY_ACTUATOR, p.actuator, p.actuators);
  visit(ARRAY_INPUT_CONSTRAINT, p.input_constraint, p.input_constraints);
  visit(ARRAY_FRICTION, p.friction, p.frictions);
  visit(ARRAY_CONTACT, p.contact, p.contacts);
  visit(ARRAY_SIZE_POINT, p.size_point, p.size_points);
  visit(ARRAY_READ, p.law.read, p.law.reads);
  visit(ARRAY_CURVE, p.law.curve, p.law.curves);
  visit(ARRAY_KNOT, p.law.knot, p.law.knots);
  visit(ARRAY_PROGRAM_CONSTANT, p.law.constant, p.law.constants);
  visit(ARRAY_OPERATION, p.law.operation, p.law.instructions);
  visit(ARRAY_OPERAND, p.law.operand, 3 * p.law.instructions);
  visit(ARRAY_PROGRAM_OUTPUT, p.law.output, p.law.outputs);
  visit(ARRAY_KINK, p.law.kink, p.law.kinks);
  visit(ARRAY_FUNCTION, p.functions.function, p.functions.functions);
  visit(ARRAY_FUNCTION_CURVE, p.functions.curve, p.functions.curves);
  visit(ARRAY_FUNCTION_KNOT, p.function_knot, p.functions.knots);
  visit(ARRAY_FUNCTION_CONSTANT, p.function_constant, p.functions.constants);
  visit(ARRAY_FUNCTION_OPERATION, p.functions.operation, p.functions.instructions);
  visit(ARRAY_FUNCTION_OPERAND, p.functions.operand, 3 * p.functions.instructions);
  visit(ARRAY_FUNCTION_OUTPUT, p.functions.output, p.functions.outputs);
}

}  // namespace

bool all_finite(const double* x, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    if (!std::isfinite(x[i])) return false;
  return true;
}

void FrozenPlan::Free::operator()(char* arena) const { ::operator delete(arena, std::align_val_t(ALIGNMENT)); }

FrozenPlan::FrozenPlan(const Plan& given, const std::vector<ConstantPlace>& constants,
                       const std::vector<std::pair<int, ConstantPlace>>& repeated) {
  Plan p = given;
  std::size_t at[ARRAY_COUNT], used = aligned(sizeof(Plan));
  each_array(p, [&](int array, auto* from, int count) {
    at[array] = used;
    used += aligned(count * sizeof *from);
  });
  const auto offset = [&](ConstantPlace c) { return c.offset + (c.array == ARRAY_PLAN ? 0 : at[c.array]); };
  auto structure = std::make_shared<PlanStructure>();
  structure->bytes = used;
  for (const ConstantPlace& c : constants) structure->constant.push_back(offset(c));
  for (const auto& [number, place] : repeated) structure->repeated.push_back({(std::size_t)number, offset(place)});

  arena_.reset(allocate(used));
  std::memset(arena_.get(), 0, used);
  each_array(p, [&](int array, auto*& from, int count) {
    char* const to = arena_.get() + at[array];
    if (count) std::memcpy(to, from, count * sizeof *from);
    from = reinterpret_cast<std::remove_reference_t<decltype(from)>>(to);
  });
  std::memcpy(arena_.get(), &p, sizeof p);
  structure_ = std::move(structure);
  derive();
}

FrozenPlan::FrozenPlan(const FrozenPlan& other) : structure_(other.structure_), arena_(allocate(structure_->bytes)) {
  std::memcpy(arena_.get(), other.arena_.get(), structure_->bytes);
  each_array(plan(), [&](int, auto*& array, int) {
    const std::ptrdiff_t offset = reinterpret_cast<const char*>(array) - other.arena_.get();
    array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(arena_.get() + offset);
  });
}

void FrozenPlan::read_constants(double* out) const {
  for (std::size_t offset : structure_->constant) std::memcpy(out++, arena_.get() + offset, sizeof *out);
}

bool FrozenPlan::assign(const double* constants) noexcept {
  const std::size_t count = structure_->constant.size();
  if (!all_finite(constants, count) || !(constants[CONSTANT_LENGTH] > 0.0) || !(constants[CONSTANT_SIZE] > 0.0))
    return false;
  write(constants);
  derive();
  return true;
}

FrozenPlan FrozenPlan::with_numbers(const double* numbers) const {
  FrozenPlan other(*this);
  other.write(numbers);
  return other;
}

void FrozenPlan::write(const double* constants) noexcept {
  const std::size_t count = structure_->constant.size();
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(arena_.get() + structure_->constant[i], constants + i, sizeof *constants);
  for (const auto& [number, offset] : structure_->repeated)
    std::memcpy(arena_.get() + offset, constants + number, sizeof *constants);
}

bool FrozenPlan::assign_size(double size) noexcept {
  if (!std::isfinite(size) || !(size > 0.0)) return false;
  plan().size = size;
  derive();
  return true;
}

void FrozenPlan::derive() noexcept {
  Plan& p = plan();
  p.row_weight = p.length / p.size;
  double* const weight = const_cast<double*>(p.column_weight);  // the arena is this object's own
  for (int c = 0; c < p.columns; ++c) {
    const TreeJoint& j = p.joints[p.column_joint[c]];
    const bool slide = kernel_unit()->tree_types[j.type].slides >> (c - j.column) & 1;
    weight[c] = slide ? p.size / p.length : 1.0;
  }
}
