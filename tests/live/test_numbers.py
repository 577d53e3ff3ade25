"""Numbers of files without parameters on their pages: what the edited file gives is what a page
shows, and only these numbers change in its text."""

from __future__ import annotations

import base64
import difflib
from pathlib import Path

import numpy as np
import pytest
from live.test_cells import NODE, compared, computed, with_values
from references import FILE_OF

from mechkin_cli import load, loads
from mechkin_cli.building import edit_parameters, file_numbers
from mechkin_cli.view.scene import page_data

SUSPENSION = FILE_OF["five_link_suspension"]
CASE = {"joints.B5.point.z": 308.0, "joints.strut.point.y": 572.5, "links.carrier.mass": 41.0}


def test_places_and_masses_have_names() -> None:
    found = {one.name: one for one in file_numbers(load(SUSPENSION).built.document)}
    assert len(found) == 13 * 3 + 2 * 3 + 1
    assert found["joints.A2.point.x"].value == -180.0
    assert found["points.contact.at.y"].path == ("points", "contact", "at", 1)
    assert found["links.carrier.mass"].text == "32"


def test_a_page_offers_numbers_only_where_no_parameter_varies() -> None:
    """The leg's only parameter says how many rows there are."""
    data, _ = page_data([load(FILE_OF["walking_leg"]).analyze()], modes=False)
    names = [one["name"] for one in data["live"]["parameters"]]
    assert len(names) == 22
    assert "joints.upper_B.point.x" in names
    assert [one["name"] for one in data["live"]["fixed"]] == ["step"]
    text = Path(SUSPENSION).read_text(encoding="utf-8")
    named = text.replace("links:\n", "parameters: {m: 32 kg}\nlinks:\n", 1).replace("32\n", "m\n")
    data, _ = page_data([loads(named).analyze()], modes=False)
    assert [one["name"] for one in data["live"]["parameters"]] == ["m"]


@pytest.mark.skipif(NODE is None, reason="needs node")
def test_numbers_beside_parameters_are_those_of_the_edited_file() -> None:
    model = load(FILE_OF["walking_leg"])
    text = model.built.document.text
    assert "-38, -7.8" in text
    data, _ = page_data([model.analyze()], modes=False)
    names = ("joints.upper_B.point.x", "joints.lower_B.point.x")
    (found,) = computed(data, [dict.fromkeys(names, -37.5)])
    wanted = loads(text.replace("-38, -7.8", "-37.5, -7.8")).analyze().tables["walk"]
    for column in wanted.columns:
        (one,) = [one for one in found["columns"] if one["label"] == column.label]
        numbers = np.frombuffer(base64.b64decode(one["values"]))
        size = np.abs(column.values).max()
        np.testing.assert_allclose(numbers, column.values, atol=1e-9 * size)


def test_only_the_numbers_change_in_the_text() -> None:
    model = load(SUSPENSION)
    edited = edit_parameters(model.built.document.text, model.built, CASE)
    assert edited.written == {"links.carrier.mass": "41"} | {
        "joints.B5.point.z": "308",
        "joints.strut.point.y": "572.5",
    }
    lines = difflib.ndiff(model.built.document.text.splitlines(), edited.text.splitlines())
    assert [line.strip() for line in lines if line.startswith("+ ")] == [
        "+     mass: 41",
        "+   B5: {type: S, links: [track_rod, carrier], point: [-140, 690, 308]}",
        "+   strut: {type: P, links: [strut_tube, strut_rod], point: [0, 572.5, 420], "
        "axis: [0, 100, -440]}",
    ]


@pytest.mark.skipif(NODE is None, reason="needs node")
def test_the_page_shows_what_the_edited_file_gives() -> None:
    model = load(SUSPENSION)
    analysis = model.analyze()
    data, _ = page_data([analysis], modes=False)
    offered = {one["name"] for one in data["live"]["parameters"]}
    # off the line of the strut its halves would no longer spin freely: the file would be another
    assert "joints.A5.point.x" in offered
    assert not {"joints.A6.point.x", "joints.B6.point.z"} & offered
    own, changed = computed(data, [{}, CASE])
    compared("suspension", data["live"], own, analysis)
    varied = with_values(model, CASE).analyze()
    assert compared("suspension", data["live"], changed, varied) > 10
    text = edit_parameters(model.built.document.text, model.built, CASE).text
    for one, before, now in zip(
        loads(text).analyze().tables, analysis.tables, varied.tables, strict=True
    ):
        for column, old, new in zip(one.columns, before.columns, now.columns, strict=True):
            scale = np.abs(column.values).max()
            np.testing.assert_allclose(new.values, column.values, atol=1e-9 * scale)
            moved = np.abs(new.values - old.values).max() > 1e-4 * scale
            assert moved or column.label == "strut", column.label
    spans = data["live"]["file"]["spans"]
    start, end = spans["joints.A2.point.x"]
    assert data["live"]["file"]["text"][start:end] == "-180"
