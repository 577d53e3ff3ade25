"""The command line as a process of its own: pipes, terminals, interrupts, a missing core."""

import contextlib
import os
import pty
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from cli import files
from references import FILE_OF, RCSR

import mechkin_cli

# -P keeps a source folder that pytest may stand in from hiding the installed package
MECHKIN = [sys.executable, "-P", "-m", "mechkin_cli"]


def run(*arguments: str | Path, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*MECHKIN, *map(str, arguments)],
        cwd=cwd,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def on_terminal(*arguments: str | Path, cwd: Path, **environment: str) -> str:
    """What a command prints on stdout and stderr when both are a terminal."""
    leader, follower = pty.openpty()
    process = subprocess.Popen(
        [*MECHKIN, *map(str, arguments)],
        cwd=cwd,
        env=os.environ | {"COLUMNS": "80"} | environment,
        stdout=follower,
        stderr=follower,
    )
    os.close(follower)
    printed = b""
    # Linux says by an error that the other side has closed
    with contextlib.suppress(OSError):
        while part := os.read(leader, 65536):
            printed += part
    process.wait(60)
    os.close(leader)
    return printed.decode().replace("\r\n", "\n")


@pytest.fixture
def invalid(tmp_path: Path) -> Path:
    path = tmp_path / "invalid.yaml"
    path.write_text(files.INVALID, encoding="utf-8")
    return Path("invalid.yaml")


def test_the_module_runs_as_the_command(tmp_path: Path) -> None:
    found = run("check", RCSR, cwd=tmp_path)
    assert (found.returncode, found.stderr) == (0, "")
    assert found.stdout == f"{RCSR}: ok (1 loop, 27 rows, 11 tables)\n"


def test_no_colours_in_a_pipe(tmp_path: Path, invalid: Path) -> None:
    found = run("check", invalid, cwd=tmp_path)
    assert found.returncode == 3
    assert found.stderr.startswith("invalid.yaml:5:39: error: there is no link amr")
    assert "\x1b" not in found.stderr


def test_colours_on_a_terminal_unless_refused(tmp_path: Path, invalid: Path) -> None:
    environment = {"NO_COLOR": "", "TERM": "xterm"}
    assert "\x1b[31merror:\x1b[0m" in on_terminal("check", invalid, cwd=tmp_path, **environment)
    environment["NO_COLOR"] = "1"
    assert "\x1b" not in on_terminal("check", invalid, cwd=tmp_path, **environment)


def test_long_messages_are_broken_between_words_on_a_terminal(tmp_path: Path) -> None:
    arguments = ("analyze", RCSR, "--table", "nothing")
    assert run(*arguments, cwd=tmp_path).stderr.count("\n") == 1
    lines = on_terminal(*arguments, cwd=tmp_path).splitlines()
    assert len(lines) > 1
    assert max(map(len, lines)) <= 80
    assert all(line.startswith("    table_") for line in lines[1:])


def test_a_reader_that_goes_away_does_not_stop_the_work(tmp_path: Path, invalid: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    process = subprocess.run(
        [*MECHKIN, "analyze", "--quiet", "--explain", str(RCSR), str(invalid)],
        cwd=tmp_path,
        stdout=writer,
        stderr=subprocess.PIPE,
        text=True,
        timeout=60,
        check=False,
    )
    os.close(writer)
    assert process.returncode == 3
    assert process.stderr.startswith("invalid.yaml:5:39: error: ")
    assert process.stderr.count("\n") == 1
    assert (tmp_path / "out/rcsr/rows.csv").is_file()


def test_letters_that_a_terminal_lacks_are_no_error(tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_text(files.CRANK + files.TABLES.replace("The tip", "→ tip"))
    found = run("analyze", "x.yaml", cwd=tmp_path, PYTHONIOENCODING="ascii")
    assert found.returncode == 0
    assert found.stdout.startswith("tip: \\u2192 tip\n")
    assert (tmp_path / "out/x/tip.md").read_text(encoding="utf-8").startswith("# → tip\n")


def test_a_missing_core_is_one_sentence_with_the_cure(tmp_path: Path) -> None:
    source = Path(mechkin_cli.__file__).parent
    leave_out = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__", "src", "core", "python")
    shutil.copytree(source, tmp_path / "source/mechkin_cli", ignore=leave_out)
    found = run("analyze", RCSR, cwd=tmp_path, PYTHONPATH=str(tmp_path / "source"))
    assert (found.returncode, found.stdout) == (70, "")
    assert found.stderr.startswith("mechkin: mechkin's compiled core is missing: run 'pip install")
    assert found.stderr.count("\n") == 1
    assert "please report" not in found.stderr


@pytest.mark.parametrize("command", [("--help",), ("schema",)])
def test_what_needs_no_core_runs_without_it(tmp_path: Path, command: tuple[str, ...]) -> None:
    source = Path(mechkin_cli.__file__).parent
    leave_out = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__", "src", "core", "python")
    shutil.copytree(source, tmp_path / "source/mechkin_cli", ignore=leave_out)
    found = run(*command, cwd=tmp_path, PYTHONPATH=str(tmp_path / "source"))
    assert (found.returncode, found.stderr) == (0, "")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("earlier", [False, True], ids=["first run", "tables of an earlier run"])
def test_an_interrupt_leaves_nothing_half_written(
    tmp_path: Path, invalid: Path, earlier: bool, number: signal.Signals
) -> None:
    long = files.CRANK.replace("to: 90, step: 45", "to: 90, step: 1e-4")
    (tmp_path / "long.yaml").write_text(long, encoding="utf-8")
    before = {}
    if earlier:
        (tmp_path / "out/long").mkdir(parents=True)
        before = {tmp_path / "out/long/sweep.csv": "of an earlier run\n"}
        (tmp_path / "out/long/sweep.csv").write_text("of an earlier run\n", encoding="utf-8")
    process = subprocess.Popen(
        [*MECHKIN, "analyze", str(invalid), "long.yaml", "--quiet"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # what runs the tests may ignore the signal, and a command goes on ignoring it
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),
    )
    assert process.stderr is not None
    assert process.stderr.readline().startswith("invalid.yaml:")
    time.sleep(0.3)  # now the long one is under way; it takes some seconds
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, "")
    assert err == "mechkin: interrupted; files written so far are whole\n"
    left = {p: p.read_text(encoding="utf-8") for p in (tmp_path / "out").rglob("*") if p.is_file()}
    assert left == before


def test_what_earlier_analyses_left_is_collected(tmp_path: Path) -> None:
    """Several analyses in one process: nothing of them outlives it, as the kernel would report."""
    program = tmp_path / "again.py"
    program.write_text(
        "import sys\n"
        "from mechkin_cli.__main__ import main\n"
        f"sys.argv = ['mechkin', 'analyze', {str(RCSR)!r}]\n"
        "for _ in range(3):\n"
        "    try:\n"
        "        main()\n"
        "    except SystemExit as ended:\n"
        "        assert ended.code == 0\n"
    )
    found = subprocess.run(
        [sys.executable, str(program)], capture_output=True, text=True, timeout=60, cwd=tmp_path
    )
    assert found.returncode == 0, found.stderr
    assert "leaked" not in found.stderr


def test_a_script_ends_without_a_word_about_what_was_remembered(tmp_path: Path) -> None:
    """Programs of expressions are remembered until Python ends, and are no leak of the core's."""
    script = (
        "import mechkin_cli as mk, sys\n"
        "errors = mk.load(sys.argv[1]).analyze().errors\n"
        "errors['O2.turn']\n"
    )
    found = subprocess.run(
        [sys.executable, "-P", "-c", script, str(FILE_OF["rssr"])],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (found.returncode, found.stdout, found.stderr) == (0, "", "")
