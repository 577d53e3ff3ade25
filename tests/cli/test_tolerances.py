"""`mechkin tolerances`: its files against the closed form of the slider-crank; what it refuses."""

from __future__ import annotations

import csv
import re
from io import StringIO

import numpy as np
import pytest
from references import MECHANISMS

FILE = MECHANISMS / "plane/slider_crank.yaml"
CRANK, ROD = 0.1, 0.35
HALF, LEAST, MOST = 5e-4, -1e-4, 1e-3
BANDS = ("--tolerance", "crank=0.5 mm", "--tolerance", "rod=-0.1 mm, 1 mm")


def slide(crank, rod, turn):
    """How far the slider is from its home, crank + rod."""
    return crank * np.cos(turn) + np.sqrt(rod**2 - (crank * np.sin(turn)) ** 2) - crank - rod


def columns(text: str) -> dict[str, list[str]]:
    head, *lines = csv.reader(StringIO(text))
    return dict(zip(head, map(list, zip(*lines, strict=True)), strict=True))


def test_the_slider_crank_by_its_closed_form(mechkin, folder) -> None:
    run = mechkin("tolerances", FILE, *BANDS, "--of", "D.s", "--samples", "512", "--plot")
    assert run.code == 0, run.err
    written = folder / "out/slider_crank"
    names = {f"tolerances{one}" for one in (".csv", ".md", ".svg", "_shares.csv")}
    assert {path.name for path in written.iterdir()} == names
    found = columns((written / "tolerances.csv").read_text())
    # where nothing scatters no share is of anything
    numbers = {
        label: np.array([float(cell or "nan") for cell in cells])
        for label, cells in found.items()
        if label != "D.s first order"
    }
    turn = np.radians(numbers["A.theta"])
    root = np.sqrt(ROD**2 - (CRANK * np.sin(turn)) ** 2)
    by_crank = np.cos(turn) - CRANK * np.sin(turn) ** 2 / root - 1.0
    by_rod = ROD / root - 1.0
    nominal = slide(CRANK, ROD, turn)

    def near(label, expected):
        assert np.abs(numbers[f"D.s {label}".strip()] - expected).max() < 1e-12, label

    half, middle = 0.5 * (MOST - LEAST), 0.5 * (MOST + LEAST)
    near("", nominal)
    near("least", nominal - HALF * np.abs(by_crank) + np.minimum(LEAST * by_rod, MOST * by_rod))
    near("largest", nominal + HALF * np.abs(by_crank) + np.maximum(LEAST * by_rod, MOST * by_rod))
    off = np.hypot(HALF * by_crank, half * by_rod)
    near("RSS least", nominal + middle * by_rod - off)
    near("RSS largest", nominal + middle * by_rod + off)
    near("scatter", off / np.sqrt(3.0))
    some = off > 1e-9
    share = (HALF * by_crank[some] / off[some]) ** 2
    assert np.abs(numbers["D.s share of crank"][some] - share).max() < 1e-9
    # Monte Carlo: the mean and the deviation of both uniform bands, by quadrature
    nodes, weights = np.polynomial.legendre.leggauss(12)
    cranks, rods = CRANK + HALF * nodes, ROD + middle + half * nodes
    grid = slide(cranks[:, None, None], rods[None, :, None], turn)
    both = 0.25 * np.multiply.outer(weights, weights)[:, :, None]
    mean = (both * grid).sum(axis=(0, 1))
    deviation = np.sqrt((both * (grid - mean) ** 2).sum(axis=(0, 1)))
    room = 5.0 * deviation / np.sqrt(512) + 1e-12
    assert (np.abs(numbers["D.s sampled mean"] - mean) < room).all()
    assert (np.abs(numbers["D.s sampled scatter"] - deviation) < room).all()
    assert (numbers["D.s sampled 2.5 %"] < numbers["D.s sampled mean"] + 1e-12).all()
    assert not numbers["D.s samples lost"].any()
    assert set(found["D.s first order"]) <= {"ok", "inaccurate"}
    parts = columns((written / "tolerances_shares.csv").read_text())
    assert parts["parameter"] == ["crank [m]", "rod [m]"]
    assert abs(sum(map(float, parts["share"])) - 100.0) < 1e-9
    assert b"<svg" in (written / "tolerances.svg").read_bytes()


def test_the_same_seed_gives_the_same_bytes(mechkin, folder) -> None:
    def files(out: str, seed: str) -> dict[str, bytes]:
        words = ("--seed", seed, "--samples", "64", "--at", "60", "--plot", "--out", out)
        assert mechkin("tolerances", FILE, *BANDS, "--of", "D.s", *words).code == 0
        return {path.name: path.read_bytes() for path in (folder / out).iterdir()}

    first = files("a", "1")
    assert files("b", "1") == first
    assert files("c", "2")["tolerances.csv"] != first["tolerances.csv"]


def test_json_and_the_columns_of_the_first_table(mechkin, folder) -> None:
    run = mechkin("tolerances", FILE, *BANDS, "--samples", "32", "--at", "60 deg", "--json")
    assert run.code == 0
    found = run.json
    assert list(found["quantities"]) == ["s", "s_dot", "s_ddot", "effort"]
    assert found["tolerances"]["rod"]["unit"] == "m"
    assert found["tolerances"]["rod"]["largest"] == pytest.approx(MOST)
    assert found["places"] == [60.0]
    s = found["quantities"]["s"]
    assert s["nominal"][0] == pytest.approx(slide(CRANK, ROD, np.pi / 3), abs=1e-12)
    assert s["worst"][0][0] < s["root_sum_square"][0][0] < s["nominal"][0]
    assert not (folder / "out").exists()


@pytest.mark.parametrize(
    ("words", "named"),
    [
        ((), r"name what scatters, as --tolerance P1=0.01mm; parameters of slider-crank are crank"),
        (("--tolerance", "crank"), "--tolerance crank: expected NAME=HALF"),
        (("--tolerance", "crnk=1mm"), "there is no parameter crnk"),
        (("--tolerance", "crank=1deg"), "expected a length, found an angle"),
        (("--tolerance", "crank=1mm,2mm,3mm"), "one number, or two"),
        (("--tolerance", "crank=2mm,1mm"), "has no width"),
        ((*BANDS, "--of", "D.x"), "D.x"),
        ((*BANDS, "--of", "D.force"), "is a vector"),
        ((*BANDS, "--at", "7"), "no row has A.theta = 7"),
        ((*BANDS, "--format", "xlsx"), "formats of tolerances are csv and md"),
        ((*BANDS, "--method", "dice"), "method is one of"),
        ((*BANDS, "--distribution", "flat"), "distribution is one of"),
    ],
)
def test_what_is_wrong_is_named(mechkin, folder, words, named) -> None:
    run = mechkin("tolerances", FILE, *words)
    assert run.code == 2
    assert re.search(named, run.err), run.err
    assert "internal error" not in run.err
    assert not (folder / "out").exists()
