"""`Model.sensitivities` against derivatives of 40 digits, in parts of the column's largest."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from oracle import UnsolvableError, mp, read, to_text
from oracle.mechanism import Mechanism
from properties.answers import Kind, kind, scales
from sensitivities.exact.derivatives import Numbers, Row
from sensitivities.exact.files import Data, conventional, spatial

import mechkin_cli as mk
from mechkin_cli.sensitivities.first_order import Sensitivities

NEXT_TO_NOTHING = 1e-7
"""Derivatives that are smaller than this part of the quantity by the parameter's scale are compared
as if they were so large: differences of 32 digits over 2e-12 leave 1e-20 of the quantity."""


class Compared(NamedTuple):
    """One quantity by one parameter over some rows.

    Attributes:
        quantity, parameter: which.
        off: the largest deviation in parts of the largest derivative, of a vector's components.
        wrong: rows of which the verdicts are, as `row 3: ok, and it does not close`.
        told: rows with a derivative on both sides.
        refused: rows that neither side has a derivative for.
        stuck: rows that close with another value, but do not move: what the oracle refuses and
            `sensitivities` does not look for.
    """

    quantity: str
    parameter: str
    off: float
    wrong: tuple[str, ...]
    told: int
    refused: int
    stuck: int


def compare(data: Data, parameters: Sequence[str], rows: Sequence[int]) -> list[Compared]:
    """Everything that both sides tell of some rows of a file."""
    model = mk.loads(to_text(data))
    known = model.problem.quantities()
    seen = model.analyze([n for n in known if n.endswith(PLACES)], tables=[], threads=1)
    around = [Row(data, row, _told(seen, row)) for row in rows]
    own = around[0].own()
    skipped = conventional(data)
    quantities = [n for n in own if n in known and n.partition(".")[0] not in skipped]
    if any(load["type"] == "spring" for load in data.get("loads", [])):
        quantities.remove("row.potential_energy")  # to the oracle a spring is a law
    mechanism = read(spatial(data))
    sizes = _sizes(own, quantities, mechanism.size)
    s = model.sensitivities(quantities, parameters, threads=1)
    found = []
    for name in parameters:
        true = [_derivatives(row, name, s.unit_of(name)) for row in around]
        scale = _scale(mechanism, model, name)
        for quantity in quantities:
            unit = mechanism.units.value(s.unit_of(quantity)) if s.unit_of(quantity) else mp.one
            cells = [one[quantity] / unit if one else one for one in true]
            least = NEXT_TO_NOTHING * sizes[quantity] / float(unit * scale)
            found.append(_compared(s, quantity, name, rows, cells, least))
    return found


STUCK: Numbers = {}
ENERGY = Kind(None, 1)
PLACES = (".position", ".theta", ".theta1", ".theta2", ".s", ".x", ".y")


def _told(seen: Any, row: int) -> Any:
    def told(name: str) -> Any:
        try:
            return seen[name][row]
        except mk.MechkinError:
            return None

    return told


def _sizes(own: Numbers, quantities: Sequence[str], size: Any) -> dict[str, Any]:
    """By quantity the largest of its family in the row, in the oracle's units."""
    plain = {n: v for n, v in own.items() if n.partition(".")[0] != "row"}
    largest = scales(plain, float(size))
    found = {}
    for name in quantities:
        its = kind(name) if name in plain else ENERGY
        found[name] = largest[its.family] * float(size) ** its.lengths
    return found


def _derivatives(row: Row, name: str, unit: str) -> Numbers | None:
    try:
        return row.derivatives(name, unit)
    except UnsolvableError as refusal:
        return STUCK if "about the rates" in str(refusal) else None


def _scale(mechanism: Mechanism, model: mk.Model, name: str) -> float:
    """How much a parameter would have to change to change everything, in the file's units."""
    known, units = model.problem.parameters[name], model.problem.units
    value = abs(float(units.from_si(float(known.value), known.dimension)))
    words = mechanism.units.words
    if units.label(known.dimension) == words["length"]:
        return max(float(mechanism.size / mechanism.units.of("length")), value)
    if units.label(known.dimension) == words["angle"]:
        return float(1 / mechanism.units.of("angle"))
    return value or 1.0


def _compared(
    s: Sensitivities,
    quantity: str,
    name: str,
    rows: Sequence[int],
    cells: Iterable[Any],
    least: float,
) -> Compared:
    words, slopes = s.verdict(quantity, name), s[quantity, name]
    apart, sizes, wrong, refused, stuck = [], [], [], 0, 0
    for row, true in zip(rows, cells, strict=True):
        is_told = np.isfinite(slopes[row]).all()
        if true is STUCK:
            stuck += 1
        elif (true is None) == is_told:
            what = "does not close" if true is None else "has a derivative"
            wrong.append(f"row {row}: {words[row]}, and it {what}")
        elif true is None:
            refused += 1
        else:
            slope = np.atleast_1d(slopes[row])
            true = true[[2]] if slope.size == 1 < true.size else true[: slope.size]
            pairs = zip(slope.tolist(), true, strict=True)
            apart.append(max(float(abs(mp.mpf(x) - y)) for x, y in pairs))
            sizes.append(max(float(abs(y)) for y in true))
    worst, size = max(apart, default=0.0), max([*sizes, least])
    off = worst / size if size else worst
    return Compared(quantity, name, off, tuple(wrong), len(apart), refused, stuck)
