"""Mechanisms whose mobility is known from theory, as text of format 1; none declares inputs."""

from __future__ import annotations


def text(links: str, joints: list[str]) -> str:
    body = "\n".join(f"  {joint}" for joint in joints)
    names = ", ".join(f"{name}: {{}}" for name in links.split())
    return f"format: 1\nname: test\nlinks: {{{names}}}\njoints:\n{body}\n"


def joint(name: str, letter: str, links: str, point, axis=None, **more: object) -> str:
    first, second = links.split()
    keys = {"type": letter, "links": f"[{first}, {second}]", "point": list(point)}
    if axis is not None:
        keys["axis"] = list(axis)
    words = ", ".join(f"{key}: {value}" for key, value in (keys | more).items())
    return f"{name}: {{{words}}}"


def ring(letters: str, points, axes, **more: object) -> str:
    """A single loop; `more` (lead) goes to every H."""
    count = len(letters)
    links = ["ground", *(f"L{k}" for k in range(1, count)), "ground"]
    joints = [
        joint(
            f"J{k + 1}",
            letter,
            f"{links[k]} {links[k + 1]}",
            points[k],
            None if letter == "S" else axes[k],
            **(more if letter == "H" else {}),
        )
        for k, letter in enumerate(letters)
    ]
    return text(" ".join(links[1:-1]), joints)


POINTS = [
    (0.1, 0.2, -0.3), (0.9, -0.1, 0.2), (1.1, 0.8, 0.4), (0.4, 1.2, -0.2),
    (-0.5, 0.9, 0.3), (-0.8, 0.1, 0.6), (-0.3, -0.6, 0.1),
]  # fmt: skip
AXES = [
    (0.2, 0.9, -0.4), (-0.7, 0.3, 0.6), (0.5, 0.5, 0.8), (0.9, -0.2, 0.3),
    (-0.1, 0.6, 0.7), (0.4, -0.8, 0.5), (0.3, 0.2, 0.9),
]  # fmt: skip
Z = (0, 0, 1)


def general(letters: str, **more: object) -> str:
    return ring(letters, POINTS, AXES, **more)


def planar(letters: str = "RRRR") -> str:
    return ring(letters, [(0, 0, 0), (0, 1, 0), (2, 1.5, 0), (2.5, 0, 0)], [Z] * 4)


def sarrus() -> str:
    """Two chains of three parallel hinges between the same two plates: a plate that goes straight
    up."""
    x = [(1.0, -0.5, 0.0), (1.5, -0.5, 0.5), (1.0, -0.5, 1.0)]
    y = [(-0.5, 1.0, 0.0), (-0.5, 1.5, 0.5), (-0.5, 1.0, 1.0)]
    return ring("RRRRRR", [*x, *reversed(y)], [(0, 1, 0)] * 3 + [(1, 0, 0)] * 3)


def bricard() -> str:
    """The trihedral 6R linkage as three mutually square axes through either of two corners of a
    cube: a plane-symmetric threefold ring of six unit edges."""
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1), (0, 0, 1)]
    axes = []
    for k, here in enumerate(corners):
        before, after = corners[k - 1], corners[(k + 1) % 6]
        a = [h - b for h, b in zip(here, before, strict=True)]
        b = [n - h for n, h in zip(after, here, strict=True)]
        axes.append(
            (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
        )
    return ring("RRRRRR", corners, axes)


def double_spherical() -> str:
    """S-S-R-R: the link between the two spheres spins."""
    return general("RSSR")


def leg() -> str:
    """A slider on a guide, and a cylinder with two spheres from ground to it: a strut whose two
    halves spin together."""
    return text(
        "slider tube rod",
        [
            joint("G", "P", "ground slider", (0, 0, 0), (1, 0, 0)),
            joint("A", "S", "ground tube", (0, 2, 0.3)),
            joint("B", "P", "tube rod", (0.5, 1, 0.3), (1, -2, 0)),
            joint("C", "S", "rod slider", (1, 0, 0.3)),
        ],
    )


def stretched() -> str:
    """A planar three-bar chain drawn straight: its middle moves to first order only."""
    return ring("RRR", [(0, 0, 0), (1, 0, 0), (3, 0, 0)], [Z] * 3)


def coaxial_hinge() -> str:
    """A planar four-bar whose coupler has two coaxial hinges at one end, with a collar between."""
    points = [(0, 0, 0), (0, 1, 0), (0, 1, 0.2), (2, 1.5, 0), (2.5, 0, 0)]
    return ring("RRRRR", points, [Z] * 5)
