"""The inputs of a motion as the kernel takes them, and its numbers in words for messages.

Slides are in the kernel's length unit; a helical joint is driven by its angle. An angle that may
turn for ever is its part within half a turn and its whole turns; their sum is for ways and
messages, and rounds by its size.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Number
from mechkin_cli.exact import PI
from mechkin_cli.kernel import _kernel, functions
from mechkin_cli.mechanism import LongRun, dimension_of
from mechkin_cli.record import NamedTuple
from mechkin_cli.session.kernel_run import RowInputs
from mechkin_cli.units import ANGLE

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import DrivenInput, Frame, Joint, Problem
    from mechkin_cli.plan import Layout
    from mechkin_cli.show import Floats
    from mechkin_cli.units import CompoundUnit


# Whole turns of angles: taken off in the file's own unit, so that decimal degrees stay exact.
#
# 360 deg are exact in degrees and not in radians: 36010 deg is 100 turns and 10 deg, exactly, while
# its radians are rounded by half the last place of 628. Where a turn is no whole number of the unit
# (rad), it is subtracted in three parts with their rounding errors (W. J. Cody, W. Waite, Software
# Manual for the Elementary Functions, 1980; D. E. Knuth, The Art of Computer Programming 2, 4.2.2).

_PART_BITS = 26
"""Bits of the first parts of a turn: their products with as many bits of turns are exact."""


def reduce_angle(value: float, turn: Fraction) -> tuple[float, float]:
    """One angle; as `without_turns`."""
    if abs(value) <= 0.5 * float(turn):
        return value, 0.0
    rest, whole = without_turns(np.array([value]), turn)
    return float(rest[0]), float(whole[0])


def without_turns(
    values: Floats, turn: Fraction, *, one_by_one: bool = False
) -> tuple[Floats, Floats]:
    """Angles in (-half a turn, half a turn] and the whole turns taken off, both (rows,); where none
    goes beyond half a turn, they are left as they are.

    Args:
        values: angles.
        turn: a full turn in their unit.
        one_by_one: whether one at minus half a turn is turned whatever the others are.
    """
    size = float(turn)
    cells, _, largest, smallest = _kernel.extremes(np.ascontiguousarray(values))
    most = max(largest, -smallest)
    turned = 0.5 * size < most or (one_by_one and smallest == -0.5 * size)
    if cells < values.size or not (turned and most <= tolerances.LARGEST_TURNS * size):
        return values, np.zeros_like(values)
    whole = np.rint(values / size)
    if Fraction(size) != turn:
        rest = _subtract(values, whole, turn)
    elif size.is_integer() and most * size < float(1 << _PART_BITS):
        # the product is exact, and so is the difference: no longer than the values
        rest = values - whole * size
        np.copysign(rest, values, out=rest, where=rest == 0.0)  # as the remainder below
    else:
        rest = np.fmod(values, size)  # exact by IEEE 754
        whole = np.rint((values - rest) / size)
    for way in (1.0, -1.0):
        beyond = rest > 0.5 * size if way > 0.0 else rest <= -0.5 * size
        if beyond.any():
            here = rest[beyond]
            rest[beyond] = _subtract(here, np.full_like(here, way), turn)
            whole[beyond] += way
    return rest, whole + 0.0  # no zero has a sign


def _subtract(values: Floats, whole: Floats, turn: Fraction) -> Floats:
    """values - whole * turn to the last place."""
    if np.any(np.abs(whole) >= float(1 << _PART_BITS)):
        rows = zip(values.tolist(), whole.tolist(), strict=True)
        return np.array([float(Fraction(x) - int(k) * turn) for x, k in rows])
    first, second, third = _parts(turn)
    one, lost = _difference(values, whole * first)
    two, more = _difference(one, whole * second)
    rest: Floats = two + ((lost + more) - whole * third)
    return rest


def _difference(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """a - b and what rounding lost of it."""
    s = a - b
    t = s - a
    return s, (a - (s - t)) - (b + t)


@cache
def _parts(turn: Fraction) -> tuple[float, float, float]:
    found = []
    rest = turn
    for _ in range(2):
        places = _PART_BITS - int(np.frexp(float(rest))[1])
        scale = Fraction(1 << max(places, 0), 1 << max(-places, 0))
        part = Fraction(int(rest * scale), 1) / scale
        found.append(float(part))
        rest -= part
    return found[0], found[1], float(rest)


class KernelInputs(NamedTuple):
    """Values and their derivatives over time (inputs, rows) in kernel units.

    `reduced` are the values without the `whole` turns of angles, which threads keep.
    """

    values: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats
    reduced: Floats
    whole: Floats

    @classmethod
    def of(
        cls, problem: Problem, values: Floats, rates: Floats, accelerations: Floats, jerks: Floats
    ) -> KernelInputs:
        """Of a problem's inputs in kernel units."""
        return cls(values, rates, accelerations, jerks, *_reduced(problem, values))

    @property
    def orders(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Values, rates, accelerations and jerks."""
        return (self.values, self.rates, self.accelerations, self.jerks)

    def at_unit_rate(self, number: int) -> KernelInputs:
        """The same places, where input `number` moves at unit rate and all others are held."""
        rates = np.zeros_like(self.rates)
        rates[number] = 1.0
        still = np.zeros_like(rates)
        return self._replace(rates=rates, accelerations=still, jerks=still)

    def at_unit_acceleration(self, number: int) -> KernelInputs:
        """The same places at rest, where input `number` has unit acceleration and no other has."""
        accelerations, still = np.zeros_like(self.rates), np.zeros_like(self.rates)
        accelerations[number] = 1.0
        return self._replace(rates=still, accelerations=accelerations, jerks=still)

    def at_rest(self) -> KernelInputs:
        """The same places at rest."""
        still = np.zeros_like(self.rates)
        return self._replace(rates=still, accelerations=still, jerks=still)

    def without_accelerations(self) -> KernelInputs:
        """The same places and rates, with no acceleration."""
        still = np.zeros_like(self.rates)
        return self._replace(accelerations=still, jerks=still)

    def at(
        self,
        states: Floats,
        turned: Floats,
        time: Floats | None = None,
        constraint_rates: Floats | None = None,
    ) -> RowInputs:
        """All rows on their states (states, rows) and turns (turn slots, rows), as a run takes
        them; time (rows,) in s, and what `Session.constraint_rates` are."""
        moving = (self.rates, self.accelerations, self.jerks)
        of_rows = (constraint_rates, turned, self.whole, self.values, time)
        return RowInputs(self.reduced, states, *moving, *of_rows)

    def part(self, rows: slice | Floats) -> KernelInputs:
        """Some of the rows."""
        return KernelInputs(*(np.ascontiguousarray(array[:, rows]) for array in self))


def kernel_inputs(problem: Problem, layout: Layout) -> KernelInputs:
    """The inputs of all rows, then the coordinates that hold idle freedoms, at rest."""
    inputs, rows = problem.motion.inputs, problem.motion.rows
    units = [input_unit(layout, item) for item in inputs]
    held = held_values(problem, layout)

    def table(name: str, at: list[float]) -> Floats:
        moving = [
            getattr(i, name) if unit == 1.0 else getattr(i, name) / unit
            for i, unit in zip(inputs, units, strict=True)
        ]
        still = [np.full(rows, value) for value in at]
        return np.array([*moving, *still]) if moving or still else np.empty((0, rows))

    rest = [0.0] * len(held)
    rates, accelerations, jerks = (
        table(name, rest) for name in ("rates", "accelerations", "jerks")
    )
    return KernelInputs.of(problem, table("values", held), rates, accelerations, jerks)


def held_values(problem: Problem, layout: Layout) -> list[float]:
    """The held coordinates in kernel units."""
    joints = layout.mechanism.joints
    return [
        value / joints[name].unit_of(coordinate, layout.length)
        for (name, coordinate), value in problem.held_at.items()
    ]


def turn_of(problem: Problem, item: DrivenInput) -> Fraction | None:
    """A full turn of an input in the file's unit; None where a turn is not the same place."""
    kind = problem.mechanism.joints[item.joint].type
    if not kind.chain[kind.freedom_of[item.coordinate]].is_cyclic:
        return None
    return _turn(problem.units.angle)


def round_of(problem: Problem, item: DrivenInput) -> Fraction | None:
    """A full turn of an input that turns about an axis, in the file's unit, whether the turn is
    counted or not; None of threads and slides."""
    kind = problem.mechanism.joints[item.joint].type
    if kind.chain[kind.freedom_of[item.coordinate]].motion != "turn":
        return None
    return _turn(problem.units.angle)


@cache
def _turn(unit: CompoundUnit) -> Fraction:
    return 2 * PI / unit.factor


def _reduced(problem: Problem, values: Floats) -> tuple[Floats, Floats]:
    """The values without whole turns, and these; recorded numbers as they are."""
    whole = np.zeros(values.shape)
    reduced, motion = values, problem.motion
    # parts of a run have the bits of all its rows
    one_by_one = motion.span is not None or isinstance(motion, LongRun)
    for number, item in enumerate(problem.motion.inputs):
        turn = turn_of(problem, item)
        if turn is None or item.written.dtype != np.float64:
            continue
        rest, turns = without_turns(item.written, turn, one_by_one=one_by_one)
        if turns.any():
            reduced = values.copy() if reduced is values else reduced
            reduced[number] = problem.units.to_si(rest, ANGLE)
            whole[number] = turns
    return reduced, whole


def input_unit(layout: Layout, item: DrivenInput) -> float:
    """The SI value of one kernel unit of an input."""
    return layout.mechanism.joints[item.joint].unit_of(item.coordinate, layout.length)


def input_number(problem: Problem, layout: Layout, number: int, value: float) -> Number:
    """A value of input `number` in kernel units as a number in the file's units."""
    item = problem.motion.inputs[number]
    dimension = dimension_of(item.coordinate)
    in_file = float(problem.units.from_si(value * input_unit(layout, item), dimension))
    return Number(item.name, in_file, problem.units.label(dimension))


def input_numbers(problem: Problem, layout: Layout, values: Floats) -> tuple[Number, ...]:
    """Values of all inputs in kernel units, shape (inputs,), as numbers in the file's units; what
    is held is no input of the file."""
    count = len(problem.motion.inputs)
    return tuple(input_number(problem, layout, k, float(v)) for k, v in enumerate(values[:count]))


def input_text(number: Number) -> str:
    """An input's value as messages show it.

    >>> input_text(Number("O1.theta", 205.1376, "deg"))
    'O1.theta = 205.1376 deg'
    """
    return f"{number.name} = {number.value:.12g} {number.unit}"


# Turns: continuous angles and orientations of cut joints, whole turns of the tree's angles.
#
# The kernel has the angle of a cut joint from an arctangent and its orientation from a rotation
# matrix: whole turns and the quaternion's sign are lost. Following carries both along from node to
# node by the integral of their rates (`follow(..., turns=True)`), so each row only has to take the
# value that is nearest to what following says. The states of the tree's angles are kept within half
# a turn, where their rounding stays that of a turn, and their whole turns are counted.

ORIENTATION = -1
"""Stands for the freedom of an orientation, which has four slots."""

Four = tuple["Floats", "Floats", "Floats", "Floats"]


def closing_slots(plan: Plan) -> dict[tuple[int, int], int]:
    """The first row of `Followed.turns` of each (cut joint, freedom); freedom `ORIENTATION` of a
    joint that has no angles."""
    return {(joint, freedom): slot for joint, freedom, slot, _ in _kernel.closing_turns(plan)}


def tree_slots(plan: Plan) -> dict[int, int]:
    """The row of `Followed.turns` with the whole turns of each state that is an angle of the
    tree."""
    return dict(_kernel.tree_turns(plan))


def continuous_angle(values: Floats, followed: Floats) -> Floats:
    """An angle with the whole turns that following says.

    Args:
        values: (rows,) from an arctangent, rad.
        followed: (rows,) the same angle out of `Followed.turns`.
    """
    continuous: Floats = values - np.rint((values - followed) / (2.0 * pi)) * (2.0 * pi)
    return continuous


def continuous_signs(q: Four, followed: Four, first: int) -> Floats:
    """Signs (rows,) that make unit quaternions continuous, 1 at row `first`.

    Args:
        q: four arrays (rows,), scalar first, of either sign.
        followed: as `drawn_quaternion` gives them.
        first: a row that keeps its sign.
    """
    signs = np.where(_inner(q, followed) < 0.0, -1.0, 1.0)
    alike: Floats = signs * signs[first]
    return alike


def drawn_quaternion(joint: Joint, turns: Floats) -> Four:
    """The orientation that following carries along, (4, rows), about the axes as drawn.

    The kernel turns the joint's frame on the second link against the one on the first, R = A^T B;
    against the drawing that is A0 R B0^T.
    """
    a, b = _frame_quaternion(joint.on_first), _frame_quaternion(joint.on_second)
    r = (turns[0], turns[1], turns[2], turns[3])
    return quaternion_product(quaternion_product(a, r), (b[0], -b[1], -b[2], -b[3]))


def turned_quaternion(quaternion: Floats, vector: Floats) -> Floats:
    """Unit quaternions (4, places) turned further by rotation vectors (3, places) about fixed
    axes."""
    x, y, z = 0.5 * vector
    angle = np.sqrt(x * x + y * y + z * z)
    part = np.where(angle > 0.0, functions.sin(angle) / np.where(angle > 0.0, angle, 1.0), 1.0)
    by: Four = (functions.cos(angle), part * x, part * y, part * z)
    a, b, c, d = quaternion_product(
        by, (quaternion[0], quaternion[1], quaternion[2], quaternion[3])
    )
    return np.array([a, b, c, d]) / np.sqrt(a * a + b * b + c * c + d * d)


def _inner(p: Four, q: Four) -> Floats:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]


def quaternion_product(p: Four | Floats, q: Four | Floats) -> Four:
    """The product p q of quaternions (4, ...), scalar first: the turn q, then p."""
    (a, b, c, d), (e, f, g, h) = p, q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def _frame_quaternion(frame: Frame) -> Four:
    """The rotation whose columns are the frame's axes, as arrays of no dimension."""
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = frame.x, frame.y, frame.z
    a, b, c = m21 - m12, m02 - m20, m10 - m01
    d, e, f = m10 + m01, m20 + m02, m21 + m12
    rows = (
        (1.0 + m00 + m11 + m22, a, b, c),
        (a, 1.0 + m00 - m11 - m22, d, e),
        (b, d, 1.0 - m00 + m11 - m22, f),
        (c, e, f, 1.0 - m00 - m11 + m22),
    )
    best = max(range(4), key=lambda k: rows[k][k])
    size = sqrt(functions.total(part * part for part in rows[best]))
    w, x, y, z = (np.asarray(part / size) for part in rows[best])
    return (w, x, y, z)
