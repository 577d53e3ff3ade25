"""Mistakes in what uses the parts: motion, assembly, loads and columns."""

from building.sound import added, between, changed, column, inputs, joint, load

MOTION = [
    inputs(
        "{»O.s: {at: 0}}",
        "unknown-coordinate",
        "type R and has no coordinate s",
        "its coordinates: theta",
    ),
    inputs("{»A.theta: {at: 0}}", "unknown-coordinate", "type S and has no coordinate theta"),
    inputs("{»Q.theta: {at: 0}}", "unknown-coordinate", "Q.theta is not a coordinate", "O.theta"),
    inputs("{O.theta: {from: 0, to: 9, step: »0}}", "zero-step", "step is zero"),
    inputs("{O.theta: {from: 0, to: 9, step: »1e-12}}", "too-many-rows", "9e+12"),
    inputs("{O.theta: {at: »1e308}}", "too-large", "1e+308 (limit 1e+100)"),
    inputs("{O.theta: »{at: 1e99}}", "too-large", "1e+99 deg (limit 1.621e+18 deg)"),
    inputs("{O.theta: {from: 0, to: 9, count: »9999999999999}}", "too-many-rows", "1e+13"),
    inputs("{O.theta: {from: 0, to: »9 mm, step: 1}}", "expression", "expected an angle", "length"),
    inputs(
        "{O.theta: {from: 0, to: 9, step: 1, rate: »1 mm/s}}",
        "expression",
        "expected an angular rate",
        "velocity",
    ),
    inputs(
        "»{O.theta: {values: [0, 1, 2]}, D.s: {values: [0, 1]}}",
        "row-counts",
        "equally many rows",
        "O.theta 3, D.s 2",
    ),
    changed(
        "motion: {inputs",
        "motion: {grid: »true, inputs",
        "grid-inputs",
        "two inputs with rows of their own, here are 1: O.theta",
        "give a second one",
    ),
    changed("motion: {inputs", "motion: {grid: »2, inputs", "not-a-flag", "true or false"),
    inputs("{O.theta: {values: [0, k*»mm]}}", "expression", "right behind a number: 1 mm"),
]

ASSEMBLY = [
    added("assembly: {near: {»A.theta: 3}}", "unknown-coordinate", "A is of type S", "none"),
    added("assembly: {near: {»D.ss: 3}}", "unknown-coordinate", "no coordinate ss", "theta, s"),
    added("assembly: {near: {D.s: »3 deg}}", "expression", "expected a length", "angle"),
]

LOADS = [
    load("{type: gravity, g: [0, »-9810 mm, 0]}", "expression", "acceleration", "length"),
    load(
        "{type: force, link: »rods, point: [0, 0, 0], force: [1, 0, 0]}",
        "unknown-link",
        "no link rods",
        "did you mean rod?",
    ),
    load(
        "{type: force, link: »ground, point: [0, 0, 0], force: [1, 0, 0]}",
        "load-on-ground",
        "ground",
    ),
    load(
        "{type: force, link: rod, point: [0, 0, 0], force: [1, »2 mm, 0]}",
        "expression",
        "expected a force",
        "length",
    ),
    load(
        "{type: torque, link: rod, torque: [1, 0, »2 N]}",
        "expression",
        "expected a moment",
        "force",
    ),
    load("{type: torque, joint: »C, value: 1}", "unknown-joint", "no joint C"),
    load(
        "{type: force, joint: »O, value: 1}",
        "unknown-coordinate",
        "type R and has no coordinate s",
        "theta",
    ),
    load(
        "{type: torque, joint: »A, value: 1}",
        "unknown-coordinate",
        "type S and has no coordinate theta",
        "none",
    ),
    load(
        "{type: spring, joint: D, coordinate: »phi, stiffness: 1}",
        "unknown-coordinate",
        "no coordinate phi",
        "theta, s",
    ),
    load(
        "{type: spring, joint: D, coordinate: s, stiffness: »1 N*m}",
        "expression",
        "stiffness",
    ),
    load(
        "{type: spring, between: [p, »qq], stiffness: 1, free: 1}",
        "unknown-point",
        "no point qq",
        "did you mean q?",
    ),
    load(
        "{type: spring, between: [q, »q], stiffness: 1, free: 1}",
        "same-point",
        "from q to itself",
    ),
    load(
        "{type: damper, between: [»n, q], damping: 1}",
        "unknown-point",
        "no point n",
    ),
    load(
        "{type: damper, joint: O, coordinate: theta, damping: »1 N}",
        "expression",
        "damping",
        "force",
    ),
    load(
        "{type: force, joint: D, value: {table: »force.csv}}",
        "csv-table",
        "force.csv is sought beside the mechanism file",
    ),
    load(
        "{type: force, link: slider, point: [0, 0, 0], force: [0, {table: »force.csv}, 0]}",
        "load-table",
        "over time, and the motion has none",
        "time: {from: ..., to: ..., step: ...}",
    ),
    load("{type: force, joint: D, value: »D.s}", "expression", "expected a force, found a length"),
    load(
        "{type: force, joint: D, value: 3 N + 2 N/mm*»D.z}",
        "expression",
        "nothing named D.z",
        "did you mean D.s",
    ),
    load(
        "{type: force, joint: D, value: 2 N/mm*p.position}".replace("2 N", "»2 N"),
        "expression",
        "expected a force, found a vector",
        ".x, .y or .z",
    ),
    load(
        "{type: force, joint: D, value: 2 N/s*»time}",
        "expression",
        "time is not known: the motion has no time",
    ),
    load(
        "{type: force, joint: D, value: 2 kg*»D.s_ddot}",
        "expression",
        "a load cannot read D.s_ddot: it is an acceleration",
        "a load may read joint coordinates and their rates",
    ),
    load(
        "{type: force, joint: D, value: 2 kg*»p.acceleration.x}",
        "expression",
        "a load cannot read p.acceleration: it is an acceleration",
    ),
    load(
        "{type: torque, link: rod, torque: [0, 2 kg*mm^2*»crank.alpha.y, 0]}",
        "expression",
        "a load cannot read crank.alpha: it is an acceleration",
    ),
    load(
        "{type: force, joint: D, value: 2*»norm(A.force)}".replace("»norm(", "norm(»"),
        "expression",
        "a load cannot read A.force: it follows from the loads",
    ),
    load(
        "{type: torque, joint: O, value: 2*»O.effort}",
        "expression",
        "a load cannot read O.effort: it follows from the loads",
    ),
    load(
        "{type: torque, joint: O, value: 1 N*mm*»row.condition}",
        "expression",
        "a load cannot read row.condition: it is a verdict",
    ),
    load(
        "{type: torque, joint: O, value: 1 N*mm*sin(»D.s)}",
        "expression",
        "sin takes an angle",
        "length",
    ),
]

COLUMNS = [
    column("»O.thetta", "expression", "O.thetta", "O.theta"),
    changed(
        "columns: [O.theta]",
        "columns: [O.force, »O.force.x]",
        "label-clash",
        "'O.force.x' is used twice, once by a component of a vector",
    ),
    changed(
        "columns: [O.theta]",
        "columns: [O.theta, O.force], plot: {x: »O.force}",
        "vector-label",
        "O.force is a vector",
        "a column: O.force.x, O.force.y, O.force.z",
    ),
    column(
        "»D.theta.effort",
        "expression",
        "nothing named D.theta.effort",
        "D.theta is not an input: the input is O.theta; ask for O.effort, or drive D.theta",
    ),
    column("»D.effort", "expression", "D.theta and D.s are not inputs: the input is O.theta"),
    column("»B.effort", "expression", "B.theta is not an input: the input is O.theta"),
    column("»A.effort", "expression", "A has no coordinate: efforts act at O.theta"),
    column("»rod.effort", "expression", "rod has no coordinate: efforts act at O.theta"),
    column("»O.s.effort", "expression", "did you mean O.effort"),
    changed(
        "{O.theta: {from: -70, to: 70, step: 5}}}\nloads: [{type: gravity, g: [0, -9810, 0]}]\n"
        "tables: [{name: t, columns: [O.theta]}]",
        "{D.theta: {at: 0}, D.s: {at: 0}}}\ntables: [{name: t, columns: [»D.effort]}]",
        "expression",
        "it has two efforts: ask for D.theta.effort or D.s.effort",
    ),
    column("O.theta + »D.s", "expression", "angle", "length"),
    column('"1 + »row.status"', "expression", "row.status"),
    column('"dot(O.force, »2)"', "expression", "vector"),
    column("{label: a, value: »pp.position.x}", "expression", "pp.position", "p.position"),
    column("{label: a, value: sin(»D.s)}", "expression", "sin takes an angle", "length"),
    column("»A.axis.x", "expression", "A.axis"),
    column("»row.residuum", "expression", "row.residual"),
]

ACTUATORS = [
    added("actuators: [»A.s]", "unknown-coordinate", "A is of type S", "its coordinates: none"),
    added("actuators: [»Q.theta]", "unknown-coordinate", "Q.theta is not a coordinate", "O.theta"),
    added("actuators: [D.s, »D.s]", "actuator-twice", "D.s is an actuator already"),
    added("actuators: [»D]", "wrong-form", "a joint coordinate", "joint.coordinate"),
    changed(
        "{O.theta: {from: -70, to: 70, step: 5}}}",
        "{O.theta: {at: 0}, D.s: {at: 0}}}\nactuators: »[D.theta]",
        "too-few-actuators",
        "1 actuator cannot carry",
        "O.theta, D.s",
        "drive: tie",
    ),
    changed(
        "columns: [O.theta]}]",
        "columns: [»O.effort]}]\nactuators: [D.s]",
        "expression",
        "no effort acts at the input O.theta",
        "ask for D.effort, or add O.theta to actuators",
    ),
    changed(
        "columns: [O.theta]}]",
        "columns: [»B.effort]}]\nactuators: [D.s]",
        "expression",
        "no effort acts at B.theta: actuators act at D.s; ask for D.effort, or add B.theta to",
    ),
    inputs("{»pp.position.z: {at: 0}}", "unknown-point", "there is no point pp"),
    inputs("{»q.position.z: {at: 0}}", "point-on-ground", "q is a point of ground"),
    inputs("{»p.position.w: {at: 0}}", "wrong-form", "a joint coordinate"),
    inputs(
        "{O.theta: {at: 0}, D.s: {with: 3 mm, drive: »tie}}",
        "tied-to-nothing",
        "D.s follows no input whose motor could move it",
    ),
]

FIRST_TRIES = [
    joint("{type: R, LINKS, »at: [0, 0, 0], axis: [0, 0, 1]}", "unknown-key", "write point:"),
    joint(
        "{type: R, LINKS, point: [0, 0, 0], »direction: [0, 0, 1]}", "unknown-key", "write axis:"
    ),
    joint(
        "{type: R, LINKS, point: 0, »0, axis: [0, 0, 1]}",
        "empty-value",
        "the comma before '0' ends the value",
        "[1, 2]",
    ),
    joint("{type: R, LINKS, point: [0, 0, 0], axis: »z}", "wrong-kind", "brackets: [x, y, z]"),
    joint(
        "{type: R, LINKS, point: [»[0, 0, 0], 1, 2], axis: [0, 0, 1]}",
        "not-a-number",
        "without brackets",
    ),
    joint(
        "{type: R, LINKS, point: [0 »0, 0, 0], axis: [0, 0, 1]}",
        "expression",
        "a comma separates entries",
    ),
    between("{type: S, LINKS, point: [0, r, 10], »axis: [1, 0, 0]}", "unknown-key", "no axis"),
    changed("mass: 1,", "mass: 1 »kilogram,", "expression", "write kg"),
    changed("mass: 1,", "mass: 0, »5,", "empty-value", "0.5"),
    changed("r: 40 mm", "r: 40 »millimeters", "expression", "write mm"),
    changed("xx: 1,", "xx: 1 »kgmm2,", "expression", "write kg*mm^2"),
    changed("xx: 1,", "xx: 1 »Nmms2,", "expression", "is not a unit"),
    inputs("{O.theta: {at: 0, »speed: 5}}", "unknown-key", "write rate:"),
    inputs("{O.theta: {from: 0, »end: 9, step: 1}}", "unknown-key", "write to:"),
    load("{type: torque, joint: O, »torque: 3}", "unknown-key", "write value:"),
    load(
        "{type: spring, »from: p, stiffness: 2 N/mm, free: 3}", "unknown-key", "write between: [P"
    ),
    load(
        "{type: spring, between: [p, »O], stiffness: 2 N/mm, free: 3}",
        "unknown-point",
        "O is a joint: name its point under points",
    ),
    changed("columns: [O.theta]", "columns: »O.theta", "wrong-kind", "brackets: [O.theta]"),
    column("{label: a, value: O.theta, »unit: rad}", "unknown-key", "units of the file"),
    column("»p", "expression", "write what of p: ", "p.position"),
    column("»P.position.x", "expression", "did you mean p.position"),
    column("»p.pos.x", "expression", "did you mean p.position.x?"),
    column("»D.theta1", "expression", "D.theta"),
    column("»A.theta", "expression", "there is nothing named A.theta"),
    column("»B.s", "expression", "did you mean B.theta?"),
    column("»time", "expression", "a sweep has time where its motion has"),
]
"""What people who are new to the program write."""

BAD_USES = [*MOTION, *ASSEMBLY, *LOADS, *COLUMNS, *ACTUATORS, *FIRST_TRIES]
