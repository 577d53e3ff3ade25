"""A thousand variants: in lanes, one after the other, and each from its file."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks.scenes import texts
from mechkin_cli.bench.measurement import in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable
from mechkin_cli.model.model import loads

VARIANTS = 1000
ALONE, FROM_FILE = 40, 5
"""Variants of the slower ways, which are timed by fewer."""

UNIT = {True: "rad", False: "m"}
"""Of the file's angles, whose names begin with alpha, and of its lengths."""

PART = 0.01
"""By which parameters are varied."""

MILLI = 1000.0
QUANTITIES = ("O1.effort", "O2.theta", "O2.s", "O4.theta")

COLUMNS = (
    ReportColumn("way", "way"),
    ReportColumn("milliseconds", "ms a\nvariant", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times\nlanes", "time"),
)


def variant_table(rounds: int, variants: int = VARIANTS) -> ReportTable:
    """The RCSR mechanism with other dimensions, extremes over its rows, on one thread."""
    text = texts()["RCSR"]().replace("to: 202 deg", "to: 190 deg")
    model = loads(text, "RCSR")
    generator = np.random.default_rng(1)
    given = {
        name: np.asarray(q.value, float) * (1.0 + PART * generator.uniform(-1.0, 1.0, variants))
        for name, q in model.problem.parameters.items()
    }

    def together() -> object:
        return model.vary(given, QUANTITIES, reduce=("min", "max"), threads=1)

    def one(k: int) -> dict[str, float]:
        return {name: float(values[k]) for name, values in given.items()}

    def alone(count: int) -> None:
        for k in range(count):
            model.with_parameters(one(k)).analyze(QUANTITIES, tables=[], threads=1)

    def from_file(count: int) -> None:
        for k in range(count):
            settings = {
                name: f"{value!r} {UNIT[name.startswith('alpha')]}"
                for name, value in one(k).items()
            }
            loads(text, "RCSR", settings).analyze(QUANTITIES, tables=[], threads=1)

    few = min(ALONE, variants), min(FROM_FILE, variants)
    calls: dict[str, tuple[Callable[[], object], int]] = {
        f"vary, {variants} variants": (together, variants),
        "with_parameters(...).analyze()": (partial(alone, few[0]), few[0]),
        "the file read anew": (partial(from_file, few[1]), few[1]),
    }
    times = in_turns({name: call for name, (call, _) in calls.items()}, rounds)
    first = next(iter(calls))
    lines: list[dict[str, Cell]] = []
    for name, timing in times.items():
        count = calls[name][1]
        lines.append(
            {
                "way": name,
                "milliseconds": MILLI * timing.median / count,
                "spread": timing.spread,
                "ratio": timing.ratio(times[first], count / variants),
            }
        )
    rows = model.problem.motion.rows
    complete = int(model.vary(given, QUANTITIES, reduce="max", threads=1).complete.sum())
    notes = (f"{rows} rows each, one thread; {complete} of {variants} variants complete.",)
    columns = COLUMNS
    return ReportTable("variants", f"{variants} variants of RCSR", columns, lines, notes)
