"""Kept mechanisms that a crank drives, with an idle loop or an idle link at the crank."""

from __future__ import annotations

from typing import NamedTuple

from oracle import document, with_links
from oracle.document import Document
from references import FILE_OF


class Crank(NamedTuple):
    """A link that turns about a point of ground, in the file's lengths."""

    link: str
    point: tuple[float, float, float]
    size: float


CRANKS = {
    "rcsr": Crank("crank", (-5.0, 0.0, 0.0), 1.0),
    "rssr": Crank("crank", (0.0, 0.0, 0.0), 50.0),
    "sevenr": Crank("one", (0.0, 0.0, 0.0), 1.0),
    "rcsr_csr": Crank("crank", (-5.0, 0.0, 0.0), 1.0),
    "slider_crank": Crank("one", (0.0, 0.0, 0.0), 0.1),
    "bennett": Crank("one", (0.0, 0.0, 0.0), 0.1),
}


def plain(name: str) -> Document:
    """The mechanism alone, without what is written of it."""
    data = document(FILE_OF[name])
    return {key: value for key, value in data.items() if key not in ("tables", "follow")}


def with_idle_loop(data: Document, crank: Crank) -> Document:
    """The crank moves a rocker of no use: R, S, S, R with a short crank, which turns freely."""

    def at(x: float, y: float, z: float) -> list[str]:
        return [repr(a + crank.size * b) for a, b in zip(crank.point, (x, y, z), strict=True)]

    joints = {
        "X1": {"type": "S", "links": [crank.link, "idle_rod"], "point": at(0.1, 0.2, -0.1)},
        "X2": {"type": "S", "links": ["idle_rod", "idle_rocker"], "point": at(2.0, 2.0, 0.3)},
        "X3": {
            "type": "R",
            "links": ["ground", "idle_rocker"],
            "point": at(3.0, -0.5, 0.4),
            "axis": ["0.1", "0.3", "1"],
        },
    }
    return with_links(data, {"idle_rod": {}, "idle_rocker": {}}, joints)


def with_idle_link(data: Document, crank: Crank) -> Document:
    """A link welded to the crank."""
    joints = {"X1": {"type": "W", "links": [crank.link, "idle"]}}
    return with_links(data, {"idle": {}}, joints)
