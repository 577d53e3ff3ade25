"""What became of the rows of a family: counts, errors against condition, bounds, faults."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from benchmarks.stress.certify import Proofs
from benchmarks.stress.histogram import Histogram
from benchmarks.stress.judge import Judged
from benchmarks.stress.quantity import Mask, Rows
from mechkin_cli.bench.runs import ROUNDING, TOLERANCE, StressVerdict
from mechkin_cli.verdict import Proof

SHOWN = 5
"""Faults of each kind that a family keeps."""
NOTHING = ROUNDING / 1024.0
"""Errors below this are luck, and say nothing of a bound."""
LEVELS = ("position", "rate", "acceleration", "force")
NO_POSITION = "no position"
CONTRADICTED = "proven elsewhere"


@dataclass(frozen=True)
class Fault:
    """The first faulty row of a mechanism: its kind, and what was found."""

    kind: str
    number: int
    row: int
    words: str


@dataclass
class Tally:
    """Of one family. Errors are in roundings times the condition, of rates times its square, of
    accelerations and forces times its cube; of responses in tolerances. `by_condition` holds
    positions by the condition's power of ten; `bounds` are bounds over errors."""

    family: str
    mechanisms: int = 0
    rows: int = 0
    verdicts: Counter[str] = field(default_factory=Counter)
    errors: dict[str, Histogram] = field(default_factory=lambda: {k: Histogram() for k in LEVELS})
    by_condition: dict[int, Histogram] = field(default_factory=dict)
    bounded: int = 0
    bounds_kept: int = 0
    bounds: Histogram = field(default_factory=Histogram)
    proofs: Counter[str] = field(default_factory=Counter)
    faults: list[Fault] = field(default_factory=list)

    def add_proofs(self, proofs: Proofs, solved: Mask, wrong: Mask) -> None:
        """Rows of which a proof was asked, by what was proven; those that are not `solved`, where
        there is nothing to prove; and those that are elsewhere."""
        for proof in Proof:
            count = int((proofs.codes == proof).sum())
            if count:
                self.proofs[proof.name] += count
        for name, rows in (
            (NO_POSITION, (proofs.codes == Proof.not_proven) & ~solved),
            (CONTRADICTED, wrong),
        ):
            if rows.any():
                self.proofs[name] += int(rows.sum())

    def add(self, judged: Judged, *, response: bool = False) -> None:
        """Rows of a block; mechanisms are counted apart."""
        self.rows += judged.verdict.size
        for verdict in StressVerdict:
            count = int((judged.verdict == verdict).sum())
            if count:
                self.verdicts[verdict.name] += count
        # the bare errors of wrong rows are told as faults
        right = (judged.verdict == StressVerdict.right) | (
            judged.verdict == StressVerdict.right_warned
        )
        blank = np.where(right, 0.0, np.nan)
        self._add_errors(judged, blank, response=response)
        self._add_bounds(judged.bound + blank, judged.miss + blank)

    def _add_errors(self, judged: Judged, blank: Rows, *, response: bool) -> None:
        condition = judged.condition
        if response:
            self.errors["position"].add((judged.position + blank) / TOLERANCE)
            return
        position = (judged.position + blank) / (ROUNDING * condition)
        self.errors["position"].add(position)
        square = ROUNDING * condition * condition
        self.errors["rate"].add((judged.rate + blank) / square)
        cube = square * condition
        self.errors["acceleration"].add((judged.acceleration + blank) / cube)
        self.errors["force"].add((judged.force + blank) / cube)
        decades = _decades(condition)
        for decade in np.unique(decades[~np.isnan(position)]):
            own = self.by_condition.setdefault(int(decade), Histogram())
            own.add(position[decades == decade])

    def _add_bounds(self, bound: Rows, error: Rows) -> None:
        there = ~np.isnan(bound) & ~np.isnan(error)
        self.bounded += int(there.sum())
        self.bounds_kept += int((error[there] <= bound[there]).sum())
        positive = there & (error > NOTHING)
        self.bounds.add(bound[positive] / error[positive])

    def tell(self, fault: Fault) -> None:
        """Keeps those of each kind with the least numbers, whatever the order of blocks."""
        same = sorted([f for f in self.faults if f.kind == fault.kind] + [fault], key=_order)
        self.faults = [f for f in self.faults if f.kind != fault.kind] + same[:SHOWN]

    def in_order(self) -> Tally:
        """The same with its faults in the order of kinds and numbers."""
        self.faults.sort(key=lambda fault: (fault.kind, *_order(fault)))
        return self

    def merge(self, other: Tally) -> None:
        """What another part of the family's mechanisms gave."""
        self.mechanisms += other.mechanisms
        self.rows += other.rows
        self.verdicts.update(other.verdicts)
        for level, own in self.errors.items():
            own.merge(other.errors[level])
        for decade, histogram in other.by_condition.items():
            self.by_condition.setdefault(decade, Histogram()).merge(histogram)
        self.bounded += other.bounded
        self.bounds_kept += other.bounds_kept
        self.bounds.merge(other.bounds)
        self.proofs.update(other.proofs)
        for fault in other.faults:
            self.tell(fault)

    def record(self) -> dict[str, Any]:
        """As plain data, from which `of_record` makes it again."""
        return {
            "family": self.family,
            "mechanisms": self.mechanisms,
            "rows": self.rows,
            "verdicts": dict(self.verdicts),
            "errors": {k: _plain(h) for k, h in self.errors.items()},
            "by_condition": {str(k): _plain(h) for k, h in self.by_condition.items()},
            "bounded": self.bounded,
            "bounds_kept": self.bounds_kept,
            "bounds": _plain(self.bounds),
            "proofs": dict(self.proofs),
            "faults": [asdict(fault) for fault in self.faults],
        }


def _order(fault: Fault) -> tuple[int, int]:
    return fault.number, fault.row


def of_record(record: Mapping[str, Any]) -> Tally:
    """The tally that `record` was made of."""
    return Tally(
        record["family"],
        record["mechanisms"],
        record["rows"],
        Counter(record["verdicts"]),
        {k: _histogram(h) for k, h in record["errors"].items()},
        {int(k): _histogram(h) for k, h in record["by_condition"].items()},
        record["bounded"],
        record["bounds_kept"],
        _histogram(record["bounds"]),
        Counter(record["proofs"]),
        [Fault(**fault) for fault in record["faults"]],
    )


def _plain(histogram: Histogram) -> dict[str, int]:
    return {str(k): n for k, n in sorted(histogram.counts.items())}


def _histogram(counts: Mapping[str, int]) -> Histogram:
    return Histogram({int(k): n for k, n in counts.items()})


def _decades(condition: Rows) -> Rows:
    """Powers of ten below the condition, by comparison: logarithms differ between machines."""
    decades = np.zeros(condition.shape)
    for power in range(1, 17):
        decades += condition >= float(f"1e{power}")
    return decades
