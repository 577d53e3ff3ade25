// Lines between two points that meet, and directions that vanish beside another.
#pragma once

#include "arithmetic/pack.hpp"

namespace {

#if MECHKIN_ENCLOSES

// Unknown where the interval reaches zero.
MECHKIN_INLINE Pack inverse_or_zero(Pack length) { return Pack(1.0) / length; }
MECHKIN_INLINE Pack known_tension(Pack, Pack tension) { return tension; }

#else

MECHKIN_INLINE Pack inverse_or_zero(Pack length) {
  const Mask some = length > Pack(0.0);
  return select(some, Pack(1.0) / select(some, length, Pack(1.0)), Pack(0.0));
}
// Where the ends of a line meet it is lost: no force if there is no tension, else no number.
MECHKIN_INLINE Pack known_tension(Pack length, Pack tension) {
  return select((length > Pack(0.0)) | (tension == Pack(0.0)), tension, Pack(__builtin_nan("")));
}

#endif

}  // namespace
