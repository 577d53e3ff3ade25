// One instruction set's copy of the kernel: compiled once per width, with MECHKIN_LANES and
// MECHKIN_UNIT set by the build.
#include "rows/unit.hpp"

#include "rows/band_steps.hpp"
#include "rows/condition.hpp"
#include "arithmetic/elementwise.hpp"
#include "rows/row_run.hpp"
#include "rows/interpolation.hpp"
#include "rows/search.hpp"
#if MECHKIN_LANES == 2  // one set of inputs at a time: the narrowest unit does for all
#include "tape/tape_jets.hpp"
#endif

namespace {

void search_rows(const Plan& p, const SearchRequest& r, long begin, long end, char* memory) {
  Workspace w = workspace_at(p, memory);
  for (long row = begin; row < end; row += LANES) {
    const int count = end - row < LANES ? (int)(end - row) : LANES;
    const Reader in = {r.rows, row, count};
    for (int s = 0; s < p.states; ++s) w.q[s] = in.get(r.states, s);
    for (int i = 0; i < p.inputs; ++i) w.q[p.column_state[p.input_column[i]]] = in.get(r.inputs, i);
    for (int b = 0; b < r.block; ++b) place_block(p, w, p.block[b]);
    if (p.block[r.block].charts) leave_free(p, w);
    const Pack residual = search_block(p, w, r.block, r.iterations, r.accept);
    for (int s = 0; s < p.states; ++s) Writer{r.states, r.rows, row, count}.put(s, w.q[s]);
    Writer{r.residual, r.rows, row, count}.put(0, residual);
    write_flags(r.flags, in, residual <= Pack(r.accept), block_side_conditions(p, w, p.block[r.block]));
  }
}

template <class Entry>
constexpr TreeType tree_type() {
  return {Entry::freedoms, Entry::states, Entry::slides};
}
// in the order of TreeCode
constexpr TreeType tree_types[TREE_CODES] = {tree_type<Turn>(),         tree_type<Slide>(),       tree_type<Screw>(),
                                             tree_type<TurnAndSlide>(), tree_type<Orientation>(), tree_type<Fixed>(),
                                             tree_type<Fixed>(),        tree_type<Carriage<1>>(), tree_type<Carriage<2>>()};

// in the order of their codes
template <class... All>
struct PairTypes;
template <class... All>
struct PairTypes<Entries<All...>> {
  static constexpr PairType table[] = {{All::letter, All::equations, All::lengths, All::coordinates(), All::turns()}...};
};

#if MECHKIN_LANES != 2
constexpr long (*jets_size)(const Tape&) = nullptr;
constexpr void (*replay_jets)(const Tape&, const double*, const double*, double*, char*) = nullptr;
#endif

const KernelUnit unit = {LANES, tree_types, PairTypes<Pairs>::table, Pairs::count, workspace_size, prepare, run_row, run_rows,
                         search_rows, band_room, judge_band_step, elementwise, interpolate, replay_size, replay, jets_size,
                         replay_jets};

}  // namespace

extern "C" const KernelUnit* MECHKIN_UNIT() { return &unit; }
