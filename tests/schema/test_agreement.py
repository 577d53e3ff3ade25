"""The JSON Schema and the reader give one verdict on every file, but for the differences listed.

A difference that is not listed fails, and so does one that is listed and no longer occurs.
"""

from pathlib import Path

import pytest
from building.bad_parts import BAD_PARTS
from building.bad_responses import BAD_RESPONSES
from building.bad_uses import BAD_USES
from building.sound import SOUND
from reading.bad_files import BAD_FILES, SOUND as SMALL
from references import FILE_OF
from schema.test_json_schema import accepts

import mechkin_cli as mk
from mechkin_cli.building.source import open_file

TESTS = Path(__file__).parent.parent
SHAPED = sorted((TESTS / "reading" / "good").glob("*.yaml"))
"""Files of the right shape, which need not mean anything."""
MEANT = sorted([*FILE_OF.values(), *(TESTS / "stress" / "loops").glob("*.yaml")])
YAML = "YAML itself resolves it before a schema sees the data"
EXPRESSION = "expressions are texts to a schema: names, dimensions and values are the reader's"
CROSSING = "it lies between two places of the file, a schema sees one at a time"
VALUE = "it is a property of computed values"
EDITORS_ACCEPT = {
    "anchor": YAML,
    "bad-character": YAML,
    "duplicate-key": YAML,
    "merge-key": YAML,
    "tag": YAML,
    "unknown-format": "1.0 and 0x1 are the number 1 to YAML",
    "not-a-whole-number": "3.0 is a whole number to JSON Schema",
    "not-finite": "unquoted .nan and .inf are numbers to YAML, without a word in JSON Schema",
    "expression": EXPRESSION,
    "dimension": EXPRESSION,
    "unit": EXPRESSION,
    "name-clash": CROSSING,
    "label-clash": CROSSING,
    "vector-label": CROSSING,
    "table-clash": CROSSING,
    "same-link": CROSSING,
    "same-point": CROSSING,
    "not-its-link": CROSSING,
    "law-without-time": CROSSING,
    "rows-beside-time": CROSSING,
    "grid-inputs": CROSSING,
    "row-counts": CROSSING,
    "unknown-label": CROSSING,
    "unknown-link": CROSSING,
    "unknown-joint": CROSSING,
    "unknown-point": CROSSING,
    "point-of-another-link": CROSSING,
    "circular-place": CROSSING,
    "unknown-coordinate": CROSSING,
    "disconnected-link": CROSSING,
    "load-on-ground": CROSSING,
    "actuator-twice": CROSSING,
    "too-few-actuators": CROSSING,
    "point-on-ground": CROSSING,
    "tied-to-nothing": CROSSING,
    "load-table": CROSSING,
    "unknown-run": CROSSING,
    "named-twice": CROSSING,
    "start-rates": CROSSING,
    "start-and-drive": CROSSING,
    "effort-and-drive": CROSSING,
    "rest-and-input": CROSSING,
    "block-too-large": CROSSING,
    "too-many-rows": CROSSING,
    "csv-table": "it is a property of another file",
    "too-large": VALUE,
    "too-small": VALUE,
    "negative-mass": VALUE,
    "one-moment": VALUE,
    "time-backwards": VALUE,
    "no-duration": VALUE,
    "too-many-steps": VALUE,
    "no-angle": "to a schema theta and s are both names",
    "out-of-range": "a tolerance may be an expression; its value is the reader's",
    "zero-step": VALUE,
    "empty-window": VALUE,
    "wide-window": VALUE,
    "zero-lead": VALUE,
    "zero-direction": VALUE,
    "zero-parallel": VALUE,
    "parallel-axes": VALUE,
    "axes-not-square": VALUE,
    "not-square": VALUE,
    "pin-parallel": VALUE,
    "parameter-unit": VALUE,
}
"""Code of the reader's error -> why editors accept the file."""

EDITORS_REFUSE = [
    ("format: 1", "format: '1'", "to YAML quotes make a text of a number, the reader reads both"),
    ("step: 5}", "count: '3'}", "as for format"),
    ("name: t,", "name: 12,", "a table name is a text, 12 a number to YAML, the reader reads both"),
]
"""(text of the sound file, what replaces it, why editors refuse what the reader accepts)."""

HINGES = "\n".join(
    f"  H{i}: {{type: R, links: [ground, door], point: [0, 0, {i}], axis: [0, 0, 1]}}"
    for i in range(26)
)
MORE_BAD = [
    SMALL + 'name: "a \\x1b[31m b"\n',
    f"format: 1\nlinks: {{door: {{}}}}\njoints:\n{HINGES}\n",
    SOUND.replace("step: 5}", "count: 9999999999999}"),
    SOUND.replace("step: 5}", "count: 3.0}"),
    SOUND.replace("format: 1", "format: 1.0"),
    "format: 1\nlinks: {a: {}}\njoints:\n  A:\n    type: R\n    links: [ground, a]\n"
    "    point: {ground: [0, 0, 0], a: [1e-200, 0, 0]}\n    axis: [0, 0, 1]\n"
    "motion: {inputs: {A.theta: {at: 0}}}\n",
]
BAD = [*(bad.text for bad in (*BAD_FILES, *BAD_PARTS, *BAD_USES, *BAD_RESPONSES)), *MORE_BAD]


def codes(text: str) -> set[str]:
    """The codes of the reader's errors."""
    try:
        mk.loads(text, "f.yaml")
    except mk.InvalidFile as invalid:
        return {found.code for found in invalid.diagnostics if found.severity == "error"}
    return set()


@pytest.mark.parametrize("path", [*SHAPED, *MEANT], ids=lambda path: path.stem)
def test_both_accept_good_files(path: Path) -> None:
    open_file(path)
    assert accepts(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", MEANT, ids=lambda path: path.stem)
def test_what_is_well_formed_is_built(path: Path) -> None:
    assert codes(path.read_text(encoding="utf-8")) == set()


@pytest.mark.parametrize(("old", "new", "reason"), EDITORS_REFUSE)
def test_where_editors_are_stricter(old: str, new: str, reason: str) -> None:
    assert reason
    text = SOUND.replace(old, new)
    assert (codes(text), accepts(text)) == (set(), False)
    assert accepts(SOUND)


@pytest.mark.parametrize("text", BAD, ids=lambda text: repr(text[-40:]))
def test_both_refuse_bad_files_but_for_the_differences_listed(text: str) -> None:
    found = codes(text)
    assert found
    if accepts(text):
        assert found <= EDITORS_ACCEPT.keys()


def test_every_difference_listed_occurs() -> None:
    met = set().union(*(codes(text) for text in BAD if accepts(text)))
    assert set(EDITORS_ACCEPT) - met == set()
