"""MJCF, the format of MuJoCo: bodies as a tree, loops closed by equality constraints.

The file is drawn in the pose of one row: every body's frame has the ground's axes there, and stands
at the joint that carries the body. A joint's `ref` is its coordinate in that row, so that MuJoCo's
qpos are the coordinates of the mechanism file.

A ball that closes a loop is a `connect`. Of any other joint that does, the joint carries one half
of a link, which is welded to the other half, so that every coordinate exists and all masses are
those of the mechanism. Inputs are held where they are in the row, by `equality joint`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final
from xml.etree import ElementTree

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.bridges.parts import Exported, ExportOptions, listed
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.mechanism import (
    GROUND_NAME,
    Attached,
    Bushing,
    Damper,
    Frame,
    Joint,
    Part,
    RigidLink,
    Spring,
    dimension_of,
    is_told,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.verdict import SWEEP, __version__
from mechkin_cli.view import link_poses

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats

STIFFNESS: Final = {
    "solref": f"{2.0 * tolerances.MUJOCO_STEP!r} 1",
    "solimp": "0.9999 0.9999 0.001",
}
"""Of the constraints, as stiff as MuJoCo takes them at that step."""

INERTIA: Final = "mechkin.inertia."
"""Begins the names of numbers that tell what a link has where MuJoCo needs another: mass (kg) and
inertia xx, yy, zz, xy, xz, yz about its mass centre (kg m^2), in the body's axes."""

Pose = Any
"""A displacement, or a frame: a matrix (4, 4)."""


def export(model: Model, options: ExportOptions) -> Exported:
    """The model at one of its rows (the first) as one MJCF file.

    Raises:
        UsageError: the row has no position, or something keeps the mechanism together that MJCF
            cannot express.
    """
    if len(options.rows) > 1:
        raise UsageError("--to mjcf takes one --row, in whose pose the mechanism is drawn")
    run = options.run or (SWEEP if SWEEP in model.runs else model.runs[0])
    (analysis,) = model.analyses(run, options.mode)
    row = options.rows[0] if options.rows else 1
    if row > analysis.rows:
        raise UsageError(f"--row {row}: the run {run} has {analysis.rows} rows; name one of them")
    drawn = _Drawing(analysis, row - 1)
    text = drawn.text()
    return Exported({f"{model.stem}.xml": text.encode()}, tuple(drawn.notes()))


class _Carried(NamedTuple):
    """A body below another: the link (or half of it) that a joint carries, and the joint's parts
    with their coordinates, passed from the parent on; `is_half`: the other half of the link is
    another body."""

    name: str
    link: str
    joint: Joint
    forward: bool
    is_half: bool = False


class _Drawing:
    """A mechanism in the pose of a row."""

    def __init__(self, analysis: Analysis, row: int) -> None:
        self.analysis, self.row = analysis, row
        self.problem = analysis.result.problem
        self.mechanism = self.problem.mechanism
        if not analysis.result.solved[row]:
            raise UsageError(
                f"row {row + 1} of {analysis.run} has no position ({analysis['row.status'][row]}); "
                "choose another --row"
            )
        self._check()
        moving = [name for name in self.mechanism.links if name != GROUND_NAME]
        self.links = [GROUND_NAME, *moving]
        poses = link_poses(analysis.result, self.links)[row]
        self.poses = dict(zip(self.links, map(_matrix_of, poses), strict=True))
        self.size = self.mechanism.box_diagonal()
        self.driven = {".".join(pair) for pair in self.problem.motion.driven}
        coupled = {
            f"{term.joint.name}.{term.coordinate}"
            for relation in self.mechanism.couplings.values()
            for term in relation.terms
        }
        self.needed = self.driven | coupled
        self.left_out: dict[str, list[str]] = {}
        self.changed: dict[str, tuple[float, ...]] = {}
        self._plan()

    def _check(self) -> None:
        """Refuses what MJCF has no constraint for."""
        curved = [joint.name for joint in self.mechanism.joints.values() if joint.type.is_carried]
        if curved:
            raise UsageError(
                f"MJCF has no joint along a curve or over a surface: {listed(curved)}; replace it "
                "by a P, R or C joint, or leave it out"
            )
        for name, relation in self.mechanism.couplings.items():
            if relation.extents or any(not is_told(term.joint.name) for term in relation.terms):
                why = "a cable, whose length MJCF does not keep"
            elif relation.has_play:
                why = "one with backlash"
            elif any(term.law is not None for term in relation.terms):
                why = "a function or a table"
            else:
                continue
            raise UsageError(
                f"the coupling {name} is {why}; MJCF takes sums of coordinates: leave it out, or "
                "replace it by a coupling of type linear"
            )

    # The tree.

    def _plan(self) -> None:
        """Which joint carries which body, and what closes the loops."""
        joints = [
            joint
            for joint in self.mechanism.joints.values()
            if not joint.type.is_free or self._is_needed(joint)
        ]
        joints.sort(key=lambda joint: (joint.type.is_ball, not self._is_needed(joint)))
        roots = {name: name for name in self.links}

        def root(name: str) -> str:
            while roots[name] != name:
                name = roots[name]
            return name

        tree, self.closing = [], []
        for joint in joints:
            one, other = root(joint.first), root(joint.second)
            if one == other:
                self.closing.append(joint)
            else:
                roots[one] = other
                tree.append(joint)
        loose = [name for name in self.links if root(name) != root(GROUND_NAME)]
        if loose:
            raise UsageError(f"no joint leads from ground to {listed(loose)}; add one")
        at: dict[str, list[Joint]] = {name: [] for name in self.links}
        for joint in tree:
            at[joint.first].append(joint)
            at[joint.second].append(joint)
        self.carried: dict[str, list[_Carried]] = {}
        halved = set()
        queue, seen = [GROUND_NAME], {GROUND_NAME}
        for name in queue:
            for joint in at[name]:
                forward = joint.first == name
                other = joint.second if forward else joint.first
                if other not in seen:
                    seen.add(other)
                    queue.append(other)
                    self._carry(name, _Carried(other, other, joint, forward))
        for joint in self.closing:
            if _is_cut(joint):
                continue
            forward = joint.second != GROUND_NAME
            parent, link = (joint.first, joint.second) if forward else (joint.second, joint.first)
            self._carry(parent, _Carried(f"{link}.{joint.name}", link, joint, forward, True))
            halved.add(link)
        self.pieces = {
            link: 1
            + sum(c.link == link and c.is_half for every in self.carried.values() for c in every)
            for link in self.links
        }

    def _carry(self, parent: str, body: _Carried) -> None:
        self.carried.setdefault(parent, []).append(body)

    def _is_needed(self, joint: Joint) -> bool:
        return any(name in self.needed for name in joint.coordinates)

    # The text.

    def text(self) -> str:
        """The MJCF file."""
        root = ElementTree.Element("mujoco", model=self.mechanism.name or "mechanism")
        version = f"made by mechkin {__version__}: {self.analysis.run}, row {self.row + 1}"
        root.append(ElementTree.Comment(f" {version} "))
        _add(root, "compiler", angle="radian", autolimits="true")
        gravity = _numbers(self.mechanism.gravity)
        _add(
            root,
            "option",
            timestep=repr(tolerances.MUJOCO_STEP),
            gravity=gravity,
            integrator="implicitfast",
        )
        default = _add(root, "default")
        # bodies are drawn thin, without mass and without contact
        thin = {"contype": "0", "conaffinity": "0", "mass": "0", "rgba": "0.3 0.5 0.7 1"}
        _add(default, "geom", type="capsule", size=repr(0.01 * self.size), **thin)
        _add(default, "site", size=repr(0.015 * self.size))
        _add(default, "equality", **STIFFNESS)
        _add(_add(root, "visual"), "headlight", ambient="0.5 0.5 0.5", diffuse="0.5 0.5 0.5")
        self.world = _add(root, "worldbody")
        self.elements: dict[str, tuple[Any, Floats]] = {GROUND_NAME: (self.world, np.zeros(3))}
        self.names: dict[str, str] = {}
        queue = [GROUND_NAME]
        for name in queue:
            for body in self.carried.get(name, ()):
                self._body(name, body)
                if not body.is_half:
                    queue.append(body.link)
        for name, at in self.mechanism.points.items():
            self._site(at.link, name, self._placed(at.link, at.vector))
        tendons, equality = ElementTree.Element("tendon"), ElementTree.Element("equality")
        self._closings(equality)
        self._couplings(equality, tendons)
        self._drives(equality)
        self._loads(tendons)
        for part in (tendons, equality):
            if len(part):
                root.append(part)
        if self.changed:
            custom = _add(root, "custom")
            for link, numbers in self.changed.items():
                _add(custom, "numeric", name=f"{INERTIA}{link}", data=_numbers(numbers))
        ElementTree.indent(root)
        return ElementTree.tostring(root, encoding="unicode") + "\n"

    def _placed(self, link: str, point: Any) -> Floats:
        """Where a point as drawn on a link is in the row (m, ground axes)."""
        found: Floats = (self.poses[link] @ np.append(np.asarray(point, dtype=float), 1.0))[:3]
        return found

    def _body(self, parent: str, body: _Carried) -> None:
        """A body with its joints; its frame has the ground's axes in the row."""
        above, origin = self.elements[parent]
        chain = self._chain(parent, body)
        own = chain[0][1][:3, 3] if chain else self._anchor(body)
        element = _add(above, "body", name=body.name, pos=_numbers(own - origin))
        self.elements[body.name] = element, own
        self._inertial(element, body.link, own)
        for part, frame, coordinates in chain:
            self._joints(element, body.joint, part, frame, coordinates, own)
        if body.is_half:
            return
        ends = [
            self._placed(body.link, (j.on_first if j.first == body.link else j.on_second).o)
            for j in self.mechanism.joints_of[body.link]
            if j.type.has_point
        ]
        for end in ends:
            if float(np.linalg.norm(end - own)) > tolerances.SHORT_BAR * self.size:
                _add(element, "geom", fromto=_numbers([0.0, 0.0, 0.0, *(end - own)]))

    def _anchor(self, body: _Carried) -> Floats:
        frame = body.joint.on_first if body.joint.first == body.link else body.joint.on_second
        return self._placed(body.link, frame.o)

    def _chain(
        self, parent: str, body: _Carried
    ) -> list[tuple[Part, Pose, tuple[tuple[str, float], ...]]]:
        """The parts from the parent on with their frames in the row, and the names and values
        (rad, m) of their freedoms; "" for one without a coordinate."""
        joint = body.joint
        by_freedom = {freedom: name for name, freedom in joint.type.scalars.items()}
        known: list[tuple[Part, tuple[tuple[str, float], ...]]] = []
        freedom = 0
        for part in joint.parts:
            found = []
            for _ in part.type.freedoms:
                name = by_freedom.get(freedom, "")
                found.append((name, self._value(joint, name) if name else 0.0))
                freedom += 1
            known.append((part, tuple(found)))
        if not body.forward:
            known = [(part.reversed(), found) for part, found in reversed(known)]
        frames = []
        place = self.poses[parent]
        for part, values in known:
            place = place @ _matrix(part.before)
            frames.append(place)
            place = place @ _displacement(part, [v for _, v in values], joint.pitch)
            place = place @ np.linalg.inv(_matrix(part.after))
        if joint.type.is_oriented:
            frames = self._frames_of_ball(known, parent, body.link)
        elif not np.allclose(
            place, self.poses[body.link], atol=tolerances.CHAIN_GAP * max(self.size, 1.0)
        ):
            raise UsageError(
                f"the coordinates of {joint.name} do not lead from {parent} to {body.link} in "
                f"row {self.row + 1}; choose another --row"
            )
        return [(p, frame, found) for (p, found), frame in zip(known, frames, strict=True)]

    def _frames_of_ball(self, known: Any, parent: str, link: str) -> list[Pose]:
        """The frames of a ball and the slides on one side of it, in the row: nothing tells how far
        these are, but they ride on the links."""
        frames, is_before = [], True
        for part, _ in known:
            if part.type.is_ball:
                is_before = False
            pose = self.poses[parent if is_before or part.type.is_ball else link]
            frames.append(pose @ _matrix(part.before if is_before else part.after))
        ball = next(i for i, (part, _) in enumerate(known) if part.type.is_ball)
        part = known[ball][0]
        # the centre rides on the side of the ball that has no slides
        side = parent if ball == 0 else link
        centre = self.poses[side] @ _matrix(part.before if ball == 0 else part.after)
        frames[ball] = centre
        return frames

    def _value(self, joint: Joint, coordinate: str) -> float:
        """A coordinate in the row (rad, m)."""
        values = self.analysis[f"{joint.name}.{coordinate}"]
        dimension = dimension_of(coordinate)
        return float(self.problem.units.to_si(float(values[self.row]), dimension))

    def _joints(
        self,
        element: Any,
        joint: Joint,
        part: Part,
        frame: Pose,
        coordinates: tuple[tuple[str, float], ...],
        own: Floats,
    ) -> None:
        place = {"pos": _numbers(frame[:3, 3] - own)}
        if part.type.is_ball:
            _add(element, "joint", name=joint.name, type="ball", **place)
            return
        freedoms = zip(part.type.freedoms, coordinates, strict=True)
        for freedom, (coordinate, value) in freedoms:
            axis = _numbers(frame[:3, "xyz".index(freedom.axis)])
            full = f"{joint.name}.{coordinate}" if coordinate else ""
            name = joint.name if joint.type.freedoms == 1 else full
            if not name:
                name = f"{joint.name}.{1 + len(element.findall('joint'))}"
            kind = "slide" if freedom.is_slide else "hinge"
            told = {"axis": axis, "ref": repr(value), **self._limits(full), **place}
            if freedom.is_slide:
                del told["pos"]
            if full:
                self.names[full] = name
            made = _add(element, "joint", name=name, type=kind, **told)
            self._springs(made, full)
            if part.type.is_thread and joint.pitch:
                slide = {"axis": axis, "ref": repr(joint.pitch * value)}
                _add(element, "joint", name=f"{joint.name}.slide", type="slide", **slide)

    def _limits(self, full: str) -> dict[str, str]:
        for limit in self.problem.limits:
            if limit.name == full:
                if np.isfinite([limit.low, limit.high]).all():
                    return {"range": _numbers([limit.low, limit.high])}
                self._leave_out("limits with one end", full)
        return {}

    def _inertial(self, element: Any, link: str, own: Floats) -> None:
        body = self.mechanism.links[link]
        turn = self.poses[link][:3, :3]
        drawn = turn @ _tensor(body) @ turn.T
        mass, tensor = body.mass, self._real(drawn)
        if not mass > 0.0:
            mass = self._least
        if mass != body.mass or not np.allclose(
            tensor, drawn, rtol=0.0, atol=tolerances.CHANGED_INERTIA * np.max(tensor)
        ):
            self.changed[link] = (body.mass, *_entries(drawn))
        share = 1.0 / self.pieces[link]
        centre = self._placed(link, body.center_of_mass) - own
        inertia = {"mass": repr(share * mass), "fullinertia": _numbers(_entries(share * tensor))}
        _add(element, "inertial", pos=_numbers(centre), **inertia)

    @property
    def _least(self) -> float:
        """What a link without mass is given (kg)."""
        masses = (each.mass for each in self.mechanism.links.values())
        return tolerances.MUJOCO_LEAST_SHARE * max(masses, default=0.0) or 1.0

    def _real(self, tensor: Any) -> Any:
        """A tensor that MuJoCo takes as that of a body: principal moments that are positive, none
        above the sum of the others."""
        moments, axes = np.linalg.eigh(tensor)
        tensors = (_tensor(each) for each in self.mechanism.links.values())
        largest = max(float(np.max(np.abs(each))) for each in tensors)
        least = tolerances.MUJOCO_LEAST_SHARE * largest or self._least * (0.1 * self.size) ** 2
        raised = np.maximum(moments, max(least, tolerances.MUJOCO_LEAST_MOMENT * moments[2]))
        lack = raised[2] - raised[0] - raised[1]
        if lack > -tolerances.MUJOCO_TRIANGLE * raised[2]:
            raised[:2] += 0.5 * max(lack, 0.0) + tolerances.MUJOCO_TRIANGLE * raised[2]
        return tensor if np.array_equal(raised, moments) else (axes * raised) @ axes.T

    def _site(self, body: str, name: str, place: Floats) -> str:
        element, origin = self.elements[body]
        _add(element, "site", name=name, pos=_numbers(place - origin))
        return name

    # What closes loops, drives and pulls.

    def _closings(self, equality: Any) -> None:
        for joint in self.closing:
            if _is_cut(joint):
                kind = "connect" if joint.type.is_ball else "weld"
                one, other = joint.first, joint.second
                place = self._placed(one, joint.on_first.o)
                name = joint.name
            else:
                kind, name = "weld", f"{joint.name}.weld"
                link = joint.second if joint.second != GROUND_NAME else joint.first
                one, other = f"{link}.{joint.name}", link
                place = self.elements[one][1]
            sites = {
                "site1": self._site(one, f"{joint.name}.1", place),
                "site2": self._site(other, f"{joint.name}.2", place),
            }
            _add(equality, kind, name=name, **sites)

    def _couplings(self, equality: Any, tendons: Any) -> None:
        for joint in self.mechanism.joints.values():
            if joint.type.is_threaded and joint.pitch and self._is_drawn(joint):
                slope = f"0 {joint.pitch!r} 0 0 0"
                pair = {"joint1": f"{joint.name}.slide", "joint2": joint.name}
                _add(equality, "joint", name=f"{joint.name}.thread", polycoef=slope, **pair)
        for name, relation in self.mechanism.couplings.items():
            # MuJoCo counts a fixed tendon from where it is in the drawing
            _add(equality, "tendon", name=name, tendon1=name, polycoef="0 0 0 0 0")
            fixed = _add(tendons, "fixed", name=name)
            for term in relation.terms:
                name_of = self.names[f"{term.joint.name}.{term.coordinate}"]
                _add(fixed, "joint", joint=name_of, coef=repr(float(term.factor)))
            if relation.mesh is not None:
                self._leave_out("forces between teeth and in strands", name)
            if relation.loss is not None:
                self._leave_out("friction and losses", name)

    def _is_drawn(self, joint: Joint) -> bool:
        return joint.coordinates[0] in self.names

    def _drives(self, equality: Any) -> None:
        for joint, coordinate in self.problem.motion.driven:
            full = f"{joint}.{coordinate}"
            if full not in self.names:
                raise UsageError(f"the input {full} has no coordinate in MJCF; drive another one")
            held = {"name": f"{full}.drive", "joint1": self.names[full]}
            _add(equality, "joint", polycoef="0 0 0 0 0", **held)

    def _springs(self, made: Any, full: str) -> None:
        """Springs and dampers on a coordinate, as attributes of its joint."""
        stiffness = damping = pull = 0.0
        for load in self.mechanism.loads:
            if load.acts_at is None or ".".join(load.acts_at) != full:
                continue
            if isinstance(load, Spring):
                stiffness += load.stiffness
                pull += load.preload - load.stiffness * load.free
            elif isinstance(load, Damper):
                damping += load.damping
        if stiffness:
            made.set("stiffness", repr(stiffness))
            made.set("springref", repr(-pull / stiffness))
        elif pull:
            self._leave_out("constant forces", full)
        if damping:
            made.set("damping", repr(damping))

    def _loads(self, tendons: Any) -> None:
        for number, load in enumerate(self.mechanism.loads, 1):
            if isinstance(load, Spring | Damper):
                if load.between is None:
                    if f"{load.joint}.{load.coordinate}" not in self.names:
                        self._leave_out("springs and dampers on coordinates", f"{load.joint}")
                    continue
                self._between(tendons, number, load, load.between)
            elif isinstance(load, Bushing):
                self._leave_out("bushings", load.name or " to ".join(load.links))
            else:
                place = ".".join(load.acts_at) if load.acts_at else load.link
                self._leave_out("forces and torques", place)
        for rubbing in self.mechanism.frictions:
            self._leave_out("friction and losses", rubbing.joint)

    def _between(
        self, tendons: Any, number: int, load: Spring | Damper, ends: tuple[Attached, Attached]
    ) -> None:
        told = {}
        if isinstance(load, Spring):
            length = load.free - load.preload / load.stiffness if load.stiffness else -1.0
            if length < 0.0:
                self._leave_out("springs that pull at no length", f"load {number}")
                return
            told = {"stiffness": repr(load.stiffness), "springlength": repr(length)}
        else:
            told = {"damping": repr(load.damping)}
        spatial = _add(tendons, "spatial", name=f"load{number}", **told)
        for which, end in enumerate(ends, 1):
            name = f"load{number}.{which}"
            self._site(end.link, name, self._placed(end.link, end.vector))
            _add(spatial, "site", site=name)

    # What is not in the file.

    def _leave_out(self, what: str, name: str) -> None:
        known = self.left_out.setdefault(what, [])
        if name not in known:
            known.append(name)

    def notes(self) -> Iterator[Diagnostic]:
        """What the file lacks, and what it has beside the mechanism."""
        for what, names in self.left_out.items():
            message = f"left out of MJCF: {what}: {listed(names)}"
            yield Diagnostic("left-out", "warning", message)
        if self.changed:
            message = f"MuJoCo needs bodies with mass and inertia; given to {listed(self.changed)}"
            yield Diagnostic("mass-given", "note", message)
        if self.driven:
            message = f"the inputs are held as in row {self.row + 1}: {listed(sorted(self.driven))}"
            hint = "change the polycoef of their equality to move them"
            yield Diagnostic("inputs-held", "note", message, hint=hint)
        if self.analysis.run != SWEEP:
            yield Diagnostic("left-out", "warning", "left out of MJCF: efforts of the response")


def _is_cut(joint: Joint) -> bool:
    """Whether it closes a loop as it is: a ball or a weld."""
    return joint.type.is_ball or joint.type.freedoms == 0


def _add(parent: Any, kind: str, **attributes: str) -> Any:
    return ElementTree.SubElement(parent, kind, attributes)


def _numbers(values: Any) -> str:
    return " ".join(repr(float(x) + 0.0) for x in values)


def _matrix(frame: Frame) -> Pose:
    found = np.eye(4)
    found[:3] = np.column_stack([frame.x, frame.y, frame.z, frame.o])
    return found


def _matrix_of(pose: Floats) -> Pose:
    """A shift and a unit quaternion (7,) as a matrix."""
    w, x, y, z = pose[3:]
    found = np.eye(4)
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    found[:3, 3] = pose[:3]
    return found


def _displacement(part: Part, values: Any, pitch: float) -> Pose:
    """A part's displacement in its own frame; a ball's is unknown here, and left at rest."""
    found = np.eye(4)
    if part.type.is_ball:
        return found
    for freedom, value in zip(part.type.freedoms, values, strict=True):
        if freedom.is_slide:
            found["xyz".index(freedom.axis), 3] += value
        else:
            c, s = np.cos(value), np.sin(value)
            turn = np.eye(4)
            turn[:2, :2] = [[c, -s], [s, c]]
            turn[2, 3] = pitch * value if part.type.is_thread else 0.0
            found = found @ turn
    return found


def _entries(tensor: Any) -> list[float]:
    """xx, yy, zz, xy, xz, yz."""
    return [tensor[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]


def _tensor(body: RigidLink) -> Any:
    xx, yy, zz, xy, xz, yz = body.inertia
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
