"""Constants of a plan: numbered as its records are flattened, exchanged without a new plan."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
import pytest
from references import RCSR, SWEPT

import mechkin_cli as mk
from mechkin_cli.assembly.home import Probe
from mechkin_cli.assembly.start import choose_start
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.outputs import OutputPlan, Readout
from mechkin_cli.plan.plan import build_plan, plan_records
from mechkin_cli.plan.records import Demand, flatten, hand_over
from mechkin_cli.session.kernel_run import Ask, Batch, RowInputs, assembly_size, run

EVERYTHING = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES | Demand.CONDITION | Demand.POWER
FILES = SWEPT


def layout_of(path: Any, parameters: dict[str, str] | None = None) -> Layout:
    model = mk.load(path, parameters or {})
    return Layout(model.problem.mechanism, model.graph, laws=model.problem.laws)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_plan_numbers_its_constants_as_its_records_are_flattened(path: Any) -> None:
    records = plan_records(layout_of(path), 3.25)
    plan = hand_over(records)
    assert plan.constants.tolist() == [float(number) for number in flatten(records)]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_each_number_lands_on_its_own_constant(path: Any) -> None:
    """Numbers that are all different, so that no two can have been exchanged."""
    plan = build_plan(layout_of(path))
    numbers = 1.0 + np.arange(plan.constants.size)
    other = plan.with_constants(numbers)
    assert other.constants.tolist() == numbers.tolist()
    assert other.with_constants(plan.constants).constants.tolist() == plan.constants.tolist()


def case(parameters: dict[str, str]) -> tuple[Any, OutputPlan]:
    model = mk.load(RCSR, parameters)
    layout = Layout(model.problem.mechanism, model.graph)
    own = OutputPlan(layout, build_plan(layout), model.problem.motion.driven)
    for wanted in model.problem.quantities().values():
        own.add(wanted)
    return model, own


def computed(plan: Any, outputs: Any, rows: int = 9) -> Batch:
    inputs = np.linspace(2.7, 2.8, rows)[None, :]
    guess = np.zeros((plan.states, rows))
    ones = np.ones_like(inputs)
    return run(
        plan,
        RowInputs(inputs, guess, ones, 0.5 * ones, ones),
        Ask(EVERYTHING | Demand.JERK, Readout(outputs, {}, ()), derivatives=True),
    )


def assert_same(found: Batch, expected: Batch) -> None:
    for name, array in expected._asdict().items():
        if isinstance(array, np.ndarray):
            assert getattr(found, name).tobytes() == array.tobytes(), name


def test_a_plan_with_other_constants_is_the_plan_built_with_them() -> None:
    """Parameters change lengths, frames, unit and size; the bytes are those of a new plan."""
    _, base = case({})
    _, changed = case({"P1": "0.83 in", "alpha1": "17 deg"})
    plan = base.plan.with_constants(changed.plan.constants)
    outputs = base.outputs.with_constants(changed.outputs.constants)
    assert not np.array_equal(base.plan.constants, changed.plan.constants)
    assert_same(computed(plan, outputs), computed(changed.plan, changed.outputs))
    untouched = case({})[1]
    assert_same(computed(base.plan, base.outputs), computed(untouched.plan, untouched.outputs))


def test_a_size_given_later_is_the_size_built_with() -> None:
    layout = layout_of(RCSR)
    later, before = build_plan(layout).with_size(0.7), build_plan(layout, 0.7)
    assert later.size == 0.7
    assert later.constants.tolist() == before.constants.tolist()
    own = OutputPlan(layout, later, [])
    assert_same(
        computed(later, own.outputs), computed(before, OutputPlan(layout, before, []).outputs)
    )


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_size_is_that_of_the_box_of_the_joint_points(path: Any) -> None:
    """Against the points that the first row's assembly has, one by one."""
    model = mk.load(path)
    problem = model.problem
    if not problem.motion.inputs or problem.follow is not None:
        pytest.skip("drives nothing, or follows a part")
    session = model.session
    plan, inputs = session.plan, session.inputs.values
    start = choose_start(session)
    if start.state is None:
        pytest.skip("has no assembly")
    first = inputs[:, start.row]
    _, moving = Probe(session).read(first, start.state[:, None])
    points = [at.vector for _, at in problem.mechanism.joint_points() if at.link == "ground"]
    every = [*moving[:, :, 0].tolist(), *points]
    extent = [max(p[i] for p in every) - min(p[i] for p in every) for i in range(3)]
    x, y, z = extent
    assert assembly_size(plan, first, start.state) == (sqrt(x * x + y * y + z * z) or 1.0)
