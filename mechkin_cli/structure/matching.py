"""Matching of equations to freedoms, and what follows from it: the Dulmage-Mendelsohn parts.

Nodes have a capacity (freedoms of a link), rows equations, each of which may be taken up
by one freedom of any of its nodes. A largest matching (augmenting paths; Kuhn 1955) leaves

- freedoms free: the nodes from which these can be reached are not determined;
- the others, whose strong components (Tarjan 1972) are the smallest sets of nodes that their
  equations determine together, each after those that it depends on (Dulmage, Mendelsohn 1958).

Where there are too many equations, the parts depend on which are left over, and on nothing else.
Rows come first whose nodes have fewest free freedoms left, then by their turns: so small sets are
full before equations are spent on larger ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heapify, heappop, heappush

from mechkin_cli.record import NamedTuple


class Row(NamedTuple):
    """`equations` between the freedoms of some nodes."""

    equations: int
    nodes: tuple[int, ...]


class Matching:
    """A largest matching: `taken[node][row]` equations of a row at a node, `free[node]` freedoms
    left."""

    def __init__(
        self, capacities: Sequence[int], rows: Sequence[Row], turns: Sequence[int] | None = None
    ) -> None:
        self.rows = rows
        self.turns = range(len(rows)) if turns is None else turns
        self.free = list(capacities)
        self.taken: list[dict[int, int]] = [{} for _ in capacities]
        self._closed = [False] * len(self.free)
        self._match_all()

    def _match_all(self) -> None:
        """Takes every row, first those whose nodes have fewest free freedoms."""
        at: list[list[int]] = [[] for _ in self.free]
        for number, row in enumerate(self.rows):
            for node in row.nodes:
                at[node].append(number)
        open_at = [sum(self.free[node] for node in row.nodes) for row in self.rows]
        turns = self.turns
        ahead = [(count, turns[number], number) for number, count in enumerate(open_at)]
        heapify(ahead)
        done = [False] * len(self.rows)
        while ahead:
            count, _, number = heappop(ahead)
            if done[number] or count != open_at[number]:
                continue
            done[number] = True
            left = self.rows[number].equations
            while left and (step := self._take(number, left)):
                left -= step[0]
                for other in at[step[1]]:
                    open_at[other] -= step[0]
                    if not done[other]:
                        heappush(ahead, (open_at[other], turns[other], other))

    def _take(self, number: int, most: int) -> tuple[int, int] | None:
        """Matches some equations of a row, at most so many: how many, and the node that takes them
        up in the end. None where none can be matched."""
        came: dict[int, tuple[int, int]] = {}
        front = [node for node in self.rows[number].nodes if not self._closed[node]]
        came.update((node, (-1, number)) for node in front)
        for node in front:
            if self.free[node]:
                return self._shift(node, came, most), node
            for row in self.taken[node]:
                for other in self.rows[row].nodes:
                    if other not in came and not self._closed[other]:
                        came[other] = (node, row)
                        front.append(other)
        # no path leads out of these nodes any more, whatever is matched later
        for node in front:
            self._closed[node] = True
        return None

    def _shift(self, node: int, came: dict[int, tuple[int, int]], most: int) -> int:
        """Moves equations along the path to a node with free freedoms."""
        step, at = min(most, self.free[node]), node
        while came[at][0] >= 0:
            at, row = came[at]
            step = min(step, self.taken[at][row])
        self.free[node] -= step
        while node >= 0:
            before, row = came[node]
            self.taken[node][row] = self.taken[node].get(row, 0) + step
            if before >= 0:
                self.taken[before][row] -= step
                if not self.taken[before][row]:
                    del self.taken[before][row]
            node = before
        return step

    @property
    def is_redundant(self) -> bool:
        """Whether some equations find no freedom."""
        matched = sum(sum(taken.values()) for taken in self.taken)
        return matched < sum(row.equations for row in self.rows)

    def undetermined(self) -> set[int]:
        """Nodes with freedoms that no equation determines, or that depend on such."""
        at: list[list[int]] = [[] for _ in self.free]
        for node, taken in enumerate(self.taken):
            for row in taken:
                for other in self.rows[row].nodes:
                    if other != node:
                        at[other].append(node)
        front = [node for node, free in enumerate(self.free) if free]
        reached = set(front)
        for node in front:
            for other in at[node]:
                if other not in reached:
                    reached.add(other)
                    front.append(other)
        return reached

    def parts(self, left_out: set[int]) -> list[list[int]]:
        """The other nodes in smallest sets that are determined together, in order: by their
        distance from what depends on nothing, then by the turns of their rows."""
        ahead = [
            sorted({other for row in taken for other in self.rows[row].nodes} - left_out)
            for taken in self.taken
        ]
        parts = strong_components(ahead, [n for n in range(len(ahead)) if n not in left_out])
        level: dict[int, int] = {}
        keys = []
        for k, part in enumerate(parts):
            before = {other for node in part for other in ahead[node]}.difference(part)
            own = 1 + max((level[node] for node in before), default=0)
            level.update((node, own) for node in part)
            turns = sorted(self.turns[row] for node in part for row in self.taken[node])
            keys.append((own, turns, k))
        return [parts[k] for _, _, k in sorted(keys)]


def strong_components(ahead: Sequence[Sequence[int]], nodes: Sequence[int]) -> list[list[int]]:
    """Strong components of a directed graph, each after all those that it leads to."""
    number: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    waiting: set[int] = set()
    components: list[list[int]] = []
    for start in nodes:
        if start in number:
            continue
        number[start] = low[start] = len(number)
        stack.append(start)
        waiting.add(start)
        path = [(start, iter(ahead[start]))]
        while path:
            node, rest = path[-1]
            for other in rest:
                if other not in number:
                    number[other] = low[other] = len(number)
                    stack.append(other)
                    waiting.add(other)
                    path.append((other, iter(ahead[other])))
                    break
                if other in waiting:
                    low[node] = min(low[node], number[other])
            else:
                path.pop()
                if path:
                    low[path[-1][0]] = min(low[path[-1][0]], low[node])
                if low[node] == number[node]:
                    members = [stack.pop()]
                    while members[-1] != node:
                        members.append(stack.pop())
                    waiting.difference_update(members)
                    components.append(sorted(members))
    return components
