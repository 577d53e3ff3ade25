"""Proofs of a sweep in the file's units and words."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from mechkin_cli.arguments import a_text
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Number, UsageError
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.proofs import (
    are_one,
    bounds,
    dead_centre_enclosure,
    enclosures,
    input_bounds,
    inside_boxes,
    is_angle_of_place,
    reason_against,
    reason_unknown,
)
from mechkin_cli.session import input_number, input_text
from mechkin_cli.show import Listed, Listing
from mechkin_cli.verdict import SWEEP, Proof

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.proofs import DeadCentreProof as Found, Enclosure, Gap, SweepProofs
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep import Readable


# Dead centres at which a sweep ends, as they are proven, in the file's units and words.

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


class SweepDeadCentre:
    """A dead centre beyond which rows are missing: a place where the input stops while the
    mechanism goes on.

    Attributes:
        row: the last row before it, counted from 0.
        tubes: how many tubes lead there from that row.
    """

    def __init__(self, analysis: Readable, found: Found) -> None:
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

    def is_same_as(self, other: SweepDeadCentre) -> bool:
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


# Which rows that are proven have no bounds of a quantity, and why.

_NOT_ENCLOSED_WHY: Final = {
    "value": (
        "it has no finite value there, or is not unique",
        "row.status and the notes of the analysis say which",
    ),
    "input": (
        "the input is farther from what the file's text says than the row's box holds",
        "write the law so that its terms do not cancel",
    ),
    "box": (
        "it is not bounded over the row's box",
        "the place is singular or nearly so: look at row.condition and row.status",
    ),
}


def not_enclosed(
    name: str, proven: Bools, has_value: Bools, is_inside: Bools, bounded: Bools
) -> tuple[Diagnostic, ...]:
    """A note for each reason, with the rows; all arrays (rows,).

    Args:
        proven: rows of which something is proven.
        has_value: rows with a number in doubles.
        is_inside: rows whose inputs as the text says them are among those of their boxes.
        bounded: rows with bounds.
    """
    missing = proven & ~bounded
    reasons = {
        "value": missing & ~has_value,
        "input": missing & has_value & ~is_inside,
        "box": missing & has_value & is_inside,
    }
    return tuple(_note(name, why, rows) for why, rows in reasons.items() if rows.any())


def _note(name: str, why: str, chosen: Bools) -> Diagnostic:
    rows = np.flatnonzero(chosen) + 1
    first, last = int(rows[0]), int(rows[-1])
    where = f"row {first}" if rows.size == 1 else f"{rows.size} rows from {first} to {last}"
    words, hint = _NOT_ENCLOSED_WHY[why]
    numbers = (Number("rows", rows.size), Number("first_row", first), Number("last_row", last))
    text = f"{name} has no bounds in {where}, proven as that is: {words}"
    return Diagnostic("not-enclosed", "note", text, hint=hint, numbers=numbers)


GAPS_TOLD = 4
"""Gaps that are told one by one."""

_CERTIFICATE_WHY = {
    "no position": "there is no position",
    "box": "no box about the position could be proven to hold exactly one",
    "branch": "the positions are proven, that they continue those of the rows before is not",
}
_CURE = {
    "no position": None,
    "box": "the place is singular or nearly so: look at row.condition and row.status",
    "branch": "ask for rows between the last that is proven and the first that is not",
}


class Certificate(Listed):
    """What is proven of the rows of a sweep.

    Raises:
        UsageError: the rows are those of a response.
    """

    def __init__(self, analysis: Readable) -> None:
        if analysis.run != SWEEP:
            raise UsageError(f"{analysis.run} is a response: proofs are of sweeps")
        self.analysis = analysis
        self._found: SweepProofs = analysis.result.certificate

    @property
    def listing(self) -> Listing:
        """What is proven, and where nothing is."""
        head = f"Certificate of {self.analysis.model.name}: {self.words}"
        return Listing(head, notes=tuple(str(one) for one in self.diagnostics))

    @cached_property
    def status(self) -> NDArray[np.str_]:
        """`proven`, `proven to closure` or `not proven` of every row (rows,)."""
        labels = np.array([proof.label for proof in Proof])
        found: NDArray[np.str_] = labels[self._found.status]
        return found

    @property
    def is_one_branch(self) -> bool:
        """Whether all rows are proven, or proven to closure: as the inputs go straight from each
        row to the next, the mechanism moves through all of these positions."""
        return self._found.is_complete

    @property
    def tubes(self) -> int:
        """How many tubes join the rows."""
        return self._found.tubes

    @cached_property
    def dead_centres(self) -> tuple[SweepDeadCentre, ...]:
        """The dead centres beyond which rows are missing, one for each way along the rows that ends
        at one."""
        return tuple(SweepDeadCentre(self.analysis, found) for found in self._found.dead_centres)

    @property
    def closure(self) -> Floats:
        """At most the size of the closing equations beyond those solved for, anywhere in the
        row's box (rows,): lengths in the kernel's unit; nan where nothing is proven."""
        boxes = self._found.boxes
        return np.where(boxes.proven, boxes.beyond, np.nan)

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Where nothing is proven, and why."""
        gaps = self._found.gaps
        told = [self._told(gap) for gap in gaps[:GAPS_TOLD]]
        if not self._found.of_text:
            text = (
                "what is proven is proven of the mechanism as the kernel holds it, in doubles: its "
                "numbers could not be followed back to the file's text"
            )
            told.append(Diagnostic("proof-of-doubles", "note", text))
        told += [one.diagnostic for one in self.dead_centres if not one.is_proven]
        if len(gaps) > GAPS_TOLD:
            text = f"{len(gaps) - GAPS_TOLD} more stretches of rows are not proven"
            told.append(Diagnostic("not-proven", "warning", text))
        return tuple(told)

    @property
    def words(self) -> str:
        """One line for a person."""
        found = self._found
        counts = [(int((found.status == proof).sum()), proof.label) for proof in reversed(Proof)]
        rows = ", ".join(f"{count} {label}" for count, label in counts if count)
        words = [rows, *(one.words for one in self.dead_centres if one.is_proven)]
        if self.is_one_branch and found.rows > 1:
            words.append(f"one branch from end to end ({counted_tubes(found.tubes)})")
        return "; ".join(words)

    def enclosure(self, name: str) -> tuple[Floats, Floats]:
        """Bounds of a quantity in the file's units: two arrays (rows,), of a vector (rows, 3).

        Coordinates, points, rates, accelerations, jerks, reactions and efforts of the mechanism as
        the file's text says it lie between them, in every row that is proven; nan elsewhere. Rows
        that are proven and have no bounds all the same, as where the quantity is not unique, are
        told by `not_enclosed`.

        Raises:
            UsageError: no such quantity, or one that is not enclosed, with the reason: verdicts,
                what is derived, and forces that go by friction, actuators or tables of loads.
        """
        return self.enclosures([name])[name]

    def enclosures(self, names: Sequence[str]) -> dict[str, tuple[Floats, Floats]]:
        """Those of several quantities by name, found together; errors as those of `enclosure`."""
        result = self.analysis.result
        known, wanted = result.problem.quantities(), []
        for name in names:
            quantity = known.get(a_text("quantity", name, '"O4.theta_dot"'))
            if quantity is None:
                raise UsageError(f"{name[:LONGEST_NAME]} is no quantity of this mechanism")
            against = reason_against(quantity)
            if against:
                raise UsageError(f"{name} is not enclosed: {against}")
            wanted.append(quantity)
        rows = result.row_states
        found = enclosures(result.session, self._found, wanted, rows.states, rows.turns)
        return {quantity.name: self._bounds(quantity, found[quantity.name]) for quantity in wanted}

    def not_enclosed(self, name: str) -> tuple[Diagnostic, ...]:
        """Which rows are proven but have no bounds of a quantity, with the reasons; empty where all
        have them. Errors as those of `enclosure`."""
        result = self.analysis.result
        low, high = self.enclosure(name)
        values = np.asarray(self.analysis[name])
        bounded, has_value = (_finite_rows(part) for part in (high - low, values))
        inside = inside_boxes(result.session)
        return not_enclosed(name, self._found.on_branch, has_value, inside, bounded)

    def _bounds(self, wanted: Wanted, found: Enclosure) -> tuple[Floats, Floats]:
        """Of an enclosure in SI (width, rows), in the file's units."""
        result = self.analysis.result
        unknown = reason_unknown(result.problem)
        if unknown and self._found.on_branch.any() and not np.isfinite(found.radius).any():
            raise UsageError(f"{wanted.name} is not enclosed: {unknown}")
        known = np.asarray(result.units.to_si(self.analysis[wanted.name], wanted.dimension))
        low, high = (part.T for part in bounds(result.problem, wanted, found, known.T))
        return (low, high) if len(wanted.places) > 1 else (low[:, 0], high[:, 0])

    def _told(self, gap: Gap) -> Diagnostic:
        rows = (
            f"row {gap.first + 1} is"
            if gap.first == gap.last
            else f"rows {gap.first + 1} to {gap.last + 1} are"
        )
        numbers = (Number("first_row", gap.first + 1), Number("last_row", gap.last + 1))
        measured = None
        if gap.why == "box":
            worst = float(self._found.boxes.contraction[gap.first : gap.last + 1].max())
            measured = f"the operator leaves {worst:.2g} of a box (limit 1)"
        text = f"{rows} not proven: {_CERTIFICATE_WHY[gap.why]}"
        return Diagnostic(
            "not-proven", "warning", text, None, measured, None, _CURE[gap.why], numbers
        )


def _finite_rows(values: Floats) -> Bools:
    """Rows of which all parts are finite (rows,)."""
    found: Bools = np.logical_and.reduce(np.isfinite(values.reshape(len(values), -1)), axis=1)
    return found
