"""Everything that one mechanism file asks for, in SI and checked; a response as a problem of its
own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, nearest_hint
from mechkin_cli.expressions import (
    Definitions,
    ExpressionError,
    Name,
    Node,
    NumberNode,
    OperationNode,
    Quantity,
    UnknownName,
    parse_nodes,
)
from mechkin_cli.mechanism.curve import LoadLaw
from mechkin_cli.mechanism.derived import (
    coefficient_catalogue,
    derived_catalogue,
    hint_in_plane,
    hint_of,
    ledger_catalogue,
)
from mechkin_cli.mechanism.held import LockedFreedom
from mechkin_cli.mechanism.joint import GROUND_NAME, is_told
from mechkin_cli.mechanism.model import Mechanism, without_effort
from mechkin_cli.mechanism.motion import ORDERS, Assembly, DrivenInput, Limit, MotionInputs
from mechkin_cli.mechanism.pairs import is_angle
from mechkin_cli.mechanism.quantities import (
    Catalogue,
    Elements,
    ElementsByName,
    bearing_catalogue,
    catalogue,
    coordinates_of,
    response_quantities,
)
from mechkin_cli.mechanism.wanted import Wanted
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.row_notes import Found, RowNote
from mechkin_cli.tolerances import LARGEST_NUMBER, TABLE_END
from mechkin_cli.units import Dimension, UnitSystem

if TYPE_CHECKING:
    from collections.abc import Iterable

    from mechkin_cli.expressions import Differentiate
    from mechkin_cli.mechanism.response import AnyBalance, ResponseProblem
    from mechkin_cli.show import Bools, Floats

_REACTIONS = frozenset(
    (
        *("force", "moment", "moment_about_origin", "total_force", "total_moment"),
        *("radial_force", "axial_force", "tilting_moment"),
    )
)
"""What a joint takes of what transmits a tie, by kind and word."""


@dataclass(frozen=True)
class Problem:
    """A mechanism, how it moves, how it is assembled, and the units of its file.

    Mechanism, motion and laws are those of the sweep; `responses` are the file's other runs, and
    `response` is the one whose first moment this is (`mechanism.response.response_problem`);
    `limits` are where coordinates end.
    """

    mechanism: Mechanism
    motion: MotionInputs
    assembly: Assembly
    units: UnitSystem
    parameters: Mapping[str, Quantity] = field(default_factory=dict)
    definitions: Definitions = field(default_factory=Definitions)
    diagnostics: tuple[Diagnostic, ...] = ()
    load_laws: tuple[LoadLaw, ...] = ()
    hold_idle: bool = False
    held: tuple[LockedFreedom, ...] = ()
    follow: tuple[str, ...] | None = None
    responses: Mapping[str, ResponseProblem] = field(default_factory=dict)
    response: ResponseProblem | None = None
    limits: tuple[Limit, ...] = ()
    _alike: Problem | None = field(default=None, init=False, repr=False, compare=False)

    def part(self, first: int, last: int) -> Problem:
        """The problem of the rows from `first` to `last`, both included; it has the same
        quantities."""
        return replace(self, motion=self.motion.part(first, last)).with_quantities_of(self)

    @property
    def driven(self) -> list[tuple[str, str]]:
        """The inputs (joint, coordinate), then the coordinates at which idle freedoms are held."""
        return [*self.motion.driven, *self.held_at]

    @property
    def acting(self) -> Sequence[tuple[str, str]]:
        """Where efforts act (joint, coordinate): at actuators, else at the inputs; none where
        nothing drives."""
        drives, motion = self.mechanism.drives, self.motion
        acting = motion.driven if drives is None else drives.acting
        if motion.rest is None:
            return acting
        free = [motion.driven[number] for number in motion.rest.inputs]
        return [at for at in acting if at not in free and at not in motion.rest.names]

    @cached_property
    def has_idle(self) -> bool:
        """Whether something may move freely while all else stands still."""
        return bool(self.mechanism.spins or any(one.idle for one in self.held))

    @cached_property
    def stopped(self) -> tuple[LockedFreedom, ...]:
        """Held freedoms that the loops stop, but not to first order."""
        return tuple(one for one in self.held if not one.idle)

    @cached_property
    def held_at(self) -> dict[tuple[str, str], float]:
        """Where the held coordinates stand (rad, m): as drawn, or where `near` puts them."""
        near = self.assembly.near
        held = [one for one in self.held if one.coordinate is not None]
        return {one.coordinate: near.get(one.name, 0.0) for one in held if one.coordinate}

    @cached_property
    def laid_mechanism(self) -> Mechanism:
        """The mechanism with the pairs that hold idle freedoms."""
        stops = {one.stop.name: one.stop for one in self.held if one.stop is not None}
        if not stops:
            return self.mechanism
        return replace(self.mechanism, joints={**self.mechanism.joints, **stops})

    @cached_property
    def solved_mechanism(self) -> Mechanism:
        """The same with the balls that hold idle freedoms told as three turns."""
        told = {one.told.name: one.told for one in self.held if one.told is not None}
        if not told:
            return self.laid_mechanism
        return replace(self.laid_mechanism, joints={**self.laid_mechanism.joints, **told})

    @property
    def laws(self) -> Laws | None:
        """The laws of the loads that vary, with what their names stand for; None without any."""
        watched = () if self.response is None else self.response.watched
        if not self.load_laws and not watched:
            return None

        return Laws(self.load_laws, self.parameters, self.quantities(), watched)

    def moved(self, motion: MotionInputs) -> Problem:
        """The problem with another motion; those of a response have the same quantities."""
        other = replace(self, motion=motion)
        return other if self.response is None else other.with_quantities_of(self)

    def with_quantities_of(self, other: Problem) -> Problem:
        """This problem, which has the quantities of another: links, joints and inputs of the same
        names and kinds."""
        object.__setattr__(self, "_alike", other)
        return self

    def quantities(self) -> Mapping[str, Wanted]:
        """The quantities that the mechanism has, by name."""
        return self._quantities

    @property
    def told_quantities(self) -> tuple[str, ...]:
        """The names among them that users see: not those of a cable's stretches."""
        return tuple(name for name in self.quantities() if is_told(name))

    def why_not(self, name: str) -> str | None:
        """Why there is no quantity of a name, and what there is; None where that is not known."""
        response = self.response is not None
        drives = None if response else self.mechanism.drives
        passive = without_effort(name, self._quantities, drives, response=response)
        held = hint_in_plane(name) if self.mechanism.plane else None
        return passive or self._why_untold(name) or held or hint_of(name, self._quantities)

    @cached_property
    def tied(self) -> Mapping[str, tuple[str, str]]:
        """Joints that are tied to others as inputs, by name, with the tie in words and the cure:
        its effort is known, but not what transmits it, a tooth or a belt, of which their reactions
        depend."""
        inputs = self.motion.inputs
        pairs = [(inputs[tie.input], inputs[tie.leader]) for tie in self.motion.constraints]
        return {
            joint: (f"{one.name} is tied to {other.name}", _as_coupling(one, other))
            for one, other in pairs
            if one.joint != other.joint
            for joint in (one.joint, other.joint)
        }

    def _why_untold(self, name: str) -> str | None:
        """Why a reaction is not told at a tied joint; None for other names."""
        owner, _, word = (
            name.removesuffix(".x").removesuffix(".y").removesuffix(".z").rpartition(".")
        )
        if owner not in self.tied or word not in _REACTIONS:
            return None
        tie, cure = self.tied[owner]
        return (
            f"{tie}, and what transmits that is not said: teeth push their bearings, a belt pulls; "
            f"{cure}, or write drive: own if they are not connected"
        )

    def _linear(self, found: Mapping[str, Wanted]) -> Mapping[str, Wanted]:
        """Without reactions where teeth push wheels apart, whichever way their moment acts."""
        if not self._pushes_apart:
            return found
        reactions = ("force", "moment", "moment_about_origin")
        return {name: known for name, known in found.items() if known.kind not in reactions}

    @cached_property
    def _pushes_apart(self) -> bool:
        return any(relation.pushes_apart for relation in self.mechanism.couplings.values())

    @cached_property
    def _quantities(self) -> Mapping[str, Wanted]:
        if self._alike is not None:
            return self._alike.quantities()
        if self.motion.span is None:
            return Catalogue(self._quantities_of, self._coordinates_of)
        # a catalogue holds what it is of: the numbers of a part's rows go with their part
        held = replace(self, motion=self.motion.without_numbers)
        return Catalogue(held._quantities_of, held._coordinates_of)

    @cached_property
    def _elements(self) -> ElementsByName:
        return ElementsByName(self.mechanism)

    @property
    def _orders(self) -> int:
        """How often coordinates and points are differentiated: in a response not for jerks."""
        return len(ORDERS) if self.response is None else len(ORDERS) - 1

    def _coordinates_of(self, name: str) -> Mapping[str, Wanted]:
        """The coordinates of a joint and their rates; none of what is no joint."""
        joint = self.mechanism.joints.get(name)
        if joint is None:
            return {}
        return {one.name: one for one in coordinates_of(joint) if one.order < self._orders}

    def _quantities_of(self, word: str | None, coefficients: bool = True) -> Mapping[str, Wanted]:
        """Those whose names have this first word; None: all. Without `coefficients`: those that are
        no coefficients of others."""
        elements = Elements.of(self.mechanism) if word is None else self._elements(word)
        tied, found = self.tied, self._untied_quantities(elements, coefficients)
        if not tied:
            return found
        return {
            name: known
            for name, known in found.items()
            if known.owner not in tied or known.kind not in _REACTIONS
        }

    def _untied_quantities(self, elements: Elements, coefficients: bool) -> Mapping[str, Wanted]:
        motion = self.motion
        if self.response is not None:
            efforts = self.response.efforts_of
            found = catalogue(elements, efforts, timed=True, held=self.held)
            derived = derived_catalogue(elements, (), None)
            # the rates of forces, and with them jerks, are not known; nor is what steps leave of
            # errors
            found = {
                name: known
                for name, known in found.items()
                if known.order < self._orders and known.kind != "error_bound"
            }
            # efforts are given here, and linear in nothing
            linear = self._linear(found)
            linear = {name: known for name, known in linear.items() if known.kind != "effort"}
            moving = [*self.response.independent, *self.response.driven_at]
            if moving and coefficients:
                found |= coefficient_catalogue(linear, moving, moving[0])
            own = response_quantities()
            if self.response.search is not None:
                own = self.response.resting
            found |= own | bearing_catalogue(elements, efforts)
            return found | {n: known for n, known in derived.items() if known.order < self._orders}
        leading = motion.leading and (motion.leading.joint, motion.leading.coordinate)
        found = catalogue(elements, self.acting, timed=motion.time is not None, held=self.held)
        if leading is not None and coefficients:
            found |= coefficient_catalogue(self._linear(found), motion.driven, leading)
        if motion.time is not None and leading is not None:
            found |= ledger_catalogue()
        found |= bearing_catalogue(elements)
        return found | derived_catalogue(elements, motion.driven, leading)


def _as_coupling(tied: DrivenInput, leader: DrivenInput) -> str:
    """What to write in place of a tie between two inputs."""
    slides = [one.joint for one in (leader, tied) if not is_angle(one.coordinate)]
    turns = [one.joint for one in (leader, tied) if is_angle(one.coordinate)]
    terms = f"type: linear, terms: {{{leader.name}: ..., {tied.name}: ...}}"
    form, along = terms, ""
    if turns:
        form = f"type: gear, joints: [{', '.join(turns)}], teeth: [..., ...]"
        if slides:
            form = f"type: rack, joints: [{turns[0]}, {slides[0]}], radius: ..."
        along = f" (or, for moments and forces along the coordinates alone, {{{terms}}})"
    return f"take {tied.name} out of inputs: and write couplings: {{K: {{{form}}}}}{along}"


# Loads that vary: laws of coordinates, rates and time.
#
# The kernel evaluates them row by row before the forces (`plan/programs.py`); here is what
# they are over rows of numbers.
#
# A law is an expression of quantities that are known without forces, or a table's curve over one of
# them. Where a law has no value (a row outside its table, a root of a negative number) the row
# keeps its position and rates; what depends on the load has no value either.

Resolve = Callable[[str], Quantity]


class Laws(NamedTuple):
    """The laws of the loads that vary, and what the names in them stand for; `watched` are values
    that a motion is watched for beside them."""

    laws: tuple[LoadLaw, ...]
    parameters: Mapping[str, Quantity]
    quantities: Mapping[str, Wanted]
    watched: tuple[LoadLaw, ...] = ()


def quantities_read(problem: Problem) -> list[str]:
    """Names of the quantities that the laws of a problem depend on."""
    return list(dict.fromkeys(name for law in problem.load_laws for name in law.reads))


def law_value(law: LoadLaw, resolve: Resolve, rows: int) -> Floats:
    """The value of a law (rows,) in SI, nan where it has none.

    Args:
        law: an expression or a curve.
        resolve: the quantity of a name over the rows, in SI.
        rows: how many there are.
    """
    if law.curve is not None:
        x = np.broadcast_to(np.asarray(resolve(law.reads[0]).value, dtype=np.float64), (rows,))
        slack = TABLE_END * (law.curve.last - law.curve.first)
        inside = (x >= law.curve.first - slack) & (x <= law.curve.last + slack)
        clipped = np.clip(x, law.curve.first, law.curve.last)
        return np.where(inside, law.curve.evaluate(clipped)[0], np.nan)
    assert law.expression is not None
    quantity = law.expression.evaluate(resolve, through_infinity=True)
    found = np.asarray(quantity.value, dtype=np.float64)
    inside = np.broadcast_to(np.abs(found) <= LARGEST_NUMBER, (rows,))
    return np.where(inside, found, np.nan)


def undefined_laws(problem: Problem, resolve: Resolve, lost: Bools) -> list[RowNote]:
    """What to say of rows in which a law has no value.

    Args:
        problem: its laws, and the units of messages.
        resolve: the quantity of a name over the rows, in SI.
        lost: the rows (rows,) to look at.
    """
    notes = []
    for law in problem.load_laws:
        rows = lost & np.isnan(law_value(law, resolve, lost.size))
        if rows.any():
            dimension = None if law.curve is None else resolve(law.reads[0]).dimension
            words = partial(_undefined_law, law, problem.units, dimension)
            at = partial(_read_by_law, law, resolve, problem.units)
            notes.append(RowNote("load-undefined", "error", law.place, rows, words, told=at))
    return notes


def _undefined_law(
    law: LoadLaw, units: UnitSystem, dimension: Dimension | None, found: Found
) -> Diagnostic:
    if law.curve is not None and dimension is not None:
        low, high = (units.text(x, dimension) for x in (law.curve.first, law.curve.last))
        words, limit = "lies outside its table", f"{low} to {high}"
        hint = "extend the table, or keep the motion within it"
    else:
        words, limit = "has no finite value", None
        hint = "write an expression that holds in all rows, or move the rows"
    rows = found.rows
    first = f"row {rows.first}"
    where = first if rows.size == 1 else f"{rows.size} rows, first in {first}"
    text = f"this load {words} in {where}; cells that depend on it stay empty"
    at = found.told or first
    return Diagnostic("load-undefined", "error", text, law.place, at, limit, hint)


def _read_by_law(law: LoadLaw, resolve: Resolve, units: UnitSystem, row: int) -> str:
    """`O1.theta = 90 deg, time = 1 s`: what a law reads in a row; vectors are left out."""
    words = []
    for name in law.reads:
        value, dimension = resolve(name).value, resolve(name).dimension
        if isinstance(value, float | np.ndarray):
            at_row = np.ravel(value)[row if np.size(value) > 1 else 0]
            words.append(f"{name} = {units.text(float(at_row), dimension)}")
    return ", ".join(words)


_POSITIONS = "it is taken of coordinates, positions of points, directions and parameters"


def differentiation(problem: Problem) -> Differentiate:
    """How derivatives by the inputs of a problem are taken."""

    def differentiate(nodes: tuple[Node, ...], by: Name, offset: int) -> tuple[Node, ...]:
        # loaded only where a derivative is written
        from mechkin_cli.expressions import differentiated

        influence = _Influence(problem, by)
        return differentiated(nodes, influence.rate, influence.unit, offset, influence.sample)

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
        if text not in self.known and text.endswith((".x", ".y", ".z")):
            text, _, axis = text.rpartition(".")
        wanted = self.known.get(text)
        if wanted is None:
            return None  # what is not known is told when the expression is evaluated
        component = (OperationNode(f".{axis}", 1, name.offset),) if axis else ()
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
            bare = (*parse_nodes("1 rad"), OperationNode("/", 2, name.offset))
            cross = OperationNode("cross", 2, name.offset)
            return (*turning, *bare, Name(text, name.offset), cross, *component)
        hint = _POSITIONS
        if wanted.kind == "joint_point":
            hint = f"name the place in points: and write its position; {_POSITIONS}"
        raise ExpressionError(f"{text} has no derivative by an input", name.offset, hint)

    def sample(self, name: str) -> Quantity:
        """One row of a name, of its dimension.

        Raises:
            UnknownName: nothing has this name.
        """
        if name in self.problem.parameters:
            return Quantity(np.ones(1), self.problem.parameters[name].dimension)
        if name not in self.known:
            raise UnknownName(name)
        wanted = self.known[name]
        return Quantity(wanted.value([np.ones(1)] * 3), wanted.dimension)

    def _of_coordinate(self, text: str, name: Name) -> tuple[Node, ...] | None:
        if text in self.inputs:
            one = NumberNode(1.0, None, "1", name.offset)
            return (one,) if text == self.input else None
        return self._per(f"{text}_ddot", name)

    def _per(self, acceleration: str, name: Name) -> tuple[Node, ...]:
        leading = self.problem.motion.leading
        found = f"{acceleration}.per.{self.input}_ddot"
        if found not in self.known and leading is not None and leading.name == self.input:
            found = f"{acceleration}.per_acceleration"
        if found not in self.known:
            text = f"{name.text} has no derivative by {self.input}"
            raise ExpressionError(text, name.offset, _POSITIONS)
        return (Name(found, name.offset, whole=True),)


def response_problem(
    problem: Problem, response: ResponseProblem, motion: MotionInputs | None = None
) -> Problem:
    """The problem at the first moment of a response, with its loads, laws and quantities.

    Its motion, or the `motion` that is given, has one row, in which the start's coordinates are
    inputs; a solver graph of its `driven` is that of the assembly at the start.
    """
    from mechkin_cli.mechanism.response import first_motion  # only for responses

    return replace(
        problem,
        mechanism=response.mechanism,
        motion=first_motion(response, problem.units) if motion is None else motion,
        assembly=response.assembly,
        load_laws=response.load_laws,
        held=response.held,
        follow=None,
        response=response,
    )


def read_by(balances: Iterable[AnyBalance], problem: Problem) -> list[str]:
    """Names of the quantities that balances read at once."""
    from mechkin_cli.mechanism.response import Harmonics  # only for balances

    found: list[str] = []
    for balance in balances:
        if isinstance(balance, Harmonics):
            known = problem.quantities()
            for _, expression in balance.of:
                names = sorted(expression.names)
                found += [n if n in known else n.rpartition(".")[0] for n in names]
        else:
            found += [f"{joint}.{coordinate}.effort" for joint, coordinate in problem.acting]
    return [name for name in dict.fromkeys(found) if name in problem.quantities()]
