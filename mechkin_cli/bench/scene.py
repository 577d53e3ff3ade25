"""A mechanism on the bench: its file, its rows closed once, what is asked of it, and calls of the
kernel.

Three levels are asked for: `position` (all unknown coordinates and named points), `motion` (with
their velocities and accelerations), `everything` (with efforts and joint reactions).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.bench.chain import BodyTree, chain_of
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.session import RESIDUAL_TESTS, Ask, Batch, Packing, Session
from mechkin_cli.sweep import analyze, at_once, follow_rows
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Attached, Wanted
    from mechkin_cli.model import Model
    from mechkin_cli.show import Floats


BATCH = 2048
"""Rows of a timed call of the kernel; those of the sweep, over and over."""

MOST_PLACES = 46
"""Rows at which errors are measured and that slow methods solve: evenly spaced over the sweep."""

ALONE = Packing(0, 1)
"""The widest lanes, on one thread."""

LEVELS = ("position", "motion", "everything")
ORDERS = {"position": ("", ".position"), "velocity": ("_dot", ".velocity")}
ORDERS["acceleration"] = ("_ddot", ".acceleration")

Values = dict[str, "Floats"]
"""Quantities by name: (1, rows), vectors (3, rows); SI."""


class BenchScene:
    """A mechanism whose sweep is closed.

    Args:
        name: as tables show it.
        model: of the file.
        most_places: how many of its rows are `places`, evenly spaced.

    Raises:
        UsageError: it has no sweep, no row of it closes, or nothing is unknown in it.
        InvalidFile: the mechanism cannot be solved as it is driven.
    """

    def __init__(self, name: str, model: Model, most_places: int = MOST_PLACES) -> None:
        self.name, self.model, self.most_places = name, model, most_places
        if SWEEP not in model.runs:
            raise UsageError(
                f"{name} has no sweep to measure (no motion:); bench takes files with motion:, and "
                "has responses of its own"
            )
        self.problem = model.problem
        self.quantities = model.problem.quantities()
        self.asked = self._asked(model.session)
        if not model.session.graph.blocks:
            raise UsageError(
                f"{name} has nothing that is solved for: all its coordinates are inputs; bench "
                "takes mechanisms with closed loops"
            )
        if not self.asked["position"]:
            raise UsageError(
                f"{name} has nothing by which errors could be measured: no unknown coordinate has "
                "a name; write points: on a link that moves"
            )
        self.result = analyze(model.session.packed(ALONE), self.names("everything"))
        self.solved = np.flatnonzero(self.result.row_states.reached)
        if not self.solved.size:
            said = next((str(d) for d in self.result.diagnostics if d.severity != "note"), "")
            raise UsageError(f"{name}: no row of its sweep closes, so nothing can be timed; {said}")

    @property
    def session(self) -> Session:
        """In parts of the first row's size, as the sweep ran it."""
        return self.result.session

    @cached_property
    def places(self) -> NDArray[np.intp]:
        """The rows of the sweep that are solved one after the other and have known errors."""
        return self.solved[:: -(-self.solved.size // self.most_places)]

    @property
    def rows(self) -> int:
        """Their number."""
        return int(self.places.size)

    @cached_property
    def chain(self) -> BodyTree:
        """The mechanism for other solvers, with its named points."""
        at = {name: (a.link, a.vector) for name, a in self._points().items()}
        return chain_of(self.session.layout, at)

    def wanted(self, names: Sequence[str]) -> list[Wanted]:
        """Quantities by name."""
        return [self.quantities[name] for name in names]

    @cached_property
    def states(self) -> Floats:
        """Closed states (states, rows) of these places."""
        found: Floats = np.ascontiguousarray(self.result.row_states.states[:, self.places])
        return found

    @cached_property
    def from_before(self) -> Floats:
        """As a guess, the states of the row before; of the first row those of the second."""
        last = np.concatenate([[min(1, self.rows - 1)], np.arange(self.rows - 1)])
        found: Floats = np.ascontiguousarray(self.states[:, last])
        return found

    @cached_property
    def followed(self) -> Floats:
        """As a guess, what following the branch fills in between its nodes (states, rows)."""
        rows = follow_rows(self.session, self.result.start, every_row=False)
        found: Floats = np.ascontiguousarray(rows.states[:, self.places])
        return found

    def closing(
        self,
        level: str | Sequence[str],
        at: NDArray[np.intp],
        *,
        more: Demand = Demand.POSITION,
        iterations: int = tolerances.NEWTON_ITERATIONS,
        tests: tuple[float, float, float] = RESIDUAL_TESTS,
        packing: Packing = ALONE,
    ) -> Callable[[Floats], Batch]:
        """One call of the kernel that closes some rows of the sweep from guesses (states, rows) and
        computes a level, or some quantities, and what is demanded beside them."""
        wanted = self.wanted(self.names(level))
        session = self.session.packed(packing)
        demand = demand_of(self.problem.mechanism, wanted) | more
        states = self.result.row_states
        rows = session.row_inputs(states.states, states.turns).at(at)
        readout = session.readout(wanted)
        ask = Ask(demand, readout, iterations=iterations, tests=tests)

        def close(guess: Floats) -> Batch:
            return session.run(rows._replace(guess=guess), ask)

        return close

    def kernel(
        self, level: str | Sequence[str], guess: Floats, count: int | None = None, **options: Any
    ) -> Callable[[], Batch]:
        """The same for the places, over and over until there are `count`, with guesses (states,
        places)."""
        chosen = np.resize(np.arange(self.rows), self.rows if count is None else count)
        close = self.closing(level, self.places[chosen], **options)
        return partial(close, np.ascontiguousarray(guess[:, chosen]))

    def names(self, level: str | Sequence[str]) -> tuple[str, ...]:
        """The names of a level; other names as they are."""
        if not isinstance(level, str):
            return tuple(level)
        asked = self.asked
        moving = (*asked["position"], *asked["velocity"], *asked["acceleration"])
        return {
            "position": asked["position"],
            "motion": moving,
            "everything": (*moving, *asked["loads"]),
        }[level]

    @property
    def is_whole(self) -> bool:
        """Whether the sweep is followed from its first row to its last."""
        return bool(self.result.row_states.reached.all()) and self.result.start.row == 0

    def found(self, level: str | Sequence[str], batch: Batch) -> Values:
        """The quantities of a call by name."""
        names = self.names(level)
        slots = self.session.readout(self.wanted(names)).slots
        assert batch.outputs is not None
        return {name: batch.outputs[slots[name]] for name in names}

    @cached_property
    def closing_values(self) -> Values:
        """Named coordinates of cut joints (1, rows) in the closed rows."""
        names = [
            name
            for name, at in zip(self.chain.coordinates, self.chain.states, strict=True)
            if at is None
        ]
        names = [name for name in names if name in self.quantities]
        return self.found(names, self.kernel(names, self.states)()) if names else {}

    def verdicts(self, level: str) -> Demand:
        """What `analyze` computes for the verdicts of the rows beside a level."""
        wanted = self.wanted(self.names(level))
        _, demand = at_once(self.session, wanted, verdicts=True)
        return demand

    def _asked(self, session: Session) -> dict[str, tuple[str, ...]]:
        """Names of what is asked for, by order; `loads` are efforts and reactions."""
        coordinates, points = _unknown_coordinates(session), list(self._points())
        names = {
            order: [name + ends[0] for name in coordinates] + [name + ends[1] for name in points]
            for order, ends in ORDERS.items()
        }
        known = {o: tuple(n for n in each if n in self.quantities) for o, each in names.items()}
        return known | {"loads": self._loads(session)}

    def _loads(self, session: Session) -> tuple[str, ...]:
        """Efforts; and the wrenches of all joints, where they are unique."""
        efforts = [f"{joint}.effort" for joint, _ in self.problem.acting]
        joints = [] if session.is_redundant else list(self.problem.mechanism.joints)
        wrenches = [f"{joint}.{part}" for joint in joints for part in ("force", "moment")]
        return tuple(n for n in dict.fromkeys([*efforts, *wrenches]) if n in self.quantities)

    def _points(self) -> dict[str, Attached]:
        """Named points on links that move and have a place of their own."""
        mechanism = self.problem.mechanism
        spinning = {link for spin in mechanism.spins for link in spin.links}
        fixed = {"ground", *spinning}
        return {name: at for name, at in mechanism.points.items() if at.link not in fixed}


def _unknown_coordinates(session: Session) -> list[str]:
    """Named coordinates of the tree that are solved for."""
    graph, found = session.graph, []
    for block in graph.blocks:
        for edge, freedom in block.unknowns:
            joint = graph.edges[edge].joint
            scalars = joint.type.scalars.items()
            found += [f"{joint.name}.{name}" for name, f in scalars if f == freedom]
    mechanism = session.problem.mechanism
    return [name for name in found if name.rpartition(".")[0] in mechanism.joints]
