"""A mechanism beside its copy, with an idle loop, or with an idle link: as much is proven, of the
same place."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from idle_parts import CRANKS, plain, with_idle_link, with_idle_loop
from oracle import beside_itself, to_text

import mechkin_cli as mk
from mechkin_cli.analysis.certificate import Certificate


@cache
def known(name: str) -> Certificate:
    return mk.loads(to_text(plain(name))).certify()


MORE = {
    "beside itself": lambda name: beside_itself(plain(name)),
    "with an idle loop": lambda name: with_idle_loop(plain(name), CRANKS[name]),
    "with an idle link": lambda name: with_idle_link(plain(name), CRANKS[name]),
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
