"""Curves through tables and points are enclosed as the file's decimals say them, against dense
systems at 60 digits."""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.proofs import rows as proven_rows
from mechkin_cli.session import Precise

DIGITS = 60
WORDS = {
    "not-a-knot": "",
    "natural": ", ends: natural",
    "clamped": ", ends: clamped",
    "periodic": "",
    "monotone": ", interpolation: monotone",
    "linear": ", interpolation: linear",
}
FOLLOWED = """
format: 1
plane: xy
units: {{length: mm, angle: deg, mass: kg, force: N}}
links:
  crank: {{mass: 1, center_of_mass: [0, 0], inertia: 0.5 kg*m^2}}
  rod: {{mass: 2, center_of_mass: [0, 0], inertia: 1 kg*m^2}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: P, links: [ground, rod], point: [0, 0], axis: [1, 0]}}
couplings:
  K: {{type: table, table: lift.csv, over: A.theta, gives: B.s{words}}}
motion:
  inputs: {{A.theta: {{from: {first}, to: {last}, count: {count}, rate: 0.7 rad/s,
           acceleration: 0.3 rad/s^2}}}}
"""


def pieces(x: Sequence[Any], y: Sequence[Any], ends: str) -> list[tuple[Any, Any, Any]]:
    """b, c, d of each piece of the cubic spline, from its conditions written out."""
    count = len(x) - 1
    h = [b - a for a, b in pairwise(x)]
    matrix, right = mp.zeros(3 * count), mp.zeros(3 * count, 1)
    row = 0

    def add(terms: dict[int, Any], value: Any = 0) -> None:
        nonlocal row
        for place, factor in terms.items():
            matrix[row, place] += factor
        right[row] = value
        row += 1

    def at_end(i: int, order: int) -> dict[int, Any]:
        b, c, d = 3 * i, 3 * i + 1, 3 * i + 2
        if order == 1:
            return {b: mp.mpf(1), c: 2 * h[i], d: 3 * h[i] ** 2}
        return {c: mp.mpf(2), d: 6 * h[i]}

    def joined(i: int, j: int, order: int) -> None:
        terms = at_end(i, order)
        place = 3 * j + order - 1
        terms[place] = terms.get(place, 0) - order
        add(terms)

    for i in range(count):
        add({3 * i: h[i], 3 * i + 1: h[i] ** 2, 3 * i + 2: h[i] ** 3}, y[i + 1] - y[i])
    for i in range(count - 1):
        joined(i, i + 1, 1)
        joined(i, i + 1, 2)
    if ends == "periodic":
        joined(count - 1, 0, 1)
        joined(count - 1, 0, 2)
    elif ends == "natural":
        add({1: mp.mpf(1)})
        add(at_end(count - 1, 2))
    elif ends == "clamped":
        add({0: mp.mpf(1)})
        add(at_end(count - 1, 1))
    else:
        add({2: mp.mpf(1), 5: mp.mpf(-1)})
        add({3 * count - 4: mp.mpf(1), 3 * count - 1: mp.mpf(-1)})
    found = mp.lu_solve(matrix, right)
    return [(found[3 * i], found[3 * i + 1], found[3 * i + 2]) for i in range(count)]


def monotone(x: Sequence[Any], y: Sequence[Any]) -> list[tuple[Any, Any, Any]]:
    """The same of a monotone curve: Hermite's cubics with the slopes of Fritsch and Butland."""
    h = [b - a for a, b in pairwise(x)]
    rise = [(b - a) / w for a, b, w in zip(y, y[1:], h, strict=False)]

    def end(h0: Any, h1: Any, r0: Any, r1: Any) -> Any:
        slope = ((2 * h0 + h1) * r0 - h0 * r1) / (h0 + h1)
        if slope * r0 <= 0:
            return mp.mpf(0)
        return 3 * r0 if r0 * r1 <= 0 and abs(slope) > 3 * abs(r0) else slope

    slopes = [end(h[0], h[1], rise[0], rise[1])]
    for i in range(1, len(h)):
        if rise[i - 1] * rise[i] <= 0:
            slopes.append(mp.mpf(0))
            continue
        w0, w1 = 2 * h[i] + h[i - 1], h[i] + 2 * h[i - 1]
        slopes.append((w0 + w1) / (w0 / rise[i - 1] + w1 / rise[i]))
    slopes.append(end(h[-1], h[-2], rise[-1], rise[-2]))
    return [
        (s, (3 * r - 2 * s - t) / w, (s + t - 2 * r) / w**2)
        for s, t, r, w in zip(slopes, slopes[1:], rise, h, strict=False)
    ]


class Reference:
    """The curve through decimals, at 60 digits."""

    def __init__(self, x: Sequence[Any], y: Sequence[Any], kind: str) -> None:
        self.x, self.y = list(x), list(y)
        self.span = x[-1] - x[0] if kind == "periodic" else None
        if kind == "linear":
            rises = [(b - a) / (d - c) for a, b, c, d in zip(y, y[1:], x, x[1:], strict=False)]
            self.pieces = [(rise, mp.mpf(0), mp.mpf(0)) for rise in rises]
        else:
            self.pieces = monotone(x, y) if kind == "monotone" else pieces(x, y, kind)

    def __call__(self, at: Any) -> tuple[Any, Any, Any]:
        if self.span is not None:
            at -= self.span * mp.floor((at - self.x[0]) / self.span)
        i = max(k for k in range(len(self.pieces)) if k == 0 or self.x[k] <= at)
        b, c, d = self.pieces[i]
        u = at - self.x[i]
        return (
            self.y[i] + u * (b + u * (c + u * d)),
            b + u * (2 * c + 3 * u * d),
            2 * c + 6 * u * d,
        )


def decimals(kind: str, seed: int) -> list[tuple[str, str]]:
    """Rows of a random table of seven to nine points."""
    draw = random.Random(f"{kind} {seed}")
    count = draw.randint(7, 9)
    steps = [draw.uniform(5.0, 60.0) for _ in range(count)]
    if kind == "periodic":
        whole = sum(steps)
        steps = [360.0 * step / whole for step in steps]
    places, at = ["0"], 0.0
    for step in steps:
        at += step
        places.append(f"{at:.{draw.randint(3, 9)}f}")
    lifts = [f"{draw.uniform(-40.0, 70.0):.{draw.randint(1, 9)}f}" for _ in places]
    if kind == "periodic":
        places[-1], lifts[-1] = "360", lifts[0]
    return list(zip(places, lifts, strict=True))


def enclosed(model: mk.Model, names: Sequence[str]) -> dict[str, Any]:
    """Enclosures in SI of proven rows, without any rounding to the file's units."""
    proofs = model.certify()
    assert set(proofs.status) == {"proven"}
    result = proofs.analysis.result
    wanted = [result.problem.quantities()[name] for name in names]
    rows = result.row_states
    found = proven_rows.enclosures(result.session, proofs._proofs, wanted, rows.states, rows.turns)
    return dict(found)


def off(found: Any, row: int, true: Any) -> tuple[Any, Any]:
    """How far the true number is from the middle of an enclosure, and the radius of that."""
    middle = mp.mpf(float(found.high[0, row])) + mp.mpf(float(found.low[0, row]))
    return abs(true - middle), mp.mpf(float(found.radius[0, row]))


def table_model(folder: Path, kind: str, seed: int) -> tuple[mk.Model, list[tuple[str, str]], Any]:
    rows = decimals(kind, seed)
    text = "\n".join(["turn,lift", *(f"{x},{y}" for x, y in rows)]) + "\n"
    (folder / "lift.csv").write_text(text, encoding="utf-8")
    last = 1000 if kind == "periodic" else rows[-1][0]
    range_of = (-500 if kind == "periodic" else 0, last, 12)
    first, last, count = range_of
    file = folder / "m.yaml"
    words = WORDS[kind]
    file.write_text(FOLLOWED.format(words=words, first=first, last=last, count=count))
    return mk.load(file), rows, range_of


def exact_rows(rows: Sequence[tuple[str, str]]) -> tuple[list[Any], list[Any]]:
    """Their numbers in SI."""
    return (
        [mp.mpf(x) * mp.pi / 180 for x, _ in rows],
        [mp.mpf(y) / 1000 for _, y in rows],
    )


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("kind", ["not-a-knot", "natural", "clamped", "periodic", "monotone"])
def test_random_tables_are_proven_and_enclosed(tmp_path: Path, kind: str, seed: int) -> None:
    """Value, rate and acceleration of what follows, in rows between knots."""
    model, rows, (first, last, count) = table_model(tmp_path, kind, seed)
    found = enclosed(model, ["B.s", "B.s_dot", "B.s_ddot"])
    with mp.workdps(DIGITS):
        reference = Reference(*exact_rows(rows), kind)
        rate, acceleration = mp.mpf("0.7"), mp.mpf("0.3")
        begin, end = mp.mpf(first), mp.mpf(last)
        for row in range(1, count - 1):
            at = (begin + (end - begin) * row / (count - 1)) * mp.pi / 180
            value, slope, bend = reference(at)
            true = (value, slope * rate, bend * rate**2 + slope * acceleration)
            for name, number in zip(found, true, strict=True):
                distance, radius = off(found[name], row, number)
                assert distance <= radius, (row, name)
                assert radius <= 1e-24 * max(abs(number), mp.mpf("1e-3")), (row, name)


def test_what_knots_are_rounded_by_is_in_the_radius(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Planted: the doubles of all constants, said to be exact. The true numbers are outside."""
    whole = Precise.enclosed_constants

    def rounded(self: Precise, session: Any) -> Any:
        constants = whole(self, session).copy()
        constants[:, 1:] = 0.0
        return constants

    monkeypatch.setattr(Precise, "enclosed_constants", rounded)
    model, rows, (first, last, count) = table_model(tmp_path, "not-a-knot", 3)
    found = enclosed(model, ["B.s"])["B.s"]
    outside = 0
    with mp.workdps(DIGITS):
        reference = Reference(*exact_rows(rows), "not-a-knot")
        for row in range(1, count - 1):
            at = (mp.mpf(first) + (mp.mpf(last) - first) * row / (count - 1)) * mp.pi / 180
            distance, radius = off(found, row, reference(at)[0])
            outside += distance > radius
    assert outside == count - 2


GUIDED = """
format: 1
plane: xy
units: {{length: mm, angle: deg, mass: kg, force: N}}
links: {{arm: {{}}, bead: {{}}}}
joints:
  A: {{type: R, links: [ground, arm], point: [0, 0]}}
  B: {{type: P, links: [arm, bead], point: [{start}], axis: [{start}]}}
  D:
    type: Ps
    links: [bead, ground]
    point: [{start}]
    curve: {{points: [{points}]{closed}}}
motion: {{inputs: {{A.theta: {{from: 0, to: {last}, count: 9}}}}}}
"""


@pytest.mark.parametrize("closed", [True, False])
def test_curves_through_points_are_proven_and_enclosed(closed: bool) -> None:
    """A bead of a turning arm on them: once round, or from end to end."""
    draw = random.Random(5)
    turns = [40.0 * k for k in range(9)] if closed else [15.0 * k for k in range(9)]
    points = []
    for turn in turns:
        radius = draw.uniform(80.0, 100.0)
        x, y = radius * np.cos(np.radians(turn)), radius * np.sin(np.radians(turn))
        points.append((f"{x:.6f}", f"{y:.6f}"))
    text = ", ".join(f"[{x}, {y}]" for x, y in points)
    start, last = ", ".join(points[0]), 330 if closed else 113
    ends = ", closed: true" if closed else ""
    model = mk.loads(GUIDED.format(start=start, points=text, closed=ends, last=last))
    found = enclosed(model, ["B.s", "D.u"])
    places = model.analyze()["D.u"]
    with mp.workdps(DIGITS):
        given = [(mp.mpf(x) / 1000, mp.mpf(y) / 1000) for x, y in points]
        given += given[:1] if closed else []
        u = [mp.mpf(0)]
        for (x0, y0), (x1, y1) in pairwise(given):
            u.append(u[-1] + mp.sqrt((x1 - x0) ** 2 + (y1 - y0) ** 2))
        kind = "periodic" if closed else "not-a-knot"
        x, y = (Reference(u, [point[k] for point in given], kind) for k in range(2))
        drawn = mp.atan2(given[0][1], given[0][0])
        for row in range(1, 9):
            turn = drawn + mp.mpf(last) * row / 8 * mp.pi / 180
            near = mp.mpf(float(places[row]))

            def across(at: Any, turn: Any = turn) -> Any:
                return x(at)[0] * mp.sin(turn) - y(at)[0] * mp.cos(turn)

            at = mp.findroot(across, (near, near + mp.mpf("1e-9")))
            out = x(at)[0] * mp.cos(turn) + y(at)[0] * mp.sin(turn)
            slid = out - mp.hypot(*given[0])
            for name, number in (("B.s", slid), ("D.u", at)):
                distance, radius = off(found[name], row, number)
                assert distance <= radius, (row, name)
                assert radius <= 1e-24, (row, name)


def test_points_with_parameters_are_followed_by_variants_and_sensitivities() -> None:
    """They were taken as those of the file: B.s did not change with h at all."""
    points = "[100, 0], [80, 60], [0, h], [-60, 70], [-90, 0]"
    text = GUIDED.format(start="100, 0", points=points, closed="", last=150)
    text = text.replace("links: {arm", "parameters: {h: 95 mm}\nlinks: {arm")
    model = mk.loads(text)
    names = ["B.s", "D.u"]
    heights = ["93 mm", "95 mm", "97 mm"]
    table = model.vary({"h": heights}, names)
    for number, height in enumerate(heights):
        alone = mk.loads(text.replace("h: 95 mm", f"h: {height}")).analyze()
        for name in names:
            np.testing.assert_allclose(table[name][number], alone[name], rtol=1e-11, atol=1e-11)
    step = (table["B.s"][2] - table["B.s"][0]) / 4.0
    slopes = model.sensitivities(["B.s"], ["h"])["B.s", "h"]
    np.testing.assert_allclose(slopes, step, atol=1e-3)
    assert np.abs(slopes).max() > 0.5


LOADED = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {rod: {mass: 2, center_of_mass: [0, 0], inertia: 1}}
joints: {B: {type: P, links: [ground, rod], point: [0, 0], axis: [1, 0]}}
motion: {inputs: {B.s: {from: 0, to: 1, count: 8, acceleration: 3 m/s^2}}}
loads: [{type: force, joint: B, value: {table: f.csv, over: B.s, interpolation: KIND}}]
"""


@pytest.mark.parametrize("kind", ["spline", "monotone", "linear"])
def test_forces_of_tables_are_enclosed_and_their_errors_known(tmp_path: Path, kind: str) -> None:
    rows = [("0", "0.3"), ("0.17", "1.7"), ("0.41", "-2.3"), ("0.9", "0.1"), ("1.3", "4")]
    text = "\n".join(["way,force", *(f"{x},{y}" for x, y in rows)]) + "\n"
    (tmp_path / "f.csv").write_text(text, encoding="utf-8")
    (tmp_path / "m.yaml").write_text(LOADED.replace("KIND", kind), encoding="utf-8")
    model = mk.load(tmp_path / "m.yaml")
    found = enclosed(model, ["B.effort"])["B.effort"]
    errors = model.analyze(errors=True).errors
    with mp.workdps(DIGITS):
        x, y = [mp.mpf(a) for a, _ in rows], [mp.mpf(b) for _, b in rows]
        reference = Reference(x, y, {"spline": "not-a-knot"}.get(kind, kind))
        for row in range(1, 8):
            force = 6 - reference(mp.mpf(row) / 7)[0]
            distance, radius = off(found, row, force)
            assert distance <= radius, row
            assert radius <= 1e-24 * abs(force), row
            computed = mp.mpf(float(model.analyze()["B.effort"][row]))
            told = float(errors["B.effort"][row])
            assert abs(float(abs(computed - force)) - told) <= 1e-3 * told + 1e-25
