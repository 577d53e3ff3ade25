"""What the README says is true: its files, its commands, its numbers."""

import csv
import re
import subprocess
from functools import cache
from math import cos, radians, sin, sqrt
from pathlib import Path

import pytest
import typer
from mpmath import ellipk
from references import RCSR, exact, published

import mechkin_cli as mk
from mechkin_cli.cli.analyze import analyze_files
from mechkin_cli.cli.app import app
from mechkin_cli.cli.exit_codes import ExitCode

ROOT = RCSR.parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


@cache
def options() -> dict[str, set[str]]:
    """The options of every command, without --help."""
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    return {
        name: {
            option for parameter in command.params for option in parameter.opts if "--" in option
        }
        for name, command in commands.items()
    }


def described_commands() -> dict[str, str]:
    """The first cell of each row of the table of commands, by command."""
    cells = re.findall(r"^\| `(mechkin [^`]*)` \|", README, re.MULTILINE)
    return {cell.split()[1]: cell for cell in cells}


def test_every_command_is_described_and_exists() -> None:
    assert list(described_commands()) == list(options())


@pytest.mark.parametrize("command", described_commands())
def test_options_in_the_table_of_commands_exist(command: str) -> None:
    named = set(re.findall(r"--[a-z]+", described_commands()[command]))
    assert named <= options()[command]


def test_every_option_of_analyze_is_described_and_exists() -> None:
    (paragraph,) = re.findall(r"^`mechkin analyze` takes (.*?)\n\n", README, re.M | re.DOTALL)
    assert set(re.findall(r"`(--[a-z]+)", paragraph)) == options()["analyze"]


def test_every_option_named_anywhere_exists() -> None:
    of_other_programs = {"--strict"}
    known = {"--help", "--version"} | of_other_programs | set().union(*options().values())
    assert set(re.findall(r"(?<![-\w<])--[a-z]+", README)) <= known


def test_the_line_of_errors_is_that_of_the_command(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    analyze_files([RCSR], tmp_path, ["csv"], errors=True)
    (line,) = [x for x in capsys.readouterr().err.splitlines() if x.startswith("  errors")]
    assert line + "\n" in blocks("text")


def test_exit_codes() -> None:
    (sentence,) = re.findall(r"Exit codes: (.*?)\.", README, re.DOTALL)
    codes = {int(code) for code in re.findall(r"\b\d+\b", sentence)}
    assert codes == {code for code in ExitCode if code != ExitCode.INTERRUPTED}


def test_row_verdicts() -> None:
    (paragraph,) = re.findall(r"`row\.status` is (.*?)\.\n`rows\.csv`", README, re.DOTALL)
    assert re.findall(r"`([a-z-]+)`", paragraph) == [status.label for status in mk.Status]


def test_files_named_in_the_readme_exist() -> None:
    named = re.findall(r"`((?:mechanisms|tests|mechkin_cli|schemas)/[\w./]*)`", README)
    assert named
    missing = [name for name in {*named, ".ci/run"} if not (ROOT / name).exists()]
    assert not missing


@pytest.mark.parametrize("marker", ["main", "tests"])
def test_the_gate_runs_the_command_lines_of_the_readme(marker: str) -> None:
    gate = (ROOT / ".ci/run").read_text(encoding="utf-8")
    (extraction,) = [
        line for line in gate.splitlines() if line.startswith("command=") and marker in line
    ]
    found = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", f'{extraction}\nprintf %s "$command"'],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    (block,) = [text for text in blocks("sh") if text.startswith(found)]
    assert block == f"{found}\n"
    assert found.startswith("python3 -m venv .venv && .venv/bin/pip install -q ")
    ending = {"main": ".venv/bin/mechkin analyze mechanisms/rcsr.yaml", "tests": ".venv/bin/pytest"}
    assert found.endswith(ending[marker])


def test_the_example_file_against_the_closed_form_of_the_slider_crank() -> None:
    text, _ = blocks("yaml")
    model = mk.loads(text, "readme.yaml")
    analysis = model.analyze()
    assert analysis.diagnostics == ()
    assert analysis.result.complete
    (table,) = analysis.tables
    assert [column.label for column in table.columns] == ["theta", "s", "v", "torque", "bearing"]
    columns = {column.label: column.values for column in table.columns}
    assert columns["theta"].tolist() == [float(angle) for angle in range(-70, 71, 5)]
    crank, rate = 40.0, 20.0
    rod = sqrt(120.0**2 + 40.0**2)
    for theta, s, v in zip(columns["theta"], columns["s"], columns["v"], strict=True):
        x, y = -crank * sin(radians(theta)), crank * cos(radians(theta))
        reach = sqrt(rod**2 - y**2)
        assert s == pytest.approx(x + reach - 120.0, abs=1e-11)
        assert v == pytest.approx(rate * (-y - y * x / reach), abs=1e-9)


def test_the_example_of_responses_against_elliptic_functions_and_a_balance_of_power() -> None:
    _, text = blocks("yaml")
    model = mk.loads(text, "readme.yaml")
    assert model.runs == ("swing", "start_up")
    swing = model.respond("swing")
    half = 2.0 * ellipk(sin(radians(40.0)) ** 2) / sqrt(9.81 / 0.25)
    assert swing["time"][-1] == pytest.approx(float(half), rel=1e-9)
    assert swing["A.theta"][-1] == pytest.approx(-80.0, abs=1e-6)
    assert swing["row.event"][-1] == "dead centre of A.theta"
    assert max(swing["row.energy_error"]) < 1e-9
    (table,) = swing.tables
    assert table.name == "half_swing"
    start_up = model.respond("start_up")
    assert start_up["row.event"][-1] == "3 turns of A.theta"
    assert start_up["A.theta"][-1] == pytest.approx(3.0 * 360.0, rel=1e-12)
    torque = 8000.0 - 400.0 * start_up["A.theta_dot"]
    assert start_up["A.effort"] == pytest.approx(torque, rel=1e-12)
    weight, arm, inertia = 2.0 * 9.81, 250.0, 2.0 * 0.25**2 * 1e3
    for effort, angle, rate, acceleration in zip(
        start_up["A.effort"],
        start_up["A.theta"],
        start_up["A.theta_dot"],
        start_up["A.theta_ddot"],
        strict=True,
    ):
        left = effort - weight * arm * sin(radians(angle)) - 20.0 * rate
        assert acceleration * inertia == pytest.approx(left, rel=1e-9, abs=1e-9)


def test_the_python_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    (code,) = blocks("python")
    names: dict[str, object] = {}
    exec(code, names)
    analysis = names["r"]
    assert isinstance(analysis, mk.Analysis)
    assert analysis["O4.theta"].shape == (27,)
    for expression in re.findall(r'r\["(.*?)"\]', code):
        assert analysis[expression].shape[0] == 27


def test_the_torque_where_print_is_wrong() -> None:
    (right, wrong) = re.findall(r"torque at 150 degrees is (\S+) \S+ \S+, not (\S+)\.", README)[0]
    assert published("table_18")["MIN"][0] == wrong
    assert f"{float(exact('rcsr')['ne_MIN'][0]):.2f}" == right
    with (RCSR.parent / "rcsr/table_18.csv").open(newline="", encoding="utf-8") as file:
        assert f"{float(next(csv.DictReader(file))['MIN']):.2f}" == right


def test_unknowns_of_the_rcsr_mechanism() -> None:
    (count,) = re.findall(r"RCSR: (\d+) unknowns", README)
    (block,) = mk.load(RCSR).graph.blocks
    assert block.equations == int(count)
