"""Cables over pulleys in space: the plane's against the same in space, drawn upright or turned, and
pulleys that swivel against their closed form at 40 digits (Pott, Cable-Driven Parallel Robots)."""

from __future__ import annotations

import re

import mpmath
import numpy as np
import pytest
from couplings.test_cables import CRANE, HOIST, over

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.kernel.functions import widths

TURNED = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0
"""A turn by a third about no axis of the drawing: columns are where x, y and z go."""


def in_space(text: str, turn: np.ndarray) -> str:
    """A plane file as one of space, its plane turned."""

    def carried(match: re.Match[str]) -> str:
        x, y = (float(part) for part in match[2].split(","))
        return f"{match[1]}{[float(c) for c in turn @ [x, y, 0.0]]}"

    text = re.sub(r"((?:point|at|center_of_mass|axis): )\[([^\]]*)\]", carried, text)
    z = [float(c) for c in turn[:, 2]]
    text = re.sub(r"(\{type: R, [^}]*)\}", rf"\1, axis: {z}}}", text)
    text = re.sub(r"(pulley: [a-z]\w*, [^}]*)\}", rf"\1, axis: {z}}}", text)
    gravity = [f"{c} m/s^2" for c in turn @ [0.0, -10.0, 0.0]]
    return text.replace("plane: xy\n", "").replace("g: [0, -10 m/s^2]", f"g: {gravity}")


PLANE = {
    "pulley": (over("{pulley: o, radius: 0.25, side: right}"), "S.s A.effort K.tension"),
    "hoist": (HOIST, "G.s G.s_dot A.effort K.tension"),
    "crane": (CRANE, "H.s D.effort A.effort K.tension"),
}


@pytest.mark.parametrize(("text", "names"), PLANE.values(), ids=PLANE.keys())
@pytest.mark.parametrize("turn", [np.eye(3), TURNED], ids=["upright", "turned"])
def test_the_same_in_space_as_in_a_plane(text: str, names: str, turn: np.ndarray) -> None:
    plane, space = (mk.loads(each).analyze() for each in (text, in_space(text, turn)))
    assert set(space["row.status"]) == {"ok"}
    for name in names.split():
        level = np.max(np.abs(plane[name]))
        np.testing.assert_allclose(space[name], plane[name], rtol=1e-12, atol=1e-12 * level)
    bearing = "A.force"
    flat = np.column_stack([plane[bearing], np.zeros(len(plane[bearing]))])
    level = np.max(np.abs(flat))
    np.testing.assert_allclose(space[bearing], flat @ turn.T, rtol=1e-10, atol=1e-11 * level)
    assert np.nanmax(space["row.power_error"]) < 1e-12


ROBOT = """
format: 1
units: {length: m, angle: deg, mass: kg, force: N}
links:
  beam: {}
  cart: {}
  body: {mass: 3, center_of_mass: [0.2, 0.1, -1]}
  w1: {}
  w2: {}
  w3: {}
joints:
  X: {type: P, links: [ground, beam], point: [0, 0, 0], axis: [1, 0, 0]}
  Y: {type: P, links: [beam, cart], point: [0, 0, 0], axis: [0, 1, 0]}
  Z: {type: P, links: [cart, body], point: [0, 0, 0], axis: [0, 0, 1]}
  S1: {type: P, links: [ground, w1], point: [2, 0, -2], axis: [0, 0, 1]}
  S2: {type: P, links: [ground, w2], point: [-1, 1.5, -2], axis: [0, 0, 1]}
  S3: {type: P, links: [ground, w3], point: [-1, -1.5, -2], axis: [0, 0, 1]}
points:
  p: {link: body, at: [0.2, 0.1, -1]}
  a1: {link: ground, at: [2, 0, 0]}
  a2: {link: ground, at: [-1, 1.5, 0]}
  a3: {link: ground, at: [-1, -1.5, 0]}
  b1: {link: w1, at: [2, 0, -2]}
  b2: {link: w2, at: [-1, 1.5, -2]}
  b3: {link: w3, at: [-1, -1.5, -2]}
couplings:
  K1: {type: cable, path: [b1, {pulley: a1, radius: 0.1, swivel: [0, 0, 1]}, p]}
  K2: {type: cable, path: [p, {pulley: a2, radius: 0.12, swivel: [0, 0, -1]}, b2]}
  K3: {type: cable, path: [b3, {pulley: a3, radius: 0.08, swivel: [0, 0, 1]}, p]}
motion:
  inputs:
    S1.s: {from: 0, to: -0.4, count: 5, rate: -0.3 m/s, acceleration: 0.7 m/s^2}
    S2.s: {with: "-0.5*S1.s"}
    S3.s: {with: "0.25*S1.s + S1.s^2/(1 m)"}
loads: [{type: gravity, g: [0, 0, -10 m/s^2]}]
"""
CORNERS = {
    1: (("2", "0"), "0.1"),
    2: (("-1", "1.5"), "0.12"),
    3: (("-1", "-1.5"), "0.08"),
}


def rope(corner: int, x: mpmath.mpf, y: mpmath.mpf, z: mpmath.mpf) -> mpmath.mpf:
    """Tangent and arc from a vertical line over a pulley of that line's plane with the point."""
    (a, b), r = CORNERS[corner]
    radius = mpmath.mpf(r)
    out = mpmath.hypot(x - mpmath.mpf(a), y - mpmath.mpf(b)) - radius
    apart = mpmath.hypot(out, z)
    touch = mpmath.atan2(z, out) + mpmath.acos(radius / apart)
    return mpmath.sqrt(apart**2 - radius**2) + radius * (mpmath.pi - touch)


def test_a_cable_robot_whose_pulleys_swivel() -> None:
    """Winches drive a point mass: its place by three lengths, its pulls by Newton's equation."""
    model = mk.loads(ROBOT)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    with mpmath.workdps(40):
        home = [mpmath.mpf("0.2"), mpmath.mpf("0.1"), mpmath.mpf(-1)]
        drawn = {k: rope(k, *home) for k in CORNERS}
        for row in range(5):
            # from the winch: what goes down there comes up here
            paid = {k: mpmath.mpf(float(result[f"S{k}.s"][row])) for k in CORNERS}
            found = [mpmath.mpf(float(result[f"{n}.s"][row])) for n in "XYZ"]

            def missing(*moved, paid=paid):  # type: ignore[no-untyped-def]
                place = [h + m for h, m in zip(home, moved, strict=True)]
                return [rope(k, *place) - drawn[k] - paid[k] for k in CORNERS]

            place = mpmath.findroot(missing, found)
            for one, other in zip(found, place, strict=True):
                assert abs(one - other) < 1e-13
            at = [h + m for h, m in zip(home, place, strict=True)]
            slope = mpmath.matrix(3, 3)
            for i, k in enumerate(CORNERS):
                for j in range(3):
                    order = tuple(int(j == n) for n in range(3))
                    slope[i, j] = mpmath.diff(lambda *p, k=k: rope(k, *p), tuple(at), order)
            speeds = mpmath.matrix([float(result[f"{n}.s_dot"][row]) for n in "XYZ"])
            for i, k in enumerate(CORNERS):
                rate = (slope * speeds)[i]
                assert abs(rate - float(result[f"S{k}.s_dot"][row])) < 1e-12
            accelerations = [float(result[f"{n}.s_ddot"][row]) for n in "XYZ"]
            load = mpmath.matrix(
                [3 * (a + g) for a, g in zip(accelerations, (0, 0, 10), strict=True)]
            )
            pulls = mpmath.lu_solve(slope.T, -load)
            for i, k in enumerate(CORNERS):
                assert abs(result[f"K{k}.tension"][row] / pulls[i] - 1) < 1e-11
                # the winch holds the cable, whose pull draws it up
                assert abs(result[f"S{k}.effort"][row] / -pulls[i] - 1) < 1e-11
    assert np.nanmax(result["row.power_error"]) < 1e-12
    assert model.mobility().mobility == 3
    rows = [model.analyze(lanes=n, threads=t)["K1.tension"] for n in widths() for t in (1, 2)]
    assert len({row.tobytes() for row in rows}) == 1
    assert set(model.certify().status) == {"proven"}


def test_pulleys_swivel_towards_their_points_in_all_modes() -> None:
    """Turned away, a pulley has its cable in the plane, too, but swings round at a touch: below
    the pulleys, where the robot works, and above them one place is left each."""
    modes = mk.loads(ROBOT).modes().modes
    with mpmath.workdps(30):
        home = [mpmath.mpf("0.2"), mpmath.mpf("0.1"), mpmath.mpf(-1)]
        for mode in modes:
            place = [h + mode.coordinates[f"{n}.s"] for h, n in zip(home, "XYZ", strict=True)]
            for k in CORNERS:
                assert abs(rope(k, *place) - rope(k, *home)) < 1e-9
    assert sorted(mode.coordinates["Z.s"] > 1.0 for mode in modes) == [False, True]


GANTRY = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links:
  trolley: {mass: 2, center_of_mass: [0, 0, 0.2]}
  drum: {mass: 1, center_of_mass: [0.3, 0, -1], inertia: {xx: 0.02, yy: 0.03, zz: 0.02}}
  arm: {mass: 1.5, center_of_mass: [1.5, 0.8, -0.5], inertia: {xx: 0.1, yy: 0.2, zz: 0.3}}
joints:
  X: {type: P, links: [ground, trolley], point: [0, 0, 0], axis: [1, 2, 0]}
  D: {type: R, links: [trolley, drum], point: [0.3, 0, -1], axis: [0, -1, 0]}
  A: {type: R, links: [ground, arm], point: [1, 0, -0.5], axis: [0, 1, -3]}
points:
  a: {link: trolley, at: [0, 0, 0]}
  p: {link: arm, at: [1.5, 1.2, -0.8]}
couplings:
  K:
    type: cable
    path:
      - {drum: D, radius: 0.3, side: left}
      - {pulley: a, radius: 0.1, swivel: [0, 0, 1]}
      - p
motion:
  inputs:
    X.s: {from: 0, to: 0.3, count: 4, rate: 0.5 m/s, acceleration: 1.5 m/s^2}
    D.theta: {with: "2 rad*X.s/(1 m)"}
loads: [{type: gravity, g: [0, 0, -10 m/s^2]}]
"""


def arm_end(theta: mpmath.mpf) -> list[mpmath.mpf]:
    """Where the arm's end is, by Rodrigues' formula."""
    axis = [mpmath.mpf(x) / mpmath.sqrt(10) for x in (0, 1, -3)]
    pin = [mpmath.mpf(x) for x in ("1", "0", "-0.5")]
    arm = [mpmath.mpf(x) for x in ("0.5", "1.2", "-0.3")]
    c, t = mpmath.cos(theta), mpmath.sin(theta)
    along = sum(a * b for a, b in zip(axis, arm, strict=True))
    across = [
        axis[(i + 1) % 3] * arm[(i + 2) % 3] - axis[(i + 2) % 3] * arm[(i + 1) % 3]
        for i in range(3)
    ]
    return [pin[i] + c * arm[i] + t * across[i] + (1 - c) * along * axis[i] for i in range(3)]


def from_trolley(s: mpmath.mpf, theta: mpmath.mpf) -> list[mpmath.mpf]:
    """The arm's end against the trolley's point, which runs along (1, 2, 0)."""
    way = [mpmath.mpf(x) / mpmath.sqrt(5) for x in (1, 2, 0)]
    return [e - s * w for e, w in zip(arm_end(theta), way, strict=True)]


def over_pulley(end: list[mpmath.mpf], radius: mpmath.mpf) -> tuple[mpmath.mpf, list[mpmath.mpf]]:
    """The length from the point of the line on, and the direction of the straight stretch."""
    aside = mpmath.hypot(end[0], end[1])
    apart = mpmath.hypot(aside - radius, end[2])
    touch = mpmath.atan2(end[2], aside - radius) + mpmath.acos(radius / apart)
    straight = mpmath.sqrt(apart**2 - radius**2)
    # the tangent where the pulley's rim is at `touch`, run down it
    out, up = mpmath.sin(touch), -mpmath.cos(touch)
    direction = [out * end[0] / aside, out * end[1] / aside, up]
    return straight + radius * (mpmath.pi - touch), direction


def test_a_drum_and_a_swivelling_pulley_on_a_trolley_that_speeds_up() -> None:
    """The drum's rim touches the line below the pulley: what it winds draws the arm. The trolley's
    guide takes what the cable pulls at pulley and drum, the drum's bearing its pull alone."""
    result = mk.loads(GANTRY).analyze()
    assert set(result["row.status"]) == {"ok"}
    radius = mpmath.mpf("0.1")
    with mpmath.workdps(40):

        def length(s, turn, theta):  # type: ignore[no-untyped-def]
            # about -y the rim on the line goes down as the drum turns
            return over_pulley(from_trolley(s, theta), radius)[0] + mpmath.mpf("0.3") * turn

        drawn = length(0, 0, 0)
        for row in range(4):
            s, turn, found = (float(result[n][row]) for n in ("X.s", "D.theta", "A.theta"))
            place = mpmath.findroot(lambda a, s=s, t=turn: length(s, t, a) - drawn, found)
            assert abs(found - place) < 1e-12
            pull = float(result["K.tension"][row])
            strand = np.array([float(c) for c in over_pulley(from_trolley(s, place), radius)[1]])
            way, up = np.array([1.0, 2.0, 0.0]) / np.sqrt(5.0), np.array([0.0, 0.0, 1.0])
            speeding = 1.5 * way
            # 2 kg of the trolley and 1 kg of the drum
            held = 3.0 * (speeding + 10.0 * up) - pull * strand
            guided = result["X.force"][row] + result["X.effort"][row] * way
            np.testing.assert_allclose(guided, held, rtol=1e-11, atol=1e-10)
            bearing = 1.0 * (speeding + 10.0 * up) - pull * up
            np.testing.assert_allclose(result["D.force"][row], bearing, rtol=1e-11, atol=1e-10)
    assert np.nanmax(result["row.power_error"]) < 1e-12


def test_slopes_by_the_radius_of_a_swivelling_pulley() -> None:
    """The cable is as long as drawn over the pulley, whatever its radius is."""
    text = GANTRY.replace("links:\n", "parameters: {r: 0.1 m}\nlinks:\n", 1)
    model = mk.loads(text.replace("radius: 0.1", "radius: r"))
    slopes = model.sensitivities(["A.theta"], ["r"])["A.theta", "r"]
    result = model.analyze()
    with mpmath.workdps(40):
        for row in range(4):
            s, theta = (float(result[n][row]) for n in ("X.s", "A.theta"))

            def length(r, a, s=s):  # type: ignore[no-untyped-def]
                return over_pulley(from_trolley(s, a), r)[0]

            longer = mpmath.diff(lambda r, a=theta: length(r, a) - length(r, 0, 0), 0.1)
            by_turn = mpmath.diff(lambda a: length(mpmath.mpf("0.1"), a), theta)
            assert abs(slopes[row] + longer / by_turn) < 1e-9


def test_every_quantity_can_be_asked_for() -> None:
    for text in (ROBOT, GANTRY):
        model = mk.loads(text)
        names = [name for name in model.quantities if not name.startswith("row.")]
        result = model.analyze(names, tables=[])
        assert set(result["row.status"]) == {"ok"}


ROPEWAY = """
format: 1
units: {length: m, angle: deg, mass: kg, force: N}
links: {beam: {}, cart: {}, car: {mass: 3, center_of_mass: [1.5, 0.2, -1]}, mast: {}}
joints:
  X: {type: P, links: [ground, beam], point: [0, 0, 0], axis: [1, 0, 0]}
  Y: {type: P, links: [beam, cart], point: [0, 0, 0], axis: [0, 1, 0]}
  Z: {type: P, links: [cart, car], point: [0, 0, 0], axis: [0, 0, 1]}
  M: {type: P, links: [ground, mast], point: [4, 1, 0.5], axis: [0, 1, 0]}
points:
  c: {link: car, at: [1.5, 0.2, -1]}
  a: {link: ground, at: [0, 0, 0]}
  b: {link: mast, at: [4, 1, 0.5]}
couplings: {K: {type: cable, path: [a, {pulley: c, radius: 0.2, free: true}, b]}}
motion:
  inputs:
    X.s: {from: -0.5, to: 1, count: 4, rate: 0.8 m/s, acceleration: -0.5 m/s^2}
    Y.s: {with: X.s/2}
    M.s: {with: X.s/5}
loads: [{type: gravity, g: [0, 0, -10 m/s^2]}]
"""


def under_pulley(x: mpmath.mpf, y: mpmath.mpf, z: mpmath.mpf, m: mpmath.mpf) -> mpmath.mpf:
    """Both tangents, and the arc beneath, in the plane of the centre and both ends."""
    radius, centre = mpmath.mpf("0.2"), [mpmath.mpf("1.5") + x, mpmath.mpf("0.2") + y, z - 1]
    ends = [[0, 0, 0], [4, 1 + m, mpmath.mpf("0.5")]]
    arms = [[e - c for e, c in zip(end, centre, strict=True)] for end in ends]
    one, other = (mpmath.sqrt(sum(c * c for c in arm)) for arm in arms)
    between = mpmath.acos(sum(a * b for a, b in zip(*arms, strict=True)) / (one * other))
    touch = mpmath.acos(radius / one) + mpmath.acos(radius / other)
    straight = sum(mpmath.sqrt(d * d - radius * radius) for d in (one, other))
    return straight + radius * (2 * mpmath.pi - between - touch)


def test_a_free_pulley_runs_on_its_cable() -> None:
    """A ropeway's car between a mast that stands and one that moves: its height by the length, the
    pull and the efforts of the slides by virtual work."""
    model = mk.loads(ROPEWAY)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    with mpmath.workdps(40):
        drawn = under_pulley(0, 0, 0, 0)
        for row in range(4):
            x, y, z, m = at = [float(result[f"{n}.s"][row]) for n in "XYZM"]
            place = mpmath.findroot(lambda h, x=x, y=y, m=m: under_pulley(x, y, h, m) - drawn, z)
            assert abs(z - place) < 1e-13
            slopes = [
                mpmath.diff(under_pulley, tuple(at), tuple(int(k == n) for n in range(4)))
                for k in range(4)
            ]
            rates = [float(result[f"{n}.s_dot"][row]) for n in "XYZM"]
            assert abs(sum(s * r for s, r in zip(slopes, rates, strict=True))) < 1e-13
            speeding = [float(result[f"{n}.s_ddot"][row]) for n in "XYZ"]
            pull = -3.0 * (10.0 + speeding[2]) / slopes[2]
            assert abs(result["K.tension"][row] / pull - 1) < 1e-11
            for name, slope, mass, quick in zip(
                "XYM", (slopes[0], slopes[1], slopes[3]), (3, 3, 0), (*speeding[:2], 0), strict=True
            ):
                effort = mass * quick + pull * slope
                assert abs(result[f"{name}.effort"][row] - effort) < 1e-10
    assert np.nanmax(result["row.power_error"]) < 1e-12
    assert set(model.certify().status) == {"proven"}


def test_no_strands_of_a_free_pulley_cross() -> None:
    """Below the line of both ends the car hangs, above it stands; with a loop of the cable round
    the pulley, whose strands cross, each would have a place more."""
    deep = mk.loads(ROPEWAY.replace("1.5, 0.2, -1]", "1.5, 0.2, -3]"))
    modes = deep.modes().modes
    assert len(modes) == 2
    with mpmath.workdps(30):
        drawn = under_pulley(0, 0, -2, 0)
        for mode in modes:
            x, y, z, m = (mode.coordinates[f"{n}.s"] for n in "XYZM")
            assert abs(under_pulley(x, y, z - 2, m) - drawn) < 1e-9


LEAVES = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {arm: {}, slide: {}}
joints:
  A: {type: R, links: [ground, arm], point: [100, 0, -100], axis: [1, 0, 0]}
  S: {type: P, links: [ground, slide], point: [-20, 0, -100], axis: [0, 0, 1]}
points:
  o: {link: ground, at: [0, 0, 0]}
  p: {link: arm, at: [100, 0, -150]}
  q: {link: slide, at: [-20, 0, -100]}
couplings:
  K: {type: cable, path: [q, {pulley: o, radius: 20, side: left, axis: [0, 1, 0]}, p]}
motion: {inputs: {A.theta: {values: [-30, 0, 30]}}}
"""


def test_a_fleet_angle_is_named() -> None:
    """The arm swings its end out of the pulley's plane: 25 mm by the stretch as drawn."""
    result = mk.loads(LEAVES).analyze(["S.s", "row.status"])
    assert result["row.status"].tolist() == ["fleet-angle", "ok", "fleet-angle"]
    (said,) = (d for d in result.diagnostics if d.code == "fleet-angle")
    drawn = np.sqrt(100.0**2 + 150.0**2 - 20.0**2)
    assert said.measured is not None
    assert f"fleet angle {np.degrees(np.arctan(25.0 / drawn)):.8g}" in said.measured
    assert "K leaves the plane of a pulley" in said.message
    swivels = LEAVES.replace("side: left, axis: [0, 1, 0]", "swivel: [0, 0, 1]").replace(
        "o: {link: ground, at: [0, 0, 0]}", "o: {link: ground, at: [-20, 0, 0]}"
    )
    assert set(mk.loads(swivels).analyze()["row.status"]) == {"ok"}
    varied = mk.loads(
        LEAVES.replace("motion:", "parameters: {r: 20 mm}\nmotion:").replace(
            "radius: 20", "radius: r"
        )
    ).vary({"r": ["20 mm", "15 mm"]}, ["S.s"])
    assert varied.status.tolist() == [["fleet-angle", "ok", "fleet-angle"]] * 2


SWIVEL = "{pulley: a1, radius: 0.1, swivel: [0, 0, 1]}"
WRONG = {
    "axis": (SWIVEL, "{pulley: a1, radius: 0.1, side: left}", "has no axis"),
    "joint": (SWIVEL, "{pulley: X, radius: 0.1, swivel: [0, 0, 1]}", "a pulley turns on an R"),
    "line": ("swivel: [0, 0, 1]}, p", "swivel: [0, 1, 1]}, p", "neither comes nor leaves"),
    "end": ("[b1, " + SWIVEL, "[" + SWIVEL, "ends at the swivelling pulley"),
    "side": (SWIVEL, SWIVEL.replace("]}", "], side: left}"), "has no side"),
    "fleet": (
        SWIVEL,
        "{pulley: a1, radius: 0.1, side: left, axis: [0, 1, 0]}",
        "leaves the plane of a pulley",
    ),
    "two": (f"[b1, {SWIVEL}", f"[b1, {SWIVEL}, {SWIVEL}", "one swivelling pulley to another"),
    "free": (SWIVEL, SWIVEL.replace("]}", "], free: true}"), "about a line or is free"),
    "free end": ("[b1, " + SWIVEL, "[{pulley: a1, radius: 0.1, free: true}", "ends at the"),
    "in line": (
        f"[b1, {SWIVEL}, p]",
        "[b1, {pulley: a1, radius: 0.1, free: true}, b1]",
        "lies in line with",
    ),
    "point": (SWIVEL, "{point: a1, swivel: [0, 0, 1]}", "points and drums do not swivel"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_cables_that_cannot_be_are_refused(before: str, after: str, words: str) -> None:
    assert before in ROBOT
    with pytest.raises(InvalidFile) as told:
        mk.loads(ROBOT.replace(before, after, 1))
    assert any(words in str(d) for d in told.value.diagnostics)


def test_in_a_plane_no_pulley_has_an_axis() -> None:
    text = over("{pulley: o, radius: 0.25, side: right, axis: [0, 0, 1]}")
    with pytest.raises(InvalidFile, match="in a plane pulleys turn about z"):
        mk.loads(text)
