"""Variants continued in the parameters to places beside a dead centre, and from there: where the
way stays on its branch it arrives, and where it crosses the dead centre the variant is lost.

What is exact is the closure, solved to 50 digits, and the law of cosines.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from dead_centre_cases import CASES, Case

import mechkin_cli as mk
from mechkin_cli.variants.design import Base

BESIDE = (1e-2, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
"""Distances of the driven coordinate from its dead centre, in degrees or mm."""


@pytest.fixture(autouse=True)
def _fifty_digits() -> Iterator[None]:
    with mp.workdps(50):
        yield


def unit_of(case: Case) -> str:
    return "deg" if case.driven == "D.theta" else "mm"


def data(case: Case, place: float, *more: float) -> dict[str, Any]:
    """A file with a row at a distance from the dead centre that is a parameter, and more rows."""
    own = f"{case.inward * place!r} {unit_of(case)}"
    values = ["p", *(f"{case.inward * one!r}" for one in more)]
    rate = f"{float(case.rate)!r} {'rad/s' if unit_of(case) == 'deg' else 'm/s'}"
    return case.file | {
        "parameters": {"p": own},
        "motion": {"inputs": {case.driven: {"values": values, "rate": rate}}},
        "assembly": {"near": {"A.theta": 2 * case.side}},
    }


def model(case: Case, place: float, *more: float) -> mk.Model:
    return mk.load(data(case, place, *more))


def put(case: Case, place: float) -> dict[str, str]:
    return {"p": f"{case.inward * place!r} {unit_of(case)}"}


def check_place(case: Case, place: float, found: mk.Analysis) -> None:
    (told,) = found["row.status"]
    driven = mp.mpf(repr(place)) * case.unit * case.inward
    if told == "dead-centre":
        assert abs(case.gap(0, driven)) < 300 * np.spacing(1.0)
        return
    assert told in ("ok", "near-singular")
    (condition,), (angle,) = found["row.condition"], found["A.theta"]
    known = float(case.crank(driven)) * 180 / np.pi
    assert angle == pytest.approx(known, rel=1e-14 * condition**2 + 1e-11)


def sided(case: Case, found: mk.Analysis) -> Case:
    """The case on the branch that a place near by has."""
    return case._replace(side=int(np.sign(found["A.theta"][-1])))


@pytest.mark.parametrize("case", CASES)
def test_a_way_that_stays_on_its_branch_arrives(case: Case) -> None:
    base = model(case, 1.0)
    case = sided(case, model(case, 1.0, 1e-3).analyze())
    for place in BESIDE:
        check_place(case, place, base.with_parameters(put(case, place)).analyze())
    (there,) = base.with_parameters(put(case, 0.0)).analyze()["row.status"]
    assert there == "dead-centre"
    for place in (-1.0, -1e-3, -1e-7):
        (beyond,) = base.with_parameters(put(case, place)).analyze()["row.status"]
        assert beyond == "branch-lost"


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("start", [1e-9, 1e-11, 1e-12])
def test_a_way_that_begins_beside_a_dead_centre_leaves_it(case: Case, start: float) -> None:
    """Of the base, whose condition is 1e7 and more, no derivative is known."""
    base = model(case, start)
    first = base.analyze()
    if first["row.status"][0] == "dead-centre":
        return
    case = sided(case, first)
    for place in (1e-6, 1e-3, 1e-2):
        check_place(case, place, base.with_parameters(put(case, place)).analyze())


@pytest.mark.parametrize("case", CASES)
def test_it_is_the_row_of_a_sweep_from_the_base(case: Case) -> None:
    """There and back, whatever stands between: the same branch, followed in the input."""
    for start, end in ((1.0, 0.1), (1.0, 1e-7), (1e-7, 1.0), (1e-8, 1e-2), (1e-6, 1e-9)):
        swept = model(case, start, end).analyze()
        if list(swept["row.status"]) != ["ok", "ok"]:
            continue
        found = model(case, start).with_parameters(put(case, end)).analyze()
        condition = swept["row.condition"].max()
        within = 1e-14 * condition**2 + 1e-11
        assert found["A.theta"][0] == pytest.approx(swept["A.theta"][1], rel=within)


@pytest.mark.parametrize("case", CASES[:4])
def test_all_ways_to_a_variant_are_one(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    """Vary, a study and a model built anew are the same continuation; the text alone is searched
    for."""
    places = [1e-2, 1e-5, 1e-8, 1e-10]
    base = model(case, 1.0)
    values = [case.inward * place for place in places]
    one_by_one = [base.with_parameters(put(case, place)).analyze() for place in places]
    angles = [found["A.theta"][0] for found in one_by_one]
    varied = base.vary({"p": values}, ["A.theta"])
    assert varied.complete.all()
    assert varied["A.theta"].ravel().tolist() == angles
    kept = base.study({"vary": {"p": values}, "keep": [{"of": "A.theta", "as": "max"}]})
    assert list(kept["max(A.theta)"]) == angles
    for place, found in zip(places, one_by_one, strict=True):
        text = mk.load(data(case, 1.0), parameters=put(case, place)).analyze()
        within = 1e-14 * found["row.condition"][0] ** 2 + 1e-11
        if text["A.theta"][0] * found["A.theta"][0] > 0.0:  # else near means the other branch there
            assert text["A.theta"][0] == pytest.approx(found["A.theta"][0], rel=within)
    monkeypatch.setattr(Base, "variation", lambda *_: None)
    anew = model(case, 1.0)
    for place, angle in zip(places[:3], angles, strict=False):
        found = anew.with_parameters(put(case, place)).analyze()
        within = 1e-14 * found["row.condition"][0] ** 2 + 1e-11
        assert found["A.theta"][0] == pytest.approx(angle, rel=within)


def rod_and_crank(rod: str) -> mk.Model:
    """A slider that stands 1.5 m from the crank of 0.5 m; the rod is just as long as it takes to
    come to a dead centre at 1 m and at 2 m."""
    return mk.loads(f"""
format: 1
plane: xy
units: {{length: m}}
parameters: {{rod: {rod} m, r: 0.5 m, x: 1.5 m}}
links: {{crank: {{}}, coupler: {{}}, block: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, coupler], point: [r, 0]}}
  C: {{type: R, links: [coupler, block], point: [r + rod, 0]}}
  D: {{type: P, links: [ground, block], point: [r + rod, 0], axis: [1, 0]}}
assembly: {{near: {{A.theta: 80}}}}
motion: {{inputs: {{D.s: {{values: [x - r - rod], rate: 1}}}}}}
""")


@pytest.mark.parametrize("end", [1, 2])
def test_dimensions_that_come_to_a_dead_centre(end: int) -> None:
    inward = 1 if end == 1 else -1
    base = rod_and_crank("1.6")
    for exponent in (*range(1, 14), 99):
        rod = mp.mpf(end) + inward * mp.mpf(10) ** -exponent
        given = float(rod)
        found = base.with_parameters({"rod": f"{given!r} m"}).analyze()
        r, x = mp.mpf("0.5"), mp.mpf("1.5")
        cosine = (r**2 + x**2 - mp.mpf(given) ** 2) / (2 * r * x)
        (told,) = found["row.status"]
        if exponent == 99:
            assert told == "dead-centre"
            continue
        assert told in ("ok", "near-singular")
        known = float(mp.acos(cosine) * 180 / mp.pi)
        within = 1e-14 * found["row.condition"][0] ** 2 + 1e-11
        away = 0.0 if end == 1 else 180.0
        assert abs(found["A.theta"][0] - away) == pytest.approx(abs(known - away), rel=within)
        beyond = base.with_parameters({"rod": f"{float(end - inward * 10.0**-exponent)!r} m"})
        assert (
            beyond.analyze()["row.status"][0]
            in ("branch-lost", "dead-centre")[: 1 + (exponent > 12)]
        )


FLAT = {
    "format": 1,
    "units": {"length": "m", "angle": "rad", "mass": "kg", "force": "N"},
    "links": {"a": {}, "r": {}, "o": {}},
    "parameters": {"x": "95.65647736549569 m"},
    "joints": {
        "I": {
            "type": "P",
            "links": ["ground", "a"],
            "point": ["0.966", "-40.617", "55.338"],
            "axis": ["-0.654", "0.941", "-0.524"],
        },
        "A": {"type": "S", "links": ["a", "r"], "point": ["58.234", "-39.397", "-45.269"]},
        "B": {
            "type": "S",
            "links": ["r", "o"],
            "point": {
                "r": ["107.369", "-39.397", "-45.269"],
                "o": ["-18.870", "10.812", "-40.760"],
            },
        },
        "O": {
            "type": "P",
            "links": ["ground", "o"],
            "point": ["-3.294", "2.247", "33.036"],
            "axis": ["-0.070", "0.796", "-0.288"],
        },
    },
    "motion": {"inputs": {"I.s": {"values": ["x"], "rate": "3.251 m/s"}}},
    "assembly": {"near": {"O.s": "14.920437"}},
}
"""A flat fold: at the dead centre the condition is below that of near-singular rows."""


def test_variants_in_lanes_are_judged_as_one_alone() -> None:
    """A place 2e-15 from a dead centre, where the rate is -3e7 m/s by 50 digits: a row there has no
    digit of it."""
    place = 80.65647736549575
    model = mk.load(FLAT)
    alone = model.with_parameters({"x": place}).analyze(["O.s_dot"], tables=[])
    lanes = model.vary({"x": [90.0, place]}, ["O.s_dot"])
    solved = model.solve({"I.s": place}, ["O.s_dot"])
    assert lanes.status.ravel().tolist() == ["ok", "dead-centre"]
    assert alone["row.status"].tolist() == [solved.status] == ["dead-centre"]
    assert not np.isfinite(lanes["O.s_dot"][1, 0])


def test_near_names_the_branch_where_the_base_stands() -> None:
    """A four-bar whose follower swings back between the base and the dead centre: `near`, which is
    the base's, is nearer to the branch that the variant is not on. Nothing may have its sign."""
    hinges = {"I": (40.834, -36.858), "A": (-31.844, 4.308), "O": (26.318, 1.881)}
    ends = {"r": (37.01, 4.308), "o": (-26.482, 20.292)}
    base, place = 2.8394993154368757, 2.5394993154368763
    file = {
        "format": 1,
        "units": {"length": "m", "angle": "rad", "mass": "kg", "force": "N"},
        "links": {"a": {}, "r": {}, "o": {}},
        "parameters": {"x": f"{base!r} rad"},
        "joints": {
            name: {"type": "R", "links": links, "point": point, "axis": [0, 0, 1]}
            for name, links, point in (
                ("I", ["ground", "a"], [*hinges["I"], 0]),
                ("A", ["a", "r"], [*hinges["A"], 0]),
                ("B", ["r", "o"], {link: [*end, 0] for link, end in ends.items()}),
                ("O", ["ground", "o"], [*hinges["O"], 0]),
            )
        },
        "motion": {"inputs": {"I.theta": {"values": ["x"], "rate": "4.542 rad/s"}}},
        "assembly": {"near": {"O.theta": 2.3293547}},
    }
    centre, rod, follower, pivot = (
        mp.mpc(*(mp.mpf(repr(x)) for x in point))
        for point in (hinges["I"], hinges["A"], ends["o"], hinges["O"])
    )
    length = abs(mp.mpc(*(mp.mpf(repr(x)) for x in ends["r"])) - rod)

    def follower_angle(x: Any, elbow: int) -> Any:
        """By the law of cosines; each branch keeps its elbow up to the dead centre."""
        across = centre + (rod - centre) * mp.expj(x) - pivot
        arm = follower - pivot
        cosine = (abs(arm) ** 2 + abs(across) ** 2 - length**2) / (2 * abs(arm) * abs(across))
        y = mp.arg(across) - mp.arg(arm) + elbow * mp.acos(cosine)
        return y - 2 * mp.pi * mp.nint((y - mp.mpf(2.3)) / (2 * mp.pi))

    (elbow,) = (e for e in (1, -1) if abs(follower_angle(mp.mpf(base), e) - 2.3293547) < 1e-6)
    x = mp.mpf(place) + mp.mpf(1e-4) * mp.sign(mp.mpf(base) - mp.mpf(place))
    y, slope = follower_angle(x, elbow), mp.diff(lambda x: follower_angle(x, elbow), x)
    model = mk.load(file)
    near = model.with_parameters({"x": float(x)}).analyze(["O.theta", "O.theta_dot"], tables=[])
    assert near["O.theta"][0] == pytest.approx(float(y), abs=1e-9)
    assert np.sign(near["O.theta_dot"][0]) == np.sign(float(slope))
    at = model.with_parameters({"x": place}).analyze(["O.theta_dot"], tables=[])
    assert at["row.status"].tolist() == ["dead-centre"]
    rate = at["O.theta_dot"][0]
    assert np.isnan(rate) or np.sign(rate) == np.sign(float(slope))
