"""Some of the random loops; more: `python -P tests/random_families/subgroups --seeds 0:500`."""

from __future__ import annotations

import os
import random
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from oracle.numerics import mpmath_context as mp
from random_families.subgroups.judge import OFF, judged, run_one, written
from random_families.subgroups.linkage import FAMILIES, TILTS, Joint, Linkage, Tilt, by_fractions

import mechkin_cli as mk

COUNT = 15 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(COUNT))
def test_what_the_text_says_is_proven_and_nothing_else(seed: int) -> None:
    outcome = run_one(seed)
    assert not outcome.fault, f"{outcome.fault}\n{outcome.text}"


def drawn(name: str) -> tuple[Linkage, Tilt]:
    rng = random.Random(f"one {name}")
    return FAMILIES[name](rng), by_fractions(rng)


@pytest.mark.parametrize("off", OFF)
@pytest.mark.parametrize("name", [name for name in FAMILIES if name != "slides"])
def test_with_a_number_off_nothing_is_proven(name: str, off: str) -> None:
    """Rather than taken for rounding."""
    linkage, tilt = drawn(name)
    try:
        proofs = mk.loads(written(linkage, tilt, off, "B")).certify()
    except mk.MechkinError:
        assert abs(float(off)) > 1e-8
        return
    assert not (proofs.status == "proven").any()
    if abs(float(off)) < 1e-13:
        assert (proofs.status == "proven to closure").all()
        assert (proofs.closure > 0.0).all()


def test_a_reference_beside_the_truth_is_seen() -> None:
    linkage, tilt = drawn("four-bar")

    def beside(theta: Any, near: Any) -> Any:
        return linkage.reference(theta, near) + mp.mpf("1e-11")

    wrong = replace(linkage, reference=beside)
    assert "does not hold" in judged(wrong, written(wrong, tilt)).fault


@pytest.mark.parametrize("name", list(FAMILIES))
def test_however_it_is_written_and_tilted(name: str) -> None:
    """Renamed, its joints in another order, its links the other way round, turned."""
    linkage, _ = drawn(name)
    for tilt in TILTS:
        there = tilt(random.Random(name))
        assert judged(linkage, written(linkage, there)).remark == "proven"
    names = {"A": "Z", "B": "Y", "C": "X", "D": "W", "E": "V", "F": "U", "G": "T"}
    joints = {names[key]: joint for key, joint in reversed(linkage.joints.items())}
    kind = linkage.input.partition(".")[2]
    other = replace(linkage, joints=joints, input=f"Z.{kind}")
    assert (mk.loads(written(other, there)).certify().status == "proven").all()


def test_two_loops_side_by_side_and_an_idle_one() -> None:
    """A second four-bar on the same crank at another height, and another that nothing needs."""
    linkage, tilt = drawn("four-bar")
    joints = dict(linkage.joints)
    for copy in ("two", "three"):
        for name in "BCD":
            joint = linkage.joints[name]
            x, y, z = joint.point
            links = tuple(n if n in ("ground", "crank") else f"{n}_{copy}" for n in joint.links)
            joints[f"{name}{copy}"] = Joint("R", links, (x, y, z + 1), joint.axis)  # type: ignore[arg-type]
    both = replace(linkage, joints=joints)
    assert judged(both, written(both, tilt)).remark == "proven"


def test_a_third_equal_bar_does_not_follow() -> None:
    """Its equation in the plane holds by the bars' lengths, not by the plane."""
    linkage, tilt = drawn("four-bar")
    places = {"A": (0, 0), "B": (0, 1), "C": (3, 1), "D": (3, 0), "E": (1, 0), "F": (1, 1)}
    ends = ("ground", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("ground", "rocker")
    ends += ("ground", "third"), ("coupler", "third")
    joints = {
        name: replace(linkage.joints["A"], links=links, point=tuple(map(Fraction, (*at, k % 3))))
        for k, ((name, at), links) in enumerate(zip(places.items(), ends, strict=True))
    }
    proofs = mk.loads(written(replace(linkage, joints=joints), tilt)).certify()
    assert (proofs.status == "proven to closure").all()
