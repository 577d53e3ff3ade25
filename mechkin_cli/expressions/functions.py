"""The functions of expressions: one table of their arguments and results.

A function is added by one entry of `FUNCTIONS`; the second section keeps rows in which something is
infinite from becoming numbers again.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import reduce
from math import inf, nextafter
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.expressions import operations
from mechkin_cli.expressions.operations import (
    common_dimension,
    dimension_of_all,
    require_alike,
)
from mechkin_cli.expressions.quantity import (
    Operand,
    Quantity,
    Scalar,
    Site,
    Value,
    Vector,
    components,
)
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.tape import is_number, of_one
from mechkin_cli.tolerances import KNOWN_AT_DEAD_CENTRE
from mechkin_cli.units import ANGLE, DIMENSIONLESS, Dimension

if TYPE_CHECKING:
    from mechkin_cli.show import Bools, Floats


_BELOW_ONE = nextafter(1.0, 0.0)
"""The last double at which artanh is finite."""


class Function(NamedTuple):
    """A function of `fewest` arguments, or of any larger number where `variadic`; `alone` is the
    hint for a call with a single argument, which probably means something else."""

    usage: str
    fewest: int
    apply: Callable[..., Quantity]
    variadic: bool = False
    alone: str = ""

    def accepts(self, count: int) -> bool:
        """Whether the function takes this number of arguments."""
        return count == self.fewest or (self.variadic and count > self.fewest)

    @property
    def arity_text(self) -> str:
        """How many arguments the function takes, in words."""
        noun = "argument" if self.fewest == 1 else "arguments"
        return f"{'at least ' if self.variadic else ''}{self.fewest} {noun}"

    def cure(self, count: int) -> str:
        """What to write in place of a call with this number of arguments."""
        return f"write {self.usage}{self.alone if count == 1 else ''}"


_OVER_ROWS = {
    word: f" for the {of_two} of several in each row; the {of_all} over the rows stands below a "
    f'table with summary: [{word}], and in r.summary("...").{word} of Python'
    for word, of_two, of_all in (("min", "smaller", "smallest"), ("max", "larger", "largest"))
}


def dot_product(a: Vector, b: Vector) -> Scalar:
    """The sum of the components' products, in order x, y, z."""
    products: list[Scalar] = [p * q for p, q in zip(a.components, b.components, strict=True)]
    return reduce(operator.add, products)


def cross_product(a: Vector, b: Vector) -> Value:
    """The vector product; in a plane its one component, along the normal."""
    normal = a.x * b.y - a.y * b.x
    if a.z is None or b.z is None:
        return normal
    return Vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, normal)


def _elementary(
    operation: str, argument: Dimension, result: Dimension
) -> Callable[[Site, Operand], Quantity]:
    def apply(site: Site, operand: Operand) -> Quantity:
        value = site.periodic(operand) if argument == ANGLE else site.scalar(operand)
        if not (operand.in_pi and argument == ANGLE and operand.dimension.dimensionless):
            site.require(operand, argument)
        return Quantity(of_one(operation, value), result)

    return apply


def _arctangent(site: Site, y: Operand, x: Operand) -> Quantity:
    sine, cosine = site.scalar(y), site.scalar(x)
    common_dimension(site, "take atan2 of {left} and {right}", y, x)
    return Quantity(operations.angle_of(sine, cosine), ANGLE)


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
    return Quantity(operations.square_root(value), root)


def _extreme(
    function: Callable[[Scalar, Scalar], Scalar],
) -> Callable[..., Quantity]:
    def apply(site: Site, *operands: Operand) -> Quantity:
        values = [site.scalar(operand) for operand in operands]
        dimension = dimension_of_all(site, "compare {left} and {right}", operands)
        return Quantity(reduce(function, values), dimension)

    return apply


def _extreme_of(word: str, function: Callable[[Scalar, Scalar], Scalar]) -> Function:
    return Function(f"{word}(a, b)", 2, _extreme(function), True, _OVER_ROWS[word])


def _clip(site: Site, operand: Operand, least: Operand, most: Operand) -> Quantity:
    raised = Operand(_extreme(operations.larger)(site, operand, least), operand.offset)
    return _extreme(operations.smaller)(site, raised, most)


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
    return Quantity(operations.remainder(value, length), dimension)


def _hypotenuse(site: Site, *operands: Operand) -> Quantity:
    squares = [site.scalar(operand) * site.scalar(operand) for operand in operands]
    dimension = dimension_of_all(site, "take hypot of {left} and {right}", operands)
    return Quantity(operations.square_root(reduce(operator.add, squares)), dimension)


def _wrap(site: Site, operand: Operand) -> Quantity:
    value = site.periodic(operand)
    site.require(operand, ANGLE)
    return Quantity(operations.wrap(value), ANGLE)


def _product(function: Callable[[Vector, Vector], Value]) -> Callable[..., Quantity]:
    def apply(site: Site, a: Operand, b: Operand) -> Quantity:
        left, right = site.vector(a), site.vector(b)
        require_alike(site, a, b)
        return Quantity(function(left, right), a.dimension * b.dimension)

    return apply


def _determinant(site: Site, a: Operand, b: Operand, c: Operand) -> Quantity:
    across = cross_product(site.vector(b), site.vector(c))
    if site.vector(a).z is None or not isinstance(across, Vector):
        raise site.error("det takes three vectors of space", "in a plane write cross(a, b)")
    value = dot_product(site.vector(a), across)
    return Quantity(value, a.dimension * b.dimension * c.dimension)


def _norm(site: Site, operand: Operand) -> Quantity:
    value = site.vector(operand)
    length = operations.square_root(dot_product(value, value))
    return Quantity(operations.infinite_with(value.components, length), operand.dimension)


def _unit_vector(site: Site, operand: Operand) -> Quantity:
    site.vector(operand)
    return operations.divide(site, operand, Operand(_norm(site, operand), operand.offset))


def _angle_between(site: Site, a: Operand, b: Operand) -> Quantity:
    """By atan2, whose digits do not get lost where the vectors are parallel."""
    left, right = site.vector(a), site.vector(b)
    require_alike(site, a, b)
    normal, cosine = cross_product(left, right), dot_product(left, right)
    if isinstance(normal, Vector):
        sine = operations.square_root(dot_product(normal, normal))
    else:
        sine = operations.magnitude(normal)
    angle = operations.angle_of(sine, cosine)
    return Quantity(angle + (_zero_of(site, a) + _zero_of(site, b)), ANGLE)


def _zero_of(site: Site, operand: Operand) -> Scalar:
    """Zero, and no number in rows where a vector has no direction."""
    vector = site.vector(operand)
    square = dot_product(vector, vector)
    if is_number(square) and square == 0.0:
        message = f"{site.symbol} of a zero vector, which has no direction"
        raise site.error(message, "check the values of the parameters", operand)
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
    "pow": Function("pow(x, n)", 2, operations.raise_to_power),
    "abs": Function(
        "abs(x)", 1, lambda site, x: Quantity(operations.magnitude(site.scalar(x)), x.dimension)
    ),
    "sign": Function("sign(x)", 1, lambda site, x: Quantity(operations.sign(site.scalar(x)))),
    "min": _extreme_of("min", operations.smaller),
    "max": _extreme_of("max", operations.larger),
    "clip": Function("clip(x, least, most)", 3, _clip),
    "if": Function("if(condition, a, b)", 3, operations.choose),
    "hypot": Function("hypot(a, b)", 2, _hypotenuse, variadic=True),
    "floor": Function(
        "floor(x)", 1, _of_number(operations.below, -operations.LARGEST, operations.LARGEST)
    ),
    "ceil": Function(
        "ceil(x)", 1, _of_number(operations.above, -operations.LARGEST, operations.LARGEST)
    ),
    "round": Function(
        "round(x)", 1, _of_number(operations.nearest, -operations.LARGEST, operations.LARGEST)
    ),
    "mod": Function("mod(x, period)", 2, _remainder),
    "sinh": Function("sinh(x)", 1, _of_number(operations.sinh)),
    "cosh": Function("cosh(x)", 1, _of_number(operations.cosh)),
    "tanh": Function("tanh(x)", 1, _of_number(operations.tanh)),
    "asinh": Function("asinh(x)", 1, _of_number(operations.asinh)),
    "acosh": Function("acosh(x)", 1, _of_number(operations.acosh, 1.0)),
    "atanh": Function("atanh(x)", 1, _of_number(operations.atanh, -_BELOW_ONE, _BELOW_ONE)),
    "wrap": Function("wrap(angle)", 1, _wrap),
    "dot": Function("dot(a, b)", 2, _product(dot_product)),
    "cross": Function("cross(a, b)", 2, _product(cross_product)),
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
"""Forms written as functions, which `Definitions` replace before an expression is evaluated."""

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
"""What to write for functions that have another name elsewhere."""


# Rows in which something is infinite: a quantity that grows without bound towards a dead centre.
# What is computed from it is infinite, too, or nan. An operation that has no finite value by
# itself, as 1/x at zero, gives nan, so that no function makes a number of it again.

_KEEPS_INFINITE = frozenset({"+", "-", "negate", "max", "min", "abs"})
"""Operations that are infinite where one operand is, whatever the others are."""

_TAKES_PARTS = frozenset({"[]", ".x", ".y", ".z"})


def is_infinite(quantity: Quantity) -> bool:
    """Whether a quantity is infinite in some row."""
    return any(map(_somewhere, components(quantity.value)))


def without_new(operand: Operand) -> Operand:
    """An operand computed from finite ones, with nan for what is infinite."""
    if not is_infinite(operand.quantity):
        return operand
    return _each(operand, lambda part: np.where(np.isinf(part), np.nan, part))


def of_infinite(symbol: str, operand: Operand, operands: Sequence[Operand]) -> Operand:
    """The result of an operation whose operands may be infinite: nan where it is finite although
    one of them is infinite, or the other way round."""
    if symbol in _TAKES_PARTS:
        return operand
    rows: Bools | np.bool_ = np.False_
    for each in operands:
        for part in components(each.value):
            if isinstance(part, np.ndarray):
                rows = rows | np.isinf(part)
    result = _each(operand, lambda part: np.where(np.isinf(part) == rows, part, np.nan))
    if symbol in _KEEPS_INFINITE:
        return result
    lost: Bools | np.bool_ = np.False_
    for each in operands:
        lost = lost | _may_vanish(each.quantity)
    return _each(result, lambda part: np.where(rows & lost, np.nan, part))


def _may_vanish(quantity: Quantity) -> Bools | np.bool_:
    """Rows in which a quantity is zero as far as positions are known at a dead centre, so that its
    product with what is infinite may have any limit."""
    rows: Bools | np.bool_ = np.True_
    plain = 1.0 if quantity.dimension in (ANGLE, DIMENSIONLESS) else 0.0
    for part in components(quantity.value):
        size = np.abs(np.asarray(part, dtype=np.float64))
        scale = max(plain, float(size.max(where=np.isfinite(size), initial=0.0)))
        rows = rows & (size <= KNOWN_AT_DEAD_CENTRE * scale)
    return rows


def _somewhere(part: Scalar) -> bool:
    # both of these go without a wrapper of Python's, and every operation on rows comes by here
    if not isinstance(part, np.ndarray) or part.dtype.kind != "f":
        return False
    return bool(np.logical_or.reduce(np.isinf(part)))


def _each(operand: Operand, change: Callable[[Floats], Floats]) -> Operand:
    parts = [change(p) if isinstance(p, np.ndarray) else p for p in components(operand.value)]
    value = Vector(*parts) if isinstance(operand.value, Vector) else parts[0]
    return replace(operand, quantity=replace(operand.quantity, value=value))
