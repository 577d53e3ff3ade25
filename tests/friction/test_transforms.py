"""The same mechanism with friction, written otherwise, has the same answers."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from friction.slider_crank import TEXT
from oracle import (
    document,
    in_other_units,
    moved,
    mp,
    renamed,
    reordered,
    rotation_matrix,
    swapped_links,
    to_text,
)

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel

SCALARS = ("A.effort", "A.normal_load", "B.normal_load", "C.normal_load", "D.normal_load")
POWERS = tuple(f"{joint}.friction_power" for joint in "ABCD")


def answers(data, names=(*SCALARS, *POWERS), **options):
    text = data if isinstance(data, str) else to_text(data)
    analysis = mk.loads(text).analyze(list(names), tables=[], **options)
    assert analysis.diagnostics == ()
    return {name: analysis[name] for name in names}


@cache
def plain():
    return answers(TEXT)


def close(found, expected, limit=1e-13):
    for name, value in expected.items():
        assert np.abs(found[name] - value).max() <= limit * np.abs(value).max(), name


@pytest.mark.parametrize("joint", ["B", "C"])
def test_links_in_the_other_order(joint):
    """The shoes of a guide ride on its second link: D would be another one."""
    close(answers(swapped_links(document(TEXT), joint)), plain())


@pytest.mark.parametrize(("joint", "axis"), [("B", "[0, 0, -1]"), ("D", "[-1, 0, 0]")])
def test_the_axis_the_other_way(joint, axis):
    data = document(TEXT)
    data["joints"][joint]["axis"] = axis[1:-1].split(", ")
    close(answers(data), plain())


def test_the_drawing_turned():
    turned = moved(
        document(TEXT), rotation_matrix(1, 2, -1, 3), [mp.mpf(30), mp.mpf(-7), mp.mpf(4)]
    )
    close(answers(turned), plain(), 1e-12)


def test_other_names_and_another_order():
    names = {"A": "Q", "B": "A", "rod": "bar"}
    back = {
        name: "".join(names.get(part, part) for part in name.partition(".")) for name in plain()
    }
    found = answers(renamed(reordered(document(TEXT), 3), names), back.values())
    close({name: found[back[name]] for name in plain()}, plain())


def test_loads_in_another_order():
    data = document(TEXT)
    data["loads"].reverse()
    close(answers(data), plain())


def test_other_units():
    units = {"length": "m", "angle": "rad", "mass": "kg", "force": "kN", "time": "ms"}
    found = answers(in_other_units(document(TEXT), units))
    ratio = dict.fromkeys(SCALARS, 1e-3) | {"A.effort": 1e-6} | dict.fromkeys(POWERS, 1e-9)
    close(found, {name: ratio[name] * value for name, value in plain().items()})


def test_run_backwards():
    """Without masses friction knows directions alone: any speed, and forth is not back."""
    data = document(TEXT)
    for link in data["links"].values():
        link.clear()
    data["loads"][3]["coefficient"] = "0.1"
    data["motion"]["inputs"]["A.theta"]["rate"] = "1 rad/s"
    slow = answers(data)
    data["motion"]["inputs"]["A.theta"]["rate"] = "1000 rad/s"
    close(answers(data, SCALARS), {name: slow[name] for name in SCALARS})
    data["motion"]["inputs"]["A.theta"]["rate"] = "-1 rad/s"
    names = ["A.effort", *POWERS]
    back = mk.loads(to_text(data)).analyze(names, tables=[])
    assert all((back[power] > 0.0).all() for power in POWERS)
    assert (back["A.effort"] < slow["A.effort"]).all()


def test_no_coefficient_gives_the_bytes_without_friction():
    data = document(TEXT)
    for load in data["loads"]:
        if load["type"] == "friction":
            load["coefficient"] = "0"
    model = mk.loads(to_text(data))
    plain_loads = [load for load in data["loads"] if load["type"] != "friction"]
    without = mk.loads(to_text(data | {"loads": plain_loads}))
    names = sorted(without.quantities)
    found, expected = (m.analyze(names, tables=[]) for m in (model, without))
    for name in names:
        assert found[name].tobytes() == expected[name].tobytes(), name
    assert found.diagnostics == expected.diagnostics


@pytest.mark.parametrize(("lanes", "threads"), [(4, 1), (8, 1), (0, 2)])
def test_lanes_and_threads_give_the_same_bytes(lanes, threads):
    if lanes > _kernel.widest:
        pytest.skip("this machine has no packs of that width")
    names = (*SCALARS, *POWERS, "C.force", "D.friction_force")
    one = answers(TEXT, names, lanes=2, threads=1)
    other = answers(TEXT, names, lanes=lanes, threads=threads)
    assert all(one[name].tobytes() == other[name].tobytes() for name in names)
