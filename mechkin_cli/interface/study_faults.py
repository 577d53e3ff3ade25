"""What is wrong with a study file, collected place by place; and its values of quantities."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.interface.given import one_value
from mechkin_cli.reading.parser import in_order

if TYPE_CHECKING:
    from mechkin_cli.reading.document import Document, KeyPath
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
    found = float(np.asarray(units.from_si(in_si, dimension)))
    for digits in DIGITS:
        rounded = float(f"{found:.{digits}g}")
        if float(np.asarray(units.to_si(rounded, dimension))) == in_si:
            return rounded
    return found


def split(error: UsageError) -> tuple[str, str]:
    """What is wrong, and what to do."""
    message, mark, hint = str(error).rpartition("; ")
    return (message, hint) if mark else (hint, "write another value")
