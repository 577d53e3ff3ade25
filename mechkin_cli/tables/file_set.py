"""Replacing several files at one moment: all of them are the old ones, or all are the new.

A rename replaces one file at once, but not two. So an attempt at a set has a folder of its own,
`.mechkin-...`, with the new files in `new/`, second names of those that they replace in `old/`, and
a symbolic link `set` to one of the two. First `set` leads to `old/`, and file by file a link
through `set` is put in the place of what stands there: whoever reads still finds the old files.
Then one rename lets `set` lead to `new/`: that is the moment. At last the links are replaced by the
files themselves, and the attempt's folder goes.

`settle` is this last part, in both directions: it also takes back what was interrupted before the
moment, and clears what a run left that was killed.
"""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

replacing: set[Path] = set()
"""The attempts of this process that are under way: an interrupt must let them be taken back."""

Refuse = Callable[[Path], contextlib.AbstractContextManager[None]]
"""Words for the errors of one target."""

_ATTEMPT = re.compile(r"\.mechkin-[0-9a-f]{16}(\.tmp)?")
_UP = f"..{os.sep}..{os.sep}"
"""From `old/` to the folder in which the set stands."""


def replace_files(
    folder: Path, files: Mapping[str, bytes], refuse: Refuse, removed: Sequence[str] = ()
) -> None:
    """Put files (name -> content) into the folder, replacing those of the same names; those of the
    names `removed` go at the same moment.

    Whatever fails, a keyboard interrupt included, the old files stay.
    """
    names = [*files, *removed]
    attempt = folder / f".mechkin-{os.urandom(8).hex()}"
    try:
        replacing.add(attempt)
        _prepare(attempt, folder, files, names, refuse)
        if len(names) == len(files) == 1:
            (name,) = files
            with refuse(folder / name):
                (attempt / "new" / name).replace(folder / name)
        elif _link(attempt / "set", "old"):
            for name in names:
                with refuse(folder / name):
                    _put_link(f"{attempt.name}/set/{name}", folder / name, attempt)
            with refuse(folder):
                _put_link("new", attempt / "set", attempt)
        else:
            _replace_one_by_one(attempt, folder, names, refuse)
    finally:
        _without_interrupts(lambda: settle(attempt))
        replacing.discard(attempt)


def settle(attempt: Path) -> None:
    """Let the side that `set` leads to stand in the folder, and remove the attempt; may be repeated
    after an interrupt. What cannot be settled now stays as it is, readable, for the next time."""
    with contextlib.suppress(OSError):
        for name in _links(attempt):
            with contextlib.suppress(OSError):
                side = attempt / os.readlink(attempt / "set")
                _put_file(side / name, attempt.parent / name, attempt)
        if not _links(attempt):
            from shutil import rmtree

            rmtree(attempt, ignore_errors=True)


def settle_all(folder: Path) -> None:
    """Settles and clears what runs left that were killed; none may be under way."""
    for name in os.listdir(folder):
        if _ATTEMPT.fullmatch(name):
            path = folder / name
            if path.is_dir() and not path.is_symlink():
                settle(path)
            else:
                with contextlib.suppress(OSError):
                    path.unlink()


def _prepare(
    attempt: Path, folder: Path, files: Mapping[str, bytes], names: Sequence[str], refuse: Refuse
) -> None:
    """The attempt's folder with both sides."""
    for name in names[:1]:
        with refuse(folder / name):
            attempt.mkdir()
            (attempt / "new").mkdir()
            (attempt / "old").mkdir()
    for name, content in files.items():
        with refuse(folder / name):
            _write(attempt / "new" / name, content)
    for name in names:
        with refuse(folder / name):
            _keep(folder / name, attempt / "old" / name)


def _write(path: Path, content: bytes) -> None:
    with path.open("xb") as stream:
        stream.write(content)


def _keep(target: Path, second: Path) -> None:
    """Give what stands at the target a second name."""
    if target.is_symlink():
        text = os.readlink(target)
        second.symlink_to(text if os.path.isabs(text) else _UP + text)
    elif target.exists():
        try:
            os.link(target, second)
        except OSError:  # a file system without hard links
            from shutil import copy2

            copy2(target, second)


def _link(path: Path, text: str) -> bool:
    """Whether the symbolic link could be made: some file systems have none."""
    try:
        path.symlink_to(text)
    except OSError:
        return False
    return True


def _put_link(text: str, target: Path, attempt: Path) -> None:
    spare = attempt / "spare"
    spare.symlink_to(text)
    spare.replace(target)


def _links(attempt: Path) -> list[str]:
    """Names in the attempt's folder that are links through `set`."""
    with os.scandir(attempt.parent) as entries:
        links = [entry.name for entry in entries if entry.is_symlink()]
    ends = {name: os.readlink(attempt.parent / name) for name in links}
    return [name for name, end in ends.items() if end == f"{attempt.name}/set/{name}"]


def _put_file(source: Path, target: Path, attempt: Path) -> None:
    """Put the file at `source`, or nothing where there is none, in the place of the target."""
    if not os.path.lexists(source):
        target.unlink()
        return
    spare = attempt / "spare"
    spare.unlink(missing_ok=True)
    if source.is_symlink():
        spare.symlink_to(os.readlink(source).removeprefix(_UP))
    else:
        try:
            os.link(source, spare)
        except OSError:  # a file system without hard links
            spare = source
    spare.replace(target)


def _replace_one_by_one(attempt: Path, folder: Path, names: list[str], refuse: Refuse) -> None:
    """Without symbolic links there is no one moment; but what fails is taken back."""
    try:
        for name in names:
            with refuse(folder / name):
                if (attempt / "new" / name).exists():
                    (attempt / "new" / name).replace(folder / name)
                else:
                    (folder / name).unlink()
    except BaseException:
        done = [name for name in names if not (attempt / "new" / name).exists()]
        _without_interrupts(lambda: _take_back(attempt, folder, done))
        raise


def _take_back(attempt: Path, folder: Path, names: list[str]) -> None:
    for name in names:
        with contextlib.suppress(OSError):
            _put_file(attempt / "old" / name, folder / name, attempt)


def _without_interrupts(work: Callable[[], None]) -> None:
    """Does the work to its end; an interrupt meanwhile counts only after that."""
    interrupts = 0
    while True:
        try:
            work()
            break
        except KeyboardInterrupt:
            interrupts += 1
    if interrupts:
        raise KeyboardInterrupt
