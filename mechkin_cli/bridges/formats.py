"""Which format is read and written where: one table for each direction."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mechkin_cli.bridges.hard_points import with_hard_points
from mechkin_cli.bridges.parts import Exported, Imported, listed, text_of
from mechkin_cli.diagnostics import UsageError, nearest_hint
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.model import Model


class ImportOptions(NamedTuple):
    """What the command line says of an import: the text and the name of the template that takes
    hard points, their unit, and points that the template calls otherwise."""

    template: str | None = None
    template_name: str = ""
    unit: str | None = None
    renamed: Mapping[str, str] | None = None


class ExportOptions(NamedTuple):
    """What the command line says of an export: the run (`sweep` or a response; None: the first),
    the assembly mode (None: the file's), and rows by number from 1 (none: all, or the first)."""

    run: str | None = None
    mode: str | None = None
    rows: tuple[int, ...] = ()


Export = Callable[["Model", ExportOptions], Exported]
"""Gives the files of a model; raises `UsageError` with words for what cannot be exported."""

EXPORTS: Final[Mapping[str, str]] = {
    "mjcf": "mjcf_export",
    "gltf": "gltf_export",
    "dxf": "dxf_export",
    "loads": "load_cases",
    "parquet": "parquet_export",
}
"""By the name of a format the chapter of this room whose function `export` writes it."""


def imported(path: Path, options: ImportOptions) -> Imported:
    """The mechanism file that a file of another program becomes.

    Raises:
        UsageError: it cannot be read, is of no known format, or an option does not fit.
        InvalidFile: with every fault and its place.
    """
    ending = path.suffix.casefold()
    text = text_of(path)
    if ending in (".csv", ".tsv", ".txt"):
        if options.template is None:
            raise UsageError(
                f"{path} is a table of hard points; name the file that takes them, as "
                "--template suspension, or a mechanism file of your own"
            )
        return with_hard_points(
            text,
            str(path),
            options.template,
            options.template_name,
            options.unit,
            options.renamed,
        )
    raise UsageError(
        f"{path}: {ending or 'a file without ending'} is no format that is imported; a table of "
        "hard points ends in .csv"
    )


def exported(model: Model, format_: str, options: ExportOptions) -> Exported:
    """The files of a model in a format.

    Raises:
        UsageError: there is no such format, or the model cannot be written in it.
    """
    if format_ not in EXPORTS:
        hint = nearest_hint(format_, EXPORTS) or f"formats are {listed(EXPORTS)}"
        raise UsageError(f"--to {format_[:40]}: there is no such format; {hint}")
    export: Export = import_module(f"mechkin_cli.bridges.{EXPORTS[format_]}").export
    return export(model, options)
