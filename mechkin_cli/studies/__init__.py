"""Planned variants by the hundred thousand: drawn, run on many workers, written to a folder."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.studies.results import (
        Spread as Spread,
        StudyFiles as StudyFiles,
        StudyResults as StudyResults,
    )
    from mechkin_cli.studies.source import open_study as open_study
    from mechkin_cli.studies.study import Study as Study, Workers as Workers, study_of as study_of
    from mechkin_cli.studies.workers import end_without_warnings as end_without_warnings

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "results": "Spread StudyFiles StudyResults",
        "source": "open_study",
        "study": "Study Workers study_of",
        "workers": "end_without_warnings",
    },
)
