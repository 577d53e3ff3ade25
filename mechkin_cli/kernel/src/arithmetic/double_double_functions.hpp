// The elementary functions in double-double, and the doubles' that they start from.
#pragma once

#include "double_double_exponential.hpp"
#include "double_double_trigonometric.hpp"
#include "trigonometric.hpp"
