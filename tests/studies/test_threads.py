"""Threads share a model: the same bytes for any number of them, each recording made once; and
what is gathered while pieces come is what their files hold."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from references import FILE_OF
from variants.test_recorded_again import ROWS, SPACINGS, with_a_mass

import mechkin_cli as mk
from mechkin_cli.studies import results, study as running
from mechkin_cli.studies.formats import GatheredRecords, Heading
from mechkin_cli.studies.results import GatheredOverview, RunningOverview, overview
from mechkin_cli.variants import many
from mechkin_cli.variants.design import Base, base_of
from mechkin_cli.variants.result import Verdicts
from mechkin_cli.verdict import Status

SHAKEN = {
    "dead centres": (
        lambda: mk.load(FILE_OF["rcsr"]),
        {
            "vary": {"P1": {"tolerance": "0.1 in"}, "alpha1": {"deviation": "3 deg"}},
            "sample": {"count": 60},
            "keep": [{"of": "O1.effort", "as": ["peak"]}, {"of": "O4.theta", "as": ["range"]}],
            "dead_centres": "place",
            "rows": ["O4.theta"],
        },
    ),
    "loops left out": (
        lambda: mk.load(FILE_OF["rcsr_csr_loop_one"]),
        {
            "vary": {"P1": {"tolerance": "0.01 in"}},
            "sample": {"count": 24},
            "keep": [{"of": "O4.theta", "as": ["range"]}],
        },
    ),
    "built in two ways": (
        lambda: mk.loads(with_a_mass()),
        {
            "vary": {"m": [0, 1, 2], "b": {"tolerance": "3 mm"}},
            "sample": {"count": 16},
            "keep": [{"of": "A.effort", "as": ["peak"]}],
        },
    ),
    "rows by parameters": (
        lambda: mk.loads(ROWS.replace("SPACING", SPACINGS["both ends"])),
        {
            "vary": {"first": {"tolerance": "3"}, "b": {"tolerance": "3 mm"}},
            "sample": {"count": 48},
            "keep": [{"of": "D.theta", "as": ["peak", "place_of_peak"]}],
        },
    ),
}


def contents(found: Any) -> dict[str, object]:
    columns = {**{label: found[label] for label in found}, **found.rows}
    return {k: v.tolist() if v.dtype == object else v.tobytes() for k, v in columns.items()}


@pytest.mark.parametrize(("make", "asked"), SHAKEN.values(), ids=SHAKEN.keys())
def test_any_number_of_threads(
    make: Callable[[], mk.Model], asked: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = contents(make().study(asked, threads=1))
    monkeypatch.setattr(running, "MOST_IN_PIECE", 3)
    for threads in (2, 5):
        assert contents(make().study(asked, threads=threads)) == whole


def test_threads_record_once(monkeypatch: pytest.MonkeyPatch) -> None:
    recorded: list[tuple[str, ...]] = []
    own = Base._recorded

    def noted(self: Base, names: tuple[str, ...]) -> Any:
        recorded.append(names)
        return own(self, names)

    monkeypatch.setattr(Base, "_recorded", noted)
    monkeypatch.setattr(running, "MOST_IN_PIECE", 2)
    make, asked = SHAKEN["built in two ways"]
    model = make()
    model.study(asked, threads=4)
    assert recorded == [("m", "b")]
    assert len(base_of(model.design)._recordings["m", "b"]) == 2


HEADINGS = (Heading("variant", kind="whole"), Heading("x"), Heading("verdict", kind="text"))


def pieces_of(count: int) -> list[dict[str, Any]]:
    generator = np.random.default_rng(8)
    x = generator.standard_normal(count) * 10.0 ** generator.integers(-8, 8, count)
    x[::17], x[3] = np.nan, -0.0
    words = np.array(["ok", "branch-lost"], dtype=object)[(generator.random(count) < 0.1) * 1]
    cuts = np.sort(generator.choice(np.arange(1, count), 11, replace=False))
    stretches = np.split(np.arange(count), cuts)
    return [{"variant": s, "x": x[s], "verdict": words[s]} for s in stretches]


def test_a_gathered_overview_is_that_of_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(results, "LINES_AT_ONCE", 50)
    pieces = pieces_of(333)
    whole = {k: np.concatenate([p[k] for p in pieces]) for k in pieces[0]}
    whole["x"] = whole["x"] + 0.0
    lines = [{k: v[n : n + 50] for k, v in whole.items()} for n in range(0, 333, 50)]
    expected = overview(lines, HEADINGS, "variant", "verdict")
    for order in (range(12), range(11, -1, -1), [5, 0, 3, 1, 11, 2, 4, 6, 10, 9, 8, 7]):
        gathered = GatheredOverview(RunningOverview(HEADINGS, "variant", "verdict"), 0)
        for number in order:
            gathered.put(int(pieces[number]["variant"][0]), pieces[number])
        assert repr(gathered.overview()) == repr(expected)


def test_a_study_tells_what_it_would_read(tmp_path: Path) -> None:
    make, asked = SHAKEN["dead centres"]
    first = make().study(asked, tmp_path, threads=2)
    again = make().study(asked, tmp_path)  # from the files
    assert repr(first.overview) == repr(again.overview)


def test_records_in_whatever_order_they_come() -> None:
    pieces = pieces_of(120)
    gathered = GatheredRecords(120, "variants")
    for piece in pieces[::-1]:
        begin, end = int(piece["variant"][0]), int(piece["variant"][-1]) + 1
        gathered.put(begin, end, {"variants": piece, "rows": {"row": piece["variant"][:1]}})
    tables = gathered.tables()
    for label, values in tables["variants"].items():
        own = np.concatenate([piece[label] for piece in pieces])
        same = own.dtype != object
        assert np.array_equal(values, own, equal_nan=same)
    assert tables["rows"]["row"].tolist() == [int(piece["variant"][0]) for piece in pieces]


def test_only_verdicts_that_are_not_ok_are_held(monkeypatch: pytest.MonkeyPatch) -> None:
    generator = np.random.default_rng(2)
    codes = np.where(generator.random((70, 9)) < 0.01, int(Status.branch_lost), int(Status.ok))
    parts = [Verdicts.of(part.astype(np.int8)) for part in np.split(codes, [10, 11, 40])]
    whole = Verdicts.joined(parts)
    assert np.array_equal(whole.codes, codes)
    assert len(whole.held) == (codes != int(Status.ok)).any(axis=1).sum() < 20
    model = mk.load(FILE_OF["rcsr"])
    given = {"P1": np.linspace(0.3, 1.4, 40)}
    one = model.vary(given, ["O4.theta"])
    monkeypatch.setattr(many, "CHUNK_NUMBERS", 500)
    other = model.vary(given, ["O4.theta"])
    assert not one.complete.all()
    assert other.codes.tobytes() == one.codes.tobytes()
    assert other.complete.tolist() == one.complete.tolist()
    assert other["O4.theta"].tobytes() == one["O4.theta"].tobytes()
