"""A mechanism file, read and checked: what was meant, and where it was written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.reading.document import Document, document_from_text, read_document
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.schema.validate import InvalidDataError, validate

_NONE: Mapping[str, str] = MappingProxyType({})
_NO_TABLES: Mapping[str, bytes] = MappingProxyType({})


class Source(NamedTuple):
    """The content of a mechanism file, of one in a plane as in space, and the document that knows
    the place of each value."""

    file: MechanismFile
    document: Document


def open_file(path: str | Path, parameters: Mapping[str, str] = _NONE) -> Source:
    """Read a mechanism file; `parameters` replace values of its `parameters:`, as `--set` does.

    Raises `UsageError` for a file that cannot be read or an unknown parameter, `InvalidFile` with
    all independent diagnostics for content that is not format 1.
    """
    return _checked(read_document(path).with_parameters(parameters))


def open_text(
    text: str,
    name: str,
    parameters: Mapping[str, str] = _NONE,
    folder: Path | None = None,
    tables: Mapping[str, bytes] = _NO_TABLES,
) -> Source:
    """As `open_file`, for a text; `name` stands for the file in messages, in `folder` are the files
    that the text names; `tables` are contents of such files that are known already."""
    document = replace(document_from_text(text, name), folder=folder, tables=dict(tables))
    return _checked(document.with_parameters(parameters))


def open_data(
    data: Mapping[Any, Any],
    name: str,
    parameters: Mapping[str, str] = _NONE,
    folder: Path | None = None,
    tables: Mapping[str, bytes] = _NO_TABLES,
) -> Source:
    """As `open_text`, for the plain data of a program; places are ways of keys."""
    from mechkin_cli.reading.from_data import document_from_data

    document = replace(document_from_data(data, name, folder), tables=dict(tables))
    return _checked(document.with_parameters(parameters))


def _checked(document: Document) -> Source:
    try:
        file = validate(document.data)
    except InvalidDataError as invalid:
        from mechkin_cli.reading.explain import explain, is_study  # only on the way to messages

        raise InvalidFile(is_study(document) or explain(invalid.errors, document)) from None
    if isinstance(file, MechanismFile):
        return Source(file, document)
    from mechkin_cli.building.plane import in_space  # only for files in a plane

    return Source(in_space(file), document)
