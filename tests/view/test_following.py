"""A file that is edited in many ways: its pictures, its faults, and what is written back."""

from __future__ import annotations

import json
import os
import stat
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.view import Changed, Follower, Seen, Wish

CRANK = """\
format: 1
name: crank
units: {length: mm}
parameters: {r: 40 mm, e: r/2}  # the crank
links: {arm: {}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
points: {tip: {link: arm, at: [r, e, 0]}}
motion: {inputs: {O.theta: {from: 0, to: 90, step: 45}}}
"""
LONG = 20.0
"""Seconds that a busy machine may take."""

Following = Callable[..., Follower]


@pytest.fixture
def crank(tmp_path: Path) -> Path:
    path = tmp_path / "crank.yaml"
    path.write_text(CRANK, encoding="utf-8")
    return path


@pytest.fixture
def following() -> Iterator[Following]:
    """Follows a file, and has seen it once; nobody follows it afterwards."""
    begun = []

    def follow(path: Path, wish: Wish = Wish(modes=False)) -> Follower:  # noqa: B008
        follower = Follower(path, lambda text, name, at: mk.loads(text, name, folder=at), wish)
        begun.append(follower)
        follower.start()
        assert follower.wait(0, LONG)
        return follower

    yield follow
    for each in begun:
        each.stop()


def after(follower: Follower, change: Callable[[], object]) -> Seen:
    """What is seen next after a change."""
    number = follower.seen.number
    change()
    seen = follower.wait(number, LONG)
    assert seen is not None
    return seen


def tip(seen: Seen) -> list[float]:
    """Where the picture has the point: the r and e of its file."""
    assert seen.picture is not None
    (found,) = json.loads(seen.picture.data)["points"]
    return [float(value) for value in found["place"][:2]]


def test_a_change_is_seen(crank: Path, following: Following) -> None:
    follower = following(crank)
    assert (tip(follower.seen), follower.seen.faults) == ([40, 20], ())
    seen = after(follower, lambda: crank.write_text(CRANK.replace("40 mm", "42 mm")))
    assert tip(seen) == [42, 21]
    assert dict(seen.picture.model.parameters) == {"r": 42, "e": 21}  # type: ignore[union-attr]


def test_editors_save_in_their_ways(crank: Path, following: Following) -> None:
    follower = following(crank)
    other = crank.with_name("new")

    def renamed() -> None:
        other.write_text(CRANK.replace("40 mm", "43 mm"))
        os.replace(other, crank)

    assert tip(after(follower, renamed)) == [43, 21.5]

    def moved_away() -> None:
        os.rename(crank, other)
        time.sleep(0.1)
        crank.write_text(CRANK.replace("40 mm", "44 mm"))

    assert tip(after(follower, moved_away)) == [44, 22]
    # of the same size and the same time
    before = os.stat(crank)

    def unnoticed() -> None:
        crank.write_text(CRANK.replace("40 mm", "46 mm"))
        os.utime(crank, ns=(before.st_atime_ns, before.st_mtime_ns))

    assert tip(after(follower, unnoticed)) == [46, 23]


def test_a_file_that_is_saved_unchanged_gives_nothing_new(
    crank: Path, following: Following
) -> None:
    follower = following(crank)
    number = follower.seen.number
    crank.write_text(CRANK)
    os.utime(crank)
    assert follower.wait(number, 0.3) is None


def test_faults_stand_beside_the_last_picture(crank: Path, following: Following) -> None:
    follower = following(crank)
    seen = after(follower, lambda: crank.write_text(CRANK.replace("type: R", "type: Q")))
    assert tip(seen) == [40, 20]
    (fault,) = seen.record()["faults"]  # type: ignore[misc]
    assert (fault["line"], fault["column"]) == (6, 20)  # type: ignore[index]
    assert fault["source"] == CRANK.splitlines()[5].replace("type: R", "type: Q")  # type: ignore[index]
    assert "'Q' is not a known joint type" in fault["text"]  # type: ignore[index]
    # half written files are not told of: nothing is seen until the file has stood for a moment
    seen = after(follower, crank.unlink)
    assert "there is no file" in str(seen.faults[0])
    seen = after(follower, lambda: crank.write_text(CRANK))
    assert (seen.faults, tip(seen)) == ((), [40, 20])


def test_a_file_with_faults_is_followed_from_the_start(
    tmp_path: Path, following: Following
) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text("format: 1\n")
    follower = following(path)
    assert follower.seen.picture is None
    assert "no joints" in follower.seen.faults[0].message
    assert tip(after(follower, lambda: path.write_text(CRANK))) == [40, 20]


def test_tables_that_the_file_names_are_followed(crank: Path, following: Following) -> None:
    load = 'loads: [{type: torque, joint: O, value: {table: "t.csv", over: O.theta}}]\n'
    rows = "theta,torque\n0,{}\n45,2\n90,1\n"
    crank.write_text(CRANK + load)
    follower = following(crank)
    assert "t.csv" in str(follower.seen.faults[0])
    table = crank.with_name("t.csv")
    seen = after(follower, lambda: table.write_text(rows.format(1)))
    assert seen.faults == ()
    first = seen.picture.data  # type: ignore[union-attr]
    seen = after(follower, lambda: table.write_text(rows.format(3)))
    assert seen.picture.data != first  # type: ignore[union-attr]


def test_values_are_written_and_nothing_else(crank: Path, following: Following) -> None:
    text = "\ufeff" + CRANK.replace("\n", "\r\n")
    crank.write_bytes(text.encode())
    os.chmod(crank, 0o640)
    link = crank.with_name("link.yaml")
    link.symlink_to(crank)
    follower = following(link)
    done = follower.write(follower.seen.hash, {"r": 44.5, "e": 30.0})
    assert (done.written, done.expressions) == ({"r": "44.5 mm"}, {"e": "r/2"})
    assert crank.read_bytes().decode() == text.replace("40 mm", "44.5 mm")
    assert stat.S_IMODE(crank.stat().st_mode) == 0o640
    assert link.is_symlink()
    assert sorted(each.name for each in crank.parent.iterdir()) == ["crank.yaml", "link.yaml"]
    deadline = time.monotonic() + LONG
    while follower.seen.hash != done.hash and time.monotonic() < deadline:
        time.sleep(0.01)
    again = follower.write(done.hash, {"e": 30.0}, ["e"])
    assert again.written == {"e": "30 mm"}
    assert dict(mk.load(crank).parameters) == {"r": 44.5, "e": 30}


def test_a_file_that_has_changed_is_not_written(crank: Path, following: Following) -> None:
    follower = following(crank)
    hash = follower.seen.hash
    newer = CRANK.replace("# the crank", "# ours")
    crank.write_text(newer)
    with pytest.raises(Changed, match="has changed since"):
        follower.write(hash, {"r": 44.0})
    assert crank.read_text() == newer


def test_what_is_saved_while_values_are_written_stays(
    crank: Path, following: Following, monkeypatch: pytest.MonkeyPatch
) -> None:
    follower = following(crank)
    newer = CRANK.replace("# the crank", "# ours")
    synced = os.fsync

    def saved_meanwhile(stream: int) -> None:
        synced(stream)
        crank.write_text(newer)

    monkeypatch.setattr(os, "fsync", saved_meanwhile)
    with pytest.raises(Changed, match="has changed since"):
        follower.write(follower.seen.hash, {"r": 44.0})
    assert crank.read_text() == newer
    assert [each.name for each in crank.parent.iterdir()] == ["crank.yaml"]


def test_a_file_that_cannot_be_written_stays(crank: Path, following: Following) -> None:
    follower = following(crank)
    with pytest.raises(UsageError, match="did you mean r"):
        follower.write(follower.seen.hash, {"rr": 1.0})
    hash = follower.seen.hash
    crank.unlink()
    with pytest.raises(UsageError, match="cannot be read"):
        follower.write(hash, {"r": 1.0})


def test_the_other_modes_come_with_the_picture(following: Following, tmp_path: Path) -> None:
    path = tmp_path / "bar.yaml"
    path.write_text(Path(mk.__file__).with_name("templates").joinpath("four-bar.yaml").read_text())
    follower = following(path, Wish())
    deadline = time.monotonic() + LONG
    while not follower.seen.picture.is_whole and time.monotonic() < deadline:  # type: ignore[union-attr]
        time.sleep(0.01)
    runs = json.loads(follower.seen.picture.data)["runs"]  # type: ignore[union-attr]
    assert len(runs[0]["branches"]) == 2
