"""Random linkages in a plane, assembled as drawn, by their seed: Assur groups put on one another.

A crank or a slider is driven; dyads (R-R-R, R-R-P, R-P-R, P-R-P, a link with a pin in a slot) and
triads are added between links that are there. Numbers have few decimals, in m, rad, kg and N, so
that their texts are exact.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

Data = dict[str, Any]


class Linkage:
    """A file in a plane that grows group by group."""

    def __init__(self, seed: int) -> None:
        self.random = Random(seed)
        self.links: Data = {}
        self.joints: Data = {}
        self.points: Data = {}
        self.loads: list[Data] = []
        first = self.link()
        if self.random.random() < 0.75:
            self.joint("R", "ground", first)
            drive, rate = "J0.theta", "rad/s"
        else:
            self.joint("P", "ground", first)
            drive, rate = "J0.s", "m/s"
        speed = self.random.choice((-3, -1.5, 2, 4))
        reach = 0.12 if drive.endswith("theta") else 0.06
        self.motion = {
            "inputs": {drive: {"from": -reach, "to": reach, "count": 5, "rate": f"{speed} {rate}"}}
        }
        groups: tuple[Callable[[], None], ...] = (
            *(self.dyad("RRR"), self.dyad("RRR"), self.dyad("RRP"), self.dyad("RPR")),
            *(self.dyad("PRR"), self.dyad("PRP"), self.slotted, self.triad),
        )
        for _ in range(self.random.choice((1, 1, 2, 2, 3))):
            self.random.choice(groups)()
        if self.random.random() < 0.2:
            self.joint("W", self.random.choice(list(self.links)), self.link())
        self.load()

    def file(self) -> Data:
        """The file as plain data."""
        return {
            "format": 1,
            "name": "random linkage in a plane",
            "plane": "xy",
            "units": {"length": "m", "angle": "rad", "mass": "kg", "force": "N"},
            "links": self.links,
            "joints": self.joints,
            "points": self.points,
            "motion": self.motion,
            "loads": self.loads,
        }

    def place(self) -> list[float]:
        return [self.digits(-1.5, 1.5), self.digits(-1.5, 1.5)]

    def digits(self, low: float, high: float) -> float:
        return round(self.random.uniform(low, high), 3)

    def direction(self) -> list[float]:
        x, y = 0.0, 0.0
        while x * x + y * y < 0.2:
            x, y = self.digits(-1, 1), self.digits(-1, 1)
        return [x, y]

    def link(self) -> str:
        name = f"L{len(self.links)}"
        section: Data = {}
        if self.random.random() < 0.85:
            section = {"mass": self.digits(0.1, 3), "center_of_mass": self.place()}
            section["inertia"] = self.digits(0.01, 0.5)
        self.links[name] = section
        self.points[f"p{name}"] = {"link": name, "at": self.place()}
        return name

    def joint(self, kind: str, one: str, other: str) -> None:
        links = [one, other]
        if len(self.joints) and self.random.random() < 0.5:
            links.reverse()
        section: Data = {"type": kind, "links": links}
        if kind != "W":
            section["point"] = self.place()
        if kind in ("P", "Ps"):
            section["axis" if kind == "P" else "slot"] = self.direction()
        self.joints[f"J{len(self.joints)}"] = section

    def two(self) -> list[str]:
        return self.random.sample(["ground", *self.links], 2)

    def dyad(self, kinds: str) -> Callable[[], None]:
        def add() -> None:
            (one, other), (p, q) = self.two(), (self.link(), self.link())
            chain = [one, p, q, other]
            for kind, first, second in zip(kinds, chain[:-1], chain[1:], strict=True):
                self.joint(kind, first, second)

        return add

    def slotted(self) -> None:
        """A link with a pin in a slot."""
        (one, other), link = self.two(), self.link()
        self.joint(self.random.choice("RRP"), one, link)
        self.joint("Ps", link, other)

    def triad(self) -> None:
        """A ternary link on three others, each on a link that is there."""
        others = [self.random.choice(["ground", *self.links]) for _ in range(3)]
        if len(set(others)) == 1:
            others[0] = next(name for name in ["ground", *self.links] if name != others[0])
        middle = self.link()
        for other in others:
            rod = self.link()
            self.joint("R", other, rod)
            self.joint("R", rod, middle)

    def load(self) -> None:
        some = self.random.choice(list(self.links))
        joint, section = self.random.choice(list(self.joints.items())[1:])
        coordinate = {"R": "theta", "P": "s", "Ps": "s"}.get(section["type"])
        ends = self.random.sample(list(self.points), 2)
        offered: list[Data] = [
            {"type": "gravity", "g": [0, -9.81]},
            {"type": "force", "link": some, "point": self.place(), "force": [3.5, -2]},
            {
                "type": "force",
                "link": some,
                "point": self.place(),
                "force": [-1, 2],
                "axes": "link",
            },
            {"type": "torque", "link": some, "torque": 1.25},
            {"type": "spring", "between": ends, "stiffness": 20, "free": 0.4},
            {"type": "damper", "between": ends, "damping": 1.5},
        ]
        if coordinate:
            at = {"joint": joint, "coordinate": coordinate}
            offered += [{"type": "spring", **at, "stiffness": 4, "free": 0.1}]
            offered += [{"type": "damper", **at, "damping": 0.75}]
        self.loads = self.random.sample(offered, 3)
