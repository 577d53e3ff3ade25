"""Tallies as tables: what became of the rows, how far they are off, what the bound says."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.histogram import Histogram
from benchmarks.stress.tally import CONTRADICTED, NO_POSITION, Tally
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable
from mechkin_cli.bench.runs import COUNTS, REFUSED
from mechkin_cli.verdict import Proof

MOST = 0.999
"""The part of the rows that the tables call nearly all."""
TOTAL = "all"


def tables(tallies: Sequence[Tally]) -> tuple[ReportTable, ...]:
    """Verdicts, errors, and errors by condition."""
    return _verdicts(tallies), _errors(tallies), _proofs(tallies), _by_condition(tallies)


def _proofs(tallies: Sequence[Tally]) -> ReportTable:
    columns = (
        ReportColumn("family", "family"),
        ReportColumn("each", "one mecha-\nnism of", "number"),
        ReportColumn("rows", "rows\nasked", "number"),
        ReportColumn("proven", "proven", "number"),
        ReportColumn("closure", "proven\nto closure", "number"),
        ReportColumn("open", "not\nproven", "number"),
        ReportColumn("none", "no\nposition", "number"),
        ReportColumn("contradicted", "proven\nelsewhere", "number"),
    )
    asked = [tally for tally in tallies if FAMILIES[tally.family].proven]
    rows = [_proven(tally) | {"each": FAMILIES[tally.family].proven} for tally in asked]
    if len(asked) > 1:
        rows.append(_proven(_together(asked)))
    return ReportTable("proofs", "What --certify proves", columns, rows)


def _proven(tally: Tally) -> dict[str, Cell]:
    proofs = tally.proofs
    return {
        "family": tally.family,
        "rows": sum(proofs[proof.name] for proof in Proof),
        "proven": proofs[Proof.proven.name],
        "closure": proofs[Proof.proven_to_closure.name],
        "open": proofs[Proof.not_proven.name] - proofs[NO_POSITION],
        "none": proofs[NO_POSITION],
        "contradicted": proofs[CONTRADICTED],
    }


def _together(tallies: Sequence[Tally]) -> Tally:
    total = Tally(TOTAL)
    for tally in tallies:
        total.merge(tally)
    return total


def _verdicts(tallies: Sequence[Tally]) -> ReportTable:
    columns = (
        ReportColumn("family", "family"),
        ReportColumn("mechanisms", "mecha-\nnisms", "number"),
        ReportColumn("rows", "rows", "number"),
        *(ReportColumn(key, label, "number") for key, _, label in COUNTS),
    )
    rows = [_counted(tally) for tally in tallies]
    if len(tallies) > 1:
        rows.append(_counted(_together(tallies)))
    faults = [
        f"{tally.family} {fault.number}, row {fault.row + 1}: {fault.kind.replace('_', ' ')}: "
        f"{fault.words}"
        for tally in tallies
        for fault in tally.faults
    ]
    return ReportTable("verdicts", "What became of the rows", columns, rows, faults)


def _counted(tally: Tally) -> dict[str, Cell]:
    counts: dict[str, Cell] = {key: tally.verdicts[v.name] for key, v, _ in COUNTS}
    known: dict[str, Cell] = {
        "family": tally.family,
        "mechanisms": tally.mechanisms,
        "rows": tally.rows,
        REFUSED: tally.verdicts[REFUSED],
    }
    return known | counts


def _errors(tallies: Sequence[Tally]) -> ReportTable:
    columns = (
        ReportColumn("family", "family"),
        ReportColumn("unit", "errors in"),
        *_level("position"),
        *_level("rate"),
        *_level("acceleration"),
        *_level("force"),
        ReportColumn("bounded", "bound holds\n%", "text"),
        ReportColumn("bound", "bound over\nerror", "text"),
    )
    rows = [_measured(tally) for tally in tallies]
    notes = (
        "u k: 2^-53 times the condition, at least 1; of rates u k^2, of accelerations and forces "
        "u k^3.",
        "median and 99.9 %; positions in rad and sizes, or in parts of larger values.",
    )
    return ReportTable("errors", "Errors of the rows that are right", columns, rows, notes)


def _level(name: str) -> tuple[ReportColumn, ReportColumn]:
    label = "acceler-\nation" if name == "acceleration" else f"{name}\n"
    return ReportColumn(f"{name}_median", label, "text"), ReportColumn(
        f"{name}_most", "99.9\n%", "text"
    )


def _measured(tally: Tally) -> dict[str, Cell]:
    row: dict[str, Cell] = {
        "family": tally.family,
        "unit": "tolerances" if FAMILIES[tally.family].response else "u k",
    }
    for level, histogram in tally.errors.items():
        row[f"{level}_median"] = _shown(histogram.quantile(0.5))
        row[f"{level}_most"] = _shown(histogram.quantile(MOST))
    if tally.bounded:
        row["bounded"] = _percent(tally.bounds_kept, tally.bounded)
        row["bound"] = _shown(tally.bounds.quantile(0.5))
    return row


def _by_condition(tallies: Sequence[Tally]) -> ReportTable:
    together: dict[int, Histogram] = {}
    for tally in tallies:
        for decade, histogram in tally.by_condition.items():
            together.setdefault(decade, Histogram()).merge(histogram)
    columns = (
        ReportColumn("condition", "condition"),
        ReportColumn("rows", "rows", "number"),
        ReportColumn("median", "median", "text"),
        ReportColumn("most", "99.9 %", "text"),
        ReportColumn("largest", "largest", "text"),
    )
    rows: list[dict[str, Cell]] = [
        {
            "condition": f"1e{decade} to 1e{decade + 1}",
            "rows": histogram.total,
            "median": _shown(histogram.quantile(0.5)),
            "most": _shown(histogram.quantile(MOST)),
            "largest": _shown(histogram.largest),
        }
        for decade, histogram in sorted(together.items())
    ]
    notes = ("Errors of positions in u k, of all families.",)
    return ReportTable("by_condition", "Errors against condition", columns, rows, notes)


def _shown(value: float | None) -> str | None:
    """Two digits, or three below a thousand's decimals: edges of bins are known to an eighth."""
    return None if value is None else f"{value:.2g}"


def _percent(part: int, whole: int) -> str:
    """Rounded towards what is missing: 100 only where all hold."""
    missing = whole - part
    return "100" if not missing else f"{100.0 - max(100.0 * missing / whole, 0.001):.3f}"
