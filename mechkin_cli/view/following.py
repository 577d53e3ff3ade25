"""A mechanism file that is being edited: its picture after every change, its faults, and values
that are written back into it.

The file and those that it names are looked at a few dozen times a second, whatever editor saves
them and in whatever way (in place, or by renaming a new file over the old one). What they hold
decides, not their times: a file that is saved unchanged gives nothing new.
"""

from __future__ import annotations

import contextlib
import os
import stat
import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from time import perf_counter, time_ns
from typing import TYPE_CHECKING, Protocol

from mechkin_cli.building import edit_parameters, file_numbers
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.reading import MOST_BYTES, decoded, lines_of, read_regular, read_text
from mechkin_cli.record import NamedTuple
from mechkin_cli.view.page import ShownAnalysis, ShownModel
from mechkin_cli.view.scene import view_data

if TYPE_CHECKING:
    from mechkin_cli.view.page import Plain

INTERVAL = 0.03
"""Seconds between two looks at the files."""

GRAIN = 100_000_000
"""Nanoseconds within which two changes of a file may have the same time: as many after a change its
content is compared, too."""

PATIENCE = 0.4
"""Seconds that a file may be missing while an editor puts a new one in its place."""

FAREWELL = 5.0
"""Seconds that a picture which is being made may take to end when nobody looks any more: a program
that ends while its threads compute is aborted."""

LONG = 0.1
"""Seconds: where the other assembly modes took longer last time, the file's own is shown first."""


class LiveModel(ShownModel, Protocol):
    """What following a file asks of its model."""

    @property
    def parameters(self) -> Mapping[str, float]:
        """The parameters by name, in the file's units."""
        ...

    def analyses(self, run: str | None, mode: str | None) -> Sequence[ShownAnalysis]:
        """All runs of the file, or one."""
        ...


class Wish(NamedTuple):
    """What of a file is to be shown: a run (None: all), its assembly mode (None: the file's own),
    and whether the other modes are."""

    run: str | None = None
    mode: str | None = None
    modes: bool = True


class Picture(NamedTuple):
    """A sound state of the file.

    Attributes:
        number: counts pictures.
        hash: of the file's content.
        data: what the page shows, as JSON.
        model: the file, checked.
        is_whole: the other assembly modes are in it, where they are to be shown.
    """

    number: int
    hash: str
    data: bytes
    model: LiveModel
    is_whole: bool


class Seen(NamedTuple):
    """What is known of a file.

    Attributes:
        number: counts what was seen.
        hash: of the file's content; "" where there is none.
        picture: of its last sound state.
        faults: why its present state has none.
        seconds: from the look at the change to this.
        ended: nobody looks any more.
    """

    number: int = 0
    hash: str = ""
    picture: Picture | None = None
    faults: tuple[Diagnostic, ...] = ()
    lines: tuple[str, ...] = ()
    seconds: float = 0.0
    ended: bool = False

    def record(self) -> Plain:
        """It as plain data for the page that shows it."""
        picture = self.picture
        shown: Plain | None = None
        if picture is not None:
            # what a page may set: in one where no parameter varies these are numbers of the file
            numbers = file_numbers(picture.model.built.document)
            parameters = dict(picture.model.parameters) | {one.name: one.value for one in numbers}
            shown = {"number": picture.number, "hash": picture.hash, "parameters": parameters}
            shown["whole"] = picture.is_whole
        faults = [_fault(one, self.lines) for one in self.faults]
        return {
            "number": self.number,
            "hash": self.hash,
            "picture": shown,
            "faults": faults,
            "milliseconds": round(1000.0 * self.seconds, 1),
            "ended": self.ended,
        }


class Written(NamedTuple):
    """What writing values into the file has done: what parameters say now, and the expressions that
    were left alone, by name; `hash` is that of the file's content."""

    hash: str
    written: dict[str, str]
    expressions: dict[str, str]


class Changed(UsageError):
    """The file has changed since the page was made that asks to change it."""


class Follower:
    """Follows a file in a thread of its own, from `start` to `stop`.

    Args:
        path: of the file.
        load: checks a text, given the name that messages show and the folder of the files that it
            names.
        wish: what is to be shown.
        tell: called after each look that saw something new.
    """

    def __init__(
        self,
        path: Path,
        load: Callable[[str, str, Path], LiveModel],
        wish: Wish = Wish(),  # noqa: B008 - it is frozen
        tell: Callable[[Seen], None] = lambda _: None,
    ) -> None:
        self.path, self._load, self._wish, self._tell = path, load, wish, tell
        self.seen = Seen()
        self._news = threading.Condition()
        self._writing = threading.Lock()
        self._looks: dict[Path, _Look] = {path: _NO_LOOK}
        self._mode_seconds = 0.0
        self._wake = threading.Event()
        self._thread = threading.Thread(target=self._follow, name="mechkin-follow", daemon=True)

    def start(self) -> None:
        """Looks for the first time, and goes on in the background."""
        self._thread.start()

    def stop(self) -> None:
        """Looks no more, and tells those who wait; a file that is being written is finished."""
        with self._writing, self._news:
            self.seen = self.seen._replace(number=self.seen.number + 1, ended=True)
            self._news.notify_all()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join(FAREWELL)

    def wait(self, after: int, timeout: float) -> Seen | None:
        """What was seen after `after`; None where that is nothing for so many seconds."""
        with self._news:
            found = self._news.wait_for(lambda: self.seen.number > after, timeout)
            return self.seen if found else None

    def write(
        self, hash: str, values: Mapping[str, float], replace: Collection[str] = ()
    ) -> Written:
        """Writes values of parameters into the file, and nothing else.

        Args:
            hash: of the content of which the values are changes.
            values: by name, in the file's units.
            replace: those whose expressions are replaced by numbers.

        Raises:
            Changed: the file has another content now.
            UsageError: an unknown parameter, or the file cannot be written.
        """
        with self._writing:
            picture = self.seen.picture
            content = _content(self.path)
            now = _hash(content)
            if picture is None or now != hash or picture.hash != hash:
                raise self._changed()
            text = content.decode("utf-8")
            edited = edit_parameters(text, picture.model.built, values, replace)
            if edited.written:
                before, content = content, edited.text.encode("utf-8")
                if not _replace(self.path, before, content):
                    raise self._changed()
            self._wake.set()
            return Written(_hash(content), edited.written, edited.expressions)

    def _changed(self) -> Changed:
        return Changed(
            f"{self.path} has changed since this picture of it: nothing was written; look at the "
            "new picture and try again"
        )

    def _follow(self) -> None:
        missing_since: float | None = None
        held: tuple[Diagnostic, ...] = ()
        while not self.seen.ended:
            if not self._has_changed() and not held:
                self._wake.wait(INTERVAL)
                self._wake.clear()
                continue
            begun = perf_counter()
            is_there = self._looks[self.path].content is not None
            missing_since = None if is_there else missing_since or begun
            if missing_since and self.seen.number and begun - missing_since < PATIENCE:
                self._forget()
                self._wake.wait(INTERVAL)
                continue
            faults = self._picture(begun)
            # what is half written mends itself: a fault is told when it is the same a look later
            if faults and faults != held and self.seen.number:
                held = faults
                self._wake.wait(INTERVAL)
                continue
            held = ()
            if faults and (faults, self._hash()) != (self.seen.faults, self.seen.hash):
                self._see(faults=faults, lines=self._lines(), seconds=perf_counter() - begun)

    def _has_changed(self) -> bool:
        """Whether a file is another than at the last look."""
        changed = False
        for path, before in list(self._looks.items()):
            look = before.again(path)
            changed |= look.content != before.content or before is _NO_LOOK
            self._looks[path] = look
        return changed

    def _forget(self) -> None:
        self._looks[self.path] = _NO_LOOK

    def _picture(self, begun: float) -> tuple[Diagnostic, ...]:
        """Tells of the picture of what the file holds now; why there is none."""
        content = self._looks[self.path].content
        file, folder = str(self.path), self.path.parent
        try:
            if content is None:
                read_text(self.path)  # says why it cannot be read
                self._forget()
                return ()
            model = self._load(decoded(content, file), file, folder)
            tables = model.built.document.tables
            self._watch({folder / name: _Look(content=tables[name]) for name in tables})
            run, mode, modes = self._wish
            analyses = model.analyses(run, mode)
            if modes and self._mode_seconds > LONG:
                self._show(model, analyses, content, begun, modes=False)
                if self._has_changed():
                    self._looks[self.path] = _NO_LOOK
                    return ()
            before = perf_counter()
            self._show(model, analyses, content, begun, modes=modes)
            self._mode_seconds = perf_counter() - before
        except InvalidFile as error:
            # what is missing may come: any change beside the file counts
            self._watch({**self._looks, folder: _NO_LOOK.again(folder)})
            return error.diagnostics
        except UsageError as error:
            return (Diagnostic("usage", "error", str(error)),)
        except Exception as error:
            text = f"internal error, {type(error).__name__}: {error}; this is a defect of mechkin"
            return (Diagnostic("internal", "error", text, hint="report it with the file"),)
        return ()

    def _show(
        self,
        model: LiveModel,
        analyses: Sequence[ShownAnalysis],
        content: bytes,
        begun: float,
        modes: bool,
    ) -> None:
        data, _ = view_data(analyses, modes)
        last = self.seen.picture
        number = 1 if last is None else last.number + 1
        is_whole = modes or not self._wish.modes
        picture = Picture(number, _hash(content), data, model, is_whole)
        self._see(picture=picture, seconds=perf_counter() - begun)

    def _watch(self, looks: Mapping[Path, _Look]) -> None:
        """Looks at these files beside the mechanism's own from now on."""
        self._looks = {**looks, self.path: self._looks[self.path]}

    def _hash(self) -> str:
        content = self._looks[self.path].content
        return "" if content is None else _hash(content)

    def _lines(self) -> tuple[str, ...]:
        content = self._looks[self.path].content or b""
        return tuple(lines_of(content.decode("utf-8", "replace").removeprefix("\ufeff")))

    def _see(
        self,
        picture: Picture | None = None,
        faults: tuple[Diagnostic, ...] = (),
        lines: tuple[str, ...] = (),
        seconds: float = 0.0,
    ) -> None:
        with self._news:
            if self.seen.ended:
                return
            shown = picture or self.seen.picture
            number = self.seen.number + 1
            self.seen = Seen(number, self._hash(), shown, faults, lines, seconds)
            self._news.notify_all()
        self._tell(self.seen)


class _Look(NamedTuple):
    """A file as it was when it was looked at: its state, its content (None: it cannot be read), and
    whether it may change without that its state does."""

    state: tuple[int, ...] | None = None
    content: bytes | None = None
    is_fresh: bool = False

    def again(self, path: Path) -> _Look:
        """The file as it is now."""
        try:
            found = os.stat(path)
        except (OSError, ValueError):
            return _MISSING
        times = found.st_mtime_ns, found.st_ctime_ns
        state = (*times, found.st_size, found.st_ino, found.st_mode)
        if state == self.state and not self.is_fresh:
            return self
        is_fresh = abs(time_ns() - found.st_mtime_ns) < GRAIN
        if stat.S_ISDIR(found.st_mode):
            return _Look(state, repr(state).encode(), is_fresh)
        try:
            return _Look(state, read_regular(path, MOST_BYTES), is_fresh)
        except (OSError, ValueError):
            return _Look(state, None, is_fresh)


_NO_LOOK = _Look()
_MISSING = _Look((), None)


def _content(path: Path) -> bytes:
    try:
        return read_regular(path, MOST_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{path} cannot be read: {reason}; nothing was written") from error


def _hash(content: bytes) -> str:
    return sha256(content).hexdigest()


def _replace(path: Path, before: bytes, content: bytes) -> bool:
    """Puts other content into a file, whole or not at all; its rights stay, and so do links to
    it. False, and nothing is done, where its content is no longer the one before: an editor may
    save while the new one is written to the disk, and what it saved must stay.

    Raises:
        UsageError: it cannot be written.
    """
    target = path.resolve()
    attempt = target.with_name(f".{target.name}.{os.urandom(4).hex()}")
    try:
        mode = stat.S_IMODE(os.stat(target).st_mode)
        descriptor = os.open(attempt, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with open(descriptor, "wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(descriptor)
        os.chmod(attempt, mode)
        is_same = _content(target) == before
        if is_same:
            os.replace(attempt, target)
        else:
            os.unlink(attempt)
    except UsageError:
        with contextlib.suppress(OSError):
            os.unlink(attempt)
        raise
    except OSError as error:
        with contextlib.suppress(OSError):
            os.unlink(attempt)
        reason = error.strerror or str(error)
        raise UsageError(f"cannot write {path}: {reason}; nothing was changed") from error
    return is_same


def _fault(diagnostic: Diagnostic, lines: Sequence[str]) -> Plain:
    place = diagnostic.place
    bare = diagnostic._replace(place=None, hint=None)
    line = place.line if place is not None and place.in_file else 0
    return {
        "severity": diagnostic.severity,
        "text": str(bare).removeprefix(f"{diagnostic.severity}: "),
        "hint": diagnostic.hint,
        "place": None if place is None else str(place),
        "line": line,
        "column": place.column if place is not None else 0,
        "source": lines[line - 1] if 0 < line <= len(lines) else None,
    }
