#include "mechkin.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "rows/run.hpp"
#include "stepping/stepper.hpp"
#include "stepping/variants.hpp"
#include "text/plan_text.hpp"
#include "text/table_text.hpp"

struct mechkin_plan {
  PlanText of;
  mechkin_sizes sizes;
  std::vector<double> replayed;  // what the tape gave last
  std::optional<Variants> variants;
  std::size_t constants() const { return of.plan.constants() + of.outputs.constants(); }
};

namespace {

constexpr char NOT_FINITE_CONSTANTS[] = "constants must be finite, length unit and size positive";

// What a call comes to: none of its exceptions, of which there is one, goes farther.
template <class Call>
mechkin_status answer(mechkin_message* message, const Call& call) {
  if (message) message->text[0] = '\0';
  const auto refused = [&]() -> mechkin_status {
    const Refusal refusal = call();
    if (!refusal) return MECHKIN_OK;
    if (message) {
      const std::size_t size = std::min(refusal->size(), sizeof message->text - 1);
      std::memcpy(message->text, refusal->data(), size);
      message->text[size] = '\0';
    }
    return MECHKIN_REFUSED;
  };
#ifdef __cpp_exceptions
  try {
    return refused();
  } catch (...) {
    return MECHKIN_NO_MEMORY;
  }
#else
  return refused();
#endif
}

Refusal assign(mechkin_plan* plan, const double* constants) {
  const std::size_t first = plan->of.plan.constants();
  REQUIRE(all_finite(constants, plan->constants()), NOT_FINITE_CONSTANTS);
  REQUIRE(plan->of.plan.assign(constants), NOT_FINITE_CONSTANTS);
  plan->of.outputs.assign(constants + first);
  return {};
}

Refusal create(std::string_view text, mechkin_plan** to) {
  Result<PlanText> read = read_plan(text);
  CHECK(read.refusal());
  auto plan = std::make_unique<mechkin_plan>(mechkin_plan{std::move(*read), {}, {}, {}});
  const Plan& p = plan->of.plan.view();
  mechkin_sizes& s = plan->sizes;
  s.inputs = (size_t)p.inputs, s.states = (size_t)p.states, s.columns = (size_t)p.columns;
  s.values = (size_t)plan->of.outputs.view().slots, s.loads = (size_t)p.load_values, s.input_constraints = (size_t)p.input_constraints;
  s.turns = (size_t)turn_slots(p, *kernel_unit(2)), s.blocks = (size_t)p.blocks, s.constants = plan->constants();
  if (plan->of.tape) {
    const Tape& tape = plan->of.tape->view();
    REQUIRE((size_t)tape.outputs >= s.constants, "the tape does not give the constants of plan and outputs");
    s.parameters = (size_t)tape.inputs, s.moving = (size_t)tape.outputs - s.constants;
    plan->replayed.resize((size_t)tape.outputs);
  }
  if (plan->of.response) s.variant_rows = plan->of.response->times.size();
  if (plan->of.variants) {
    s.variant_rows = (size_t)std::max(plan->of.variants->rows, 0L);
    plan->variants.emplace(*plan->of.tape, plan->of.plan, plan->of.outputs, std::move(*plan->of.variants));
    CHECK(plan->variants->prepare());
  }
  *to = plan.release();
  return {};
}

// The rows as the core takes them.
Request request_of(const mechkin_rows& rows, const OutputList& outputs) {
  Request r = {};
  r.rows = (long)rows.rows;
  r.inputs = rows.inputs, r.guess = rows.guess, r.rates = rows.rates, r.accelerations = rows.accelerations;
  r.jerks = rows.jerks, r.constraint_rates = rows.constraint_rates, r.turned = rows.turned, r.whole = rows.whole, r.full = rows.full;
  r.time = rows.time;
  r.wanted = outputs.view();
  r.states = rows.states, r.outputs = rows.values, r.velocities = rows.first, r.second = rows.second;
  r.residual = rows.residual, r.correction = rows.correction, r.side = rows.side, r.condition = rows.condition;
  r.power_error = rows.power_error, r.loads = rows.loads, r.flags = rows.flags, r.undefined = rows.undefined;
  r.demand = rows.demand, r.iterations = rows.iterations;
  r.tight = rows.tight, r.coarse = rows.coarse, r.accept = rows.accept;
  return r;
}

Refusal run(const mechkin_plan& plan, const mechkin_rows& rows) {
  const Plan& p = plan.of.plan.view();
  const OutputList& outputs = plan.of.outputs;
  REQUIRE(rows.rows <= (std::size_t)MOST_ROWS, "more than 100000000 rows");
  REQUIRE((rows.inputs || !p.inputs) && (rows.guess || !p.states), "inputs and guesses are given");
  REQUIRE(rows.states || !p.states, "states have their array");
  REQUIRE(rows.residual && rows.correction && rows.flags, "residual, correction and flags have their arrays");
  REQUIRE(!(rows.demand & ~(unsigned)DEMAND_EVERYTHING), "an unknown demand");
  REQUIRE(rows.demand || !rows.side, "sides go with a demand");
  REQUIRE(rows.iterations >= 0 && rows.iterations <= MOST_ITERATIONS, "0 to 10000 iterations");
  REQUIRE(rows.tight >= 0.0 && rows.coarse >= 0.0 && rows.accept >= 0.0, "a test is a number from 0 on");
  REQUIRE(rows.threads >= 1 && rows.threads <= MOST_THREADS, "1 to 1024 threads");
  const Request r = request_of(rows, outputs);
  CHECK(check_demand(r, outputs.view().count ? &outputs : nullptr, p));
  if (r.rows) run_rows(p, r, *kernel_unit(), rows.threads);
  return {};
}

Refusal run_response(const mechkin_plan& start, const mechkin_plan& motion, const double* parameters, mechkin_response& r) {
  REQUIRE(start.variants && motion.of.response, "the texts of the plans do not say what a response is");
  const VariedResponse varied = {*start.variants, *motion.of.tape, motion.of.plan, motion.of.outputs, *motion.of.response};
  CHECK(check_start(varied));
  REQUIRE(parameters || !motion.sizes.parameters, "parameters are given");
  REQUIRE((r.values || !motion.sizes.values) && r.residual && r.condition && r.power_error && r.work, "all columns have their arrays");
  FloatingPointState state;
  Result<PlayedResponse> played = play_response(varied, parameters, {r.values, r.residual, r.condition, r.power_error, r.work});
  CHECK(played.refusal());
  r.end = (mechkin_end)(int)played->end;
  r.rows = (size_t)played->rows, r.reached = (size_t)played->reached, r.moments = (size_t)played->moments;
  r.stop = played->stop, r.time = played->time, r.energy = played->energy;
  return {};
}

Refusal run_variant(const mechkin_plan& plan, const double* parameters, mechkin_variant& v) {
  REQUIRE(plan.variants, "the text of the plan does not say what its variants have in common");
  REQUIRE(parameters || !plan.sizes.parameters, "parameters are given");
  REQUIRE((v.values || !plan.sizes.values) && v.residual && v.condition, "values, residual and condition have their arrays");
  VariantReach reach = {0, 0, {}};
  int end = 0;
  FloatingPointState state;
  plan.variants->run(1, parameters, *kernel_unit(), 1, {v.values, v.residual, v.condition, &end, v.power_error, &reach});
  v.end = (mechkin_end)end;
  v.first = (size_t)reach.first, v.last = (size_t)reach.last;
  if (v.end == MECHKIN_COMPLETE) v.first = 0, v.last = plan.sizes.variant_rows;
  if (v.end == MECHKIN_BUILT_ANEW || v.end == MECHKIN_LOST) v.first = v.last = 0;
  for (int side : {0, 1}) {
    const VariantStop& stop = reach.stops[side];
    v.stops[side] = (mechkin_stop)(int)stop.kind;
    for (std::size_t i = 0; v.stopped && i < plan.sizes.inputs; ++i)
      v.stopped[side * plan.sizes.inputs + i] = i < stop.inputs.size() ? stop.inputs[i] : __builtin_nan("");
  }
  return {};
}

}  // namespace

struct mechkin_tape {
  TapeStore of;
};

mechkin_status mechkin_plan_create(const char* text, size_t length, mechkin_plan** plan, mechkin_message* message) {
  *plan = nullptr;
  return answer(message, [&] { return create({text, length}, plan); });
}

void mechkin_plan_free(mechkin_plan* plan) { delete plan; }

mechkin_sizes mechkin_plan_sizes(const mechkin_plan* plan) { return plan->sizes; }

void mechkin_plan_constants(const mechkin_plan* plan, double* constants) {
  plan->of.plan.read_constants(constants);
  plan->of.outputs.read_constants(constants + plan->of.plan.constants());
}

mechkin_status mechkin_plan_set_constants(mechkin_plan* plan, const double* constants, mechkin_message* message) {
  return answer(message, [&] { return assign(plan, constants); });
}

mechkin_status mechkin_plan_set_parameters(mechkin_plan* plan, const double* parameters, double* moving,
                                           mechkin_message* message) {
  std::uint8_t verdict = TAPE_SAME;
  const mechkin_status status = answer(message, [&]() -> Refusal {
    REQUIRE(plan->of.tape, "the plan has no tape");
    const Tape& tape = plan->of.tape->view();
    const KernelUnit& unit = *kernel_unit(2);
    std::vector<char> memory((std::size_t)unit.replay_size(tape));
    FloatingPointState state;
    unit.replay(tape, {1, parameters, plan->replayed.data(), &verdict}, memory.data());
    if (verdict == TAPE_OTHER_WAY) return {};
    CHECK(assign(plan, plan->replayed.data()));
    if (moving) std::copy(plan->replayed.begin() + (long)plan->constants(), plan->replayed.end(), moving);
    return {};
  });
  return status == MECHKIN_OK && verdict == TAPE_OTHER_WAY ? MECHKIN_OTHER_WAY : status;
}

mechkin_status mechkin_plan_set_size(mechkin_plan* plan, double size, mechkin_message* message) {
  return answer(message, [&]() -> Refusal {
    REQUIRE(plan->of.plan.assign_size(size), "the size must be finite and positive");
    return {};
  });
}

mechkin_status mechkin_run(const mechkin_plan* plan, const mechkin_rows* rows, mechkin_message* message) {
  return answer(message, [&] { return run(*plan, *rows); });
}

mechkin_status mechkin_run_variant(const mechkin_plan* plan, const double* parameters, mechkin_variant* variant,
                                   mechkin_message* message) {
  return answer(message, [&] { return run_variant(*plan, parameters, *variant); });
}

mechkin_status mechkin_run_response(const mechkin_plan* start, const mechkin_plan* motion, const double* parameters,
                                    mechkin_response* response, mechkin_message* message) {
  return answer(message, [&] { return run_response(*start, *motion, parameters, *response); });
}

mechkin_status mechkin_tape_create(const char* text, size_t length, mechkin_tape** tape, mechkin_message* message) {
  *tape = nullptr;
  return answer(message, [&]() -> Refusal {
    Result<TapeStore> read = read_tape({text, length});
    CHECK(read.refusal());
    *tape = new mechkin_tape{std::move(*read)};
    return {};
  });
}

void mechkin_tape_free(mechkin_tape* tape) { delete tape; }

size_t mechkin_tape_inputs(const mechkin_tape* tape) { return (size_t)tape->of.view().inputs; }
size_t mechkin_tape_outputs(const mechkin_tape* tape) { return (size_t)tape->of.view().outputs; }

mechkin_status mechkin_tape_run(const mechkin_tape* tape, size_t count, const double* inputs, double* outputs,
                                unsigned char* other_way, mechkin_message* message) {
  return answer(message, [&]() -> Refusal {
    REQUIRE(count <= (std::size_t)MOST_ROWS, "more than 100000000 rows");
    const Tape& of = tape->of.view();
    const KernelUnit& unit = *kernel_unit();
    std::vector<char> memory((std::size_t)unit.replay_size(of));
    std::vector<double> found(count * (std::size_t)of.outputs);
    std::vector<std::uint8_t> verdicts(count);
    FloatingPointState state;
    unit.replay(of, {(long)count, inputs, found.data(), verdicts.data()}, memory.data());
    for (std::size_t row = 0; row < count; ++row) {
      for (int k = 0; k < of.outputs; ++k) outputs[(std::size_t)k * count + row] = found[row * (std::size_t)of.outputs + (std::size_t)k];
      if (other_way) other_way[row] = verdicts[row] == TAPE_OTHER_WAY;
    }
    return {};
  });
}

size_t mechkin_cell_texts(const double* numbers, size_t rows, mechkin_notation notation, unsigned digits, char* text,
                          size_t room) {
  size_t size = 0;
  const mechkin_status status = answer(nullptr, [&]() -> Refusal {
    TextColumn column;
    column.numbers = numbers;
    constexpr Notation notations[] = {Notation::shortest, Notation::fixed, Notation::fixed, Notation::scientific};
    column.style = {notations[notation & 3], (int)std::min(digits, 300u), notation == MECHKIN_TRIMMED};
    const std::vector<std::string> cells = column_texts(column, rows);
    for (const std::string& cell : cells) size += cell.size() + 1;
    for (const std::string& cell : cells) {
      if (size > room) break;
      std::memcpy(text, cell.data(), cell.size()), text += cell.size(), *text++ = '\n';
    }
    return {};
  });
  return status == MECHKIN_OK ? size : 0;
}
