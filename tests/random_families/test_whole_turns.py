"""Ten thousand turns against closed forms: every row, equal bits for equal reduced inputs."""

from __future__ import annotations

import math
import os
import re
from typing import Any

import mpmath
import numpy as np
import pytest
from random_families.four_bars import cases
from random_families.test_many_turns import grashof
from references import FILE_OF

from mechkin_cli import loads
from mechkin_cli.exact import PI
from mechkin_cli.session.inputs import without_turns
from mechkin_cli.session.session import Session
from mechkin_cli.sweep.sweep import analyze
from mechkin_cli.units.units import UNITS

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

DEGREE = mpmath.mpf(180) / mpmath.pi


def swept(name: str, first: float, last: float, step: float) -> str:
    text = FILE_OF[name].read_text()
    motion = f"from: {first!r}, to: {last!r}, step: {step!r}"
    return re.sub(r"from: [^,]+, to: [^,]+, step: [^,}]+", motion, text[: text.index("tables:")])


def four_bar(bars: tuple[float, ...], motion: str, more: str = "") -> str:
    """Drawn at the crank's angle zero, rocker above the ground line."""
    a, b, c, d = bars
    ground = d - a
    at = math.acos((ground**2 + c * c - b * b) / (2 * ground * c))
    x, y = d - c * math.cos(at), c * math.sin(at)
    pin = "axis: [0, 0, 1]"
    return (
        "format: 1\nname: four_bar\nunits: {length: m, angle: deg, mass: kg, force: N}\n"
        "links: {crank: {}, coupler: {}, rocker: {}, screw: {}, nut: {}}\njoints:\n"
        f"  A: {{type: R, links: [ground, crank], point: [0, 0, 0], {pin}}}\n"
        f"  B: {{type: R, links: [crank, coupler], point: [{a!r}, 0, 0], {pin}}}\n"
        f"  C: {{type: R, links: [coupler, rocker], point: [{x!r}, {y!r}, 0], {pin}}}\n"
        f"  D: {{type: R, links: [ground, rocker], point: [{d!r}, 0, 0], {pin}}}\n"
        + more
        + f"motion: {motion}\n"
    ).replace("" if more else ", screw: {}, nut: {}", "")


def rocker(bars: tuple[float, ...], crank: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    a, b, c, d = bars
    x, y = a * np.cos(crank) - d, a * np.sin(crank)
    far = np.hypot(x, y)
    turn = np.arccos((far**2 + c * c - b * b) / (2 * far * c))
    return np.arctan2(y, x) - turn


def repeats(values: Any, period: int) -> bool:
    """Whether values are equal in every bit to those a period of rows before."""
    return np.asarray(values[period:]).tobytes() == np.asarray(values[:-period]).tobytes()


def plain(names: list[str]) -> list[str]:
    """The quantities in expressions."""
    return sorted({re.sub(r"^\w+\((.*)\)$", r"\1", name) for name in names})


def is_ok(result: Any) -> bool:
    return set(result["row.status"].tolist()) == {"ok"}


@pytest.mark.parametrize(("first", "way"), [(0, 1), (-3_600_000, 1), (7_200_000, -1)])
def test_hooke(first: int, way: int) -> None:
    """tan(B) = tan(A) cos(angle), with the turns of A."""
    last, step = first + way * 3_600_000, way * 100
    names = ["B.theta", "wrap(B.theta)", "B.theta_dot", "A.effort", "sin(B.theta)"]
    result = loads(swept("hooke", first, last, step)).analyze(plain(names))
    assert is_ok(result)
    cosine = mpmath.cos(mpmath.pi / 6)
    with mpmath.workdps(40):
        for row in range(0, 36001, 997):
            value = first + row * step
            a = (value % 360) / DEGREE
            b = mpmath.atan2(mpmath.sin(a) * cosine, mpmath.cos(a)) * DEGREE
            wanted = b + 360 * mpmath.nint((value - first - b) / 360)
            assert abs(result["B.theta"][row] - wanted) <= 1e-13 * abs(value) + 1e-12
    for name in names[1:]:
        assert repeats(result[name], 18)


def test_bennett() -> None:
    """tan(A/2) tan(B/2) is one constant, tan((B + A)/2) is not needed."""
    names = ["B.theta", "D.theta", "B.theta_dot", "A.effort", "wrap(D.theta)"]
    for first, last, step in ((15, 3_600_015, 100), (3_600_015, 15, -100)):
        result = loads(swept("bennett", first, last, step)).analyze(plain(names))
        assert is_ok(result)
        for name in names[2:]:
            assert repeats(result[name], 18)
        with mpmath.workdps(40):
            alpha, beta = mpmath.mpf(40) / DEGREE, mpmath.mpf(75) / DEGREE
            ratio = mpmath.sin((beta + alpha) / 2) / mpmath.sin((beta - alpha) / 2)
            for row in range(0, 36001, 1009):
                a = (first + row * step) % 360 / DEGREE
                b = mpmath.mpf(result["B.theta"][row]) / DEGREE
                product = abs(mpmath.tan(a / 2) * mpmath.tan(b / 2))
                assert abs(product / ratio - 1) <= 1e-9 or abs(product * ratio - 1) <= 1e-9
        turns = (result["B.theta"][-1] - result["B.theta"][0]) / (last - first)
        assert abs(turns) == 1.0


def test_rssr() -> None:
    """The rod keeps its length: distances of its spheres from the committed dimensions."""
    names = ["O4.theta", "O4.theta_dot", "O1.effort"]
    result = loads(swept("rssr", 0, 3_600_000, 1000)).analyze(plain(names))
    assert is_ok(result)
    for name in names:
        assert repeats(result[name], 9)
    with mpmath.workdps(40):
        tilt = 15 / DEGREE
        axis = mpmath.matrix([mpmath.sin(tilt), 0, mpmath.cos(tilt)])
        arm = mpmath.matrix([-20, 100, 0])
        for row in range(0, 3601, 53):
            a, b = (row * 1000 % 360) / DEGREE, mpmath.mpf(result["O4.theta"][row]) / DEGREE
            cross = mpmath.matrix(
                [
                    axis[1] * arm[2] - axis[2] * arm[1],
                    axis[2] * arm[0] - axis[0] * arm[2],
                    axis[0] * arm[1] - axis[1] * arm[0],
                ]
            )
            along = (axis.T * arm)[0] * (1 - mpmath.cos(b))
            far = mpmath.cos(b) * arm + mpmath.sin(b) * cross + along * axis
            far += mpmath.matrix([160, 0, 60])
            near = mpmath.matrix([40 * mpmath.cos(a), 40 * mpmath.sin(a), 0])
            square = sum((far[i] - near[i]) ** 2 for i in range(3))
            assert abs(mpmath.sqrt(square) - mpmath.sqrt(23600)) <= 1e-11


def test_four_bars_from_any_turn_either_way() -> None:
    for rng in cases(31, 12):
        bars = grashof(rng)
        if min(bars) != bars[0]:
            continue
        first = 360 * rng.randint(-10_000, 10_000)
        step = rng.choice([-1, 1]) * rng.choice([10, 72, 100, 1080, 3610])
        rows = rng.choice([100, 2000])
        motion = (
            f"{{inputs: {{A.theta: {{from: {first}, to: {first + rows * step}, step: {step}}}}}}}"
        )
        result = loads(four_bar(bars, motion)).analyze(["D.theta", "B.theta"])
        assert is_ok(result), motion
        crank = np.radians(np.arange(rows + 1) * step % 360)
        wanted = rocker(bars, crank)
        off = np.radians(result["D.theta"]) - (wanted - rocker(bars, np.zeros(1)))
        assert np.abs(off - 2 * np.pi * np.rint(off / (2 * np.pi))).max() <= 1e-9, motion
        assert np.ptp(result["D.theta"]) < 180
        period = 360 // math.gcd(abs(step), 360)
        assert rows < period or repeats(result["wrap(B.theta)"], period)


def test_a_motor_at_1500_rpm() -> None:
    """40 000 rows in 400 s; the speed of the rocker repeats with each turn, 0.04 s."""
    law = "{time: {from: 0, to: 400, step: 0.01}, inputs: {A.theta: {law: constant-rate, at: 0, "
    result = loads(four_bar((1, 2.5, 2, 3), law + "rate: 1500 rpm}}}")).analyze(
        ["D.theta", "D.theta_dot"]
    )
    assert is_ok(result)
    assert result["A.theta"][-1] == 3_600_000
    wanted = rocker((1, 2.5, 2, 3), np.radians(np.arange(40001) % 4 * 90.0))
    off = np.radians(result["D.theta"]) - (wanted - wanted[0])
    assert np.abs(off - 2 * np.pi * np.rint(off / (2 * np.pi))).max() <= 1e-9
    assert np.ptp(result["D.theta"]) < 180


def test_a_thread_on_the_crank_advances_and_the_rest_repeats() -> None:
    thread = (
        "  H: {type: H, links: [crank, nut], point: [0, 0, 1], axis: [0, 0, 1], lead: 0.01}\n"
        "  P: {type: P, links: [ground, nut], point: [0, 1, 1], axis: [0, 0, 1]}\n"
    )
    motion = "{inputs: {A.theta: {from: 0, to: 360000, step: 45, rate: 3 rad/s}}}"
    text = four_bar((1, 2.5, 2, 3), motion, thread).replace(", screw: {}", "")
    result = loads(text).analyze(["D.theta", "D.theta_dot", "P.s", "H.theta"])
    assert is_ok(result)
    assert not [d for d in result.diagnostics if d.code == "turn-not-closed"]
    assert np.abs(result["P.s"] - (-0.01) * np.arange(8001) / 8).max() <= 1e-11
    assert np.abs(result["H.theta"] + 45.0 * np.arange(8001)).max() <= 1e-7
    assert repeats(result["D.theta"], 8)
    assert repeats(result["D.theta_dot"], 8)


def test_a_loop_that_comes_back_after_two_turns() -> None:
    """A geared five-bar: its second crank turns half as fast."""
    text = """format: 1
name: geared
links: {one: {}, two: {}, three: {}, four: {}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [one, two], point: [1, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [two, three], point: [2.5, 3, 0], axis: [0, 0, 1]}
  D: {type: R, links: [three, four], point: [5, 0, 0], axis: [0, 0, 1]}
  E: {type: R, links: [ground, four], point: [4, 0, 0], axis: [0, 0, 1]}
motion:
  inputs:
    A.theta: {from: 0, to: 720000, step: 40, rate: 1 rad/s}
    E.theta: {from: 0, to: 360000, step: 20, rate: 0.5 rad/s}
"""
    result = loads(text).analyze(["C.theta", "C.theta_dot"])
    assert is_ok(result)
    assert repeats(result["C.theta_dot"], 18)
    assert repeats(result["wrap(C.theta)"], 18)
    assert not repeats(result["C.theta_dot"], 9)
    # the distance of the ends of the cranks gives the angle between the couplers
    a = np.radians(np.arange(18001) % 18 * 40.0)
    far = np.hypot(4 + np.cos(a / 2) - np.cos(a), np.sin(a / 2) - np.sin(a))
    two, three = math.hypot(1.5, 3), math.hypot(2.5, 3)
    angle = np.arccos((two**2 + three**2 - far**2) / (2 * two * three))
    wanted = np.degrees(angle - angle[0])
    assert np.abs(np.abs(result["wrap(C.theta)"]) - np.abs(wanted)).max() <= 1e-9


@pytest.mark.parametrize("unit", ["deg", "rad", "turn", "mrad", "arcsec"])
def test_whole_turns_against_forty_digits(unit: str) -> None:
    turn = 2 * PI / UNITS[unit].factor
    with mpmath.workdps(60):
        exact = mpmath.mpf(turn.numerator) / turn.denominator
        for rng in cases(5, 3):
            values = [
                rng.uniform(-1, 1) * float(turn) * 10 ** rng.uniform(-2, 9) for _ in range(60)
            ]
            values += [float(turn) * k / 2 for k in range(-5, 6)]
            rest, whole = without_turns(np.array(values), turn)
            for x, r, k in zip(values, rest.tolist(), whole.tolist(), strict=True):
                wanted = mpmath.mpf(x) - int(k) * exact
                assert abs(r - wanted) <= 2e-16 * float(turn)
                assert -0.5 * float(turn) < r <= 0.5 * float(turn) or unit in ("rad", "mrad")
                assert unit not in ("deg", "turn", "arcsec") or r == wanted


def lead_screw(lead: float, order: list[int], flip: bool) -> str:
    """A crank slider whose slide is a nut on a screw; a torsion spring turns the screw back."""
    joints = [
        "A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}",
        "B: {type: R, links: [crank, rod], point: [30, 0, 0], axis: [0, 0, 1]}",
        "C: {type: R, links: [rod, nut], point: [130, 0, 0], axis: [0, 0, 1]}",
        "D: {type: P, links: [ground, nut], point: [130, 0, 0], axis: [1, 0, 0]}",
        f"H: {{type: H, links: [nut, screw], point: [200, 0, 0], axis: [1, 0, 0], lead: {lead}}}",
        "R: {type: R, links: [screw, ground], point: [260, 0, 0], axis: [-1, 0, 0]}"
        if flip
        else "R: {type: R, links: [ground, screw], point: [260, 0, 0], axis: [1, 0, 0]}",
    ]
    return (
        "format: 1\nname: screw\nunits: {length: mm, angle: deg, mass: kg, force: N}\n"
        "links: {crank: {}, rod: {}, nut: {}, screw: {}}\njoints:\n"
        + "".join(f"  {joints[k]}\n" for k in order)
        + "motion: {inputs: {A.theta: {from: 0, to: 720, step: 30, rate: 10 rad/s}}}\n"
        "loads:\n  - {type: spring, joint: R, coordinate: theta, stiffness: 2, free: 0}\n"
    )


CLOSED_AT = [("B", "R"), ("D", "R"), ("C", "D"), None]
CLOSED_AT += [("C", "R"), ("B", "D")] if TIMES > 1 else []


@pytest.mark.parametrize("lead", [5, 0.05, 0.01])
@pytest.mark.parametrize("closed_at", CLOSED_AT)
def test_turns_of_a_fast_screw_and_its_spring(
    lead: float, closed_at: tuple[str, ...] | None
) -> None:
    a = np.radians(np.arange(0, 721, 30.0))
    root = np.sqrt(100**2 - (30 * np.sin(a)) ** 2)
    slide, slope = 30 * np.cos(a) + root - 130, -30 * np.sin(a) * (1 + 30 * np.cos(a) / root)
    turn = -2 * np.pi * slide / lead
    effort = 2 * turn * (-2 * np.pi * slope / lead)
    for rng in cases(round(1 / lead), 2):
        order = rng.sample(range(6), 6)
        problem = loads(lead_screw(lead, order, rng.random() < 0.5)).problem
        session = Session.of(problem, closed_at=None if closed_at is None else list(closed_at))
        result = analyze(session, ["R.theta", "H.theta", "A.effort"])
        assert result.complete
        for name in ("R.theta", "H.theta"):
            found = np.asarray(result.quantity(name).value)
            assert np.abs(found - turn).max() <= 1e-9 * np.abs(turn).max()
        found = np.asarray(result.quantity("A.effort").value) * 1e3
        assert np.abs(found - effort).max() <= 1e-9 * np.abs(effort).max()


def test_a_spring_on_a_crank_that_turns_on() -> None:
    """An angle of the tree, an input: the torque grows with every turn."""
    motion = "{inputs: {A.theta: {from: 0, to: 36000, step: 90, rate: 1 rad/s}}}"
    spring = "loads:\n  - {type: spring, joint: A, coordinate: theta, stiffness: 2, free: 0}\n"
    result = loads(four_bar((1, 2.5, 2, 3), motion) + spring).analyze(["A.effort"])
    wanted = 2 * np.radians(np.arange(401) * 90.0)
    assert np.abs(result["A.effort"] - wanted).max() <= 1e-12 * wanted.max()


@pytest.mark.parametrize("kind", ["R", "P"])
def test_what_closes_no_loop_is_not_followed(kind: str) -> None:
    coordinate = "theta" if kind == "R" else "s"
    text = (
        "format: 1\nname: motor\nlinks: {a: {}, b: {}}\njoints:\n"
        "  O: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}\n"
        f"  A: {{type: {kind}, links: [a, b], point: [0, 0, 0], axis: [0, 0, 1]}}\n"
        f"motion: {{inputs: {{O.theta: {{at: 3}}, A.{coordinate}: "
        "{from: 0, to: 1e9, step: 1e8}}}\n"
    )
    result = loads(text).analyze([f"A.{coordinate}"])
    assert is_ok(result)
    assert result.result.nodes == 0


def test_a_way_that_is_too_long_says_so() -> None:
    text = lead_screw(5, list(range(6)), False)
    text = text.replace("from: 0, to: 720, step: 30, rate: 10 rad/s", "at: 0")
    nut = re.sub(r"  [ABC]: .*\n", "", text).replace("crank: {}, rod: {}, ", "")
    nut = nut.replace("A.theta: {at: 0}", "D.s: {from: 0, to: 1e12, step: 5e11}")
    result = loads(nut[: nut.index("loads:")]).analyze(["D.s"])
    assert result["row.status"].tolist()[1:] == ["branch-lost"] * 2
    assert "steps-exhausted" in {d.code for d in result.diagnostics}


@pytest.mark.parametrize("turns", [0, 1, -2000, 30000])
@pytest.mark.parametrize("way", [1, -1])
def test_a_dead_centre_is_as_far_after_any_turns(turns: int, way: int) -> None:
    """Crank and coupler in line with the rocker's far end: cos(A) = (a^2 + d^2 - (b + c)^2)/2ad."""
    a, b, c, d = bars = (2.0, 2.2, 2.1, 3.0)
    first = 360 * turns
    motion = f"{{inputs: {{A.theta: {{from: {first}, to: {first + way * 200}, step: {way * 8}}}}}}}"
    result = loads(four_bar(bars, motion)).analyze(["D.theta"])
    (note,) = [found for found in result.diagnostics if found.code == "dead-centre"]
    fold = math.degrees(math.acos((a * a + d * d - (b + c) ** 2) / (2 * a * d)))
    (place,) = note.numbers
    assert abs(place.value - first - way * fold) <= 1e-9 + 1e-15 * abs(first)
    crank = np.radians(way * 8.0 * np.arange(26))
    reached = np.abs(crank) < math.radians(fold)
    assert np.array_equal(np.asarray(result["row.status"]) == "ok", reached)
    wanted = np.degrees(rocker(bars, crank[reached]) - rocker(bars, np.zeros(1)))
    off = result["D.theta"][reached] - wanted
    assert np.abs(off - 360 * np.rint(off / 360)).max() <= 1e-7


def test_there_and_back_by_any_turns() -> None:
    """Lists of crank angles: each is its own place, whatever came before."""
    for rng in cases(99, 12):
        bars = grashof(rng)
        if min(bars) != bars[0]:
            continue
        values = [0]
        for _ in range(rng.randint(4, 12)):
            values.append(values[-1] + rng.choice([-1, 1]) * rng.choice([30, 90, 400, 720, 36000]))
        listed = ", ".join(map(str, values))
        motion = f"{{inputs: {{A.theta: {{values: [{listed}], rate: 2 rad/s}}}}}}"
        result = loads(four_bar(bars, motion)).analyze(["D.theta", "D.theta_dot"])
        assert is_ok(result), motion
        off = np.radians(result["D.theta"]) - rocker(bars, np.radians(np.array(values) % 360.0))
        off += rocker(bars, np.zeros(1))
        assert np.abs(off - 2 * np.pi * np.rint(off / (2 * np.pi))).max() <= 1e-9, motion
        seen: dict[int, float] = {}
        for value, rate in zip(values, result["D.theta_dot"].tolist(), strict=True):
            assert seen.setdefault(value % 360, rate) == rate, motion


def test_variants_turn_as_the_file_does() -> None:
    motion = "{inputs: {A.theta: {from: 0, to: 7200, step: 45, rate: 1 rad/s}}}"
    spring = "loads:\n  - {type: spring, joint: B, coordinate: theta, stiffness: 2, free: 0}\n"
    text = four_bar((1, 2.5, 2, 3), motion) + spring
    text = text.replace("\nlinks:", "\nparameters: {h: 0.2 m}\nlinks:")
    text = text.replace("point: [0, 0, 0]", "point: [0, 0, h]")
    names = ["D.theta", "B.theta", "A.effort", "wrap(B.theta)", "sin(A.theta)"]
    model = loads(text)
    varied = model.vary({"h": [0.2, 0.3, 0.5]}, names)
    for k, h in enumerate(("0.2", "0.3", "0.5")):
        fresh = loads(text.replace("h: 0.2 m", f"h: {h} m")).analyze(plain(names))
        for name in names:
            assert np.asarray(varied[name])[k].tobytes() == np.asarray(fresh[name]).tobytes()
    for value in (90.0, 3_600_090.0, -3_599_910.0):
        here = model.solve({"A.theta": value}, ["D.theta", "B.theta"])
        turns = (value - 90) / 360
        assert abs(here["D.theta"] - model.analyze(["D.theta"])["D.theta"][2]) <= 1e-9
        assert abs(here["B.theta"] + 360 * turns - model.analyze(["B.theta"])["B.theta"][2]) <= 1e-8


@pytest.mark.parametrize("name", ["hooke", "bennett", "slider_crank", "rspp", "swash_plate"])
def test_the_closing_joint_changes_no_angle(name: str) -> None:
    problem = loads(swept(name, 3615, -3585, -100)).problem
    names = list(problem.mechanism.coordinates)
    driven = problem.motion.inputs[0].joint
    found = []
    for joint in [None, *(joint for joint in problem.mechanism.joints if joint != driven)]:
        session = Session.of(problem, closed_at=None if joint is None else [joint])
        result = analyze(session, names)
        assert result.complete, joint
        found.append(np.stack([np.asarray(result.quantity(name).value) for name in names]))
    scale = np.maximum(1.0, np.abs(found[0]).max(axis=1))[:, None]
    assert len(found) > 2
    for other in found[1:]:
        assert (np.abs(other - found[0]) / scale).max() <= 1e-11
