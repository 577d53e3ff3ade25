"""What drives idle freedoms: there they are dynamic freedoms, which kinematics does not know."""

from __future__ import annotations

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.held import Line
from mechkin_cli.mechanism.idle import Idle, idle_freedoms, times
from mechkin_cli.mechanism.model import Damper, JointLoad, Link, LinkLoad, Load, Spring, varying
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.vectors import Vector, cross, dot, norm
from mechkin_cli.tape.scalars import largest
from mechkin_cli.units import LENGTH


def spin_errors(problem: Problem, *, free: bool = False) -> list[tuple[str, Diagnostic]]:
    """For every idle freedom that something drives: the link, and what to say; in a `free` motion
    it may be one of the freedoms that the start names.

    None if the file holds idle freedoms.
    """
    if problem.hold_idle:
        return []
    found: list[tuple[str, Diagnostic]] = []
    for idle in idle_freedoms(problem):
        for link in idle.links:
            cause = _spin_cause(problem, idle, link)
            if cause is not None:
                cure = _cure_in_motion(idle) if free else idle.cure
                error = (link, _dynamic_freedom(idle, cure, *cause))
                found += [error] if error not in found else []
                break
    return found


def _cure_in_motion(idle: Idle) -> str:
    """How the start of a free motion comes to have an idle freedom for one of its own."""
    if idle.moves:
        return f"name {'.'.join(min(idle.moves))} in start: it is a freedom as others are"
    return (
        "give it a coordinate that start names: write one S as an R along that line and a U, with "
        "a link {} between"
    )


def _dynamic_freedom(idle: Idle, cure: str, cause: str, measured: str) -> Diagnostic:
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
            if load.axes == "link" and not _runs_along(load, line):
                return f"a force across that line turns with {link}", "its axes are the link's"
    if (
        isinstance(load, JointLoad | Spring | Damper)
        and (load.joint, load.coordinate) in idle.moves
    ):
        return f"a load acts on {load.joint}.{load.coordinate}", "which moves with it"
    if isinstance(load, Spring | Damper) and load.between:
        for end in load.between:
            if end.link != link:
                continue
            if line is None:
                return f"a spring or damper pulls at {link}", "which moves with it"
            if off := _off_line(problem, idle, line, end.vector):
                return f"a spring or damper pulls at {link} off that line", off
    return None


def _runs_along(load: LinkLoad, line: Line) -> bool:
    """Whether a constant force runs along a line."""
    if varying(load) or line.along is None:
        return False
    across = cross(load.value, line.along)  # type: ignore[arg-type]
    return norm(across) <= tolerances.ON_LINE * norm(load.value)  # type: ignore[arg-type]


def _asymmetry(body: Link, line: Vector) -> float:
    """How far a tensor is from k e e + m (1 - e e), in parts of its largest entry."""
    xx, yy, zz, xy, xz, yz = body.inertia
    rows: tuple[Vector, ...] = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    greatest = largest(*(abs(entry) for row in rows for entry in row))
    if greatest == 0.0:
        return 0.0
    along = dot(line, times(body, line))
    across = (xx + yy + zz - along) / 2.0
    worst = 0.0
    for i, row in enumerate(rows):
        for k, entry in enumerate(row):
            symmetric = (along - across) * line[i] * line[k] + (across if i == k else 0.0)
            worst = largest(worst, abs(entry - symmetric))
    return worst / greatest
