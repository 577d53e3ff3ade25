"""Load cases for finite elements: what acts on every link at chosen rows, as tables and as steps.

Everything that acts on a link is a force and a moment at a point: of each joint, of the loads that
the file applies, of gravity, and of inertia by d'Alembert. Their sums are zero, row by row, and
what is missing from them is named. `loads_link.csv` has them in the drawing's axes, carried along
with the link, which are those of a mesh made from the drawing; `loads_ground.csv` where the link
is.

For CalculiX each link and row has a file to `*INCLUDE` behind the mesh, in N, mm, t and s. A joint
is a rigid body of the mesh whose reference nodes take its force and its moment; gravity and inertia
are loads of the whole volume.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.balances import borne_wrenches, row_motion
from mechkin_cli.bridges.parts import Exported, listed
from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.mechanism import GROUND_NAME, is_told, is_written
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables import run_parameter
from mechkin_cli.units import FORCE, LENGTH, MOMENT
from mechkin_cli.verdict import SWEEP, __version__

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.balances import RowMotion
    from mechkin_cli.bridges.parts import ExportOptions
    from mechkin_cli.mechanism import RigidLink
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats

MOST_ROWS: Final = 1000
"""Rows of an export: each is a set of load cases that somebody computes."""

_MM: Final = 1e3


class LinkWrench(NamedTuple):
    """What acts on a link: its kind and name, and a force (N) and a moment (N m) about a point (m),
    in ground axes."""

    link: str
    kind: str
    name: str
    point: Floats
    force: Floats
    moment: Floats


def export(model: Model, options: ExportOptions) -> Exported:
    """The load cases of a run at some rows; without any, at those where a joint's force is largest.

    Raises:
        UsageError: a row that the run does not have, or too many.
    """
    analysis = _analysis(model, options)
    rows = _rows(analysis, options.rows)
    cases = {row: list(_whole(analysis, row)) for row in rows}
    files = {
        f"loads_{axes}.csv": _table(analysis, cases, axes == "link").encode()
        for axes in ("link", "ground")
    }
    for row, loads in cases.items():
        for link in dict.fromkeys(load.link for load in loads):
            own = [load for load in loads if load.link == link]
            files[f"{link}_row_{row + 1}.inp"] = _steps(analysis, row, link, own).encode()
    return Exported(files, tuple(_notes(analysis, cases)))


def _analysis(model: Model, options: ExportOptions) -> Analysis:
    """The run, with everything that load cases read."""
    run = options.run or (SWEEP if SWEEP in model.runs else model.runs[0])
    if run != SWEEP:
        (analysis,) = model.analyses(run, options.mode)
        return analysis
    asked = [name for name in model.quantities if name.endswith((".total_force", ".total_moment"))]
    return model.analyze(asked, tables=[], mode=options.mode)


def _joints(analysis: Analysis) -> list[str]:
    mechanism = analysis.result.problem.mechanism
    known = analysis.result.problem.quantities()
    return [n for n in mechanism.joints if is_told(n) and f"{n}.total_force" in known]


def _rows(analysis: Analysis, asked: tuple[int, ...]) -> list[int]:
    """Rows from 0."""
    if len(asked) > MOST_ROWS:
        raise UsageError(f"--row names {len(asked)} rows (limit {MOST_ROWS}); name fewer")
    for row in asked:
        if row > analysis.rows:
            run = f"the run {analysis.run} has {analysis.rows} rows"
            raise UsageError(f"--row {row}: {run}; name one of them")
        if not analysis.result.solved[row - 1]:
            word = analysis["row.status"][row - 1]
            raise UsageError(f"row {row} of {analysis.run} has no position ({word}); name another")
    if asked:
        return sorted({row - 1 for row in asked})
    peaks = set()
    for joint in _joints(analysis):
        sizes = np.linalg.norm(analysis[f"{joint}.total_force"], axis=1)
        if np.isfinite(sizes).any():
            peaks.add(int(np.nanargmax(sizes)))
    if not peaks:
        raise UsageError(
            f"no joint of {analysis.model.name} has a unique reaction in any row; write the file "
            "in a plane (plane: xy), free the joints that hold twice, or name a --row"
        )
    return sorted(peaks)


def _loads(analysis: Analysis, row: int) -> Iterator[LinkWrench]:
    """What acts on each moving link at a row: joints, then what the file applies, gravity, inertia,
    the last three at the mass centre."""
    result = analysis.result
    motion, mechanism = row_motion(result, row), result.problem.mechanism
    borne = borne_wrenches(result, motion, row)
    names = _joints(analysis)
    for link, body in mechanism.links.items():
        if link == GROUND_NAME or not is_written(link):
            continue
        for name in names:
            joint = mechanism.joints[name]
            if link in (joint.first, joint.second):
                sign = 1.0 if joint.second == link else -1.0
                point = np.array(motion.point(joint.point))
                force = sign * _in_space(analysis, f"{name}.total_force", row)
                moment = sign * _in_space(analysis, f"{name}.total_moment", row)
                yield LinkWrench(link, "joint", name, point, force, moment)
        centre = _middle(analysis, link, motion)
        weight = body.mass * np.array(mechanism.gravity)
        inertia = _inertia(body, motion)
        total, about = (np.array(part) for part in borne[link])
        force = total - weight - inertia[0]
        moment = about - np.cross(centre, total) - inertia[1]
        # what is left of a difference of large numbers is no load
        size = np.abs(total).max() + np.abs(weight).max() + np.abs(inertia[0]).max()
        force = np.where(np.abs(force) > tolerances.NO_LOAD * size, force, 0.0)
        arm = size * float(np.linalg.norm(centre)) + np.abs(about).max() + np.abs(inertia[1]).max()
        moment = np.where(np.abs(moment) > tolerances.NO_LOAD * arm, moment, 0.0)
        if force.any() or moment.any():
            yield LinkWrench(link, "applied", "loads", centre, force, moment)
        if weight.any():
            yield LinkWrench(link, "gravity", "gravity", centre, weight, np.zeros(3))
        if inertia[0].any() or inertia[1].any():
            yield LinkWrench(link, "inertia", "inertia", centre, *inertia)


def _middle(analysis: Analysis, link: str, motion: RowMotion) -> Floats:
    """Where a resultant acts: at the mass centre; of a link without mass at its first joint."""
    mechanism = analysis.result.problem.mechanism
    body, names = mechanism.links[link], _joints(analysis)
    own = [n for n in names if link in (mechanism.joints[n].first, mechanism.joints[n].second)]
    if body.mass or not own:
        return np.array(motion[link].point(body.center_of_mass))
    return np.array(motion.point(mechanism.joints[own[0]].point))


def _remainder(loads: list[LinkWrench], centre: Floats) -> LinkWrench:
    """What else acts on a link, by the sums of what is known: a wrench at its mass centre."""
    force = -sum((one.force for one in loads), np.zeros(3))
    moments = (one.moment + np.cross(one.point - centre, one.force) for one in loads)
    return LinkWrench(
        loads[0].link, "remainder", "couplings", centre, force, -sum(moments, np.zeros(3))
    )


def _whole(analysis: Analysis, row: int) -> Iterator[LinkWrench]:
    """All loads at a row; where couplings or friction act, on links that these leave out of balance
    what is missing."""
    mechanism = analysis.result.problem.mechanism
    loads, motion = list(_loads(analysis, row)), row_motion(analysis.result, row)
    has_more = bool(mechanism.couplings or mechanism.frictions)
    for link in dict.fromkeys(one.link for one in loads):
        own = [one for one in loads if one.link == link]
        yield from own
        known = all(np.isfinite([*one.force, *one.moment]).all() for one in own)
        left = _unbalanced(own, mechanism.box_diagonal()) if has_more and known else 0.0
        if left > tolerances.LOADS_BALANCED:
            yield _remainder(own, _middle(analysis, link, motion))


def _inertia(body: RigidLink, motion: RowMotion) -> tuple[Floats, Floats]:
    """-m a through the mass centre, and -(I alpha + omega x I omega)."""
    own = motion[body.name]
    xx, yy, zz, xy, xz, yz = body.inertia
    axes = np.array([own.frame.x, own.frame.y, own.frame.z]).T
    tensor = axes @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ axes.T
    omega, alpha = np.array(own.omega), np.array(own.alpha)
    couple = tensor @ alpha + np.cross(omega, tensor @ omega)
    return -body.mass * np.array(own.acceleration_of(body.center_of_mass)), -couple


def _in_space(analysis: Analysis, name: str, row: int) -> Floats:
    """A force or a moment in SI; in a plane a force has two components and a moment one."""
    units = analysis.result.units
    dimension = FORCE if name.endswith("force") else MOMENT
    value = np.atleast_1d(np.asarray(units.to_si(analysis[name][row], dimension), dtype=float))
    if value.size == 3:
        return value
    return np.append(value, 0.0) if value.size == 2 else np.array([0.0, 0.0, value[0]])


def _notes(analysis: Analysis, cases: dict[int, list[LinkWrench]]) -> Iterator[Diagnostic]:
    """Links whose sums are not zero, and joints whose reactions are not unique."""
    size = analysis.result.problem.mechanism.box_diagonal()
    empty: dict[str, None] = {}
    rest: dict[str, None] = {}
    off: dict[str, float] = {}
    for loads in cases.values():
        for link in dict.fromkeys(load.link for load in loads):
            own = [load for load in loads if load.link == link]
            lost = [one.name for one in own if not np.isfinite([*one.force, *one.moment]).all()]
            empty |= dict.fromkeys(lost)
            if lost:
                continue
            rest |= {one.link: None for one in own if one.kind == "remainder"}
            share = _unbalanced(own, size)
            if share > tolerances.LOADS_BALANCED:
                off[link] = max(share, off.get(link, 0.0))
    if empty:
        yield Diagnostic(
            "empty-load",
            "warning",
            f"the reactions of {listed(empty)} are not unique, and their cells are empty",
            hint="write the file in a plane (plane: xy), or free the joints that hold twice",
        )
    if rest:
        yield Diagnostic(
            "remainder",
            "note",
            f"what couplings and friction do to {listed(rest)} is one force and one moment, found "
            "by the balance of the link",
            hint="move them to where the teeth, the belt or the rubbing surface is",
        )
    if off:
        worst = max(off.values())
        yield Diagnostic(
            "unbalanced-load",
            "warning",
            f"what acts on {listed(off)} does not add up to zero",
            measured=f"{worst:.2g} of the largest force",
            hint="what rods without bodies, curves and drives of points do is not among the loads; "
            "add it by hand",
        )


def _unbalanced(loads: list[LinkWrench], size: float) -> float:
    """The sum of forces, or of moments about the first point over the size of the mechanism, over
    the largest force."""
    force = sum((one.force for one in loads), np.zeros(3))
    about = loads[0].point
    moment = sum(
        (one.moment + np.cross(one.point - about, one.force) for one in loads), np.zeros(3)
    )
    sizes = [float(np.linalg.norm(one.force)) for one in loads]
    sizes += [float(np.linalg.norm(one.moment)) / size for one in loads]
    largest = max(sizes)
    if largest == 0.0:
        return 0.0
    return max(float(np.linalg.norm(force)), float(np.linalg.norm(moment)) / size) / largest


def _table(analysis: Analysis, cases: dict[int, list[LinkWrench]], on_link: bool) -> str:
    """All loads as CSV, in the file's units; of joints without a unique reaction empty cells."""
    units, along = analysis.result.units, run_parameter(analysis.result)
    words = [f"{along.name} [{along.unit}]" if along and along.unit else along and along.name]
    head = ["row", *(word for word in words if word), "link", "kind", "name"]
    dimensions = (("point", LENGTH), ("force", FORCE), ("moment", MOMENT))
    for word, dimension in dimensions:
        head += [f"{word} {axis} [{units.label(dimension)}]" for axis in "xyz"]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(head)
    for row, loads in cases.items():
        motion = row_motion(analysis.result, row)
        place = [] if along is None else [repr(float(along.values[row]))]
        for load in loads:
            if on_link:
                load = _on_link(analysis, motion, load)
            vectors = (load.point, load.force, load.moment)
            cells = [
                "" if np.isnan(number) else repr(float(number) + 0.0)
                for vector, (_, dimension) in zip(vectors, dimensions, strict=True)
                for number in np.asarray(units.from_si(vector, dimension)).tolist()
            ]
            writer.writerow([row + 1, *place, load.link, load.kind, load.name, *cells])
    return stream.getvalue()


def _on_link(analysis: Analysis, motion: RowMotion, load: LinkWrench) -> LinkWrench:
    """The same in the axes of the drawing, which the link carries along."""
    own, datum = motion[load.link], np.array(analysis.result.problem.mechanism.datum)
    axes = np.array([own.frame.x, own.frame.y, own.frame.z])
    point = axes @ (load.point - np.array(own.frame.o)) + np.array(own.reference) + datum
    return load._replace(point=point, force=axes @ load.force, moment=axes @ load.moment)


def _steps(analysis: Analysis, row: int, link: str, loads: list[LinkWrench]) -> str:
    """A step of CalculiX with the loads of one link at one row."""
    motion = row_motion(analysis.result, row)
    mechanism = analysis.result.problem.mechanism
    body, own = mechanism.links[link], motion[link]
    axes = np.array([own.frame.x, own.frame.y, own.frame.z])
    placed = [_on_link(analysis, motion, load) for load in loads]
    at = [one for one in placed if one.kind in ("joint", "applied", "remainder")]
    lines = [
        f"** {link} of {mechanism.name}, {analysis.run}, row {row + 1}; made by mechkin "
        f"{__version__}",
        "** N, mm, t, s; axes of the drawing. Include this file behind the mesh of the link.",
        "** Element set EALL: the whole link. Hold six degrees of freedom at three nodes; their",
        "** reactions are what mesh and mechanism differ by.",
    ]
    for one in at:
        point = " ".join(_text(x) for x in one.point * _MM)
        lines.append(f"** {one.name}: *RIGID BODY, NSET={one.name}, REF NODE=r, ROT NODE=t")
        lines.append(f"**   with r in the node set {one.name}_REF at {point}, t in {one.name}_ROT")
    lines += ["*STEP", "*STATIC", "*CLOAD, OP=NEW"]
    for one in at:
        lines += _components(f"{one.name}_REF", one.force)
        lines += _components(f"{one.name}_ROT", one.moment * _MM)
    gravity, datum = np.array(mechanism.gravity), np.array(mechanism.datum)
    lines += _volume_loads(body, axes, motion, gravity, datum)
    lines += ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP"]
    return "\n".join(lines) + "\n"


def _components(nodes: str, vector: Floats) -> list[str]:
    return [f"{nodes}, {k}, {_text(x)}" for k, x in enumerate(vector, 1) if x != 0.0 and x == x]


def _volume_loads(
    body: RigidLink, own_axes: Floats, motion: RowMotion, gravity: Floats, datum: Floats
) -> list[str]:
    """Gravity less the acceleration of the mass centre, and the turning about it."""
    own = motion[body.name]
    centre = (np.array(body.center_of_mass) + datum) * _MM
    felt = own_axes @ (gravity - np.array(own.acceleration_of(body.center_of_mass))) * _MM
    omega, alpha = own_axes @ np.array(own.omega), own_axes @ np.array(own.alpha)
    lines = []
    size = float(np.linalg.norm(felt))
    if size > 0.0:
        lines.append(f"EALL, GRAV, {_text(size)}, {', '.join(_text(x) for x in felt / size)}")
    speed = float(np.linalg.norm(omega))
    if speed > 0.0:
        place = ", ".join(_text(x) for x in (*centre, *(omega / speed)))
        lines.append(f"EALL, CENTRIF, {_text(speed**2)}, {place}")
    if lines:
        lines.insert(0, "*DLOAD, OP=NEW")
    if alpha.any():
        turning = " ".join(_text(x) for x in alpha)
        lines.append(f"** without a load of CalculiX: angular acceleration {turning} rad/s^2")
    return lines


def _text(number: float) -> str:
    """A number in the 20 characters that CalculiX reads of a field."""
    return f"{float(number) + 0.0:.12g}"
