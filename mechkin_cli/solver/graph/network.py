"""The mechanism as a network: links are vertices, every joint and every leg is a connection.

Independent of any tree. A leg is one distance equation between the links that it joins.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.legs import Leg
from mechkin_cli.mechanism.model import Joint, Mechanism, Spring
from mechkin_cli.solver.reduction import Reduction


class Connection(NamedTuple):
    """A joint or a leg between two links.

    `driven` counts its driven freedoms (of a leg: of its slide); `stays` says that no loop may be
    closed at it.
    """

    name: str
    first: str
    second: str
    joint: Joint
    driven: int = 0
    stays: bool = False
    leg: Leg | None = None

    @property
    def freedoms(self) -> int:
        """Freedoms between the two links, a leg's slide included."""
        if self.leg is None:
            return self.joint.type.freedoms
        return 5 if self.leg.slide is None else 6

    @property
    def equations(self) -> int:
        """Closing equations."""
        return 1 if self.leg is not None else self.joint.type.equations

    @property
    def space(self) -> int:
        """Freedoms of a free body where it works: six, or three in a plane."""
        return self.joint.type.space

    @property
    def has_screws(self) -> bool:
        """Whether its freedoms are screws of a joint: neither a leg nor a free pair."""
        return self.leg is None and not self.joint.type.is_free

    def other(self, link: str) -> str:
        """The link at the other end."""
        return self.second if link == self.first else self.first


def connections_of(
    mechanism: Mechanism, whole: Reduction, inputs: Sequence[tuple[str, str]]
) -> list[Connection]:
    """The joints in the order written, then the legs.

    Inputs stay in the tree, and springs whose angle goes beyond half a turn, which a closing joint
    does not count; so do H and free pairs, which close no loop, and joints of loops that are cut.
    """
    driven = Counter(joint for joint, _ in inputs)
    sprung = {
        load.joint
        for load in mechanism.loads
        if isinstance(load, Spring) and load.joint and is_angle(load.coordinate or "")
    }
    found = [
        Connection(
            name,
            joint.first,
            joint.second,
            joint,
            driven[name],
            name in driven or name in sprung or name in whole.cut or not joint.type.equations,
        )
        for name, joint in whole.joints.items()
    ]
    for leg in whole.legs:
        count = driven[leg.slide.name] if leg.slide is not None else 0
        found.append(Connection(leg.end.name, leg.first, leg.second, leg.end, count, True, leg))
    return found


def incidence(connections: Sequence[Connection]) -> dict[str, list[int]]:
    """Numbers of the connections at each link, in their order."""
    found: dict[str, list[int]] = {}
    for number, c in enumerate(connections):
        found.setdefault(c.first, []).append(number)
        found.setdefault(c.second, []).append(number)
    return found


def distances(
    connections: Sequence[Connection], at: dict[str, list[int]], root: str
) -> dict[str, int]:
    """Number of connections between each link and the root."""
    found = {root: 0}
    front = [root]
    for link in front:
        for number in at.get(link, ()):
            other = connections[number].other(link)
            if other not in found:
                found[other] = found[link] + 1
                front.append(other)
    return found
