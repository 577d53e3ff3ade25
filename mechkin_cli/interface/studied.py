"""Studies of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from concurrent.futures import Executor
    from pathlib import Path
    from typing import Any

    from mechkin_cli.interface.model import Model
    from mechkin_cli.interface.study_results import StudyFiles, StudyResults


class Studied:
    """The studies of a model."""

    def study(
        self,
        study: str | Path | Mapping[str, Any],
        out: str | Path | None = None,
        *,
        format: str = "csv",
        again: bool = False,
        threads: int = 0,
        processes: int = 0,
        executor: Executor | None = None,
        scheduler: str | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> StudyResults | StudyFiles:
        """Many variants: drawn, crossed or listed, and numbers of each that are kept.

        Args:
            study: a study file, whose `mechanism:` does not count here; or its sections as a dict.
            out: a folder for results of any size, which a run that was stopped goes on with; None:
                they come back as arrays.
            format: of the files, "csv" or "parquet" (extra `parquet`).
            again: begin anew where the folder has results already.
            threads: of the kernel in each process; 0: as many as pay, of workers one.
            processes: so many new processes compute; 0: this one.
            executor: computes instead; any of `concurrent.futures`.
            scheduler: address of a Dask cluster that computes instead (extra `cluster`).
            progress: told how many variants are done, and of how many.

        Returns:
            Columns over the variants; of a folder its files and an overview.

        Raises:
            InvalidFile: with every independent error of the study and its place.
            UsageError: too many results for the memory, a folder of another study or one that
                another process writes to, what cannot be written, workers that do not answer.

        Example:
            >>> from mechkin_cli import load
            >>> m = load("mechanisms/rcsr.yaml")
            >>> r = m.study(
            ...     {"vary": {"P1": [0.48, 0.5, 0.52]}, "keep": [{"of": "O1.effort", "as": "peak"}]}
            ... )
            >>> r["peak(O1.effort)"].round(2).tolist()
            [147.41, 135.04, 125.93]
        """
        from mechkin_cli.interface.studies import Workers, study_of

        workers = Workers(threads, processes, executor, scheduler)
        model: Model = self  # type: ignore[assignment]
        return study_of(model, study, out, format, again, workers, progress)
