"""Times an equilibrium of the RCSR with springs, and rows of a sweep at rest against driven ones.

    python -m benchmarks.equilibria [--rounds N]

Printed are the time of the kernel's calls for one equilibrium with its verdict and their number,
the whole time of the search, the time of windows of three freedoms in parts of that of the one
equilibrium, and the time of a row of a sweep at rest in parts of that of the same
row driven, for sweeps of one turn with several steps. Runs take turns, so that a slow moment of the
machine meets each, and the least time of the processor counts.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

from mechkin_cli import statics
from mechkin_cli.kernel import _kernel
from mechkin_cli.model.model import Model, load, loads
from mechkin_cli.response import prepare
from mechkin_cli.session import kernel_run, session as session_module

ROUNDS = 7
STEPS = (5.0, 1.0, 0.1)
"""Degrees from row to row."""

LEVER = Path("benchmarks/mechanisms/lever.yaml").read_text(encoding="utf-8")


def rcsr() -> Model:
    """The RCSR of the dissertation with gravity, a spring at its crank and one at its rocker."""
    text = Path("mechanisms/dissertation/rcsr.yaml").read_text(encoding="utf-8")
    head = text[: text.index("\nmotion:")]
    return loads(
        head
        + """
loads:
  - {type: gravity, g: [0, 0, -386 in/s^2]}
  - {type: spring, joint: O1, coordinate: theta, stiffness: 400 lbm*in^2/s^2/rad}
  - {type: spring, joint: O4, coordinate: theta, stiffness: 900 lbm*in^2/s^2/rad, free: 40 deg}
equilibria: {one: {near: {O1.theta: 170}}}
"""
    )


class _TimedPlan:
    """A plan of the kernel that adds up the time of its runs."""

    def __init__(self, plan: _kernel.Plan, kernel: KernelTime) -> None:
        self._plan, self._kernel = plan, kernel

    def __getattr__(self, name: str) -> object:
        return getattr(self._plan, name)

    def run(self, **given: object) -> None:
        """As the plan's."""
        begin = perf_counter()
        self._plan.run(**given)  # type: ignore[arg-type]
        self._kernel.seconds += perf_counter() - begin
        self._kernel.calls += 1


class KernelTime:
    """Adds up the time of the kernel's calls."""

    def __init__(self) -> None:
        self.calls, self.seconds = 0, 0.0
        self._run, self._count = kernel_run.run, kernel_run.turn_count

    def __enter__(self) -> KernelTime:
        def timed(plan: _kernel.Plan, *args: object, **named: object) -> object:
            return self._run(_TimedPlan(plan, self), *args, **named)  # type: ignore[arg-type]

        def count(plan: _kernel.Plan) -> int:
            return self._count(getattr(plan, "_plan", plan))

        setattr(session_module, "run_kernel", timed)  # noqa: B010 - not one of its own names
        kernel_run.turn_count = count
        return self

    def __exit__(self, *_: object) -> None:
        setattr(session_module, "run_kernel", self._run)  # noqa: B010 - as above
        kernel_run.turn_count = self._count


def one_equilibrium(rounds: int) -> None:
    """Of the RCSR, its start being known."""
    model = rcsr()
    design = model.design
    session, response = design.session_of("one"), design.response("one")
    prepared = prepare(design.problem, response, session=session)
    statics.balanced(prepared)
    best, whole, calls = np.inf, np.inf, 0
    for _ in range(rounds):
        with KernelTime() as kernel:
            begin = process_time()
            found = statics.balanced(prepared)
            whole = min(whole, process_time() - begin)
        best, calls = min(best, kernel.seconds), kernel.calls
    steps = found.found[0][0].steps
    print(
        f"RCSR with springs: {steps} steps, {calls} calls of the kernel, {1e6 * best:.0f} us in it,"
    )
    print(f"  {1e6 * whole:.0f} us in all")


def windows(rounds: int) -> None:
    """Of three blocks that fall without end, and of three pendulums on each other."""
    weight = {"type": "gravity", "g": [0, -9.81, 0]}
    base: dict[str, object] = {"format": 1, "units": {"angle": "rad"}, "loads": [weight]}
    links = {name: {"mass": 1, "center_of_mass": [0, -k - 0.4, 0]} for k, name in enumerate("abc")}
    slides = {
        name.upper(): {
            "type": "P",
            "links": ["ground", name],
            "point": [0, 0, 0],
            "axis": [0, 1, 0],
        }
        for name in "abc"
    }
    turns = {
        joint: {"type": "R", "links": list(pair), "point": [0, -k, 0], "axis": [0, 0, 1]}
        for k, (joint, pair) in enumerate(
            zip("ABC", (("ground", "a"), ("a", "b"), ("b", "c")), strict=True)
        )
    }
    model = rcsr()
    cases = [
        ("three falling blocks", slides, "s", 1.0),
        ("a chain of three", turns, "theta", np.pi),
    ]
    for words, joints, coordinate, half in cases:
        chain = load({**base, "links": links, "joints": joints})
        window = {f"{joint}.{coordinate}": (-half, half) for joint in joints}
        best, one = np.inf, np.inf
        for _ in range(rounds):
            begin = process_time()
            found = chain.equilibrium(window=window)
            middle = process_time()
            model.equilibrium("one")
            best, one = min(best, middle - begin), min(one, process_time() - middle)
        number = int(np.count_nonzero(found.result.solved))
        print(f"{words}: {number} equilibria, {best:.2f} s, {best / one:.0f} times the one above")


def rows_at_rest(rounds: int, step: float) -> None:
    """Of the lever with a bob that hangs from it."""
    count = round(360 / step) + 1
    swept = f"A.theta: {{from: 0, to: 360, count: {count}}}"
    resting = LEVER + f"motion: {{inputs: {{{swept}}}, rest: [E.theta]}}\n"
    values = [float(value) for value in loads(resting).analyze()["E.theta"]]
    driven = LEVER + f"motion: {{inputs: {{{swept}, E.theta: {{values: {values}}}}}}}\n"
    best = {resting: np.inf, driven: np.inf}
    for _ in range(rounds):
        for text in best:
            model = loads(text)
            _ = model.session
            begin = process_time()
            model.analyze(["A.effort"], tables=[])
            best[text] = min(best[text], process_time() - begin)
    ratio = best[resting] / best[driven]
    each = 1e6 * best[resting] / count
    print(f"{count} rows, {step:g} deg apart: {each:.1f} us a row at rest, {ratio:.1f} driven ones")


def main() -> None:
    """Prints the figures."""
    parser = argparse.ArgumentParser(description="equilibria and rows at rest")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    rounds = parser.parse_args().rounds
    one_equilibrium(rounds)
    windows(min(rounds, 2))
    for step in STEPS:
        rows_at_rest(rounds, step)


if __name__ == "__main__":
    main()
