"""The stepper's verbs: closing, prediction by order, judgement block by block, changing plans."""

from __future__ import annotations

import numpy as np
import pytest
from prepared import Setup, prepared
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.kernel._kernel import Node, Stepper
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.session.following import step_limits


def setup_of(name: str) -> Setup:
    return prepared(mk.load(FILE_OF[name]).problem)


def straight(name: str) -> tuple[Stepper, Node]:
    setup = setup_of(name)
    inputs = setup.inputs.values[:, setup.start.row]
    stepper = Stepper.straight(
        build_plan(setup.layout), inputs.tolist(), [1.0] * inputs.size, step_limits()
    )
    node = stepper.close(0.0, setup.start.state.tolist())
    assert node is not None
    return stepper, node


@pytest.mark.parametrize("name", ["rcsr", "sevenr", "rcsr_csr", "rsgc"])
def test_predictions_are_of_third_order(name: str) -> None:
    stepper, node = straight(name)
    errors = []
    for h in (2e-2, 1e-2, 5e-3):
        closed = stepper.close(h, stepper.predict(node, h).tolist())
        assert closed is not None
        errors.append(np.max(np.abs(closed.state - stepper.predict(node, h))))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(3.0, abs=0.4)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(3.0, abs=0.3)


@pytest.mark.parametrize("name", ["rcsr", "sevenr", "rcsr_csr"])
def test_a_step_is_prediction_closing_and_judgement(name: str) -> None:
    stepper, node = straight(name)
    h = 0.5 * stepper.wanted_step(node)
    stepped = stepper.step(node, h)
    closed = stepper.close(node.sigma + h, stepper.predict(node, h).tolist())
    assert stepped is not None
    assert closed is not None
    assert stepper.judge(node, closed)
    assert stepped.state.tobytes() == closed.state.tobytes()
    assert stepper.judge(closed, node)


def test_a_place_on_another_branch_is_refused() -> None:
    stepper, node = straight("rcsr")
    found = 0
    for guess in node.state + np.random.default_rng(2).uniform(-2.0, 2.0, (60, node.state.size)):
        other = stepper.close(0.01, guess.tolist())
        if other is not None and np.max(np.abs(other.state - node.state)) > 0.2:
            found += 1
            assert not stepper.judge(node, other)
    assert found


def test_sides_stand_block_by_block() -> None:
    """The sign of each block's determinant and its Jacobian, against LAPACK."""
    _, node = straight("rcsr_csr")
    assert node.side.size == node.pivot.size == 2
    jacobians = node.jacobian.reshape(2, 3, 3)
    assert np.array_equal(node.side, np.sign(np.linalg.det(jacobians)))
    assert np.all(node.pivot > 0.0)


def test_two_blocks_that_turn_over_together_are_another_branch() -> None:
    """Both loops of two equal four-bars on the other side: the product of the signs is the same."""
    text = four_bars(2)
    problem = mk.loads(text).problem
    setup = prepared(problem)
    inputs = setup.inputs.values[:, 0]
    stepper = Stepper.straight(build_plan(setup.layout), inputs.tolist(), [1.0, 1.0], step_limits())
    node = stepper.close(0.0, setup.start.state.tolist())
    assert node is not None
    rng = np.random.default_rng(3)
    for _ in range(4000):
        guess = node.state + rng.uniform(-3.0, 3.0, node.state.size)
        other = stepper.close(1e-3, guess.tolist())
        if other is not None and np.array_equal(other.side, -node.side):
            assert np.prod(other.side) == np.prod(node.side)
            assert not stepper.judge(node, other)
            return
    pytest.fail("no pair of turned loops found")


def four_bars(count: int) -> str:
    """Equal plane four-bars side by side, each with its own input."""
    lines = ["format: 1", "name: four-bars", "units: {length: m, angle: deg}", "links:"]
    for k in range(count):
        lines += [f"  a{k}: {{}}", f"  b{k}: {{}}", f"  c{k}: {{}}"]
    lines.append("joints:")
    for k in range(count):
        z = 0.1 * k
        places = {"A": (0, 0), "B": (0, 1), "C": (2, 1.5), "D": (2, 0)}
        ends = {
            "A": ("ground", f"a{k}", "R"),
            "B": (f"a{k}", f"b{k}", "R"),
            "C": (f"b{k}", f"c{k}", "S"),
            "D": ("ground", f"c{k}", "R"),
        }
        for joint, (one, other, kind) in ends.items():
            x, y = places[joint]
            axis = ", axis: [0, 0, 1]" if kind == "R" else ""
            if joint == "B":
                kind, axis = "C", ", axis: [0, 0, 1]"
            links = f"links: [{one}, {other}], point: [{x}, {y}, {z}]"
            lines.append(f"  {joint}{k}: {{type: {kind}, {links}{axis}}}")
    lines += ["motion:", "  inputs:"]
    lines += [f"    A{k}.theta: {{from: 0, to: 10, step: 1}}" for k in range(count)]
    return "\n".join(lines) + "\n"


def test_a_path_of_changing_dimensions() -> None:
    """RCSR from its own P1 to another one: every place is an assembly of its own mechanism, and
    halving the step leaves an eighth of the prediction's error."""
    base = mk.load(FILE_OF["rcsr"])
    setup = prepared(base.problem)
    length = setup.layout.length

    def plan(sigma: float):
        m = mk.load(FILE_OF["rcsr"], {"P1": f"{0.5 + 0.2 * sigma!r} in"})
        layout = Layout(m.problem.mechanism, m.graph)
        assert layout.length == length
        return build_plan(layout)

    inputs = setup.inputs.values[:, 0].tolist()
    zeros = [0.0] * len(inputs)
    stepper = Stepper.along(plan, lambda _: (inputs, zeros, zeros), True, step_limits())
    node = stepper.close(0.0, setup.start.state.tolist())
    assert node is not None
    errors = []
    for h in (0.4, 0.2, 0.1):
        closed = stepper.close(h, stepper.predict(node, h).tolist())
        assert closed is not None
        errors.append(np.max(np.abs(closed.state - stepper.predict(node, h))))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(3.0, abs=0.5)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(3.0, abs=0.5)
    sigma = 0.0
    while sigma < 1.0:
        h = min(stepper.wanted_step(node), 1.0 - sigma)
        following = stepper.step(node, h)
        assert following is not None
        node, sigma = following, following.sigma
    other = mk.load(FILE_OF["rcsr"], {"P1": "0.7 in"})
    first = other.analyze(["O4.theta"])["O4.theta"][0]
    layout = setup.layout
    k = next(k for k, e in enumerate(layout.graph.edges) if e.joint.name == "O4")
    assert np.degrees(node.state[layout.state(k, 0)]) == pytest.approx(first, abs=1e-9)


def test_bad_use_is_refused() -> None:
    stepper, node = straight("rcsr")
    with pytest.raises(ValueError, match="guess"):
        stepper.close(0.0, [0.0])
    other, _ = straight("sevenr")
    with pytest.raises(ValueError, match="another plan"):
        other.predict(node, 0.1)
    with pytest.raises(ValueError, match="direction"):
        Stepper.straight(build_plan(setup_of("rcsr").layout), [0.0], [], step_limits())
    assert stepper.close(0.0, [np.nan] * node.state.size) is None
