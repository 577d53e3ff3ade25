// Python's view of the stepper and of following rows; needs the class Plan bound before.
#pragma once

#include <nanobind/nanobind.h>

void bind_stepper(nanobind::module_& m);
