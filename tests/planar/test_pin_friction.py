"""Friction of a pin in its slot: quick-return motion against a closed form, and what is refused."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

TEXT = """
format: 1
name: quick return
plane: xy
units: {length: mm, angle: deg, force: N}
links: {crank: {}, bar: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: Ps, links: LINKS, point: [30, 0], slot: SLOT}
  C: {type: R, links: [ground, bar], point: [-60, 0]}
motion: {inputs: {A.theta: {from: 20, to: 340, step: 32, rate: RATE rad/s}}}
loads:
  - {type: torque, link: bar, torque: -1000}
  - {type: friction, joint: B, coefficient: 0.1}
"""
NAMES = ["A.effort", "B.normal_load", "B.friction_power", "B.friction_force"]


def text(slot: str = "[1, 0]", rate: str = "10", links: str = "[crank, bar]") -> str:
    return TEXT.replace("SLOT", slot).replace("RATE", rate).replace("LINKS", links)


@pytest.mark.parametrize("rate", [10, -10])
@pytest.mark.parametrize("slot", ["[1, 0]", "[-2, 0]"])
def test_quick_return(rate: int, slot: str) -> None:
    r = mk.loads(text(slot, str(rate))).analyze(NAMES)
    with mp.workdps(30):
        for row, degrees in enumerate(r["A.theta"]):
            a = mp.radians(mp.mpf(float(degrees)))

            def arm(t: mp.mpf) -> mp.mpc:
                return 60 + 30 * mp.expj(t)

            turn = mp.diff(lambda t: mp.arg(arm(t)), a)
            slide = mp.diff(lambda t: abs(arm(t)), a)
            # the pin presses square to the bar, by whose torque alone the bar is held
            normal = 1000 / abs(arm(a))
            lost = mp.mpf("0.1") * normal * abs(slide) * abs(rate)
            effort = (1000 * turn * rate + lost) / rate
            assert r["B.normal_load"][row] == pytest.approx(float(normal), rel=1e-12)
            assert abs(r["B.friction_power"][row]) == pytest.approx(float(lost), rel=1e-9)
            assert r["A.effort"][row] == pytest.approx(float(effort), rel=1e-11)
            rubs = np.linalg.norm(r["B.friction_force"][row])
            assert rubs == pytest.approx(float(normal / 10), rel=1e-12)


def test_the_slot_in_the_crank() -> None:
    """The pair with its links exchanged: the pin on the bar, the slot in the crank, turns about C.
    Mirrored about the middle of the two pivots it is the same linkage driven at its other end."""
    r = mk.loads(text(links="[bar, crank]")).analyze(NAMES)
    with mp.workdps(30):
        for row, degrees in enumerate(r["A.theta"]):
            a = mp.radians(mp.mpf(float(degrees)))

            def pin(t: mp.mpf) -> mp.mpf:
                """How far the pin, 90 from C, is out along the crank's slot."""
                return 60 * -mp.cos(t) + mp.sqrt(90**2 - (60 * mp.sin(t)) ** 2)

            def bar(t: mp.mpf) -> mp.mpf:
                return mp.arg(pin(t) * mp.expj(t) + 60)

            turn, slide = mp.diff(bar, a), mp.diff(pin, a)
            # power: the load's, the drive's, and what is lost; the friction along the crank's slot
            # turns the bar, too, and so the normal load: N (n + sign mu e) x arm = 1000
            out = pin(a) * mp.expj(a) + 60
            e, n = mp.expj(a), 1j * mp.expj(a)

            def moment(force: mp.mpc, at: mp.mpc = out) -> mp.mpf:
                return (mp.conj(at) * force).imag

            # on the pin against its motion along the slot, whichever way the slot presses
            for side in (1, -1):
                load = side * n - mp.mpf("0.1") * mp.sign(slide) * e
                normal = 1000 / moment(load)
                if normal > 0:
                    break
            lost = mp.mpf("0.1") * normal * abs(slide) * 10
            assert r["B.normal_load"][row] == pytest.approx(float(normal), rel=1e-11)
            assert r["A.effort"][row] == pytest.approx(float(1000 * turn + lost / 10), rel=1e-10)


def test_what_other_joints_take_is_refused() -> None:
    with pytest.raises(mk.InvalidFile, match="a joint of type Ps, has no radius"):
        mk.loads(text().replace("coefficient: 0.1", "coefficient: 0.1, radius: 3 mm"))
    weld = "B: {type: W, links: [crank, bar]}"
    old = text()
    begin, end = old.index("B: {type"), old.index("\n", old.index("B: {type"))
    with pytest.raises(mk.InvalidFile, match="friction is known for R, P, Ps"):
        mk.loads(old[:begin] + weld + old[end:])
