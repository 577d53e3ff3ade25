"""How far the numbers of a run are from the true ones: its rows repeated in double-double from the
converged ones, or its motion from its start (`repetition`)."""

from mechkin_cli.analysis.errors.reasons import reason_of
from mechkin_cli.analysis.errors.repeated import Repeated, WideRun
from mechkin_cli.analysis.errors.repetition import repetition

__all__ = ["Repeated", "WideRun", "reason_of", "repetition"]
