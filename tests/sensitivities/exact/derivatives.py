"""Derivatives of everything the oracle tells by a parameter, at 80 digits.

The file is read with the parameter larger and smaller by 1e-22 of its unit and closed by the
oracle's own Newton steps; a central difference then has 40 digits.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from oracle import Solution, UnsolvableError, assemble, mp, newton_euler, read
from oracle.bodies import Bodies, Placement
from oracle.forces import powers_of
from oracle.vectors import IDENTITY, subtract, transpose
from properties.expected import expected, motion_of
from sensitivities.exact.files import Data, mark, spatial

DIGITS = 80
STEP = "1e-22"
Numbers = dict[str, np.ndarray]
Told = Callable[[str], Any]


class Row:
    """A row of a file, as it is and with its parameters shifted.

    Args:
        data: the file.
        row: which row of its motion.
        told: what the code under test tells of a name at this row, in the file's units, None for
            what it does not know: the first guess of the links' places.
    """

    def __init__(self, data: Data, row: int, told: Told) -> None:
        self.data, self.row = data, row
        self.twins = [spatial(data)]
        if "plane" in data:
            self.twins.append(spatial(data, freed=True))
        with mp.workdps(DIGITS):
            self.bases = [self._first(twin, told) for twin in self.twins]
            self.unique = [_is_unique(base) for base in self.bases]

    def own(self) -> Numbers:
        """What the oracle tells of the row, in the base of its units."""
        with mp.workdps(DIGITS):
            return self._joined(list(self.bases))

    def derivatives(self, name: str, unit: str) -> Numbers:
        """The same, derived by a parameter in a unit.

        Raises:
            UnsolvableError: the loops do not close beside the parameter's value.
        """
        with mp.workdps(DIGITS):
            above, below = (
                self._joined([self._beside(k, name, f"{sign}{STEP} {unit}") for k in self._each])
                for sign in "+-"
            )
            return {key: (above[key] - below[key]) / (2 * mp.mpf(STEP)) for key in above}

    @property
    def _each(self) -> range:
        return range(len(self.twins))

    def _first(self, twin: Data, told: Told) -> Solution:
        mechanism = read(twin)
        start = _guess(twin, Bodies(mechanism), told)
        return assemble(mechanism, mechanism.row(self.row), placement=start)

    def _beside(self, which: int, name: str, change: str) -> Solution:
        twin = self.twins[which]
        mechanism = read(twin, **{name: f"({twin['parameters'][name]}) {change}"})
        return assemble(mechanism, mechanism.row(self.row), guess=self.bases[which])

    def _joined(self, solutions: list[Solution]) -> Numbers:
        """Of a file in a plane the motion of its twin in space, the loads of the freed one."""
        found: Numbers = {}
        for solution, unique in zip(reversed(solutions), reversed(self.unique), strict=True):
            one = _numbers(solution, unique)
            joints = solution.mechanism.joints.items() if "plane" in self.data else ()
            slides = tuple(f"{n}.s" for n, joint in joints if joint.type == "Sg")
            found |= {k: v for k, v in one.items() if not k.startswith(slides)}
        if "plane" in self.data:
            found = _in_a_plane(found)
        return found


def _is_unique(solution: Solution) -> bool:
    try:
        newton_euler(solution.mechanism, solution)
    except UnsolvableError:
        return False
    return True


def _numbers(solution: Solution, unique: bool) -> Numbers:
    mechanism = solution.mechanism
    if unique:
        return expected(mechanism, solution, newton_euler(mechanism, solution))
    found = motion_of(mechanism, solution)
    if len(solution.inputs) == 1 and solution[f"{solution.inputs[0]}_dot"]:
        # with constraints that are redundant power still tells the one effort
        (name,) = solution.inputs
        effort = -mp.fsum(powers_of(mechanism, solution, {})) / solution[f"{name}_dot"]
        found[f"{name}.effort"] = np.array([effort], dtype=object)
    return found


def _in_a_plane(found: Numbers) -> Numbers:
    """By the names of a pin in a slot, of which the block's pin has angle and force."""
    pins = {name.split(".")[0] for name in found if name.split(".")[0].endswith("_pin")}
    for pin in pins:
        own = pin.removesuffix("_pin")
        found = {k: v for k, v in found.items() if not k.startswith(f"{own}.") or _of_slot(k)}
        moved = [k for k in found if k.startswith(f"{pin}.")]
        moved = {f"{own}.{k.partition('.')[2]}": found.pop(k) for k in moved}
        found |= {k: v for k, v in moved.items() if not _of_slot(k)}
    return found


def _of_slot(name: str) -> bool:
    return name.partition(".")[2].partition("_")[0] in ("s", "axis")


def _guess(twin: Data, bodies: Bodies, told: Told) -> Placement:
    """The links' places as the marked points tell them in double precision."""
    units = bodies.mechanism.units
    length, angle = units.of("length"), units.of("angle")

    def corner(number: int, name: str) -> list[Any]:
        place = told(f"{mark(number, name)}.position")
        return [mp.mpf(float(x)) for x in [*place, 0.0][:3]]

    poses: dict[str, Any] = {"ground": (IDENTITY, [mp.zero] * 3)}
    number = 0
    for link in bodies.mechanism.links:
        if link.endswith("_block"):
            continue
        flat = told(f"{mark(number, 'z')}.position") is None
        origin = corner(number, "origin")
        columns = [subtract(corner(number, c), origin) for c in "xy"]
        columns.append([0, 0, 1] if flat else subtract(corner(number, "z"), origin))
        poses[link] = transpose(columns), [x * length for x in origin]
        number += 1
    for name, joint in twin["joints"].items():
        block = f"{name}_block"
        if block in bodies.mechanism.links:
            poses[block] = poses[joint["links"][0]]  # the slotted link, along which it slides
    angles: dict[str, dict[str, Any]] = {}
    for name, joint in bodies.mechanism.joints.items():
        angles[name] = {}
        for c in joint.coordinates:
            value = told(f"{name}.{c}")
            unit = angle if c.startswith("theta") else length
            angles[name][c] = mp.mpf(0.0 if value is None else float(value)) * unit
    return bodies.placed(poses, angles)
