"""What a new pair takes: a pin in a straight slot, which the pairs in space lack.

The pin of the second link slides by s along `slot` of the first and turns by theta about `axis`,
which is square to the slot: the pair of slotted links and quick-return mechanisms. Every file that
has to be touched, with the text before which something is put.
"""

from __future__ import annotations

LETTER = "Rg"

KERNEL = """\
// A pin z_B of the second link in a slot of the first along x_A.
struct PinInTrack
    : Pair<Conditions<InPlane<AY>, InPlane<AZ>, ParallelAxes>, Coordinates<Along<AX>, About>> {
  static constexpr char letter[] = "Rg";
};

"""

TABLE = """\
    JointType(
        "Rg",
        (PairStep("P", _X1), PairStep("R")),
        (_length("s", 0, _X1), _angle("theta", 1)),
        Drawing("plane", ("axis", "slot")),
        axis=_Z2,
        closing="Rg",
    ),
"""

SCHEMA = '''\
class PinTrackJoint(PointJoint):
    """Rg: a pin of the second link slides by s along `slot` of the first, turns by theta about
    `axis`."""

    type: Literal["Rg"]
    axis: Direction
    """Axis of the pin, square to the slot."""
    slot: Direction
    """Direction of the slot, fixed in the first link."""


'''

TEXTBOOK = """\
    "Rg": Pair(
        (("P", ALONG_X), ("R", HERE)),
        lambda m: shifted(m[0, 3], 0, 0) * turned(Z, angle_about_z(m)),
        {"s": (0, lambda m: m[0, 3]), "theta": (1, angle_about_z)},
        drives=[(True, X, O), (False, O, Z)],
    ),
"""

PAGE = "| `Rg` | s, theta | pin of the second link in a `slot` of the first; `axis` of the pin |\n"

ADDITIONS = {
    "mechkin_cli/kernel/core/joints/pairs.hpp": (
        ("// Two points at a distance: no pair of the file format.\n", KERNEL),
        ("WeldInPlane>;", "PinInTrack, "),
    ),
    "mechkin_cli/mechanism/pairs.py": ((")\n\nJOINT_TYPES = {entry.letter", TABLE),),
    "mechkin_cli/schema/links_joints.py": (
        ("class WeldJoint(JointBase):\n", SCHEMA),
        ('"W")\n_PER_LINK', '"Rg", '),
        ("    | WeldJoint\n)", "    | PinTrackJoint\n"),
    ),
    "tests/kernel/pairs.py": (('    "W": Pair(', TEXTBOOK),),
    "docs/modelling.md": (("| `W` | none | weld |\n", PAGE),),
}
"""The files that a new pair touches: its entry in the kernel, in the table, in the file format, in
the identity test, and its row in the page on modelling."""

GENERATED = ("schemas/mechanism.schema.json",)
"""Written by `mechkin schema`."""

MECHANISM = """\
format: 1
name: quick return
units: {length: m, angle: rad, mass: kg, force: N}
links: {crank: {}, arm: {}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  Q: {type: R, links: [ground, arm], point: [0, -2, 0], axis: [0, 0, 1]}
  A: {type: Rg, links: [arm, crank], point: [1, 0, 0], axis: [0, 0, 1], slot: [1, 2, 0]}
motion: {inputs: {DRIVEN}}
"""
