"""Messages as annotations of GitHub, read back as its runner reads them."""

from __future__ import annotations

import re
from typing import NamedTuple

import pytest
from cli import files

COMMAND = re.compile(r"::(?P<level>\w+) (?P<fields>[^:]*)::(?P<message>.*)")


class Annotation(NamedTuple):
    level: str
    fields: dict[str, str]
    message: str


def unescaped(text: str, *, field: bool = False) -> str:
    codes = {"%0D": "\r", "%0A": "\n"} | ({"%3A": ":", "%2C": ","} if field else {}) | {"%25": "%"}
    for code, character in codes.items():
        text = text.replace(code, character)
    return text


def annotations(text: str) -> list[Annotation]:
    found = []
    for line in text.splitlines():
        if match := COMMAND.fullmatch(line):
            pairs = (field.partition("=") for field in match["fields"].split(","))
            fields = {name: unescaped(value, field=True) for name, _, value in pairs}
            found.append(Annotation(match["level"], fields, unescaped(match["message"])))
    return found


@pytest.mark.parametrize(
    "words",
    [["check", "--format"], ["check", "--messages"], ["analyze", "--messages"]],
)
def test_an_error_stands_at_its_place(mechkin, write, words) -> None:
    command, option = words
    run = mechkin(command, write("bad.yaml", files.INVALID), option, "github")
    assert (run.code, run.out) == (3, "")
    (only,) = annotations(run.err)
    assert only.level == "error"
    place = {"file": "bad.yaml", "line": "5", "col": "39", "title": "mechkin unknown-link"}
    assert only.fields == place
    plain = mechkin(command, "bad.yaml").err
    assert plain == f"bad.yaml:5:39: error: {only.message}\n"


def test_warnings_and_notes_have_their_own_levels(mechkin, write) -> None:
    path = write("odd.yaml", files.UNPHYSICAL)
    found = annotations(mechkin("check", path, "--format", "github").err)
    assert {"warning"} <= {one.level for one in found} <= {"warning", "notice"}


def test_names_of_files_cannot_make_commands_of_their_own(mechkin, write) -> None:
    path = write("a,line=9%::error ::b.yaml", files.INVALID)
    (only,) = annotations(mechkin("check", path, "--format", "github").err)
    assert only.fields["file"] == str(path)
    assert only.fields["line"] == "5"


def test_files_are_named_from_the_top_of_the_repository(
    mechkin, write, folder, monkeypatch
) -> None:
    write("sub/bad.yaml", files.INVALID)
    monkeypatch.setenv("GITHUB_WORKSPACE", str(folder))
    monkeypatch.chdir(folder / "sub")
    (only,) = annotations(mechkin("check", "bad.yaml", "--format", "github").err)
    assert only.fields["file"] == "sub/bad.yaml"


def test_what_has_no_place_is_told_at_the_file(mechkin, write) -> None:
    (only,) = annotations(mechkin("check", "nowhere.yaml", "--format", "github").err)
    assert (only.level, only.fields["file"]) == ("error", "nowhere.yaml")
    run = mechkin("analyze", write("beyond.yaml", files.beyond_dead_centre()), *GITHUB)
    assert run.code == 4
    assert any("dead centre" in one.message for one in annotations(run.err))


GITHUB = ("--messages", "github")


def test_other_forms_and_the_wrong_option_say_what_to_write(mechkin, write) -> None:
    path = write("crank.yaml", files.CRANK)
    assert mechkin("check", path, "--messages", "gitlab").err == (
        "mechkin: --messages gitlab: forms are text and github\n"
    )
    assert "write --messages github" in mechkin("analyze", path, "--format", "github").err


def test_the_form_ends_with_its_command(mechkin, write) -> None:
    path = write("bad.yaml", files.INVALID)
    mechkin("check", path, *GITHUB)
    assert mechkin("modes", path).err.startswith("bad.yaml:5:39: error:")
