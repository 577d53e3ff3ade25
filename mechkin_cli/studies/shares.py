"""Shares of a study: each computed by a job of its own, in a folder of its own, then merged.

Nothing connects the jobs but the file system: which variants a share has follows from its number
alone, and each share records what it is made from, so merging needs no list of jobs. What is merged
has the bytes of the study that was run at once.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterable
from pathlib import Path

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.studies.folder import Share, StudyFolder, refused

MOST_SHARES = 1_000_000
"""Shares of a study: more than the largest array of jobs."""

MOST_NAMED = 5
"""Faulty shares that one message tells of."""

_SHARE = re.compile(r"([0-9]{1,9})/([0-9]{1,9})")
_FOLDER = re.compile(r"part-([0-9]{1,9})-of-([0-9]{1,9})")


def share_of(text: str) -> Share:
    """The share that a text names, such as 3/8.

    Raises:
        UsageError: it names none.
    """
    found = _SHARE.fullmatch(text.strip())
    if found is None:
        raise UsageError(
            f"part {text[:LONGEST_NAME]}: expected a number and of how many, as 3/8 for the third "
            "of eight"
        )
    number, total = map(int, found.groups())
    if not 1 <= total <= MOST_SHARES:
        raise UsageError(f"part {text}: expected 1 to {MOST_SHARES} parts, not {total}")
    if not 1 <= number <= total:
        raise UsageError(
            f"part {text}: parts are numbered from 1 to {total}; where an array of jobs counts "
            "from 0, add 1"
        )
    return Share(number, total)


def part_folder(folder: Path, share: Share) -> Path:
    """The folder of a share, in that of the whole study."""
    return folder / f"part-{share.number}-of-{share.total}"


def merge(whole: StudyFolder, folder_of: Callable[[Share], StudyFolder], again: bool) -> None:
    """Puts all shares together, in the folder of the whole study, and removes them.

    A merge that was stopped is repeated: shares are removed when the whole results are there.

    Args:
        whole: claimed by the caller.
        folder_of: the folder of a share.
        again: replace results of another study.

    Raises:
        UsageError: as `Study.merged`.
    """
    found = None if again else whole.manifest()
    with refused(whole.folder):
        shares = _shares(whole.folder)
    if found is not None and not whole.differences(found) and whole.is_finished(found):
        whole.begin()
    else:
        parts = [folder_of(share) for share in _all_of(whole.folder, shares)]
        _check(whole, parts)
        whole.begin(again)
        names = {path.stem: path.name for path in whole.results}
        whole.join({n: [part.folder / names[n] for part in parts] for n in whole.tables})
    for share in shares:
        _remove(folder_of(share))


def _shares(folder: Path) -> list[Share]:
    """The shares that have a folder, in their order."""
    names = [path.name for path in folder.iterdir() if path.is_dir()]
    found = filter(None, map(_FOLDER.fullmatch, names))
    shares = [Share(*map(int, match.groups())) for match in found]
    return sorted(s for s in shares if part_folder(folder, s).name in names)


def _all_of(folder: Path, shares: Iterable[Share]) -> list[Share]:
    """All shares of the study, of which those with a folder are given."""
    counts = sorted({share.total for share in shares})
    if not counts:
        raise UsageError(
            f"{folder} has no parts to merge; compute them with --part 1/N to --part N/N and the "
            "same --out"
        )
    if len(counts) > 1:
        ways = " and into ".join(map(str, counts))
        raise UsageError(
            f"{folder} has parts of this study divided into {ways}; remove the folders part-*-of-N "
            "of all but one"
        )
    if not 1 <= counts[0] <= MOST_SHARES:
        raise UsageError(
            f"{folder}: {counts[0]} parts (limit {MOST_SHARES}); rename the folders part-*-of-N to "
            "what mechkin wrote"
        )
    return [Share(number, counts[0]) for number in range(1, counts[0] + 1)]


def _check(whole: StudyFolder, parts: Iterable[StudyFolder]) -> None:
    """Refuses shares that do not make the whole study, and names all of them."""
    missing, faults, wrong, total = [], [], [], 0
    for part in parts:
        assert part.share is not None
        number, total = part.share
        if not part.folder.is_dir():
            missing.append(number)
            continue
        fault = _fault(part)
        if fault:
            wrong.append(number)
            faults.append(f"part {part.share} {fault}")
    if not missing and not wrong:
        return
    texts = [f"parts {_ranges(missing)} of {total} are missing"] if missing else []
    texts += faults[:MOST_NAMED]
    if len(faults) > MOST_NAMED:
        texts.append(f"{len(faults) - MOST_NAMED} more are not what they should be")
    todo = _ranges(sorted(missing + wrong))
    over = " (with --again where a part is damaged or of another study)" if wrong else ""
    raise UsageError(
        f"{whole.folder} cannot be merged: {'; '.join(texts)}; run --part I/{total} for I = {todo}"
        f"{over}, then merge"
    )


def _fault(part: StudyFolder) -> str:
    """What is wrong with a share that has a folder; "" where nothing is."""
    try:
        with part:
            found = part.manifest()
            if found is None:
                return "is empty"
            named = found.get("part")
            if named != str(part.share):
                held = f"part {named}" if isinstance(named, str) else "no part"
                return f"is {held[:LONGEST_NAME]} by what its study.json says"
            changed = part.differences(found)
            if changed:
                return f"is of another study (different {changed})"
            if not part.is_finished(found):
                return "is not finished"
            if found.get("sha256") != part.digests():
                return "is damaged: its files are not those that were written"
    except UsageError as error:
        return f"cannot be used ({str(error).partition(';')[0]})"
    return ""


def _ranges(numbers: Iterable[int]) -> str:
    """Numbers as arrays of jobs take them.

    >>> _ranges([1, 2, 3, 7, 9, 10])
    '1-3,7,9-10'
    """
    ranges: list[list[int]] = []
    for number in numbers:
        if ranges and ranges[-1][1] == number - 1:
            ranges[-1][1] = number
        else:
            ranges.append([number, number])
    return ",".join(str(a) if a == b else f"{a}-{b}" for a, b in ranges)


def _remove(part: StudyFolder) -> None:
    """Removes what a study has written of a share; a share that is being computed stays."""
    with contextlib.suppress(UsageError, OSError):
        with part:
            part.clear()
        part.folder.rmdir()
