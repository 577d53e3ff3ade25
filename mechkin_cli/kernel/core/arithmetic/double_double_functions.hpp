// The elementary functions in double-double, and the doubles' that they start from.
#pragma once

#include "arithmetic/double_double_exponential.hpp"
#include "arithmetic/double_double_trigonometric.hpp"
#include "arithmetic/trigonometric.hpp"
