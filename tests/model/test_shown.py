"""What the prompt shows of a model and of every result."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from references import FILE_OF

import mechkin_cli as mk

STUDY = {"vary": {"P1": [0.48, 0.5]}, "keep": [{"of": "O1.effort", "as": "peak"}]}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    m = mk.load(FILE_OF["rcsr"])
    r = m.analyze()
    out = tmp_path_factory.mktemp("study")
    return {
        "model": m,
        "parameters": m.parameters,
        "design": m.with_parameters({"P1": 0.48}).design,
        "analysis": r,
        "tables": r.tables,
        "table": r.tables["table_03"],
        "summary": r.summary("O1.effort"),
        "picture": r.picture(["O4.theta"]),
        "errors": r.errors,
        "certificate": r.certificate,
        "position": m.solve({"O1.theta": 170}),
        "modes": m.modes(),
        "ranges": m.ranges(),
        "mobility": m.mobility(),
        "variants": m.vary({"P1": [0.48, 0.5]}, ["O4.theta"]),
        "study": m.study(STUDY),
        "files": m.study(STUDY, out),
        "sensitivities": m.sensitivities(["O4.theta"], ["P1"]),
        "tolerances": m.tolerances({"P1": 0.002}, ["O4.theta"], samples=16),
    }


NAMES = {
    "model": ["RCSR", "O1.theta"],
    "parameters": ["P1", "0.5", "in"],
    "design": ["rcsr", "P1"],
    "analysis": ["27 of 27 rows solved"],
    "tables": ["table_03", "table_18"],
    "table": ["Table III", "theta4 [deg]", "37.231", "..."],
    "summary": ["peak"],
    "picture": ["O4.theta [deg]", "O1.theta"],
    "errors": ["right to", "table_03"],
    "certificate": ["27 proven"],
    "position": ["ok", "O4.theta"],
    "modes": ["A", "B"],
    "ranges": ["dead-centre"],
    "mobility": ["one freedom"],
    "variants": ["2 variants, 2 complete", "P1", "O4.theta"],
    "study": ["2 variants", "peak(O1.effort)"],
    "files": ["2 variants", "variants.csv"],
    "sensitivities": ["O4.theta", "P1"],
    "tolerances": ["16 samples"],
}


@pytest.mark.parametrize("name", NAMES)
def test_a_result_shows_what_it_holds(results: dict[str, Any], name: str) -> None:
    text = repr(results[name])
    assert " at 0x" not in text
    assert len(text.splitlines()) <= 40
    for word in NAMES[name]:
        assert word in text, text


def test_every_kind_of_result_is_shown_here(results: dict[str, Any]) -> None:
    assert set(results) == set(NAMES)


def test_parameters_are_a_mapping_in_the_units_of_the_file() -> None:
    m = mk.load(FILE_OF["rcsr"])
    assert list(m.parameters)[:3] == ["alpha1", "alpha4", "P1"]
    assert m.parameters["alpha1"] == pytest.approx(12.0, rel=1e-15)
    assert m.parameters.unit("alpha1") == "deg"
    assert dict(m.with_parameters({"P1": 0.25}).parameters) == {**m.parameters, "P1": 0.25}
    with pytest.raises(KeyError):
        m.parameters["P9"]


def test_given_parameters_come_back_as_they_were_given() -> None:
    """What is read from one model and given to another changes nothing."""
    m = mk.load(FILE_OF["rcsr"], {"P1": "0.013 m"})
    again = mk.load(FILE_OF["rcsr"]).with_parameters(m.parameters)
    assert dict(again.parameters) == pytest.approx(dict(m.parameters), rel=4e-16)


def test_names_of_the_package_complete() -> None:
    assert set(mk.__all__) == set(dir(mk))
    assert {"load", "Model", "Analysis"} <= set(dir(mk))


def test_a_study_folder_is_named(tmp_path: Path) -> None:
    files = mk.load(FILE_OF["rcsr"]).study(STUDY, tmp_path / "here")
    assert str(tmp_path / "here") in repr(files)
