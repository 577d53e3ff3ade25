"""Loops written as Denavit-Hartenberg rows: the same mechanism as written with joints."""

import re

import mpmath as mp
import numpy as np
import pytest
import yaml
from building.denavit_hartenberg import Row, frames, rows_of
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.analysis.analysis import Analysis

BENNETT = FILE_OF["bennett"].read_text()
SEVEN = yaml.safe_load(FILE_OF["sevenr"].read_text())
BENNETT_CHAIN = """\
chain:
  - {joint: A, type: R, link: one, alpha: alpha, a: a}
  - {joint: B, type: R, link: two, alpha: beta, a: b}
  - {joint: C, type: R, link: three, alpha: alpha, a: a}
  - {joint: D, type: R, link: ground, alpha: beta, a: b}

"""
"""All theta are zero: the unfolded drawing of the file that is written with joints."""


def test_bennett_by_rows_has_the_tables_of_bennett_by_joints() -> None:
    by_rows = re.sub(r"joints:\n.*?\n(?=motion:)", BENNETT_CHAIN, BENNETT, flags=re.DOTALL)
    expected, found = mk.loads(BENNETT).analyze(), mk.loads(by_rows).analyze()
    assert found.result.mode == expected.result.mode
    for one, two in zip(expected.tables, found.tables, strict=True):
        for column, other in zip(one.columns, two.columns, strict=True):
            scale = np.abs(column.values).max()
            np.testing.assert_allclose(other.values, column.values, rtol=0, atol=1e-11 * scale)


def chain_file(rows: list[Row], types: str, inputs: str, more: str = "") -> str:
    """A file of the rows with joints J1, J2, ... and links one by one, none with mass."""
    lines = []
    for i, (row, letter) in enumerate(zip(rows, types, strict=True), start=1):
        link = f"L{i}" if i < len(rows) else "ground"
        numbers = ", ".join(f"{k}: {mp.nstr(v, 17)}" for k, v in row._asdict().items())
        lead = ", lead: 0.3" if letter == "H" else ""
        lines.append(f"  - {{joint: J{i}, type: {letter}, link: {link}, {numbers}{lead}}}")
    text = "\n".join(lines)
    units = "units: {length: in, angle: rad}"
    return f"format: 1\n{units}\n{more}chain:\n{text}\nmotion: {{inputs: {{{inputs}}}}}\n"


with mp.workdps(40):
    ROWS = rows_of([(j["point"], j["axis"]) for j in SEVEN["joints"].values()])


def test_a_loop_of_seven_revolutes_moves_as_the_file_with_joints() -> None:
    law = "J1.theta: {values: [0, 0.2, 0.7], rate: 0.5, acceleration: 0.2}"
    found = mk.loads(chain_file(ROWS, "R" * 7, law)).analyze()
    original = FILE_OF["sevenr"].read_text()
    swept = re.compile(r"J1.theta: {.*}")
    expected = mk.loads(swept.sub(law, original).replace("angle: deg", "angle: rad")).analyze()
    for i in range(1, 8):
        for suffix in ("", "_dot", "_ddot"):
            name = f"J{i}.theta{suffix}"
            np.testing.assert_allclose(found[name], expected[name], rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize(
    ("types", "driven"),
    [("RRRRRRR", "J1.theta"), ("RCHCR", "J1.theta"), ("PCRCH", "J1.s"), ("CRCC", "J2.theta")],
)
def test_rows_with_the_coordinates_multiply_to_the_identity(types: str, driven: str) -> None:
    with mp.workdps(40):
        joints = list(SEVEN["joints"].values())[: len(types)]
        rows = rows_of([(j["point"], j["axis"]) for j in joints])
    step = f"{driven}: {{from: 0, to: 0.1, count: 3}}"
    analysis = mk.loads(chain_file(rows, types, step)).analyze()
    assert analysis.result.complete
    for k in range(analysis.rows):
        moved = [
            tuple(coordinate(analysis, f"J{i + 1}", q)[k] for q in ("theta", "s"))
            for i in range(len(types))
        ]
        with mp.workdps(40):
            found = frames(rows, moved)
            assert mp.norm(found[-1] - mp.eye(4), mp.inf) < 1e-13
        for i, frame in enumerate(found[:-1], start=1):
            for name, column in ((f"J{i}.axis", 2), (f"J{i}.point", 3)):
                expected = [float(frame[r, column]) for r in range(3)]
                np.testing.assert_allclose(analysis[name][k], expected, rtol=0, atol=2e-13)


def coordinate(analysis: Analysis, joint: str, name: str) -> np.ndarray:
    """A coordinate over the rows, zero where the joint has none."""
    full = f"{joint}.{name}"
    return analysis[full] if full in analysis.model.quantities else np.zeros(analysis.rows)


def test_a_drawing_that_is_not_assembled_closes_elsewhere() -> None:
    rows = [row._replace(theta=mp.mpf(0)) for row in ROWS]
    analysis = mk.loads(chain_file(rows, "R" * 7, "J1.theta: {at: 3.1}")).analyze()
    assert analysis.result.complete
    moved = [(analysis[f"J{i}.theta"][0], 0.0) for i in range(1, 8)]
    with mp.workdps(40):
        assert mp.norm(frames(rows, moved)[-1] - mp.eye(4), mp.inf) < 1e-13


def test_links_of_a_chain_may_carry_mass_and_more_joints() -> None:
    more = """\
links: {L2: {mass: 1, center_of_mass: [1, 0, 0]}, arm: {}}
joints: {K: {type: R, links: [L2, arm], point: [1, 0, 0], axis: [0, 0, 1]}}
points: {p: {link: L3, at: [1, 2, 3]}}
loads: [{type: force, link: arm, point: [1, 0, 0], force: [1, 0, 0]}]
"""
    model = mk.loads(chain_file(ROWS, "R" * 7, "J1.theta: {at: 0}, K.theta: {at: 0}", more))
    assert list(model.problem.mechanism.links) == ["L2", "arm", "L1", "L3", "L4", "L5", "L6"]
    assert model.problem.mechanism.links["L2"].mass > 0
    assert np.isfinite(model.analyze()["J1.effort"]).all()
    assert model.analyze()["p.position"][0] == pytest.approx([1, 2, 3], rel=1e-14)


FILE = """\
format: 1
links: {two: {}}
chain:
  - {joint: A, type: R, link: one, alpha: 40 deg, a: 1}
  - {joint: B, type: C, link: two, alpha: 50, a: 1.1}
  - {joint: C, type: C, link: three, alpha: 60, a: 1.2}
  - {joint: D, type: C, link: ground, alpha: 70, a: 1.3}
motion: {inputs: {A.theta: {at: 5}}}
"""

BAD = [
    ("link: ground", "link: »four", "open-chain", "the last row closes the loop: link: ground"),
    ("link: three", "link: »ground", "chain-ends-early", "before its last row (4)"),
    ("link: three", "link: »two", "chain-crosses-itself", "comes through link two twice"),
    ("link: three", "link: »one", "name-clash", "the name one is already used in chain"),
    ("link: three", "link: »A", "name-clash", "the name A is already used in chain"),
    ("link: three", "link: »sin", "reserved-name", "the name sin is reserved"),
    ("a: 1.1", "a: »1 deg", "expression", "expected a length, found an angle"),
    ("alpha: 50", "alpha: »50 mm", "expression", "expected an angle, found a length"),
    ("alpha: 50", "theta: »P", "expression", "nothing named P"),
    ("type: C, link: two", "type: H, lead: »0, link: two", "zero-lead", "the lead is zero"),
    ("{A.theta: {at: 5}}", "{»A.s: {at: 5}}", "unknown-coordinate", "type R and has no coordinate"),
    ("links: {two: {}}", "links: {two: {}, »left: {}}", "disconnected-link", "left is not joined"),
    (
        "motion: {inputs: {A.theta: {at: 5}}}",
        "points: {p: {link: »onne, at: [0, 0, 0]}}",
        "unknown-link",
        "did you mean one?",
    ),
]


@pytest.mark.parametrize("bad", BAD, ids=[f"{bad[2]} {bad[1]}" for bad in BAD])
def test_bad_chains(bad: tuple[str, ...]) -> None:
    old, new, code, *words = bad
    assert mk.loads(FILE).analyze().result.complete
    marked = FILE.replace(old, new)
    before = marked[: marked.index("»")]
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(marked.replace("»", ""), "bad.yaml")
    (error,) = caught.value.diagnostics
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    assert str(error).startswith(f"bad.yaml:{line}:{column}: error: "), str(error)
    assert error.code == code
    assert all(word in str(error) for word in words), str(error)


def test_a_chain_of_one_row_is_no_loop() -> None:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads("format: 1\nchain:\n  - {joint: A, type: R, link: ground}\n", "bad.yaml")
    (error,) = caught.value.diagnostics
    assert str(error).startswith("bad.yaml:3:5: error: a chain of one row joins ground to itself")


def test_a_chain_that_nothing_drives_is_told_at_its_row() -> None:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(FILE.split("motion:")[0], "bad.yaml").analyze()
    (error,) = caught.value.diagnostics
    assert error.code == "undriven-freedom"
    assert error.place is not None
    assert error.place.line in range(4, 8)
