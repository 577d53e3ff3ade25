"""Times of a page's computation of a changed sweep, beside the kernel of the command.

    python tests/benchmark/live.py [--rows 361] [--repeat 50]

A line for each mechanism: milliseconds of `LiveRuns.compute` in node with all that a change needs
(rows, cells, poses, arrows), of its run of rows alone, and of the same run by the native kernel
with one thread, each the least of many of the same parameters; then the ratio of the runs. The
native time of a response is that of its integration alone.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import mechkin_cli as mk
from benchmarks import sevenr
from mechkin_cli.live.recording import Recording
from mechkin_cli.plan import Demand
from mechkin_cli.response import integrate, prepare
from mechkin_cli.session import Packing
from mechkin_cli.variants import base_of
from mechkin_cli.view.page import script_json
from mechkin_cli.view.scene import page_data

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAM = HERE.parent / "live" / "compute.mjs"
MODULE = ROOT / "mechkin_cli" / "kernel" / "wasm" / "mechkin.wasm.gz"

FILES = {
    "four-bar": "mechanisms/plane/planar_four_bar.yaml",
    "RCSR": "mechanisms/dissertation/rcsr.yaml",
    "RCHCH": "mechanisms/dissertation/rchch.yaml",
    "five-link suspension": "mechanisms/classics/five_link_suspension.yaml",
    "7R": "",
}
RESPONSES = {"RCSR response of 2 s": "mechanisms/dissertation/rcsr_response.yaml"}


def text_of(name: str, rows: int) -> str:
    """The text of a file with so many rows, and with a parameter where it has none."""
    text = sevenr.text() if name == "7R" else (ROOT / FILES[name]).read_text()
    if "\nparameters:" not in text:
        # the first number of a joint's point, whatever it is
        place = re.search(r"point: \[(-?[\d.]+)", text)
        assert place is not None
        unit = "m" if name == "7R" else "mm"
        text = f"{text[: place.start(1)]}dim{text[place.end(1) :]}"
        text = text.replace("\nlinks:", f"\nparameters: {{dim: {place[1]} {unit}}}\nlinks:", 1)
    if name == "7R":
        return text  # a full turn in steps of a degree
    return re.sub(
        r"(from: [^,}]*, to: [^,}]*), (?:step|count): [^,}]+", rf"\1, count: {rows}", text
    )


def in_page(name: str, data: dict[str, Any], repeat: int) -> dict[str, Any]:
    """What the page's program computes of parameters a little changed, and how long it takes."""
    changed = {p["name"]: p["value"] * 1.001 for p in data["live"]["parameters"]}
    given = {"data": json.loads(script_json(data)), "cases": [changed], "repeat": repeat}
    command = ["node", str(PROGRAM), str(MODULE)]
    done = subprocess.run(
        command, input=json.dumps(given), capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(done.stderr)
    (found,) = json.loads(done.stdout)
    if found["end"] != "complete":
        sys.exit(f"{name}: {found['end']}: {found['words']}")
    return dict(found)


def measured(name: str, rows: int, repeat: int) -> dict[str, float]:
    """Milliseconds of one mechanism."""
    if name in RESPONSES:
        return measured_response(name, repeat)
    model = mk.loads(text_of(name, rows))
    analysis = model.analyze()
    data = page_data([analysis], False)[0]
    parameters = data["live"]["parameters"]
    found = in_page(name, data, repeat)
    variation = base_of(model.design).variation(tuple(p["name"] for p in parameters))
    recording = Recording(analysis, data, variation)
    recording.record()
    native = recording.reading.runs(recording.demand & ~Demand.POWER)
    values = variation.values[:, None] * 1.001
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        native.run(np.ascontiguousarray(values), 0, 1)
        times.append(1e3 * (time.perf_counter() - start))
    return {"change": found["milliseconds"], "run": found["run"], "native": min(times)}


def measured_response(name: str, repeat: int) -> dict[str, float]:
    """The same of a response."""
    model = mk.load(ROOT / RESPONSES[name])
    found = in_page(name, page_data([model.respond()], False)[0], repeat)
    run = next(iter(model.problem.responses))
    packing = Packing(2, 1)
    response, session = model.response(run), model.design.session_of(run)
    one = prepare(model.problem, response, packing, session)
    assert one.begun is not None
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        integrate(
            [(one.free.plan, one.begun)],
            float(response.moments.values[0]),
            response.moments.values,
            tolerance=response.tolerance,
            fixed_step=response.fixed_step,
            packing=packing,
        )
        times.append(1e3 * (time.perf_counter() - start))
    return {"change": found["milliseconds"], "run": found["run"], "native": min(times)}


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=361)
    parser.add_argument("--repeat", type=int, default=50)
    parser.add_argument("names", nargs="*", default=[*FILES, *RESPONSES])
    given = parser.parse_args()
    print(f"{given.rows} rows, ms          change     run  native   ratio")
    for name in given.names:
        found = measured(name, given.rows, given.repeat)
        ratio = found["run"] / found["native"]
        times = f"{found['change']:8.2f} {found['run']:7.2f} {found['native']:7.2f}"
        print(f"{name:22} {times} {ratio:7.1f}")


if __name__ == "__main__":
    main()
