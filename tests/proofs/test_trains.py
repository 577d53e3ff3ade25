"""Loops that hang on each other: what is known of one is known of the next, in proofs too."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from oracle import mp

import mechkin_cli as mk
from benchmarks import train
from mechkin_cli.analysis.certificate import Certificate

LOOPS = 40
MOTION = "{from: 0 deg, to: 50 deg, step: 1 deg}"


def rocker_angles(crank: Any, loops: int) -> list[Any]:
    """How far each rocker of the train has turned from its drawing, at 40 digits: the tip lies on
    two circles, on the side of the frame on which it is drawn."""
    angle, found = mp.mpf(crank), []
    for k in range(loops):
        one, other = (mp.mpf(16 + n % 2) / 10 for n in (k, k + 1))
        coupler = mp.sqrt(16 + (one - other) ** 2)
        x, y = -one * mp.sin(angle) - 4, one * mp.cos(angle)
        distance = mp.sqrt(x * x + y * y)
        along = (distance**2 + other**2 - coupler**2) / (2 * distance)
        beside = mp.sqrt(other**2 - along**2)
        tip = (along * x + beside * y) / distance, (along * y - beside * x) / distance
        angle = mp.atan2(-tip[0], tip[1])
        found.append(angle)
    return found


@cache
def certificate(loops: int = LOOPS) -> Certificate:
    return mk.loads(train.text(loops, MOTION)).certify()


def test_forty_loops_are_enclosed() -> None:
    """With blocks taken one by one the last rockers had radii of 1e-6, and the sweep 104 tubes."""
    proofs = certificate()
    assert proofs.is_one_branch
    assert proofs.tubes <= 12
    boxes = [proofs.enclosure(f"G{k + 1}.theta") for k in range(LOOPS)]
    with mp.workdps(40):
        for row in (0, 7, 30, 50):
            for (low, high), true in zip(boxes, rocker_angles(mp.radians(row), LOOPS), strict=True):
                assert low[row] <= true <= high[row]
                assert high[row] - low[row] < 1e-11


def test_a_jump_in_the_middle_of_a_train_is_not_proven() -> None:
    """The state of one rocker off by more than its box, whatever those before and behind it are."""
    result = mk.loads(train.text(12, MOTION)).analyze(tables=[]).result
    states = result.row_states.states
    for number in range(1, states.shape[0], 5):
        states[number, 20] += 1e-3
    assert not result.certificate.on_branch[20]
    assert result.certificate.on_branch[:20].all()


IDLE_LINKS = "  idle1: {}\n  idle2: {}\njoints:"
IDLE_JOINTS = """
  X1: {type: R, links: [bar0, idle1], point: [0, 1.6, 0], axis: [0, 0, 1]}
  X2: {type: R, links: [idle1, idle2], point: [0, 2.6, 0], axis: [0, 0, 1]}
  X3: {type: R, links: [ground, idle2], point: [-1, 3, 0], axis: [0, 0, 1]}
motion:"""


def test_a_loop_beside_the_others_leaves_their_boxes() -> None:
    """A four-bar that hangs on the train's crank, and on which nothing hangs."""
    text = train.text(6, MOTION)
    more = text.replace("joints:", IDLE_LINKS).replace("\nmotion:", IDLE_JOINTS)
    one, other = mk.loads(text).certify(), mk.loads(more).certify()
    assert one.is_one_branch
    assert other.is_one_branch
    for k in range(6):
        (low, high), (least, most) = (x.enclosure(f"G{k + 1}.theta") for x in (one, other))
        assert (np.maximum(low, least) <= np.minimum(high, most)).all()
        assert np.allclose(most - least, high - low, rtol=0.2)
