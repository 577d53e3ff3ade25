"""A general 7R loop in numbers for the peers and as a file.

Seven lines are always an assembled drawing. The short first link lets the input make a full turn.
Joint Jk joins link k - 1 to link k; links 0 and 7 are ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

RATE, ACCELERATION = 2.0, 0.7
"""Of the input, rad/s and rad/s^2."""

GRAVITY = (0.3, -9.0, -3.5)
"""In a generic direction, m/s^2."""

SPAN = (0.0, 360.0)
"""The sweep, degrees of J1."""

FULL_TURN = "from: 0 deg, to: 360 deg, step: 1 deg"
"""The sweep of 361 rows."""

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Line:
    """A joint's line in the home drawing: direction (of any length) and a point, m."""

    axis: Vector
    point: Vector


@dataclass(frozen=True)
class Body:
    """A link: mass, kg; mass centre in the home drawing, m; (xx, yy, zz, xy, xz, yz), kg m^2."""

    mass: float
    centre: Vector
    tensor: tuple[float, ...]


@dataclass(frozen=True)
class Loop:
    """The seven lines and the six moving links between them."""

    lines: tuple[Line, ...]
    bodies: tuple[Body, ...]


LINES = (
    Line((0.505, -0.098, 0.858), (1.3, 0.0, -0.396)),
    Line((0.36, -0.152, 0.921), (1.143, 0.133, -0.474)),
    Line((-0.204, -0.693, 0.691), (0.602, 1.14, -0.376)),
    Line((-0.983, -0.168, 0.074), (-0.471, 1.025, 0.665)),
    Line((0.391, 0.802, 0.452), (-1.28, 0.23, -0.021)),
    Line((-0.196, 0.49, -0.849), (-0.697, -1.075, 0.037)),
    Line((0.9, -0.099, -0.424), (0.774, -0.895, 0.4)),
)

BODIES = (
    Body(0.9, (1.336, 0.031, -0.433), (0.0437, 0.0392, 0.0356, 0.0049, -0.0001, -0.0031)),
    Body(1.1, (0.798, 0.647, -0.376), (0.0941, 0.0875, 0.0926, -0.006, 0.0042, 0.0037)),
    Body(0.8, (-0.006, 1.151, 0.166), (0.0561, 0.0545, 0.0533, 0.0009, 0.0006, -0.0004)),
    Body(1.3, (-0.828, 0.703, 0.407), (0.0626, 0.0561, 0.0643, 0.0016, -0.0102, 0.0038)),
    Body(0.7, (-0.948, -0.34, -0.003), (0.0608, 0.0389, 0.0586, -0.0006, -0.0001, 0.0062)),
    Body(1.0, (0.1, -0.977, 0.243), (0.0707, 0.0602, 0.0635, 0.0108, -0.0095, 0.0164)),
)

JOINTS = tuple(f"J{k}" for k in range(1, len(LINES) + 1))
COORDINATES = tuple(f"{joint}.theta" for joint in JOINTS[1:])
LOADS = ("J1.effort", *(f"{joint}.{part}" for joint in JOINTS for part in ("force", "moment")))
TENSOR_ENTRIES = ("xx", "yy", "zz", "xy", "xz", "yz")


def dimensions(scale: float = 1.0) -> Loop:
    """The loop with all lengths times `scale`, tensors times its square."""

    def longer(v: Vector) -> Vector:
        x, y, z = v
        return (x * scale, y * scale, z * scale)

    square = scale * scale
    return Loop(
        tuple(Line(line.axis, longer(line.point)) for line in LINES),
        tuple(
            Body(
                body.mass,
                longer(body.centre),
                tuple(x * square for x in body.tensor),
            )
            for body in BODIES
        ),
    )


def text(motion: str = FULL_TURN, loop: Loop | None = None) -> str:
    """The mechanism file; `motion` gives the values of J1.theta, as `values: [0.1, 0.2]` (rad).

    Its one table has every angle, rate and acceleration, the effort and all joint wrenches.
    """
    loop = loop or dimensions()
    names = ("ground", *(f"link{k}" for k in range(1, len(BODIES) + 1)), "ground")
    lines = ["format: 1", "name: general 7R", "units: {length: m, angle: rad, mass: kg, force: N}"]
    lines += ["links:"]
    for name, body in zip(names[1:], loop.bodies, strict=False):
        tensor = zip(TENSOR_ENTRIES, body.tensor, strict=True)
        entries = ", ".join(f"{entry}: {value!r}" for entry, value in tensor)
        lines += [
            f"  {name}:",
            f"    {{mass: {body.mass!r}, center_of_mass: {list(body.centre)},"
            f" inertia: {{{entries}}}}}",
        ]
    lines += ["joints:"]
    for k, (joint, line) in enumerate(zip(JOINTS, loop.lines, strict=True)):
        lines += [
            f"  {joint}: {{type: R, links: [{names[k]}, {names[k + 1]}],"
            f" point: {list(line.point)}, axis: {list(line.axis)}}}"
        ]
    drive = f"{motion}, rate: {RATE!r} rad/s, acceleration: {ACCELERATION!r} rad/s^2"
    lines += ["motion:", "  inputs:", f"    J1.theta: {{{drive}}}"]
    lines += ["loads:", f"  - {{type: gravity, g: {list(GRAVITY)}}}"]
    lines += ["tables:", "  - name: everything", "    columns:"]
    lines += [f"      - {{label: {label}, value: {value}}}" for label, value in columns()]
    return "\n".join(lines) + "\n"


def columns() -> Sequence[tuple[str, str]]:
    """Label and value of every column of the table."""
    found = [("theta1", "J1.theta")]
    for suffix in ("", "_dot", "_ddot"):
        found += [(f"theta{k}{suffix}", f"{name}{suffix}") for k, name in enumerate(COORDINATES, 2)]
    found += [("effort", "J1.effort")]
    for joint in JOINTS:
        for part in ("force", "moment"):
            found += [(f"{joint}_{part}_{i}", f"{joint}.{part}.{i}") for i in "xyz"]
    return found
