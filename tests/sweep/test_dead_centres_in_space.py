"""Rows at a dead centre of several inputs, of spatial mechanisms, with friction, of laws of time,
and as a sweep's first.

Towards what a quantity goes there is told by closed forms of 40 digits just beside it.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from sweep.dead_centre_texts import FIVE_BAR, PAIRS, spatial

import mechkin_cli as mk

ENDS = ["ok", "ok", "ok", "dead-centre"]


def crank(kind: str, phi: mp.mpf) -> mp.mpf:
    """The crank's angle of the spatial mechanisms, of the end of the rocker at `phi`."""
    d = PAIRS[kind][1]
    x, z = d + 20 * mp.cos(phi), 10 + 20 * mp.sin(phi)
    across = z if kind == "RSSR" else mp.mpf(0)
    return mp.acos((x**2 + across**2 + 30**2 - 50**2) / (60 * x))


def turned(kind: str, degrees: float) -> mp.mpf:
    """By how much the crank has turned from its drawing at 120 degrees."""
    return crank(kind, mp.radians(mp.mpf(degrees))) - crank(kind, mp.radians(mp.mpf(120)))


@pytest.mark.parametrize("kind", list(PAIRS))
def test_spatial_mechanisms(kind: str) -> None:
    r = mk.loads(spatial(kind)).analyze(["D.effort", "A.theta_dot", "A.force"])
    assert r["row.status"].tolist() == ENDS
    with mp.workdps(40):
        # the input turns by -1 rad/s as phi falls; the torque's power is 3000 N*mm times the rate
        slopes = [mp.diff(lambda p: crank(kind, p), mp.radians(p)) for p in (120, 110, 100)]
        beside = mp.diff(lambda p: crank(kind, p), mp.radians(90 + mp.mpf("1e-8")))
        place = float(mp.degrees(turned(kind, 90)))
    known = [float(-slope) for slope in slopes]
    np.testing.assert_allclose(r["A.theta_dot"][:3], known, rtol=1e-13)
    np.testing.assert_allclose(r["D.effort"][:3], [3000 * k for k in known], rtol=1e-13)
    assert beside > 1e3
    assert r["A.theta_dot"][3] == r["D.effort"][3] == -np.inf
    assert r["norm(A.force)"][3] == np.inf
    assert r["A.theta"][3] == pytest.approx(place, abs=1e-5)


def test_what_is_zero_does_not_grow_with_the_rest() -> None:
    r = mk.loads(spatial("RCSR")).analyze(["C.force", "B.s_dot"])
    # the slide along z takes no force along it, and the end of the rocker stands still in z there
    assert np.isnan(r["C.force"][3, 2])
    assert np.isnan(r["B.s_dot"][3])
    assert np.isinf(r["C.force"][3, 0])


def test_two_inputs() -> None:
    names = ["A.effort", "E.effort", "B.theta_dot"]
    r = mk.loads(FIVE_BAR).analyze(names)
    assert r["row.status"].tolist() == ENDS
    with mp.workdps(40):

        def rod(a: mp.mpf, e: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
            """Angle of the first rod, and height of C, of the cranks' angles."""
            b, d = mp.mpc(40 * mp.expj(a)), 100 + 40 * mp.expj(e)
            half = (d - b) / 2
            c = b + half + 1j * half / abs(half) * mp.sqrt(70**2 - abs(half) ** 2)
            return mp.arg(c - b), c

        def work(k: int, near: mp.mpf) -> mp.mpf:
            """What the load at C does along one crank's angle, negative: its effort."""
            a, e = mp.pi / 2 + near, mp.pi / 2 - near
            moved = mp.diff(lambda t: rod(a + (k == 0) * t, e + (k == 1) * t)[1], 0)
            return -(10 * mp.re(moved) + 20 * mp.im(moved))

        for row in range(3):
            near = mp.radians(10 * row)
            for k, name in enumerate(names[:2]):
                assert r[name][row] == pytest.approx(float(work(k, near)), rel=1e-12)
        beside = mp.radians(30) - mp.mpf("1e-8")
        signs = [mp.sign(work(k, beside)) for k in (0, 1)]
        assert min(abs(work(k, beside)) for k in (0, 1)) > 1e5
    assert [r[name][3] for name in names[:2]] == [float(s) * np.inf for s in signs]
    assert r["B.theta_dot"][3] == -np.inf


@pytest.mark.parametrize("kind", list(PAIRS))
def test_first_row(kind: str) -> None:
    names = ["D.effort", "A.theta_dot"]
    there = mk.loads(spatial(kind)).analyze(names)
    back = mk.loads(spatial(kind, values="-30, -20, -10, 0")).analyze(names)
    assert back["row.status"].tolist() == ENDS[::-1]
    for name in names:
        np.testing.assert_array_equal(back[name][0], there[name][3])
        np.testing.assert_allclose(back[name][1:], there[name][2::-1], rtol=1e-13)
    # drawn at the dead centre: which side is a choice, how steep is none
    drawn = mk.loads(spatial(kind, 90.0, "0, 10, 20, 30")).analyze(names)
    assert drawn["row.status"].tolist() == ENDS[::-1]
    for name in names:
        np.testing.assert_allclose(np.abs(drawn[name]), np.abs(back[name]), rtol=1e-9)


FRICTION = "  - {{type: friction, joint: {}, coefficient: 0.1, radius: 8 mm}}\n"


def test_friction_jams_the_crank_before_its_dead_centre() -> None:
    """A torque that holds the crank back, whose arm has come into the circle of friction, is
    overcome by no effort; rates have nothing to do with it."""
    text = spatial("RCSR", more=FRICTION.format("A"))
    r = mk.loads(text).analyze(["D.effort", "A.theta_dot", "A.force"])
    assert r["row.status"].tolist() == ENDS
    assert r["A.theta_dot"][3] == -np.inf
    assert np.isnan(r["D.effort"][3])
    assert np.isnan(r["norm(A.force)"][3])
    assert not any("inf" in str(note) for note in r.diagnostics if note.code != "at-dead-centre")


def test_friction_of_the_driven_joint_leaves_its_effort_infinite() -> None:
    r = mk.loads(spatial("RCSR", more=FRICTION.format("D"))).analyze(["D.effort"])
    assert r["D.effort"][3] == -np.inf
    notes = [str(note) for note in r.diagnostics if note.code == "friction-uncounted"]
    assert notes
    assert not any("inf" in note for note in notes)


def test_law_of_time() -> None:
    """At constant rate what rates and accelerations do is infinite; where the law comes to rest at
    the dead centre, both have limits that no row can tell."""
    base = spatial("RSSR").replace("values: [0, -10, -20, -30], rate: -1 rad/s", "{law}")
    base = base.replace("motion:\n", "motion:\n  time: {from: 0, to: 3, step: 1}\n")
    base = base.replace(
        "crank: {}", "crank: {mass: 1, center_of_mass: [0, 0, 0], inertia: {zz: 9}}"
    )
    steady = base.replace("{law}", "law: constant-rate, at: 0, rate: -10 deg/s")
    r = mk.loads(steady).analyze(["A.theta_ddot", "row.kinetic_energy", "D.effort"])
    assert r["row.status"].tolist() == ENDS
    assert r["A.theta_ddot"][3] == -np.inf
    assert r["row.kinetic_energy"][3] == np.inf
    resting = base.replace("{law}", "law: cycloidal, from: 0, to: -30")
    r = mk.loads(resting).analyze(["A.theta_dot", "D.effort"])
    assert r["row.status"].tolist() == ENDS
    assert np.isnan(r["A.theta_dot"][3])
