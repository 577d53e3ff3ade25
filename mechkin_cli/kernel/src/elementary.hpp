// The elementary functions of the kernel for packs: sincos, sin, cos, tan, atan2, atan, asin, acos,
// exp, log, pow. They stand in for the C library's, whose bits change with the machine.
#pragma once

#include "exponential.hpp"
#include "inverse_trigonometric.hpp"
#include "trigonometric.hpp"
