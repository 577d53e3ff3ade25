"""The units section to the file's unit system, and what is to be said of it."""

from __future__ import annotations

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.reading.document import Document
from mechkin_cli.schema.units_section import UnitsSection
from mechkin_cli.units import FORCE, MOMENT, UnitError, UnitSystem
from mechkin_cli.units.system import FIELDS


def read_units(document: Document, section: UnitsSection) -> tuple[UnitSystem, list[Diagnostic]]:
    """The file's unit system, and what is wrong with it."""
    try:
        return UnitSystem.from_mapping({name: getattr(section, name) for name in FIELDS}), []
    except UnitError as error:
        path: Path = ("units", error.key) if error.key else ("units",)
        place = document.place_in(path, error.offset)
        return UnitSystem(), [Diagnostic("unit", "error", error.message, place, hint=error.hint)]


def note_force_unit(fields: Fields) -> None:
    """Says in which unit forces are, where the file leaves it out and its mass, length and time
    would make another."""
    document, units = fields.document, fields.units
    named = document.node(("units", "force")) is not None
    if fields.error_count or named or document.node(("units",)) is None:
        return
    coherent = units.mass * units.length * units.time**-2
    if coherent.factor == units.force.factor:
        return
    forces, moments = units.label(FORCE), units.label(MOMENT)
    fields.note(
        Diagnostic(
            "force-unit",
            "note",
            f"units: names no force, so forces are in {forces} and moments in {moments}",
            document.key_place(("units",)),
            hint=f"write force: {forces} to say so, or another, such as force: {coherent}",
        )
    )
