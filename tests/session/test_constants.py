"""Constants of plans as the text says them: against another reader of the files, and against the
tapes evaluated at 80 digits."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from oracle.numerics import mp as oracle
from oracle.reader import read
from references import FILE_OF
from session.tapes import STEMS, model, mp, true_outputs

import mechkin_cli as mk
from mechkin_cli.model.model import Model
from mechkin_cli.plan.plan import plan_records
from mechkin_cli.plan.records import flatten
from mechkin_cli.session.double_double import Precise
from mechkin_cli.tape.decimals import double_doubles, enclosures

TWO_PARTS = mp.mpf(2) ** -104

CRANK = """
format: 1
units: {length: mm}
parameters: {r: 31.1 mm, tilt: 12.3 deg}
links: {crank: {mass: 0.7, center_of_mass: [10.1, 0, 0]}, rod: {}, block: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [sin(tilt), 0, cos(tilt)]}
  B: {type: S, links: [crank, rod], point: [r, 0, 0]}
  C: {type: S, links: [rod, block], point: [97.3, 1, 2]}
  D: {type: P, links: [ground, block], point: [97.3, 1, 2], axis: [1, 0.1, 0]}
motion:
  inputs: {A.theta: {from: 0, to: 30, step: 10}}
"""


ALONG_Z = ("R", "P", "C", "H")
"""Joints whose frames have the written axis as z on both links."""


def constants_of(text: str) -> Any:
    made = mk.loads(text)
    return made.session.precise.constants(made.session)


def exactly(pairs: Any) -> list[Any]:
    return [mp.mpf(high) + mp.mpf(low) for high, low in pairs]


def in_doubles(one: Model) -> Any:
    session = one.session
    size = session.layout.mechanism.box_diagonal()
    return np.array(flatten(plan_records(session.layout, size)))


def as_read(one: Precise, stem: str) -> list[tuple[Any, Any]]:
    """Numbers of the recording, with what the oracle's reader finds, in SI."""
    with oracle.workdps(80):
        try:
            known = read(FILE_OF[stem])
        except (NotImplementedError, KeyError) as error:
            pytest.skip(f"the oracle does not read {error}")
        length, mass, _ = (oracle.mpf(x.numerator) / x.denominator for x in known.units._base)
        pairs: list[tuple[Any, Any]] = []

        def from_datum(place: Any) -> list[Any]:
            datum = one.problem.mechanism.datum
            return [x * length - oracle.mpf(d) for x, d in zip(place, datum, strict=True)]

        for name, link in known.links.items():
            own = one.problem.mechanism.links[name]
            pairs.append((own.mass, link.mass * mass))
            if link.mass:
                pairs += zip(own.center_of_mass, from_datum(link.mass_centre), strict=True)
        for name, joint in known.joints.items():
            drawn = one.problem.mechanism.joints[name]
            frames = (drawn.on_first, drawn.on_second)
            if drawn.type.has_point:
                for frame, point in zip(frames, joint.points, strict=True):
                    pairs += zip(frame.o, from_datum(point), strict=True)
            if joint.type in ALONG_Z:
                for frame, axis in zip(frames, joint.axes, strict=True):
                    pairs += zip(frame.z, axis, strict=True)
            if joint.lead is not None:
                pairs.append((drawn.lead, joint.lead * length))
        return [(number, mp.mpf(oracle.in_mpmath(oracle.mpf(value)))) for number, value in pairs]


@pytest.mark.parametrize("stem", STEMS)
def test_numbers_are_those_of_another_reader(stem: str) -> None:
    one = model(stem).precise
    pairs = as_read(one, stem)
    found = exactly(double_doubles(one.tape([number for number, _ in pairs])))
    for value, (_, true) in zip(found, pairs, strict=True):
        assert abs(value - true) <= TWO_PARTS * max(abs(true), mp.mpf(1) / 16)


@pytest.mark.parametrize("stem", STEMS)
def test_constants_are_right_to_both_parts(stem: str) -> None:
    session = model(stem).session
    one = session.precise
    tape = one.tape(one._constants(session))
    found, boxes = double_doubles(tape), enclosures(tape)
    for value, box, true in zip(exactly(found), boxes, true_outputs(tape), strict=True):
        high, low, radius = map(mp.mpf, box.tolist())
        assert abs(value - true) <= TWO_PARTS * abs(true) + mp.mpf(10) ** -55
        assert abs(high + low - true) <= radius <= TWO_PARTS * max(abs(true), 1)


@pytest.mark.parametrize("stem", STEMS)
def test_doubles_of_the_recording_are_those_of_the_plan(stem: str) -> None:
    session = model(stem).session
    one = session.precise
    recorded = [getattr(x, "recorded", x) for x in one._constants(session)]
    assert np.array(recorded).tobytes() == in_doubles(model(stem)).tobytes()


@pytest.mark.parametrize("stem", STEMS)
def test_no_rounded_number_stands_for_itself(stem: str) -> None:
    """What a tape takes as it is comes from no rounding: it has few bits."""
    session = model(stem).session
    one = session.precise
    plain = one.tape(one._constants(session)).tape.constants
    size = session.layout.mechanism.box_diagonal()
    long = [x for x in plain if x != size and (x * 2.0**20) % 1.0]
    assert [x for x in long if Fraction(x).numerator.bit_length() > 20] == []


def test_one_constant_is_the_next_double_for_a_wrong_literal() -> None:
    """The checks above see a literal that is read as its double."""
    one = mk.loads(CRANK)
    tape = one.precise.tape([one.precise.problem.parameters["r"].value])
    wrong = tape._replace(numbers=tuple(Fraction(float(x)) for x in tape.numbers))
    true = mp.mpf("31.1") / 1000
    assert abs(exactly(double_doubles(tape))[0] - true) <= TWO_PARTS * true
    assert abs(exactly(double_doubles(wrong))[0] - true) > 1e-18


SAME = [
    ("31.1 mm", "0.0311 m"),
    ("31.1 mm", "3.11e-2 m"),
    ("31.1 mm", "(0.0311 m)"),
    ("r: 31.1 mm", "q: 62.2 mm, r: q/2"),
    ("12.3 deg", "12.3*pi/180*1 rad"),
    ("12.3 deg", "738 arcmin"),
    ("[r, 0, 0]", "[31.1, 0, 0]"),
    ("10.1, 0, 0", "sqrt(102.01 mm^2), 0, 0"),
    ("10.1, 0, 0", "10.1 mm, 0 m, 0 in"),
    ("mass: 0.7", "mass: 700 g"),
    ("[1, 0.1, 0]", "[10, 1, 0]"),
]


@pytest.mark.parametrize(("old", "new"), SAME)
def test_same_meaning_same_numbers(old: str, new: str) -> None:
    assert old in CRANK
    found, other = exactly(constants_of(CRANK)), exactly(constants_of(CRANK.replace(old, new)))
    for a, b in zip(found, other, strict=True):
        assert abs(a - b) <= mp.mpf(10) ** -31 * max(abs(a), 1)


def test_another_number_is_seen() -> None:
    found = exactly(constants_of(CRANK))
    other = exactly(constants_of(CRANK.replace("31.1 mm", "31.100000000000000000001 mm")))
    assert any(1e-24 < abs(a - b) < 1e-22 for a, b in zip(found, other, strict=True))


def test_set_parameters_are_the_doubles_that_they_are() -> None:
    varied = mk.loads(CRANK).with_parameters({"r": "31.2 mm"})
    anew = mk.loads(CRANK.replace("31.1 mm", "31.2 mm"))
    found = varied.session.precise.constants(varied.session)
    other = anew.session.precise.constants(anew.session)
    assert np.abs(found[:, 0] - other[:, 0]).max() <= 1e-15
    exact = Fraction(varied.problem.parameters["r"].value)
    value = varied.precise.parameters["r"]
    assert Fraction(value[0]) + Fraction(value[1]) == exact


def test_sessions_of_parts_take_their_parts() -> None:
    session = model("rcsr").session
    bare = replace(session.problem.mechanism, loads=())
    other = session.loaded(replace(session.problem, mechanism=bare, load_laws=()))
    found = session.precise.constants(other)
    assert found.shape[0] < session.precise.constants(session).shape[0]


def test_a_part_that_stands_in_no_text_is_refused() -> None:
    session = model("rcsr").session
    mechanism = session.problem.mechanism
    name, link = next(iter(mechanism.links.items()))
    links = {**mechanism.links, name: link._replace(mass=0.1)}
    other = session.loaded(replace(session.problem, mechanism=replace(mechanism, links=links)))
    with pytest.raises(ValueError, match="stands in no text"):
        session.precise.constants(other)
