"""Numbers in double-double, as pairs (high, low), and the operations of a tape on them.

    python -P tests/kernel/double_double.py [--count 100000] [--seed 1]

tries as many random and hard arguments of every operation against mpmath.
"""

from __future__ import annotations

import argparse
import random
from collections.abc import Callable, Iterable, Sequence

import mpmath as mp
import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.tape.tape import Operation, replay_precise

Pair = tuple[float, float]
UNIT = mp.mpf(2) ** -106

# enough for sin of 1e300 next to a multiple of pi
DIGITS = 420

TRUE: dict[Operation, Callable[..., mp.mpf]] = {
    Operation.ADD: lambda x, y: x + y,
    Operation.SUBTRACT: lambda x, y: x - y,
    Operation.MULTIPLY: lambda x, y: x * y,
    Operation.DIVIDE: lambda x, y: x / y,
    Operation.SQUARE_ROOT: lambda x, y: mp.sqrt(x),
    Operation.SIN: lambda x, y: mp.sin(x),
    Operation.COS: lambda x, y: mp.cos(x),
    Operation.TAN: lambda x, y: mp.tan(x),
    Operation.ASIN: lambda x, y: mp.asin(x),
    Operation.ACOS: lambda x, y: mp.acos(x),
    Operation.ATAN: lambda x, y: mp.atan(x),
    Operation.ATAN2: lambda x, y: mp.atan2(x, y),
    Operation.EXP: lambda x, y: mp.exp(x),
    Operation.LOG: lambda x, y: mp.log(x),
    Operation.POWER: lambda x, y: mp.power(x, y),
}


def bound(operation: Operation, x: mp.mpf, y: mp.mpf) -> mp.mpf:
    """Relative error that the headers promise."""
    if operation in (Operation.ADD, Operation.SUBTRACT):
        return 3.01 * UNIT
    if operation is Operation.MULTIPLY:
        return 5 * UNIT
    if operation is Operation.DIVIDE:
        return 10 * UNIT
    if operation is Operation.SQUARE_ROOT:
        return 4 * UNIT
    scale = 1 + abs(y * mp.log(x)) if operation is Operation.POWER else 1
    return mp.mpf("2e-31") * scale


def pair(value: object) -> Pair:
    exact = mp.mpf(value)
    high = float(exact)
    return high, float(exact - high)


def exact(number: Sequence[float]) -> mp.mpf:
    return mp.mpf(float(number[0])) + mp.mpf(float(number[1]))


def compute(
    operation: Operation, first: Sequence[Pair], second: Sequence[Pair], lanes: int = 0
) -> np.ndarray:
    """(numbers, 2): an operation on pairs."""
    none = np.empty(0, np.uint8)
    tape = _kernel.Tape(
        2,
        np.empty(0),
        np.array([operation], np.uint8),
        np.array([[0, 1, 1]], np.int32),
        np.array([2], np.int32),
        np.empty((0, 3), np.int32),
        none,
        none,
    )
    values = np.array([np.array(first).T, np.array(second).T])
    found, _ = replay_precise(tape, values, lanes=lanes)
    return found[:, 0]


class Arguments:
    """Random pairs, with low parts that matter."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def sign(self) -> int:
        return self.random.choice((-1, 1))

    def pair(self, least: float, most: float, positive: bool = False) -> Pair:
        """Of a size from 10^least to 10^most."""
        mantissa = 1 + mp.mpf(self.random.getrandbits(120)) / mp.mpf(2) ** 120
        size = mp.mpf(10) ** self.random.uniform(least, most) * mantissa
        return pair(size if positive else self.sign() * size)

    def near(self, value: mp.mpf, least: float, most: float) -> Pair:
        return pair(value * (1 + self.sign() * mp.mpf(10) ** self.random.uniform(least, most)))

    def angle(self) -> Pair:
        kind = self.random.randrange(5)
        if kind < 3:
            return self.pair(*((-10, 0), (0, 5), (5, 300))[kind])
        turns = self.random.choice((5, 16, 30, 60, 300, 900))
        multiple = (1 + self.random.getrandbits(turns)) * mp.pi / 2
        return pair(multiple) if kind == 3 else self.near(multiple, -31, -16)

    def of(self, operation: Operation) -> tuple[Pair, Pair]:
        """Arguments of an operation, every second of them hard."""
        hard, none = self.random.random() < 0.5, (0.0, 0.0)
        if operation in (Operation.ADD, Operation.SUBTRACT) and hard:
            x = self.pair(-3, 3)
            other = exact(x) * (-1 if operation is Operation.ADD else 1)
            return x, self.near(other, -31, -3)
        if operation in (Operation.SIN, Operation.COS, Operation.TAN):
            return self.angle(), none
        if operation is Operation.ATAN2:
            return (self.pair(-130, 130), self.pair(-130, 130)) if hard else self.both(5)
        if operation in (Operation.ASIN, Operation.ACOS):
            if hard:
                return pair(self.sign() * (1 - mp.mpf(10) ** self.random.uniform(-31, -1))), none
            return self.pair(-20, -0.31), none
        if operation is Operation.EXP:
            return (pair(self.random.uniform(-600, 700)) if hard else self.pair(-10, 2)), none
        if operation is Operation.LOG:
            if hard:
                return self.near(mp.mpf(1), -30, -1), none
            return self.pair(-290, 300, positive=True), none
        if operation is Operation.POWER:
            return self.pair(-2, 2, positive=True), self.pair(-1, 1.5 if hard else 0.4)
        if operation is Operation.SQUARE_ROOT:
            return self.pair(-200, 200, positive=True), none
        return self.both(140 if hard else 5)

    def both(self, decades: float) -> tuple[Pair, Pair]:
        return self.pair(-decades, decades), self.pair(-decades, decades)


def worst(operation: Operation, cases: Iterable[tuple[Pair, Pair]]) -> mp.mpf:
    """The largest error in parts of what is promised."""
    cases = list(cases)
    found = compute(operation, [x for x, _ in cases], [y for _, y in cases])
    parts = [mp.mpf(0)]
    for (first, second), result in zip(cases, found, strict=True):
        x, y = exact(first), exact(second)
        true = TRUE[operation](x, y)
        error = abs(exact(result) - true) / (abs(true) if true else 1)
        parts.append(error / bound(operation, x, y))
    return max(parts)


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--count", type=int, default=100_000)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    with mp.workdps(DIGITS):
        for operation in TRUE:
            arguments = Arguments(given.seed)
            part = worst(operation, (arguments.of(operation) for _ in range(given.count)))
            print(f"{operation.name:12} {mp.nstr(part, 3)} of the bound")


if __name__ == "__main__":
    main()
