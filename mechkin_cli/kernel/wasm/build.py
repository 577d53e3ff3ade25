"""Builds the core for a page: the interface in C as WebAssembly with 128-bit SIMD.

    python mechkin_cli/kernel/wasm/build.py            # mechkin.wasm.gz and lock.json beside this
    python mechkin_cli/kernel/wasm/build.py --check    # builds it again and compares the bytes

It needs `ziglang` from PyPI in the version that `lock.json` names (clang with a C++ library for
wasm32). Only what a page uses is linked: variants of a sweep and of a response, tapes and
texts of cells, in the narrowest unit; no threads, no exceptions, no library for elementary
functions, and no contraction of products and sums, so that every number has the bits of the other
units.
"""

# ruff: noqa: SIM905  options and names are read more easily as lines of text
from __future__ import annotations

import argparse
import gzip
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

HERE = Path(__file__).resolve().parent
KERNEL = HERE.parent
MODULE = HERE / "mechkin.wasm.gz"
LOCK = HERE / "lock.json"

COMMON = """-target wasm32-wasi -std=c++17 -msimd128 -mbulk-memory -fno-exceptions -fno-rtti
-fno-stack-protector -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden
-ffunction-sections -fdata-sections -Wall -Wextra -g0 -DNDEBUG -DMECHKIN_ONE_THREAD=1
-Icore -Ic""".split()
COMMON.append(f"-ffile-prefix-map={KERNEL}=.")
UNIT = """-DMECHKIN_LANES=2 -DMECHKIN_UNIT=mechkin_unit_sse2
-DMECHKIN_MOTION=mechkin_motion_sse2""".split()
UNITS = ("rows/unit.cpp", "response/motion_unit.cpp")
FAST = """rows/unit.cpp response/motion_unit.cpp stepping/infill.cpp stepping/row_curve.cpp
stepping/stepper.cpp arithmetic/dense.cpp integrator/dop853.cpp integrator/lane_states.cpp
integrator/march.cpp integrator/march_rows.cpp response/charted_motion.cpp""".split()
SMALL = """plan/plan_builder.cpp plan/plan_blocks.cpp plan/frozen_plan.cpp plan/same_layout.cpp
plan/output_list.cpp plan/program_store.cpp plan/function_store.cpp tape/tape_store.cpp
rows/assembly_size.cpp rows/run.cpp rows/threads.cpp rows/units.cpp stepping/arc.cpp
stepping/branch_point.cpp stepping/passage.cpp stepping/stretch.cpp stepping/ahead.cpp
stepping/judge.cpp stepping/tracker.cpp stepping/polyline.cpp stepping/orbit.cpp
stepping/row_pieces.cpp stepping/course.cpp stepping/dimension_path.cpp stepping/variants.cpp
text/number_text.cpp text/shortest.cpp
integrator/radau.cpp integrator/radau_newton.cpp integrator/crossings.cpp integrator/kinks.cpp
integrator/march_start.cpp integrator/sides.cpp integrator/crossing_search.cpp
response/driven_laws.cpp response/charted_friction.cpp response/slip_trial.cpp response/response.cpp
response/sign_vectors.cpp response/charted_sizes.cpp response/charted_ways.cpp
response/charted_sticking.cpp response/charted_crossings.cpp response/crossing_curve.cpp
response/chart_matrix.cpp response/varied_response.cpp
text/plan_text.cpp text/table_text.cpp ../c/mechkin.cpp ../wasm/room.cpp""".split()
EXPORTED = """mechkin_plan_create mechkin_plan_free mechkin_page_sizes mechkin_page_run
mechkin_page_respond mechkin_tape_create mechkin_tape_free mechkin_tape_run mechkin_tape_outputs
mechkin_cell_texts malloc free""".split()
LINKED = """-target wasm32-wasi -mexec-model=reactor -O2 -s -Wl,--gc-sections -Wl,--strip-all
-Wl,--no-entry -Wl,-z,stack-size=1048576""".split()
LINKED += [f"-Wl,--export={name}" for name in EXPORTED]


def sources() -> list[tuple[str, list[str]]]:
    """Each source under `core` with the options of its own."""
    fast = [(name, ["-O2", *(UNIT if name in UNITS else [])]) for name in FAST]
    return fast + [(name, ["-Os"]) for name in SMALL]


def compiled(folder: Path) -> bytes:
    """The module, built in a folder for what lies between."""
    zig = [sys.executable, "-m", "ziglang", "c++"]
    places = {name: str(folder / place) for name, place in CACHES.items()}
    # SOURCE_DATE_EPOCH: no moment of the build anywhere
    environment = {**os.environ, **places, "SOURCE_DATE_EPOCH": "0"}

    def compile_one(source: tuple[str, list[str]]) -> str:
        name, options = source
        target = folder / f"{name.replace('/', '_').replace('.', '_')}.o"
        command = [*zig, *COMMON, *options, "-c", f"core/{name}", "-o", str(target)]
        subprocess.run(command, cwd=KERNEL, env=environment, check=True)
        return str(target)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(compile_one, sources()))
    target = folder / "mechkin.wasm"
    command = [*zig, *LINKED, *objects, "-o", str(target)]
    subprocess.run(command, cwd=KERNEL, env=environment, check=True)
    return target.read_bytes()


CACHES = {"ZIG_GLOBAL_CACHE_DIR": "cache", "ZIG_LOCAL_CACHE_DIR": "cache"}
"""Names of variables that say where zig keeps what it made, and the folders."""


def source_hash() -> str:
    """Of everything that is compiled, and of this script."""
    files = [
        *KERNEL.glob("core/**/*.[ch]pp"),
        *KERNEL.glob("c/*.*"),
        *HERE.glob("*.cpp"),
        HERE / "build.py",
    ]
    total = hashlib.sha256()
    for file in sorted(files):
        total.update(str(file.relative_to(KERNEL)).encode() + b"\0" + file.read_bytes() + b"\0")
    return total.hexdigest()


def main() -> int:
    """Builds or checks; the exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument(
        "--check", action="store_true", help="build again and compare, write nothing"
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="with --check: compare hashes of sources only, build nothing",
    )
    given = parser.parse_args()
    lock = json.loads(LOCK.read_text()) if LOCK.exists() else {}
    if given.check and given.quick:
        digest = hashlib.sha256(gzip.decompress(MODULE.read_bytes())).hexdigest()
        if lock.get("sources") == source_hash() and lock.get("module") == digest:
            return 0
        print(
            "mechkin.wasm is not of these sources: run mechkin_cli/kernel/wasm/build.py",
            file=sys.stderr,
        )
        return 1
    try:
        zig = version("ziglang")
    except PackageNotFoundError:
        print(f"no ziglang here: pip install ziglang=={lock.get('ziglang', '')}", file=sys.stderr)
        return 2
    if given.check and zig != lock.get("ziglang"):
        print(f"ziglang {zig} is here, lock.json has {lock.get('ziglang')}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        module = compiled(Path(folder))
    if given.check:
        if module != gzip.decompress(MODULE.read_bytes()):
            print(
                "mechkin.wasm is not what its sources give: run mechkin_cli/kernel/wasm/build.py",
                file=sys.stderr,
            )
            return 1
        print(f"mechkin.wasm is what its sources give: {len(module)} bytes")
        return 0
    # packed here, since not every library packs alike
    MODULE.write_bytes(gzip.compress(module, 9, mtime=0))
    record = {
        "ziglang": zig,
        "sources": source_hash(),
        "module": hashlib.sha256(module).hexdigest(),
    }
    LOCK.write_text(json.dumps(record, indent=2) + "\n")
    print(f"mechkin.wasm: {len(module)} bytes, {MODULE.stat().st_size} packed")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
