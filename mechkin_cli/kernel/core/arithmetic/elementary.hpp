// The elementary functions of the kernel for packs: sincos, sin, cos, tan, atan2, atan, asin, acos,
// exp, log, pow. They stand in for the C library's, whose bits change with the machine.
#pragma once

#include "arithmetic/pack.hpp"

#if MECHKIN_ARITHMETIC == MECHKIN_DOUBLE_DOUBLE
#include "arithmetic/double_double_functions.hpp"
#elif MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
#include "arithmetic/interval_functions.hpp"
#elif MECHKIN_ARITHMETIC == MECHKIN_TAYLOR
#include "arithmetic/taylor_functions.hpp"
#else
#include "arithmetic/exponential.hpp"
#include "arithmetic/inverse_trigonometric.hpp"
#include "arithmetic/trigonometric.hpp"
#endif
