"""One block of a family's mechanisms: drawn, solved, judged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmarks.stress.certify import contradicted
from benchmarks.stress.draws import generator
from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.family import Block, Family
from benchmarks.stress.judge import Found, Judged, judge, misses
from benchmarks.stress.quantity import Truth
from benchmarks.stress.solve import solve
from benchmarks.stress.tally import CONTRADICTED, Fault, Tally
from mechkin_cli.bench.runs import FAULTS, REFUSED, StressVerdict
from mechkin_cli.verdict import Status, has_solution

CHUNK = 50_000
"""Rows of a mechanism that are judged at once: double-double rows and their rates take a kilobyte
each."""


def drawn(family: Family, seed: int, numbers: Sequence[int]) -> Block:
    """Mechanisms of one make."""
    (make,) = {family.makes[number % len(family.makes)] for number in numbers}
    with np.errstate(all="ignore"):
        return make([generator(seed, family.name, number) for number in numbers])


def text_of(name: str, seed: int, number: int) -> str:
    """The file of one mechanism."""
    return drawn(FAMILIES[name], seed, [number]).texts[0]


def run_block(name: str, seed: int, numbers: Sequence[int]) -> Tally:
    """What becomes of mechanisms of one make."""
    family = FAMILIES[name]
    block = drawn(family, seed, numbers)
    tally = Tally(name, mechanisms=len(numbers))
    with np.errstate(all="ignore"):
        known = block.truth(block.places[:, :1]).cells()
        count = block.places.shape[1]
        makes = len(family.makes)
        each = family.proven
        asked = [k for k, n in enumerate(numbers) if each and n // makes % each == 0]
        found, proofs, refused = solve(
            block.texts, count, known, response=family.response, proven=asked
        )
        for first in range(0, count, CHUNK):
            rows = slice(first, first + CHUNK)
            truth = block.truth(block.places[:, rows])
            part = _rows(found, rows)
            judged = judge(part, truth, response=family.response)
            written = block.written and block.written(block.places[:, rows])
            if written is not None:
                # a row's bound is one on the errors against the numbers that the file says
                judged = replace(judged, miss=misses(part, written) + 0.0 * judged.miss)
            tally.add(judged, response=family.response)
            if asked:
                assert written is not None
                own = proofs.columns(rows)
                wrong = contradicted(own, part, truth, written)
                tally.add_proofs(own, has_solution(part.codes), wrong)
                for k in np.flatnonzero(wrong.any(axis=1)).tolist():
                    row = int(np.argmax(wrong[k]))
                    words = _words(part, truth, k, row)
                    tally.tell(Fault(CONTRADICTED, numbers[k], first + row, words))
            for fault in _faults(numbers, first, judged, part, truth):
                tally.tell(fault)
    for k, words in refused.items():
        tally.verdicts[REFUSED] += 1
        tally.tell(Fault(REFUSED, numbers[k], 0, words))
    return tally


def _rows(found: Found, rows: slice) -> Found:
    values = {name: value[:, rows] for name, value in found.values.items()}
    condition, bound = found.condition[:, rows], found.bound[:, rows]
    return Found(found.codes[:, rows], condition, bound, values, found.noted, found.unit)


def _faults(
    numbers: Sequence[int], first: int, judged: Judged, found: Found, truth: Truth
) -> list[Fault]:
    """The first row of each kind of fault of each mechanism."""
    faults = []
    for verdict in FAULTS:
        for k in np.flatnonzero((judged.verdict == verdict).any(axis=1)).tolist():
            row = int(np.argmax(judged.verdict[k] == verdict))
            words = _words(found, truth, k, row)
            faults.append(Fault(StressVerdict(verdict).name, numbers[k], first + row, words))
    return faults


def _words(found: Found, truth: Truth, k: int, row: int) -> str:
    status = Status(int(found.codes[k, row])).label
    said = [status, f"condition {found.condition[k, row]:.2g}"]
    if not truth.exists[k, row]:
        return ", ".join([*said, "where the branch has ended"])
    for quantity in truth.quantities:
        right = np.broadcast_to(quantity.value.number.high, found.codes.shape)[k, row]
        unit = " rad" if quantity.kind != "length" else " m"
        key = quantity.keys[0]
        given = found.values[key][k, row]
        shown = "none" if np.isnan(given) else f"{given:.17g}{' deg' if unit == ' rad' else ' m'}"
        said.append(f"{key} {shown} for {right:.17g}{unit}")
    return ", ".join(said)
