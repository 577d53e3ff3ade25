"""A mechanism file, read and checked, with the places of its values; and the CSV files it names."""

from __future__ import annotations

import gc
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

from mechkin_cli import reading, schema
from mechkin_cli.building.fields import read_units
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.expressions import evaluate_parameters, literal
from mechkin_cli.reading import (
    MOST_BYTES,
    Document,
    NotRegular,
    document_from_text,
    read_document,
    read_regular,
)
from mechkin_cli.record import replace
from mechkin_cli.schema import InvalidDataError, MechanismFile, UnitsSection, validate

_NONE: Mapping[str, str] = MappingProxyType({})
_NO_TABLES: Mapping[str, bytes] = MappingProxyType({})


@contextmanager
def without_collection() -> Iterator[None]:
    """No search for garbage: what a file is made into lives on, and to look through it again and
    again takes a third of the time of a machine of a thousand loops. What is much is looked through
    once, and counts as old from then on."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            young, middle, _ = gc.get_threshold()
            if gc.get_count()[0] > young * middle > 0:
                gc.collect(1)
            gc.enable()


@without_collection()
def open_file(
    path: str | Path, parameters: Mapping[str, str] = _NONE
) -> tuple[MechanismFile, Document]:
    """The content of a mechanism file, in space if it is of a plane, and the document with the
    place of each value; `parameters` replace values of its `parameters:`, as `--set` does.

    Raises `UsageError` for a file that cannot be read or an unknown parameter, `InvalidFile` with
    all independent diagnostics for content that is not format 1.
    """
    return _checked(read_document(path).with_parameters(parameters))


@without_collection()
def open_text(
    text: str,
    name: str,
    parameters: Mapping[str, str] = _NONE,
    folder: Path | None = None,
    tables: Mapping[str, bytes] = _NO_TABLES,
) -> tuple[MechanismFile, Document]:
    """As `open_file`, for a text; `name` stands for the file in messages, `folder` has the files
    that the text names; `tables` are contents of such files that were read already."""
    document = replace(document_from_text(text, name), folder=folder, tables=dict(tables))
    return _checked(document.with_parameters(parameters))


@without_collection()
def open_data(
    data: Mapping[Any, Any],
    name: str,
    parameters: Mapping[str, str] = _NONE,
    folder: Path | None = None,
    tables: Mapping[str, bytes] = _NO_TABLES,
) -> tuple[MechanismFile, Document]:
    """As `open_text`, for the plain data of a program; places are paths of keys."""
    document = replace(reading.document_from_data(data, name, folder), tables=dict(tables))
    return _checked(document.with_parameters(parameters))


def _checked(document: Document) -> tuple[MechanismFile, Document]:
    if schema.OLD_KEYS:
        document = schema.up_to_date(schema.form_of(document.data), document)
    try:
        file = validate(document.data)
    except InvalidDataError as invalid:
        diagnostics = reading.is_study(document) or reading.explain(invalid.errors, document)
        raise InvalidFile([*document.notes, *diagnostics]) from None
    with_units = _with_units(document, file.units)
    if with_units != document.overrides:
        return _checked(replace(document, overrides=with_units))
    if isinstance(file, MechanismFile):
        return file, document
    return schema.in_space(file), document


def _with_units(document: Document, section: UnitsSection) -> dict[str, str]:
    """The parameters set from outside: a bare number is in the file's unit of the parameter."""
    overrides = dict(document.overrides)
    bare = [name for name, text in overrides.items() if literal(text) is not None]
    if not bare:
        return overrides
    units, _ = read_units(document, section)
    written = replace(document, overrides={}).data["parameters"]
    assert isinstance(written, dict)
    own = {name: str(text) for name, text in written.items()}
    originals = evaluate_parameters(own, units, [])
    for name in bare:
        if name in originals and (unit := units.label(originals[name].dimension)):
            overrides[name] = f"{overrides[name].strip()} {unit}"
    return overrides


class BadTable(Exception):
    """An error in a CSV file; `line` and `column` count from 1, line 0 is the whole file."""

    def __init__(self, line: int, column: int, message: str, hint: str) -> None:
        super().__init__(message)
        self.line, self.column, self.message, self.hint = line, column, message, hint


def table_path(document: Document, name: str) -> Path:
    """The path of a file that a document names."""
    return Path(name) if document.folder is None else document.folder / name


def table_text(document: Document, name: str, most: int = MOST_BYTES) -> str:
    """The text of a file that a document names, of at most `most` bytes, as it was first read.

    Raises:
        BadTable: it cannot be read.
    """
    if name not in document.tables:
        document.tables[name] = _content(table_path(document, name), most)
    content = document.tables[name]
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        text = f"the byte 0x{content[error.start]:02X} is not UTF-8 text"
        raise BadTable(line, 1, text, "save the file as UTF-8") from None


def _content(file: Path, most: int) -> bytes:
    try:
        content = read_regular(file, most)
    except NotRegular:
        raise BadTable(0, 0, "is not a regular file", "name a CSV file") from None
    except FileNotFoundError:
        hint = "the path leads from the folder of the file that names it"
        raise BadTable(0, 0, "does not exist", hint) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise BadTable(0, 0, f"cannot be read: {reason}", "check its rights") from None
    if len(content) > most:
        text = f"is too large for a table: more than {most >> 20} MiB (limit {most} bytes)"
        raise BadTable(0, 0, text, "keep fewer rows: the curve between them is smooth")
    return content
