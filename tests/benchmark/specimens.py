"""The mechanisms that are measured: RCSR, and a general 7R."""

from __future__ import annotations

from functools import partial

from benchmark.specimen import Specimen

from benchmarks import rcsr, sevenr


def rcsr_specimen(scale: float = 1.0) -> Specimen:
    """The mechanism of the dissertation, all lengths times `scale`."""
    size = rcsr.dimensions(scale)
    return Specimen(
        name="RCSR",
        text=size.text,
        driven="O1.theta",
        coordinates=rcsr.COORDINATES,
        loads=rcsr.LOADS,
        rate=rcsr.RATE,
        acceleration=rcsr.ACCELERATION,
        span=rcsr.SPAN,
    )


def sevenr_specimen(scale: float = 1.0) -> Specimen:
    """The general loop of seven revolutes, all lengths times `scale`."""
    loop = sevenr.dimensions(scale)
    return Specimen(
        name="7R",
        text=partial(sevenr.text, loop=loop),
        driven="J1.theta",
        coordinates=sevenr.COORDINATES,
        loads=sevenr.LOADS,
        rate=sevenr.RATE,
        acceleration=sevenr.ACCELERATION,
        span=sevenr.SPAN,
    )
