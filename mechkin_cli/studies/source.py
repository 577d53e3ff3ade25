"""A study, read and checked: from its file, or from the data of a program; and its faults."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from mechkin_cli import reading
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.reading import Document, KeyPath, in_order, read_document
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import OLD_KEYS, InvalidDataError, StudyFile, up_to_date, validate_study
from mechkin_cli.variants import one_value, with_parameters

if TYPE_CHECKING:
    from mechkin_cli.analysis import Solvable
    from mechkin_cli.reading import KeyPath
    from mechkin_cli.units import Dimension, UnitSystem


DIGITS = (15, 16)
"""Significant digits of a decimal number that may be the one that was written."""


class Faults:
    """Diagnostics of a study file."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.diagnostics: list[Diagnostic] = []

    def error(self, code: str, path: KeyPath, text: str, hint: str, at_key: bool = False) -> None:
        """Something is wrong with the value at a path, or with its key."""
        place = self.document.key_place(path) if at_key else self.document.place(path)
        self.diagnostics.append(Diagnostic(code, "error", text, place, hint=hint))

    def note(self, code: str, path: KeyPath, text: str, hint: str) -> None:
        """Something to know of the value at a path."""
        place = self.document.place(path)
        self.diagnostics.append(Diagnostic(code, "note", text, place, hint=hint))

    @property
    def are_errors(self) -> bool:
        """Whether anything is wrong."""
        return any(found.severity == "error" for found in self.diagnostics)

    def notes(self) -> tuple[Diagnostic, ...]:
        """What is to know, where nothing is wrong.

        Raises:
            InvalidFile: with every independent error.
        """
        if self.are_errors:
            raise InvalidFile(in_order(self.diagnostics))
        return tuple(self.diagnostics)

    def value(
        self, path: KeyPath, name: str, text: str, dimension: Dimension, units: UnitSystem
    ) -> float | None:
        """The value of a quantity in the file's units; None where the text says none."""
        try:
            return in_file_units(name, text, dimension, units)
        except UsageError as error:
            self.error("bad-value", path, *split(error))
            return None


def in_file_units(name: str, text: str, dimension: Dimension, units: UnitSystem) -> float:
    """A value in the file's units, as short as it can be written: 0.48 for `0.48 in`.

    Raises:
        UsageError: the text says none.
    """
    in_si = one_value(name, text, dimension, units)
    value = float(np.asarray(units.from_si(in_si, dimension)))
    for digits in DIGITS:
        rounded = float(f"{value:.{digits}g}")
        if float(np.asarray(units.to_si(rounded, dimension))) == in_si:
            return rounded
    return value


def split(error: UsageError) -> tuple[str, str]:
    """What is wrong, and what to do."""
    message, mark, hint = str(error).rpartition("; ")
    return (message, hint) if mark else (hint, "write another value")


DATA = "study"
"""What messages call the dict that a caller gives."""

_OUTSIDE = "--set "
"""In front of parameters from outside the mechanism, in messages about them."""


class StudySource(NamedTuple):
    """A study as written, and the document that knows the place of each value."""

    file: StudyFile
    document: Document

    @property
    def name(self) -> str:
        """The study's name, or that of its file."""
        return self.file.name or Path(self.document.file).stem

    def load_model(
        self, parameters: Mapping[str, str], load: Callable[[Path, Mapping[str, str]], Solvable]
    ) -> Solvable:
        """The mechanism that the study names, loaded with the values of `set:` and these.

        Raises:
            UsageError: its file cannot be read, or an unknown parameter.
            InvalidFile: the study names none, or the mechanism is wrong.
        """
        if self.file.mechanism is None:
            self._refuse("missing-key", (), "the study names no mechanism", "add mechanism: FILE")
        folder = self.document.folder or Path()
        try:
            return load(folder / str(self.file.mechanism), {**self.file.set, **parameters})
        except UsageError as error:
            text, _, hint = str(error).partition("; ")
            named, _, own = text.removeprefix(_OUTSIDE).partition(": ")
            if not text.startswith(_OUTSIDE):
                hint = hint or "write a path from the study's folder"
                self._refuse("mechanism", ("mechanism",), text, hint)
            if named in parameters:
                raise
            self._refuse("bad-value", ("set", named), own, hint or "remove it from set:")
        except InvalidFile as error:
            raise InvalidFile([self._at_home(d, parameters) for d in error.diagnostics]) from None

    def applied_to(self, model: Solvable) -> Solvable:
        """A model of Python's with the values of `set:`.

        Raises:
            InvalidFile: one of them is no parameter, or no value of it.
        """
        for name, value in self.file.set.items():
            try:
                model = with_parameters(model, {name: value})
            except UsageError as error:
                self._refuse("bad-value", ("set", name), *split(error))
        return model

    def _at_home(self, found: Diagnostic, parameters: Mapping[str, str]) -> Diagnostic:
        """A message on a value of `set:`, at its place in the study."""
        place = found.place
        if place is None or place.in_file or not place.file.startswith(_OUTSIDE):
            return found
        name = place.file.removeprefix(_OUTSIDE)
        if name in parameters or name not in self.file.set:
            return found
        return found._replace(place=self.document.place_in(("set", name), place.column - 1))

    def _refuse(self, code: str, path: KeyPath, text: str, hint: str) -> NoReturn:
        place = self.document.place(path)
        raise InvalidFile([Diagnostic(code, "error", text, place, hint=hint)])


def open_study(study: str | Path | Mapping[str, Any]) -> StudySource:
    """The study in a file, or in the sections that a dict has.

    Raises:
        UsageError: the file cannot be read.
        InvalidFile: with every independent error and its place.
    """
    if isinstance(study, Mapping):
        document = reading.document_from_data({"study": 1, **study}, DATA, None)
    else:
        document = read_document(study)
    if OLD_KEYS:
        document = up_to_date(StudyFile, document)
        if any(note.severity == "error" for note in document.notes):
            raise InvalidFile(list(document.notes))
    try:
        return StudySource(validate_study(document.data), document)
    except InvalidDataError as invalid:
        errors = reading.is_mechanism(document) or reading.explain(invalid.errors, document)
        raise InvalidFile([*document.notes, *errors]) from None
