"""The command: a small set of every family, in processes, as a page and as files."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

import mechkin_cli as mk
from benchmarks import ROOT
from benchmarks.__main__ import app
from benchmarks.stress import page, workers
from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.forecast import Forecast
from benchmarks.stress.plan import tasks
from benchmarks.stress.run import stress
from benchmarks.stress.tally import Tally
from mechkin_cli.diagnostics import UsageError

PAGE = Path(__file__).parents[2] / "docs" / "stress.md"


@pytest.fixture(scope="module")
def small() -> list[Tally]:
    """What the page's check computes anew."""
    known = page.of_page(PAGE.read_text(encoding="utf-8"))
    assert known is not None
    return stress(page.SMALL_ROWS, known[1], list(FAMILIES))


def test_no_row_is_wrong_and_says_ok(small: list[Tally]) -> None:
    assert [tally.family for tally in small] == list(FAMILIES)
    for tally in small:
        assert tally.verdicts["false_ok"] == 0, tally.faults
        assert tally.verdicts["refused"] == 0, tally.faults
        assert tally.rows == sum(tally.verdicts.values())


def test_the_page_is_what_would_be_written_now(small: list[Tally]) -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert page.is_current(text, small)
    assert not page.is_current(text.replace("| sizes | 4 ", "| sizes | 5 "), small)
    assert not page.is_current(text.replace("| leads |", "| lead |", 1), small)
    # more that is proven leaves the page as it is; what is proven elsewhere does not
    own = proofs_of_small_set(text, "sizes")
    better, worse = [*own], [*own]
    better[3], better[5] = str(int(own[3]) + 3), str(int(own[5]) + 4)
    worse[7] = str(int(own[7]) + 1)
    for cells, stays in ((better, True), (worse, False)):
        changed = text.replace(" | ".join(own), " | ".join(cells))
        assert changed != text
        assert page.is_current(changed, small) is stays


def proofs_of_small_set(text: str, family: str) -> list[str]:
    """Cells of a family's row: its name, one mechanism of, rows asked, proven, to closure, not
    proven, no position, elsewhere."""
    table = text.split("### What --certify proves")[-1]
    (line,) = (x for x in table.split("###")[0].splitlines() if x.startswith(f"| {family} |"))
    return line.strip("| ").split(" | ")


def test_processes_give_the_same(small: list[Tally]) -> None:
    family = "double modes"
    blocks = tasks(100, [family])
    known = Tally(family)
    for done in workers.results([*blocks, *blocks], 1, 2):
        known.merge(done.tally)
    once = Tally(family)
    for done in workers.results([*blocks, *blocks], 1, 1):
        once.merge(done.tally)
    assert known.in_order().record() == once.in_order().record()


def test_what_is_left_follows_from_what_is_done() -> None:
    blocks = tasks(40_000, ["sizes", "many loops"])
    forecast = Forecast(blocks, 2)
    assert forecast.seconds is None
    for task in blocks[:-1]:
        rows = sum(FAMILIES[task.family].rows_of(n) for n in task.numbers)
        forecast.done(task, rows * 0.25)
    last = blocks[-1]
    rows = sum(FAMILIES[last.family].rows_of(n) for n in last.numbers)
    assert forecast.seconds == pytest.approx(rows * 0.25 / 2)
    forecast.done(last, 1.0)
    assert forecast.seconds == 0.0


def test_one_mechanism_is_printed_as_a_file() -> None:
    one = ("--stress", "--family", "leads", "--only", "3")
    text = CliRunner().invoke(app, one).stdout
    assert text == CliRunner().invoke(app, one).stdout
    assert mk.loads(text).name == "leads"
    assert text != CliRunner().invoke(app, [*one, "--seed", "2"]).stdout


def test_json() -> None:
    asked = ["--stress", "--family", "change points", "--rows", "1e2", "--json"]
    found = json.loads(CliRunner().invoke(app, asked).stdout)
    assert found["rows"] == 100
    assert found["families"]["change points"]["verdicts"] == {"right": 120}


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["--family", "doubel modes"], "did you mean double modes?"),
        (["--only", "3"], "name it with --family"),
        (["--check"], "name it with --page"),
        (["--page", "page.md", "--family", "leads"], "leave --family out"),
    ],
)
def test_what_is_not_understood(asked: list[str], said: str) -> None:
    result = CliRunner().invoke(app, ["--stress", *asked])
    assert result.exit_code != 0
    assert said in str(result.exception)


def test_a_process_ends_where_its_input_ends() -> None:
    """Also in the middle of a task: nobody waits for it."""
    process = subprocess.Popen(
        workers.COMMAND, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL
    )
    assert process.stdin is not None
    process.stdin.write(json.dumps(["many loops", 1, list(range(1000))]).encode() + b"\n")
    process.stdin.close()
    assert process.wait(timeout=60) == 0


@pytest.mark.parametrize(
    ("given", "named"),
    [
        (["--stress", "one.yaml"], "FILE"),
        (["--stress", "--rows", "20", "--quick"], "--quick"),
        (["--stress", "--out", "folder", "one.yaml"], "FILE, --out"),
        (["--family", "leads"], "--family"),
        (["--quick", "--rows", "2000", "one.yaml"], "--rows"),
        (["--seed", "1", "--processes", "0"], "--seed, --processes"),
    ],
)
def test_options_that_mean_nothing_together_are_refused(given: list[str], named: str) -> None:
    run = CliRunner().invoke(app, given)
    assert isinstance(run.exception, UsageError)
    assert f"{named} out" in str(run.exception) or f"for {named};" in str(run.exception)
