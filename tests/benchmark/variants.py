"""Times `m.vary`, `m.with_parameters(...).analyze()` and `m.solve`, and the memory of variants;
and variants that one recording does not hold against a build of their file.

    python tests/benchmark/variants.py [--variants 1000] [--quick]

Effort and three coordinates over 361 rows, reduced to extremes, on one thread; medians of several
runs. Memory is the growth of the process's peak from 1000 to 10 000 variants.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import mechkin_cli as mk
from mechkin_cli.variants.design import base_of

MECHANISMS = Path(__file__).resolve().parents[2] / "mechanisms"
ROWS = 361

CASES: dict[str, tuple[list[str], float]] = {
    "rcsr": (["O1.effort", "O2.theta", "O2.s", "O4.theta"], 0.20),
    "sevenr": (["J1.effort", "J2.theta", "J3.theta", "J7.theta"], 0.45),
    "rchch": (["O1.effort", "O2.theta", "O2.s", "O4.theta"], 0.30),
}
"""Quantities, and the limit in ms a variant."""

SEVEN_R_POINTS = {
    "[0.8, 1.9, 0.5]": "[x2, y2, z2]",
    "[2.3, 3, 1.2]": "[x3, y3, z3]",
    "[3.9, 3.2, 1.5]": "[x4, 3.2 in, 1.5 in]",
}
SEVEN_R_PARAMETERS = """\
parameters: {x2: 0.8 in, y2: 1.9 in, z2: 0.5 in, x3: 2.3 in, y3: 3 in, z3: 1.2 in, x4: 3.9 in}
"""


def text_of(stem: str) -> str:
    """A mechanism with 361 rows, and with parameters."""
    text = (next(MECHANISMS.glob(f"*/{stem}.yaml"))).read_text(encoding="utf-8")
    for spacing in ("to: 202, step: 2", "to: 60, step: 5", "to: 55, step: 5"):
        text = text.replace(spacing, spacing.partition(" step")[0] + f" count: {ROWS}")
    if stem == "rcsr":
        # farther from the dead centre, which some variants would come to
        text = text.replace("to: 202", "to: 190")
    if stem == "sevenr":
        for numbers, names in SEVEN_R_POINTS.items():
            text = text.replace(f"point: {numbers}", f"point: {names}")
        text = text.replace("links:\n  one", f"{SEVEN_R_PARAMETERS}links:\n  one", 1)
    return text


def arrays(model: Any, count: int, seed: int = 1) -> dict[str, np.ndarray]:
    """Every parameter about its own value by one per cent, in the file's units."""
    generator = np.random.default_rng(seed)
    units = model.problem.units
    return {
        name: float(units.from_si(quantity.value, quantity.dimension))
        * (1.0 + 0.01 * generator.standard_normal(count))
        for name, quantity in model.problem.parameters.items()
    }


def best_of(work: Any, times: int) -> float:
    """Median time of a call in s, the first left out."""
    work()
    found = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        found.append(time.perf_counter() - start)
    return statistics.median(found)


def measure(stem: str, count: int, times: int) -> None:
    """Prints the figures of one mechanism."""
    model = mk.loads(text_of(stem), stem)
    quantities, limit = CASES[stem]
    given = arrays(model, count)

    def study() -> Any:
        return model.vary(given, quantities, reduce=("min", "max"), threads=1)

    seconds = best_of(study, times)
    complete = int(study().complete.sum())
    print(
        f"{stem:7} vary      {1e3 * seconds / count:8.4f} ms a variant (limit {limit:.2f}), "
        f"{complete} of {count} complete"
    )
    one = {name: float(values[0]) for name, values in given.items()}
    whole = best_of(lambda: model.with_parameters(one).analyze(quantities, tables=[]), 5 * times)
    print(f"{stem:7} one       {1e3 * whole:8.4f} ms with_parameters(...).analyze(), {ROWS} rows")
    driven = model.problem.motion.inputs[0]
    places = np.linspace(driven.written[5], driven.written[-5], 500) + 0.01
    names = quantities[1:]

    def positions() -> None:
        for place in places:
            model.solve({driven.name: place}, names)

    print(f"{stem:7} solve     {1e6 * best_of(positions, times) / places.size:8.2f} us a call")


def without_mass() -> str:
    """RCSR whose coupler has a mass that may be zero: it is planned in two ways."""
    text = text_of("rcsr").replace("parameters:\n", "parameters:\n  m: 5\n", 1)
    assert "coupler:\n    mass: 5\n" in text
    return text.replace("coupler:\n    mass: 5\n", "coupler:\n    mass: m * 1 lbm\n", 1)


def by_law() -> str:
    """RCSR driven by a law of time whose end is a parameter."""
    text = text_of("rcsr").replace("parameters:\n", "parameters:\n  last: 190 deg\n", 1)
    begin = text.index("    O1.theta: {from: 150")
    law = "    O1.theta: {law: harmonic, from: 150, to: last}\n"
    text = text[:begin] + law + text[text.index("\n", begin) + 1 :]
    return text.replace("motion:\n", f"motion:\n  time: {{from: 0, to: 1, count: {ROWS}}}\n", 1)


APART: dict[str, tuple[Any, list[str], str, tuple[float, ...]]] = {
    "another recording": (without_mass, ["O4.theta", "O1.effort"], "m", (0.0,)),
    "loops left out": (lambda: text_of("rcsr_csr_loop_one"), ["O4.theta"], "", ()),
    "rows by parameters": (lambda: text_of("double_wishbone"), ["lower_pivot.theta"], "", ()),
    "a law of time": (by_law, ["O4.theta", "O1.effort"], "", ()),
    "beside a dead centre": (
        lambda: text_of("rcsr").replace("to: 190", "to: 205"),
        ["O4.theta", "O1.effort"],
        "",
        (),
    ),
}
"""Files, quantities, and a parameter that is held at a value in all variants."""


def apart(name: str, count: int, times: int) -> None:
    """Prints what a variant of such a file takes, as a part of a build."""
    make, quantities, held, value = APART[name]
    model = mk.loads(make(), "apart")
    given = arrays(model, count)
    if held:
        given[held] = np.full(count, value[0])
    one = {n: q.value * 1.001 for n, q in model.problem.parameters.items()}
    base = base_of(model.design)
    build = best_of(lambda: base.built(one), times)
    taken = best_of(lambda: model.vary(given, quantities, threads=1), times) / count
    print(f"{name:21} {1e3 * taken:8.3f} ms a variant, {taken / build:5.2f} of a build of its file")


def peak_after(count: int) -> int:
    """Peak memory in MB of a process that runs so many variants of RCSR."""
    script = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "import resource, variants, mechkin_cli as mk\n"
        "m = mk.loads(variants.text_of('rcsr'), 'rcsr')\n"
        "q, _ = variants.CASES['rcsr']\n"
        "m.vary(variants.arrays(m, int(sys.argv[2])), q, reduce=('min', 'max'), threads=1)\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)\n"
    )
    line = [sys.executable, "-P", "-c", script, str(Path(__file__).parent), str(count)]
    done = subprocess.run(line, check=True, capture_output=True, text=True)
    return int(done.stdout) // 1024


def main() -> None:
    """Prints all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--variants", type=int, default=1000)
    parser.add_argument("--quick", action="store_true", help="fewer repetitions, no memory")
    options = parser.parse_args()
    for stem in CASES:
        measure(stem, options.variants, 1 if options.quick else 5)
    for name in APART:
        apart(name, 50, 1 if options.quick else 5)
    if not options.quick:
        few, many = peak_after(1000), peak_after(10_000)
        print(f"peak memory: {few} MB with 1000 variants, {many} MB with 10 000")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss > 0


if __name__ == "__main__":
    main()
