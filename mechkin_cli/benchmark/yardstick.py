"""The yardstick: a throw-away C kernel with no error handling that marks what the machine can do.

Its folder holds `run.py` (which compiles `kern.c`), `prep.py` and `mechs.py`; it is no part of the
package.
"""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from mechkin_cli.benchmark.kernel_case import BATCH
from mechkin_cli.diagnostics import UsageError

DEFAULT = Path("tests") / "benchmark" / "yardstick"
MODULES = ("run", "prep", "mechs")
LEVELS = ("position", "+ velocity, acceleration", "+ effort, wrenches")


def find(folder: Path | None) -> Path | None:
    """The yardstick's folder: the one given, else below the current folder or the source tree.

    Raises:
        UsageError: no yardstick in the folder given.
    """
    source_tree = Path(__file__).resolve().parents[2]
    for place in (folder,) if folder else (DEFAULT, source_tree / DEFAULT):
        if (place / "run.py").is_file() and (place / "kern.c").is_file():
            return place.resolve()
    if folder is not None:
        raise UsageError(f"--yardstick {folder}: no run.py and kern.c there")
    return None


class Yardstick:
    """Its builds without contraction on RCSR, by lane width."""

    def __init__(self, folder: Path) -> None:
        """Compiles it.

        Raises:
            OSError: no C compiler.
            CalledProcessError: the compiler failed.
        """
        self.folder = folder
        self._run = _import(folder)
        self._files = TemporaryDirectory(prefix="mechkin-yardstick-")
        builds = {
            lanes: self._run.build(self._files.name, lanes, contraction, options)
            for _, lanes, contraction, options in self._run.widths()
            if not contraction
        }
        self.data, self._inputs, self._guess, self._exact = self._run.case(builds[1], "rcsr", BATCH)
        self._builds = {lanes: run for lanes, run in builds.items() if lanes > 1}
        self._out = np.zeros((self._run.slots(self.data.nu), BATCH))

    @property
    def widths(self) -> list[int]:
        """Lane widths that were built."""
        return list(self._builds)

    def call(self, lanes: int, level: int) -> Callable[[], None]:
        """A call for `BATCH` positions, two Newton steps; level as in `LEVELS`."""
        run, arrays = self._builds[lanes], (self._inputs, self._guess)

        def timed() -> None:
            self._run.call(run, self.data, *arrays, 2, level, self._out)

        return timed

    def position_error(self, lanes: int) -> float:
        """Largest error of a coordinate in parts of its largest value, against 12 Newton steps."""
        self.call(lanes, 0)()
        found = self._out[: self.data.nu]
        miss = np.abs(found - self._exact).max(axis=1) / np.abs(self._exact).max(axis=1)
        return float(miss.max())

    def __enter__(self) -> Yardstick:
        return self

    def __exit__(self, *reason: object) -> None:
        """Removes the compiled files."""
        self._files.cleanup()


def load(folder: Path | None) -> Yardstick | str:
    """The compiled yardstick, or why it is left out."""
    place = find(folder)
    if place is None:
        return f"no yardstick: {DEFAULT} is not here (--yardstick DIR names its folder)"
    try:
        return Yardstick(place)
    except (OSError, subprocess.CalledProcessError) as error:
        return f"no yardstick: {place / 'kern.c'} could not be compiled ({error})"


def _import(folder: Path) -> Any:
    """The module run.py of the folder, without leaving its neighbours importable."""
    saved = {name: sys.modules.pop(name, None) for name in MODULES}
    sys.path.insert(0, str(folder))
    try:
        return importlib.import_module("run")
    finally:
        sys.path.remove(str(folder))
        for name, module in saved.items():
            sys.modules.pop(name, None)
            if module is not None:
                sys.modules[name] = module
