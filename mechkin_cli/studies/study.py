"""Many variants in pieces, in memory or in a folder that the next run goes on with.

First what travels to those who compute a study, then the study, then who computes.
"""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import ExitStack
from functools import cached_property, partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.arguments import a_path, a_text, a_whole_number
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel.functions import check_threads
from mechkin_cli.record import NamedTuple
from mechkin_cli.studies.chunk import VARIANT, VERDICTS, StudyQuestion, chunk, lost
from mechkin_cli.studies.folder import VARIANTS, Share, StudyFolder, spare
from mechkin_cli.studies.formats import Format, GatheredRecords, Records, format_of, joined
from mechkin_cli.studies.plan import study_plan
from mechkin_cli.studies.results import (
    GatheredOverview,
    Overview,
    RunningOverview,
    StudyFiles,
    StudyResults,
    overview,
)
from mechkin_cli.studies.shares import merge, part_folder, share_of
from mechkin_cli.studies.source import StudySource, open_study
from mechkin_cli.studies.workers import Executors, Task, cluster, executed, processes
from mechkin_cli.tolerances import MOST_KEPT, MOST_THREADS
from mechkin_cli.variants import base_of
from mechkin_cli.verdict import SWEEP, __version__

if TYPE_CHECKING:
    from mechkin_cli.analysis import Solvable
    from mechkin_cli.show import Floats


Parcel = tuple[bytes, str]
"""A mechanism and what is asked of its variants, as bytes, and the version of mechkin; with the
text of the file and of the tables that it names, so that a worker needs nothing but the package."""

Answer = tuple[dict[str, Records], str]
"""The tables that a worker has computed, and its version of mechkin."""


def version() -> str:
    """Done by a worker: its version of mechkin."""
    return __version__


def work_off(parcel: Parcel, values: Mapping[str, Floats], begin: int, threads: int) -> Answer:
    """Done by a worker: the records of variants with these values, the first with the number
    `begin`."""
    if parcel[1] != __version__:
        return {}, __version__
    model, question = _unpacked(parcel)
    return chunk(model, question, values, begin, threads), __version__


def _work_off_here(
    model: Solvable,
    question: StudyQuestion,
    values: Mapping[str, Floats],
    begin: int,
    threads: int,
) -> Answer:
    """The same, done by a thread of this process."""
    return chunk(model, question, values, begin, threads), __version__


def check_version(found: str) -> None:
    """Refuses a worker of another version.

    Raises:
        UsageError: its numbers might be others.
    """
    if found != __version__:
        raise UsageError(
            f"a worker has mechkin {found}, this is mechkin {__version__}: results would not be "
            "those of one program; install the same version everywhere"
        )


_unpacked_by_thread = threading.local()
"""The parcel that a thread unpacked last: a model of its own, built once for all its tasks."""


def _unpacked(parcel: Parcel) -> tuple[Solvable, StudyQuestion]:
    last = _unpacked_by_thread
    if getattr(last, "parcel", None) != parcel:
        last.content = pickle.loads(parcel[0])
        last.parcel = parcel
    content: tuple[Solvable, StudyQuestion] = last.content
    return content


PIECE_NUMBERS = 2_000_000
"""Numbers that a piece's rows hold at most while it is computed."""

MOST_IN_PIECE = 4096
RESPONSES_IN_PIECE = 512
LEAST_IN_PIECE = 256
LEAST_RESPONSES_IN_PIECE = 64
PIECES = 20
"""Variants of a piece: enough to fill the kernel's packs and threads, few enough to lose little;
and of a small study so few that its progress is seen in so many steps, but not so few that writing
a piece, which goes on in one thread, takes a tenth of what computing it takes in two."""

TRIAL = 16
TRIAL_SECONDS = 0.25
"""Variants of the first trial; a trial that takes less than this is made again with more."""

Progress = Callable[[int, int], None]
"""Called with how many variants are done, and of how many: at first, and after each piece."""


class Workers(NamedTuple):
    """Who computes.

    Attributes:
        threads: of the kernel, in each process; 0: as many as pay.
        processes: new ones on this machine; 0: this process alone.
        executor: one of the caller's.
        scheduler: the address of a Dask cluster.
        at_once: how many tasks the executor does at a time; 0: as many as it says it does.
    """

    threads: int = 0
    processes: int = 0
    executor: Executor | None = None
    scheduler: str | None = None
    at_once: int = 0

    @property
    def is_here(self) -> bool:
        """Whether this process computes."""
        return not self.processes and self.executor is None and self.scheduler is None


class Study:
    """A study of a model, planned and not yet carried out; of a share of it, where one is named."""

    def __init__(self, model: Solvable, source: StudySource, share: Share | None = None) -> None:
        """Raises:
        InvalidFile: with every independent error and its place.
        """
        self.model = model
        self.source = source
        self.share = share
        plan = study_plan(source.file, source.document, model)
        self.variation, self.question, notes = plan
        self.notes = (*source.document.notes, *notes)

    @property
    def variants(self) -> int:
        """How many, of all shares."""
        return len(self.variation)

    @property
    def numbers(self) -> range:
        """Numbers of the variants that are computed: all, or those of the share."""
        return (self.share or Share()).of(self.variants)

    @property
    def piece(self) -> int:
        """Variants of a piece."""
        question = self.question
        wished = len(self.numbers) // PIECES
        if question.run != SWEEP:
            return min(RESPONSES_IN_PIECE, max(LEAST_RESPONSES_IN_PIECE, wished))
        wide = 2 + len({column.text for column in question.columns}) + len(question.rows)
        most = PIECE_NUMBERS // (self.model.problem.motion.rows * wide)
        return max(1, min(MOST_IN_PIECE, max(LEAST_IN_PIECE, wished), most))

    @cached_property
    def _sources(self) -> dict[str, str]:
        """Digests of what the results of this study follow from."""
        document, known = self.model.built.document, self.model.problem.parameters
        values = dict(document.overrides) | {n: repr(known[n].value) for n in known}
        study = dict(self.source.document.data)
        for key in ("mechanism", "name"):
            study.pop(key, None)
        sources = {
            "mechanism": _digest(document.text.encode("utf-8", "surrogatepass")),
            "parameters": _digest(_canonical(values)),
            "study": _digest(_canonical(study)),
            "version": __version__,
        }
        tables = {**document.tables, **self.source.document.tables}
        return sources | {name: _digest(content) for name, content in tables.items()}

    def trial(self, workers: Workers, file_format: str) -> tuple[int, float, float, float]:
        """Computes some variants, spread over all, as an estimate of the time and the size of all:
        how many, their seconds, and the seconds and bytes of all.

        Raises:
            UsageError: there is no such format.
        """
        kind, tables = format_of(file_format), self.question.tables
        count = TRIAL
        while True:
            count = min(count, self.variants)
            numbers = [number * self.variants // count for number in range(count)]
            lines = [self.variation.values(k, k + 1) for k in numbers]
            values = {name: np.concatenate([one[name] for one in lines]) for name in lines[0]}
            begin = perf_counter()
            computed = chunk(self.model, self.question, values, 0, workers.threads)
            seconds = perf_counter() - begin
            if seconds > TRIAL_SECONDS or count == min(self.variants, self.piece):
                break
            count = min(4 * count, self.piece)
        size = sum(len(kind.piece(headings, computed[name])) for name, headings in tables.items())
        share = len(self.numbers) / count
        at_once = max(workers.processes, 1)
        return count, seconds, seconds * share / at_once, size * share

    def computed(
        self, tasks: list[Task], workers: Workers
    ) -> Iterator[tuple[Task, dict[str, Records]]]:
        """The records of tasks, in the order in which they end."""
        question, variation = self.question, self.variation
        with ExitStack() as stack:
            # threads of the kernel split a piece that is the only one
            is_alone = len(tasks) < 2 and workers.is_here
            chosen = None if is_alone else _executors(workers, stack)
            if chosen is None:
                for task in tasks:
                    values = variation.values(task.begin, task.end)
                    yield task, chunk(self.model, question, values, task.begin, workers.threads)
                return
            executors, count, threads = chosen
            shared = workers.is_here
            if shared:  # threads share the model, and what is recorded of it
                base_of(self.model.design)
            parcel = None if shared else (pickle.dumps((self.model, question)), __version__)

            def submit(executor: Executor, task: Task) -> Future[Answer]:
                values = variation.values(task.begin, task.end)
                if parcel is None:
                    given = self.model, question, values, task.begin, threads
                    return executor.submit(_work_off_here, *given)
                return executor.submit(work_off, parcel, values, task.begin, threads)

            def died(task: Task) -> Answer:
                values = variation.values(task.begin, task.end)
                return lost(question, values, task.begin), __version__

            for task, (tables, theirs) in executed(tasks, submit, died, executors, count):
                check_version(theirs)
                yield task, tables

    def in_memory(self, workers: Workers, progress: Progress | None = None) -> StudyResults:
        """All results as arrays.

        Raises:
            UsageError: they are too many for the memory.
        """
        workers = _checked(workers)
        question = self.question
        rows, tables = self.model.problem.motion.rows, question.tables
        width = len(tables[VARIANTS]) + len(tables.get("rows", ())) * rows
        if self.variants * width > MOST_KEPT:
            raise UsageError(
                f"the results of {self.variants} variants are {self.variants * width} numbers "
                f"(limit {MOST_KEPT}); write them to a folder: out="
            )
        size = self.piece
        pieces = range(-(-self.variants // size))
        tasks = [Task(n, n * size, min((n + 1) * size, self.variants)) for n in pieces]
        gathered = GatheredRecords(self.variants, VARIANTS)
        for task, computed in self._whole_pieces(tasks, workers, progress, 0):
            gathered.put(task.begin, task.end, computed)
        return StudyResults(self.source.name, question.tables, gathered.tables(), self.notes)

    def in_folder(
        self,
        folder: Path,
        workers: Workers,
        file_format: str = "csv",
        again: bool = False,
        progress: Progress | None = None,
    ) -> StudyFiles:
        """Writes the results into a folder, those of a share into a folder in it; takes up what an
        earlier run of the same study left.

        Raises:
            UsageError: the folder holds another study, another process writes to it, or a file
                cannot be written; pieces that were written stay.
        """
        workers, kind, question = _checked(workers), format_of(file_format), self.question
        spare(folder, [*self.model.built.document.files, *self.source.document.files])
        with self._folder(folder, kind, self.share) as output:
            output.begin(again)
            missing = [] if output.is_complete else output.missing()
            tasks = [Task(number, *output.stretch(number)) for number in missing]
            done = len(self.numbers) - sum(task.end - task.begin for task in tasks)
            running = RunningOverview(question.tables[VARIANTS], VARIANT.label, VERDICTS[1].label)
            gathered = GatheredOverview(running, self.numbers.start)
            for task, records in self._whole_pieces(tasks, workers, progress, done):
                output.put(task.piece, records)
                if not done:
                    gathered.put(task.begin, records[VARIANTS])
            if not output.is_complete:
                output.finish()
            return self._written(output, gathered.overview() if tasks and not done else None)

    def merged(self, folder: Path, file_format: str = "csv", again: bool = False) -> StudyFiles:
        """Puts the shares in a folder together, as if the whole study had been run there, and
        removes them.

        Raises:
            UsageError: a share is missing, unfinished, damaged, there twice or of another study;
                or the folder holds another study, or a file cannot be written. All shares stay.
        """
        kind = format_of(file_format)
        spare(folder, [*self.model.built.document.files, *self.source.document.files])
        with self._folder(folder, kind, None) as output:
            merge(output, lambda share: self._folder(folder, kind, share), again)
            return self._written(output)

    def _folder(self, folder: Path, kind: Format, share: Share | None) -> StudyFolder:
        """The folder of the whole study, or that of a share in it."""
        where = folder if share is None else part_folder(folder, share)
        tables = self.question.tables
        return StudyFolder(where, self._sources, self.variants, tables, kind, self.piece, share)

    def _written(self, output: StudyFolder, seen: Overview | None = None) -> StudyFiles:
        if seen is None:
            headings = self.question.tables[VARIANTS]
            seen = overview(output.read(VARIANTS), headings, VARIANT.label, VERDICTS[1].label)
        return StudyFiles(self.source.name, tuple(output.results), seen, self.notes)

    def _whole_pieces(
        self, tasks: list[Task], workers: Workers, progress: Progress | None, done: int
    ) -> Iterator[tuple[Task, dict[str, Records]]]:
        """Pieces, of which a worker that died may have left several parts."""
        whole = {task.piece: task for task in tasks}
        parts: dict[int, list[tuple[Task, dict[str, Records]]]] = {}
        if progress is not None and tasks:
            progress(done, len(self.numbers))
        for part, tables in self.computed(tasks, workers):
            task = whole[part.piece]
            own = parts.setdefault(part.piece, [])
            own.append((part, tables))
            done += part.end - part.begin
            if sum(p.end - p.begin for p, _ in own) == task.end - task.begin:
                own.sort(key=lambda item: item[0].begin)
                names = self.question.tables
                yield task, {name: joined([tables[name] for _, tables in own]) for name in names}
                del parts[part.piece]
            if progress is not None:
                progress(done, len(self.numbers))


def study_of(
    model: Solvable,
    study: str | Path | Mapping[str, Any],
    out: str | Path | None,
    file_format: str,
    again: bool,
    workers: Workers,
    progress: Progress | None,
    part: str | None,
    merge: bool,
) -> StudyResults | StudyFiles:
    """`Model.study`, whose arguments these are."""
    if not isinstance(study, Mapping):
        study = a_path("study", study)
    a_text("format", file_format, '"csv"')
    source = open_study(study)
    share = None if part is None else share_of(a_text("part", part, '"3/8"'))
    if merge and share is not None:
        raise UsageError("merge puts all parts together; leave part out")
    planned = Study(source.applied_to(model), source, share)
    if out is None:
        if merge or share is not None:
            raise UsageError("the parts of a study are kept in a folder; name it with out=")
        return planned.in_memory(workers, progress)
    if merge:
        return planned.merged(a_path("out", out), file_format, again)
    return planned.in_folder(a_path("out", out), workers, file_format, again, progress)


def _checked(workers: Workers) -> Workers:
    """The same with whole numbers; UsageError where they are none, or too many."""
    count = a_whole_number("processes", workers.processes, "processes")
    if count > MOST_THREADS:
        raise UsageError(f"processes {count}: at most {MOST_THREADS}")
    threads = a_whole_number("threads", workers.threads, "threads")
    check_threads(threads)
    return workers._replace(threads=threads, processes=count)


def _executors(workers: Workers, stack: ExitStack) -> tuple[Executors, int, int] | None:
    """Executors, how many tasks they do at a time, threads of each; None: this process computes."""
    named = (workers.executor is not None, workers.scheduler is not None, workers.processes > 0)
    if sum(named) > 1:
        raise UsageError("processes, executor and scheduler say who computes; give one of them")
    if workers.scheduler is not None:
        client, count, versions = stack.enter_context(cluster(workers.scheduler, version))
        for theirs in versions:
            check_version(theirs)
        return Executors(client), workers.at_once or count, workers.threads or 1
    if workers.executor is not None:
        count = getattr(workers.executor, "_max_workers", 0) or os.cpu_count() or 1
        check_version(workers.executor.submit(version).result())
        return Executors(workers.executor), workers.at_once or count, workers.threads or 1
    if workers.processes:
        make = partial(processes, workers.processes)
        executors = Executors(make(), make)
        stack.push(partial(_shut_down, executors))
        return executors, workers.processes, workers.threads or 1
    threads = workers.threads or os.cpu_count() or 1
    if threads == 1:
        return None
    # a piece to a thread: what is done beside the kernel goes on in several, too
    pool = ThreadPoolExecutor(threads)
    executors = Executors(pool)
    stack.push(partial(_shut_down, executors))
    return executors, threads, 1


def _shut_down(executors: Executors, kind: object, *_: object) -> None:
    """Ends the executor of a study. Where all is computed its threads and processes have ended when
    this returns, so that nothing is left to end with the program; an error is not kept waiting by
    what they still do."""
    executors.current.shutdown(wait=kind is None, cancel_futures=True)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _canonical(data: Mapping[str, Any]) -> bytes:
    return json.dumps(data, sort_keys=True, ensure_ascii=False).encode("utf-8", "surrogatepass")
