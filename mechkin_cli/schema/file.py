"""The whole file: format 1, of a mechanism in space; what it has in common with one in a plane."""

from typing import Annotated, Any, Literal

from mechkin_cli.schema.assembly import AssemblySection
from mechkin_cli.schema.balances import Balance, refuse_clashes
from mechkin_cli.schema.base import NOTHING, Section, refuse
from mechkin_cli.schema.chain import ChainRow
from mechkin_cli.schema.coefficients import Coefficients
from mechkin_cli.schema.joints import Joint
from mechkin_cli.schema.links import Link
from mechkin_cli.schema.loads import Load
from mechkin_cli.schema.motion import MotionSection
from mechkin_cli.schema.points import DirectionOfLink, PointOfLink
from mechkin_cli.schema.responses import Response
from mechkin_cli.schema.rules import After, Before
from mechkin_cli.schema.runs import free_run_names
from mechkin_cli.schema.scalars import AnyDimension, Coordinate, Name, Text
from mechkin_cli.schema.tables import Table, differing_names
from mechkin_cli.schema.units_section import METRIC, UnitsSection
from mechkin_cli.schema.view import ViewSection


def _format_number(value: Any) -> int:
    if str(value).strip() == "1" and not isinstance(value, bool):
        return 1
    raise refuse("unknown-format", "this version of mechkin reads format 1", "write format: 1")


class AnyFile(Section):
    """What files of mechanisms in space and in a plane have in common."""

    in_plane = False

    format: Annotated[Literal[1], Before(_format_number)]
    """Version of the file format."""
    name: Text | None = None
    """Name of the mechanism."""
    source: Text | None = None
    """Where the mechanism comes from: book, page, drawing."""
    units: UnitsSection = METRIC
    """Units of bare numbers and of the tables."""
    parameters: dict[Name, AnyDimension] = NOTHING
    """Named numbers, values with units, or expressions of one another."""
    quantities: dict[Name, AnyDimension] = NOTHING
    """Named expressions of quantities, used by name in columns, loads, stops and one another."""
    motion: MotionSection | None = None
    """The driven coordinates and their values."""
    assembly: AssemblySection | None = None
    """Which way of assembling the mechanism is meant."""
    responses: Annotated[dict[Name, Response], After(free_run_names)] = NOTHING
    """Motions under forces, by name."""
    actuators: tuple[Coordinate, ...] = ()
    """Where efforts act, when not at the inputs: [leg1.s, leg2.s]; at least as many as freedoms."""
    tables: Annotated[tuple[Table, ...], After(differing_names)] = ()
    """The tables a run writes; left out, one table of all coordinates, their rates and efforts."""
    balances: tuple[Balance, ...] = ()
    """Work over a cycle, harmonics and flywheels of the sweep, a table each."""
    view: ViewSection | None = None
    """How `mechkin view` shows the mechanism; it changes no number."""
    follow: tuple[Name, ...] | None = None
    """Joints whose loops are followed beside those the outputs need; left out, all loops are."""
    accept: tuple[Literal["unphysical-inertia"], ...] = ()
    """Warnings that the file acknowledges."""

    def check(self) -> None:
        """No two tables are written to the same files."""
        refuse_clashes(self.balances, self.tables)


class MechanismFile(AnyFile):
    """A mechanism in the format 1 of mechkin.

    All points, axes, mass centres and inertias are written in one drawing, the home pose, in ground
    axes; every joint coordinate is zero there. Joints, links, points, directions, parameters
    and quantities share one namespace.
    """

    links: dict[Name, Link] = NOTHING
    """The moving bodies by name; `ground` always exists."""
    joints: dict[Name, Joint] = NOTHING
    """The joints by name."""
    chain: tuple[ChainRow, ...] = ()
    """A loop as rows (theta, s, alpha, a), beside or instead of `joints`."""
    points: dict[Name, PointOfLink] = NOTHING
    """Points that move with links, by name."""
    directions: dict[Name, DirectionOfLink] = NOTHING
    """Directions that turn with links, by name."""
    loads: tuple[Load, ...] = ()
    """Gravity, forces, torques, springs and dampers."""
    coefficients: Annotated[tuple[Coefficients, ...], After(differing_names)] = ()
    """Tables of the dense system of all reactions at one row, as textbooks write it."""
    idle: Literal["hold"] | None = None
    """`hold`: idle freedoms that loads would move are held, and the holding moment is reported."""

    def check(self) -> None:
        """There is a joint, and no two tables are written to the same files."""
        if not self.joints and not self.chain:
            raise refuse("no-joints", "the file has no joints", "add joints: (or chain:)")
        refuse_clashes(self.balances, (*self.tables, *self.coefficients))
