"""Packs of 2, 4 and 8 lanes give the same bytes, overconstrained and several loops included."""

from __future__ import annotations

from functools import cache

import pytest
from properties.cases import STRUCTURES, case
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel

FILES = ("bennett", "hooke", "parallelogram", "rcsr_csr", "cspc")
SOURCES = (*FILES, *STRUCTURES[:6])


def width(lanes: int):
    missing = lanes > _kernel.widest
    reason = f"this machine has packs of {_kernel.widest} lanes at most"
    return pytest.param(lanes, marks=pytest.mark.skipif(missing, reason=reason))


@cache
def contents(source: str, lanes: int) -> dict[str, bytes]:
    """All quantities of a source, verdicts too."""
    model = mk.load(FILE_OF[source]) if source in FILES else mk.loads(case(source).text)
    analysis = model.analyze(sorted(model.quantities), tables=[], lanes=lanes)
    return {name: analysis[name].tobytes() for name in sorted(model.quantities)}


@pytest.mark.parametrize("lanes", [width(4), width(8)])
@pytest.mark.parametrize("source", SOURCES)
def test_same_bytes(source, lanes):
    assert contents(source, lanes) == contents(source, 2)
