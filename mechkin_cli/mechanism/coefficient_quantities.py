"""The coefficients of what is linear in the inputs' accelerations, by name.

Every acceleration, reaction and effort is a*alpha + b, with the acceleration alpha of an input
(dissertation, (3.54)-(3.61)): `Q.per_acceleration` is a, for the first input that moves, with no
other accelerated, and `Q.per.A.theta_ddot` for each of several inputs; `Q.without_acceleration` is
b, with no input accelerated. `A.theta.reduced_inertia` is the effort of an input per its own
acceleration, `A.theta.effort.per.A.theta_ddot`; with `A.theta.effort.per.B.theta_ddot` these are
the matrix of Lagrange's equations in the inputs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.quantities import Kind, Wanted, effort_quantity
from mechkin_cli.units import ACCELERATION, ANGULAR_ACCELERATION, Dimension

COEFFICIENT_KINDS: set[str] = {"per_acceleration", "without_acceleration"}

_FORCES = {
    "force",
    "moment",
    "moment_about_origin",
    "effort",
    "shaking_force",
    "shaking_moment",
    "inertia_force",
    "inertia_moment",
}
_AT = " at "

Input = tuple[str, str]
"""Joint and coordinate."""


def coefficient_catalogue(
    known: Mapping[str, Wanted], inputs: Sequence[Input], leading: Input
) -> dict[str, Wanted]:
    """Every coefficient of the quantities that are `known`; `leading` is the input that is meant
    where none is named."""
    found = [*_of_inertias(inputs)]
    for quantity in known.values():
        if _is_linear(quantity, inputs):
            found.append(_per(quantity, leading, f"{quantity.name}.per_acceleration"))
            for joint, coordinate in inputs if len(inputs) > 1 else ():
                name = f"{quantity.name}.per.{joint}.{coordinate}_ddot"
                found.append(_per(quantity, (joint, coordinate), name))
            found.append(_without(quantity))
    return {wanted.name: wanted for wanted in found}


def base_name(coefficient: Wanted) -> str:
    """The quantity whose coefficient it is."""
    return coefficient.coordinate.partition(_AT)[0]


def accelerated(coefficient: Wanted) -> Input | None:
    """The input by whose acceleration it is; None: no input is accelerated."""
    joint, _, coordinate = coefficient.coordinate.partition(_AT)[2].rpartition(".")
    return (joint, coordinate) if joint else None


def base_quantity(known: Mapping[str, Wanted], name: str) -> Wanted:
    """The quantity of a coefficient's base name; inputs have efforts, whatever else is known."""
    if name in known:
        return known[name]
    joint, coordinate, _ = name.rsplit(".", 2)
    return effort_quantity(joint, coordinate)


def _of_inertias(inputs: Sequence[Input]) -> Iterator[Wanted]:
    for joint, coordinate in inputs:
        effort = effort_quantity(joint, coordinate)
        yield _per(effort, (joint, coordinate), f"{joint}.{coordinate}.reduced_inertia")


def _is_linear(quantity: Wanted, inputs: Sequence[Input]) -> bool:
    if quantity.kind == "coordinate":
        return quantity.order == 2 and (quantity.owner, quantity.coordinate) not in inputs
    if quantity.kind == "point":
        return quantity.order == 2
    return quantity.kind == "alpha" or quantity.kind in _FORCES


def _per(quantity: Wanted, by: Input, name: str) -> Wanted:
    dimension = quantity.dimension / _acceleration(by[1])
    return _coefficient(quantity, "per_acceleration", name, dimension, f"{_AT}{by[0]}.{by[1]}")


def _without(quantity: Wanted) -> Wanted:
    name = f"{quantity.name}.without_acceleration"
    return _coefficient(quantity, "without_acceleration", name, quantity.dimension, "")


def _coefficient(quantity: Wanted, kind: Kind, name: str, dimension: Dimension, by: str) -> Wanted:
    # order 2 says that it is of a motion, and needs no forces
    order = 0 if quantity.kind in _FORCES else 2
    base = f"{quantity.name}{by}"
    return quantity._replace(
        name=name, kind=kind, dimension=dimension, coordinate=base, order=order
    )


def _acceleration(coordinate: str) -> Dimension:
    return ANGULAR_ACCELERATION if is_angle(coordinate) else ACCELERATION
