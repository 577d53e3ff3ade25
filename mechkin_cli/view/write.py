"""`Model.view` and `Analysis.view`: a page that shows runs of a mechanism, and in which other
assembly modes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli.arguments import a_path
from mechkin_cli.assembly import HOME, NEAR
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.modes import UNNAMED
from mechkin_cli.sweep import refuse_loaded_spin
from mechkin_cli.tables import write_files
from mechkin_cli.verdict import SWEEP, version
from mechkin_cli.view.arrows import has_forces, reactions
from mechkin_cli.view.page import MOST_MODE_ROWS, MOST_MODES, filled, shares, template
from mechkin_cli.view.scene import Scene
from mechkin_cli.view.shown import ShownAnalysis, ShownBranch, ShownRun

if TYPE_CHECKING:
    from os import PathLike

    from mechkin_cli.tables import Columns


_OWN_NAMES = {HOME: "as drawn", NEAR: "as chosen"}
"""What the file's own branch is called where its letter is not known."""


def write_view(path: str | PathLike[str], page: bytes) -> Path:
    """Writes a page whole or not at all; its path.

    Raises:
        UsageError: it cannot be written there.
    """
    target = a_path("path", path, 'the path of a page such as "page.html"')
    if not target.name:
        raise UsageError(f"{path} names no file; write a name such as page.html")
    return write_files(target.parent, {target.name: page})[0]


def view_page(
    analyses: Sequence[ShownAnalysis], modes: bool = True
) -> tuple[bytes, list[Diagnostic]]:
    """The page of runs of one model, and the notes on what it leaves out."""
    scene, notes = view_scene(analyses, modes)
    return filled(template(), scene.record()), notes


def view_scene(
    analyses: Sequence[ShownAnalysis], modes: bool = True
) -> tuple[Scene, list[Diagnostic]]:
    """What a page of runs of one model shows, and the notes on what it leaves out, which are among
    its own; `modes`: with the other ways of assembling."""
    model = analyses[0].model
    notes: list[Diagnostic] = []
    runs = tuple(_shown(analysis, modes, notes) for analysis in analyses)
    said = [note for analysis in analyses for note in analysis.diagnostics]
    notes += _left_out(runs)
    scene = Scene(
        f"mechkin {version()}",
        Path(model.built.read.document.file).name,
        model.problem,
        runs,
        tuple(dict.fromkeys([*said, *notes])),
        model.view_settings,
    )
    return scene, notes


def _shown(analysis: ShownAnalysis, modes: bool, notes: list[Diagnostic]) -> ShownRun:
    model, run = analysis.model, analysis.run
    forces = _may_read_forces(analysis, notes)
    own = analysis.result.letter if modes else analysis.result.mode
    others = list(_other_modes(analysis, own, notes)) if modes else []
    branches = [ShownBranch(_OWN_NAMES.get(own, f"mode {own}"), analysis, forces)]
    branches += [ShownBranch(f"mode {letter}", one, forces) for letter, one in others]
    title = f"sweep of {model.name}" if run == SWEEP else f"response {run}"
    return ShownRun(run, title, tuple(branches), _other_tables(analysis, notes))


def _may_read_forces(analysis: ShownAnalysis, notes: list[Diagnostic]) -> bool:
    """Whether reactions are there to be shown; a note says why not."""
    result = analysis.result
    if not has_forces(result.problem.mechanism) or not result.solved.any():
        return False
    try:
        refuse_loaded_spin(result.session, reactions(result.problem))
    except UsageError as error:
        text = "no forces are shown: what spins freely has a cause to spin"
        notes.append(Diagnostic("view-without-forces", "note", text, measured=str(error)))
        return False
    return True


def _other_modes(
    analysis: ShownAnalysis, own: str, notes: list[Diagnostic]
) -> Iterator[tuple[str, ShownAnalysis]]:
    """The same run in the assembly modes that are not its `own`, as far as a page holds them."""
    model, run = analysis.model, analysis.run
    found = model.modes(run=run)
    taken = (UNNAMED, found.picked if own in _OWN_NAMES else own)
    letters = [one.name for one in found.modes if one.name not in taken]
    most = min(MOST_MODES, MOST_MODE_ROWS // max(analysis.rows, 1))
    if letters[most:]:
        notes.append(
            Diagnostic(
                "view-modes-left-out",
                "note",
                f"{run}: other assembly modes are not shown: {', '.join(letters[most:])}",
                measured=f"{len(letters)} of {analysis.rows} rows",
                limit=f"{MOST_MODES} modes of {MOST_MODE_ROWS} rows together",
                hint="mechkin view --mode NAME shows one of them",
            )
        )
    tables = [layout.name for layout in analysis.layouts]
    for letter in letters[:most]:
        try:
            if run == SWEEP:
                yield letter, model.analyze(tables=tables, mode=letter)
            else:
                yield letter, model.respond(run, tables=tables, mode=letter)
        except UsageError as error:
            text = f"{run}: mode {letter} is not shown: {error}"
            notes.append(Diagnostic("view-modes-left-out", "note", text))


def _other_tables(analysis: ShownAnalysis, notes: list[Diagnostic]) -> tuple[Columns, ...]:
    """The tables of dense systems and of balances."""
    try:
        return (*analysis.coefficients, *analysis.balance_tables)
    except UsageError as error:
        notes.append(Diagnostic("view-tables-left-out", "note", f"no dense system: {error}"))
        return analysis.balance_tables


def _left_out(runs: Sequence[ShownRun]) -> Iterator[Diagnostic]:
    """Notes on runs of which not all rows are shown."""
    for run in runs:
        rows, own = run.branches[0].analysis.rows, shares(run)[0]
        if rows > min(own):
            yield Diagnostic(
                "view-thinned",
                "note",
                f"{run.name}: the page shows some of the rows, in even steps",
                measured=f"{rows} rows",
                limit=f"{own.rows} in curves and tables, {own.poses} poses, fewer of other modes",
                hint="the files that mechkin analyze writes have all rows",
            )
