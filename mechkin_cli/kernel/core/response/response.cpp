#include "response/response.hpp"

#include <algorithm>

#include "rows/threads.hpp"
#include "rows/units.hpp"

namespace {

// The longest step of a motion whose loads read the time, in parts of its duration: steps that grow while nothing happens
// would pass over a load that comes and goes. Such a motion ends a step at every row, however dense.
constexpr double PART_OF_TIME = 1.0 / 64.0;

bool reads_time(const Plan& plan) {
  for (int k = 0; k < plan.law.reads; ++k)
    if (plan.law.read[k].kind == READ_TIME) return true;
  return false;
}

// A pack of variants from `first` on; lanes beyond the last repeat it, into rows of their own.
Refusal respond_pack(const ResponseTask& task, const MotionUnit& unit, long first, std::vector<ResponseReport>* reports) {
  const long count = (long)task.starts.size();
  std::vector<MotionStart> starts;
  std::vector<MotionRows> rows;
  for (int l = 0; l < unit.lanes; ++l) {
    const long v = std::min(first + l, count - 1);
    starts.push_back(task.starts[v]);
    rows.push_back(task.rows[v]);
    if (first + l >= count) rows.back().rows = 0;
  }
  IntegratorSettings settings = task.settings;
  MotionLimits limits = task.limits;
  const long moments = task.moments < 0 ? rows[0].rows : task.moments;
  const RowTimes times = {task.times, moments, 0, task.spaced, task.part};
  limits.longest = __builtin_inf();
  if (reads_time(*starts[0].plan) && moments > 0) {
    settings.dense_rows = (int)std::min<long>(moments + 1, 1 << 30);
    limits.longest = PART_OF_TIME * (times.at(0, moments - 1) - starts[0].time);
  }
  ChartedMotion motion(unit, starts, limits, rows, task.stops, task.driven);
  std::vector<double> begin;
  for (const MotionStart& s : starts) begin.push_back(s.time);
  Result<std::vector<LaneReport>> reached =
      integrate(motion, settings, begin.data(), motion.start(), times);
  CHECK(reached.refusal());
  const std::vector<LaneReport>& found = *reached;
  for (int l = 0; l < unit.lanes && first + l < count; ++l)
    (*reports)[first + l] = {found[l], motion.first_row(l), motion.stopped_by(l), motion.undecided_joints(l, found[l]),
                             motion.lightest(l), motion.growth(l), motion.energy(l), motion.last_place(l), motion.crossings(l), motion.touches(l),
                             motion.branch_point_near(l), motion.is_next_to_singular(l)};
  return {};
}

}  // namespace

Result<std::vector<ResponseReport>> respond(const ResponseTask& task, int lanes, int threads) {
  const long count = (long)task.starts.size();
  std::vector<ResponseReport> reports((std::size_t)count);
  const MotionUnit& unit = *motion_unit(lanes);
  const long packs = (count + unit.lanes - 1) / unit.lanes;
  std::vector<Refusal> refusals((std::size_t)packs);
  over_rows(packs, 1, (int)std::min<long>(threads, packs), [&](long begin, long end, int) {
    for (long pack = begin; pack < end; ++pack)
      refusals[(std::size_t)pack] = respond_pack(task, unit, pack * unit.lanes, &reports);
  });
  for (const Refusal& refusal : refusals) CHECK(refusal);
  return reports;
}
