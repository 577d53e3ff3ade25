"""Exit codes: 0 ok, 1 differences, 2 usage, 3 invalid file, 4 rows are missing, 70 internal."""

import sys
from importlib import metadata

import pytest
from cli import files
from references import RCSR

import mechkin_cli as mk
from mechkin_cli import kernel
from mechkin_cli.kernel.functions import INSTRUCTIONS


@pytest.fixture(autouse=True)
def _files(write) -> None:
    write("crank.yaml", files.CRANK)
    write("invalid.yaml", files.INVALID)
    write("odd.yaml", files.UNPHYSICAL)
    write("beyond.yaml", files.beyond_dead_centre())
    write("apart.yaml", files.WITHOUT_ASSEMBLY)


@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("", 2),
        ("--help", 0),
        ("--version", 0),
        ("frobnicate", 2),
        ("analyze", 2),
        ("analyze --frobnicate crank.yaml", 2),
        ("analyze crank.yaml", 0),
        ("analyze odd.yaml", 0),
        ("analyze nowhere.yaml", 2),
        ("analyze .", 2),
        ("analyze invalid.yaml", 3),
        ("analyze beyond.yaml", 4),
        ("analyze apart.yaml", 4),
        ("analyze crank.yaml --mode Q", 2),
        ("analyze crank.yaml invalid.yaml beyond.yaml", 4),
        ("analyze invalid.yaml crank.yaml nowhere.yaml", 3),
        ("analyze crank.yaml nowhere.yaml", 2),
        ("analyze crank.yaml --set", 2),
        ("analyze crank.yaml --set r", 2),
        ("analyze crank.yaml --set r=", 2),
        ("analyze crank.yaml --set q=1", 2),
        ("analyze crank.yaml --set r=1", 0),
        ("analyze crank.yaml --set r=x", 3),
        ("analyze crank.yaml --table nothing", 2),
        ("analyze crank.yaml --format xml", 2),
        ("analyze crank.yaml --out crank.yaml", 2),
        ("analyze crank.yaml --out crank.yaml/below", 2),
        ("check crank.yaml odd.yaml apart.yaml", 0),
        ("check crank.yaml invalid.yaml nowhere.yaml", 3),
        ("check nowhere.yaml", 2),
        ("tables nowhere", 2),
        ("tables crank.yaml", 0),
        ("tables crank.yaml --check", 1),
        ("tables invalid.yaml --check", 3),
        ("tables .", 4),
        ("schema", 0),
        ("schema --check", 2),
        ("schema --check --out crank.yaml", 1),
    ],
)
def test_exit_code(mechkin, command: str, code: int) -> None:
    run = mechkin(*command.split())
    assert run.code == code, run.err
    assert "internal error" not in run.err
    assert "Traceback" not in run.err


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("analyze crank.yaml --set r=1 --set r=2", "--set gives r twice; leave one of them out"),
        ("modes crank.yaml --at O.theta=1 --at O.theta=2", "--at gives O.theta twice; leave one"),
        ("modes crank.yaml --at 1e308", "too large to compute with (limit 1.621e+18)"),
        ("plot crank.yaml --run nix", "there is no run nix; known are sweep"),
        ("schema --check", "there is no file schemas/mechanism.schema.json; check its name"),
        ("new a/b/c", "there is no folder a/b; make it first"),
    ],
)
def test_a_command_that_cannot_be_done_says_why_and_what_to_do(
    mechkin, command: str, words: str
) -> None:
    run = mechkin(*command.split())
    assert (run.code, run.out) == (2, "")
    assert words in run.err


@pytest.mark.parametrize(
    ("name", "library", "extra"),
    [
        ("xlsx", "openpyxl", "xlsx"),
        *((name, "pyarrow", "parquet") for name in ("parquet", "arrow", "csv.zst", "jsonl.zst")),
    ],
)
def test_a_format_without_its_library_is_refused_before_the_run(
    mechkin, monkeypatch, name: str, library: str, extra: str
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.setattr("mechkin_cli.model.load", lambda *_: 1 / 0)
    run = mechkin("analyze", "crank.yaml", "--format", f"csv,{name}")
    assert (run.code, run.out) == (2, "")
    said = f"--format {name} needs {library}: pip install 'mechkin[{extra}]'"
    assert said in run.err


def test_a_mode_without_a_letter_is_quoted(mechkin) -> None:
    run = mechkin("analyze", "crank.yaml", "--mode", "")
    assert run.code == 2
    assert 'there is no mode "" at the first row' in run.err


def test_the_rcsr_tables_are_the_ones_kept(mechkin) -> None:
    assert mechkin("tables", RCSR, "--check").code == 0


def test_an_internal_error_asks_for_a_report(mechkin, monkeypatch) -> None:
    monkeypatch.delenv("MECHKIN_DEBUG", raising=False)
    monkeypatch.setattr("mechkin_cli.model.load", lambda *_: 1 / 0)
    run = mechkin("analyze", "crank.yaml")
    assert run.code == 70
    assert run.err.startswith("mechkin: internal error, ZeroDivisionError")
    assert "please report it" in run.err


def test_an_interrupt_ends_with_130(mechkin, monkeypatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("mechkin_cli.model.load", interrupted)
    run = mechkin("analyze", "crank.yaml")
    assert (run.code, run.out) == (130, "")
    assert "interrupted" in run.err


def test_the_version_is_that_of_the_installed_package(mechkin) -> None:
    assert mk.__version__ == metadata.version("mechkin")
    lanes = kernel._kernel.widest
    lines = (
        f"mechkin {mk.__version__}",
        f"kernel  {lanes} lanes ({INSTRUCTIONS[lanes]})",
        "format  1",
    )
    assert mechkin("--version").out.splitlines() == [*lines]


def test_the_version_is_told_without_a_kernel(mechkin, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mechkin_cli.kernel._kernel", None)
    monkeypatch.delattr(kernel, "_kernel", raising=False)
    assert mechkin("--version").out.splitlines()[:2] == [
        f"mechkin {mk.__version__}",
        "kernel  missing",
    ]
