"""A response that begins where one of its coordinates is at a dead centre."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

TEXT = """
format: 1
name: pump
plane: xy
units: {length: mm, angle: deg, force: N}
parameters: {r: 30 mm, l: 50 mm, x: "sqrt(l^2 - r^2)"}
links: {crank: {mass: 1, center_of_mass: [0, 0], inertia: 900}, rod: {}, block: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [0, r]}
  C: {type: R, links: [rod, block], point: [x, 0]}
  D: {type: P, links: [ground, block], point: [x, 0], axis: [1, 0]}
responses:
  free:
    start: {START}
    time: {from: 0, to: 1, count: 3}
tables:
  - {name: t, columns: [time, A.theta, A.theta_dot, D.s]}
"""
NAMES = ["A.theta", "A.theta_dot", "D.s"]


def run(start: str) -> mk.Analysis:
    return mk.loads(TEXT.replace("START", start)).respond("free", NAMES)


def test_a_rate_that_the_coordinate_cannot_have_is_refused() -> None:
    r = run("D.s: 40, D.s_dot: 1 mm/s")
    (said,) = [note for note in r.diagnostics if note.severity == "error"]
    assert said.code == "start-at-dead-centre"
    assert "dead centre of D.s" in str(said)
    assert "start" in str(said.hint)
    assert np.isnan(r["A.theta_dot"]).all()


def test_the_rate_of_what_moves_there_starts_it() -> None:
    r = run("D.s: 40, A.theta_dot: 1 rad/s")
    assert set(r["row.status"]) == {"ok"}
    # a wheel without friction keeps its rate; the slide follows it
    np.testing.assert_allclose(r["A.theta_dot"], 1.0, rtol=1e-9)
    with mp.workdps(30):
        # from the dead centre at -90 degrees, the crank along x
        at = [30 * mp.cos(t) + mp.sqrt(2500 - 900 * mp.sin(t) ** 2) - 40 for t in (0, 0.5, 1)]
    np.testing.assert_allclose(r["D.s"], np.array(at, dtype=float), rtol=1e-8)


def test_at_rest_it_may_begin_there() -> None:
    r = run("D.s: 40")
    assert set(r["row.status"]) == {"ok"}
    np.testing.assert_allclose(r["A.theta"], -90.0, atol=1e-5)


def test_just_beside_it_is_no_dead_centre() -> None:
    r = run("D.s: 39.999, D.s_dot: 1 mm/s")
    assert r["row.status"][0] == "ok"


FALLING = """format: 1
plane: xy
links:
  a: {mass: 1, center_of_mass: [0.2, 0.2], inertia: 0.1}
  b: {mass: 1, center_of_mass: [0.6, 0.3], inertia: 0.1}
  c: {mass: 1, center_of_mass: [1, 0.1], inertia: 0.1}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: BPLACE}
  C: {type: R, links: [b, c], point: CPLACE}
  D: {DJOINT}
loads: [{type: gravity, g: [0, -9.81]}]
responses:
  r: {start: START, time: {from: 0, to: 0.2, step: 0.1}, tolerance: 1e-12}
"""


def falling(second: str, third: str, last: str) -> str:
    """Three links that fall, with two of their joints at some places and a last one to ground."""
    text = FALLING.replace("BPLACE", second).replace("CPLACE", third)
    return text.replace("DJOINT", last)


PIN = "type: R, links: [ground, c], point: [1.25, 0]"
IN_LINE = falling("[0.25, 0.5]", "[0.75, 0.25]", PIN)
SLIDER = falling(
    "[0.5, 0]", "[1.5, 0]", "type: P, links: [ground, c], point: [1.5, 0], axis: [1, 0]"
)


@pytest.mark.parametrize(
    ("text", "start", "same"),
    [
        (IN_LINE, "{A.theta: 0}", "{D.theta: 0}"),
        (IN_LINE, "{A.theta: 0, A.theta_dot: 0}", "{D.theta: 0}"),
        (IN_LINE, "{A.theta: 0, D.theta_dot: 1}", "{D.theta: 0, D.theta_dot: 1}"),
        (SLIDER, "{D.s: 0}", "{A.theta: 0}"),
        (SLIDER, "{D.s: 0, A.theta_dot: 3}", "{A.theta: 0, A.theta_dot: 3}"),
    ],
)
def test_a_place_may_be_named_by_what_is_at_a_dead_centre_there(
    text: str, start: str, same: str
) -> None:
    """As by a coordinate that moves there, which has its rates by the ordinary way."""
    names = ["A.theta", "B.theta", "A.theta_dot", "B.theta_dot"]
    one, other = (
        mk.loads(text.replace("START", each)).respond("r", names) for each in (start, same)
    )
    assert one.complete
    for name in names:
        np.testing.assert_allclose(one[name], other[name], atol=1e-9)


BESIDE = IN_LINE.replace(
    "joints:\n",
    """  p: {mass: 1, center_of_mass: [3, -1], inertia: 0.1}
joints:
  P: {type: R, links: [ground, p], point: [3, 0]}
""",
)
DRIVEN = BESIDE.replace("start: START,", "start: START, driven: {P.theta: LAW},")
DRIVEN = DRIVEN.replace("LAW", "{law: sine, amplitude: 0.5, frequency: 1 Hz}")


@pytest.mark.parametrize(
    ("start", "same"),
    [
        (
            "{P.theta: 0, A.theta: 0, P.theta_dot: 1, D.theta_dot: 1}",
            "{P.theta: 0, D.theta: 0, P.theta_dot: 1, D.theta_dot: 1}",
        ),
        ("{P.theta: 0, A.theta: 0, P.theta_dot: 1, A.theta_dot: 0}", ""),
    ],
)
def test_others_have_their_rates_beside_a_dead_centre(start: str, same: str) -> None:
    """A pendulum beside the four-bar; with its rate alone it is not told how the bars move."""
    names = ["P.theta_dot", "A.theta", "D.theta", "D.theta_dot"]
    one = mk.loads(BESIDE.replace("START", start)).respond("r", names)
    if not same:
        (said,) = [each for each in one.diagnostics if each.severity == "error"]
        assert said.code == "start-rates"
        return
    other = mk.loads(BESIDE.replace("START", same)).respond("r", names)
    assert one.complete
    for name in names:
        np.testing.assert_allclose(one[name], other[name], atol=1e-9)


def test_drives_move_beside_a_dead_centre() -> None:
    names = ["P.theta_dot", "A.theta", "D.theta", "D.theta_dot"]
    one, other = (
        mk.loads(DRIVEN.replace("START", start)).respond("r", names)
        for start in ("{A.theta: 0, D.theta_dot: 1}", "{D.theta: 0, D.theta_dot: 1}")
    )
    assert one.complete
    for name in names:
        np.testing.assert_allclose(one[name], other[name], atol=1e-9)
    unfixed = mk.loads(DRIVEN.replace("START", "{A.theta: 0}")).respond("r", names)
    (said,) = [each for each in unfixed.diagnostics if each.severity == "error"]
    assert said.code == "start-rates"


@pytest.mark.parametrize("rate", ["", ", A.theta_dot: 1"])
def test_a_start_in_a_branch_point_is_named(rate: str) -> None:
    flat = IN_LINE.replace("[0.25, 0.5]", "[0.25, 0]").replace("[0.75, 0.25]", "[1.5, 0]")
    rows = mk.loads(flat.replace("START", f"{{A.theta: 0{rate}}}")).respond("r", ["D.theta"])
    (said,) = [each for each in rows.diagnostics if each.severity == "error"]
    assert said.code == "start-at-dead-centre"
    assert "a special position, as a branch point" in said.message
    assert set(rows["row.status"]) == {"branch-lost"}


def test_a_rate_of_what_never_moves_fixes_nothing() -> None:
    """A dyad between the pins of the coupler stands still on it, but for rounding."""
    text = IN_LINE.replace("point: [0.25, 0.5]", "point: [0.27, 0.53]")
    text = text.replace("point: [0.75, 0.25]", "point: [0.81, 0.74]").replace(
        "joints:\n",
        "  d: {mass: 1, center_of_mass: [0.3, 0.5], inertia: 0.1}\n"
        "  e: {mass: 1, center_of_mass: [0.4, 0.9], inertia: 0.1}\n"
        "joints:\n"
        "  E: {type: R, links: [a, d], point: [0.27, 0.53]}\n"
        "  F: {type: R, links: [d, e], point: [0.31, 0.93]}\n"
        "  G: {type: R, links: [e, c], point: [0.81, 0.74]}\n",
    )
    rows = mk.loads(text.replace("START", "{A.theta: 0, F.theta_dot: 0.1}")).respond(
        "r", ["A.theta"]
    )
    (said,) = [each for each in rows.diagnostics if each.severity == "error"]
    assert said.code == "start-rates"


IN_SPACE = """format: 1
units: {length: m, angle: rad}
links:
  crank: {mass: 1, center_of_mass: [0.1, 0.1, 0.1], inertia: {xx: 1, yy: 1, zz: 1}}
  rod: {mass: 1, center_of_mass: [0.1, 0.1, 0.1], inertia: {xx: 1, yy: 1, zz: 1}}
  slider: {mass: 1, center_of_mass: [0.1, 0.1, 0.1]}
joints:
JOINTS
loads: [{type: gravity, g: [1, 2, -9]}]
responses:
  r: {start: START, time: {from: 0, to: 0.02, step: 0.01}, tolerance: 1e-12}
"""
ALONG = {"[1, 2, 2]": (2, -2, 1), "[2, -1, 2]": (2, 2, -1), "[-2, 2, 1]": (1, 2, -2)}


@pytest.mark.parametrize("axis", ALONG)
@pytest.mark.parametrize("order", range(4))
@pytest.mark.parametrize("rate", [0.0, 1.0, 0.42])
def test_least_squares_of_redundant_constraints_are_no_rates(
    axis: str, order: int, rate: float
) -> None:
    """A slider-crank in space at its dead centre: rates of the others for one of its slide are
    rounding there, but finite."""
    along = ALONG[axis]
    one, two = ([part * x for x in along] for part in (0.1, 0.3))
    joints = [
        f"  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: {axis}}}",
        f"  B: {{type: R, links: [crank, rod], point: {one}, axis: {axis}}}",
        f"  C: {{type: R, links: [rod, slider], point: {two}, axis: {axis}}}",
        f"  D: {{type: P, links: [ground, slider], point: {two}, axis: {list(along)}}}",
    ]
    text = IN_SPACE.replace("JOINTS", "\n".join(joints[order:] + joints[:order]))
    names = ["A.theta", "A.theta_dot", "D.s", "D.s_dot"]
    one_way, other = (
        mk.loads(text.replace("START", f"{{{place}: 0, A.theta_dot: {rate} rad/s}}")).respond(
            "r", names
        )
        for place in ("D.s", "A.theta")
    )
    assert one_way.complete
    for name in names:
        np.testing.assert_allclose(one_way[name], other[name], atol=1e-9)
