"""Dead centres at which a sweep ends, as they are proven, in the file's units and words."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.proof.enclosures import (
    bounds,
    dead_centre_enclosure,
    input_bounds,
    is_angle_of_place,
    reason_against,
)
from mechkin_cli.analysis.proof.fold import are_one
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Number, UsageError
from mechkin_cli.interface.arguments import a_text
from mechkin_cli.proof import Proof
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.inputs import input_number, input_text

if TYPE_CHECKING:
    from mechkin_cli.analysis.proof.dead_centre import DeadCentre as Found
    from mechkin_cli.arrays import Floats
    from mechkin_cli.interface.analysis import Analysis

_WHY = {
    "inputs": "several inputs move there together, and it is looked for along one",
    "balls": "only balls turn there, and it is looked for along a joint coordinate",
    "box": "no box about it could be proven to hold exactly one: it may be two, or a branch point",
    "closure": "its loops are proven to closure alone",
    "branch": "it exists, that the branch of the rows leads to it could not be proven",
}


def counted_tubes(number: int) -> str:
    """`1 tube`, `2 tubes`."""
    return f"{number} tube" if number == 1 else f"{number} tubes"


class DeadCentre:
    """A dead centre beyond which rows are missing: a place where the input stops while the
    mechanism goes on.

    Attributes:
        row: the last row before it, counted from 0.
        tubes: how many tubes lead there from that row.
    """

    def __init__(self, analysis: Analysis, found: Found) -> None:
        self._analysis = analysis
        self._found = found
        self.row = found.row
        self.tubes = found.tubes

    @property
    def is_proven(self) -> bool:
        """Whether there is exactly one dead centre in the box of the enclosures, and the branch of
        the rows leads to it."""
        return self._found.why is None

    @property
    def status(self) -> str:
        """`proven` or `not proven`."""
        return (Proof.proven if self.is_proven else Proof.not_proven).label

    @property
    def why(self) -> str | None:
        """Why it is not proven, in words; None where it is."""
        return None if self._found.why is None else _WHY[self._found.why]

    @property
    def input(self) -> str:
        """The coordinate of which it is a dead centre, such as `O1.theta`."""
        return self._analysis.result.problem.motion.inputs[self._found.number].name

    @property
    def number(self) -> Number:
        """The input there in doubles, with its name and unit."""
        session = self._analysis.result.session
        value = float(self._found.place[self._found.number])
        return input_number(session.problem, session.layout, self._found.number, value)

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """Bounds of the input there in the file's units, between which the exact dead centre lies;
        nan where none is proven to exist."""
        return input_bounds(self._analysis.result.session, self._found)

    def enclosure(self, name: str) -> tuple[Floats, Floats]:
        """Bounds of a coordinate or a point of the position there in the file's units: two numbers,
        of a vector two arrays (3,); nan where no dead centre is proven to exist. Angles go on from
        the last row's with their whole turns; where the branch of the rows is not proven to lead
        there, they are those next to the last row's.

        Raises:
            UsageError: no such quantity, or one that is no position: at a dead centre rates by the
                input have no value.
        """
        a_text("quantity", name, '"O4.theta"')
        result = self._analysis.result
        wanted = result.problem.quantities().get(name)
        mechanism = result.problem.mechanism
        if (
            wanted is None
            or reason_against(wanted)
            or demand_of(mechanism, [wanted]) != Demand.POSITION
        ):
            raise UsageError(f"{name[:LONGEST_NAME]} is no position that is enclosed")
        if name == self.input:
            low, high = (np.array([[bound]]) for bound in self.bounds)
        else:
            row = np.asarray(self._analysis[name])[self.row]
            known = np.asarray(result.units.to_si(row, wanted.dimension)).reshape(-1, 1)
            turned = self._found.turned
            if turned is not None and is_angle_of_place(wanted):
                known = known + turned.of_angle(result.session, wanted)
            found = dead_centre_enclosure(result.session, self._found, wanted)
            low, high = bounds(result.problem, wanted, found, known)
        return (low[:, 0], high[:, 0]) if len(wanted.places) > 1 else (low[0, 0], high[0, 0])

    def is_same_as(self, other: DeadCentre) -> bool:
        """Whether two that are proven, of sweeps of one model, are proven to be the same: then the
        branches of both sweeps are one, which passes it, as those on its two sides.
        """
        one, two = self._found, other._found
        if one.fold is None or two.fold is None or one.why or two.why:
            return False
        return are_one(one.fold, two.fold)

    @property
    def words(self) -> str:
        """A part of a line for a person."""
        where = input_text(self.number)
        if self.is_proven:
            return f"one branch to a proven dead centre, {where} ({counted_tubes(self.tubes)})"
        return f"the dead centre at {where} is not proven: {self.why}"

    @property
    def diagnostic(self) -> Diagnostic:
        """That it is not proven, and why."""
        return Diagnostic("dead-centre-not-proven", "note", self.words, numbers=(self.number,))
