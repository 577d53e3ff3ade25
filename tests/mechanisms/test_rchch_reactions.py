"""Tables XXXIII to XXXVII from the data of section 3.7, without mechkin.

Coordinates and rates are those of `exact/rchch_kinematics_A_B.csv`, branch A. Links move by the
source's screws, negative on the left; forces follow from the equations of all links and pairs. What
the file says is not read, so that a slip of its numbers shows in the tables.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from references import committed, exact

LIMIT = 1e-10
"""Of the table's largest force or moment; committed cells have twelve digits."""

A = np.radians([0.0, 10.0, 90.0, 130.0])
"""Twist of A1 to A4 from x towards z: alpha1 = 10, alpha2 = 80, alpha3 = 40 degrees."""
A5 = np.radians(60.0)
P1, P2, P3, P4, P5, S1 = 1.0, 0.5, 0.8, 0.6, 0.4, 0.2
LEAD = {3: 2.0, 5: 5.0}
MOUT = 10.0
Y = np.array([0.0, 1.0, 0.0])

MASS = {1: 0.1, 2: 0.5, 3: 0.4, 4: 0.5}
CENTRE = {1: (0.1, 0.1, 0.01), 2: (0.2, 0.1, 0.1), 3: (0.01, 0.2, 0.01), 4: (0.1, 0.1, 0.01)}
INERTIA = {
    1: {"xx": 0.01, "yy": 0.002, "xy": 0.01, "xz": 0.001},
    2: {"yy": 0.002, "yz": 0.01, "zz": 0.02},
    3: {"xx": 0.01, "xy": 0.02, "xz": 0.001, "yy": 0.002, "yz": 0.01, "zz": 0.02},
    4: {"xx": 0.01, "xy": 0.02, "yy": 0.001, "yz": 0.01, "zz": 0.02},
}
"""As printed; entries that cannot be read are zero, products are integrals of x y dm."""


def along(angle: float) -> np.ndarray:
    return np.array([np.cos(angle), 0.0, np.sin(angle)])


HOME = {
    1: (along(A[0]), np.array([-S1, 0.0, 0.0])),
    2: (along(A[1]), np.array([-S1, -P1, 0.0])),
    3: (along(A[2]), np.array([-S1, -P1 - P2, 0.0])),
    4: (along(A[3]), np.array([-S1, -P1 - P2 - P3, 0.0])),
    5: (along(-A5), np.array([0.0, P5, 0.0])),
}
"""Axis and point of each pair in the unfolded chain; of pair 4 as the left half has it."""
RIGHT_4 = (along(-A5 - np.radians(50.0)), np.array([0.0, P5 + P4, 0.0]))


def skew(v: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    cross = skew(axis)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


class Link:
    """Pose (home point to place), rates and the acceleration of one of its points."""

    def __init__(self, rotation, shift, omega, alpha, point, acceleration):
        self.rotation, self.shift, self.omega, self.alpha = rotation, shift, omega, alpha
        self.point, self.acceleration = point, acceleration

    def place(self, home):
        return self.rotation @ home + self.shift

    def acceleration_at(self, place):
        arm = place - self.point
        turning = np.cross(self.omega, np.cross(self.omega, arm))
        return self.acceleration + np.cross(self.alpha, arm) + turning


GROUND = Link(np.eye(3), np.zeros(3), *np.zeros((4, 3)))


def moved(base: Link, pair: int, sign: float, theta, slide) -> Link:
    """The next link of the chain; `theta` and `slide` with their two rates."""
    home_axis, home_point = HOME[pair]
    relative = turn(sign * home_axis, theta[0])
    shift = home_point - relative @ home_point + sign * slide[0] * home_axis
    axis, place = sign * base.rotation @ home_axis, base.place(home_point)
    place = place + slide[0] * axis
    rate = theta[1] * axis
    omega = base.omega + rate
    alpha = base.alpha + theta[2] * axis + np.cross(base.omega, rate)
    acceleration = base.acceleration_at(place) + slide[2] * axis
    acceleration = acceleration + 2 * slide[1] * np.cross(base.omega, axis)
    rotation, total = base.rotation @ relative, base.place(shift)
    return Link(rotation, total, omega, alpha, place, acceleration)


def tensor(of: dict[str, float]) -> np.ndarray:
    entry = {name: value if name[0] == name[1] else -value for name, value in of.items()}
    names = [["".join(sorted(a + b)) for b in "xyz"] for a in "xyz"]
    return np.array([[entry.get(name, 0.0) for name in row] for row in names])


def links(row: int) -> dict[int, Link]:
    data = exact("rchch_kinematics_A_B")
    rows = [i for i, branch in enumerate(data["branch"]) if branch == "A"]

    def coordinate(label: str, rates: tuple[str, str]) -> list[float]:
        return [float(data[name][rows[row]]) for name in (label, *rates)]

    def theta(k: int) -> list[float]:
        value, rate, acceleration = coordinate(f"theta{k}_deg", (f"omega{k}", f"alpha{k}"))
        return [np.radians(value), rate, acceleration]

    def slide(k: int) -> list[float]:
        return coordinate(f"s{k}", (f"s{k}_dot", f"s{k}_ddot"))

    first = [np.radians(float(data["theta1"][rows[row]])), 0.1, 0.1]
    found = {1: moved(GROUND, 1, -1.0, first, [0.0] * 3)}
    for k in (2, 3):
        found[k] = moved(found[k - 1], k, -1.0, theta(k), slide(k))
    return found | {4: moved(GROUND, 5, 1.0, theta(5), slide(5))}


def pairs(of: dict[int, Link]) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Axes (the source's A, not reversed) and points of all pairs at the row."""
    carriers = {1: GROUND, 2: of[1], 3: of[2], 4: of[3], 5: GROUND}
    found = {}
    for k, carrier in carriers.items():
        axis, point = HOME[k]
        found[k] = (carrier.rotation @ axis, carrier.place(point))
    return found


def inertia(k: int, link: Link) -> np.ndarray:
    """Rates of momentum and of moment of momentum about the ground origin (6,)."""
    axis, point = HOME[5 if k == 4 else k]
    frame = np.column_stack([axis, Y, np.cross(axis, Y)])
    place = link.place(point + frame @ CENTRE[k])
    own = link.rotation @ frame
    about = own @ tensor(INERTIA[k]) @ own.T
    force = MASS[k] * link.acceleration_at(place)
    couple = about @ link.alpha + np.cross(link.omega, about @ link.omega)
    return np.concatenate([force, np.cross(place, force) + couple])


@cache
def reactions(row: int) -> tuple[dict[int, np.ndarray], float]:
    """What each pair's second body exerts on the first (ground on one, two on one, three on two,
    four on three, ground on four), and MIN, the couple about A1 on link one."""
    of = links(row)
    on = {1: {1: 1, 2: 1}, 2: {2: -1, 3: 1}, 3: {3: -1, 4: 1}, 4: {4: -1, 5: 1}}
    matrix, right = [], []
    axes = pairs(of)
    for k, signs in on.items():
        rate = inertia(k, of[k])
        if k == 4:
            rate = rate - np.concatenate([np.zeros(3), MOUT * axes[5][0]])
        for component in range(6):
            line = np.zeros(31)
            for pair, sign in signs.items():
                line[6 * (pair - 1) + component] = sign
            if k == 1:
                line[30] = np.concatenate([np.zeros(3), axes[1][0]])[component]
            matrix.append(line)
            right.append(rate[component])
    for pair, (axis, point) in axes.items():
        force = np.concatenate([axis, np.zeros(3)])
        moment = np.concatenate([-np.cross(axis, point), axis])
        free = [force, moment] if pair in (2, 4) else [moment + LEAD.get(pair, 0.0) * force]
        for condition in free:
            line = np.zeros(31)
            line[6 * (pair - 1) : 6 * pair] = condition
            matrix.append(line)
            right.append(0.0)
    solution = np.linalg.solve(np.array(matrix), np.array(right))
    return {k: solution[6 * (k - 1) : 6 * k] for k in range(1, 6)}, float(solution[30])


def table(number: int, row: int) -> list[float]:
    """Cells of a row of a table from XXXIII on, without theta1."""
    wrenches, effort = reactions(row)
    axis, point = pairs(links(row))[number - 32]
    force, moment = wrenches[number - 32][:3], wrenches[number - 32][3:]
    if number in (34, 36):
        return [*force, *moment]
    axial = force @ axis
    rest = force - axial * axis
    if number == 33:
        return [*rest, *moment, axial, effort]
    couple = (moment - np.cross(point, force)) @ axis
    moment = moment - np.cross(point, axial * axis) - couple * axis
    return [*rest, *moment, axial, couple]


@pytest.mark.parametrize("row", range(25))
def test_the_chain_closes(row):
    """Pair 4 as both halves have it: one line."""
    of = links(row)
    axis, point = pairs(of)[4]
    other, place = of[4].rotation @ RIGHT_4[0], of[4].place(RIGHT_4[1])
    assert np.max(np.abs(np.cross(axis, other))) <= 1e-14
    assert np.max(np.abs(np.cross(axis, place - point))) <= 1e-13


@pytest.mark.parametrize("number", range(33, 38))
def test_every_cell(number):
    cells = [
        [float(cell) for cell in row.values()] for row in committed("rchch", f"table_{number}")
    ]
    found = np.array([row[1:] for row in cells])
    expected = np.array([table(number, row) for row in range(25)])
    assert found.shape == expected.shape
    forces = [0, 1, 2, 6] if found.shape[1] == 8 else [0, 1, 2]
    moments = [place for place in range(found.shape[1]) if place not in forces]
    for kind in (forces, moments):
        error = np.max(np.abs(found - expected)[:, kind])
        assert error <= LIMIT * np.max(np.abs(expected[:, kind]))
