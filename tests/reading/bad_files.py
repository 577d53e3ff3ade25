"""Mechanism files with mistakes: what is written, where the message points, what it says.

`editor` tells whether the JSON Schema refuses the file as well. It cannot where the mistake lies
between sections, or where YAML itself has given the file another meaning.
"""

from dataclasses import dataclass

SOUND = """\
format: 1
links: {crank: {}}
joints:
  O1: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
"""
JOINT = "format: 1\nlinks: {crank: {}}\njoints:\n  O1: "


@dataclass(frozen=True)
class BadFile:
    text: str
    place: str
    words: str
    editor: bool = True


def _after(line: str, column: int, words: str, editor: bool = True) -> BadFile:
    """A sound file with one more line, the fifth."""
    return BadFile(SOUND + line + "\n", f"5:{column}", words, editor)


def _joint(mapping: str, column: int, words: str, editor: bool = True) -> BadFile:
    """A file whose only joint O1 is the mapping; columns count from the mapping's brace."""
    return BadFile(JOINT + mapping + "\n", f"4:{column + 6}", words, editor)


YAML_MISTAKES = [
    BadFile("", "1:1", "file is empty"),
    BadFile("# only a comment\n", "1:1", "file is empty"),
    BadFile("- format: 1\n", "1:1", "top level must be a mapping"),
    BadFile("format 1\n", "1:1", "top level must be a mapping"),
    BadFile("format: 1\n---\nformat: 1\n", "2:1", "second YAML document"),
    BadFile("%YAML 1.2\n---\nformat: 1\n", "1:1", "directives"),
    _after("name:", 1, "'name' has no value"),
    _after("name: ~", 1, "'name' has no value"),
    _after("points: {p: , q: {link: crank, at: [0, 0, 0]}}", 10, "'p' has no value"),
    BadFile(SOUND + "follow:\n  - O1\n  -\n", "6:3", "item 2 of this list is empty"),
    _after("format: 1", 1, "the first is at line 1, column 1", editor=False),
    _after("parameters: {a: 1, b: 2, a: 3}", 26, "'a' is written twice", editor=False),
    _after("parameters: {a: &x 1}", 17, "anchors", editor=False),
    _after("parameters: {a: *x}", 17, "aliases"),
    _after("parameters: {<<: {a: 1}}", 14, "merge keys", editor=False),
    _after("name: !!str 12", 7, "tags", editor=False),
    _after("parameters: {[a]: 1}", 14, "cannot be a key"),
    _after("parameters: {a:1}", 14, "blank after the colon: a: 1"),
    _after("name: a: b", 8, "':' cannot stand here"),
    _after("name home\nfollow: [O1]", 1, "a ':' is missing after this key"),
    BadFile(SOUND + "parameters:\n  a 1\n\n  b: 2\n", "6:3", "a ':' is missing after this key"),
    _after("quantities: {q: [1, 2, 3]}", 17, 'in quotes: "[x, y, z]"'),
    _after("name: @home", 7, "cannot start a value"),
    _after("name: 'home", 7, "never closed"),
    _after('name: "a \\q b"', 7, "escape"),
    _after("follow: [O1, O2", 9, "not closed"),
    _after("follow: [O1, O2}", 16, "',' or ']' was expected"),
    _after("points: {p: {link: crank", 13, "not closed"),
    _after("follow: [O1]]", 13, "a key was expected"),
    _after("   name: x", 4, "a key was expected"),
    BadFile(SOUND + "motion:\n\tinputs: {}\n", "6:1", "tab"),
    _after("loads: [,]", 9, "value is missing"),
    _after("name: x\x00y", 8, "NUL"),
    _after("name: x\u2028y", 8, "U+2028"),
    _after('name: "x\\0y"', 7, "stands for a NUL", editor=False),
    _after('name: "\\e[31mx"', 7, "stands for the invisible character U+001B", editor=False),
    _after("follow: [O1, *", 15, "anchors, aliases and tags"),
    _after("tables: [{name: t, columns: [{label: d, value: det(a, b, c)}]}]", 48, '"det(a, b, c)"'),
    _after("parameters: {a: atan2(1, 2)/2, b: 3}", 17, 'in quotes: "atan2(1, 2)/2"'),
    _after("directions: {d: {link: crank, vector: [max(1, 2), 0, 0]}}", 40, '"max(1, 2)"'),
    _after("parameters: {a: dot([1, 0, 0], d)}", 17, '"dot([1, 0, 0], d)"'),
    _after(f"name: {'[' * 200_000}", 38, "32 deep"),
]

SHAPE_MISTAKES = [
    BadFile("name: x\njoints: {}\n", "1:1", "key format is missing"),
    BadFile("format: 2\njoints: {}\n", "1:9", "reads format 1"),
    BadFile("format: 1\n", "1:1", "no joints"),
    _after("tabels: []", 1, "did you mean tables?"),
    _after("links2: 3", 1, "did you mean links?"),
    _after("points: [p]", 9, "points: expected a mapping, found a list of 1"),
    _after("loads: {type: gravity}", 8, "loads: expected a list"),
    _after("parameters: {2a: 1}", 14, "'2a' is not a name"),
    _after("parameters: {sin: 1}", 14, "sin is reserved"),
    _after("parameters: {time: 1}", 14, "time is reserved"),
    _after("parameters: {crank: 1}", 14, "crank is already used in links", editor=False),
    _after("directions: {O1: {link: crank, vector: [0, 0, 1]}}", 14, "already used", editor=False),
    _after("parameters: {a: .nan}", 17, "not a finite number", editor=False),
    _after("parameters: {a: -Inf}", 17, "not a finite number"),
    _after("parameters: {a: [1]}", 17, "expected a number or an expression, found a list of 1"),
    _after("parameters: {a: ''}", 17, "empty text"),
    _after("units: {lenght: in}", 9, "did you mean length?"),
    _after("points: {p: {link: crank, at: [0, 0]}}", 31, "found 2 entries"),
    _after("points: {p: {link: crank, at: [0, 0, 0, 0]}}", 31, "found 4 entries"),
    _after("points: {p: {link: crank}}", 13, "the key at is missing"),
    _after("directions: {d: {link: 7, vector: [0, 0, 1]}}", 24, "'7' is not a name"),
    _after("accept: [everything]", 10, "unphysical-inertia"),
    _after("idle: holds", 7, "is not one of the words allowed here; did you mean hold?"),
    _after("assembly: {near: {O1.theta: 1}, mode: B}", 39, "both choose"),
    _after("assembly: {turns: -1}", 19, "below the limit 0"),
    _after("assembly: {near: {O1: 1}}", 19, "not a joint coordinate"),
    _joint("{type: Q}", 8, "is not a known joint type; known words: R, P, C"),
    _joint("{type: r}", 8, "did you mean R?"),
    _joint("{links: [ground, crank]}", 1, "the key type is missing"),
    _joint("hinge", 1, "expected a mapping, found 'hinge'"),
    _joint("{type: W, links: [ground]}", 18, "found 1 entry"),
    _joint("{type: W, links: [crank, crank]}", 26, "joined to itself", editor=False),
    _joint("{type: R, links: [ground, crank], point: [0, 0, 0]}", 1, "the key axis is missing"),
    _joint("{type: S, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}", 53, "axis"),
    _joint(
        "{type: H, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1], pitch: 2, lead: 2}",
        70,
        "use lead: length per turn",
    ),
    _joint(
        "{type: S, links: [ground, crank], point: {ground: [0, 0, 0], b: [0, 0, 0]}}",
        62,
        "write point: {ground: [...], crank: [...]}",
        editor=False,
    ),
    _joint("{type: S, links: [ground, crank], point: {ground: [0, 0, 0]}}", 42, "found 1 entry"),
]

SECTION_MISTAKES = [
    BadFile(
        "format: 1\nlinks:\n  a: {mass: 1}\njoints: {w: {type: W, links: [ground, a]}}\n",
        "3:13",
        "needs a center_of_mass",
    ),
    BadFile(
        "format: 1\nlinks:\n  a: {centre_of_mass: [0, 0, 0]}\n"
        "joints: {w: {type: W, links: [ground, a]}}\n",
        "3:7",
        "spelled center_of_mass",
    ),
    BadFile("format: 1\nchain:\n- {joint: a, type: H, link: ground}\n", "3:3", "needs its lead"),
    BadFile(
        "format: 1\nchain:\n- {joint: a, type: R, link: ground, lead: 1}\n", "3:43", "only a joint"
    ),
    BadFile(
        "format: 1\nchain:\n- {joint: a, type: R, link: b}\n- {joint: a, type: R, link: ground}\n",
        "4:11",
        "already used in chain",
        editor=False,
    ),
    _after("motion: {inputs: {O1: {at: 1}}}", 19, "not a joint coordinate"),
    _after("motion: {inputs: {O1.theta: {from: 0, to: 9}}}", 29, "a step or a count"),
    _after("motion: {inputs: {O1.theta: {from: 0, to: 9, step: 1, count: 9}}}", 62, "both define"),
    _after("motion: {inputs: {O1.theta: {from: 0, to: 9, count: 2.5}}}", 53, "whole number"),
    _after("motion: {inputs: {O1.theta: {from: 0, to: 9, count: 0}}}", 53, "below the limit 1"),
    _after("motion: {inputs: {O1.theta: {from: 0, to: 9, stp: 1}}}", 46, "did you mean step?"),
    _after("motion: {inputs: {O1.theta: {values: []}}}", 38, "at least 1"),
    _after(
        "motion: {inputs: {O1.theta: {law: cubic}}}",
        35,
        "is not a known law; known words: constant-rate",
    ),
    _after(
        "motion: {inputs: {O1.theta: {law: harmonic, from: 0, to: 1}}}",
        29,
        "add time: {from, to, step}",
        editor=False,
    ),
    _after(
        "motion: {time: {from: 0, to: 1, step: 1}, inputs: {O1.theta: {values: [1]}}}",
        62,
        "rows of its own",
        editor=False,
    ),
    _after("loads: [{type: weight}]", 16, "weights follow from the masses"),
    _after("loads: [{type: wait}]", 16, "is not a known load type; known words: gravity"),
    _after("loads: [{type: torque, joint: O1}]", 9, "the key value is missing"),
    _after("loads: [{type: spring, joint: O1, coordinate: theta, stifness: 1}]", 54, "stiffness?"),
    _after("loads: [{type: force, joint: O1, value: {table: ../x.csv}}]", 49, "beside or below"),
    _after("loads: [{type: force, joint: O1, value: {table: /x.csv}}]", 49, "relative path"),
    _after(
        "loads: [{type: torque, link: crank, torque: [0, 0, 1], axes: body}]", 62, "ground, link"
    ),
    _after("tables: [{name: rows, columns: [O1.theta]}]", 17, "a table rows of its own"),
    _after("tables: [{name: Errata, columns: [O1.theta]}]", 17, "written to the page errata"),
    _after("tables: [{name: t, columns: [a], published: ../a.csv}]", 45, "not a CSV file beside"),
    _after("tables: [{name: t, columns: [a], published: {file: a.txt}}]", 52, "not a CSV file"),
    _after(
        "tables: [{name: t, columns: [a], published: {remarks: []}}]", 45, "key file is missing"
    ),
    _after(
        "tables: [{name: t, columns: [a], published: {file: a.csv, remarks: [{text: ''}, b]}}]",
        81,
        "expected a mapping",
    ),
    _after(
        "tables: [{name: t, columns: [a], published: {file: a.csv, remarks: "
        "[{columns: [a, b], text: c}]}}]",
        83,
        "the table has no column 'b'",
        editor=False,
    ),
    _after(
        "tables: [{name: t, columns: [a], published: {file: a.csv, rows_by: time}}]",
        68,
        "no column 'time' to find its rows by",
        editor=False,
    ),
    _after(
        "tables: [{name: t, columns: [a], published: {file: a.csv, remarks: "
        "[{data: [], text: c}]}}]",
        76,
        "at least 1",
    ),
    _after("tables: [{name: Disagreements, columns: [a]}]", 17, "written to a table disagreements"),
    _after("coefficients: [{row: 1}]", 16, "the key name is missing"),
    _after("coefficients: [{name: t, row: 0}]", 31, "below the limit 1"),
    _after("coefficients: [{name: t, along: {O3: [B]}}]", 38, "at least 2"),
    _after("coefficients: [{name: t, sphere: O3}]", 26, "there is no key 'sphere' here"),
    _after("tables: [{name: ../t, columns: [O1.theta]}]", 17, "not a name for a file"),
    _after("tables: [{name: a/b, columns: [O1.theta]}]", 17, "not a name for a file"),
    _after('tables: [{name: "a\\n", columns: [O1.theta]}]', 17, "not a name for a file"),
    _after("tables: [{name: '', columns: [O1.theta]}]", 17, "not a name for a file"),
    _after(f"tables: [{{name: {'t' * 101}, columns: [O1.theta]}}]", 17, "at most 100"),
    _after("tables: [{name: con, columns: [O1.theta]}]", 17, "a device on Windows"),
    _after("tables: [{name: Lpt1, columns: [O1.theta]}]", 17, "a device on Windows"),
    _after("tables: [{name: t, columns: []}]", 29, "at least 1"),
    _after("tables: [{name: t, columns: [{value: O1.theta}]}]", 30, "the key label is missing"),
    _after(
        "tables: [{name: t, columns: [{label: a, value: 1, decimals: 99}]}]",
        61,
        "above the limit 17",
    ),
    _after("tables: [{name: t, columns: [a, b, a]}]", 36, "'a' is used twice", editor=False),
    _after(
        "tables: [{name: t, columns: [a]}, {name: T, columns: [a]}]",
        42,
        "two tables are called T",
        editor=False,
    ),
]

BAD_FILES = [*YAML_MISTAKES, *SHAPE_MISTAKES, *SECTION_MISTAKES]
