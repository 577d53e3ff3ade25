"""MJCF, the format of MuJoCo, read as bodies on joints (https://mujoco.readthedocs.io, XML
reference): defaults and classes, frames, joints, inertias given or made of geoms, and the equality
constraints that close loops.

Everything is drawn as the file draws it, which is MuJoCo's `qpos0`.
"""

from __future__ import annotations

from typing import Any, Final, Literal

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.bridges.bodies import WORLD, Body, Closing, Line, Robot, Sum, Turning
from mechkin_cli.bridges.markup import Element, about, from_quaternion, pose
from mechkin_cli.bridges.mjcf_export import INERTIA
from mechkin_cli.bridges.mjcf_geoms import geom_mass
from mechkin_cli.bridges.parts import refuse

_MOTIONS: Final = {"hinge": "turn", "slide": "slide", "ball": "ball", "free": "free"}
_REFUSED: Final = {
    "include": "put the included file's text in its place",
    "replicate": "write the copies out",
    "attach": "write the attached model out",
    "composite": "write its bodies out",
    "flexcomp": "flexible bodies have no counterpart; leave it out",
    "model": "write the attached model out",
}
_LEFT_OUT: Final = (
    *("asset", "contact", "sensor", "actuator", "keyframe", "visual", "statistic", "deformable"),
    *("extension", "size"),
)
_ON_BODIES: Final = ("camera", "light", "plugin")
_ORIENTATIONS: Final = ("quat", "axisangle", "xyaxes", "zaxis", "euler")
_DISABLED: Final = ("equality", "limit", "spring", "damper", "passive", "constraint")
_GRAVITY: Final = (0.0, 0.0, -9.81)


def read_mjcf(root: Element, file: str) -> Robot:
    """The bodies of an MJCF file.

    Raises:
        InvalidFile: with the place of what is wrong, or has no counterpart.
    """
    return _Reader(root, file).robot()


class _Reader:
    def __init__(self, root: Element, file: str) -> None:
        self.root, self.file = root, file
        self.model = Robot(root.attributes.get("model", "mechanism"), file, "MJCF")
        self.compiler: dict[str, str] = {}
        for element in root.all("compiler"):
            self.compiler |= element.attributes
        self.in_degrees = self.compiler.get("angle", "degree") != "radian"
        self.groups = (0.0, np.inf)
        for element in self.root.all("compiler"):
            given = element.numbers("inertiagrouprange", (2,))
            self.groups = self.groups if given is None else (float(given[0]), float(given[1]))
        self.model.angle = "deg" if self.in_degrees else "rad"
        self.classes: dict[str, dict[str, dict[str, str]]] = {"": {}}
        self.sites: dict[str, tuple[str, Any]] = {}
        self.joints: dict[str, Turning] = {}
        self.bodies = self.model.bodies
        self.drawn: set[str] = set()
        self.used: set[str] = set()
        self.kept: set[str] = set()

    def robot(self) -> Robot:
        """All sections in their order of need."""
        self._check()
        for element in self.root.all("default"):
            self._defaults(element, self.classes[""], "main")
        gravity = None
        for option in self.root.all("option"):
            given = option.numbers("gravity", (3,))
            gravity = gravity if given is None else given
        self.model.gravity = np.array(_GRAVITY) if gravity is None else gravity
        for option in self.root.all("option"):
            for flag in option.all("flag"):
                self._flag(flag)
        for world in self.root.all("worldbody"):
            self._children(world, WORLD, np.eye(4), "")
        self._bound_masses()
        self._scale_masses()
        for element in self.root.all("equality"):
            self._equality(element)
        for element in self.root.all("tendon"):
            self._tendons(element)
        for element in self.root.all("custom"):
            self._custom(element)
        self._points()
        return self.model

    def _check(self) -> None:
        """Refuses what would change the mechanism unseen, and names what does not."""
        stack = [self.root]
        while stack:
            element = stack.pop()
            if element.tag in _REFUSED and element is not self.root:
                told = f"<{element.tag}> is not read"
                refuse("not-read", told, element.at, _REFUSED[element.tag])
            stack.extend(element.children)
        for element in self.root.all(*_LEFT_OUT):
            for child in element.children or [element]:
                name = child.attributes.get("name", "")
                self.model.leave_out(element.tag, name or child.tag)
        if self.compiler.get("coordinate", "local") != "local":
            place = next(self.root.all("compiler")).at
            refuse("not-read", "global coordinates are not read", place, "use local ones")

    def _flag(self, flag: Element) -> None:
        """Takes gravity away where a flag does; what else one switches off is named, and stays."""
        if flag.attributes.get("gravity") == "disable":
            self.model.gravity = None
        for word in _DISABLED:
            if flag.attributes.get(word) == "disable":
                self.model.leave_out("flags that disable", word)

    def _bound_masses(self) -> None:
        """Brings masses and inertias to what the compiler demands of each body."""
        for element in self.root.all("compiler"):
            least = element.number("boundmass", "0") or 0.0
            least_inertia = element.number("boundinertia", "0") or 0.0
            is_balanced = element.attributes.get("balanceinertia", "false") == "true"
            if not (least > 0.0 or least_inertia > 0.0 or is_balanced):
                continue
            for body in self.bodies.values():
                if body.centre is None:
                    body.add(0.0, body.frame[:3, 3], np.zeros((3, 3)))
                body.mass = max(body.mass, least)
                moments, axes = np.linalg.eigh(body.inertia)
                if is_balanced and moments[0] + moments[1] < moments[2]:
                    moments = np.full(3, moments.mean())
                body.inertia = axes @ np.diag(np.maximum(moments, least_inertia)) @ axes.T

    def _scale_masses(self) -> None:
        """Brings the mass of all bodies to what the compiler says."""
        for element in self.root.all("compiler"):
            wanted = element.number("settotalmass", "-1") or 0.0
            total = sum(body.mass for body in self.bodies.values())
            if wanted > 0.0 and total > 0.0:
                for body in self.bodies.values():
                    if body.inertia is not None:
                        body.mass *= wanted / total
                        body.inertia = body.inertia * (wanted / total)

    # Defaults.

    def _defaults(self, element: Element, above: dict[str, dict[str, str]], name: str) -> None:
        own = {tag: dict(values) for tag, values in above.items()}
        for child in element.children:
            if child.tag != "default":
                values = {k: v for k, v in child.attributes.items() if k != "class"}
                own[child.tag] = _over(own.get(child.tag, {}), values)
        name = element.attributes.get("class", name)
        self.classes[name] = own
        if name == "main":
            self.classes[""] = own
        for child in element.all("default"):
            self._defaults(child, own, child.text("class"))

    def _full(self, element: Element, around: str) -> Element:
        """An element with the attributes of its class."""
        name = element.attributes.get("class", around)
        if name not in self.classes:
            known = ", ".join(sorted(filter(None, self.classes))[:8]) or "none"
            hint = f"define it under <default>; known are {known}"
            refuse("unknown-class", f"there is no class {name[:40]!r}", element.at, hint)
        given = self.classes[name].get(element.tag, {})
        return element._replace(attributes=_over(given, element.attributes))

    # Bodies.

    def _children(self, element: Element, parent: str, frame: Any, around: str) -> None:
        """Everything below a body (or frame) that stands at `frame` in the drawing."""
        for child in element.children:
            if child.tag == "body":
                self._body(child, parent, frame, around)
            elif child.tag == "frame":
                within = child.attributes.get("childclass", around)
                self._children(child, parent, frame @ self._pose(child), within)
            elif child.tag == "site":
                full = self._full(child, around)
                name = full.attributes.get("name")
                if name and name not in self.sites:
                    self.sites[name] = parent, frame @ self._pose(full)
            elif child.tag == "geom":
                self._geom(child, parent, frame, around)
            elif child.tag in _ON_BODIES:
                self.model.leave_out(f"{child.tag}s", child.attributes.get("name", ""))
            elif child.tag in ("joint", "freejoint") and parent != WORLD:
                self._joint(child, parent, frame, around)
            elif child.tag not in ("inertial", "joint", "freejoint"):
                self.model.leave_out(f"<{child.tag}>", child.attributes.get("name", ""))

    def _body(self, element: Element, parent: str, above: Any, around: str) -> None:
        name = element.attributes.get("name") or f"body_{len(self.bodies) + 1}"
        if name in self.bodies or name == "world":
            refuse("name-twice", f"there are two bodies {name[:40]!r}", element.at, "rename one")
        frame = above @ self._pose(element)
        body = Body(name, parent, frame, element.at)
        self.bodies[name] = body
        around = element.attributes.get("childclass", around)
        if (element.number("gravcomp", "0") or 0.0) != 0.0:
            self.model.leave_out("gravcomp of bodies", name)
        inertial = element.first("inertial")
        from_geoms = self.compiler.get("inertiafromgeom", "auto") == "true"
        if inertial is not None and not from_geoms:
            self._inertial(inertial, body)
            self.drawn.add(name)
        self._children(element, name, frame, around)
        if inertial is not None and from_geoms and not body.mass:
            # its geoms have no mass, or there are none
            self._inertial(inertial, body)

    def _pose(self, element: Element) -> Any:
        place = element.numbers("pos", (3,), "0 0 0")
        return pose(self._turn(element), place)

    def _turn(self, element: Element) -> Any:
        """The orientation of an element, in whichever way it is written."""
        quaternion = element.numbers("quat", (4,))
        if quaternion is not None:
            if float(np.linalg.norm(quaternion)) < tolerances.NO_DIRECTION:
                refuse("no-direction", "the quaternion is zero", element.at, "correct it")
            return from_quaternion(quaternion)
        turned = element.numbers("axisangle", (4,))
        if turned is not None:
            if float(np.linalg.norm(turned[:3])) < tolerances.NO_DIRECTION:
                refuse("no-direction", "the axis of axisangle is zero", element.at, "correct it")
            return about(turned[:3] / np.linalg.norm(turned[:3]), self._angle(turned[3]))
        axes = element.numbers("xyaxes", (6,))
        if axes is not None:
            return self._from_axes(element, axes[:3], axes[3:])
        z = element.direction("zaxis")
        if z is not None:
            return shortest_from_z(z)
        euler = element.numbers("euler", (3,))
        if euler is None:
            return np.eye(3)
        found = np.eye(3)
        sequence = self.compiler.get("eulerseq", "xyz")
        if len(sequence) != 3 or set(sequence.lower()) - set("xyz"):
            refuse("not-read", f"eulerseq {sequence[:20]!r}", element.at, 'write "xyz" or so')
        for letter, value in zip(sequence, euler, strict=True):
            turn = about(np.eye(3)["xyz".index(letter.lower())], self._angle(value))
            # small letters turn with the body, capitals stand still
            found = found @ turn if letter.islower() else turn @ found
        return found

    def _from_axes(self, element: Element, x: Any, y: Any) -> Any:
        length = float(np.linalg.norm(x))
        x = x / length if length > tolerances.NO_DIRECTION else x
        y = y - (y @ x) * x
        if length <= tolerances.NO_DIRECTION or float(np.linalg.norm(y)) <= tolerances.NO_DIRECTION:
            refuse(
                "no-direction",
                "the axes of xyaxes are parallel or zero",
                element.at,
                "correct them",
            )
        y = y / np.linalg.norm(y)
        return np.column_stack([x, y, np.cross(x, y)])

    def _angle(self, value: float) -> float:
        return float(np.radians(value)) if self.in_degrees else float(value)

    def _inertial(self, element: Element, body: Body) -> None:
        mass = element.number("mass")
        if mass is None or mass < 0.0:
            refuse("no-mass", "an inertial needs a mass, 0 or more", element.at, 'write mass="..."')
        placed = self._pose(element)
        entries = element.numbers("fullinertia", (6,))
        diagonal = element.numbers("diaginertia", (3,), "0 0 0")
        if entries is not None:
            xx, yy, zz, xy, xz, yz = entries
            tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        else:
            tensor = np.diag(diagonal)
        turn = (body.frame @ placed)[:3, :3]
        body.add(mass, (body.frame @ placed)[:3, 3], turn @ tensor @ turn.T)

    def _geom(self, element: Element, parent: str, frame: Any, around: str) -> None:
        full = self._full(element, around)
        name = full.attributes.get("name", "")
        self.model.leave_out("geoms (shapes and contacts)")
        if parent == WORLD or parent in self.drawn or not self._counts(full):
            return
        found = geom_mass(full, self._turn)
        if found is None:
            kind = full.attributes.get("type", "sphere")
            shell = "shells of " if kind == "ellipsoid" else ""
            self.model.leave_out(f"masses of {shell}geoms of type {kind[:20]}", name)
            return
        mass, placed, tensor = found
        turn = (frame @ placed)[:3, :3]
        if mass > 0.0:
            self.bodies[parent].add(mass, (frame @ placed)[:3, 3], turn @ tensor @ turn.T)

    def _counts(self, geom: Element) -> bool:
        """Whether the compiler takes a geom for the mass of its body."""
        if self.compiler.get("inertiafromgeom", "auto") == "false":
            return False
        group = geom.number("group", "0") or 0.0
        return bool(self.groups[0] <= group <= self.groups[1])

    def _joint(self, element: Element, body: str, frame: Any, around: str) -> None:
        is_free = element.tag == "freejoint"
        full = element if is_free else self._full(element, around)
        kind = "free" if is_free else full.attributes.get("type", "hinge")
        if kind not in _MOTIONS:
            hint = f"types are {', '.join(_MOTIONS)}"
            refuse("unknown-type", f"there is no joint type {kind[:40]!r}", full.at, hint)
        own = self.bodies[body]
        count = len(own.joints)
        name = full.attributes.get("name") or f"{body}_joint{'' if not count else count + 1}"
        if name in self.joints:
            refuse("name-twice", f"there are two joints {name[:40]!r}", full.at, "rename one")
        motion = _MOTIONS[kind]
        axis = full.direction("axis", "0 0 1")
        place = full.numbers("pos", (3,), "0 0 0")
        if motion == "free":
            axis, place = np.array([0.0, 0.0, 1.0]), np.zeros(3)
        read = self._angle if motion == "turn" else float
        has_value = motion in ("turn", "slide")
        spring_ref = full.number("springref", "0") or 0.0
        stiffness, damping = (
            full.numbers("stiffness", (1, 2, 3), "0"),
            full.numbers("damping", (1, 2, 3), "0"),
        )
        joint = Turning(
            name,
            motion,  # type: ignore[arg-type]
            frame[:3, :3] @ axis,
            (frame @ [*place, 1.0])[:3],
            read(full.number("ref", "0") or 0.0) if has_value else 0.0,
            self._limits(full, read) if has_value else None,
            float(stiffness[0]) if has_value else 0.0,
            read(spring_ref),
            float(damping[0]) if has_value else 0.0,
        )
        if np.any(stiffness[1:]) or np.any(damping[1:]):
            self.model.leave_out("stiffness and damping beyond the linear", name)
        if "springdamper" in full.attributes:
            self.model.leave_out("springdamper of joints", name)
        for word in ("armature", "frictionloss"):
            if (full.number(word, "0") or 0.0) != 0.0:
                self.model.leave_out(f"{word} of joints", name)
        if not has_value and (np.any(stiffness) or np.any(damping) or "range" in full.attributes):
            self.model.leave_out("springs, dampers and ranges of ball and free joints", name)
        self.joints[name] = joint
        own.joints.append(joint)

    def _limits(self, element: Element, read: Any) -> tuple[float, float] | None:
        given = element.numbers("range", (2,))
        limited = element.attributes.get("limited", "auto")
        auto = self.compiler.get("autolimits", "true") != "false"
        if given is None or limited == "false" or (limited == "auto" and not auto):
            return None
        low, high = map(read, given)
        if not low < high:
            hint = "write the least value first"
            refuse("no-range", "the range is empty", element.at, hint, f"{given[0]} to {given[1]}")
        return low, high

    # What closes loops.

    def _equality(self, section: Element) -> None:
        connects: dict[tuple[str, str], list[Closing]] = {}
        for number, element in enumerate(section.children, 1):
            full = self._full(element, "")
            name = full.attributes.get("name") or f"{element.tag}_{number}"
            if full.attributes.get("active", "true") == "false":
                self.model.leave_out("equality constraints that are not active", name)
            elif element.tag in ("connect", "weld"):
                found = self._pair(full, name)
                if element.tag == "weld":
                    self.model.closings.append(found)
                else:
                    connects.setdefault((found.first, found.second), []).append(found)
            elif element.tag == "joint":
                self._joint_equality(full, name)
            elif element.tag == "tendon":
                self._tendon_equality(full, name)
            else:
                self.model.leave_out(f"equality {element.tag}", name)
        for points in connects.values():
            self.model.closings += _joined(points)

    def _pair(self, element: Element, name: str) -> Closing:
        kind: Literal["weld", "ball"] = "weld" if element.tag == "weld" else "ball"
        if "site1" in element.attributes or "site2" in element.attributes:
            (first, one), (second, other) = (
                self._known(element, word, self.sites, "site") for word in ("site1", "site2")
            )
            self.used |= {element.attributes[word] for word in ("site1", "site2")}
            shift = other @ np.linalg.inv(one)
        else:
            ends = []
            for word in ("body1", "body2"):
                named = element.attributes.get(word, "world" if word == "body2" else "")
                if named != "world":
                    self._known(element, word, self.bodies, "body")
                ends.append(WORLD if named == "world" else named)
            first, second = ends
            frames = [np.eye(4) if end == WORLD else self.bodies[end].frame for end in ends]
            anchor = element.numbers("anchor", (3,), "0 0 0")
            on = frames[1] if kind == "weld" else frames[0]
            one = other = pose(np.eye(3), (on @ [*anchor, 1.0])[:3])
            shift = np.eye(4)
            given = element.numbers("relpose", (7,), "0 1 0 0 0 0 0") if kind == "weld" else None
            if given is not None and np.any(given[3:]):
                # where the second body stands, seen from the first
                wanted = frames[0] @ pose(from_quaternion(given[3:]), given[:3])
                shift = frames[1] @ np.linalg.inv(wanted)
        return Closing(
            name, kind, first, second, one[None, :3, 3], other[None, :3, 3], element.at, shift
        )

    def _known(self, element: Element, word: str, known: Any, what: str) -> Any:
        name = element.text(word)
        if name not in known:
            hint = f"name a {what} of the model"
            refuse(f"unknown-{what}", f"there is no {what} {name[:40]!r}", element.at, hint)
        return known[name]

    def _joint_equality(self, element: Element, name: str) -> None:
        one = self._known(element, "joint1", self.joints, "joint")
        powers = element.numbers("polycoef", (1, 2, 3, 4, 5), "0 1 0 0 0")
        if "joint2" not in element.attributes:
            self.model.held[one.name] = one.ref + powers[0]
            return
        other = self._known(element, "joint2", self.joints, "joint")
        if np.any(powers[2:]):
            told = f"{name} is a polynomial of higher order"
            hint = "leave it out, and write a coupling of type function"
            refuse("not-read", told, element.at, hint)
        slope = float(powers[1]) if powers.size > 1 else 0.0
        total = one.ref + float(powers[0]) - slope * other.ref
        self.model.sums.append(Sum(name, {one.name: 1.0, other.name: -slope}, total, element.at))

    def _tendon_equality(self, element: Element, name: str) -> None:
        wanted = element.text("tendon1")
        fixed = [
            each
            for section in self.root.all("tendon")
            for each in section.all("fixed")
            if each.attributes.get("name") == wanted
        ]
        if not fixed or "tendon2" in element.attributes:
            self.model.leave_out("equality of spatial or of two tendons", name)
            return
        powers = element.numbers("polycoef", (1, 2, 3, 4, 5), "0 1 0 0 0")
        factors: dict[str, float] = {}
        total = float(powers[0])
        for part in fixed[0].all("joint"):
            joint = self._known(part, "joint", self.joints, "joint")
            factor = part.number("coef") or 0.0
            factors[joint.name] = factors.get(joint.name, 0.0) + factor
            total += factor * joint.ref
        factors = {joint: factor for joint, factor in factors.items() if factor}
        if len(factors) == 1:
            ((joint_name, factor),) = factors.items()
            self.model.held[joint_name] = total / factor
        elif factors:
            self.model.sums.append(Sum(name, factors, total, element.at))

    # Springs, points, and what this format has no place for.

    def _tendons(self, section: Element) -> None:
        for element in section.children:
            name = element.attributes.get("name", "")
            stiffness = element.numbers("stiffness", (1, 2, 3), "0")
            damping = element.numbers("damping", (1, 2, 3), "0")
            if np.any(stiffness[1:]) or np.any(damping[1:]):
                self.model.leave_out("stiffness and damping beyond the linear", name)
            if "range" in element.attributes:
                self.model.leave_out("ranges of tendons", name)
            if element.tag != "spatial":
                if np.any(stiffness) or np.any(damping):
                    self.model.leave_out("springs of fixed tendons", name)
                continue
            ends = [
                each.attributes.get("site", "") for each in element.children if each.tag == "site"
            ]
            is_plain = len(ends) == len(element.children) == 2 and all(
                e in self.sites for e in ends
            )
            if not is_plain:
                self.model.leave_out("tendons over more than two sites", name)
                continue
            one, other = (self.sites[end][1][:3, 3] for end in ends)
            length = element.numbers("springlength", (1, 2), "-1")
            if length.size == 2 and length[0] != length[1]:
                self.model.leave_out("springs with a range of rest", name)
                continue
            free = float(length[0]) if length[0] >= 0.0 else float(np.linalg.norm(one - other))
            self.kept |= set(ends)
            pair = ends[0], ends[1]
            if stiffness[0]:
                values = {"stiffness": float(stiffness[0]), "free": free}
                self.model.lines.append(Line("spring", pair, values))
            if damping[0]:
                self.model.lines.append(Line("damper", pair, {"damping": float(damping[0])}))

    def _points(self) -> None:
        for name, (body, frame) in self.sites.items():
            if name not in self.used or name in self.kept:
                self.model.points[name] = body, frame[:3, 3]

    def _custom(self, section: Element) -> None:
        for element in section.children:
            name = element.attributes.get("name", "")
            body = name.removeprefix(INERTIA)
            if element.tag == "numeric" and name.startswith(INERTIA) and body in self.bodies:
                values = element.numbers("data", (7,))
                if values is not None:
                    tensor = self.bodies[body].frame[:3, :3]
                    self.model.exact[body] = _turned(values, tensor)
            else:
                self.model.leave_out("custom data", name)


def _over(given: dict[str, str], own: dict[str, str]) -> dict[str, str]:
    """Attributes over those of a class; an orientation of its own replaces that of the class,
    however either is written."""
    if not own.keys().isdisjoint(_ORIENTATIONS):
        given = {key: value for key, value in given.items() if key not in _ORIENTATIONS}
    return given | own


def _turned(values: Any, turn: Any) -> Any:
    """Mass and inertia with the inertia's axes turned."""
    mass, xx, yy, zz, xy, xz, yz = values
    tensor = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
    entries = [tensor[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    return [mass, *entries]


def _joined(points: list[Closing]) -> list[Closing]:
    """The connects of two bodies as one joint: one is a ball, two are a hinge, three a weld."""
    one = points[0]
    if len(points) == 1:
        return points
    first = np.vstack([each.on_first for each in points])
    second = np.vstack([each.on_second for each in points])
    far = max(range(len(points)), key=lambda k: float(np.linalg.norm(first[k] - first[0])))
    if float(np.linalg.norm(first[far] - first[0])) < tolerances.SAME_PLACE:
        return [one]
    if len(points) == 2:
        return [one._replace(kind="hinge", on_first=first, on_second=second)]
    return [one._replace(kind="weld", shift=np.eye(4))]


def shortest_from_z(z: Any) -> Any:
    """The shortest turn that carries z onto a unit vector."""
    across = np.cross([0.0, 0.0, 1.0], z)
    length = float(np.linalg.norm(across))
    if length < tolerances.PARALLEL_AXIS:
        return np.eye(3) if z[2] > 0.0 else about(np.array([1.0, 0.0, 0.0]), np.pi)
    return about(across / length, float(np.arctan2(length, z[2])))
