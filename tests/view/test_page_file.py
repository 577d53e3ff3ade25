"""The page as a file: it holds all it needs, with licences, and is what its sources give."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import subprocess
from pathlib import Path

import pytest
from view.browser import PACKAGES, missing
from view.page_data import PAGE, PLACE

SOURCES = PAGE.parent / "page"
TEXT = PAGE.read_text(encoding="utf-8")
MOST_BYTES = 1_600_000


def test_it_is_small() -> None:
    assert PAGE.stat().st_size <= MOST_BYTES


def test_the_place_for_the_data_occurs_once() -> None:
    assert TEXT.count(PLACE) == 1


def test_only_its_own_script_and_style_may_run() -> None:
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', TEXT)
    assert policy
    assert "default-src 'none'" in policy[1]
    assert re.findall("[^ ]*unsafe[^ ;]*", policy[1]) == ["'wasm-unsafe-eval'"], "the kernel alone"
    for name in ("style", "script"):
        contents = re.findall(rf"<{name}>(.*?)</{name}>", TEXT, re.DOTALL)
        assert len(contents) == 1
        digest = base64.b64encode(hashlib.sha256(contents[0].encode()).digest()).decode()
        assert f"{name}-src 'sha256-{digest}'" in policy[1]


def test_nothing_is_loaded_from_elsewhere() -> None:
    markup = re.sub(r"<(script|style)>.*?</\1>", "", TEXT, flags=re.DOTALL)
    assert re.findall(r"<(?:link|iframe|object|embed)\b|\b(?:src|href|srcset)\s*=", markup) == []
    assert "@import" not in TEXT
    assert (
        re.findall(r"url\((?!data:)", re.findall(r"<style>(.*?)</style>", TEXT, re.DOTALL)[0]) == []
    )


def test_licences_of_the_libraries_stand_in_it() -> None:
    locked = json.loads((SOURCES / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    for name in ("three", "uplot"):
        assert f"{name} {locked[f'node_modules/{name}']['version']}" in TEXT
    assert TEXT.count("Permission is hereby granted, free of charge") == 2


def test_libraries_are_pinned() -> None:
    package = json.loads((SOURCES / "package.json").read_text(encoding="utf-8"))
    for versions in (package["dependencies"], package["devDependencies"]):
        assert all(re.fullmatch(r"\d+\.\d+\.\d+", version) for version in versions.values())


@pytest.mark.parametrize("path", sorted(SOURCES.glob("src/**/*.js")), ids=lambda path: path.name)
def test_sources_are_short_and_make_no_markup_of_texts(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 300
    assert (
        re.findall(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(", text) == []
    )
    assert text.startswith("//"), "the module says nothing"


def test_the_page_is_what_its_sources_give() -> None:
    if not (PACKAGES / "esbuild").is_dir():
        pytest.skip(f"the page is not built anew: {missing() or 'esbuild is not installed'}")
    run = subprocess.run(
        ["node", "build.mjs", "--check"], cwd=SOURCES, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
