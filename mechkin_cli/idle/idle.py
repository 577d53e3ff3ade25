"""Idle freedoms: what moves freely while all else stands still, the convention about it, and what
mechkin reports of it.

The own links of a distance spin (`DistanceConstraint`): their pose is the shortest turn from the
drawing, and their rate is zero. Other idle freedoms are held at a coordinate (`hold`). Nothing else
moves with them. Forces are exact as long as nothing drives such a motion (`spin_errors`); otherwise
it is a dynamic freedom that a kinematic analysis cannot know.

A body that nothing turns about a line of its own, about which it is symmetric, has no spin: the
forces on it do not depend on its moment of inertia about that line, which is left out where a held
link turns with the link beside it (`without_spin`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.idle.find import Coordinate
from mechkin_cli.mechanism import (
    COEFFICIENT_KINDS,
    FINITE_KINDS,
    INSTANT_KINDS,
    ORIENTATION_KINDS,
    Attached,
    Bushing,
    Coordinate as NamedCoordinate,
    DistanceConstraint,
    Joint,
    Line,
    LinkLoad,
    Load,
    Problem,
    RigidLink,
    Vector,
    Wanted,
    base_name,
    base_quantity,
    cross,
    dot,
    norm,
    scale,
)
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.row_notes import Found, RowNote
from mechkin_cli.tape import largest
from mechkin_cli.units import LENGTH, MOMENT

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class Idle(NamedTuple):
    """An idle freedom of some links.

    `lines`: about what each turns, on its own drawing, None where that is no line of the link;
    `slides`: it does not turn; `moves`: coordinates that move with it; `length`: what distances
    from a line are compared with, m; `convention` and `cure`: in words, its pose by convention and
    how to give it one of its own; `holding`: the quantity that holds it.
    """

    words: str
    links: tuple[str, ...]
    lines: Mapping[str, Line | None]
    slides: bool
    moves: frozenset[Coordinate]
    length: float
    convention: str
    cure: str
    holding: str


def idle_freedoms(problem: Problem) -> Iterator[Idle]:
    """Spins, then what is held."""
    for spin in problem.mechanism.spins:
        yield _of_spin(spin)
    length = problem.mechanism.box_diagonal() if problem.held else 0.0
    for h in problem.held:
        if not h.idle:
            continue
        motion = h.words, h.links, h.axes, h.slides, h.moves
        yield Idle(*motion, length, h.convention, h.cure, h.holding)


def _of_spin(spin: DistanceConstraint) -> Idle:
    return Idle(
        spin.idle_words,
        spin.links,
        spin.lines,
        False,
        frozenset(),
        spin.length,
        spin.convention,
        spin.cure,
        spin.holding,
    )


def without_spin(problem: Problem) -> Problem:
    """The problem whose held links have no moment of inertia about the lines that they turn about;
    those that a moment holds (`idle: hold`) keep it."""
    if problem.hold_idle or not problem.held:
        return problem
    links = dict(problem.mechanism.links)
    for held in problem.held:
        for name, line in held.axes.items():
            if line is not None and links[name].has_mass:
                links[name] = _without_spin_about(links[name], line.along)
    return replace(problem, mechanism=replace(problem.mechanism, links=links))


def _without_spin_about(body: RigidLink, line: Vector | None) -> RigidLink:
    if line is None:  # free about its mass centre, it needs no moment
        return body._replace(inertia=(0.0,) * 6)
    along = dot(line, _times(body, line))
    (xx, yy, zz, xy, xz, yz), (x, y, z) = body.inertia, line
    turning = (xx - along * x * x, yy - along * y * y, zz - along * z * z)
    across = (xy - along * x * y, xz - along * x * z, yz - along * y * z)
    return body._replace(inertia=(*turning, *across))


def _times(body: RigidLink, a: Vector) -> Vector:
    """Its inertia tensor times a vector, kg m^2."""
    xx, yy, zz, xy, xz, yz = body.inertia
    return (dot((xx, xy, xz), a), dot((xy, yy, yz), a), dot((xz, yz, zz), a))


def holding_notes(problem: Problem, moments: Mapping[str, Floats]) -> list[RowNote]:
    """The largest moment (force) that holds each idle freedom; `moments` (N m, N) by name,
    (components, rows)."""
    notes = []
    for idle in idle_freedoms(problem):
        moment = moments.get(idle.holding)
        if moment is None:
            continue
        row = np.sqrt(sum(part * part for part in moment))
        most = np.where(np.isfinite(row), row, 0.0)
        words = partial(_held_spin, problem, idle)
        every = np.ones(most.size, dtype=bool)
        notes.append(RowNote("held-spin", "note", idle.holding, every, words, most))
    return notes


def _held_spin(problem: Problem, idle: Idle, found: Found) -> Diagnostic:
    dimension = problem.quantities()[idle.holding].dimension
    text = f"{float(problem.units.from_si(found.told, dimension)):.6g}"
    by = "moment about" if dimension == MOMENT else "force along"
    motion = "sliding" if idle.slides else "spinning"
    return Diagnostic(
        "held-spin",
        "note",
        f"{idle.words}; idle: hold keeps it from {motion} by a {by} that line",
        measured=f"at most {text} {problem.units.label(dimension)}",
        hint=f"{idle.holding} is its value in each row",
    )


def nearly_common_notes(problem: Problem) -> list[Diagnostic]:
    """Notes on motions that joints have in common but for more than rounding: results are those of
    the mechanism that has them."""
    return [
        Diagnostic(
            "nearly-common",
            "note",
            f"{held.words} but for what the drawing leaves; it is taken to do so exactly, and all "
            "results are off by about as much",
            measured=f"{held.miss:.2g} rad or sizes (limit {tolerances.COMMON_MOTION:g})",
            hint="write what coincides with all its digits, and draw the rest farther apart",
        )
        for held in problem.held
        if held.miss > tolerances.COMMON_MOTION_ROUNDING
    ]


def conventional_notes(problem: Problem, wanted: Iterable[Wanted]) -> list[Diagnostic]:
    """Notes on quantities that depend on the convention about an idle freedom."""
    wanted = list(wanted)
    notes: list[Diagnostic] = []
    noted: set[tuple[str, str]] = set()
    for idle in idle_freedoms(problem) if wanted else ():
        names = [q.name for q in wanted if _is_conventional(problem, idle, q)]
        if names and (idle.words, idle.convention) not in noted:
            noted.add((idle.words, idle.convention))
            notes.append(
                Diagnostic(
                    "conventional",
                    "note",
                    f"{idle.words}; by convention {idle.convention}: {', '.join(names)}",
                    hint=f"{idle.cure} for a pose of its own",
                )
            )
    return notes


def _is_conventional(problem: Problem, idle: Idle, quantity: Wanted) -> bool:
    if quantity.kind in COEFFICIENT_KINDS:
        quantity = base_quantity(problem.quantities(), base_name(quantity))
    mechanism, kind, owner = problem.mechanism, quantity.kind, quantity.owner
    if kind == "coordinate":
        return (owner, quantity.coordinate) in idle.moves
    if kind in ("omega", "alpha"):
        return owner in idle.links and not idle.slides
    if kind in INSTANT_KINDS | FINITE_KINDS:
        return owner in idle.links
    if kind in ORIENTATION_KINDS:
        joint = mechanism.joints[owner]
        held = joint.first in idle.links, joint.second in idle.links
        return held[0] != held[1] and not idle.slides
    if kind == "point":
        return _point_moves(idle, mechanism.points[owner])
    if kind == "direction":
        return _direction_moves(idle, mechanism.directions[owner])
    if kind == "axis":
        return _direction_moves(idle, mechanism.joints[owner].axis)
    if kind in ("force", "moment") and _works_askew(problem, idle, owner, kind == "force"):
        return True
    if kind in ("joint_point", "moment"):
        return _point_moves(idle, mechanism.joints[owner].point)
    if kind == "slip":
        joint = mechanism.joints[owner]
        contact = Attached(joint.second, joint.on_second.o)
        return _point_moves(idle, joint.point) or _point_moves(idle, contact)
    return False


def _works_askew(problem: Problem, idle: Idle, owner: str, slides: bool) -> bool:
    """Whether a drive or a load works along (slides) or about an axis of a joint that turns with an
    idle motion: what the joint bears is without it, and turns, too."""
    joint = problem.mechanism.joints.get(owner)
    if joint is None:  # a pair that holds
        return False
    worked = {name for driven, name in problem.motion.driven if driven == owner}
    at = [load.acts_at for load in problem.mechanism.loads if load.acts_at is not None]
    worked |= {name for loaded, name in at if loaded == owner}
    return any(
        _axis_moves(idle, joint, known)
        for known in (joint.type.coordinate[name] for name in sorted(worked))
        if known.is_angle != slides
    )


def _axis_moves(idle: Idle, joint: Joint, coordinate: NamedCoordinate) -> bool:
    """Whether an idle motion turns the axis of a coordinate: of two turns either of the axes, and
    what both links carry only where both turn it."""
    ends = [Attached(joint.first, joint.on_first.z), Attached(joint.second, joint.on_second.z)]
    if coordinate.axis is None:
        return any(_direction_moves(idle, end) for end in ends)
    if joint.type.is_guide:
        return all(_direction_moves(idle, end) for end in ends)
    return _direction_moves(idle, joint.drawn(coordinate.axis))


def _point_moves(idle: Idle, at: Attached) -> bool:
    if at.link not in idle.links:
        return False
    line = idle.lines[at.link]
    return line is None or line.distance(at.vector) > tolerances.ON_LINE * idle.length


def _direction_moves(idle: Idle, at: Attached) -> bool:
    if at.link not in idle.links or idle.slides:
        return False
    line = idle.lines[at.link]
    if line is None or line.along is None:
        return True
    off = cross(scale(1.0 / (norm(at.vector) or 1.0), at.vector), line.along)
    return norm(off) > tolerances.ON_LINE


def spin_errors(problem: Problem, *, free: bool = False) -> list[tuple[str, Diagnostic]]:
    """For every idle freedom that something drives: the link, and an error; in a `free` motion it
    may be one of the freedoms that the start names. None if the file holds idle freedoms."""
    if problem.hold_idle:
        return []
    errors: list[tuple[str, Diagnostic]] = []
    for idle in idle_freedoms(problem):
        for link in idle.links:
            cause = _spin_cause(problem, idle, link)
            if cause is not None:
                error = (link, _dynamic_freedom(idle, *cause, free=free))
                errors += [error] if error not in errors else []
                break
    return errors


def _dynamic_freedom(idle: Idle, cause: str, measured: str, *, free: bool) -> Diagnostic:
    cure = idle.cure
    if free and idle.moves:
        cure = f"name {'.'.join(min(idle.moves))} in start: it is a freedom as others are"
    elif free:
        cure = "give it a coordinate that start names: write one S as an R along that line and a U,"
        cure += " with a link {} between"
    motion, what = ("slide", "a force") if idle.slides else ("spin", "a moment")
    return Diagnostic(
        "loaded-spin",
        "error",
        f"{idle.words}, and {cause}: the {motion} is a dynamic freedom, forces depend on it",
        measured=measured,
        hint=f"{cure}, or accept {what} that holds it with idle: hold",
    )


def _spin_cause(problem: Problem, idle: Idle, link: str) -> tuple[str, str] | None:
    """What drives an idle freedom at one of its links: words, and a measure."""
    mechanism = problem.mechanism
    body, line = mechanism.links[link], idle.lines[link]
    for load in mechanism.loads:
        if (cause := _load_cause(problem, idle, link, load)) is not None:
            return cause
    if line is None:
        if body.has_mass:
            return f"{link} has mass", f"{body.mass:.4g} kg"
        return None
    if body.mass != 0.0 and (off := _off_line(problem, idle, line, body.center_of_mass)):
        where = "centre" if line.along is None else "line"
        return f"the mass centre of {link} lies off that {where}", off
    asymmetry = 0.0 if line.along is None else _asymmetry(body, line.along)
    if asymmetry > tolerances.ON_LINE:
        words = f"the inertia of {link} is not symmetric about that line"
        return words, f"{asymmetry:.2g} of its largest entry"
    return None


def _off_line(problem: Problem, idle: Idle, line: Line, point: Vector) -> str | None:
    """How far a point lies off a line, in the file's units; None if it lies on it."""
    off = line.distance(point)
    if off <= tolerances.ON_LINE * idle.length:
        return None
    return f"{float(problem.units.from_si(off, LENGTH)):.4g} {problem.units.label(LENGTH)}"


def _load_cause(problem: Problem, idle: Idle, link: str, load: Load) -> tuple[str, str] | None:
    line = idle.lines[link]
    if isinstance(load, LinkLoad) and load.link == link:
        if load.kind == "torque" and not idle.slides:
            return f"a torque acts on {link}", "its part along the line"
        if load.kind == "force":
            if line is None:
                return f"a force acts on {link}", "its part along the motion"
            if off := _off_line(problem, idle, line, load.point):
                return f"a force acts on {link} off that line", off
            if load.axes == "link" and not _acts_along(load, line):
                return f"a force across that line turns with {link}", "its axes are the link's"
    if isinstance(load, Bushing) and link in load.links:
        return f"a bushing holds {link}", "which moves with it"
    if load.acts_at is not None and load.acts_at in idle.moves:
        return f"a load acts on {'.'.join(load.acts_at)}", "which moves with it"
    for end in load.ends:
        if end.link != link:
            continue
        if line is None:
            return f"a spring or damper pulls at {link}", "which moves with it"
        if off := _off_line(problem, idle, line, end.vector):
            return f"a spring or damper pulls at {link} off that line", off
    return None


def _acts_along(load: LinkLoad, line: Line) -> bool:
    """Whether a constant force acts along a line."""
    if load.varying or line.along is None:
        return False
    across = cross(load.value, line.along)  # type: ignore[arg-type]
    return norm(across) <= tolerances.ON_LINE * norm(load.value)  # type: ignore[arg-type]


def _asymmetry(body: RigidLink, line: Vector) -> float:
    """How far a tensor is from k e e + m (1 - e e), in parts of its largest entry."""
    xx, yy, zz, xy, xz, yz = body.inertia
    rows: tuple[Vector, ...] = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    greatest = largest(*(abs(entry) for row in rows for entry in row))
    if greatest == 0.0:
        return 0.0
    along = dot(line, _times(body, line))
    across = (xx + yy + zz - along) / 2.0
    worst = 0.0
    for i, row in enumerate(rows):
        for k, entry in enumerate(row):
            symmetric = (along - across) * line[i] * line[k] + (across if i == k else 0.0)
            worst = largest(worst, abs(entry - symmetric))
    return worst / greatest
