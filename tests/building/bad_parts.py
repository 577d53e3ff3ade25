"""Mistakes in units, parameters, links, joints, points, and sections that are not solved."""

from building.sound import added, between, changed, joint, load

UNITS_AND_PARAMETERS = [
    changed("{length: mm, force: N}", "{length: »parsec}", "unit", "parsec"),
    changed("{length: mm, force: N}", "{length: mm, force: »kg}", "unit", "force", "mass"),
    changed("r: 40 mm", "r: 40 »mmm", "expression", "mmm", "mm"),
    changed("k: 2", "k: 2*»kk", "expression", "kk", "did you mean k"),
    changed("k: 2", "k: r + »2", "expression", "length", "dimensionless"),
    changed("k: 2", "k: 2*j, j: »k", "expression", "depend on themselves", "k -> j -> k"),
    changed("k: 2", "k: 1/»0", "expression", "zero"),
    changed("k: 2", "k: sin(»12)", "expression", "angle", "12 deg"),
]

LINKS = [
    changed("mass: 1,", "mass: »-1,", "negative-mass", "negative"),
    changed("mass: 1,", "mass: »1 N,", "expression", "expected a mass", "force"),
    changed("mass: 1,", "mass: »1e101,", "too-large", "1e+101 (limit 1e+100)"),
    changed("[0, 20, 0]", "[0, »2*1, 0]", "expression", "expected a length", "1 mm"),
    changed(
        "k: 2}\nlinks:\n  crank: {mass: 1, center_of_mass: [0, 20, 0]",
        "k: »2}\nlinks:\n  crank: {mass: 1, center_of_mass: [0, k, 0]",
        "parameter-unit",
        "k is used as a length and has no unit",
        "write 2 mm",
    ),
    changed("zz: 1}", "zz: »1 kg}", "expression", "moment of inertia", "mass"),
    changed(
        "zz: 1}",
        "zz: 1, axes: »{x: [1, 0, 0], y: [0.001, 1, 0]}}",
        "axes-not-square",
        "cosine of their angle 0.001",
        "limit 1e-09",
    ),
    changed(
        "zz: 1}",
        "zz: 1, axes: {x: »[0, 0, 0], y: [0, 1, 0]}}",
        "zero-direction",
        "direction is zero",
    ),
    changed("  slider: {}", "  slider: {}\n  »spare: {}", "disconnected-link", "spare", "ground"),
]

JOINTS = [
    changed("[crank, rod]", "[»crnk, rod]", "unknown-link", "no link crnk", "did you mean crank?"),
    changed("[crank, rod]", "[crank, »r]", "unknown-link", "no link r"),
    changed("axis: [0, 0, 1]", "axis: »[0, 0, 0]", "zero-direction", "direction is zero"),
    changed("axis: [0, 0, 1]", "axis: »[0, r, k]", "dimension", "alike", "length"),
    changed("axis: [0, 0, 1]", "axis: [0, 0, »c]", "expression", "c"),
    changed("[0, r, 10]", "[0, »r*r, 10]", "expression", "expected a length", "area"),
    joint(
        "{type: R, LINKS, point: [0, 0, 0], axis: {ground: [0, 0, 1], crank: »[0, 0, 0]}}",
        "zero-direction",
        "direction is zero",
    ),
    joint(
        "{type: R, LINKS, point: [0, 0, 0], axis: [0, 0, 1], "
        "zero: {ground: »[0, 0, 2], crank: [1, 0, 0]}}",
        "zero-parallel",
        "parallel to the joint's axis",
    ),
    joint(
        "{type: H, LINKS, point: [0, 0, 0], axis: [0, 0, 1], lead: »0}",
        "zero-lead",
        "lead is zero",
    ),
    joint(
        "{type: H, LINKS, point: [0, 0, 0], axis: [0, 0, 1], lead: »90 deg}",
        "expression",
        "expected a length",
        "angle",
    ),
    between(
        "{type: U, LINKS, point: [0, r, 10], axis: [0, 0, 1], axis2: »[0, 0, -2]}",
        "parallel-axes",
        "universal joint are parallel",
        "use type R",
    ),
    between(
        "{type: E, LINKS, point: [0, r, 10], normal: [0, 0, 1], "
        "x: {crank: [1, 0, 0], rod: »[0, 0, 3]}}",
        "zero-parallel",
        "x is parallel to the joint's normal",
    ),
    between(
        "{type: Sp, LINKS, point: [0, r, 10], normal: »[0, 0, 0]}",
        "zero-direction",
        "direction is zero",
    ),
    between(
        "{type: Sg, LINKS, point: [0, r, 10], groove: »[0, 0, 0]}",
        "zero-direction",
        "direction is zero",
    ),
    between(
        "{type: Ss, LINKS, point: [0, r, 10], slot: [0, 0, 1], pin: »[1, 0, 0.001]}",
        "not-square",
        "slot and pin of this joint must be square",
        "cosine of their angle 0.001",
        "limit 1e-09",
        "give the normal of that plane",
    ),
    between(
        "{type: Ss, LINKS, point: [0, r, 10], slot: [0, 0, 1], pin: »[0, 0, 0]}",
        "zero-direction",
        "direction is zero",
    ),
    between(
        "{type: Sc, LINKS, point: [0, r, 10], axis: [0, 2, 1], pin: »[0, -4, -2]}",
        "pin-parallel",
        "parallel to the cylinder's axis",
        "draw the pin where it comes out of the slot",
    ),
    between(
        "{type: Sc, LINKS, point: [0, r, 10], axis: »[0, 0, 0], pin: [1, 0, 0]}",
        "zero-direction",
        "direction is zero",
    ),
    between(
        "{type: Cp, LINKS, point: [0, r, 10], axis: [1, 0, 0], "
        "normal: {crank: [0, 0, 1], rod: »[1, 0, 1]}}",
        "not-square",
        "axis and normal of this joint must be square",
        "cosine of their angle 0.707",
        "a cylinder touches a plane along a line",
    ),
]

POINTS = [
    joint(
        "{type: R, LINKS, point: »pp, axis: [0, 0, 1]}", "unknown-point", "no point pp", "mean p?"
    ),
    joint(
        "{type: R, LINKS, point: {ground: q, crank: »D}, axis: [0, 0, 1]}",
        "unknown-point",
        "there is no point D",
        "D is a joint: name its point under points",
    ),
    changed("center_of_mass: [0, 20, 0]", "center_of_mass: »pq", "unknown-point", "no point pq"),
    changed(
        "center_of_mass: [0, 20, 0]",
        "center_of_mass: »q",
        "point-of-another-link",
        "q is a point of ground, and this place moves with crank",
        "q_of_crank: {link: crank, at: q}",
    ),
    load(
        "{type: force, link: rod, point: »p, force: [1, 0, 0]}",
        "point-of-another-link",
        "p is a point of crank, and this place moves with rod",
        "p_of_rod: {link: rod, at: p}",
    ),
    changed("at: [0, 40, 0]", "at: »pq", "unknown-point", "there is no point pq"),
    changed("at: [0, 40, 0]", "at: »p", "circular-place", "back to itself: p -> p", "coordinates"),
    changed(
        "{p: {link: crank, at: [0, 40, 0]}",
        "{p: {link: crank, at: »u}, u: {link: rod, at: v}, v: {link: rod, at: p}",
        "circular-place",
        "the place of p leads back to itself: p -> u -> v -> p",
    ),
    changed(
        "D: {type: C, links: [ground, slider], point: [120, 0, 10], axis: [1, 0, 0]}\n"
        "points: {p: {link: crank, at: [0, 40, 0]}",
        "D: {type: C, links: [ground, slider], point: u, axis: [1, 0, 0]}\n"
        "points: {u: {link: slider, at: [»2 kg, 0, 10]}, p: {link: crank, at: [0, 40, 0]}",
        "expression",
        "expected a length",
    ),
    changed("{p: {link: crank", "{p: {link: »cran", "unknown-link", "no link cran", "crank"),
    changed("{n: {link: crank", "{n: {link: »crink", "unknown-link", "no link crink", "crank"),
    changed("vector: [0, k, 0]", "vector: »[0, 0, 0]", "zero-direction", "direction is zero"),
    changed("at: [0, 40, 0]", "at: [0, »40 deg, 0]", "expression", "expected a length", "angle"),
]

SECTIONS = [
    added("follow: [»Q]", "unknown-joint", "there is no joint Q"),
]

BAD_PARTS = [*UNITS_AND_PARAMETERS, *LINKS, *JOINTS, *POINTS, *SECTIONS]
