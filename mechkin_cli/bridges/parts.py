"""What a bridge gives back, and the messages that all of them share."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final, NoReturn

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place, UsageError
from mechkin_cli.reading import NotRegular, decoded, read_regular
from mechkin_cli.record import NamedTuple

MOST_BYTES: Final = 1 << 20
"""Size of a file that is imported: as of a mechanism file, which it becomes."""

NUMBER: Final = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
"""A number as tables and robot files have it."""

MOST_NAMED: Final = 12
"""Names that a message lists before it counts the others."""


class Imported(NamedTuple):
    """The text of a mechanism file, and what a person should know of how it was made."""

    text: str
    notes: tuple[Diagnostic, ...] = ()


class Exported(NamedTuple):
    """The files of an export by their names below the folder, and what was left out of them."""

    files: Mapping[str, bytes]
    notes: tuple[Diagnostic, ...] = ()


class ImportOptions(NamedTuple):
    """What the command line says of an import: the text and the name of the template that takes
    hard points, their unit, and points that the template calls otherwise; pairs of links of a
    robot that close loops."""

    template: str | None = None
    template_name: str = ""
    unit: str | None = None
    renamed: Mapping[str, str] | None = None
    closed: tuple[str, ...] = ()


class ExportOptions(NamedTuple):
    """What the command line says of an export: the run (`sweep` or a response; None: the first),
    the assembly mode (None: the file's), and rows by number from 1 (none: all, or the first)."""

    run: str | None = None
    mode: str | None = None
    rows: tuple[int, ...] = ()


def text_of(path: Path) -> str:
    """The text of a file that is imported, in UTF-8.

    Raises:
        UsageError: there is no file to read.
        InvalidFile: it is too large, or not text.
    """
    try:
        content = read_regular(path, MOST_BYTES)
    except NotRegular as error:
        raise UsageError(f"{path} is no file; name the file to import") from error
    except FileNotFoundError:
        raise UsageError(f"there is no file {path}; check its name, and the folder") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{path} cannot be read: {reason}; make it readable") from None
    return decoded(content, str(path), is_yaml=False)


def refuse(
    code: str, message: str, place: Place, hint: str, measured: str | None = None
) -> NoReturn:
    """Raises `InvalidFile` with one diagnostic."""
    raise InvalidFile([Diagnostic(code, "error", message, place, measured=measured, hint=hint)])


def listed(names: Iterable[str]) -> str:
    """Names in a message; of many the first, and how many more there are."""
    known = list(names)
    if len(known) <= MOST_NAMED:
        return ", ".join(known)
    return f"{', '.join(known[:MOST_NAMED])} and {len(known) - MOST_NAMED} more"


def number_text(value: float) -> str:
    """A number as a mechanism file holds it: its shortest decimals.

    >>> number_text(700.0), number_text(0.1), number_text(-0.0)
    ('700', '0.1', '0')
    """
    text = repr(float(value) + 0.0)
    return text.removesuffix(".0")
