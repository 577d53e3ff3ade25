"""Words that people first write for gears, belts, cams and their like, and the form that each has
here: a coupling of joints, whose sections are in `couplings.py`."""

from typing import Final

RATIO = (
    "wheels and racks are couplings of joints: couplings: {K: {type: gear, joints: [A, B], "
    "teeth: [20, 40]}}, or {type: linear, terms: {A.theta: 1, B.theta: 2}}"
)
WORM = (
    "a worm is a gear whose axes pass each other: couplings: {K: {type: gear, joints: [A, B], "
    "teeth: [1, 40], radii: [20 mm, 80 mm], helix: atan(10)}}, helix being 90 deg less its lead "
    "angle"
)
BEVEL = (
    "bevel wheels are a gear whose axes meet: couplings: {K: {type: gear, joints: [A, B], "
    "teeth: [20, 40], radii: [15 mm, 30 mm]}}"
)
PLANETARY = (
    "a planetary gear is two couplings with the carrier's joint C: couplings: {I: {type: gear, "
    "joints: [S, P], teeth: [18, 12]}, O: {type: gear, joints: [C, P], teeth: [42, 12], internal: "
    "true}}; mechkin new drive --template planetary"
)
DIFFERENTIAL = (
    "a differential is a coupling of three: couplings: {K: {type: linear, terms: {case.theta: 2, "
    "left.theta: -1, right.theta: -1}}}, or its bevel wheels are gears"
)
RACK = (
    "a rack and its pinion are a coupling: couplings: {K: {type: rack, joints: [A, S], radius: "
    "20 mm}}, A the pinion's R joint, S the rack's P joint"
)
BELT = (
    "belts and chains over pulleys are couplings: couplings: {K: {type: belt, joints: [A, B], "
    "radii: [30 mm, 50 mm]}}, or {type: chain, joints: [A, B], teeth: [17, 38], pitch: 12.7 mm}; "
    "over more than two with tensioner: C"
)
CAM = (
    "a cam is a coupling of its angle and the follower's coordinate: couplings: {K: {type: "
    'function, of: A.theta, gives: S.s, value: "10 mm*(1 - cos(A.theta))"}}, or {type: table, '
    "table: lift.csv, over: A.theta, gives: S.s}"
)
PLAY = (
    "play between flanks is a key of a coupling: couplings: {K: {type: gear, joints: [A, B], "
    "teeth: [20, 40], backlash: 0.1 mm, restitution: 0.4}}; where flanks part and meet is computed "
    "in responses"
)
TIE = (
    "coordinates that move in a ratio are a coupling: couplings: {K: {type: linear, terms: "
    "{A.theta: 1, B.theta: -2}}}; between two inputs of a sweep write {B.theta: {with: A.theta/2, "
    "drive: tie}}"
)

ELSEWHERE: Final = {
    **dict.fromkeys(("gear", "gears", "gearing", "gearbox", "gear_pair", "spur", "pinion"), RATIO),
    **dict.fromkeys(("reducer", "gear_train", "gear_ratio", "gearset", "transmission"), RATIO),
    **dict.fromkeys(("mesh", "meshes", "gear_wheel", "cogwheel", "helical_gear", "idler"), RATIO),
    **dict.fromkeys(("worm", "worm_gear", "worm_wheel", "crossed_helical"), WORM),
    **dict.fromkeys(("bevel", "bevels", "bevel_gear", "bevel_gears", "miter"), BEVEL),
    **dict.fromkeys(("planetary", "epicyclic", "planetary_gear", "ring_gear", "sun"), PLANETARY),
    **dict.fromkeys(("differential", "differentials"), DIFFERENTIAL),
    **dict.fromkeys(("rack", "racks", "rack_and_pinion", "rack_pinion"), RACK),
    **dict.fromkeys(("belt", "belts", "pulley", "pulleys", "timing_belt", "belt_drive"), BELT),
    **dict.fromkeys(("sprocket", "sprockets", "roller_chain", "chains", "chain_drive"), BELT),
    **dict.fromkeys(("cam", "cams", "follower", "followers"), CAM),
    **dict.fromkeys(("backlash", "play", "lash", "slop", "lost_motion", "gear_play"), PLAY),
    **dict.fromkeys(("tie", "ties", "ratio", "ratios", "coupled", "link_ratio"), TIE),
    **dict.fromkeys(("coupling", "coupler_ratio", "synchronize", "sync"), TIE),
}
"""As a type or key of joints, loads, the motion or the file."""

COUPLING_ADVICE: Final = {
    **ELSEWHERE,
    **dict.fromkeys(("gears", "spur", "helical", "external", "wheels"), "write type: gear"),
    **dict.fromkeys(
        ("internal", "ring"), "write type: gear with internal: true, one wheel being the ring"
    ),
    **dict.fromkeys(("cvt", "friction_wheel"), "write type: gear with radii: [20 mm, 40 mm]"),
}
"""Types of a coupling."""

_JOINTS = "name the joints that the wheels turn on: joints: [A, B]"
_TEETH = (
    "a ratio is told by teeth: [20, 40], in the order of the joints, or by radii: [20 mm, 40 mm]; "
    "of coordinates alone write type: linear"
)
_LOSSES = (
    "write efficiency: 0.9, the share of the power that comes out; friction of bearings is a load "
    "at their joints"
)
_PLAY = (
    "the play of flanks is backlash: 0.1 mm along the pitch circle, or an angle of the first "
    "joint; restitution: 0.4 beside it lets them rebound"
)
_OF_FLANKS: Final = {
    **dict.fromkeys(("play", "lash", "clearance", "slack", "gap", "lost_motion"), _PLAY),
    **dict.fromkeys(("bounce", "rebound", "impact", "e"), _PLAY),
}
_OF_JOINTS: Final = {
    **dict.fromkeys(("wheels", "gears", "pulleys", "between", "links", "bodies"), _JOINTS),
    **dict.fromkeys(("axes", "shafts", "a", "b", "first", "second", "from", "to"), _JOINTS),
    **dict.fromkeys(("input", "output", "driver", "driven", "pinion", "wheel", "joint"), _JOINTS),
    **dict.fromkeys(("efficiency", "eta", "friction", "losses"), _LOSSES),
    "stiffness": "teeth and belts have no give",
    **dict.fromkeys(
        ("carrier", "arm", "frame", "housing"),
        "the carrier is the link that both joints have; leave it out",
    ),
}

GEAR_KEYS: Final = {
    **_OF_JOINTS,
    **_OF_FLANKS,
    **dict.fromkeys(("ratio", "gear_ratio", "transmission", "i", "n"), _TEETH),
    **dict.fromkeys(("z", "number_of_teeth", "tooth_numbers", "tooth", "zs"), _TEETH),
    **dict.fromkeys(("radius", "r"), "radii: [20 mm, 40 mm] has both pitch radii"),
    **dict.fromkeys(("diameter", "diameters", "d"), "radii: are half of the pitch diameters"),
    **dict.fromkeys(("m", "modulus", "normal_module"), "the key is module: 2 mm"),
    **dict.fromkeys(("alpha", "pressure", "contact_angle"), "the key is pressure_angle: 20 deg"),
    **dict.fromkeys(
        ("beta", "helix_angle", "spiral"), "the key is helix: 15 deg, that of the first wheel"
    ),
    **dict.fromkeys(("ring", "inner", "annulus"), "write internal: true"),
    **dict.fromkeys(
        ("sign", "external", "reversed", "direction", "opposite"),
        "wheels turn opposite ways, with internal: true the same way, as drawn; leave it out",
    ),
    **dict.fromkeys(
        ("distance", "centre_distance", "center_distance"),
        "the distance of the axes is that of the drawing; leave it out",
    ),
}
"""Keys of a gear."""

RACK_KEYS: Final = {
    **GEAR_KEYS,
    **dict.fromkeys(
        ("pinion", "rack", "slider"), "name the pinion's joint, then the rack's: joints: [A, S]"
    ),
    **dict.fromkeys(
        ("teeth", "module", "radii", "ratio", "lead", "diameter", "r", "m", "z"),
        "a rack is told by the pitch radius of its pinion: radius: 20 mm, module times teeth by 2",
    ),
}
"""Keys of a rack."""

BELT_KEYS: Final = {
    **_OF_JOINTS,
    **dict.fromkeys(
        ("backlash", "restitution", "play", "clearance", "slack"),
        "a belt has no play: its slack strand gives way; a chain has backlash: 5 mm",
    ),
    **dict.fromkeys(
        ("diameter", "diameters", "d", "radius", "r", "ratio"),
        "radii: [30 mm, 50 mm] reach to the middle of the belt, in the order of the joints",
    ),
    "teeth": "of a toothed belt: radii, of a chain: type: chain, teeth: [17, 38], pitch: 12.7 mm",
    **dict.fromkeys(("tension", "preload", "initial_tension"), "the key is pretension: 200 N"),
    **dict.fromkeys(
        ("idlers", "idler", "back", "backside", "inside", "sides", "side", "reversed"),
        "name all pulleys under joints, in the order in which the belt passes them, and under "
        "outside those that it touches with its back: outside: [C]",
    ),
    **dict.fromkeys(
        ("tensioners", "tension_pulley", "tensioning"),
        "the key is tensioner: C, the joint of the pulley that holds the pretension",
    ),
    **dict.fromkeys(("length", "belt_length"), "its length is that of the drawing; leave it out"),
}
"""Keys of a belt."""

CHAIN_KEYS: Final = {
    **BELT_KEYS,
    **_OF_FLANKS,
    **dict.fromkeys(
        ("radii", "diameters", "ratio", "z"), "write teeth: [17, 38] and pitch: 12.7 mm"
    ),
}
"""Keys of a chain."""

_PATH = (
    "a cable passes the places of its path: path: [P, {pulley: A, radius: 50 mm, side: left}, Q], "
    "points by their names"
)
CABLE_KEYS: Final = {
    **dict.fromkeys(("points", "via", "over", "through", "route", "from", "to", "ends"), _PATH),
    **dict.fromkeys(("pulleys", "joints", "radii", "radius", "drums", "drum", "side"), _PATH),
    "length": "its length is that of the drawing; leave it out",
    **dict.fromkeys(
        ("tension", "pretension", "force"), "its tension follows from the loads: K.tension"
    ),
    **dict.fromkeys(("stiffness", "k", "mass"), "a cable does not stretch and has no mass"),
    **dict.fromkeys(
        ("strands", "falls", "parts"),
        "a tackle names its points again: path: [a, b, a, b, a] has four strands",
    ),
}
"""Keys of a cable."""

PATH_KEYS: Final = {
    **dict.fromkeys(
        ("normal", "direction", "plane"),
        "the axis of a pulley in space is axis: [0, 1, 0], or that of the joint that it names",
    ),
    **dict.fromkeys(
        ("caster", "swivels", "swivelling", "swiveling", "pan"),
        "a pulley that turns to where its cable leads has the line about which it does: swivel: "
        "[0, 0, 1]; one that hangs on its centre is free: true",
    ),
    **dict.fromkeys(("ball", "hangs", "hook", "hung"), "write free: true"),
    **dict.fromkeys(("joint", "centre", "center"), "write pulley: A, its R joint or its centre"),
    **dict.fromkeys(("r", "diameter", "d"), "radius: 50 mm reaches to the middle of the cable"),
}
"""Keys of a place of a cable."""

LINEAR_KEYS: Final = {
    **_OF_FLANKS,
    **dict.fromkeys(
        ("ratio", "joints", "of", "gives", "factors", "factor", "coefficients", "coordinates"),
        "write terms: {A.theta: 1, B.theta: 2}: their sum is constant",
    ),
}
"""Keys of a linear coupling."""

SCREW_KEYS: Final = _OF_FLANKS
"""Keys of a screw."""

FUNCTION_KEYS: Final = {
    **dict.fromkeys(
        ("expression", "function", "f", "formula", "lift"),
        "the key is value: an expression of the leading coordinate, 10 mm*(1 - cos(A.theta))",
    ),
    **dict.fromkeys(
        ("joints", "from", "to", "input", "output", "over", "cam"),
        "write of: A.theta, the leading coordinate, and gives: S.s, the following one",
    ),
    **dict.fromkeys(("table", "file", "points"), "write type: table, table: lift.csv"),
}
"""Keys of a function."""

TABLE_KEYS: Final = {
    **dict.fromkeys(("file", "path", "csv", "values"), "the key is table: lift.csv"),
    **dict.fromkeys(
        ("joints", "of", "from", "to", "input", "output", "cam"),
        "write over: A.theta, the leading coordinate, and gives: S.s, the following one",
    ),
    **dict.fromkeys(("law", "value", "expression"), "an expression goes with type: function"),
}
"""Keys of a table."""
