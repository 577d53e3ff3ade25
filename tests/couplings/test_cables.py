"""Cables over points, pulleys and drums, against closed forms and lengths at 40 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.kernel.functions import widths

HEAD = """
format: 1
plane: xy
units: {length: m, angle: deg, mass: kg, force: N}
"""
TACKLE = (
    HEAD
    + """
links: {block: {mass: 8, center_of_mass: [0, -3]}, cart: {}}
joints:
  G: {type: P, links: [ground, block], point: [0, -3], axis: [0, 1]}
  C: {type: P, links: [ground, cart], point: [2, 0], axis: [1, 0]}
points:
  a: {link: ground, at: [0, 0]}
  b: {link: block, at: [0, -3]}
  e: {link: ground, at: [1, 0]}
  c: {link: cart, at: [2, 0]}
couplings: {K: {type: cable, path: [a, b, a, b, a, e, c]}}
motion: {inputs: {C.s: {from: 0, to: 1, count: 3, rate: 1 m/s, acceleration: 0.4 m/s^2}}}
loads: [{type: gravity, g: [0, -10 m/s^2]}]
"""
)


def test_a_tackle_of_four_strands() -> None:
    """A quarter of the way, and of the load: 8 kg by 10 + .1 m/s^2."""
    model = mk.loads(TACKLE)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    np.testing.assert_allclose(result["G.s"], [0.0, 0.125, 0.25], atol=1e-14)
    np.testing.assert_allclose(result["G.s_dot"], 0.25, rtol=1e-13)
    np.testing.assert_allclose(result["K.tension"], 8.0 * 10.1 / 4.0, rtol=1e-13)
    np.testing.assert_allclose(result["C.effort"], 8.0 * 10.1 / 4.0, rtol=1e-13)
    assert model.mobility().mobility == 1
    # the block hangs below the eye, or stands above it: no stretch is shorter than nothing
    modes = model.modes()
    assert sorted(round(mode.coordinates["G.s"], 9) for mode in modes.modes) == [0.0, 6.0]
    # nothing of the stretches is told
    assert set(modes.modes[0].coordinates) == {"G.s", "C.s"}
    assert set(model.problem.mechanism.coordinates) == {"G.s", "C.s"}
    assert {name.split(".")[0] for name in model.quantities} == {
        *("G", "C", "K", "a", "b", "c", "e", "block", "cart", "ground", "row")
    }
    for name in result:
        assert len(result[name]) == 3


def test_a_cable_does_not_push() -> None:
    up = TACKLE.replace("[0, -10 m/s^2]", "[0, 10 m/s^2]")
    result = mk.loads(up).analyze(["K.tension", "row.status"])
    assert set(result["row.status"]) == {"slack"}
    np.testing.assert_allclose(result["K.tension"], 8.0 * -9.9 / 4.0, rtol=1e-13)
    (said,) = (d for d in result.diagnostics if d.code == "slack")
    assert "K goes slack in all rows" in said.message


HOIST = (
    HEAD
    + """
links: {drums: {}, block: {mass: 6, center_of_mass: [-0.02, -1]}}
joints:
  A: {type: R, links: [ground, drums], point: [0, 0]}
  G: {type: P, links: [ground, block], point: [-0.02, -1], axis: [0, 1]}
points: {b: {link: block, at: [-0.02, -1]}}
couplings:
  K:
    type: cable
    path:
      - {drum: A, radius: 0.12, side: right}
      - {pulley: b, radius: 0.1, side: right}
      - {drum: A, radius: 0.08, side: right}
motion: {inputs: {A.theta: {from: -900, to: 900, count: 7, rate: 2 rad/s, acceleration: 1 rad/s^2}}}
loads: [{type: gravity, g: [0, -10 m/s^2]}]
"""
)


def test_a_differential_hoist() -> None:
    """Weston's: a turn lifts by pi (R - r); both strands hang straight down."""
    result = mk.loads(HOIST).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.radians(np.linspace(-900.0, 900.0, 7))
    np.testing.assert_allclose(result["G.s"], -0.02 * turn, atol=1e-14)
    pull = 6.0 * (10.0 - 0.02) / 2.0
    np.testing.assert_allclose(result["K.tension"], pull, rtol=1e-12)
    np.testing.assert_allclose(result["A.effort"], -0.04 * pull, rtol=1e-11)
    for row in range(7):
        np.testing.assert_allclose(
            result["A.force"][row], [0.0, 2.0 * pull], rtol=1e-12, atol=1e-10
        )
    assert np.nanmax(result["row.power_error"]) < 1e-12


OVER = (
    HEAD
    + """
links: {crank: {}, slide: {}}
joints:
  A: {type: R, links: [ground, crank], point: [1.5, 0.4]}
  S: {type: P, links: [ground, slide], point: [-0.2, -2], axis: [0, 1]}
points:
  c: {link: crank, at: [2, 0]}
  o: {link: ground, at: [0, 0.3]}
  q: {link: slide, at: [-0.2, -2]}
couplings: {K: {type: cable, path: [c, WAY, q]}}
motion: {inputs: {A.theta: {from: -60, to: 60, count: 5, rate: 1 rad/s}}}
loads: [{type: force, joint: S, value: -50}]
"""
)


def over(way: str) -> str:
    return OVER.replace("WAY", way)


def end_of(turn: float) -> mpmath.mpc:
    return mpmath.mpc("1.5", "0.4") + mpmath.mpc("0.5", "-0.4") * mpmath.expj(mpmath.radians(turn))


def through_an_eye(turn: float, s: mpmath.mpf) -> mpmath.mpf:
    eye = mpmath.mpc(0, "0.3")
    return abs(end_of(turn) - eye) + abs(mpmath.mpc("-0.2", -2 + s) - eye)


def around(turn: float, s: mpmath.mpf, radius: float = 0.25) -> mpmath.mpf:
    """Two tangents and the arc over the top of a circle, from right to left."""
    centre = mpmath.mpc(0, "0.3")
    one, other = end_of(turn) - centre, mpmath.mpc("-0.2", -2 + s) - centre
    lengths = [mpmath.sqrt(abs(p) ** 2 - radius**2) for p in (one, other)]
    # seen from the centre each point lies acos(r / d) from where the cable touches
    right = mpmath.arg(one) + mpmath.acos(radius / abs(one))
    left = mpmath.arg(other) % (2 * mpmath.pi) - mpmath.acos(radius / abs(other))
    return sum(lengths) + radius * (left - right)


WAYS = {
    "eye": ("o", through_an_eye),
    "pulley": ("{pulley: o, radius: 0.25, side: right}", around),
}


@pytest.mark.parametrize(("way", "length"), WAYS.values(), ids=WAYS.keys())
def test_a_crank_draws_a_slide(way: str, length) -> None:  # type: ignore[no-untyped-def]
    """Places at 40 digits; the pull by virtual power, the bearing by both strands."""
    model = mk.loads(over(way))
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    with mpmath.workdps(40):
        drawn = length(0.0, mpmath.mpf(0))
        for row, turn in enumerate(np.linspace(-60.0, 60.0, 5)):
            place = mpmath.findroot(
                lambda s, turn=turn: length(turn, s) - drawn, result["S.s"][row]
            )
            assert abs(result["S.s"][row] - place) < 1e-13
            by_s = mpmath.diff(lambda s, turn=turn: length(turn, s), place)
            by_turn = mpmath.diff(lambda t, place=place: length(t, place), turn) * 180 / mpmath.pi
            # the load pushes along s, the pull draws both ends in
            pull = -50 / by_s
            assert abs(result["K.tension"][row] / pull - 1) < 1e-12
            assert abs(result["A.effort"][row] / (pull * by_turn) - 1) < 1e-11
            assert abs(result["S.s_dot"][row] * by_s + by_turn) < 1e-11
    rows = [model.analyze(lanes=n, threads=t)["K.tension"] for n in widths() for t in (1, 2)]
    assert len({row.tobytes() for row in rows}) == 1
    assert set(model.certify().status) == {"proven"}


def test_a_bearing_takes_both_strands_of_a_pulley() -> None:
    """The cable's pull is the same on both sides, which the pulley's axle carries."""
    text = over("{pulley: W, radius: 0.25, side: right}").replace(
        "joints:", "joints:\n  W: {type: R, links: [ground, wheel], point: [0, 0.3]}"
    )
    text = text.replace("links: {", "links: {wheel: {}, ").replace(
        "inputs: {", "inputs: {W.theta: {with: 3*A.theta}, "
    )
    result = mk.loads(text).analyze()
    plain = mk.loads(over("{pulley: o, radius: 0.25, side: right}")).analyze()
    np.testing.assert_allclose(result["S.s"], plain["S.s"], atol=1e-13)
    np.testing.assert_allclose(result["W.effort"], 0.0, atol=1e-10)
    for row, turn in enumerate(np.linspace(-60.0, 60.0, 5)):
        pulls = []
        for end, side in (
            (complex(end_of(turn)) - 0.3j, 1.0),
            (complex(-0.2, -2.3 + result["S.s"][row]), -1.0),
        ):
            touch = 0.25 * end / abs(end) * np.exp(1j * side * np.arccos(0.25 / abs(end)))
            pulls.append((end - touch) / abs(end - touch))
        force = -result["K.tension"][row] * sum(pulls)
        np.testing.assert_allclose(result["W.force"][row], [force.real, force.imag], rtol=1e-11)


CRANE = (
    HEAD
    + """
links: {drum: {}, boom: {}, hook: {}}
joints:
  D: {type: R, links: [ground, drum], point: [0, 0]}
  A: {type: R, links: [ground, boom], point: [1, 0]}
  H: {type: P, links: [ground, hook], point: [7, 1], axis: [0, 1]}
points:
  t: {link: boom, at: [6, 4]}
  h: {link: hook, at: [7, 1]}
couplings:
  K:
    type: cable
    path: [{drum: D, radius: 0.3, side: left}, {pulley: t, radius: 0.2, side: left}, h]
motion:
  inputs:
    A.theta: {from: -10, to: 20, count: 4, rate: 0.1 rad/s}
    D.theta: {with: 9*A.theta}
loads: [{type: force, joint: H, value: -900}]
"""
)


def test_a_crane_whose_cable_runs_from_pulley_to_pulley() -> None:
    """The boom luffs and the drum turns: what is wound, two tangents and an arc at 40 digits."""
    result = mk.loads(CRANE).analyze()
    assert set(result["row.status"]) == {"ok"}
    drum, pulley = mpmath.mpf("0.3"), mpmath.mpf("0.2")

    def length(luff: float, turn: float, s: mpmath.mpf) -> mpmath.mpf:
        tip = 1 + mpmath.mpc(5, 4) * mpmath.expj(mpmath.radians(luff))
        down = mpmath.mpc(7, 1 + s) - tip
        # where the cable touches, on the left of its way
        first = mpmath.arg(tip) + mpmath.acos((drum - pulley) / abs(tip))
        second = mpmath.arg(down) + mpmath.acos(pulley / abs(down))
        stretches = mpmath.sqrt(abs(tip) ** 2 - (drum - pulley) ** 2)
        stretches += mpmath.sqrt(abs(down) ** 2 - pulley**2)
        wound = drum * (mpmath.radians(turn) - first)
        return wound + stretches + pulley * (first - second)

    with mpmath.workdps(40):
        drawn = length(0.0, 0.0, mpmath.mpf(0))
        for row, luff in enumerate(np.linspace(-10.0, 20.0, 4)):
            found, turn = result["H.s"][row], 9.0 * luff
            place = mpmath.findroot(lambda s, a=luff, b=turn: length(a, b, s) - drawn, found)
            assert abs(found - place) < 1e-12
            by_s = mpmath.diff(lambda s, a=luff, b=turn: length(a, b, s), place)
            pull = -900 / by_s
            assert abs(result["K.tension"][row] / pull - 1) < 1e-11
            assert abs(result["D.effort"][row] / (pull * drum) - 1) < 1e-11
            by_luff = mpmath.diff(lambda a, b=turn, s=place: length(a, b, s), luff)
            moment = pull * by_luff * 180 / mpmath.pi
            assert abs(result["A.effort"][row] / moment - 1) < 1e-10
    assert np.nanmax(result["row.power_error"]) < 1e-12


def test_a_cable_that_leaves_its_pulley_is_named() -> None:
    """Over the pulley's top only while both ends hang below: beyond, no arc is left."""
    text = (
        HEAD
        + """
links: {arm: {}, slide: {}}
joints:
  A: {type: R, links: [ground, arm], point: [1, 0]}
  S: {type: P, links: [ground, slide], point: [-2, 0], axis: [1, 0]}
points:
  o: {link: ground, at: [0, 0]}
  p: {link: arm, at: [2, 0]}
  q: {link: slide, at: [-2, 0]}
couplings: {K: {type: cable, path: [q, {pulley: o, radius: 0.3, side: left}, p]}}
motion: {inputs: {A.theta: {from: -60, to: 60, count: 7, rate: 1 rad/s}}}
"""
    )
    result = mk.loads(text).analyze(["S.s", "row.status"])
    status = result["row.status"]
    for row, turn in enumerate(np.radians(np.linspace(-60.0, 60.0, 7))):
        end, other = 1.0 + np.exp(1j * turn), -2.0 + result["S.s"][row]
        # what is left between where both ends touch
        first = np.pi - np.arccos(0.3 / abs(other))
        arc = first - (np.angle(end) + np.arccos(0.3 / abs(end)))
        assert status[row] == ("ok" if arc > 0.0 else "slack")
    assert {"ok", "slack"} == set(status)
    (said,) = (d for d in result.diagnostics if d.code == "slack")
    assert "K leaves the pulley at o" in said.message
    radius = text.replace("motion:", "parameters: {r: 0.3 m}\nmotion:").replace(
        "radius: 0.3", "radius: r"
    )
    varied = mk.loads(radius).vary({"r": ["0.3 m", "0.01 m"]}, ["S.s"])
    assert varied.status[0].tolist() == list(status)
    assert varied.status[1].tolist() != list(status)


def test_slopes_by_the_radius_of_a_pulley_and_errors_of_cells() -> None:
    """The cable is as long as drawn over the eye's pulley, whatever its radius is."""
    text = over("{pulley: o, radius: r, side: right}").replace(
        "links: {crank", "parameters: {r: 0.25 m}\nlinks: {crank"
    )
    model = mk.loads(text)
    slopes = model.sensitivities(["S.s"], ["r"])["S.s", "r"]
    places = model.analyze()["S.s"]
    with mpmath.workdps(40):
        for row, turn in enumerate(np.linspace(-60.0, 60.0, 5)):
            longer = mpmath.diff(
                lambda r, t=turn, s=places[row]: around(t, s, r) - around(0, 0, r), 0.25
            )
            by_s = mpmath.diff(lambda s, t=turn: around(t, s), places[row])
            assert abs(slopes[row] + longer / by_s) < 1e-9
    errors = model.analyze(errors=True).errors
    assert errors.digits is not None
    assert errors.digits >= 13


def test_a_crane_is_assembled_with_its_cable_wound_as_drawn() -> None:
    """Boom and drum given, the hook hangs at one height for each whole turn on the drum."""
    model = mk.loads(CRANE)
    modes = model.modes()
    places = sorted(mode.coordinates["H.s"] for mode in modes.modes)
    assert len(places) == len({round(place, 6) for place in places})
    first = model.analyze()["H.s"][0]
    assert any(abs(place - first) < 1e-9 for place in places)


def test_two_masses_over_a_pulley_fall() -> None:
    """Atwood's machine: (m - n) g / (m + n), and the pull 2 m n g / (m + n)."""
    text = (
        HEAD
        + """
links:
  left: {mass: 5, center_of_mass: [-0.3, -1]}
  right: {mass: 3, center_of_mass: [0.3, -1]}
joints:
  A: {type: P, links: [ground, left], point: [-0.3, -1], axis: [0, 1]}
  B: {type: P, links: [ground, right], point: [0.3, -1], axis: [0, 1]}
points:
  a: {link: left, at: [-0.3, -1]}
  b: {link: right, at: [0.3, -1]}
  o: {link: ground, at: [0, 0]}
couplings: {K: {type: cable, path: [a, {pulley: o, radius: 0.3, side: left}, b]}}
loads: [{type: gravity, g: [0, -10 m/s^2]}]
responses: {fall: {start: {A.s: 0}, time: {from: 0, to: 0.5, count: 3}}}
"""
    )
    result = mk.loads(text).respond("fall")
    times = np.linspace(0.0, 0.5, 3)
    np.testing.assert_allclose(result["A.s"], -0.5 * 2.5 * times**2, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(result["B.s"], 0.5 * 2.5 * times**2, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(result["K.tension"], 2.0 * 5.0 * 3.0 * 10.0 / 8.0, rtol=1e-9)


SPACE = """
format: 1
units: {length: m, angle: deg, mass: kg, force: N}
links: {arm: {}, slide: {}}
joints:
  A: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 1, 2]}
  S: {type: P, links: [ground, slide], point: [3, 1, 0], axis: [0, 0, 1]}
points:
  p: {link: arm, at: [1, 0, 0.5]}
  e: {link: ground, at: [2, 0, 2]}
  q: {link: slide, at: [3, 1, 0]}
couplings: {K: {type: cable, path: [p, e, q, e]}}
motion: {inputs: {A.theta: {from: 0, to: 40, count: 5, rate: 1 rad/s}}}
loads: [{type: force, joint: S, value: -7}]
"""


def test_a_cable_in_space() -> None:
    """|p e| + 2 |e q| is constant; the eye lies above the slide, on whose load the cable pulls."""
    result = mk.loads(SPACE).analyze()
    assert set(result["row.status"]) == {"ok"}
    axis, eye = np.array([0.0, 1.0, 2.0]) / np.sqrt(5.0), np.array([2.0, 0.0, 2.0])
    start = np.array([1.0, 0.0, 0.5])
    total = np.linalg.norm(start - eye) + 2.0 * np.sqrt(2.0 + 4.0)
    for row, turn in enumerate(np.radians(np.linspace(0.0, 40.0, 5))):
        along = axis * (axis @ start)
        end = along + np.cos(turn) * (start - along) + np.sin(turn) * np.cross(axis, start)
        rest = (total - np.linalg.norm(end - eye)) / 2.0
        height = 2.0 - np.sqrt(rest**2 - 2.0)
        assert abs(result["S.s"][row] - height) < 1e-12
        pull = 7.0 * rest / (2.0 * (2.0 - height))
        assert abs(result["K.tension"][row] / pull - 1.0) < 1e-12
        moment = pull * np.cross(end, (end - eye) / np.linalg.norm(end - eye)) @ axis
        assert abs(result["A.effort"][row] - moment) < 1e-11


WRONG = {
    "spatial": (SPACE, "p, e,", "p, {pulley: e, radius: 0.1, side: left},", "has no axis"),
    "point": (SPACE, "p, e,", "p, f,", "there is no point f"),
    "side": (OVER, "WAY", "{pulley: o, radius: 0.1}", "a pulley needs its side"),
    "both": (OVER, "WAY", "{pulley: o, point: c, radius: 1, side: left}", "a point, a pulley or"),
    "radius": (OVER, "WAY", "{pulley: o, radius: 0, side: left}", "the radius of a pulley is 0"),
    "large": (OVER, "WAY", "{pulley: o, radius: 9, side: left}", "no straight stretch"),
    "drum": (OVER, "WAY", "{drum: A, radius: 0.1, side: left}", "ends on the drum at A"),
    "rest": (OVER, "[c, WAY, q]", "[c, c]", "no straight stretch"),
    "one link": (SPACE, "e: {link: ground", "e: {link: slide", "one link"),
}


@pytest.mark.parametrize(("text", "before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_cables_that_cannot_be_are_refused(text: str, before: str, after: str, words: str) -> None:
    assert before in text
    if words == "one link":
        text = text.replace("[p, e, q, e]", "[e, q]")
    with pytest.raises(InvalidFile) as told:
        mk.loads(text.replace(before, after))
    assert any(words in str(d) for d in told.value.diagnostics)


def winch(x: float, radius: float, side: str, motion: str) -> str:
    return f"""
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  load: {{mass: 2, center_of_mass: [{x}, -1.5], inertia: 0}}
  drum: {{mass: 1, center_of_mass: [0, 0], inertia: 0.2}}
points: {{q: {{link: load, at: [{x}, -1.5]}}}}
joints:
  S: {{type: P, links: [ground, load], point: [{x}, 0], axis: [0, 1]}}
  A: {{type: R, links: [ground, drum], point: [0, 0]}}
couplings: {{K: {{type: cable, path: [{{drum: A, radius: {radius}, side: {side}}}, q]}}}}
loads: [{{type: gravity, g: [0, -9.81]}}]
{motion}
"""


@pytest.mark.parametrize(("side", "sense"), [("left", -1.0), ("right", 1.0)])
@pytest.mark.parametrize(("x", "radius"), [(1.0, 0.3), (-0.7, 0.2), (0.4, 0.05), (0.05, 0.35)])
def test_a_drum_turns_by_what_it_winds(side: str, sense: float, x: float, radius: float) -> None:
    """The drum is carried by its joint and by the cable that leaves it, and spins about neither."""
    sweep = "motion: {inputs: {S.s: {from: -0.3, to: 0.3, step: 0.1}}}"
    model = mk.loads(winch(x, radius, side, sweep))
    assert model.mobility().idle == ()
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}

    def length(s: float) -> mpmath.mpf:
        across, down = mpmath.mpf(x), mpmath.mpf("-1.5") + s
        far = mpmath.sqrt(across**2 + down**2)
        touch = mpmath.atan2(down, across) - sense * mpmath.acos(radius / far)
        return mpmath.sqrt(far**2 - mpmath.mpf(radius) ** 2) + sense * radius * touch

    with mpmath.workdps(40):
        turns = [sense * (length(s) - length(0)) / radius for s in np.linspace(-0.3, 0.3, 7)]
    np.testing.assert_allclose(result["A.theta"], [float(turn) for turn in turns], atol=1e-12)


@pytest.mark.parametrize("start", ["S.s", "A.theta"])
def test_a_winch_runs_down(start: str) -> None:
    motion = f"responses: {{r: {{start: {{{start}: 0}}, time: {{from: 0, to: 1, step: 0.25}}}}}}"
    run = mk.loads(winch(0.3, 0.3, "left", motion)).respond("r")
    t = np.linspace(0.0, 1.0, 5)
    fall = 9.81 * 2 * 0.3**2 / (2 * 0.3**2 + 0.2) * t * t / 2
    assert set(run["row.status"]) == {"ok"}
    np.testing.assert_allclose(run["S.s"], -fall, rtol=1e-9, atol=1e-12)


def test_every_quantity_of_a_tackle_can_be_asked_for() -> None:
    """A stretch drives the block along its way, so that its force is at 90 deg."""
    model = mk.loads(TACKLE)
    names = [name for name in model.quantities if not name.startswith("row.")]
    result = model.analyze(names, tables=[])
    np.testing.assert_allclose(result["G.s.dynamic_transmission_angle"], 90.0, rtol=1e-12)


def test_a_cylinder_drives_at_its_angle_to_the_boom() -> None:
    """Of a boom of 3 from A and a cylinder from (0, -4): the force is at 90 deg less the angle
    between boom and cylinder to the way of the eye; atan(4/3) as drawn."""
    text = (
        HEAD
        + """
links: {boom: {mass: 2, center_of_mass: [1, 0]}}
joints: {A: {type: R, links: [ground, boom], point: [0, 0]}}
points: {P: {link: ground, at: [0, -4]}, Q: {link: boom, at: [3, 0]}}
cylinders: {lift: {from: P, to: Q}}
motion: {inputs: {lift.s: {from: 5, to: 6, step: 0.25}}}
loads: [{type: gravity, g: [0, -10 m/s^2]}]
"""
    )
    result = mk.loads(text).analyze(["A.theta.dynamic_transmission_angle", "lift.s"])
    length = result["lift.s"]
    between = np.arccos((length**2 + 9.0 - 16.0) / (2.0 * 3.0 * length))
    angle = np.degrees(np.abs(np.pi / 2.0 - np.abs(np.pi / 2.0 - between)))
    np.testing.assert_allclose(result["A.theta.dynamic_transmission_angle"], angle, rtol=1e-11)
