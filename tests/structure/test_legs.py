"""Legs against closed forms and against the same mechanisms without idle freedoms.

A universal joint in place of one sphere takes the idle freedom away and leaves everything else as
it is, if the leg has no inertia about its line; such a mechanism is solved without any leg.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpmath import mp, mpf

import mechkin_cli as mk

RSSR = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links:
  crank: {mass: 1, center_of_mass: [20, 5, 0], inertia: {xx: 100, yy: 200, zz: 300}}
  coupler: {mass: 2, center_of_mass: [90, 50, 30], inertia: {xx: 1360, yy: 1360, zz: 2000,
    xy: -1000, xz: -600, yz: -600}}
  rocker: {mass: 1.5, center_of_mass: [150, 60, 60], inertia: {xx: 300, yy: 200, zz: 500}}
joints:
  O1: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  O2: {type: S, links: [crank, coupler], point: [40, 0, 0]}
  O3: LAST
  O4: {type: R, links: [ground, rocker], point: [160, 0, 60], axis: [0.3, 0, 1]}
points: {c: {link: coupler, at: [90, 50, 30]}}
motion: {inputs: {O1.theta: {from: FROM, to: TO, step: 10, rate: 2, acceleration: 1}}}
loads: [{type: gravity, g: [100, 0, -9810]}, {type: torque, joint: O4, value: 100},
  {type: force, link: coupler, point: [65, 25, 15], force: [3, -2, 1]}]
"""
SPHERES = ("{type: S, links: [coupler, rocker], point: [140, 100, 60]}", 1.0)
TURNED = ("{type: S, links: [rocker, coupler], point: [140, 100, 60]}", -1.0)
UNIVERSAL = (
    "{type: U, links: [coupler, rocker], point: [140, 100, 60], axis: [1, 0, 1], axis2: [0, 1, 0]}"
)


def rssr(last: str, first: float = 0, final: float = 360) -> mk.Model:
    text = RSSR.replace("LAST", last).replace("FROM", str(first)).replace("TO", str(final))
    return mk.loads(text)


def rocker_angle(theta: float) -> tuple[mpf, mpf]:
    """The two rocker angles at a crank angle in degrees, from |O2 O3|^2 = L^2 (40 digits).

    With the axis k through O4, O3 = O4 + a + b cos + c sin, so A cos + B sin = C.
    """
    with mp.workdps(40):
        t = mp.radians(theta)
        crank = [40 * mp.cos(t), 40 * mp.sin(t), mpf(0)]
        pivot = [mpf(160), mpf(0), mpf(60)]
        k = [mpf("0.3"), mpf(0), mpf(1)]
        k = [x / mp.norm(k) for x in k]
        arm = [mpf(-20), mpf(100), mpf(0)]
        along = [sum(x * y for x, y in zip(arm, k, strict=True)) * x for x in k]
        cosine = [x - y for x, y in zip(arm, along, strict=True)]
        sine = [
            k[1] * arm[2] - k[2] * arm[1],
            k[2] * arm[0] - k[0] * arm[2],
            k[0] * arm[1] - k[1] * arm[0],
        ]
        fixed = [p + a - q for p, a, q in zip(pivot, along, crank, strict=True)]
        square = mpf(100) ** 2 + 100**2 + 60**2
        first = 2 * sum(x * y for x, y in zip(fixed, cosine, strict=True))
        second = 2 * sum(x * y for x, y in zip(fixed, sine, strict=True))
        rest = square - sum(x * x for x in fixed) - sum(x * x for x in cosine)
        middle = mp.atan2(second, first)
        half = mp.acos(rest / mp.sqrt(first**2 + second**2))
        return mp.degrees(middle + half), mp.degrees(middle - half)


@pytest.mark.parametrize("last", [SPHERES[0], TURNED[0]])
def test_rssr_against_its_closed_form(last: str) -> None:
    result = rssr(last).analyze()
    for theta, found in zip(result["O1.theta"], result["O4.theta"], strict=True):
        misses = [abs(float(exact - mpf(float(found)))) for exact in rocker_angle(float(theta))]
        assert min(m % 360 for m in misses) < 1e-12
    assert set(result["row.status"]) == {"ok"}


@pytest.mark.parametrize(("last", "sign"), [SPHERES, TURNED])
def test_a_leg_carries_what_a_coupler_without_idle_freedom_carries(last: str, sign: float) -> None:
    leg, whole = rssr(last).analyze(), rssr(UNIVERSAL).analyze()
    for name in (
        "O4.theta_dot",
        "O4.theta_ddot",
        "c.position",
        "c.velocity",
        "c.acceleration",
        "O1.effort",
        "O1.force",
        "O1.moment",
        "O2.force",
        "O4.force",
        "O4.moment",
        "ground.shaking_force",
        "ground.shaking_moment",
    ):
        assert np.abs(leg[name] - whole[name]).max() <= 2e-12 * np.abs(whole[name]).max(), name
    assert np.abs(sign * leg["O3.force"] - whole["O3.force"]).max() < 1e-10
    assert leg["row.power_error"].max() < 1e-14


def test_the_leg_does_not_spin() -> None:
    result = rssr(SPHERES[0]).analyze()
    line = result["O3.point"] - result["O2.point"]
    along = (result["coupler.omega"] * line).sum(axis=1) / 150
    assert np.abs(along).max() < 1e-14 * np.abs(result["coupler.omega"]).max() * 150
    codes = [d.code for d in result.model.analyze(["coupler.omega"]).diagnostics]
    assert codes == ["conventional"]


def test_dead_centre_of_a_leg() -> None:
    """A rocker that is driven beyond its reach stops where the discriminant vanishes."""
    text = RSSR.replace("LAST", SPHERES[0]).replace("O1.theta: {from: FROM", "O4.theta: {from: 0")
    result = mk.loads(text.replace("TO", "80")).analyze([])
    (note,) = [d for d in result.diagnostics if d.code == "dead-centre"]
    assert note.measured is not None
    limit = float(note.measured.split("=")[1].split()[0])
    grid = [float(rocker_angle(t / 50)[k]) for t in range(18000) for k in (0, 1)]
    nearest = min(grid, key=lambda angle: abs(angle - limit))
    assert abs(nearest - limit) < 1e-4
    # beyond the limit no crank angle reaches that rocker angle
    assert not any(limit + 1e-4 < angle < limit + 2 for angle in grid)


def platform(universal: bool) -> str:
    lines = [
        "format: 1",
        "links:",
        "  platform: {mass: 20, center_of_mass: [0.02, 0, 1.05], inertia: {xx: 2, yy: 2, zz: 4}}",
    ]
    joints, inputs = ["joints:"], ["motion:", "  inputs:"]
    for k in range(6):
        a = math.radians(120 * (k // 2) + (12 if k % 2 else -12))
        b = math.radians(120 * ((k + 1) // 2) - 60 + (-10 if k % 2 else 10))
        foot = [round(math.cos(a), 3), round(math.sin(a), 3), 0.0]
        head = [round(0.6 * math.cos(b), 3), round(0.6 * math.sin(b), 3), 1.0]
        axis = [round(h - f, 12) for h, f in zip(head, foot, strict=True)]
        low, high = ([f + u * a for f, a in zip(foot, axis, strict=True)] for u in (0.3, 0.6))
        lines += [f"  tube{k}: {{mass: 1, center_of_mass: {low}}}"]
        lines += [f"  rod{k}: {{mass: 2, center_of_mass: {high}}}"]
        kind = "S" if not universal else "U"
        axes = "" if not universal else ", axis: [1, 0, 0.1], axis2: [0, 1, 0]"
        joints += [f"  A{k}: {{type: {kind}, links: [ground, tube{k}], point: {foot}{axes}}}"]
        joints += [f"  L{k}: {{type: P, links: [tube{k}, rod{k}], point: {foot}, axis: {axis}}}"]
        joints += [f"  B{k}: {{type: S, links: [rod{k}, platform], point: {head}}}"]
        to = [0.2, 0.1, -0.1, 0.15, 0.05, 0.12][k]
        inputs += [f"    L{k}.s: {{from: 0, to: {to}, count: 9, rate: {to}, acceleration: 0.1}}"]
    points = ["points: {tool: {link: platform, at: [0, 0.1, 1.2]}}"]
    loads = ["loads: [{type: gravity, g: [0, 0, -9.81]}]"]
    return "\n".join(lines + joints + points + inputs + loads)


def test_a_platform_on_six_legs_is_one_block_of_six() -> None:
    model = mk.loads(platform(universal=False))
    assert [(b.equations, len(b.unknowns)) for b in model.graph.blocks] == [(6, 6)]


def test_a_platform_against_the_one_on_universal_joints() -> None:
    leg = mk.loads(platform(universal=False)).analyze()
    whole = mk.loads(platform(universal=True)).analyze()
    names = ["tool.position", "tool.velocity", "tool.acceleration", "platform.alpha"]
    names += [f"{joint}{k}.force" for joint in "ALB" for k in range(6)]
    names += [f"L{k}.effort" for k in range(6)]
    for name in names:
        assert np.abs(leg[name] - whole[name]).max() <= 1e-11 * np.abs(whole[name]).max(), name


def test_a_passive_telescope_carries_its_spring_alone() -> None:
    """A strut between the rocker and ground: the force of its spring along its line, no more."""
    text = RSSR.replace("LAST", SPHERES[0]).replace("FROM", "0").replace("TO", "90")
    text = text.replace("links:\n", "links:\n  tube: {}\n  rod: {}\n", 1)
    text = text.replace(
        "joints:\n",
        "joints:\n"
        "  F: {type: S, links: [ground, tube], point: [200, 150, 0]}\n"
        "  Q: {type: P, links: [rod, tube], point: [200, 150, 0], axis: [60, 50, -60]}\n"
        "  G: {type: S, links: [rocker, rod], point: [140, 100, 60]}\n",
        1,
    ).replace("loads: [", "loads: [{type: spring, joint: Q, coordinate: s, stiffness: 3}, ")
    result = mk.loads(text).analyze()
    line = result["G.point"] - np.array([200.0, 150.0, 0.0])
    length = np.sqrt((line * line).sum(axis=1))
    stretch = length - math.sqrt(60**2 + 50**2 + 60**2)
    # Q.s moves the tube towards (60, 50, -60), away from the rod: it grows with the length
    assert np.abs(result["Q.s"] - stretch).max() < 1e-12
    tension = (3 * stretch / length)[:, None] * line
    assert np.abs(result["F.force"] + tension).max() < 1e-11
    assert np.abs(result["G.force"] - tension).max() < 1e-11


LOADED = {
    "its mass centre": ("[90, 50, 30]", "[90, 50, 35]", "mass centre of coupler lies off"),
    "its inertia": ("xx: 1360", "xx: 1400", "inertia of coupler is not symmetric"),
    "a force": ("point: [65, 25, 15]", "point: [65, 25, 20]", "a force acts on coupler off"),
}


@pytest.mark.parametrize("case", LOADED)
def test_a_leg_that_would_spin_is_refused(case: str) -> None:
    old, new, words = LOADED[case]
    text = RSSR.replace("LAST", SPHERES[0]).replace("FROM", "0").replace("TO", "360")
    assert text.count(old) >= 1
    text = text.replace(old, new, 1)
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    (error,) = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert error.code == "loaded-spin"
    assert error.place is not None
    assert error.place.line == (RSSR[: RSSR.index("  coupler:")].count("\n") + 1)
    for word in (words, "spins freely about O2-O3"):
        assert word in error.message
    assert "replace one S by U" in (error.hint or "")
    positions = text + "tables: [{name: t, columns: [O4.theta]}]\n"
    assert mk.loads(positions).analyze(["O4.theta"]).result.complete


def test_held_spin_is_held_by_the_moment_of_the_weight() -> None:
    """At rest: the moment about the line of the weight at a mass centre off it."""
    text = RSSR.replace("LAST", SPHERES[0]).replace("FROM", "0").replace("TO", "0")
    text = text.replace("rate: 2, acceleration: 1", "rate: 0").replace(
        "[90, 50, 30]", "[90, 50, 35]"
    )
    result = mk.loads(text + "idle: hold\n").analyze(["coupler.holding_moment"])
    line = np.array([100.0, 100.0, 60.0])
    weight = 2 * np.array([100.0, 0.0, -9810.0])
    moment = np.cross(np.array([0.0, 0.0, 5.0]), weight / 1000) @ line / np.sqrt(line @ line)
    assert result["coupler.holding_moment"] == pytest.approx(-moment, rel=1e-13)
    assert [d.code for d in result.diagnostics].count("held-spin") == 1
