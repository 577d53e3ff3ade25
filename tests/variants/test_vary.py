"""Variants in one call: the same bytes as one at a time, whatever their order, chunks and lanes."""

from __future__ import annotations

import numpy as np
import pytest
from benchmark.variants import CASES, arrays, text_of
from means import mean_over_the_way, rms_over_the_way

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths
from mechkin_cli.variants import many as variant_runs

COUNT = 12


def model_of(stem: str) -> mk.Model:
    return mk.loads(text_of(stem).replace("count: 361", "count: 31"), stem)


@pytest.fixture(scope="module", params=CASES)
def case(request):
    model = model_of(request.param)
    given = arrays(model, COUNT)
    quantities = [*CASES[request.param][0], "row.condition", "row.residual"]
    return model, given, quantities, model.vary(given, quantities)


def bytes_of(result, texts) -> list[bytes]:
    return [result.codes.tobytes(), *(result[text].tobytes() for text in texts)]


def test_as_one_at_a_time(case):
    model, given, quantities, result = case
    assert result.complete.all()
    for number in range(COUNT):
        one = {name: float(values[number]) for name, values in given.items()}
        analysis = model.with_parameters(one).analyze(quantities[:-2], tables=[])
        assert analysis.result.status.tobytes() == result.codes[number].tobytes()
        for text in quantities:
            assert analysis[text].tobytes() == result[text][number].tobytes(), text


def test_as_a_fresh_file(case):
    """Another start, hence other last digits, but the same positions."""
    model, given, quantities, result = case
    values = {name: float(values[3]) for name, values in given.items()}
    units, known = model.problem.units, model.problem.parameters
    texts = {
        name: f"{value!r} {units.label(known[name].dimension)}".strip()
        for name, value in values.items()
    }
    text = text_of(model.stem).replace("count: 361", "count: 31")
    fresh = mk.loads(text, model.stem, texts).analyze(quantities[:-2], tables=[])
    for name in quantities[:-2]:
        scale = np.abs(fresh[name]).max()
        assert np.abs(result[name][3] - fresh[name]).max() < 1e-10 * scale


def test_lanes_threads_and_chunks(case, monkeypatch):
    model, given, quantities, result = case
    expected = bytes_of(result, quantities)
    for lanes in widths():
        assert bytes_of(model.vary(given, quantities, lanes=lanes), quantities) == expected
    for threads in (1, 2, 3):
        assert bytes_of(model.vary(given, quantities, threads=threads), quantities) == expected
    monkeypatch.setattr(variant_runs, "CHUNK_NUMBERS", 1)
    assert bytes_of(model.vary(given, quantities), quantities) == expected


def test_order_and_number(case):
    model, given, quantities, result = case
    order = np.random.default_rng(5).permutation(COUNT)
    shuffled = model.vary({n: v[order] for n, v in given.items()}, quantities)
    doubled = model.vary({n: np.concatenate([v, v]) for n, v in given.items()}, quantities)
    for text in (*quantities,):
        assert shuffled[text].tobytes() == result[text][order].tobytes()
        assert doubled[text].tobytes() == np.concatenate([result[text]] * 2).tobytes()


def test_the_base_among_its_variants(case):
    model, given, quantities, _ = case
    units, known = model.problem.units, model.problem.parameters
    names = list(given)
    own = {n: np.full(2, units.from_si(known[n].value, known[n].dimension)) for n in names}
    changed = {n: v.copy() for n, v in own.items()}
    changed[names[0]][1] *= 1.001
    result = model.vary(changed, quantities)
    if all(float(units.to_si(own[n][0], known[n].dimension)) == known[n].value for n in names):
        base = model.analyze(quantities[:-2], tables=[])
        for text in quantities:
            assert result[text][0].tobytes() == base[text].tobytes()
            assert result[text][1].tobytes() != base[text].tobytes()


def test_one_parameter_or_several(case):
    """A parameter that keeps its value makes no difference."""
    model, given, quantities, _ = case
    first, second = list(given)[:2]
    values = given[first]
    alone = model.vary({first: values}, quantities)
    known = model.problem.parameters
    own = f"{known[second].value!r} "
    label = {"length": "m", "angle": "rad"}
    dimension = known[second].dimension
    unit = label["length"] if dimension.length else label["angle"] if dimension.angle else ""
    both = model.vary({first: values, second: (own + unit).strip()}, quantities)
    assert bytes_of(alone, quantities) == bytes_of(both, quantities)


def test_reductions(case):
    model, given, quantities, result = case
    text = quantities[0]
    every = ("min", "max", "peak", "range", "mean", "rms", lambda values: values[:, 0])
    reduced = model.vary(given, [text], reduce=every)[text]
    full = result[text]
    expected = [
        [min(row), max(row), max(map(abs, row)), max(row) - min(row)] for row in full.tolist()
    ]
    assert reduced[:, :4].tolist() == expected
    at = model.analyze([], tables=[]).result.inputs
    (at,) = (values for values in at.values() if np.ptp(values) > 0)
    assert np.allclose(reduced[:, 4], [mean_over_the_way(row, at) for row in full], rtol=1e-13)
    assert np.allclose(reduced[:, 5], [rms_over_the_way(row, at) for row in full], rtol=1e-13)
    assert reduced[:, 6].tobytes() == np.ascontiguousarray(full[:, 0]).tobytes()
    by_name = model.vary(given, quantities, reduce={text: "max"})
    assert by_name[text].shape == (COUNT,)
    assert by_name[quantities[1]].shape == full.shape


def test_expressions_and_vectors():
    model = model_of("rcsr")
    given = {"P1": ["0.5 in", "0.52 in"], "alpha1": 12}
    texts = ["O4.theta - O1.theta", "norm(O3.point)/P1", "pm2.position", "O1.theta", "P1"]
    result = model.vary(given, texts)
    for number, value in enumerate((0.5, 0.52)):
        analysis = model.with_parameters({"P1": value, "alpha1": 12}).analyze(tables=[])
        for text in texts:
            assert result[text][number].tobytes() == analysis[text].tobytes(), text
    assert result["pm2.position"].shape == (2, 31, 3)
    assert result.parameters["P1"].tolist() == [0.5, 0.52]


def test_variants_past_a_dead_centre():
    """Rows beyond are empty and say so; other variants are not touched."""
    text = text_of("rcsr").replace("to: 190", "to: 204").replace("count: 361", "count: 28")
    model = mk.loads(text, "rcsr")
    values = np.array([0.5, 0.42, 0.5, 0.58])
    result = model.vary({"P1": values}, ["O4.theta"])
    assert "beyond-dead-centre" in result.status[1]
    assert not result.complete[1]
    for number, value in enumerate(values):
        analysis = model.with_parameters({"P1": float(value)}).analyze(tables=[])
        assert analysis["O4.theta"].tobytes() == result["O4.theta"][number].tobytes()
        assert analysis.result.status.tobytes() == result.codes[number].tobytes()


def test_a_variant_that_cannot_be_reached():
    """A coupler too short for the crank: the branch folds on the way from the file's own."""
    model = model_of("rcsr")
    result = model.vary({"P2": [0.8, 0.01]}, ["O4.theta"])
    assert set(result.status[0]) == {"ok"}
    assert set(result.status[1]) <= {"branch-lost", "not-assembled", "beyond-dead-centre"}
    assert np.isnan(result["O4.theta"][1]).all()


def test_a_variant_that_is_no_mechanism():
    text = text_of("rcsr").replace("mass: 2\n", "mass: m2 * 1 lbm\n")
    text = text.replace("parameters:\n", "parameters:\n  m2: 2\n").replace("361", "5")
    model = mk.loads(text, "rcsr")
    result = model.vary({"m2": [2.0, -1.0, 3.0]}, ["O1.effort"])
    assert list(result.errors) == [1]
    assert "a mass is not negative" in str(result.errors[1])
    assert np.isnan(result["O1.effort"][1]).all()
    assert np.isfinite(result["O1.effort"][[0, 2]]).all()
    with pytest.raises(mk.InvalidFile, match="a mass is not negative"):
        model.with_parameters({"m2": -1.0})


@pytest.mark.parametrize(
    ("given", "more", "match"),
    [
        ({"Q1": 1}, {}, "no parameter Q1"),
        ({}, {}, "at least one parameter"),
        ([1, 2], {}, "mapping"),
        ({"P1": "1 deg"}, {}, "expected a length"),
        ({"P1": "P2"}, {}, "P1 = P2: there is nothing named P2"),
        ({"P1": np.nan}, {}, "that is finite"),
        ({"P1": [0.5, np.inf]}, {}, r"P1\[1\] = inf"),
        ({"P1": True}, {}, "not True"),
        ({"P1": None}, {}, "not None"),
        ({"P1": [[0.5]]}, {}, "one dimension"),
        ({"P1": [0.5, [1]]}, {}, "P1"),
        ({"P1": [0.5, 0.6], "P2": [1, 2, 3]}, {}, "equally many"),
        ({"P1": 0.5}, {"quantities": "O4.theta"}, "list of texts"),
        ({"P1": 0.5}, {"quantities": ["O9.theta"]}, "nothing named O9.theta"),
        ({"P1": 0.5}, {"quantities": [3]}, "not 3"),
        ({"P1": 0.5}, {"quantities": ["row.status"]}, "status"),
        ({"P1": 0.5}, {"reduce": "median"}, "no reduction median"),
        ({"P1": 0.5}, {"reduce": 3}, "expected one of max"),
        ({"P1": 0.5}, {"reduce": {"O1.effort": "max"}}, "was not asked for"),
        ({"P1": 0.5}, {"lanes": 3}, "lanes 3"),
        ({"P1": 0.5}, {"threads": -1}, "threads: expected"),
        ({"P1": 0.5}, {"reduce": lambda values: 1.0}, "one value a variant"),
        ({"P1": 0.5}, {"reduce": lambda values: values.sort()}, "read-only"),
        ({"P1": np.full(50_000_000, 0.5)}, {}, "50000000 variants are [0-9]+ numbers"),
    ],
)
def test_bad_use(given, more, match):
    model = model_of("rcsr")
    with pytest.raises(mk.UsageError, match=match):
        model.vary(given, **({"quantities": ["O4.theta"]} | more))


def test_no_variants():
    result = model_of("rcsr").vary({"P1": []}, ["O4.theta"], reduce="max")
    assert len(result) == 0
    assert result["O4.theta"].shape == (0,)


def test_whole_numbers_of_numpy():
    model = model_of("rcsr")
    one = model.vary({"P1": [0.5, 0.51]}, ["O4.theta"])
    other = model.vary({"P1": [0.5, 0.51]}, ["O4.theta"], lanes=np.int64(2), threads=np.uint8(2))
    assert one["O4.theta"].tobytes() == other["O4.theta"].tobytes()
    assert model.analyze(threads=np.int64(2), lanes=np.int32(2)).result.complete
