"""Links and what joins them: bodies, the joints of `joints:` and `chain:`, the way to ground.

Rows (theta, s, alpha, a) of a chain become joints and links of the mechanism. With Z(theta, s) a
screw about and along z, and X(alpha, a) one about and along x, the frame behind row i is F_i =
F_(i-1) Z(theta_i, s_i) X(alpha_i, a_i), from F_0, the ground axes, on; a loop closes with F_n =
F_0. Joint i lies on z of F_(i-1); its point is the foot of the common normal behind it, which is
the origin of F_(i-1) Z(theta_i, s_i). That is the drawing, where all coordinates are zero: the
angle from x to x about the axis is theta_i plus the joint's coordinate. Row n is drawn twice,
behind the rows before it and in front of the ground axes, X(alpha_n, a_n)^-1: where the two differ,
the drawing is not assembled. Source: J. Denavit, R. S. Hartenberg, A kinematic notation for
lower-pair mechanisms, 1955.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path, place_at
from mechkin_cli.building.joints import build_joints, lead_of
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import (
    GROUND_NAME,
    ZERO,
    Frame,
    Joint,
    Part,
    RigidLink,
    Tensor,
    Vector,
    add,
    cross,
    dot,
    frame_about,
    scale,
    subtract,
    unit,
    upright,
)
from mechkin_cli.schema import ChainRow, MechanismFile, links_joints as written
from mechkin_cli.tape import Recorded, TraceLost, advice, cos, largest, sin
from mechkin_cli.units import ANGLE, INERTIA, LENGTH, MASS

NO_INERTIA: Tensor = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def build_links(
    fields: Fields, sections: Mapping[str, written.Link], accepted: bool
) -> dict[str, RigidLink]:
    """All links; unphysical inertias warn unless the file acknowledges them."""
    links = {}
    for name, section in sections.items():
        path: Path = ("links", name)
        mass, centre, tensor = 0.0, ZERO, NO_INERTIA
        if section.mass is not None and section.center_of_mass is not None:
            mass = fields.number((*path, "mass"), section.mass, MASS)
            if mass < 0.0:
                fields.error("negative-mass", (*path, "mass"), "a mass is not negative")
            centre = place_at(fields, (*path, "center_of_mass"), section.center_of_mass, name)
        if section.inertia is not None:
            tensor = _tensor(fields, (*path, "inertia"), section.inertia)
            if fields.plane:
                # a plane only knows the moment about its normal: that of a ball
                tensor = (tensor[2], tensor[2], tensor[2], 0.0, 0.0, 0.0)
            if not accepted:
                _check_physical(fields, (*path, "inertia"), name, tensor)
        links[name] = RigidLink(name, mass, centre, tensor)
    return links


def _tensor(fields: Fields, path: Path, section: written.LinkInertia) -> Tensor:
    names = ("xx", "yy", "zz", "xy", "xz", "yz")
    texts = [getattr(section, name) for name in names]
    xx, yy, zz, xy, xz, yz = (
        fields.number((*path, name), text, INERTIA) for name, text in zip(names, texts, strict=True)
    )
    if section.axes is None:
        return xx, yy, zz, xy, xz, yz
    x = fields.direction((*path, "axes", "x"), section.axes.x)
    y = fields.direction((*path, "axes", "y"), section.axes.y)
    cosine = dot(x, y)
    if abs(cosine) > tolerances.AXES_SQUARE:
        fields.error(
            "axes-not-square",
            (*path, "axes"),
            "the axes of an inertia must be square to each other",
            "write them as expressions",
            measured=f"cosine of their angle {cosine:.3g}",
            limit=f"{tolerances.AXES_SQUARE:g}",
            numbers=(Number("cosine", abs(cosine), limit=tolerances.AXES_SQUARE),),
        )
    axes = (x, y, cross(x, y))
    matrix = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))

    def entry(p: int, q: int) -> float:
        """Of the sum of I_ij a_i a_j^T over the axes a_i."""
        total = 0.0
        for i in range(3):
            for j in range(3):
                total += matrix[i][j] * (axes[i][p] * axes[j][q])
        return total

    return (entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2))


def _is_surely_physical(tensor: tuple[float, ...]) -> bool:
    """Whether the second moments of mass tr(I)/2 - I are those of a body, judged by the pivots of
    their elimination: as `_check_physical` with half its slack, without eigenvalues."""
    xx, yy, zz, xy, xz, yz = tensor
    slack = 0.5 * tolerances.UNPHYSICAL_INERTIA * largest(abs(xx), abs(yy), abs(zz))
    a, b, c = (
        (yy + zz - xx) / 2.0 + slack,
        (xx + zz - yy) / 2.0 + slack,
        (xx + yy - zz) / 2.0 + slack,
    )
    if not advice(a > 0.0):
        return False
    b, yz, c = b - xy * xy / a, -yz - xy * xz / a, c - xz * xz / a
    return advice(b > 0.0) and advice(c - yz * yz / b > 0.0)


def _check_physical(fields: Fields, path: Path, name: str, tensor: tuple[float, ...]) -> None:
    """Principal moments of a real body are not negative and none exceeds the sum of the others."""
    recorded = [entry for entry in tensor if isinstance(entry, Recorded)]
    if recorded:
        if not all(entry.is_settled for entry in recorded) and not _is_surely_physical(tensor):
            raise TraceLost(f"the inertia of {name} belongs to no real body")
        return
    xx, yy, zz, xy, xz, yz = tensor
    moments = np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    slack = tolerances.UNPHYSICAL_INERTIA * float(np.abs(moments).max())
    if moments[0] >= -slack and moments[2] <= moments[0] + moments[1] + slack:
        return
    in_file = [float(fields.units.from_si(float(m), INERTIA)) for m in moments]
    unit = fields.units.label(INERTIA)
    fields.diagnostics.append(
        Diagnostic(
            "unphysical-inertia",
            "warning",
            f"the inertia of {name} belongs to no real body",
            fields.document.place(path),
            measured=f"principal moments {', '.join(f'{m:.6g}' for m in in_file)} {unit}",
            hint="a principal moment is not negative and not above the sum of the other two; "
            "accept: [unphysical-inertia] acknowledges it",
            numbers=tuple(Number("principal moment", m, unit) for m in in_file),
        )
    )


def build_linkage(
    fields: Fields, file: MechanismFile
) -> tuple[dict[str, RigidLink], dict[str, Joint]]:
    """Links and joints by name; a link that only `chain:` names has no mass. Every link must be
    joined to ground."""
    links = build_links(fields, file.links, "unphysical-inertia" in file.accept)
    # each row's joint lies behind the link before
    chain = list(pairwise([GROUND_NAME, *(row.link for row in file.chain)]))
    links |= {
        name: RigidLink(name) for _, name in chain if name != GROUND_NAME and name not in links
    }
    joints = build_joints(fields, file.joints, links)
    if chain:
        joints |= build_chain(fields, file.chain, chain)
    pairs = [(joint.links[0], joint.links[1]) for joint in file.joints.values()]
    _check_connected(fields, links, [*pairs, *chain])
    return links, joints


def _check_connected(
    fields: Fields, links: Mapping[str, object], pairs: Sequence[tuple[str, str]]
) -> None:
    if any(name not in links and name != GROUND_NAME for pair in pairs for name in pair):
        return  # a misspelt link, reported at its joint
    joined: dict[str, list[str]] = {}
    for first, second in pairs:
        joined.setdefault(first, []).append(second)
        joined.setdefault(second, []).append(first)
    reached, front = {GROUND_NAME}, [GROUND_NAME]
    for link in front:
        more = [other for other in joined.get(link, ()) if other not in reached]
        reached.update(more)
        front += more
    for name in links:
        if name not in reached:
            fields.key_error(
                "disconnected-link",
                ("links", name),
                f"link {name} is not joined to ground, nor to a link that is",
                "add a joint, or remove the link",
            )


def build_chain(
    fields: Fields, rows: Sequence[ChainRow], pairs: Sequence[tuple[str, str]]
) -> dict[str, Joint]:
    """The joints of a chain between the links of `pairs`; errors are noted in `fields`."""
    if not _closes_at_ground(fields, rows):
        fields.refused |= {row.joint for row in rows} | {link for _, link in pairs}
        return {}
    joints = {}
    ground = upright(scale(-1.0, fields.origin))
    here = ground
    for i, (row, (first, second)) in enumerate(zip(rows, pairs, strict=True)):
        theta = fields.number(("chain", i, "theta"), row.theta, ANGLE)
        s = fields.number(("chain", i, "s"), row.s, LENGTH)
        alpha = fields.number(("chain", i, "alpha"), row.alpha, ANGLE)
        a = fields.number(("chain", i, "a"), row.a, LENGTH)
        at_joint = _along_z(here, theta, s)
        here = _along_x(at_joint, alpha, a)
        behind = at_joint
        if second == GROUND_NAME:
            behind = _along_x(ground, -alpha, -a)
        parts = (Part(row.type, at_joint, behind),)
        lead = lead_of(fields, ("chain", i, "lead"), row.lead) if row.lead is not None else 0.0
        joints[row.joint] = Joint(row.joint, row.type, first, second, at_joint, behind, parts, lead)
    return joints


def _closes_at_ground(fields: Fields, rows: Sequence[ChainRow]) -> bool:
    """Whether the rows run from ground over differing links back to ground."""
    errors = fields.error_count
    last = len(rows) - 1
    seen: set[str] = set()
    for i, row in enumerate(rows):
        path = ("chain", i, "link")
        if row.link == GROUND_NAME:
            if i < last:
                text = f"the chain is back at ground before its last row ({last + 1})"
                fields.error("chain-ends-early", path, text, "name the link behind this joint")
        elif row.link in seen:
            text = f"the chain comes through link {row.link} twice"
            fields.error("chain-crosses-itself", path, text, "name another link")
        elif i == last:
            text = f"the chain ends at link {row.link}"
            fields.error("open-chain", path, text, "the last row closes the loop: link: ground")
        seen.add(row.link)
    if last == 0 and fields.error_count == errors:
        text = "a chain of one row joins ground to itself"
        fields.error("short-chain", ("chain", 0), text, "a loop has two rows or more")
    return fields.error_count == errors


def _along_z(frame: Frame, angle: float, distance: float) -> Frame:
    """The frame moved by a screw about its own z."""
    x, _ = _turned(frame.x, frame.y, angle)
    return frame_about(frame.z, x, add(frame.o, scale(distance, frame.z)))


def _along_x(frame: Frame, angle: float, distance: float) -> Frame:
    """The frame moved by a screw about its own x."""
    _, z = _turned(frame.y, frame.z, angle)
    return frame_about(unit(z), frame.x, add(frame.o, scale(distance, frame.x)))


def _turned(p: Vector, q: Vector, angle: float) -> tuple[Vector, Vector]:
    """Two square unit vectors turned from p towards q."""
    c, s = cos(angle), sin(angle)
    return add(scale(c, p), scale(s, q)), subtract(scale(c, q), scale(s, p))
