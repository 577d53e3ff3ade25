"""Streamed runs that are stopped at random: nothing is torn, and the next run is clean.

    python -P tests/random_families/stopped_streams.py [NUMBER] [SEED]

A run writes large tables (CSV, packed lines of JSON, Parquet, Arrow) and a small file into a folder
that has those of another run. It is killed, interrupted, or runs into a limit of file sizes or a
full disk at a random place; or it prints JSON to a reader that is slow and goes away. Then the
folder has the files of one run or of the other, and the next run leaves nothing but its own.
"""

from __future__ import annotations

import contextlib
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]

from cli import files
from tables.streamed import cut, random_table

from mechkin_cli.cli import interrupts
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables import OutputFolder, TableStream, heading_of, write_table
from mechkin_cli.tables.folder import LISTING

ROWS = 20_000
TABLES = [random_table(ROWS, seed) for seed in (1, 2)]
FORMATS = ("csv", "jsonl.gz", "parquet", "arrow")
DONE, REFUSED = 0, 2
MECHKIN = [sys.executable, "-P", "-m", "mechkin_cli"]


def write_run(folder: Path, which: int) -> None:
    """A run with the first or the second table, in blocks; with the second one, a file less."""
    table = TABLES[which]
    with OutputFolder(folder) as output:
        for format in FORMATS[which:]:
            with output.begin(f"large.{format}") as file:
                stream = TableStream(heading_of(table), cut(table, 1000))
                write_table(stream, format, file)
        output.add("small.md", f"run {which}".encode())
        output.write_run()


def found(folder: Path) -> dict[str, bytes]:
    """What a reader of the folder finds by name: behind that of a new file there is none until the
    moment of its set."""
    paths = sorted(folder.iterdir()) if folder.is_dir() else []
    files = [path for path in paths if path.is_file() and not path.name.startswith(".")]
    return {path.name: path.read_bytes() for path in files}


def debris(folder: Path) -> list[str]:
    """What is no file of a run."""
    return [
        path.name
        for path in (folder.iterdir() if folder.is_dir() else ())
        if path.is_symlink() or (path.name.startswith(".") and path.name != LISTING)
    ]


def forked(work: Callable[[], None], said: Path) -> int:
    """The process of a child that does the work; what it is refused with stands in `said`."""
    process = os.fork()
    if process:
        return process
    code = 70
    try:
        interrupts.end_quietly()
        os.close(2)
        work()
        code = DONE
    except UsageError as error:
        said.write_text(str(error))
        code = REFUSED
    except KeyboardInterrupt:  # while files were put in their places
        code = interrupts.INTERRUPTED
    finally:
        os._exit(code)


def code_of(process: int) -> int:
    """The exit code of a child."""
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


class Stopped:
    """Runs in one folder, one stopped after the other."""

    def __init__(self, place: Path, seed: int) -> None:
        self.random = random.Random(seed)
        self.place, self.said = place, place / "said"
        self.counts: Counter[str] = Counter()
        self.known = []
        self.took = 0.0
        for which in (0, 1):
            start = time.monotonic()
            work = partial(write_run, place / "known", which)
            assert code_of(forked(work, self.said)) == DONE
            self.took = time.monotonic() - start
            self.known.append(found(place / "known"))
        assert self.known[0].keys() != self.known[1].keys()

    def check(self, folder: Path, stop: Callable[[Callable[[], None]], None]) -> None:
        """A run in a folder that has those of another is stopped, and the next one is clean."""
        which = self.random.randrange(2)
        before = found(folder)
        assert before in (*self.known, {})
        stop(lambda: write_run(folder, which))
        left = found(folder)
        assert left in (before, self.known[which]), sorted(left)
        self.counts["new" if left == self.known[which] else "old"] += 1
        next_run = self.random.randrange(2)
        assert code_of(forked(lambda: write_run(folder, next_run), self.said)) == DONE
        assert debris(folder) == []
        assert found(folder) == self.known[next_run]

    def signalled(self, number: signal.Signals) -> None:
        """By a signal at a random moment."""
        folder = self.place / "out"

        def stop(work: Callable[[], None]) -> None:
            process = forked(work, self.said)
            time.sleep(self.random.uniform(0.0, 1.1) * self.took)
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, number)
            code = code_of(process)
            assert code in (DONE, -number, interrupts.INTERRUPTED), code
            self.counts[f"{number.name} {'in time' if code else 'too late'}"] += 1
            left = debris(folder)
            assert number == signal.SIGKILL or left == []
            self.counts["left something"] += bool(left)

        self.check(folder, stop)

    def limited(self) -> None:
        """By the largest size that files may have."""
        folder = self.place / "out"
        size = max(len(content) for content in self.known[0].values())
        most = self.random.randrange(100_000, int(1.1 * size))

        def work(write: Callable[[], None]) -> None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
            write()

        self.check(folder, lambda write: self.refused(lambda: work(write), folder, "larger than"))

    def refused(self, work: Callable[[], None], folder: Path, words: str) -> None:
        """Does what may be refused, for a reason."""
        code = code_of(forked(work, self.said))
        assert code in (DONE, REFUSED), code
        assert debris(folder) == []
        if code == REFUSED:
            said = self.said.read_text()
            assert said.startswith(f"cannot write {folder}/")
            assert words in said
            self.counts[f"{words}{', after some rows' if 'rows:' in said else ''}"] += 1

    def full(self, disk: Path) -> None:
        """By a disk with a random part of the room that two runs need."""
        folder = disk / "out"
        filler = disk / "filler"
        assert code_of(forked(lambda: write_run(folder, 0), self.said)) == DONE
        state = os.statvfs(disk)
        free = state.f_bavail * state.f_frsize
        size = sum(map(len, self.known[0].values()))
        filler.write_bytes(bytes(max(0, free - self.random.randrange(int(1.1 * size)))))

        def stop(write: Callable[[], None]) -> None:
            self.refused(write, folder, "the disk is full")
            filler.unlink()

        self.check(folder, stop)

    def printed(self) -> None:
        """By a reader of JSON that is slow and goes away: files are written all the same."""
        file = self.place / "crank.yaml"
        file.write_text(files.CRANK.replace("step: 45", "step: 0.05"), encoding="utf-8")
        out = self.place / "printed"
        command = [*MECHKIN, "analyze", str(file), "--json", "--format", "csv,jsonl", "--out", out]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert process.stdout is not None
        assert process.stderr is not None
        for _ in range(self.random.randrange(4)):
            process.stdout.read(self.random.randrange(1, 40_000))
            time.sleep(self.random.uniform(0, 0.02))
        process.stdout.close()
        said = process.stderr.read().decode()
        assert (process.wait(60), said) == (0, ""), said
        assert debris(out) == []
        names = {f"{stem}.{kind}" for stem in ("rows", "sweep") for kind in ("csv", "jsonl")}
        assert found(out).keys() == names
        self.counts["reader went away"] += 1


@contextlib.contextmanager
def small_disk(place: Path, size: int) -> Iterator[Path | None]:
    """A disk of a size, where one may be had."""
    place.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(place)]
    try:
        is_there = subprocess.run(words, capture_output=True, check=False).returncode == 0
    except OSError:
        is_there = False
    try:
        yield place if is_there else None
    finally:
        if is_there:
            subprocess.run(["umount", str(place)], check=True)


def stopped(times: int, seed: int, place: Path) -> Counter[str]:
    """Stops so many runs; what happened to them."""
    runs = Stopped(place, seed)
    size = sum(map(len, runs.known[0].values()))
    with small_disk(place / "disk", 3 * size) as disk:
        for number in range(times):
            kind = number % 10
            if kind < 4:
                runs.signalled(signal.SIGKILL)
            elif kind < 6:
                runs.signalled(runs.random.choice([signal.SIGINT, signal.SIGTERM]))
            elif kind < 8 or (kind == 8 and disk is None):
                runs.limited()
            elif kind == 8 and disk is not None:
                runs.full(disk)
            else:
                runs.printed()
    return runs.counts


if __name__ == "__main__":
    times, seed = (int(word) for word in (*sys.argv[1:], *("300", "0")[len(sys.argv) - 1 :]))
    with tempfile.TemporaryDirectory() as folder:
        for words, count in sorted(stopped(times, seed, Path(folder)).items()):
            print(f"{count:6} {words}")
