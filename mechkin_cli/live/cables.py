"""How far cables are from leaving their pulleys, recorded: what `sweep/friction.py` judges rows by.

The joints of a cable's stretches are none that users see; the kernel's run writes their coordinates
beside what columns read.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from mechkin_cli import tolerances
from mechkin_cli.mechanism import Swing, Wanted, dimension_of
from mechkin_cli.tape import cos, sin, square_root
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Arm, Extent, Mechanism, Relation, Term

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
            of = _swing if isinstance(extent, Swing) else _extent
            size = extent.drawn if extent.most is None else extent.most
            limit, status = tolerances.PARALLEL * size, Status.slack
            found.append(_verdict(recording, of(recording, extent), limit, status, False))
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


def _extent(recording: Any, extent: Extent) -> Any:
    """As `Extent.value`."""
    together: Any = 0.0
    for term in extent.terms:
        together = together + _value(recording, term)
    return extent.drawn + together


def _swing(recording: Any, swing: Swing) -> Any:
    """As `Swing.value`."""
    turn = _value(recording, swing.turn)
    (x, y), (out, beside) = _arm(recording, swing.base), _arm(recording, swing.end)
    across = out * cos(turn) - beside * sin(turn), out * sin(turn) + beside * cos(turn)
    return swing.offset + (x * across[1] - y * across[0]) / square_root(x * x + y * y)


def _arm(recording: Any, arm: Arm) -> list[Any]:
    by: Any = 0.0 if arm.slide is None else _value(recording, arm.slide)
    return [a + by * b for a, b in zip(arm.drawn, arm.along, strict=True)]
