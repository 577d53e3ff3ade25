"""Mechanism files that are well-formed but mean nothing: each is the sound file with one change.

`»` stands in the changed text where the message has to point; it is taken out before reading.
"""

from dataclasses import dataclass

MARK = "»"

SOUND = """\
format: 1
units: {length: mm}
parameters: {r: 40 mm, k: 2}
links:
  crank: {mass: 1, center_of_mass: [0, 20, 0], inertia: {xx: 1, yy: 1, zz: 1}}
  rod: {}
  slider: {}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: S, links: [crank, rod], point: [0, r, 10]}
  B: {type: R, links: [rod, slider], point: [120, 0, 10], axis: [0, 0.2, 1]}
  D: {type: C, links: [ground, slider], point: [120, 0, 10], axis: [1, 0, 0]}
points: {p: {link: crank, at: [0, 40, 0]}, q: {link: ground, at: [0, 0, 0]}}
directions: {n: {link: crank, vector: [0, 1, 0]}}
motion: {inputs: {O.theta: {from: -70, to: 70, step: 5}}}
loads: [{type: gravity, g: [0, -9810, 0]}]
tables: [{name: t, columns: [O.theta]}]
"""


@dataclass(frozen=True)
class BadMechanism:
    """`old` of the sound file becomes `new`; the message has the code and says the words."""

    old: str
    new: str
    code: str
    words: tuple[str, ...]

    @property
    def text(self) -> str:
        return self._marked.replace(MARK, "")

    @property
    def place(self) -> tuple[int, int]:
        """Line and column of the mark, from 1."""
        before = self._marked[: self._marked.index(MARK)]
        return before.count("\n") + 1, len(before) - before.rfind("\n")

    @property
    def _marked(self) -> str:
        assert SOUND.count(self.old) == 1, self.old
        return SOUND.replace(self.old, self.new)


def _bad(old: str, new: str, code: str, *words: str) -> BadMechanism:
    return BadMechanism(old, new, code, words)


def _joint(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with another joint O, of the links ground and crank."""
    old = "{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}"
    return BadMechanism(old, new.replace("LINKS", "links: [ground, crank]"), code, words)


def _input(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with other inputs."""
    return BadMechanism("{O.theta: {from: -70, to: 70, step: 5}}", new, code, words)


def _load(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with another load."""
    return BadMechanism("{type: gravity, g: [0, -9810, 0]}", new, code, words)


def _column(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with another column."""
    return BadMechanism("columns: [O.theta]", f"columns: [{new}]", code, words)


def _more(line: str, code: str, *words: str) -> BadMechanism:
    """The sound file with one more line."""
    return BadMechanism("format: 1\n", f"format: 1\n{line}\n", code, words)


UNITS_AND_PARAMETERS = [
    _bad("{length: mm}", "{length: »parsec}", "unit", "parsec"),
    _bad("{length: mm}", "{length: mm, force: »kg}", "unit", "force", "mass"),
    _bad("r: 40 mm", "r: 40 »mmm", "expression", "mmm", "mm"),
    _bad("k: 2", "k: 2*»kk", "expression", "kk", "did you mean k"),
    _bad("k: 2", "k: r + »2", "expression", "length", "dimensionless"),
    _bad("k: 2", "k: 2*j, j: »k", "expression", "depend on themselves", "k -> j -> k"),
    _bad("k: 2", "k: 1/»0", "expression", "zero"),
    _bad("k: 2", "k: sin(»12)", "expression", "angle", "12 deg"),
]

LINKS = [
    _bad("mass: 1,", "mass: »-1,", "negative-mass", "negative"),
    _bad("mass: 1,", "mass: »1 N,", "expression", "expected a mass", "force"),
    _bad("mass: 1,", "mass: »1e101,", "too-large", "1e+101 (limit 1e+100)"),
    _bad("[0, 20, 0]", "[0, »k, 0]", "expression", "expected a length", "1 mm"),
    _bad("zz: 1}", "zz: »1 kg}", "expression", "moment of inertia", "mass"),
    _bad(
        "zz: 1}",
        "zz: 1, axes: »{x: [1, 0, 0], y: [0.001, 1, 0]}}",
        "axes-not-square",
        "cosine of their angle 0.001",
        "limit 1e-09",
    ),
    _bad(
        "zz: 1}",
        "zz: 1, axes: {x: »[0, 0, 0], y: [0, 1, 0]}}",
        "zero-direction",
        "direction is zero",
    ),
    _bad("  slider: {}", "  slider: {}\n  »spare: {}", "disconnected-link", "spare", "ground"),
]

JOINTS = [
    _bad("[crank, rod]", "[»crnk, rod]", "unknown-link", "no link crnk", "did you mean crank?"),
    _bad("[crank, rod]", "[crank, »r]", "unknown-link", "no link r"),
    _bad("axis: [0, 0, 1]", "axis: »[0, 0, 0]", "zero-direction", "direction is zero"),
    _bad("axis: [0, 0, 1]", "axis: »[0, r, k]", "dimension", "alike", "length"),
    _bad("axis: [0, 0, 1]", "axis: [0, 0, »c]", "expression", "c"),
    _bad("[0, r, 10]", "[0, »r*r, 10]", "expression", "expected a length", "area"),
    _joint(
        "{type: R, LINKS, point: [0, 0, 0], axis: {ground: [0, 0, 1], crank: »[0, 0, 0]}}",
        "zero-direction",
        "direction is zero",
    ),
    _joint(
        "{type: R, LINKS, point: [0, 0, 0], axis: [0, 0, 1], "
        "zero: {ground: »[0, 0, 2], crank: [1, 0, 0]}}",
        "zero-parallel",
        "parallel to the joint's axis",
    ),
    _joint(
        "{type: H, LINKS, point: [0, 0, 0], axis: [0, 0, 1], lead: »0}",
        "zero-lead",
        "lead is zero",
    ),
    _joint(
        "{type: H, LINKS, point: [0, 0, 0], axis: [0, 0, 1], lead: »90 deg}",
        "expression",
        "expected a length",
        "angle",
    ),
    _joint(
        "{type: »U, LINKS, point: [0, 0, 0], axis: [1, 0, 0], axis2: [0, 1, 0]}",
        "joint-type",
        "type U",
        "it solves R, P",
    ),
    _joint(
        "{type: »E, LINKS, point: [0, 0, 0], normal: [0, 0, 1], x: [1, 0, 0]}",
        "joint-type",
        "type E",
    ),
    _joint("{type: »Sp, LINKS, point: [0, 0, 0], normal: [0, 0, 1]}", "joint-type", "type Sp"),
    _joint("{type: »Sg, LINKS, point: [0, 0, 0], groove: [0, 0, 1]}", "joint-type", "type Sg"),
    _joint("{type: »W, LINKS}", "joint-type", "type W"),
]

POINTS = [
    _bad("{p: {link: crank", "{p: {link: »cran", "unknown-link", "no link cran", "crank"),
    _bad("{n: {link: crank", "{n: {link: »crink", "unknown-link", "no link crink", "crank"),
    _bad("vector: [0, 1, 0]", "vector: »[0, 0, 0]", "zero-direction", "direction is zero"),
    _bad("at: [0, 40, 0]", "at: [0, »40 deg, 0]", "expression", "expected a length", "angle"),
]

MOTION = [
    _input(
        "{»O.s: {at: 0}}",
        "unknown-coordinate",
        "type R and has no coordinate s",
        "its coordinates: theta",
    ),
    _input("{»A.theta: {at: 0}}", "unknown-coordinate", "type S and has no coordinate theta"),
    _input("{»Q.theta: {at: 0}}", "unknown-coordinate", "Q.theta is no coordinate", "O.theta"),
    _input("{O.theta: {from: 0, to: 9, step: »0}}", "zero-step", "step is zero"),
    _input("{O.theta: {from: 0, to: 9, step: »1e-7}}", "too-many-rows", "rows", "10000000"),
    _input("{O.theta: {at: »1e308}}", "too-large", "1e+308 (limit 1e+100)"),
    _input("{O.theta: {from: 0, to: 9, count: »99999999}}", "too-many-rows", "rows", "10000000"),
    _input("{O.theta: {from: 0, to: »9 mm, step: 1}}", "expression", "expected an angle", "length"),
    _input(
        "{O.theta: {from: 0, to: 9, step: 1, rate: »1 mm/s}}",
        "expression",
        "expected an angular rate",
        "velocity",
    ),
    _input(
        "»{O.theta: {values: [0, 1, 2]}, D.s: {values: [0, 1]}}",
        "row-counts",
        "equally many rows",
        "O.theta 3, D.s 2",
    ),
    _input("{O.theta: {values: [0, k*»mm]}}", "expression", "right behind a number: 1 mm"),
    _input(
        "{O.theta: {from: 0, to: 9, step: 1}, D.s: {with: »r}}",
        "following-input",
        "not computed by this version",
    ),
    _input(
        "»{O.theta: {from: 0, to: 9, step: 1}, D.theta: {at: 0}}",
        "overconstrained",
        "1 more closing equation",
        "drive fewer coordinates",
    ),
    _bad(
        "{inputs: {O.theta: {from: -70, to: 70, step: 5}}}",
        "{time: »{from: 0, to: 1, step: 0.1}, "
        "inputs: {O.theta: {law: constant-rate, at: 0, rate: 1}}}",
        "time-laws",
        "laws over time are not computed",
    ),
]

ASSEMBLY = [
    _more("assembly: {near: {»A.theta: 3}}", "unknown-coordinate", "A is of type S", "none"),
    _more("assembly: {near: {»D.ss: 3}}", "unknown-coordinate", "no coordinate ss", "theta, s"),
    _more("assembly: {near: {D.s: »3 deg}}", "expression", "expected a length", "angle"),
]

LOADS = [
    _load("{type: gravity, g: [0, »-9810 mm, 0]}", "expression", "acceleration", "length"),
    _load(
        "{type: force, link: »rods, point: [0, 0, 0], force: [1, 0, 0]}",
        "unknown-link",
        "no link rods",
        "did you mean rod?",
    ),
    _load(
        "{type: force, link: »ground, point: [0, 0, 0], force: [1, 0, 0]}",
        "load-on-ground",
        "ground",
    ),
    _load(
        "{type: force, link: rod, point: [0, 0, 0], force: [1, »2 mm, 0]}",
        "expression",
        "expected a force",
        "length",
    ),
    _load(
        "{type: torque, link: rod, torque: [1, 0, »2 N]}",
        "expression",
        "expected a moment",
        "force",
    ),
    _load("{type: torque, joint: »C, value: 1}", "unknown-joint", "no joint C"),
    _load(
        "{type: force, joint: »O, value: 1}",
        "unknown-coordinate",
        "type R and has no coordinate s",
        "theta",
    ),
    _load(
        "{type: torque, joint: »A, value: 1}",
        "unknown-coordinate",
        "type S and has no coordinate theta",
        "none",
    ),
    _load(
        "{type: spring, joint: D, coordinate: »phi, stiffness: 1}",
        "unknown-coordinate",
        "no coordinate phi",
        "theta, s",
    ),
    _load(
        "{type: spring, joint: D, coordinate: s, stiffness: »1 N*m}",
        "expression",
        "stiffness",
    ),
    _load(
        "{type: spring, between: [p, »qq], stiffness: 1, free: 1}",
        "unknown-point",
        "no point qq",
        "did you mean q?",
    ),
    _load(
        "{type: spring, between: [q, »q], stiffness: 1, free: 1}",
        "same-point",
        "from q to itself",
    ),
    _load(
        "{type: damper, between: [»n, q], damping: 1}",
        "unknown-point",
        "no point n",
    ),
    _load(
        "{type: damper, joint: O, coordinate: theta, damping: »1 N}",
        "expression",
        "damping",
        "force",
    ),
    _load(
        "{type: force, joint: D, value: »{table: force.csv}}",
        "load-table",
        "not read by this version",
    ),
    _load("{type: force, joint: D, value: »D.s}", "expression", "D.s"),
]

COLUMNS = [
    _column("»O.thetta", "expression", "O.thetta", "O.theta"),
    _column("»O.force", "expression", "vector", ".x, .y or .z"),
    _column("»D.theta.effort", "expression", "D.theta.effort"),
    _column("O.theta + »D.s", "expression", "angle", "length"),
    _column('"1 + »row.status"', "expression", "row.status"),
    _column('"dot(O.force, »2)"', "expression", "vector"),
    _column("{label: a, value: »pp.position.x}", "expression", "pp.position", "p.position"),
    _column("{label: a, value: sin(»D.s)}", "expression", "sin takes an angle", "length"),
    _column("»A.axis.x", "expression", "A.axis"),
    _column("»row.residuum", "expression", "row.residual"),
]

SECTIONS = [
    _more(
        "»chain: [{joint: J, type: R, link: ground}]",
        "not-solved",
        "chain rows",
        "not part of this version",
    ),
    _more("»follow: [A]", "not-solved", "not part of this version", "remove follow:"),
    _more("»idle: hold", "not-solved", "not part of this version", "remove idle:"),
]

BAD_MECHANISMS = [
    *UNITS_AND_PARAMETERS,
    *LINKS,
    *JOINTS,
    *POINTS,
    *MOTION,
    *ASSEMBLY,
    *LOADS,
    *COLUMNS,
    *SECTIONS,
]
