"""Derivatives written out as expressions, against mpmath's at 40 digits."""

from __future__ import annotations

import os
import random

import numpy as np
import pytest
from expressions.random_expressions import NAMES, number, value, written
from mpmath import mp

from mechkin_cli.expressions import FUNCTIONS, ExpressionError, Quantity, lookup, parse
from mechkin_cli.expressions.definitions import Definitions
from mechkin_cli.expressions.differentiation import STEPS, TERMS, WHOLE, differentiated
from mechkin_cli.expressions.limits import MAX_EXPANDED
from mechkin_cli.expressions.nodes import Name, Node, Number

COUNT = 40 * int(os.environ.get("MECHKIN_RANDOM", "5"))
ROWS = {name: Quantity(np.array(rows)) for name, rows in NAMES.items()}
STEP = mp.mpf("1e-12")


def rate(name: Name) -> tuple[Node, ...] | None:
    """x moves alone."""
    return (Number(1.0, None, "1", name.offset),) if name.text == "x" else None


def by_x(nodes: tuple[Node, ...], by: Name, offset: int) -> tuple[Node, ...]:
    return differentiated(nodes, rate, "rad", offset)


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
