"""`--lanes`: the same bytes of every file for each width of the packs and on other machines."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from references import FILE_OF, RCSR

from mechkin_cli.kernel.functions import INSTRUCTIONS, check_width, force_width, width, widths

FILES = ("rcsr", "bennett", "rcsr_csr", "stewart")
"""A loop, an overconstrained loop, two loops, and a platform on legs."""

MACHINES = {
    "no AVX2 and FMA in the C library": {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"},
    "an old machine for OpenBLAS": {"OPENBLAS_CORETYPE": "Nehalem"},
}


@cache
def written(lanes: int, machine: str | None = None) -> dict[str, bytes]:
    """Every file that a process of its own writes for all mechanisms, by path."""
    files = [str(FILE_OF[name]) for name in FILES]
    formats = ["--format", "csv", "--format", "md", "--format", "json"]
    with TemporaryDirectory() as folder:
        options = ["--out", folder, "--lanes", str(lanes), "--quiet", *formats]
        subprocess.run(
            [sys.executable, "-P", "-m", "mechkin_cli", "analyze", *files, *options],
            env=os.environ | (MACHINES[machine] if machine else {}),
            check=True,
            capture_output=True,
        )
        paths = [path for path in Path(folder).rglob("*") if path.is_file()]
        return {str(path.relative_to(folder)): path.read_bytes() for path in paths}


def test_every_mechanism_is_written() -> None:
    """Otherwise the comparisons would compare nothing."""
    found = written(0)
    for name in FILES:
        assert {f"{name}/rows.csv", f"{name}/analysis.json"} < found.keys()
        assert found[f"{name}/rows.csv"].count(b"\n") > 3


@pytest.mark.parametrize("lanes", widths())
def test_every_width_writes_the_same_bytes(lanes: int) -> None:
    assert written(lanes) == written(0)


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("lanes", [0, 2])
def test_other_machines_write_the_same_bytes(lanes: int, machine: str) -> None:
    assert written(lanes, machine) == written(0)


@pytest.mark.parametrize("lanes", widths())
def test_the_explanation_names_the_width(mechkin, lanes: int) -> None:
    out = mechkin("analyze", RCSR, "--lanes", lanes, "--explain", "--quiet").out
    (line,) = [line for line in out.splitlines() if line.strip().startswith("width: ")]
    assert f"width: {lanes} rows at a time" in line
    for known in widths():
        assert f"{known} ({INSTRUCTIONS[known]})" in line


def test_without_the_option_the_widest_runs(mechkin) -> None:
    mechkin("analyze", RCSR, "--lanes", 2, "--quiet")
    out = mechkin("analyze", RCSR, "--explain", "--quiet").out
    assert f"width: {max(widths())} rows at a time" in out


@pytest.mark.parametrize("lanes", [-2, 1, 3, 16])
def test_a_width_that_the_machine_lacks_is_refused(mechkin, folder: Path, lanes: int) -> None:
    run = mechkin("analyze", RCSR, "--lanes", lanes)
    known = ", ".join(map(str, widths()))
    assert (run.code, run.out) == (2, "")
    assert f"lanes {lanes}: this machine has {known}; 0 takes the widest" in run.err
    assert not (folder / "out").exists()


def test_a_narrower_machine_says_what_it_has(monkeypatch, mechkin) -> None:
    monkeypatch.setattr("mechkin_cli.kernel.functions.INSTRUCTIONS", {2: "SSE2"})
    run = mechkin("analyze", RCSR, "--lanes", 8)
    assert run.code == 2
    assert "lanes 8: this machine has 2; 0 takes the widest" in run.err


def test_a_width_is_forced_until_it_is_taken_back() -> None:
    force_width(2)
    try:
        assert (width(), width(max(widths()))) == (2, max(widths()))
    finally:
        force_width(0)
    assert width() == max(widths())
    check_width(0)
