"""URDF, the robot description of ROS, read as bodies on joints (wiki.ros.org/urdf/XML).

A URDF is a tree, drawn with all coordinates zero; its root is the ground. Loops are closed by
words of the command line, and coordinates coupled by `mimic`.
"""

from __future__ import annotations

from typing import Any, Final, Literal

import numpy as np

from mechkin_cli.bridges.bodies import WORLD, Body, Closing, Robot, Sum, Turning
from mechkin_cli.bridges.markup import Element, about, pose
from mechkin_cli.bridges.parts import listed, refuse
from mechkin_cli.diagnostics import UsageError, nearest_hint

TYPES: Final = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
_Z: Final = np.array([0.0, 0.0, 1.0])
_LEFT_OUT: Final = ("material", "transmission", "gazebo", "sensor", "ros2_control")


def read_urdf(root: Element, file: str, closed: tuple[str, ...] = ()) -> Robot:
    """The bodies of a URDF file.

    Args:
        root: its root element.
        file: its name in messages.
        closed: pairs of links, `A:B`, whose origins a ball keeps together, or `A:B:R` for a hinge
            about the z axes of their frames.

    Raises:
        InvalidFile: with the place of what is wrong.
        UsageError: a pair that is none.
    """
    robot = Robot(root.attributes.get("name", "robot"), file, "URDF")
    robot.gravity = np.array([0.0, 0.0, -9.81])
    links = _named(root, "link")
    joints = _named(root, "joint")
    if not links:
        refuse("no-links", "the robot has no links", root.at, "add <link> elements")
    below: dict[str, list[Element]] = {name: [] for name in links}
    carried: dict[str, Element] = {}
    for joint in joints.values():
        parent, child = (_end(joint, word, links) for word in ("parent", "child"))
        if child in carried:
            told = f"the link {child[:40]} has two parents"
            hint = "a URDF is a tree: leave one joint out, and close the loop by --close A:B"
            refuse("two-parents", told, joint.at, hint)
        carried[child] = joint
        below[parent].append(joint)
    roots = [name for name in links if name not in carried]
    if len(roots) != 1:
        told = f"the robot has {len(roots)} roots: {listed(roots) or 'its joints go round'}"
        refuse("no-tree", told, root.at, "join all links to one link, as a tree")
    _hang(robot, links, below, roots[0])
    for joint in joints.values():
        _mimic(robot, joint, joints)
    for pair in closed:
        robot.closings.append(_closing(robot, pair, root))
    for tag in _LEFT_OUT:
        for element in root.all(tag):
            robot.leave_out(f"<{tag}>", element.attributes.get("name", ""))
    return robot


def _named(root: Element, tag: str) -> dict[str, Element]:
    found: dict[str, Element] = {}
    for element in root.all(tag):
        name = element.text("name")
        if name in found:
            hint = "rename one of them"
            refuse("name-twice", f"there are two {tag}s {name[:40]!r}", element.at, hint)
        found[name] = element
    return found


def _end(joint: Element, word: str, links: dict[str, Element]) -> str:
    element = joint.first(word)
    if element is None:
        hint = f'add <{word} link="..."/>'
        refuse("missing-element", f"the joint has no <{word}>", joint.at, hint)
    name = element.text("link")
    if name not in links:
        hint = nearest_hint(name, links) or "name a link of the robot"
        refuse("unknown-link", f"there is no link {name[:40]!r}", element.at, hint)
    return name


def _hang(
    robot: Robot, links: dict[str, Element], below: dict[str, list[Element]], root: str
) -> None:
    """Places all links from the root on; the root does not move."""
    frames = {root: np.eye(4)}
    seen = {root}
    _contents(robot, links[root])
    robot.points[root] = WORLD, np.zeros(3)
    if links[root].first("inertial") is not None:
        robot.leave_out("the mass of the link that is the ground", root)
    queue = [root]
    for parent in queue:
        for joint in below[parent]:
            child = joint.first("child")
            assert child is not None
            name = child.attributes["link"].strip()
            frame = frames[parent] @ _origin(joint)
            body = Body(name, WORLD if parent == root else parent, frame, joint.at)
            body.joints += _joints(joint, frame, robot)
            robot.bodies[name] = body
            inertial = links[name].first("inertial")
            if inertial is not None:
                _inertial(inertial, body)
            _contents(robot, links[name])
            frames[name] = frame
            seen.add(name)
            queue.append(name)
    lost = [name for name in links if name not in seen]
    if lost:
        told = f"no joint leads from {root} to {listed(lost)}"
        refuse("no-tree", told, links[lost[0]].at, "join all links to one link, as a tree")


def _contents(robot: Robot, link: Element) -> None:
    for tag in ("visual", "collision"):
        if link.first(tag) is not None:
            robot.leave_out("shapes (visual, collision)")


def _origin(element: Element) -> Any:
    """The displacement of <origin>: roll, pitch and yaw about the fixed x, y and z axes."""
    origin = element.first("origin")
    if origin is None:
        return np.eye(4)
    roll, pitch, yaw = origin.numbers("rpy", (3,), "0 0 0")
    x, y, z = np.eye(3)
    turn = about(z, yaw) @ about(y, pitch) @ about(x, roll)
    return pose(turn, origin.numbers("xyz", (3,), "0 0 0"))


def _joints(joint: Element, frame: Any, robot: Robot) -> list[Turning]:
    name, kind = joint.attributes["name"].strip(), joint.text("type")
    if kind not in TYPES:
        hint = nearest_hint(kind, TYPES) or f"types are {listed(TYPES)}"
        refuse("unknown-type", f"there is no joint type {kind[:40]!r}", joint.at, hint)
    if kind == "fixed":
        return []
    element = joint.first("axis")
    default = np.array([1.0, 0.0, 0.0])
    own = default if element is None else element.direction("xyz", "1 0 0")
    axis, place = frame[:3, :3] @ own, frame[:3, 3]
    damping, limits = 0.0, None
    dynamics = joint.first("dynamics")
    if dynamics is not None:
        damping = dynamics.number("damping", "0") or 0.0
        if dynamics.number("friction", "0"):
            robot.leave_out("friction of joints", name)
        if damping and kind in ("floating", "planar"):
            robot.leave_out("damping of floating and planar joints", name)
    if kind == "floating":
        return [Turning(name, "free", frame[:3, :3] @ _Z, place)]
    limit = joint.first("limit")
    if limit is not None and kind in ("revolute", "prismatic"):
        low, high = limit.number("lower", "0") or 0.0, limit.number("upper", "0") or 0.0
        if low > high:
            hint = "write the least value as lower"
            refuse("no-range", "the range is empty", limit.at, hint, f"{low} to {high}")
        limits = (low, high) if low < high else None
        if "effort" in limit.attributes or "velocity" in limit.attributes:
            robot.leave_out("limits of effort and velocity")
    if kind == "planar":
        x = np.eye(3)[int(np.argmin(np.abs(axis)))]
        x = x - (x @ axis) * axis
        x /= np.linalg.norm(x)
        ways = (("x", "slide", x), ("y", "slide", np.cross(axis, x)), ("theta", "turn", axis))
        return [Turning(f"{name}.{word}", way, along, place) for word, way, along in ways]  # type: ignore[arg-type]
    motion: Any = "slide" if kind == "prismatic" else "turn"
    if damping < 0.0:
        refuse("negative-damping", "the damping is negative", joint.at, "correct it")
    return [Turning(name, motion, axis, place, limits=limits, damping=damping)]


def _inertial(inertial: Element, body: Body) -> None:
    mass = inertial.first("mass")
    value = None if mass is None else mass.number("value")
    if value is None or value < 0.0:
        hint = 'write <mass value="..."/>, 0 or more'
        refuse("no-mass", "an inertial needs a mass", inertial.at, hint)
    placed = body.frame @ _origin(inertial)
    tensor = np.zeros((3, 3))
    inertia = inertial.first("inertia")
    if inertia is not None:
        for i, one in enumerate("xyz"):
            for j, other in enumerate("xyz"):
                word = f"i{min(one, other)}{max(one, other)}"
                tensor[i, j] = inertia.number(word, "0") or 0.0
    turn = placed[:3, :3]
    body.add(value, placed[:3, 3], turn @ tensor @ turn.T)


def _mimic(robot: Robot, joint: Element, joints: dict[str, Element]) -> None:
    element = joint.first("mimic")
    if element is None:
        return
    name, leader = joint.attributes["name"].strip(), element.text("joint")
    single = ("revolute", "continuous", "prismatic")
    if leader not in joints:
        hint = nearest_hint(leader, joints) or "name a joint of the robot"
        refuse("unknown-joint", f"there is no joint {leader[:40]!r}", element.at, hint)
    for each in (joint, joints[leader]):
        if each.attributes.get("type") not in single:
            told = "mimic takes joints of one coordinate"
            refuse("no-coordinate", told, element.at, f"types are {listed(single)}")
    if leader == name:
        refuse("same-joint", "the joint mimics itself", element.at, "name another joint")
    multiplier = element.number("multiplier", "1") or 0.0
    offset = element.number("offset", "0") or 0.0
    if not multiplier:
        robot.held[name] = offset
        return
    factors = {name: 1.0, leader: -multiplier}
    robot.sums.append(Sum(f"{name}_mimic", factors, offset, element.at))


def _closing(robot: Robot, pair: str, root: Element) -> Closing:
    first, colon, rest = pair.partition(":")
    second, _, how = rest.partition(":")
    if not colon or how not in ("", "S", "R"):
        raise UsageError(
            f"--close {pair}: expected two links, as --close tip:bar for a ball at the origins of "
            "their frames, or tip:bar:R for a hinge about their z axes"
        )
    frames = []
    ends = []
    for name in (first, second):
        if name in robot.bodies:
            frames.append(robot.bodies[name].frame)
            ends.append(name)
        elif name in robot.points:
            frames.append(np.eye(4))
            ends.append(WORLD)
        else:
            known = [*robot.points, *robot.bodies]
            hint = nearest_hint(name, known) or f"its links are {listed(known)}"
            raise UsageError(f"--close {pair}: the robot has no link {name[:40]!r}; {hint}")
    if first == second:
        raise UsageError(f"--close {pair}: a link cannot close a loop with itself; name two")
    points = [frame[:3, 3] for frame in frames]
    if how == "R":
        points = [np.array([frame[:3, 3], frame[:3, 3] + frame[:3, 2]]) for frame in frames]
    one, other = (np.atleast_2d(point) for point in points)
    name = f"{first}_{second}"
    joint: Literal["hinge", "ball"] = "hinge" if how == "R" else "ball"
    return Closing(name, joint, ends[0], ends[1], one, other, root.at)
