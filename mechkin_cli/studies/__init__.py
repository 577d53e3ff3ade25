"""Planned variants by the hundred thousand: drawn, run on many workers, written to a folder."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.studies.formats import *
    from mechkin_cli.studies.results import *
    from mechkin_cli.studies.shares import *
    from mechkin_cli.studies.source import *
    from mechkin_cli.studies.study import *
    from mechkin_cli.studies.workers import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "formats": "Format format_of",
        "results": "Spread StudyFiles StudyResults",
        "shares": "share_of",
        "source": "open_study",
        "study": "Study Workers study_of",
        "workers": "end_without_warnings",
    },
)
