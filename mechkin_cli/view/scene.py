"""A page that shows runs of a mechanism, and in which other assembly modes: its data, and the way
from a model to the file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.arguments import a_path
from mechkin_cli.assembly import HOME, NEAR
from mechkin_cli.building import ViewSettings
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.mechanism import GROUND_NAME, diagonal, is_written
from mechkin_cli.modes import UNNAMED
from mechkin_cli.record import dataclass, field
from mechkin_cli.sweep import refuse_loaded_spin
from mechkin_cli.tables import write_files
from mechkin_cli.units import ANGLE, FORCE, LENGTH, MOMENT
from mechkin_cli.verdict import SWEEP, __version__
from mechkin_cli.view.arrows import has_forces, reactions, tie_records
from mechkin_cli.view.branch import BranchScene, table_record
from mechkin_cli.view.cams import DrawnCam, drawn_cams
from mechkin_cli.view.joints import (
    carried,
    drawn_joints,
    joint_records,
    link_shape,
    plane_of_motion,
    sliding_coordinate,
    upwards,
)
from mechkin_cli.view.page import (
    MOST_MODE_ROWS,
    MOST_MODES,
    Lengths,
    ShownAnalysis,
    ShownRun,
    assumed,
    filled,
    script_json,
    shares,
    template,
)

if TYPE_CHECKING:
    from os import PathLike

    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Floats
    from mechkin_cli.tables import Columns
    from mechkin_cli.view.page import Plain


FORMAT = 1
"""Version of the data that pages read."""

_Z = 2

RACK_ENDS = 1.2
"""What a rack reaches beyond the places where its pinion is, in parts of the pinion's radius."""


@dataclass(frozen=True)
class Scene:
    """What a page shows.

    Attributes:
        program: name and version of what wrote it.
        file: name of the mechanism file.
        problem: the mechanism; poses are those of the runs.
        runs: in the order of the file.
        notes: all messages on the file and its runs.
        settings: the `view:` section.
    """

    program: str
    file: str
    problem: Problem
    runs: tuple[ShownRun, ...]
    notes: tuple[Diagnostic, ...] = ()
    settings: ViewSettings = field(default_factory=ViewSettings)

    @cached_property
    def links(self) -> list[str]:
        """Names of the links, ground first."""
        moving = (name for name in self.problem.mechanism.links if is_written(name))
        return [GROUND_NAME, *(name for name in moving if name != GROUND_NAME)]

    @cached_property
    def branches(self) -> list[list[BranchScene]]:
        """The branches of every run."""
        return [
            [
                BranchScene(*one, self.links, share, forces=run.forces)
                for one, share in zip(run.branches.items(), shares(run), strict=True)
            ]
            for run in self.runs
        ]

    @cached_property
    def _lengths(self) -> Lengths:
        return Lengths(self.problem.units)

    @cached_property
    def _left_out(self) -> frozenset[str]:
        followed = {
            name
            for run in self.runs
            for analysis in run.branches.values()
            for name in analysis.result.problem.mechanism.links
        }
        return frozenset(self.links) - followed - {GROUND_NAME}

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        """Corners (m) of the box of all joints' and named points that are followed, over all poses;
        of the drawing where there is no pose."""
        mechanism = self.problem.mechanism
        places = (*(at for _, at in mechanism.joint_points()), *mechanism.points.values())
        drawn = [at for at in places if at.link in self.links]
        seen = [at for at in drawn if at.link not in self._left_out] or drawn
        poses = [one.poses for run in self.branches for one in run if one.poses.size]
        corners = [
            carried(found[:, self.links.index(at.link)], at.vector)
            for found in poses
            for at in seen
        ]
        if not corners:
            corners = [np.array([at.vector]) for at in seen] or [np.zeros((1, 3))]
        every = np.concatenate(corners)
        return every.min(axis=0), every.max(axis=0)

    def record(self) -> Plain:
        """The data of the page (`format` 1); numbers in the file's units."""
        problem, lengths, settings = self.problem, self._lengths, self.settings
        units, mechanism = problem.units, problem.mechanism
        low, high = self.box
        size = diagonal([tuple(low), tuple(high)])
        arrow = settings.arrow_length
        return {
            "format": FORMAT,
            "program": self.program,
            "file": self.file,
            "name": mechanism.name,
            "units": {
                "length": units.label(LENGTH),
                "angle": units.label(ANGLE),
                "force": units.label(FORCE),
                "moment": units.label(MOMENT),
            },
            "size": lengths.one(size),
            "centre": lengths.vector((low + high) / 2.0),
            "up": [float(x) for x in upwards(self._gravity(), self.plane)],
            "planar": self.plane == _Z,
            "links": [self._link(name, size) for name in self.links],
            "joints": joint_records(
                problem, self.links, self._travels(), settings.joint_radius, lengths
            ),
            "points": self._points(),
            "wheels": self._wheels(),
            "belts": self._belts(),
            "screws": self._screws(),
            "discs": self._discs(),
            "cables": self._cables(),
            "runs": [
                self._run(run, branches)
                for run, branches in zip(self.runs, self.branches, strict=True)
            ],
            "tables": self._tables(),
            "notes": [_note(one) for one in self.notes],
            "assumed": assumed(problem, self.runs),
            "view": {
                "camera": self._camera(),
                "speed": settings.speed,
                "forces": settings.forces,
                "arrow_length": None if arrow is None else lengths.one(arrow),
            },
        }

    @cached_property
    def plane(self) -> int | None:
        """The ground axis square to the plane of the own branches, None where they have none."""
        own = [run[0].poses for run in self.branches if run[0].poses.size]
        return plane_of_motion(own, *self.box)

    def _camera(self) -> list[float] | None:
        """Direction to the eye: as asked for, or square to a plane of motion that holds z."""
        if self.settings.camera is not None:
            return list(self.settings.camera)
        if self.plane is None or self.plane == _Z:
            return None
        # y to the eye would be a mirrored view: x is to the right
        return [1.0, 0.0, 0.0] if self.plane == 0 else [0.0, -1.0, 0.0]

    def _gravity(self) -> Floats:
        """Gravity (m/s^2) of the sweep, or else of a response."""
        found = [self.problem.mechanism.gravity]
        for run in self.runs:
            found.append(run.own.result.problem.mechanism.gravity)
        return np.array(next((one for one in found if any(one)), (0.0, 0.0, 0.0)))

    def _link(self, name: str, size: float) -> Plain:
        settings, lengths = self.settings, self._lengths
        shape = link_shape(self.problem.mechanism, name, size, settings.shapes.get(name))
        points = [lengths.vector(point) for point in shape.points]
        drawn: Plain = {"kind": shape.kind, "points": points}
        if shape.normal is not None:
            drawn["normal"] = [float(x) for x in shape.normal]
        if shape.centre is not None:
            drawn["centre"] = lengths.vector(shape.centre)
        if shape.kind in ("rod", "cylinder", "wheel"):
            drawn["radius"] = None if shape.radius is None else lengths.one(shape.radius)
        if shape.kind == "wheel":
            drawn["width"] = lengths.one(shape.width)
        return {
            "name": name,
            "colour": settings.colours.get(name),
            "hidden": name in settings.hidden or name in self._left_out,
            "shape": drawn,
        }

    def _points(self) -> list[Plain]:
        chosen = self.settings.paths
        return [
            {
                "name": name,
                "link": self.links.index(at.link),
                "place": self._lengths.vector(at.vector),
                "path": at.link != GROUND_NAME and (chosen is None or name in chosen),
            }
            for name, at in self.problem.mechanism.points.items()
        ]

    def _wheels(self) -> list[Plain]:
        """What couplings have on their links; of racks from where to where, about their place."""
        lengths, travels = self._lengths, self._travels()
        found: list[Plain] = []
        rollers = [cam.roller for cam in self._cams if cam.roller is not None]
        for wheel in (*self.settings.wheels, *rollers):
            reach = None
            if wheel.slide is not None:
                name, sense = wheel.slide
                ends = travels.get(name.rpartition(".")[0], (0.0, 0.0))
                beyond = lengths.one(RACK_ENDS * wheel.radius)
                reach = [min(-sense * end for end in ends) - beyond]
                reach.append(max(-sense * end for end in ends) + beyond)
            found.append(
                {
                    "link": self.links.index(wheel.link),
                    "centre": lengths.vector(wheel.on.o),
                    "axis": list(wheel.on.z),
                    "x": list(wheel.on.x),
                    "radius": lengths.one(wheel.radius),
                    "width": lengths.one(wheel.width),
                    "teeth": wheel.teeth,
                    "inner": wheel.inner,
                    "apex": lengths.one(wheel.apex),
                    "lean": float(wheel.lean),
                    "reach": reach,
                }
            )
        return found

    @cached_property
    def _cams(self) -> list[DrawnCam]:
        return list(drawn_cams(self.problem.mechanism))

    def _discs(self) -> list[Plain]:
        """Discs of cams: corners in x and y of their frames."""
        lengths = self._lengths
        return [
            {
                "link": self.links.index(cam.link),
                "centre": lengths.vector(cam.on.o),
                "axis": list(cam.on.z),
                "x": list(cam.on.x),
                "outline": lengths.array(cam.outline).tolist(),
                "width": lengths.one(cam.width),
            }
            for cam in self._cams
        ]

    def _belts(self) -> list[Plain]:
        lengths = self._lengths
        return [
            {
                "link": self.links.index(belt.link),
                "line": [lengths.vector(point) for point in belt.line],
                "axis": list(belt.axis),
                "width": lengths.one(belt.width),
            }
            for belt in self.settings.belts
        ]

    def _screws(self) -> list[Plain]:
        """Spindles, from their bearing to beyond where the nut comes, and nuts."""
        lengths, travels = self._lengths, self._travels()
        found: list[Plain] = []
        for screw in self.settings.screws:
            joint, sense = screw.slide
            ends = [sense * end for end in travels.get(joint, (0.0, 0.0))]
            ends += [0.0, lengths.one(screw.bearing)]
            found.append(
                {
                    "link": self.links.index(screw.link),
                    "centre": lengths.vector(screw.on.o),
                    "axis": list(screw.on.z),
                    "x": list(screw.on.x),
                    "lead": lengths.one(screw.lead),
                    "reach": [min(ends), max(ends)],
                    "nut": {
                        "link": self.links.index(screw.nut_link),
                        "centre": lengths.vector(screw.nut.o),
                        "axis": list(screw.nut.z),
                    },
                }
            )
        return found

    def _cables(self) -> list[Plain]:
        """Places of cables as drawn on their links, how far to the left of each they run, and the
        axes of their pulleys (`DrawnCable`)."""
        lengths = self._lengths
        return [
            {
                "links": [self.links.index(at.link) for at in cable.places],
                "places": [lengths.vector(at.vector) for at in cable.places],
                "beside": [lengths.one(one) for one in cable.beside],
                "axes": [list(axis) for axis in cable.axes],
                "swivels": list(cable.swivels),
            }
            for cable in self.settings.cables
        ]

    def _travels(self) -> dict[str, tuple[float, float]]:
        """Least and most of every slide that stands alone in its joint, over all poses."""
        found: dict[str, tuple[float, float]] = {}
        for branch in (one for run in self.branches for one in run if one.posed.size):
            for joint in drawn_joints(branch.analysis.result.problem.mechanism):
                name = sliding_coordinate(joint)
                if name is None:
                    continue
                slides = np.asarray(branch.analysis[name], dtype=np.float64)[
                    branch.rows[branch.posed]
                ]
                low, high = float(slides.min()), float(slides.max())
                before = found.get(joint.name, (low, high))
                found[joint.name] = (min(low, before[0]), max(high, before[1]))
        return found

    def _run(self, run: ShownRun, branches: Sequence[BranchScene]) -> Plain:
        axis = branches[0].axis
        return {
            "name": run.name,
            "kind": "sweep" if run.name == "sweep" else "response",
            "title": run.title,
            "x": {"label": axis.name, "unit": axis.unit},
            "ties": tie_records(
                run.own.result.problem.mechanism, self.settings.between, self.links, self._lengths
            ),
            "branches": [
                branch.record(number == 0, self._lengths) for number, branch in enumerate(branches)
            ],
        }

    def _tables(self) -> list[Plain]:
        found = []
        for run, branches in zip(self.runs, self.branches, strict=True):
            own = branches[0]
            for table in (*own.analysis.tables, *run.tables, own.verdicts):
                found.append(table_record(table, run.name, own))
        return found


def _note(diagnostic: Diagnostic) -> Plain:
    severity, place = diagnostic.severity, diagnostic.place
    return {
        "severity": severity,
        "text": str(diagnostic._replace(place=None)).removeprefix(f"{severity}: "),
        "place": None if place is None else str(place),
    }


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
    data, notes = page_data(analyses, modes)
    return filled(template(), data), notes


def page_data(
    analyses: Sequence[ShownAnalysis], modes: bool = True
) -> tuple[Plain, list[Diagnostic]]:
    """The data of the page, and the notes on what it leaves out; `live` is what the page computes
    its runs with other parameters from: the first of them, which leads, and the `others`; `still`
    are the runs that it cannot compute, and why."""
    scene, notes = view_scene(analyses, modes)
    data = scene.record()
    asked = [one.model.live_record(one, data) for one in analyses]
    records = [record for record in asked if "why" not in record]
    data["still"] = [record for record in asked if "why" in record]
    if not records:
        return data, notes
    for other in records[1:]:
        del other["file"]
    return {**data, "live": {**records[0], "others": records[1:]}}, notes


def view_data(
    analyses: Sequence[ShownAnalysis], modes: bool = True
) -> tuple[bytes, list[Diagnostic]]:
    """What the page of runs of one model shows, as JSON, and the notes as of `view_page`."""
    data, notes = page_data(analyses, modes)
    return script_json(data).encode("ascii"), notes


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
        f"mechkin {__version__}",
        Path(model.built.document.file).name,
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
    # the equilibria of a window are of any mode
    others = list(_other_modes(analysis, own, notes)) if modes and own else []
    branches = {_OWN_NAMES.get(own, f"mode {own}"): analysis}
    branches |= {f"mode {letter}": one for letter, one in others}
    return ShownRun(
        run,
        _title(model.name, model.problem, run),
        branches,
        forces,
        _other_tables(analysis, notes),
    )


def _title(name: str, problem: Problem, run: str) -> str:
    if run == SWEEP:
        return f"sweep of {name}"
    known = problem.responses.get(run)
    if known is None:  # a mode of vibration
        return run
    return f"response {run}" if known.search is None else f"equilibria {run}"


def _may_read_forces(analysis: ShownAnalysis, notes: list[Diagnostic]) -> bool:
    """Whether reactions are there to be shown; a note says why not."""
    result = analysis.result
    if not (analysis.run == SWEEP or analysis.run in analysis.model.problem.responses):
        return False  # what loads are where a mode of vibration swings shows nothing
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
                yield letter, model.run_free(run, tables=tables, mode=letter)
        except UsageError as error:
            text = f"{run}: mode {letter} is not shown: {error}"
            notes.append(Diagnostic("view-modes-left-out", "note", text))


def _other_tables(analysis: ShownAnalysis, notes: list[Diagnostic]) -> tuple[Columns, ...]:
    try:
        return (*analysis.coefficients, *analysis.balance_tables)
    except UsageError as error:
        notes.append(Diagnostic("view-tables-left-out", "note", f"no dense system: {error}"))
        return analysis.balance_tables


def _left_out(runs: Sequence[ShownRun]) -> Iterator[Diagnostic]:
    """Notes on runs of which not all rows are shown."""
    for run in runs:
        rows, own = run.own.rows, shares(run)[0]
        if rows > min(own):
            yield Diagnostic(
                "view-thinned",
                "note",
                f"{run.name}: the page shows some of the rows, in even steps",
                measured=f"{rows} rows",
                limit=f"{own[0]} in curves and tables, {own[1]} poses, fewer of other modes",
                hint="the files that mechkin analyze writes have all rows",
            )
