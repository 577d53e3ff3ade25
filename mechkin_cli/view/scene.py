"""A mechanism with its runs as the data of one page."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import ViewSettings
from mechkin_cli.mechanism import GROUND_NAME, diagonal, is_written
from mechkin_cli.record import dataclass, field
from mechkin_cli.units import ANGLE, FORCE, LENGTH, MOMENT
from mechkin_cli.view.branch import BranchScene, table_record
from mechkin_cli.view.joints import (
    carried,
    drawn_joints,
    joint_records,
    link_shape,
    plane_of_motion,
    sliding_coordinate,
    upwards,
)
from mechkin_cli.view.page import Lengths, assumed, shares
from mechkin_cli.view.shown import ShownRun

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Floats
    from mechkin_cli.view.page import Plain


FORMAT = 1
"""Version of the data that pages read."""

_Z = 2


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
                BranchScene(one, self.links, share)
                for one, share in zip(run.branches, shares(run), strict=True)
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
            for branch in run.branches
            for name in branch.analysis.result.problem.mechanism.links
        }
        return frozenset(self.links) - followed - {GROUND_NAME}

    @cached_property
    def box(self) -> tuple[Floats, Floats]:
        """Corners (m) of the box of all joints' and named points that are followed, over all poses;
        of the drawing where there is no pose."""
        mechanism = self.problem.mechanism
        drawn = [at for _, at in mechanism.joint_points()] + [*mechanism.points.values()]
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
                mechanism, self.links, self._travels(), settings.joint_radius, lengths
            ),
            "points": self._points(),
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
            found.append(run.branches[0].analysis.result.problem.mechanism.gravity)
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
            "branches": [
                branch.record(number == 0, self._lengths) for number, branch in enumerate(branches)
            ],
        }

    def _tables(self) -> list[Plain]:
        found = []
        for run, branches in zip(self.runs, self.branches, strict=True):
            own = branches[0]
            codes = [int(code) for code in own.analysis.result.status[own.rows]]
            for table in (*own.analysis.tables, *run.tables, own.verdicts):
                found.append(table_record(table, run.name, own.rows, codes))
        return found


def _note(diagnostic: Diagnostic) -> Plain:
    severity, place = diagnostic.severity, diagnostic.place
    return {
        "severity": severity,
        "text": str(diagnostic._replace(place=None)).removeprefix(f"{severity}: "),
        "place": None if place is None else str(place),
    }
