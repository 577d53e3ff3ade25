"""Misuse of motions in time: `python -m kernel.hostile_motions SEED COUNT`.

As `hostile`: every call must end with a result or with a documented refusal. Motions of sound
plans, of random ones with a chart and of random tapes; laws of drives; objects of other trials come
back as arguments; threads change the arrays of calls that run.
"""

from __future__ import annotations

import sys
import threading
from collections import Counter
from functools import cache
from typing import Any

import numpy as np
from kernel.hostile import INDICES, NUMBERS, WRONG
from kernel.hostile_runs import KEPT, HostileRuns

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel
from mechkin_cli.response.runs import prepare
from mechkin_cli.session.cells import SWITCHES
from mechkin_cli.session.kernel_run import RESIDUAL_TESTS

PENDULUM = """format: 1
name: pendulum
units: {angle: rad}
links:
  arm: {mass: 1, center_of_mass: [1, 0, 0]}
  bob: {mass: 1, center_of_mass: [2, 0, 0]}
joints:
  A: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 1, 0]}
  B: {type: R, links: [arm, bob], point: [1, 0, 0], axis: [0, 1, 0]}
loads: [{type: gravity, g: [0, 0, -9.81]}]
responses:
  free: {start: {A.theta: 0, B.theta: 0.5}, time: {from: 0, to: 0.5, step: 0.1}}
  driven:
    start: {B.theta: 0.5}
    driven: {A.theta: {law: cycloidal, from: 0, to: 0.2}}
    time: {from: 0, to: 0.5, step: 0.1}
  stopped:
    start: {A.theta: 0, B.theta: 0.5}
    stop: [{value: A.theta, at: 0.4}, {dead_centre: B.theta}]
    time: {from: 0, to: 0.5, step: 0.1}
"""
STEPS = 60
"""Attempts of a call that is well."""


class Free:
    """A motion that runs: its session's plan, how it begins, its drives and its stops."""

    def __init__(self, name: str) -> None:
        from mechkin_cli.response.integration import watched_stop

        problem = mk.loads(PENDULUM).problem
        response = problem.responses[name]
        found = prepare(problem, response)
        assert found.begun is not None
        self.plan, self.begun, self.driven = found.free.plan, found.begun, found.driven
        self.stops = [tuple(watched_stop(stop)) for stop in response.stops]


@cache
def free(name: str) -> Free:
    return Free(name)


class HostileMotions(HostileRuns):
    """The same draws, of other calls."""

    def small(self) -> Any:
        return self.random.choice([0, 1, -1, 2, 3, 8, 60, 2**31 - 1, 2**62, -(2**62)])

    # --- charts ---------------------------------------------------------------------------------

    def moving(self) -> tuple[Any, Any, Any, Any]:
        """A plan with a chart, arrays of one start (state, first, tangent), drives, stops."""
        if self.random.random() < 0.6:
            one = free(self.random.choice(["free", "driven", "stopped"]))
            start = [a.reshape(1, -1).copy() for a in one.begun]
            return one.plan, start, one.driven, one.stops
        builder = None
        while builder is None:
            builder = self.attempt(_kernel.PlanBuilder, 1.0, (0.0, 0.0, 0.0), 1.0)
        links = self.tree(builder)
        columns = list(range(builder.columns))
        charts = self.either(self.random.randint(0, len(columns)), *INDICES)
        driven = columns[: len(columns) - charts] if str(charts).isdigit() else []
        unknown = [c for c in columns if c not in driven]
        joints = self.either(list(range(links)), [], [0, 0])
        self.attempt(builder.add_block, self.either(0, 1), joints, unknown, charts)
        for column in driven:
            self.attempt(builder.add_input, column, -1, 1.0)
        for link in range(links):
            tensor = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
            mass = self.either(1.0, 0.0, *NUMBERS)
            self.attempt(builder.set_inertia, link, mass, self.numbers(3), tensor)
        self.attempt(builder.set_gravity, self.numbers(3))
        plan = self.attempt(builder.finish)
        if plan is None:
            return self.moving()
        charts = charts if isinstance(charts, int) and 0 <= charts <= plan.columns else 1
        tangent = np.eye(max(charts, 1), plan.columns).ravel()[: charts * plan.columns]
        start = [self.noise.uniform(-1.0, 1.0, (1, k)) for k in (plan.states, plan.columns)]
        held = self.attempt(_kernel.DrivenLaws, None, [], [], [], [], 1.0, [0.1] * plan.inputs)
        return plan, [*start, tangent.reshape(1, -1)], held if plan.inputs else None, []

    def several(self, plan: Any, count: int) -> Any:
        """Plans of one structure, as a rule."""
        constants = plan.constants
        plans = [plan.with_constants(constants * (1.0 + 1e-3 * k)) for k in range(count)]
        plans = [self.kept("chart plan", one) for one in plans]
        return self.either(plans, [], [None], plans[:-1], [plan, _kernel.PlanBuilder], plan)

    def moments(self) -> Any:
        count = self.random.choice([0, 1, 2, 5, 40])
        times = np.linspace(0.0, self.random.choice([1e-9, 0.1, 1.0]), count)
        broken = times.copy()
        if count:
            broken[self.random.randrange(count)] = self.random.choice(NUMBERS)
        wrong = [times[::-1].copy(), times[::-1], np.zeros(3), times.reshape(1, -1), broken]
        return self.either(times, *wrong, times.astype(np.float32))

    def stopping(self, stops: Any) -> Any:
        if not self.bad():
            return stops
        one = (self.small() % 7, self.index(-2, 3), self.index(-3, 9), self.number())
        one = (*one, self.index(-99, 99), self.index(-3, 99))
        return self.random.choice([[], [*stops, one], [one] * len(stops), [(0, 0)], None])

    def settings(self) -> dict[str, Any]:
        """Of both integrations."""
        return {
            "tolerance": self.either(1e-6, 1e-300, 1e300, 0.0, *NUMBERS),
            "fixed_step": self.either(self.random.choice([0.0, 0.0, 0.05]), 1e-300, *NUMBERS),
            "most_steps": self.either(STEPS, 0, -1, -(2**62), 10**6 + 1, 2**62),
            "dense_rows": self.either(self.random.choice([3, 10]), self.small()),
            "method": self.either(self.random.randrange(3), *INDICES),
        }

    def responses(self) -> None:
        plan, start, driven, stops = self.moving()
        count = self.random.choice([1, 1, 2, 5, 9])
        state, first, tangent = (np.repeat(a, count, 0) for a in start)
        if self.random.random() < 0.2:
            tangent = tangent * self.random.choice([0.0, 1e300, -1.0])
        plans, times = self.several(plan, count), self.moments()
        named = self.settings() | {
            "plans": plans,
            "state": self.either(self.around(state, 0.0), state[:0], state.T, state[:, :-1]),
            "first": self.either(self.around(first, 0.1), first[:-1], first.astype(np.float32)),
            "tangent": self.either(self.around(tangent, 0.0), tangent[:, :-1], tangent.ravel()),
            "begin": self.either(0.0, -1.0, 1.0, *NUMBERS),
            "times": times,
            "stops": self.stopping(stops),
            "driven": self.kept("laws", driven) if self.bad() else driven,
            "tests": self.either(list(RESIDUAL_TESTS), [0.0] * 3, [1.0] * 2, [float("nan")] * 3),
            "iterations": self.either(8, 0, 10001, *INDICES),
            "jump": self.either(0.5, *NUMBERS),
            "radius": self.either(0.5, *NUMBERS),
            "straight": self.either(self.random.random() < 0.5),
            "lanes": self.either(self.random.choice([0, 2]), *INDICES),
            "threads": self.either(self.random.choice([1, 2]), *INDICES),
        }
        if self.bad():
            del named[self.random.choice(list(named))]

        def call() -> None:
            found = self.attempt(_kernel.respond, **named)
            if found is not None:
                self.counts["rows responded"] += sum(told["rows"] for told in found[0])

        def take_away() -> None:
            # the list and its plans may go while the call runs
            if isinstance(plans, list):
                plans.clear()

        thread = threading.Thread(target=take_away)
        if self.random.random() < 0.1:
            del plan
            thread.start()
        self.at_once(call, self.random.choice([times, state, tangent]))
        if thread.ident:
            thread.join()

    # --- laws of drives ---------------------------------------------------------------------------

    def laws(self) -> None:
        inputs, outputs = self.random.randint(1, 3), self.random.randint(0, 3)
        tape = self.tape(inputs, outputs)
        switches = sum(int(code) in SWITCHES for code in self.codes.get(id(tape), ()))
        edges = sorted(self.noise.uniform(0.0, 1.0, self.random.randint(0, 3)).tolist())
        cells = len(edges) + 1
        constants = self.noise.normal(size=cells * (inputs - 1)).tolist()
        ways = self.noise.choice([-1.0, 1.0, 0.0, 7.0], cells * switches).tolist()
        units = [1.0] * outputs
        made = self.attempt(
            _kernel.DrivenLaws,
            self.either(self.kept("tape", tape), None),
            self.either(edges, edges[::-1], [float("nan")], [0.0, 0.0], [[1.0]]),
            self.either(constants, constants[:-1], [*constants, 1.0], np.zeros((2, 2))),
            self.either(ways, ways[:-1], [*ways, 1.0]),
            self.either(units, [0.0] * outputs, [*units, 1.0], []),
            self.either(1.0, *NUMBERS),
            self.either([0.5] * self.random.randint(0, 2), [float("inf")], ["a"]),
        )
        del tape
        if made is None:
            return
        KEPT.setdefault("laws", []).append(made)
        del KEPT["laws"][:-20]
        for _ in range(3):
            self.attempt(made.at, self.either(0.5, *NUMBERS))
        if self.bad():
            self.attempt(made.__init__, None, [], [], [], [], 1.0, [])

    # --- tapes of motions -------------------------------------------------------------------------

    def tapes(self) -> None:
        """Any tape as the rates of a motion, with any switches and charts."""
        freedoms, sums = self.random.randint(0, 2), self.random.randint(0, 1)
        lanes, parameters = self.random.choice([1, 2, 5]), self.random.randint(0, 1)
        kinds = [tuple(self.random.random() < 0.5 for _ in range(3)) for _ in range(2)]
        kinds = kinds[: self.random.randint(0, 2)]
        size = 2 * freedoms + sums
        tape = self.tape(1 + size + len(kinds) + parameters, freedoms + sums + len(kinds) + 1)
        state, more = self.noise.normal(size=(size, lanes)), np.ones((parameters, lanes))
        settings = self.settings()
        arguments = [
            self.either(self.kept("tape", tape)),
            self.either(freedoms, *INDICES),
            self.either(sums, *INDICES),
            self.either(kinds, kinds[:-1], [(1, 2)]),
            self.either(np.zeros(lanes), np.ones(lanes), np.full(lanes, np.nan), np.zeros(0)),
            self.either(state, state[:-1], state[:, :-1], state.T, state * 1e300),
            self.either(more, more[:, :-1], np.ones((parameters + 1, lanes))),
            self.moments(),
            self.either([1.0], [], [0.0], [1.0, 0.3], [float("nan")]),
            self.either(1.0, *NUMBERS),
            self.either(1e3, *NUMBERS),
            settings["tolerance"],
            settings["fixed_step"],
            self.either(1e-13, *NUMBERS),
            *(settings[name] for name in ("most_steps", "dense_rows", "method")),
        ]
        if self.bad():
            del arguments[self.random.randrange(len(arguments))]
        self.at_once(lambda: self.attempt(_kernel.integrate_tape, *arguments), state)

    def trial(self) -> Counter[str]:
        """A few calls of every kind."""
        for call in (self.responses, self.responses, self.laws, self.tapes):
            call()
        return self.counts


def unfinished() -> None:
    """Laws that were never made refuse to work."""
    hostile = HostileMotions(0)
    empty = _kernel.DrivenLaws.__new__(_kernel.DrivenLaws)
    assert hostile.attempt(lambda: empty.at(0.0)) is None
    KEPT["laws"] = [empty, *WRONG]


def main(seed: int, count: int) -> None:
    """Prints how often each outcome came."""
    counts: Counter[str] = Counter()
    unfinished()
    for number in range(seed, seed + count):
        print(number, file=sys.stderr, flush=True)
        counts += HostileMotions(number).trial()
    print(dict(counts))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
