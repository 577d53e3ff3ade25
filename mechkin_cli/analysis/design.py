"""A design: a checked mechanism file with values of its parameters, ready for the kernel.

The file's own design comes from `building`; `variants` derives designs with other values from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from mechkin_cli import building
from mechkin_cli.building import Built
from mechkin_cli.diagnostics import Diagnostic, InvalidFile
from mechkin_cli.mechanism import Problem, response_problem
from mechkin_cli.memo import Memo, remembered
from mechkin_cli.session import Session
from mechkin_cli.structure import SolverGraph
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.building import ViewSettings
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.session import Precise, ShiftingPrecise

AS_WRITTEN: Mapping[str, Quantity] = MappingProxyType({})
"""No parameter has another value than the file says."""


class Design:
    """A checked file with the values of its parameters.

    Args:
        built: the file, checked.
        stem: of its name.
        given: values of parameters that `built` has and the file's text does not, in SI.
    """

    def __init__(self, built: Built, stem: str, given: Mapping[str, Quantity] = AS_WRITTEN) -> None:
        self.built, self.stem, self.given = built, stem, given
        self.memo: Memo = {}

    def __repr__(self) -> str:
        values = ", ".join(f"{name} = {value:.10g}" for name, value in self.values.items())
        return f"Design of {self.stem}" + (f" with {values} in SI" if values else "")

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied as the text of the file and of the tables that it names."""
        document = self.built.document
        source = (document.text, document.file, dict(document.overrides), document.folder)
        return _from_text, (*source, self.stem, document.is_data, dict(document.tables))

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        return self.built.problem

    @property
    def values(self) -> Mapping[str, float]:
        """The parameters that were set, by name, in SI."""
        return {}

    @property
    def graph(self) -> SolverGraph:
        """Tree, cut joints and blocks.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return self._solvable(self.built.graph)

    @cached_property
    def session(self) -> Session:
        """The mechanism in the kernel, as the file drives it; every question goes through it.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        session = Session.of(self.problem, self.graph, known=self.built.structure)
        return session.reading(lambda: self.precise)

    @cached_property
    def precise(self) -> Precise:
        """The numbers of this design's sessions as the file's text says them, in double-double.
        Values that were set are the doubles that they are.

        Raises:
            TraceLost: a number depends on the text in a way that no tape holds.
        """
        return building.precise(self.built, self.problem, self.given)

    @cached_property
    def shifting(self) -> ShiftingPrecise:
        """As `precise`, with parameters that can be shifted.

        Raises:
            TraceLost: a number depends on the text in a way that no tape holds.
        """
        return building.shifting(self.built, self.problem, self.given)

    @property
    def view_settings(self) -> ViewSettings:
        """How the file wants to be shown (`view:`), in SI."""
        return self.built.view or building.ViewSettings()

    # Responses: each has a graph of its own, since it is driven by what its start names.

    @property
    def at_responses(self) -> Design:
        """The design with the problem and graphs of its responses."""
        return self

    def response(self, name: str) -> ResponseProblem:
        """What one of the file's responses asks for, in SI."""
        return self.at_responses.built.problem.responses[name]

    def response_graph(self, name: str) -> SolverGraph:
        """Tree, cut joints and blocks at the start of a response.

        Raises:
            InvalidFile: its start names too few coordinates or too many, or nothing is free.
        """
        built = self.at_responses.built
        graph = self._solvable(built.response_graphs[name])
        response = built.problem.responses[name]
        if response.independent:
            return graph
        text = "nothing is free to move in this response: all its freedoms are driven"
        hint = "write the laws under motion: {time: ..., inputs: ...}, which is a sweep in time"
        return self._solvable(Diagnostic("nothing-free", "error", text, response.place, hint=hint))

    def session_of(self, run: str) -> Session:
        """The mechanism in the kernel at the first row of a run; that of a response is driven by
        the coordinates that its start names.

        Raises:
            InvalidFile: the mechanism cannot be solved as it is driven.
        """
        return self.session if run == SWEEP else _at_start(self.at_responses, run)

    def _solvable(self, graph: SolverGraph | Diagnostic) -> SolverGraph:
        if isinstance(graph, Diagnostic):
            raise InvalidFile([*self.problem.diagnostics, graph])
        return graph


def _from_text(
    text: str,
    file: str,
    overrides: Mapping[str, str],
    folder: Path | None,
    stem: str,
    is_data: bool,
    tables: Mapping[str, bytes],
) -> Design:
    """A design of the text that another had, or of the data that its text was made from."""
    if is_data:
        import json

        source = building.open_data(json.loads(text), file, overrides, folder, tables)
    else:
        source = building.open_text(text, file, overrides, folder, tables)
    return Design(building.build(*source), stem)


@remembered
def _at_start(design: Design, run: str) -> Session:
    graph = design.response_graph(run)
    first = response_problem(design.problem, design.problem.responses[run])
    exactly = cache(lambda: building.precise_response(design.built, first, design.given))
    return Session.of(first, graph).reading(exactly)
