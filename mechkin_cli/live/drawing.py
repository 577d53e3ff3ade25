"""What hangs on parameters in a page's picture: poses, arrows, and places as drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING, Any

from mechkin_cli.derived import displacement
from mechkin_cli.expressions import Vector, constant, lookup
from mechkin_cli.live.load_arrows import arrow_record, axis_of, load_arrows, takes
from mechkin_cli.mechanism import FIRST, GROUND_NAME, SECOND, reference_point, scale
from mechkin_cli.tables import effort_names
from mechkin_cli.tape import Recorded
from mechkin_cli.units import LENGTH
from mechkin_cli.view import Lengths, drawn_joints, half_axis, half_frame

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Attached, Joint, Mechanism

    Plain = dict[str, Any]

Later = Callable[[], list["Plain"]]
"""Makes records once it is known where the kernel's run writes what they need."""


def pose_records(recording: Any, data: Mapping[str, Any]) -> Later:
    """The poses of links: where the run writes a link's place and the ground axes as drawn on it,
    and the place as drawn, numbers of the recording."""
    mechanism: Mechanism = recording.problem.mechanism
    drawn: Mechanism = recording.recorded.mechanism
    links = [one["name"] for one in data["links"]]
    moving = [name for name in links if name != GROUND_NAME and name in mechanism.links]
    for name in moving:
        recording.wanted |= {quantity.name: quantity for quantity in displacement(name)}

    def records() -> list[Plain]:
        slots = recording.reading.slots
        found = []
        for name in moving:
            axes = [slots[quantity.name].start for quantity in displacement(name)]
            place = reference_point(drawn, name).vector
            found.append(
                {
                    "link": links.index(name),
                    "axes": axes[:3],
                    "place": axes[3],
                    "drawn": [recording.number(number) for number in place],
                }
            )
        return found

    return records


def arrows_of(recording: Any, data: Mapping[str, Any]) -> Later:
    """The arrows of the data that follow from quantities: of joints, drives and loads."""
    problem = recording.problem
    names = {arrow["name"]: at for at, arrow in enumerate(recording.shown["branches"][0]["arrows"])}
    joints: Mapping[str, Joint] = recording.recorded.mechanism.joints
    pending: list[tuple[int, Attached, Callable[[], Sequence[Any]]]] = []
    for name, at in names.items():
        joint, _, word = name.rpartition(".")
        if word in ("force", "moment") and joint in joints and takes(recording, [name]):
            pending.append((at, joints[joint].point, partial(_in_space, recording, name)))
    driven = [f"{joint}.{coordinate}" for joint, coordinate in problem.acting]
    for name, effort in zip(driven, effort_names(driven), strict=True):
        own = joints[name.rpartition(".")[0]]
        along = axis_of(recording, own) if effort in names else None
        if along is not None and takes(recording, [effort]):
            place = own.point
            pending.append((names[effort], place, partial(_along, recording, effort, along)))
    links = [one["name"] for one in data["links"]]
    for name, place, make in load_arrows(recording, links):
        if name in names:
            pending.append((names[name], place, make))

    def records() -> list[Plain]:
        pending.sort(key=lambda each: each[0])
        return [arrow_record(recording, at, place, make()) for at, place, make in pending]

    return records


def _in_space(recording: Any, name: str) -> list[Any]:
    """The three components of a vector in the file's units."""
    units, quantity = recording.problem.units, recording.resolve(name)
    parts = quantity.value.components if isinstance(quantity.value, Vector) else (quantity.value,)
    found: list[Any] = [0.0, 0.0, 0.0]
    for place, part in zip(recording.known[name].places, parts, strict=True):
        found[place] = units.from_si(part, quantity.dimension)
    return found


def _along(recording: Any, name: str, axis: Callable[[], Sequence[Any]]) -> list[Any]:
    """A number along an axis, in the file's unit."""
    quantity = recording.resolve(name)
    size = recording.problem.units.from_si(quantity.value, quantity.dimension)
    return [size * part for part in axis()]


def drawing_of(recording: Any, data: Mapping[str, Any]) -> Plain:
    """Numbers of the page's data that hang on parameters: their paths in the data, their places
    among the recording's numbers, and what these are divided by."""
    units = recording.problem.units
    places = []
    for path, value, is_length in _drawn(recording, data):
        if isinstance(value, Recorded):
            number = units.from_si(value, LENGTH) if is_length else value
            places.append([path, recording.number(number), 1])
    return {"first": 0, "places": places}


def _drawn(recording: Any, data: Mapping[str, Any]) -> Iterator[tuple[list[Any], Any, bool]]:
    drawn: Mechanism = recording.recorded.mechanism
    own: Mechanism = recording.problem.mechanism
    for at, joint in enumerate(drawn_joints(drawn)):
        for side in (FIRST, SECOND):
            frame, axis = half_frame(joint, side), half_axis(joint, side)
            base = half_frame(own.joints[joint.name], side)
            base_axis = half_axis(own.joints[joint.name], side)
            across = frame.z if base_axis == base.x else frame.x
            path = ["joints", at, "halves", side]
            yield from _vector([*path, "point"], frame.o, True)
            yield from _vector([*path, "axis"], axis, False)
            yield from _vector([*path, "x"], across, False)
            if data["joints"][at]["halves"][side].get("axis2"):
                yield from _vector([*path, "axis2"], scale(-1.0, frame.y), False)
    for at, (_, point) in enumerate(drawn.points.items()):
        yield from _vector(["points", at, "place"], point.vector, True)
    yield from _links(recording, data, own, drawn)
    yield from _ties(recording, data, own, drawn)
    yield from _radii(recording, data)
    yield from _cables(recording, data)


def _vector(path: list[Any], vector: Any, is_length: bool) -> Iterator[tuple[list[Any], Any, bool]]:
    for k, number in enumerate(vector):
        yield [*path, k], number, is_length


def _links(
    recording: Any, data: Mapping[str, Any], own: Mechanism, drawn: Mechanism
) -> Iterator[tuple[list[Any], Any, bool]]:
    """The points through which links are drawn: each is a joint's or a named point."""
    units = recording.problem.units
    shown = recording.analysis.model.view_settings.shapes
    for at, link in enumerate(data["links"]):
        if link["name"] in shown and shown[link["name"]].points is not None:
            continue
        own_points = _points(own, link["name"])
        drawn_points = _points(drawn, link["name"])
        chosen: list[Any] = []
        for place in link["shape"]["points"]:
            near = (
                now
                for was, now in zip(own_points, drawn_points, strict=True)
                if all(
                    float(units.from_si(float(a), LENGTH)) == b
                    for a, b in zip(was, place, strict=True)
                )
            )
            chosen.append(next(near, None))
        for k, vector in enumerate(chosen):
            if vector is not None:
                yield from _vector(["links", at, "shape", "points", k], vector, True)
        if link["shape"].get("centre") is not None and chosen and None not in chosen:
            count = float(len(chosen))
            for k in range(3):
                total = sum((v[k] for v in chosen[1:]), start=chosen[0][k])
                yield ["links", at, "shape", "centre", k], total / count, True


def _ties(
    recording: Any, data: Mapping[str, Any], own: Mechanism, drawn: Mechanism
) -> Iterator[tuple[list[Any], Any, bool]]:
    """The ends of springs, dampers and cylinders between points: each is a named point."""
    lengths = Lengths(recording.problem.units)
    links = data["links"]
    run = data["runs"].index(recording.shown)
    for at, tie in enumerate(recording.shown["ties"]):
        for k, (link, place) in enumerate(zip(tie["links"], tie["places"], strict=False)):
            named = (
                drawn.points[name]
                for name, point in own.points.items()
                if point.link == links[link]["name"] and lengths.vector(point.vector) == place
            )
            for point in islice(named, 1):
                yield from _vector(["runs", run, "ties", at, "places", k], point.vector, True)


def _radii(recording: Any, data: Mapping[str, Any]) -> Iterator[tuple[list[Any], Any, bool]]:
    """The radii of wheels and pulleys whose coupling gives them."""
    problem, model = recording.problem, recording.analysis.model
    units, lengths = problem.units, Lengths(problem.units)
    links = data["links"]
    for section in model.built.file.couplings.values():
        radii = getattr(section, "radii", None) or ()
        for name, text in zip(section.joints if radii else (), radii, strict=False):
            joint = problem.mechanism.joints.get(name)
            radius = constant(text, LENGTH, units, lookup(recording.recorded.parameters))
            if joint is None or not isinstance(radius, Recorded):
                continue
            own = lengths.one(constant(text, LENGTH, units, lookup(problem.parameters)))
            for at, wheel in enumerate(data["wheels"]):
                is_there = links[wheel["link"]]["name"] in (joint.first, joint.second)
                if is_there and wheel["radius"] == own:
                    yield ["wheels", at, "radius"], radius, True


def _cables(recording: Any, data: Mapping[str, Any]) -> Iterator[tuple[list[Any], Any, bool]]:
    """How far cables run beside the centres of their pulleys and drums."""
    problem, couplings = recording.problem, recording.analysis.model.built.file.couplings
    cables = (one.path for one in couplings.values() if one.type == "cable")
    for at, (path, cable) in enumerate(zip(cables, data["cables"], strict=True)):
        for k, (place, beside) in enumerate(zip(path, cable["beside"], strict=True)):
            text = getattr(place, "radius", None)
            if text is not None and beside:
                known = lookup(recording.recorded.parameters)
                radius: Any = constant(text, LENGTH, problem.units, known)
                yield ["cables", at, "beside", k], radius if beside > 0.0 else -radius, True


def _points(mechanism: Mechanism, link: str) -> list[Any]:
    found = [at.vector for _, at in mechanism.joint_points() if at.link == link]
    found += [at.vector for at in mechanism.points.values() if at.link == link]
    body = mechanism.links.get(link)
    if body is not None:
        found.append(body.center_of_mass)
    return found
