"""`--json` is valid JSON, and nothing fails, for any name of a file and any encoding of stdout."""

from __future__ import annotations

import json
import os
import random
import subprocess
from pathlib import Path
from typing import Any

import pytest
from cli import files
from cli.test_processes import MECHKIN

NAMES = [
    b"plain.yaml",
    b"bytes \xff\xfe.yaml",
    b"half \xed\xa0\x80.yaml",
    "ä → \U0001f600.yaml".encode(),
    b'quote " back\\slash.yaml',
    b"line\nbreak\ttab.yaml",
    b"\x1b[31mred.yaml",
    b"$(id);`id`&|<b>.yaml",
    "\u202e\u2028.yaml".encode(),
    b"=1+1.yaml",
    b" .yaml",
    b"...yaml",
    b"%s{}.yaml",
]
COMMANDS = ["analyze", "check", "modes", "mobility", "ranges", "tables"]
ENCODINGS = ["utf-8", "ascii", "latin-1", "cp1252", "utf-8:surrogateescape"]
TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
BOTH = [
    (command, encoding)
    for i, command in enumerate(COMMANDS)
    for j, encoding in enumerate(ENCODINGS)
    if TIMES > 1 or i % 5 == j
]
"""Every command and every encoding, or all pairs of them with `MECHKIN_RANDOM=2`."""


def run(folder: Path, command: str, name: bytes, encoding: str = "utf-8") -> tuple[int, Any, bytes]:
    """Exit code, the object on stdout as a strict reader has it, stderr."""
    done = subprocess.run(
        [*map(os.fsencode, MECHKIN), command.encode(), b"./" + name, b"--json"],
        cwd=folder,
        env=os.environ | {"PYTHONIOENCODING": encoding},
        capture_output=True,
        check=False,
        timeout=60,
    )
    text = done.stdout.decode("utf-8")  # JSON is UTF-8, whatever stdout was said to be
    found = json.loads(text, parse_constant=lambda word: pytest.fail(word))
    json.dumps(found, ensure_ascii=False).encode("utf-8")  # no half characters
    return done.returncode, found, done.stderr


def names_in(record: Any) -> list[str]:
    if isinstance(record, dict):
        own = [record["file"]] if isinstance(record.get("file"), str) else []
        return own + [name for value in record.values() for name in names_in(value)]
    if isinstance(record, list):
        return [name for value in record for name in names_in(value)]
    return []


@pytest.mark.parametrize("name", NAMES, ids=repr)
def test_any_name_of_a_file(tmp_path: Path, name: bytes) -> None:
    (tmp_path / os.fsdecode(name)).write_text(files.CRANK + files.TABLES, encoding="utf-8")
    for command in ("analyze", "check"):
        code, found, err = run(tmp_path, command, name)
        assert (code, err) == (0, b"")
        assert names_in(found)
        assert "\x1b" not in "".join(names_in(found)) or b"\x1b" in name
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(("command", "encoding"), BOTH)
def test_any_command_and_encoding(tmp_path: Path, command: str, encoding: str) -> None:
    name = NAMES[1].replace(b" ", "ä\U0001f600".encode())
    text = files.CRANK.replace("name: crank", "name: 'ä → \U0001f600 \"'") + files.TABLES
    (tmp_path / os.fsdecode(name)).write_text(text, encoding="utf-8")
    code, found, err = run(tmp_path, command, name, encoding)
    assert b"Traceback" not in err
    assert b"internal error" not in err
    assert code == 0
    assert any(r"\xff" in own and "\U0001f600" in own for own in names_in(found))


@pytest.mark.parametrize("command", COMMANDS)
def test_refusals_too(tmp_path: Path, command: str) -> None:
    for name, text in ((NAMES[1], files.INVALID), (b"no such \xff", None)):
        if text:
            (tmp_path / os.fsdecode(name)).write_text(text, encoding="utf-8")
        elif command == "tables":
            continue  # a use of the command that cannot be, as --set without a value
        code, found, err = run(tmp_path, command, name, "ascii")
        assert code == (3 if text else 2)
        assert names_in(found)
        assert rb"\xff" in err


def test_pages_of_a_folder_with_any_names(tmp_path: Path) -> None:
    """The overview and the errata name files that have no name in any encoding."""
    folder = tmp_path / "all"
    folder.mkdir()
    for name in NAMES:
        (folder / os.fsdecode(name)).write_text(files.CRANK, encoding="utf-8")
    code, _, err = run(folder, "tables", b".")
    assert b"...yaml: a folder for its tables would be .." in err
    assert code == 2
    assert [path.name for path in tmp_path.iterdir()] == ["all"]
    (folder / "...yaml").unlink()
    code, _, err = run(folder, "tables", b".")
    assert code == 0
    assert b"internal error" not in err
    page = (folder / "README.md").read_text(encoding="utf-8")
    assert "](bytes%20%FF%FE.yaml)" in page
    assert "<b>" not in page


def test_random_names(tmp_path: Path) -> None:
    rng = random.Random(0)
    for _ in range(4 * int(os.environ.get("MECHKIN_RANDOM", "1"))):
        letters = [byte for byte in range(1, 256) if byte != ord("/")]
        name = bytes(rng.choices(letters, k=rng.randrange(1, 40))) + b".yaml"
        (tmp_path / os.fsdecode(name)).write_text(files.CRANK, encoding="utf-8")
        code, found, err = run(tmp_path, "check", name, rng.choice(ENCODINGS))
        assert (code, err) == (0, b"")
        assert len(names_in(found)) == 1
