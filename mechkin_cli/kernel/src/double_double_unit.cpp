// The copy of the kernel that computes in double-double, with MECHKIN_LANES and MECHKIN_UNIT set by the build.
#include "double_double_unit.hpp"

#include "tape_replay.hpp"

namespace {

const DoubleDoubleUnit unit = {LANES, replay_size, replay};

}  // namespace

extern "C" const DoubleDoubleUnit* MECHKIN_UNIT() { return &unit; }
