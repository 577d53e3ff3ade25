"""Time of the mechanisms kept here with `plane: xy` against the same in space, on this machine.

`python -P tests/benchmark/plane_and_space.py`: microseconds per row of a sweep of 20 000 rows with
motion, efforts and all reactions, on one thread, following included; milliseconds of the sweep that
the file asks for, from its text on.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests"))
sys.path.append(str(ROOT))

import yaml
from planar.space import Data, in_space

import mechkin_cli as mk

ROWS = 20_000
FILES = sorted((ROOT / "mechanisms" / "plane").glob("planar_*.yaml"))


def least(run: Callable[[], object], times: int = 7) -> float:
    """The shortest of some times, s."""
    found = []
    for _ in range(times):
        start = time.perf_counter()
        run()
        found.append(time.perf_counter() - start)
    return min(found)


def measured(data: Data, names: list[str]) -> tuple[float, float]:
    """Seconds of many rows with all reactions and efforts, and of the file from its text on."""
    ((name, drive),) = data["motion"]["inputs"].items()
    rows = {key: value for key, value in drive.items() if key != "step"} | {"count": ROWS}
    model = mk.loads(json.dumps({**data, "motion": {"inputs": {name: rows}}}))
    text = json.dumps(data)
    many = least(lambda: model.analyze(names, tables=[], threads=1))
    return many, least(lambda: mk.loads(text).analyze(), 15)


def main() -> None:
    print("                              [us/row]  file [ms]")
    for path in FILES:
        flat = yaml.safe_load(path.read_text(encoding="utf-8"))
        forces = [f"{joint}.force" for joint in flat["joints"]]
        efforts = [f"{name}.effort" for name in flat["motion"]["inputs"]]
        columns = [f"{force}.{axis}" for force in forces for axis in "xy"] + efforts
        flat["tables"] = [{"name": "t", "columns": columns}]
        for form, data in (("plane", flat), ("space", in_space(flat))):
            many, file = measured(data, [*forces, *efforts])
            text = f"{path.stem:22s} {form} {1e6 * many / ROWS:8.3f}"
            print(f"{text} {1e3 * file:8.2f}", flush=True)


if __name__ == "__main__":
    main()
