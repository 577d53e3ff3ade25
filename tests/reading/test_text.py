"""From a path to text: encodings, sizes, and paths that are no files."""

import os
import re
from pathlib import Path

import pytest

from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.reading.text import MOST_BYTES, check_characters, read_text


def written(folder: Path, content: bytes) -> Path:
    path = folder / "f.yaml"
    path.write_bytes(content)
    return path


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (b"a: 1\n", "a: 1\n"),
        (b"\xef\xbb\xbfa: 1\r\n", "a: 1\r\n"),
        ("name: Gelenk \u00e4 \U0001d6fc".encode(), "name: Gelenk \u00e4 \U0001d6fc"),
    ],
)
def test_utf8_with_and_without_mark(tmp_path: Path, content: bytes, text: str) -> None:
    assert read_text(written(tmp_path, content)) == text


@pytest.mark.parametrize(
    ("content", "place", "words"),
    [
        (b"a: 1\nb: \xe4\n", "2:4", "0xE4 is not UTF-8"),
        (b"\xef\xbb\xbfa\xff", "1:2", "0xFF is not UTF-8"),
        (b"a: 1\r\nb: \xc3", "2:4", "0xC3 is not UTF-8"),
        ("a: 1".encode("utf-16"), "1:1", "UTF-16"),
        (b"a: \x00", "1:4", "NUL"),
        (b"a: 1\n\x1b[31m", "2:1", "U+001B"),
        (b"a: \xef\xbb\xbf1", "1:4", "U+FEFF"),
        (b"a:\n  b: 1\n \tc: 2", "3:2", "tab"),
        (b"x" * (MOST_BYTES + 1), "1:1", "too large"),
    ],
)
def test_unreadable_content_has_a_place(
    tmp_path: Path, content: bytes, place: str, words: str
) -> None:
    path = written(tmp_path, content)
    with pytest.raises(InvalidFile) as caught:
        read_text(path)
    assert str(caught.value).startswith(f"{path}:{place}: error: ")
    assert words in str(caught.value)


@pytest.mark.parametrize("text", ["a: 1\n\t\nb: 2", "a: 1\n \t# note", "a:\t1", "a: [1,\t2]"])
def test_tabs_that_indent_nothing_are_allowed(text: str) -> None:
    check_characters(text, "f.yaml")


def test_lone_surrogates_of_a_python_text_are_refused() -> None:
    with pytest.raises(InvalidFile, match="U\\+D800"):
        check_characters("a: \ud800", "f.yaml")


@pytest.mark.parametrize(
    ("asked", "there"),
    [
        ("RCSR.yaml", "rcsr.yaml"),
        ("rcsr.yml", "rcsr.yaml"),
        ("four-bar.yaml", "four_bar.yaml"),
        ("slider_cranck.yaml", "slider_crank.yaml"),
        ("slider_carnk.yaml", "slider_crank.yaml"),
        ("slidr_crank.yaml", "slider_crank.yaml"),
        ("slider_crsnk.yaml", "slider_crank.yaml"),
    ],
)
def test_a_slip_in_a_files_name_is_seen(asked: str, there: str, tmp_path: Path) -> None:
    (tmp_path / there).touch()
    with pytest.raises(UsageError, match=rf"did you mean .*{re.escape(there)}\?"):
        read_text(tmp_path / asked)


@pytest.mark.parametrize(
    ("asked", "there"),
    [
        ("rscr.yaml", "rcsr.yaml"),
        ("rssr.yaml", "rcsr.yaml"),
        ("rcsr_csr.yaml", "rcsr.yaml"),
        ("crane.yaml", "crank.yaml"),
        ("four_bar.yaml", "planar_four_bar.yaml"),
        ("lecture_crane_20.yaml", "lecture_crane_30.yaml"),
        ("slider_crank.yaml", "slider_crank_2.yaml"),
        ("slider_crank.yaml", "inverted_slider_crank.yaml"),
    ],
)
def test_another_mechanism_is_not_suggested(asked: str, there: str, tmp_path: Path) -> None:
    (tmp_path / there).touch()
    with pytest.raises(UsageError, match=r"there is no file .*; check the path$"):
        read_text(tmp_path / asked)


def test_folders_name_a_file_in_them(tmp_path: Path) -> None:
    (tmp_path / "rcsr.yaml").touch()
    with pytest.raises(UsageError, match=r"is a directory.*rcsr\.yaml"):
        read_text(tmp_path)


def test_pipes_are_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(UsageError, match="not a regular file"):
        read_text(tmp_path / "pipe")


@pytest.mark.parametrize("path", ["a\x00b.yaml", "x" * 5000, "missing/folder/f.yaml"])
def test_impossible_paths(path: str) -> None:
    with pytest.raises(UsageError):
        read_text(path)
