"""`mechkin vibrate`: its tables, its picture and its JSON object."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk

ENGINE = Path(__file__).parents[2] / "mechanisms" / "vibration" / "engine_mounts.yaml"


def table(path: Path) -> tuple[list[str], list[list[str]]]:
    with path.open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    return head, rows


def numbers(path: Path) -> np.ndarray:
    return np.array([[float(cell) for cell in row[1:]] for row in table(path)[1]])


def test_tables(mechkin, tmp_path: Path) -> None:
    words = ["vibrate", str(ENGINE), "--row", "2", "--input", "sump.position.z,sump.position.y"]
    words += ["--output", "pose.rx, norm(front_left.force)", "--out", str(tmp_path), "--quiet"]
    assert mechkin(*words).code == 0
    v = mk.load(ENGINE).vibration(row=2)
    head, rows = table(tmp_path / "frequencies.csv")
    assert head[1] == "frequency [Hz]"
    assert [float(row[1]) for row in rows] == v.frequencies.tolist()
    space = v.state_space(
        ["sump.position.z", "sump.position.y"], ["pose.rx", "norm(front_left.force)"]
    )
    for name in "ABCD":
        assert (numbers(tmp_path / f"{name}.csv") == getattr(space, name)).all(), name
    head, _ = table(tmp_path / "stiffness.csv")
    assert head[1] == "pose.rx [rad]"
    assert (numbers(tmp_path / "stiffness.csv") == v.stiffness).all()
    assert not (tmp_path / "response.csv").exists()


def test_frequency_response_with_its_picture(mechkin, tmp_path: Path) -> None:
    words = ["vibrate", str(ENGINE), "--row", "2", "--input", "sump.position.z", "--quiet"]
    words += ["--output", "sump.position", "--frequencies", "1:100:21", "--out", str(tmp_path)]
    assert mechkin(*words).code == 0
    head, rows = table(tmp_path / "response.csv")
    assert head[5] == "sump.position.z amplitude"
    frequencies = np.array([float(row[0]) for row in rows])
    assert (frequencies[0], frequencies[-1], len(rows)) == (1.0, 100.0, 21)
    assert np.diff(np.log(frequencies)) == pytest.approx(np.log(100) / 20)
    v = mk.load(ENGINE).vibration(row=2)
    told = v.response(frequencies, "sump.position.z", "sump.position")
    assert [float(row[5]) for row in rows] == told.amplitude[2].tolist()
    pytest.importorskip("matplotlib")
    assert (tmp_path / "response.svg").read_text(encoding="utf-8").startswith("<?xml")


def test_json(mechkin, tmp_path: Path) -> None:
    ran = mechkin("vibrate", str(ENGINE), "--row", "0", "--json", "--out", str(tmp_path))
    assert ran.code == 0
    found = json.loads(ran.out)
    assert found["coordinates"][0] == "pose.rx"
    assert len(found["frequencies"]) == 6
    # turned by 4 degrees only the drives hold it
    assert [each["code"] for each in found["diagnostics"]] == ["held-by-efforts"]
