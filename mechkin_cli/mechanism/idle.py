"""Idle freedoms: legs spin freely about the line of their spheres.

Nothing else moves with that spin, so its pose is a convention (the shortest turn from the drawing)
and its rate is taken as zero. Forces are exact as long as nothing turns the leg about its line;
otherwise the spin is a dynamic freedom that a kinematic analysis cannot know.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.derived_quantities import (
    FINITE_KINDS,
    INSTANT_KINDS,
    ORIENTATION_KINDS,
)
from mechkin_cli.mechanism.legs import Leg, find_legs, frame_on
from mechkin_cli.mechanism.model import Attached, Damper, Link, LinkLoad, Mechanism, Spring
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.mechanism.vectors import Vector, cross, dot, norm, scale, subtract
from mechkin_cli.tape.scalars import largest
from mechkin_cli.units import LENGTH, MOMENT

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def spin_errors(problem: Problem) -> list[tuple[str, Diagnostic]]:
    """For every leg that something turns about its line: the link, and what to say.

    None if the file holds idle freedoms.
    """
    if problem.hold_idle:
        return []
    found = []
    for leg in find_legs(problem.mechanism):
        for link in leg.links:
            cause = _spin_cause(problem, leg, link)
            if cause is not None:
                found.append((link, _dynamic_freedom(leg, *cause)))
                break
    return found


def holding_notes(problem: Problem, moments: Mapping[str, Floats]) -> list[Diagnostic]:
    """The largest moment that holds each leg from spinning; `moments` (N m) by name, (rows,)."""
    notes = []
    for leg in find_legs(problem.mechanism):
        moment = moments.get(f"{leg.body}.holding_moment")
        if moment is None:
            continue
        row = np.abs(moment)
        largest = float(np.max(row[np.isfinite(row)], initial=0.0))
        text = f"{float(problem.units.from_si(largest, MOMENT)):.6g}"
        notes.append(
            Diagnostic(
                "held-spin",
                "note",
                f"{leg.words}; idle: hold keeps it from spinning by a moment about that line",
                measured=f"at most {text} {problem.units.label(MOMENT)}",
                hint=f"{leg.body}.holding_moment is its value in each row",
            )
        )
    return notes


def _dynamic_freedom(leg: Leg, cause: str, measured: str) -> Diagnostic:
    return Diagnostic(
        "loaded-spin",
        "error",
        f"{leg.words}, and {cause}: the spin is a dynamic freedom, forces depend on it",
        measured=measured,
        hint="replace one S by U, or accept a moment that holds it with idle: hold",
    )


def conventional_notes(problem: Problem, wanted: Iterable[Wanted]) -> list[Diagnostic]:
    """Notes on quantities that depend on the convention about a leg's spin."""
    wanted = list(wanted)
    notes = []
    for leg in find_legs(problem.mechanism):
        names = [q.name for q in wanted if _is_conventional(problem.mechanism, leg, q)]
        if names:
            notes.append(
                Diagnostic(
                    "conventional",
                    "note",
                    f"{leg.words}; by convention its pose is the shortest turn from the drawing "
                    f"and it does not spin: {', '.join(names)}",
                    hint="replace one S by U for a pose of its own",
                )
            )
    return notes


def _spin_cause(problem: Problem, leg: Leg, link: str) -> tuple[str, str] | None:
    """What turns a link of a leg about the leg's line: words, and a measure."""
    mechanism = problem.mechanism
    line, start = _line_on(leg, link)
    body = mechanism.links[link]

    def off_line(point: Vector) -> str | None:
        off = _distance(point, start, line)
        if off <= tolerances.ON_LINE * norm(leg.span):
            return None
        return f"{float(problem.units.from_si(off, LENGTH)):.4g} {problem.units.label(LENGTH)}"

    if body.mass != 0.0 and (off := off_line(body.center_of_mass)):
        return f"the mass centre of {link} lies off that line", off
    asymmetry = _asymmetry(body, line)
    if asymmetry > tolerances.ON_LINE:
        words = f"the inertia of {link} is not symmetric about that line"
        return words, f"{asymmetry:.2g} of its largest entry"
    for load in mechanism.loads:
        if isinstance(load, LinkLoad) and load.link == link:
            if load.kind == "torque":
                return f"a torque acts on {link}", "its part along the line"
            if off := off_line(load.point):
                return f"a force acts on {link} off that line", off
        if isinstance(load, Spring | Damper) and load.between:
            for end in load.between:
                if end.link == link and (off := off_line(end.vector)):
                    return f"a spring or damper pulls at {link} off that line", off
    return None


def _line_on(leg: Leg, link: str) -> tuple[Vector, Vector]:
    """The leg's line and a point of it, as drawn on one of its links."""
    if link == leg.body:
        return leg.line, frame_on(leg.start, link).o
    assert leg.slide is not None
    return frame_on(leg.slide, link).z, frame_on(leg.end, link).o


def _distance(point: Vector, start: Vector, line: Vector) -> float:
    return norm(cross(subtract(point, start), line))


def _asymmetry(body: Link, line: Vector) -> float:
    """How far a tensor is from k e e + m (1 - e e), in parts of its largest entry."""
    xx, yy, zz, xy, xz, yz = body.inertia
    rows: tuple[Vector, ...] = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    greatest = largest(*(abs(entry) for row in rows for entry in row))
    if greatest == 0.0:
        return 0.0
    along = dot(line, (dot(rows[0], line), dot(rows[1], line), dot(rows[2], line)))
    across = (xx + yy + zz - along) / 2.0
    worst = 0.0
    for i, row in enumerate(rows):
        for k, entry in enumerate(row):
            symmetric = (along - across) * line[i] * line[k] + (across if i == k else 0.0)
            worst = largest(worst, abs(entry - symmetric))
    return worst / greatest


def _is_conventional(mechanism: Mechanism, leg: Leg, quantity: Wanted) -> bool:
    if quantity.kind in ("omega", "alpha") or quantity.kind in INSTANT_KINDS | FINITE_KINDS:
        return quantity.owner in leg.links
    if quantity.kind in ORIENTATION_KINDS:
        joint = mechanism.joints[quantity.owner]
        return joint.first in leg.links or joint.second in leg.links
    if quantity.kind == "point":
        at = mechanism.points[quantity.owner]
        return at.link in leg.links and not _on_line(leg, at)
    if quantity.kind == "direction":
        at = mechanism.directions[quantity.owner]
        return at.link in leg.links and not _along_line(leg, at)
    return False


def _on_line(leg: Leg, at: Attached) -> bool:
    line, start = _line_on(leg, at.link)
    return _distance(at.vector, start, line) <= tolerances.ON_LINE * norm(leg.span)


def _along_line(leg: Leg, at: Attached) -> bool:
    line, _ = _line_on(leg, at.link)
    off = cross(scale(1.0 / (norm(at.vector) or 1.0), at.vector), line)
    return norm(off) <= tolerances.ON_LINE
