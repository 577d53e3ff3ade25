"""The home drawing as an assembly; the modes at the first row and their letters; the paths from
the drawing to the rows.

Letters follow the order of the wrapped coordinates, in joint order, then of the joints' places. An
assembled drawing's own branch is among the modes even where the random starts miss it.

The drawing stands where all inputs are zero, and whole turns away from there. Rows in its own turn
come first, or in the turn next to it that has any; and of each kind the nearest row before the
nearest on the other side of the drawing: its branch may end in one direction and reach the rows in
the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import ceil, pi, sqrt
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import GROUND_NAME, Mechanism, coordinate_quantities, is_angle
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand, TrackEnd, home_inputs, home_state
from mechkin_cli.record import dataclass
from mechkin_cli.search import Assemblies, all_assemblies, with_assemblies
from mechkin_cli.session import Ask, Followed, RowInputs, Session

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats

Angle = TypeVar("Angle", float, "Floats")


@remembered
def is_home_assembled(session: Session) -> bool:
    """Whether the home drawing closes all loops as drawn."""
    inputs = home_inputs(session.layout)[:, None]
    tests = (0.0, 0.0, tolerances.HOME_ASSEMBLED)
    home = home_state(session.layout)[:, None]
    batch = session.run(RowInputs(inputs, home), Ask(iterations=0, tests=tests))
    return bool(batch.good[0])


def is_home_singular(session: Session, limit: float = tolerances.CONDITION_NEAR_SINGULAR) -> bool:
    """Whether the condition of some block is above a limit in the home drawing, assembled or
    not."""
    home = home_inputs(session.layout)[:, None], home_state(session.layout)[:, None]
    batch = session.run(RowInputs(*home), Ask(Demand.CONDITION, iterations=0))
    assert batch.condition is not None
    # no number is below the limit where a block has none
    return not batch.condition[0] < limit


def _from_home(session: Session, path: Floats) -> Floats:
    """How far inputs (inputs, rows) are from those of the drawing."""
    away: Floats = path - home_inputs(session.layout)[:, None]
    return away


def nearest_to_home(session: Session, path: Floats) -> int:
    """The row whose inputs (inputs, rows) are nearest to the drawing's."""
    return int(np.argmin(np.max(np.abs(_from_home(session, path)), axis=0))) if path.size else 0


def follow_from_home(session: Session, inputs: Floats) -> Followed:
    """The branch of an assembled drawing, straight to `inputs` (inputs,)."""
    path = np.stack([home_inputs(session.layout), inputs], axis=1)
    return session.follow(path, home_state(session.layout))


class Probe:
    """Reads coordinates and joint points of assemblies; `joints` names those of the points."""

    def __init__(self, session: Session) -> None:
        self.session = session
        mechanism = session.problem.mechanism
        self.coordinates = [q.name for q in coordinate_quantities(mechanism)]
        moving = [(n, at) for n, at in mechanism.joint_points() if at.link != GROUND_NAME]
        self.joints = [name for name, _ in moving]
        self.points = [at for _, at in moving]
        self.fixed = [at.vector for _, at in mechanism.joint_points() if at.link == GROUND_NAME]
        self.datum = np.array(mechanism.datum)[:, None]
        self.readout = session.readout(coordinate_quantities(mechanism), self.points)

    def read(self, inputs: Floats, states: Floats) -> tuple[dict[str, Floats], Floats]:
        """Coordinates by name (SI) and the joint points of the moving links (points, 3,
        assemblies)."""
        values = np.repeat(inputs[:, None], states.shape[1], axis=1)
        batch = self.session.run(RowInputs(values, states), Ask(readout=self.readout))
        assert batch.outputs is not None
        out = batch.outputs
        coordinates = {name: out[self.readout.slots[name].start] for name in self.coordinates}
        points = np.array([out[slot : slot + 3] - self.datum for slot in self.readout.points])
        # welds have no point
        return coordinates, points.reshape(len(self.points), 3, states.shape[1])

    def size(self, inputs: Floats, state: Floats) -> float:
        """Diagonal of the box of all joint points, in m; 1 if they coincide."""
        _, points = self.read(inputs, state[:, None])
        every = np.concatenate([points[:, :, 0], np.array(self.fixed).reshape(-1, 3)])
        extent = every.max(axis=0) - every.min(axis=0)
        x, y, z = (float(e) for e in extent)
        return sqrt(x * x + y * y + z * z) or 1.0


def telling_points(coordinates: Mapping[str, Floats], points: Floats) -> list[int]:
    """Numbers of a few points that tell those of some assemblies apart which the coordinates do
    not.

    Args:
        coordinates: by name of all assemblies, (assemblies,) each, in SI.
        points: (points, 3, assemblies), in m.
    """
    count = points.shape[2]
    if not points.size:
        return []
    size = float(np.max(np.ptp(points, axis=(0, 2))))
    groups = np.zeros(count, dtype=np.intp)
    for name, values in coordinates.items():
        scale = 1.0 if is_angle(name.rpartition(".")[2]) else size
        groups = _split(groups, values, tolerances.TOLD_APART * scale)
    found: list[int] = []
    while (told := int(groups.max()) + 1) < count:
        splits = []
        for place in points:
            split = groups
            for values in place:
                split = _split(split, values, tolerances.TOLD_APART * size)
            splits.append(split)
        counts = [int(split.max()) for split in splits]
        best = counts.index(max(counts))
        if counts[best] + 1 == told:
            break
        found.append(best)
        groups = splits[best]
    return found


def _split(groups: NDArray[np.intp], values: Floats, tolerance: float) -> NDArray[np.intp]:
    """Groups (assemblies,), numbered from 0, split where values (assemblies,) have gaps."""
    order = np.argsort(values, kind="stable")
    steps = np.concatenate([[0], np.cumsum(np.diff(values[order]) > tolerance)])
    places = np.empty_like(groups)
    places[order] = steps
    split: NDArray[np.intp] = np.unique(groups * groups.size + places, return_inverse=True)[1]
    return split


@remembered
def probe_of(session: Session) -> Probe:
    """What reads the assemblies of a session."""
    return Probe(session)


@dataclass(frozen=True)
class NamedModes:
    """Assemblies as `found`, their coordinates (SI), joint points and letters (by number, in the
    order of the letters), where these are known."""

    found: Assemblies
    coordinates: dict[str, Floats]
    points: Floats
    letters: dict[int, str]

    @property
    def number(self) -> int:
        """Of assemblies."""
        return self.found.number


@remembered
def name_modes(session: Session, inputs: Floats, *, thorough: bool = True) -> NamedModes:
    """The modes at the first row, `inputs` (inputs,) in kernel units; not `thorough`: most of them,
    and letters only if these are all for certain."""
    found = all_assemblies(session, inputs, thorough=thorough)
    if is_home_assembled(session):
        home = follow_from_home(session, inputs)
        if home.end == TrackEnd.FINISHED:
            found = with_assemblies(
                session.layout, session.plan, inputs, found, home.state[:, None]
            )
    coordinates, points = probe_of(session).read(inputs, found.states)
    known = thorough or found.complete
    names = _letters(session.problem.mechanism, coordinates, points) if known else {}
    return NamedModes(found, coordinates, points, names)


def _letters(
    mechanism: Mechanism, coordinates: dict[str, Floats], points: Floats
) -> dict[int, str]:
    """The name of each assembly, by its number, in the order of the names.

    Assemblies with the same coordinates, as of a platform on rods, follow their joint points
    (points, 3, assemblies).
    """
    grid = mechanism.box_diagonal() * tolerances.MODE_ORDER
    count = points.shape[2]
    rows = [
        *(_order(mechanism, name, values) for name, values in coordinates.items()),
        *np.rint(points.reshape(3 * points.shape[0], count) / grid),
    ]
    keys = np.array(rows).reshape(len(rows), count).T.tolist()
    order = sorted(range(count), key=keys.__getitem__)
    return {i: mode_name(rank) for rank, i in enumerate(order)}


def _order(mechanism: Mechanism, name: str, values: Floats) -> Floats:
    """What values (assemblies,) of a coordinate are ordered by: whole numbers."""
    half_turn, cyclic = round(pi / tolerances.MODE_ORDER), is_cyclic(mechanism, name)
    if not is_angle(name.rpartition(".")[2]):
        values = values / mechanism.box_diagonal()
    order: Floats = np.rint((wrapped(values) if cyclic else values) / tolerances.MODE_ORDER)
    return np.where(order == -half_turn, half_turn, order) if cyclic else order


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


def wrapped(angle: Angle) -> Angle:
    """The angle, or each of an array, brought into (-pi, pi]."""
    turns = (angle - pi) / (2.0 * pi)
    return angle - 2.0 * pi * (np.ceil(turns) if isinstance(angle, np.ndarray) else ceil(turns))


def rows_from_home(session: Session) -> Iterator[tuple[int, Followed, bool]]:
    """Rows to try, at least one, with the drawing's branch followed there, and whether whole turns
    of the inputs were left out."""
    # inputs that place a row in a turn: those that follow no other
    inputs = session.problem.motion.inputs
    leading = np.zeros(session.inputs.values.shape[0], dtype=bool)
    leading[: len(inputs)] = [not item.follows for item in inputs]
    tried = set()
    for path, rows, turned in _paths(session, leading):
        for row in two_sides(_from_home(session, path)[leading], rows):
            target = np.ascontiguousarray(path[:, row])
            if (row, target.tobytes()) not in tried:
                tried.add((row, target.tobytes()))
                yield row, follow_from_home(session, target), turned


def _paths(session: Session, leading: Bools) -> Iterator[tuple[Floats, NDArray[np.intp], bool]]:
    """The inputs of all rows (inputs, rows) and which of them to try: those in the first turn that
    has any, all rows, and all without whole turns."""
    inputs = session.inputs
    turns = np.max(np.abs(inputs.whole[leading]), axis=0, initial=0.0)
    every = np.arange(turns.size)
    # an assembly is the same whole turns of an input away; in the drawing's own turn inputs that
    # follow others keep their whole turns
    if turns.size:
        least = float(turns.min())
        yield (inputs.reduced if least else inputs.values), np.flatnonzero(turns == least), False
    yield inputs.reduced, every, False
    yield _without_turns(session, inputs.reduced), every, True


def two_sides(path: Floats, rows: NDArray[np.intp]) -> list[int]:
    """Of some rows (of inputs from the drawing's, rows) the nearest to the drawing, and of all rows
    the nearest on its other side."""
    if not path.size:
        return [0]
    away = np.abs(path)
    distance = np.max(away, axis=0)
    # of rows whose farthest input is as far off, as on the edge of a grid, the one least off in all
    first = int(rows[np.lexsort((np.add.reduce(away, axis=0)[rows], distance[rows]))[0]])
    along = sum(one * one[first] for one in path)
    other = np.flatnonzero(along < 0.0)
    return [first, int(other[np.argmin(distance[other])])] if other.size else [first]


def _without_turns(session: Session, path: Floats) -> Floats:
    """Inputs (inputs, rows) without the whole turns after which the mechanism stands as drawn; as
    they are where turns are counted."""
    joints = session.problem.mechanism.joints
    if any(joint.type.counts_turns for joint in joints.values()):
        return path
    cyclic = np.array([is_cyclic(session.problem.mechanism, f"{j}.{c}") for j, c in session.driven])
    turns = np.rint(path / (2.0 * np.pi))
    turned: Floats = np.where(cyclic[:, None], path - turns * (2.0 * np.pi), path)
    return turned if (turned != path).any() else path
