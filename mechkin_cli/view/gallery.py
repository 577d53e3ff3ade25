"""The gallery: an index page of a folder's mechanisms, a card for each that links its page.

The index is one file of HTML with the pages and pictures beside it; it loads nothing from the
network and works from a folder. Texts of the files stand in it as text, pictures as images.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from html import escape
from itertools import groupby
from typing import TYPE_CHECKING
from urllib.parse import quote

from mechkin_cli.diagnostics import legible
from mechkin_cli.mechanism import is_told
from mechkin_cli.record import NamedTuple
from mechkin_cli.view.drawing import mechanism_picture

if TYPE_CHECKING:
    from pathlib import PurePath

    from mechkin_cli.view.page import ShownAnalysis

INDEX_NAME = "index.html"
"""Name of the index in the folder of a gallery."""


MOST_LETTERS = 8
"""Joints that a card lists one by one: more are counted by type, so that they fill no lines."""


class Card(NamedTuple):
    """A mechanism in the index; `stem` is the path of its page and picture from the index, without
    an ending and with slashes."""

    stem: str
    name: str
    line: str

    @property
    def page(self) -> str:
        """Path of the page that shows it in motion."""
        return f"{self.stem}.html"

    @property
    def picture(self) -> str:
        """Path of its drawing."""
        return f"{self.stem}.svg"

    @property
    def group(self) -> str:
        """The folder that it stands in, as words; "" at the top."""
        return self.stem.rpartition("/")[0].replace("_", " ")


def card_of(analyses: Sequence[ShownAnalysis], file: PurePath) -> tuple[Card, str]:
    """The card of a model that was run, and its drawing.

    Args:
        analyses: all of one model.
        file: the mechanism file by its path in the folder.
    """
    model = analyses[0].model
    joints = model.problem.mechanism.joints
    letters = [
        joint.letter for name, joint in joints.items() if is_told(name) and not joint.is_play
    ]
    words = " ".join(letters)
    if len(letters) > MOST_LETTERS:
        words = ", ".join(f"{count} {letter}" for letter, count in Counter(letters).items())
    line = "; ".join(part for part in (words, model.built.source) if part)
    card = Card(file.with_suffix("").as_posix(), model.name, line)
    return card, mechanism_picture(analyses[0].result, model.view_settings)


def index_page(title: str, cards: Iterable[Card]) -> bytes:
    """The index in UTF-8: cards by folder, each folder's by name.

    Example:
        >>> b'href="a%26b.html"' in index_page("mine", [Card("a&b", "<crank>", "R P")])
        True
    """
    ordered = sorted(cards, key=lambda card: (card.group, card.name.casefold(), card.stem))
    sections = [
        _section(group, list(found)) for group, found in groupby(ordered, lambda card: card.group)
    ]
    count = f"{len(ordered)} mechanism{'' if len(ordered) == 1 else 's'}"
    text = _PAGE.format(
        title=_text(title), count=count, style=_STYLE, script=_SCRIPT, sections="\n".join(sections)
    )
    return text.encode()


def _section(group: str, cards: Sequence[Card]) -> str:
    head = f"<h2>{_text(group)}</h2>\n" if group else ""
    return f"<section>\n{head}<ul>\n{chr(10).join(map(_card, cards))}\n</ul>\n</section>"


def _card(card: Card) -> str:
    page, picture = quote(card.page), quote(card.picture)
    return (
        f'<li><a href="{page}"><img src="{picture}" alt="" width="200" height="150" loading="lazy">'
        f"<strong>{_text(card.name)}</strong><span>{_text(card.line)}</span></a></li>"
    )


def _text(text: str) -> str:
    return escape(legible(text))


_STYLE = """\
:root{color-scheme:light dark}
body{margin:0 auto;max-width:76rem;padding:1rem;font:1rem/1.45 system-ui,sans-serif}
h1{font-size:1.5rem;margin:.5rem 0}h2{font-size:1.1rem;margin:1.5rem 0 .5rem}
label{display:block;margin:.5rem 0}input{font:inherit;padding:.3rem .5rem;width:min(20rem,100%);
box-sizing:border-box}
ul{display:grid;gap:.75rem;grid-template-columns:repeat(auto-fill,minmax(10.5rem,1fr));
list-style:none;margin:0;padding:0}
li a{display:block;height:100%;box-sizing:border-box;padding:.5rem;border:1px solid #8886;
border-radius:.5rem;color:inherit;text-decoration:none}
li a:hover,li a:focus-visible{border-color:#0969da;outline:1px solid #0969da}
li img{display:block;width:100%;height:auto}
li strong,li span{display:block;overflow-wrap:anywhere}li span{font-size:.8rem;opacity:.75}
[hidden]{display:none}"""

_SCRIPT = """\
const box = document.querySelector("input"), items = [...document.querySelectorAll("li")];
box.parentElement.hidden = false;
box.addEventListener("input", () => {
  const words = box.value.toLowerCase().split(/\\s+/);
  for (const item of items) {
    const text = item.textContent.toLowerCase();
    item.hidden = !words.every((word) => text.includes(word));
  }
  for (const part of document.querySelectorAll("section"))
    part.hidden = !part.querySelector("li:not([hidden])");
});"""

_PAGE = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
{style}
</style>
</head>
<body>
<h1>{title}</h1>
<p>{count}; each opens in motion.</p>
<label hidden>Find <input type="search" autocomplete="off"></label>
<main>
{sections}
</main>
<script>
{script}
</script>
</body>
</html>
"""
