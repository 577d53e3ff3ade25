"""Who computes a study: any executor, and workers that die."""

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from references import FILE_OF
from studies.poison import poisoned
from studies.studies import RCSR

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.studies import study as running
from mechkin_cli.studies.workers import Executors, Task, executed, processes


@pytest.fixture(scope="module")
def model() -> mk.Model:
    return mk.load(FILE_OF["rcsr"])


def test_the_variants_that_kill_a_process_are_found_and_the_rest_goes_on() -> None:
    victims = (5, 21, 22)

    def submit(executor: Executor, task: Task) -> Future[list[int]]:
        return executor.submit(poisoned, task, victims)

    def make() -> Executor:
        return processes(2)

    executors = Executors(make(), make)
    tasks = [Task(number, 8 * number, 8 * number + 8) for number in range(4)]
    lost: list[int] = []

    def died(task: Task) -> list[int]:
        lost.append(task.begin)
        return []

    found = [each for _, part in executed(tasks, submit, died, executors, 2) for each in part]
    executors.current.shutdown(wait=False, cancel_futures=True)
    assert sorted(lost) == list(victims)
    assert sorted(found) == [number for number in range(32) if number not in victims]


def test_an_error_of_a_task_ends_the_study() -> None:
    def fails(task: Task) -> int:
        raise ArithmeticError("task 2") if task.piece == 2 else None  # type: ignore[misc]

    def submit(executor: Executor, task: Task) -> Future[int]:
        return executor.submit(lambda: 1 if task.piece != 2 else fails(task))

    with ThreadPoolExecutor(1) as pool:
        tasks = [Task(number, number, number + 1) for number in range(4)]
        found = executed(tasks, submit, lambda task: 0, Executors(pool), 1)
        assert next(found) == (tasks[0], 1)
        with pytest.raises(ArithmeticError, match="task 2"):
            list(found)


class Inline(Executor):
    """Computes at once; `spoil` may put something else into a future."""

    def __init__(self, spoil: Callable[[int, int], BaseException | None]) -> None:
        self.spoil = spoil
        self.calls = 0

    def submit(self, function: Any, /, *given: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.calls += 1
        if len(given) == 4:
            count = len(next(iter(given[1].values())))
            error = self.spoil(given[2], given[2] + count)
            if error is not None:
                future.set_exception(error)
                return future
        future.set_result(function(*given, **named))
        return future


def test_any_executor_computes_the_same(model: mk.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = model.study(RCSR)
    monkeypatch.setattr(running, "MOST_IN_PIECE", 5)
    inline = Inline(lambda begin, end: None)
    for executor in (inline, ThreadPoolExecutor(3)):
        with executor:
            found = model.study(RCSR, executor=executor)
        for label in whole:
            assert np.array_equal(
                found[label], whole[label], equal_nan=whole[label].dtype != object
            )
    assert inline.calls > 10


def test_a_variant_that_its_worker_dies_of_is_recorded(model: mk.Model) -> None:
    victim = 11

    def dies(begin: int, end: int) -> BaseException | None:
        return BrokenExecutor("dead") if begin <= victim < end else None

    whole = model.study(RCSR)
    found = model.study(RCSR, executor=Inline(dies))
    others = np.arange(len(whole)) != victim
    assert found["verdict"][victim] == "worker-died"
    assert np.isnan(found["peak(O1.effort)"][victim])
    assert np.array_equal(found["P2"], whole["P2"])
    for label in ("peak(O1.effort)", "verdict"):
        same = found[label][others] == whole[label][others]
        assert (same | (found[label][others] != found[label][others])).all()
    assert victim not in found.rows["variant"]


def test_workers_of_another_version_are_refused(model: mk.Model) -> None:
    class Older(Inline):
        def submit(self, function: Any, /, *given: Any, **named: Any) -> Future[Any]:
            asked = (lambda: "0.0.1") if function is running.version else function
            return super().submit(asked, *given, **named)

    with pytest.raises(UsageError, match=r"a worker has mechkin 0.0.1, this is mechkin"):
        model.study(RCSR, executor=Older(lambda begin, end: None))
    assert running.version() != "0.0.1"


def test_workers_that_have_gone_are_told(model: mk.Model) -> None:
    class Gone(Inline):
        def submit(self, function: Any, /, *given: Any, **named: Any) -> Future[Any]:
            if len(given) == 4:
                raise RuntimeError("cannot schedule new futures after shutdown")
            return super().submit(function, *given, **named)

    with pytest.raises(UsageError, match="the workers have gone away: cannot schedule"):
        model.study(RCSR, executor=Gone(lambda begin, end: None))


def test_one_says_who_computes(model: mk.Model) -> None:
    with pytest.raises(UsageError, match="give one of them"):
        model.study(RCSR, processes=2, executor=Inline(lambda begin, end: None))


def test_a_parcel_needs_no_file(tmp_path: Any) -> None:
    """The mechanism and the tables that it names travel as text."""
    import pickle

    (tmp_path / "arm.yaml").write_text(
        "format: 1\nlinks: {arm: {mass: 1, center_of_mass: [1, 0, 0]}}\n"
        "joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}\n"
        "motion: {time: {from: 0, to: 1, step: 0.5}, "
        "inputs: {O.theta: {law: table, file: turn.csv}}}\n"
    )
    (tmp_path / "turn.csv").write_text("time,angle\n0,0\n0.5,30\n1,90\n2,91\n")
    model = mk.load(tmp_path / "arm.yaml")
    expected = model.analyze()["O.theta"].tolist()
    sent = pickle.dumps(model)
    (tmp_path / "turn.csv").unlink()
    (tmp_path / "arm.yaml").unlink()
    assert pickle.loads(sent).analyze()["O.theta"].tolist() == expected


def test_a_script_without_a_guard_is_told(tmp_path: Any) -> None:
    """Every new process reads the script that starts them."""
    import subprocess
    import sys

    script = tmp_path / "script.py"
    script.write_text(
        "import mechkin_cli as mk\n"
        f"m = mk.load({str(FILE_OF['rcsr'])!r})\n"
        "try:\n"
        "    m.study({'vary': {'P1': [0.5, 0.51]}}, processes=1)\n"
        "except mk.MechkinError as error:\n"
        "    print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=60, check=False
    )
    assert 'does its work below `if __name__ == "__main__":`' in done.stdout
