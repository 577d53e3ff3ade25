"""A mechanism beside its copy, with an idle loop, or with an idle link: as much is proven, of the
same place."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from oracle import beside_itself, document, to_text, with_links
from oracle.document import Document
from references import MECHANISMS

import mechkin_cli as mk
from mechkin_cli.interface.certificate import Certificate


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
    data = document(MECHANISMS / f"{name}.yaml")
    return {key: value for key, value in data.items() if key not in ("tables", "follow")}


def with_idle_loop(name: str) -> Document:
    """The crank moves a rocker of no use: R, S, S, R with a short crank, which turns freely."""
    its = CRANKS[name]

    def at(x: float, y: float, z: float) -> list[str]:
        return [repr(a + its.size * b) for a, b in zip(its.point, (x, y, z), strict=True)]

    joints = {
        "X1": {"type": "S", "links": [its.link, "idle_rod"], "point": at(0.1, 0.2, -0.1)},
        "X2": {"type": "S", "links": ["idle_rod", "idle_rocker"], "point": at(2.0, 2.0, 0.3)},
        "X3": {
            "type": "R",
            "links": ["ground", "idle_rocker"],
            "point": at(3.0, -0.5, 0.4),
            "axis": ["0.1", "0.3", "1"],
        },
    }
    return with_links(plain(name), {"idle_rod": {}, "idle_rocker": {}}, joints)


def with_idle_link(name: str) -> Document:
    """A link welded to the crank."""
    joints = {"X1": {"type": "W", "links": [CRANKS[name].link, "idle"]}}
    return with_links(plain(name), {"idle": {}}, joints)


@cache
def known(name: str) -> Certificate:
    return mk.loads(to_text(plain(name))).certify()


MORE = {
    "beside itself": lambda name: beside_itself(plain(name)),
    "with an idle loop": with_idle_loop,
    "with an idle link": with_idle_link,
}


def overlap(one: Any, other: Any) -> bool:
    low, high = np.maximum(one[0], other[0]), np.minimum(one[1], other[1])
    return bool((low <= high).all())


@pytest.mark.parametrize("more", MORE)
@pytest.mark.parametrize("name", CRANKS)
def test_with_more(name: str, more: str) -> None:
    alone, certificate = known(name), mk.loads(to_text(MORE[more](name))).certify()
    assert "not proven" not in alone.status
    assert certificate.status.tolist() == alone.status.tolist()
    assert certificate.is_one_branch
    compared = 0
    for coordinate in alone.analysis.result.coordinates:
        for suffix in ("", "_dot", "_ddot"):
            try:
                box = alone.enclosure(coordinate + suffix)
            except mk.UsageError:  # the angle of a joint that closes a loop
                continue
            joint, _, rest = (coordinate + suffix).partition(".")
            copies = [f"{joint}.{rest}", f"{joint}_again.{rest}"]
            for copy in copies[: 2 if more == "beside itself" else 1]:
                assert overlap(box, certificate.enclosure(copy)), copy
                compared += 1
    assert compared >= 6
