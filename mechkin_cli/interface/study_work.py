"""What travels to those who compute a study, and what they do with it."""

from __future__ import annotations

import pickle
import threading
from collections.abc import Mapping
from concurrent.futures import Executor, Future
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.interface.study_chunk import Question, chunk
from mechkin_cli.version import version

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.interface.model import Model
    from mechkin_cli.studies.records import Records


class Parcel(NamedTuple):
    """A mechanism and what is asked of its variants, as bytes: the text of the file and of the
    tables that it names, so that a worker needs nothing but the package."""

    content: bytes
    version: str

    @classmethod
    def of(cls, model: Model, question: Question) -> Parcel:
        """The parcel of a model and a question."""
        return cls(pickle.dumps((model, question)), version())


class Answer(NamedTuple):
    """What a worker found, and which version of mechkin it has."""

    tables: dict[str, Records]
    version: str


def work_off(parcel: Parcel, values: Mapping[str, Floats], begin: int, threads: int) -> Answer:
    """Done by a worker: the records of variants with these values, the first with the number
    `begin`."""
    own = version()
    if own != parcel.version:
        return Answer({}, own)
    model, question = _unpacked(parcel)
    return Answer(chunk(model, question, values, begin, threads), own)


def submit(
    executor: Executor, parcel: Parcel, values: Mapping[str, Floats], begin: int, threads: int
) -> Future[Answer]:
    """Hands the variants to an executor."""
    return executor.submit(work_off, parcel, values, begin, threads)


def check_version(found: str) -> None:
    """Refuses a worker of another version.

    Raises:
        UsageError: its numbers might be others.
    """
    own = version()
    if found != own:
        raise UsageError(
            f"a worker has mechkin {found}, this is mechkin {own}: results would not be those of "
            "one program; install the same version everywhere"
        )


class _Kept(threading.local):
    """What a thread has unpacked last: a model of its own, built once for all its tasks."""

    parcel: Parcel | None = None
    content: tuple[Model, Question]


_kept = _Kept()


def _unpacked(parcel: Parcel) -> tuple[Model, Question]:
    if _kept.parcel != parcel:
        _kept.content = pickle.loads(parcel.content)
        _kept.parcel = parcel
    return _kept.content
