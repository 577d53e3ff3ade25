"""Variants that a recording refuses, and rows that follow from parameters: the bytes of variants
that are built anew one by one, at the cost of a replay."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from references import FILE_OF
from variants.recordings import near

import mechkin_cli as mk
from mechkin_cli.mechanism.vectors import perpendicular
from mechkin_cli.tape.recorder import Recorder, Traced, register
from mechkin_cli.tape.tape import Verdict, compiled, replay
from mechkin_cli.variants import design
from mechkin_cli.variants.design import Base, base_of


@pytest.fixture
def builds(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, float]]:
    """The values of all variants that are built from their file."""
    found: list[dict[str, float]] = []
    own = Base.built

    def built(self: Base, values: Any) -> Any:
        found.append(dict(values))
        return own(self, values)

    monkeypatch.setattr(Base, "built", built)
    return found


def given_of(model: mk.Model, count: int, seed: int, spread: float) -> dict[str, Any]:
    units, known = model.problem.units, model.problem.parameters
    values = near(model.built, count, seed, spread)
    return {
        name: np.asarray(units.from_si(row, known[name].dimension))
        for name, row in zip(known, values, strict=True)
        if name != "step"
    }


def asked_of(model: mk.Model) -> list[str]:
    if model.problem.follow is not None:
        return ["O2.theta", "O4.theta"]
    known = model.problem.quantities()
    efforts = [name for name in known if known[name].kind == "effort"][:1]
    return [*model.problem.mechanism.coordinates, *efforts]


def without_recordings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every variant, and every place on the way to it, is built from the file."""
    monkeypatch.setattr(Base, "recording", lambda self, values: None)
    monkeypatch.setattr(Base, "variation", lambda self, names: None)


@pytest.mark.parametrize(
    ("stem", "spread", "count"),
    [
        ("stewart", 0.3, 5),
        ("rcsr_csr_loop_one", 0.02, 4),
        ("bricard", 0.3, 4),
        ("slider_crank", 0.3, 5),
        ("planetary_gear", 0.4, 5),
        ("cardan_gears", 0.6, 5),
    ],
)
def test_as_built_anew(
    stem: str, spread: float, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Directions that pass each other, sizes far from the file's own, loops left out, errors."""
    model = mk.load(FILE_OF[stem])
    given, asked = given_of(model, count, 11, spread), asked_of(model)
    result = model.vary(given, asked)
    without_recordings(monkeypatch)
    fresh = mk.load(FILE_OF[stem]).vary(given, asked)
    assert result.codes.tobytes() == fresh.codes.tobytes()
    assert {n: str(e) for n, e in result.errors.items()} == {
        n: str(e) for n, e in fresh.errors.items()
    }
    for text in asked:
        assert result[text].tobytes() == fresh[text].tobytes(), text


MASS = {"m": [2.0, 0.0, 0.0, 1.0], "b": [100.0, 104.0, 103.0, 98.0]}
"""A link without mass is planned otherwise than one with."""


def with_a_mass(warning: str = "") -> str:
    text = ROWS.replace("SPACING", "from: 40, to: 160, step: 20")
    text = text.replace("{a: 30 mm", "{m: 2, a: 30 mm")
    link = "{mass: m * 1 kg, center_of_mass: [a + b/2, 0, 0]" + warning + "}"
    return text.replace("coupler: {}", f"coupler: {link}", 1)


def test_each_way_of_building_is_recorded_once(
    builds: list[dict[str, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = ["B.theta", "D.theta", "A.effort", "D.force"]
    model, another = mk.loads(with_a_mass()), mk.loads(with_a_mass())
    result = model.vary(MASS, asked)
    kept = base_of(model.design)._recordings["m", "b"]
    assert len(kept) == 2
    assert None not in kept
    assert len(builds) == 1
    backwards = another.vary({name: values[::-1] for name, values in MASS.items()}, asked)
    without_recordings(monkeypatch)
    fresh = mk.loads(with_a_mass()).vary(MASS, asked)
    assert len(builds) > 4 * 4
    for text in asked:
        assert result[text].tobytes() == fresh[text].tobytes(), text
        assert backwards[text][::-1].tobytes() == fresh[text].tobytes(), text
    assert np.abs(fresh["A.effort"][0] - fresh["A.effort"][1]).max() > 1e-3


def test_no_more_recordings_than_they_are_worth(
    builds: list[dict[str, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = mk.loads(with_a_mass()).vary(MASS, ["A.effort"])
    few = len(builds)
    monkeypatch.setattr(design, "MOST_RECORDINGS", 1)
    result = mk.loads(with_a_mass()).vary(MASS, ["A.effort"])
    assert len(builds) > 2 * few
    assert result["A.effort"].tobytes() == whole["A.effort"].tobytes()


def test_warnings_are_those_of_the_values() -> None:
    """Not those of the values with which the file, or another variant, was recorded: here of a
    tensor of no real body, with its eigenvalues."""
    tensor = ", inertia: {xx: 60 kg*mm^2, yy: 50 kg*mm^2, zz: b * 1 kg*mm}"
    model = mk.loads(with_a_mass(tensor), "file")
    warned = []
    for m, b in ((0.0, 101.0), (0.0, 140.0), (1.0, 150.0), (0.0, 104.0), (2.0, 99.0)):
        varied = model.with_parameters({"m": m, "b": b})
        fresh = mk.loads(with_a_mass(tensor), "file", {"m": repr(m), "b": f"{b!r} mm"})
        told = [str(d) for d in varied.diagnostics]
        assert told == [str(d) for d in fresh.diagnostics]
        warned.append(any("belongs to no real body" in text for text in told))
    assert warned == [False, True, True, False, False]
    assert len(base_of(model.design)._recordings["m", "b"]) == 2


def test_the_axis_beside_another_is_chosen_on_the_tape() -> None:
    """Wherever the direction points, and whichever ground axis it was recorded beside."""
    generator = np.random.default_rng(5)
    others = generator.standard_normal((3, 40))
    others[:, 0], others[:, 1] = (1.0, 1.0, 1.0), (0.0, 0.0, 1.0)
    others /= np.sqrt((others * others).sum(axis=0))
    for recorded in ((0.6, 0.0, 0.8), (0.0, 0.8, 0.6), (0.8, 0.6, 0.0)):
        recorder = Recorder(("x", "y", "z"), recorded)
        z: Any = tuple(Traced(recorder, k) for k in range(3))
        tape = recorder.tape(register(recorder, number) for number in perpendicular(z))
        outputs, verdicts = replay(compiled(tape), others)
        assert (verdicts != Verdict.OTHER_WAY).all()
        for found, column in zip(outputs, others.T.tolist(), strict=True):
            assert found.tobytes() == np.array(perpendicular(tuple(column))).tobytes()  # type: ignore[arg-type]


# Rows whose places follow from parameters.

ROWS = """
format: 1
units: {length: mm, angle: deg}
parameters: {a: 30 mm, b: 100 mm, c: 80 mm, d: 90 mm, first: 40, gap: 7, half: gap/2}
links: {crank: {}, coupler: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, coupler], point: [a, 0, 0], axis: [0, 0, 1]}
  C:
    type: R
    links: [coupler, rocker]
    point: {coupler: [a + b, 0, 0], rocker: [d + c, 0, 0]}
    axis: [0, 0, 1]
  D: {type: R, links: [rocker, ground], point: [d, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {SPACING, rate: 10 rad/s}}}
assembly: {near: {D.theta: 60}}
"""
SPACINGS = {
    "a step": "from: 40, to: 160, step: gap * 1 deg",
    "both ends": "from: first * 1 deg, to: first * 3 deg + half * 1 deg, count: 9",
    "back": "from: first * 4 deg, to: first * 1 deg, step: 3 * gap * 1 deg",
    "beyond half a turn": "from: first * 1 deg, to: first * 9 deg, count: 17",
}


@pytest.fixture(params=SPACINGS.values(), ids=SPACINGS.keys())
def text(request: pytest.FixtureRequest) -> str:
    return ROWS.replace("SPACING", request.param)


def test_rows_that_follow_from_parameters(text: str, builds: list[dict[str, float]]) -> None:
    model = mk.loads(text, "rows")
    generator = np.random.default_rng(3)
    given = {
        "b": 100.0 + generator.standard_normal(6),
        "first": 40.0 + 0.1 * generator.standard_normal(6),
        "gap": 7.0 + 0.01 * generator.standard_normal(6),
    }
    asked = [
        "A.theta",
        "B.theta",
        "D.theta",
        "D.theta_dot",
        "wrap(A.theta) + D.theta",
        "A.theta_dot",
    ]
    result = model.vary(given, asked)
    assert result.complete.all()
    assert not builds
    for number in range(6):
        one = {name: float(column[number]) for name, column in given.items()}
        varied = model.with_parameters(one).analyze(asked[:4], tables=[])
        texts = {name: f"{v!r} mm" if name == "b" else repr(v) for name, v in one.items()}
        fresh = mk.loads(text, "rows", texts).analyze(asked[:4], tables=[])
        assert result["A.theta"][number].tobytes() == fresh["A.theta"].tobytes()
        for name in asked:
            assert varied[name].tobytes() == result[name][number].tobytes(), name
            assert np.allclose(fresh[name], varied[name], rtol=0.0, atol=1e-9), name


def test_what_is_named_with_its_own_value_changes_nothing(text: str) -> None:
    model = mk.loads(text, "rows")
    given = {"b": [99.0, 100.0, 102.5]}
    one = model.vary(given, ["A.theta", "D.theta"])
    other = model.vary({**given, "gap": [7.0] * 3, "first": [40.0] * 3}, ["A.theta", "D.theta"])
    for name in ("A.theta", "D.theta"):
        assert one[name].tobytes() == other[name].tobytes()


def test_other_numbers_of_rows_are_told_without_a_build(builds: list[dict[str, float]]) -> None:
    model = mk.loads(ROWS.replace("SPACING", SPACINGS["a step"]), "rows")
    result = model.vary({"gap": [7.0, 6.0, 7.0001, 0.0, 12.0]}, ["A.theta", "D.theta"])
    words = {number: str(error) for number, error in result.errors.items()}
    assert "has 21 rows, the file has 18" in words[1]
    assert "the step is zero" in words[3]
    assert "has 11 rows, the file has 18" in words[4]
    assert set(words) == {1, 3, 4}
    assert [values["gap"] for values in builds] == [0.0]
    longer = model.with_parameters({"gap": 6.0}).analyze(["D.theta"], tables=[])
    fresh = mk.loads(ROWS.replace("SPACING", SPACINGS["a step"]), "rows", {"gap": "6"})
    assert longer.rows == 21
    own = fresh.analyze(["D.theta"], tables=[])
    assert np.allclose(longer["D.theta"], own["D.theta"], rtol=0.0, atol=1e-9)


def test_places_between_are_replayed_where_a_law_of_time_is_built(
    builds: list[dict[str, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    law = "{law: harmonic, from: 40, to: first * 3 deg}"
    law = f"motion: {{time: {{from: 0, to: 1, count: 9}}, inputs: {{A.theta: {law}}}}}"
    line = next(line for line in ROWS.splitlines() if line.startswith("motion"))
    text = ROWS.replace(line, law)
    given = {"first": [40.0, 41.0, 39.0], "b": [100.0, 102.0, 99.0]}
    result = mk.loads(text, "rows").vary(given, ["D.theta"])
    # one, to record the mechanism alone
    assert len(builds) == 1
    wrong = mk.loads(text, "rows").vary({"first": [1e20], "b": [101.0]}, ["D.theta"])
    without_recordings(monkeypatch)
    fresh = mk.loads(text, "rows").vary(given, ["D.theta"])
    assert result["D.theta"].tobytes() == fresh["D.theta"].tobytes()
    refused = mk.loads(text, "rows").vary({"first": [1e20], "b": [101.0]}, ["D.theta"])
    assert str(wrong.errors[0]) == str(refused.errors[0])
