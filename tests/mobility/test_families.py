"""Families that meet in a drawing, or that are singular everywhere: tables on equal parallel rods.

A table whose rods have the length L and the direction t may move along the sphere |t| = L without a
turn. With R the table's turn, the rod at b closes where |t + (R - 1) b| = L; for a rectangle of
rods that is, beside the sphere's equation, (R^T t - t) square to the table and q1 q2 = 0, q the
quaternion of R: a turn by s about t adds s^2 t1 t2 / 4, so that away from t1 t2 = 0 the table turns
to first order only, and in the drawing, t along z, the families {x, y}, {x, twist} and {y, twist}
meet.
"""

from __future__ import annotations

import math
import os
import random
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.mobility import dimension

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

SQUARE = ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))
REGULAR = {
    n: tuple((math.cos(k), math.sin(k)) for k in np.arange(n) * 2 * math.pi / n) for n in (5, 6)
}
PLACES = ((0.3, 0.2), (0.4, 0.25), (0.5, 0.3))


def turn_of(seed: int) -> np.ndarray:
    """A random rotation."""
    a, b, c, d = np.random.default_rng(seed).normal(size=4) if seed else (1.0, 0.0, 0.0, 0.0)
    a, b, c, d = np.array([a, b, c, d]) / math.hypot(a, b, c, d)
    return np.array(
        [
            [1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)],
        ]
    )


def table(
    feet: tuple[tuple[float, float], ...] = SQUARE,
    drawn: tuple[float, float] = (0.3, 0.2),
    places: tuple[tuple[float, float], ...] = PLACES,
    *,
    names: str = "xy",
    size: float = 1.0,
    seed: int = 0,
    loads: str = "[{type: gravity, g: [0, 0, -10]}]",
    columns: str = "",
) -> str:
    """A table of 10 kg on rods of the length `size` with feet at `size` times `feet`, everything
    turned at random; its middle is drawn at x, y and driven through `places`."""
    turn = size * turn_of(seed)

    def spot(x: float, y: float, z: float) -> list[float]:
        return [float(c) for c in turn @ np.array([x, y, z])]

    x, y = drawn
    z = -math.sqrt(1.0 - x * x - y * y)
    rods = range(len(feet))
    lines = ["format: 1", "units: {length: m, angle: deg}"]
    links = ", ".join(f"l{k}: {{}}" for k in rods)
    lines.append(f"links: {{top: {{mass: 10, center_of_mass: {spot(x, y, z)}}}, {links}}}")
    lines.append("joints:")
    for k, (a, b) in enumerate(feet):
        lines.append(f"  A{k}: {{type: S, links: [ground, l{k}], point: {spot(a, b, 0)}}}")
        lines.append(f"  B{k}: {{type: S, links: [l{k}, top], point: {spot(a + x, b + y, z)}}}")
    lines.append(f"points: {{c: {{link: top, at: {spot(x, y, z)}}}}}")
    lines.append(
        f"directions: {{u: {{link: top, vector: {[float(c) for c in turn_of(seed)[:, 0]]}}}}}"
    )
    lines.append(f"loads: {loads}")
    middles = np.array([spot(a, b, -math.sqrt(1.0 - a * a - b * b)) for a, b in places])
    inputs = ", ".join(
        f"c.position.{name}: {{values: {middles[:, 'xyz'.index(name)].tolist()}}}" for name in names
    )
    lines.append(f"motion: {{inputs: {{{inputs}}}}}")
    if columns:
        lines.append(f"tables: [{{name: t, columns: [{columns}]}}]")
    return "\n".join(lines)


def on_rods_of_a_length(feet: tuple[tuple[float, float], ...], drawn: tuple[float, float]) -> str:
    """A table drawn at x, y on rods of the length L, a parameter (1 m)."""
    text = table(feet, drawn).replace("format: 1", "format: 1\nparameters: {L: 1 m}")
    x, y = drawn
    z = -math.sqrt(1.0 - x * x - y * y)
    assert f"{z!r}]" in text
    return text.replace(f"{z!r}]", f"'-sqrt(L^2 - ({x!r} m)^2 - ({y!r} m)^2)']")


def middles(places: tuple[tuple[float, float], ...], size: float, seed: int) -> np.ndarray:
    """Where the table's middle is at some places (places, 3)."""
    flat = np.array([(a, b, -math.sqrt(1.0 - a * a - b * b)) for a, b in places])
    return size * flat @ turn_of(seed).T


def check(text: str, places: tuple[tuple[float, float], ...], size: float, seed: int) -> None:
    """All rows are ok, where the rods are parallel."""
    analysis = mk.loads(text).analyze(["c.position", "u"])
    assert analysis["row.status"].tolist() == ["ok"] * len(places)
    off = np.abs(analysis["c.position"] - middles(places, size, seed)).max()
    assert off < 1e-12 * size
    assert np.abs(analysis["u"] - turn_of(seed)[:, 0]).max() < 1e-12


@pytest.mark.parametrize("drawn", [(0.0, 0.0), (0.3, 0.2), (0.0, 0.2)], ids=str)
@pytest.mark.parametrize("feet", [SQUARE, *REGULAR.values()], ids=lambda feet: f"{len(feet)} rods")
def test_a_table_goes_parallel(
    feet: tuple[tuple[float, float], ...], drawn: tuple[float, float]
) -> None:
    places = (drawn, *((drawn[0] + 0.1 * k, drawn[1] + 0.06 * k) for k in range(1, 4)))
    check(table(feet, drawn, places), places, 1.0, 0)


@pytest.mark.parametrize("seed", range(1, 1 + 4 * TIMES))
def test_turned_and_scaled_and_of_other_shapes(seed: int) -> None:
    rng = random.Random(seed)
    feet = tuple((rng.uniform(-1, 1), rng.uniform(-1, 1)) for _ in range(rng.randint(4, 6)))
    size = 10.0 ** rng.uniform(-2, 2)
    # two coordinates that the sphere does not make dependent where it is drawn
    normal = np.abs(middles(PLACES, 1.0, seed)[0])
    names = "xyz".replace("xyz"[int(np.argmax(normal))], "")
    check(table(feet, names=names, size=size, seed=seed), PLACES, size, seed)


def test_the_hold_is_as_regular_as_the_rods_lie() -> None:
    """The rods swing by 64 degrees from where they are drawn, whatever the axes of the file."""
    places = tuple((math.sin(math.radians(a)), 0.1) for a in range(16, 81, 8))
    for seed in (0, 3):
        normal = np.abs(middles(places, 1.0, seed))
        names = "xyz".replace("xyz"[int(np.argmax(normal.min(axis=0)))], "")
        check(table(drawn=places[0], places=places, names=names, seed=seed), places, 1.0, seed)


@pytest.fixture
def searches(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """A number for each search for the families of a drawing."""
    found: list[int] = []
    directions = dimension.directions

    def counted(*args: Any) -> Any:
        found.append(len(found))
        return directions(*args)

    monkeypatch.setattr(dimension, "directions", counted)
    return found


@pytest.mark.parametrize(
    ("feet", "drawn", "variants"), [(SQUARE, (0.0, 0.0), 8 * TIMES), (REGULAR[5], (0.3, 0.2), 5)]
)
def test_variants_go_on_in_the_family_of_the_file(
    feet: tuple[tuple[float, float], ...],
    drawn: tuple[float, float],
    variants: int,
    searches: list[int],
) -> None:
    text = on_rods_of_a_length(feet, drawn)
    model = mk.loads(text)
    x, y = np.array(PLACES).T
    model.analyze()
    assert len(searches) == 1
    lengths = np.linspace(0.8, 1.5, variants)
    varied = model.vary({"L": lengths}, ["c.position.z", "c.position.x.effort"])
    z = -np.sqrt(lengths[:, None] ** 2 - x * x - y * y)
    assert np.abs(varied["c.position.z"] - z).max() < 1e-12
    assert np.abs(varied["c.position.x.effort"] + 100.0 * x / z).max() < 1e-9
    found = model.sensitivities(["c.position.z"])
    slope = -1.0 / np.sqrt(1.0 - x * x - y * y)
    assert np.abs(found["c.position.z", "L"] - slope).max() < 1e-9
    one = model.with_parameters({"L": 1.2}).analyze(["c.position.z"])["c.position.z"]
    assert len(searches) == 1
    fresh = mk.loads(text, parameters={"L": 1.2}).analyze(["c.position.z"])["c.position.z"]
    assert np.abs(one - fresh).max() < 1e-12


def test_a_variant_without_the_family_is_searched_anew(searches: list[int]) -> None:
    """Two of the rods are shorter: where they swing the table tilts, and nothing of it rests."""
    text = on_rods_of_a_length(SQUARE, (0.0, 0.0)).replace("L: 1 m", "L: 1 m, e: 0 m")
    text = re.sub(r"(A[01]: .*), 0\.0\]", r"\1, -e]", text)
    model = mk.loads(text)
    assert model.problem.stopped
    assert len(searches) == 1
    fresh = mk.loads(text, parameters={"e": 0.1})
    assert len(searches) == 2
    varied = model.with_parameters({"e": 0.1})
    # a build of the file, and a recording about these parameters
    assert len(searches) == 4
    assert varied.problem.stopped == fresh.problem.stopped == ()


def test_efforts_are_those_of_the_sphere() -> None:
    names = "c.position.x.effort, c.position.y.effort, B0.force.z"
    analysis = mk.loads(table(columns=names)).analyze()
    x, y = np.array(PLACES).T
    z = np.sqrt(1.0 - x * x - y * y)
    assert analysis["c.position.x.effort"] == pytest.approx(100.0 * x / z, rel=1e-12)
    assert analysis["c.position.y.effort"] == pytest.approx(100.0 * y / z, rel=1e-12)
    assert np.isnan(analysis["B0.force.z"]).all()  # four rods, three of which would do


@pytest.mark.parametrize("drawn", [(0.0, 0.0), (0.3, 0.2)], ids=str)
def test_modes_are_those_of_the_sphere(drawn: tuple[float, float]) -> None:
    """A table that tilts has assemblies at the same inputs that the rods hold without a turn more:
    none of its own family."""
    model = mk.loads(table(drawn=drawn, columns="c.position.z, c.position.x.effort"))
    found = model.modes()
    assert [mode.name for mode in found.modes] == ["A", "B"]
    assert [d.code for d in found.diagnostics if "turns to first order" in d.message] == [
        "family-modes"
    ]
    x, y = np.array(PLACES).T
    for mode, side in (("A", -1.0), ("B", 1.0)):
        analysis = model.analyze(mode=mode)
        z = side * np.sqrt(1.0 - x * x - y * y)
        assert analysis["row.status"].tolist() == ["ok"] * len(PLACES)
        assert np.abs(analysis["c.position.z"] - z).max() < 1e-12
        assert np.abs(analysis["c.position.x.effort"] + 100.0 * x / z).max() < 1e-9


def test_rates_are_those_of_the_sphere() -> None:
    x_values, y_values = ([place[k] for place in PLACES] for k in (0, 1))
    text = table().replace(f"{x_values}}}", f"{x_values}, rate: 0.5}}")
    text = text.replace(f"{y_values}}}", f"{y_values}, rate: 0.25}}")
    analysis = mk.loads(text).analyze(["c.velocity.x", "c.velocity.y", "c.velocity.z", "top.omega"])
    x, y = np.array(PLACES).T
    vx, vy = np.array(analysis["c.velocity.x"]), np.array(analysis["c.velocity.y"])
    assert vx == pytest.approx(0.5, rel=1e-15)
    assert vy == pytest.approx(0.25, rel=1e-15)
    slope = (x * vx + y * vy) / np.sqrt(1.0 - x * x - y * y)
    assert analysis["c.velocity.z"] == pytest.approx(slope, rel=1e-12)
    assert np.abs(analysis["top.omega"]).max() < 1e-12


def test_a_load_about_the_rods_has_no_finite_reactions() -> None:
    loads = "[{type: torque, link: top, torque: [0, 0, 5]}]"
    analysis = mk.loads(table(loads=loads, columns="c.position.z, c.position.x.effort")).analyze()
    assert analysis["row.status"].tolist() == ["unsupported"] * 3
    assert np.isnan(analysis["c.position.x.effort"]).all()
    (said,) = (d for d in analysis.diagnostics if d.code == "unsupported")
    # the turn is held about the rods as drawn, and a turn about the rods has to do no work
    rods = middles(PLACES, 1.0, 0)
    most = np.max(np.abs(5.0 * rods[:, 2] / (rods @ rods[0])))
    assert said.measured == f"{most:.6g} N*m"


def test_variants_say_that_no_finite_reactions_hold_them() -> None:
    """Also where no reaction is asked for, whose being arbitrary would have them run alone."""
    loads = "[{type: torque, link: top, torque: [0, 0, turning]}]"
    text = "parameters: {turning: 5 N*m}\n" + table(loads=loads, columns="c.position.z")
    found = mk.loads(text).vary({"turning": [0.0, 5.0]}, ["c.position.x.effort", "c.position.z"])
    assert found.status.tolist() == [["ok"] * 3, ["unsupported"] * 3]
    assert np.abs(found["c.position.x.effort"][0]).max() < 1e-12
    assert np.isnan(found["c.position.x.effort"][1]).all()


def test_a_load_square_to_the_rods_is_carried() -> None:
    x, y = PLACES[0]
    loads = f"[{{type: torque, link: top, torque: [{-y!r}, {x!r}, 0]}}]"
    text = table(places=PLACES[:1], loads=loads, columns="c.position.z, c.position.x.effort")
    analysis = mk.loads(text).analyze()
    assert analysis["row.status"].tolist() == ["ok"]
    assert abs(float(analysis["c.position.x.effort"][0])) < 1e-12


def test_mobility_tells_the_families_of_a_rectangle() -> None:
    found = mk.loads(table(drawn=(0.0, 0.0), places=((0.0, 0.0), (0.1, 0.06)))).mobility()
    assert (found.mobility, found.first_order, found.dimensions, found.fixed) == (6, 7, (6,), ())
    assert not found.diagnostics
    told = {(f.dimension, f.excess, f.rests, f.inputs) for f in found.families}
    both = ("c.position.x", "c.position.y")
    assert told == {
        (6, 1, ("the turns of top",), both),
        (6, 0, both[:1], both[1:]),
        (6, 0, both[1:], both[:1]),
    }


@pytest.mark.parametrize("count", [5, 6])
def test_mobility_tells_families_of_several_dimensions(count: int) -> None:
    """Of rods on a circle q1 = q2 = 0: the twist about z is a family of one freedom."""
    text = table(REGULAR[count], drawn=(0.0, 0.0), places=((0.0, 0.0), (0.1, 0.06)))
    found = mk.loads(text).mobility()
    assert found.dimensions == (2 + count, 1 + count)
    both = ("c.position.x", "c.position.y")
    told = {(f.dimension, f.excess, f.rests, f.inputs) for f in found.families}
    assert told == {(2 + count, 1, ("the turns of top",), both), (1 + count, 2, both, ())}


def test_mobility_tells_that_a_family_is_singular_everywhere() -> None:
    (family,) = mk.loads(table()).mobility().families
    assert (family.dimension, family.excess) == (6, 1)
    assert family.rests == ("the turns of top",)


def test_what_is_regular_has_no_family_to_tell() -> None:
    stewart = Path(__file__).parents[2] / "mechanisms" / "classics" / "stewart.yaml"
    assert mk.load(stewart).mobility().families == ()
