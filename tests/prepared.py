"""A mechanism in the kernel and its first assembly."""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.assembly.near import AssemblyStart
from mechkin_cli.assembly.start import choose_start
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.plan.layout import Layout
from mechkin_cli.session.inputs import KernelInputs
from mechkin_cli.session.session import Session


class Setup(NamedTuple):
    session: Session
    start: AssemblyStart

    @property
    def layout(self) -> Layout:
        return self.session.layout

    @property
    def inputs(self) -> KernelInputs:
        return self.session.inputs


def prepared(problem: Problem) -> Setup:
    session = Session.of(problem)
    return Setup(session, choose_start(session))
