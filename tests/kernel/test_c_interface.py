"""The core without Python: built alone, without exceptions, and run by a program in C.

The rows have the bits that Python's session gives. What a session ran is caught as it runs, its
plan is written as text, and the program runs the text. Where `pip install .` left its build here
that core is linked, which saves most of a minute; with `MECHKIN_RANDOM=2` it is built alone.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from kernel.compiler import COMPILER, SOURCES, built_core, compile_with
from references import FILE_OF

from mechkin_cli import load
from mechkin_cli.kernel.plan_text import plan_text
from mechkin_cli.plan.outputs import OutputPlan
from mechkin_cli.plan.plan import plan_records
from mechkin_cli.plan.records import flatten
from mechkin_cli.session.kernel_run import POSITIONS, RESIDUAL_TESTS, Ask, Batch, RowInputs, run
from mechkin_cli.session.session import Session
from mechkin_cli.tape.recorder import register
from mechkin_cli.tape.tape import Verdict
from mechkin_cli.variants.design import Base

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
C_COMPILER = shutil.which(os.environ.get("CC", "cc"))
CMAKE = shutil.which("cmake")
pytestmark = pytest.mark.skipif(
    None in (COMPILER, C_COMPILER, CMAKE), reason="needs compilers and CMake"
)

ALONE = [
    "-DMECHKIN_C_INTERFACE=ON",
    "-DMECHKIN_NARROW=ON",
    "-DBUILD_SHARED_LIBS=ON",
    "-DCMAKE_BUILD_TYPE=Release",
    "-DCMAKE_CXX_FLAGS=-fno-exceptions -fno-rtti",
    # whoever looks for these stops the build
    *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("Python", "Python3", "nanobind")),
]
GIVEN = RowInputs._fields[:-1]
OTHER_WAY = 2
FOUND = ("outputs", "first", "second", "side", "condition", "power_error", "loads")


class Built(NamedTuple):
    library: Path
    program: Path


def of_core(core: Path, folder: Path) -> Path:
    """The library in C of a core that was built for Python."""
    whole = ["-Wl,--whole-archive", str(core), "-Wl,--no-whole-archive"]
    by_text = [
        str(SOURCES / name) for name in ("response/varied_response.cpp", "text/plan_text.cpp")
    ]
    options = ["-O1", "-shared", "-pthread", "-fno-exceptions", "-fno-rtti", *by_text, *whole]
    return compile_with(SOURCES.parent / "c" / "mechkin.cpp", folder / "libmechkin.so", *options)


def built_alone(folder: Path) -> Path:
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    assert CMAKE is not None
    for command in (
        [CMAKE, "-S", str(SOURCES.parent), "-B", str(folder), *generator, *ALONE],
        [CMAKE, "--build", str(folder), "--parallel", "2"],
    ):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]
    (library,) = (folder / "c").glob("libmechkin.*")
    return library


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    folder = tmp_path_factory.mktemp("alone")
    core = built_core() if TIMES == 1 and sys.platform == "linux" else None
    library = of_core(core, folder) if core else built_alone(folder)
    program = folder / "c_rows"
    strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"]
    source = Path(__file__).with_name("c_rows.c")
    linked = ["-L", str(library.parent), "-lmechkin", f"-Wl,-rpath,{library.parent}"]
    headers = ["-I", str(SOURCES.parent / "c")]
    command = [str(C_COMPILER), *strict, str(source), *headers, "-o", str(program), *linked]
    subprocess.run(command, check=True)
    return Built(library, program)


def calls_of(session: Session, size: float) -> Iterator[tuple[str, Any]]:
    for call, arguments in plan_records(session.layout, size):
        yield "plan" if call == "units" else call, arguments


def outputs_of(session: Session, ask: Ask) -> list[Any]:
    if ask.readout is None:
        return []
    plan = OutputPlan(session.layout, None, session.driven)
    for wanted in ask.readout.wanted:
        plan.add(wanted)
    return plan.records


def run_by_c(
    built: Built,
    folder: Path,
    text: str,
    rows: RowInputs,
    ask: Ask,
    size: float,
    like: Batch,
    parameters: np.ndarray | None = None,
    threads: int = 1,
) -> list[bytes]:
    """Constants, then what `like` has in the program's order, then flags, as bytes; nothing where
    the parameters lead another way."""
    given = [getattr(rows, name) for name in GIVEN]
    found = [getattr(like, name) for name in FOUND]
    if not ask.demand:
        found[FOUND.index("side")] = None
    bits = [
        sum(1 << k for k, array in enumerate(arrays) if array is not None)
        for arrays in (given, found)
    ]
    head = [rows.inputs.shape[1], int(ask.demand), ask.iterations, threads]
    head += [parameters is not None, *bits]
    (folder / "plan.txt").write_text(text, encoding="ascii")
    numbers = [*(ask.tests or RESIDUAL_TESTS), size]
    parts = [np.array(numbers), parameters, *given]
    with (folder / "given.bin").open("wb") as file:
        file.write(np.array(head, np.int64).tobytes())
        for part in parts:
            if part is not None:
                file.write(np.ascontiguousarray(part, np.float64).tobytes())
    names = [str(folder / name) for name in ("plan.txt", "given.bin", "found.bin")]
    done = subprocess.run([str(built.program), *names], check=False)
    if done.returncode == OTHER_WAY:
        return []
    assert done.returncode == 0
    data = (folder / "found.bin").read_bytes()
    arrays = [like.states, like.residual, like.correction, *(a for a in found if a is not None)]
    constants = len(data) - sum(array.nbytes for array in arrays) - like.flags.nbytes
    cuts = np.cumsum([0, constants, *(array.nbytes for array in arrays), like.flags.nbytes])
    return [data[a:b] for a, b in pairwise(cuts)]


def wanted_bytes(constants: list[np.ndarray], ask: Ask, like: Batch) -> list[bytes]:
    found = [like.states, like.residual, like.correction]
    for name in FOUND:
        array = getattr(like, name)
        if array is not None and (name != "side" or ask.demand):
            found.append(array)
    return [np.concatenate(constants).tobytes(), *(a.tobytes() for a in (*found, like.flags))]


def picked(batch: Batch, rows: Any) -> Batch:
    return Batch(*(array if array is None else array[..., rows].copy() for array in batch))


Caught = tuple[Session, RowInputs, Ask, Batch]


def caught(monkeypatch: pytest.MonkeyPatch, stem: str) -> list[Caught]:
    """Every run in doubles, with quantities to read, of an analysis of all tables; as it was found,
    for what is read of it is made continuous in its place."""
    runs: list[Caught] = []
    ran = Session.run

    def catching(
        self: Session, rows: RowInputs, ask: Ask = POSITIONS, *rest: Any, **more: Any
    ) -> Batch:
        batch = ran(self, rows, ask, *rest, **more)
        if ask.readout is not None and not ask.readout.points and not (rest or more):
            runs.append((self, rows, ask, picked(batch, slice(None))))
        return batch

    monkeypatch.setattr(Session, "run", catching)
    analysis = load(FILE_OF[stem]).analyze()
    assert analysis.tables
    return runs


@pytest.mark.parametrize("stem", ["planar_four_bar", "rcsr", "stewart", "lecture_crane_30"])
def test_rows_have_the_bits_of_pythons_session(
    built: Built, stem: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs = caught(monkeypatch, stem)
    assert runs
    for session, rows, ask, batch in runs:
        size = session.plan.size
        assert ask.readout is not None
        text = plan_text(calls_of(session, size), outputs_of(session, ask))
        constants = [session.plan.constants, ask.readout.outputs.constants]
        found = run_by_c(built, tmp_path, text, rows, ask, size, batch)
        assert found == wanted_bytes(constants, ask, batch)
        # more rows than one thread takes
        many = np.resize(np.arange(batch.flags.size), 300)
        more = picked(batch, many)
        found = run_by_c(built, tmp_path, text, rows.at(many), ask, size, more, threads=3)
        assert found == wanted_bytes(constants, ask, more)


@pytest.mark.parametrize(
    ("stem", "names", "last"),
    [
        ("planar_four_bar", ("a", "c"), Verdict.OTHER_WAY),
        ("rcsr", ("alpha1", "P2", "cx"), Verdict.SAME),
    ],
)
def test_a_tape_gives_the_rows_of_other_parameters(
    built: Built,
    stem: str,
    names: tuple[str, ...],
    last: Verdict,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    session, rows, ask, _ = caught(monkeypatch, stem)[-1]
    variation = Base(load(FILE_OF[stem]).design).variation(names)
    assert variation is not None
    assert ask.readout is not None
    assert variation.base.plan.constants.tobytes() == session.plan.constants.tobytes()
    recorded = OutputPlan(variation.layout, None, session.driven)
    for wanted in ask.readout.wanted:
        recorded.add(wanted)
    constants = [*variation.constants, *flatten(recorded.records)]
    recorder = variation.recorder
    tape = recorder.tape(register(recorder, number) for number in constants)
    arrays = (tape.constants, tape.operations, tape.operands, tape.outputs, tape.guards)
    words = (a.tolist() for a in (*arrays, tape.expected.astype(int), tape.advice.astype(int)))
    text = plan_text(
        calls_of(session, session.plan.size), outputs_of(session, ask), (len(names), *words)
    )
    verdicts = []
    for change in (1.0, 1.001, 0.99, 10.0):
        values, size = variation.values * change, session.plan.size * 1.25
        plan = variation.plan(values, size)
        outputs = variation.reading(ask.readout.wanted).outputs(values)
        readout = ask.readout._replace(outputs=outputs)
        like = run(plan, rows, ask._replace(readout=readout))
        found = run_by_c(built, tmp_path, text, rows, ask, size, like, values)
        verdicts.append(int(variation.verdicts(values[:, None])[0]))
        if verdicts[-1] == Verdict.OTHER_WAY:
            assert found == []
            continue
        assert found == wanted_bytes([plan.constants, outputs.constants], ask, like)
    assert verdicts == [0, 0, 0, last]


PLAN = """\
mechkin plan 1
plan 1 [0 0 0] 1
add_tree_joint 0 -1 0 [1 0 0 0 1 0 0 0 1 0 0 0]
set_rest [0]
add_input 0 -1 1
"""
BAD = {
    "": "there is no plan",
    "mechkin plan 2\n": "the text does not begin with 'mechkin plan 1'",
    "mechkin plan 1\nset_rest []\n": "line 2: records of a plan stand behind `plan`",
    "mechkin plan 1\nplan 0 [0 0 0] 1\n": "line 2: length unit and size must be positive",
    "mechkin plan 1\nplan 1 [0 0 0] x7ff8000000000000\n": "line 2: a plan's numbers must be finite",
    "mechkin plan 1\nplan 1 [0 0] 1\n": "line 2: these are not the values of this record",
    PLAN + "set_rest [0\n": "line 6: these are not the values of this record",
    PLAN + "set_rest [0] 1\n": "line 6: these are not the values of this record",
    PLAN + "set_rest [99999999999]\n": "line 6: these are not the values of this record",
    PLAN + "set_rest [1.5]\n": "line 6: these are not the values of this record",
    PLAN + "set_gravity [x3ff000000000000 0 0]\n": "line 6: these are not the values",
    PLAN + "set_gravity [x3ff000000000000g 0 0]\n": "line 6: these are not the values",
    PLAN + "set_rest [0]\n": "line 6: the rest is set once",
    PLAN + "finish\n": "line 6: unknown record",
    PLAN + "output 99 0 0 0 [0 0 0] 1\n": "unknown kind of output",
    PLAN + "tape 0 [] [] [] [] [] [] []\n": "line 6: a tape has inputs",
    PLAN + "tape 1 [] [300] [[0 0 0]] [] [] [] []\n": "line 6: these are not the values",
    PLAN + "tape 1 [] [0] [[0 7 0]] [] [] [] []\n": "line 6: an operand lies before its instr",
    PLAN + "tape 1 [] [] [] [0] [] [] []\n": "the tape does not give the constants of plan",
}


@pytest.mark.parametrize("text", BAD)
def test_what_is_no_plan_is_refused_with_its_line(built: Built, text: str) -> None:
    library = ctypes.CDLL(str(built.library))
    plan, message = ctypes.c_void_p(1), ctypes.create_string_buffer(256)
    data = text.encode("ascii")
    create = library.mechkin_plan_create
    status = create(data, ctypes.c_size_t(len(data)), ctypes.byref(plan), message)
    assert (status, plan.value) == (1, None)
    assert message.value.decode("ascii").startswith(BAD[text])
    # nobody need ask why
    assert create(data, ctypes.c_size_t(len(data)), ctypes.byref(plan), None) == 1


def test_a_plan_in_its_whole_text_is_taken(built: Built) -> None:
    library = ctypes.CDLL(str(built.library))
    plan, message = ctypes.c_void_p(), ctypes.create_string_buffer(256)
    data = PLAN.encode("ascii")
    create = library.mechkin_plan_create
    assert create(data, ctypes.c_size_t(len(data)), ctypes.byref(plan), message) == 0
    assert message.value == b""
    nothing = ctypes.create_string_buffer(4096)
    # rows without arrays, tests and threads
    assert library.mechkin_run(plan, nothing, message) == 1
    assert message.value == b"inputs and guesses are given"
    assert library.mechkin_plan_set_parameters(plan, nothing, None, message) == 1
    assert message.value == b"the plan has no tape"
    assert library.mechkin_plan_set_size(plan, ctypes.c_double(float("nan")), message) == 1
    assert library.mechkin_plan_set_constants(plan, nothing, message) == 1  # a length unit of zero
    library.mechkin_plan_free(plan)
    library.mechkin_plan_free(None)
