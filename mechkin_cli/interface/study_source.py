"""A study, read and checked: from its file, or from the data of a program."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.reading.document import Document, read_document
from mechkin_cli.schema.validate import InvalidDataError, validate_study

if TYPE_CHECKING:
    from mechkin_cli.interface.model import Model
    from mechkin_cli.schema.study import StudyFile

DATA = "study"
"""What messages call the dict that a caller gives."""


class StudySource(NamedTuple):
    """A study as written, and the document that knows the place of each value."""

    file: StudyFile
    document: Document

    @property
    def name(self) -> str:
        """The study's name, or that of its file."""
        return self.file.name or Path(self.document.file).stem

    def model(self, parameters: Mapping[str, str]) -> Model:
        """The mechanism that the study names, with the values of `set:` and these.

        Raises:
            UsageError: its file cannot be read, or an unknown parameter.
            InvalidFile: the study names none, or the mechanism is wrong.
        """
        from mechkin_cli.interface import load

        if self.file.mechanism is None:
            self._refuse("missing-key", (), "the study names no mechanism", "add mechanism: FILE")
        folder = self.document.folder or Path()
        try:
            return load(folder / str(self.file.mechanism), {**self.file.set, **parameters})
        except UsageError as error:
            text, _, hint = str(error).partition("; ")
            at = ("mechanism",) if "--set" not in text else ("set",)
            self._refuse("mechanism", at, text, hint or "write a path from the study's folder")

    def _refuse(self, code: str, path: tuple[str, ...], text: str, hint: str) -> NoReturn:
        place = self.document.place(path)
        raise InvalidFile([Diagnostic(code, "error", text, place, hint=hint)])


def open_study(given: str | Path | Mapping[str, Any]) -> StudySource:
    """The study in a file, or in the sections that a dict has.

    Raises:
        UsageError: the file cannot be read.
        InvalidFile: with every independent error and its place.
    """
    if isinstance(given, Mapping):
        from mechkin_cli.reading.from_data import document_from_data

        document = document_from_data({"study": 1, **given}, DATA, None)
    else:
        document = read_document(given)
    try:
        return StudySource(validate_study(document.data), document)
    except InvalidDataError as invalid:
        from mechkin_cli.reading.explain import explain  # only on the way to messages

        raise InvalidFile(explain(invalid.errors, document)) from None
