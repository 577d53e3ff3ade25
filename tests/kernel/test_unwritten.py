"""What nothing has written is no number: never what memory happened to hold.

The C library fills memory that it hands out with a byte of choice (`MALLOC_PERTURB_`), so that two
runs with different bytes differ wherever something unwritten shows.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from cli.files import beyond_dead_centre
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.session import following, session
from mechkin_cli.session.following import Followed, follow

PROGRAM = """
import sys
import numpy as np
import mechkin_cli as mk

for path in sys.argv[1:]:
    model = mk.load(path)
    found = model.analyze(sorted(model.quantities))
    for name in sorted(model.quantities):
        print(path, name, found[name].tobytes().hex())
    for name in ("status", "residual", "condition", "power_error"):
        print(path, name, getattr(found.result, name).tobytes().hex())
    for name, value in list(model.problem.parameters.items())[:2]:
        far = [float(value.value) * part for part in (1.0, 1.01, 1e3)]
        try:
            varied = model.vary({name: far})
        except mk.MechkinError as error:
            print(path, name, error)
            continue
        for column in model.problem.mechanism.coordinates:
            print(path, name, column, varied[column].tobytes().hex())
"""


def printed(byte: int, *paths: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-P", "-c", PROGRAM, *map(str, paths)],
        env=os.environ | {"MALLOC_PERTURB_": str(byte), "PYTHONMALLOC": "malloc"},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


def test_answers_do_not_depend_on_what_memory_held(tmp_path: Path) -> None:
    ends = tmp_path / "ends.yaml"
    ends.write_text(beyond_dead_centre())
    paths = [ends, FILE_OF["parallelogram"]]
    first = printed(0x55, *paths)
    assert first.count("\n") > 100
    assert first == printed(0xAA, *paths)


class Poisoned:
    """numpy whose new arrays hold a number that is easily told."""

    def __getattr__(self, name: str) -> Any:
        return getattr(np, name)

    def empty(self, shape: Any, dtype: Any = float) -> Any:
        return np.full(shape, POISON, dtype)


POISON = 7.25


def test_rows_that_are_not_reached_are_no_numbers(tmp_path, monkeypatch) -> None:
    path = tmp_path / "ends.yaml"
    path.write_text(beyond_dead_centre())
    ways: list[Followed] = []

    def spied(*arguments: Any, **more: Any) -> Followed:
        ways.append(follow(*arguments, **more))
        return ways[-1]

    monkeypatch.setattr(following, "np", Poisoned())
    monkeypatch.setattr(session, "follow_path", spied)
    assert mk.load(path).analyze().rows == 31
    assert any(way.reached < way.limit.size for way in ways)
    for way in ways:
        for array in (way.guess, way.limit[None, :], way.turns):
            if array is not None:
                assert not np.isnan(array[:, : way.reached]).any()
                assert np.isnan(array[:, way.reached :]).all()
                assert not (array == POISON).any()
