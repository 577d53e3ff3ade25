"""Derivatives written out as expressions, against mpmath's at 40 digits."""

from __future__ import annotations

import os
import random

import numpy as np
import pytest
from expressions.random_expressions import NAMES, number, value, written
from mpmath import mp

from mechkin_cli.expressions.differentiation import STEPS, TERMS, WHOLE, differentiated
from mechkin_cli.expressions.expression import Definitions, parse
from mechkin_cli.expressions.functions import FUNCTIONS
from mechkin_cli.expressions.grammar import parse_nodes
from mechkin_cli.expressions.quantity import (
    MAX_EXPANDED,
    ExpressionError,
    Name,
    Node,
    Quantity,
    lookup,
)

COUNT = 40 * int(os.environ.get("MECHKIN_RANDOM", "5"))
ROWS = {name: Quantity(np.array(rows)) for name, rows in NAMES.items()}
STEP = mp.mpf("1e-12")
PER_ANGLE = parse_nodes("1/(1 rad)")


def rate(name: Name) -> tuple[Node, ...] | None:
    """x moves alone, as an angle in rad does."""
    return PER_ANGLE if name.text == "x" else None


def by_x(nodes: tuple[Node, ...], by: Name, offset: int) -> tuple[Node, ...]:
    return differentiated(nodes, rate, "rad", offset, lookup(ROWS))


DEFINITIONS = Definitions({}, by_x)


def difference(text: str, row: int) -> mp.mpf | None:
    """The slope between places 1e-12 apart at 60 digits; None where it is another on either side,
    or has no value."""
    at = NAMES["x"][row]
    found = []
    for shift in (-2, -1, 0, 1, 2):
        NAMES["x"] = (*NAMES["x"][:row], at + shift * STEP, *NAMES["x"][row + 1 :])
        found.append(value(text, row))
        NAMES["x"] = (*NAMES["x"][:row], at, *NAMES["x"][row + 1 :])
    if any(one is None for one in found):
        return None
    a, b, c, d, e = found
    slopes = [(d - b) / (2 * STEP), (c - a) / (2 * STEP), (e - c) / (2 * STEP)]
    if max(abs(slope - slopes[0]) for slope in slopes[1:]) > mp.mpf("1e-6"):
        return None
    return slopes[0]


def test_random_expressions() -> None:
    draw, followed = random.Random(7), 0
    with mp.workdps(60):
        for _ in range(COUNT):
            text = number(draw, draw.randint(1, 4))
            expected = [difference(text, row) for row in range(3)]
            if "x" not in text or any(one is None for one in expected):
                continue
            whole = f"derivative({written(text)}, x)"
            try:
                found = DEFINITIONS.parse(whole).evaluate(lookup(ROWS))
            except ExpressionError:
                continue  # a constant that no row needs has no value
            rows = np.broadcast_to(found.value, (3,))
            followed += 1
            for row, one in zip(rows, expected, strict=True):
                assert abs(row - float(one)) < 1e-9 * (1.0 + abs(float(one))), text
    assert followed > COUNT // 8


# a condition that is not known or a chosen way alone tells nothing of the others
CHOICES = {
    "clip": (3, lambda x, least, most: min(max(x, least), most)),
    "min": (2, min),
    "max": (2, max),
}


@pytest.mark.parametrize("name", CHOICES)
def test_a_choice_has_the_derivative_of_what_is_chosen(name: str) -> None:
    """Bounds that move, in any order: the least above the most, too."""
    count, choose = CHOICES[name]
    draw = random.Random(name)
    moving = [(lambda x: 2 * x, "2*x"), (lambda x: 1 - x * x, "(1 - x*x)"), (lambda x: x, "x")]
    for _ in range(COUNT):
        bounds = [draw.choice([-2.5, -0.5, 0.25, 1.5]) for _ in range(3)]
        constant = [(lambda x, at=at: mp.mpf(at), f"({at})") for at in bounds]
        parts = [draw.choice([*moving, *constant]) for _ in range(count)]
        text = f"{name}({', '.join(written for _, written in parts)})"
        found = DEFINITIONS.parse(f"derivative({text}, x)").evaluate(lookup(ROWS)).value
        for row, at in enumerate(NAMES["x"]):
            with mp.workdps(40):
                values = [part(mp.mpf(at)) for part, _ in parts]
                if len(set(values)) < count:
                    continue
                chosen = parts[values.index(choose(*values))][0]
                slope = mp.diff(chosen, mp.mpf(at))
            assert abs(np.broadcast_to(found, (3,))[row] - float(slope)) < 1e-12, text


@pytest.mark.parametrize(
    ("text", "there"),
    [
        ("log(x)", [True, False, True]),
        ("atanh(x)", [True, False, False]),
        ("acosh(x)", [False, False, True]),
        ("x + sqrt(y)", [True, True, False]),
        ("x*log(n)", [True, True, False]),
        ("2*x + floor(1/(n - 1))", [True, False, True]),
        ("[x, sqrt(y), 1].x", [True, True, True]),
        ("if(x > 0, log(x), x)", [True, True, True]),
        ("mod(x, y - 0.25)", [True, False, True]),
        ("atan(1/(n - 1))*x/(1 rad)", [True, False, True]),
    ],
)
def test_there_is_none_where_the_expression_has_no_value(text: str, there: list[bool]) -> None:
    value = np.broadcast_to(parse(text).evaluate(lookup(ROWS)).value, (3,))
    assert np.isfinite(value).tolist() == there
    found = DEFINITIONS.parse(f"derivative({text}, x)").evaluate(lookup(ROWS)).value
    assert np.isfinite(np.broadcast_to(found, (3,))).tolist() == there


@pytest.mark.parametrize("text", ["x + log(-1)", "x*sqrt(0 - 4)", "clip(x, 1/0, 2)"])
def test_a_constant_without_a_value_is_refused_in_a_derivative_too(text: str) -> None:
    for whole in (text, f"derivative({text}, x)"):
        with pytest.raises(ExpressionError, match=r"check the values of the parameters|negative"):
            DEFINITIONS.parse(whole).evaluate(lookup(ROWS))


def test_every_operation_has_a_rule() -> None:
    operations = {"+", "-", "*", "/", "^", "negate", "[]", ".x", ".y", ".z"}
    truths = {"<", "<=", ">", ">=", "==", "!=", "and", "or", "not"}
    assert set(TERMS) | set(WHOLE) | STEPS == operations | truths | set(FUNCTIONS)


def test_what_grows_too_large_is_refused() -> None:
    definitions = Definitions()
    definitions = definitions.adding("q0", parse("x"))
    for k in range(8):
        tripled = definitions.parse(f"q{k} + q{k}*q{k}")
        definitions = definitions.adding(f"q{k + 1}", tripled)
    with pytest.raises(ExpressionError, match=f"more than {MAX_EXPANDED} parts"):
        definitions.parse("q8 + q8*q8")
    product = "*".join(["(x + 1)"] * 240)
    with pytest.raises(ExpressionError, match=f"more than {MAX_EXPANDED} parts"):
        DEFINITIONS.parse(f"derivative({product}, x)")
