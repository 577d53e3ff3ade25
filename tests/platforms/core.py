"""The core without Python, built for another platform and run here: the bits of all sweeps kept,
and of some responses.

    python -P tests/platforms/core.py x86_64-windows-gnu wine [STEM ...]
    python -P tests/platforms/core.py aarch64-linux-musl qemu-aarch64 [STEM ...]
    python -P tests/platforms/core.py aarch64-macos                       builds it and no more

It needs `ziglang` from PyPI (a compiler and C libraries for many platforms), CMake, and what runs
the platform's programs. What an analysis of all tables runs is caught here and run there by a
program in C, responses with other parameters, too; every number must have the same bits. A warning
of the compiler is an error. With `--wide` every width of lanes is built, as in a wheel, which takes
much longer, and the widest that the machine has is run.
"""

from __future__ import annotations

import argparse
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from kernel.c_programs import (
    ALONE,
    HEADERS,
    PROGRAM,
    RESPONSES,
    STRICT,
    Built,
    Recorded,
    calls_of,
    caught,
    moving,
    outputs_of,
    run_by_c,
    wanted_bytes,
)
from kernel.compiler import SOURCES
from platforms.digests import MECHANISMS, stems

from mechkin_cli import load
from mechkin_cli.kernel.plan_text import plan_text
from mechkin_cli.verdict import SWEEP

SYSTEMS = {"windows": "Windows", "linux": "Linux", "macos": "Darwin"}


def built(target: str, runner: list[str], folder: Path, *, wide: bool) -> Built:
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
    left = ("SHARED", "NARROW") if wide else ("SHARED",)
    alone = [each for each in ALONE if not any(word in each for word in left)]
    alone = [f"{each} -Wall -Wextra -Werror" if "FLAGS" in each else each for each in alone]
    place = folder / "build"
    for command in (
        ["cmake", "-S", str(SOURCES.parent), "-B", str(place), "-G", "Ninja", *alone, *cross],
        ["cmake", "--build", str(place), "--parallel", "2"],
    ):
        subprocess.run(command, check=True)
    (core,) = place.rglob("libmechkin_core*.a")
    others = [each for each in place.rglob("*.a") if each != core]
    program, code = folder / "c_runs.exe", folder / "c_runs.o"
    command = [str(tools["cc"]), *STRICT, "-c", str(PROGRAM), *HEADERS, "-o", str(code)]
    subprocess.run(command, check=True)
    libraries = [str(each) for each in (*others, core, *others)]
    subprocess.run([str(tools["c++"]), str(code), *libraries, "-o", str(program)], check=True)
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


def compared_responses(there: Built, folder: Path) -> tuple[int, int]:
    """How many responses have the same bits there, with the file's parameters and with others, and
    how many there are."""
    same = total = 0
    for name in RESPONSES:
        model, run = moving(name)
        recorded = Recorded.of(model, run)
        for spread in (0.0, 0.005, 0.01):
            total += 1
            varied = recorded.varied(model, spread) if spread else model
            try:
                recorded.compare(there, folder, varied, run)
                same += 1
            except AssertionError as error:
                print(f"{name}, {spread}: {str(error)[:200]}", flush=True)
    return same, total


def compared_sweeps(there: Built, folder: Path, asked: list[str]) -> tuple[int, int]:
    """How many mechanisms have the same bits in all runs of their sweeps, of how many."""
    chosen = [each for each in stems() if not asked or Path(each).name in asked]
    chosen = [each for each in chosen if SWEEP in load(MECHANISMS / f"{each}.yaml").runs]
    runs, same = 0, 0
    for stem in chosen:
        try:
            runs += compared(there, stem, folder)
            same += 1
        except AssertionError as error:
            print(f"{stem}: {str(error)[:200]}", flush=True)
    print(f"{runs} runs of sweeps")
    return same, len(chosen)


def main() -> int:
    """Builds, compares, and prints what differs."""
    parser = argparse.ArgumentParser()
    parser.add_argument("target")
    parser.add_argument("runner", nargs="?")
    parser.add_argument("stems", nargs="*")
    parser.add_argument("--wide", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        runner = (given.runner or "").split()
        there = built(given.target, runner, folder, wide=given.wide)
        print(f"{given.target}: built without a warning", flush=True)
        if given.runner is None:
            return 0
        sweeps = compared_sweeps(there, folder, given.stems)
        moved = compared_responses(there, folder)
    for what, (same, total) in (("mechanisms", sweeps), ("responses", moved)):
        print(f"{given.target}: {same} of {total} {what} with the same bits")
    return int(sweeps[0] < sweeps[1] or moved[0] < moved[1])


if __name__ == "__main__":
    raise SystemExit(main())
