"""Writes what the commands of docs/tutorial.md print into the page.

With `--timed` it does all of the tutorial in a new environment and a new folder, from the
installation on, compares what is printed and tells the seconds of each step.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from documents.tutorial.running import comparable, printed, runs
from documents.tutorial.steps import PAGE, Step, Written, steps

ROOT = PAGE.parents[1]


def write() -> None:
    """The page with the outputs as they are now."""
    text = PAGE.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        for step, out in runs(Path(folder)):
            head, fence, rest = text.partition(f"```sh\n{step.commands}```\n\n```text\n")
            if fence:
                text = f"{head}{fence}{out}{rest[rest.index('```') :]}"
    PAGE.write_text(text, encoding="utf-8")


def timed() -> float:
    """Seconds from end to end."""
    total = 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        inside = f'. "{folder}/.venv/bin/activate"\n'
        for number, step in enumerate(steps()):
            if isinstance(step, Written):
                (folder / step.name).write_text(step.text, encoding="utf-8")
                continue
            begun = time.perf_counter()
            out = printed(folder, _commands(step, number, inside))
            taken = time.perf_counter() - begun
            total += taken
            as_shown = "as shown" if comparable(out) == comparable(step.shown) else "otherwise"
            as_shown = as_shown if number else "installed"
            print(f"{taken:6.1f} s  {as_shown:9}  {step.commands.splitlines()[0]}", flush=True)
    return total


def _commands(step: Step, number: int, inside: str) -> str:
    if number == 0:
        return step.commands.replace("pip install .", f'pip install -q "{ROOT}"')
    return inside + step.commands


if __name__ == "__main__":
    if "--timed" in sys.argv[1:]:
        print(f"{timed():6.1f} s  from end to end")
    else:
        write()
