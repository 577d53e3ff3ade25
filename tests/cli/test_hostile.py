"""What surrounds a run may fail: disks, pipes, inputs that are no files, texts of options."""

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from cli import files
from cli.test_processes import MECHKIN

LONG = files.CRANK.replace("to: 90, step: 45", "to: 90, step: 1e-3")
"""Its tables take some megabytes."""

Finished = subprocess.CompletedProcess[str]


def run(folder: Path, command: list[str], **options: object) -> Finished:
    return subprocess.run(  # type: ignore[call-overload, no-any-return]
        command,
        cwd=folder,
        stdin=subprocess.DEVNULL,
        text=True,
        timeout=60,
        check=False,
        **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options,
    )


def shell(folder: Path, line: str, **options: object) -> Finished:
    """A line of the shell in which `mechkin` is the command."""
    command = " ".join(f"'{part}'" for part in MECHKIN)
    return run(folder, ["/bin/sh", "-c", f'mechkin() {{ {command} "$@"; }}; {line}'], **options)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "crank.yaml").write_text(files.CRANK, encoding="utf-8")
    (tmp_path / "long.yaml").write_text(LONG, encoding="utf-8")
    return tmp_path


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.rglob("*") if path.is_file())


def one_sentence(found: Finished, code: int, words: str) -> None:
    assert (found.returncode, found.stdout) == (code, "")
    assert found.stderr.startswith("mechkin: ")
    assert found.stderr.count("\n") == 1
    assert words in found.stderr


def test_a_limit_of_file_size_leaves_the_old_tables(folder: Path) -> None:
    old = folder / "out/long/sweep.csv"
    old.parent.mkdir(parents=True)
    old.write_text("old\n", encoding="utf-8")

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

    found = run(folder, [*MECHKIN, "analyze", "long.yaml"], preexec_fn=limited)
    one_sentence(found, 2, " rows: the file is larger than is allowed")
    assert names(folder / "out") == ["sweep.csv"]
    assert old.read_text(encoding="utf-8") == "old\n"
    # as many rows are told as are in so many bytes
    rows = re.search(r"cannot write out/long/sweep\.csv after (\d+) rows: ", found.stderr)
    assert rows is not None
    run(folder, [*MECHKIN, "analyze", "long.yaml", "--format", "csv", "--out", "whole"])
    lines = (folder / "whole/sweep.csv").read_bytes()[:100_000].count(b"\n")
    assert int(rows[1]) == lines - 1


def test_a_full_disk_leaves_the_old_tables(folder: Path) -> None:
    unshare = shutil.which("unshare")
    mount = f"{unshare} --user --map-root-user --mount /bin/sh -c"
    disk = folder / "disk"
    disk.mkdir()
    attach = f"mount -t tmpfs -o size=256k none {disk}"
    if not unshare or shell(folder, f"{mount} '{attach}'").returncode:
        pytest.skip("this system does not let a test mount a small disk of its own")
    script = f"""{attach} && cd {disk} && mkdir -p out/long && echo old > out/long/sweep.csv
    {" ".join(MECHKIN)} analyze ../long.yaml; echo $?; ls -A out/long; cat out/long/sweep.csv"""
    found = run(folder, [*mount.split(), script])
    words = r"mechkin: cannot write out/long/sweep\.csv after [1-9]\d* rows: the disk is full"
    assert re.match(words, found.stderr)
    assert found.stdout.splitlines() == ["2", "sweep.csv", "old"]


def test_a_read_only_folder(folder: Path) -> None:
    (folder / "out").mkdir(mode=0o500)
    if os.access(folder / "out", os.W_OK):
        pytest.skip("this user may write everywhere")
    found = run(folder, [*MECHKIN, "analyze", "crank.yaml"])
    one_sentence(found, 2, "no permission to write there; choose another place with --out")


@pytest.mark.parametrize("out", ["/dev/full", "/dev/null/x", "crank.yaml", "/proc/nowhere", "loop"])
def test_places_that_are_no_folders(folder: Path, out: str) -> None:
    (folder / "loop").symlink_to("loop")
    found = run(folder, [*MECHKIN, "analyze", "crank.yaml", "--out", out])
    one_sentence(found, 2, f"cannot write {out}/sweep.csv: ")
    assert "--out" in found.stderr


@pytest.mark.parametrize(
    "line",
    [
        "mechkin analyze crank.yaml",
        "mechkin check --json crank.yaml",
        "mechkin schema",
        "mechkin --help",
    ],
)
def test_a_stdout_that_is_full(folder: Path, line: str) -> None:
    one_sentence(shell(folder, f"{line} > /dev/full"), 2, "stdout cannot be written: No space left")


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("mechkin analyze crank.yaml", 0),
        ("mechkin analyze nowhere.yaml", 2),
        ("mechkin analyze", 2),
        ("mechkin check crank.yaml --json", 0),
        ("mechkin --help", 0),
    ],
)
@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&- <&-", "2>/dev/full"])
def test_closed_streams_do_not_change_the_answer(
    folder: Path, line: str, code: int, closed: str
) -> None:
    found = shell(folder, f"{line} {closed}")
    assert found.returncode == code
    assert "Traceback" not in found.stderr
    assert (folder / "out/crank/rows.csv").is_file() == ("analyze crank" in line)


@pytest.mark.parametrize("line", ["mechkin analyze crank.yaml 2>&1", "mechkin schema"])
def test_a_reader_that_stops_early(folder: Path, line: str) -> None:
    found = shell(folder, f"{{ {line}; echo $? >&3; }} 3>code | head -1")
    assert found.stderr == ""
    assert (folder / "code").read_text() == "0\n"


@pytest.mark.parametrize("line", ["mechkin --help", "mechkin plot --help", "mechkin schema"])
def test_a_reader_that_is_gone(folder: Path, line: str) -> None:
    found = shell(folder, f"{{ sleep 0.5; {line}; echo $? >&3; }} 3>code | true")
    assert found.stderr == ""
    assert (folder / "code").read_text() == "0\n"


@pytest.mark.parametrize(
    ("file", "words"),
    [
        ("''", "is a directory"),
        (".", "is a directory; name a mechanism file in it, for example crank.yaml"),
        ("pipe", "pipe is not a regular file"),
        ("/dev/zero", "/dev/zero is not a regular file"),
        ("round", "cannot be read: Too many levels of symbolic links"),
        ("crank.yaml/x", "cannot be read: Not a directory"),
        ("\"$(printf 'a\\033[31m')\"", "there is no file a\\x1b[31m"),
        ("\"$(printf '\\377')\"", "there is no file \\xff"),
    ],
)
def test_what_is_no_file(folder: Path, file: str, words: str) -> None:
    os.mkfifo(folder / "pipe")
    (folder / "round").symlink_to("round")
    one_sentence(shell(folder, f"mechkin analyze {file}"), 2, words)


def test_a_pipe_as_stdin_is_refused_and_not_waited_for(folder: Path) -> None:
    found = shell(folder, "cat crank.yaml | mechkin analyze /dev/stdin")
    one_sentence(found, 2, "/dev/stdin is not a regular file")


def test_a_file_without_permission(folder: Path) -> None:
    (folder / "crank.yaml").chmod(0)
    if os.access(folder / "crank.yaml", os.R_OK):
        pytest.skip("this user may read everything")
    found = run(folder, [*MECHKIN, "check", "crank.yaml"])
    one_sentence(found, 2, "crank.yaml cannot be read: Permission denied")


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("(" * 60 + "1", "nested more than 50 deep (at character 51 of the value)"),
        ("1" * 100_000, "the expression has 100000 characters (limit 4000)"),
        ("1e999 m", "is too large"),
        ("r", "parameters depend on themselves: r -> r"),
        ("\x01", "unexpected character 'U+0001'"),
        ("\udcff", "unexpected character 'U+DCFF'"),
        ("2 m; rm", "unexpected character ';' (at character 4 of the value)"),
        ("[1, 2, 3] m", "'m' stands where an operator was expected"),
        ("1 m\n  x: 2", "unexpected character ':' (at character 8 of the value)"),
        ("&a 1", "unexpected character '&'"),
        ("inf", "inf is not a finite number"),
    ],
    ids=lambda text: ascii(text[:12]),
)
def test_texts_that_set_a_parameter(folder: Path, value: str, message: str) -> None:
    found = run(folder, [*MECHKIN, "check", "crank.yaml", "--set", f"r={value}"])
    assert (found.returncode, found.stdout) == (3, "")
    assert found.stderr.startswith("--set r: error: ")
    assert message in found.stderr


def test_a_file_whose_name_is_dots_stays_in_its_folder(folder: Path) -> None:
    (folder / "here").mkdir()
    shutil.copy(folder / "crank.yaml", folder / "here/...yaml")
    found = run(folder / "here", [*MECHKIN, "analyze", "...yaml", "--quiet"])
    assert found.returncode == 0
    assert (folder / "here/out/...yaml/rows.csv").is_file()


def test_a_signal_that_the_parent_ignores_is_ignored(folder: Path) -> None:
    process = subprocess.Popen(
        [*MECHKIN, "analyze", "long.yaml", "--quiet"],
        cwd=folder,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
    )
    for _ in range(20):
        process.send_signal(signal.SIGHUP)
    assert process.wait(60) == 0
    assert (folder / "out/long/rows.csv").is_file()


def test_too_little_memory_is_one_sentence(folder: Path) -> None:
    sweep = files.CRANK.replace("to: 90, step: 45", "to: 90, count: 3500000")
    (folder / "sweep.yaml").write_text(sweep, encoding="utf-8")

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))

    # threads of linear algebra, which no row needs, would reserve memory of their own
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    command = [*MECHKIN, "analyze", "sweep.yaml", "--quiet"]
    found = run(folder, command, preexec_fn=limited, env=environment)
    one_sentence(found, 2, "the memory is used up; take fewer rows, columns or tables")
    assert names(folder) == ["crank.yaml", "long.yaml", "sweep.yaml"]


NO_THREADS = """
import sys, threading
def start(thread):
    raise RuntimeError("can't start new thread")
threading.Thread.start = start
from mechkin_cli.cli.run import run
sys.argv[1:] = ["analyze", "sweep.yaml", "--format", "csv", "--quiet"]
sys.exit(run())
"""


def test_no_memory_for_a_thread_is_the_same_sentence(folder: Path) -> None:
    sweep = files.CRANK.replace("to: 90, step: 45", "to: 90, count: 100000")
    (folder / "sweep.yaml").write_text(sweep, encoding="utf-8")
    found = run(folder, [sys.executable, "-P", "-c", NO_THREADS])
    one_sentence(found, 2, "the memory is used up; take fewer rows, columns or tables")
    assert names(folder) == ["crank.yaml", "long.yaml", "sweep.yaml"]
