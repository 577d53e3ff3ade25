"""The runs of a file: the sweep along the inputs of its motion, and its responses by name."""

from typing import Final

SWEEP: Final = "sweep"
"""Name of the run along the inputs of `motion:`; no response may have it."""
