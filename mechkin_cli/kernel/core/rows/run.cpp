#include "rows/run.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "plan/program_store.hpp"
#include "rows/aligned.hpp"
#include "rows/threads.hpp"

namespace {

constexpr long LEAST_CHUNK = 64;  // rows: whole packs of every width

// Rows that a thread takes at a time: several chunks a thread, since threads are not equally fast; whole packs of
// every width.
long chunk_of(long rows, int threads) {
  const long chunk = std::clamp(rows / (8L * threads), LEAST_CHUNK, 4096L);
  return (chunk + LEAST_CHUNK - 1) / LEAST_CHUNK * LEAST_CHUNK;
}

int threads_for(long rows, int threads) {
  const long chunks = (rows + LEAST_CHUNK - 1) / LEAST_CHUNK;
  return (int)std::min<long>(std::max(chunks, 1L), threads);
}

// Calls work(begin, end, workspace) for all rows, with a workspace a thread, all of them there before the first row is
// begun.
template <class Work>
void share_out(long rows, long chunk, int threads, long size, const Work& work) {
  // laid out by each unit, which reads nothing that it has not written: clearing it would take a short call longer than its rows
  const std::unique_ptr<char[]> memory(new char[(std::size_t)size * threads]);
  FloatingPointState state;
  over_rows(rows, chunk, threads,
            [&](long begin, long end, int thread) { work(begin, end, memory.get() + thread * size); });
}

}  // namespace

Refusal check_demand(const Request& r, const OutputList* outputs, const Plan& p) {
  const auto demands = [&r](unsigned part) { return (r.demand & part) != 0; };
  const bool velocity = demands(DEMAND_VELOCITY), acceleration = demands(DEMAND_ACCELERATION);
  const bool jerk = demands(DEMAND_JERK), forces = demands(DEMAND_FORCES);
  const bool condition = demands(DEMAND_CONDITION), power = demands(DEMAND_POWER);
  REQUIRE(!r.demand || !p.columns || p.blocks || p.inputs, "a tree without inputs and blocks has poses only");
  REQUIRE(!outputs == !r.outputs, "outputs and values are given together");
  REQUIRE(!outputs || !(outputs->demand() & ~r.demand), "the outputs need more than is demanded");
  REQUIRE(!p.charts || r.chart, "a plan with a chart needs its directions");
  REQUIRE(!p.charts || !velocity || r.chart_rates, "velocities need rates of the chart");
  REQUIRE(!p.charts || !acceleration || r.chart_accelerations, "accelerations need accelerations of the chart");
  REQUIRE(!p.charts || !jerk, "a chart has no jerks");
  REQUIRE(!velocity || r.rates, "velocities need rates of the inputs");
  REQUIRE(!acceleration || (velocity && r.accelerations), "accelerations need rates and accelerations of the inputs");
  REQUIRE(!jerk || (acceleration && r.jerks), "jerks need accelerations, and jerks of the inputs");
  REQUIRE(forces || (!r.loads && !r.undefined), "the values of loads go with forces");
  REQUIRE(!forces || !(program_demand(p.law) & ~r.demand), "loads that vary need more than is demanded");
  REQUIRE(!forces || !p.input_constraints || r.constraint_rates, "forces need the rates of led inputs");
  REQUIRE(!forces || !p.frictions || acceleration, "forces with friction need accelerations");
  REQUIRE(!power || forces, "the power error needs forces");
  REQUIRE(condition == (r.condition != nullptr), "an array for the condition goes with its demand");
  REQUIRE(power == (r.power_error != nullptr), "an array for the power error goes with its demand");
  REQUIRE(velocity || !r.velocities, "first derivatives are not demanded");
  REQUIRE(acceleration || !r.second, "second derivatives are not demanded");
  return {};
}

void run_rows(const Plan& p, const Request& r, const KernelUnit& unit, int most_threads) {
  const int threads = threads_for(r.rows, most_threads);
  share_out(r.rows, chunk_of(r.rows, threads), threads, unit.workspace_size(p),
            [&](long begin, long end, char* workspace) { unit.run_rows(p, r, begin, end, workspace); });
}

bool run_rows(const Plan& p, const Request& r, const KernelUnit& unit, int most_threads, const RowLimits& limits) {
  const int threads = threads_for(r.rows, most_threads);
  std::atomic<bool> closed{true};
  share_out(r.rows, chunk_of(r.rows, threads), threads, unit.workspace_size(p),
            [&](long begin, long end, char* workspace) {
              unit.run_rows(p, r, begin, end, workspace);
              // a thread's first row beside that of all, which may not be there yet, is looked at below
              if (!all_closed(r, p.blocks, limits, begin, end)) closed = false;
            });
  for (long row = 0; closed && row < r.rows; row += LEAST_CHUNK) closed = on_one_side(r, p.blocks, 0, row);
  return closed;
}

void search_rows(const Plan& p, const SearchRequest& r, const KernelUnit& unit, int threads) {
  share_out(r.rows, LEAST_CHUNK, threads_for(r.rows, threads), unit.workspace_size(p),
            [&](long begin, long end, char* workspace) { unit.search_rows(p, r, begin, end, workspace); });
}

void run_rows(const Plan& high, const Plan* low, const Request& r, const DoubleDoubleUnit& unit, int most_threads) {
  // both as one plan, which refers to them
  std::vector<char, AlignedAllocator<char>> both((std::size_t)unit.join(high, low, nullptr));
  unit.join(high, low, both.data());
  const int threads = threads_for(r.rows, most_threads);
  share_out(r.rows, chunk_of(r.rows, threads), threads, unit.workspace_size(both.data()),
            [&](long begin, long end, char* workspace) { unit.run_rows(both.data(), r, begin, end, workspace); });
}
