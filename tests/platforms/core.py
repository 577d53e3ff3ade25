"""The core without Python, built for another platform and run here: the bits of all sweeps kept.

    python -P tests/platforms/core.py x86_64-windows-gnu wine [STEM ...]
    python -P tests/platforms/core.py aarch64-linux-musl qemu-aarch64 [STEM ...]

It needs `ziglang` from PyPI (a compiler and C libraries for many platforms), CMake, and what runs
the platform's programs. What an analysis of all tables runs is caught here and run there by a
program in C; every number must have the same bits.
"""

from __future__ import annotations

import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from kernel.test_c_interface import (
    ALONE,
    SOURCES,
    Built,
    calls_of,
    caught,
    outputs_of,
    run_by_c,
    wanted_bytes,
)
from platforms.digests import MECHANISMS, stems

from mechkin_cli import load
from mechkin_cli.kernel.plan_text import plan_text
from mechkin_cli.verdict import SWEEP

SYSTEMS = {"windows": "Windows", "linux": "Linux", "macos": "Darwin"}


def built(target: str, runner: list[str], folder: Path) -> Built:
    """The library and the program for a platform that zig knows."""
    tools = {name: folder / name for name in ("cc", "c++", "ar", "ranlib")}
    for name, place in tools.items():
        words = f"-target {target}" if name.startswith("c") else ""
        place.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m ziglang {name} {words} "$@"\n')
        place.chmod(place.stat().st_mode | stat.S_IXUSR)
    system = next(name for word, name in SYSTEMS.items() if word in target)
    cross = [
        f"-DCMAKE_SYSTEM_NAME={system}",
        f"-DCMAKE_SYSTEM_PROCESSOR={target.split('-')[0]}",
        f"-DCMAKE_C_COMPILER={tools['cc']}",
        f"-DCMAKE_CXX_COMPILER={tools['c++']}",
        f"-DCMAKE_AR={tools['ar']}",
        f"-DCMAKE_RANLIB={tools['ranlib']}",
        "-DBUILD_SHARED_LIBS=OFF",
    ]
    alone = [each for each in ALONE if "SHARED" not in each]
    place = folder / "build"
    for command in (
        ["cmake", "-S", str(SOURCES.parent), "-B", str(place), "-G", "Ninja", *alone, *cross],
        ["cmake", "--build", str(place), "--parallel", "2"],
    ):
        subprocess.run(command, check=True)
    (core,) = place.rglob("libmechkin_core*.a")
    others = [each for each in place.rglob("*.a") if each != core]
    program = folder / "c_rows.exe"
    source = Path(__file__).parents[1] / "kernel" / "c_rows.c"
    objects = folder / "c_rows.o"
    headers = ["-I", str(SOURCES.parent / "c")]
    subprocess.run([str(tools["cc"]), "-c", str(source), *headers, "-o", str(objects)], check=True)
    libraries = [str(each) for each in (*others, core, *others)]
    subprocess.run([str(tools["c++"]), str(objects), *libraries, "-o", str(program)], check=True)
    start = folder / "start"
    start.write_text(f'#!/bin/sh\nexec {" ".join(runner)} "{program}" "$@"\n')
    start.chmod(start.stat().st_mode | stat.S_IXUSR)
    return Built(core, start)


def compared(there: Built, stem: str, folder: Path) -> int:
    """How many runs of an analysis have the same bits there; an assertion for others."""
    with pytest.MonkeyPatch.context() as patch:
        runs = caught(patch, Path(stem).stem)
    for session, rows, ask, batch in runs:
        assert ask.readout is not None
        size = session.plan.size
        text = plan_text(calls_of(session, size), outputs_of(session, ask))
        constants = [session.plan.constants, ask.readout.outputs.constants]
        found = run_by_c(there, folder, text, rows, ask, size, batch)
        assert found == wanted_bytes(constants, ask, batch), stem
    return len(runs)


def main(target: str, runner: str, *asked: str) -> int:
    """Builds, compares, and prints what differs."""
    chosen = [each for each in stems() if not asked or Path(each).name in asked]
    chosen = [each for each in chosen if SWEEP in load(MECHANISMS / f"{each}.yaml").runs]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        there = built(target, runner.split(), folder)
        total, other = 0, []
        for stem in chosen:
            try:
                total += compared(there, stem, folder)
            except AssertionError as error:
                other.append(stem)
                print(f"{stem}: {str(error)[:200]}", flush=True)
    same = len(chosen) - len(other)
    print(f"{target}: {same} of {len(chosen)} mechanisms with the same bits, {total} runs")
    return bool(other)


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
