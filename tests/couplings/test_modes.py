"""Assemblies, ranges, proofs and variants of geared five-bars: wheels on both cranks, whose turns
are whole multiples of one angle, so that all assemblies are roots of one polynomial."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

FIVE_BAR = """
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
parameters: {{far: 4 m}}
assembly: {{turns: 2}}
links:
  a: {{mass: 2, center_of_mass: [0.5, 0], inertia: 0.1}}
  b: {{mass: 3, center_of_mass: [1.5, 1.5], inertia: 0.4}}
  c: {{mass: 1, center_of_mass: [3, 2], inertia: 0.2}}
  d: {{mass: 2, center_of_mass: [4, 0.5], inertia: 0.3}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [a, b], point: [1, 0]}}
  C: {{type: R, links: [b, c], point: [2, 3]}}
  D: {{type: R, links: [d, c], point: [far, 1]}}
  E: {{type: R, links: [ground, d], point: [far, 0]}}
couplings: {{G: {{type: gear, joints: [A, E], teeth: [{teeth[0]}, {teeth[1]}], {more}}}}}
motion: {{inputs: {{{driven}: {{from: 0, to: 0.2, count: 3, rate: 2 rad/s}}}}}}
"""
TEETH = [(20, 30), (20, 20), (20, 40), (30, 20), (30, 40)]


def five_bar(teeth: tuple[int, int], driven: str, more: str = "internal: false") -> mk.Model:
    """With a crank or the joint between the rods driven."""
    return mk.loads(FIVE_BAR.format(teeth=teeth, driven=driven, more=more))


def assemblies(teeth: tuple[int, int], sign: int) -> list[tuple[mp.mpf, mp.mpf]]:
    """Both cranks' angles in all places at which the rods are drawn against each other as at home:
    the distance of their ends is that of the drawing, a polynomial in exp(i tau), of which the
    cranks turn by whole multiples."""
    common = int(np.gcd(*teeth))
    one, other = teeth[1] // common, sign * teeth[0] // common
    # |4 + i z^other - z^one|^2 = |4 + i - 1|^2
    terms: dict[int, mp.mpc] = {0: mp.mpc(16 + 1 + 1 - 10)}
    for power, factor in (
        (other, 4j),
        (-other, -4j),
        (one, -4),
        (-one, -4),
        (other - one, -1j),
        (one - other, 1j),
    ):
        terms[power] = terms.get(power, mp.mpc(0)) + factor
    least, most = min(terms), max(terms)
    given = [terms.get(power, mp.mpc(0)) for power in range(most, least - 1, -1)]
    while given[0] == 0:
        given.pop(0)
    roots = mp.polyroots(given, maxsteps=500, extraprec=200, asc=False)
    taus = [mp.arg(z) for z in roots if abs(abs(z) - 1) < mp.mpf("1e-15")]
    return [(one * tau, other * tau) for tau in taus]


@pytest.mark.parametrize("teeth", TEETH)
@pytest.mark.parametrize("internal", [False, True])
def test_all_assemblies_are_the_roots_of_a_polynomial(
    teeth: tuple[int, int], internal: bool
) -> None:
    """Places whole turns apart are one assembly."""
    if internal and teeth == (20, 20):
        return  # such wheels would lie on one another
    more = "ideal: true, internal: true" if internal else "ideal: true"
    with mp.workdps(30):
        wanted = assemblies(teeth, 1 if internal else -1)
        found = five_bar(teeth, "C.theta", more).modes()
        places = [
            (mode.coordinates["A.theta"], mode.coordinates["E.theta"]) for mode in found.modes
        ]
        assert len(places) == len(wanted)
        for place in places:
            off = [
                max(abs(mp.sin((x - y) / 2)) for x, y in zip(place, one, strict=True))
                for one in wanted
            ]
            assert sum(each < mp.mpf("1e-12") for each in off) == 1


@pytest.mark.parametrize("teeth", TEETH)
def test_cranks_turn_fully_until_both_are_back(teeth: tuple[int, int]) -> None:
    """At a crank both sides of the coupler are modes, which no motion of the cranks joins: 3.8 m
    apart, the distance of the rods' ends is 1.8 to 5.8 m, below their sum and above their
    difference."""
    found = five_bar(teeth, "A.theta").with_parameters({"far": 3.8}).ranges()
    assert len(found.ranges) == 2
    for one in found.ranges:
        assert one.turns == teeth[1] // np.gcd(*teeth)
    assert len(found.circuits) == 2


def test_wheels_of_many_teeth_come_back_after_as_many_turns() -> None:
    found = five_bar((17, 59), "A.theta").with_parameters({"far": 3.8}).ranges()
    assert [one.turns for one in found.ranges] == [59, 59]


@pytest.mark.parametrize("driven", ["A.theta", "C.theta"])
def test_rows_are_proven_and_bounded(driven: str) -> None:
    model = five_bar((20, 30), driven, "pressure_angle: 0.35")
    result = model.analyze()
    assert result.certificate.is_one_branch
    assert np.all(result["row.error_bound"] < 1e-12)
    with mp.workdps(30):
        for row in range(3):
            a, e, c = (mp.mpf(float(result[f"{name}.theta"][row])) for name in "AEC")
            assert abs(a * 2 / 3 + e) < mp.mpf("1e-14")
            ends = abs(4 + 1j * mp.expj(e) - mp.expj(a))
            rods = abs(mp.mpc(1, 3) + mp.mpc(2, -2) * mp.expj(c))
            assert abs(ends - rods) < mp.mpf("1e-13")


def test_variants_and_sensitivities_are_those_of_other_files() -> None:
    model = five_bar((20, 30), "A.theta", "pressure_angle: 0.35")
    names = ["A.effort", "G.torque", "norm(E.force)"]
    varied = model.vary({"far": [3.9, 4.1]}, names)
    text = FIVE_BAR.format(teeth=(20, 30), driven="A.theta", more="pressure_angle: 0.35")

    def alone(far: float) -> mk.Analysis:
        return mk.loads(text.replace("far: 4 m", f"far: {far!r} m")).analyze()

    for k, far in enumerate((3.9, 4.1)):
        for name in names:
            np.testing.assert_allclose(varied[name][k], alone(far)[name], rtol=1e-12)
    found = model.sensitivities(names, ["far"])
    less, more = alone(4.0 - 1e-5), alone(4.0 + 1e-5)
    for name in names:
        slope = (more[name] - less[name]) / 2e-5
        np.testing.assert_allclose(found[name, "far"], slope, rtol=1e-7)
