"""The functions of expressions: one table of what each takes and gives.

A function is added by one entry of `FUNCTIONS`.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import reduce
from math import inf, nextafter
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.expressions import (
    operations as conditions,
    operations as hyperbolic,
    operations as scalar_functions,
    operations as steps,
)
from mechkin_cli.expressions.operations import (
    common_dimension,
    divide,
    raise_to_power,
    require_alike,
)
from mechkin_cli.expressions.quantity import Operand, Quantity, Scalar, Site, Value, Vector
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.tape import is_number, of_one
from mechkin_cli.tolerances import KNOWN_AT_DEAD_CENTRE
from mechkin_cli.units import ANGLE, DIMENSIONLESS, Dimension

if TYPE_CHECKING:
    from mechkin_cli.show import Bools, Floats


_BELOW_ONE = nextafter(1.0, 0.0)
"""The last double at which artanh is finite."""


class Function(NamedTuple):
    """A function of `fewest` arguments, or of any larger number where `variadic`; `alone` says
    what to write where a single argument is given and another thing is meant."""

    usage: str
    fewest: int
    apply: Callable[..., Quantity]
    variadic: bool = False
    alone: str = ""

    def accepts(self, count: int) -> bool:
        """Whether the function takes so many arguments."""
        return count == self.fewest or (self.variadic and count > self.fewest)

    @property
    def arity_text(self) -> str:
        """How many arguments the function takes, in words."""
        noun = "argument" if self.fewest == 1 else "arguments"
        return f"{'at least ' if self.variadic else ''}{self.fewest} {noun}"

    def cure(self, count: int) -> str:
        """What to write in place of a call with so many arguments."""
        return f"write {self.usage}{self.alone if count == 1 else ''}"


_OVER_ROWS = {
    word: f" for the {of_two} of several in each row; the {of_all} over the rows stands below a "
    f'table with summary: [{word}], and in r.summary("...").{word} of Python'
    for word, of_two, of_all in (("min", "smaller", "smallest"), ("max", "larger", "largest"))
}


def dot_product(a: Vector, b: Vector) -> Scalar:
    """The sum of the components' products, in order x, y, z."""
    products = [one * other for one, other in zip(a.components, b.components, strict=True)]
    return reduce(operator.add, products)


def cross_product(a: Vector, b: Vector) -> Value:
    """The vector product; in a plane its one component, along the normal."""
    normal = a.x * b.y - a.y * b.x
    if a.z is None or b.z is None:
        return normal
    return Vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, normal)


def _elementary(
    operation: str, takes: Dimension, gives: Dimension
) -> Callable[[Site, Operand], Quantity]:
    def apply(site: Site, operand: Operand) -> Quantity:
        value = site.periodic(operand) if takes == ANGLE else site.scalar(operand)
        site.require(operand, takes)
        return Quantity(of_one(operation, value), gives)

    return apply


def _arctangent(site: Site, y: Operand, x: Operand) -> Quantity:
    sine, cosine = site.scalar(y), site.scalar(x)
    common_dimension(site, "take atan2 of {left} and {right}", y, x)
    return Quantity(scalar_functions.angle_of(sine, cosine), ANGLE)


def _square_root(site: Site, operand: Operand) -> Quantity:
    value = site.scalar(operand)
    if is_number(value) and value < 0.0:
        raise site.error(
            f"square root of a negative number ({value:.6g} in SI units)",
            "check the values of the parameters",
            operand,
        )
    root = operand.dimension ** Fraction(1, 2)
    if any(Fraction(exponent).denominator > 2 for exponent in root.exponents):
        raise site.error(f"no square root of {operand.phrase}", None, operand)
    return Quantity(scalar_functions.square_root(value), root)


def _absolute(site: Site, operand: Operand) -> Quantity:
    return Quantity(scalar_functions.magnitude(site.scalar(operand)), operand.dimension)


def _sign(site: Site, operand: Operand) -> Quantity:
    return Quantity(scalar_functions.sign(site.scalar(operand)))


def _common_dimension_of(site: Site, action: str, operands: Sequence[Operand]) -> Dimension:
    """The dimension of operands that must be of one kind."""
    first, dimension = operands[0], operands[0].dimension
    for operand in operands[1:]:
        sofar = Operand(Quantity(first.value, dimension), first.offset, first.number)
        dimension = common_dimension(site, action, sofar, operand)
    return dimension


def _extreme(
    function: Callable[[Scalar, Scalar], Scalar],
) -> Callable[..., Quantity]:
    def apply(site: Site, *operands: Operand) -> Quantity:
        values = [site.scalar(operand) for operand in operands]
        dimension = _common_dimension_of(site, "compare {left} and {right}", operands)
        return Quantity(reduce(function, values), dimension)

    return apply


def _extreme_of(word: str, function: Callable[[Scalar, Scalar], Scalar]) -> Function:
    return Function(f"{word}(a, b)", 2, _extreme(function), True, _OVER_ROWS[word])


def _clip(site: Site, operand: Operand, least: Operand, most: Operand) -> Quantity:
    raised = Operand(_extreme(scalar_functions.larger)(site, operand, least), operand.offset)
    return _extreme(scalar_functions.smaller)(site, raised, most)


def _of_number(
    function: Callable[[Scalar], Scalar], least: float = -inf, most: float = inf
) -> Callable[[Site, Operand], Quantity]:
    """A function of a dimensionless number, which lies between bounds where it is constant."""

    def apply(site: Site, operand: Operand) -> Quantity:
        value = site.scalar(operand)
        site.require(operand, DIMENSIONLESS)
        if is_number(value) and not least <= value <= most:
            raise site.error(
                f"{site.symbol} has no finite value for {value:.6g}",
                "check the values of the parameters",
                operand,
            )
        return Quantity(function(value))

    return apply


def _remainder(site: Site, operand: Operand, period: Operand) -> Quantity:
    value, length = site.scalar(operand), site.scalar(period)
    dimension = common_dimension(site, "take mod of {left} and {right}", operand, period)
    if is_number(length) and length == 0.0:
        raise site.error("mod of zero", "check the values of the parameters", period)
    return Quantity(steps.remainder(value, length), dimension)


def _hypotenuse(site: Site, *operands: Operand) -> Quantity:
    squares = [site.scalar(operand) * site.scalar(operand) for operand in operands]
    dimension = _common_dimension_of(site, "take hypot of {left} and {right}", operands)
    return Quantity(scalar_functions.square_root(reduce(operator.add, squares)), dimension)


def _wrap(site: Site, operand: Operand) -> Quantity:
    value = site.periodic(operand)
    site.require(operand, ANGLE)
    return Quantity(scalar_functions.wrap(value), ANGLE)


def _dot(site: Site, a: Operand, b: Operand) -> Quantity:
    one, other = site.vector(a), site.vector(b)
    require_alike(site, a, b)
    return Quantity(dot_product(one, other), a.dimension * b.dimension)


def _cross(site: Site, a: Operand, b: Operand) -> Quantity:
    one, other = site.vector(a), site.vector(b)
    require_alike(site, a, b)
    return Quantity(cross_product(one, other), a.dimension * b.dimension)


def _determinant(site: Site, a: Operand, b: Operand, c: Operand) -> Quantity:
    across = cross_product(site.vector(b), site.vector(c))
    if site.vector(a).z is None or not isinstance(across, Vector):
        raise site.error("det takes three vectors of space", "in a plane write cross(a, b)")
    value = dot_product(site.vector(a), across)
    return Quantity(value, a.dimension * b.dimension * c.dimension)


def _norm(site: Site, operand: Operand) -> Quantity:
    value = site.vector(operand)
    found = scalar_functions.square_root(dot_product(value, value))
    return Quantity(scalar_functions.infinite_with(value.components, found), operand.dimension)


def _unit_vector(site: Site, operand: Operand) -> Quantity:
    site.vector(operand)
    return divide(site, operand, Operand(_norm(site, operand), operand.offset))


def _angle_between(site: Site, a: Operand, b: Operand) -> Quantity:
    """By atan2, whose digits do not get lost where the vectors are parallel."""
    one, other = site.vector(a), site.vector(b)
    require_alike(site, a, b)
    normal, cosine = cross_product(one, other), dot_product(one, other)
    if isinstance(normal, Vector):
        sine = scalar_functions.square_root(dot_product(normal, normal))
    else:
        sine = scalar_functions.magnitude(normal)
    angle = scalar_functions.angle_of(sine, cosine)
    return Quantity(angle + (_zero_of(site, a) + _zero_of(site, b)), ANGLE)


def _zero_of(site: Site, operand: Operand) -> Scalar:
    """Zero, and no number in rows where a vector has no direction."""
    vector = site.vector(operand)
    square = dot_product(vector, vector)
    if is_number(square) and square == 0.0:
        words = f"{site.symbol} of a zero vector, which has no direction"
        raise site.error(words, "check the values of the parameters", operand)
    return 0.0 / square


FUNCTIONS: dict[str, Function] = {
    "sin": Function("sin(angle)", 1, _elementary("SIN", ANGLE, DIMENSIONLESS)),
    "cos": Function("cos(angle)", 1, _elementary("COS", ANGLE, DIMENSIONLESS)),
    "tan": Function("tan(angle)", 1, _elementary("TAN", ANGLE, DIMENSIONLESS)),
    "asin": Function("asin(x)", 1, _elementary("ASIN", DIMENSIONLESS, ANGLE)),
    "acos": Function("acos(x)", 1, _elementary("ACOS", DIMENSIONLESS, ANGLE)),
    "atan": Function("atan(x)", 1, _elementary("ATAN", DIMENSIONLESS, ANGLE)),
    "atan2": Function("atan2(y, x)", 2, _arctangent),
    "sqrt": Function("sqrt(x)", 1, _square_root),
    "exp": Function("exp(x)", 1, _elementary("EXP", DIMENSIONLESS, DIMENSIONLESS)),
    "log": Function("log(x)", 1, _elementary("LOG", DIMENSIONLESS, DIMENSIONLESS)),
    "pow": Function("pow(x, n)", 2, raise_to_power),
    "abs": Function("abs(x)", 1, _absolute),
    "sign": Function("sign(x)", 1, _sign),
    "min": _extreme_of("min", scalar_functions.smaller),
    "max": _extreme_of("max", scalar_functions.larger),
    "clip": Function("clip(x, least, most)", 3, _clip),
    "if": Function("if(condition, a, b)", 3, conditions.choose),
    "hypot": Function("hypot(a, b)", 2, _hypotenuse, variadic=True),
    "floor": Function("floor(x)", 1, _of_number(steps.below, -steps.LARGEST, steps.LARGEST)),
    "ceil": Function("ceil(x)", 1, _of_number(steps.above, -steps.LARGEST, steps.LARGEST)),
    "round": Function("round(x)", 1, _of_number(steps.nearest, -steps.LARGEST, steps.LARGEST)),
    "mod": Function("mod(x, period)", 2, _remainder),
    "sinh": Function("sinh(x)", 1, _of_number(hyperbolic.sinh)),
    "cosh": Function("cosh(x)", 1, _of_number(hyperbolic.cosh)),
    "tanh": Function("tanh(x)", 1, _of_number(hyperbolic.tanh)),
    "asinh": Function("asinh(x)", 1, _of_number(hyperbolic.asinh)),
    "acosh": Function("acosh(x)", 1, _of_number(hyperbolic.acosh, 1.0)),
    "atanh": Function("atanh(x)", 1, _of_number(hyperbolic.atanh, -_BELOW_ONE, _BELOW_ONE)),
    "wrap": Function("wrap(angle)", 1, _wrap),
    "dot": Function("dot(a, b)", 2, _dot),
    "cross": Function("cross(a, b)", 2, _cross),
    "det": Function("det(a, b, c)", 3, _determinant),
    "norm": Function("norm(a)", 1, _norm),
    "unit_vector": Function("unit_vector(a)", 1, _unit_vector),
    "angle_between": Function("angle_between(a, b)", 2, _angle_between),
}


def _no_derivative(site: Site, *operands: Operand) -> Quantity:
    raise site.error(
        "derivatives are known in columns and quantities: of positions, by an input", None
    )


FORMS = {"derivative": Function("derivative(expression, input)", 2, _no_derivative)}
"""What is written as a function, and replaced before it is evaluated (`definitions`)."""

INSTEAD = {
    "ln": "the natural logarithm is log(x)",
    "log10": "write log(x)/log(10)",
    "log2": "write log(x)/log(2)",
    "arcsin": "write asin(x)",
    "arccos": "write acos(x)",
    "arctan": "write atan(x)",
    "arctan2": "write atan2(y, x)",
    "fabs": "write abs(x)",
    "sgn": "write sign(x)",
    "clamp": "write clip(x, least, most)",
    "where": "write if(condition, a, b)",
    "degrees": "angles know their unit: divide by 1 deg for the number of degrees",
    "radians": "angles know their unit: multiply a number of degrees by 1 deg",
    "cbrt": "write pow(x, 1/3)",
    "length": "write norm(a)",
    "normalize": "write unit_vector(a)",
}
"""What to write for functions that go by another name elsewhere."""


# What becomes of rows in which something is infinite.
#
# A quantity may be: what grows without bound towards a row at a dead centre. What is made of it is
# infinite, too, or has no value. An operation that has no finite value by itself, as 1/x at zero,
# gives none, so that no function makes a number of it again.

_KEEPS_INFINITE = frozenset({"+", "-", "negate", "max", "min", "abs"})
"""Operations that are infinite where one operand is, whatever the others are."""

_TAKES_PARTS = frozenset({"[]", ".x", ".y", ".z"})


def is_infinite(quantity: Quantity) -> bool:
    """Whether a quantity is infinite in some row."""
    return any(map(_somewhere, _parts(quantity)))


def without_new(operand: Operand) -> Operand:
    """Rows with nan for what is infinite, of operations on what is finite."""
    if not is_infinite(operand.quantity):
        return operand
    return _each(operand, lambda part: np.where(np.isinf(part), np.nan, part))


def of_infinite(symbol: str, operand: Operand, operands: Sequence[Operand]) -> Operand:
    """The same where operands may be infinite: what is finite in such a row is none of it."""
    if symbol in _TAKES_PARTS:
        return operand
    rows: Bools | np.bool_ = np.False_
    for given in operands:
        for part in _parts(given.quantity):
            if isinstance(part, np.ndarray):
                rows = rows | np.isinf(part)
    told = _each(operand, lambda part: np.where(np.isinf(part) == rows, part, np.nan))
    if symbol in _KEEPS_INFINITE:
        return told
    lost: Bools | np.bool_ = np.False_
    for given in operands:
        lost = lost | _may_vanish(given.quantity)
    return _each(told, lambda part: np.where(rows & lost, np.nan, part))


def _may_vanish(quantity: Quantity) -> Bools | np.bool_:
    """Rows in which a quantity is zero as far as positions are known at a dead centre, so that its
    product with what is infinite may have any limit."""
    rows: Bools | np.bool_ = np.True_
    plain = 1.0 if quantity.dimension in (ANGLE, DIMENSIONLESS) else 0.0
    for part in _parts(quantity):
        size = np.abs(np.asarray(part, dtype=np.float64))
        scale = max(plain, float(size.max(where=np.isfinite(size), initial=0.0)))
        rows = rows & (size <= KNOWN_AT_DEAD_CENTRE * scale)
    return rows


def _somewhere(part: Scalar) -> bool:
    # both of these go without a wrapper of Python's, and every operation on rows comes by here
    if not isinstance(part, np.ndarray) or part.dtype.kind != "f":
        return False
    return bool(np.logical_or.reduce(np.isinf(part)))


def _parts(quantity: Quantity) -> Sequence[Scalar]:
    value = quantity.value
    return value.components if isinstance(value, Vector) else (value,)


def _each(operand: Operand, change: Callable[[Floats], Floats]) -> Operand:
    value = operand.quantity.value
    kept = [change(p) if isinstance(p, np.ndarray) else p for p in _parts(operand.quantity)]
    found = Vector(*kept) if isinstance(value, Vector) else kept[0]
    return replace(operand, quantity=replace(operand.quantity, value=found))
