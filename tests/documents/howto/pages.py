"""The how-to pages as what their reader does: files saved, commands, and what these print.

A block of YAML or CSV is the file that the text before it links, whole or in part, without the line
for editors; or, where that is no file of the repository, one that the reader writes. A block of
`sh` is run, and the block of `text` behind it is what it prints.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from unittest import mock

from documents.reading import ROOT

from mechkin_cli.__main__ import main

FOLDER = ROOT / "docs" / "howto"
PAGES = sorted(FOLDER.glob("*.md"))
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_NAMED = re.compile(r"\[`[\w./]+`\]\(([^)]+\.(?:yaml|csv))\)|`([\w/]+\.(?:yaml|csv|sh))`")
WHOLE = ("format:", "study:")
"""How a block begins that shows a whole file."""
_FOR_EDITORS = "# yaml-language-server:"


class Block(NamedTuple):
    """A block of a page; `file` is the file of the repository that it shows, `name` what the reader
    calls the file that he writes."""

    language: str
    text: str
    file: Path | None = None
    name: str = ""


def blocks(page: str) -> list[Block]:
    """The blocks of a page's text, in order."""
    found = []
    last = 0
    file, name = None, ""
    for match in FENCE.finditer(page):
        for link, own in _NAMED.findall(page[last : match.start()]):
            place = (FOLDER / link).resolve() if link else None
            file, name = (place, "") if place and place.is_file() else (None, own)
        last = match.end()
        is_file = match[1] in ("yaml", "csv")
        found.append(Block(match[1], match[2], file if is_file else None, name))
    return found


def content(file: Path) -> str:
    """A file of the repository without the line for editors."""
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    return "".join(line for line in lines if not line.startswith(_FOR_EDITORS))


def saved(page: str, folder: Path) -> None:
    """Puts all files into a folder that the page links or has its reader write, as he would."""
    for link, _ in _NAMED.findall(page):
        place = (FOLDER / link).resolve() if link else None
        if place is not None and place.is_file():
            target = folder / _place_of(place)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(place, target)
    for block in blocks(page):
        if block.language in ("yaml", "csv") and block.file is None:
            (folder / block.name).write_text(block.text, encoding="utf-8")


def _place_of(file: Path) -> Path:
    """Where the reader saves a file: beside the others, but for those that lie in a folder of
    theirs."""
    parts = file.relative_to(ROOT / "mechanisms").parts
    return Path(*parts[1:])


def printed(commands: str) -> str:
    """What commands, one a line, print on both streams; `mechkin` runs in this process, in the
    working folder.

    Raises:
        AssertionError: a command failed.
    """
    said = io.StringIO()
    for line in commands.splitlines():
        words = shlex.split(line)
        if words[0] == "cat":
            said.write(Path(words[1]).read_text(encoding="utf-8"))
            continue
        assert words[0] == "mechkin", line
        with (
            mock.patch.object(sys, "argv", words),
            mock.patch.dict(os.environ, {"COLUMNS": "100"}),
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
        ):
            code = _exit_code()
        assert code == 0, f"{line}: exit code {code}\n{said.getvalue()}"
    return "".join(f"{line.rstrip()}\n" for line in said.getvalue().splitlines())


def _exit_code() -> int:
    try:
        main()
    except SystemExit as ended:
        return int(ended.code or 0)
    return 0


def done(page: str) -> Iterator[tuple[Block, str, str]]:
    """Each block of commands, what the page shows of what it prints, and what it prints; files are
    in the working folder."""
    found = blocks(page)
    for block, below in zip(found, [*found[1:], Block("", "")], strict=True):
        if block.language == "sh":
            yield block, below.text if below.language == "text" else "", printed(block.text)
