"""Nuts on lead screws, with torsion springs that know every turn; whatever joint closes the loops.

A crank's rod moves a slide, or the slide or the screw is driven itself; a slide s turns the screw
by 2 pi s / lead. Two threads of leads l and m on one spindle turn it by 2 pi s / (l - m). A spring
of stiffness k on an angle q asks the input x for k (q - free) dq/dx. `MECHKIN_RANDOM` multiplies
the number of mechanisms.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest
from random_families.turning_loop import TURN, Array, TurningLoop, about, frame, split, text

import mechkin_cli as mk

COUNT = 8 * int(os.environ.get("MECHKIN_RANDOM", "1"))
EXACTNESS = 1e-9
"""Of a column, in parts of its largest value and of the condition."""
HEAD = "format: 1\nname: nut\nunits: {length: m, angle: deg}\n"


class Nut(NamedTuple):
    """A file, its columns in the file's units, and a factor for roundings."""

    text: str
    columns: dict[str, Array]
    condition: float


class Spring(NamedTuple):
    """A torsion spring, N m/rad, with its free angle in degrees."""

    stiffness: float
    free: float

    def on(self, joint: str) -> str:
        return (
            f"loads: [{{type: spring, joint: {joint}, coordinate: theta, "
            f"stiffness: {self.stiffness!r}, free: {self.free!r} deg}}]\n"
        )

    def effort(self, angle: Array, slope: Array | float) -> Array:
        """Of the input, from the angle in rad and its rate by the input."""
        return np.asarray(self.stiffness * (angle - np.radians(self.free)) * slope)


def spring(rng: np.random.Generator) -> Spring:
    return Spring(float(10 ** rng.uniform(-2, 1)), float(np.round(rng.uniform(-200, 200), 2)))


def slope(f: Callable[[Array], Array], x: Array, step: float = 1e-4) -> Array:
    """The derivative by differences of fourth order."""
    near, far = f(x + step) - f(x - step), f(x + 2 * step) - f(x - 2 * step)
    return (8 * near - far) / (12 * step)


def joint(
    name: str, kind: str, links: str, point: Array, axis: Array | None, more: str = ""
) -> str:
    direction = "" if axis is None else f", axis: {text(axis)}"
    return f"  {name}: {{type: {kind}, links: [{links}], point: {text(point)}{direction}{more}}}\n"


class CrankSlide:
    """R-S-S-P: with w from a to b, the slide is s of s^2 + 2 s w.v + w.w = L^2."""

    def __init__(self, rng: np.random.Generator) -> None:
        places = np.linspace(0, TURN, 721)
        while True:
            self.u, self.o, self.v = frame(rng)[:, 2], rng.normal(size=3), frame(rng)[:, 0]
            self.a = self.o + rng.uniform(0.2, 0.5) * np.cross(self.u, frame(rng)[:, 1])
            self.b = self.o + self.v * rng.uniform(1.5, 3) + 0.2 * rng.normal(size=3)
            self.square = float(((self.a - self.b) ** 2).sum())
            if self._parts(places)[1].min() > 0.05:
                break
        self.side = float(np.sign((self.b - self.a) @ self.v))

    def _parts(self, t: Array) -> tuple[Array, Array]:
        w = self.b - about(self.u, t, self.a, self.o)
        along = w @ self.v
        return along, along**2 - (w * w).sum(-1) + self.square

    def slide(self, t: Array) -> Array:
        along, rest = self._parts(t)
        return np.asarray(self.side * np.sqrt(rest) - along)


def moved_by_a_crank(rng: np.random.Generator) -> Nut:
    """An RSSP loop whose slide is a nut."""
    loop = CrankSlide(rng)
    lead = float(10 ** rng.uniform(-5, 0) * rng.choice([-1, 1]))
    held, on_nut = spring(rng), bool(rng.random() < 0.5)

    def turned(t: Array) -> Array:
        return loop.slide(t) * TURN / lead

    span, count = float(rng.choice([90, 360, 720])), int(rng.choice([7, 20, 73, 361]))
    c = rng.normal(size=3)
    written = (
        f"{HEAD}links: {{crank: {{}}, rod: {{}}, nut: {{}}, screw: {{}}}}\njoints:\n"
        + joint("A", "R", "ground, crank", loop.o, loop.u)
        + joint("B", "S", "crank, rod", loop.a, None)
        + joint("C", "S", "rod, nut", loop.b, None)
        + joint("D", "P", "ground, nut", loop.b, loop.v)
        + joint("N", "H", "screw, nut", c, loop.v, f", lead: {lead!r}")
        + joint("E", "R", "ground, screw", c - loop.v, loop.v)
        + f"motion: {{inputs: {{A.theta: {{from: 0, to: {span!r}, count: {count}, "
        f"rate: 1 rad/s}}}}}}\n{held.on('N' if on_nut else 'E')}"
    )
    crank, sign = np.radians(np.linspace(0, span, count)), 1 if on_nut else -1
    angle, speed = turned(crank), slope(turned, crank)
    effort = held.effort(sign * angle, sign * speed)
    columns = {"N.theta": angle, "E.theta": -angle}
    degrees = {name: np.degrees(value) for name, value in columns.items()}
    return Nut(written, degrees | {"D.s": angle * lead / TURN, "A.effort": effort}, 10)


def driven(rng: np.random.Generator) -> Nut:
    """A slide, a nut and a screw: the slide or the screw's hinge is the input."""
    f, o = frame(rng), rng.normal(size=3)
    v, lead = f[:, 2], float(10 ** rng.uniform(-6, 0) * rng.choice([-1, 1]))
    last = float(lead * 10 ** rng.uniform(0, 4) * rng.choice([-1, 1]))
    count = int(rng.choice([3, 11, 50]))
    held, on_nut, by_slide = spring(rng), bool(rng.random() < 0.5), bool(rng.random() < 0.5)
    joints = [
        joint("N", "H", "screw, nut", o, v, f", lead: {lead!r}"),
        joint("E", "R", "ground, screw", o - v, v),
        joint("D", "P", "ground, nut", o + f[:, 0], v),
    ]
    name, to, unit = ("D.s", last, "1") if by_slide else ("E.theta", -last / lead * 360, "1 rad/s")
    written = (
        f"{HEAD}links: {{nut: {{}}, screw: {{}}}}\njoints:\n"
        + "".join(joints[k] for k in rng.permutation(3))
        + f"motion: {{inputs: {{{name}: {{from: 0, to: {to!r}, count: {count}, rate: {unit}}}}}}}\n"
        + held.on("N" if on_nut else "E")
    )
    slide = np.linspace(0, last, count)
    angle, sign = slide / lead * TURN, 1 if on_nut else -1
    effort = held.effort(sign * angle, sign * (TURN / lead if by_slide else -1))
    columns = {"N.theta": np.degrees(angle), "E.theta": -np.degrees(angle), "D.s": slide}
    return Nut(written, columns | {f"{name[0]}.effort": effort}, 3)


def differential(rng: np.random.Generator) -> Nut:
    """Two threads on one spindle; the nut's slide is the input."""
    f, o = frame(rng), rng.normal(size=3)
    v, lead = f[:, 2], float(10 ** rng.uniform(-4, 0) * rng.choice([-1, 1]))
    second = float(lead * (1 + 10 ** rng.uniform(-3, 0)))
    last = float(lead * 10 ** rng.uniform(0, 2) * rng.choice([-1, 1]))
    count, held = int(rng.choice([3, 11, 50])), spring(rng)
    joints = [
        joint("M", "H", "ground, spindle", o, v, f", lead: {lead!r}"),
        joint("N", "H", "spindle, nut", o + v, v, f", lead: {second!r}"),
        joint("D", "P", "ground, nut", o + f[:, 0], v),
    ]
    written = (
        f"{HEAD}links: {{nut: {{}}, spindle: {{}}}}\njoints:\n"
        + "".join(joints[k] for k in rng.permutation(3))
        + f"motion: {{inputs: {{D.s: {{from: 0, to: {last!r}, count: {count}, rate: 1}}}}}}\n"
        + held.on("M")
    )
    angle = np.linspace(0, last, count) / (lead - second) * TURN
    effort = held.effort(angle, TURN / (lead - second))
    columns = {"M.theta": np.degrees(angle), "N.theta": -np.degrees(angle), "D.effort": effort}
    return Nut(written, columns, 2 / abs(1 - second / lead))


def spring_on_a_rocker(rng: np.random.Generator) -> Nut:
    """A rocker, or a link that is dragged around, over many turns of the crank."""
    loop = TurningLoop(rng, 1e-2, planar=bool(rng.random() < 0.6))
    held, count = spring(rng), int(rng.choice([5, 37, 200]))
    span = float(rng.choice([360, 3600, 7200, 36000]))
    written = loop.file(
        f"{{from: 0, to: {span!r}, count: {count}, rate: 1 rad/s}}", "deg", held.on("D")
    )
    reduced, turns = split(np.linspace(0, span, count), 360)
    angle = loop.angle(reduced, turns)

    def once(x: Array) -> Array:
        return loop.angle(x % TURN, np.floor(x / TURN))

    effort = held.effort(angle, slope(once, reduced))
    return Nut(written, {"D.theta": np.degrees(angle), "A.effort": effort}, 1000)


FAMILIES = {f.__name__: f for f in (moved_by_a_crank, driven, differential, spring_on_a_rocker)}


def fault(family: str, number: int) -> str:
    """The first difference, as closed by itself and at a joint; "" if none."""
    rng = np.random.default_rng(number)
    nut = FAMILIES[family](rng)
    model = mk.loads(nut.text)
    joints = re.findall(r"^  (\w+): \{type", nut.text, re.M)
    for closed_at in (None, [str(rng.choice(joints))]):
        try:
            result = model.analyze(list(nut.columns), closed_at=closed_at)
        except mk.UsageError:
            continue  # a joint that closes nothing, or not alone
        for name, want in nut.columns.items():
            have, largest = result[name], max(np.abs(want).max(), 1e-3)
            where = f"{family} {number}, closed at {closed_at}: {name}"
            if not np.isfinite(have).all():
                return f"{where} is empty in row {np.flatnonzero(np.isnan(have))[0]}"
            off = np.abs(have - want).max() / largest
            if off > EXACTNESS * nut.condition:
                return f"{where} is off by {off:.2g} of {largest:.6g}"
    return ""


@pytest.mark.parametrize("family", FAMILIES)
def test_angles_and_efforts_know_every_turn(family: str) -> None:
    wrong = [words for n in range(COUNT) if (words := fault(family, n))]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("driven", ["M.theta", "D.s"])
@pytest.mark.parametrize("apart", [1e-3, 2.7e-5, 1e-6, 1e-7, 1e-8, 1e-9])
def test_threads_of_nearly_one_lead_move_the_nut(apart: float, driven: str) -> None:
    """s = (l1 - l2) theta / 360 deg, however little the leads differ; by the slide, whose rounding
    is that of the size, the angle has as many digits less as the lead is smaller."""
    first, second = 2e-3, 2e-3 - apart
    lead = first - second
    span = "7200" if driven == "M.theta" else repr(20 * lead)
    result = mk.loads(
        f"{HEAD}links: {{spindle: {{}}, nut: {{}}}}\njoints:\n"
        f"  M: {{type: H, links: [ground, spindle], point: [0, 0, 0], axis: [0, 0, 1], "
        f"lead: {first!r}}}\n"
        f"  N: {{type: H, links: [nut, spindle], point: [0, 0, 0.1], axis: [0, 0, 1], "
        f"lead: {second!r}}}\n"
        "  D: {type: P, links: [ground, nut], point: [0.1, 0, 0], axis: [0, 0, 1]}\n"
        f"motion: {{inputs: {{{driven}: {{from: 0, to: {span}, count: 5, rate: 1}}}}}}\n"
    ).analyze()
    theta, s = np.radians(result["M.theta"]), result["D.s"]
    assert set(map(str, result["row.status"])) <= {"ok", "near-singular"}
    assert np.abs(s - lead * theta / TURN).max() < 1e-16
    ratio = result["D.s_dot"] / result["M.theta_dot"] * TURN / lead
    assert np.abs(ratio - 1).max() < 4 * 2.0**-52 * first / apart


def test_equal_leads_leave_the_spindle_free() -> None:
    """The nut then stands still while the spindle turns."""
    for second in ("2e-3", "0.00200000000099"):
        model = mk.loads(
            f"{HEAD}links: {{spindle: {{}}, nut: {{}}}}\njoints:\n"
            "  M: {type: H, links: [ground, spindle], point: [0, 0, 0], axis: [0, 0, 1], "
            "lead: 2e-3}\n"
            "  N: {type: H, links: [nut, spindle], point: [0, 0, 0.1], axis: [0, 0, 1], "
            f"lead: {second}}}\n"
            "  D: {type: P, links: [ground, nut], point: [0.1, 0, 0], axis: [0, 0, 1]}\n"
        )
        assert [one.links for one in model.mobility().idle] == [("spindle",)]
