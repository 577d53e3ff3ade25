"""The bytes of the tables of all mechanisms kept here, as digests: the same on every platform.

    python -P tests/platforms/digests.py --write FILE                     where they are known
    python -P tests/platforms/digests.py FILE [--lanes N] [STEM ...]      compares elsewhere

Every number is written with all its digits (the shortest text that reads back the same), for some
files with true errors and proofs, which run in double-double and in intervals; responses integrate.
It needs mechkin and what mechkin needs, and nothing else: a wheel is tried with it where it was
built, and an emulator runs it.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import platform
import sys
import tempfile
from pathlib import Path

from mechkin_cli.cli.run import run

MECHANISMS = Path(__file__).parents[2] / "mechanisms"

MORE = {
    "plane/planar_four_bar": ("--errors", "--certify"),
    "classics/rssr": ("--errors", "--certify"),
    "classics/five_link_suspension": ("--errors",),
    "dissertation/rcsr": ("--errors",),
    "dissertation/sevenr": ("--errors",),
    "dissertation/rcrcr": ("--certify",),
}
"""What is asked for beside the tables."""


def stems() -> list[str]:
    """Every mechanism that is kept, by folder and name."""
    files = MECHANISMS.glob("*/*.yaml")
    return sorted(file.relative_to(MECHANISMS).with_suffix("").as_posix() for file in files)


def digest(stem: str, *options: str) -> str:
    """SHA-256 of all files that a run writes, their names included."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["analyze", str(MECHANISMS / f"{stem}.yaml"), "--out", folder, "--quiet"]
        sys.argv[1:] = [*words, "--format", "csv", "--format", "md", *MORE.get(stem, ()), *options]
        with contextlib.redirect_stderr(io.StringIO()) as said:
            code = run()
        if code not in (0, 4):
            raise SystemExit(f"{stem}: exit code {code}: {said.getvalue()}")
        found = hashlib.sha256()
        for path in sorted(p for p in Path(folder).rglob("*") if p.suffix in (".csv", ".md")):
            found.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return found.hexdigest()


def write(file: Path) -> None:
    """Writes the digests of all mechanisms."""
    lines = [f"{digest(stem)}  {stem}\n" for stem in stems()]
    file.write_text("".join(lines), encoding="ascii", newline="\n")


def compare(file: Path, wanted: list[str], *options: str) -> int:
    """Prints what is the same and what differs; the number of mechanisms that differ."""
    known = dict(line.split()[::-1] for line in file.read_text(encoding="ascii").splitlines())
    chosen = [s for s in known if not wanted or s in wanted or s.rpartition("/")[2] in wanted]
    print(
        f"{platform.machine()} {platform.system()}, Python {platform.python_version()}", flush=True
    )
    different = 0
    for stem in chosen:
        is_same = digest(stem, *options) == known[stem]
        different += not is_same
        print(f"{'same bytes' if is_same else 'DIFFERENT '}  {stem}", flush=True)
    print(f"{len(chosen) - different} of {len(chosen)} mechanisms have the same bytes", flush=True)
    return different


if __name__ == "__main__":
    _, first, *rest = sys.argv
    if first == "--write":
        write(Path(rest[0]))
    else:
        lanes = rest[:2] if rest[:1] == ["--lanes"] else []
        raise SystemExit(min(compare(Path(first), rest[len(lanes) :], *lanes), 1))
