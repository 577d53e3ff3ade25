"""Inputs that follow others: values and rates against Taylor series, and what is refused."""

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.tables.csv import csv_bytes

FILE = """\
format: 1
units: {length: in, angle: deg}
parameters: {a: 2 in, k: 3, tau: 0.5 s}
links: {one: {}, two: {}, three: {}, four: {}, five: {}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: P, links: [one, two], point: [0, 0, 0], axis: [1, 0, 0]}
  C: {type: R, links: [two, three], point: [1, 0, 0], axis: [0, 1, 0]}
  D: {type: E, links: [three, four], point: [1, 0, 0], normal: [0, 1, 0], x: [1, 0, 0]}
  F: {type: R, links: [ground, five], point: [0, 0, 0], axis: [0, 0, 1]}
motion:
  inputs:
    D.x: {with: EX}
    D.y: {with: D.x/k + 1}
    C.theta: {with: CT}
    A.theta: {from: 10, to: 50, step: 20, rate: 2 rad/s, acceleration: 3, jerk: -4}
    B.s: {with: "a*sin(2*A.theta)/(1 + 0.2*cos(C.theta))"}
    D.theta: {with: 90}
    F.theta: {at: 30, rate: 5}
tables: [{name: t, columns: [A.theta, A.theta_dot, D.theta, B.s_dot, D.x]}]
"""
GOOD = (
    FILE.replace("EX", "D.theta*a/1 rad - B.s")
    .replace("CT", "A.theta + F.theta")
    .replace("+ 1}", "+ 1 in}")
)
INCH = 0.0254


def paths(a0: float) -> dict[str, object]:
    """The inputs over t as the chain of definitions says, in rad and in."""
    deg = mp.pi / 180

    def a(t: mp.mpf) -> mp.mpf:
        return a0 * deg + 2 * t + 3 * t**2 / 2 - 4 * t**3 / 6

    def c(t: mp.mpf) -> mp.mpf:
        return a(t) + 30 * deg + 5 * t

    def b(t: mp.mpf) -> mp.mpf:
        return 2 * mp.sin(2 * a(t)) / (1 + mp.cos(c(t)) / 5)

    def x(t: mp.mpf) -> mp.mpf:
        return 2 * mp.pi / 2 - b(t)

    return {"A.theta": a, "C.theta": c, "B.s": b, "D.x": x, "D.y": lambda t: x(t) / 3 + 1}


def test_inputs_follow_in_any_order_with_their_rates() -> None:
    motion = mk.loads(GOOD).problem.motion
    inputs = {item.name: item for item in motion.inputs}
    assert list(inputs)[:2] == ["D.x", "D.y"]
    for row, start in enumerate((10, 30, 50)):
        with mp.workdps(40):
            for name, path in paths(start).items():
                item, unit = inputs[name], 1 if name.endswith("theta") else INCH
                series = [c * mp.factorial(k) for k, c in enumerate(mp.taylor(path, 0, 3))]
                orders = (item.values, item.rates, item.accelerations, item.jerks)
                found = [float(order[row]) for order in orders]
                expected = [float(value) * unit for value in series]
                assert found == pytest.approx(expected, rel=1e-14, abs=1e-14), name


def test_a_number_holds_an_input_and_rates_are_printed_as_written() -> None:
    table = csv_bytes(mk.loads(GOOD.replace("rate: 2 rad/s", "rate: 0.1")).analyze().tables[0])
    lines = [line.split(",") for line in table.decode().splitlines()]
    assert [line[:3] for line in lines[1:]] == [[x, "0.1", "90"] for x in ("10", "30", "50")]


def test_an_input_may_follow_time() -> None:
    text = GOOD.replace("motion:", "motion:\n  time: {from: 0, to: 1, step: 0.5}").replace(
        "A.theta: {from: 10, to: 50, step: 20, rate: 2 rad/s, acceleration: 3, jerk: -4}",
        "A.theta: {with: 3 rad*exp(-time/tau)}",
    )
    text = text.replace("rate: 5", "at: 30").replace("{at: 30, at: 30}", "{at: 30}")
    item = next(i for i in mk.loads(text).problem.motion.inputs if i.name == "A.theta")
    expected = [3 * mp.exp(-2 * t) for t in (0, 0.5, 1)]
    for order, found in enumerate((item.values, item.rates, item.accelerations, item.jerks)):
        np.testing.assert_allclose(found, [float(x) * (-2) ** order for x in expected], rtol=1e-15)


UNDRIVEN = "  G: {type: R, links: [ground, five], point: [0, 0, 0], axis: [0, 0, 1]}\n"
BAD = [
    ("EX", "2*»D.x", "expression", "D.x follows itself", "name the inputs that it follows"),
    ("EX", "»G.theta*a/1 rad", "expression", "G.theta is not an input", "inputs are"),
    ("EX", "a*»AA.theta", "expression", "nothing named AA.theta", "did you mean A.theta"),
    ("EX", "a + »time", "expression", "nothing named time"),
    ("EX", "»A.theta", "expression", "expected a length, found an angle"),
    ("EX", "»[a, a, a]", "expression", "found a vector"),
    ("EX", "a*»", "expression", "ends where"),
    ("EX", "»7 deg", "expression", "expected a length, found an angle"),
    ("EX", "a*»A.theta_dot", "expression", "nothing named A.theta_dot"),
    (
        "EX",
        "»a/cos(3*A.theta)*0 + a*abs(A.theta - 30 deg)/1 rad",
        "undefined-rate",
        "D.x has no finite rate in row 2: A.theta = 30 deg",
        "smooth over all rows",
    ),
    (
        "EX",
        "»a*log((A.theta - 20 deg)/1 deg)",
        "undefined-value",
        "D.x has no finite value in row 1: A.theta = 10 deg",
    ),
    ("CT", "A.theta + »B.s/a*1 rad", "expression", "in a circle: B.s -> C.theta -> B.s"),
]


@pytest.mark.parametrize("bad", BAD, ids=[f"{bad[2]} {bad[1]}" for bad in BAD])
def test_bad_expressions(bad: tuple[str, ...]) -> None:
    hole, new, code, *words = bad
    marked = FILE.replace("motion:\n", f"{UNDRIVEN}motion:\n")
    marked = marked.replace(hole, f'"{new}"').replace("+ 1}", "+ 1 in}")
    marked = marked.replace("EX", "a + B.s").replace("CT", "A.theta")
    before = marked[: marked.index("»")]
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(marked.replace("»", ""), "bad.yaml")
    (error,) = caught.value.diagnostics
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    if code.startswith("undefined"):
        column -= 1  # the whole value, from its quote on
    assert str(error).startswith(f"bad.yaml:{line}:{column}: error: "), str(error)
    assert error.code == code
    assert all(word in str(error) for word in words), str(error)


def test_what_follows_a_refused_input_is_not_reported_again() -> None:
    text = GOOD.replace("step: 20", "step: 0")
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    assert [error.code for error in caught.value.diagnostics] == ["zero-step"]
    text = GOOD.replace("a*sin(2*A.theta)", "a*sin(2*AA.theta)")
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    assert [error.code for error in caught.value.diagnostics] == ["expression"]
