"""The start of a response: coordinates and rates at its first moment.

Values name the independent coordinates. There are as many rates as values: those that are left out
are zero, unless a rate of another coordinate stands for one of them; then all are named.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mechkin_cli.building.coordinates import dimension_of, is_coordinate
from mechkin_cli.mechanism.response import Start

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields, Path
    from mechkin_cli.mechanism.model import Joint
    from mechkin_cli.schema import responses as written

RATE = "_dot"


def build_start(
    fields: Fields, path: Path, section: written.Response, joints: Mapping[str, Joint]
) -> tuple[Start, ...]:
    """The start of the response at `path`, in the order of the file."""
    path = (*path, "start")
    errors = fields.error_count
    values: dict[str, float] = {}
    rates: dict[str, float] = {}
    for key, text in section.start.items():
        name, place = key.removesuffix(RATE), (*path, key)
        if not is_coordinate(fields, place, name, joints):
            continue
        if _is_prescribed(fields, place, name, section, joints):
            continue
        coordinate = name.rpartition(".")[2]
        if key.endswith(RATE):
            rates[name] = fields.number(place, text, dimension_of(coordinate, 1))
        elif not _is_same_freedom(fields, place, name, values, joints):
            values[name] = fields.number(place, text, dimension_of(coordinate))
    if fields.error_count == errors:
        rates = _all_rates(fields, path, values, rates)
    names = dict.fromkeys(key.removesuffix(RATE) for key in section.start)
    return tuple(
        Start(*_split(name), values.get(name), rates.get(name))
        for name in names
        if name in values or name in rates
    )


def _split(name: str) -> tuple[str, str]:
    joint, _, coordinate = name.rpartition(".")
    return joint, coordinate


def _all_rates(
    fields: Fields, path: Path, values: Mapping[str, float], rates: Mapping[str, float]
) -> dict[str, float]:
    """As many rates as values."""
    others = [name for name in rates if name not in values]
    if not others:
        return {name: rates.get(name, 0.0) for name in values}
    if len(rates) == len(values):
        return dict(rates)
    place = (*path, f"{others[0]}{RATE}")
    text = f"start has {_counted(rates, 'rate')} for {_counted(values, 'coordinate')}"
    if len(rates) > len(values):
        hint = "give as many rates as coordinates: remove a rate"
    else:
        missing = [f"{name}{RATE}" for name in values if name not in rates]
        hint = f"with a rate of another coordinate name all: add {' or '.join(missing)}"
    fields.key_error("start-rates", place, text, hint)
    return dict(rates)


def _counted(named: Mapping[str, float], word: str) -> str:
    return f"{len(named)} {word}{'s' * (len(named) != 1)}"


def _is_prescribed(
    fields: Fields,
    place: Path,
    name: str,
    section: written.Response,
    joints: Mapping[str, Joint],
) -> bool:
    """Whether the motion of a coordinate is driven already; that is noted."""
    joint, coordinate = _split(name)
    freedom = joints[joint].type.freedom_of
    for other in section.driven:
        owner, driven = _split(other)
        if owner == joint and driven in freedom and freedom[driven] == freedom[coordinate]:
            text = f"{name} is driven: its law says where it starts"
            fields.key_error("start-and-drive", place, text, "remove it here, or under driven:")
            return True
    return False


def _is_same_freedom(
    fields: Fields,
    place: Path,
    name: str,
    values: Mapping[str, float],
    joints: Mapping[str, Joint],
) -> bool:
    """Whether a coordinate is the turn or the slide of a thread whose other one is named."""
    joint, coordinate = _split(name)
    freedom = joints[joint].type.freedom_of
    for other in values:
        owner, known = _split(other)
        if owner == joint and freedom[known] == freedom[coordinate]:
            text = f"{other} and {name} are one freedom"
            fields.key_error("driven-twice", place, text, "start one of them")
            return True
    return False
