"""Any text is either an expression or an `ExpressionError`, in bounded time."""

from __future__ import annotations

from datetime import timedelta

from expressions.names import INCH_POUND, QUANTITIES, resolve
from hypothesis import given, settings, strategies as st

from mechkin_cli.expressions.expression import constant, parse
from mechkin_cli.expressions.quantity import MAX_TEXT_LENGTH, ExpressionError
from mechkin_cli.units.dimension import LENGTH
from mechkin_cli.units.units import CompoundUnit, UnitError, parse_unit

WORDS = [*QUANTITIES, "in", "N*m", "deg", "s", "sin", "sqrt", "det", "min", "wrap", "cross", "pi"]
SIGNS = ["+", "-", "*", "/", "^", "**", "(", ")", "[", "]", ",", ".x", ".", " ", "1", "0", "2.5e3"]

expression_like = st.lists(st.sampled_from(WORDS + SIGNS), max_size=40).map("".join)
spaced = st.lists(st.sampled_from(WORDS + SIGNS), max_size=40).map(" ".join)


def error_of(text: str) -> ExpressionError | None:
    try:
        parse(text).evaluate(resolve, INCH_POUND)
        constant(text, LENGTH, INCH_POUND, resolve)
    except ExpressionError as error:
        return error
    return None


def check(text: str) -> None:
    error = error_of(text)
    assert error is None or (error.message and 0 <= error.offset <= len(text))


@settings(max_examples=300, deadline=timedelta(seconds=1))
@given(st.one_of(st.text(max_size=60), expression_like, spaced))
def test_any_text(text: str) -> None:
    check(text)


@settings(max_examples=60, deadline=timedelta(seconds=1))
@given(st.one_of(expression_like, st.sampled_from(WORDS + SIGNS)).filter(bool))
def test_long_repetitions(text: str) -> None:
    check((text * MAX_TEXT_LENGTH)[:MAX_TEXT_LENGTH])


@settings(max_examples=200, deadline=timedelta(seconds=1))
@given(
    st.one_of(
        st.text(max_size=40),
        st.lists(st.sampled_from(["m", "N", "lbm", "*", "/", "^", "-", "1", "9", " "])).map(
            "".join
        ),
    )
)
def test_any_unit(text: str) -> None:
    unit = unit_or_error(text)
    if isinstance(unit, UnitError):
        assert 0 <= unit.offset <= len(text)
    else:
        assert parse_unit(str(unit) or "1").factor == unit.factor


def unit_or_error(text: str) -> CompoundUnit | UnitError:
    try:
        return parse_unit(text)
    except UnitError as error:
        return error
