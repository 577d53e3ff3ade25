"""A mechanism in the kernel and its first assembly."""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.analysis.assembly.start import Start, choose_start
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.inputs import KernelInputs
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.session import Session


class Setup(NamedTuple):
    session: Session
    start: Start

    @property
    def layout(self) -> Layout:
        return self.session.layout

    @property
    def inputs(self) -> KernelInputs:
        return self.session.inputs


def prepared(problem: Problem) -> Setup:
    session = Session(problem)
    return Setup(session, choose_start(session))
