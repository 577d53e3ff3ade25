"""Mechanisms with Ss, Sc and Cp, and the same ones built of R, P, U and E with links without mass.

A pin in a slot is two turns with a body between them; the ball in a slotted cylinder hangs by a
Hooke joint from a slider; a cylinder on a plane is a roller on a plate.
"""

from __future__ import annotations

from dataclasses import dataclass

HEAD = """\
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links:
  crank: {mass: 1.5, center_of_mass: [0.2, 0.1, 0.1],
      inertia: {xx: 0.1, yy: 0.2, zz: 0.25, xy: 0.02}}
  rod: {mass: 2, center_of_mass: [0.9, 0.6, 0.2], inertia: {xx: 0.3, yy: 0.4, zz: 0.6, xz: 0.05}}
"""


@dataclass(frozen=True)
class Case:
    """Joints and loads of a mechanism with the pairs under test, and of its equivalent.

    `same` names what must agree beside all motions of links and wrenches of joints with equal
    names: quantity here, quantity there.
    """

    joints: str
    loads: str
    equivalent_joints: str
    equivalent_loads: str
    same: tuple[tuple[str, str], ...]
    more_links: str
    massless: str
    motion: str = "O.theta: {from: -0.25, to: 0.3, count: 12, rate: 2, acceleration: -3}"

    @property
    def text(self) -> str:
        return self._text("", self.joints, self.loads)

    @property
    def equivalent(self) -> str:
        return self._text(self.massless, self.equivalent_joints, self.equivalent_loads)

    def _text(self, links: str, joints: str, loads: str) -> str:
        parts = [HEAD, self.more_links, links, "joints:\n", joints]
        parts.append("loads:\n  - {type: gravity, g: [1, -2, -9]}\n" + loads)
        parts.append("points: {contact: {link: ground, at: [1.5, 0.4, 0.5]}}\n")
        return "".join(parts) + f"motion: {{inputs: {{{self.motion}}}}}\n"


def rates(here: str, there: str) -> list[tuple[str, str]]:
    """A coordinate with its derivatives."""
    return [(here + suffix, there + suffix) for suffix in ("", "_dot", "_ddot")]


CRANK = "  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0.2, 0.1, 1]}\n"
WRENCH = ("force", "moment", "moment_about_origin")
SLOT = "[0.3, -0.5, 1]"
PIN = "[1, 0.6, 0]"

SLOTTED_SPHERE = Case(
    joints=CRANK
    + f"""\
  A: {{type: Ss, links: [crank, rod], point: [0.5, 0, 0.2], slot: {SLOT}, pin: {PIN}}}
  B: {{type: R, links: [rod, rocker], point: [1.5, 1, 0.4], axis: [0.4, 1, 0.3]}}
  D: {{type: Sc, links: [rocker, ground], point: [1.8, 0.1, 0.9],
      axis: [1, 0.2, 0.1], pin: [0.2, 1, 0.6]}}
""",
    loads="""\
  - {type: spring, joint: A, coordinate: theta1, stiffness: 7, free: 0.1}
  - {type: damper, joint: A, coordinate: theta2, damping: 3}
  - {type: force, joint: D, value: 11}
  - {type: spring, joint: D, coordinate: theta1, stiffness: 5, preload: 2}
  - {type: damper, joint: D, coordinate: s, damping: 4}
  - {type: damper, joint: D, coordinate: theta2, damping: 6}
""",
    equivalent_joints=CRANK
    + f"""\
  A1: {{type: R, links: [crank, pin], point: [0.5, 0, 0.2], axis: {SLOT}}}
  A2: {{type: R, links: [pin, rod], point: [0.5, 0, 0.2], axis: {PIN}}}
  B: {{type: R, links: [rod, rocker], point: [1.5, 1, 0.4], axis: [0.4, 1, 0.3]}}
  D1: {{type: P, links: [rocker, slider], point: [1.8, 0.1, 0.9], axis: [1, 0.2, 0.1]}}
  # pin cross axis = (0.1 - 0.12, 0.6 - 0.02, 0.04 - 1)
  D2: {{type: U, links: [slider, ground], point: [1.8, 0.1, 0.9],
      axis: [-0.02, 0.58, -0.96], axis2: [0.2, 1, 0.6]}}
""",
    equivalent_loads="""\
  - {type: spring, joint: A1, coordinate: theta, stiffness: 7, free: 0.1}
  - {type: damper, joint: A2, coordinate: theta, damping: 3}
  - {type: force, joint: D1, value: 11}
  - {type: spring, joint: D2, coordinate: theta1, stiffness: 5, preload: 2}
  - {type: damper, joint: D1, coordinate: s, damping: 4}
  - {type: damper, joint: D2, coordinate: theta2, damping: 6}
""",
    same=(
        *rates("A.theta1", "A1.theta"),
        *rates("A.theta2", "A2.theta"),
        *rates("D.s", "D1.s"),
        *rates("D.theta1", "D2.theta1"),
        *rates("D.theta2", "D2.theta2"),
        ("A.point", "A2.point"),
        ("A.force", "A1.force"),
        ("D.point", "D2.point"),
        ("D.axis", "D1.axis"),
    ),
    more_links="""\
  rocker: {mass: 1, center_of_mass: [1.6, 0.5, 0.5], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
""",
    massless="  pin: {}\n  slider: {}\n",
)

SLOTTED_CYLINDER = Case(
    joints=CRANK
    + """\
  A: {type: Sc, links: [crank, rod], point: [0.5, 0, 0.2], axis: [0.2, 0.3, 1], pin: [1, 0.4, 0]}
  D: {type: Sc, links: [ground, rod], point: [1.5, 0.4, 0.5],
      axis: [0.3, 0.2, 1], pin: [0.2, -0.4, 1]}
""",
    loads="  - {type: force, joint: A, value: -3}\n",
    equivalent_joints=CRANK
    + """\
  A1: {type: P, links: [crank, a], point: [0.5, 0, 0.2], axis: [0.2, 0.3, 1]}
  # pin cross axis = (0.4, -1, 0.3 - 0.08)
  A2: {type: R, links: [a, a2], point: [0.5, 0, 0.2], axis: [0.4, -1, 0.22]}
  A3: {type: R, links: [a2, rod], point: [0.5, 0, 0.2], axis: [1, 0.4, 0]}
  D1: {type: P, links: [ground, d], point: [1.5, 0.4, 0.5], axis: [0.3, 0.2, 1]}
  # pin cross axis = (-0.4 - 0.2, 0.3 - 0.2, 0.04 + 0.12)
  D2: {type: U, links: [d, rod], point: [1.5, 0.4, 0.5],
      axis: [-0.6, 0.1, 0.16], axis2: [0.2, -0.4, 1]}
""",
    equivalent_loads="  - {type: force, joint: A1, value: -3}\n",
    same=(
        *rates("A.s", "A1.s"),
        *rates("A.theta1", "A2.theta"),
        *rates("A.theta2", "A3.theta"),
        *rates("D.s", "D1.s"),
        ("D.theta1", "D2.theta1"),
        ("D.theta2", "D2.theta2"),
        *((f"A.{w}", f"A1.{w}") for w in WRENCH),
        *((f"D.{w}", f"D1.{w}") for w in ("force", "moment_about_origin")),
        ("D.moment", "D2.moment"),
    ),
    more_links="",
    massless="  a: {}\n  a2: {}\n  d: {}\n",
)

CYLINDER_ON_PLANE = Case(
    joints=CRANK
    + """\
  A: {type: C, links: [crank, rod], point: [0.5, 0, 0.2], axis: [0.2, 1, 0.4]}
  D: {type: Cp, links: [rod, ground], point: [1.5, 0.4, 0.5],
      axis: [1, 0.5, 0.2], normal: [-0.2, -0.2, 1.5]}
""",
    loads="""\
  - {type: spring, joint: D, coordinate: x, stiffness: 20, free: 0.05}
  - {type: damper, joint: D, coordinate: y, damping: 5}
  - {type: damper, joint: D, coordinate: theta1, damping: 2}
  - {type: spring, joint: D, coordinate: theta2, stiffness: 3}
""",
    equivalent_joints=CRANK
    + """\
  A: {type: C, links: [crank, rod], point: [0.5, 0, 0.2], axis: [0.2, 1, 0.4]}
  D1: {type: R, links: [rod, roller], point: [1.5, 0.4, 0.5], axis: [1, 0.5, 0.2]}
  # as a plate on the roller: x along axis cross normal = (0.79, -1.54, -0.1)
  D2: {type: E, links: [ground, roller], point: [1.5, 0.4, 0.5],
      normal: [-0.2, -0.2, 1.5], x: [0.79, -1.54, -0.1]}
""",
    equivalent_loads="""\
  - {type: spring, joint: D2, coordinate: x, stiffness: 20, free: -0.05}
  - {type: damper, joint: D2, coordinate: y, damping: 5}
  - {type: damper, joint: D1, coordinate: theta, damping: 2}
  - {type: spring, joint: D2, coordinate: theta, stiffness: 3}
""",
    same=(
        *rates("D.theta1", "D1.theta"),
        *rates("D.theta2", "-D2.theta"),
        *rates("D.x", "-D2.x"),
        *rates("D.y", "-D2.y"),
        ("D.point", "D1.point"),
        ("D.slip", "D1.point - contact.position"),
        ("D.axis", "D1.axis"),
    ),
    more_links="",
    massless="  roller: {}\n",
)

PLATE_ON_CYLINDER = Case(
    joints=CRANK
    + f"""\
  A: {{type: Cp, links: [crank, rod], point: [0.5, 0, 0.2],
      axis: [1, 0.4, 0], normal: [0.2, -0.5, 1.5]}}
  D: {{type: Ss, links: [rod, ground], point: [1.5, 0.4, 0.5], slot: {SLOT}, pin: {PIN}}}
""",
    loads="",
    equivalent_joints=CRANK
    + f"""\
  A1: {{type: R, links: [crank, roller], point: [0.5, 0, 0.2], axis: [1, 0.4, 0]}}
  A2: {{type: E, links: [rod, roller], point: [0.5, 0, 0.2],
      normal: [0.2, -0.5, 1.5], x: [0.6, -1.5, -0.58]}}
  D1: {{type: R, links: [rod, pin], point: [1.5, 0.4, 0.5], axis: {SLOT}}}
  D2: {{type: R, links: [pin, ground], point: [1.5, 0.4, 0.5], axis: {PIN}}}
""",
    equivalent_loads="",
    same=(
        *rates("A.theta1", "A1.theta"),
        *rates("A.theta2", "-A2.theta"),
        *rates("A.x", "-A2.x"),
        *rates("A.y", "-A2.y"),
        *rates("D.theta1", "D1.theta"),
        *rates("D.theta2", "D2.theta"),
        *((f"A.{w}", f"A1.{w}") for w in WRENCH),
        *((f"D.{w}", f"D1.{w}") for w in WRENCH),
    ),
    more_links="",
    massless="  roller: {}\n  pin: {}\n",
)

CASES = {
    "Ss and Sc": SLOTTED_SPHERE,
    "Sc and Sc": SLOTTED_CYLINDER,
    "Cp": CYLINDER_ON_PLANE,
    "Cp and Ss": PLATE_ON_CYLINDER,
}
