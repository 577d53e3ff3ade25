"""A run of ten million rows takes the memory of one of a few parts."""

from __future__ import annotations

import platform
import subprocess
import sys
from pathlib import Path

import pytest
from streams.motions import BENT, REDUNDANT
from streams.rebounding import BALL, SPRUNG, timed

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel

FOUR_BAR = """format: 1
plane: xy
units: {{length: m, angle: deg}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, coupler], point: [0, 1]}}
  C: {{type: R, links: [coupler, rocker], point: [4, 3]}}
  D: {{type: R, links: [ground, rocker], point: [4, 0]}}
motion: {{inputs: {{A.theta: {{from: 0, to: 3600, count: {count}}}}}}}
tables:
  - {{name: t, columns: [D.theta], summary: [max, mean]}}
"""
PENDULUM = """format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{bob: {{mass: 1, center_of_mass: [0, -1]}}}}
joints: {{O: {{type: R, links: [ground, bob], point: [0, 0]}}}}
loads: [{{type: gravity, g: [0, -9.80665]}}]
responses: {{swing: {{start: {{O.theta: 1}}, time: {{from: 0, to: 3, count: {count}}}}}}}
tables:
  - {{name: t, run: swing, columns: [O.theta], summary: [max, mean]}}
"""
RUBBING = """format: 1
links: {{block: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints: {{D: {{type: R, links: [ground, block], point: [0, 0, 0], axis: [0, 0, 1]}}}}
motion:
  time: {{from: 0, to: 2, count: {count}}}
  inputs: {{D.theta: {{with: "30 deg*sin(180 deg/s*time + 30 deg)"}}}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
  - {{type: friction, joint: D, coefficient: 0.1, radius: 10 mm}}
balances: [{{name: work, type: work}}]
tables: [{{name: t, columns: [row.work, row.dissipated, row.energy_error], summary: [max]}}]
"""
DRIVEN = """format: 1
plane: xy
units: {{length: m, angle: rad}}
links:
  slide: {{mass: 1, center_of_mass: [0, 0]}}
  bob: {{mass: 1, center_of_mass: [0, -1]}}
joints:
  P: {{type: P, links: [ground, slide], point: [0, 0], axis: [1, 0]}}
  O: {{type: R, links: [slide, bob], point: [0, 0]}}
loads: [{{type: gravity, g: [0, -9.80665]}}]
responses:
  swing:
    start: {{O.theta: 1}}
    driven: {{P.s: {{law: sine, amplitude: 0.1, frequency: 0.7}}}}
    time: {{from: 0, to: 3, count: {count}}}
tables:
  - {{name: t, run: swing, columns: [P.effort, O.theta], summary: [max, mean]}}
"""
CHILD = """
import resource, sys
limit = int(sys.argv[1])
if limit:
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
from mechkin_cli.__main__ import main
sys.argv[1:] = sys.argv[2:]
try:
    main()
except SystemExit as exit:
    assert not exit.code, exit.code
lines = [line.split() for line in open("/proc/self/status")]
print(*[words[1] for words in lines if words[0] in ("VmPeak:", "VmHWM:")])
"""


def peak_of(folder: Path, count: int, limit: int = 0) -> int:
    """Peak of the address space in bytes of a process that sums up so many rows."""
    return peaks_of(folder, FOUR_BAR.format(count=count), limit)[0]


def peaks_of(folder: Path, text: str, limit: int = 0) -> tuple[int, int]:
    """The same of a file, and that of what is in memory."""
    path = folder / "run.yaml"
    path.write_text(text)
    options = ["--summary-only", "--quiet", "--threads", "1", "--out", str(folder / "out")]
    found = subprocess.run(
        [sys.executable, "-P", "-c", CHILD, str(limit), "analyze", str(path), *options],
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.returncode == 0, found.stderr[-2000:]
    space, resident = (1024 * int(word) for word in found.stdout.split()[-2:])
    return space, resident


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_ten_million_rows_need_the_memory_of_a_part(tmp_path: Path) -> None:
    few = peak_of(tmp_path, 200_000)
    # states of ten million rows alone would take 240 MB
    peak_of(tmp_path, 10_000_000, few + 20_000_000)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_the_limit_is_one(tmp_path: Path) -> None:
    few = peak_of(tmp_path, 200_000)
    with pytest.raises(AssertionError):
        peak_of(tmp_path, 200_000, few - 40_000_000)


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("text", [PENDULUM, DRIVEN], ids=["free", "driven"])
def test_responses_hold_no_moments(tmp_path: Path, text: str) -> None:
    few, many = (peaks_of(tmp_path, text.format(count=count))[1] for count in (200_000, 4_000_000))
    # the moments alone, in two units, would take 64 MB
    assert many < few + 20_000_000


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize(
    "text", [REDUNDANT, BENT.replace("0.1 rad", "9 rad")], ids=["a loop", "a slope that may jump"]
)
def test_responses_of_loops_and_couplings_hold_no_rows(tmp_path: Path, text: str) -> None:
    few, many = (
        peaks_of(tmp_path, text.replace("count: 41", f"count: {count}"))[1]
        for count in (100_000, 700_000)
    )
    # the moments alone, in two units of two doubles each, would take 19 MB
    assert many < few + 10_000_000


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("text", [BALL, SPRUNG], ids=["impacts", "rests"])
def test_responses_with_impacts_hold_no_rows(tmp_path: Path, text: str) -> None:
    text = text.split("tables:")[0] + "tables: [{name: t, run: r, columns: [S.s], summary: [max]}]"
    few, many = (peaks_of(tmp_path, timed(text, 6.0, count))[1] for count in (100_000, 600_000))
    # the moments alone, in two units, would take 8 MB, and states with their chart 48 MB
    assert many < few + 12_000_000


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_energies_and_balances_hold_no_rows(tmp_path: Path) -> None:
    few, many = (peaks_of(tmp_path, RUBBING.format(count=count))[1] for count in (100_000, 500_000))
    # held rows would take 100 bytes each at least
    assert many < few + 15_000_000


FAULTS = """
import resource, sys
import numpy as np
from mechkin_cli.kernel import _kernel
if sys.argv[1] != "0":
    _kernel.keep_freed_memory(int(sys.argv[1]))
def part():
    arrays = [np.ones(32768) for _ in range(30)]
for _ in range(5):
    part()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(50):
    part()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif("glibc" not in platform.libc_ver(), reason="others keep what is freed")
def test_freed_memory_is_kept_for_the_next_part() -> None:
    """No page is asked for again; 50 parts have 96 000 of them."""

    def faults(megabytes: int) -> int:
        words = [sys.executable, "-P", "-c", FAULTS, str(megabytes)]
        return int(subprocess.run(words, capture_output=True, text=True, check=True).stdout)

    assert faults(0) > 10_000
    assert faults(tolerances.FREED_MEGABYTES) < 1_000
    with pytest.raises(ValueError, match="not negative"):
        _kernel.keep_freed_memory(-1)
