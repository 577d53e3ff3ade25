"""DXF: outlines of links, joints, paths of points and profiles of cams.

Written by ezdxf, in the unit of the file. A mechanism that moves in a plane is drawn in x and y of
the drawing, as the page sees it; others in space. Layers: `LINK <name>`, `JOINTS`, `PATH <point>`
and, of each cam, in its own axes beside the mechanism, `CAM <name>` and `CAM <name> PITCH`.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mechkin_cli.bridges.parts import Exported, listed
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.mechanism import GROUND_NAME, is_written
from mechkin_cli.units import LENGTH
from mechkin_cli.verdict import SWEEP
from mechkin_cli.view import (
    carried,
    drawn_joints,
    link_poses,
    link_shape,
    plane_of_motion,
)

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.bridges.parts import ExportOptions
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats

VERSION: Final = "R2010"
"""Of DXF: what every CAD program of the last fifteen years reads."""

UNITS: Final = {"mm": 4, "cm": 5, "m": 6, "in": 1, "ft": 2}
"""$INSUNITS by the label of a unit; others are named in a note."""

GAP: Final = 1.5
"""Between the mechanism and its cams, in parts of their size."""

SEEN_ALONG: Final = {0: (1, 2), 1: (0, 2), 2: (0, 1)}
"""Ground axes to the right and up, by the axis that the plane of motion is square to."""


def export(model: Model, options: ExportOptions) -> Exported:
    """The mechanism in the pose of a row (the first with a position) with the paths of all rows.

    Raises:
        UsageError: ezdxf is not there, or the row has no position.
    """
    ezdxf = _ezdxf()
    if len(options.rows) > 1:
        raise UsageError("--to dxf takes one --row, in whose pose the links are drawn")
    run = options.run or (SWEEP if SWEEP in model.runs else model.runs[0])
    (analysis,) = model.analyses(run, options.mode)
    drawing = _Drawing(model, analysis, _row(analysis, options.rows))
    unit = analysis.result.units.label(LENGTH)
    settings = ezdxf.options
    dated = settings.write_fixed_meta_data_for_testing
    # the same file for the same mechanism: no dates, no random names
    settings.write_fixed_meta_data_for_testing = True
    try:
        text = _text(ezdxf.new(VERSION, setup=False), drawing, unit)
    finally:
        settings.write_fixed_meta_data_for_testing = dated
    notes = tuple(drawing.notes(unit))
    return Exported({f"{model.stem}.dxf": text.encode()}, notes)


def _text(document: Any, drawing: _Drawing, unit: str) -> str:
    """The file, from an empty document."""
    document.header["$INSUNITS"] = UNITS.get(unit, 0)
    space = document.modelspace()
    for layer, places, is_closed in drawing.lines():
        _layer(document, layer)
        _line(space, layer, places, is_closed)
    for layer, place, radius in drawing.circles():
        _layer(document, layer)
        space.add_circle(place, radius, dxfattribs={"layer": layer})
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue()


def _ezdxf() -> Any:
    try:
        return import_module("ezdxf")
    except ImportError:
        raise UsageError("--to dxf needs ezdxf: pip install 'mechkin[dxf]'") from None


def _row(analysis: Analysis, asked: tuple[int, ...]) -> int:
    """The row whose pose is drawn, from 0."""
    solved = analysis.result.solved
    if not asked:
        if not solved.any():
            raise UsageError(f"no row of {analysis.run} has a position; see mechkin analyze")
        return int(np.argmax(solved))
    (row,) = asked
    if row > analysis.rows:
        raise UsageError(
            f"--row {row}: the run {analysis.run} has {analysis.rows} rows; name one of them"
        )
    if not solved[row - 1]:
        word = analysis["row.status"][row - 1]
        raise UsageError(f"row {row} of {analysis.run} has no position ({word}); name another")
    return row - 1


class _Drawing:
    """What is drawn, in the file's unit of length."""

    def __init__(self, model: Model, analysis: Analysis, row: int) -> None:
        self.model, self.analysis, self.row = model, analysis, row
        self.problem = analysis.result.problem
        self.mechanism = self.problem.mechanism
        moving = [n for n in self.mechanism.links if is_written(n) and n != GROUND_NAME]
        self.links = [GROUND_NAME, *moving]
        self.poses = link_poses(analysis.result, self.links)
        self.size = self.mechanism.box_diagonal()
        self.axis = self._plane()
        self.cams, self.lost_cams = self._found_cams()

    def _plane(self) -> int | None:
        if self.mechanism.plane:
            return 2
        poses = self.poses[self.analysis.result.solved]
        places = [(at.link, at.vector) for _, at in self.mechanism.joint_points()]
        corners = [
            carried(poses[:, self.links.index(link)], vector)
            for link, vector in places
            if link in self.links
        ]
        every = np.concatenate(corners) if corners else np.zeros((1, 3))
        return plane_of_motion([poses], every.min(axis=0), every.max(axis=0))

    def lines(self) -> Iterator[tuple[str, Floats, bool]]:
        """Layer, places (n, 2 or 3), and whether the last leads to the first."""
        view = self.analysis.model.built.view
        for number, link in enumerate(self.links):
            setting = None if view is None else view.shapes.get(link)
            shape = link_shape(self.mechanism, link, self.size, setting)
            points = np.asarray(shape.points, dtype=np.float64)
            layer, pose = _name("LINK", link), self.poses[self.row, number]
            if shape.kind in ("rod", "cylinder") or (shape.kind == "plate" and len(points) > 1):
                yield layer, self._seen(carried(pose, points)), shape.kind == "plate"
            elif shape.kind == "star" and shape.centre is not None:
                for point in points:
                    both = np.array([shape.centre, point])
                    yield layer, self._seen(carried(pose, both)), False
        for name, at in self.mechanism.points.items():
            if at.link != GROUND_NAME and at.link in self.links and is_written(name):
                poses = self.poses[self.analysis.result.solved, self.links.index(at.link)]
                if len(poses) > 1:
                    yield _name("PATH", name), self._seen(carried(poses, at.vector)), False
        place = self._beside()
        for cam in self.cams:
            width = float(np.abs(np.asarray(cam.profile)).max())
            place = place + np.array([GAP * width, 0.0])
            curves = {"": cam.profile} | ({"PITCH": cam.pitch} if cam.has_pitch else {})
            for word, curve in curves.items():
                shown = np.asarray(curve)[:, :-1] if cam.is_closed else np.asarray(curve)
                yield _name("CAM", cam.name, word), shown.T + place, cam.is_closed
            place = place + np.array([GAP * width, 0.0])

    def circles(self) -> Iterator[tuple[str, Any, float]]:
        """Layer, centre and radius: joints."""
        radius = float(self._lengths(0.01 * self.size))
        for joint in drawn_joints(self.mechanism):
            at = joint.point
            if at.link in self.links:
                pose = self.poses[self.row, self.links.index(at.link)]
                place = self._seen(carried(pose, np.asarray(at.vector)))
                yield "JOINTS", tuple(place.tolist()), radius

    def notes(self, unit: str) -> Iterator[Diagnostic]:
        """What the file does not have."""
        if unit not in UNITS:
            yield Diagnostic(
                "left-out",
                "note",
                f"DXF has no unit {unit}; the drawing is without one",
                hint=f"one unit of the drawing is 1 {unit}",
            )
        couplings = [n for n in self.mechanism.couplings if is_written(n)]
        others = [n for n in couplings if n not in {cam.name for cam in self.cams}]
        if others:
            yield Diagnostic(
                "left-out",
                "note",
                f"wheels, belts and cables of {listed(others)} are not drawn",
                hint="mechkin view shows them",
            )
        lost = int((~self.analysis.result.solved).sum())
        if lost:
            yield Diagnostic(
                "left-out",
                "note",
                f"paths pass over {lost} rows without a position",
                hint="mechkin analyze tells why",
            )

    def _found_cams(self) -> tuple[list[Any], list[str]]:
        """Cams with a profile, and couplings with a follower that have none."""
        found, lost = [], []
        for name in self.mechanism.couplings:
            try:
                found.append(self.model.cam(name))
            except UsageError:
                lost.append(name)
        return found, lost

    def _beside(self) -> Floats:
        """To the right of the mechanism."""
        poses = self.poses[self.row]
        points = [
            carried(poses[self.links.index(at.link)], np.asarray(at.vector))
            for _, at in self.mechanism.joint_points()
            if at.link in self.links
        ]
        seen = self._seen(np.array(points)) if points else np.zeros((1, 2))
        return np.array([float(seen[:, 0].max()), 0.0])

    def _seen(self, places: Floats) -> Floats:
        """In the plane of motion, or in space."""
        found: Floats = self._lengths(places)
        return found if self.axis is None else found[..., list(SEEN_ALONG[self.axis])]

    def _lengths(self, values: Any) -> Any:
        return np.asarray(self.analysis.result.units.from_si(values, LENGTH))


def _name(*words: str) -> str:
    """The name of a layer: CAD programs take no < > / \\ " : ; ? * | = ` in it."""
    return re.sub(r"[<>/\\\":;?*|=`']", "_", " ".join(filter(None, words)))


def _layer(document: Any, name: str) -> None:
    if name not in document.layers:
        number = 1 + (len(document.layers) - 1) % 6
        document.layers.add(name, color=7 if name == "JOINTS" else number)


def _line(space: Any, layer: str, places: Floats, is_closed: bool) -> None:
    attributes = {"layer": layer}
    if places.shape[1] == 2:
        space.add_lwpolyline(places.tolist(), close=is_closed, dxfattribs=attributes)
    else:
        space.add_polyline3d(places.tolist(), close=is_closed, dxfattribs=attributes)
