"""A coupling with a follower as a cam: its profile over a turn, what is extreme in it, what cannot
be cut, and where the follower would leave it in the rows of the sweep."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.cams.drawings import curve_bytes, dxf_bytes, svg_bytes
from mechkin_cli.cams.profile import Profile, profile_of
from mechkin_cli.diagnostics import Diagnostic, UsageError, nearest_hint
from mechkin_cli.mechanism import Follower, Joint, Term, dot, frame_on
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.show import Listed, Listing
from mechkin_cli.tables import Columns, column_of_numbers, csv_bytes
from mechkin_cli.tolerances import CAM_CLOSED, CAM_SAME
from mechkin_cli.units import ANGLE, LENGTH

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Floats
    from mechkin_cli.units import UnitSystem

POINTS = 360
"""Points of a profile, unless more are asked for."""

_ZOOMS, _FINE = 5, 200
"""An extreme is sought again between its neighbours, with so many places, so many times."""

_HALVINGS = 60


class At(NamedTuple):
    """A value in the file's units and the turn of the cam at which it stands."""

    value: float
    turn: float


Stretch = tuple[float, float]
"""From one turn of the cam to another, in the file's angle."""


@dataclass(frozen=True, repr=False)
class Cam(Listed):
    """A cam over a turn, or over the range of its table, in the file's units; `angle` and `length`
    name those.

    Attributes:
        name: of the coupling.
        turn: turns of the cam (points,).
        lift: the follower's coordinate and its derivatives by the turn in rad (4, points).
        pitch: path of the roller's centre (2, points), on the cam in its axes at turn 0: x to the
            right, y along a translating follower, or x to the pivot of an oscillating one.
        profile: the profile there (2, points).
        pressure_angle: between the profile's normal and the motion of the follower (points,).
        radius: of curvature of the profile (points,), negative where it is hollow or cut under.
        greatest_pressure_angle: by size.
        least_radius: of the round parts of the profile, None without any.
        hollow_radius: of the hollow parts, the least by size; None without any.
        undercut: stretches in which the cam would be cut away again.
        lift_off: stretches of the sweep in which the follower would have to be pulled.
        diagnostics: what a maker has to know.
    """

    name: str
    angle: str
    length: str
    measure: str
    turn: Floats
    lift: Floats
    pitch: Floats
    profile: Floats
    pressure_angle: Floats
    radius: Floats
    greatest_pressure_angle: At
    least_radius: At | None
    hollow_radius: At | None
    undercut: tuple[Stretch, ...]
    lift_off: tuple[Stretch, ...]
    base_radius: float
    diagnostics: tuple[Diagnostic, ...]

    @property
    def table(self) -> Columns:
        """All columns."""
        length, measure = self.length, self.measure
        per = (measure, f"{measure}/rad", f"{measure}/rad^2", f"{measure}/rad^3")
        words = ("lift", "lift_1", "lift_2", "lift_3")
        columns = [column_of_numbers("turn", self.angle, self.turn)]
        columns += map(column_of_numbers, words, per, self.lift)
        columns.append(column_of_numbers("pressure_angle", self.angle, self.pressure_angle))
        columns.append(column_of_numbers("radius_of_curvature", length, self.radius))
        for word, places in (("profile", self.profile), ("pitch", self.pitch)):
            if not np.isnan(places).all():
                labels = (f"{word}.x", f"{word}.y")
                columns += map(column_of_numbers, labels, (length, length), places)
        return Columns(self.name, f"cam {self.name}", tuple(columns))

    def files(self) -> dict[str, bytes]:
        """The table as CSV, the profile and the pitch curve as DXF (R12) and SVG, and `curve` as
        YAML, by file name."""
        curves, more = {"PROFILE": self.profile}, {}
        if self.has_pitch:
            curves["PITCH"] = self.pitch
            more[f"{self.name}.curve.yaml"] = curve_bytes(self.curve(), self.length)
        base = self.base_radius
        return {
            f"{self.name}.csv": csv_bytes(self.table, units=True),
            f"{self.name}.dxf": dxf_bytes(curves, base, self.length, self.is_closed),
            f"{self.name}.svg": svg_bytes(curves, base, self.is_closed),
            **more,
        }

    @property
    def has_pitch(self) -> bool:
        """Whether a point of the follower stays on one curve of the cam: not with a flat face."""
        return not bool(np.isnan(self.pitch).all())

    def curve(self) -> dict[str, Any]:
        """The pitch curve as the `curve:` of a pair `Ps` or `Sg` that leads the follower: a spline
        through the points of the table.

        Its places are those of the cam's own axes in the file's unit of length: draw the cam's axis
        at the origin, and the joint's point at the first place. The spline departs from the law by
        the fourth power of the step, if jumps of the law's jerk are among the turns.

        Returns:
            `points`, each [x, y], and `closed`.

        Raises:
            UsageError: the follower has a flat face.

        Example:
            `m.cam("K", points=3600).curve()`
        """
        if not self.has_pitch:
            raise UsageError(
                f"{self.name}: a flat face touches the cam with ever other points, so that none of "
                "them keeps to a curve; give the follower contact: roller or knife"
            )
        closed = self.is_closed
        places = self.pitch[:, :-1] if closed else self.pitch
        return {"closed": closed, "points": places.T.tolist()}

    @property
    def is_closed(self) -> bool:
        """Whether the last point of the profile is the first one."""
        gap = self.profile[:, -1] - self.profile[:, 0]
        return bool(np.abs(gap).max() <= CAM_CLOSED * np.abs(self.profile).max())

    @property
    def listing(self) -> Listing:
        """The table without the curves, and what is extreme."""
        return self.shown.listing._replace(head=f"Cam {self.name}", notes=tuple(self.notes()))

    @property
    def shown(self) -> Columns:
        """The columns without curves."""
        columns = {c.label: c for c in self.table.columns}
        labels = ("turn", "lift", "lift_1", "lift_2", "pressure_angle", "radius_of_curvature")
        return replace(self.table, columns=tuple(columns[label] for label in labels))

    def notes(self) -> list[str]:
        """What is extreme, in words."""
        angle, length = self.angle, self.length
        worst = self.greatest_pressure_angle
        notes = [f"pressure angle up to {worst.value:.6g} {angle} at {worst.turn:.6g} {angle}"]
        for word, least in (("round", self.least_radius), ("hollow", self.hollow_radius)):
            if least is not None:
                text = f"least {word} radius {least.value:.6g} {length} at {least.turn:.6g} {angle}"
                notes.append(text)
        for word, stretches in (("undercut", self.undercut), ("lift-off", self.lift_off)):
            notes += [f"{word} from {a:.6g} to {b:.6g} {angle}" for a, b in stretches]
        return notes


def cam_of(
    problem: Problem,
    name: str | None,
    points: int,
    swept: Callable[[Sequence[str]], Sequence[Floats]] | None,
) -> Cam:
    """The cam of a coupling with a follower; None: of the only one.

    Args:
        problem: of the file.
        name: of the coupling.
        points: how many steps the turn has.
        swept: gives quantities of the rows of the sweep in the file's units; None: there is none.

    Raises:
        UsageError: there is no such coupling, or none with a follower, or several.
    """
    chosen, follower, term = _chosen(problem, name)
    assert term.law is not None
    curve = term.law.curve
    whole = curve is None or term.law.period > 0.0
    first, last = (0.0, 2.0 * pi) if whole or curve is None else (curve.first, curve.last)
    turn = first + (last - first) * np.arange(points + 1) / points

    def at(places: Floats) -> Profile:
        assert term.law is not None
        return profile_of(follower, places, term.law.orders(places))

    units, found = problem.units, at(turn)
    lift = term.law.orders(turn)
    step = (last - first) / points
    seek = _Seek(at, turn, step)
    measure = ANGLE if follower.oscillates else LENGTH
    undercut = seek.undercut(found.roundness)
    in_angle = _converter(units, ANGLE)
    cut = tuple((float(in_angle(a)), float(in_angle(b))) for a, b in undercut)
    effort = f"{chosen}.torque" if follower.oscillates else f"{chosen}.force"
    lift_off: tuple[Stretch, ...] = ()
    if swept is not None:
        lift_off = _lost(*swept([f"{term.joint.name}.{term.coordinate}", effort]))
    worst = seek.extreme(np.abs(found.pressure), lambda p: np.abs(p.pressure))
    least = seek.extreme(-found.roundness, lambda p: -p.roundness)
    deepest = seek.extreme(_hollowness(found), _hollowness)
    in_length = _converter(units, LENGTH)

    def placed(extreme: At | None, convert: Any, sign: float) -> At | None:
        if extreme is None:
            return None
        return At(float(convert(sign * extreme.value)), float(in_angle(extreme.turn)))

    greatest = placed(worst, in_angle, 1.0)
    assert greatest is not None
    cam = Cam(
        chosen,
        units.label(ANGLE),
        units.label(LENGTH),
        units.label(measure),
        np.asarray(in_angle(turn)),
        np.asarray(_converter(units, measure)(lift)),
        np.asarray(in_length(found.pitch)),
        np.asarray(in_length(found.surface)),
        np.asarray(in_angle(found.pressure)),
        np.asarray(in_length(found.radius)),
        greatest,
        placed(least, in_length, -1.0),
        placed(deepest, in_length, -1.0),
        cut,
        lift_off,
        float(in_length(follower.base_radius)),
        (),
    )
    follows = next(t.joint for t in problem.mechanism.couplings[chosen].terms if t.law is None)
    turning = _turning_alike(term.joint, follows) if follower.oscillates else ()
    return replace(cam, diagnostics=(*turning, *_warnings(cam)))


def _turning_alike(cam: Joint, follower: Joint) -> Iterator[Diagnostic]:
    """Warns where an oscillating follower, as its coordinate grows, turns the way of its cam: that
    takes another profile."""
    shared = {cam.first, cam.second} & {follower.first, follower.second}
    if not (shared and cam.type.is_bearing and follower.type.is_bearing):
        return
    carrier = min(shared)
    along = dot(frame_on(cam, carrier).z, frame_on(follower, carrier).z)
    if (cam.first == carrier) != (follower.first == carrier):
        along = -along
    if along > 0.0:
        text = (
            f"as drawn, {follower.name}.theta grows the way that {cam.name}.theta turns the cam; "
            "this profile is of a follower that rises the other way round"
        )
        hint = (
            f"write the links of {follower.name} the other way round if it rises so; a follower "
            "that does not has the mirror image of the profile of the law run backwards"
        )
        yield Diagnostic("follower-turns-alike", "warning", text, hint=hint)


def _warnings(cam: Cam) -> Iterator[Diagnostic]:
    angle = cam.angle
    for first, last in cam.undercut:
        text = f"{cam.name}: the cam is undercut from {first:.6g} to {last:.6g} {angle}"
        hint = "give it a larger base_radius, a smaller roller, or a gentler law"
        yield Diagnostic("undercut", "warning", text, hint=hint)
    for first, last in cam.lift_off:
        text = f"{cam.name}: the follower leaves the cam from {first:.6g} to {last:.6g} {angle}"
        hint = "preload it by a stronger spring, or run slower"
        yield Diagnostic("lift-off", "warning", text, hint=hint)
    if not cam.is_closed:
        text = (
            f"{cam.name}: the profile does not close, as the follower ends where it did not begin"
        )
        yield Diagnostic("open-profile", "note", text)


def _converter(units: UnitSystem, dimension: Any) -> Callable[[Any], Any]:
    return lambda value: units.from_si(value, dimension)


def _chosen(problem: Problem, name: str | None) -> tuple[str, Follower, Term]:
    couplings = problem.mechanism.couplings
    cams = [key for key, relation in couplings.items() if relation.follower is not None]
    if name is None:
        if not cams:
            hint = (
                "add follower: {type: translating, contact: roller, base_radius: ..., radius: ...}"
            )
            raise UsageError(f"no coupling of this file has a follower; {hint} to a function")
        if len(cams) > 1:
            raise UsageError(f"several couplings have a follower; name one of {', '.join(cams)}")
        name = cams[0]
    if name not in cams:
        known = name in couplings
        text = f"{name} has no follower" if known else f"there is no coupling {name}"
        near = None if known else nearest_hint(name, cams)
        raise UsageError(f"{text}; {near or 'with a follower: ' + (', '.join(cams) or 'none')}")
    relation = couplings[name]
    assert relation.follower is not None
    return name, relation.follower, next(t for t in relation.terms if t.law is not None)


class _Seek:
    """Looks for places between the turns of a table."""

    def __init__(self, at: Callable[[Floats], Profile], turn: Floats, step: float) -> None:
        self.at, self.turn, self.step = at, turn, step

    def extreme(self, values: Floats, of: Callable[[Profile], Floats]) -> At | None:
        """The largest value and its turn, in SI; None where no row has one."""
        known = np.where(np.isfinite(values), values, -np.inf)
        best = int(np.argmax(known))
        if not np.isfinite(known[best]):
            return None
        found = self._zoomed(best, float(known[best]), of)
        for row in self._peaks(known, found.value + CAM_SAME * abs(found.value)):
            other = self._zoomed(row, float(known[row]), of)
            if other.value > found.value + CAM_SAME * abs(found.value):
                found = other
        return found

    def _zoomed(self, row: int, value: float, of: Callable[[Profile], Floats]) -> At:
        """The largest value around a row that has one."""
        place, width = float(self.turn[row]), self.step
        for _ in range(_ZOOMS):
            places = place + width * (np.arange(-_FINE, _FINE + 1) / _FINE)
            places = np.clip(places, self.turn[0], self.turn[-1])
            near = of(self.at(places))
            near = np.where(np.isfinite(near), near, -np.inf)
            k = int(np.argmax(near))
            if near[k] > value:
                value, place = float(near[k]), float(places[k])
            width = 2.0 * width / _FINE
        return At(value, place)

    def undercut(self, roundness: Floats) -> tuple[Stretch, ...]:
        """Where the roundness is not above zero, with its edges; also between two rows."""
        turn = np.union1d(self.turn, self._dips(roundness))
        roundness = self.at(turn).roundness
        found = []
        for begin, end in _runs_of(roundness <= 0.0):
            first, last = float(turn[begin]), float(turn[end])
            if begin > 0:
                first = self._edge(float(turn[begin - 1]), first)
            if end + 1 < turn.size:
                last = self._edge(float(turn[end + 1]), last)
            found.append((first, last))
        return tuple(found)

    def _dips(self, roundness: Floats) -> list[float]:
        """Turns of the least roundness next to rows where it may fall below zero."""
        rows = [row for row in self._peaks(-roundness, 0.0) if roundness[row] > 0.0]
        return [
            self._zoomed(row, -float(roundness[row]), lambda p: -p.roundness).turn for row in rows
        ]

    def _peaks(self, values: Floats, level: float) -> list[int]:
        """Rows next to which a largest value may lie above a level, the first and last ones
        included."""
        known = np.where(np.isfinite(values), values, -np.inf)
        # an end has one neighbour: the one behind that stands in for the other
        around = np.concatenate([known[2:3], known, known[-3:-2]])
        before, after = around[:-2], around[2:]
        # a parabola through three rows rises by less than the larger step between them
        with np.errstate(invalid="ignore"):
            reach = known + (known - np.minimum(before, after))
        return np.flatnonzero((known >= np.maximum(before, after)) & (reach >= level)).tolist()

    def _edge(self, outside: float, inside: float) -> float:
        for _ in range(_HALVINGS):
            middle = 0.5 * (outside + inside)
            if self.at(np.array([middle])).roundness[0] <= 0.0:
                inside = middle
            else:
                outside = middle
        return inside


def _hollowness(profile: Profile) -> Floats:
    return np.where(profile.hollow, profile.radius, -np.inf)


def _runs_of(holds: Any) -> list[tuple[int, int]]:
    """First and last number of each run of rows in which something holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _lost(turn: Floats, effort: Floats) -> tuple[Stretch, ...]:
    """Stretches of the rows in which the follower would have to be pulled."""
    with np.errstate(invalid="ignore"):
        pulled = effort < 0.0
    return tuple((float(turn[a]), float(turn[b])) for a, b in _runs_of(pulled))
