"""How far the numbers of a run are from the true ones: its rows repeated in double-double from the
converged ones (`Repeated`)."""

from mechkin_cli.analysis.errors.reasons import reason_of
from mechkin_cli.analysis.errors.repeated import Repeated, WideRun

__all__ = ["Repeated", "WideRun", "reason_of"]
