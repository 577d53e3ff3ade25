"""Mechanism files that are well-formed but mean nothing: each is the sound file with one change.

`»` stands in the changed text where the message has to point; it is taken out before reading.
"""

from dataclasses import dataclass

MARK = "»"

SOUND = """\
format: 1
units: {length: mm, force: N}
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
directions: {n: {link: crank, vector: [0, k, 0]}}
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
        return self.marked.replace(MARK, "")

    @property
    def place(self) -> tuple[int, int]:
        """Line and column of the mark, from 1."""
        before = self.marked[: self.marked.index(MARK)]
        return before.count("\n") + 1, len(before) - before.rfind("\n")

    @property
    def marked(self) -> str:
        """The text with its mark."""
        assert SOUND.count(self.old) == 1, self.old
        return SOUND.replace(self.old, self.new)


def changed(old: str, new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with one text replaced."""
    return BadMechanism(old, new, code, words)


def joint(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with another joint O, of the links ground and crank."""
    old = "{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}"
    return BadMechanism(old, new.replace("LINKS", "links: [ground, crank]"), code, words)


def between(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with another joint A, of the links crank and rod."""
    old = "{type: S, links: [crank, rod], point: [0, r, 10]}"
    return BadMechanism(old, new.replace("LINKS", "links: [crank, rod]"), code, words)


def inputs(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with other inputs."""
    return BadMechanism("{O.theta: {from: -70, to: 70, step: 5}}", new, code, words)


def load(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with another load."""
    return BadMechanism("{type: gravity, g: [0, -9810, 0]}", new, code, words)


def column(new: str, code: str, *words: str) -> BadMechanism:
    """The sound file with another column."""
    return BadMechanism("columns: [O.theta]", f"columns: [{new}]", code, words)


def added(line: str, code: str, *words: str) -> BadMechanism:
    """The sound file with one more line."""
    return BadMechanism("format: 1\n", f"format: 1\n{line}\n", code, words)
