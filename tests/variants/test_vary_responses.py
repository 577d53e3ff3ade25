"""Responses of many variants at once: what each gives by itself, bit for bit."""

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile, UsageError

FILE = """\
format: 1
name: slider-crank with a spring
units: {length: m, angle: deg}
parameters:
  a: 0.1 m
  b: 0.3 m
  k: 40 N/m
  start: 60 deg
links:
  crank: {mass: 1, center_of_mass: [a/2, 0, 0], inertia: {xx: .001, yy: .001, zz: .001}}
  rod: {mass: .5, center_of_mass: [a + b/2, 0, 0], inertia: {xx: .001, yy: .004, zz: .004}}
  slider: {mass: .7, center_of_mass: [a + b, 0, 0], inertia: {xx: .001, yy: .001, zz: .001}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [a, 0, 0], axis: [0, 0, 1]}
  C: {type: S, links: [rod, slider], point: [a + b, 0, 0]}
  D: {type: P, links: [ground, slider], point: [a + b, 0, 0], axis: [1, 0, 0]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: spring, joint: D, coordinate: s, stiffness: k}
responses:
  swing:
    start: {A.theta: start}
    near: {D.s: -0.05}
    time: {from: 0, to: 1, step: 0.25}
  until:
    start: {A.theta: start}
    near: {D.s: -0.05}
    time: {from: 0, to: 2, step: 0.25}
    stop: [{dead_centre: A.theta}]
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> mk.Model:
    path: Path = tmp_path_factory.mktemp("vary") / "slider.yaml"
    path.write_text(FILE)
    return mk.load(path)


GIVEN = {
    "a": np.linspace(0.08, 0.12, 11),
    "k": np.linspace(0.0, 90.0, 11),
    "start": np.linspace(20.0, 110.0, 11),
}


@pytest.mark.parametrize("run", ["swing", "until"])
def test_every_variant_is_what_it_gives_alone(model: mk.Model, run: str) -> None:
    asked = ["A.theta", "D.s_dot", "C.force", "row.work"]
    together = model.vary(GIVEN, asked, run=run)
    for number in (0, 4, 10):
        values = {name: float(array[number]) for name, array in GIVEN.items()}
        alone = model.with_parameters(values).respond(run, asked, tables=[])
        for text in asked:
            rows = alone[text].shape[0]
            np.testing.assert_array_equal(together[text][number, :rows], alone[text])
            assert np.isnan(together[text][number, rows:]).all()


def test_the_assembly_is_continued_from_the_files(model: mk.Model) -> None:
    """It is the one that the file built anew chooses, but for rounding."""
    values = {"a": 0.12, "start": 75.0}
    found = model.with_parameters(values).respond("swing", ["D.s"], tables=[])
    assert found.result.how == "continued in the parameters"
    fresh = mk.loads(FILE, parameters=values).respond("swing", ["D.s"], tables=[])
    np.testing.assert_allclose(found["D.s"], fresh["D.s"], rtol=1e-9)


def test_neither_lanes_threads_nor_neighbours_matter(model: mk.Model) -> None:
    whole = model.vary(GIVEN, ["A.theta"], run="swing")["A.theta"]
    for packing in ({"lanes": 2}, {"threads": 2}):
        other = model.vary(GIVEN, ["A.theta"], run="swing", **packing)
        np.testing.assert_array_equal(other["A.theta"], whole)
    backwards = {name: array[::-1] for name, array in GIVEN.items()}
    reversed_ = model.vary(backwards, ["A.theta"], run="swing")["A.theta"]
    np.testing.assert_array_equal(reversed_[::-1], whole)


def test_reductions_leave_out_what_a_stop_cut_off(model: mk.Model) -> None:
    rows = model.vary(GIVEN, ["A.theta"], run="until")["A.theta"]
    peaks = model.vary(GIVEN, ["A.theta"], "max", run="until")["A.theta"]
    np.testing.assert_array_equal(peaks, np.nanmax(rows, axis=1))
    assert np.isnan(rows).any()


def test_a_variant_that_cannot_be_built_is_told(model: mk.Model) -> None:
    found = model.vary({"b": [0.3, 0.05]}, ["A.theta"], run="swing")
    assert found.complete.tolist() == [True, False]
    assert np.isnan(found["A.theta"][1]).all()


def test_unknown_names_are_told(model: mk.Model) -> None:
    with pytest.raises(UsageError, match="swing"):
        model.vary(GIVEN, ["A.theta"], run="swung")
    with pytest.raises(UsageError, match=r"A\.thta"):
        model.vary(GIVEN, ["A.thta"], run="swing")


def test_nothing_free_is_said(tmp_path: Path) -> None:
    path = tmp_path / "driven.yaml"
    head, _, _ = FILE.partition("responses:")
    driven = "{start: {}, driven: {A.theta: {at: 20}}, time: {from: 0, to: 1, step: 1}}"
    path.write_text(f"{head}responses:\n  r: {driven}\n")
    with pytest.raises(InvalidFile, match=r"driven\.yaml:\d+:\d+: .*nothing is free"):
        mk.load(path).respond("r")


def test_expressions_are_read(model: mk.Model) -> None:
    found = model.vary(
        {"a": [0.1, 0.11]}, ["2*A.theta", "norm(C.force)", "a*A.theta_dot"], run="swing"
    )
    plain = model.vary({"a": [0.1, 0.11]}, ["A.theta", "C.force"], run="swing")
    np.testing.assert_allclose(found["2*A.theta"], 2 * plain["A.theta"], rtol=1e-14)
    size = np.sqrt((plain["C.force"] ** 2).sum(axis=2))
    np.testing.assert_allclose(found["norm(C.force)"], size, rtol=1e-14)


FOLLOWED = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
parameters: {k: 0.2 m/rad}
links:
  crank: {mass: 1, center_of_mass: [0, 0], inertia: 0.5}
  rod: {mass: 2, center_of_mass: [0, 0], inertia: 1}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: P, links: [ground, rod], point: [0, 0], axis: [1, 0]}
couplings: {K: {type: function, of: A.theta, gives: B.s, value: k*theta}}
loads: [{type: torque, joint: A, value: 1}]
responses: {r: {start: {A.theta: -1, A.theta_dot: 1}, time: {from: 0, to: 2, count: 9}}}
"""


def test_the_exact_numbers_of_variants_are_their_own() -> None:
    """They were those of the text: far from it the start was told as a dead centre. The inertia is
    0.5 + 2 k^2."""
    slopes, times = [0.05, 0.2, 0.4, 0.9], np.linspace(0.0, 2.0, 9)
    table = mk.loads(FOLLOWED).vary({"k": slopes}, ["A.theta"], run="r")
    for number, slope in enumerate(slopes):
        turn = -1.0 + times + 0.5 * times**2 / (0.5 + 2.0 * slope * slope)
        np.testing.assert_allclose(table["A.theta"][number], turn, atol=1e-9)
