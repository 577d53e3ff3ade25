"""Rows that are all pairs of the values of two inputs."""

import itertools
from math import cos, hypot, radians, sin

import numpy as np
import pytest

import mechkin_cli as mk

ARM, COUPLER, BASE = hypot(10.0, 45.0), hypot(40.0, 50.0), 60.0
LEFT, RIGHT = np.arctan2(45.0, -10.0), np.arctan2(45.0, 10.0)
FIVE_BAR = """\
format: 1
plane: xy
units: {length: mm}
links: {a: {mass: 1, center_of_mass: [0, 0]}, b: {}, d: {}, e: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [-10, 45]}
  C: {type: R, links: [b, e], point: [30, 95]}
  D: {type: R, links: [d, e], point: [70, 45]}
  E: {type: R, links: [ground, d], point: [60, 0]}
points: {p: {link: b, at: [30, 95]}}
"""
SLOW = [-10.0, 0.0, 10.0, 20.0, 30.0]
FAST = [20.0, 0.0, -10.0]
GRID = """\
motion:
  grid: true
  inputs:
    A.theta: {from: -10, to: 30, step: 10, rate: 1 rad/s}
    E.theta: {values: [20, 0, -10], rate: -2 rad/s}
"""
NAMES = ["p.position.x", "p.position.y", "p.velocity.x", "p.velocity.y"]


def five_bar(a: float, e: float) -> tuple[float, float, float, float]:
    """Place and velocity of the point: the upper crossing of two circles, and the rates that keep
    both distances."""
    u, v = LEFT + radians(a), RIGHT + radians(e)
    b = np.array([ARM * cos(u), ARM * sin(u)])
    d = np.array([BASE + ARM * cos(v), ARM * sin(v)])
    half = 0.5 * (d - b)
    up = np.array([-half[1], half[0]]) / hypot(*half)
    p = b + half + np.sqrt(COUPLER**2 - half @ half) * up
    moved_b, moved_d = np.array([-b[1], b[0]]), -2.0 * np.array([-d[1], d[0] - BASE])
    matrix = np.array([p - b, p - d])
    velocity = np.linalg.solve(matrix, [(p - b) @ moved_b, (p - d) @ moved_d])
    return (*p, *velocity)


def test_rows_are_all_pairs_in_order() -> None:
    run = mk.loads(FIVE_BAR + GRID).analyze(["A.theta", "E.theta", *NAMES])
    pairs = list(itertools.product(SLOW, FAST))
    assert list(zip(run["A.theta"], run["E.theta"], strict=True)) == pairs
    assert run.complete
    expected = np.array([five_bar(*pair) for pair in pairs]).T
    for name, values in zip(NAMES, expected, strict=True):
        np.testing.assert_allclose(run[name], values, rtol=1e-12, atol=1e-12)


def test_rows_are_those_of_the_listed_pairs() -> None:
    columns = zip(*itertools.product(SLOW, FAST), strict=True)
    slow, fast = (", ".join(map(str, column)) for column in columns)
    listed = f"""\
motion:
  inputs:
    A.theta: {{values: [{slow}], rate: 1 rad/s}}
    E.theta: {{values: [{fast}], rate: -2 rad/s}}
"""
    names = [*NAMES, "A.effort", "C.theta", "norm(B.force)"]
    one, other = (mk.loads(FIVE_BAR + motion).analyze(names) for motion in (GRID, listed))
    for name in names:
        np.testing.assert_allclose(one[name], other[name], rtol=1e-13, atol=1e-13)


def test_rows_of_the_text_are_those_of_the_doubles() -> None:
    proofs = mk.loads(FIVE_BAR + GRID).certify()
    assert proofs.is_one_branch
    for name, place in (("p.position.x", 0), ("p.velocity.y", 3)):
        low, high = proofs.enclosure(name)
        for row, pair in enumerate(itertools.product(SLOW, FAST)):
            value = five_bar(*pair)[place]
            assert low[row] - 1e-11 <= value <= high[row] + 1e-11


@pytest.mark.parametrize("slow", ["{from: 5, to: 6, count: 1}", "{values: [5]}"])
def test_a_grid_may_have_one_line(slow: str) -> None:
    motion = GRID.replace("{from: -10, to: 30, step: 10, rate: 1 rad/s}", slow)
    proofs = mk.loads(FIVE_BAR + motion).certify()
    assert proofs.is_one_branch
    np.testing.assert_array_equal(proofs.analysis["A.theta"], [5.0] * 3)
    np.testing.assert_array_equal(proofs.analysis["E.theta"], FAST)


WIDE = """\
motion:
  grid: true
  inputs:
    A.theta: {from: START, to: END, step: 15}
    E.theta: {from: -90, to: 30, step: 15}
"""


def reach(a: float, e: float) -> float:
    """How far the outer pins are apart, in parts of the farthest: the loop closes up to 1."""
    u, v = LEFT + radians(a), RIGHT + radians(e)
    apart = hypot(BASE + ARM * (cos(v) - cos(u)), ARM * (sin(v) - sin(u)))
    return apart / (2.0 * COUPLER)


@pytest.mark.parametrize(("start", "end"), [(0, 90), (90, 0), (-30, 45), (0, 135), (45, 120)])
def test_a_line_that_ends_does_not_end_the_others(start: int, end: int) -> None:
    motion = WIDE.replace("START", str(start)).replace("END", str(end))
    run = mk.loads(FIVE_BAR + motion).analyze(["A.theta", "E.theta", *NAMES[:2], "row.status"])
    met = 0
    for row in range(run.rows):
        a, e = float(run["A.theta"][row]), float(run["E.theta"][row])
        if np.isnan(run["p.position.x"][row]):
            assert run["row.status"][row] == "beyond-dead-centre"
            assert reach(a, e) > 1.0
            continue
        assert reach(a, e) < 1.0
        place = (run["p.position.x"][row], run["p.position.y"][row])
        assert place == pytest.approx(five_bar(a, e)[:2], abs=1e-9)
        met += 1
    assert 0 < met < run.rows
    codes = [d.code for d in run.diagnostics if d.severity == "warning"]
    assert codes == ["dead-centre"]


def test_variants_of_a_grid_are_analyses() -> None:
    motion = WIDE.replace("START", "0").replace("END", "90")
    text = FIVE_BAR.replace("[-10, 45]", "[-x, 45]")
    model = mk.loads(f"{text}parameters: {{x: 10 mm}}\n{motion}")
    varied = model.vary({"x": ["10 mm", "11 mm"]}, ["p.position.x"])["p.position.x"]
    for values, x in zip(varied, ("10 mm", "11 mm"), strict=True):
        one = model.with_parameters({"x": x}).analyze(["p.position.x"])["p.position.x"]
        np.testing.assert_allclose(values, one, rtol=1e-12)


TABLE = """\
format: 1
links: {x: {}, y: {}, z: {}, w: {}}
joints:
  X: {type: P, links: [ground, x], point: [0, 0, 0], axis: [1, 0, 0]}
  Y: {type: P, links: [x, y], point: [0, 0, 0], axis: [0, 1, 0]}
  Z: {type: P, links: [y, z], point: [0, 0, 0], axis: [0, 0, 1]}
  W: {type: P, links: [z, w], point: [0, 0, 0], axis: [0, 0, 1]}
points: {p: {link: w, at: [0, 0, 0]}}
motion:
  grid: true
  inputs:
    Z.s: {with: X.s*Y.s/1 m, drive: own}
    X.s: {from: 1, to: 2, step: 0.5, rate: 3 m/s}
    W.s: {at: 7}
    Y.s: {from: 0, to: -2, count: 3, rate: 5 m/s}
"""


def test_inputs_beside_a_grid_are_held_or_follow() -> None:
    model = mk.loads(TABLE)
    names = [*NAMES[:2], "p.position.z", "p.velocity.z"]
    run = model.analyze(names)
    pairs = list(itertools.product([1.0, 1.5, 2.0], [0.0, -1.0, -2.0]))
    expected = np.array([(x, y, x * y + 7.0, 3.0 * y + 5.0 * x) for x, y in pairs]).T
    for name, values in zip(names, expected, strict=True):
        np.testing.assert_allclose(run[name], values, rtol=1e-14, atol=1e-14)
    assert model.certify().is_one_branch


ONE = "{A.theta: {from: 0, to: 9, step: 1}, E.theta: {at: 3}}"
THREE = """{A.theta: {values: [1, 2]}, E.theta: {values: [1, 2]}, B.theta: {values: [1, 2]}}"""


@pytest.mark.parametrize(
    ("motion", "code", "words"),
    [
        (f"{{grid: true, inputs: {ONE}}}", "grid-inputs", "here are 1: A.theta; give a second one"),
        ("{grid: true, inputs: {}}", "grid-inputs", "here are 0; give a second one"),
        (
            f"{{grid: true, inputs: {THREE}}}",
            "grid-inputs",
            "here are 3: A.theta, E.theta, B.theta; hold the others with at",
        ),
        (f"{{grid: maybe, inputs: {ONE}}}", "not-a-flag", "expected true or false"),
    ],
)
def test_a_grid_has_two_inputs(motion: str, code: str, words: str) -> None:
    with pytest.raises(mk.InvalidFile) as refused:
        mk.loads(f"{FIVE_BAR}motion: {motion}\n")
    (error,) = refused.value.diagnostics
    assert error.code == code
    assert words in str(refused.value)
    assert error.place is not None
    assert error.place.line == FIVE_BAR.count("\n") + 1


def test_grids_too_large_are_refused_before_they_are_made() -> None:
    few, many, most = (f"{{from: 0, to: 1, count: {n}}}" for n in (60_000, 3_000_000, 30_000_000))
    text = f"{FIVE_BAR}motion: {{grid: true, inputs: {{A.theta: ONE, E.theta: OTHER}}}}\n"
    with pytest.raises(mk.InvalidFile, match="lines of the grid have too many rows to be held"):
        mk.loads(text.replace("ONE", few).replace("OTHER", many))
    with pytest.raises(mk.InvalidFile, match=r"the run has too many rows, 1\.8e\+12"):
        mk.loads(text.replace("ONE", most).replace("OTHER", few))
    model = mk.loads(text.replace("ONE", few).replace("OTHER", few))
    with pytest.raises(mk.UsageError, match="too many rows to be held at once, 3600000000"):
        model.analyze()
    assert len(model.stream(rows=3_600_000)) == 1000
    plain = mk.loads(f"{FIVE_BAR}motion: {{grid: false, inputs: {ONE}}}\n")
    assert plain.analyze(["A.theta"])["A.theta"].size == 10
