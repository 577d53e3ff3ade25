"""What every joint demands of the poses of its two links, and its coordinates there.

With the poses x -> R x + p of the first (1) and the second (2) link, P and a the point and the
axis of a link, e, g two unit vectors square to a1, and Z the rotation at zero:

    points together      P2 - P1 = 0                          gap along the axis   (P2 - P1) . a1
    gap on the axis      (P2 - P1) . e1 = (P2 - P1) . g1 = 0
    axes parallel        e1 . a2 = g1 . a2 = 0, beside a1 . a2 > 0
    no turn              e1 . Z'g2 = 0, beside e1 . Z'e2 > 0
    theta                the angle of cosine e1 . Z'e2 and sine g1 . Z'e2

Everything works on numbers and on series.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from oracle.mechanism import Joint
from oracle.numerics import Number, mp
from oracle.series import angle
from oracle.vectors import (
    IDENTITY,
    Matrix,
    add,
    apply,
    cross,
    dot,
    scale,
    subtract,
    transpose,
    unit,
)

Pose = tuple[Matrix, Any]
Angles = dict[str, Number]
"""Values near which the angles of a joint are looked for, by coordinate."""


@dataclass(frozen=True)
class Equation:
    """What must be zero; `length` tells whether it counts in lengths."""

    value: Any
    length: bool


class Pair:
    """A joint between two posed links."""

    def __init__(self, joint: Joint, first: Pose, second: Pose) -> None:
        self.joint = joint
        self.first, self.second = first, second
        p, other = joint.points
        self.gap = subtract(_placed(second, other), _placed(first, p))
        a = joint.axes[0] if joint.axes else IDENTITY[2]
        e = _square_to(a)
        self._bases = (a, e, cross(a, e))

    def on_first(self, vector: Any) -> Any:
        return apply(self.first[0], vector)

    def on_second(self, vector: Any) -> Any:
        return apply(self.second[0], vector)

    def axis(self, side: int) -> Any:
        assert self.joint.axes is not None
        turned = (self.on_first, self.on_second)[side]
        return turned(self.joint.axes[side])

    def _matched(self, vector: Any) -> Any:
        """A direction of the first link's drawing as the second carries it at zero."""
        return self.on_second(apply(transpose(self.joint.zero), vector))

    def together(self) -> list[Equation]:
        return [Equation(x, True) for x in self.gap]

    def gap_on_axis(self) -> list[Equation]:
        return [Equation(dot(self.gap, self.on_first(v)), True) for v in self._bases[1:]]

    def parallel(self) -> list[Equation]:
        other = self.axis(1)
        return [Equation(dot(self.on_first(v), other), False) for v in self._bases[1:]]

    def locked(self) -> list[Equation]:
        a, e, g = self._bases
        matched = self._matched(a)
        equations = [Equation(dot(self.on_first(v), matched), False) for v in (e, g)]
        return [*equations, Equation(dot(self.on_first(e), self._matched(g)), False)]

    def theta(self, near: Number) -> Any:
        _, e, g = self._bases
        matched = self._matched(e)
        return angle(dot(self.on_first(e), matched), dot(self.on_first(g), matched), near)

    def along(self) -> Any:
        return dot(self.gap, self.axis(0))

    def sides(self) -> list[Any]:
        """What must be positive beside the equations."""
        match self.joint.type:
            case "R" | "C" | "H" | "E":
                return [dot(self.axis(0), self.axis(1))]
            case "P" | "W":
                return [dot(self.on_first(v), self._matched(v)) for v in self._bases[:2]]
        return []


def equations(pair: Pair, near: Angles) -> list[Equation]:
    """The 6 - f equations of a joint."""
    return _EQUATIONS[pair.joint.type](pair, near)


def coordinates(pair: Pair, near: Angles) -> dict[str, Any]:
    """The joint's coordinates by name."""
    joint = pair.joint
    found: dict[str, Any] = {}
    match joint.type:
        case "U":
            found = _universal_angles(pair, near)
        case "Sg":
            found["s"] = -dot(pair.gap, pair.axis(1))
        case "E":
            found["x"] = dot(pair.gap, pair.on_first(joint.x))
            y = cross(joint.axes[0], joint.x)  # type: ignore[index]
            found["y"] = dot(pair.gap, pair.on_first(y))
        case "P" | "C" | "H":
            found["s"] = pair.along()
    if "theta" in joint.coordinates:
        found["theta"] = pair.theta(near["theta"])
    return found


def _universal_angles(pair: Pair, near: Angles) -> dict[str, Any]:
    """theta1 turns axis2 from its drawn place about axis; theta2 turns axis back about axis2."""
    a, b = pair.joint.axes  # type: ignore[misc]
    across = cross(a, b)
    first, second = pair.axis(0), pair.axis(1)
    # square to axis: the drawn axis2 as the first link carries it; then the same for axis2
    from_first = pair.on_first(unit(subtract(b, scale(a, dot(a, b)))))
    from_second = pair.on_second(unit(subtract(a, scale(b, dot(a, b)))))
    normal_first, normal_second = (
        scale(turned(across), 1 / mp.sqrt(dot(across, across)))
        for turned in (pair.on_first, pair.on_second)
    )
    return {
        "theta1": angle(dot(second, from_first), dot(second, normal_first), near["theta1"]),
        # theta2 carries the drawn axis away from where the first link holds it
        "theta2": angle(dot(first, from_second), dot(first, normal_second), near["theta2"]),
    }


def _universal(pair: Pair, near: Angles) -> list[Equation]:
    a, b = pair.joint.axes  # type: ignore[misc]
    turned = dot(pair.axis(0), pair.axis(1)) - dot(a, b)
    return [*pair.together(), Equation(turned, False)]


def _helical(pair: Pair, near: Angles) -> list[Equation]:
    assert pair.joint.lead is not None
    advance = pair.theta(near["theta"]) * (pair.joint.lead / (2 * mp.pi))
    return [*pair.parallel(), *pair.gap_on_axis(), Equation(pair.along() - advance, True)]


def _in_plane(pair: Pair, near: Angles) -> list[Equation]:
    """The sphere of the first link in the plane of the second."""
    return [Equation(dot(pair.gap, pair.axis(1)), True)]


def _in_groove(pair: Pair, near: Angles) -> list[Equation]:
    axis = pair.joint.axes[1]  # type: ignore[index]
    e = _square_to(axis)
    return [Equation(dot(pair.gap, pair.on_second(v)), True) for v in (e, cross(axis, e))]


_EQUATIONS: dict[str, Callable[[Pair, Angles], list[Equation]]] = {
    "R": lambda pair, near: [*pair.together(), *pair.parallel()],
    "P": lambda pair, near: [*pair.gap_on_axis(), *pair.locked()],
    "C": lambda pair, near: [*pair.gap_on_axis(), *pair.parallel()],
    "H": _helical,
    "S": lambda pair, near: pair.together(),
    "Sp": _in_plane,
    "Sg": _in_groove,
    "U": _universal,
    "E": lambda pair, near: [*pair.parallel(), Equation(pair.along(), True)],
    "W": lambda pair, near: [*pair.together(), *pair.locked()],
}


def _placed(pose: Pose, place: Any) -> Any:
    return add(apply(pose[0], place), pose[1])


def _square_to(axis: Any) -> list[Number]:
    """A unit vector square to a unit vector."""
    least = min(range(3), key=lambda i: abs(axis[i]))
    return unit(cross(axis, IDENTITY[least]))
