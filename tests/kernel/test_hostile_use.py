"""Misuse ends with a documented exception, in whatever order and number it comes; `hostile` is the
generator."""

from __future__ import annotations

import ast
import gc
import re
import subprocess
import sys
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kernel import hostile
from kernel.hostile_motions import free
from kernel.hostile_runs import USUAL
from references import RCSR

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.plan.records import Demand, LoadCode, Output, OutputCode, hand_over_outputs
from mechkin_cli.session.following import step_limits

TRIALS = 2000
RUNS = 400
FRAME = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
ZERO = (0.0, 0.0, 0.0)


def test_thousands_of_bad_calls_end_with_refusals() -> None:
    """In a process of its own, since a crash would take this one along."""
    command = [sys.executable, hostile.__file__, "0", str(TRIALS)]
    found = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert found.returncode == 0, found.stderr[-2000:]
    counts = ast.literal_eval(found.stdout)
    assert counts["plans"] > TRIALS / 4
    assert counts["plans refused"] > TRIALS / 4
    assert counts["ValueError"] > TRIALS
    assert counts["TypeError"] > TRIALS


def test_tapes_variants_positions_paths_and_texts_refuse_bad_calls() -> None:
    """So do they; and not all calls are refused."""
    found = of_its_own("kernel.hostile_runs", RUNS)
    assert found.returncode == 0, found.stderr[-2000:]
    counts = ast.literal_eval(found.stdout)
    for refusal in ("ValueError", "TypeError"):
        assert counts[refusal] > 5 * RUNS
    for done in ("variants complete", "positions found", "rows followed", "judge done"):
        assert counts[done] > RUNS / 2
    for made in (
        "Tape",
        "Variants",
        "Positions",
        "straight",
        "along",
        "csv_lines",
        "json_lines",
        "markdown_text",
    ):
        assert counts[f"{made} done"] > RUNS / 10


def test_motions_in_time_refuse_bad_calls() -> None:
    """So do they; and most of those that are well are taken."""
    found = of_its_own("kernel.hostile_motions", RUNS)
    assert found.returncode == 0, found.stderr[-2000:]
    counts = ast.literal_eval(found.stdout)
    for refusal in ("ValueError", "TypeError"):
        assert counts[refusal] > RUNS
    assert counts["rows responded"] > 5 * RUNS
    for made in ("respond", "DrivenLaws", "at", "integrate_tape"):
        assert counts[f"{made} done"] > RUNS / 5


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"plans": []}, "plans: none"),
        ({"plans": ["all"]}, "plans: not a Plan"),
        ({"plans": [None]}, "plans: not a Plan"),
        ({"state": np.zeros((1, 5))}, "state: not of the shape"),
        ({"state": np.full((1, 2), np.nan)}, "state: not finite"),
        ({"times": np.array([0.0, 0.5, 0.4])}, "the times of rows rise"),
        ({"begin": 0.1}, "the times of rows rise"),
        ({"tolerance": float("nan")}, "positive numbers"),
        ({"tolerance": 0.0}, "positive numbers"),
        ({"most_steps": 2**40}, "1 to 1000000 steps"),
        ({"method": 3}, "method: unknown"),
        ({"iterations": 10001}, "0 to 10000"),
        ({"jump": float("nan")}, "from 0 on"),
        ({"stops": [(0, 0, 1, 0.5, 0, 0)]}, "one for each watched value"),
        (
            {"driven": _kernel.DrivenLaws(None, [], [], [], [], 1.0, [0.0])},
            "one law for each input",
        ),
    ],
)
def test_a_response_says_which_argument_is_wrong(change: dict[str, Any], message: str) -> None:
    motion = free("free")
    state, first, tangent = (a.reshape(1, -1) for a in motion.begun)
    good = {
        "plans": [motion.plan],
        "state": state,
        "first": first,
        "tangent": tangent,
        "begin": 0.0,
        "times": np.array([0.0, 0.1]),
        "stops": [],
        "driven": None,
        "tolerance": 1e-6,
        "fixed_step": 0.0,
        "most_steps": 60,
        "dense_rows": 3,
        "method": 0,
        "tests": [1e-16, 1e-8, 1e-14],
        "iterations": 8,
        "jump": 0.5,
        "radius": 0.5,
        "straight": False,
        "lanes": 2,
        "threads": 1,
    }
    assert _kernel.respond(**good)[0][0]["rows"] == 2
    with pytest.raises((ValueError, TypeError), match=message):
        _kernel.respond(**(good | change))


def of_its_own(module: str, count: int) -> subprocess.CompletedProcess[str]:
    """A generator in a process of its own, since a crash would take this one along."""
    command = [sys.executable, "-W", "ignore", "-m", module, "0", str(count)]
    tests = Path(hostile.__file__).parent.parent
    return subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=tests)


def one_turn() -> Any:
    builder = _kernel.PlanBuilder(1.0, ZERO, 1.0)
    builder.add_tree_joint(_kernel.TreeCode.R, -1, 0.0, FRAME)
    builder.add_place(0, -1, 0, 0, ZERO, 1.0)
    builder.add_axis(0, False, 0, (0.0, 0.0, 1.0), 0, ZERO)
    builder.set_rest([0])
    builder.add_input(0, 0, 1.0)
    return builder


def arguments(plan: Any, rows: int = 3) -> dict[str, Any]:
    return {
        "inputs": np.zeros((plan.inputs, rows)),
        "guess": np.zeros((plan.states, rows)),
        "states": np.zeros((plan.states, rows)),
        "residual": np.zeros(rows),
        "correction": np.zeros(rows),
        "flags": np.zeros(rows, np.uint8),
        "tests": (1e-12, 1e-8, 1e-10),
        "iterations": 5,
    }


def test_a_spent_builder_takes_nothing() -> None:
    builder = one_turn()
    builder.finish()
    with pytest.raises(ValueError, match="spent"):
        builder.add_place(0, -1, 0, 0, ZERO, 1.0)
    with pytest.raises(ValueError, match="spent"):
        builder.finish()


def test_a_builder_that_cannot_finish_may_be_mended() -> None:
    builder = _kernel.PlanBuilder(1.0, ZERO, 1.0)
    for parent in (-1, 0):
        builder.add_tree_joint(_kernel.TreeCode.R, parent, 0.0, FRAME)
    builder.add_input(0, -1, 1.0)
    with pytest.raises(ValueError, match="every column must be an input or an unknown"):
        builder.finish()
    builder.add_input(1, -1, 1.0)
    with pytest.raises(ValueError, match="every tree joint must be placed"):
        builder.finish()
    builder.set_rest([0, 1])
    assert builder.finish().inputs == 2


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf")])
def test_numbers_of_a_plan_are_finite(bad: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        one_turn().set_gravity((0.0, bad, 0.0))
    plan = one_turn().finish()
    constants = plan.constants
    constants[-1] = bad
    with pytest.raises(ValueError, match="finite"):
        plan.with_constants(constants)
    with pytest.raises(ValueError, match="size"):
        plan.with_size(bad)
    with pytest.raises(ValueError, match="finite"):
        hand_over_outputs(plan, [Output(OutputCode.POINT, 0, 0, 0, ZERO, bad)])


def test_a_sphere_has_no_coordinate_to_read_or_to_load() -> None:
    model = mk.load(RCSR)
    layout = Layout(model.problem.mechanism, model.graph)
    spheres = [c for c, k in enumerate(layout.graph.closings) if k.joint.letter == "S"]
    assert spheres
    with pytest.raises(ValueError, match="has no coordinate 0"):
        hand_over_outputs(
            build_plan(layout), [Output(OutputCode.CLOSING, spheres[0], 0, 0, ZERO, 1.0)]
        )
    builder = _kernel.PlanBuilder(1.0, ZERO, 1.0)
    builder.add_tree_joint(_kernel.TreeCode.S, -1, 0.0, FRAME)
    builder.add_place(0, -1, 0, 0, ZERO, 1.0)
    builder.add_axis(0, False, 0, (0.0, 0.0, 1.0), 0, ZERO)
    with pytest.raises(ValueError, match="unknown coordinate"):
        builder.add_load(LoadCode.COORDINATE_SPRING, 0, 0, 0, ZERO, ZERO, ZERO)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"shift": 3}, "shift: 3 is not from 0 to 2"),
        ({"demand": 128}, "demand: 128 is not from 0 to 127"),
        ({"demand": 1}, "velocities need rates"),
        ({"iterations": -1}, "iterations: -1"),
        ({"lanes": 3}, "lanes: this width"),
        ({"threads": 0}, "threads: 0"),
        ({"tests": (1.0, float("nan"), 1.0)}, "tests: a limit is a number from 0 on"),
        ({"guess": np.zeros((1, 4))}, "guess: 4 rows instead of 3"),
        ({"guess": np.zeros((2, 3))}, "guess: 2 columns instead of 1"),
        ({"guess": np.zeros(3)}, "guess: 1 dimensions instead of 2"),
        ({"condition": np.zeros(3)}, "condition goes with its demand"),
        ({"first": np.zeros((1, 3))}, "first derivatives are not demanded"),
        ({"values": np.zeros((1, 3))}, "values: 1 columns instead of 0"),
    ],
)
def test_a_run_says_which_argument_is_wrong(change: dict[str, Any], message: str) -> None:
    plan = one_turn().finish()
    with pytest.raises(ValueError, match=re.escape(message)):
        plan.run(**(arguments(plan) | change))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"states": np.zeros((1, 3), np.float32)}, "states: not a writable C-contiguous array"),
        ({"states": np.zeros((3, 2)).T[:1]}, "states: not a writable C-contiguous array"),
        ({"inputs": [[0.0, 0.0, 0.0]]}, "inputs: not a C-contiguous array"),
        ({"guess": None}, "guess: missing"),
        ({"flags": np.zeros(3)}, "flags: not a writable array of uint8"),
        ({"outputs": "all"}, "outputs: not Outputs of a plan"),
        ({"shift": "one"}, "shift: not a whole number"),
        ({"gess": np.zeros((1, 3))}, "gess: no such argument"),
    ],
)
def test_a_run_says_which_argument_is_of_the_wrong_type(
    change: dict[str, Any], message: str
) -> None:
    plan = one_turn().finish()
    with pytest.raises(TypeError, match=re.escape(message)):
        plan.run(**(arguments(plan) | change))


def test_written_arrays_share_no_memory() -> None:
    plan = one_turn().finish()
    given = arguments(plan)
    with pytest.raises(ValueError, match="shares memory with"):
        plan.run(**(given | {"states": given["guess"]}))
    both = np.zeros(4)
    with pytest.raises(ValueError, match="shares memory with"):
        plan.run(**(given | {"residual": both[:3], "correction": both[1:]}))


def test_read_only_arrays_are_read_and_not_written() -> None:
    plan = one_turn().finish()
    given = arguments(plan)
    given["guess"].setflags(write=False)
    plan.run(**given)
    given["states"].setflags(write=False)
    with pytest.raises(TypeError, match="states: not a writable"):
        plan.run(**given)


def test_outputs_fit_plans_of_their_structure_only() -> None:
    plan, other = one_turn().finish(), one_turn().finish()
    outputs = hand_over_outputs(plan, [Output(OutputCode.STATE, 0, 0, 0, ZERO, 2.0)])
    given = arguments(plan) | {"outputs": outputs, "values": np.zeros((1, 3))}
    given["inputs"][:] = 0.25
    plan.with_size(3.0).run(**given)
    assert given["values"].tolist() == [[0.5, 0.5, 0.5]]
    with pytest.raises(ValueError, match="another structure"):
        other.run(**given)


def test_what_an_output_demands_must_be_demanded() -> None:
    plan = one_turn().finish()
    outputs = hand_over_outputs(plan, [Output(OutputCode.ALPHA, 0, 0, 0, ZERO, 1.0)])
    assert outputs.demand == Demand.VELOCITY | Demand.ACCELERATION
    with pytest.raises(ValueError, match="outputs and values are given together"):
        plan.run(**(arguments(plan) | {"outputs": outputs}))
    given = arguments(plan) | {"outputs": outputs, "values": np.zeros((3, 3))}
    with pytest.raises(ValueError, match="need more than is demanded"):
        plan.run(**given)


def test_the_generator_would_see_a_call_that_is_not_refused(tmp_path: Path) -> None:
    """A builder that takes records after finish() ends the process with an error."""
    patched = tmp_path / "patched.py"
    source = Path(hostile.__file__).read_text(encoding="utf-8")
    patched.write_text(source.replace("call(*arguments)\n", "None\n"), encoding="utf-8")
    command = [sys.executable, str(patched), "0", "50"]
    found = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert found.returncode == 1
    assert "a spent builder took a record" in found.stderr


def four_turns(closed: bool) -> tuple[Any, list[float]]:
    """Four turns about one axis in a row, or two and a pin that ties them; and inputs."""
    builder = _kernel.PlanBuilder(1.0, ZERO, 1.0)
    for parent in range(-1, 3):
        builder.add_tree_joint(_kernel.TreeCode.R, parent, 0.0, FRAME)
    builder.set_rest([0, 1, 2, 3])
    for column in range(4):
        builder.add_input(column, -1, 2.0 if closed else 1.0)
    return builder.finish(), [0.0] * 4


def test_a_stepper_refuses_the_call_of_its_own_path() -> None:
    """A path's function that steps on is told so; the stepper works again afterwards."""
    plan, inputs = four_turns(False)
    held: list[Any] = []
    again = [False]

    def at(sigma: float) -> Any:
        if again[0]:
            held[0].close(sigma, inputs)
        return [sigma] * 4, [1.0] * 4, [0.0] * 4

    held.append(_kernel.Stepper.along(plan, at, False, step_limits()))
    again[0] = True
    with pytest.raises(ValueError, match="the stepper is in a call"):
        held[0].close(0.5, inputs)
    again[0] = False
    assert held[0].close(0.5, inputs).state.tolist() == [0.5] * 4


def test_a_path_that_holds_its_stepper_is_collected() -> None:
    plan, _ = four_turns(False)

    class Held:
        stepper: Any = None

        def at(self, sigma: float) -> Any:
            return [sigma] * 4, [1.0] * 4, [0.0] * 4

    held = Held()
    held.stepper = _kernel.Stepper.along(plan, held.at, False, step_limits())
    gone = weakref.ref(held)
    del held
    gc.collect()
    assert gone() is None


@pytest.mark.parametrize(
    ("plan", "at", "varies", "message"),
    [
        (lambda _: None, lambda _: ([], [], []), True, "not a Plan"),
        ("plan", lambda _: ([], [], []), False, "not a Plan"),
        ("plan", lambda _: ([], [], []), True, "not a function"),
        (lambda _: None, "at", True, "not a function"),
    ],
)
def test_a_path_is_made_of_functions(plan: Any, at: Any, varies: bool, message: str) -> None:
    with pytest.raises(TypeError, match=message):
        _kernel.Stepper.along(plan, at, varies, step_limits())


def test_a_path_gives_three_lists() -> None:
    plan, inputs = four_turns(False)
    stepper = _kernel.Stepper.along(plan, lambda _: (inputs, inputs), False, step_limits())
    with pytest.raises(TypeError, match="three lists"):
        stepper.close(0.0, inputs)


def test_the_plans_of_a_path_have_one_structure() -> None:
    """As many states, columns and closings as before are not enough."""
    plan, inputs = four_turns(False)
    builder = _kernel.PlanBuilder(1.0, ZERO, 1.0)
    for parent in range(-1, 3):
        code = _kernel.TreeCode.P if parent == 2 else _kernel.TreeCode.R
        builder.add_tree_joint(code, parent, 0.0, FRAME)
    builder.set_rest([0, 1, 2, 3])
    for column in range(4):
        builder.add_input(column, -1, 1.0)
    other = builder.finish()
    plans = [plan]
    path = _kernel.Stepper.along(
        lambda _: plans[0], lambda _: (inputs, inputs, inputs), True, step_limits()
    )
    assert path.close(0.0, inputs) is not None
    plans[0] = four_turns(True)[0]
    assert path.close(0.0, inputs) is not None
    plans[0] = other
    with pytest.raises(ValueError, match="one structure"):
        path.close(0.0, inputs)


def test_rows_that_are_followed_share_no_memory() -> None:
    plan, start = four_turns(False)
    inputs, guess, limit = np.zeros((4, 3)), np.zeros((4, 3)), np.zeros(3)
    arguments = plan, inputs, None, start, [], False, step_limits()
    _kernel.follow_rows(*arguments, guess, limit, None)
    for both in ((inputs, limit), (guess, guess[0]), (guess, inputs[1])):
        with pytest.raises(ValueError, match="share no memory"):
            _kernel.follow_rows(*arguments, *both, None)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"turn_cosine": 1.5}, "from -1 to 1"),
        ({"jump": float("nan")}, "from 0 on"),
        ({"least_step": -1e-15}, "from 0 on"),
        ({"most_steps": 2**31 - 1}, "1000000 steps"),
        ({"iterations": -1}, "10000 iterations"),
    ],
)
def test_the_limits_of_a_step_are_numbers(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        _kernel.StepLimits(**(USUAL | change))


def test_rows_without_columns_are_counted() -> None:
    """A plan without inputs has tables of any length that take no memory."""
    builder = _kernel.PlanBuilder(1.0, ZERO, 1.0)
    plan = builder.finish()
    outputs = hand_over_outputs(plan, [])
    nothing = np.zeros((0, 2**59))
    names = ("inputs", "whole", "rates", "accelerations", "jerks", "states", "turns")
    with pytest.raises(ValueError, match="rows: more than"):
        _kernel.Positions(
            plan=plan,
            outputs=outputs,
            demand=0,
            iterations=5,
            limits=step_limits(),
            angles=[],
            **dict.fromkeys(names, nothing),
        )
