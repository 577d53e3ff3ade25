"""Which format is read and written where: one table for each direction."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from itertools import combinations, islice
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mechkin_cli.bridges.hard_points import with_hard_points
from mechkin_cli.bridges.parts import (
    Exported,
    ExportOptions,
    Imported,
    ImportOptions,
    listed,
    refuse,
    text_of,
)
from mechkin_cli.diagnostics import MechkinError, UsageError, nearest_hint

if TYPE_CHECKING:
    from mechkin_cli.model import Model


MOST_COORDINATES: Final = 60
"""Of a mechanism with loops whose inputs are chosen; of a larger one the mobility takes long."""

MOST_TRIES: Final = 20
"""Choices of inputs that are tried."""

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
    if ending in (".xml", ".mjcf", ".urdf"):
        return imported_robot(text, str(path), options.closed)
    raise UsageError(
        f"{path}: {ending or 'a file without ending'} is no format that is imported; a table of "
        "hard points ends in .csv, a robot in .urdf, a model of MuJoCo in .xml"
    )


def imported_robot(text: str, file: str, closed: tuple[str, ...] = ()) -> Imported:
    """The mechanism file of a text in MJCF or URDF, as its first element tells.

    Args:
        text: the robot file.
        file: its name in messages.
        closed: pairs of links of a URDF between which loops are closed (`read_urdf`).

    Raises:
        InvalidFile: with the place of what is wrong, or has no counterpart.
        UsageError: pairs that are none, or of an MJCF, which closes its loops itself.
    """
    from mechkin_cli.bridges.bodies import mechanism_text
    from mechkin_cli.bridges.markup import read_markup

    root = read_markup(text, file)
    if root.tag == "robot":
        from mechkin_cli.bridges.urdf import read_urdf

        robot = read_urdf(root, file, closed)
    elif root.tag != "mujoco":
        hint = "MJCF begins with <mujoco>, URDF with <robot>"
        refuse("unknown-format", f"<{root.tag[:40]}> is no robot", root.at, hint)
    elif closed:
        raise UsageError("--close is for URDF; MJCF closes loops by <equality>: write it there")
    else:
        from mechkin_cli.bridges.mjcf_import import read_mjcf

        robot = read_mjcf(root, file)
    if not robot.bodies:
        what = "joint and a second link" if root.tag == "robot" else "body with a joint"
        refuse("no-bodies", f"<{root.tag}> has nothing that moves", root.at, f"add a {what}")
    return mechanism_text(robot, driven)


def driven(free: list[str], text_of_inputs: Callable[[list[str]], str]) -> list[str]:
    """The first coordinates that drive a mechanism with loops, as many as it has freedoms; none
    where few tries find none, or it is not movable.

    Args:
        free: the coordinates to choose from.
        text_of_inputs: makes the mechanism file in which some of them are driven.
    """
    from mechkin_cli.model import loads

    if len(free) > MOST_COORDINATES:
        return []
    try:
        mobility = loads(text_of_inputs([])).mobility()
        # bodies that float are driven already
        count = max((mobility.useful or 0) - len(mobility.inputs), 0) or mobility.useful or 0
        for chosen in islice(combinations(free, count), MOST_TRIES):
            try:
                if loads(text_of_inputs(list(chosen))).analyze().complete:
                    return list(chosen)
            except MechkinError:
                continue
    except MechkinError:
        pass
    return []


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
