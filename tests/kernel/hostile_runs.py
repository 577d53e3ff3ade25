"""Misuse of tapes, variants, positions, paths, texts: `python -m kernel.hostile_runs SEED COUNT`.

As `hostile`: every call must end with a result or with a documented refusal. Plans are random ones
and sound ones with their true states; objects that belong to plans of earlier trials come back as
arguments; threads call at once, and change the arrays of calls that run.
"""

from __future__ import annotations

import gc
import itertools
import random
import sys
import threading
from collections import Counter
from functools import cache
from typing import Any

import numpy as np
from kernel.hostile import INDICES, NUMBERS, WRONG, Hostile
from prepared import prepared
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.session import turn_count
from mechkin_cli.session.cells import SWITCHES
from mechkin_cli.session.following import step_limits
from mechkin_cli.tape.tape import CONDITIONS, Operation

HUGE = 2**59
"""Rows of a table without columns: it takes no memory, its length in bytes overflows."""
USUAL: dict[str, Any] = {
    "turn_cosine": 0.97,
    "turn": 0.2,
    "bend": 0.35,
    "jump": 0.1,
    "infill": 0.02,
    "longest_step": 0.5,
    "least_step": 1e-15,
    "most_steps": 300,
    "tight": 1e-16,
    "coarse": 1e-8,
    "accept": 1e-14,
    "pivot": 1e-6,
    "iterations": 6,
    "same_line": 1e-12,
    "knot": 0.01,
    "corner_cosine": 0.99,
    "stray": 1e-3,
    "angle_step": 0.1,
    "angle_miss": 1.0,
    "angle_bend": 0.5,
    "plan_step": 1e-3,
    "arc_pivot": 1e-8,
    "radius": 0.5,
    "narrow": 1e-2,
    "arc_steps": 100,
    "arc_work": 1e9,
    "straight": False,
}
"""Limits of a step that follow a branch."""
STRANGE: list[Any] = [(), (None,) * 4, ([1.0], True, 2, False), (np.zeros(1, np.int32), ["a"], 1)]


class Sound:
    """A plan that closes, its inputs, a state, and what is recorded of it: nothing but constants
    that an input of the tape scales."""

    def __init__(self, name: str) -> None:
        setup = prepared(mk.load(FILE_OF[name]).problem)
        self.plan = build_plan(setup.layout)
        self.inputs = np.ascontiguousarray(setup.inputs.values[:, :5])
        self.state = np.ascontiguousarray(setup.start.state)


@cache
def sound(name: str) -> Sound:
    return Sound(name)


KEPT: dict[str, list[Any]] = {}
"""Objects of earlier trials, by kind."""


class HostileRuns(Hostile):
    """The same draws, of other calls."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self.noise = np.random.default_rng(seed)
        self.codes: dict[int, Any] = {}

    def kept(self, kind: str, own: Any) -> Any:
        """An object of this trial, or now and then one of another plan; `own` is kept, too."""
        pool = KEPT.setdefault(kind, [])
        if own is not None:
            pool.append(own)
            if len(pool) > 40:
                del pool[self.random.randrange(20)]
        if self.random.random() < 0.5 * self.wrong + 0.02:
            return self.random.choice([*pool, *WRONG])
        return own

    def either(self, good: Any, *others: Any) -> Any:
        return self.random.choice([*others, *WRONG]) if self.bad() else good

    def table(self, columns: int, rows: int) -> Any:
        """A table, or one of another shape; one without columns may have any number of rows."""
        if columns == 0 and self.bad():
            return np.zeros((0, self.random.choice([HUGE, 2**40, 2**31])))
        return self.array(columns, rows)

    def around(self, values: Any, spread: float) -> Any:
        """Numbers near some others, so that loops close; sometimes one of them is none."""
        near = np.array(values) + self.noise.normal(0.0, spread, np.shape(values))
        if near.size and self.bad():
            near.flat[self.random.randrange(near.size)] = self.random.choice(NUMBERS)
        return near

    # --- what all calls take ------------------------------------------------------------------

    def limits(self) -> Any:
        given = dict(USUAL)
        while self.bad():
            name = self.random.choice(list(USUAL))
            given[name] = self.random.choice([*NUMBERS, *INDICES, *WRONG])
        return self.attempt(_kernel.StepLimits, **given) or step_limits()

    def some_plan(self) -> tuple[Any, Any, Any]:
        """A plan, inputs (inputs, rows) and a state; of sound plans they belong together."""
        if self.random.random() < 0.6:
            found = sound(self.random.choice(["rcsr", "rsgc", "pspr"]))
            return found.plan, self.around(found.inputs, 0.0), self.around(found.state, 0.0)
        plan = self.attempt(self.builder().finish)
        if plan is None:
            return self.some_plan()
        inputs = self.noise.uniform(-1.0, 1.0, (plan.inputs, self.random.choice([1, 3, 5])))
        return plan, inputs, self.noise.uniform(-1.0, 1.0, plan.states)

    # --- tapes --------------------------------------------------------------------------------

    def operands(self, first: int, count: int) -> Any:
        drawn = [[self.random.randrange(max(1, first + k)) for _ in range(3)] for k in range(count)]
        operands = np.array(drawn, np.int32).reshape(count, 3)
        if operands.size and self.bad():
            operands.flat[self.random.randrange(operands.size)] = self.random.choice(
                [-1, first, first + count, 2**31 - 1, -(2**31)]
            )
        return operands

    def numbers_of(self, kind: Any, count: int, end: int) -> Any:
        """(count,) whole numbers below `end`, as a rule."""
        array = self.noise.integers(0, max(1, end), count).astype(kind)
        if array.size and self.bad():
            array[self.random.randrange(count)] = self.random.choice([255, 200, 25, 127])
        wrong = [array[:-1], array.astype(np.int16), array.reshape(1, -1), array[::-1]]
        return self.either(array, *wrong)

    def tape(self, inputs: int, outputs: Any) -> Any:
        """A random tape; `outputs` (registers,) or how many are drawn."""
        constants = self.around(np.ones(self.random.randint(0, 4)), 1.0)
        count, guards = self.random.randint(0, 12), self.random.randint(0, 3)
        first = inputs + constants.size
        registers = first + count
        if isinstance(outputs, int):
            outputs = self.numbers_of(np.int32, outputs, registers)
        asked = self.noise.integers(0, max(1, registers), (guards, 3)).astype(np.int32)
        asked[:, 0] = [self.random.choice(CONDITIONS) for _ in range(guards)]
        if asked.size and self.bad():
            asked.flat[self.random.randrange(asked.size)] = self.random.choice([-1, 9, 14, 2**30])
        arguments = [
            self.either(inputs, 0, -1, 2**31 - 1, 2**31),
            self.either(constants, constants.astype(np.float32), constants.reshape(-1, 1)),
            self.numbers_of(np.uint8, count, len(Operation)),
            self.either(self.operands(first, count), np.zeros((count, 2), np.int32)),
            outputs,
            self.either(asked, asked[:, :2], asked.astype(np.float64)),
            self.numbers_of(np.uint8, guards, 2),
            self.numbers_of(np.uint8, guards, 2),
        ]
        tape = self.attempt(_kernel.Tape, *arguments)
        self.codes[id(tape)] = np.ravel(arguments[2]) if tape is not None else ()
        if tape is not None and self.bad():
            self.attempt(tape.__init__, *arguments)
        return tape

    def replays(self) -> None:
        inputs = self.random.randint(1, 4)
        tape = self.tape(inputs, self.random.randint(0, 6))
        if tape is None:
            return
        KEPT.setdefault("tape", []).append(tape)
        del KEPT["tape"][:-20]
        wild = self.noise.integers(0, 2**63, (inputs, self.random.choice([0, 1, 7, 65])))
        values = (wild.astype(np.uint64) * np.uint64(2)).view(np.float64)
        values = self.either(values, values.T, values.astype(np.float32), self.array(inputs, 9))
        self.attempt(tape.replay, values, self.either(0, *INDICES))
        switches = sum(int(code) in SWITCHES for code in self.codes.get(id(tape), ()))
        ways = self.noise.choice([-1.0, 0.0, 1.0, 5.0], switches)
        self.attempt(tape.jets, values, self.either(ways, ways[:-1], ways.astype(np.float32)))

    # --- variants and positions -----------------------------------------------------------------

    def reading(self, plan: Any) -> tuple[Any, int, int]:
        """Outputs, what they demand at least, and how many constants they have."""
        outputs = self.kept("outputs", self.outputs(plan))
        if not isinstance(outputs, _kernel.Outputs):
            return outputs, 0, 0
        return outputs, int(outputs.demand), outputs.constants.size

    def base_tape(self, plan: Any, outputs: Any, moving: int) -> tuple[Any, Any]:
        """A tape that gives the constants of plan and outputs, of which its inputs are some, and
        the base's parameters."""
        kept = getattr(outputs, "constants", np.zeros(0))
        constants = np.concatenate([plan.constants, kept, np.zeros(moving)])
        given = self.noise.permutation(constants.size)[: self.random.randint(1, 4)]
        registers = np.arange(constants.size, dtype=np.int32) + given.size
        registers[given] = np.arange(given.size)
        none = np.zeros((0, 3), np.int32), np.zeros(0, np.uint8)
        arguments = (constants, none[1], none[0], registers, none[0], none[1], none[1])
        return _kernel.Tape(int(given.size), *arguments), constants[given]

    def angles(self, slots: Any, plan: Any) -> Any:
        turns = turn_count(plan)
        if self.bad():
            return self.random.choice([[(self.index(0, 9), self.index(0, 9))], [(0,)], *WRONG])
        if not turns or not slots or self.random.random() < 0.5:
            return []
        turn = self.random.choice([self.random.randrange(turns), -2])
        return [(self.random.randrange(slots), turn, self.random.random() < 0.5)]

    def known_rows(self, plan: Any, inputs: Any) -> dict[str, Any]:
        rows = inputs.shape[1]
        named = {"inputs": self.either(inputs, inputs.T, self.table(plan.inputs, rows))}
        for name in ("rates", "accelerations", "jerks"):
            named[name] = self.table(plan.inputs, rows)
        named["whole"] = self.whole_turns(plan.inputs, rows)
        return named

    def whole_turns(self, inputs: int, rows: int) -> Any:
        few = self.noise.integers(-2, 3, (inputs, rows)).astype(np.float64)
        return self.either(np.zeros((inputs, rows)), few, self.table(inputs, rows))

    def variants(self) -> None:
        plan, inputs, state = self.some_plan()
        outputs, demand, _ = self.reading(plan)
        moving = self.random.choice([0, 0, 4 * inputs.size])
        tape, base = self.base_tape(plan, outputs, moving)
        tape = self.kept("tape", tape)
        rows = inputs.shape[1]
        named = self.known_rows(plan, inputs) | {
            "tape": tape,
            "plan": self.kept("plan", plan),
            "outputs": outputs,
            "parameters": self.either(base, base[:-1], np.append(base, 1.0), base.reshape(1, -1)),
            "state": self.either(state, state[:-1], np.append(state, 0.0), state.reshape(1, -1)),
            "size": self.either(plan.size, *NUMBERS),
            "start_row": self.either(self.random.randrange(rows), *INDICES),
            "demand": self.either(demand | self.random.choice([0, 3, 8, 64]), *INDICES),
            "iterations": self.either(6, *INDICES),
            "continuation": self.kept("limits", self.limits()),
            "following": self.kept("limits", self.limits()),
            "half_turn_side": self.either(1e-9, *NUMBERS),
            "angles": self.angles(getattr(outputs, "slots", 0), plan),
            "full": self.table(plan.inputs, rows),
            "time": self.either(np.zeros(rows), self.array(1, rows), np.zeros(rows + 1)),
        }
        variants = self.attempt(_kernel.Variants, **named)
        if variants is None:
            return
        if self.bad():
            self.attempt(variants.__init__, **named)
        count = self.random.choice([0, 1, 3, 40])
        # the last reference may go while the kernel's object lives
        del tape, plan, outputs
        values = self.around(np.repeat(base[:, None], count, 1), self.random.choice([0, 1e-3, 1]))
        values = self.either(values, values.T, self.array(base.size, count))

        def call() -> None:
            lanes, threads = self.either(0, *INDICES), self.either(2, *INDICES)
            found = self.attempt(variants.run, values, lanes, threads)
            if found is not None:
                self.counts["variants complete"] += int((found[3] == 0).sum())
            self.attempt(variants.start, self.either(base, base[:-1], values))

        self.at_once(call, values)

    def positions(self) -> None:
        plan, inputs, state = self.some_plan()
        outputs, demand, _ = self.reading(plan)
        rows = inputs.shape[1]
        turns = turn_count(plan)
        named = self.known_rows(plan, inputs) | {
            "plan": self.kept("plan", plan),
            "outputs": outputs,
            "states": np.repeat(np.array(state)[:, None], rows, 1)
            if not self.bad()
            else self.table(plan.states, rows),
            "turns": self.table(turns, rows),
            "demand": self.either(demand | self.random.choice([0, 3, 64]), *INDICES),
            "iterations": self.either(6, *INDICES),
            "limits": self.kept("limits", self.limits()),
            "angles": self.angles(getattr(outputs, "slots", 0), plan),
        }
        positions = self.attempt(_kernel.Positions, **named)
        if positions is None:
            return
        if self.bad():
            self.attempt(positions.__init__, **named)
        del plan, outputs

        def call() -> None:
            for _ in range(3):
                here = self.around(inputs[:, 0], 1e-2).tolist()
                turns = self.either([0.0] * len(here), [3.0], [float("nan")] * len(here))
                full = self.either(here, here[:-1], [float("inf")] * len(here))
                here = self.either(here, here[:-1], [*here, 0.0])
                found = self.attempt(positions.solve, here, turns, full)
                self.counts["positions found"] += found is not None

        self.at_once(call, inputs)

    def at_once(self, call: Any, changed: Any) -> None:
        """The call, sometimes by threads, while another one changes an array of it."""
        if self.random.random() < 0.7:
            call()
            return
        threads = [threading.Thread(target=call) for _ in range(2)]
        for thread in threads:
            thread.start()
        if isinstance(changed, np.ndarray) and changed.size and changed.dtype != object:
            for _ in range(20):
                changed.flat[-1] = self.random.choice([0, 1])
        for thread in threads:
            thread.join()

    # --- paths ------------------------------------------------------------------------------------

    def paths(self) -> None:
        plan, inputs, state = self.some_plan()
        stepper = None
        if self.random.random() < 0.5:
            stepper = self.along(plan, inputs, state)
        else:
            direction = self.around(np.ones(plan.inputs), 0.1).tolist()
            stepper = self.attempt(
                _kernel.Stepper.straight, plan, inputs[:, 0].tolist(), direction, self.limits()
            )
        if stepper is not None:
            self.steps(self.kept("stepper", stepper), state)

    def along(self, plan: Any, inputs: Any, state: Any) -> Any:
        """A path out of Python: wrong plans and places, calls of the stepper that asks, errors."""
        held: list[Any] = []
        varies = self.random.random() < 0.7

        def other(sigma: float) -> Any:
            if self.bad():
                return self.kept("plan", plan)
            if self.bad() and held:
                self.attempt(held[0].close, sigma, state.tolist())
            constants = np.array(plan.constants)
            constants[5:] *= 1.0 + 1e-3 * sigma
            return plan.with_constants(constants)

        def at(sigma: float) -> Any:
            here = inputs[:, 0] + sigma * 0.1
            if self.bad() and held:
                self.attempt(held[0].close, sigma, state.tolist())
            if self.bad():
                raise ValueError("the path ends here")
            zeros = np.zeros(len(here)).tolist()
            good = here.tolist(), zeros, zeros
            return self.either(good, (good[0],), (good[0], [], zeros), ([None], zeros, zeros))

        named = self.either(other if varies else plan, other, plan), self.either(at)
        made = self.attempt(_kernel.Stepper.along, *named, self.either(varies), self.limits())
        if isinstance(made, _kernel.Stepper):
            held.append(made)
        return made

    def steps(self, stepper: Any, state: Any) -> None:
        if not isinstance(stepper, _kernel.Stepper):
            return
        start = state.tolist()
        guess = self.either(start, start[:-1], [*start, 0.0], [None] * len(start))
        node = self.attempt(stepper.close, self.either(0.0, *NUMBERS), guess)
        before = node
        for _ in range(3):
            node = self.kept("node", node)
            for call in (stepper.predict, stepper.step):
                self.attempt(call, node, self.either(0.01, *NUMBERS))
            self.attempt(stepper.judge, self.either(before, *KEPT["node"]), node)
            self.attempt(stepper.wanted_step, node)
            if not isinstance(node, _kernel.Node):
                return
            before, node = node, self.attempt(stepper.step, node, 0.01) or node

    def course(self, plan: Any, rows: int) -> Any:
        """Pieces of random tapes over the rows, and a look at some places of them."""
        tape = self.tape(2, plan.inputs)
        if tape is None:
            return None
        switches = sum(int(code) in SWITCHES for code in self.codes.get(id(tape), ()))
        cuts = sorted(self.random.sample(range(rows), min(rows, self.random.randint(2, 4))))
        pieces = [
            (first, last, self.number(), self.number(), self.either(1.0, *NUMBERS), power)
            for first, last in itertools.pairwise(cuts)
            for power in [self.either(1.0, 2.0, -3.0, 0.0, 1e9)]
        ]
        arguments = [
            tape,
            self.either(pieces, pieces[::-1], [(0,)], None),
            self.array(len(pieces), 1),
            self.array(len(pieces), switches),
            self.either(np.ones(plan.inputs), np.zeros(plan.inputs), np.ones(plan.inputs + 1)),
            self.noise.normal(size=rows),
        ]
        made = self.attempt(_kernel.Course, *arguments)
        if isinstance(made, _kernel.Course):
            for call in (made.at, made.sigma, made.parameter):
                self.attempt(call, self.either(0, *INDICES), self.either(0.3, *NUMBERS))
        return made

    def followed(self) -> None:
        plan, inputs, state = self.some_plan()
        limits = self.limits()
        if self.random.random() < 0.2:
            # rows whose distances overflow, under limits that see no corner
            inputs = self.noise.choice([0.0, 1e-200, 1e200, -1e300, 1.0], (plan.inputs, 6))
            limits = _kernel.StepLimits(**(USUAL | {"corner_cosine": -1.0}))
        rows = inputs.shape[1]
        turns = turn_count(plan)
        guess, limit = self.array(plan.states, rows), self.per_row(rows)
        carried = self.either(np.zeros((turns, rows)), None, guess, self.table(turns, rows))
        if self.bad():
            guess = inputs if self.random.random() < 0.5 else carried
        begin = self.either([0.0] * turns, [], [0.0] * (turns + 1))
        start = self.either(state.tolist(), state[:-1].tolist())
        whole = self.either(None, None, np.zeros(inputs.shape), self.whole_turns(plan.inputs, rows))
        arguments = [plan, inputs, whole, start, begin, self.either(False, True), limits]

        course = self.either(None, self.course(plan, rows))

        def call() -> None:
            found = self.attempt(_kernel.follow_rows, *arguments, guess, limit, carried, course)
            self.counts["rows followed"] += 0 if found is None else found[1]

        self.at_once(call, inputs)

    # --- texts ------------------------------------------------------------------------------------

    def text_column(self, rows: int) -> Any:
        numbers = self.noise.normal(size=rows) * 10.0 ** self.noise.integers(-300, 300, rows)
        if rows and self.bad():
            numbers[0] = self.random.choice(NUMBERS)
        if self.bad():
            wrong = [numbers[:-1], numbers.astype(np.float32), numbers[::2], numbers.reshape(1, -1)]
            return self.random.choice([*wrong, *WRONG, *STRANGE])
        kind = self.random.randrange(3)
        if kind == 0:
            return numbers
        if kind == 1:
            digits = self.either(self.random.choice([0, 3, 17, 1000]), -1, 1001, *INDICES)
            return (self.either(numbers), self.either(True, False), digits, self.either(True))
        texts = self.either(
            ["ä", "b", "", '"', "\n,"], [], ["\udc80"], ["a\0b"], [1, 2], ("a", "b")
        )
        codes = self.noise.integers(0, 5, rows).astype(np.int32)
        if rows and self.bad():
            codes[-1] = self.random.choice([-1, 5, 2**31 - 1, -(2**31)])
        return (self.either(codes, codes.astype(np.int64)), texts)

    def texts(self) -> None:
        rows = self.random.choice([0, 1, 3, 1024, 1025, 3000])
        count = self.random.randint(0, 4)
        columns = [self.text_column(rows) for _ in range(count)]
        labels = [self.either(self.random.choice(["a", "ß", ""]), "\ud800") for _ in range(count)]
        labels = self.either(labels, [*labels, "more"], tuple(labels))
        room = self.either(
            np.zeros(self.random.choice([0, 1, 100, 1 << 16]), np.uint8),
            np.zeros(100),
            b"not to be written",
        )
        whole = self.either([False] * count, [True] * (count + 1))
        changed = self.changed(columns)

        def call() -> None:
            threads = self.either(self.random.choice([1, 3]), *INDICES)
            digits = self.either(self.random.randint(0, 15), *INDICES)
            comma, first = self.random.random() < 0.5, self.either(0, rows, rows + 1, *INDICES)
            self.attempt(_kernel.csv_header, labels, comma)
            self.attempt(_kernel.csv_lines, columns, first, room, digits, False, comma, threads)
            self.attempt(_kernel.json_lines, labels, columns, first, room, whole, threads)
            self.attempt(_kernel.markdown_text, labels, columns, threads)
            for column in columns:
                self.attempt(_kernel.json_list, column, threads)
                self.attempt(_kernel.decimal_texts, column)
            self.attempt(_kernel.number_text, self.number(), digits)

        self.at_once(call, changed)

    def changed(self, columns: list[Any]) -> Any:
        """An array that one of the columns is made of."""
        for column in columns:
            array = column[0] if isinstance(column, tuple) and column else column
            if isinstance(array, np.ndarray):
                return array
        return None

    def trial(self) -> Counter[str]:
        """A few calls of every kind."""
        for call in (
            *(self.replays, self.variants, self.positions),
            *(self.paths, self.followed, self.texts),
        ):
            call()
        return self.counts


def unfinished() -> None:
    """Objects that were never made refuse to work."""
    hostile = HostileRuns(0)
    random.seed(0)
    for kind, method in (
        (_kernel.Tape, "replay"),
        (_kernel.Variants, "run"),
        (_kernel.Variants, "start"),
        (_kernel.Positions, "solve"),
        (_kernel.Stepper, "close"),
        (_kernel.Node, "state"),
    ):
        empty = kind.__new__(kind)
        found = hostile.attempt(lambda e=empty, m=method: getattr(e, m)(np.zeros((1, 1))))
        assert found is None, kind


def main(seed: int, count: int) -> None:
    """Prints how often each outcome came."""
    counts: Counter[str] = Counter()
    unfinished()
    for number in range(seed, seed + count):
        print(number, file=sys.stderr, flush=True)
        counts += HostileRuns(number).trial()
        if number % 100 == 0:
            gc.collect()
    print(dict(counts))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
