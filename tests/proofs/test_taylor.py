"""Taylor models hold every value: random polynomials with radii against mpmath at 60 digits."""

from __future__ import annotations

import ctypes
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kernel.compiler import COMPILER, compile_with
from mpmath import mp, mpf

COUNT = 300
EXACT = (
    lambda x, y: x + y,
    lambda x, y: x - y,
    lambda x, y: x * y,
    lambda x, y: x / y,
    lambda x, _: mp.sqrt(x),
    lambda x, _: mp.sin(x),
    lambda x, _: mp.cos(x),
    mp.atan2,
)
NAMES = ("add", "subtract", "multiply", "divide", "sqrt", "sin", "cos", "atan2")

pytestmark = pytest.mark.skipif(COMPILER is None, reason="needs a C++ compiler")


@pytest.fixture(scope="module", params=[0, 4])
def library(request: Any, tmp_path_factory: Any) -> ctypes.CDLL:
    options = "-O1", "-shared", "-DMECHKIN_LANES=2", "-DMECHKIN_ARITHMETIC=3"
    target = tmp_path_factory.mktemp("taylor") / "taylor.so"
    source = Path(__file__).with_name("taylor_probe.cpp")
    return ctypes.CDLL(
        str(compile_with(source, target, *options, f"-DMECHKIN_ORDER={request.param}"))
    )


def value(parts: np.ndarray, t: Any) -> Any:
    """The polynomial's value at t; the last part is its radius."""
    found = mpf(0)
    for coefficient in parts[-2::-1]:
        found = found * t + mpf(float(coefficient))
    return found


def drawn(random: np.random.Generator, parts: int) -> np.ndarray:
    """Coefficients that fall fast or not at all, of all sizes; radii of many sizes, or none."""
    size, falling = 10.0 ** random.uniform(-8, 8), 10.0 ** random.uniform(-4, 0.3)
    found: np.ndarray = size * random.uniform(-1, 1, parts) * falling ** np.arange(parts)
    found[-1] = random.choice([0.0, abs(found[0]) * 10.0 ** random.uniform(-17, 0)])
    if random.uniform() < 0.1:
        found[:] = 0.0
    return found


@pytest.mark.parametrize("operation", range(len(NAMES)), ids=NAMES)
def test_every_value_is_held(library: ctypes.CDLL, operation: int) -> None:
    random, parts = np.random.default_rng(operation), library.parts()
    known = 0
    for _ in range(COUNT):
        a, b, out = drawn(random, parts), drawn(random, parts), np.empty(parts)
        pointers = (ctypes.c_void_p(each.ctypes.data) for each in (a, b, out))
        library.model(operation, *pointers)
        radius = float(out[-1])
        if not math.isfinite(radius) or not np.isfinite(out).all():
            continue
        known += 1
        for t in (-1, 1, random.uniform(-1, 1)):
            for end in (-1, 1, random.uniform(-1, 1)):
                with mp.workdps(60):
                    x = value(a, mpf(t)) + mpf(end) * mpf(float(a[-1]))
                    y = value(b, mpf(t)) + mpf(end) * mpf(float(b[-1]))
                    off = EXACT[operation](x, y) - value(out, mpf(t))
                    if operation == 7:
                        off -= 2 * mp.pi * mp.nint(off / (2 * mp.pi))
                    assert abs(off) <= radius, (a, b, t)
    assert known > COUNT / 4


def test_zero_stays_exactly_zero(library: ctypes.CDLL) -> None:
    """Equations that hold exactly are told from those that nearly do."""
    parts = library.parts()
    zero, other, out = np.zeros(parts), drawn(np.random.default_rng(1), parts), np.empty(parts)
    for operation, (a, b) in {2: (zero, other), 0: (zero, zero), 5: (zero, other)}.items():
        library.model(operation, *(ctypes.c_void_p(each.ctypes.data) for each in (a, b, out)))
        assert not out.any()
