// The copy of the kernel that computes in double-double, with MECHKIN_LANES and MECHKIN_UNIT set by the build.
#define MECHKIN_WIDE_PLAN
#include "plan/parted_plan.hpp"

#include "rows/double_double_unit.hpp"

#include "rows/factored_block.hpp"
#include "rows/row_run.hpp"
#include "tape/tape_replay.hpp"

namespace {

const Plan& plan_at(const char* memory) { return *reinterpret_cast<const Plan*>(memory); }

long precise_workspace_size(const char* plan) { return workspace_size(plan_at(plan)); }

void run_precise_rows(const char* plan, const Request& r, long begin, long end, char* workspace) {
  run_rows(plan_at(plan), r, begin, end, workspace);
}

const DoubleDoubleUnit unit = {LANES, join_parts, precise_workspace_size, run_precise_rows, replay_size, replay};

}  // namespace

extern "C" const DoubleDoubleUnit* MECHKIN_UNIT() { return &unit; }
