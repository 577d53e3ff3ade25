"""A motion with an error is told of alone: what the file asks of the motion is not judged."""

from __future__ import annotations

import pytest

import mechkin_cli as mk

# Whatever can refer to the motion: efforts, rates, time, derivatives, coefficients, balances.
FILE = """\
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
parameters: {r: 40 mm, n: 1}
links:
  crank: {mass: 0.4, center_of_mass: [r/2, 0, 0], inertia: {xx: 80, yy: 20, zz: 90}}
  arm: {mass: 0.2, center_of_mass: [r, 10, 0], inertia: {xx: 80, yy: 20, zz: 90}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: R, links: [crank, arm], point: [r, 0, 0], axis: [0, 1, 1]}
points:
  tip: {link: arm, at: [2*r, 0, 0]}
quantities:
  gain: derivative(tip.position.x, O.theta)
  power: O.effort*O.theta_dot + A.effort*A.theta_dot
  twice: 2*gain
loads:
  - {type: gravity, g: standard}
  - {type: torque, joint: O, value: "-0.1 N*m*s/rad*O.theta_dot"LOADS}
motion: MOTION
actuators: [O.theta, A.theta]
assembly: {near: {A.theta: 0}}
coefficients: [{name: dense, row: 2}]
balances:
  - {name: work, type: work, cycle: O.theta}
  - {name: harmonics, type: harmonics, of: [O.effort], orders: [0, 1]}
tables:
  - name: t
    summary: [peak]
    columns:
      - O.theta
      - gain
      - power
      - twice
      - derivative(tip.position.y, A.theta)
      - O.theta.reduced_inertia
      - O.theta.effort.per.A.theta_ddot
      - norm(O.force)
      - tip.position.z
      - row.work
      - time
"""
GOOD = (
    "{inputs: {O.theta: {from: 0, to: 360, count: 13, rate: 1 rad/s}, A.theta: {with: 2*O.theta}}}"
)
TIMED = (
    "{time: {from: 0, to: 6, count: 13}, inputs: {O.theta: {law: constant-rate, at: 0, rate: 60 "
    "deg/s}, A.theta: {with: 2*O.theta}}}"
)
BAD = (
    "{inputs: {O.theta: {from: 0, to: 9, count: 5}, A.theta: {from: 0, to: 9, count: 4}}}",
    "{inputs: {O.theta: {from: 0, to: 9, count: 5}, A.theta: {from: 0 mm, to: 9, count: 5}}}",
    "{inputs: {O.theta: {from: 0, to: 9, count: 5}, A.theta: {with: 2*O.s}}}",
    "{inputs: {O.theta: {from: 0, to: 9, count: 5}, A.thet: {from: 0, to: 9, count: 5}}}",
    "{inputs: {O.theta: {from: 0, to: 9, count: 5}, B.theta: {at: 0}}}",
    "{inputs: {O.theta: {values: [0, m]}, A.theta: {at: 0}}}",
    "{inputs: {O.theta: {from: 0, to: 9, step: 0}, A.theta: {at: 0}}}",
    "{inputs: {O.theta: {with: A.theta}, A.theta: {with: O.theta}}}",
    "{inputs: {O.theta: {from: 0, to: 1e9, step: 1e-9}, A.theta: {at: 0}}}",
    "{inputs: {O.theta: {at: 0, rate: 3 N}, A.theta: {at: 0}}}",
    "{inputs: {tip.position.x: {from: 0, to: 9, count: 5}, A.theta: {from: 0, to: 9, count: 3}}}",
    "{inputs: {O.theta: {law: constant-rate, at: 0, rate: 60 deg/s}, A.theta: {at: 0}}}",
    "{time: {from: 0, to: 0, count: 5}, inputs: {O.theta: {at: 0}, A.theta: {at: 0}}}",
    "{time: {from: 0, to: m, count: 5}, inputs: {O.theta: {at: 0}, A.theta: {at: 0}}}",
    TIMED.replace("60 deg/s", "60 mm"),
)


def file(motion: str, loads: str = "") -> str:
    return FILE.replace("MOTION", motion).replace("LOADS", loads)


def places(text: str) -> list[int]:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    return [d.place.line for d in caught.value.diagnostics if d.severity == "error" and d.place]


def test_the_file_itself_is_good() -> None:
    assert mk.loads(file(TIMED)).analyze(tables=["t"]).complete


@pytest.mark.parametrize("motion", BAD)
def test_no_error_follows_from_that_of_the_motion(motion: str) -> None:
    text = file(motion)
    line = 1 + text.splitlines().index(f"motion: {motion}")
    assert set(places(text)) == {line}


@pytest.mark.parametrize("motion", [each for each in BAD if "law" not in each or "time" in each])
def test_other_errors_are_told_beside_it(motion: str) -> None:
    text = file(motion).replace("point: [r, 0, 0]", "point: [rr, 0, 0]")
    line = 1 + text.splitlines().index(f"motion: {motion}")
    assert set(places(text)) == {line, 9}


BODY = "{start: {O.theta: 5, A.theta: 3}, time: {from: 0, to: 1, count: 3}, efforts: {O.theta: 3}}"
OF_FALL = """\
tables:
  - name: of_fall
    run: fall
    columns: [time, O.effort, O.theta_ddot, norm(A.force), row.work, row.event]
"""
BAD_BODIES = (
    BODY.replace("count: 3", "count: m"),
    BODY.replace("A.theta: 3", "A.thet: 3"),
    BODY.replace("efforts: {O.theta: 3}", "efforts: {O.theta: 3 mm}"),
    BODY.replace("efforts: {O.theta: 3}", "efforts: {O.thet: 3}"),
    BODY.replace("from: 0", "from: 2 mm"),
    BODY.replace("efforts", "driven: {A.theta: {law: constant-rate, at: 0, rate: 1 mm}}, efforts"),
)


def with_response(body: str) -> str:
    """The file with a response and its table in place of the balances and tables of the sweep."""
    head = file(GOOD).partition("coefficients:")[0]
    own = ("quantities:", "  gain", "  power", "  twice")
    lines = [line for line in head.splitlines() if not line.startswith(own)]
    return "\n".join([*lines, f"responses:\n  fall: {body}", OF_FALL])


def test_the_response_itself_is_good() -> None:
    assert mk.loads(with_response(BODY)).respond("fall").complete


@pytest.mark.parametrize("body", BAD_BODIES)
def test_no_error_follows_from_that_of_a_response(body: str) -> None:
    text = with_response(body)
    line = 1 + text.splitlines().index(f"  fall: {body}")
    assert set(places(text)) == {line}
