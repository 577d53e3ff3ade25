"""Builds the site of the documentation into build/site/html, and checks its links.

    pip install '.[docs]'
    python -P docs/site              everything; needs no network
    python -P docs/site --no-modes   live pages without the other assembly modes: faster

The pages stand in the site as they do in the repository, so that every link of one works in the
other: `README.md`, `docs/`, `mechanisms/`. Zensical renders them. It is chosen over Material for
MkDocs, whose end of life is announced; it reads `mkdocs.yml` and runs mkdocstrings.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))

import gather  # noqa: E402
import links  # noqa: E402

BUILT = ROOT / "build" / "site"

_SHIM = "https://unpkg.com/iframe-worker/shim"
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_WARNING = re.compile(r"^Warning: (.*)(?:\n.*?\[ (\S+) \])?", re.MULTILINE)


def main(options: list[str]) -> int:
    """Gathers, renders, checks; the exit code."""
    known = {"--no-modes"}
    if unknown := set(options) - known:
        print(f"{', '.join(sorted(unknown))}: the options are {', '.join(known)}", file=sys.stderr)
        return 2
    shutil.rmtree(BUILT, ignore_errors=True)
    pages = BUILT / "pages"
    gather.gather(ROOT, pages, modes="--no-modes" not in options)
    shutil.copy(HERE / "mkdocs.yml", BUILT / "mkdocs.yml")
    render()
    html = BUILT / "html"
    keep_local(html)
    faults = links.faults(html)
    for fault in faults:
        print(fault, file=sys.stderr)
    count = sum(1 for _ in html.rglob("*.html"))
    print(f"{html / 'index.html'}: {count} pages, {len(faults)} broken links")
    return 1 if faults else 0


def render() -> None:
    """Runs Zensical; its warnings are errors.

    Raises:
        SystemExit: a warning, or it failed.
    """
    # docstrings are read with the adapter beside this file
    paths = os.pathsep.join([str(HERE), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    done = subprocess.run(
        [sys.executable, "-P", "-m", "zensical", "build", "--clean", "--strict"],
        cwd=BUILT,
        env=os.environ | {"PYTHONPATH": paths, "NO_COLOR": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    said = _COLOUR.sub("", done.stdout)
    warnings = [": ".join(filter(None, (place, words))) for words, place in _WARNING.findall(said)]
    if done.returncode or warnings:
        print("\n".join(warnings) or said, file=sys.stderr)
        raise SystemExit(1)


def keep_local(html: Path) -> None:
    """Takes the one script that the theme loads from the network from beside the pages."""
    for page in html.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        if _SHIM in text:
            up = "../" * (len(page.relative_to(html).parts) - 1)
            page.write_text(text.replace(_SHIM, f"{up}{gather.WORKER}"), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
