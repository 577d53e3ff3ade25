"""The whole file of a mechanism in space: format 1; and the sections common to space and plane."""

from typing import Annotated, Any, Literal

from mechkin_cli.schema.base import NOTHING, Rule, Section, refuse
from mechkin_cli.schema.couplings import Coupling
from mechkin_cli.schema.cylinders import Cylinder
from mechkin_cli.schema.limits import CoordinateLimit
from mechkin_cli.schema.links_joints import ChainRow, Joint, Link
from mechkin_cli.schema.loads import Load
from mechkin_cli.schema.motion import AssemblySection, MotionSection
from mechkin_cli.schema.responses import Equilibrium, Response
from mechkin_cli.schema.scalars import (
    METRIC,
    AnyDimension,
    Coordinate,
    DirectionOfLink,
    Name,
    PointOfLink,
    Text,
    UnitsSection,
    free_run_names,
)
from mechkin_cli.schema.tables import Balance, Coefficients, Table, differing_names, refuse_clashes
from mechkin_cli.schema.view import ViewSection


def _format_number(value: Any) -> int:
    if str(value).strip() == "1" and not isinstance(value, bool):
        return 1
    raise refuse("unknown-format", "this version of mechkin reads format 1", "write format: 1")


class AnyFile(Section):
    """What files of mechanisms in space and in a plane have in common."""

    in_plane = False

    format: Annotated[Literal[1], Rule(_format_number, before=True)]
    """Version of the file format."""
    name: Text | None = None
    """Name of the mechanism; left out, that of the file."""
    source: Text | None = None
    """Where the mechanism comes from (book, page, drawing); left out, nothing is said."""
    units: UnitsSection = METRIC
    """Units of bare numbers and of the tables; left out, m, deg, kg, N and s."""
    parameters: dict[Name, AnyDimension] = NOTHING
    """Named numbers, values with units, or expressions of one another; left out, none."""
    quantities: dict[Name, AnyDimension] = NOTHING
    """Named expressions of quantities, used by name in columns, loads, stops and one another; left
    out, none."""
    couplings: dict[Name, Coupling] = NOTHING
    """Relations between coordinates of joints (gears, racks), by name; left out, none."""
    cylinders: dict[Name, Cylinder] = NOTHING
    """Links of variable length between two named points, by name; left out, none."""
    limits: dict[Coordinate, CoordinateLimit] = NOTHING
    """Where coordinates end, as [least, largest] or by min and max: a row beyond is not `ok`; left
    out, nowhere."""
    motion: MotionSection | None = None
    """The driven coordinates and their values; left out, one row."""
    assembly: AssemblySection | None = None
    """Which way of assembling the mechanism is meant; left out, an assembled drawing, else the way
    nearest to it."""
    responses: Annotated[dict[Name, Response], Rule(free_run_names)] = NOTHING
    """Motions under forces, by name; left out, none."""
    equilibria: Annotated[dict[Name, Equilibrium], Rule(free_run_names)] = NOTHING
    """Places at which loads balance, by name; left out, none."""
    actuators: tuple[Coordinate, ...] = ()
    """Where efforts act, at least as many coordinates as freedoms; left out, at the inputs."""
    tables: Annotated[tuple[Table, ...], Rule(differing_names)] = ()
    """The tables a run writes; left out, one table of all coordinates, their rates and efforts."""
    balances: tuple[Balance, ...] = ()
    """Work over a cycle, harmonics and flywheels of the sweep, a table each; left out, none."""
    view: ViewSection | None = None
    """How `mechkin view` shows the mechanism; it changes no number; left out, the page
    chooses."""
    follow: tuple[Name, ...] | None = None
    """Joints whose loops are followed beside those the outputs need; left out, all loops are."""
    accept: tuple[Literal["unphysical-inertia"], ...] = ()
    """Warnings that the file acknowledges; left out, none."""

    def check(self) -> None:
        """No two tables are written to the same files, and no two runs have one name."""
        refuse_clashes(self.balances, self.tables)
        self.check_runs()

    def check_runs(self) -> None:
        """No two runs are written to the same files."""
        known = {name.casefold() for name in self.responses}
        for name in self.equilibria:
            if name.casefold() in known:
                text = f"a response has the name {name}, too"
                raise refuse("name-clash", text, "rename it", "equilibria", name)

    @property
    def free_runs(self) -> "dict[str, Response | Equilibrium]":
        """The runs whose freedoms loads decide on, by name: responses, then equilibria."""
        return {**self.responses, **self.equilibria}


class MechanismFile(AnyFile):
    """A mechanism in the format 1 of mechkin.

    All points, axes, mass centres and inertias are written in one drawing, the home pose, in ground
    axes; every joint coordinate is zero there. Joints, couplings, links, points, directions,
    parameters and quantities share one namespace.
    """

    links: dict[Name, Link] = NOTHING
    """The moving bodies by name; `ground` always exists; left out, those of `chain`."""
    joints: dict[Name, Joint] = NOTHING
    """The joints by name; left out, those of `chain`."""
    chain: tuple[ChainRow, ...] = ()
    """A loop as rows (theta, s, alpha, a), beside or instead of `joints`; left out, none."""
    points: dict[Name, PointOfLink] = NOTHING
    """Points that move with links, by name; left out, none."""
    directions: dict[Name, DirectionOfLink] = NOTHING
    """Directions that turn with links, by name; left out, none."""
    loads: tuple[Load, ...] = ()
    """Gravity, forces, torques, springs, dampers and friction; left out, none."""
    coefficients: Annotated[tuple[Coefficients, ...], Rule(differing_names)] = ()
    """Tables of the dense system of all reactions at one row, as textbooks write it; left out,
    none."""
    idle: Literal["hold"] | None = None
    """`hold`: idle freedoms that loads would move are held, and the holding moment is reported;
    left out, such loads are refused."""

    def check(self) -> None:
        """There is a joint or a cylinder, and no two tables are written to the same files."""
        if not self.joints and not self.chain and not self.cylinders:
            raise refuse("no-joints", "the file has no joints", "add joints: (or chain:)")
        refuse_clashes(self.balances, (*self.tables, *self.coefficients))
        self.check_runs()
