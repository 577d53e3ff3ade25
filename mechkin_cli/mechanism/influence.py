"""Derivatives of positions by an input, as quantities of the mechanism.

An acceleration per acceleration of an input is the velocity per its rate, and so the derivative of
the position by the input (influence coefficients: J. Duffy, Analysis of Mechanisms and Robot
Manipulators, 1980): `p.position` by `A.theta` is `p.acceleration.per_acceleration`. A direction d
of a link moves by the cross product of the link's coefficient and d.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mechkin_cli.expressions.errors import ExpressionError
from mechkin_cli.expressions.nodes import Name, Node, Number, Operation
from mechkin_cli.expressions.parser import parse_nodes
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.model import GROUND_NAME
from mechkin_cli.nearest import nearest_hint

if TYPE_CHECKING:
    from mechkin_cli.expressions.definitions import Differentiate
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted

_AXES = ("x", "y", "z")
_POSITIONS = "it is taken of coordinates, positions of points, directions and parameters"


def differentiation(problem: Problem) -> Differentiate:
    """How derivatives by the inputs of a problem are taken."""

    def differentiate(nodes: tuple[Node, ...], by: Name, offset: int) -> tuple[Node, ...]:
        # loaded only where a derivative is written
        from mechkin_cli.expressions.differentiation import differentiated

        influence = _Influence(problem, by)
        return differentiated(nodes, influence.rate, influence.unit, offset)

    return differentiate


class _Influence:
    """The derivatives of names by one input.

    Raises:
        ExpressionError: it is no input.
    """

    def __init__(self, problem: Problem, by: Name) -> None:
        self.problem, self.input = problem, by.text
        self.known: Mapping[str, Wanted] = problem.quantities()
        self.inputs = [f"{joint}.{name}" for joint, name in problem.motion.driven]
        if self.input not in self.inputs:
            hint = nearest_hint(self.input, self.inputs) or "the motion has no inputs"
            raise ExpressionError(f"{self.input[:40]} is no input of the motion", by.offset, hint)
        self.unit = "rad" if is_angle(self.input.rpartition(".")[2]) else "m"

    def rate(self, name: Name) -> tuple[Node, ...] | None:
        """The derivative of a name; None of what does not move.

        Raises:
            ExpressionError: it is no position.
        """
        text, axis = name.text, ""
        if text in self.problem.parameters:
            return None
        if text not in self.known and text.rpartition(".")[2] in _AXES:
            text, _, axis = text.rpartition(".")
        wanted = self.known.get(text)
        if wanted is None:
            return None  # what is not known is told when the expression is evaluated
        component = (Operation(f".{axis}", 1, name.offset),) if axis else ()
        if wanted.kind == "coordinate" and wanted.order == 0:
            return self._of_coordinate(text, name)
        if wanted.kind == "point" and wanted.order == 0:
            if self.problem.mechanism.points[wanted.owner].link == GROUND_NAME:
                return None
            return (*self._per(f"{wanted.owner}.acceleration", name), *component)
        if wanted.kind == "direction":
            link = self.problem.mechanism.directions[text].link
            if link == GROUND_NAME:
                return None
            turning = self._per(f"{link}.alpha", name)
            # a rate of turning times a length is a velocity: its rad is left out
            bare = (*parse_nodes("1 rad"), Operation("/", 2, name.offset))
            cross = Operation("cross", 2, name.offset)
            return (*turning, *bare, Name(text, name.offset), cross, *component)
        hint = _POSITIONS
        if wanted.kind == "joint_point":
            hint = f"name the place in points: and write its position; {_POSITIONS}"
        raise ExpressionError(f"{text} has no derivative by an input", name.offset, hint)

    def _of_coordinate(self, text: str, name: Name) -> tuple[Node, ...] | None:
        if text in self.inputs:
            one = Number(1.0, None, "1", name.offset)
            return (one,) if text == self.input else None
        return self._per(f"{text}_ddot", name)

    def _per(self, acceleration: str, name: Name) -> tuple[Node, ...]:
        """The coefficient of an acceleration."""
        leading = self.problem.motion.leading
        found = f"{acceleration}.per.{self.input}_ddot"
        if found not in self.known and leading is not None and leading.name == self.input:
            found = f"{acceleration}.per_acceleration"
        if found not in self.known:
            text = f"{name.text} has no derivative by {self.input}"
            raise ExpressionError(text, name.offset, _POSITIONS)
        return (Name(found, name.offset, whole=True),)
