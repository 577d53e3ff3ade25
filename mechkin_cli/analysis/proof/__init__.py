"""Proofs of the rows of a sweep: that each has exactly one position where it says, and that all
lie on one branch."""

from mechkin_cli.analysis.proof.certificate import Certificate
from mechkin_cli.analysis.proof.certify import certify

__all__ = ["Certificate", "certify"]
