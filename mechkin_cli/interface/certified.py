"""`Model.certify`: the sweep with its proofs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from mechkin_cli.interface.analysis import Analysis
    from mechkin_cli.interface.certificate import Certificate


class Analyzed(Protocol):
    """What runs a sweep."""

    def analyze(
        self,
        *,
        mode: str | None = None,
        closed_at: Sequence[str] | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Analysis:
        """Runs the sweep."""
        ...


class Certified:
    """The proofs of a model."""

    def certify(
        self: Analyzed,
        *,
        mode: str | None = None,
        closed_at: Sequence[str] | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Certificate:
        """Runs the sweep and proves its rows: that each has exactly one position in a small box
        about the one given, and that all lie on one branch.

        Args and errors are those of `analyze`.

        Example:
            >>> from mechkin_cli import load
            >>> proofs = load("mechanisms/rcsr.yaml").certify()
            >>> proofs.is_one_branch, sorted(set(proofs.status.tolist()))
            (True, ['proven'])
            >>> low, high = proofs.enclosure("O2.theta")
            >>> bool((high - low < 1e-11).all())
            True
        """
        analysis = self.analyze(mode=mode, closed_at=closed_at, lanes=lanes, threads=threads)
        return analysis.certificate
