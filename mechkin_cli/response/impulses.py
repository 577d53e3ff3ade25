"""What joints transmit in impacts: the table `NAME.impacts` of a response.

Over an impact the momenta of all links change by what limits, joints, couplings and drives give
them: M (v+ - v-) = impulses. These are the equations of motion with the jumps of the rates in place
of accelerations, at rest and without any load but the impulses of limits, so that reactions read
there are impulses. Limits do not touch what friction, springs and gravity do, which in no time is
nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism import ZERO, JointLoad, effort_quantity
from mechkin_cli.plan import demand_of
from mechkin_cli.record import replace
from mechkin_cli.response.integration import with_loads
from mechkin_cli.session import Ask
from mechkin_cli.sweep import SHIFTS
from mechkin_cli.tables import (
    Columns,
    TableColumn,
    column_of_numbers,
    unique_cells,
    words_of,
)
from mechkin_cli.units import FORCE, MOMENT, TIME

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from mechkin_cli.mechanism import Problem, Wanted
    from mechkin_cli.response.integration import Rebound
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats

_NAMES = {
    "force": "impulse",
    "moment": "angular_impulse",
    "torque": "angular_impulse",
    "tooth_force": "tooth_impulse",
    "effort": "effort_impulse",
}
"""What the last word of a reaction becomes."""


def impact_table(session: Session, run: str, rebounds: Sequence[Rebound]) -> Columns:
    """Columns time, event, the impulse of each limit along its coordinate, and the impulses that
    joints and couplings transmit and drives give, by components in the ground's axes; angular ones
    about the joint's point. A line for each impact, in the file's units; shares that are not unique
    (redundant constraints, limits that end one freedom) are nan.

    Args:
        session: of the free motion.
        run: the name of the response.
        rebounds: its impacts.
    """
    units = session.problem.units
    times = np.array([one.impact.time for one in rebounds])
    events = [
        "; ".join([one.words, *(f"{limit.name} rests" for limit in one.impact.held)])
        for one in rebounds
    ]
    columns = [
        TableColumn("time", units.label(TIME), np.array(units.from_si(times, TIME))),
        TableColumn("event", "", words_of(events)),
    ]
    # first those of the motion, then others that are as good
    pushed = [
        [one.others[number] if 0 <= number < len(one.others) else one.pushes for one in rebounds]
        for number in range(-1, max(len(one.others) for one in rebounds))
    ]
    given = list(dict.fromkeys(at for each in pushed for one in each for at in one))
    for joint, coordinate in given:
        dimension = effort_quantity(joint, coordinate).dimension * TIME
        at = joint, coordinate
        own, *others = (np.array([one.get(at, 0.0) for one in each]) for each in pushed)
        pushes = unique_cells(own, others)
        name = f"{joint}.{coordinate}.impulse"
        columns.append(
            column_of_numbers(name, units.label(dimension), units.from_si(pushes, dimension))
        )
    wanted = list(_transmitted(session.problem))
    read = [
        [
            _read(_struck(session, own), wanted, one, shift)
            for one, own in zip(rebounds, each, strict=True)
        ]
        for each in pushed
        for shift in (0, *(SHIFTS if session.is_redundant else ()))
    ]
    for number, quantity in enumerate(wanted):
        dimension = quantity.dimension * TIME
        owner, _, word = quantity.name.rpartition(".")
        for place, letter in zip(quantity.places, quantity.told, strict=False):
            own, *others = (np.array([rows[number][place] for rows in every]) for every in read)
            name = f"{owner}.{_NAMES[word]}"
            if len(quantity.places) > 1:
                name += f".{letter}"
            cells = units.from_si(unique_cells(own, others), dimension)
            columns.append(column_of_numbers(name, units.label(dimension), cells))
    title = f"Impacts of {run} and the impulses that joints transmit"
    return Columns(f"{run}.impacts", title, tuple(columns), of_rows=False)


def _transmitted(problem: Problem) -> Iterator[Wanted]:
    """Reactions of joints, what couplings transmit, and efforts of what is driven."""
    mechanism = problem.mechanism
    for quantity in problem.quantities().values():
        word = quantity.name.rpartition(".")[2]
        owned = quantity.owner in mechanism.joints or quantity.owner in mechanism.couplings
        if word == "effort":
            if (quantity.owner, quantity.coordinate) in problem.motion.driven:
                yield quantity
        elif owned and word in _NAMES and quantity.dimension in (FORCE, MOMENT):
            yield quantity


def _struck(session: Session, pushes: Mapping[tuple[str, str], float]) -> Session:
    """The session in which nothing acts but the impulses of limits, as forces."""
    problem = session.problem
    couplings = {
        name: relation._replace(pulls=()) for name, relation in problem.mechanism.couplings.items()
    }
    loads = tuple(JointLoad(*at, push) for at, push in pushes.items())
    mechanism = replace(
        problem.mechanism, loads=loads, gravity=ZERO, frictions=(), couplings=couplings
    )
    return with_loads(session, replace(problem, mechanism=mechanism))


def _read(session: Session, wanted: Sequence[Wanted], rebound: Rebound, shift: int) -> list[Floats]:
    """The components of some reactions over an impact, in SI."""
    readout = session.readout(wanted)
    demand = demand_of(session.problem.mechanism, wanted)
    assert rebound.rows.chart is not None
    # nothing rubs in that session
    chart = rebound.rows.chart._replace(friction=rebound.rows.chart.friction[:0])
    rows = rebound.rows._replace(chart=chart)
    batch = session.run(rows, Ask(demand, readout, shift=shift, iterations=0))
    assert batch.outputs is not None
    return [batch.outputs[readout.slots[quantity.name], 0] for quantity in wanted]
