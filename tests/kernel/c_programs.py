"""Programs in C over the core without Python: how they are built and run, and what Python has."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from kernel.compiler import SOURCES, compile_with
from live.slider_crank import rubbing_slider_crank, slider_crank, stiff_slider_crank
from references import FILE_OF

from mechkin_cli import Model, load, loads
from mechkin_cli.live.response import ResponseRecording
from mechkin_cli.plan.outputs import OutputPlan
from mechkin_cli.plan.plan import plan_records
from mechkin_cli.response.result import ResponseResult
from mechkin_cli.session.kernel_run import POSITIONS, RESIDUAL_TESTS, Ask, Batch, RowInputs
from mechkin_cli.session.session import Session
from mechkin_cli.variants import base_of
from mechkin_cli.view.scene import page_data

CMAKE = shutil.which("cmake")
C_COMPILER = shutil.which(os.environ.get("CC", "cc"))
PROGRAM = Path(__file__).with_name("c_runs.c")
HEADERS = ["-I", str(SOURCES.parent / "c")]
STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"]

ALONE = [
    "-DMECHKIN_C_INTERFACE=ON",
    "-DMECHKIN_NARROW=ON",
    "-DBUILD_SHARED_LIBS=ON",
    "-DCMAKE_BUILD_TYPE=Release",
    "-DCMAKE_CXX_FLAGS=-fno-exceptions -fno-rtti",
    # whoever looks for these stops the build
    *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("Python", "Python3", "nanobind")),
]
GIVEN = RowInputs._fields[: RowInputs._fields.index("place")]
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
    return Batch(
        *(each[..., rows].copy() if isinstance(each, np.ndarray) else each for each in batch)
    )


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


def moving(name: str) -> tuple[Model, str]:
    """A model and its response, by a name of `RESPONSES`."""
    if name == "rcsr_response":
        return load(FILE_OF[name]), "response"
    others = {"rubbing": rubbing_slider_crank, "stiff": stiff_slider_crank}
    if name in others:
        return loads(others[name]()), "swing"
    return loads(slider_crank(name)), name


RESPONSES = ("rcsr_response", "swing", "until", "off", "rubbing", "stiff")
"""To the last row, up to a stop, from a start that moves; with friction, and by the implicit
method."""


class Recorded(NamedTuple):
    """A response as a page has it: the texts of its start and of its motion, and its parameters."""

    start: str
    motion: str
    names: list[str]
    recording: ResponseRecording

    @classmethod
    def of(cls, model: Model, run: str) -> Recorded:
        analysis = model.respond(run)
        data, _ = page_data([analysis], modes=False)
        names = [one["name"] for one in data["live"]["parameters"]]
        start = base_of(model.design).response_variation(names, run)
        assert start is not None
        recording = ResponseRecording(analysis, data, start)
        record = recording.record()
        assert record is not None
        return cls(record["start"], record["plan"], names, recording)

    def varied(self, model: Model, spread: float) -> Model:
        """A model with parameters that differ by chance."""
        random, problem, case = np.random.default_rng(0), model.problem, {}
        for name in self.names:
            own = problem.parameters[name]
            value = float(own.value) * (1.0 + spread * random.standard_normal())
            case[name] = float(problem.units.from_si(value, own.dimension))
        return model.with_parameters(case)

    def compare(self, built: Built, folder: Path, model: Model, run: str) -> None:
        """The response of a model with other values of these parameters."""
        known = model.problem.parameters
        values = np.array([float(known[name].value) for name in self.names])
        found = self.run_by_c(built, folder, values)
        assert found == self.wanted(model.respond(run).result)

    def run_by_c(self, built: Built, folder: Path, values: np.ndarray) -> bytes:
        """What the program in C finds."""
        files = ("start.txt", "motion.txt", "given.bin", "found.bin")
        names = [str(folder / name) for name in files]
        for name, text in zip(names[:2], (self.start, self.motion), strict=True):
            Path(name).write_text(text, encoding="ascii")
        Path(names[2]).write_bytes(values.tobytes())
        subprocess.run([str(built.program), *names], check=True)
        return Path(names[3]).read_bytes()

    def wanted(self, result: ResponseResult) -> bytes:
        """The same of a response that Python has integrated and read."""
        assert result.report is not None
        report, length = result.report, result.session.layout.length
        readout, rows = self.recording.reading.readout, self.recording.response.rows
        columns = result.evaluated(readout.wanted, demand=self.recording.demand)
        values = np.full((readout.outputs.slots, rows), np.nan)
        for quantity in readout.wanted:
            column = columns[quantity.name]
            if quantity.kind == "coordinate" and quantity.name in result.problem.quantities():
                column = result.quantity(quantity.name).value  # with its whole turns
            values[readout.slots[quantity.name], : result.rows] = column
        verdicts = np.full((5, rows), np.nan)
        verdicts[0, : result.rows] = result.residual
        verdicts[1, : result.rows] = result.quantity("row.condition").value
        verdicts[2, : result.rows] = result.quantity("row.power_error").value
        verdicts[3, : result.rows] = result.work
        verdicts[4, : result.rows] = result.dissipated
        reached = int(result.row_states.reached.sum())
        told = np.array([0, result.rows, reached, report.rows, report.stop], np.int64)
        moment = np.array([report.time, length * length * report.energy])
        return b"".join(part.tobytes() for part in (told, moment, values, verdicts))
