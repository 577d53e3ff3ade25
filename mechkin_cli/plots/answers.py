"""Answers of quantities to a harmonic input over its frequency: amplitudes above phases, both over
the logarithm of the frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.plots.curves import empty_figure, figure_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mechkin_cli.vibration import FrequencyResponse

_PANEL = 2.6
"""Height of each panel, inches."""


def answer_image(answer: FrequencyResponse, ending: str) -> bytes:
    """A file with the picture: "svg", "png" or "pdf".

    Raises:
        UsageError: matplotlib is not there.
    """
    return figure_bytes(lambda: _figure(answer), ending)


def _figure(answer: FrequencyResponse) -> Figure:
    figure = empty_figure(2.0 * _PANEL)
    above, below = figure.subplots(2, 1, sharex=True)
    # a static answer, at no frequency, has no place on the logarithm's axis
    shown = answer.frequencies > 0.0
    places = answer.frequencies[shown]
    for name, amplitude, phase in zip(
        answer.outputs, answer.amplitude[:, shown], answer.phase[:, shown], strict=True
    ):
        above.plot(places, amplitude, label=name)
        below.plot(places, phase, label=name)
    above.set_xscale("log")
    if (answer.amplitude[:, shown] > 0.0).any():
        above.set_yscale("log")
    above.set_ylabel("amplitude [SI]")
    above.set_title(f"by {answer.input} of amplitude 1")
    below.set_ylabel("phase [deg]")
    below.set_xlabel("frequency [Hz]")
    below.set_yticks([-180, -90, 0, 90, 180])
    above.legend()
    for axes in (above, below):
        axes.grid(visible=True, which="major", alpha=0.3)
    return figure
