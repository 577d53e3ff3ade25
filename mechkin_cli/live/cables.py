"""How far cables are from leaving their pulleys, recorded: what `sweep/friction.py` judges rows by.

The joints of a cable's stretches are none that users see; the kernel's run writes their coordinates
beside what columns read.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

from mechkin_cli import tolerances
from mechkin_cli.mechanism import Swing, Wanted, dimension_of
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Mechanism, Relation, Term

    Plain = dict[str, Any]


def cable_coordinates(mechanism: Mechanism) -> list[Wanted]:
    """The coordinates by which cables are judged."""
    terms = (term for one in mechanism.couplings.values() for term in _terms(one))
    return list(dict.fromkeys(_coordinate(term) for term in terms))


def _terms(relation: Relation) -> Iterator[Term]:
    for extent in relation.extents:
        if isinstance(extent, Swing):
            yield extent.turn
            yield from (arm.slide for arm in (extent.base, extent.end) if arm.slide is not None)
        else:
            yield from extent.terms
    yield from (fleet.term for fleet in relation.fleets)


def _coordinate(term: Term) -> Wanted:
    name, dimension = f"{term.joint.name}.{term.coordinate}", dimension_of(term.coordinate)
    return Wanted(name, "coordinate", term.joint.name, dimension, False, term.coordinate)


def cable_verdicts(recording: Any) -> list[Plain]:
    """What is to stay above zero, or within a limit to both sides, and the verdict where it does
    not: places of cells and numbers."""
    found = []
    for relation in recording.recorded.mechanism.couplings.values():
        for extent in relation.extents:
            value = extent.value(partial(_value, recording))
            size = extent.drawn if extent.most is None else extent.most
            limit, status = tolerances.PARALLEL * size, Status.slack
            found.append(_verdict(recording, value, limit, status, False))
        for fleet in relation.fleets:
            value = _value(recording, fleet.term)
            value = value if fleet.length is None else value / fleet.length
            status = Status.fleet_angle
            found.append(_verdict(recording, value, tolerances.FLEET, status, True))
    return found


def _verdict(recording: Any, value: Any, limit: Any, status: Status, both: bool) -> Plain:
    cell, at = recording.cell(value), recording.number(limit)
    return {"cell": cell, "limit": at, "both": both, "status": int(status)}


def _value(recording: Any, term: Term) -> Any:
    """A factor times a coordinate, in rad or m."""
    slot = recording.reading.slots[_coordinate(term).name]
    return term.factor * recording.recorder.of("slot", slot.start)
