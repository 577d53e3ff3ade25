"""Studies on Dask clusters on this machine: a local one, and one started from the command line."""

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
import pytest
from references import FILE_OF
from studies.studies import RCSR, study_text

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError

distributed = pytest.importorskip("distributed")

SECONDS = 60.0
"""Long after everything should have begun."""


def waited(condition: object, what: str) -> None:
    end = time.monotonic() + SECONDS
    while not condition():  # type: ignore[operator]
        assert time.monotonic() < end, what
        time.sleep(0.02)


def test_a_local_cluster_finds_the_same() -> None:
    model = mk.load(FILE_OF["rcsr"])
    whole = model.study(RCSR)
    with distributed.LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster:
        found = model.study(RCSR, scheduler=cluster.scheduler_address)
    for label in whole:
        assert np.array_equal(found[label], whole[label], equal_nan=whole[label].dtype != object)


def test_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mechkin_cli.studies.workers.SECONDS", 1)
    model = mk.load(FILE_OF["rcsr"])
    with pytest.raises(UsageError, match=r"no scheduler answers at tcp://127.0.0.1:9: .*; start"):
        model.study(RCSR, scheduler="tcp://127.0.0.1:9")


class Machines:
    """A scheduler and two workers as processes of their own, on the loopback address."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self.stack = stack
        file = folder / "scheduler.json"
        self.scheduler = self.started("scheduler", "--port", "0", "--scheduler-file", str(file))
        waited(file.exists, "the scheduler does not start")
        self.address = str(json.loads(file.read_text())["address"])
        self.workers = [
            self.started("worker", self.address, "--nthreads", "1", "--no-nanny") for _ in range(2)
        ]
        with distributed.Client(self.address, set_as_default=False) as client:
            waited(lambda: len(client.nthreads()) == 2, "the workers do not start")

    def started(self, what: str, *arguments: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-P", "-m", f"distributed.cli.dask_{what}", *arguments]
        running = subprocess.Popen(
            [*command, "--no-dashboard", "--host", "127.0.0.1"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.stack.callback(ended, running)
        return running


def ended(running: subprocess.Popen[bytes]) -> None:
    running.kill()
    running.wait()


@contextmanager
def machines(folder: Path) -> Iterator[Machines]:
    with ExitStack() as stack:
        yield Machines(folder, stack)


def command(study: Path, out: Path, *more: str) -> list[str]:
    code = (
        "import sys; from mechkin_cli.studies import study; study.MOST_IN_PIECE = 20; "
        "from mechkin_cli.__main__ import main; sys.exit(main())"
    )
    words = ["study", str(study), "--out", str(out), "--quiet", *more]
    # -P: the installed package, not the source folder that the tests may be started in
    return [sys.executable, "-P", "-c", code, *words]


def test_killed_workers_and_schedulers_change_no_byte(tmp_path: Path) -> None:
    study = tmp_path / "study.yaml"
    study.write_text(study_text(RCSR | {"sample": {"count": 120}}, FILE_OF["rcsr"]))
    subprocess.run(command(study, tmp_path / "here"), check=False)
    expected = (tmp_path / "here/variants.csv").read_bytes()

    def pieces(folder: Path) -> int:
        return len(list(folder.glob("pieces/variants-*.csv")))

    with machines(tmp_path) as found:
        # one of two workers dies
        out = tmp_path / "one worker"
        with subprocess.Popen(command(study, out, "--scheduler", found.address)) as running:
            waited(lambda: pieces(out) >= 3 or running.poll() is not None, "no piece is written")
            found.workers[0].send_signal(signal.SIGKILL)
            assert running.wait(SECONDS) == 4
        assert (out / "variants.csv").read_bytes() == expected
        # the scheduler dies: told in one sentence, and what is there stays
        out = tmp_path / "no scheduler"
        with subprocess.Popen(
            command(study, out, "--scheduler", found.address), stderr=subprocess.PIPE, text=True
        ) as running:
            waited(lambda: pieces(out) >= 3 or running.poll() is not None, "no piece is written")
            found.scheduler.send_signal(signal.SIGKILL)
            _, said = running.communicate(timeout=SECONDS)
        assert running.returncode == 2, said
        assert "the workers have gone away" in said
        assert pieces(out) >= 3
        subprocess.run(command(study, out), check=False)
        assert (out / "variants.csv").read_bytes() == expected
