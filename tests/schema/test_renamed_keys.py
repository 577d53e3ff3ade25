"""The path of a key that gets another name: read with a warning at its place, offered by editors as
deprecated, refused beside its new name. No key of format 1 has been renamed yet; these are played.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from mechkin_cli import InvalidFile, load, loads
from mechkin_cli.schema import OLD_KEYS, Renamed
from mechkin_cli.schema.base import Section
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.schema.json_schema import SCHEMAS
from mechkin_cli.schema.links_joints import AxisJoint, Link
from mechkin_cli.schema.motion import SweptInput
from mechkin_cli.schema.study import StudyFile

WORD = "1.4", "2.0"
OLD: dict[type[Section], dict[str, Renamed]] = {
    MechanismFile: {"drives": Renamed("motion", *WORD)},
    Link: {"weight": Renamed("mass", *WORD)},
    AxisJoint: {"direction_of_axis": Renamed("axis", *WORD)},
    SweptInput: {"until": Renamed("to", *WORD)},
    StudyFile: {"vary_over": Renamed("vary", *WORD)},
}
NEW_TEXT = """\
format: 1
links:
  arm: {mass: 2, center_of_mass: [0.5, 0, 0]}
joints:
  O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}
motion:
  inputs: {O.theta: {from: 0, to: 90, step: 45, rate: 1 rad/s}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
"""
OLD_TEXT = NEW_TEXT
for _new, _old in (("{mass:", "{weight:"), (", axis:", ", direction_of_axis:"), ("to:", "until:")):
    OLD_TEXT = OLD_TEXT.replace(_new, _old)
OLD_TEXT = OLD_TEXT.replace("motion:", "drives:")


@pytest.fixture
def renamed(monkeypatch: pytest.MonkeyPatch) -> None:
    for section, words in OLD.items():
        monkeypatch.setattr(section, "renamed", words)
    for module in ("schema", "schema.base", "schema.renamed", "studies.source"):
        monkeypatch.setattr(f"mechkin_cli.{module}.OLD_KEYS", ALL, raising=False)


ALL = {word for words in OLD.values() for word in words}


def test_format_1_has_renamed_no_key_yet() -> None:
    """When the first one is: describe it in docs/versions.md and in the changelog."""
    assert set() == OLD_KEYS
    with pytest.raises(InvalidFile, match="weight"):
        loads(OLD_TEXT)


def test_old_keys_mean_the_new_ones_and_say_so(renamed: None) -> None:
    one, other = loads(NEW_TEXT), loads(OLD_TEXT)
    assert not [d for d in one.diagnostics if d.code == "renamed-key"]
    told = [d for d in other.diagnostics if d.code == "renamed-key"]
    lines = OLD_TEXT.splitlines()
    for each in told:
        assert each.place is not None
        old = lines[each.place.line - 1][each.place.column - 1 :].partition(":")[0]
        assert f"the key '{old}' is called" in each.message
        assert "since mechkin 1.4" in each.message
        assert "before mechkin 2.0, which refuses" in str(each.hint)
        assert each.severity == "warning"
    assert len(told) == 4
    ours, theirs = other.analyze(), one.analyze()
    assert ours["O.effort"].tobytes() == theirs["O.effort"].tobytes()
    assert [d.code for d in ours.diagnostics if d.severity == "error"] == []


def test_both_names_are_one_too_many(renamed: None) -> None:
    with pytest.raises(InvalidFile) as refused:
        loads(NEW_TEXT.replace("mass: 2", "mass: 2, weight: 2"))
    (told,) = refused.value.diagnostics
    assert told.message == "'weight' is the old name of 'mass', and both are there"
    assert (told.place.line, told.place.column) == (3, 18) if told.place else False


def test_a_fault_at_an_old_key_has_its_place(renamed: None) -> None:
    with pytest.raises(InvalidFile) as refused:
        loads(OLD_TEXT.replace("weight: 2", "weight: heavy"))
    (error,) = (d for d in refused.value.diagnostics if d.severity == "error")
    assert error.place is not None
    assert (error.place.line, error.place.column) == (3, OLD_TEXT.splitlines()[2].index("2") + 1)


def test_a_file_made_by_a_program_is_told_too(renamed: None) -> None:
    told = [d for d in load(yaml.safe_load(OLD_TEXT)).diagnostics if d.code == "renamed-key"]
    paths = (
        "drives",
        "drives.inputs.O.theta.until",
        "joints.O.direction_of_axis",
        "links.arm.weight",
    )
    assert sorted(str(d.place) for d in told) == [f"data at {path}" for path in paths]


def test_a_study_takes_old_keys(renamed: None, tmp_path: Path) -> None:
    model = loads(NEW_TEXT.replace("mass: 2", "mass: m") + "parameters: {m: 2 kg}\n")
    study: dict[str, Any] = {"keep": [{"of": "O.effort", "as": "max", "label": "torque"}]}
    new = model.study(study | {"vary": {"m": ["1 kg", "2 kg"]}})
    old = model.study(study | {"vary_over": {"m": ["1 kg", "2 kg"]}})
    assert [d.code for d in old.diagnostics] == ["renamed-key"]
    assert old["torque"].tobytes() == new["torque"].tobytes()
    with pytest.raises(InvalidFile, match="both are there"):
        model.study(study | {"vary": {"m": ["1 kg", "2 kg"]}, "vary_over": {"m": ["1 kg", "2 kg"]}})


def test_editors_show_old_keys_as_deprecated(renamed: None) -> None:
    schema = json.loads(json.dumps(SCHEMAS["mechanism"]()))
    weight = schema["$defs"]["Link"]["properties"]["weight"]
    assert weight["deprecated"] is True
    assert weight["description"] == "Deprecated since 1.4: write `mass`. 2.0 refuses it."
    check = jsonschema.Draft202012Validator(schema)
    assert not list(check.iter_errors(yaml.safe_load(NEW_TEXT)))
    assert not list(check.iter_errors(yaml.safe_load(OLD_TEXT)))
    for text in (
        NEW_TEXT.replace("mass: 2", "mass: 2, weight: 2"),
        NEW_TEXT.replace(", axis: [0, 0, 1]", ""),
    ):
        assert list(check.iter_errors(yaml.safe_load(text)))
