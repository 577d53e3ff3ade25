"""Mistakes in responses, in what names their runs, and words that the format does not have."""

from building.sound import BadMechanism, added, between, changed, column, joint, load

TIME = "time: {from: 0, to: 1, step: 0.1}"


def response(keys: str, code: str, *words: str) -> BadMechanism:
    """The sound file with a response of some keys; `TIME` stands for its moments."""
    return added(f"responses: {{go: {{{keys.replace('TIME', TIME)}}}}}", code, *words)


def started(keys: str, code: str, *words: str) -> BadMechanism:
    """The sound file with a response that starts at 20 deg, and some more keys."""
    return response(f"start: {{O.theta: 20}}, TIME, {keys}", code, *words)


def stopped(stop: str, code: str, *words: str) -> BadMechanism:
    """The sound file with a response that has a stop."""
    return started(f"stop: [{stop}]", code, *words)


START = [
    response("start: {»O.s: 1}, TIME", "unknown-coordinate", "no coordinate s", "theta"),
    response(
        "start: {O.theta: 2}, time: {from: 0, to: »3 mm, count: 3}",
        "expression",
        "expected a time, found a length",
    ),
    response("start: {O.theta: 2}, time: {from: 1, to: »1, count: 3}", "zero-step", "stands still"),
    response("start: {»Q.theta_dot: 1}, TIME", "unknown-coordinate", "Q.theta is not a coord"),
    response("start: {»O.theta_ddot: 1}, TIME", "wrong-form", "O1.theta_dot"),
    response("start: {O.theta: »20 mm}, TIME", "expression", "expected an angle", "length"),
    response("start: {O.theta: 2, O.theta_dot: »2 mm}, TIME", "expression", "an angular rate"),
    response(
        "start: {O.theta: 2, O.theta_dot: 1, »D.s_dot: 1}, TIME",
        "start-rates",
        "2 rates for 1 coordinate",
        "remove a rate",
    ),
    response(
        "start: {O.theta: 2, D.theta: 1, »D.s_dot: 1}, TIME",
        "start-rates",
        "1 rate for 2 coordinates",
        "add O.theta_dot or D.theta_dot",
    ),
    response(
        "start: {»O.theta: 2}, driven: {O.theta: {at: 3}}, TIME",
        "start-and-drive",
        "O.theta is driven",
        "remove it",
    ),
]
"""What starts a response, and when."""

DRIVES = [
    started("efforts: {»D.q: 1}", "unknown-coordinate", "no coordinate q", "theta, s"),
    started("efforts: {D.s: »3 mm}", "expression", "expected a force", "length"),
    started("efforts: {D.s: »-2*D.s}", "expression", "expected a force", "length"),
    changed(
        "tables: [{name: t, columns: [O.theta]}]",
        "responses: {go: {start: {O.theta: 20}, efforts: {O.theta: 3}, TIME}}\n"
        "tables: [{name: t, run: go, columns: [»D.s.effort]}]".replace("TIME", TIME),
        "expression",
        "no effort acts at D.s in this response: efforts act at O.theta; ask for O.effort, or name",
    ),
    changed(
        "tables: [{name: t, columns: [O.theta]}]",
        "responses: {go: {start: {O.theta: 20}, TIME}}\n"
        "tables: [{name: t, run: go, columns: [»B.effort]}]".replace("TIME", TIME),
        "expression",
        "no effort acts at B.theta in this response: there is no effort, or name B.theta under",
    ),
    started("efforts: {O.theta: 1 N*mm*»row.mode}", "expression", "cannot read row.mode"),
    started("efforts: {O.theta: »O.moment.z}", "expression", "it follows from the loads"),
    started("efforts: {D.s: {table: f.csv, over: »D.s + 1 mm}}", "expression", "one quantity"),
    started("efforts: {D.s: {table: f.csv, over: »p.position}}", "expression", "is a vector"),
    started("efforts: {D.s: {table: f.csv, over: »r}}", "load-table", "r is a parameter"),
    started("efforts: {D.s: {table: f.csv, over: »D.z}}", "expression", "D.z"),
    started("efforts: {D.s: {table: »f.csv, over: time}}", "csv-table", "comes from no file"),
    started(
        "driven: {D.s: {at: 1}}, efforts: {»D.s: 1}", "effort-and-drive", "D.s is driven", "remove"
    ),
    started("driven: {»D.q: {at: 1}}", "unknown-coordinate", "no coordinate q"),
    started("driven: {D.s: {at: »1 deg}}", "expression", "expected a length"),
    started("driven: {D.s: {law: »jump, at: 1}}", "unknown-word", "constant-rate"),
    started("driven: {D.s: {with: »O.theta*1 mm/rad}}", "expression", "O.theta is not an input"),
    started(
        "driven: {D.s: {law: harmonic, from: 0, to: 1, duration: »0}}", "no-duration", "positive"
    ),
    started("near: {»D.q: 1}", "unknown-coordinate", "no coordinate q"),
    started("near: {D.s: »1 deg}", "expression", "expected a length"),
    started("near: {D.s: 1}, mode: »A", "two-choices", "near and mode", "keep one"),
]
"""What drives it and how it is assembled."""

ROWS = [
    added("responses: {go: »{start: {O.theta: 2}}}", "missing-key", "the key time is missing"),
    response("start: {O.theta: 2}, time: »{from: 0, to: 1, step: 2}", "one-moment", "two moments"),
    response("start: {O.theta: 2}, time: {from: 0, to: 1, step: »0}", "zero-step", "zero"),
    response("start: {O.theta: 2}, time: {from: 0, to: 9, step: »1e-12}", "too-many-rows"),
    response(
        "start: {O.theta: 2}, driven: {D.s: {at: 1}}, time: {from: 0, to: 9, step: »1e-12}",
        "too-many-rows",
    ),
    response(
        "start: {O.theta: 2}, time: »{from: 1, to: 0, step: 0.1}", "time-backwards", "backwards"
    ),
    response("start: {O.theta: 2}, time: {values: [0, 1, »0.5]}", "time-backwards", "not later"),
    response("start: {O.theta: 2}, time: {values: »[0]}", "wrong-length", "at least 2"),
    started("tolerance: »1e-20", "out-of-range", "1e-14 to 0.01", "such as 1e-10"),
    started("tolerance: »1 mm", "expression", "dimensionless"),
    started("fixed_step: »0 s", "zero-step", "positive time"),
    started("fixed_step: »1e-7 s", "too-many-steps", "1e+07 steps", "limit 1000000 steps"),
    started("tolerance: 1e-6, fixed_step: »1e-3", "two-choices", "keep one"),
]
"""Its rows and steps."""

STOPS = [
    stopped("{value: »O.q}", "expression", "O.q"),
    stopped("{value: »r}", "expression", "never changes"),
    stopped("{value: »p.position}", "expression", "write p.position.x, "),
    stopped("{value: »O.effort}", "expression", "O.effort"),
    stopped("{value: »O.theta_ddot}", "expression", "a stop cannot read", "acceleration"),
    stopped("{value: O.theta, at: »3 mm}", "expression", "expected an angle"),
    stopped("{value: O.theta, direction: »left}", "unknown-word", "up, down, any"),
    stopped("{dead_centre: »O.q}", "unknown-coordinate", "no coordinate q"),
    stopped("{dead_centre: »Z.theta}", "unknown-coordinate", "Z.theta is not a coordinate"),
    stopped("{dead_centre: O.theta, count: »0}", "out-of-range", "below the limit 1"),
    stopped("{turns: »D.s}", "no-angle", "slide", "write value:"),
    stopped("{value: O.theta, »contact: D}", "unknown-key", "a stop is a value"),
]
"""What ends it."""

RUNS = [
    load("{type: gravity, g: [0, -9810, 0], runs: [»go]}", "unknown-run", "sweep"),
    load("{type: gravity, g: [0, -9810, 0], runs: »[]}", "wrong-length", "at least 1"),
    load("{type: gravity, g: [0, 1, 0], runs: [sweep, »sweep]}", "named-twice", "once"),
    added(f"responses: {{»sweep: {{{TIME}}}}}", "reserved-name", "the run along the inputs"),
    added(f"responses: {{»aux: {{{TIME}}}}}", "reserved-name", "device"),
    added(f"responses: {{»{'n' * 101}: {{{TIME}}}}}", "reserved-name", "limit 100"),
    added(
        f"responses: {{go: {{start: {{O.theta: 2}}, {TIME}}}, »GO: {{{TIME}}}}}",
        "name-clash",
        "case",
    ),
    column("O.theta, »row.event", "expression", "row.event is told of the rows of a response"),
    column("O.theta, »row.work", "expression", "row.work is told of the rows"),
    BadMechanism("name: t,", "name: t, run: »go,", "unknown-run", ("there is no run go", "sweep")),
    BadMechanism("name: t,", "name: t, run: »a b,", "wrong-form", ("a b",)),
]
"""Who names runs."""

OTHER_WORDS = [
    added("»studies: {}", "unknown-key", "no key 'studies'", "--set NAME=VALUE", "vary"),
    added("»study: {}", "unknown-key", "vary"),
    added("»contact: {}", "unknown-key", "no contact", "Sp", "Sg"),
    added("»gears: {}", "unknown-key", "couplings: {K: {type: gear"),
    added("»cam: {}", "unknown-key", "type: function"),
    added("»flexible: {}", "unknown-key", "links are rigid", "spring"),
    added("»Control: {}", "unknown-key", "an effort may be an expression"),
    added("»motors: {}", "unknown-key", "efforts"),
    added("»friction: 0.1", "unknown-key", "friction is a load"),
    added("»simulation: {}", "unknown-key", "responses:"),
    added("»gravity: 9.81", "unknown-key", "loads:"),
    load("{type: »motor, joint: O}", "unknown-word", "efforts"),
    load("{type: »contact, joint: O}", "unknown-word", "no contact"),
    load("{type: »moment, link: rod}", "unknown-word", "torque"),
    joint("{type: »gear, LINKS}", "unknown-word", "couplings: {K: {type: gear"),
    joint("{type: »Revolute, LINKS}", "unknown-word", "a hinge is R"),
    between("{type: »cam, LINKS}", "unknown-word", "type: function"),
    joint("{type: R, LINKS, point: [0, 0, 0], axis: [0, 0, 1], »friction: 1}", "unknown-key", "is"),
    started("»inputs: {}", "unknown-key", "driven:"),
    added("»planar: true", "unknown-key", "there is no key", "plane: xy"),
    added("»mu: 0.1", "unknown-key", "coefficient: 0.1", "radius"),
    added("»coulomb: 0.1", "unknown-key", "type: friction"),
    added("»stiction: 0.1", "unknown-key", "type: friction"),
    added("»viscous: 1", "unknown-key", "type: damper"),
    added("»damping: 1", "unknown-key", "type: damper"),
    added("»motor: {}", "unknown-key", "motion: inputs:", "efforts"),
    added("»actuator: [O.theta]", "unknown-key", "actuators: ["),
    added("»simulate: {}", "unknown-key", "responses:"),
    added("»dynamics: {}", "unknown-key", "responses:"),
    added("»initial: {}", "unknown-key", "start: {"),
    added("»t_end: 2", "unknown-key", "time: {from: 0, to: 2, step: 0.1}"),
    added("»duration: 2", "unknown-key", "time: {from: 0, to: 2, step: 0.1}"),
    added("»solver: rk45", "unknown-key", "tolerance: 1e-10"),
    added("»outputs: [O.theta]", "unknown-key", "tables: [{name: t"),
    added("»rows_by: t", "unknown-key", "published: {file: printed.csv, rows_by: t}"),
    added("»published: a.csv", "unknown-key", "belong to a table"),
    added("»harmonics: {}", "unknown-key", "balances: [{name: work, type: work}]"),
    added("»mass: 3", "unknown-key", "links:"),
    load(
        "{type: friction, joint: O, coefficient: 0.1, radius: 8, »mu: 0.1}", "unknown-key", "coeff"
    ),
    load(
        "{type: friction, joint: O, »static: 0.1, coefficient: 0.1, radius: 8}", "unknown-key", "{"
    ),
    joint("{type: R, LINKS, point: [0, 0, 0], axis: [0, 0, 1], »mu: 1}", "unknown-key", "friction"),
    joint(
        "{type: R, LINKS, point: [0, 0, 0], axis: [0, 0, 1], »parent: a}", "unknown-key", "first"
    ),
    started("»t_end: 2", "unknown-key", "time: {from: 0, to: 2, step: 0.1}"),
    started("»rtol: 1e-6", "unknown-key", "tolerance: 1e-10"),
    started("»solver: rk45", "unknown-key", "DOP853"),
    started("»initial_conditions: {}", "unknown-key", "start: {"),
    started("»forces: {}", "unknown-key", "efforts: {"),
    started("»actuators: [O.theta]", "unknown-key", "efforts:"),
    changed("name: t, col", "name: t, »rows_by: t, col", "unknown-key", "with the file: published"),
    changed("motion: {in", "motion: {»start: {}, in", "unknown-key", "responses:"),
    started("»loads: []", "unknown-key", "runs: [NAME]"),
]
"""Words of other programs, each with what to write instead."""


def equilibrium(keys: str, code: str, *words: str) -> BadMechanism:
    """The sound file with equilibria of some keys."""
    return added(f"equilibria: {{rest: {{{keys}}}}}", code, *words)


EQUILIBRIA = [
    equilibrium("near: {»Q.theta: 20}", "unknown-coordinate", "Q.theta is not a coordinate"),
    equilibrium("near: {O.theta: »20 mm}", "expression", "expected an angle", "length"),
    equilibrium("window: {»Q.theta: {from: 0, to: 9}}", "unknown-coordinate", "Q.theta is not"),
    equilibrium("window: {O.theta: {from: 9, to: »-9}}", "empty-window", "empty", "from:"),
    equilibrium("window: {O.theta: {from: 9, to: »9}}", "empty-window", "empty", "from:"),
    equilibrium("window: {O.theta: {from: »9 mm, to: 20}}", "expression", "expected an angle"),
    equilibrium("window: {O.theta: {from: 0, to: »1e6}}", "wide-window", "limit 100"),
    equilibrium(
        "near: {O.theta: 2}, window: »{O.theta: {from: 0, to: 9}}", "two-choices", "keep one"
    ),
    equilibrium("window: {O.theta: {from: 0, to: 9}}, mode: »A", "two-choices", "remove mode"),
    equilibrium("near: {O.theta: 2}, starts: »9", "starts-without-window", "add window"),
    equilibrium(
        "near: {»O.theta: 2}, driven: {O.theta: {at: 3}}", "start-and-drive", "no load decides"
    ),
    equilibrium("»start: {O.theta: 2}", "unknown-key", "near: {A.theta: 20}"),
    equilibrium("near: {O.theta: 2}, time: »3 mm", "expression", "expected a time", "length"),
    changed("step: 5}}}", "step: 5}}, rest: [»O.theta]}", "rest-and-input", "cannot rest"),
    changed("step: 5}}}", "step: 5}}, rest: [»Q.s]}", "unknown-coordinate", "Q.s is not"),
    changed("step: 5}}}", "step: 5}}, rest: [A.s, »A.s]}", "named-twice", "name it once"),
    changed("step: 5}}}", "step: 5}}, grid: true, rest: »[A.s]}", "rest-in-grid", "remove rest"),
]
"""Where loads balance."""

BAD_RESPONSES = [*START, *DRIVES, *ROWS, *STOPS, *RUNS, *OTHER_WORDS, *EQUILIBRIA]
