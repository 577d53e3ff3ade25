"""What is kept of variants, against an analysis of each by itself, and numpy."""

from typing import Any

import numpy as np
import pytest
from references import FILE_OF
from studies.studies import RCSR

import mechkin_cli as mk
from mechkin_cli.verdict import Status


@pytest.fixture(scope="module")
def model() -> mk.Model:
    return mk.load(FILE_OF["rcsr"])


@pytest.fixture(scope="module")
def found(model: mk.Model) -> Any:
    return model.study(RCSR)


def test_every_number_is_that_of_the_variant_by_itself(model: mk.Model, found: Any) -> None:
    names = ("P1", "P2", "alpha1")
    ends = 0
    for number in range(len(found)):
        own = {name: float(found[name][number]) for name in names}
        alone = model.with_parameters(own).analyze(["O1.effort", "O4.theta", "O3.force"])
        inputs, effort, angle = (alone[text] for text in ("O1.theta", "O1.effort", "O4.theta"))
        there = ~np.isnan(effort)
        at, values = inputs[there], effort[there]
        assert found["peak(O1.effort)"][number] == np.abs(values).max()
        assert found["place_of_peak(O1.effort)"][number] == at[np.abs(values).argmax()]
        assert found["max(O4.theta)"][number] == angle[there].max()
        assert found["place_of_min(O4.theta)"][number] == at[angle[there].argmin()]
        assert found["range(O4.theta)"][number] == np.ptp(angle[there])
        # over the way to the last solved row, by the trapezoidal rule
        for word, own in (("mean", values), ("rms", values * values)):
            mean = np.sum(np.diff(at) * (own[1:] + own[:-1])) / 2.0 / np.ptp(at)
            expected = mean if word == "mean" else np.sqrt(mean)
            assert found[f"{word}(O1.effort)"][number] == pytest.approx(expected, rel=1e-12)
            assert found[f"{word}(O1.effort)"][number] == getattr(alone.summary("O1.effort"), word)
        ball = alone["norm(O3.force)"][inputs == 170.0]
        assert found["ball"][number] == ball[0]
        status = alone.result.status
        assert found["rows_not_ok"][number] == np.count_nonzero(status != Status.ok)
        if there.all():
            assert np.isnan(found["dead_centre"][number])
            continue
        ends += 1
        assert found["verdict"][number] == "beyond-dead-centre"
        (end,) = [d.numbers[0].value for d in alone.diagnostics if d.code == "dead-centre"]
        assert found["dead_centre"][number] == end
        assert at.max() < end <= inputs[~there].min()
    assert 0 < ends < len(found) / 2


def test_all_rows_are_those_of_the_variants(model: mk.Model, found: Any) -> None:
    rows = model.problem.motion.rows
    assert len(found.rows["variant"]) == rows * len(found)
    for number in (0, 17, len(found) - 1):
        own = {name: float(found[name][number]) for name in ("P1", "P2", "alpha1")}
        alone = model.with_parameters(own).analyze(["O1.effort"], tables=[])
        here = found.rows["variant"] == number
        assert found.rows["row"][here].tolist() == list(range(1, rows + 1))
        assert np.array_equal(found.rows["O1.theta"][here], alone["O1.theta"])
        assert np.array_equal(found.rows["O1.effort"][here], alone["O1.effort"], equal_nan=True)


def test_values_are_those_that_were_written(found: Any) -> None:
    assert np.unique(found["P1"]).tolist() == [0.38, 0.42, 0.46, 0.5, 0.54, 0.58, 0.62]
    assert np.all(np.abs(found["P2"] - 0.8) <= 0.03)
    frame = found.to_pandas()
    assert frame.attrs["units"]["peak(O1.effort)"] == found.unit("peak(O1.effort)") != ""
    assert list(frame["variant"]) == list(range(len(found)))


def test_lists_may_be_split_and_joined(model: mk.Model) -> None:
    def peaks(values: list[float]) -> list[float]:
        keep = [{"of": "O1.effort", "as": "peak"}]
        return model.study({"vary": {"P1": values}, "keep": keep})["peak(O1.effort)"].tolist()

    values = [0.44, 0.47, 0.5, 0.53]
    assert peaks(values) == [each for value in values for each in peaks([value])]
    assert peaks(values[::-1]) == peaks(values)[::-1]


def test_what_cannot_be_built_is_told_and_the_rest_goes_on() -> None:
    model = mk.load(FILE_OF["swash_plate"])
    keep = [{"of": "bore.s", "as": "range"}]
    found = model.study({"vary": {"tilt": ["10 deg", "90 deg", "18 deg"]}, "keep": keep})
    # a plate parallel to the bore: the plunger's nose finds no place on it
    assert found["verdict"].tolist()[::2] == ["ok", "ok"]
    assert found["verdict"][1] != "ok"
    radius = 32.0
    for number in (0, 2):
        tilt = np.radians(found["tilt"][number])
        expected = 2.0 * radius * np.tan(tilt)
        assert found["range(bore.s)"][number] == pytest.approx(expected, rel=1e-12)


def test_a_response_is_studied_too() -> None:
    model = mk.load(FILE_OF["rcsr_response"])
    (run,) = model.runs
    quantity = "O1.theta"
    data = {
        "vary": {"cx": ["0.5 in", "0.6 in"]},
        "keep": [{"of": quantity, "as": ["max", "place_of_max"]}],
    }
    found = model.study(data)
    for number, value in enumerate((0.5, 0.6)):
        alone = model.with_parameters({"cx": value}).respond(run, tables=[])
        assert found[f"max({quantity})"][number] == alone[quantity].max()
        place = alone["time"][alone[quantity].argmax()]
        assert found[f"place_of_max({quantity})"][number] == place
