"""Misuse of the kernel by the thousand: `python hostile.py SEED COUNT`.

Every call must end with a result or with TypeError, ValueError, OverflowError or MemoryError; a
crash kills this process, which the test sees. Random records with wrong indices, codes, sizes and
numbers make plans; calls with wrong arrays and ranges run what came out of it; finished builders
are used again, and threads add records while others run.
"""

from __future__ import annotations

import random
import sys
import threading
from collections import Counter
from typing import Any

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.session import turn_count
from mechkin_cli.session.following import step_limits

REFUSALS = (TypeError, ValueError, OverflowError, MemoryError)
INDICES = [-(2**40), -(2**31), -1000, -3, -2, -1, 0, 1, 2, 3, 4, 7, 1000, 2**31 - 1, 2**31, 2**40]
NUMBERS = [0.0, 1.0, -1.0, 0.5, 2.0, 1e-300, 1e300, float("nan"), float("inf"), -float("inf")]
WRONG: list[Any] = [None, "text", [], {}, 1.5, -1, 2**70, float("nan"), np.zeros(2), object()]


class Hostile:
    """A generator of bad calls; `wrong` is the share of bad arguments."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.wrong = self.random.choice([0.0, 0.005, 0.05, 0.3])
        self.counts: Counter[str] = Counter()

    def bad(self) -> bool:
        return self.random.random() < self.wrong

    def attempt(self, call: Any, *arguments: Any, **named: Any) -> Any:
        try:
            found = call(*arguments, **named)
        except REFUSALS as refusal:
            self.counts[type(refusal).__name__] += 1
            return None
        self.counts[f"{call.__name__} done"] += 1
        return found

    def index(self, least: int, end: int) -> Any:
        if self.bad():
            return self.random.choice([*INDICES, *WRONG])
        return self.random.randint(least, max(least, end - 1))

    def number(self) -> Any:
        return self.random.choice([*NUMBERS, *WRONG]) if self.bad() else self.random.uniform(-1, 1)

    def numbers(self, count: int) -> Any:
        if self.bad():
            return self.random.choice([*WRONG, [1.0] * (count - 1), [1.0] * (count + 1)])
        return [self.number() for _ in range(count)]

    def knots(self, count: int) -> list[Any]:
        return [x for k in range(count) for x in (float(k), *(self.number() for _ in range(4)))]

    def frame(self) -> Any:
        if self.bad():
            return self.numbers(12)
        origin = [self.random.uniform(-1, 1) for _ in range(3)]
        return [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, *origin]

    def sign(self) -> Any:
        return self.number() if self.bad() else self.random.choice([1.0, -1.0])

    def builder(self) -> Any:
        """A builder with a random tree, loops, legs, places, axes, blocks, loads."""
        builder = None
        while builder is None:
            origin = self.numbers(3)
            builder = self.attempt(
                _kernel.PlanBuilder,
                2.0 if not self.bad() else self.number(),
                origin,
                1.0 if not self.bad() else self.number(),
            )
        links = self.tree(builder)
        closings = self.closings(builder, links)
        places, axes = self.places(builder, links, closings)
        self.blocks(builder, links, closings)
        self.inputs_and_loads(builder, links, closings, places, axes)
        return builder

    def tree(self, builder: Any) -> int:
        links = self.random.randint(0, 6)
        self.types: list[Any] = []
        for k in range(links):
            parent = k - 1 if self.random.random() < 0.7 else self.index(-1, k)
            code = self.index(0, 6)
            self.types.append(code)
            self.attempt(builder.add_tree_joint, code, parent, self.number(), self.frame())
        return links

    def closings(self, builder: Any, links: int) -> int:
        closings = self.random.randint(0, 2)
        for _ in range(closings):
            first, second = self.index(-1, links), self.index(-1, links)
            loop = [(self.index(0, links), self.sign()) for _ in range(links)]
            ends = self.frame(), self.frame()
            if self.random.random() < 0.2:
                self.relation(builder, links, loop)
            elif self.random.random() < 0.8:
                arguments = (self.index(0, 17), first, second, *ends, self.number(), loop)
                self.attempt(builder.add_closing_joint, *arguments)
            else:
                body, rod = self.index(0, links), self.index(-1, links)
                line = self.numbers(3)
                arguments = (body, rod, first, second, *ends, self.number(), line, self.sign())
                self.attempt(builder.add_hung_links, *arguments, loop)
        return closings

    def function(self, builder: Any) -> None:
        count = self.random.randint(0, 1)
        curves = [(self.index(0, 1), self.random.random() < 0.5, 2)] * count
        knots = self.knots(2 * count)
        size = self.random.randint(0, 4)
        operations = [self.index(0, 27) for _ in range(size)]
        operands = [(self.index(0, 4), self.index(0, 4), self.index(0, 4)) for _ in range(size)]
        ends = [*sorted(self.random.randint(0, size) for _ in range(3)), size]
        outputs = [self.index(0, 4) for _ in range(4)]
        parts = curves, knots, self.numbers(2), operations, operands, ends, outputs
        self.attempt(builder.add_function, self.index(1, 2), *parts, [1, 2, 3, 4])

    def relation(self, builder: Any, links: int, loop: list[tuple[int, float]]) -> None:
        functions = self.random.randint(0, 2)
        for _ in range(functions):
            self.function(builder)
        terms = [
            (
                self.index(0, links),
                self.sign(),
                self.index(-1, 2),
                self.index(0, 2),
                self.index(-1, functions),
            )
            for _ in range(links)
        ]
        factors, arguments = ([self.number() for _ in terms] for _ in range(2))
        is_length = self.random.random() < 0.5
        self.attempt(builder.add_relation, is_length, terms, factors, arguments, self.number())
        if self.random.random() < 0.5:
            vectors = self.numbers(3), self.numbers(3), self.numbers(3)
            self.attempt(builder.add_mesh, self.index(-1, links), *vectors, loop)
        if self.random.random() < 0.5:
            self.attempt(builder.add_force, self.numbers(3), self.numbers(3), self.numbers(3))

    def places(self, builder: Any, links: int, closings: int) -> tuple[int, int]:
        count = self.random.randint(0, 3)
        for _ in range(count):
            joints = [self.index(-1, links) for _ in range(3)]
            reference = self.index(-closings, links)
            self.attempt(builder.add_place, reference, *joints, self.numbers(3), self.sign())
        axes = self.random.randint(0, 3)
        for _ in range(axes):
            slide, link, other = self.index(0, 2), self.index(-1, links), self.index(-1, links)
            vectors = self.numbers(3), self.numbers(3)
            place = self.index(0, count)
            slide = bool(slide) if isinstance(slide, int) else slide
            self.attempt(builder.add_axis, place, slide, link, vectors[0], other, vectors[1])
        return count, axes

    def blocks(self, builder: Any, links: int, closings: int) -> None:
        columns = list(range(builder.columns))
        self.random.shuffle(columns)
        driven = columns[: self.random.randint(0, len(columns))]
        unknown = [c for c in columns if c not in driven]
        joints: Any = list(range(links))
        if closings:
            count = closings if not self.bad() else self.index(0, 3)
            if self.bad():
                unknown = [self.index(0, builder.columns) for _ in unknown]
            self.attempt(builder.add_block, count, joints, unknown)
            if self.bad():
                self.attempt(builder.set_rest, [self.index(0, links)])
        else:
            driven = columns
            self.attempt(builder.set_rest, self.numbers(3) if self.bad() else joints)
        for column in driven:
            self.attempt(builder.add_input, self.index(0, 9) if self.bad() else column, -1, 1.0)

    def inputs_and_loads(
        self, builder: Any, links: int, closings: int, places: int, axes: int
    ) -> None:
        if self.random.random() < 0.2:
            self.attempt(builder.add_input, self.index(0, 4), self.index(-1, axes), self.number())
        for _number in range(self.random.randint(0, 2)):
            inertia = self.number(), self.numbers(3), self.numbers(6)
            self.attempt(builder.set_inertia, self.index(0, links), *inertia)
        self.attempt(builder.set_gravity, self.numbers(3))
        values = 0
        for _number in range(self.random.randint(0, 4)):
            code = self.index(0, 9)
            along = isinstance(code, int) and code in (4, 7, 8)
            link = self.index(0, axes) if along else self.index(-1, links)
            other = self.index(-closings, links)
            freedom = self.index(0, 3) if along else self.index(0, 1)
            vectors = [self.numbers(3) for _ in range(3)]
            varying = self.random.random() < 0.2
            before = self.counts["add_load done"]
            self.attempt(builder.add_load, code, link, other, freedom, *vectors, varying)
            if varying and self.counts["add_load done"] > before:
                values += 1 if along else 3
        self.frictions(builder, links, places)
        self.program(builder, links, closings, values)
        self.attempt(builder.add_size_point, self.index(-1, links), self.numbers(3))

    def frictions(self, builder: Any, links: int, places: int) -> None:
        for _number in range(self.random.choice([0, 0, 1, 2])):
            motions = self.index(-1, 3), self.index(-1, 3), self.index(-1, links)
            constants = [self.number() for _ in range(5)]
            falls = self.random.random() < 0.5
            self.attempt(
                builder.add_friction,
                self.index(0, places),
                *motions,
                falls,
                self.numbers(3),
                *constants,
                self.index(0, 6) if self.random.random() < 0.1 else -1,
            )
        for _number in range(self.random.choice([0, 1, 3])):
            numbers = [self.number() for _ in range(4)]
            self.attempt(builder.add_contact, self.index(0, 3), *numbers, self.numbers(3))

    def program(self, builder: Any, links: int, closings: int, values: int) -> None:
        """The values of varying loads: random instructions over random reads and curves."""
        if not values and self.random.random() < 0.8:
            return
        reads, registers = [], 0
        for _number in range(self.random.randint(1, 4)):
            kind = self.index(0, 3)
            code = self.random.choice([0, 0, 1, 3, 4, 5, 6, 7, 20, 21, self.index(0, 23)])
            code = 0 if str(kind) == "1" and not self.bad() else code
            order = self.index(0, 2) if str(code) in ("3", "5") else 0
            reads.append((kind, code, self.index(0, links), 0, order))
            wide = str(kind) == "0" and str(code) in ("4", "5", "6", "7")
            registers += 3 if wide else 2 if str(kind) == "1" else 1
        curves, knots = [], []
        for _number in range(self.random.randint(0, 2)):
            count = self.random.randint(0, 4)
            knots += self.knots(count)
            curves.append((self.index(0, registers), self.number(), 9.0, count))
        constants = [self.number() for _ in range(self.random.randint(0, 3))]
        registers += len(curves) + len(constants)
        operations, operands = [], []
        for _number in range(self.random.randint(0, 12)):
            operations.append(self.index(0, 25))
            operands.append(tuple(self.index(0, registers) for _ in range(3)))
            registers += 1
        outputs = [self.index(0, registers) for _ in range(values)]
        kinks = [k for k, code in enumerate(operations) if str(code) in ("5", "7", "8", "14")]
        numbers = [self.number() for _ in range(4 * len(reads))]
        record = (reads, numbers, curves, knots, constants, operations, operands, outputs, kinks)
        self.attempt(builder.set_load_program, *record)

    def outputs(self, plan: Any) -> Any:
        records = []
        for _ in range(self.random.randint(0, 6)):
            code = self.index(0, 19)
            order = (
                self.index(0, 4) if isinstance(code, int) and code in (3, 5) else self.index(0, 1)
            )
            number = 0 if self.random.random() < 0.5 else self.index(-1, 4)
            record = (code, number, self.index(0, 1), order, self.numbers(3), self.number())
            if self.attempt(_kernel.Outputs, plan, [record]) is not None:
                records.append(record)
        return self.attempt(_kernel.Outputs, plan, records)

    def array(self, columns: int, rows: int) -> Any:
        if self.bad():
            shapes = [(columns, rows + 1), (columns + 1, rows), (rows,), (), (columns, rows, 1)]
            wrong = [np.zeros(self.random.choice(shapes)), np.zeros((columns, rows), np.float32)]
            wrong += [np.zeros((rows, columns)).T, *WRONG]
            return self.random.choice(wrong)
        array = np.array(
            [[self.random.uniform(-1, 1) for _ in range(rows)] for _ in range(columns)]
        )
        array = array.reshape(columns, rows)
        if array.size and self.random.random() < 0.1:
            array.flat[0] = self.random.choice(NUMBERS)
        return array

    def per_row(self, rows: int, kind: Any = np.float64) -> Any:
        if self.bad():
            wrong = [np.zeros(rows + 1, kind), np.zeros((1, rows), kind), np.zeros(rows, np.int16)]
            return self.random.choice([*wrong, *WRONG])
        return np.zeros(rows, kind)

    def run(self, plan: Any, outputs: Any) -> None:
        rows = self.random.choice([0, 1, 2, 7, 8, 9, 65, 130])
        demand = self.random.choice([0, 1, 3, 35, 7, 15, 31, 63, 8])
        if outputs is not None:
            demand |= int(outputs.demand)
        named: dict[str, Any] = {
            name: self.array(plan.inputs, rows)
            for name in ("inputs", "rates", "accelerations", "jerks")
        }
        named |= {name: self.array(plan.states, rows) for name in ("guess", "states")}
        if demand & 4:
            named["loads"] = self.random.choice([None, self.array(plan.load_values, rows)])
            named["undefined"] = self.random.choice([None, self.per_row(rows, np.uint8)])
        named["full"] = self.random.choice([None, self.array(plan.inputs, rows)])
        named["time"] = self.random.choice([None, self.per_row(rows)])
        named["turned"] = self.random.choice([None, self.array(turn_count(plan), rows)])
        named["whole"] = self.random.choice([None, self.array(plan.inputs, rows)])
        named["outputs"] = outputs
        named["values"] = None if outputs is None else self.array(outputs.slots, rows)
        named["first"] = self.array(plan.columns, rows) if demand & 1 else None
        named["second"] = self.array(plan.columns, rows) if demand & 2 else None
        for name in ("residual", "correction"):
            named[name] = self.per_row(rows)
        named["condition"] = self.per_row(rows) if demand & 8 else None
        named["power_error"] = self.per_row(rows) if demand & 16 else None
        named["flags"] = self.per_row(rows, np.uint8)
        named["demand"] = self.index(0, 64) if self.bad() else demand
        named["shift"] = self.index(0, 3)
        named["iterations"] = self.index(0, 9)
        named["tests"] = (1e-12, 1e-8, 1e-10) if not self.bad() else self.random.choice(WRONG)
        named["lanes"] = self.random.choice([0, 2]) if not self.bad() else self.index(0, 9)
        named["threads"] = self.index(1, 4)
        if self.bad():
            named[self.random.choice(["no_such", "guess"])] = named["states"]
        if self.bad():
            del named[self.random.choice(list(named))]
        self.attempt(plan.run, **named)
        self.search(plan, named, rows)

    def search(self, plan: Any, named: dict[str, Any], rows: int) -> None:
        block = self.index(0, plan.blocks)
        chosen = {name: named.get(name) for name in ("inputs", "states", "residual", "flags")}
        tests = (1e-12,) if not self.bad() else self.random.choice(WRONG)
        self.attempt(plan.search, block=block, **chosen, iterations=self.index(0, 9), tests=tests)
        self.balance(plan, named, rows)
        self.follow(plan)

    def balance(self, plan: Any, named: dict[str, Any], rows: int) -> None:
        """Places at which loads balance."""
        count = self.random.randint(0, 3)
        free = [(self.index(0, 3), self.index(0, 6), self.number()) for _ in range(count)]
        chosen = {
            name: named.get(name)
            for name in ("inputs", "states", "outputs", "lanes", "threads", "iterations")
        }
        chosen["free"] = self.random.choice(WRONG) if self.bad() else free
        chosen["cyclic"] = [self.index(0, 3)]
        chosen["stiffness"] = self.array(count * count, rows)
        chosen["turned"] = self.array(turn_count(plan), rows)
        chosen["time"] = self.per_row(rows)
        chosen["constraint_rates"] = self.array(plan.input_constraints, rows)
        chosen["given"], chosen["known"] = self.index(0, 2), self.index(0, 2)
        chosen["limits"] = (1e-4, 0.5, 1e-9, 1e-11) if not self.bad() else self.random.choice(WRONG)
        chosen["steps"] = self.index(1, 5)
        tests = (1e-12, 1e-8, 1e-10) if not self.bad() else self.random.choice(WRONG)
        self.attempt(plan.balance, **chosen, tests=tests)

    def follow(self, plan: Any) -> None:
        """Rows on a path, and single steps."""
        count = self.random.randint(0, 5)
        path = self.array(plan.inputs, count)
        guess, limit = self.array(plan.states, count), self.per_row(count)
        start = [self.number() for _ in range(plan.states + self.bad())]
        limits = step_limits()
        every_row = self.random.choice([True, False])
        whole = self.random.choice([None, np.zeros((plan.inputs, count))])
        arguments = [plan, path, whole, start, [], every_row, limits, guess, limit, None]
        if self.bad():
            arguments[self.random.randrange(len(arguments))] = self.random.choice(WRONG)
        self.attempt(_kernel.follow_rows, *arguments)
        inputs = [self.number() for _ in range(plan.inputs + self.bad())]
        stepper = self.attempt(_kernel.Stepper.straight, plan, inputs, inputs, limits)
        if stepper is not None:
            node = self.attempt(stepper.close, self.number(), start)
            if node is not None:
                self.attempt(stepper.step, node, self.number())
                self.attempt(stepper.judge, node, node)

    def constants(self, plan: Any) -> Any:
        values = plan.constants
        if self.bad():
            values = np.append(values, 1.0)
        if self.bad():
            values[self.random.randrange(values.size)] = self.random.choice(NUMBERS)
        if self.bad():
            self.attempt(plan.with_constants, self.random.choice(WRONG))
        if self.bad():
            self.attempt(plan.with_size, self.number())
        arrays = {"inputs": self.array(plan.inputs, 1), "guess": self.array(plan.states, 1)}
        self.attempt(plan.assembly_size, **arrays, iterations=3, tests=(1e-12, 1e-8, 1e-10))
        return self.attempt(plan.with_constants, values) or plan

    def trial(self) -> Counter[str]:
        """A builder, its plan and its runs; the builder is used again after it is spent."""
        builder = self.builder()
        plan = self.attempt(builder.finish)
        if plan is None:
            self.counts["plans refused"] += 1
            return self.counts
        self.counts["plans"] += 1
        adding = threading.Thread(target=self.add_more, args=(builder,))
        adding.start()
        for one in (plan, self.constants(plan)):
            self.run(one, self.outputs(plan))
        adding.join()
        if self.counts["spent"] != 20:
            raise AssertionError("a spent builder took a record")
        return self.counts

    def add_more(self, builder: Any) -> None:
        """A spent builder refuses all, also while its plan runs."""
        for _ in range(5):
            for call, arguments in (
                (builder.add_tree_joint, (0, -1, 0.0, [0.0] * 12)),
                (builder.set_gravity, ([0.0, 0.0, 1.0],)),
                (builder.add_size_point, (-1, [0.0] * 3)),
                (builder.finish, ()),
            ):
                try:
                    call(*arguments)
                except ValueError:
                    self.counts["spent"] += 1


def main(seed: int, count: int) -> None:
    """Prints how often each outcome came."""
    counts: Counter[str] = Counter()
    for number in range(seed, seed + count):
        print(number, file=sys.stderr, flush=True)
        counts += Hostile(number).trial()
    print(dict(counts))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
