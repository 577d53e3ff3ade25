"""Arithmetic on operands: sums need one dimension, products multiply dimensions.

Every formula is elementwise IEEE arithmetic in a fixed order, for scalars, rows and vectors alike.
"""

from __future__ import annotations

import operator
from collections.abc import Callable

from mechkin_cli.expressions.limits import MAX_EXPONENT
from mechkin_cli.expressions.nodes import Number
from mechkin_cli.expressions.operand import Operand, Site
from mechkin_cli.expressions.quantity import Quantity, Scalar, Value, Vector
from mechkin_cli.expressions.scalar_functions import power
from mechkin_cli.tape.scalars import as_recorded, is_number
from mechkin_cli.units import DIMENSIONLESS, POWER, Dimension

_SUM_WORDS = {
    "+": ("add {left} and {right}", operator.add),
    "-": ("subtract {right} from {left}", operator.sub),
}


def common_dimension(site: Site, action: str, left: Operand, right: Operand) -> Dimension:
    """The dimension of two operands that must be of one kind.

    Raises:
        ExpressionError: one is a vector and the other is not, or the dimensions differ.
    """
    if left.dimension == right.dimension:
        dimension = left.dimension
    elif left.dimension.compatible(right.dimension):
        dimension = left.dimension.reduced()
    else:
        bare = left if left.dimension.dimensionless else right
        other = right if bare is left else left
        hint = None
        if bare.dimension.dimensionless:
            hint = site.unit_hint(bare, other.dimension)
        words = action.format(left=left.phrase, right=right.phrase)
        raise site.error(f"cannot {words}", hint or "both must be of one kind", bare)
    if isinstance(left.value, Vector) is not isinstance(right.value, Vector):
        words = action.format(left=left.phrase, right=right.phrase)
        raise site.error(f"cannot {words}", "take a component with .x, .y or .z, or norm(...)")
    require_alike(site, left, right)
    return dimension


def require_alike(site: Site, left: Operand, right: Operand) -> None:
    """Check that two vectors have as many components.

    Raises:
        ExpressionError: one is of a plane and the other of space.
    """
    one, other = left.value, right.value
    if not isinstance(one, Vector) or not isinstance(other, Vector):
        return
    counts = len(one.components), len(other.components)
    if counts[0] != counts[1]:
        words = f"a vector of {counts[0]} components and one of {counts[1]}"
        hint = "with plane: xy all vectors have two, in space three"
        raise site.error(f"{site.symbol} does not take {words}", hint, right)


def add_or_subtract(site: Site, left: Operand, right: Operand) -> Quantity:
    """Sum or difference of scalars or of vectors."""
    action, function = _SUM_WORDS[site.symbol]
    dimension = common_dimension(site, action, left, right)
    return Quantity(elementwise(function, left.value, right.value), dimension)


def multiply(site: Site, left: Operand, right: Operand) -> Quantity:
    """Product of scalars, or of a scalar and a vector."""
    if isinstance(left.value, Vector) and isinstance(right.value, Vector):
        raise site.error("* does not multiply two vectors", "write dot(a, b) or cross(a, b)")
    product = elementwise(operator.mul, left.value, right.value)
    return Quantity(product, left.dimension * right.dimension)


def divide(site: Site, left: Operand, right: Operand) -> Quantity:
    """Quotient of a scalar or vector and a scalar."""
    divisor = site.scalar(right)
    constant = any(is_number(item) for item in _components(left.value))
    if constant and is_number(divisor) and divisor == 0.0:
        raise site.error("division by zero", "check the values of the parameters", right)
    quotient = elementwise(operator.truediv, left.value, divisor)
    return Quantity(quotient, _quotient(left.dimension, right.dimension))


def _quotient(left: Dimension, right: Dimension) -> Dimension:
    """What a quotient measures. A torque times an angular rate is a power, and as one divided by
    a power it is a number; a length times an angle, divided by a length, is an angle again."""
    if left.reduced() == right.reduced() == POWER:
        return DIMENSIONLESS
    return left / right


def negate(site: Site, operand: Operand) -> Quantity:
    """The opposite scalar or vector."""
    value = operand.value
    if isinstance(value, Vector):
        return Quantity(Vector(*(-item for item in value.components)), operand.dimension)
    return Quantity(-value, operand.dimension)


def raise_to_power(site: Site, base: Operand, exponent: Operand) -> Quantity:
    """A power; a base with a dimension takes only a whole number written as such."""
    if isinstance(base.value, Vector):
        raise site.error("a vector has no power", "write dot(a, a) or norm(a)^2", base)
    if not exponent.dimension.dimensionless or isinstance(exponent.value, Vector):
        raise site.error(
            f"an exponent is a dimensionless number, not {exponent.phrase}", None, exponent
        )
    if base.dimension.dimensionless:
        if exponent.number is not None and exponent.value == 2.0:
            return Quantity(base.value * base.value)
        return Quantity(power(base.value, exponent.value))
    count = _whole_number(site, base, exponent)
    value = base.value * base.value if count == 2 else power(base.value, float(count))
    return Quantity(value, base.dimension**count)


def _whole_number(site: Site, base: Operand, exponent: Operand) -> int:
    number: Number | None = exponent.number
    written = 0.5 if number is None else as_recorded(number.value)
    if number is None or written % 1.0 != 0.0:
        raise site.error(
            f"{base.phrase} can only be raised to a whole number that is written as such",
            "write a root as sqrt(...)",
            exponent,
        )
    if abs(written) > MAX_EXPONENT:
        raise site.error(f"the exponent is {number.text} (limit {MAX_EXPONENT})", None, exponent)
    return int(written)


def component(site: Site, operand: Operand) -> Quantity:
    """The component `.x`, `.y` or `.z` of a vector."""
    if not isinstance(operand.value, Vector):
        raise site.error(
            f"{site.symbol} takes a component of a vector, not of {operand.phrase}",
            f"leave out {site.symbol}",
        )
    found = getattr(operand.value, site.symbol[1])
    if found is None:
        raise site.error(
            f"a vector of a plane file has no {site.symbol}",
            "it has .x and .y; what the plane holds, forces along z and moments about x and y, is "
            "not computed",
        )
    return Quantity(found, operand.dimension)


def vector(site: Site, x: Operand, *others: Operand) -> Quantity:
    """A vector of two or three scalars of one dimension."""
    components = [site.scalar(operand) for operand in (x, *others)]
    dimension = x.dimension
    for operand in others:
        partial = Operand(Quantity(x.value, dimension), x.offset, x.number)
        action = "make a vector of {left} and {right}"
        dimension = common_dimension(site, action, partial, operand)
    return Quantity(Vector(*components), dimension)


def elementwise(function: Callable[[Scalar, Scalar], Scalar], left: Value, right: Value) -> Value:
    """The function on two scalars, or on components; a scalar goes with every component."""
    if not isinstance(left, Vector) and not isinstance(right, Vector):
        return function(left, right)
    count = min(len(_components(left)), len(_components(right)))
    return Vector(*map(function, _components(left)[:count], _components(right)[:count]))


def _components(value: Value) -> tuple[Scalar, ...]:
    return value.components if isinstance(value, Vector) else (value, value, value)
