// Places at which loads balance.
#pragma once

#include <nanobind/nanobind.h>

#include "plan/frozen_plan.hpp"

// How many of some places, from the first one on, come to an equilibrium; see rows/balance.hpp.
long balance_places(const FrozenPlan& plan, const nanobind::kwargs& keywords);
