"""The sweep: all rows of a motion on one branch, and what is read off them."""

from mechkin_cli.analysis.sweep.result import Result
from mechkin_cli.analysis.sweep.sweep import analyze, first_assembly

__all__ = ["Result", "analyze", "first_assembly"]
