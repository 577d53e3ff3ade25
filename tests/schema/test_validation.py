"""What the reader takes for valid is valid, and becomes the same sections, by pydantic's core."""

from __future__ import annotations

import copy
import random
from pathlib import Path
from typing import Any

import pytest

from mechkin_cli.reading import read_document
from mechkin_cli.schema import errors, validation
from mechkin_cli.schema.base import Section
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.schema.plane import PlaneFile

ROOT = Path(__file__).parents[2]
FOLDERS = [ROOT / "mechanisms", ROOT / "tests"]
FILES = sorted(
    path
    for folder in FOLDERS
    for path in folder.rglob("*.yaml")
    if "format: 1" in path.read_text(encoding="utf-8", errors="replace")
)
OTHERS: list[Any] = [
    *("", " ", "x", "R", "1", "a.b", "a\n", "é", "\ud800", "nan", "[1, 2, 3]", "own", "sweep"),
    *(1, 0, -1, 2.0, 1.5, True, None, float("nan"), 10**400),
    *([], ["1"], ["1", "2"], ["1", "2", "3"], {}, {"type": "R"}, {"law": "x"}, {"from": "1"}),
]


def _form(data: object) -> type[Section]:
    return PlaneFile if isinstance(data, dict) and "plane" in data else MechanismFile


def plain(value: Any) -> Any:
    """Sections as plain data, with the names of their classes."""
    if isinstance(value, Section):
        fields = sorted(vars(value).items())
        return type(value).__name__, [(name, plain(one)) for name, one in fields]
    if isinstance(value, tuple):
        return tuple(plain(one) for one in value)
    if isinstance(value, dict):
        return [(name, plain(one)) for name, one in value.items()]
    return type(value), value


def read(form: type[Section], data: Any) -> Any:
    try:
        return plain(validation._section(form)(data))
    except (validation.NotSure, ValueError, AssertionError):
        return None


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_file_becomes_the_same_sections(path: Path) -> None:
    try:
        data = read_document(path).data
    except Exception:
        return
    found = read(_form(data), data)
    if found is not None:
        assert found == plain(errors.judged(_form(data), data))


def test_the_files_of_mechanisms_are_read() -> None:
    for path in (ROOT / "mechanisms").rglob("*.yaml"):
        data = read_document(path).data
        assert "study" in data or read(_form(data), data) is not None, path


def changed(data: Any, dice: random.Random) -> None:
    """Changes something somewhere in the data."""
    while True:
        keys = list(data) if isinstance(data, dict) else list(range(len(data)))
        if not keys:
            return
        key = dice.choice(keys)
        if isinstance(data[key], dict | list) and dice.random() < 0.8:
            data = data[key]
            continue
        what = dice.randrange(4)
        if what == 0:
            del data[key]
        elif what == 1 and isinstance(data, dict):
            data[dice.choice(("x", "at", "rate", "count", "links", "1"))] = data[key]
        else:
            data[key] = copy.deepcopy(dice.choice(OTHERS))
        return


@pytest.mark.parametrize("seed", range(20))
def test_what_is_read_is_valid(seed: int) -> None:
    dice = random.Random(seed)
    taken = 0
    for path in dice.sample(FILES, 12):
        try:
            data = read_document(path).data
        except Exception:
            continue
        for _ in range(20):
            other = copy.deepcopy(data)
            changed(other, dice)
            found = read(_form(other), other)
            if found is not None:
                taken += 1
                assert found == plain(errors.judged(_form(other), other))
    assert taken
