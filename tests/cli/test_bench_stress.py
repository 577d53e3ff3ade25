"""`mechkin bench --stress`: a small set of hard mechanisms, whose rows are known."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import mechkin_cli as mk
from benchmarks.stress.block import run_block
from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.small import SEED, small_set
from mechkin_cli.bench import runs as stress
from mechkin_cli.cli.app import app
from mechkin_cli.diagnostics import UsageError


def run(*words: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["bench", "--stress", *words])
    return done.exit_code, done.stdout


def test_every_row_is_what_is_known() -> None:
    code, said = run("--json")
    assert code == 0
    found = json.loads(said)["mechanisms"]
    assert [one["family"] for one in found] == [
        name for name, family in FAMILIES.items() if not family.lengths
    ]
    assert sum(one["rows"] for one in found) == 560
    for one in found:
        assert set(one["verdicts"]) <= {"right", "rightly_none", "taken_as_drawn", "undecided"}
        assert sum(one["verdicts"].values()) == one["rows"]


def test_the_table_names_every_family() -> None:
    code, said = run()
    assert code == 0
    assert all(re.search(rf"^{name} ", said, re.MULTILINE) for name in ("sizes", "leads", "forces"))


@pytest.mark.parametrize("family", ["sizes", "dead centres", "leads", "stiff responses"])
def test_verdicts_are_those_of_double_double(family: str) -> None:
    """Where rates are right, too: the kept numbers are places alone."""
    (known,) = (one for one in stress.kept() if one["family"] == family)
    (own,) = stress.outcomes([known])
    full = run_block(family, SEED, [known["number"]])
    assert own.verdicts == full.verdicts


def test_the_kept_set_is_what_would_be_drawn_now() -> None:
    """Written by `python -m benchmarks --stress --small mechkin_cli/bench/hard_mechanisms.json`."""
    kept = Path(stress.__file__).with_name(stress.KEPT)
    assert kept.read_text(encoding="utf-8") == small_set()


def one_of(family: str) -> dict:
    (known,) = (one for one in stress.kept() if one["family"] == family)
    return known


def verdicts(known: dict) -> dict[str, int]:
    (outcome,) = stress.outcomes([known])
    return dict(outcome.verdicts)


def test_another_place_is_found_out() -> None:
    known = one_of("sizes")
    (place,) = known["places"]
    place["value"][3] += 1e-6
    assert verdicts(known) == {"right": 39, "false_ok": 1}
    (outcome,) = stress.outcomes([known])
    assert outcome.is_wrong
    assert outcome.faults == ("row 4: false ok: ok",)


def test_the_other_assembly_is_found_out() -> None:
    known = one_of("double modes")
    (place,) = known["places"]
    place["value"], place["other"] = place["other"], place["value"]
    assert verdicts(known).get("right", 0) == 0


def test_rows_that_should_not_be_there_and_those_that_lack_are_told() -> None:
    known = one_of("dead centres")
    known["exists"] = [1 - there for there in known["exists"]]
    found = verdicts(known)
    assert found["false_alarm"] == 2
    assert found["false_ok"] + found.get("wrong_warned", 0) == 38


def test_a_refused_file_is_a_finding() -> None:
    known = one_of("sizes") | {"text": "format: 1\n"}
    (outcome,) = stress.outcomes([known])
    assert outcome.is_wrong
    assert outcome.faults[0].startswith("refused: InvalidFile")


def test_whole_turns_count_only_where_they_are_known() -> None:
    turns = np.array([721.0])
    assert stress._apart(turns, np.array([1.0]), "angle") == pytest.approx(0.0)
    assert stress._apart(turns, np.array([1.0]), "whole turns") == 720.0


def test_its_files_are_files() -> None:
    assert all(mk.loads(one["text"]).runs for one in stress.kept())


@pytest.mark.parametrize("given", [["one.yaml"], ["--quick"], ["--out", "folder"]])
def test_what_is_measured_in_time_is_refused_beside_it(given: list[str]) -> None:
    done = CliRunner().invoke(app, ["bench", "--stress", *given])
    assert isinstance(done.exception, UsageError)
    assert "times nothing; leave" in str(done.exception)
