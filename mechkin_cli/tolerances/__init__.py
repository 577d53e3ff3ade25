"""Every threshold of mechkin: name, unit, scale rule and reason, in one file for each subject.

Callers say `tolerances.NAME`, whichever file it stands in: what a threshold is about may move, and
a name stands once. Lengths are scaled by the mechanism's size (diagonal of the box of the joint
points at the first row) before they meet a limit, so the numbers are pure or radians.

The kernel is given its limits from here. What it keeps itself belongs to one algorithm each and
stands beside it with its reason (`kernel/core/`):

* `condition.hpp`: the condition up to which the estimate stands, 1e6, and how far its factors may
  be off, 5e-4; beyond, the condition is computed to rounding;
* `bushings.hpp`: turns below which series take over, and their terms;
* `linear.hpp`: cosines of Jacobi rotations, 1e-15 and 1e-8, and at most 30 sweeps;
* `judge.cpp`, `arc.cpp`, `passage.cpp`, `stretch.cpp`, `branch_point.cpp`, `tracker.cpp`: what a
  walk by arclength takes for a fold, a narrow place or a branch point, and what rounding leaves;
* `search.hpp`: damping of Levenberg-Marquardt steps;
* `position.hpp`: a Newton step beyond 1e100 is none;
* `row_curve.cpp`: rows from which a curve's derivatives are read, in parts of step and `PATH_KNOT`;
* `orbit.hpp`: states within 1e-12 of the start's are back, sought for 16 turns: rounding leaves
  1e-16 times the condition, and no linkage is known that takes more turns; `tracker.hpp`: 2e7
  steps of one path;
* `tracker.cpp`: jumps of slopes are crossed by steps of 1e-7, on which the branch may differ by
  1e-4 from the tangents of both sides: rounding and curvature leave less;
* `tracker.cpp`, `dimension_path.cpp`: a rest of 1e-6 of a step is taken along, steps grow fourfold
  at most;
* `hung_bodies.hpp`: `OPPOSITE_COSINE` again;
* `closing_equations.hpp`, `tree_joints.hpp`: 1e-150, just above the root of the least normal
  double; `arithmetic/`: where one formula takes over from another.
"""

from __future__ import annotations

from mechkin_cli.tolerances.bridges import *
from mechkin_cli.tolerances.closing import *
from mechkin_cli.tolerances.mobility import *
from mechkin_cli.tolerances.reading import *
from mechkin_cli.tolerances.results import *
from mechkin_cli.tolerances.statics import *
from mechkin_cli.tolerances.vibration import *
