"""glTF 2.0 in one file (GLB): a node for each link, its shape, and the run as an animation.

A mesh is drawn as the page draws the link (rods, plates, stars, cylinders, wheels, and its halves
of joints), in the drawing's axes in metres; the node's animation carries it from pose to pose. glTF
has y up: where the mechanism's own up is z, a node above all turns it. Rows without a position are
left out of the animation, which passes over them in a straight line; a note counts them.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mechkin_cli.bridges.parts import Exported, listed
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.mechanism import FIRST, GROUND_NAME, SECOND, is_written
from mechkin_cli.tables import run_parameter
from mechkin_cli.verdict import SWEEP, __version__
from mechkin_cli.view import continuous, drawn_joints, link_poses, link_shape, upwards

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.bridges.parts import ExportOptions
    from mechkin_cli.mechanism import Joint
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats

SIDES: Final = 12
"""Of the prism that a round bar is drawn as."""

THICK: Final = 0.012
"""Radius of a bar in parts of the mechanism's size."""

SECONDS_A_ROW: Final = 1.0 / 25.0
"""Of the animation where nothing says how fast the mechanism moves."""

COLOURS: Final = (
    (0.45, 0.47, 0.50),
    (0.12, 0.47, 0.71),
    (1.00, 0.50, 0.05),
    (0.17, 0.63, 0.17),
    (0.84, 0.15, 0.16),
    (0.58, 0.40, 0.74),
    (0.55, 0.34, 0.29),
    (0.09, 0.75, 0.81),
)
"""Of ground, then of the links in turn."""

_FLOAT, _ARRAY = 5126, 34962
_JSON, _BINARY = 0x4E4F534A, 0x004E4942

Mesh = tuple[Any, Any]
"""Corners (n, 3), and triangles by their numbers (m, 3)."""


def export(model: Model, options: ExportOptions) -> Exported:
    """The model and a run of it as one GLB file, in some rows or in all.

    Raises:
        UsageError: no row has a position, or the run does not have one that is named.
    """
    run = options.run or (SWEEP if SWEEP in model.runs else model.runs[0])
    (analysis,) = model.analyses(run, options.mode)
    result = analysis.result
    wanted = [row - 1 for row in options.rows] or list(range(analysis.rows))
    if max(wanted) >= analysis.rows:
        raise UsageError(
            f"--row {max(wanted) + 1}: the run {run} has {analysis.rows} rows; name one of them"
        )
    rows = [row for row in sorted(set(wanted)) if result.solved[row]]
    if not rows:
        raise UsageError(f"no row of {run} has a position; see mechkin analyze for the reason")
    notes = _notes(analysis, wanted, rows)
    content = _Scene(analysis, rows).glb()
    return Exported({f"{model.stem}.glb": content}, tuple(notes))


def _notes(analysis: Analysis, wanted: Sequence[int], rows: Sequence[int]) -> Iterator[Diagnostic]:
    lost = len(set(wanted)) - len(rows)
    if lost:
        yield Diagnostic(
            "left-out",
            "note",
            f"{lost} rows without a position are not in the animation",
            hint="mechkin analyze tells why",
        )
    mechanism = analysis.result.problem.mechanism
    parts = [name for name in mechanism.couplings if is_written(name)]
    if parts:
        yield Diagnostic(
            "left-out",
            "note",
            f"wheels, belts, cables and cams of the couplings {listed(parts)} are not drawn",
            hint="mechkin view shows them",
        )


class _Scene:
    """Links as nodes, rows as keys of their animation."""

    def __init__(self, analysis: Analysis, rows: Sequence[int]) -> None:
        self.analysis, self.rows = analysis, list(rows)
        self.problem = analysis.result.problem
        self.mechanism = self.problem.mechanism
        moving = [n for n in self.mechanism.links if is_written(n) and n != GROUND_NAME]
        self.links = [GROUND_NAME, *moving]
        poses = link_poses(analysis.result, self.links)[self.rows]
        self.poses = continuous(poses)
        self.size = self.mechanism.box_diagonal()
        self.binary = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def glb(self) -> bytes:
        """The file."""
        nodes: list[dict[str, Any]] = []
        meshes: list[dict[str, Any]] = []
        for number, link in enumerate(self.links):
            node: dict[str, Any] = {"name": link}
            place, turn = _parted(self.poses[0, number])
            node |= {"translation": place.tolist(), "rotation": turn.tolist()}
            mesh = self._mesh(link)
            if mesh is not None:
                primitive = self._primitive(*mesh) | {"material": number}
                node["mesh"] = len(meshes)
                meshes.append({"name": link, "primitives": [primitive]})
            nodes.append(node)
        root: dict[str, Any] = {"name": self.mechanism.name or "mechanism"}
        root["children"] = list(range(len(nodes)))
        up = upwards(np.array(self.mechanism.gravity), 2 if self.mechanism.plane else None)
        if abs(up[2]) > max(abs(up[0]), abs(up[1])):
            root["rotation"] = [-(0.5**0.5) * float(np.sign(up[2])), 0.0, 0.0, 0.5**0.5]
        nodes.append(root)
        tree: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": f"mechkin {__version__}"},
            "scene": 0,
            "scenes": [{"nodes": [len(nodes) - 1]}],
            "nodes": nodes,
            "materials": [_material(k, link) for k, link in enumerate(self.links)],
        }
        if meshes:
            tree["meshes"] = meshes
        if len(self.rows) > 1:
            tree["animations"] = [self._animation()]
        if self.views:
            tree |= {
                "buffers": [{"byteLength": len(self.binary)}],
                "bufferViews": self.views,
                "accessors": self.accessors,
            }
        return _container(tree, bytes(self.binary))

    # Motion.

    def _animation(self) -> dict[str, Any]:
        times = self._array(self._times(), "SCALAR", with_ends=True)
        samplers: list[dict[str, Any]] = []
        channels: list[dict[str, Any]] = []
        for number, link in enumerate(self.links):
            if link == GROUND_NAME:
                continue
            place, turn = _parted(self.poses[:, number])
            for path, values, kind in (("translation", place, "VEC3"), ("rotation", turn, "VEC4")):
                sampler = {"input": times, "output": self._array(values, kind)}
                channels.append(
                    {"sampler": len(samplers), "target": {"node": number, "path": path}}
                )
                samplers.append(sampler | {"interpolation": "LINEAR"})
        return {"name": self.analysis.run, "channels": channels, "samplers": samplers}

    def _times(self) -> Floats:
        """Seconds of the rows from the first: times of the run, else by the rate of the input, else
        of equal steps."""
        result = self.analysis.result
        along = run_parameter(result)
        count = np.arange(len(self.rows), dtype=np.float64) * SECONDS_A_ROW
        if along is None:
            return count
        values = along.values[self.rows]
        if along.name == "time":
            seconds = values - values[0]
        else:
            driven = next(i for i in self.problem.motion.inputs if i.name == along.name)
            rate = float(np.abs(driven.rates[self.rows]).mean())
            if rate == 0.0:
                return count
            seconds = np.abs(driven.values[self.rows] - driven.values[self.rows[0]]) / rate
        # keys of an animation grow, in the floats of the file
        grow = bool((np.diff(seconds.astype(np.float32)) > 0.0).all())
        return seconds if grow else count

    # Shapes.

    def _mesh(self, link: str) -> Mesh | None:
        """What a link looks like."""
        radius = THICK * self.size
        view = self.analysis.model.built.view
        setting = None if view is None else view.shapes.get(link)
        shape = link_shape(self.mechanism, link, self.size, setting)
        points = np.asarray(shape.points, dtype=np.float64)
        round_ = radius if shape.radius is None else shape.radius
        parts: list[Mesh] = []
        if shape.kind in ("rod", "cylinder"):
            parts += [_prism(a, b, round_) for a, b in pairwise(points)]
        elif shape.kind == "plate" and shape.normal is not None:
            parts.append(_plate(points, np.asarray(shape.normal), radius))
        elif shape.kind == "star" and shape.centre is not None:
            parts += [_prism(np.asarray(shape.centre), point, radius) for point in points]
        elif shape.kind == "wheel" and shape.normal is not None:
            half = 0.5 * shape.width * np.asarray(shape.normal)
            parts.append(_prism(points[0] - half, points[0] + half, round_, 3 * SIDES))
        for joint in drawn_joints(self.mechanism):
            for side, own in ((FIRST, joint.first), (SECOND, joint.second)):
                if own == link:
                    parts.append(self._half(joint, side, radius))
        return _joined(parts) if parts else None

    def _half(self, joint: Joint, side: int, radius: float) -> Mesh:
        """One half of a joint: a pin (longer, thinner) or its eye, a ball or its socket."""
        frame = joint.on_first if side == FIRST else joint.on_second
        at = np.asarray(frame.o, dtype=np.float64)
        if joint.type.is_ball:
            return _ball(at, radius * (2.0 if side == SECOND else 1.6))
        axis = np.asarray(frame.z, dtype=np.float64)
        long, thick = (3.0, 1.3) if side == FIRST else (2.0, 1.9)
        return _prism(at - long * radius * axis, at + long * radius * axis, thick * radius)

    # The file.

    def _primitive(self, corners: Floats, triangles: Any) -> dict[str, Any]:
        """Flat faces: each triangle has corners of its own, with its normal."""
        places = corners[triangles]
        normals = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
        sizes = np.linalg.norm(normals, axis=1)
        places, normals = places[sizes > 0.0], normals[sizes > 0.0] / sizes[sizes > 0.0, None]
        attributes = {
            "POSITION": self._array(places.reshape(-1, 3), "VEC3", _ARRAY, with_ends=True),
            "NORMAL": self._array(np.repeat(normals, 3, axis=0), "VEC3", _ARRAY),
        }
        return {"attributes": attributes, "mode": 4}

    def _array(
        self, values: Any, kind: str, target: int | None = None, with_ends: bool = False
    ) -> int:
        """The number of an accessor of floats."""
        content = np.ascontiguousarray(values, dtype="<f4")
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.binary)}
        view["byteLength"] = content.nbytes
        if target is not None:
            view["target"] = target
        self.binary += content.tobytes()
        accessor: dict[str, Any] = {
            "bufferView": len(self.views),
            "componentType": _FLOAT,
            "count": len(content),
            "type": kind,
        }
        if with_ends:
            rows = content.reshape(len(content), -1).astype(np.float64)
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.views.append(view)
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _parted(poses: Floats) -> tuple[Floats, Floats]:
    """Shifts, and quaternions with the scalar last, as glTF has them; of length 1 in its floats."""
    turns = np.roll(poses[..., 3:], -1, axis=-1)
    return poses[..., :3], turns / np.linalg.norm(turns, axis=-1, keepdims=True)


def _material(number: int, link: str) -> dict[str, Any]:
    colour = COLOURS[0] if number == 0 else COLOURS[1 + (number - 1) % (len(COLOURS) - 1)]
    shine = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.1, "roughnessFactor": 0.7}
    return {"name": link, "pbrMetallicRoughness": shine}


def _container(tree: dict[str, Any], binary: bytes) -> bytes:
    """GLB: a header, the JSON filled up with blanks, the numbers filled up with zeros."""
    text = json.dumps(tree, ensure_ascii=False, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), _JSON) + text
    if binary:
        chunks += struct.pack("<II", len(binary), _BINARY) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _joined(parts: Sequence[Mesh]) -> Mesh:
    first = np.cumsum([0, *(len(corners) for corners, _ in parts[:-1])])
    triangles = [faces + start for (_, faces), start in zip(parts, first, strict=True)]
    return np.concatenate([corners for corners, _ in parts]), np.concatenate(triangles)


def _across(axis: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors square to one, right-handed with it."""
    start = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(start, axis)
    x /= np.linalg.norm(x)
    return x, np.cross(axis, x)


def _prism(a: Floats, b: Floats, radius: float, sides: int = SIDES) -> Mesh:
    """A round bar between two points, with flat ends."""
    line = b - a
    x, y = _across(line / np.linalg.norm(line))
    turns = 2.0 * np.pi * np.arange(sides) / sides
    rim = radius * (np.cos(turns)[:, None] * x + np.sin(turns)[:, None] * y)
    corners = np.concatenate([a + rim, b + rim, [a], [b]])
    this = np.arange(sides)
    after = (this + 1) % sides
    low, high = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
    faces = [
        np.stack([this, after, sides + after], axis=1),
        np.stack([this, sides + after, sides + this], axis=1),
        np.stack([low, after, this], axis=1),
        np.stack([high, sides + this, sides + after], axis=1),
    ]
    return corners, np.concatenate(faces)


def _plate(points: Floats, normal: Floats, thickness: float) -> Mesh:
    """The hull of points in a plane, of some thickness."""
    x, y = _across(normal / np.linalg.norm(normal))
    rim = points[_hull(np.stack([points @ x, points @ y], axis=1))]
    count, half = len(rim), 0.5 * thickness * normal / np.linalg.norm(normal)
    corners = np.concatenate([rim - half, rim + half])
    this = np.arange(count)
    after = (this + 1) % count
    fan = np.arange(1, count - 1)
    start = np.zeros(count - 2, dtype=int)
    faces = [
        np.stack([this, after, count + after], axis=1),
        np.stack([this, count + after, count + this], axis=1),
        np.stack([start, fan + 1, fan], axis=1),
        np.stack([count + start, count + fan, count + fan + 1], axis=1),
    ]
    return corners, np.concatenate(faces)


def _hull(flat: Floats) -> list[int]:
    """Corners of the convex hull of points of a plane, counterclockwise (monotone chain)."""
    order = sorted(range(len(flat)), key=lambda k: (flat[k, 0], flat[k, 1]))

    def chain(numbers: Sequence[int]) -> list[int]:
        found: list[int] = []
        for k in numbers:
            while len(found) > 1 and _turn(flat[found[-2]], flat[found[-1]], flat[k]) <= 0.0:
                found.pop()
            found.append(k)
        return found[:-1]

    return chain(order) + chain(order[::-1])


def _turn(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _ball(centre: Floats, radius: float) -> Mesh:
    """A sphere of rings."""
    rings = SIDES // 2
    tilts = np.pi * np.arange(rings + 1) / rings
    turns = 2.0 * np.pi * np.arange(SIDES) / SIDES
    tilt, turn = np.meshgrid(tilts, turns, indexing="ij")
    across = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], -1)
    corners = centre + radius * across.reshape(-1, 3)
    ring, side = (k.reshape(-1) for k in np.meshgrid(range(rings), range(SIDES), indexing="ij"))
    this, after = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
    faces = [
        np.stack([this, this + SIDES, after + SIDES], axis=1),
        np.stack([this, after + SIDES, after], axis=1),
    ]
    # at the poles one of each pair has no area
    return corners, np.concatenate(faces)
