"""Small motions about a place, in named coordinates q and SI units:

    M q'' + C q' + K q = what else acts along q,

and what quantities add to their values by q, q' and q''. Forces are known along a chart u about the
place (statics/forces.py). With q' = N u' + P w', where w are the driven inputs, what would have to
act along q is N^-T times what would have to along u.

A place is held by constant efforts: of a sweep by those of its drives, which act along its inputs,
else by such along the named coordinates; at an equilibrium they are zero. At rest, with efforts e
along coordinates h that are such functions of u,

    K = N^-T (dr/du - sum of e_i d^2 h_i / du^2) N^-1,
    C = N^-T dr/du' N^-1,   M = N^-T dr/du'' N^-1,

where the second derivatives are accelerations at constant rates u'. About places that drives move,
the named coordinates rest, and N, P and the accelerations are followed beside the place.
"""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.expressions import Quantity, Vector
from mechkin_cli.mechanism import BEARING_KINDS, DERIVED_KINDS, is_angle
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import continuous_angle
from mechkin_cli.statics import DrivenAt, Forces, ForcesAt, FreePlace, differentiated, summed
from mechkin_cli.vibration.arithmetic import inverse, solved, times, turned
from mechkin_cli.vibration.inputs import bends

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.plan import Readout
    from mechkin_cli.session import Batch, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics import Derivative
    from mechkin_cli.vibration.inputs import InputForces


class Motions(NamedTuple):
    """Places about one, and motions there: displacements u (freedoms, places) of the chart, rates
    and accelerations of the named coordinates (freedoms, places) in SI, and what the driven inputs
    add to theirs (inputs, places) in kernel units; None: nothing."""

    u: Floats
    first: Floats
    second: Floats
    driven: DrivenAt


Values = tuple["Floats", "Bools"]
"""What is read at motions (numbers, places), and where it is known (places,)."""


class SmallMotions:
    """Small motions about a place.

    Args:
        session: of the free mechanism.
        driven: its inputs.
        place: gives the one about which it moves.
        coordinates: that are named, as many as there are freedoms.
        held_by: coordinates whose constant efforts hold the place; None: the named ones.
        inputs: what the drives of a sweep exert about the place, if the coordinates are its inputs:
            that tells the matrices at less cost.
    """

    def __init__(
        self,
        session: Session,
        driven: DrivenAt,
        place: Callable[[Forces], FreePlace],
        coordinates: Sequence[str],
        held_by: Sequence[str] | None = None,
        inputs: InputForces | None = None,
    ) -> None:
        self.session, self.driven, self._place = session, driven, place
        self.coordinates = tuple(coordinates)
        self.known: Mapping[str, Wanted] = session.problem.quantities()
        self.energy = session.layout.length**2
        self.moves = bool(driven.rates.any() or driven.accelerations.any())
        self.held_by = self.coordinates if held_by is None else tuple(held_by)
        self._inputs = inputs

    @cached_property
    def forces(self) -> Forces:
        """Of the free mechanism."""
        return Forces(self.session, self.driven)

    @cached_property
    def place(self) -> FreePlace:
        """About which it moves."""
        return self._place(self.forces)

    @cached_property
    def rates(self) -> Floats:
        """N at the place (1, coordinates, freedoms)."""
        return self._rates(np.zeros((self.forces.freedoms, 1)), self.driven)[0]

    @cached_property
    def inverse(self) -> Floats:
        """N^-1 there; nan or infinite where the coordinates do not tell the motion."""
        found: Floats = inverse(self.rates)[0]
        return found

    @cached_property
    def _pushes(self) -> Floats:
        """What has to act along the chart (freedoms, 1) to keep the place, J."""
        return self._left(self.still(), held=False)[0]

    @cached_property
    def efforts(self) -> Floats:
        """What the coordinates (freedoms,) need to stay."""
        if self._inputs is not None:
            return self._inputs.efforts
        return times(turned(self.inverse), self._pushes)[:, 0]

    @cached_property
    def _holding(self) -> Floats:
        """The efforts along the coordinates that hold the place."""
        if self.held_by == self.coordinates:
            return self.efforts
        here = np.zeros((self.forces.freedoms, 1))
        rates = self._rates(here, self.driven, self._readout(self.held_by, 1))[0]
        return solved(turned(rates)[0], self._pushes)[:, 0]

    @property
    def is_balanced(self) -> bool:
        """Whether what holds the place is rounding beside its stiffness."""
        largest = float(np.abs(self.matrices[0]).max(initial=0.0))
        return float(np.abs(self.efforts).max(initial=0.0)) <= tolerances.SMALL_IMBALANCE * largest

    def with_forces(self, forces: Forces) -> SmallMotions:
        """The same motions, read with other loads."""
        place, other = self.place, copy(self)
        other.forces, other.session, other.place = forces, forces.session, place
        return other

    def acting(self, forces: Forces) -> Floats:
        """What acts along the coordinates (freedoms,) at the place by what other forces have
        more."""
        still = self.still()
        without, _, _ = self._left(still, held=False)
        more, _, _ = self.with_forces(forces)._left(still, held=False)
        return times(turned(self.inverse), without - more)[:, 0]

    def still(self, count: int = 1) -> Motions:
        """The place itself, at rest, so many times."""
        zeros = np.zeros((self.forces.freedoms, count))
        return Motions(zeros, zeros, zeros, self.driven)

    def _readout(self, names: Sequence[str], order: int) -> Readout:
        """Rates (order 1) or accelerations (2) of coordinates."""
        suffix = "_dot" if order == 1 else "_ddot"
        return self.session.readout([self.known[name + suffix] for name in names])

    def _rates(
        self, u: Floats, driven: DrivenAt, readout: Readout | None = None
    ) -> tuple[Floats, Floats]:
        """N (places, coordinates, freedoms) and P w' (coordinates, places) at places."""
        n, places = u.shape
        units = np.concatenate([np.eye(n), np.zeros((n, 1))], axis=1)
        rates = np.repeat(units, places, axis=1)
        still = np.repeat([0.0] * n + [1.0], places)
        values, whole, full, moving = (
            _tiled(x, n + 1, places)
            for x in (driven.values, driven.whole, driven.full, driven.rates)
        )
        rest = np.zeros_like(moving)
        many = DrivenAt(values, whole, full, moving * still, rest, driven.time)
        readout = readout or self._readout(self.coordinates, 1)
        everywhere = np.tile(u, (1, n + 1))
        batch = self.forces.told(self.place, readout, everywhere, rates, np.zeros_like(rates), many)
        told = _outputs(batch, readout).reshape(-1, n + 1, places)
        return np.moveaxis(told[:, :n], -1, 0), told[:, n]

    def _motion(self, at: Motions) -> tuple[Floats, Floats, Floats]:
        """Rates and accelerations of the chart (freedoms, places), and N^-1 (places, ...)."""
        u, first, second, driven = at
        if not self.moves and driven is self.driven:
            # to first order: what rates bend is even in them
            return times(self.inverse, first), times(self.inverse, second), self.inverse[None]
        rates, drift = self._rates(u, driven)
        back = inverse(rates)
        one = _by_places(back, first - drift)
        readout = self._readout(self.coordinates, 2)
        batch = self.forces.told(self.place, readout, u, one, np.zeros_like(one), driven)
        bias = _outputs(batch, readout)
        return one, _by_places(back, second - bias), back

    def _left(self, at: Motions, *, held: bool = True) -> tuple[Floats, Bools, Floats]:
        """What would have to act along the chart (freedoms, places), J, less what holds where that
        is `held`; where it is known, and N^-1 (places, ...)."""
        one, two, back = self._motion(at)
        found = self.forces.at(self.place, at.u, one, two, at.driven)
        left = self.energy * found.forces
        if held:
            rates, _ = self._rates(at.u, at.driven, self._readout(self.held_by, 1))
            left = left - times(turned(rates), self._holding[:, None])[..., 0].T
        return left, found.good, back

    def _along(self, at: Motions) -> Values:
        """What would have to act along the named coordinates (freedoms, places), with places
        followed."""
        left, good, back = self._left(at)
        return _by_places(turned(back), left), good

    # Derivatives.

    def derivatives(self, read: Callable[[Motions], Values]) -> tuple[Floats, Floats, Floats]:
        """Derivatives (numbers, freedoms) of what is read by q, q' and q''."""
        n = self.forces.freedoms

        def by_first(first: Floats) -> ForcesAt:
            return _read(read, self.still(first.shape[1])._replace(first=first))

        still = self.still(n)
        moved, _ = read(still._replace(second=np.eye(n)))
        rested, _ = read(still)
        return self.gradient(read), differentiated(by_first, n).matrix, moved - rested

    def gradient(self, read: Callable[[Motions], Values]) -> Floats:
        """Derivatives (numbers, freedoms) of what is read by q."""
        return times(self._by_u(read), self.inverse)

    def _by_u(self, read: Callable[[Motions], Values]) -> Floats:
        """Derivatives (numbers, freedoms) by displacements of the chart."""

        def displaced(u: Floats) -> ForcesAt:
            return _read(read, self.still(u.shape[1])._replace(u=u))

        return differentiated(displaced, self.forces.freedoms).matrix

    @property
    def bends(self) -> bool:
        """Whether loads bend or jump at the place, so that the differences that stiffness and
        damping are taken from do not settle; not told where drives move it along other
        coordinates."""
        if self._inputs is not None:
            return self._inputs.bends
        if self.moves:
            return False
        inertia = self.forces.inertia(self.place)
        return any(bends(found, inertia) for found in self._derivatives)

    @cached_property
    def _derivatives(self) -> tuple[Derivative, ...]:
        """Of the forces along the chart by its displacements, and by its rates where loads read
        some."""
        found = [self.forces.stiffness(self.place)]
        if any(load.reads_rates for load in self.session.problem.mechanism.loads):
            found.append(self.forces.damping(self.place))
        return tuple(found)

    @cached_property
    def matrices(self) -> tuple[Floats, Floats, Floats]:
        """K, C, M (freedoms, freedoms)."""
        if self._inputs is not None:
            return self._inputs.matrices
        if self.moves:
            stiffness, damping, inertia = self.derivatives(self._along)
            return stiffness, damping, 0.5 * (inertia + inertia.T)
        along = self._derivatives[0].matrix
        stiffest = self.energy * float(np.abs(along).max(initial=0.0))
        if np.abs(self._pushes).max() > tolerances.NO_BEND * stiffest:
            along = along - self._bend() / self.energy
        damping = np.zeros_like(along)
        if len(self._derivatives) > 1:
            damping = self._derivatives[1].matrix
        inertia = self.forces.inertia(self.place)
        named = (
            self.energy * times(self.inverse.T, times(matrix, self.inverse))
            for matrix in (along, damping, 0.5 * (inertia + inertia.T))
        )
        stiffness, damping, inertia = named
        return stiffness, damping, inertia

    def _bend(self) -> Floats:
        """The second derivatives (freedoms, freedoms) by the chart of the coordinates along which
        efforts hold the place, each times its effort, J."""
        efforts, n = self._holding, self.forces.freedoms
        pairs = [(i, k) for i in range(n) for k in range(i, n)]
        rates = np.zeros((n, len(pairs)))
        for number, (i, k) in enumerate(pairs):
            rates[i, number] = rates[k, number] = 1.0
        none, readout = np.zeros_like(rates), self._readout(self.held_by, 2)
        seconds = _outputs(self.forces.told(self.place, readout, none, rates, none), readout)
        # v.H v of single motions, and of two at once
        squares = summed(efforts[:, None] * seconds)
        found = np.zeros((n, n))
        own = [number for number, (i, k) in enumerate(pairs) if i == k]
        for number, (i, k) in enumerate(pairs):
            both = squares[number] - squares[own[i]] - squares[own[k]]
            found[i, k] = found[k, i] = squares[number] if i == k else 0.5 * both
        return found

    def driven_derivatives(
        self, number: int, read: Callable[[Motions], Values] | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """Derivatives (numbers,) of what is read, or of what would have to act along the
        coordinates, by a driven input, its rate and its acceleration in kernel units, at q, q' and
        q'' as they are."""
        driven, n = self.driven, self.forces.freedoms
        unit = np.zeros(len(driven.values))
        unit[number] = 1.0

        def by(name: str) -> Floats:
            def moved(x: Floats) -> ForcesAt:
                more = unit[:, None] * x
                changed = {name: getattr(driven, name)[:, None] + more}
                if name == "values":
                    changed["full"] = driven.full[:, None] + more
                return _read(
                    read or self._along,
                    self.still(x.shape[1])._replace(driven=driven._replace(**changed)),
                )

            return differentiated(moved, 1).matrix[:, 0]

        # places at u = 0 move the coordinates, too: q is brought back to where it was
        along = driven._replace(rates=unit, accelerations=np.zeros_like(unit))
        back = times(self.inverse, self._rates(np.zeros((n, 1)), along)[1])
        if read is None:
            moved_back = times(self.matrices[0], times(self.rates[0], back))
        else:
            moved_back = times(self._by_u(read), back)
        by_place = by("values") - moved_back[:, 0]
        return by_place, by("rates"), by("accelerations")

    def reader(self, expressions: Sequence[Expression]) -> Callable[[Motions], Values]:
        """Reads the numbers of expressions, in SI.

        Raises:
            UsageError: a quantity that is not known beside a row.
            ExpressionError: an expression with no value.
        """
        problem = self.session.problem
        names = dict.fromkeys(name for one in expressions for name in sorted(one.names))
        wanted = [self.known[name] for name in names if name not in problem.parameters]
        for one in wanted:
            if one.owner == "row" or one.kind in (*DERIVED_KINDS, *BEARING_KINDS):
                raise UsageError(
                    f"{one.name} is not known beside a row; ask for what it follows from"
                )
            if demand_of(problem.mechanism, [one]) & Demand.JERK:
                raise UsageError(f"{one.name} is a jerk, which small motions do not have")
        readout = self.session.readout(wanted)
        before: dict[str, Floats] = {}

        def read(at: Motions) -> Values:
            one, two, _ = self._motion(at)
            batch = self.forces.told(self.place, readout, at.u, one, two, at.driven)
            outputs = batch.outputs
            assert outputs is not None

            def resolve(name: str) -> Quantity:
                if name in problem.parameters:
                    return problem.parameters[name]
                quantity = self.known[name]
                numbers = outputs[readout.slots[name]]
                if (
                    quantity.kind == "coordinate"
                    and not quantity.order
                    and is_angle(quantity.coordinate)
                ):
                    near = before.setdefault(name, numbers[:, :1])
                    numbers = continuous_angle(numbers, near)
                return Quantity(quantity.value(numbers), quantity.dimension)

            found = []
            for expression in expressions:
                value = expression.evaluate(resolve, problem.units).value
                parts = value.components if isinstance(value, Vector) else (value,)
                found += [np.broadcast_to(np.asarray(x, float), batch.good.shape) for x in parts]
            return np.array(found), batch.good

        read(self.still())  # where angles are, at the place itself
        return read


def _outputs(batch: Batch, readout: Readout) -> Floats:
    """Scalars (quantities, places) that were read."""
    assert batch.outputs is not None
    return batch.outputs[[readout.slots[wanted.name].start for wanted in readout.wanted]]


def _read(read: Callable[[Motions], Values], at: Motions) -> ForcesAt:
    """What is read, as what is differentiated."""
    values, good = read(at)
    return ForcesAt(values, values, values, good)


def _tiled(numbers: Floats, count: int, places: int) -> Floats:
    """Numbers (inputs,) or (inputs, places) for several motions at each place."""
    column = numbers[:, None] if numbers.ndim == 1 else numbers
    return np.tile(np.broadcast_to(column, (len(column), places)), (1, count))


def _by_places(matrices: Floats, columns: Floats) -> Floats:
    """Products (numbers, places) of matrices (places, numbers, n), or one for all, by columns (n,
    places)."""
    return times(matrices, columns.T[:, :, None])[..., 0].T
