"""Links of the file to rigid bodies: mass, mass centre, inertia in ground axes of the home
drawing."""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.places import place_at
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism.model import Link, Tensor
from mechkin_cli.mechanism.vectors import ZERO, Vector, cross, dot
from mechkin_cli.schema import links as written
from mechkin_cli.tape.scalars import Recorded, advice, largest
from mechkin_cli.units import INERTIA, MASS

NO_INERTIA: Tensor = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def build_links(
    fields: Fields, sections: Mapping[str, written.Link], accepted: bool
) -> dict[str, Link]:
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
                tensor = _about_normal(tensor)
            if not accepted:
                _check_physical(fields, (*path, "inertia"), name, tensor)
        links[name] = Link(name, mass, centre, tensor)
    return links


def _tensor(fields: Fields, path: Path, section: written.LinkInertia) -> Tensor:
    def entry(name: str, text: str) -> float:
        return fields.number((*path, name), text, INERTIA)

    entries = (
        entry("xx", section.xx),
        entry("yy", section.yy),
        entry("zz", section.zz),
        entry("xy", section.xy),
        entry("xz", section.xz),
        entry("yz", section.yz),
    )
    if section.axes is None:
        return entries
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
    return _in_ground_axes(entries, (x, y, cross(x, y)))


def _in_ground_axes(entries: tuple[float, ...], axes: tuple[Vector, Vector, Vector]) -> Tensor:
    """Sum of I_ij a_i a_j^T over the axes a_i."""
    xx, yy, zz, xy, xz, yz = entries
    matrix = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))

    def entry(p: int, q: int) -> float:
        total = 0.0
        for i in range(3):
            for j in range(3):
                total += matrix[i][j] * (axes[i][p] * axes[j][q])
        return total

    return (entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2))


def _about_normal(tensor: Tensor) -> Tensor:
    """The tensor of a ball with its moment about the normal: a plane asks for no other."""
    normal = tensor[2]
    return (normal, normal, normal, 0.0, 0.0, 0.0)


def _is_surely_physical(tensor: tuple[float, ...]) -> bool:
    """Whether the second moments of mass tr(I)/2 - I are those of a body, judged by the pivots of
    their elimination: as `_check_physical` with half its slack, and no eigenvalues."""
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
            from mechkin_cli.tape.traced import TraceLost

            raise TraceLost(f"the inertia of {name} belongs to no real body")
        return
    import numpy as np

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
