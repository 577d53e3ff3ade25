"""The folder of a study: pieces as they are computed, and the whole results at the end.

`study.json` says what the folder holds, `pieces/` has a file for each piece that is done. A piece
is written under another name and renamed when it is whole, so that whatever ends the process leaves
pieces that are whole or not there; the next run computes those that are missing. At the end the
pieces are put together, and go. A share of a study has a folder of its own inside that of the
whole, in which it is kept in the same way.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.reading import MOST_TABLE_BYTES, read_regular
from mechkin_cli.record import NamedTuple
from mechkin_cli.studies.formats import FORMATS, Format, Records
from mechkin_cli.tables import Claim, Heading

MANIFEST = "study.json"
PIECES = "pieces"
VARIANTS, ROWS = "variants", "rows"
"""What the results are called, and in which order they are written."""

_UNFINISHED = ".unfinished"


class Share(NamedTuple):
    """The `number`-th of `total` consecutive stretches of a study's variants, from 1."""

    number: int = 1
    total: int = 1

    def __str__(self) -> str:
        return f"{self.number}/{self.total}"

    def of(self, variants: int) -> range:
        """Numbers of its variants, of so many; none where there are fewer variants than shares."""
        return range(
            (self.number - 1) * variants // self.total, self.number * variants // self.total
        )


class StudyFolder:
    """A folder that this process alone writes a study to, inside `with`."""

    def __init__(
        self,
        folder: Path,
        sources: Mapping[str, str],
        variants: int,
        tables: Mapping[str, Sequence[Heading]],
        file_format: Format,
        size: int,
        share: Share | None = None,
    ) -> None:
        """Args:
        folder: made as needed.
        sources: digests of what its results are of, by name (`mechanism`, `study`, ...); results
            of equal sources, variants, tables and format have equal bytes.
        variants: how many the whole study has.
        tables: headings of `variants`, and of `rows` where rows are kept.
        file_format: writes the files.
        size: variants of a piece, where the folder does not say yet.
        share: of the study that is kept here; None: all of it.
        """
        self.folder = folder
        self.sources = sources
        self.variants = variants
        self.tables = tables
        self.size = size
        self.share = share
        self.numbers = (share or Share()).of(variants)
        self.is_complete = False
        self._format = file_format
        self._claim: Claim | None = None

    def __enter__(self) -> StudyFolder:
        with refused(self.folder):
            self._claim = Claim(self.folder)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._claim is not None:
            self._claim.release()
            self._claim = None

    def begin(self, again: bool = False) -> None:
        """Takes up what an earlier run left, or begins; with `again` in any case.

        Raises:
            UsageError: the folder holds another study, or cannot be written to.
        """
        found = None if again else self.manifest()
        with refused(self.folder):
            if found is None:
                if not again:
                    self._refuse_foreign()
                self.clear()
                (self.folder / PIECES).mkdir(exist_ok=True)
                self._write_manifest()
                return
            self._check(found)
            self.size = int(found["piece"])
            self.is_complete = self.is_finished(found)
            if self.is_complete:
                shutil.rmtree(self.folder / PIECES, ignore_errors=True)
                return
            (self.folder / PIECES).mkdir(exist_ok=True)
            for path in (self.folder / PIECES).glob(f"*{_UNFINISHED}"):
                path.unlink()

    def _record(self) -> dict[str, Any]:
        """What the results are of, as plain data."""
        share = {} if self.share is None else {"part": str(self.share)}
        return share | {
            "sources": dict(self.sources),
            "variants": self.variants,
            "format": self._format.ending,
            "tables": {
                name: [heading._asdict() for heading in headings]
                for name, headings in self.tables.items()
            },
        }

    @property
    def results(self) -> list[Path]:
        """The files of the whole study."""
        return [self.folder / f"{name}.{self._format.ending}" for name in self.tables]

    @property
    def pieces(self) -> range:
        """Numbers of all pieces."""
        return range(-(-len(self.numbers) // self.size))

    def stretch(self, piece: int) -> tuple[int, int]:
        """Numbers of the variants of a piece: the first, and one after the last."""
        first, end = self.numbers.start, self.numbers.stop
        return first + piece * self.size, min(first + (piece + 1) * self.size, end)

    def missing(self) -> list[int]:
        """Numbers of the pieces that are not there yet."""
        with refused(self.folder):
            there = {path.name for path in (self.folder / PIECES).iterdir()}
        names = list(self.tables)
        return [
            n for n in self.pieces if any(self._piece(name, n).name not in there for name in names)
        ]

    def put(self, piece: int, records: Mapping[str, Records]) -> None:
        """Writes a piece.

        Raises:
            UsageError: it cannot be written; the others stay.
        """
        for name, headings in self.tables.items():
            content = self._format.piece(headings, records[name])
            path = self._piece(name, piece)
            with refused(path):
                _write_whole(path, partial(_put, content))

    def read(self, name: str) -> Iterator[Records]:
        """Stretches of the lines of a result, in order; of a finished study from its only file."""
        headings = self.tables[name]
        for path in self._files(name):
            with refused(path, "read"):
                try:
                    yield from self._format.read(path, headings)
                except (ValueError, KeyError) as error:
                    raise UsageError(
                        f"{path} is not as it was written: {str(error)[:120]}; start over with "
                        "--again"
                    ) from None

    def finish(self) -> None:
        """Puts the pieces together, and removes them.

        Raises:
            UsageError: a result cannot be written; all pieces stay.
        """
        self.join({name: [self._piece(name, n) for n in self.pieces] for name in self.tables})

    def join(self, files: Mapping[str, Sequence[Path]]) -> None:
        """Puts files of consecutive variants together, by name of result, as the whole ones.

        Raises:
            UsageError: a result cannot be written; all files stay.
        """
        for (name, headings), path in zip(self.tables.items(), self.results, strict=True):
            with refused(path):
                _write_whole(path, partial(self._format.join, files[name], headings))
        with refused(self.folder):
            self.is_complete = True
            self._write_manifest()
            shutil.rmtree(self.folder / PIECES, ignore_errors=True)

    def _files(self, name: str) -> list[Path]:
        if self.is_complete:
            return [self.folder / f"{name}.{self._format.ending}"]
        return [self._piece(name, number) for number in self.pieces]

    def _piece(self, name: str, number: int) -> Path:
        return self.folder / PIECES / f"{name}-{number:09d}.{self._format.ending}"

    def manifest(self) -> dict[str, Any] | None:
        """What the folder says that it holds; None: nothing.

        Raises:
            UsageError: it cannot be read, or is none.
        """
        path = self.folder / MANIFEST
        try:
            found = json.loads(read_regular(path, MOST_TABLE_BYTES))
        except FileNotFoundError:
            return None
        except (OSError, ValueError, RecursionError):
            found = None
        if not _is_manifest(found):
            raise UsageError(
                f"{path} does not say what the folder holds; choose another folder with --out, or "
                "start over with --again"
            )
        return dict(found)

    def is_finished(self, found: Mapping[str, Any]) -> bool:
        """Whether a manifest says that all is there, and it is."""
        return bool(found["complete"]) and all(map(Path.exists, self.results))

    def differences(self, found: Mapping[str, Any]) -> str:
        """In what a manifest is one of another study; "" where it is one of this."""
        own = json.loads(json.dumps(self._record()))
        if all(found.get(key) == own.get(key) for key in {*own, "part"}):
            return ""
        theirs = found["sources"]
        changed = [
            name
            for name in dict.fromkeys((*self.sources, *theirs))
            if self.sources.get(name) != theirs.get(name)
        ]
        keys = ("part", "variants", "format")
        changed += [key for key in keys if found.get(key) != own.get(key)]
        return ", ".join(changed) or "columns"

    def _check(self, found: Mapping[str, Any]) -> None:
        what = self.differences(found)
        if what:
            raise UsageError(
                f"{self.folder} holds results of another study: different {what}; choose another "
                "folder with --out, or start over with --again"
            )

    def digests(self) -> dict[str, str]:
        """SHA-256 of each result, by the name of its file.

        Raises:
            UsageError: it cannot be read.
        """
        found = {}
        for path in self.results:
            with refused(path, "read"), path.open("rb") as file:
                found[path.name] = hashlib.file_digest(file, "sha256").hexdigest()
        return found

    def _write_manifest(self) -> None:
        record = self._record() | {"piece": self.size, "complete": self.is_complete}
        if self.share is not None and self.is_complete:
            # a part may be copied from machine to machine before all are merged
            record["sha256"] = self.digests()
        text = json.dumps(record, indent=1, ensure_ascii=False) + "\n"
        _write_whole(self.folder / MANIFEST, partial(_put, text.encode()))

    def _refuse_foreign(self) -> None:
        """Refuses to replace files of which no manifest says that they are a study's."""
        for path in self.results:
            if os.path.lexists(path):
                raise UsageError(
                    f"{path} is there already, and no {MANIFEST} that says of which study; choose "
                    "another folder with --out, or replace it with --again"
                )

    def clear(self) -> None:
        """Removes what a study left here, and nothing else; last what says that it is a study's."""
        for path in _replaced(self.folder):
            with contextlib.suppress(FileNotFoundError):
                path.unlink()
        shutil.rmtree(self.folder / PIECES, ignore_errors=True)
        with contextlib.suppress(FileNotFoundError):
            (self.folder / MANIFEST).unlink()


def spare(folder: Path, sources: Iterable[Path]) -> None:
    """Refuses a folder in which results would replace a file that they are made from.

    Raises:
        UsageError: one of the sources has the name of a result there.
    """
    with refused(folder):
        for path in _replaced(folder):
            for source in sources:
                if path.exists() and source.exists() and path.samefile(source):
                    raise UsageError(
                        f"{path} is read by the study and would be replaced by its results; choose "
                        "another folder with --out"
                    )


def _replaced(folder: Path) -> list[Path]:
    """Files that a study in a folder replaces or removes."""
    return [folder / f"{name}.{ending}" for name in (VARIANTS, ROWS) for ending in FORMATS]


def _is_manifest(found: object) -> bool:
    """Whether it is what `_write_manifest` writes."""
    if not isinstance(found, dict):
        return False
    piece, complete = found.get("piece"), found.get("complete")
    is_size = isinstance(piece, int) and not isinstance(piece, bool) and piece > 0
    return is_size and isinstance(complete, bool) and isinstance(found.get("sources"), dict)


def _write_whole(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Writes under another name, and renames when all is on the disk."""
    unfinished = path.with_name(path.name + _UNFINISHED)
    try:
        with unfinished.open("wb") as file:
            write(file)
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            unfinished.unlink()
        raise


def _put(content: bytes, file: BinaryIO) -> None:
    file.write(content)


@contextlib.contextmanager
def refused(path: Path, what: str = "write") -> Iterator[None]:
    """Words for what the operating system refuses."""
    try:
        yield
    except OSError as error:
        kept = "; the variants computed so far are kept, and the same command goes on with them"
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            text = f"the disk is full; free some space{kept}"
        else:
            text = f"{error.strerror or error}; choose another folder with --out"
        raise UsageError(f"cannot {what} {path}: {text}") from error
