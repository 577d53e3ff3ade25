"""The unit behind a number literal: `0.5 in`, `10 N*m`, `3 lbm*in/s^2`.

Units stand only here. The word right after a number is a unit, with or without a space between.
`*` or `/` and another unit word continue the unit only when no space surrounds the sign, so
`2 N * m` is two newtons times a parameter m. `^` and a whole number right behind a unit word is its
exponent.
"""

from __future__ import annotations

from mechkin_cli.expressions.errors import ExpressionError
from mechkin_cli.expressions.limits import MAX_QUOTED
from mechkin_cli.expressions.tokens import Token
from mechkin_cli.units import UNITS, CompoundUnit, UnitError
from mechkin_cli.units.compound import bounded_exponent, compound, named_unit

_POWERS = ("^", "**")


class UnitReader:
    """Reads the unit whose first word is `tokens[position]`; `position` ends behind the unit."""

    def __init__(self, tokens: list[Token], position: int) -> None:
        self.tokens = tokens
        self.position = position
        self.number = tokens[position - 1].text[:MAX_QUOTED]
        self.terms: list[tuple[str, int]] = []
        self.joined: list[tuple[str, int]] = []

    def read(self) -> CompoundUnit:
        """The unit.

        Raises:
            ExpressionError: the word is no unit, or an exponent is not a whole number.
        """
        first = self.tokens[self.position]
        try:
            self._term(1)
            while self._continues():
                sign = -1 if self.tokens[self.position].text == "/" else 1
                self.position += 1
                word = self.tokens[self.position]
                self.joined.append((word.text, word.start))
                self._term(sign)
            self._end()
            return compound(self.terms)
        except UnitError as error:
            hint = error.hint or f"a product is written {self.number}*{first.text[:MAX_QUOTED]}"
            raise ExpressionError(error.message, max(error.offset, first.start), hint) from None

    def _term(self, sign: int) -> None:
        word = self.tokens[self.position]
        unit = named_unit(word.text, word.start)
        self.position += 1
        self.terms.append((unit.symbol, sign * self._exponent(word)))

    def _exponent(self, word: Token) -> int:
        caret = self.tokens[self.position]
        if caret.text not in _POWERS:
            return 1
        last = self.position + 1
        sign = 1
        if self.tokens[last].text == "-":
            sign, last = -1, last + 1
        number = self.tokens[last]
        together = number.end - word.end == sum(
            token.end - token.start for token in self.tokens[self.position : last + 1]
        )
        if not (together and number.kind == "number" and number.text.isdigit()):
            raise _ambiguous(caret)
        self.position = last + 1
        return sign * bounded_exponent(number.text, number.start)

    def _end(self) -> None:
        caret = self.tokens[self.position]
        if caret.text in _POWERS:
            raise _ambiguous(caret)

    def _continues(self) -> bool:
        before, sign = self.tokens[self.position - 1], self.tokens[self.position]
        if sign.text not in ("*", "/"):
            return False
        word = self.tokens[self.position + 1]
        if word.text not in UNITS or not before.end == sign.start == word.start - 1:
            return False
        return self.tokens[self.position + 2].text != "("


def _ambiguous(caret: Token) -> ExpressionError:
    return ExpressionError(
        "ambiguous power behind a unit",
        caret.start,
        "write the exponent of a unit as a whole number without spaces, 5 in^2, "
        "or the power of a value in parentheses, (5 in)^2",
    )
