"""What responses are measured on: a double pendulum, a chain in space, RCSR's loop, a stiff spring
and damper."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from benchmarks import rcsr
from benchmarks.responses import pendulum
from benchmarks.responses.extrapolation import extrapolated
from benchmarks.responses.tree import GROUND, Ball, Carried, Tree
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.model.model import Model, loads

TOLERANCES = tuple(10.0**-k for k in (4, 6, 8, 10, 12))
SMOOTH, STIFF = ("DOP853",), ("Radau", "BDF", "LSODA")
"""Integrators of scipy: of our explicit one's order; those for stiff equations."""

RUN = "run"
CHAIN = """format: 1
name: three hinges in space
units: {{angle: rad}}
links:
  one:
    {{mass: 1.2, center_of_mass: [0, 0.1, -0.3],
     inertia: {{xx: 0.06, yy: 0.05, zz: 0.02, xy: 0.004}}}}
  two:
    {{mass: 0.8, center_of_mass: [0.1, 0, -0.8],
     inertia: {{xx: 0.04, yy: 0.03, zz: 0.02, xz: 0.003}}}}
  three:
    {{mass: 0.5, center_of_mass: [0, -0.1, -1.3],
     inertia: {{xx: 0.02, yy: 0.02, zz: 0.01, yz: 0.002}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 1, 0]}}
  B: {{type: R, links: [one, two], point: [0, 0, -0.6], axis: [1, 0.3, 0]}}
  C: {{type: R, links: [two, three], point: [0.1, 0, -1.1], axis: [0.2, 1, 0.4]}}
loads: [{{type: gravity, g: [0, 0, -9.81]}}]
responses:
  run:
    start: {{A.theta: 0.7, B.theta: -0.4, C.theta: 0.6}}
    time: {{from: 0, to: 2, step: 0.2}}
    tolerance: {tolerance}
"""
SPRING = """format: 1
name: stiff spring and damper
links: {{block: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints: {{S: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}}}
loads:
  - {{type: spring, joint: S, coordinate: s, stiffness: 8e5}}
  - {{type: damper, joint: S, coordinate: s, damping: 4e4}}
responses:
  run:
    start: {{S.s: 1}}
    time: {{from: 0, to: 0.2, step: 0.02}}
    tolerance: {tolerance}
"""
STIFFNESS, DAMPING = 8e5, 4e4
LOOP = """responses:
  run:
    start: {{O1.theta: 150 deg}}
    near: {{O2.theta: -104 deg, O2.s: -9, O4.theta: 37 deg}}
    efforts: {{O1.theta: 300}}
    time: {{from: 0, to: 1, step: 0.1}}
    tolerance: {tolerance}
"""
COUPLE, TORQUE = 300.0, 10.0

Rates = Callable[[Any, Any], Any]
"""Time and a state of coordinates and rates to its derivative, as scipy takes them."""


@dataclass(frozen=True)
class Case:
    """A response with its exact motion.

    Args:
        name: as tables show it.
        text: of the file, with a place for the tolerance.
        names: coordinates that are compared, in rad and m, as far as `start` goes first.
        moments: (rows,) s.
        start: coordinates and rates of the equations (2 coordinates,).
        rates: their derivative, in doubles.
        exact: (names, rows), in numpy's widest numbers.
        integrators: scipy's that are measured.
        tree: the same as a tree for other libraries, where it is open.
    """

    name: str
    text: str
    names: tuple[str, ...]
    moments: Any
    start: Any
    rates: Rates
    exact: Callable[[], Any]
    integrators: tuple[str, ...]
    tree: Tree | None = None

    def model(self, tolerance: float) -> Model:
        """The file at a tolerance."""
        return loads(self.text.format(tolerance=repr(tolerance)), self.name)

    @cached_property
    def true(self) -> Any:
        """The exact motion, found once."""
        return self.exact()


def cases() -> list[Case]:
    """In the order of the page."""
    return [double_pendulum(), chain(), loop(), spring()]


def double_pendulum() -> Case:
    """Whose equations are short enough to be written by hand."""
    mechanism = _mechanism(pendulum.TEXT)
    carried = (Carried("A", "R", GROUND, "upper"), Carried("B", "R", 0, "lower"))
    return Case(
        "double pendulum",
        pendulum.TEXT,
        ("A.theta", "B.theta"),
        pendulum.moments(),
        np.array([*pendulum.START, 0.0, 0.0]),
        pendulum.rates,
        pendulum.exact_motion,
        SMOOTH,
        Tree(mechanism, carried, (0.0, 0.0)),
    )


def chain() -> Case:
    """Three bodies on skew hinges."""
    mechanism = _mechanism(CHAIN)
    carried = [
        Carried(joint, "R", k - 1, link)
        for k, (joint, link) in enumerate((("A", "one"), ("B", "two"), ("C", "three")))
    ]
    trees = [Tree(mechanism, carried, (0.0,) * 3, (), kind) for kind in (np.float64, np.longdouble)]
    moments = np.linspace(0.0, 2.0, 11)
    start = np.array([0.7, -0.4, 0.6, 0.0, 0.0, 0.0])
    return _of_tree(
        "three hinges in space", CHAIN, ("A.theta", "B.theta", "C.theta"), moments, start, trees, 2
    )


def loop() -> Case:
    """The RCSR linkage, moved by a couple on its crank against a torque on its rocker."""
    text = rcsr.dimensions().text("values: [2.6, 2.7]")
    head, loads_of = text.partition("\nmotion:")[0], text.partition("\nloads:")[2]
    braces = f"{head}\nloads:{loads_of}".replace("{", "{{").replace("}", "}}")
    text = f"{braces.rstrip()}\n{LOOP}"
    mechanism = _mechanism(text)
    carried = (
        Carried("O1", "R", GROUND, "crank"),
        Carried("O2", "R", 0, None),
        Carried("O2", "P", 1, "coupler"),
        Carried("O4", "R", GROUND, "rocker"),
    )
    efforts, balls = (COUPLE, 0.0, 0.0, TORQUE), (Ball("O3", 2, 3),)
    trees = [Tree(mechanism, carried, efforts, balls, kind) for kind in (np.float64, np.longdouble)]
    place = _closed(trees[1], np.radians(np.array([150.0, -104.0, 0.0, 37.0], np.longdouble)), -9.0)
    start = np.concatenate([place, np.zeros(4, np.longdouble)])
    names = ("O1.theta", "O2.theta", "O2.s", "O4.theta")
    return _of_tree("RCSR", text, names, np.linspace(0.0, 1.0, 11), start, trees, 1)


def spring() -> Case:
    """One slide: x'' = -k x - c x', whose rates differ by a factor of 2000."""
    half = np.longdouble(DAMPING) / 2
    root = np.sqrt(half * half - np.longdouble(STIFFNESS))
    # the slow one without cancelling
    fast, slow = -half - root, -np.longdouble(STIFFNESS) / (half + root)
    moments = np.linspace(0.0, 0.2, 11)

    def exact() -> Any:
        t = moments.astype(np.longdouble)
        return ((fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow))[None]

    def rates(_: Any, y: Any) -> Any:
        return np.array([y[1], -STIFFNESS * y[0] - DAMPING * y[1]])

    start = np.array([1.0, 0.0])
    return Case("stiff spring and damper", SPRING, ("S.s",), moments, start, rates, exact, STIFF)


def _mechanism(text: str) -> Mechanism:
    """Geometry, masses and gravity of a response."""
    return loads(text.format(tolerance=TOLERANCES[0])).session_of(RUN).problem.mechanism


def _of_tree(
    name: str,
    text: str,
    names: tuple[str, ...],
    moments: Any,
    start: Any,
    trees: Sequence[Tree],
    parts: int,
) -> Case:
    """A case whose equations are dense ones: in doubles, and in the widest numbers, of which the
    exact motion takes so many `parts` of the time between two rows."""
    doubles, wide = trees
    count = len(names)

    def first_order(tree: Tree) -> Callable[[Any], Any]:
        return lambda y: np.concatenate([y[count:], tree.rates(y[:count], y[count:])])

    own = first_order(doubles)
    return Case(
        name,
        text,
        names,
        moments,
        start.astype(float),
        lambda _, y: own(y),
        lambda: extrapolated(first_order(wide), start, moments, parts)[:count],
        SMOOTH,
        doubles if not doubles.balls else None,
    )


def _closed(tree: Tree, near: Any, slide: float) -> Any:
    """The place where the loop is closed, by Newton's method from what the file names near; the
    crank stays."""
    q = near.copy()
    q[2] = slide
    for _ in range(12):
        columns = tree.columns(q)[:, 1:]
        q[1:] -= tree.solve(columns, tree.gap(q))
    return q
