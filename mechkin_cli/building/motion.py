"""`motion:` to values, rates, accelerations and jerks of the inputs over the rows; row limits,
equal spacing, and the guides of points whose coordinates are inputs.

The equally spaced values of a sweep are the doubles nearest to the decimal numbers: 0, 0.1, 0.2,
0.3 and not 0.30000000000000004. The numbers written are fractions over one power of ten, so x_i =
from + i*step is a quotient of two whole numbers that doubles hold exactly, and a single division
rounds it. Numbers with too many digits for that (results of expressions) are added as doubles.

A point is guided by a slide that no drawing has: it runs along those axes of the ground and carries
a ball on a plane, in a groove or in a socket, in a plane a pin in a slot or in a hole, whose centre
is the point: one equation for each coordinate and no unknown more. Its coordinates are those of the
point; in the drawing they are not zero.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from functools import partial
from math import floor, inf, isfinite, pi, prod
from typing import Final

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.building.fields import (
    Clock,
    Fields,
    Path,
    dimension_of,
    is_coordinate,
    refuse_efforts,
)
from mechkin_cli.building.joints import Halves, parts_of
from mechkin_cli.diagnostics import Number, nearest_hint
from mechkin_cli.expressions import Expression
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
    Vector,
    frame_about,
    guide_letter,
    joint_type,
    perpendicular,
    scale,
    seat_letter,
    told_coordinates,
    upright,
)
from mechkin_cli.schema import (
    FollowingInput,
    HeldCoordinate,
    HeldInput,
    InputMotion,
    ListedInput,
    MechanismFile,
    MotionSection,
    SweptInput,
    TimeSection,
    WithRates,
)
from mechkin_cli.show import Floats
from mechkin_cli.tables import default_table
from mechkin_cli.tape import Recorder, Traced, as_recorded, differ, of_numbers, with_rates, within
from mechkin_cli.tolerances import LARGEST_NUMBER, LARGEST_TURNS, MOST_NUMBERS
from mechkin_cli.units import ANGLE, TIME, Dimension
from mechkin_cli.verdict import SWEEP

_ROW_COLUMNS: Final = 6
"""Columns of rows.csv beside the inputs."""


def has_too_many_rows(fields: Fields, path: Path, rows: float, per_row: int) -> bool:
    """Whether this number of rows, before any of them is made, is too large for memory; that is
    noted at `path`, the place of the number. `per_row`: `numbers_per_row`."""
    numbers = rows * per_row
    if numbers <= MOST_NUMBERS:
        return False
    fields.error(
        "too-many-numbers",
        path,
        f"the run has too many numbers, {rows:.12g} rows of {per_row}",
        "take a larger step or fewer columns, or split the sweep into several files",
        measured=f"{numbers:.12g} numbers",
        limit=f"{MOST_NUMBERS} numbers, {MOST_NUMBERS // per_row} rows",
        numbers=(Number("numbers", float(numbers), limit=MOST_NUMBERS),),
    )
    return True


def numbers_per_row(file: MechanismFile, joints: Mapping[str, Joint]) -> int:
    """The numbers of each row of the file's run in memory: the cells of all tables, the columns of
    rows.csv and the freedoms of all joints."""
    motion = file.motion
    inputs = list(motion.inputs) if motion else []
    cells = sum(len(table.columns) for table in file.tables)
    if not file.tables:
        names = told_coordinates(joints.values())
        timed = motion is not None and motion.time is not None
        cells = len(default_table(names, inputs, timed=timed).columns)
    freedoms = sum(joint.type.freedoms for joint in joints.values())
    return cells + _ROW_COLUMNS + len(inputs) + freedoms


EXACT = 2**53
"""Whole numbers up to this one are doubles."""


def by_step(first: float, step: float, count: int) -> Floats:
    """The values first + i*step, shape (count,)."""
    (start, stride), power = _whole_numbers(first, step)
    numerators = _exact(start, stride, count)
    if numerators is None or power > EXACT:
        return np.asarray(first + np.arange(count) * step, dtype=np.float64)
    return numerators / float(power)


def by_count(first: float, last: float, count: int) -> Floats:
    """`count` values from `first` to `last`, both included; one value is `first`."""
    if count == 1:
        return np.array([first])
    (start, end), power = _whole_numbers(first, last)
    gaps = count - 1
    numerators = _exact(start * gaps, end - start, count)
    if numerators is None or power * gaps > EXACT:
        values = np.asarray(first + np.arange(count) * (last / gaps - first / gaps), dtype=float)
        values[-1] = last
        return values
    return numerators / float(power * gaps)


def _whole_numbers(*values: float) -> tuple[tuple[int, ...], int]:
    """Whole numbers and the power of ten over which they are the values' shortest decimals."""
    decimals = [Decimal(repr(float(value))) for value in values]
    exponents = [int(number.as_tuple().exponent) for number in decimals]
    power = 10 ** max(0, *(-exponent for exponent in exponents))
    return tuple(int(number * power) for number in decimals), power


def _exact(start: int, stride: int, count: int) -> Floats | None:
    """start + i*stride as doubles; None where one of them is not an exact double."""
    if max(abs(start), abs(stride), abs(start + (count - 1) * stride)) > EXACT:
        return None
    return np.asarray(start + np.arange(count, dtype=np.int64) * stride, dtype=np.float64)


def spaced(
    fields: Fields,
    path: Path,
    section: SweptInput | TimeSection,
    dimension: Dimension,
    per_row: int,
) -> Floats:
    """The values or moments of the rows in the file's units: n = floor(|to - from|/|step| + 1e-9) +
    1 values x_i = from + i*step, or `count` values. Errors are noted in `fields`, with one
    value."""
    errors = fields.error_count
    first = fields.written((*path, "from"), section.first, dimension)
    last = fields.written((*path, "to"), section.last, dimension)
    if section.count is not None:
        at = (*path, "count")
        if fields.error_count > errors or has_too_many_rows(fields, at, section.count, per_row):
            return np.array([first])
        return _computed(path, section, partial(_counted, section.count), first, last)
    assert section.step is not None  # the schema wants one of the two
    step = abs(fields.written((*path, "step"), section.step, dimension))
    if fields.error_count > errors:
        return np.array([first])
    if step == 0.0:
        if first != last:
            hint = "give the distance of rows"
            fields.error("zero-step", (*path, "step"), "the step is zero", hint)
        return np.array([first])
    ratio = as_recorded(abs(last - first) / step) + tolerances.LAST_ROW
    rows = floor(ratio) + 1 if isfinite(ratio) else ratio
    if has_too_many_rows(fields, (*path, "step"), rows, per_row):
        return np.array([first])
    return _computed(path, section, _stepped, first, last, step)


def _stepped(first: float, last: float, step: float) -> Floats:
    """The values from `first` to `last` a positive step apart; none where they are without end."""
    ratio = abs(last - first) / step + tolerances.LAST_ROW if step else inf
    if not ratio < MOST_NUMBERS:
        return np.empty(0)
    return by_step(first, step if last >= first else -step, int(ratio) + 1)


def _counted(count: int, first: float, last: float) -> Floats:
    return by_count(first, last, count) if isfinite(last - first) else np.empty(0)


def _computed(
    path: Path, section: SweptInput | TimeSection, compute: Callable[..., Floats], *numbers: float
) -> Floats:
    """Values that go by decimals, which no operation of a tape has: of recorded numbers they are
    inputs of its own."""
    for number in numbers:
        if isinstance(number, Traced) and isinstance(section, SweptInput):
            recorder: Recorder = number.recorder
            return recorder.take(".".join(map(str, path)), compute, *numbers)
    return compute(*numbers)


_RATES = ("rate", "acceleration", "jerk")
_ORDERS = ("value", *_RATES)


def build_motion(
    fields: Fields, section: MotionSection | None, joints: Mapping[str, Joint], per_row: int
) -> MotionInputs:
    """Inputs with their values; without inputs the motion has one row, or those of `time`."""
    if section is None:
        return MotionInputs((), 1)
    errors = fields.error_count
    grid = section.with_rows if section.grid else ()
    path, clock = ("motion", "inputs"), None
    if section.time is not None:
        clock = spaced_moments(fields, ("motion", "time"), section.time, per_row)
    motion = build_inputs(fields, path, section.inputs, joints, per_row, clock, grid)
    if motion is not None and fields.error_count == errors:
        return motion
    fields.failed.add(SWEEP)
    fields.refused.add("time")
    refuse_efforts(fields, joints)
    return MotionInputs((), 1)


def build_inputs(
    fields: Fields,
    path: Path,
    sections: Mapping[str, InputMotion | HeldCoordinate],
    joints: Mapping[str, Joint],
    per_row: int,
    clock: Clock | None = None,
    pair: tuple[str, ...] = (),
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
    """
    errors = fields.error_count
    time = None if clock is None else clock.time
    with np.errstate(all="ignore"):
        orders, following = _orders(fields, path, sections, joints, per_row, clock)
    rows = time.written.size if time else _row_count(fields, pair, orders)
    grid = None
    if fields.error_count == errors and not has_too_many_rows(fields, path, rows, per_row):
        grid = _all_pairs(orders, pair)
    expressions: dict[str, Expression] = {}
    constraint_rates: dict[tuple[str, str], Floats] = {}
    if fields.error_count == errors and following:
        from mechkin_cli.building.laws import Following

        coordinates = frozenset(told_coordinates(joints.values()))
        followers = Following(fields, orders, rows, time, path)
        followers.add_all(following, coordinates)
        expressions = followers.expressions
        if fields.error_count == errors:
            constraint_rates = followers.constraint_rates()
    if fields.error_count > errors:
        return None
    inputs = tuple(
        _driven(
            fields, joints, (*path, name), np.broadcast_to(column, (4, rows)), name in following
        )
        for name, column in ((name, orders[name]) for name in sections if name in orders)
    )
    if fields.error_count > errors:
        return None
    unrated = () if time else _unrated(fields, path, inputs)
    motion = MotionInputs(inputs, rows, time, unrated=unrated, grid=grid)
    if constraint_rates:
        number = {item.name: k for k, item in enumerate(inputs)}
        pairs = [(number[name], number[leader]) for name, leader in constraint_rates]
        motion = motion._replace(
            constraints=tuple(InputConstraint(*pair) for pair in pairs),
            constraint_rates=np.array(list(constraint_rates.values())),
        )
    if not inputs or (time is None and not expressions):
        return motion
    from mechkin_cli.building.laws import build_course, build_paths

    course = build_course(fields, path, sections, inputs, expressions, clock, grid=bool(pair))
    paths = build_paths(fields, inputs, expressions, time) if expressions else motion.paths
    return motion._replace(course=course, paths=paths)


def spaced_moments(fields: Fields, path: Path, section: TimeSection, per_row: int) -> Clock:
    """The moments of a section, which run forwards; errors are noted, with one moment."""
    errors = fields.error_count
    written = spaced(fields, path, section, TIME, per_row)
    last = float(written[0])
    if fields.error_count == errors:
        last = fields.written((*path, "to"), section.last, TIME)
    if written[-1] < written[0]:
        fields.error("time-backwards", path, "time runs backwards", "exchange from and to")
    elif written.size > 1 and (written[-1] - written[0]) * LARGEST_NUMBER <= 1.0:
        text = f"time stands still over {written.size} rows"
        fields.error("zero-step", (*path, "to"), text, "give a later moment, or count: 1")
        written = written[:1]
    moments = Moments(fields.units.to_si(written.copy(), TIME), written)
    return Clock(moments, float(written[0]), last)


def _orders(
    fields: Fields,
    path: Path,
    sections: Mapping[str, InputMotion | HeldCoordinate],
    joints: Mapping[str, Joint],
    per_row: int,
    clock: Clock | None,
) -> tuple[dict[str, Floats], dict[str, FollowingInput]]:
    """Value, rate, acceleration, jerk (4, rows) in the file's units of the inputs that follow none,
    and the sections of those that follow."""
    orders: dict[str, Floats] = {}
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
            orders[name] = with_rates(of_numbers([at]), [0.0, 0.0, 0.0])
        elif isinstance(item, (SweptInput, ListedInput, HeldInput)):
            values = _values(fields, own, item, coordinate, per_row)
            rates = _constant_rates(fields, own, item, coordinate, timed=clock is not None)
            orders[name] = with_rates(values, rates)
        else:
            from mechkin_cli.building.laws import law_values

            assert clock is not None  # the schema refuses a law without time
            orders[name] = law_values(fields, own, item, coordinate, clock)
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
    per_row: int,
) -> Floats:
    dimension = dimension_of(coordinate)
    if isinstance(item, HeldInput):
        return of_numbers([fields.written((*path, "at"), item.at, dimension)])
    if isinstance(item, ListedInput):
        texts = enumerate(item.values)
        return of_numbers(fields.written((*path, "values", i), t, dimension) for i, t in texts)
    return spaced(fields, path, item, dimension, per_row)


def _all_pairs(orders: dict[str, Floats], grid: Sequence[str]) -> tuple[int, int] | None:
    """Spreads the values of the two inputs of a grid over its rows; how many values each has."""
    if not grid:
        return None
    slow, fast = grid
    shape = orders[slow].shape[1], orders[fast].shape[1]
    orders[slow] = np.repeat(orders[slow], shape[1], axis=1)
    orders[fast] = np.tile(orders[fast], (1, shape[0]))
    return shape


def _row_count(fields: Fields, grid: Sequence[str], columns: Mapping[str, Floats]) -> int:
    if grid:
        return prod(columns[name].shape[1] for name in grid if name in columns)
    lengths = {name: orders.shape[1] for name, orders in columns.items() if orders.shape[1] > 1}
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
    name = str(path[-1])
    joint, _, coordinate = name.rpartition(".")
    written = orders.copy()
    in_si = [
        np.asarray(fields.units.to_si(written[k].copy(), dimension_of(coordinate, k)))
        for k in range(4)
    ]
    for word, values in zip(_ORDERS, in_si, strict=True):
        if not within(values, LARGEST_NUMBER):
            largest = float(np.abs(values).max())
            fields.error(
                "too-large",
                path,
                f"the {word} of {name} grows too large to compute with",
                "check the law and its units",
                measured=f"{largest:.4g} in SI units",
                limit=f"{LARGEST_NUMBER:g}",
            )
            break
    else:
        _refuse_lost_turns(fields, path, joints[joint], coordinate, in_si[0], written[0])
    value, rate, acceleration, jerk = in_si
    return DrivenInput(joint, coordinate, value, rate, acceleration, jerk, written, follows)


def _refuse_lost_turns(
    fields: Fields, path: Path, joint: Joint, coordinate: str, in_si: Floats, written: Floats
) -> None:
    """Notes an angle of more turns than leave a place within one."""
    most = 2.0 * pi * LARGEST_TURNS
    if not joint.type.chain[joint.freedom_number(coordinate)].is_cyclic or within(in_si, most):
        return
    unit = fields.units.label(ANGLE)
    fields.error(
        "too-large",
        path,
        f"{path[-1]} has so many turns that nothing is left of the place within one",
        "write the angle within a turn",
        measured=f"{float(np.abs(written).max()):.4g} {unit}",
        limit=f"{float(fields.units.from_si(most, ANGLE)):.4g} {unit}",
    )


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
