"""Random intervals and what the kernel makes of them, against mpmath.

    python tests/kernel/intervals.py [ARGUMENTS] [SEED]

tells of every operation how many of its results were known and how many left a value out (none
may). Arguments are of all magnitudes, with radii from zero to far wider than the midpoint, and near
points where a function bends, ends or has its cut; of each interval both ends and a point within
are taken.
"""

from __future__ import annotations

import ctypes
import math
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from mpmath import mp, mpf

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))
from kernel.compiler import compile_with

LANES = 2


def power(x: Any, y: Any) -> Any:
    if x == 0:
        return mpf(1) if y == 0 else mpf(0) if y > 0 else None
    return None if x < 0 and y != int(y) else mp.power(x, y)


def between(low: Any, high: Any) -> Callable[[Any, Any], bool]:
    return lambda x, _: low <= x <= high


def everywhere(_x: Any, _y: Any) -> bool:
    return True


@dataclass(frozen=True)
class Operation:
    exact: Callable[[Any, Any], Any]
    defined: Callable[[Any, Any], bool] = everywhere
    critical: tuple[float, ...] = (0.0,)
    largest: float = 1e300
    """Beyond it results leave the range of doubles, or mpmath takes long."""
    turns: bool = False
    """Angles, which count up to whole turns."""


QUARTERS = (*(k * math.pi / 2 for k in range(-6, 7)), 1e5 * math.pi, 2e5)
OPERATIONS = {
    "add": Operation(lambda x, y: x + y),
    "subtract": Operation(lambda x, y: x - y),
    "multiply": Operation(lambda x, y: x * y),
    "divide": Operation(lambda x, y: x / y, lambda _, y: y != 0),
    "sqrt": Operation(lambda x, _: mp.sqrt(x), lambda x, _: x >= 0),
    "square": Operation(lambda x, _: x * x),
    "sin": Operation(lambda x, _: mp.sin(x), critical=QUARTERS),
    "cos": Operation(lambda x, _: mp.cos(x), critical=QUARTERS),
    "tan": Operation(lambda x, _: mp.tan(x), critical=QUARTERS),
    "atan2": Operation(lambda y, x: mp.atan2(y, x), lambda y, x: (x, y) != (0, 0), turns=True),
    "atan": Operation(lambda x, _: mp.atan(x)),
    "asin": Operation(lambda x, _: mp.asin(x), between(-1, 1), (0.0, 0.5, 1.0, -1.0), 1.0),
    "acos": Operation(lambda x, _: mp.acos(x), between(-1, 1), (0.0, 0.5, 1.0, -1.0), 1.0),
    "exp": Operation(lambda x, _: mp.exp(x), critical=(0.0, 709.0, -740.0), largest=700.0),
    "log": Operation(lambda x, _: mp.log(x), lambda x, _: x > 0, (0.0, 1.0)),
    "power": Operation(power, lambda x, y: power(x, y) is not None, (0.0, 1.0, 2.0), 1e60),
    "hull": Operation(lambda x, _: x),
    "add_product": Operation(lambda x, y: x + x * y, largest=1e140),
    "sum_of_products": Operation(lambda x, y: x * y + y * y - x * x, largest=1e140),
    "difference_of_products": Operation(lambda x, y: x * y - y * y, largest=1e140),
    "principal_angle": Operation(lambda y, x: mp.atan2(y, x), lambda y, x: (x, y) != (0, 0)),
}


class Intervals:
    """The probe, compiled into a folder."""

    def __init__(self, folder: Path) -> None:
        source = Path(__file__).with_name("interval_probe.cpp")
        options = "-O2", "-shared", f"-DMECHKIN_LANES={LANES}", "-DMECHKIN_ARITHMETIC=2"
        self.library = ctypes.CDLL(str(compile_with(source, folder / "intervals.so", *options)))

    def __call__(self, operation: str, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Enclosures (3, n), as high and low parts of midpoints and radii, of an operation on those
        of x and y; n is even."""
        x, y = np.ascontiguousarray(x), np.ascontiguousarray(y)
        out = np.empty_like(x)
        pointers = (ctypes.c_void_p(each.ctypes.data) for each in (x, y, out))
        code = list(OPERATIONS).index(operation)
        self.library.enclose(code, *pointers, ctypes.c_long(x.shape[1]))
        return out


def midpoints(operation: Operation, random: np.random.Generator, count: int) -> np.ndarray:
    """A third of all magnitudes, a third of moderate size, a third near critical points."""
    top = math.log2(operation.largest)
    sign = random.choice([-1.0, 1.0], count)
    all_sizes = np.ldexp(random.uniform(0.5, 1, count), random.integers(-1073, int(top) + 1, count))
    moderate = random.uniform(-min(operation.largest, 10.0), min(operation.largest, 10.0), count)
    near = random.choice(operation.critical, count)
    near = near + sign * 10.0 ** random.uniform(-18, 0, count) * random.choice([0.0, 1.0], count)
    which = random.integers(0, 3, count)
    drawn: np.ndarray = np.choose(which, [sign * all_sizes, moderate, near])
    return np.maximum(np.minimum(drawn, operation.largest), -operation.largest)


def radii(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Zero, from the size of rounding to parts of the midpoint, and wide ones."""
    count = len(x)
    relative = np.abs(x) * 10.0 ** random.uniform(-33, 1, count)
    absolute = 10.0 ** random.uniform(-300, 2, count)
    moderate = 10.0 ** random.uniform(-30, 0.5, count)
    kinds = [np.zeros(count), relative, absolute, moderate]
    drawn: np.ndarray = np.choose(random.integers(0, 4, count), kinds)
    return drawn


def low_parts(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """None, or of any size below half a place of x."""
    count = len(x)
    part = random.uniform(-1, 1, count) * 2.0 ** -random.integers(0, 40, count)
    drawn: np.ndarray = np.where(random.uniform(size=count) < 0.3, 0.0, part * np.spacing(x) / 2)
    return drawn


def arguments(name: str, random: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    operation = OPERATIONS[name]
    x, y = (midpoints(operation, random, count) for _ in range(2))
    if name == "power":
        whole = random.integers(-6, 7, count).astype(float)
        y = np.choose(random.integers(0, 2, count), [whole, np.clip(y, -4, 4)])
    low = low_parts(x, random), low_parts(y, random)
    if name == "power":
        low[1][whole == y] = 0.0
    result = np.stack([x, low[0], radii(x, random)]), np.stack([y, low[1], radii(y, random)])
    if name == "power":
        result[1][2, : count // 2] = 0.0
    return result


def points(interval: np.ndarray, random: np.random.Generator) -> list[Any]:
    high, low, radius = map(mpf, map(float, interval))
    middle = high + low
    parts = (-1.0, 1.0, random.uniform(-1, 1))
    return [middle + radius * mpf(part) for part in parts] if radius else [middle]


def precision(*numbers: float) -> int:
    """Bits that keep a hundred of any sum or angle of these numbers."""
    sizes = [math.frexp(x)[1] for x in numbers if x and math.isfinite(x)] or [0]
    return 240 + max(sizes) - min(min(sizes), 0)


def values(name: str, x: Any, y: Any, random: np.random.Generator) -> Iterator[Any]:
    operation = OPERATIONS[name]
    for a in points(x, random):
        for b in points(y, random) if operation.exact.__code__.co_varnames[1] != "_" else [mpf(0)]:
            if operation.defined(a, b):
                yield operation.exact(a, b)
            else:
                yield None


def check(enclose: Intervals, name: str, count: int, seed: int) -> tuple[int, list[Any]]:
    """How many results are known, and the arguments with a value outside or without one."""
    random = np.random.default_rng([seed, list(OPERATIONS).index(name)])
    x, y = arguments(name, random, count)
    found = enclose(name, x, y)
    known, outside = 0, []
    for i in range(count):
        high, low, radius = map(float, found[:, i])
        if not (math.isfinite(high) and math.isfinite(low) and math.isfinite(radius)):
            continue
        known += 1
        with mp.workprec(precision(*x[:, i], *y[:, i], high, low, radius)):
            for value in values(name, x[:, i], y[:, i], random):
                off = None if value is None else value - mpf(high) - mpf(low)
                if off is not None and OPERATIONS[name].turns:
                    off -= 2 * mp.pi * mp.nint(off / (2 * mp.pi))
                if off is None or abs(off) > mpf(radius):
                    outside.append((x[:, i].tolist(), y[:, i].tolist(), high, low, radius))
                    break
    return known, outside


def main() -> int:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 10**6
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        enclose = Intervals(Path(folder))
        each = 2 * -(-count // (2 * len(OPERATIONS)))
        for name in OPERATIONS:
            known, outside = check(enclose, name, each, seed)
            print(f"{name}: {each} arguments, {known} known, {len(outside)} outside", flush=True)
            for case in outside[:3]:
                print("  ", *case)
            wrong += len(outside)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
