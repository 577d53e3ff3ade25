"""`responses:` to what each response asks for: start, assembly, efforts, drives, moments, stops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.building.assembly import near_values
from mechkin_cli.building.coordinates import is_coordinate
from mechkin_cli.building.law_numbers import Clock
from mechkin_cli.building.motion import Written, build_inputs, spaced_moments
from mechkin_cli.building.start import build_start
from mechkin_cli.building.stops import StopBuilder
from mechkin_cli.mechanism.motion import Moments, Motion
from mechkin_cli.mechanism.response import Effort, Response
from mechkin_cli.schema.motion import TimeSection
from mechkin_cli.units import DIMENSIONLESS, TIME

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields, Path
    from mechkin_cli.building.loads import LoadBuilder
    from mechkin_cli.building.memory import RowLimit
    from mechkin_cli.mechanism.motion import Assembly
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.schema import responses as written


def build_responses(
    fields: Fields,
    sections: Mapping[str, written.Response],
    problem: Problem,
    loads: LoadBuilder,
    limit: RowLimit,
    known: Mapping[str, Response] | None = None,
) -> dict[str, Response]:
    """The responses of a file; what is wrong is noted in `fields`, and something stands in.

    Args:
        fields: knows units and parameters.
        sections: as written.
        problem: mechanism and assembly of the file.
        loads: has all loads of the file.
        limit: how many rows a run may have.
        known: the same responses in doubles, where the file is recorded: moments, drives, stops and
            tolerances are theirs.
    """
    builder = _Builder(fields, problem, loads, limit)
    if known is not None:
        return {name: builder.anew(name, sections[name], known[name]) for name in sections}
    return {name: builder.response(name, section) for name, section in sections.items()}


class _Builder:
    """Builds one response after another; arguments as those of `build_responses`."""

    def __init__(
        self, fields: Fields, problem: Problem, loads: LoadBuilder, limit: RowLimit
    ) -> None:
        self.fields = fields
        self.problem = problem
        self.joints = problem.mechanism.joints
        self.loads = loads
        self.limit = limit

    def response(self, name: str, section: written.Response) -> Response:
        """The response of a name."""
        path: Path = ("responses", name)
        timed = self._timed(path, section)
        driven = build_inputs(self.fields, timed, self.joints, self.limit) or Motion((), 1)
        efforts = self._efforts(path, section, name)
        acting = self.loads.of_run(name)
        start = build_start(self.fields, path, section, self.joints)
        known: Mapping[str, Wanted] = self.loads.runs[name]
        stops = StopBuilder(self.fields, self.joints, name, known)
        assert timed.time is not None
        return Response(
            name=name,
            place=self.fields.document.key_place(path),
            start=start,
            assembly=self._assembly(path, section),
            efforts=efforts,
            driven=driven.inputs,
            course=driven.course,
            moments=timed.time,
            stops=stops.build(path, section.stop),
            tolerance=self._tolerance(path, section.tolerance),
            fixed_step=self._fixed_step(path, section.fixed_step, timed.time),
            mechanism=replace(acting.on(self.problem.mechanism), drives=None),
            load_laws=acting.laws,
        )

    def anew(self, name: str, section: written.Response, known: Response) -> Response:
        """A known response whose start, loads and links are those of the recording."""
        path: Path = ("responses", name)
        efforts = self._efforts(path, section, name)
        acting = self.loads.of_run(name)
        return replace(
            known,
            start=build_start(self.fields, path, section, self.joints),
            assembly=self._assembly(path, section),
            efforts=efforts,
            mechanism=replace(acting.on(self.problem.mechanism), drives=None),
            load_laws=acting.laws,
        )

    def _timed(self, path: Path, section: written.Response) -> Written:
        """The driven coordinates as written, with the moments of the rows."""
        place = (*path, "time")
        errors = self.fields.error_count
        if isinstance(section.time, TimeSection):
            moments, last = spaced_moments(self.fields, place, section.time, self.limit)
        else:
            moments = self._listed(place, section.time)
            last = float(moments.written[-1])
        if moments.written.size < 2 and self.fields.error_count == errors:
            text = "a response needs two moments, its start and a later one"
            self.fields.error("one-moment", place, text, "give time: {from, to, step}")
        clock = Clock(moments.written, float(moments.written[0]), last)
        return Written(section.driven, (*path, "driven"), moments, clock)

    def _listed(self, place: Path, section: written.ListedTime) -> Moments:
        texts = enumerate(section.values)
        values = [self.fields.written((*place, "values", i), text, TIME) for i, text in texts]
        for i in range(1, len(values)):
            if not values[i] > values[i - 1] and not self.fields.error_count:
                text = f"{values[i]!r} is not later than the {values[i - 1]!r} before it"
                hint = "order the moments, each once"
                self.fields.error("time-backwards", (*place, "values", i), text, hint)
        self.limit.is_exceeded(self.fields, (*place, "values"), len(values))
        moments = np.array(values)
        return Moments(self.fields.units.to_si(moments.copy(), TIME), moments)

    def _assembly(self, path: Path, section: written.Response) -> Assembly:
        """The response's own choice, else the file's."""
        own = near_values(self.fields, (*path, "near"), section.near, self.joints)
        if not own and section.mode is None:
            return self.problem.assembly
        return replace(self.problem.assembly, near=own, mode=section.mode)

    def _efforts(self, path: Path, section: written.Response, run: str) -> tuple[Effort, ...]:
        found = []
        for name, value in section.efforts.items():
            place = (*path, "efforts", name)
            if not is_coordinate(self.fields, place, name, self.joints):
                continue
            if name in section.driven:
                text = f"{name} is driven: what its drive has to do follows from the motion"
                self.fields.key_error("effort-and-drive", place, text, "remove one of the two")
                continue
            joint, _, coordinate = name.rpartition(".")
            amount = self.loads.add_effort(place, name, value, run)
            found.append(Effort(joint, coordinate, amount))
        return tuple(found)

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
        span = float(moments.values[-1] - moments.values[0])
        if not value > 0.0:
            message = "a step takes a positive time"
            self.fields.error("zero-step", path, message, "write 1e-3 s")
        elif span > most * value:
            self.fields.error(
                "too-many-steps",
                path,
                "steps of this length are too many for the time of the response",
                "write a longer step, or a tolerance",
                measured=f"{span / value:.3g} steps",
                limit=f"{most} steps",
            )
        return value
