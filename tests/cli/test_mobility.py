"""Both orders of freedom on screen and in JSON, and inputs that leave freedoms, in `check`."""

from __future__ import annotations

import io

import pytest
from classics.planes import polygon, quadrilateral
from classics.platforms import parallel_legs, wren

from mechkin_cli.cli.messages import fitted

FIVE_BAR = polygon((0, 0), (0, 1), (1, 1.7), (2, 1.5), (2.5, 0))
INPUT = "motion: {inputs: {J1.theta: {from: 0, to: 10, step: 5}}}\n"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        (wren(5), "2, where motions of 1 and 2 freedoms meet; to first order 3"),
        (parallel_legs(6), "2; to first order 3"),
        (quadrilateral(0.0, 1.0, 2.2, 3.0), "0; to first order 2"),
        (FIVE_BAR, "2, to first order, too"),
    ],
)
def test_both_orders_are_shown(mechkin, write, text: str, shown: str) -> None:
    run = mechkin("mobility", write("file.yaml", text))
    assert f"\n  mobility   {shown}\n" in run.out


def test_both_orders_and_all_dimensions_in_json(mechkin, write) -> None:
    record = mechkin("mobility", write("file.yaml", wren(5)), "--json").json
    assert (record["mobility"], record["dimensions"], record["first_order"]) == (2, [2, 1], 3)


def test_check_names_a_freedom_that_nothing_drives(mechkin, write) -> None:
    path = write("file.yaml", FIVE_BAR + INPUT)
    run = mechkin("check", path)
    assert run.code == 0
    assert run.err == (
        f"{path}:10:18: warning: one freedom is not driven; candidates: J2.theta, J3.theta, "
        "J4.theta, J5.theta: 2 freedoms, 0 idle, 1 driven; add inputs under motion\n"
    )
    (record,) = mechkin("check", path, "--json").json["files"]
    assert [d["code"] for d in record["diagnostics"]] == ["undriven-freedom"]
    assert record["valid"]


def test_check_and_analyze_say_the_same(mechkin, write) -> None:
    path = write("file.yaml", FIVE_BAR + INPUT)
    said = mechkin("check", path).err.split("warning: ")[1]
    assert f"error: {said}" in mechkin("analyze", path).err  # whose rows are lost by it


def test_check_is_silent_where_all_is_driven(mechkin, write) -> None:
    both = INPUT.replace("}}}", "}, J5.theta: {at: 0}}}")
    assert mechkin("check", write("file.yaml", FIVE_BAR + both)).err == ""


def test_check_says_nothing_of_a_special_position(mechkin, write) -> None:
    """A flat parallelogram has two freedoms to first order, and one in truth."""
    flat = quadrilateral(0.0, 1.0, 3.0, 2.0)
    assert mechkin("check", write("file.yaml", flat + INPUT)).err == ""


def test_lines_fit_a_terminal(monkeypatch) -> None:
    """And are whole where they are no terminal's."""

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setenv("COLUMNS", "60")
    line = f"  redundant  {' '.join(30 * ['force'])}"
    first, *others = fitted(line, Terminal(), 13).split("\n")
    assert first.startswith("  redundant  force")
    assert len(others) > 2
    assert all(other.startswith(13 * " " + "force") for other in others)
    assert max(map(len, (first, *others))) <= 60
    assert fitted(line, io.StringIO(), 13) == line
