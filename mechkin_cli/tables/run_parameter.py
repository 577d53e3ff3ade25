"""What a run goes along: time where it has one, else its first input that moves."""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.tables.source import FloatArray, Source


class RunParameter(NamedTuple):
    """Its name, its values (rows,) in the file's units, and their unit."""

    name: str
    values: FloatArray
    unit: str


def run_parameter(source: Source) -> RunParameter | None:
    """The parameter of a run; None where nothing moves."""
    for name, values in source.inputs.items():
        if bool((values != values[0]).any()):
            unit = source.units.label(source.quantity(name).dimension)
            return RunParameter(name, values, unit)
    return None
