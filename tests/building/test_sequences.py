"""Sequences of rises and rests: rows against definitions, over time and over an angle; what is said
of their joints."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.building.fields import Fields
from mechkin_cli.building.law_reading import Over, read_law
from mechkin_cli.building.law_shapes import PiecewiseLaw
from mechkin_cli.mechanism.motion import DrivenInput
from mechkin_cli.reading.document import document_from_text
from mechkin_cli.schema import Segment, Sequence
from mechkin_cli.schema.base import section_of
from mechkin_cli.tape import Recorder, Traced, compiled, register
from mechkin_cli.units import ANGLE, LENGTH, UnitSystem

FILE = """format: 1
units: {length: mm, time: ms}
links: {a: {}}
joints: {O: {type: P, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
motion:
  time: {from: 0, to: 1000, step: 20}
  inputs: {O.s: {law: sequence, from: 5, start: 50 ms, segments: [SEGMENTS]}}
"""
SEGMENTS = (
    "{for: 200, to: 25, law: 3-4-5}, {for: 0.1 s, law: dwell}, {for: 170, to: 1, law: 3-4-5}, "
    "{for: 130, law: dwell}, {for: 100, to: 5, law: cycloidal}"
)


def loaded(segments: str, old: str = "", new: str = "") -> mk.Model:
    return mk.loads(FILE.replace("SEGMENTS", segments).replace(old, new))


def driven(model: mk.Model) -> DrivenInput:
    return model.problem.motion.inputs[0]


def powers(u: Any) -> Any:
    return 10 * u**3 - 15 * u**4 + 6 * u**5


def cycloid(u: Any) -> Any:
    return u - mp.sin(2 * mp.pi * u) / (2 * mp.pi)


def true_value(t: Any) -> Any:
    """The sequence of the file in mm, with t in ms."""
    for begin, end, low, high, shape in (
        (50, 250, 5, 25, powers),
        (350, 520, 25, 1, powers),
        (650, 750, 1, 5, cycloid),
    ):
        if t < begin:
            return mp.mpf(low)
        if t <= end:
            return low + (high - low) * shape((t - begin) / mp.mpf(end - begin))
    return mp.mpf(5)


def test_rows_of_a_sequence() -> None:
    model = loaded(SEGMENTS)
    assert [d for d in model.diagnostics if d.severity != "error"] == []
    found = driven(model).written_orders
    peaks = 20, 20 * 1.875 / 200, 100, 100
    with mp.workdps(40):
        for k in range(51):
            t = mp.mpf(20 * k)
            assert abs(found[0, k] - true_value(t)) <= 4e-15 * peaks[0]
            joints = (50, 250, 350, 520, 650, 750)
            if t in joints:
                continue
            # rates of lengths are in mm/ms
            series = mp.taylor(true_value, t, 3)
            for n, peak in ((1, 0.19), (2, 4 * 6.3 / 100**2), (3, 4 * 40 / 100**3)):
                assert abs(found[n, k] - series[n] * mp.factorial(n)) <= 1e-14 * peak, (t, n)


def test_exact_rows_of_a_sequence() -> None:
    """In double-double, as proofs and bounds of errors take them."""
    session = loaded(SEGMENTS).session
    values = session.precise.inputs(session).values[0] * session.layout.length
    with mp.workdps(40):
        for k in range(51):
            found = (mp.mpf(values[0, k]) + mp.mpf(values[1, k])) * 1000
            assert abs(found - true_value(mp.mpf(20 * k))) <= mp.mpf(10) ** -28


def test_ends_and_rests_are_exact() -> None:
    found = driven(loaded(SEGMENTS, "step: 20", "step: 10")).written_orders
    assert set(found[0, :6]) == {5.0}
    assert set(found[0, 25:36]) == {25.0}
    assert set(found[0, 52:66]) == {1.0}
    assert set(found[0, 75:]) == {5.0}
    for k in (slice(0, 6), slice(25, 36), slice(52, 66), slice(75, 101)):
        assert not found[1, k].any()


def test_a_joint_belongs_to_the_later_segment_whatever_sums_round_to() -> None:
    """0.1 + 0.1 + 0.1 is not the row's own 0.3."""
    segments = ", ".join(
        f"{{for: 0.1, to: {5 + 10 * (k % 2)}, law: harmonic}}" for k in range(1, 10)
    )
    text = (
        FILE.replace("SEGMENTS", segments).replace(", time: ms", "").replace("start: 50 ms, ", "")
    )
    found = driven(mk.loads(text.replace("to: 1000, step: 20", "to: 1, step: 0.1"))).written_orders
    peak = np.pi**2 / 2 * 10 / 0.1**2
    begins = [1.0 if k % 2 else -1.0 for k in range(1, 10)]
    assert found[2, :9] == pytest.approx(peak * np.array(begins), rel=1e-13)
    assert found[2, 9:] == pytest.approx([-peak, 0.0], rel=1e-13)


SAID = [
    (
        "{for: 200, to: 25, law: constant-rate}, {for: 100, law: dwell}",
        "warning: the rate of this sequence jumps at 50 ms, the largest of 2 such jumps: "
        "0.1 mm/ms; forces are infinite there",
    ),
    (
        "{for: 200, to: 25, law: cycloidal}, {for: 100, to: 5, law: harmonic}",
        "note: the acceleration of this sequence jumps at 250 ms, the largest of 2 such jumps: "
        "0.0098696 mm/ms^2; cycloidal, 3-4-5",
    ),
    ("{for: 300, to: 25, law: modified-trapezoid}, {for: 100, to: 5, law: modified-sine}", ""),
    ("{for: 300, to: 25, law: 4-5-6-7}, {for: 100, law: dwell}, {for: 9, to: 5, law: 3-4-5}", ""),
    ("{for: 2, law: dwell}, {for: 300, to: 25, law: cycloidal}", ""),
]


@pytest.mark.parametrize(("segments", "words"), SAID)
def test_jumps_at_joints_are_said(segments: str, words: str) -> None:
    said = [str(d) for d in loaded(segments).diagnostics]
    assert len(said) == bool(words)
    assert all(text.startswith(f"text:7:66: {words}") for text in said), said


def test_what_comes_before_the_first_moment_is_no_joint() -> None:
    model = loaded("{for: 1 s, to: 25, law: harmonic}", "start: 50 ms, ", "")
    assert [str(d) for d in model.diagnostics] == []


BAD = [
    ("{for: 0, to: 3, law: harmonic}", "no-duration", "a segment has a positive extent: 0 ms"),
    ("{for: 10 mm, to: 3, law: harmonic}", "expression", "expected a time, found a length"),
    ("{for: 10, to: 3 s, law: harmonic}", "expression", "expected a length, found a time"),
    ("{for: 10, law: harmonic}", "missing-key", "add to: the value at its end"),
    ("{for: 10, to: 4, law: dwell}", "dwell-to", "a dwell stays where it is"),
    ("{for: 10, to: 4, law: spline}", "unknown-word", "cycloidal"),
    ("{duration: 10, to: 4, law: harmonic}", "unknown-key", "write for: 0.2 s"),
    ("{from: 2, for: 10, to: 4, law: harmonic}", "unknown-key", "where the one before ends"),
    ("", "wrong-length", "found 0 entries, expected at least 1"),
]


@pytest.mark.parametrize(("segments", "code", "words"), BAD)
def test_bad_segments(segments: str, code: str, words: str) -> None:
    with pytest.raises(mk.InvalidFile) as caught:
        loaded(segments)
    found = [d for d in caught.value.diagnostics if d.code == code]
    assert found, caught.value
    assert found[0].place is not None
    assert found[0].place.line == 7
    assert any(words in str(d) for d in found), caught.value


def over_a_turn(*segments: tuple[str, str, str | None], start: str | None = None) -> Any:
    """A law of mm over an angle in SI, and what is said of it."""
    fields = Fields(
        document_from_text("law: {segments: []}", "text"), UnitSystem.from_mapping({"length": "mm"})
    )
    listed = tuple(
        section_of(Segment, **{"for": extent, "law": law, "to": to}) for extent, law, to in segments
    )
    law = section_of(Sequence, law="sequence", start=start, segments=listed)
    found = read_law(fields, ("law",), law, LENGTH, Over(ANGLE, 0.0, in_si=True))
    return found, "\n".join(map(str, fields.diagnostics))


CAM = (("60 deg", "cycloidal", "20"), ("90 deg", "dwell", None), ("120 deg", "3-4-5", "0"))


def lift(degrees: Any) -> Any:
    """The cam in m, over any turns, begun at 30 deg."""
    t = (degrees - 30) % 360
    if t < 60:
        return mp.mpf(20) / 1000 * cycloid(t / mp.mpf(60))
    if t < 150:
        return mp.mpf(20) / 1000
    return mp.mpf(20) / 1000 * (1 - powers((t - 150) / mp.mpf(120))) if t < 270 else mp.mpf(0)


def test_a_sequence_over_a_turn_repeats_itself() -> None:
    law, said = over_a_turn(*CAM, ("90 deg", "dwell", None), start="30 deg")
    assert said == ""
    assert isinstance(law, PiecewiseLaw)
    assert law.period == pytest.approx(2 * np.pi, rel=1e-15)
    degrees = np.arange(-777.25, 800.0, 10.5)
    found = law.orders(np.radians(degrees))
    with mp.workdps(40):
        for k, at in enumerate(np.radians(degrees)):
            exact = lambda x: lift(180 * x / mp.pi)  # noqa: E731
            series = mp.taylor(exact, mp.mpf(at), 3)
            for n, peak in enumerate((0.02, 0.04, 0.12, 0.7)):
                assert abs(found[n, k] - series[n] * mp.factorial(n)) <= 4e-14 * peak, (at, n)


def test_one_tape_holds_for_all_pieces_and_turns() -> None:
    law, _ = over_a_turn(*CAM, ("90 deg", "dwell", None), start="30 deg")
    first = law.constants(0.0)
    recorder = Recorder([f"c{k}" for k in range(1 + len(first))], [0.0, *first])
    at, *constants = [Traced(recorder, k) for k in range(1 + len(first))]
    tape = compiled(recorder.tape([register(recorder, law.value(at, constants))], guarded=False))
    degrees = np.arange(-777.25, 800.0, 10.5)
    given = np.array([[x, *law.constants(float(x))] for x in np.radians(degrees)]).T.copy()
    found = tape.replay(given, 0)[0][:, 0]
    true = [float(lift(180 * mp.mpf(x) / mp.pi)) for x in np.radians(degrees)]
    assert found == pytest.approx(true, abs=4e-16)


def test_a_part_of_a_turn_rests_outside() -> None:
    law, said = over_a_turn(*CAM)
    assert said == ""
    assert law.period is None
    assert law.orders(np.radians([-90.0, 300.0, 500.0]))[0].tolist() == [0.0, 0.0, 0.0]


def test_what_is_wrong_with_a_turn_is_said() -> None:
    _, said = over_a_turn(*CAM, ("91 deg", "dwell", None))
    assert "the segments span more than a turn: 361 deg" in said
    _, said = over_a_turn(*CAM[:2], ("210 deg", "3-4-5", "4"))
    assert "after a turn the sequence does not end where it began: 4 mm; write to: 0 in" in said
