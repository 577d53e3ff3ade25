"""Checks the built site: every link, picture and frame leads to a file of it, every anchor to a
name in that file."""

from __future__ import annotations

from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote, urlsplit

_ADDRESSES = {"a": "href", "link": "href", "img": "src", "script": "src", "iframe": "src"}


class Read(NamedTuple):
    """What a page has: addresses with the tags that have them, and names that anchors lead to."""

    addresses: frozenset[tuple[str, str]]
    names: frozenset[str]


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.addresses: set[tuple[str, str]] = set()
        self.names: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        if address := found.get(_ADDRESSES.get(tag, "")):
            self.addresses.add((tag, address))
        self.names.update(name for key in ("id", "name") if (name := found.get(key)))


@cache
def _read(page: Path) -> Read:
    reader = _Reader()
    reader.feed(page.read_text(encoding="utf-8"))
    return Read(frozenset(reader.addresses), frozenset(reader.names))


def faults(html: Path) -> list[str]:
    """A sentence for each address that leads nowhere, and for what is loaded from the network.

    Args:
        html: folder of the built site. Live pages name nothing and are left out; so is the page of
            a missing page, whose addresses are those of a server's root.
    """
    found = []
    for page in sorted(html.rglob("*.html")):
        here = page.relative_to(html)
        if here.name == "404.html" or (here.parts[0] == "gallery" and here.name != "index.html"):
            continue
        for tag, address in sorted(_read(page).addresses):
            fault = _fault(html, page, tag, address)
            if fault is not None:
                found.append(f"{here}: {address}: {fault}; correct the link, or the page it names")
    return found


def _fault(html: Path, page: Path, tag: str, address: str) -> str | None:
    parts = urlsplit(address)
    if parts.scheme or parts.netloc:
        local = tag == "a" or parts.scheme == "data"
        return None if local else "is loaded from the network"
    target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
    if not target.is_relative_to(html.resolve()):
        return "leads out of the site"
    if not target.is_file():
        return "no such file in the site"
    name = unquote(parts.fragment)
    if name and target.suffix == ".html" and name not in _read(target).names | {"__top"}:
        return f"{target.name} has no anchor {name}"
    return None
