"""The example of the page on friction against the closed form of a press whose guide rubs."""

from math import asin, cos, radians, sin, tan

import pytest
from documents.reading import blocks, page

import mechkin_cli as mk


def test_the_guide_of_the_press() -> None:
    """The rod at an angle phi presses N = (F + mu N) tan(phi) on the guide, whose friction the
    crank feels through the rod: torque = (F + mu N) r sin(theta + phi)/cos(phi)."""
    (text,) = blocks(page("docs/friction.md"), "yaml")
    found = mk.loads(text, "friction.yaml").analyze()
    force, mu, crank, rod, rate = 100.0, 0.1, 40.0, 120.0, 20.0
    for row, degrees in enumerate(range(30, 151, 30)):
        theta = radians(degrees)
        phi = asin(crank * sin(theta) / rod)
        normal = force * tan(phi) / (1.0 - mu * tan(phi))
        pushed = force + mu * normal
        arm = crank * sin(theta + phi) / cos(phi)
        assert found["S.normal_load"][row] == pytest.approx(normal, rel=1e-12)
        assert found["S.friction_force.x"][row] == pytest.approx(mu * normal, rel=1e-12)
        assert found["O.effort"][row] == pytest.approx(pushed * arm, rel=1e-12)
        assert found["S.friction_power"][row] == pytest.approx(mu * normal * rate * arm, rel=1e-12)
