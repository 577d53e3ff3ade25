"""CasADi: the closing equations and their Jacobian as symbols, Newton's method, all as compiled C.

The compiled function solves all rows, each from the row before, without coming back to Python; the
seconds that compiling takes are not counted.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.closure import named_motion
from mechkin_cli.bench.chain import Entries, Placing
from mechkin_cli.bench.measurement import Method, Unable
from mechkin_cli.bench.methods import RowByRow

if TYPE_CHECKING:
    from mechkin_cli.bench.scene import BenchScene, Values

FAMILY = "CasADi"
COMPILER = "gcc"
FLAGS = ("-O3", "-march=native", "-fPIC", "-shared")
STEPS = (1, 2, 3, 4)
MOST_UNKNOWNS = 12
"""Beyond, its code takes longer to compile than everything else to measure."""


def methods(scene: BenchScene) -> Iterator[Method]:
    """Newton's method over its tolerance, and the whole motion."""
    casadi = import_module("casadi")
    rows = RowByRow(scene)
    unknowns, equations = len(rows.unknowns), scene.chain.equations
    if not rows.is_square:
        raise Unable(
            f"its root finder wants as many equations as unknowns; here are {equations} for "
            f"{unknowns} (redundant constraints)"
        )
    if unknowns > MOST_UNKNOWNS:
        raise Unable(f"{unknowns} unknowns in one system: minutes to compile its code")
    if shutil.which(COMPILER) is None:
        raise Unable(f"no C compiler: {COMPILER} is not on the path")
    symbols = Symbols(casadi, rows)
    for steps in STEPS:
        solve = symbols.compiled(steps, moving=False)
        call = partial(symbols.run, solve, moving=False)
        yield _method(scene, str(steps), "position", call, partial(symbols.read, call))
    solve = symbols.compiled(STEPS[-1], moving=True)
    call = partial(symbols.run, solve, moving=True)
    read = partial(symbols.read, call)
    yield _method(scene, str(STEPS[-1]), "motion", call, read, "compiled Newton and rates")


def _method(
    scene: BenchScene,
    setting: str,
    level: str,
    call: Callable[[], Any],
    read: Callable[[], Values],
    curve: str = "compiled Newton",
) -> Method:
    return Method(FAMILY, curve, setting, level, call, scene.rows, read)


class Symbols:
    """The closure of a scene in CasADi; balls count from their orientation in the first row."""

    def __init__(self, casadi: Any, rows: RowByRow) -> None:
        self.casadi, self.rows = casadi, rows
        self._folder = TemporaryDirectory(prefix="mechkin-casadi-")
        sx, size, driven = casadi.SX, len(rows.unknowns), len(rows.driven)
        self.x, self.p = sx.sym("x", size), sx.sym("p", driven)
        q = [sx(float(value)) for value in rows.start]
        for k, number in enumerate(rows.unknowns):
            q[number] = self.x[k]
        for k, number in enumerate(rows.driven):
            q[number] = self.p[k]
        placing = Placing(rows.chain, Entries(casadi.cos, casadi.sin))
        self.gap = casadi.vertcat(*placing.gaps(placing.places(q, rows.turned), q, rows.turned))

    def compiled(self, steps: int, *, moving: bool) -> Any:
        """A compiled function over all rows: starts, inputs (and their rates) to unknowns."""
        casadi, x, p = self.casadi, self.x, self.p
        start, at = (casadi.MX.sym(name, s.numel()) for name, s in (("start", x), ("at", p)))
        both = casadi.Function("closure", [x, p], [self.gap, casadi.jacobian(self.gap, x)])
        found = start
        for _ in range(steps):
            gap, columns = both(found, at)
            found = found - casadi.solve(columns, gap, "qr")
        rates = [casadi.MX.sym(name, p.numel()) for name in ("rate", "acceleration")]
        inputs, outputs = [start, at], [found]
        if moving:
            inputs, outputs = [*inputs, *rates], [found, *self._moved(found, at, *rates)]
        one = casadi.Function("one", inputs, outputs)
        return self._built(one.mapaccum("sweep", self.rows.inputs.shape[1]))

    def _moved(self, found: Any, at: Any, rate: Any, acceleration: Any) -> list[Any]:
        """Rates and accelerations of the unknowns."""
        casadi, x, p = self.casadi, self.x, self.p
        both, sx = casadi.vertcat(x, p), casadi.SX
        xd, pd, pdd = sx.sym("xd", x.numel()), sx.sym("pd", p.numel()), sx.sym("pdd", p.numel())
        first = casadi.jtimes(self.gap, p, pd)
        along = casadi.jtimes(self.gap, both, casadi.vertcat(xd, pd))
        second = casadi.jtimes(along, both, casadi.vertcat(xd, pd))
        second += casadi.jtimes(self.gap, p, pdd)
        columns = casadi.Function("columns", [x, p], [casadi.jacobian(self.gap, x)])(found, at)
        right = casadi.Function("first", [x, p, pd], [first])(found, at, rate)
        moved = casadi.solve(columns, -right, "qr")
        drift = casadi.Function("second", [x, p, xd, pd, pdd], [second])
        right = drift(found, at, moved, rate, acceleration)
        return [moved, casadi.solve(columns, -right, "qr")]

    def _built(self, function: Any) -> Any:
        """The function as C, compiled."""
        folder = Path(self._folder.name)
        number = len(list(folder.glob("*.c")))
        generator = self.casadi.CodeGenerator(f"sweep{number}")
        generator.add(function)
        source = generator.generate(f"{folder}/")
        library = folder / f"sweep{number}.so"
        subprocess.run([COMPILER, *FLAGS, source, "-o", str(library), "-lm"], check=True)
        return self.casadi.external(function.name(), str(library))

    def run(self, solve: Any, *, moving: bool) -> Any:
        """All rows by a compiled function."""
        rows = self.rows
        given = [rows.start[rows.unknowns], rows.inputs]
        return solve.call([*given, *((rows.rates, rows.accelerations) if moving else ())])

    def read(self, call: Callable[[], Any]) -> Values:
        """What a run finds, by name."""
        rows, found = self.rows, [np.array(array) for array in call()]
        count = rows.inputs.shape[1]
        q = np.repeat(rows.start[:, None], count, axis=1)
        q[rows.driven], q[rows.unknowns] = rows.inputs, found[0]
        orientations = [rows.turned] * count
        if len(found) == 1:
            return rows.named(q, orientations)
        moved = [np.zeros_like(q), np.zeros_like(q)]
        for array, given, own in zip(
            moved, (rows.rates, rows.accelerations), found[1:], strict=True
        ):
            array[rows.driven], array[rows.unknowns] = given, own
        return named_motion(rows, q, orientations, *moved)
