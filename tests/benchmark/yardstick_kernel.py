"""The yardstick: a throw-away C kernel with no error handling that marks what the machine can do.

Its folder holds `run.py` (which compiles `kern.c`), `prep.py` and `mechs.py`.
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
from benchmark.kernel_case import BATCH

FOLDER = Path(__file__).resolve().parent / "yardstick"
MODULES = ("run", "prep", "mechs")
LEVELS = ("position", "+ velocity, acceleration", "+ effort, wrenches")


class Yardstick:
    """Its builds without contraction, by lane width."""

    def __init__(self, folder: Path = FOLDER) -> None:
        """Compiles it.

        Raises:
            OSError: no C compiler.
            CalledProcessError: the compiler failed.
        """
        self._run = _import(folder)
        self._files = TemporaryDirectory(prefix="mechkin-yardstick-")
        builds = {
            lanes: self._run.build(self._files.name, lanes, contraction, options)
            for _, lanes, contraction, options in self._run.widths()
            if not contraction
        }
        self._scalar = builds[1]
        self._builds = {lanes: run for lanes, run in builds.items() if lanes > 1}

    @property
    def widths(self) -> list[int]:
        """Lane widths that were built."""
        return list(self._builds)

    def case(self, mechanism: str) -> YardstickCase:
        """One of its mechanisms (`rcsr`, `sevenr`) at `BATCH` positions."""
        return YardstickCase(
            self._run, self._builds, self._run.case(self._scalar, mechanism, BATCH)
        )

    def __enter__(self) -> Yardstick:
        return self

    def __exit__(self, *reason: object) -> None:
        """Removes the compiled files."""
        self._files.cleanup()


class YardstickCase:
    """The yardstick at work on one mechanism; `out` receives what it finds."""

    def __init__(self, run: Any, builds: dict[int, Any], data: tuple[Any, ...]) -> None:
        self._run, self._builds = run, builds
        self.data, self._inputs, self._guess, self._exact = data
        self.out = np.zeros((run.slots(self.data.nu), BATCH))

    def call(self, lanes: int, level: int) -> Callable[[], None]:
        """A call for `BATCH` positions, two Newton steps; level as in `LEVELS`."""
        run, arrays = self._builds[lanes], (self._inputs, self._guess)

        def timed() -> None:
            self._run.call(run, self.data, *arrays, 2, level, self.out)

        return timed

    def position_error(self, lanes: int) -> float:
        """Largest error of a coordinate in parts of its largest value, against 12 Newton steps."""
        self.call(lanes, 0)()
        found = self.out[: self.data.nu]
        miss = np.abs(found - self._exact).max(axis=1) / np.abs(self._exact).max(axis=1)
        return float(miss.max())


def load() -> Yardstick | str:
    """The compiled yardstick, or why it is left out."""
    try:
        return Yardstick()
    except (OSError, subprocess.CalledProcessError) as error:
        return f"no yardstick: kern.c could not be compiled ({error})"


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
