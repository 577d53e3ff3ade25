"""`responses:` and `equilibria:` - start, assembly, efforts, drives, moments and stops of each.

Values of a start name the independent coordinates. There are as many rates as values: those that
are not written are zero, unless a rate of another coordinate stands for one of them; then all are
named.

First, what all runs share: `assembly:` and `follow:` - the assembly of the first row, and the loops
that are followed; and the idle freedoms of a built problem.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import isfinite, pi
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli import idle, mobility, tolerances
from mechkin_cli.building.fields import Clock, Fields, Path, dimension_of, is_coordinate
from mechkin_cli.building.load_laws import LoadLaws
from mechkin_cli.building.motion import build_inputs, spaced_moments
from mechkin_cli.building.spacing import has_too_many_rows, sampled
from mechkin_cli.diagnostics import InvalidFile, nearest_hint
from mechkin_cli.expressions import parse
from mechkin_cli.mechanism import (
    Assembly,
    CrossingEnd,
    DeadCentreEnd,
    EquilibriumSearch,
    Joint,
    JointLoad,
    Limit,
    LoadLaw,
    Moments,
    MotionInputs,
    Problem,
    ResponseProblem,
    SpacedMoments,
    StartValue,
    Stop,
    TurnsEnd,
    is_angle,
)
from mechkin_cli.record import replace
from mechkin_cli.schema import AssemblySection, TimeSection, responses as written
from mechkin_cli.session import jumps_of
from mechkin_cli.units import DIMENSIONLESS, TIME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.building.fields import Fields, Path
    from mechkin_cli.building.loads import LoadBuilder
    from mechkin_cli.mechanism import (
        Assembly,
        DrivenInput,
        DrivenRows,
        Joint,
        LockedFreedom,
        Mechanism,
        Problem,
        Wanted,
    )


def build_assembly(
    fields: Fields, section: AssemblySection | None, joints: Mapping[str, Joint]
) -> Assembly:
    """The assembly that the section chooses, with its coordinates in SI."""
    if section is None:
        return Assembly()
    near = near_values(fields, ("assembly", "near"), section.near, joints)
    straight = section.at_branch_points is not None
    return Assembly(near, section.mode, section.turns, straight)


def near_values(
    fields: Fields, path: Path, texts: Mapping[str, str], joints: Mapping[str, Joint]
) -> dict[str, float]:
    """The coordinates (rad, m) of the section `near` at `path`."""
    near = {}
    for name, text in texts.items():
        place = (*path, name)
        if is_coordinate(fields, place, name, joints):
            near[name] = fields.number(place, text, dimension_of(name.rpartition(".")[2]))
    return near


def build_follow(
    fields: Fields, names: tuple[str, ...] | None, joints: Mapping[str, Joint]
) -> tuple[str, ...] | None:
    """The joints that `follow:` lists, each of which must exist; None without it."""
    for i, name in enumerate(names or ()):
        if name not in joints and not fields.is_refused(name):
            hint = nearest_hint(name, list(joints))
            fields.error("unknown-joint", ("follow", i), f"there is no joint {name}", hint)
    return names


def held_of(problem: Problem) -> tuple[LockedFreedom, ...]:
    """The locks of the idle freedoms."""
    held, as_drawn = idle.held_freedoms(problem.mechanism, problem.motion.driven)
    return mobility.held_along(problem, held) if as_drawn else held


def note_spins(fields: Fields, problem: Problem, *, free: bool = False) -> None:
    """Notes causes that would drive the idle freedoms: kinematics alone does not determine how they
    move, nor does a `free` motion whose start does not name them."""
    if not problem.has_idle:
        return
    for link, diagnostic in idle.spin_errors(problem, free=free):
        placed = diagnostic._replace(place=fields.document.place(("links", link)))
        if placed not in fields.diagnostics:
            fields.diagnostics.append(placed)


def settled(problem: Problem) -> Problem:
    """The problem without the moments of inertia that nothing turns."""
    return idle.without_spin(problem) if problem.held else problem


RATE = "_dot"


def build_start(
    fields: Fields,
    path: Path,
    section: written.Response | written.Equilibrium,
    joints: Mapping[str, Joint],
    window: Sequence[Limit] = (),
) -> tuple[StartValue, ...]:
    """The start of the run at `path`, in the order of the file; that of equilibria in a window is
    its middle."""
    key, texts = _started(section)
    path = (*path, key)
    middles = {one.name: 0.5 * (one.low + one.high) for one in window}
    errors = fields.error_count
    values: dict[str, float] = {}
    rates: dict[str, float] = {}
    for key, text in texts.items():
        name, place = key.removesuffix(RATE), (*path, key)
        if not is_coordinate(fields, place, name, joints):
            continue
        coordinate = name.rpartition(".")[2]
        if _same_freedom(name, section.driven, joints):
            message = f"{name} is driven, so its law defines where it starts"
            if isinstance(section, written.Equilibrium):
                message = f"{name} is held, so no load decides where it is"
            fields.key_error("start-and-drive", place, message, "remove it here, or under driven:")
        elif key.endswith(RATE) and isinstance(text, str):
            rates[name] = fields.number(place, text, dimension_of(coordinate, 1))
        elif other := _same_freedom(name, values, joints):
            message = f"{other} and {name} are one freedom"
            fields.key_error("driven-twice", place, message, "start one of them")
        elif isinstance(text, written.CoordinateWindow):
            values[name] = middles[name]
        else:
            values[name] = fields.number(place, text, dimension_of(coordinate))
    if fields.error_count == errors:
        rates = _all_rates(fields, path, values, rates)
    names = dict.fromkeys(key.removesuffix(RATE) for key in texts)
    return tuple(
        StartValue(*_split(name), values.get(name), rates.get(name))
        for name in names
        if name in values or name in rates
    )


def _started(
    section: written.Response | written.Equilibrium,
) -> tuple[str, Mapping[str, str | written.CoordinateWindow]]:
    """The key under which a run names its independent coordinates, and what stands there."""
    if isinstance(section, written.Response):
        return "start", section.start
    return ("window", section.window) if section.window else ("near", section.near)


def _window(
    fields: Fields, path: Path, section: written.CoordinateWindow, coordinate: str
) -> tuple[float, float]:
    """The least and the largest value of a window (rad, m)."""
    dimension, errors = dimension_of(coordinate), fields.error_count
    low = fields.number((*path, "from"), section.first, dimension)
    high = fields.number((*path, "to"), section.last, dimension)
    if fields.error_count == errors and not high > low:
        text = "this window is empty: its end is not above its beginning"
        fields.error("empty-window", (*path, "to"), text, "give from: the least value")
    turns = (high - low) / (2.0 * pi)
    if fields.error_count == errors and is_angle(coordinate):
        most = tolerances.MOST_WINDOW_TURNS
        if turns > most:
            text = f"this window is too wide: it has {turns:.4g} turns (limit {most})"
            hint = "one turn has all places, but for springs on angles, which count turns"
            fields.error("wide-window", (*path, "to"), text, hint)
    return low, high


def _split(name: str) -> tuple[str, str]:
    joint, _, coordinate = name.rpartition(".")
    return joint, coordinate


def _same_freedom(name: str, others: Iterable[str], joints: Mapping[str, Joint]) -> str | None:
    """The first of other coordinates that has the freedom of one, as the turn and the slide of a
    thread have."""
    joint, coordinate = _split(name)
    freedom = joints[joint].type.freedom_of
    for other in others:
        owner, own = _split(other)
        if owner == joint and own in freedom and freedom[own] == freedom[coordinate]:
            return other
    return None


def _all_rates(
    fields: Fields, path: Path, values: Mapping[str, float], rates: Mapping[str, float]
) -> dict[str, float]:
    """As many rates as values."""
    others = [name for name in rates if name not in values]
    if not others:
        return {name: rates.get(name, 0.0) for name in values}
    if len(rates) == len(values):
        return dict(rates)
    place = (*path, f"{others[0]}{RATE}")
    text = f"start has {_counted(rates, 'rate')} for {_counted(values, 'coordinate')}"
    if len(rates) > len(values):
        hint = "give as many rates as coordinates: remove a rate"
    else:
        missing = [f"{name}{RATE}" for name in values if name not in rates]
        hint = f"with a rate of another coordinate name all: add {' or '.join(missing)}"
    fields.key_error("start-rates", place, text, hint)
    return dict(rates)


def _counted(named: Mapping[str, float], word: str) -> str:
    return f"{len(named)} {word}{'s' * (len(named) != 1)}"


_DIRECTIONS = {"up": " upwards", "down": " downwards", "any": ""}


class StopBuilder:
    """Builds the stops of one run; errors are noted in `fields`."""

    def __init__(
        self,
        fields: Fields,
        joints: Mapping[str, Joint],
        run: str,
        quantities: Mapping[str, Wanted],
    ) -> None:
        self.fields, self.joints = fields, joints
        self.laws = LoadLaws(fields, {run: quantities}, reader="a stop")

    def build(self, path: Path, sections: Sequence[written.Stop]) -> tuple[Stop, ...]:
        """The stops of the response at `path`."""
        stops = [self._stop((*path, "stop", i), section) for i, section in enumerate(sections)]
        return tuple(stop for stop in stops if stop is not None)

    def _stop(self, path: Path, section: written.Stop) -> Stop | None:
        if isinstance(section, written.Crossing):
            return self._crossing(path, section)
        place, count = self.fields.document.place(path), section.count
        at_dead_centre = isinstance(section, written.DeadCentre)
        key = "dead_centre" if at_dead_centre else "turns"
        name = getattr(section, key)
        at = (*path, key)
        if not is_coordinate(self.fields, at, name, self.joints, at_key=False):
            return None
        joint, coordinate = _split(name)
        if at_dead_centre:
            words = f"dead centre {count} of {name}" if count > 1 else f"dead centre of {name}"
            return DeadCentreEnd(words, place, joint, coordinate, count)
        if not is_angle(coordinate):
            text, hint = f"{name} is a slide and does not turn", "write value: and at: for a slide"
            self.fields.error("no-angle", at, text, hint)
            return None
        words = f"{count} turn{'s' * (count > 1)} of {name}"
        return TurnsEnd(words, place, joint, coordinate, count)

    def _crossing(self, path: Path, section: written.Crossing) -> CrossingEnd | None:
        watched = self.laws.watched((*path, "value"), section.value)
        if watched is None:
            return None
        law, quantity = watched
        words, at, dimension = section.value.strip(), None, quantity.dimension
        if section.at is not None or not quantity.truth:
            at = self.fields.number((*path, "at"), section.at or "0", dimension)
            amount = self.fields.units.text(at + 0.0, dimension)  # no -0
            words += f" = {amount}{_DIRECTIONS[section.direction]}"
        if section.count > 1:
            words += f", time {section.count}"
        return CrossingEnd(words, law.place, law, dimension, at, section.direction, section.count)


def build_responses(
    fields: Fields,
    sections: Mapping[str, written.Response | written.Equilibrium],
    problem: Problem,
    loads: LoadBuilder,
    known: Mapping[str, ResponseProblem] | None = None,
) -> dict[str, ResponseProblem]:
    """The responses and equilibria of a file; errors are noted in `fields`.

    Args:
        fields: of the file, with units and parameters.
        sections: as written.
        problem: mechanism and assembly of the file.
        loads: all loads of the file.
        known: the same responses in doubles, where the file is recorded: moments, drives, stops and
            tolerances are theirs.
    """
    builder = _ResponseBuilder(fields, problem, loads)
    if known is not None:
        return {name: builder.recorded(name, sections[name], known[name]) for name in sections}
    built = {}
    for name, section in sections.items():
        errors = fields.error_count
        if isinstance(section, written.Equilibrium):
            built[name] = builder.equilibrium(name, section)
        else:
            built[name] = builder.response(name, section)
        if fields.error_count > errors:
            fields.failed.add(name)
    return built


class _ResponseBuilder:
    """Builds one response after another; arguments as those of `build_responses`."""

    def __init__(self, fields: Fields, problem: Problem, loads: LoadBuilder) -> None:
        self.fields, self.problem = fields, problem
        self.joints = problem.mechanism.joints
        self.loads, self.per_row = loads, 0

    def response(self, name: str, section: written.Response) -> ResponseProblem:
        """The response of a name."""
        path: Path = ("responses", name)
        # moments, and orders of what is driven: rows may be taken block by block
        self.per_row = 2 + 8 * len(section.driven or ())
        clock = self._clock(path, section)
        driven, driven_rows = self._driven(path, section, clock)
        self._check_ties(path, driven)
        self._check_jumps(path, driven)
        efforts = self._efforts(path, section, name)
        mechanism, laws, numbers = self.loads.of_run(name, self.problem.mechanism)
        start = build_start(self.fields, path, section, self.joints)
        known: Mapping[str, Wanted] = self.loads.runs[name]
        stops = StopBuilder(self.fields, self.joints, name, known)
        return ResponseProblem(
            name=name,
            place=self.fields.document.key_place(path),
            start=start,
            assembly=self._assembly(path, section),
            efforts=tuple(effort.renumbered(numbers) for effort in efforts),
            driven=driven.inputs,
            driven_rows=driven_rows,
            course=driven.course,
            moments=clock.time,
            stops=(*self._stops(path, section, stops), *self._limits()),
            tolerance=self._tolerance(path, section.tolerance),
            fixed_step=self._fixed_step(path, section.fixed_step, clock.time),
            mechanism=self._kept(mechanism),
            load_laws=laws,
        )

    def equilibrium(self, name: str, section: written.Equilibrium) -> ResponseProblem:
        """The equilibria of a name: a response that rests, at one moment."""
        fields, path = self.fields, ("equilibria", name)
        moment = 0.0
        if section.time is not None:
            moment = fields.written((*path, "time"), section.time, TIME)
        moments = np.array([moment])
        time = Moments(fields.units.to_si(moments.copy(), TIME), moments)
        clock = Clock(time, moment, moment, 1)
        driven = build_inputs(
            fields, (*path, "driven"), section.driven, self.joints, self.per_row, clock
        ) or MotionInputs((), 1)
        efforts = self._efforts(path, section, name)
        mechanism, laws, numbers = self.loads.of_run(name, self.problem.mechanism)
        frictions = mechanism.frictions
        mechanism = replace(mechanism, frictions=())
        window = self._windows(path, section)
        return ResponseProblem(
            name=name,
            place=fields.document.key_place(path),
            start=build_start(fields, path, section, self.joints, window),
            assembly=self._assembly(path, section),
            efforts=tuple(effort.renumbered(numbers) for effort in efforts),
            driven=driven.inputs,
            course=None,
            moments=time,
            stops=(),
            tolerance=tolerances.RESPONSE_TOLERANCE,
            fixed_step=None,
            mechanism=replace(mechanism, drives=None),
            load_laws=laws,
            search=EquilibriumSearch(window, section.starts or 0),
            frictions=frictions,
        )

    def _windows(self, path: Path, section: written.Equilibrium) -> tuple[Limit, ...]:
        """The window, of the coordinates that there are."""
        found = []
        for name, texts in section.window.items():
            joint, coordinate = _split(name)
            if joint not in self.joints or coordinate not in self.joints[joint].type.coordinates:
                continue  # refused as a start
            at = (*path, "window", name)
            low, high = _window(self.fields, at, texts, coordinate)
            found.append(Limit(joint, coordinate, low, high, self.fields.document.place(at)))
        return tuple(found)

    def _stops(
        self, path: Path, section: written.Response, builder: StopBuilder
    ) -> tuple[Stop, ...]:
        """The stops that are written; none counts over impacts, at which a new motion begins."""
        stops = builder.build(path, section.stop)
        if all(limit.restitution is None for limit in self.problem.limits):
            return stops
        for i, stop in enumerate(section.stop):
            if isinstance(stop, written.Turns) or stop.count > 1:
                text = "with limits that have a restitution a stop does not count"
                hint = "end at a value: {value: A.theta, at: 720 deg}; or leave out the restitution"
                self.fields.error("counted-stop", (*path, "stop", i), text, hint)
        return stops

    def _kept(self, mechanism: Mechanism) -> Mechanism:
        """The mechanism of a response, which keeps the joints that may rest at their limits."""
        limits = (limit for limit in self.problem.limits if limit.restitution is not None)
        return replace(mechanism, drives=None, kept=frozenset(limit.joint for limit in limits))

    def _limits(self) -> Iterator[CrossingEnd]:
        """The stops at the limits of coordinates."""
        directions: tuple[Literal["down", "up"], ...] = ("down", "up")
        for limit in self.problem.limits:
            for direction, at in zip(directions, (limit.low, limit.high), strict=True):
                if isfinite(at):
                    dimension = dimension_of(limit.coordinate)
                    words = f"{limit.name} at its limit {self.fields.units.text(at, dimension)}"
                    law = LoadLaw((limit.name,), limit.place, parse(limit.name))
                    yield CrossingEnd(words, limit.place, law, dimension, at, direction, 1, limit)

    def recorded(
        self,
        name: str,
        section: written.Response | written.Equilibrium,
        known: ResponseProblem,
    ) -> ResponseProblem:
        """A known response whose start, loads and links are those of the recording."""
        path: Path = (known.section, name)
        efforts = self._efforts(path, section, name)
        mechanism, laws, numbers = self.loads.of_run(name, self.problem.mechanism)
        start = known.start
        if known.search is None:
            start = build_start(self.fields, path, section, self.joints)
        else:
            mechanism = replace(mechanism, frictions=known.mechanism.frictions)
        return replace(
            known,
            start=start,
            assembly=self._assembly(path, section),
            efforts=tuple(effort.renumbered(numbers) for effort in efforts),
            mechanism=self._kept(mechanism),
            load_laws=laws,
        )

    def _check_jumps(self, path: Path, driven: MotionInputs) -> None:
        """Refuses driven coordinates that jump, or whose rates do: the rates of what is free would
        jump with them."""
        course, fields = driven.course, self.fields
        if course is None:
            return
        jumps = jumps_of(course)
        for number, item in enumerate(driven.inputs):
            found = np.flatnonzero(jumps[:, number].any(axis=1))
            if not found.size:
                continue
            first = int(found[0])
            order = 0 if jumps[first, number, 0] else 1
            size = float(jumps[first, number, order])
            if order:
                size /= float(fields.units.to_si(1.0, TIME))
            dimension = dimension_of(item.coordinate, order)
            moment = f"{course.edges[first + 1]:.6g} {fields.units.label(TIME)}"
            word = "the rate of " if order else ""
            fields.error(
                "driven-jump",
                (*path, "driven", item.name),
                f"{word}{item.name} jumps at {moment}, where forces would be infinite",
                "join the stretches by a rise, such as law: cycloidal, or move time beyond it",
                measured=f"{fields.units.from_si(size, dimension):.6g} "
                f"{fields.units.label(dimension)}",
            )

    def _driven(
        self, path: Path, section: written.Response, clock: Clock
    ) -> tuple[MotionInputs, DrivenRows | None]:
        """The driven coordinates at the moments; of very many moments at a sample of them, and what
        gives them at others, by the numbers of rows."""
        place = (*path, "driven")

        def at(own: Fields, moments: Clock, *, between: bool) -> MotionInputs | None:
            return build_inputs(
                own, place, section.driven, self.joints, self.per_row, moments, between=between
            )

        if not section.driven:
            return MotionInputs((), 1), None
        every = clock.time
        if not isinstance(every, SpacedMoments):
            return at(self.fields, clock, between=True) or MotionInputs((), 1), None
        moments_at, beside = every.at, every.beside

        def some(numbers: NDArray[np.int64]) -> Clock:
            return clock._replace(time=moments_at(numbers), numbers=numbers, beside=beside)

        def in_rows(first: int, end: int) -> tuple[DrivenInput, ...]:
            own = replace(self.fields, diagnostics=[], refused=set(self.fields.refused))
            motion = at(own, some(np.arange(first, end)), between=False)
            if motion is None or own.error_count:
                raise InvalidFile([one for one in own.diagnostics if one.severity == "error"])
            return motion.inputs

        motion = at(self.fields, some(sampled(clock.run_rows)), between=True)
        return motion or MotionInputs((), 1), in_rows

    def _check_ties(self, path: Path, driven: MotionInputs) -> None:
        """Notes ties of the sweep's inputs that the response would leave out."""
        motion = self.problem.motion
        names = {f"{item.joint}.{item.coordinate}" for item in driven.inputs}
        for tie in motion.constraints:
            tied, leader = (
                f"{item.joint}.{item.coordinate}"
                for item in (motion.inputs[tie.input], motion.inputs[tie.leader])
            )
            if tied in names:
                continue
            text = (
                f"{tied} is tied to {leader} under motion:, and this response would move it freely"
            )
            hint = (
                "write a coupling instead: couplings: {K: {type: linear, terms: {"
                f"{leader}: ..., {tied}: ...}}}}}}, drive both, "
                f"{tied} by {{with: ..., drive: tie}}, or write drive: own under motion: if they "
                "are not connected"
            )
            self.fields.error("tie-left-out", path, text, hint)

    def _clock(self, path: Path, section: written.Response) -> Clock:
        """The moments of the rows."""
        place = (*path, "time")
        errors = self.fields.error_count
        if isinstance(section.time, TimeSection):
            clock = spaced_moments(self.fields, place, section.time, self.per_row, held=False)
        else:
            clock = self._listed(place, section.time)
        if clock.time.rows < 2 and self.fields.error_count == errors:
            text = "a response needs two moments, its start and a later one"
            self.fields.error("one-moment", place, text, "give time: {from, to, step}")
        return clock

    def _listed(self, place: Path, section: written.ListedTime) -> Clock:
        texts = enumerate(section.values)
        values = [self.fields.written((*place, "values", i), text, TIME) for i, text in texts]
        for i in range(1, len(values)):
            if not values[i] > values[i - 1] and not self.fields.error_count:
                text = f"{values[i]!r} is not later than the {values[i - 1]!r} before it"
                hint = "order the moments, each once"
                self.fields.error("time-backwards", (*place, "values", i), text, hint)
        has_too_many_rows(self.fields, (*place, "values"), len(values), self.per_row)
        moments = np.array(values)
        time = Moments(self.fields.units.to_si(moments.copy(), TIME), moments)
        return Clock(time, float(moments[0]), float(moments[-1]), moments.size)

    def _assembly(self, path: Path, section: written.Response | written.Equilibrium) -> Assembly:
        """The run's own choice, else the file's."""
        near: Mapping[str, float] = {}
        if isinstance(section, written.Response):
            near = near_values(self.fields, (*path, "near"), section.near, self.joints)
        if not near and section.mode is None:
            return self.problem.assembly
        return replace(self.problem.assembly, near=near, mode=section.mode)

    def _efforts(
        self, path: Path, section: written.Response | written.Equilibrium, run: str
    ) -> list[JointLoad]:
        efforts = []
        for name, value in section.efforts.items():
            place = (*path, "efforts", name)
            if not is_coordinate(self.fields, place, name, self.joints):
                continue
            if name in section.driven:
                text = f"{name} is driven, so the effort of its drive follows from the motion"
                self.fields.key_error("effort-and-drive", place, text, "remove one of the two")
                continue
            if not self.joints[name.rpartition(".")[0]].carries:
                text = f"{name} is a coordinate of no joint of the machine and carries no effort"
                hint = "write a force or torque on the link under loads:, with runs: [...]"
                self.fields.key_error("load-on-pose", place, text, hint)
                continue
            efforts.append(self.loads.add_effort(place, name, value, run))
        return efforts

    def _tolerance(self, path: Path, text: str | None) -> float:
        if text is None:
            return tolerances.RESPONSE_TOLERANCE
        errors = self.fields.error_count
        value = self.fields.number((*path, "tolerance"), text, DIMENSIONLESS)
        least, most = tolerances.RESPONSE_TOLERANCES
        if self.fields.error_count == errors and not least <= value <= most:
            self.fields.error(
                "out-of-range",
                (*path, "tolerance"),
                "this tolerance cannot be kept" if value < least else "this tolerance is too wide",
                f"write a number such as {tolerances.RESPONSE_TOLERANCE:g}",
                measured=f"{value:g}",
                limit=f"{least:g} to {most:g}",
            )
        return value

    def _fixed_step(self, path: Path, text: str | None, moments: Moments) -> float | None:
        if text is None:
            return None
        path, errors = (*path, "fixed_step"), self.fields.error_count
        value = self.fields.number(path, text, TIME)
        if self.fields.error_count > errors:
            return value
        most = tolerances.MOST_RESPONSE_STEPS
        span = moments.duration
        if not value > 0.0:
            self.fields.error("zero-step", path, "a step takes a positive time", "write 1e-3 s")
        elif span > most * value:
            message = "steps of this length are too many for the time of the response"
            hint, measured = "write a longer step, or a tolerance", f"{span / value:.3g} steps"
            limit = f"{most} steps"
            self.fields.error("too-many-steps", path, message, hint, measured=measured, limit=limit)
        return value
