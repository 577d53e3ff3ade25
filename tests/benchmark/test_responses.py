"""The benchmark of responses measures what it says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from benchmark import responses

from mechkin_cli.bench.report import Cell, plain_text


def ordered(lines: Sequence[Mapping[str, Cell]], key: str) -> list[float]:
    return [float(line[key] or 0.0) for line in lines]


def test_tighter_steps_cost_more_and_err_less() -> None:
    _, double, stiff = responses.cases()
    for case, methods in ((double, ["explicit", "implicit"]), (stiff, ["implicit"])):
        lines = list(responses.accuracy_of(case, 1))
        assert len(lines) == len(case.methods) * len(case.tolerances)
        for method in methods:
            own = [line for line in lines if line["case"] == f"{case.name} {method}".strip()]
            assert (np.diff(ordered(own, "evaluations")) > 0).all()
            assert (np.diff(ordered(own, "error")) < 0).all()


def test_the_response_of_the_source_is_exact() -> None:
    lines = list(responses.accuracy_of(responses.cases()[0], 1))
    assert max(ordered(lines, "error")) < 1e-8
    assert max(ordered(lines, "energy")) < 1e-8


def test_orders_are_those_of_the_methods() -> None:
    table = responses.slopes(1, 1)
    for name, order in (("explicit", 8), ("implicit", 5)):
        found = [line["order"] for line in table.rows if str(line["case"]).endswith(name)]
        assert order - 0.5 < float(found[-1] or 0.0) < order + 1.5
    assert max(map(len, plain_text(replace(table, notes=())).splitlines())) <= 80


def test_lines_of_lanes_and_friction() -> None:
    for figure, count in ((responses.lanes, 6), (responses.friction, 8)):
        table = figure(1, 16)
        assert len(table.rows) == count
        assert min(ordered(table.rows, "value")) > 0.0
        assert max(map(len, plain_text(replace(table, notes=())).splitlines())) <= 80
