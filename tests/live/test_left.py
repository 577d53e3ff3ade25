"""Runs that a page leaves to the command: each says why, and the others follow all the same."""

from __future__ import annotations

import pytest
from references import FILE_OF
from response.test_driven import FILE

from mechkin_cli import Model, load, loads
from mechkin_cli.view.scene import page_data

LAW = "{law: harmonic, from: 0.3, to: 1, start: 0.1, duration: 0.5}"
FREE = """  free:
    start: {A.theta: 0.3, E.theta: 0.4}
    time: {from: 0, to: 0.5, step: 0.25}
"""


def driven() -> Model:
    """A response that follows, and one of which a law drives the crank."""
    text = FILE.format(law=LAW).replace("bob: {mass: 0.7", "bob: {mass: m")
    return loads(
        text.replace("responses:\n", f"parameters: {{m: 0.7 kg}}\nresponses:\n{FREE}", 1),
        "driven.yaml",
    )


def test_one_run_follows_and_the_other_says_why_not() -> None:
    model = driven()
    data, _ = page_data([model.respond("free"), model.respond("run")], modes=False)
    assert data["live"]["run"] == "free"
    assert data["live"]["others"] == []
    (still,) = data["still"]
    assert still == {
        "run": "run",
        "why": "laws of time drive coordinates in it",
        "named": True,
        "command": "mechkin analyze driven.yaml --set NAME=VALUE",
    }


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("gear_play", "something in it rebounds, by a restitution"),
        (
            "rcsr_csr_loop_one",
            "the file leaves loops out, and which ones depends on what is asked for",
        ),
        ("spur_gears", "with any one of its numbers changed the file is computed in another way"),
    ],
)
def test_kept_files_whose_pages_compute_nothing_say_why(name: str, why: str) -> None:
    model = load(FILE_OF[name])
    analysis = model.analyze() if "sweep" in model.runs else model.respond()
    data, _ = page_data([analysis], modes=False)
    assert "live" not in data
    assert [one["why"] for one in data["still"]] == [why]


def test_all_other_kept_files_have_a_page_that_computes() -> None:
    nothing = []
    for name, path in FILE_OF.items():
        model = load(path)
        if not ("sweep" in model.runs and model.problem.motion.rest is None):
            runs = [run for run in model.runs if run in model.problem.responses]
            moving = [run for run in runs if model.response(run).search is None]
            if not moving:
                continue  # where loads balance only the command finds
        analysis = model.analyze() if "sweep" in model.runs else model.respond()
        data, _ = page_data([analysis], modes=False)
        if "live" not in data:
            nothing.append(name)
    assert nothing == ["gear_play", "rcsr_csr_loop_one", "spur_gears"]
