"""`motion:` to values, rates, accelerations and jerks of the inputs over the rows, and the
guides of points whose coordinates are inputs.

A point is guided by a slide that no drawing has: it runs along those axes of the ground and carries
a ball on a plane, in a groove or in a socket, in a plane a pin in a slot or in a hole, whose centre
is the point: one equation for each coordinate and no unknown more. Its coordinates are those of the
point; in the drawing they are not zero.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from math import prod
from typing import TYPE_CHECKING, cast

import numpy as np

from mechkin_cli.building.fields import (
    Clock,
    Fields,
    Path,
    dimension_of,
    is_coordinate,
    refuse_efforts,
)
from mechkin_cli.building.joints import Halves, parts_of
from mechkin_cli.building.limits import refuse_too_large
from mechkin_cli.building.rest import resting
from mechkin_cli.building.spacing import (
    Spacing,
    fit_lines,
    has_too_many_rows,
    is_long,
    sampled,
    spacing,
)
from mechkin_cli.diagnostics import InvalidFile, nearest_hint
from mechkin_cli.expressions import Expression
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    Attached,
    DrivenInput,
    Frame,
    InputConstraint,
    Joint,
    Moments,
    MotionInputs,
    Part,
    RigidLink,
    SpacedMoments,
    Span,
    Vector,
    frame_about,
    guide_letter,
    joint_type,
    long_motion,
    perpendicular,
    scale,
    seat_letter,
    told_coordinates,
    upright,
)
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.schema import (
    FollowingInput,
    HeldCoordinate,
    HeldInput,
    InputMotion,
    ListedInput,
    MotionSection,
    SweptInput,
    TimeSection,
    WithRates,
)
from mechkin_cli.tape import differ, of_numbers, with_rates
from mechkin_cli.tolerances import (
    LARGEST_NUMBER,
    LONG_RUN,
    MOST_NUMBERS,
)
from mechkin_cli.units import TIME
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats
    from mechkin_cli.units import UnitSystem

_RATES = ("rate", "acceleration", "jerk")


def build_motion(
    fields: Fields, section: MotionSection | None, joints: Mapping[str, Joint], per_row: int
) -> MotionInputs:
    """Inputs with their values; without inputs the motion has one row, or those of `time`."""
    if section is None:
        return MotionInputs((), 1)
    errors = fields.error_count
    motion = _swept(fields, section, joints, per_row, None)
    if motion is not None and fields.error_count == errors:
        if motion.span is None:
            return motion
        if motion.rest is not None:
            return _whole_at_rest(fields, section, joints, per_row, motion.span.run_rows)
        if motion.grid is not None and not fit_lines(fields, motion.grid, per_row):
            return MotionInputs((), 1)
        rows, build = sampled(motion.span.run_rows), _rows_of(fields, section, joints)
        return long_motion(motion._replace(span=None), rows, build, MOST_NUMBERS // per_row)
    fields.failed.add(SWEEP)
    fields.refused.add("time")
    refuse_efforts(fields, joints)
    return MotionInputs((), 1)


def _whole_at_rest(
    fields: Fields,
    section: MotionSection,
    joints: Mapping[str, Joint],
    per_row: int,
    rows: int,
) -> MotionInputs:
    """A motion of many rows with coordinates at rest: where these are is found for all rows."""
    most = MOST_NUMBERS // per_row
    if rows <= most:
        motion = _swept(fields, section, joints, per_row, np.arange(rows))
        assert motion is not None
        return motion._replace(span=None)
    text = "a sweep at rest is held whole, and has too many rows for that"
    fields.error(
        "too-many-rows", ("motion", "rest"), f"{text}: {rows} (limit {most})", "take fewer"
    )
    fields.failed.add(SWEEP)
    return MotionInputs((), 1)


def _swept(
    fields: Fields,
    section: MotionSection,
    joints: Mapping[str, Joint],
    per_row: int | None,
    rows: NDArray[np.int64] | None,
    known: _Sections | None = None,
) -> MotionInputs | None:
    """The motion in some rows, by their numbers; None: in all, or in a sample of very many. None
    where an error was noted."""
    grid = section.with_rows if section.grid else ()
    clock, path = None, ("motion", "time")
    if section.time is not None:
        clock = spaced_moments(fields, path, section.time, per_row, in_parts=True, rows=rows)
    path = ("motion", "inputs")
    inputs = section.inputs
    motion = build_inputs(
        fields, path, inputs, joints, per_row, clock, grid, rows=rows, known=known
    )
    return (
        motion if motion is None or not section.rest else resting(fields, section, motion, joints)
    )


def _rows_of(
    fields: Fields, section: MotionSection, joints: Mapping[str, Joint]
) -> Callable[[NDArray[np.int64]], MotionInputs]:
    """What builds the motion in some rows, by their numbers; it raises InvalidFile where what the
    file says does not hold there. Numbers that go by no moments are read once for all parts."""
    path = ("motion", "inputs")
    known: list[_Sections] = []
    before: tuple[MotionInputs, ...] = ()

    def build(rows: NDArray[np.int64]) -> MotionInputs:
        nonlocal before
        own = replace(fields, diagnostics=[], refused=set(fields.refused))
        if section.time is None and not known:
            known.append(_read(own, path, section.inputs, joints, None))
        motion = next((each for each in before if each.rows == rows.size), None)
        if motion is not None:
            motion = _moved_on(own, joints, motion, rows, known[0][0])
        else:
            motion = _swept(own, section, joints, None, rows, known[0] if known else None)
        if motion is None or own.error_count:
            raise InvalidFile([one for one in own.diagnostics if one.severity == "error"])
        if known and not (known[0][1] or section.rest or section.grid):
            # rows of what is spaced, where nothing follows it, differ in values alone
            are_spaced = all(one.rows == 1 or one.spaced for one in known[0][0].values())
            before = (motion,) if are_spaced else ()
        return motion

    return build


def _moved_on(
    fields: Fields,
    joints: Mapping[str, Joint],
    motion: MotionInputs,
    rows: NDArray[np.int64],
    read: Mapping[str, _Read],
) -> MotionInputs:
    """A motion in as many other rows: what is spaced has other values, and all rates stay."""
    inputs = []
    for item in motion.inputs:
        spaced = read[item.name].spaced
        if spaced is not None:
            orders = item.written_orders.copy()
            orders[0] = spaced.values(rows)
            values = _in_si(fields, item.coordinate, 0, orders)
            refuse_too_large(fields, joints, ("motion", "inputs", item.name), orders[0], [values])
            item = item._replace(values=values, written_orders=orders)
        inputs.append(item)
    assert motion.span is not None
    span = motion.span._replace(first=int(rows[0]))
    return motion._replace(inputs=tuple(inputs), span=span)


def build_inputs(
    fields: Fields,
    path: Path,
    sections: Mapping[str, InputMotion | HeldCoordinate],
    joints: Mapping[str, Joint],
    per_row: int | None,
    clock: Clock | None = None,
    pair: tuple[str, ...] = (),
    *,
    rows: NDArray[np.int64] | None = None,
    known: _Sections | None = None,
    between: bool = True,
) -> MotionInputs | None:
    """Driven coordinates over the rows and between them; None where an error was noted.

    Args:
        fields: of the file, with units and parameters.
        path: of the section with the driven coordinates.
        sections: the coordinates as written.
        joints: by name.
        per_row: numbers that a row takes.
        clock: of their laws, where the rows are moments.
        pair: the two inputs of a grid, the slow one first.
        rows: the numbers of those that are wanted, which rise; None: all, or of the sweep a sample
            of very many.
        known: what the sections say, where they have been read.
        between: whether the course between the rows is wanted.
    """
    errors = fields.error_count
    time = None if clock is None else clock.time
    with np.errstate(all="ignore"):
        read, following = known or _read(fields, path, sections, joints, clock)
    run_rows = clock.run_rows if clock else _row_count(fields, pair, read)
    if fields.error_count > errors:
        return None
    if rows is None and clock is not None:
        rows = clock.numbers
    elif rows is None and is_long(run_rows, per_row):
        if has_too_many_rows(fields, path, run_rows, None):
            return None
        rows = sampled(run_rows)
    if rows is None and has_too_many_rows(fields, path, run_rows, per_row):
        return None
    grid: tuple[int, int] | None
    if pair and rows is not None:
        orders, grid = _some_pairs(read, pair, rows)
    else:
        orders = {name: one.at(rows) for name, one in read.items()}
        grid = _all_pairs(orders, pair)
    count = run_rows if rows is None else rows.size
    span = None if rows is None else Span(int(rows[0]), count, run_rows)
    expressions: dict[str, Expression] = {}
    constraint_rates: dict[tuple[str, str], Floats] = {}
    if following:
        from mechkin_cli.building.laws import Following

        coordinates = frozenset(told_coordinates(joints.values()))
        followers = Following(fields, orders, count, time, path, rows)
        followers.add_all(following, coordinates)
        expressions = followers.expressions
        if fields.error_count == errors:
            constraint_rates = followers.constraint_rates()
    if fields.error_count > errors:
        return None
    inputs = tuple(
        _driven(
            fields, joints, (*path, name), np.broadcast_to(column, (4, count)), name in following
        )
        for name, column in ((name, orders[name]) for name in sections if name in orders)
    )
    if fields.error_count > errors:
        return None
    unrated = () if time else _unrated(fields, path, inputs)
    motion = MotionInputs(inputs, count, time, unrated=unrated, grid=grid, span=span)
    if constraint_rates:
        number = {item.name: k for k, item in enumerate(inputs)}
        pairs = [(number[name], number[leader]) for name, leader in constraint_rates]
        motion = motion._replace(
            constraints=tuple(InputConstraint(*pair) for pair in pairs),
            constraint_rates=np.array(list(constraint_rates.values())),
        )
    if not between or not inputs or (time is None and not expressions):
        return motion
    from mechkin_cli.building.laws import build_course, build_paths

    course = build_course(fields, path, sections, inputs, expressions, clock, grid=bool(pair))
    paths = build_paths(fields, inputs, expressions, time) if expressions else motion.paths
    return motion._replace(course=course, paths=paths)


def spaced_moments(
    fields: Fields,
    path: Path,
    section: TimeSection,
    per_row: int | None,
    *,
    in_parts: bool = False,
    rows: NDArray[np.int64] | None = None,
    held: bool = True,
) -> Clock:
    """The moments of a section, which run forwards; errors are noted, with one moment.

    Args:
        fields: of the file.
        path: of the section.
        section: as written.
        per_row: numbers that a row takes.
        in_parts: whether the rows may be made part by part, where they are many.
        rows: the numbers of those that are wanted; None: all, or a sample of many.
        held: whether the moments of very many rows are held, too; else they are made as they are
            wanted.
    """
    errors = fields.error_count
    found = spacing(fields, path, section, TIME, None if in_parts or not held else per_row)
    if rows is None and in_parts and is_long(found.rows, per_row):
        rows = sampled(found.rows)
    is_made = not held and found.rows > LONG_RUN
    if is_made:
        rows = np.array([0, found.rows - 1])
    written = found.values(rows)
    last = found.first
    if fields.error_count == errors:
        last = fields.written((*path, "to"), section.last, TIME)
    rise = float(found.values(np.array([found.rows - 1]))[0]) - found.first
    if rise < 0.0:
        fields.error("time-backwards", path, "time runs backwards", "exchange from and to")
    elif found.rows > 1 and rise * LARGEST_NUMBER <= 1.0:
        text = f"time stands still over {found.rows} rows"
        fields.error("zero-step", (*path, "to"), text, "give a later moment, or count: 1")
        written, found, rows, is_made = written[:1], found._replace(rows=1), None, False
    if is_made:
        made = _made_as_wanted(fields.units, found)
        return Clock(made, found.first, last, found.rows)
    moments = Moments(fields.units.to_si(written.copy(), TIME), written)
    return Clock(moments, found.first, last, found.rows, rows)


def _made_as_wanted(units: UnitSystem, found: Spacing) -> Moments:
    """The moments of a spacing, of which none is held."""
    steps, in_si = found.steps, units.conversion(TIME)
    of_kernel = _kernel.SpacedTimes(*steps, float(in_si.multiplier), in_si.divisor)
    return cast("Moments", SpacedMoments(found.rows, steps.at, in_si.apply, of_kernel))


class _Read(NamedTuple):
    """An input as written: value, rate, acceleration and jerk (4, rows) in the file's units, in one
    row where it stands still or is `spaced`; `timed` in the rows of a clock."""

    orders: Floats
    spaced: Spacing | None = None
    timed: bool = False

    @property
    def rows(self) -> int:
        """How many there are; 1 of an input that stands still."""
        return self.orders.shape[1] if self.spaced is None else self.spaced.rows

    def at(self, rows: NDArray[np.int64] | None) -> Floats:
        """The numbers in some rows (4, rows); None: in all."""
        if self.rows == 1 or self.timed:
            return self.orders
        if self.spaced is not None:
            return with_rates(self.spaced.values(rows), self.orders[1:, 0])
        return self.orders if rows is None else self.orders[:, rows]


_Sections = tuple[dict[str, _Read], dict[str, "FollowingInput"]]


def _read(
    fields: Fields,
    path: Path,
    sections: Mapping[str, InputMotion | HeldCoordinate],
    joints: Mapping[str, Joint],
    clock: Clock | None,
) -> _Sections:
    """The inputs that follow none, and the sections of those that follow."""
    orders: dict[str, _Read] = {}
    following: dict[str, FollowingInput] = {}
    for name, item in sections.items():
        own = (*path, name)
        if not is_coordinate(fields, own, name, joints) or _driven_twice(fields, own, joints):
            continue
        coordinate = name.rpartition(".")[2]
        if isinstance(item, FollowingInput):
            following[name] = item
        elif isinstance(item, HeldCoordinate):
            at = fields.written((*own, "at"), item.at, dimension_of(coordinate))
            orders[name] = _Read(with_rates(of_numbers([at]), [0.0, 0.0, 0.0]))
        elif isinstance(item, (SweptInput, ListedInput, HeldInput)):
            values = _values(fields, own, item, coordinate)
            rates = _constant_rates(fields, own, item, coordinate, timed=clock is not None)
            if isinstance(values, Spacing):
                orders[name] = _Read(with_rates(of_numbers([values.first]), rates), values)
            else:
                orders[name] = _Read(with_rates(values, rates))
        else:
            from mechkin_cli.building.laws import law_values

            assert clock is not None  # the schema refuses a law without time
            found = law_values(fields, own, item, coordinate, clock)
            orders[name] = _Read(found, timed=True)
    return orders, following


def _constant_rates(
    fields: Fields, path: Path, item: WithRates, coordinate: str, *, timed: bool
) -> list[float]:
    rates = []
    for order, key in enumerate(_RATES, start=1):
        dimension = dimension_of(coordinate, order)
        rates.append(fields.written((*path, key), getattr(item, key), dimension))
        if timed and rates[-1] != 0.0:
            text = "an input that is held while time runs has no rate"
            hint = "write law: constant-rate, or another law"
            fields.key_error("held-rate", (*path, key), text, hint)
    return rates


def _driven_twice(fields: Fields, path: Path, joints: Mapping[str, Joint]) -> bool:
    """Whether the key at `path` is the s of a helical joint whose theta is an input as well."""
    name = str(path[-1])
    joint = joints[name.rpartition(".")[0]]
    turn = f"{joint.name}.theta"
    twice = (
        joint.type.coordinate[name.rpartition(".")[2]].on_thread
        and fields.document.node((*path[:-1], turn)) is not None
    )
    if twice:
        text = f"{turn} and {name} are one freedom"
        fields.key_error("driven-twice", path, text, "drive one of them")
    return twice


def _values(
    fields: Fields,
    path: Path,
    item: SweptInput | ListedInput | HeldInput,
    coordinate: str,
) -> Floats | Spacing:
    dimension = dimension_of(coordinate)
    if isinstance(item, HeldInput):
        return of_numbers([fields.written((*path, "at"), item.at, dimension)])
    if isinstance(item, ListedInput):
        texts = enumerate(item.values)
        return of_numbers(fields.written((*path, "values", i), t, dimension) for i, t in texts)
    return spacing(fields, path, item, dimension, None)


def _all_pairs(orders: dict[str, Floats], grid: Sequence[str]) -> tuple[int, int] | None:
    """Spreads the values of the two inputs of a grid over its rows; how many values each has."""
    if not grid:
        return None
    slow, fast = grid
    shape = orders[slow].shape[1], orders[fast].shape[1]
    orders[slow] = np.repeat(orders[slow], shape[1], axis=1)
    orders[fast] = np.tile(orders[fast], (1, shape[0]))
    return shape


def _some_pairs(
    read: Mapping[str, _Read], grid: Sequence[str], rows: NDArray[np.int64]
) -> tuple[dict[str, Floats], tuple[int, int]]:
    """The values of inputs in some rows of a grid; how many values each of its two has."""
    slow, fast = grid
    width = read[fast].rows
    places = {slow: rows // width, fast: rows % width}
    orders = {name: one.at(places.get(name, rows)) for name, one in read.items()}
    counted = {name: np.broadcast_to(orders[name], (4, rows.size)) for name in grid}
    return orders | counted, (read[slow].rows, width)


def _row_count(fields: Fields, grid: Sequence[str], columns: Mapping[str, _Read]) -> int:
    if grid:
        return prod(columns[name].rows for name in grid if name in columns)
    lengths = {name: read.rows for name, read in columns.items() if read.rows > 1}
    if len(set(lengths.values())) > 1:
        text = "inputs that run together need equally many rows"
        hint = "use the same number of values, or hold an input with at:"
        measured = ", ".join(f"{name} {n}" for name, n in lengths.items())
        fields.error("row-counts", ("motion", "inputs"), text, hint, measured=measured)
    return max(lengths.values(), default=1)


def _driven(
    fields: Fields, joints: Mapping[str, Joint], path: Path, orders: Floats, follows: bool
) -> DrivenInput:
    """The input of the key at `path`, in SI and as written; numbers too large to compute with are
    noted. `orders` (4, rows)."""
    joint, _, coordinate = str(path[-1]).rpartition(".")
    written = orders.copy()
    in_si = [_in_si(fields, coordinate, k, written) for k in range(4)]
    refuse_too_large(fields, joints, path, written[0], in_si)
    value, rate, acceleration, jerk = in_si
    return DrivenInput(joint, coordinate, value, rate, acceleration, jerk, written, follows)


def _in_si(fields: Fields, coordinate: str, order: int, written: Floats) -> Floats:
    """The numbers of an order (rows,), of those as written (4, rows)."""
    values = np.asarray(fields.units.to_si(written[order], dimension_of(coordinate, order)))
    return values.copy() if np.may_share_memory(values, written) else values


def _unrated(fields: Fields, path: Path, inputs: Sequence[DrivenInput]) -> tuple[str, ...]:
    """The inputs that rest only since no rate is written: those that move over the rows, or all
    where none does and none has a rate."""
    leading = [item for item in inputs if not item.follows]
    keys = {i.name: [fields.document.node((*path, i.name, key)) for key in _RATES] for i in leading}
    silent = {name for name, nodes in keys.items() if all(node is None for node in nodes)}
    moving = [item.name for item in leading if differ(item.values)]
    if moving:
        return tuple(name for name in moving if name in silent)
    return tuple(keys) if len(silent) == len(keys) else ()


_POSITION = re.compile(r"(?P<point>\w+)\.position\.(?P<axis>[xyz])")


def point_guides(
    fields: Fields, section: MotionSection | None, points: Mapping[str, Attached]
) -> tuple[dict[str, RigidLink], dict[str, Joint]]:
    """Links and joints that guide the points whose coordinates are inputs, by name; errors are
    noted in `fields`."""
    guided: dict[str, str] = {}
    for name in section.inputs if section is not None else ():
        match = _POSITION.fullmatch(name)
        if match and fields.plane and _leaves_plane(fields, name, match["axis"]):
            continue
        if match and _is_moving_point(fields, ("motion", "inputs", name), match["point"], points):
            guided[match["point"]] = guided.get(match["point"], "") + match["axis"]
    links, joints = {}, {}
    for name, letters in guided.items():
        axes, at, guide = "".join(sorted(letters)), points[name], f"{name}.position"
        links[guide] = RigidLink(guide)
        slide, place = joint_type(guide_letter(axes)), upright(at.vector)
        parts = tuple(_slide_part(axis, at.vector, fields.origin) for axis in axes)
        joints[guide] = Joint(guide, slide.letter, GROUND_NAME, guide, place, place, parts)
        held = f"{guide} of {at.link}"
        hold = _held_pin if fields.plane else _held_ball
        joints[held] = hold(held, at, guide, axes)
    return links, joints


def _leaves_plane(fields: Fields, name: str, axis: str) -> bool:
    if axis in "xy":
        return False
    text = f"{name} is not free in a plane file"
    fields.key_error("spatial", ("motion", "inputs", name), text, "drive x and y")
    fields.refused.add(name.rpartition(".")[0])
    return True


def _is_moving_point(fields: Fields, path: Path, name: str, points: Mapping[str, Attached]) -> bool:
    if name not in points:
        if not fields.is_refused(name):
            hint = nearest_hint(name, list(points)) or "name it under points"
            fields.key_error("unknown-point", path, f"there is no point {name}", hint)
            fields.refused.add(f"{name}.position")
        return False
    if points[name].link == GROUND_NAME:
        text = f"{name} is a point of ground and does not move"
        fields.key_error("point-on-ground", path, text, "drive a point of a moving link")
        fields.refused.add(f"{name}.position")
        return False
    return True


def _axis(axis: str) -> Frame:
    """The frame at the origin whose z runs along x, y or z."""
    along: Vector = getattr(GROUND, axis)
    return frame_about(along, perpendicular(along), GROUND.o)


def _slide_part(axis: str, at: Vector, datum: Vector) -> Part:
    """A slide whose coordinate is the point's own, in the ground's axes: zero where that is, and
    as drawn where the point is drawn, from the `datum`."""
    still = _axis(axis)
    number = "xyz".index(axis)
    drawn = at[number] + datum[number]
    x, y, z = scale(drawn, still.z)
    before = Frame(still.x, still.y, still.z, (at[0] - x, at[1] - y, at[2] - z))
    return Part("P", before, Frame(still.x, still.y, still.z, at), drawn)


def _held_ball(name: str, at: Attached, guide: str, axes: str) -> Joint:
    """The ball about the point, of its link, on what the slide carries."""
    kind = joint_type(seat_letter(axes))
    centre, second = upright(at.vector), _seat(at.vector, axes)
    parts = []
    for step in kind.steps:
        along = step.along
        if along is None:
            parts.append(Part(step.letter, centre, centre))
            continue
        direction = getattr(second, along.axis)
        direction = scale(-1.0, direction) if along.reverse else direction
        across = second.x if along.axis == "z" else second.z
        still = frame_about(direction, across, second.o)
        parts.append(Part(step.letter, still, still))
    return Joint(name, kind.letter, at.link, guide, centre, second, tuple(parts))


def _held_pin(name: str, at: Attached, guide: str, axes: str) -> Joint:
    """The pin about the point, of its link, in a hole of what the slide carries; where one axis
    alone is guided in a slot square to it."""
    kind = joint_type(seat_letter(axes, plane=True), plane=True)
    along = GROUND.y if axes == "x" else GROUND.x
    pin = frame_about(GROUND.z, along, at.vector)
    halves = Halves(pin, pin, (pin, pin))
    return Joint(name, kind.letter, at.link, guide, pin, pin, parts_of(kind, halves), plane=True)


def _seat(at: Vector, axes: str) -> Frame:
    """The frame of the ball's seat: z along the one axis that guides it, or along the one that does
    not."""
    if len(axes) == 3:
        return upright(at)
    still = _axis(axes if len(axes) == 1 else next(axis for axis in "xyz" if axis not in axes))
    return Frame(still.x, still.y, still.z, at)
