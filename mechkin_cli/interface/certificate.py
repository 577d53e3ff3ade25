"""Proofs of a sweep in the file's units and words."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.proof.enclosures import (
    bounds,
    enclosures,
    inside_boxes,
    reason_against,
    reason_unknown,
)
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Number, UsageError
from mechkin_cli.interface.arguments import a_text
from mechkin_cli.interface.dead_centre import DeadCentre, counted_tubes
from mechkin_cli.interface.not_enclosed import not_enclosed
from mechkin_cli.listing import Listed, Listing
from mechkin_cli.proof import Proof
from mechkin_cli.runs import SWEEP

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.analysis.proof import Certificate as Found
    from mechkin_cli.analysis.proof.certificate import Gap
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.interface.analysis import Analysis
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.enclosures import Enclosure

GAPS_TOLD = 4
"""Gaps that are told one by one."""

_WHY = {
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

    def __init__(self, analysis: Analysis) -> None:
        if analysis.run != SWEEP:
            raise UsageError(f"{analysis.run} is a response: proofs are of sweeps")
        self.analysis = analysis
        self._found: Found = analysis.result.certificate

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
    def dead_centres(self) -> tuple[DeadCentre, ...]:
        """The dead centres beyond which rows are missing, one for each way along the rows that ends
        at one."""
        return tuple(DeadCentre(self.analysis, found) for found in self._found.dead_centres)

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
        text = f"{rows} not proven: {_WHY[gap.why]}"
        return Diagnostic(
            "not-proven", "warning", text, None, measured, None, _CURE[gap.why], numbers
        )


def _finite_rows(values: Floats) -> Bools:
    """Rows of which all parts are finite (rows,)."""
    found: Bools = np.logical_and.reduce(np.isfinite(values.reshape(len(values), -1)), axis=1)
    return found
