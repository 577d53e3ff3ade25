"""A model under other parameters: its answers and its errors are those of the file."""

from __future__ import annotations

import numpy as np
import pytest
from references import FILE_OF, MECHANISMS
from variants.recordings import WITH_PARAMETERS, near, parameters_of

import mechkin_cli as mk
from mechkin_cli.variants.design import VariedDesign


def changed(model: mk.Model, seed: int) -> dict[str, float]:
    """One set of parameters in the file's units, by name."""
    values = near(model.built, 2, seed, spread=0.002)[:, 1]
    known, units = model.problem.parameters, model.problem.units
    return {
        name: float(units.from_si(value, known[name].dimension))
        for name, value in zip(parameters_of(model.built), values, strict=True)
    }


@pytest.mark.parametrize("stem", WITH_PARAMETERS)
def test_the_same_positions_as_a_fresh_file(stem: str) -> None:
    model = mk.load(FILE_OF[stem])
    values = changed(model, seed=3)
    varied = model.with_parameters(values)
    units, known = model.problem.units, model.problem.parameters
    texts = {
        name: f"{value!r} {units.label(known[name].dimension)}".strip()
        for name, value in values.items()
    }
    fresh = mk.load(FILE_OF[stem], texts)
    # of a file that follows loop one alone, what that loop has
    alone = ["O2.theta", "O2.s", "O4.theta"]
    names = alone if model.problem.follow is not None else list(model.problem.mechanism.coordinates)
    one, other = varied.analyze(names, tables=[]), fresh.analyze(names, tables=[])
    if not (one.result.complete and other.result.complete):
        return
    for name in names:
        scale = 1.0 + np.abs(other[name]).max()
        assert np.abs(one[name] - other[name]).max() < 1e-8 * scale, name


def test_problem_is_that_of_the_file() -> None:
    model = mk.load(FILE_OF["rcsr"])
    varied = model.with_parameters({"P1": "0.52 in", "s1": 5.1})
    fresh = mk.load(FILE_OF["rcsr"], {"P1": "0.52 in", "s1": "5.1 in"})
    assert varied.problem.mechanism == fresh.problem.mechanism
    assert varied.problem.assembly == fresh.problem.assembly
    assert {n: q.value for n, q in varied.problem.parameters.items()} == {
        n: q.value for n, q in fresh.problem.parameters.items()
    }
    assert [m.name for m in varied.modes().modes] == [m.name for m in fresh.modes().modes]


def test_one_after_another() -> None:
    model = mk.load(FILE_OF["rcsr"])
    once = model.with_parameters({"P1": 0.51, "P2": 0.81}).analyze(tables=[])["O4.theta"]
    twice = model.with_parameters({"P1": 0.6}).with_parameters({"P2": 0.81, "P1": 0.51})
    assert twice.analyze(tables=[])["O4.theta"].tobytes() == once.tobytes()
    back = model.with_parameters({"P1": 0.6}).with_parameters({"P1": "0.5 in"})
    assert back.analyze(tables=[])["O4.theta"].tobytes() == (
        model.analyze(tables=[])["O4.theta"].tobytes()
    )
    assert model.with_parameters({}) is model


def test_rows_that_follow_a_parameter() -> None:
    """Other numbers of rows are built anew; rates of inputs are on the tape."""
    text = FILE_OF["rcsr"].read_text(encoding="utf-8")
    text = text.replace("parameters:\n", "parameters:\n  last: 202 deg\n  w: 0.1 rad/s\n")
    text = text.replace("to: 202", "to: last").replace("rate: 0.1 rad/s", "rate: w")
    model = mk.loads(text, "rcsr")
    longer = model.with_parameters({"last": 170})
    assert isinstance(longer.design, VariedDesign)
    assert longer.analyze(tables=[]).rows == 11
    faster = model.with_parameters({"w": 0.2}).analyze(["O4.theta_dot"], tables=[])
    base = model.analyze(["O4.theta_dot"], tables=[])
    assert np.allclose(faster["O4.theta_dot"], 2 * base["O4.theta_dot"], rtol=1e-12)
    assert faster["O1.theta_dot"].tolist() == [0.2] * 27
    result = model.vary({"w": [0.1, 0.2]}, ["O4.theta_dot", "O1.effort"])
    assert result["O4.theta_dot"][1].tobytes() == faster["O4.theta_dot"].tobytes()


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"Q1": 1}, "no parameter Q1"),
        ({"P1": "one"}, "P1 = one: there is nothing named one"),
        ({"P1": [1, 2]}, r"not \[1, 2\]"),
        ("P1", "mapping"),
        ({"P1": float("nan")}, "that is finite"),
        ({1: 2}, "expected a text"),
    ],
)
def test_bad_use(given, match) -> None:
    with pytest.raises(mk.UsageError, match=match):
        mk.load(FILE_OF["rcsr"]).with_parameters(given)


@pytest.mark.parametrize("scale", [0.7, 1.3, 1.6])
def test_questions_beside_the_sweep(scale: float) -> None:
    """Whether the size leads to the length unit of the file's own drawing or not."""
    model = mk.load(FILE_OF["rcsr"])
    units, known = model.problem.units, model.problem.parameters
    lengths = [name for name in known if not name.startswith("alpha")]
    texts = {
        name: f"{scale * float(units.from_si(known[name].value, known[name].dimension))!r} in"
        for name in lengths
    }
    varied = model.with_parameters(texts)
    fresh = mk.load(FILE_OF["rcsr"], texts)
    ranges = [each.ranges(outputs=["O4.theta"]).ranges for each in (varied, fresh)]
    for one, other in zip(*ranges, strict=True):
        for a, b in ((one.lower, other.lower), (one.upper, other.upper)):
            assert a is not None
            assert b is not None
            assert abs(a.value - b.value) < 1e-9
    assert str(varied.mobility().mobility) == str(fresh.mobility().mobility)
    # of a file that follows loop one alone, what that loop has
    alone = ["O2.theta", "O2.s", "O4.theta"]
    names = alone if model.problem.follow is not None else list(model.problem.mechanism.coordinates)
    one, other = varied.analyze(names, tables=[]), fresh.analyze(names, tables=[])
    assert np.abs(one["O4.theta"] - other["O4.theta"]).max() < 1e-11
    assert varied.analyze(tables=[], mode="B").result.mode == "B"


def test_a_variant_built_anew_has_loads_that_vary() -> None:
    """With the seat on the other side of its end the gas spring is drawn otherwise, so that no
    recording holds; its force falls with its length all the same."""
    path = MECHANISMS / "plane" / "fits" / "hatch.yaml"
    values = {"u": 130.5, "v": -114.5, "p": 100.75}
    texts = {name: f"{value!r} mm" for name, value in values.items()}
    varied = mk.load(path).with_parameters(values).analyze(["hinge.effort"])
    fresh = mk.load(path, texts).analyze(["hinge.effort"])
    scale = np.abs(fresh["hinge.effort"]).max()
    assert np.abs(varied["hinge.effort"] - fresh["hinge.effort"]).max() < 1e-12 * scale
