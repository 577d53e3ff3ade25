"""Places of a mechanism and the forces that would have to hold it there.

A place is given by all inputs of a session: the coordinates that nothing drives, and the driven
ones. Forces are those of inverse dynamics at rest along the coordinates that nothing drives: zero
where the loads balance, and the slope of the potential energy where the loads have one. One kernel
call takes many places, in lanes.
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import ZERO, effort_quantity
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.session import Ask, RowInputs, balance, exchange, turn_of
from mechkin_cli.statics.forces import combined, summed

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from numpy.typing import NDArray

    from mechkin_cli.plan import Readout
    from mechkin_cli.session import Ending, Exchanged, Session
    from mechkin_cli.show import Bools, Floats


_FORCES = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES


class Place(NamedTuple):
    """Inputs (inputs,) with their whole turns, states (states,) and turns (turn slots,) of one
    closed place, in kernel units."""

    inputs: Floats
    state: Floats
    turns: Floats


class Places(NamedTuple):
    """Many places, in kernel units: inputs (inputs, places), states (states, places), turns (turn
    slots, places) and times (places,), s."""

    inputs: Floats
    states: Floats
    turns: Floats
    times: Floats

    @classmethod
    def of(cls, place: Place, time: float) -> Places:
        """One place as many."""
        return cls(
            place.inputs[:, None], place.state[:, None], place.turns[:, None], np.array([time])
        )

    def followed_by(self, others: Places) -> Places:
        """These and others."""
        return Places(*(np.concatenate(parts, axis=-1) for parts in zip(self, others, strict=True)))

    def only(self, which: slice | NDArray[np.intp]) -> Places:
        """Some of them."""
        return Places(
            self.inputs[:, which], self.states[:, which], self.turns[:, which], self.times[which]
        )

    def place(self, number: int) -> Place:
        """One of them."""
        return Place(self.inputs[:, number], self.states[:, number], self.turns[:, number])


class Forced(NamedTuple):
    """Forces (free, places) in N*m by the kernel's unit of each coordinate, states (states, places)
    and which places closed and have forces."""

    forces: Floats
    states: Floats
    good: Bools


class Way(NamedTuple):
    """Places along a way, as far as the branch could be followed: states (states, reached) and
    turns (turn slots, reached); the dead centre or branch point that it ends at, if it is known."""

    states: Floats
    turns: Floats
    ending: Ending | None = None

    @property
    def reached(self) -> int:
        """How many there are."""
        return int(self.states.shape[1])


class Statics:
    """The forces about places of a session.

    Args:
        session: whose first inputs, or those numbered `free`, nothing drives.
        free: their numbers.
    """

    def __init__(self, session: Session, free: Sequence[int]) -> None:
        self.session, self.free = session, list(free)
        problem = session.problem
        inputs = problem.motion.inputs
        self.units = np.array(
            [
                session.layout.mechanism.joints[inputs[k].joint].unit_of(
                    inputs[k].coordinate, session.layout.length
                )
                for k in self.free
            ]
        )
        self.cyclic = np.array(
            [turn_of(problem, item) is not None for item in inputs]
            + [False] * (len(session.driven) - len(inputs))
        )
        self._turns = np.where(self.cyclic, 2.0 * pi, np.inf)[:, None]

    @property
    def count(self) -> int:
        """Number of coordinates that nothing drives."""
        return len(self.free)

    @property
    def readout(self) -> Readout:
        """Efforts at the coordinates that nothing drives."""
        return _readout(self.session, tuple(self.free))

    def reduced(self, inputs: Floats) -> tuple[Floats, Floats]:
        """Inputs (inputs, places) without whole turns, and these."""
        whole = np.rint(inputs / self._turns)
        return inputs - whole * (2.0 * pi), whole

    def rows(self, inputs: Floats, states: Floats, turns: Floats, time: Floats) -> RowInputs:
        """What a run is given for places at rest."""
        reduced, whole = self.reduced(inputs)
        still = np.zeros_like(inputs)
        tied = self.session.constraint_rates
        if tied is not None:
            tied = np.repeat(tied[:, :1], inputs.shape[1], axis=1)
        return RowInputs(
            reduced, states, still, still, still, tied, turns, whole, inputs, time, None
        )

    def forces(self, inputs: Floats, states: Floats, turns: Floats, time: Floats) -> Forced:
        """Forces at places (inputs, places) closed from guesses (states, places)."""
        found = self.efforts(self.rows(inputs, states, turns, time))
        return found._replace(forces=found.forces * self.units[:, None])

    def efforts(self, rows: RowInputs) -> Forced:
        """What drives of the free coordinates would have to exert in rows, N*m or N."""
        readout = self.readout
        batch = self.session.run(rows, Ask(_FORCES, readout))
        assert batch.outputs is not None
        slots = [readout.slots[wanted.name].start for wanted in readout.wanted]
        efforts = batch.outputs[slots]
        good = batch.good & np.isfinite(efforts).all(axis=0)
        if batch.undefined is not None:
            good &= ~batch.undefined.astype(bool)
        return Forced(efforts, batch.states, good)

    def balanced(
        self, guesses: Places, stiffness: Floats | None = None, *, known: bool = False
    ) -> tuple[Places, Floats]:
        """Places that come to an equilibrium by Newton's steps from guesses, as many from the first
        one on as do so before one does not, and their stiffness (free, free, places).

        Args:
            guesses: where the steps start.
            stiffness: (free, free, places) to go by; None: each place's own, which ends before its
                determinant changes its sign.
            known: whether the first place is an equilibrium, which stays.
        """
        tied = self.session.constraint_rates
        if tied is not None:
            tied = np.repeat(tied[:, :1], guesses.times.size, axis=1)
        rows = RowInputs(
            guesses.inputs,
            guesses.states,
            constraint_rates=tied,
            turned=guesses.turns,
            time=guesses.times,
        )
        readout = self.readout
        slots = (readout.slots[wanted.name].start for wanted in readout.wanted)
        free = [*zip(self.free, slots, self.units.tolist(), strict=True)]
        cyclic = np.flatnonzero(self.cyclic).tolist()
        lanes, threads = self.session.packing
        count, inputs, states, slopes = balance(
            self.session.plan,
            rows,
            free,
            cyclic,
            readout,
            stiffness,
            known=known,
            lanes=lanes,
            threads=threads,
        )
        at = Places(inputs, states, guesses.turns, guesses.times)
        return at.only(slice(0, count)), slopes[:, :, :count]

    def largest_at(self, inputs: Floats, states: Floats, turns: Floats, time: Floats) -> Floats:
        """The largest force of one load alone, or of all weights, at each of many places (places,):
        what balances there, N*m by kernel units."""
        most = np.zeros(inputs.shape[1])
        for session in _alone(self.session):
            found = Statics(session, self.free).forces(inputs, states, turns, time)
            sizes = np.max(np.abs(found.forces), axis=0)
            most = np.where(found.good, np.maximum(most, sizes), most)
        return most

    def tangents(
        self, inputs: Floats, states: Floats, moved: Sequence[int] | None = None
    ) -> Floats:
        """Rates of the columns (numbers, columns, places) where one free coordinate, or input
        `moved`, after the other has unit rate."""
        places = inputs.shape[1]
        numbers = self.free if moved is None else moved
        repeated = np.tile(np.arange(places), len(numbers))
        rates = np.zeros((inputs.shape[0], repeated.size))
        for number, k in enumerate(numbers):
            rates[k, number * places : (number + 1) * places] = 1.0
        reduced, _ = self.reduced(inputs)
        rows = RowInputs(reduced[:, repeated], states[:, repeated], rates)
        batch = self.session.run(rows, Ask(Demand.VELOCITY, derivatives=True, iterations=0))
        assert batch.first is not None
        return batch.first.reshape(-1, len(numbers), places).transpose(1, 0, 2)

    def beside(self, place: Place, steps: Floats, time: Floats) -> Forced:
        """Forces (free, steps) where all inputs are `steps` (inputs, steps) away, at times."""
        moved = np.flatnonzero(steps.any(axis=1)).tolist()
        inputs = place.inputs[:, None] + steps
        states = np.repeat(place.state[:, None], steps.shape[1], axis=1)
        if moved:
            tangents = self.tangents(place.inputs[:, None], place.state[:, None], moved)[:, :, 0]
            states = self.session.moved_along(states, combined(tangents, steps[moved]))
        turns = np.repeat(place.turns[:, None], steps.shape[1], axis=1)
        return self.forces(inputs, states, turns, time)

    def slopes(
        self, place: Place, time: float, more: Floats | None = None, times: Floats | None = None
    ) -> tuple[Floats, Floats] | None:
        """Forces (free, 1 + more) at a place and where all inputs are `more` (inputs, more) away,
        at `times` (more,), and the slopes (free, free) of those at the place; None where one has
        no value."""
        count, h = self.count, tolerances.NEWTON_DIFFERENCE
        extra = np.zeros((place.inputs.size, 0)) if more is None else more
        here = 2 * count
        steps = np.zeros((place.inputs.size, here + 1 + extra.shape[1]))
        steps[:, here + 1 :] = extra
        moments = np.full(steps.shape[1], time)
        moments[here + 1 :] = time if times is None else times
        # as far as the mechanism moves, which is much beside a dead centre
        tangents = self.tangents(place.inputs[:, None], place.state[:, None])[:, :, 0]
        sizes = np.maximum(np.sqrt(summed((tangents * tangents).T)), 1.0)
        for number, k in enumerate(self.free):
            steps[k, 2 * number : 2 * number + 2] = np.array([h, -h]) / sizes[number]
        found = self.beside(place, steps, moments)
        if not found.good.all():
            return None
        changes = found.forces[:, :here:2] - found.forces[:, 1:here:2]
        return found.forces[:, here:], changes * sizes / (2.0 * h)

    def beside_dead_centre(
        self, place: Place, known: Place, *, surely: bool = False
    ) -> Exchanged | None:
        """What tells places apart about `place` where the free coordinates, which do so at a
        `known` place, stand near a dead centre there; None where they do not, unless they `surely`
        do."""
        session, layout = self.session, self.session.layout
        tangents = self.tangents(place.inputs[:, None], place.state[:, None])[:, :, 0]
        sizes = np.sqrt(summed((tangents * tangents).T))
        if not surely and (sizes <= 1.0 / tolerances.NEAR_DEAD_CENTRE).all():
            return None
        # what moves most there, in place of the free coordinate that it moves with most before
        way = tangents[int(np.argmax(np.where(np.isfinite(sizes), sizes, -1.0)))]
        moved = [
            max(abs(float(way[layout.column(*at)])) for at in block.unknowns)
            for block in session.graph.blocks
        ]
        if not np.isfinite(moved).any():
            return None
        block = int(np.nanargmax(moved))
        before = self.tangents(known.inputs[:, None], known.state[:, None])[:, :, 0]
        others = [exchange(session, number, block, way) for number in self.free]
        told = [
            abs(float(before[k, one.driven.column]))
            if one is not None and one.driven.name[1] in _scalars(one)
            else -1.0
            for k, one in enumerate(others)
        ]
        best = int(np.argmax(told))
        return others[best] if told[best] > 0.0 else None

    def place(self, inputs: Floats, state: Floats) -> Place:
        """A closed place at some inputs, to which nothing was followed."""
        reduced, whole = self.reduced(np.stack([inputs, inputs], axis=1))
        found = self.session.follow(reduced, state, turns=True, whole=whole)
        assert found.turns is not None
        return Place(inputs, state, found.turns[:, 0])

    def way(self, inputs: Floats, place: Place) -> Way:
        """The places along straight ways between `inputs` (inputs, places), the first of which is
        that of `place`, as far as the branch leads."""
        reduced, whole = self.reduced(inputs)
        found = self.session.follow(reduced, place.state, turns=True, turn=place.turns, whole=whole)
        assert found.turns is not None
        count = found.reached
        return Way(found.guess[:, :count], found.turns[:, :count], found.ending)


def _scalars(one: Exchanged) -> Collection[str]:
    """The names of the coordinates of the joint that is driven instead."""
    edge, _ = one.driven.at
    return one.session.graph.edges[edge].joint.type.scalars


@remembered
def _readout(session: Session, free: tuple[int, ...]) -> Readout:
    inputs = session.problem.motion.inputs
    return session.readout([effort_quantity(inputs[k].joint, inputs[k].coordinate) for k in free])


@remembered
def _alone(session: Session) -> tuple[Session, ...]:
    """Sessions in which one load acts alone, or all weights."""
    problem = session.problem
    mechanism = problem.mechanism
    acting = [
        replace(mechanism, loads=(load,), gravity=ZERO, frictions=()) for load in mechanism.loads
    ]
    if mechanism.gravity != ZERO:
        acting.append(replace(mechanism, loads=(), frictions=()))
    return tuple(session.loaded(replace(problem, mechanism=each)) for each in acting)


def eigen(matrix: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues, rising, and vectors as columns of a symmetric matrix of finite numbers."""
    found = _kernel.symmetric_eigen(np.ascontiguousarray(matrix), np.eye(len(matrix)))
    assert found is not None
    return found
