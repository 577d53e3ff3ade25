"""Proofs of a sweep in the file's units and in words: its rows and the dead centres at its ends."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from mechkin_cli import proofs
from mechkin_cli.arguments import a_text
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Number, UsageError
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.proofs import are_one, bounds, reason_against
from mechkin_cli.session import input_number, input_text
from mechkin_cli.show import Bools, Floats, Listed, Listing
from mechkin_cli.verdict import SWEEP, Proof

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.proofs import DeadCentreProof, Enclosure, Gap, SweepProofs
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep import Readable

_DEAD_CENTRE_WHY = {
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

    def __init__(self, analysis: Readable, proof: DeadCentreProof) -> None:
        self._analysis, self._proof = analysis, proof
        self.row, self.tubes = proof.row, proof.tubes

    @property
    def is_proven(self) -> bool:
        """Whether there is exactly one dead centre in the box of the enclosures, and the branch of
        the rows leads to it."""
        return self._proof.why is None

    @property
    def status(self) -> str:
        """`proven` or `not proven`."""
        return (Proof.proven if self.is_proven else Proof.not_proven).label

    @property
    def why(self) -> str | None:
        """Why it is not proven, in words; None where it is."""
        return None if self._proof.why is None else _DEAD_CENTRE_WHY[self._proof.why]

    @property
    def input(self) -> str:
        """The coordinate of which it is a dead centre, such as `O1.theta`."""
        return self._analysis.result.problem.motion.inputs[self._proof.number].name

    @property
    def number(self) -> Number:
        """The input there in doubles, with its name and unit."""
        session = self._analysis.result.session
        value = float(self._proof.place[self._proof.number])
        return input_number(session.problem, session.layout, self._proof.number, value)

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """Bounds of the input there in the file's units, between which the exact dead centre lies;
        nan where none is proven to exist."""
        return proofs.input_bounds(self._analysis.result.session, self._proof)

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
        wanted, mechanism = result.problem.quantities().get(name), result.problem.mechanism
        unproven = wanted is None or bool(reason_against(wanted))
        if wanted is None or unproven or demand_of(mechanism, [wanted]) != Demand.POSITION:
            raise UsageError(f"{name[:LONGEST_NAME]} is no position that is enclosed")
        if name == self.input:
            low, high = (np.array([[bound]]) for bound in self.bounds)
        else:
            row = np.asarray(self._analysis[name])[self.row]
            known = np.asarray(result.units.to_si(row, wanted.dimension)).reshape(-1, 1)
            turned = self._proof.turned
            if turned is not None and proofs.is_angle_of_place(wanted):
                known = known + turned.of_angle(result.session, wanted)
            enclosure = proofs.dead_centre_enclosure(self._proof, wanted)
            low, high = bounds(result.problem, wanted, enclosure, known)
        return (low[:, 0], high[:, 0]) if len(wanted.places) > 1 else (low[0, 0], high[0, 0])

    def is_same_as(self, other: SweepDeadCentre) -> bool:
        """Whether two that are proven, of sweeps of one model, are proven to be the same: then both
        sweeps are on one branch, which passes it, such as those on its two sides."""
        one, two = self._proof, other._proof
        if one.fold is None or two.fold is None or one.why or two.why:
            return False
        return are_one(one.fold, two.fold)

    @property
    def words(self) -> str:
        """A part of a line of text."""
        where = input_text(self.number)
        if self.is_proven:
            return f"one branch to a proven dead centre, {where} ({counted_tubes(self.tubes)})"
        return f"the dead centre at {where} is not proven: {self.why}"

    @property
    def diagnostic(self) -> Diagnostic:
        """That it is not proven, and why."""
        return Diagnostic("dead-centre-not-proven", "note", self.words, numbers=(self.number,))


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


def _component(both: tuple[Floats, Floats], place: int) -> tuple[Floats, Floats]:
    """One component of the bounds (rows, components) of a vector."""
    low, high = both
    return low[:, place], high[:, place]


def not_enclosed(
    name: str, proven: Bools, has_value: Bools, is_inside: Bools, bounded: Bools
) -> tuple[Diagnostic, ...]:
    """A note for each reason, with the rows; all arrays (rows,).

    Args:
        proven: rows of which something is proven.
        has_value: rows with a number in doubles.
        is_inside: rows whose inputs of the text are among those of their boxes.
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


GAPS_SHOWN = 4
"""Gaps that are reported one by one."""

_ROWS_WHY: Final = {
    "no position": ("there is no position", None),
    "box": (
        "no box about the position could be proven to hold exactly one",
        "the place is singular or nearly so: look at row.condition and row.status",
    ),
    "branch": (
        "the positions are proven, that they continue those of the rows before is not",
        "ask for rows between the last that is proven and the first that is not",
    ),
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
        self._proofs: SweepProofs = analysis.result.certificate

    @property
    def listing(self) -> Listing:
        """What is proven, and where nothing is."""
        head = f"Certificate of {self.analysis.model.name}: {self.words}"
        return Listing(head, notes=tuple(str(one) for one in self.diagnostics))

    @cached_property
    def status(self) -> NDArray[np.str_]:
        """`proven`, `proven to closure` or `not proven` of every row (rows,)."""
        labels = np.array([proof.label for proof in Proof])
        return np.asarray(labels[self._proofs.status])

    @property
    def is_one_branch(self) -> bool:
        """Whether all rows are proven, or proven to closure: as the inputs go straight from each
        row to the next, the mechanism moves through all of these positions."""
        return self._proofs.is_complete

    @property
    def tubes(self) -> int:
        """How many tubes join the rows."""
        return self._proofs.tubes

    @cached_property
    def dead_centres(self) -> tuple[SweepDeadCentre, ...]:
        """The dead centres beyond which rows are missing, one for each path along the rows that
        ends at one."""
        return tuple(SweepDeadCentre(self.analysis, one) for one in self._proofs.dead_centres)

    @property
    def closure(self) -> Floats:
        """At most the size of the closing equations beyond those solved for, anywhere in the
        row's box (rows,): lengths in the kernel's unit; nan where nothing is proven."""
        boxes = self._proofs.boxes
        return np.where(boxes.proven, boxes.beyond, np.nan)

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Where nothing is proven, and why."""
        gaps = self._proofs.gaps
        notes = [self._gap(gap) for gap in gaps[:GAPS_SHOWN]]
        if not self._proofs.of_text:
            text = (
                "what is proven is proven of the mechanism as the kernel holds it, in doubles: its "
                "numbers could not be followed back to the file's text"
            )
            notes.append(Diagnostic("proof-of-doubles", "note", text))
        notes += [one.diagnostic for one in self.dead_centres if not one.is_proven]
        if len(gaps) > GAPS_SHOWN:
            text = f"{len(gaps) - GAPS_SHOWN} more stretches of rows are not proven"
            notes.append(Diagnostic("not-proven", "warning", text))
        return tuple(notes)

    @property
    def words(self) -> str:
        """One line of text."""
        proofs = self._proofs
        counts = [(np.count_nonzero(proofs.status == one), one.label) for one in reversed(Proof)]
        rows = ", ".join(f"{count} {label}" for count, label in counts if count)
        words = [rows, *(one.words for one in self.dead_centres if one.is_proven)]
        if self.is_one_branch and proofs.rows > 1:
            words.append(f"one branch from end to end ({counted_tubes(proofs.tubes)})")
        return "; ".join(words)

    def enclosure(self, name: str) -> tuple[Floats, Floats]:
        """Bounds of a quantity in the file's units: two arrays (rows,), of a vector (rows, 3).

        Coordinates, points, rates, accelerations, jerks, reactions and efforts of the mechanism of
        the file's text lie between them, in every row that is proven; nan elsewhere. `not_enclosed`
        reports rows that are proven and have no bounds all the same, as where the quantity is not
        unique.

        Raises:
            UsageError: no such quantity, or one that is not enclosed, with the reason: verdicts,
                what is derived, and forces that go by friction or actuators.
        """
        return self.enclosures([name])[name]

    def enclosures(self, names: Sequence[str]) -> dict[str, tuple[Floats, Floats]]:
        """Those of several quantities by name, found together; errors as those of `enclosure`."""
        result = self.analysis.result
        known = result.problem.quantities()
        wanted = {
            name: self._enclosed(a_text("quantity", name, '"O4.theta_dot"')) for name in names
        }
        asked = list(dict.fromkeys(known[quantity] for quantity, _ in wanted.values()))
        rows = result.row_states
        found = proofs.enclosures(result.session, self._proofs, asked, rows.states, rows.turns)
        both = {one.name: self._bounds(one, found[one.name]) for one in asked}
        return {
            name: both[quantity] if place is None else _component(both[quantity], place)
            for name, (quantity, place) in wanted.items()
        }

    def _enclosed(self, name: str) -> tuple[str, int | None]:
        """The quantity of a name, and which of its components is meant; None: all of it.

        Raises:
            UsageError: as `enclosure`.
        """
        known = self.analysis.result.problem.quantities()
        quantity, place = known.get(name), None
        vector, _, axis = name.rpartition(".")
        if quantity is None and vector in known and len(known[vector].places) > 1:
            place = "xyz"[: len(known[vector].places)].find(axis) if len(axis) == 1 else -1
            quantity = known[vector] if place >= 0 else None
        if quantity is None:
            raise UsageError(f"{name[:LONGEST_NAME]} is no quantity of this mechanism")
        if against := reason_against(quantity):
            raise UsageError(f"{name} is not enclosed: {against}")
        return quantity.name, place

    def not_enclosed(self, name: str) -> tuple[Diagnostic, ...]:
        """Which rows are proven but have no bounds of a quantity, with the reasons; empty where all
        have them. Errors as those of `enclosure`."""
        result = self.analysis.result
        low, high = self.enclosure(name)
        values = np.asarray(self.analysis[name])
        bounded, has_value = (
            np.logical_and.reduce(np.isfinite(part.reshape(len(part), -1)), axis=1)
            for part in (high - low, values)
        )
        inside = proofs.inside_boxes(result.session)
        return not_enclosed(name, self._proofs.on_branch, has_value, inside, bounded)

    def _bounds(self, wanted: Wanted, found: Enclosure) -> tuple[Floats, Floats]:
        """Of an enclosure in SI (width, rows), in the file's units."""
        result = self.analysis.result
        unknown = proofs.reason_unknown(result.problem)
        if unknown and self._proofs.on_branch.any() and not np.isfinite(found.radius).any():
            raise UsageError(f"{wanted.name} is not enclosed: {unknown}")
        known = np.asarray(result.units.to_si(self.analysis[wanted.name], wanted.dimension))
        low, high = (part.T for part in bounds(result.problem, wanted, found, known.T))
        return (low, high) if len(wanted.places) > 1 else (low[:, 0], high[:, 0])

    def _gap(self, gap: Gap) -> Diagnostic:
        first, last = gap[0] + 1, gap[1] + 1
        rows = f"row {first} is" if first == last else f"rows {first} to {last} are"
        numbers = (Number("first_row", first), Number("last_row", last))
        measured = None
        if gap[2] == "box":
            worst = float(self._proofs.boxes.contraction[first - 1 : last].max())
            measured = f"the operator leaves {worst:.2g} of a box (limit 1)"
        why, cure = _ROWS_WHY[gap[2]]
        text = f"{rows} not proven: {why}"
        return Diagnostic("not-proven", "warning", text, None, measured, None, cure, numbers)
