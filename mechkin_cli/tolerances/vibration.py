"""Limits of small motions."""

from __future__ import annotations

from typing import Final

SMALL_IMBALANCE: Final = 1e-9
"""Effort along a coordinate, in parts of the largest stiffness (per rad or m), below which a row is
said to be in balance: equilibria are found to 1e-12 of the largest load."""

NO_BEND: Final = 1e-13
"""Force along a chart, in parts of its largest stiffness, below which what holds a place adds
nothing to the stiffness: that is right to 1e-12."""

SYMMETRIC_STIFFNESS: Final = 1e-9
"""Part of a matrix's largest entry, scaled to the inertia, by which it may be unsymmetric or damp
and still count as symmetric, or as no damping: differences of forces leave up to 1e-11."""

RIGID_MOTION: Final = 1e-9
"""Square of an angular frequency, in parts of the largest, below which a motion has no stiffness:
differences of forces leave up to 1e-12 of the largest stiffness."""

PARAMETER_STEP: Final = 1e-3
"""Step of a parameter, in parts of its value, by which frequencies are differentiated: the fourth
order leaves 1e-12 of a smooth frequency, and rounding 1e-11."""

WELL_TOLD: Final = 8.0
"""Rates of joints, rad or length units for one of an input, up to which the inputs of a sweep tell
its motion so well that steps along them do as well as such along the motion itself."""

UNSETTLED: Final = 1e-3
"""Difference of the orders six and eight of a derivative, in parts of its largest entry, above
which forces bend or jump there: of a jump or an edge the shortest step still tells a tenth."""

NO_RATE: Final = 1e-6
"""Stiffness (1/s^2) or damping (1/s) in parts of the inertia that is none: its motions take an
hour. Rounding of forces that do not change leaves less."""
