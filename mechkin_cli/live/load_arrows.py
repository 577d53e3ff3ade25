"""The arrows of loads in a page's picture, recorded: what `view/arrows.py` draws of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from mechkin_cli.derived import displacement
from mechkin_cli.expressions import Vector
from mechkin_cli.mechanism import (
    GROUND_NAME,
    Attached,
    Bushing,
    JointLoad,
    LinkLoad,
    Spring,
    Varying,
    is_angle,
    reference_point,
    subtract,
)
from mechkin_cli.tape import Recorded, square_root
from mechkin_cli.units import FORCE, MOMENT

if TYPE_CHECKING:
    from mechkin_cli.units import Dimension

NORMAL = (0.0, 0.0, 1.0)

Numbers = Sequence[Any]

Pending = tuple[str, Attached, Callable[[], Numbers]]
"""Name of an arrow, its place as drawn, and what makes its three numbers of a row, in the file's
unit, once it is known where the kernel's run writes what they need."""


def load_arrows(recording: Any, links: Sequence[str]) -> Iterator[Pending]:
    """The loads that can be recorded; those of laws as tables are left out."""
    own, drawn = recording.problem.mechanism, recording.recorded.mechanism
    pulling = (relation for relation in own.couplings.values() if relation.pulls)
    carriers = {relation.mesh.carrier for relation in pulling if relation.mesh is not None}
    taken: Counter[str] = Counter()
    for written, load in zip(own.loads, drawn.loads, strict=True):
        is_pull = written in own.pretensions
        for name, place, make in _of_load(recording, load, links, is_pull):
            # what pulls of one belt do to its carrier is together nothing
            if is_pull and place.link in carriers:
                continue
            taken[name] += 1
            yield f"{name}, {taken[name]}" if taken[name] > 1 else name, place, make


def _of_load(recording: Any, load: Any, links: Sequence[str], is_pull: bool) -> Iterator[Pending]:
    mechanism = recording.recorded.mechanism
    if isinstance(load, LinkLoad) and load.link in links:
        place = Attached(load.link, load.point)
        if load.kind == "torque" and load.link in mechanism.links:
            place = Attached(load.link, mechanism.links[load.link].center_of_mass)
        unit = FORCE if load.kind == "force" else MOMENT
        turn = load.link if load.axes == "link" else GROUND_NAME
        amounts = _amounts(recording, load.value)
        if amounts is not None:
            make = partial(_on_link, recording, turn, amounts, unit)
            yield f"{load.kind} on {load.link}", place, make
    elif isinstance(load, JointLoad):
        joint = mechanism.joints[load.joint]
        along = axis_of(recording, joint)
        amounts = _amounts(recording, (load.amount,))
        if along is not None and amounts is not None and len(joint.coordinates) == 1:
            unit = MOMENT if is_angle(load.coordinate) else FORCE
            make = partial(_at_joint, recording, along, amounts, unit)
            yield f"load at {load.name}", joint.point, make
    elif isinstance(load, Spring) and load.between is not None:
        word = "pretension" if is_pull else "spring"
        is_drawn = all(end.link in links for end in load.between)
        for k, end in enumerate(load.between if is_drawn else ()):
            yield f"{word} on {end.link}", end, _pull(recording, load, 1.0 - 2.0 * k)
    elif isinstance(load, Bushing) and load.name and not load.damps and load.links[1] in links:
        place = Attached(load.links[1], load.frames[1].o)
        for name, unit in ((f"{load.name}.force", FORCE), (f"{load.name}.moment", MOMENT)):
            if takes(recording, [name]):
                yield name, place, partial(_told, recording, name, unit)


def _on_link(recording: Any, link: str, amounts: Callable[[], Numbers], unit: Dimension) -> Numbers:
    return _in_units(recording, turned(recording, link, amounts()), unit)


def _at_joint(
    recording: Any, along: Callable[[], Numbers], amounts: Callable[[], Numbers], unit: Dimension
) -> Numbers:
    (amount,) = amounts()
    return _in_units(recording, [amount * _lifted(recording, part) for part in along()], unit)


def _pull(recording: Any, load: Any, sign: float) -> Callable[[], Numbers]:
    """What a spring between two points exerts on its first end (sign 1) or its second."""

    def make() -> Numbers:
        first, second = (placed(recording, end) for end in load.between)
        apart = [b - a for a, b in zip(first, second, strict=True)]
        length = square_root(sum((part * part for part in apart[1:]), start=apart[0] * apart[0]))
        preload, stiffness, free = (
            _lifted(recording, each) for each in (load.preload, load.stiffness, load.free)
        )
        share = (preload + stiffness * (length - free)) / length
        return _in_units(recording, [sign * share * part for part in apart], FORCE)

    return make


def axis_of(recording: Any, joint: Any) -> Callable[[], Numbers] | None:
    """The direction of a joint's axis; None where the page does not compute it."""
    name = f"{joint.name}.axis"
    if name not in recording.known:
        return (lambda: NORMAL) if joint.plane else None
    return partial(_in_space, recording, name) if takes(recording, [name]) else None


def _told(recording: Any, name: str, unit: Dimension) -> Numbers:
    return _in_units(recording, _in_space(recording, name), unit)


def _in_space(recording: Any, name: str) -> Numbers:
    """The three components of a vector, whatever of it users see."""
    value = recording.resolve(name).value
    parts = value.components if isinstance(value, Vector) else (value,)
    found: list[Any] = [0.0, 0.0, 0.0]
    for place, part in zip(recording.known[name].places, parts, strict=True):
        found[place] = part
    return found


def takes(recording: Any, names: Sequence[str]) -> bool:
    """Whether the page computes quantities, which it then does."""
    try:
        recording.need(names)
    except Exception as refused:
        if type(refused).__name__ != "LeftOut":
            raise
        return False
    return True


def _amounts(recording: Any, amounts: Sequence[Any]) -> Callable[[], Numbers] | None:
    """Forces or moments in SI; None where one follows from a table or from what is not computed."""
    laws = recording.recorded.load_laws
    varying = [laws[amount.number] for amount in amounts if isinstance(amount, Varying)]
    for law in varying:
        if law.expression is None or not takes(recording, law.reads):
            return None

    def value(amount: Any) -> Any:
        if isinstance(amount, Varying):
            amount = laws[amount.number].expression.evaluate(recording.resolve).value
        return _lifted(recording, amount)

    return lambda: [value(amount) for amount in amounts]


def _lifted(recording: Any, value: Any) -> Any:
    """A number on the tape of cells."""
    return recording.recorder.number(recording.recorder.lifted(value))


def _in_units(recording: Any, values: Numbers, dimension: Dimension) -> Numbers:
    return [recording.problem.units.from_si(value, dimension) for value in values]


def turned(recording: Any, link: str, vector: Numbers) -> Numbers:
    """A vector as drawn on a link, in the ground's axes."""
    lifted = [_lifted(recording, part) for part in vector]
    if link == GROUND_NAME:
        return lifted
    of, slots = recording.recorder.of, recording.reading.slots
    axes = [slots[quantity.name].start for quantity in displacement(link)[:3]]
    return [
        sum(
            (of("slot", at + k) * part for at, part in zip(axes[1:], lifted[1:], strict=True)),
            start=of("slot", axes[0] + k) * lifted[0],
        )
        for k in range(3)
    ]


def placed(recording: Any, at: Attached) -> Numbers:
    """Where a place as drawn on a link is, in the ground's axes, m."""
    if at.link == GROUND_NAME:
        return [_lifted(recording, part) for part in at.vector]
    reference = reference_point(recording.recorded.mechanism, at.link).vector
    start = recording.reading.slots[displacement(at.link)[3].name].start
    away = turned(recording, at.link, subtract(at.vector, reference))
    return [recording.recorder.of("slot", start + k) + away[k] for k in range(3)]


def arrow_record(recording: Any, at: int, place: Attached, values: Numbers) -> dict[str, Any]:
    """An arrow of the page: its number among those of the data, its cells, its place."""
    return {
        "arrow": at,
        "cells": [recording.cell(value) for value in values],
        "place": [recording.number(x) if isinstance(x, Recorded) else None for x in place.vector],
    }
