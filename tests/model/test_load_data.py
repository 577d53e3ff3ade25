"""`mk.load` of a dict: the same mechanism as the file, and messages that name the keys."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import yaml
from references import RCSR

import mechkin_cli as mk


def arm() -> dict[str, Any]:
    return {
        "format": 1,
        "units": {"length": "mm"},
        "parameters": {"r": "40 mm"},
        "links": {"arm": {"mass": 2, "center_of_mass": ["r", 0, 0]}},
        "joints": {
            "O": {"type": "R", "links": ["ground", "arm"], "point": [0, 0, 0], "axis": [0, 0, 1]}
        },
        "motion": {"inputs": {"O.theta": {"from": 0, "to": 90, "step": 45, "rate": "3 rad/s"}}},
        "loads": [{"type": "gravity", "g": [0, -9810, 0]}],
    }


def changed(*path: Any, to: Any) -> dict[str, Any]:
    data = arm()
    inner: Any = data
    for step in path[:-1]:
        inner = inner[step]
    inner[path[-1]] = to
    return data


def told(data: Any) -> list[str]:
    with pytest.raises(mk.InvalidFile) as refused:
        mk.load(data)
    return [str(one) for one in refused.value.diagnostics]


def test_the_data_of_a_file_gives_the_bits_of_the_file() -> None:
    text = RCSR.read_text(encoding="utf-8")
    data = yaml.load(text, yaml.BaseLoader)
    of_data = mk.load(data, folder=RCSR.parent).analyze()
    of_file = mk.load(RCSR).analyze()
    for one, other in zip(of_data.tables, of_file.tables, strict=True):
        for a, b in zip(one.columns, other.columns, strict=True):
            assert np.asarray(a.values).tobytes() == np.asarray(b.values).tobytes()


def test_effort_of_an_arm_under_its_weight() -> None:
    found = mk.load(arm()).analyze()["O.effort"]
    # N mm: a steadily turning arm needs m g r cos(theta)
    expected = 2 * 9.81 * 40 * np.cos(np.deg2rad([0, 45, 90]))
    assert found == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("number", [np.float64(2), np.int32(2), np.float32(2), Fraction(2)])
def test_numbers_of_other_kinds(number: Any) -> None:
    data = changed("links", "arm", "mass", to=number)
    assert mk.load(data).analyze()["O.effort"][0] == mk.load(arm()).analyze()["O.effort"][0]


def test_arrays_and_tuples_count_as_lists() -> None:
    data = changed("joints", "O", "axis", to=np.array([0.0, 0.0, 2.0]))
    data["joints"]["O"]["point"] = (0, 0, np.float64(0))
    assert mk.load(data).analyze().complete


def test_a_copy_and_a_pickle_keep_the_places() -> None:
    model = mk.load(changed("loads", to=[]))
    for other in (copy.copy(model), pickle.loads(pickle.dumps(model))):
        assert other.analyze()["O.theta"].tolist() == [0, 45, 90]
        assert other.built.document.is_data


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (changed("joints", "O", "axiss", to=1), "data at joints.O.axiss: error:"),
        (changed("joints", "O", "point", 2, to="1 kg"), "data at joints.O.point[2]: error:"),
        (changed("links", "arm", "mass", to=float("nan")), "at links.arm.mass: error: the number"),
        (changed("links", "arm", "mass", to=np.inf), "at links.arm.mass: error: the number inf"),
        (changed("links", "arm", "mass", to=None), "at links.arm.mass: error: no value (None)"),
        (changed("links", "arm", "mass", to={1, 2}), "at links.arm.mass: error: a set; write"),
        (changed("links", "arm", "mass", to=1j), "at links.arm.mass: error: a complex; write"),
        (changed("links", 3, to={}), "data at links: error: a key that is not a text (int)"),
        (changed("name", to="a\x00b"), "data at name: error: a NUL character in a text"),
        (changed("name", to="\ud800"), "data at name: error: the invisible character U+D800"),
        ({}, "data at the top: error:"),
    ],
)
def test_messages_name_the_way_of_keys(data: Any, words: str) -> None:
    assert any(words in one for one in told(data)), told(data)


def test_expressions_tell_the_character() -> None:
    (one,) = told(changed("parameters", "r", to="40 mm + 2 kgg"))
    assert one.startswith("data at parameters.r: error: ")
    assert "at character 11 of the value" in one


def test_what_holds_itself_and_what_is_too_deep() -> None:
    loop = arm()
    loop["links"]["arm"] = loop
    assert "a value that holds itself" in told(loop)[0]
    deep: list[Any] = []
    for _ in range(10_000):
        deep = [deep]
    assert "nested deeper" in told(changed("loads", to=deep))[0]
    assert "more than" in told(changed("loads", to=[0] * 1_100_000))[0]


def test_the_same_list_twice_is_no_loop() -> None:
    origin = [0, 0, 0]
    data = changed("joints", "O", "point", to=origin)
    data["points"] = {"P": {"link": "arm", "at": origin}}
    assert mk.load(data).analyze().complete


def test_a_text_is_no_path() -> None:
    with pytest.raises(mk.UsageError, match=r"use loads\(text\)"):
        mk.load("format: 1\nlinks: {}\n")


def test_parameters_and_files_beside_a_dict(tmp_path) -> None:
    (tmp_path / "push.csv").write_text("theta,torque\n0,1\n30,2\n60,3\n90,4\n")
    load = {"type": "torque", "joint": "O", "value": {"table": "push.csv"}}
    data = changed("loads", to=[load])
    found = mk.load(data, {"r": "0 mm"}, folder=tmp_path).analyze()["O.effort"]
    assert found == pytest.approx([-1.0, -2.5, -4.0], abs=1e-12)
    with pytest.raises(mk.UsageError, match="defines no parameter 'q'"):
        mk.load(data, {"q": "1"}, folder=tmp_path)


@pytest.mark.parametrize(
    "name", ["rcsr.yaml", "mechanisms/dissertation/rcsr.yaml", "./x.YML", " C:/a/b.yaml\n"]
)
def test_the_name_of_a_file_is_no_text(name: str) -> None:
    with pytest.raises(mk.UsageError, match=r"looks like the name of a file; use load\('"):
        mk.loads(name)
