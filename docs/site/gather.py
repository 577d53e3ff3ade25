"""Gathers the pages of the site: those of the repository, live pages, and the Python interface.

What differs from the repository: where a page shows the picture of a mechanism alone in a
paragraph, the site shows the live page; in tables such a picture links it. The photograph of a live
page is one, too.
"""

from __future__ import annotations

import posixpath
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from mechkin_cli import view

GALLERY = "gallery"
"""Folder of the live pages, at the top of the site."""

WORKER = "iframe-worker.js"
"""What lets the search run on pages that are opened from a folder."""

_LINK = re.compile(r"\]\(([^)\s#]+)")
_PHOTOGRAPH = re.compile(r"^!\[(?P<words>[^]]*)\]\([^)\s]*view\.png\)$", re.MULTILINE)
_PHOTOGRAPHED = "classics/five_link_suspension"
_PICTURE = r"!\[(?P<words>[^]]*)\]\((?P<stem>[^)\s]+)/" + re.escape(view.PICTURE_NAME) + r"\)"
_ALONE = re.compile(rf"^{_PICTURE}$", re.MULTILINE)
_IN_TABLE = re.compile(rf"^\| {_PICTURE}", re.MULTILINE)


def gather(root: Path, pages: Path, *, modes: bool) -> None:
    """Fills the folder `pages` from the repository at `root`.

    Args:
        modes: whether live pages also show the other assembly modes.
    """
    first = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "mechanisms/README.md")
    for page in [root / name for name in first] + [*(root / "docs").rglob("*.md")]:
        _take(page, root, pages)
    for name in ("site.css", WORKER):
        shutil.copy(Path(__file__).with_name(name), pages / name)
    _live_pages(root / "mechanisms", pages / GALLERY, modes)
    for page in pages.rglob("*.md"):
        _with_live_pages(page, pages)
    (pages / "gallery.md").write_text(_gallery(pages / GALLERY), encoding="utf-8")
    for name, text in _interface().items():
        target = pages / "python" / name
        target.parent.mkdir(exist_ok=True)
        target.write_text(text, encoding="utf-8")


def _take(file: Path, root: Path, pages: Path) -> None:
    """Copies a file of the repository, and what a page links: pictures, mechanisms, other pages."""
    target = pages / file.relative_to(root)
    if target.exists():
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(file, target)
    if file.suffix != ".md":
        return
    for address in _LINK.findall(file.read_text(encoding="utf-8")):
        linked = Path(posixpath.normpath(file.parent / address))
        if linked.is_file() and linked.is_relative_to(root):
            _take(linked, root, pages)


def _live_pages(mechanisms: Path, folder: Path, modes: bool) -> None:
    command = [sys.executable, "-P", "-m", "mechkin_cli", "view", str(mechanisms)]
    command += ["--out", str(folder), "--quiet", *([] if modes else ["--no-modes"])]
    # rows are missing where the sources ask for positions that a mechanism cannot reach
    done = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
    if done.returncode not in (0, 4):
        raise SystemExit(f"mechkin view: exit code {done.returncode}")


def _with_live_pages(page: Path, pages: Path) -> None:
    """Puts live pages into a page: their addresses are relative to it."""
    text = page.read_text(encoding="utf-8")
    here = page.parent.relative_to(pages).as_posix()

    def live(match: re.Match[str]) -> tuple[str, str] | None:
        stem = posixpath.normpath(posixpath.join(here, match["stem"]))
        inside = stem.removeprefix("mechanisms/")
        if inside == stem or not (pages / GALLERY / f"{inside}.html").is_file():
            return None
        return match["words"], posixpath.relpath(f"{GALLERY}/{inside}.html", here)

    def put(pattern: re.Pattern[str], text: str, made: Callable[[str, str, str], str]) -> str:
        def one(match: re.Match[str]) -> str:
            found = live(match)
            return match[0] if found is None else made(match[0], *found)

        return pattern.sub(one, text)

    up = posixpath.relpath("mechanisms", here)
    text = _PHOTOGRAPH.sub(rf"![\g<words>]({up}/{_PHOTOGRAPHED}/{view.PICTURE_NAME})", text)
    text = put(
        _ALONE,
        text,
        lambda _, words, address: (
            f'<iframe class="live" src="{address}" title="{words}" loading="lazy"></iframe>\n\n'
            f"[Open this live page alone]({address})"
        ),
    )
    text = put(
        _IN_TABLE, text, lambda shown, _, address: f"| [{shown.removeprefix('| ')}]({address})"
    )
    page.write_text(text, encoding="utf-8")


def _gallery(folder: Path) -> str:
    """The cards of the index that `mechkin view` wrote, as a page of the site."""
    index = (folder / view.INDEX_NAME).read_text(encoding="utf-8")
    (cards,) = re.findall(r"<main>\n(.*?)</main>", index, re.DOTALL)
    cards = re.sub(r'(href|src)="', rf'\1="{GALLERY}/', cards)
    cards = re.sub(r"^<h2>(.*)</h2>$", _headed, cards, flags=re.MULTILINE)
    cards = re.sub(r"</?section>\n?", "", cards).replace("<ul>", '<ul class="cards">')
    head = "Every mechanism that is kept in the repository, in motion; `mechkin view FOLDER` writes"
    return f"# Gallery\n\n{head} such a gallery of your own.\n\n{cards}"


def _headed(match: re.Match[str]) -> str:
    words = match[1][:1].upper() + match[1][1:]
    return f"\n## {words}\n"


# The Python interface, from docstrings.

_INTERFACE = {
    "model.md": (
        "Models",
        "What `mk.load` and `mk.loads` return: a checked file, and what can be asked of it.",
        ("model.model.load", "model.model.loads", "model.model.Model", "model.model.Parameters"),
    ),
    "analysis.md": (
        "Analyses",
        "What `m.analyze()` and `m.respond(NAME)` return: a run with its tables.",
        ("analysis.analysis.Analysis", "errors.errors.Errors", "analysis.certificate.Certificate"),
    ),
    "answers.md": (
        "Other answers",
        "What the other methods of a model return.",
        (
            "model.position.Position",
            "modes.modes.Modes",
            "modes.modes.Ranges",
            "mobility.mobility.Mobility",
            "cams.cam.Cam",
            "variants.result.Variants",
            "studies.results.StudyResults",
            "studies.results.StudyFiles",
            "sensitivities.first_order.Sensitivities",
            "sensitivities.tolerance_stack.Tolerances",
            "fit.result.Fit",
        ),
    ),
    "exceptions.md": (
        "Exceptions and verdicts",
        "What is raised for a file or an argument that is wrong, and what a row's status says.",
        (
            "diagnostics.MechkinError",
            "diagnostics.InvalidFile",
            "diagnostics.UsageError",
            "expressions.quantity.ExpressionError",
            "diagnostics.Diagnostic",
            "verdict.Status",
        ),
    ),
}
"""Pages by name: title, first sentence, and what is described, by its place in the package."""


def _interface() -> dict[str, str]:
    """The pages as mkdocstrings reads them, by name."""
    return {
        name: f"# {title}\n\n{head}\n\n" + "\n\n".join(f"::: mechkin_cli.{one}" for one in places)
        for name, (title, head, places) in _INTERFACE.items()
    }
