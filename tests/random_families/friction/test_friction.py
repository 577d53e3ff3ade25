"""Random loops with friction: against dense equations, and written otherwise.

`MECHKIN_RANDOM` multiplies them; `python -P tests/random_families/friction` judges any number.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from random_families.friction.__main__ import scaled
from random_families.friction.case import Answers, Judged, judge, rows
from random_families.friction.loops import Loop, loop
from random_families.friction.written_otherwise import (
    MILLIMETRE,
    doubled,
    in_millimetres,
    reordered,
    split,
    turned,
)

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
CLOSE = 1e-8
"""Parts of the largest number of its kind in which answers agree: radii are below 0.9."""


@pytest.mark.parametrize("actuators", [False, True], ids=["inputs", "actuators"])
@pytest.mark.parametrize("seed", range(8 * TIMES))
def test_all_forces(seed: int, actuators: bool) -> None:
    own = loop(seed, actuators=actuators)
    assert own is None or judge(own).fault == ""


@pytest.mark.parametrize("seed", range(6 * TIMES))
def test_next_to_the_limit(seed: int) -> None:
    """Decided below a spectral radius of 1, undecided above."""
    for low, high in ((0.99, 0.9999), (1.0001, 1.01)):
        drawn = loop(seed)
        assert drawn is not None
        own, _ = scaled(drawn, seed, low, high)
        judged = Judged() if own is None else judge(own)
        assert judged.fault == ""
        assert not judged.counts["ok" if low > 1.0 else "friction-undecided"]


def test_a_radius_next_to_one_with_a_kink_on_the_way() -> None:
    """Newton's whole steps go to and fro across a kink: halves do not."""
    for seed in (43, 57, 133):
        drawn = loop(seed)
        assert drawn is not None
        own, _ = scaled(drawn, seed, 0.9989, 0.9991)
        assert own is None or judge(own).fault == ""


Otherwise = Callable[[Loop, random.Random], Loop]


def gentle(seed: int) -> Loop:
    """A loop whose first row is surely decided."""
    drawn = loop(seed)
    assert drawn is not None
    own, _ = scaled(drawn, seed, 0.3, 0.8)
    if own is None:
        pytest.skip("nothing rubs, or nothing is assembled")
    return own


def scalars(own: Loop) -> dict[str, float]:
    """Efforts and normal loads, which no axes matter to, and friction powers."""
    answers = Answers(own.data)
    names = [f"{drive}.effort" for drive in own.drives]
    names += [f"{name}.{word}" for name in own.frictions for word in ("normal_load",)]
    names += [f"{name}.friction_power" for name in own.frictions]
    return {name: float(answers.at(0)(name)) for name in names}


@pytest.mark.parametrize("seed", range(4 * TIMES))
@pytest.mark.parametrize("otherwise", [turned, in_millimetres, reordered, doubled, split])
def test_written_otherwise(otherwise: Otherwise, seed: int) -> None:
    own = gentle(seed)
    plain = scalars(own)
    other = otherwise(own, random.Random(seed))
    found = scalars(other)
    for name, value in plain.items():
        factor = 2.0 if otherwise is doubled else 1.0
        if otherwise is in_millimetres and (name.endswith((".theta.effort", "power"))):
            factor = MILLIMETRE
        kind = name.rpartition(".")[2]
        largest = max(abs(v) for n, v in plain.items() if n.endswith(kind))
        assert abs(found[name] - factor * value) <= CLOSE * factor * largest, name


@pytest.mark.parametrize("seed", range(4 * TIMES))
def test_the_other_way(seed: int) -> None:
    """Rates reversed: reactions without friction are the same, friction turns round."""
    own = gentle(seed)
    inputs = {
        name: sweep | {"rate": "-" + sweep["rate"]}
        if sweep["rate"][0] != "-"
        else sweep | {"rate": sweep["rate"][1:]}
        for name, sweep in own.data["motion"]["inputs"].items()
    }
    back = replace(own, data=own.data | {"motion": {"inputs": inputs}})
    assert judge(back).fault == ""
    one, other = (rows(each, Answers(each.data))[0] for each in (own, back))
    scale = np.abs(one.right).max()
    assert np.abs(one.right - other.right).max() <= CLOSE * scale
    for name in own.frictions:
        for a, b in zip(
            one.friction().drag[name][:2], other.friction().drag[name][:2], strict=True
        ):
            assert np.abs(a + b).max() <= CLOSE


def test_a_wrong_coefficient_is_seen() -> None:
    """The check can fail: friction of other coefficients is not in balance."""
    own = gentle(0)
    answers = Answers(own.data)
    right, wrong = rows(own, answers)[0], rows(own.rubbing(1.001), answers)[0]
    name = next(iter(own.frictions))
    found = float(answers.at(0)(f"{name}.normal_load"))
    near, far = (row.friction() for row in (right, wrong))
    assert abs(near.force[name] / near.mu[name] / found - 1.0) < CLOSE
    assert abs(far.force[name] / far.mu[name] / found - 1.0) > 1e3 * CLOSE
