"""Texts of the file to numbers in SI, with errors at their places: parameters, coordinates, points,
units.

A point's name stands for the place where the point is drawn. A place that is fixed in a link, such
as a mass centre or the point of a force, moves with that link, so it can only be named by a point
of that link; the halves of a joint may meet at any place of the drawing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from mechkin_cli.building.datum import Datum
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Number, nearest_hint
from mechkin_cli.expressions import (
    Definitions,
    ExpressionError,
    Move,
    Quantity,
    Vector as Components,
    constant,
    constant_in_file_units,
    evaluate_parameters,
    literal,
    lookup,
    number_of,
    parse,
)
from mechkin_cli.mechanism import (
    GROUND_NAME,
    ZERO,
    Attached,
    Joint,
    Moments,
    Vector,
    pairs as joint_table,
    told_coordinates,
    unit,
)
from mechkin_cli.reading import CORRECT_FIRST, MOST_DIAGNOSTICS, Document, in_order
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.schema import MechanismFile, UnitsSection
from mechkin_cli.tape import is_number
from mechkin_cli.tolerances import LARGEST_NUMBER, SMALLEST_SIZE
from mechkin_cli.units import (
    DIMENSIONLESS,
    FIELDS,
    FORCE,
    LENGTH,
    MOMENT,
    TIME,
    Dimension,
    UnitError,
    UnitSystem,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats

Path = tuple[str | int, ...]


def is_tiny_length(in_si: object, dimension: Dimension) -> bool:
    """Whether a value is a length (m) that is not zero, but too small to divide by.

    Recorded numbers never are: their values have been judged as doubles.
    """
    if dimension != LENGTH or not isinstance(in_si, float):
        return False
    return 0.0 < abs(in_si) < SMALLEST_SIZE


class AlreadyRefused(ExpressionError):
    """A name whose definition has an error: an expression that uses it gets no message.

    It is the cause of the error that the expression raises.
    """


@dataclass
class Fields:
    """Evaluates fields of one document; errors are collected in `diagnostics`, with zeros as
    values.

    `refused` holds names whose definitions have errors: their uses are not reported again.
    `failed` holds runs whose motion has an error: what is read of them is not judged. `points`
    are the file's named points as drawn, `definitions` its named expressions. `plane`: of a file in
    a plane, whose z the user never sees. `datum`: from which places are measured.
    """

    document: Document
    units: UnitSystem
    parameters: dict[str, Quantity] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    refused: set[str] = field(default_factory=set)
    failed: set[str] = field(default_factory=set)
    points: dict[str, Attached] = field(default_factory=dict)
    definitions: Definitions = field(default_factory=Definitions)
    plane: bool = False
    datum: Datum | None = None

    @property
    def origin(self) -> Vector:
        """The datum of the drawing in the ground's axes, m."""
        return ZERO if self.datum is None else self.datum.at

    def note(self, diagnostic: Diagnostic) -> None:
        """Adds a diagnostic.

        Raises:
            InvalidFile: there are too many errors to go on.
        """
        self.diagnostics.append(diagnostic)
        if len(self.diagnostics) > MOST_DIAGNOSTICS and self.error_count > MOST_DIAGNOSTICS:
            self.diagnostics.pop()
            errors = in_order([d for d in self.diagnostics if d.severity == "error"])
            rest = "the file has more problems than are shown"
            raise InvalidFile([*errors, Diagnostic("more", "note", rest, hint=CORRECT_FIRST)])

    @property
    def error_count(self) -> int:
        """Errors so far."""
        return sum(diagnostic.severity == "error" for diagnostic in self.diagnostics)

    def is_refused(self, name: str) -> bool:
        """Whether the definition of a dotted name, or of its owner, has an error."""
        return name in self.refused or name.partition(".")[0] in self.refused

    def resolve(self, name: str) -> Quantity:
        """The parameter of a name.

        Raises:
            UnknownName: there is none.
            AlreadyRefused: its definition has an error.
        """
        if self.is_refused(name):
            raise AlreadyRefused(name)
        return lookup(self.parameters)(name)

    def error(
        self,
        code: str,
        path: Path,
        message: str,
        hint: str | None = None,
        *,
        numbers: tuple[Number, ...] = (),
        **more: str,
    ) -> None:
        """Notes an error at a value of the file."""
        place = self.document.place(path)
        self.note(Diagnostic(code, "error", message, place, hint=hint, numbers=numbers, **more))

    def key_error(self, code: str, path: Path, message: str, hint: str | None = None) -> None:
        """Notes an error at a key of the file."""
        place = self.document.key_place(path)
        self.note(Diagnostic(code, "error", message, place, hint=hint))

    def expression_error(self, path: Path, error: ExpressionError) -> None:
        """Notes an error inside an expression."""
        if isinstance(error.__cause__, AlreadyRefused):
            return
        place = self.document.place_in(path, error.offset)
        self.note(Diagnostic("expression", "error", error.message, place, hint=error.hint))

    def number(self, path: Path, text: str, dimension: Dimension) -> float:
        """The SI value of a scalar field; a bare number takes the field's unit."""
        try:
            value = constant(text, dimension, self.units, self.resolve)
            return self._bounded(path, value, value, dimension)
        except ExpressionError as error:
            if not self._blames_parameters(text, dimension):
                self.expression_error(path, error)
            return 0.0

    def written(self, path: Path, text: str, dimension: Dimension) -> float:
        """The value of a scalar field in the file's units, a bare number exactly as written."""
        try:
            value = constant_in_file_units(text, dimension, self.units, self.resolve)
            return self._bounded(path, value, self.units.to_si(value, dimension), dimension)
        except ExpressionError as error:
            self.expression_error(path, error)
            return 0.0

    def _blames_parameters(self, text: str, dimension: Dimension) -> bool:
        """Whether a text is wrong only because parameters in it were written without their unit:
        each is refused once, where it is written, and its other uses get no message."""
        try:
            names = sorted(parse(text).names & self.parameters.keys())
        except ExpressionError:
            return False
        written = self.document.data.get("parameters")
        texts = written if isinstance(written, dict) else {}
        bare = [name for name in names if literal(str(texts.get(name, ""))) is not None]
        if not bare or dimension == DIMENSIONLESS:
            return False

        def with_unit(name: str) -> Quantity:
            quantity = self.resolve(name)
            return replace(quantity, dimension=dimension) if name in bare else quantity

        try:
            constant(text, dimension, self.units, with_unit)
        except ExpressionError:
            return False
        for name in bare:
            message = f"{name} is used as {dimension.phrase} and has no unit"
            hint = f"write {str(texts[name]).strip()} {self.units.label(dimension)}"
            self.error("parameter-unit", ("parameters", name), message, hint)
            self.refused.add(name)
        return True

    def _bounded(self, path: Path, value: float, in_si: float, dimension: Dimension) -> float:
        """The value, or zero and an error where it cannot be computed with."""
        vanished = isinstance(value, float) and value != 0.0 and in_si == 0.0
        if vanished and dimension != LENGTH:
            hint = "check its exponent and unit, or write 0"
            self.error("too-small", path, "this number is too small: it would be zero", hint)
        elif vanished or is_tiny_length(in_si, dimension):
            self._refuse_size(path, "too-small", "this length is too small", in_si, SMALLEST_SIZE)
        elif abs(value) <= LARGEST_NUMBER:
            return value
        else:
            self._refuse_size(path, "too-large", "this number is too large", value, LARGEST_NUMBER)
        return 0.0

    def _refuse_size(self, path: Path, code: str, what: str, value: float, limit: float) -> None:
        metre = "m" if limit == SMALLEST_SIZE else ""
        self.error(
            code,
            path,
            f"{what} to compute with",
            "check its exponent and unit",
            measured=f"{value:.4g} {metre}".rstrip(),
            limit=f"{limit:g} {metre}".rstrip(),
            numbers=(Number("value", value, metre, limit=limit),),
        )

    def vector(self, path: Path, texts: Sequence[str], dimension: Dimension) -> Vector:
        """The SI value of a field of three scalars."""
        x, y, z = (self.number((*path, i), text, dimension) for i, text in enumerate(texts))
        return (x, y, z)

    def place(self, path: Path, texts: Sequence[str]) -> Vector:
        """A place that is written in the ground's axes, from the drawing's datum, in m."""
        errors = self.error_count
        written = self.vector(path, texts, LENGTH)
        if self.datum is None or self.error_count > errors:
            return written
        x, y, z = map(self.datum.measured, range(3), texts, written)
        return (x, y, z)

    def direction(self, path: Path, texts: Sequence[str]) -> Vector:
        """A direction: three components of one dimension, not all zero; returned as a unit
        vector."""
        values: list[float] = []
        dimensions: list[Dimension] = []
        for i, text in enumerate(texts):
            value, dimension = self.of_any_dimension((*path, i), text)
            values.append(value)
            if literal(text) is None or value != 0.0:
                dimensions.append(dimension)
        if any(d != dimensions[0] for d in dimensions):
            words = " and ".join(dict.fromkeys(d.phrase for d in dimensions))
            self.error("dimension", path, f"components of a direction must be alike, found {words}")
            return (1.0, 0.0, 0.0)
        vector = (values[0], values[1], values[2])
        if vector == ZERO:
            hint = "give a vector with a direction"
            self.error("zero-direction", path, "this direction is zero", hint)
            return (1.0, 0.0, 0.0)
        return unit(vector)

    def of_any_dimension(self, path: Path, text: str) -> tuple[float, Dimension]:
        """The SI value of a scalar field and its dimension; a bare number has none."""
        bare = number_of(text)
        if bare is not None:
            return bare, DIMENSIONLESS
        try:
            quantity = parse(text).evaluate(self.resolve, self.units)
        except ExpressionError as error:
            self.expression_error(path, error)
            return 1.0, DIMENSIONLESS
        if isinstance(quantity.value, Components) or not is_number(quantity.value):
            self.error("expression", path, "expected one number")
            return 1.0, quantity.dimension
        return quantity.value, quantity.dimension


def read_parameters(
    fields: Fields,
    texts: Mapping[str, str],
    given: Mapping[str, Quantity],
    moved: Move | None = None,
) -> None:
    """Evaluates the parameters into `fields`; `given` and `moved` as in `evaluate_parameters`."""
    errors: list[ExpressionError] = []
    fields.parameters.update(evaluate_parameters(texts, fields.units, errors, given, moved))
    for error in errors:
        fields.expression_error(("parameters", error.name or ""), error)
    _check_overrides(fields, texts)
    fields.refused |= texts.keys() - fields.parameters


def _check_overrides(fields: Fields, texts: Mapping[str, str]) -> None:
    """A parameter set from outside keeps the dimension that it has in the file."""
    document = fields.document
    if not document.overrides:
        return
    section = replace(document, overrides={}).data["parameters"]
    assert isinstance(section, dict)
    written = {name: str(section[name]) for name in document.overrides}
    originals = evaluate_parameters({**texts, **written}, fields.units, [])
    for name in document.overrides:
        original, new = originals.get(name), fields.parameters.get(name)
        if original is None or new is None or new.dimension.compatible(original.dimension):
            continue
        phrases = f"{original.dimension.phrase} in the file, this is {new.dimension.phrase}"
        example = f"{texts[name] if literal(texts[name]) else 1}"
        hint = f"write a value such as {example} {fields.units.label(original.dimension)}"
        fields.error("dimension", ("parameters", name), f"{name} is {phrases}", hint.rstrip())
        del fields.parameters[name]


CODE = "unknown-coordinate"


def dimension_of(coordinate: str, order: int = 0) -> Dimension:
    """The dimension of a coordinate, or of its derivative of some order over time."""
    return joint_table.dimension_of(coordinate) / TIME**order


def is_coordinate(
    fields: Fields, path: Path, name: str, joints: Mapping[str, Joint], *, at_key: bool = True
) -> bool:
    """Whether the key (or else the value) at `path` names a coordinate, such as `O2.theta`; if not,
    that is noted."""
    joint, _, coordinate = name.rpartition(".")
    note = fields.key_error if at_key else fields.error
    if joint in joints:
        if coordinate in joints[joint].type.coordinates:
            return True
        note(CODE, path, *without(joints[joint], coordinate))
    elif not fields.is_refused(joint):
        known = told_coordinates(joints.values())
        note(CODE, path, f"{name} is not a coordinate", nearest_hint(name, known))
    return False


def refuse_efforts(fields: Fields, joints: Mapping[str, Joint]) -> None:
    """Refuses the efforts of all joints, which follow from definitions with errors."""
    for joint in joints.values():
        fields.refused.update(f"{name}.effort" for name in (joint.name, *joint.coordinates))


def without(joint: Joint, coordinate: str) -> tuple[str, str]:
    """Message and hint for a joint that lacks a coordinate."""
    have = ", ".join(joint.type.coordinates) or "none"
    message = f"{joint.name} is of type {joint.letter} and has no coordinate {coordinate}"
    return message, f"its coordinates: {have}"


def read_points(fields: Fields, file: MechanismFile) -> dict[str, Attached]:
    """The named points of the file, which are put into `fields`; errors are noted."""
    links = dict.fromkeys([*file.links, *(row.link for row in file.chain)])
    links.pop(GROUND_NAME, None)
    drawn = {
        name: fields.place(("points", name, "at"), point.at)
        for name, point in file.points.items()
        if not isinstance(point.at, str)
    }
    for name in file.points:
        _follow(fields, file, name, drawn)
    for name, point in file.points.items():
        if is_link(fields, ("points", name, "link"), point.link, links) and name in drawn:
            fields.points[name] = Attached(point.link, drawn[name])
    return dict(fields.points)


def place_at(
    fields: Fields, path: Path, place: str | tuple[str, ...], link: str | None = None
) -> Vector:
    """A place in the drawing from its datum, in m; if it is fixed in a `link`, a name must be that
    of a point of the link. Errors are noted, with zero as value."""
    if not isinstance(place, str):
        return fields.place(path, place)
    if place not in fields.points:
        _refuse_unknown(fields, path, place)
        return ZERO
    point = fields.points[place]
    if link is not None and point.link != link:
        text = f"{place} is a point of {point.link}, and this place moves with {link}"
        hint = f"name one of {link}, such as {place}_of_{link}: {{link: {link}, at: {place}}}"
        fields.error("point-of-another-link", path, text, hint)
    return point.vector


def is_link(fields: Fields, path: tuple[str, ...], name: str, links: Iterable[str]) -> bool:
    """Whether a link exists; if not, that is noted once, at the path of its name."""
    if name == GROUND_NAME or name in links:
        return True
    fields.refused.add(path[1])
    hint = nearest_hint(name, [GROUND_NAME, *links])
    fields.error("unknown-link", path, f"there is no link {name}", hint)
    return False


def _follow(fields: Fields, file: MechanismFile, name: str, drawn: dict[str, Vector]) -> None:
    """Puts a point, and those it passes, at the place of the point that its `at` leads to."""
    passed: list[str] = []
    while name not in drawn and name in file.points and name not in fields.refused:
        if name in passed:
            circle = " -> ".join([*passed[passed.index(name) :], name])
            text = f"the place of {name} leads back to itself: {circle}"
            fields.error("circular-place", ("points", name, "at"), text, "write coordinates here")
            fields.refused.update(passed)
            return
        passed.append(name)
        at = file.points[name].at
        assert isinstance(at, str)
        name = at
    if name in drawn:
        drawn.update(dict.fromkeys(passed, drawn[name]))
    elif passed:
        _refuse_unknown(fields, ("points", passed[-1], "at"), name)
        fields.refused.update(passed)


def _refuse_unknown(fields: Fields, path: Path, name: str) -> None:
    if fields.is_refused(name):
        return
    sections = (fields.document.data.get(key) for key in ("points", "joints"))
    points, joints = (section if isinstance(section, dict) else {} for section in sections)
    hint = f"{name} is a joint: name its point under points" if name in joints else None
    hint = hint or nearest_hint(name, list(points)) or "name it under points"
    fields.error("unknown-point", path, f"there is no point {name}", hint)


def read_units(document: Document, section: UnitsSection) -> tuple[UnitSystem, list[Diagnostic]]:
    """The file's unit system, and its errors."""
    try:
        return UnitSystem.from_mapping({name: getattr(section, name) for name in FIELDS}), []
    except UnitError as error:
        path: Path = ("units", error.key) if error.key else ("units",)
        place = document.place_in(path, error.offset)
        return UnitSystem(), [Diagnostic("unit", "error", error.message, place, hint=error.hint)]


def note_force_unit(fields: Fields) -> None:
    """Notes the unit of forces, where the file has none and its mass, length and time would make
    another."""
    document, units = fields.document, fields.units
    named = document.node(("units", "force")) is not None
    if fields.error_count or named or document.node(("units",)) is None:
        return
    coherent = units.mass * units.length * units.time**-2
    if coherent.factor == units.force.factor:
        return
    forces, moments = units.label(FORCE), units.label(MOMENT)
    text = f"units: names no force, so forces are in {forces} and moments in {moments}"
    hint = f"write force: {forces} to say so, or another, such as force: {coherent}"
    place = document.key_place(("units",))
    fields.note(Diagnostic("force-unit", "note", text, place, hint=hint))


class Clock(NamedTuple):
    """The moments of the rows, and `from` and `to` of `time` in the file's units; how many rows the
    run has, and the `numbers` of those that are meant, None: all; of very many, what gives the
    moments of all next to others."""

    time: Moments
    first: float
    last: float
    run_rows: int
    numbers: NDArray[np.int64] | None = None
    beside: Callable[[Floats], tuple[Floats, Floats]] | None = None
