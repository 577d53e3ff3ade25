"""Intervals in which friction holds a mechanism: closed forms, dense equations of equilibrium, and
the responses that stay or move."""

from __future__ import annotations

import random
from itertools import pairwise
from math import asin, atan, atan2, cos, degrees, hypot, pi, radians, sin
from typing import Any

import numpy as np
import pytest
from scipy.optimize import fsolve

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths

G = 9.81
WEIGHT = {"type": "gravity", "g": [0, -G]}


def told(r: Any) -> list[str]:
    return [note.code for note in r.diagnostics]


def rests(r: Any) -> list[tuple[float, float]]:
    return list(zip(r["row.rest_from"].tolist(), r["row.rest_to"].tolist(), strict=True))


def pendulum(*more: dict[str, Any], coefficient: Any = 0.3) -> dict[str, Any]:
    return {
        "format": 1,
        "plane": "xy",
        "units": {"angle": "deg"},
        "links": {"bob": {"mass": 2, "center_of_mass": [0, -0.25]}},
        "joints": {"A": {"type": "R", "links": ["ground", "bob"], "point": [0, 0]}},
        "loads": [
            WEIGHT,
            {"type": "friction", "joint": "A", "coefficient": coefficient, "radius": 0.05},
            *more,
        ],
    }


def block(coefficient: float, slope: float, *more: dict[str, Any]) -> dict[str, Any]:
    return {
        "format": 1,
        "plane": "xy",
        "links": {"b": {"mass": 2, "center_of_mass": [0, 0]}},
        "joints": {
            "S": {"type": "P", "links": ["ground", "b"], "point": [0, 0], "axis": [1, slope]}
        },
        "loads": [WEIGHT, {"type": "friction", "joint": "S", "coefficient": coefficient}, *more],
    }


HOLDS = degrees(asin(0.3 * 0.05 / 0.25))
"""mu r R = m g l sin(theta), with R the weight."""


def test_a_pendulum_in_a_journal_rests_about_both_equilibria() -> None:
    m = mk.load(pendulum())
    near = m.equilibrium(near={"A.theta": 20})
    assert rests(near) == [pytest.approx((-HOLDS, HOLDS), abs=1e-11)]
    all_there = m.equilibrium(window={"A.theta": (-90, 240)})
    assert all_there["row.event"].tolist() == ["stable", "unstable"]
    assert rests(all_there) == [
        pytest.approx((-HOLDS, HOLDS), abs=1e-11),
        pytest.approx((180 - HOLDS, 180 + HOLDS), abs=1e-10),
    ]
    (note,) = [one for one in near.diagnostics if one.code == "rest-interval"]
    assert "friction of A holds the mechanism from" in note.message


def test_a_falling_coefficient_holds_by_its_static_value() -> None:
    m = mk.load(pendulum(coefficient={"static": 0.3, "sliding": 0.1, "speed": 0.01}))
    found = m.equilibrium(near={"A.theta": 5})
    assert rests(found) == [pytest.approx((-HOLDS, HOLDS), abs=1e-11)]


def test_an_equilibrium_from_the_drawing_has_its_interval_in_tables() -> None:
    columns = ["A.theta", "row.rest_from", "row.rest_to"]
    for tables in ({}, {"tables": [{"name": "own", "run": "e", "columns": columns}]}):
        m = mk.load(pendulum() | {"equilibria": {"e": {}}} | tables)
        (table,) = m.equilibrium("e").tables
        labels = [column.label for column in table.columns]
        assert labels[-2:] == columns[1:]
        values = [float(column.values[0]) for column in table.columns[-2:]]
        assert values == pytest.approx([-HOLDS, HOLDS], abs=1e-11)


def test_oil_does_not_hold() -> None:
    film = {"type": "damper", "joint": "A", "coordinate": "theta", "damping": 5}
    r = mk.load(pendulum(film)).equilibrium(near={"A.theta": 5})
    assert rests(r) == [pytest.approx((-HOLDS, HOLDS), abs=1e-11)]


def test_an_interval_ends_at_the_window_or_at_a_limit_of_the_coordinate() -> None:
    r = mk.load(pendulum()).equilibrium(window={"A.theta": (-1, 2)})
    assert rests(r) == [pytest.approx((-1, 2))]
    assert any("the end of the window" in one.message for one in r.diagnostics)
    limited = pendulum() | {"limits": {"A.theta": [-2, 30]}}
    r = mk.load(limited).equilibrium(near={"A.theta": 5})
    assert rests(r) == [pytest.approx((-2, HOLDS))]
    assert any("the limit of the coordinate" in one.message for one in r.diagnostics)


def test_friction_alone_holds_where_no_loads_balance_in_the_window() -> None:
    r = mk.load(pendulum()).equilibrium(window={"A.theta": (2, 20)})
    assert r["row.event"].tolist() == ["held by friction"]
    assert r["A.theta"] == pytest.approx([(2 + HOLDS) / 2])
    assert rests(r) == [pytest.approx((2, HOLDS))]
    assert "no-equilibrium" not in told(r)
    assert r["row.status"].tolist() == ["friction-undecided"]
    assert np.isnan(r["A.force.y"]).all()
    nothing = mk.load(pendulum()).equilibrium(window={"A.theta": (5, 20)})
    assert "no-equilibrium" in told(nothing)


@pytest.mark.parametrize(("coefficient", "stays"), [(0.201, True), (0.199, False)])
def test_a_block_on_an_incline(coefficient: float, stays: bool) -> None:
    """Of slope 0.2."""
    m = mk.load(block(coefficient, 0.2))
    for r in (
        m.equilibrium(window={"S.s": (-1, 3)}),
        m.equilibrium(near={"S.s": 0.4}),
    ):
        assert ("no-equilibrium" in told(r)) == (not stays)
        assert r["row.event"].tolist() == (["held by friction"] if stays else [""])
    if stays:
        r = m.equilibrium(window={"S.s": (-1, 3)})
        assert rests(r) == [pytest.approx((-1, 3))]
        assert r["S.s"] == pytest.approx([1.0])
        assert m.equilibrium(near={"S.s": 0.4})["S.s"] == pytest.approx([0.4])


def test_a_block_on_a_spring() -> None:
    spring = {"type": "spring", "joint": "S", "coordinate": "s", "stiffness": 100}
    m = mk.load(block(0.3, 0.2, spring))
    slope, weight = atan(0.2), 2 * G
    middle, half = -weight * sin(slope) / 100, 0.3 * weight * cos(slope) / 100
    for r in (m.equilibrium(near={"S.s": 0}), m.equilibrium(window={"S.s": (-1, 1)})):
        assert r["S.s"] == pytest.approx([middle])
        assert rests(r) == [pytest.approx((middle - half, middle + half), abs=1e-13)]


@pytest.mark.parametrize("at", ["H.theta", "H.s"])
@pytest.mark.parametrize(("coefficient", "locks"), [(0.21, True), (0.19, False)])
def test_a_screw_locks_itself_whatever_coordinate_is_named(
    at: str, coefficient: float, locks: bool
) -> None:
    """A nut under its weight: it rests where the friction is more than the lead angle's tangent,
    here 0.2. A force along the axis could not drive it."""
    nut = {
        "format": 1,
        "units": {"angle": "rad"},
        "links": {"nut": {"mass": 1, "center_of_mass": [0, 0, 0]}},
        "joints": {
            "H": {
                "type": "H",
                "links": ["ground", "nut"],
                "point": [0, 0, 0],
                "axis": [0, 0, 1],
                "lead": 2 * pi * 0.002,
            }
        },
        "loads": [
            {"type": "gravity", "g": [0, 0, -G]},
            {"type": "friction", "joint": "H", "coefficient": coefficient, "radius": 0.01},
        ],
    }
    r = mk.load(nut).equilibrium(window={at: (-0.02, 0.06)})
    assert r["row.event"].tolist() == (["held by friction"] if locks else [""])
    assert ("no-equilibrium" in told(r)) == (not locks)
    if locks:
        assert rests(r) == [pytest.approx((-0.02, 0.06))]


def ladder(floor: float, wall: float) -> dict[str, Any]:
    """A uniform ladder of 2 m against a wall, drawn at 60 degrees."""
    foot, top = [2 * cos(radians(60)), 0.0], [0.0, 2 * sin(radians(60))]
    return {
        "format": 1,
        "plane": "xy",
        "units": {"angle": "deg"},
        "links": {
            "ladder": {"mass": 5, "center_of_mass": [foot[0] / 2, top[1] / 2]},
            "a": {},
            "b": {},
        },
        "joints": {
            "F": {"type": "P", "links": ["ground", "a"], "point": foot, "axis": [1, 0]},
            "A": {"type": "R", "links": ["a", "ladder"], "point": foot},
            "W": {"type": "P", "links": ["ground", "b"], "point": top, "axis": [0, 1]},
            "B": {"type": "R", "links": ["b", "ladder"], "point": top},
        },
        "loads": [
            WEIGHT,
            {"type": "friction", "joint": "F", "coefficient": floor},
            {"type": "friction", "joint": "W", "coefficient": wall},
        ],
    }


def test_a_ladder_rests_down_to_its_least_angle() -> None:
    """tan(angle) = (1 - floor wall) / (2 floor)."""
    floor, wall = 0.4, 0.25
    least = degrees(atan((1 - floor * wall) / (2 * floor)))
    r = mk.load(ladder(floor, wall)).equilibrium(window={"A.theta": (-29, 20)})
    ((low, high),) = rests(r)
    # from the drawing the angle of A grows as the ladder falls
    assert 60 - high == pytest.approx(least, abs=1e-10)
    assert r["row.event"].tolist() == ["held by friction"]
    assert low == pytest.approx(-29)


class SliderCrank:
    """A crank of length a at O, a rod of length b, and a slider along x, all with weights and
    friction, a spring on the slider: equations of equilibrium of all links, written out."""

    def __init__(self, rng: random.Random) -> None:
        self.a, self.b = 0.5, round(rng.uniform(1.2, 2), 3)
        self.masses = [round(rng.uniform(0.5, 3), 3) for _ in range(3)]
        self.at = [round(rng.uniform(0.2, 0.8), 3) for _ in range(2)]
        self.mu = [round(rng.uniform(0.05, 0.4), 3) for _ in range(4)]
        self.radius = [round(rng.uniform(0.01, 0.06), 3) for _ in range(3)]
        self.stiffness = round(rng.uniform(20, 200), 2)
        self.free = round(rng.uniform(0.9, 2.0), 3)

    def kinematics(self, t: float) -> tuple[np.ndarray, np.ndarray, float]:
        crank = self.a * np.array([cos(t), sin(t)])
        x = crank[0] + (self.b**2 - crank[1] ** 2) ** 0.5
        return crank, np.array([x, 0.0]), atan2(-crank[1], x - crank[0])

    def document(self) -> dict[str, Any]:
        crank, end, _ = self.kinematics(1.0)
        names = ("O", "A", "B")
        rubs = [
            {"type": "friction", "joint": name, "coefficient": mu, "radius": r}
            for name, mu, r in zip(names, self.mu, self.radius, strict=False)
        ]
        return {
            "format": 1,
            "plane": "xy",
            "units": {"angle": "rad"},
            "links": {
                "crank": {
                    "mass": self.masses[0],
                    "center_of_mass": (self.at[0] * crank).tolist(),
                },
                "rod": {
                    "mass": self.masses[1],
                    "center_of_mass": (crank + self.at[1] * (end - crank)).tolist(),
                },
                "slider": {"mass": self.masses[2], "center_of_mass": end.tolist()},
            },
            "joints": {
                "O": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]},
                "A": {"type": "R", "links": ["crank", "rod"], "point": crank.tolist()},
                "B": {"type": "R", "links": ["rod", "slider"], "point": end.tolist()},
                "S": {
                    "type": "P",
                    "links": ["ground", "slider"],
                    "point": end.tolist(),
                    "axis": [1, 0],
                },
            },
            "points": {
                "wall": {"link": "ground", "at": [0, 0]},
                "pin": {"link": "slider", "at": end.tolist()},
            },
            "loads": [
                WEIGHT,
                {
                    "type": "spring",
                    "between": ["wall", "pin"],
                    "stiffness": self.stiffness,
                    "free": self.free,
                },
                *rubs,
                {"type": "friction", "joint": "S", "coefficient": self.mu[3]},
            ],
        }

    def left(self, unknown: np.ndarray, share: float) -> list[float]:
        """What is left of nine equations of equilibrium of three links, by the forces that O, A, B
        and the guide exert on the second link of each, a moment of the guide, and the angle."""
        o, pin, end, n, moment, t = unknown[:2], unknown[2:4], unknown[4:6], *unknown[6:9]
        crank, x, _ = self.kinematics(t)
        h = 1e-6
        _, x1, rod1 = self.kinematics(t + h)
        _, x0, rod0 = self.kinematics(t - h)
        spin, slide = (rod1 - rod0) / (2 * h), (x1 - x0)[0] / (2 * h)
        # the friction's moments on the second link of each pin
        turns = [1.0, spin - 1.0, -spin]
        forces = (o, pin, end)
        rub = [
            -share * mu * r * hypot(*f) * np.sign(w)
            for mu, r, f, w in zip(self.mu, self.radius, forces, turns, strict=False)
        ]
        drag = -share * self.mu[3] * abs(n) * np.sign(slide)
        down = [np.array([0.0, -m * G]) for m in self.masses]
        pull = -self.stiffness * (x[0] - self.free)

        def about(arm: np.ndarray, force: np.ndarray) -> float:
            return float(arm[0] * force[1] - arm[1] * force[0])

        first = o - pin + down[0]
        second = pin - end + down[1]
        third = end + down[2] + np.array([drag + pull, n])
        return [
            *first,
            about(crank, -pin) + about(self.at[0] * crank, down[0]) + rub[0] - rub[1],
            *second,
            about(x - crank, -end) + about(self.at[1] * (x - crank), down[1]) + rub[1] - rub[2],
            *third,
            moment + rub[2],
        ]


@pytest.mark.parametrize("seed", range(12))
def test_a_slider_crank_against_its_equations_of_equilibrium(seed: int) -> None:
    one = SliderCrank(random.Random(seed))
    m = mk.load(one.document())
    window = m.equilibrium(window={"O.theta": (-pi, pi)})
    checked = 0
    x = window["S.s"] + one.kinematics(1.0)[1][0]
    is_right = x > one.a * np.cos(window["O.theta"] + 1.0)
    for (low, high), right in zip(rests(window), is_right, strict=True):
        for end in (low, high) if right else ():
            if abs(end) > 3.1:
                continue
            left = min(
                (_solved(one, end + 1.0, share) for share in (1.0, -1.0)),
                key=lambda found: abs(found - end - 1.0),
            )
            assert left == pytest.approx(end + 1.0, abs=1e-8)
            checked += 1
    assert checked


def _solved(one: SliderCrank, angle: float, share: float) -> float:
    """The crank's angle near one at which the equations hold with a share of the friction."""
    begin = np.zeros(9)
    begin[8] = angle + 1e-3
    # reactions first, at that angle
    for _ in range(3):
        begin[:8] = fsolve(
            lambda f: np.delete(one.left(np.append(f, begin[8]), share), 2), begin[:8]
        )
    found, _, ended, _ = fsolve(lambda u: one.left(u, share), begin, xtol=1e-14, full_output=True)
    return float(found[8]) if ended == 1 or max(map(abs, one.left(found, share))) < 1e-7 else 99.0


@pytest.mark.parametrize("seed", range(3))
def test_a_response_stays_within_the_interval_and_leaves_it_outside(seed: int) -> None:
    text = SliderCrank(random.Random(seed)).document()
    r = mk.load(text).equilibrium(near={"O.theta": 0.3})
    ((low, high),) = rests(r)
    starts = {"below": low - 1e-3, "first": low + 1e-3, "last": high - 1e-3, "above": high + 1e-3}
    runs = {
        name: {
            "start": {"O.theta": at, "O.theta_dot": 0},
            "time": {"from": 0, "to": 0.5, "count": 6},
        }
        for name, at in starts.items()
    }
    m = mk.load(text | {"responses": runs})
    for name, at in starts.items():
        moved = abs(m.respond(name, ["O.theta"])["O.theta"][-1] - at)
        if name in ("first", "last"):
            assert moved < 1e-9
        else:
            assert moved > 1e-6


def test_several_freedoms_have_no_interval_and_a_note_says_so() -> None:
    double = pendulum()
    double["links"]["other"] = {"mass": 1, "center_of_mass": [0, -0.7]}
    double["joints"]["B"] = {"type": "R", "links": ["bob", "other"], "point": [0, -0.5]}
    r = mk.load(double).equilibrium(near={"A.theta": 5, "B.theta": 3})
    assert "friction-left-out" in told(r)
    with pytest.raises(mk.MechkinError, match="rest_from"):
        r["row.rest_from"]


def test_friction_by_reactions_that_are_not_unique_is_told() -> None:
    """A plane four-bar drawn in space has the forces in its plane; with the length of a bearing
    also moments across it, which are arbitrary."""

    def bars(**more: float) -> dict[str, Any]:
        places = {"A": [0, 0, 0], "B": [0, 0.3, 0], "C": [0.8, 0.5, 0], "D": [0.8, 0, 0]}
        chain = ["ground", "crank", "coupler", "rocker", "ground"]
        links = dict(zip(places, pairwise(chain), strict=True))
        return {
            "format": 1,
            "units": {"angle": "deg"},
            "links": {name: {"mass": 1, "center_of_mass": [0.2, 0.2, 0]} for name in chain[1:4]},
            "joints": {
                name: {"type": "R", "links": list(links[name]), "point": at, "axis": [0, 0, 1]}
                for name, at in places.items()
            },
            "loads": [
                {"type": "gravity", "g": [0, -G, 0]},
                {"type": "spring", "joint": "D", "coordinate": "theta", "stiffness": 9},
                {"type": "friction", "joint": "A", "coefficient": 0.2, "radius": 0.02, **more},
            ],
        }

    r = mk.load(bars()).equilibrium(near={"A.theta": 0})
    ((low, high),) = rests(r)
    assert low < r["A.theta"][0] < high
    r = mk.load(bars(length=0.1)).equilibrium(near={"A.theta": 0})
    assert np.isnan(r["row.rest_from"]).all()
    assert "rest-interval" in told(r)
    flat = bars()
    flat["plane"] = "xy"
    for joint in flat["joints"].values():
        del joint["axis"]
        joint["point"] = joint["point"][:2]
    for link in flat["links"].values():
        link["center_of_mass"] = link["center_of_mass"][:2]
    flat["loads"][0]["g"] = [0, -G]
    r = mk.load(flat).equilibrium(near={"A.theta": 0})
    assert rests(r) == [pytest.approx((low, high), abs=1e-9)]


def driven_effort(document: dict[str, Any], coordinate: str, way: list[float]) -> float:
    """The least effort, forward or back, of a slow drive at the end of a way, in parts of what
    friction makes of it."""
    joint = coordinate.partition(".")[0]
    efforts = []
    for rate in (1e-7, -1e-7):
        inputs = {coordinate: {"values": way, "rate": rate}}
        found = mk.load(document | {"motion": {"inputs": inputs}}).analyze([f"{joint}.effort"])
        efforts.append(float(found[f"{joint}.effort"][-1]))
    return min(map(abs, efforts)) / abs(efforts[0] - efforts[1])


def test_wheels_whose_teeth_push_apart_and_lose_power() -> None:
    """Against slow drives at both ends, on either wheel."""
    wheels = {
        "format": 1,
        "units": {"angle": "rad"},
        "links": {
            "a": {"mass": 2, "center_of_mass": [0.1, 0, 0]},
            "b": {"mass": 3, "center_of_mass": [0.4, 0.2, 0]},
        },
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0, 0], "axis": [0, 0, 1]},
            "B": {"type": "R", "links": ["ground", "b"], "point": [0.3, 0, 0], "axis": [0, 0, 1]},
        },
        "couplings": {
            "G": {
                "type": "gear",
                "joints": ["A", "B"],
                "teeth": [20, 40],
                "pressure_angle": 0.4,
                "efficiency": 0.95,
            }
        },
        "loads": [
            {"type": "gravity", "g": [0, -G, 0]},
            {"type": "friction", "joint": "A", "coefficient": 0.3, "radius": 0.03},
            {"type": "friction", "joint": "B", "coefficient": 0.2, "radius": 0.04},
        ],
    }
    for coordinate, reach in (("A.theta", 2 * pi), ("B.theta", pi)):
        r = mk.load(wheels).equilibrium(window={coordinate: (-reach, reach)})
        checked = 0
        for at, ends in zip(r[coordinate], rests(r), strict=True):
            for end in ends:
                if abs(end) < reach - 1e-9:
                    assert driven_effort(wheels, coordinate, [float(at), end]) < 1e-10
                    checked += 1
        assert checked >= 4


YOKE: dict[str, Any] = {
    "format": 1,
    "plane": "xy",
    "units": {"angle": "rad"},
    "links": {
        "crank": {"mass": 2, "center_of_mass": [0.1, 0.1]},
        "yoke": {"mass": 3, "center_of_mass": [0.3, 0.2]},
    },
    "joints": {
        "O": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]},
        "P": {"type": "Ps", "links": ["yoke", "crank"], "point": [0.3, 0.2], "slot": [0, 1]},
        "S": {"type": "P", "links": ["ground", "yoke"], "point": [0.3, 0.3], "axis": [1, 0.1]},
    },
    "loads": [
        WEIGHT,
        {"type": "spring", "joint": "S", "coordinate": "s", "stiffness": 150},
        {"type": "friction", "joint": "O", "coefficient": 0.2, "radius": 0.03},
        {"type": "friction", "joint": "P", "coefficient": 0.25},
        {"type": "friction", "joint": "S", "coefficient": 0.15, "length": 0.4},
    ],
}
GUIDED: dict[str, Any] = {
    "format": 1,
    "units": {"angle": "rad"},
    "idle": "hold",
    "links": {
        "crank": {"mass": 1, "center_of_mass": [0.1, 0.1, 0.05]},
        "rod": {"mass": 1, "center_of_mass": [0.5, 0.2, 0.1]},
        "slider": {"mass": 2, "center_of_mass": [1.0, 0.1, 0.2]},
    },
    "joints": {
        "O": {"type": "R", "links": ["ground", "crank"], "point": [0, 0, 0], "axis": [0.1, 0.2, 1]},
        "B": {"type": "S", "links": ["crank", "rod"], "point": [0.3, 0.2, 0.1]},
        "C": {"type": "S", "links": ["rod", "slider"], "point": [1.0, 0.1, 0.2]},
        "S": {
            "type": "P",
            "links": ["ground", "slider"],
            "point": [1.0, 0.1, 0.2],
            "axis": [1, 0.1, 0.3],
        },
    },
    "loads": [
        {"type": "gravity", "g": [0, 0, -G]},
        {"type": "spring", "joint": "S", "coordinate": "s", "stiffness": 80},
        {
            "type": "friction",
            "joint": "O",
            "coefficient": 0.2,
            "radius": 0.03,
            "length": 0.1,
            "collar": 0.04,
        },
        {"type": "friction", "joint": "B", "coefficient": 0.2, "radius": 0.03},
        {"type": "friction", "joint": "C", "coefficient": 0.2, "radius": 0.03},
        {"type": "friction", "joint": "S", "coefficient": 0.15, "length": 0.3, "width": 0.2},
    ],
}


@pytest.mark.parametrize("document", [YOKE, GUIDED], ids=["yoke", "guided"])
def test_slots_balls_and_guides_against_slow_drives(document: dict[str, Any]) -> None:
    r = mk.load(document).equilibrium(window={"O.theta": (-3.1, 3.1)})
    assert len(r["O.theta"]) >= 4
    for k, ends in enumerate(rests(r)):
        near = {"assembly": {"near": {"S.s": float(r["S.s"][k])}}}
        for end in ends:
            at = float(r["O.theta"][k])
            assert driven_effort(document | near, "O.theta", [at, end]) < 1e-10


@pytest.mark.parametrize(("part", "locks"), [(1.01, True), (0.99, False)])
def test_a_worm_locks_itself(part: float, locks: bool) -> None:
    """Where the coefficient is cos(pressure angle) tan(lead angle)."""
    lead, pressure = atan(1 / 5), radians(20)
    coefficient = part * cos(pressure) * sin(lead) / cos(lead)
    worm = {
        "format": 1,
        "units": {"length": "mm", "angle": "deg", "force": "N"},
        "links": {"worm": {}, "wheel": {"mass": 1, "center_of_mass": [100, 100, 0]}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "worm"], "point": [0, 0, 0], "axis": [1, 0, 0]},
            "B": {
                "type": "R",
                "links": ["ground", "wheel"],
                "point": [0, 125, 0],
                "axis": [0, 0, 1],
            },
        },
        "couplings": {
            "W": {
                "type": "gear",
                "joints": ["A", "B"],
                "teeth": [2, 40],
                "radii": ["25 mm", "100 mm"],
                "helix": 90 - degrees(lead),
                "pressure_angle": "20 deg",
                "friction": coefficient,
            }
        },
        "loads": [{"type": "gravity", "g": [0, -9810, 0]}],
    }
    r = mk.load(worm).equilibrium(window={"B.theta": (-10, 10)})
    assert r["row.event"].tolist() == (["held by friction"] if locks else [""])
    assert ("no-equilibrium" in told(r)) == (not locks)


def test_lanes_and_threads_do_not_matter() -> None:
    m = mk.load(SliderCrank(random.Random(3)).document())
    window = {"O.theta": (-pi, pi)}
    one, *others = (
        m.equilibrium(window=window, lanes=lanes, threads=threads)
        for lanes, threads in (*((width, 1) for width in widths()), (0, 2))
    )
    for other in others:
        for name in ("O.theta", "row.rest_from", "row.rest_to"):
            assert other[name].tobytes() == one[name].tobytes()
