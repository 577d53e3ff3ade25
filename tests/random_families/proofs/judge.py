"""The verdict on one random linkage: whether anything is proven that closed forms deny."""

from __future__ import annotations

import itertools
import random
from dataclasses import dataclass, field, replace
from decimal import Decimal
from typing import Any

import numpy as np
from oracle.numerics import mp
from random_families.proofs import oracle_loops
from random_families.proofs.linkage import Linkage, Place, Rates, decimal, within_a_turn
from random_families.proofs.planar import five_bar, four_bar, near_change_point, slider_crank
from random_families.proofs.rows import ways
from random_families.proofs.spatial import rssr

import mechkin_cli as mk
from mechkin_cli.analysis.certificate import Certificate
from mechkin_cli.proofs.rows import certify

DRAWS = (four_bar, slider_crank, rssr, five_bar)
GAPS = range(1, 10)
NONE = -1e-9
"""Margin below which nothing closes, whatever doubles make of it."""
SAMPLES = 400
"""Of a way between two rows."""
SAME = 1e-5
"""A mode, in rad or parts of the largest, and the assembly that it is."""


@dataclass(frozen=True)
class Outcome:
    """What one seed came to."""

    text: str
    fault: str = ""
    remark: str = ""
    figures: dict[str, float] = field(default_factory=dict)


def run_one(seed: int) -> Outcome:
    """Rows, modes and jumps of the linkage of a seed."""
    rng = random.Random(f"proofs {seed}")
    if seed % 10 == 9:
        return _near_change_point(rng)
    if seed % 20 == 8:
        return _oracle_loop(rng)
    linkage = DRAWS[seed % len(DRAWS)](rng)
    kind, places = ways(rng, linkage)
    rates = [str(decimal(rng, -3.0, 3.0)) for _ in linkage.inputs]
    accelerations = [str(decimal(rng, -3.0, 3.0)) for _ in linkage.inputs]
    return judged(linkage, kind, places, rates, accelerations)


def judged(
    linkage: Linkage, kind: str, places: list[Place], rates: Rates, accelerations: Rates
) -> Outcome:
    """Over these rows, over them backwards, and over every second one."""
    text = linkage.text(places, rates, accelerations)
    first = None
    for order in (slice(None), slice(None, None, -1), slice(None, None, 2)):
        chosen = places[order]
        written = linkage.text(chosen, rates, accelerations)
        found = _Judged(linkage, chosen, rates, accelerations, written)
        if found.fault:
            return Outcome(written, f"{kind}: {found.fault}")
        first = first or found
    assert first is not None
    fault = first.modes_at_fault() or first.jumps_at_fault()
    if fault:
        return Outcome(text, f"{kind}: {fault}")
    proven = int((first.certificate.status != "not proven").sum())
    remark = "with all of its rows" if first.certificate.is_one_branch else "with some"
    remark = remark if proven else "with none of its rows"
    return Outcome(text, "", f"{remark} proven", {"width": first.width})


class _Judged:
    """One sweep."""

    def __init__(
        self, linkage: Linkage, places: list[Place], rates: Rates, accelerations: Rates, text: str
    ) -> None:
        self.linkage, self.places = linkage, places
        self.model = mk.loads(text)
        self.certificate: Certificate = self.model.certify()
        self.status = self.certificate.status
        self.width = 0.0
        self.fault = self._rows_at_fault(rates, accelerations) or self._ways_at_fault()

    def _rows_at_fault(self, rates: Rates, accelerations: Rates) -> str:
        """Every proven row holds the assembly of the side on which the first one lies."""
        proven = np.flatnonzero(self.status != "not proven")
        side, boxes = 0, {}
        for row in proven:
            assemblies = self.linkage.at(self.places[row])
            if not assemblies:
                return f"row {row + 1} is proven where nothing closes"
            names = next(iter(assemblies.values()))
            orders = [name + suffix for name in names for suffix in ("", "_dot", "_ddot")]
            boxes = boxes or {name: self.certificate.enclosure(name) for name in orders}
            if not side:
                inside = [s for s, known in assemblies.items() if self._holds(boxes, known, row)]
                if not inside:
                    return f"row {row + 1}: no assembly lies in its box"
                side = inside[0]
            true = self.linkage.moving(self.places[row], rates, accelerations, side)
            if not self._holds(boxes, {n: true[n] for n in names}, row):
                return f"row {row + 1}: the branch's assembly is not in its box"
            if not self._holds(boxes, true, row, where_known=True):
                return f"row {row + 1}: rates lie outside"
            low, high = (boxes[next(iter(names))][k][row] for k in (0, 1))
            self.width = max(self.width, (high - low) / max(1.0, abs(low)))
        return ""

    def _holds(
        self, boxes: dict[str, Any], known: Any, row: int, where_known: bool = False
    ) -> bool:
        for name, value in known.items():
            low, high = (float(part[row]) for part in boxes[name])
            if not np.isfinite(high - low):
                if where_known:
                    continue
                return False
            if not name.endswith(("_dot", "_ddot")):
                value = low + within_a_turn(name, value - low)
                value += 0 if value >= low or name.endswith(".s") else 2 * mp.pi
            if not low <= value <= high:
                return False
        return True

    def _ways_at_fault(self) -> str:
        """The way through all proven rows, from the first one, is open."""
        proven = np.flatnonzero(self.status != "not proven")
        for before, row in itertools.pairwise(proven):
            for k in range(before, row):
                one, other = (np.radians([float(x) for x in self.places[i]]) for i in (k, k + 1))
                way = np.linspace(one, other, SAMPLES).T
                if (self.linkage.margin(list(way)) < NONE).any():
                    return f"row {row + 1} is proven across a place where nothing closes"
        return ""

    def modes_at_fault(self) -> str:
        """Modes proven to differ are as many assemblies."""
        found = self.model.modes(certify=True)
        if found.proofs is None:
            return ""
        assemblies = self.linkage.at(self.places[0])
        proven = [m for m, p in zip(found.modes, found.proofs.modes, strict=True) if p]
        if len(proven) and not assemblies:
            return "a mode is proven where nothing closes"
        if found.proofs.all_different and len(proven) > len(assemblies):
            return f"{len(proven)} modes are proven to differ, there are {len(assemblies)}"
        for mode in proven:
            if not any(_same(mode.coordinates, known) for known in assemblies.values()):
                return f"mode {mode.name} is proven and no assembly"
        return ""

    def jumps_at_fault(self) -> str:
        """Rows behind a jump to the other mode are never proven."""
        names = [mode.name for mode in self.model.modes().modes]
        if len(names) < 2 or len(self.places) < 2:
            return ""
        one, other = (self.model.analyze(tables=[], mode=name).result for name in names[:2])
        if not (one.solved.all() and other.solved.all()):
            return ""
        states = one.row_states.states
        kept = states.copy()
        for row in {1, len(self.places) // 2, len(self.places) - 1}:
            states[:, row:] = other.row_states.states[:, row:]
            found = certify(one.session, states, one.solved)
            states[:] = kept
            if found.on_branch[row:].any():
                return f"a jump at row {row + 1} is proven"
        return ""


def _same(mode: Any, known: Any) -> bool:
    return all(
        abs(within_a_turn(name, mode[name] - value)) < SAME * max(1, abs(value))
        for name, value in known.items()
    )


def _near_change_point(rng: random.Random) -> Outcome:
    """Rows on both sides of a narrow place; a jump there is not proven whatever its width."""
    gap = Decimal(10) ** -rng.choice(GAPS)
    linkage, narrow = near_change_point(rng, gap)
    is_end = rng.random() < 0.3
    step = rng.choice([0.5, 4.0, 11.0])
    middle = narrow + 180.0 * is_end
    places = [(repr(round(middle + step * (k - 4.3), 6)),) for k in range(9)]
    found = judged(linkage, f"gap {gap:.0e}", places, ["1"], ["0"])
    name = "ends side by side" if is_end else "gaps"
    return replace(found, remark=f"{name} {found.remark}" if found.remark else "")


def _oracle_loop(rng: random.Random) -> Outcome:
    text = oracle_loops.drawn(rng)
    certificate = mk.loads(text).certify()
    fault = oracle_loops.fault_of(text, certificate)
    count = np.count_nonzero(certificate.status != "not proven")
    remark = "spatial loops" if count == len(certificate.status) else "spatial loops in part"
    return Outcome(text, fault, f"{remark} proven")
