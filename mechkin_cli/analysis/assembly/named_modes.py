"""The assembly modes at the first row with their letters.

Letters follow the order of the wrapped coordinates, in joint order, then of the joints' places. An
assembled drawing's own branch is among the modes even where the random starts miss it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi
from typing import TYPE_CHECKING

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.home import follow_from_home, is_home_assembled
from mechkin_cli.analysis.assembly.probe import Probe
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.solver.follow import TrackEnd
from mechkin_cli.solver.search import Found, with_assemblies

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


@dataclass(frozen=True)
class NamedModes:
    """Assemblies as `found`, their coordinates (SI), joint points and letters (by number, in the
    order of the letters), where these are known."""

    found: Found
    coordinates: dict[str, Floats]
    points: Floats
    letters: dict[int, str]

    @property
    def number(self) -> int:
        """Number of assemblies."""
        return self.found.number


def name_modes(session: Session, inputs: Floats, *, thorough: bool = True) -> NamedModes:
    """The modes at the first row, `inputs` (inputs,) in kernel units; not `thorough`: most of them,
    and letters only if these are all for certain."""
    key = ("modes", inputs.tobytes(), str(session.problem.assembly.near), thorough)
    return session.once(key, lambda: _name_modes(session, inputs, thorough))


def _name_modes(session: Session, inputs: Floats, thorough: bool) -> NamedModes:
    found = session.search(inputs, thorough=thorough)
    if is_home_assembled(session):
        home = follow_from_home(session, inputs)
        if home.end == TrackEnd.FINISHED:
            found = with_assemblies(
                session.layout, session.plan, inputs, found, home.state[:, None]
            )
    coordinates, points = Probe.of(session).read(inputs, found.states)
    known = thorough or found.complete
    names = letters(session.problem.mechanism, coordinates, points) if known else {}
    return NamedModes(found, coordinates, points, names)


def letters(mechanism: Mechanism, coordinates: dict[str, Floats], points: Floats) -> dict[int, str]:
    """The name of each assembly, by its number, in the order of the names.

    Assemblies that no coordinate tells apart, as of a body on legs, follow their joint points
    (points, 3, assemblies).
    """
    order = sorted(
        range(points.shape[2]),
        key=lambda i: (_key(mechanism, coordinates, i), _places(mechanism, points[:, :, i])),
    )
    return {i: mode_name(rank) for rank, i in enumerate(order)}


def _key(mechanism: Mechanism, coordinates: dict[str, Floats], number: int) -> tuple[int, ...]:
    half_turn, size = round(pi / tolerances.MODE_ORDER), mechanism.box_diagonal()
    key = []
    for name, values in coordinates.items():
        value = float(values[number])
        angle = is_cyclic(mechanism, name)
        if not is_angle(name.rpartition(".")[2]):
            value /= size
        part = round((wrapped(value) if angle else value) / tolerances.MODE_ORDER)
        key.append(half_turn if angle and part == -half_turn else part)
    return tuple(key)


def _places(mechanism: Mechanism, points: Floats) -> tuple[int, ...]:
    parts = points.reshape(-1) / (mechanism.box_diagonal() * tolerances.MODE_ORDER)
    return tuple(round(float(part)) for part in parts)


def mode_name(rank: int) -> str:
    """A, B, ... Z, AA, AB, ..."""
    name = ""
    rank += 1
    while rank:
        rank, digit = divmod(rank - 1, 26)
        name = chr(ord("A") + digit) + name
    return name


def is_cyclic(mechanism: Mechanism, name: str) -> bool:
    """Whether a turn more of a coordinate is the same place: angles but for those of threads."""
    name, _, coordinate = name.rpartition(".")
    joint = mechanism.joints[name]
    return joint.type.chain[joint.freedom_number(coordinate)].is_cyclic


def wrapped(angle: float) -> float:
    """The angle brought into (-pi, pi]."""
    return angle - 2.0 * pi * ceil((angle - pi) / (2.0 * pi))
