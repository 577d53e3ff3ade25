"""The core without Python: built alone, without exceptions, and run by a program in C.

The rows have the bits that Python's session gives. What a session ran is caught as it runs, its
plan is written as text, and the program runs the text. Where `pip install .` left its build here
that core is linked, which saves most of a minute; with `MECHKIN_RANDOM=2` it is built alone.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from kernel.c_programs import (
    C_COMPILER,
    CMAKE,
    HEADERS,
    PROGRAM,
    RESPONSES,
    STRICT,
    Built,
    Recorded,
    built_alone,
    calls_of,
    caught,
    moving,
    of_core,
    outputs_of,
    picked,
    run_by_c,
    wanted_bytes,
)
from kernel.compiler import COMPILER, built_core
from references import FILE_OF

from mechkin_cli import load
from mechkin_cli.kernel.plan_text import plan_text
from mechkin_cli.plan.outputs import OutputPlan
from mechkin_cli.plan.records import flatten
from mechkin_cli.session.kernel_run import run as run_kernel
from mechkin_cli.tape.recorder import register
from mechkin_cli.tape.tape import Verdict
from mechkin_cli.variants.design import Base

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
pytestmark = pytest.mark.skipif(
    None in (COMPILER, C_COMPILER, CMAKE), reason="needs compilers and CMake"
)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    folder = tmp_path_factory.mktemp("alone")
    core = built_core() if TIMES == 1 and sys.platform == "linux" else None
    library = of_core(core, folder) if core else built_alone(folder)
    program = folder / "c_runs"
    linked = ["-L", str(library.parent), "-lmechkin", f"-Wl,-rpath,{library.parent}"]
    command = [str(C_COMPILER), *STRICT, str(PROGRAM), *HEADERS, "-o", str(program), *linked]
    subprocess.run(command, check=True)
    return Built(library, program)


@pytest.mark.parametrize(
    "stem", ["planar_four_bar", "rcsr", "stewart", "lecture_crane_30", "tackle"]
)
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
    ("stem", "names", "change", "last"),
    [
        ("rack_in_a_loop", ("crank", "rod", "radius"), -1.0, Verdict.OTHER_WAY),
        ("rcsr", ("alpha1", "P2", "cx"), 10.0, Verdict.SAME),
    ],
)
def test_a_tape_gives_the_rows_of_other_parameters(
    built: Built,
    stem: str,
    names: tuple[str, ...],
    change: float,
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
    for factor in (1.0, 1.001, 0.99, change):
        values, size = variation.values * factor, session.plan.size * 1.25
        plan = variation.plan(values, size)
        outputs = variation.reading(ask.readout.wanted).outputs(values)
        readout = ask.readout._replace(outputs=outputs)
        like = run_kernel(plan, rows, ask._replace(readout=readout))
        found = run_by_c(built, tmp_path, text, rows, ask, size, like, values)
        verdicts.append(int(variation.verdicts(values[:, None])[0]))
        if verdicts[-1] == Verdict.OTHER_WAY:
            assert found == []
            continue
        assert found == wanted_bytes([plan.constants, outputs.constants], ask, like)
    assert verdicts == [0, 0, 0, last]


@pytest.mark.parametrize("name", RESPONSES)
def test_a_response_has_the_bits_that_python_gives(built: Built, name: str, tmp_path: Path) -> None:
    """With the file's parameters and with others."""
    model, run = moving(name)
    report = model.respond(run).result.report
    assert report is not None
    assert report.stiff == (name == "stiff")
    recorded = Recorded.of(model, run)
    assert len(recorded.names) > 5
    recorded.compare(built, tmp_path, model, run)
    recorded.compare(built, tmp_path, recorded.varied(model, 0.01), run)


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
