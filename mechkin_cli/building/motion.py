"""The motion section to values, rates, accelerations and jerks of the inputs over the rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.building.coordinates import dimension_of, is_coordinate
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.memory import RowLimit
from mechkin_cli.building.spacing import spaced
from mechkin_cli.expressions import Expression
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.motion import DrivenInput, Moments, Motion
from mechkin_cli.schema.motion import (
    FollowingInput,
    HeldInput,
    InputMotion,
    ListedInput,
    MotionSection,
    SweptInput,
    TimeSection,
    WithRates,
)
from mechkin_cli.schema.responses import HeldCoordinate
from mechkin_cli.tape.rows import of_numbers, with_rates, within
from mechkin_cli.tolerances import LARGEST_NUMBER
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.building.law_numbers import Clock


class Written(NamedTuple):
    """Driven coordinates as some section writes them, its place, and the moments of their laws with
    the clock that these laws go by."""

    inputs: Mapping[str, InputMotion | HeldCoordinate]
    path: Path
    time: Moments | None = None
    clock: Clock | None = None


_RATES = ("rate", "acceleration", "jerk")
_ORDERS = ("value", *_RATES)


def build_motion(
    fields: Fields, section: MotionSection | None, joints: Mapping[str, Joint], limit: RowLimit
) -> Motion:
    """Inputs with their values; without inputs the motion has one row, or those of `time`."""
    if section is None:
        return Motion((), 1)
    errors = fields.error_count
    written = Written(section.inputs, ("motion", "inputs"))
    if section.time is not None:
        written = _timed(fields, written, ("motion", "time"), section.time, limit)
    motion = build_inputs(fields, written, joints, limit)
    if motion is not None and fields.error_count == errors:
        return motion
    fields.refused.add("time")
    for joint in joints.values():
        fields.refused.update(f"{name}.effort" for name in (joint.name, *joint.coordinates))
    return Motion((), 1)


def build_inputs(
    fields: Fields, written: Written, joints: Mapping[str, Joint], limit: RowLimit
) -> Motion | None:
    """Driven coordinates over the rows and between them; None where an error was noted."""
    errors = fields.error_count
    time = written.time
    with np.errstate(all="ignore"):
        orders, following = _orders(fields, written, joints, limit)
    rows = time.written.size if time else _row_count(fields, orders)
    if fields.error_count == errors:
        limit.is_exceeded(fields, written.path, rows)
    expressions: dict[str, Expression] = {}
    tie_rates: dict[tuple[str, str], Floats] = {}
    if fields.error_count == errors and following:
        from mechkin_cli.building.following import Following

        coordinates = frozenset(c for joint in joints.values() for c in joint.coordinates)
        tied = Following(fields, orders, rows, time, written.path)
        tied.add_all(following, coordinates)
        expressions = tied.expressions
        if fields.error_count == errors:
            tie_rates = tied.tie_rates()
    if fields.error_count > errors:
        return None
    inputs = [
        _driven(fields, (*written.path, name), orders[name], rows)._replace(
            follows=name in following
        )
        for name in written.inputs
        if name in orders
    ]
    if fields.error_count > errors:
        return None
    moving = _tied(Motion(tuple(inputs), rows, time), tie_rates)
    return _with_course(fields, written, moving, expressions)


def _tied(motion: Motion, rates: Mapping[tuple[str, str], Floats]) -> Motion:
    """A motion with the inputs that motors of others move."""
    if not rates:
        return motion
    number = {item.name: k for k, item in enumerate(motion.inputs)}
    pairs = tuple((number[tied], number[leader]) for tied, leader in rates)
    return motion._replace(tied=pairs, tie_rates=np.array(list(rates.values())))


def _with_course(
    fields: Fields, written: Written, motion: Motion, expressions: dict[str, Expression]
) -> Motion:
    """A motion with its inputs between the rows, where they do not simply run from one to the
    next."""
    inputs, time = motion.inputs, motion.time
    if not inputs or (time is None and not expressions):
        return motion
    from mechkin_cli.building.course import build_course, build_ties

    course = build_course(fields, written, inputs, expressions)
    ties = build_ties(fields, inputs, expressions, time) if expressions else motion.ties
    return motion._replace(course=course, ties=ties)


def _timed(
    fields: Fields, written: Written, path: Path, section: TimeSection, limit: RowLimit
) -> Written:
    """With the moments of a section at `path`."""
    from mechkin_cli.building.law_numbers import Clock

    moments, last = spaced_moments(fields, path, section, limit)
    clock = Clock(moments.written, float(moments.written[0]), last)
    return written._replace(time=moments, clock=clock)


def spaced_moments(
    fields: Fields, path: Path, section: TimeSection, limit: RowLimit
) -> tuple[Moments, float]:
    """The moments of a section, which run forwards, and where it ends in the file's unit; one
    moment stands in for those with an error."""
    errors = fields.error_count
    written = spaced(fields, path, section, TIME, limit)
    last = float(written[0])
    if fields.error_count == errors:
        last = fields.written((*path, "to"), section.last, TIME)
    if written[-1] < written[0]:
        fields.error("time-backwards", path, "time runs backwards", "exchange from and to")
    elif written.size > 1 and (written[-1] - written[0]) * LARGEST_NUMBER <= 1.0:
        text = f"time stands still over {written.size} rows"
        fields.error("zero-step", (*path, "to"), text, "give a later moment, or count: 1")
        written = written[:1]
    return Moments(fields.units.to_si(written.copy(), TIME), written), last


def _orders(
    fields: Fields, written: Written, joints: Mapping[str, Joint], limit: RowLimit
) -> tuple[dict[str, Floats], dict[str, FollowingInput]]:
    """Value, rate, acceleration, jerk (4, rows) in the file's units of the inputs that follow none,
    and the sections of those that follow."""
    found: dict[str, Floats] = {}
    following: dict[str, FollowingInput] = {}
    for name, item in written.inputs.items():
        path: Path = (*written.path, name)
        if not is_coordinate(fields, path, name, joints) or _driven_twice(fields, path, joints):
            continue
        coordinate = name.rpartition(".")[2]
        if isinstance(item, FollowingInput):
            following[name] = item
        elif isinstance(item, HeldCoordinate):
            at = fields.written((*path, "at"), item.at, dimension_of(coordinate))
            found[name] = with_rates(of_numbers([at]), [0.0, 0.0, 0.0])
        elif isinstance(item, (SweptInput, ListedInput, HeldInput)):
            values = _values(fields, path, item, coordinate, limit)
            found[name] = _constant_rates(fields, path, item, values, coordinate, written.time)
        else:
            from mechkin_cli.building.laws import law_values

            assert written.clock is not None  # the schema lets no law stand without time
            found[name] = law_values(fields, path, item, coordinate, written.clock)
    return found, following


def _constant_rates(
    fields: Fields,
    path: Path,
    item: WithRates,
    values: Floats,
    coordinate: str,
    time: Moments | None,
) -> Floats:
    """Values of a sweep, with the same rates in every row."""
    rates = []
    texts = (item.rate, item.acceleration, item.jerk)
    for order, (key, text) in enumerate(zip(_RATES, texts, strict=True), start=1):
        rates.append(fields.written((*path, key), text, dimension_of(coordinate, order)))
        if time is not None and rates[-1] != 0.0:
            text = "an input that is held while time runs has no rate"
            hint = "write law: constant-rate, or another law"
            fields.key_error("held-rate", (*path, key), text, hint)
    return with_rates(values, rates)


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
    limit: RowLimit,
) -> Floats:
    """Values in the file's units."""
    dimension = dimension_of(coordinate)
    if isinstance(item, HeldInput):
        return of_numbers([fields.written((*path, "at"), item.at, dimension)])
    if isinstance(item, ListedInput):
        texts = enumerate(item.values)
        return of_numbers(fields.written((*path, "values", i), t, dimension) for i, t in texts)
    return spaced(fields, path, item, dimension, limit)


def _row_count(fields: Fields, columns: Mapping[str, Floats]) -> int:
    """Rows that all inputs share."""
    lengths = {name: orders.shape[1] for name, orders in columns.items() if orders.shape[1] > 1}
    if len(set(lengths.values())) > 1:
        words = ", ".join(f"{name} {n}" for name, n in lengths.items())
        fields.error(
            "row-counts",
            ("motion", "inputs"),
            "inputs that run together need equally many rows",
            "use the same number of values, or hold an input with at:",
            measured=words,
        )
    return max(lengths.values(), default=1)


def _driven(fields: Fields, path: Path, orders: Floats, rows: int) -> DrivenInput:
    """The input of the key at `path`, in SI and as written; numbers too large to compute with are
    noted."""
    name = str(path[-1])
    joint, _, coordinate = name.rpartition(".")
    written = np.broadcast_to(orders, (4, rows)).copy()
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
    return DrivenInput(joint, coordinate, in_si[0], in_si[1], in_si[2], in_si[3], written)
