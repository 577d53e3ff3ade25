"""What becomes of errors that are planted: a repetition that is the run itself but for them."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.errors import errors as repeated_runs
from mechkin_cli.expressions.quantity import Quantity
from mechkin_cli.tape.double_double import DoubleDoubles, exactly

TEXT = """
format: 1
name: rocker
units: {length: mm, angle: deg}
parameters: {a: 20 mm}
links: {crank: {}, rod: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [a, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, rocker], point: [60 mm, 50 mm, 0 mm], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [70, 0, 0], axis: [0, 0, 1]}
points: {tip: {link: rod, at: [40, 60, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 720, step: 30, rate: 1 rad/s}}}
tables:
  - name: one
    columns:
      - A.theta
      - D.theta
      - {label: x, value: tip.position.x}
      - {label: y, value: tip.position.y}
  - name: two
    columns:
      - row.status
      - row.condition
      - {label: twice, value: 2*tip.position.x + a}
      - {label: x, value: tip.position.y}
"""


class Planted:
    """The run once more, off by planted numbers in SI at row 4."""

    def __init__(self, result, planted):
        self.result, self.planted = result, planted
        self.inputs = result.session.inputs
        self.parameters = {"a": Quantity(exactly(0.02), result.problem.parameters["a"].dimension)}
        self.written = {name: exactly(v) for name, v in result.inputs.items()}
        self.time = None
        self.calls = []

    def run(self, wanted, session, inputs, demand):
        self.calls.append([quantity.name for quantity in wanted])
        found = self.result.evaluated(wanted, session=session, demand=demand)
        true = {name: DoubleDoubles(values.copy()) for name, values in found.items()}
        for name, off in self.planted.items():
            if name in true:
                true[name].low[0, 3] = off
        return true


@pytest.fixture
def planted(monkeypatch):
    def plant(**numbers):
        made = []

        def wide_run(result):
            made.append(Planted(result, {name.replace("_", "."): n for name, n in numbers.items()}))
            return made[-1]

        monkeypatch.setattr(repeated_runs, "wide_run", wide_run)
        return made

    return plant


def test_errors_are_found_where_they_are(planted):
    planted(tip_position=1e-12)
    errors = mk.loads(TEXT).analyze(errors=True).errors
    # in mm, beside what the conversion of the cells rounds
    assert np.flatnonzero(errors["one", "x"] > 1e-13).tolist() == [3]
    assert errors["one", "x"][3] == pytest.approx(1e-9, rel=1e-3)
    assert errors["twice"][3] == pytest.approx(2e-9, rel=1e-3)
    assert (errors["y"] < 1e-13).all()
    assert errors["tip.position"][:, 0] == pytest.approx(errors["one", "x"], abs=1e-30)


def test_whole_turns_of_angles_are_no_errors(planted):
    planted()
    r = mk.loads(TEXT).analyze()
    assert r["A.theta"][-1] == 720.0
    assert r.errors["D.theta"].max() < 1e-14
    assert (r.errors["A.theta"] == 0.0).all()


def test_all_quantities_are_repeated_in_one_run(planted):
    made = planted()
    mk.loads(TEXT).analyze(errors=True)
    assert len(made) == 1
    assert len(made[0].calls) == 1


def test_a_label_of_two_tables_has_to_be_told_apart(planted):
    planted(tip_position=1e-18)
    errors = mk.loads(TEXT).analyze().errors
    with pytest.raises(mk.UsageError, match=r'errors\["one", "x"\]'):
        errors["x"]
    with pytest.raises(mk.UsageError, match=r"no column one\.z"):
        errors["one", "z"]


def test_what_is_no_number_of_the_mechanism_says_so(planted):
    planted()
    errors = mk.loads(TEXT).analyze().errors
    assert errors.why == {"two.row.status": "words", "two.row.condition": "a verdict"}


def test_the_worst_is_told(planted):
    planted(tip_position=1e-9)
    errors = mk.loads(TEXT).analyze().errors
    assert errors.worst.label in {"x", "twice"}
    assert errors.worst.worst == 3
    assert errors.digits == 7
