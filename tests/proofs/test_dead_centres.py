"""Dead centres at which a sweep ends: proven where they are, with the way to them, and never where
two branches cross or come nearer than rounding tells."""

from __future__ import annotations

from decimal import Decimal
from functools import cache
from typing import Any

import numpy as np
import pytest
from oracle import (
    document,
    fold,
    in_other_units,
    moved as turned_about,
    mp,
    read,
    renamed,
    reordered,
    rotation_matrix,
    to_text,
)
from proofs.test_boxes import COHERENT, DEGREE
from random_families.dead_centres.case import linkage, plane_four_bar
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.analysis.certificate import SweepDeadCentre
from mechkin_cli.plan.records import PassageEnd
from mechkin_cli.proofs.boxes import Enclosed, Nodes, prove_boxes
from mechkin_cli.proofs.dead_centre import are_one, prove_dead_centre, prove_fold
from mechkin_cli.session.following import Ending

SWEEP = "from: 150, to: 202, step: 2"


def rcsr(rows: str = "from: 150, to: 210, step: 2") -> str:
    return RCSR.read_text(encoding="utf-8").replace(SWEEP, rows)


def only(text: str) -> SweepDeadCentre:
    (found,) = mk.loads(text).certify().dead_centres
    return found


@cache
def true_fold() -> tuple[Any, dict[str, Any]]:
    """At 60 digits, in degrees and inches."""
    data = document(RCSR) | {"units": COHERENT}
    data.pop("tables", None)
    guess = {"O1.theta": 205.14, "O2.theta": -133.56, "O2.s": -8.8243, "O4.theta": -70.89}
    near = {n: v * (DEGREE if n.endswith("theta") else 1) for n, v in guess.items()}
    u, found = fold(read(to_text(data)), "O1.theta", near)
    return u / DEGREE, {n: found[n] / DEGREE for n in guess if n.endswith("theta")}


@pytest.mark.parametrize(
    "rows",
    [
        "from: 150, to: 210, step: 2",
        "values: [160, 300]",
        "values: [-200, -100]",
        "values: [870, 1000]",
        "values: [200, 205.143965944, 206]",
    ],
)
def test_the_true_dead_centre_is_enclosed(rows: str) -> None:
    found = only(rcsr(rows))
    assert found.is_proven
    assert found.tubes > 0
    low, high = found.bounds
    value, coordinates = true_fold()
    turns = 360 * round((low - float(value)) / 360)
    assert low <= value + turns <= high
    assert high - low < 1e-11
    for name, true in coordinates.items():
        low, high = found.enclosure(name)
        turns = 360 * round((float(low) - float(true)) / 360)
        assert low <= true + turns <= high
        assert high - low < 1e-10


SPACE = ("phchc", "rcrcr", "rprhrrr", "rrrrrrh", "sevenr", "rcsr_csr")


@pytest.mark.parametrize("name", SPACE)
def test_linkages_in_space(name: str) -> None:
    """Driven on beyond their sweeps, against dead centres at 60 digits."""
    data = document(FILE_OF[name])
    data.pop("tables", None)
    (driver,) = data["motion"]["inputs"]
    motion = data["motion"]["inputs"][driver]
    motion["to"] = str(float(motion["to"]) + 400)
    certificate = mk.loads(to_text(data)).certify()
    (found,) = certificate.dead_centres
    assert found.is_proven
    guess = {}
    for coordinate in certificate.analysis.result.coordinates:
        try:
            low, high = found.enclosure(coordinate)
        except mk.UsageError:
            continue
        unit = DEGREE if coordinate.endswith("theta") else 1
        guess[coordinate] = 0.5 * (float(low) + float(high)) * unit
    # the oracle starts from a closed place before it
    guess[driver] -= mp.mpf("1e-4")
    value, _ = fold(read(to_text(data | {"units": COHERENT})), driver, guess)
    low, high = found.bounds
    assert low <= value / (DEGREE if driver.endswith("theta") else 1) <= high
    assert high - low < 1e-11


def test_words_and_record() -> None:
    certificate = mk.loads(rcsr()).certify()
    (found,) = certificate.dead_centres
    assert (found.input, found.row, found.status, found.why) == ("O1.theta", 27, "proven", None)
    assert certificate.words == (
        "28 proven, 3 not proven; one branch to a proven dead centre, "
        "O1.theta = 205.143965945 deg (2 tubes)"
    )
    (record,) = certificate.analysis.result.proven_dead_centres
    assert (record["low"], record["high"]) == found.bounds
    assert (record["name"], record["unit"], record["proof"]) == ("O1.theta", "deg", "proven")
    assert (record["last_row"], record["tubes"]) == (28, 2)
    assert mk.load(RCSR).certify().dead_centres == ()


def test_rates_have_no_value_there() -> None:
    found = only(rcsr())
    for name in ("O4.theta_dot", "O2.force", "row.condition", "nothing"):
        with pytest.raises(mk.UsageError, match="no position"):
            found.enclosure(name)


def test_points_are_enclosed() -> None:
    """The pin of coupler and rocker, on its circle about (2, 0) where the closed form turns it."""
    case = plane_four_bar(("0.5", "0.8", "0"), ("1.7", "1.1", "0"), ("2", "0", "0"))
    points = "points: {pin: {link: rocker, at: [1.7, 1.1, 0]}}\nmotion:"
    found = only(case.swept("values: [0, -6]").replace("motion:", points))
    assert found.is_proven
    low, high = found.enclosure("pin.position")
    assert low.shape == (3,)
    assert (high - low < 1e-11).all()
    with mp.workdps(40):
        turn = case.output_at(case.dead_centre(found.number.value))
        x, y = mp.mpf("1.7") - 2, mp.mpf("1.1")
        c, s = mp.cos_sin(turn)
        true = 2 + x * c - y * s, x * s + y * c, 0
        assert all(a <= b <= c for a, b, c in zip(low, true, high, strict=True))


OTHERWISE = {
    "turned": lambda d: turned_about(d, rotation_matrix(3, 1, -2, 5), [3, -1, 2]),
    "in other units": lambda d: in_other_units(
        d, {"length": "mm", "angle": "rad", "mass": "kg", "force": "N"}
    ),
    "renamed": lambda d: renamed(d, {"O1": "Crank", "rocker": "lever", "crank": "wheel"}),
    "reordered": lambda d: reordered(d, 7),
}


@pytest.mark.parametrize("otherwise", OTHERWISE)
def test_written_otherwise(otherwise: str) -> None:
    data = document(FILE_OF["rcsr"])
    data.pop("tables", None)
    (name,) = data["motion"]["inputs"]
    data["motion"]["inputs"][name] |= {"to": "210"}
    there = only(to_text(data)).bounds
    found = only(to_text(OTHERWISE[otherwise](data)))
    assert found.is_proven
    scale = 180 / np.pi if otherwise == "in other units" else 1.0
    low, high = (scale * bound for bound in found.bounds)
    assert max(low, there[0]) <= min(high, there[1]) + 1e-13


def ends(text: str) -> list[SweepDeadCentre]:
    """The dead centres at which the branches of all assemblies end."""
    model = mk.loads(text)
    proofs = [model.certify(mode=mode.name) for mode in model.modes().modes]
    return [found for proof in proofs for found in proof.dead_centres]


def test_two_assemblies_meet() -> None:
    """Those on both sides of a dead centre are proven to end at the same one."""
    one, other = ends(rcsr("values: [200, 210]"))
    assert one.is_same_as(other)
    assert other.is_same_as(one)
    # of a model of its own nothing is known
    assert not one.is_same_as(only(rcsr("values: [200, 210]")))


def test_dead_centres_at_both_ends_of_a_sweep_are_two() -> None:
    """Followed both ways from the row in which it is drawn."""
    case = linkage(0)
    one, other = mk.loads(case.swept("from: -6, to: 6, count: 49")).certify().dead_centres
    assert one.is_proven
    assert other.is_proven
    assert one.bounds[1] < 0 < other.bounds[0]
    assert not one.is_same_as(other)


def near_change_point(gap: str) -> Any:
    """A parallelogram whose frame is too short by `gap`: its crank cannot come to point along the
    frame, by about the root of it on either side."""
    case = plane_four_bar(("0", "1", "0"), ("2", "1", "0"), ("2", "0", "0"))
    point = f"point: {{ground: [2 m - {gap} m, 0, 0], rocker: [2, 0, 0]}}"
    return case._replace(text=case.text.replace("point: [2, 0, 0]", point))


@pytest.mark.parametrize("gap", ["1e-2", "1e-6", "1e-10", "1e-12", "1e-14", "1e-18"])
def test_dead_centres_on_both_sides_of_a_gap_are_not_one(gap: str) -> None:
    case = near_change_point(gap)
    for way, side in (("from: 0, to: -3, count: 4", 1), ("from: -2.9, to: -0.1, count: 4", -1)):
        model = mk.loads(case.swept(way))
        for mode in model.modes().modes:
            proofs = model.certify(mode=mode.name)
            assert not proofs.is_one_branch
            for found in proofs.dead_centres:
                if gap in ("1e-2", "1e-6"):
                    assert found.is_proven
                if not found.is_proven:
                    assert np.isnan(found.bounds).all()
                    continue
                with mp.workdps(40):
                    half = mp.acos((2 - mp.mpf(gap)) / 2)
                    low, high = found.bounds
                    assert low <= side * half - mp.pi / 2 <= high


@pytest.mark.parametrize("gap", ["1e-1", "1e-3", "1e-6", "1e-8", "1e-10"])
def test_dead_centres_on_both_sides_of_a_gap_are_not_the_same(gap: str) -> None:
    """Found on both sides of the gap of one mechanism."""
    case = near_change_point(gap)
    ways = ("values: [0, -3]", "values: [-3, 0]")
    folds = [end._proof.fold for way in ways for end in ends(case.swept(way))]
    one = next(fold for fold in folds if fold and fold.value > -np.pi / 2)
    other = next(fold for fold in folds if fold and fold.value < -np.pi / 2)
    inputs, state = np.array([other.value]), other.node.states[:, 0]
    found = prove_fold(one.exchanged, inputs, other.node.off[:, 0], state)
    assert found is not None
    assert found.value < -np.pi / 2
    assert not are_one(one, found)
    assert not are_one(found, one)
    again = prove_fold(one.exchanged, np.array([one.value]), inputs * 0, one.node.states[:, 0])
    assert again is not None
    assert are_one(one, again)


SCREW_LOOP = """
format: 1
units: {length: mm, angle: deg}
links: {b1: {}, b2: {}, b3: {}, b4: {}, b5: {}, b6: {}}
joints:
  J0: {type: P, links: [ground, b1], point: [-532.2, -356.6, -94.5], axis: [0, 0, 1]}
  J1: {type: H, links: [b1, b2], point: [589.4, 865.3, -493], axis: [0.46, 0.13, 0.18], lead: 61.8}
  J2: {type: R, links: [b2, b3], point: [-937.7, -425.7, -635.9], axis: [0, 0, 1]}
  J3: {type: R, links: [b3, b4], point: [219.1, 853.9, -568.1], axis: [0, 0, 1]}
  J4: {type: H, links: [b4, b5], point: [966.5, 968.5, 178.1], axis: [0, 0, 1], lead: 312.1}
  J5: {type: R, links: [b5, b6], point: [808.3, 246.1, -112.7], axis: [0, 0, 1]}
  J6: {type: R, links: [b6, ground], point: [-763.4, -206.4, -178], axis: [1, 1, 0]}
motion: {inputs: {J0.s: {from: 0, to: -2000, ROWS}}}
"""


@pytest.mark.parametrize("rows", ["count: 2", "count: 9", "step: 40"])
@pytest.mark.parametrize("closed_at", [None, ["J2"], ["J6"]])
def test_a_thread_has_turned_as_far_as_it_went(rows: str, closed_at: list[str] | None) -> None:
    """By its lead more than half a turn; from the last row or in many rows."""
    model = mk.loads(SCREW_LOOP.replace("ROWS", rows))
    (found,) = model.certify(closed_at=closed_at).dead_centres
    assert found.is_proven
    (low, high), (start, end) = found.enclosure("J4.theta"), found.enclosure("J4.s")
    lead = mp.mpf("312.1") / 360
    assert float(start) > 0.5 * 312.1
    assert lead * low <= end
    assert start <= lead * high


TURNING_LOOP = """
format: 1
units: {length: m, angle: deg}
links: {b1: {}, b2: {}, b3: {}, b4: {}, b5: {}}
joints:
  J0: {type: R, links: [ground, b1], point: [-0.544, 0.499, 0.617], axis: [0.444, 0.101, 0.952]}
  J1: {type: C, links: [b1, b2], point: [0.489, 0.356, -0.894], axis: [0.498, 0.473, 0.892]}
  J2: {type: R, links: [b2, b3], point: [-0.263, 0.939, 0.080], axis: [0, 0, 1]}
  J3: {type: R, links: [b3, b4], point: [-0.419, 0.902, 0.641], axis: [0, 0, 1]}
  J4: {type: H, links: [b4, b5], point: [-0.203, 0.050, 0.276], axis: [1, 1, 0], lead: 0.030}
  J5: {type: R, links: [b5, ground], point: [0.034, 0.075, -0.302], axis: [-0.72, -0.92, 0.19]}
motion: {inputs: {J0.theta: {from: 0, to: -300, ROWS}}}
"""


@pytest.mark.parametrize("closed_at", [None, ["J2"], ["J3"]])
def test_turns_are_those_of_the_rows(closed_at: list[str] | None) -> None:
    """Where a joint turns on beyond half a turn behind the only row before the dead centre."""
    few, many = (
        mk.loads(TURNING_LOOP.replace("ROWS", rows)).certify(closed_at=closed_at)
        for rows in ("count: 2", "count: 60")
    )
    (one,), (other,) = few.dead_centres, many.dead_centres
    assert one.is_proven
    assert other.is_proven
    assert (one.row, other.row) == (0, 4)
    for name in few.analysis.result.coordinates:
        low, high = one.enclosure(name)
        least, most = other.enclosure(name)
        assert low <= most
        assert least <= high
    assert one.enclosure("J2.theta")[0] > 180


@pytest.mark.parametrize("bars", [("0", "1", "2"), ("0.6", "0.8", "2"), ("-0.28", "0.96", "3")])
def test_a_branch_point_is_no_dead_centre(bars: tuple[str, str, str]) -> None:
    """A parallelogram where its bars are in line, said to have a dead centre there; at the place,
    and where following would put it."""
    x, y, width = bars
    case = plane_four_bar((x, y, "0"), (f"{float(x) + float(width)!r}", y, "0"), (width, "0", "0"))
    model = mk.loads(case.swept("values: [0, 0.5]"))
    result = model.analyze(tables=[]).result
    session, states = result.session, result.row_states.states[:, :1]
    inputs = session.inputs
    row = Nodes.of(session, inputs.values, inputs.reduced, result.row_states.states)
    enclosed = Enclosed.of(session)
    box = prove_boxes(enclosed, row.part(slice(0, 1)))
    assert box.proven[0]
    turn = -float(mp.atan2(mp.mpf(y), mp.mpf(x)))
    for off in (0.0, 1e-12, 1e-9, 1e-6, 1e-4):
        place = np.array([turn + off])
        closed = session.close(
            place[:, None],
            session.follow(np.array([[0.0, turn * 0.999]]), states[:, 0], every_row=True).guess[
                :, 1:
            ],
        )
        state = closed.states[:, 0]
        for first in np.eye(session.plan.columns):
            ending = Ending(
                PassageEnd.DEAD_CENTRE, 0, place, state, first, first, 1.0, place, state
            )
            found = prove_dead_centre(enclosed, row.part(slice(0, 1)), box, 0, ending)
            assert found.why is not None
            assert found.fold is None


def test_several_inputs_that_move_together() -> None:
    text = """
format: 1
units: {length: m, angle: deg}
links: {one: {}, two: {}, three: {}, four: {}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [one, two], point: [1, 1, 0], axis: [0, 0, 1]}
  C: {type: R, links: [two, three], point: [2, 1.5, 0], axis: [0, 0, 1]}
  D: {type: R, links: [three, four], point: [3, 1, 0], axis: [0, 0, 1]}
  E: {type: R, links: [ground, four], point: [4, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: ONE, count: 20}, E.theta: {from: 0, to: OTHER, count: 20}}}
"""
    both = only(text.replace("ONE", "60").replace("OTHER", "-60"))
    assert not both.is_proven
    assert "several inputs" in both.words
    alone = only(text.replace("ONE", "120").replace("OTHER", "0"))
    assert alone.is_proven
    assert alone.input == "A.theta"


def two_rockers(foot: str) -> str:
    """A crank with two couplers and rockers, which are alike but for the second one's ground pin;
    drawn in `linkage(0)`."""
    start, end, first, _ = linkage(0).points
    text = linkage(0).text.replace(
        "  rocker: {}\n", "  rocker: {}\n  coupler2: {}\n  rocker2: {}\n"
    )
    more = "".join(
        f"  {name}: {{type: R, links: [{links}], point: [{', '.join(point)}], axis: [0, 0, 1]}}\n"
        for name, links, point in (
            ("B2", "crank, coupler2", start),
            ("C2", "coupler2, rocker2", end),
            ("D2", "ground, rocker2", (foot, *first[1:])),
        )
    )
    return text.replace("motion:", f"{more}motion:").replace("MOTION", "values: [0, 6.2]")


def test_loops_that_end_at_one_place_have_no_dead_centre() -> None:
    """Where both have one, the ways of either cross."""
    (found,) = mk.loads(two_rockers(linkage(0).points[2][0])).certify().dead_centres
    assert not found.is_proven
    assert np.isnan(found.bounds).all()


@pytest.mark.parametrize("off", ["1e-2", "1e-4", "1e-6"])
def test_loops_that_end_one_after_the_other(off: str) -> None:
    """The first of both dead centres, and not the second."""
    start, end, foot, _ = linkage(0).points
    other = str(Decimal(foot[0]) + Decimal(off))
    found = only(two_rockers(other))
    assert found.is_proven
    low, high = found.bounds
    with mp.workdps(40):
        near = found.number.value
        one = linkage(0).dead_centre(near)
        two = plane_four_bar(start, end, (other, "0", "0")).dead_centre(near)
        assert low <= one <= high < two
