"""Results of a study in memory: columns over the variants, as arrays and as data frames."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError
from mechkin_cli.interface.arguments import a_text
from mechkin_cli.interface.study_chunk import VARIANT, VERDICTS
from mechkin_cli.listing import Listed, Listing
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.studies.folder import ROWS, VARIANTS
from mechkin_cli.studies.overview import Overview, overview

if TYPE_CHECKING:
    import pandas  # type: ignore[import-untyped]

    from mechkin_cli.studies.records import Heading, Records, Values


class StudyFiles(NamedTuple):
    """What a study has written, and its overview."""

    name: str
    files: tuple[Path, ...]
    overview: Overview
    diagnostics: tuple[Diagnostic, ...]


class StudyResults(Listed):
    """What was kept of all variants: `r["peak(O1.effort)"]` is an array over them, in the file's
    units.

    Attributes:
        name: of the study.
        rows: columns of all rows of all variants by label, empty where none were kept.
        diagnostics: what the study has to say.
    """

    def __init__(
        self,
        name: str,
        headings: Mapping[str, Sequence[Heading]],
        records: Mapping[str, Records],
        diagnostics: tuple[Diagnostic, ...],
    ) -> None:
        self.name = name
        self.diagnostics = diagnostics
        self.rows: Records = records.get(ROWS, {})
        self._headings = headings
        self._columns = records[VARIANTS]

    def __len__(self) -> int:
        return len(self._columns[VARIANT.label])

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __contains__(self, label: object) -> bool:
        return label in self._columns

    def __getitem__(self, label: str) -> Values:
        """A column over the variants (variants,); nan where a variant has no such number.

        Raises:
            UsageError: there is no such column.
        """
        if a_text("a column", label, '"peak(O1.effort)"') not in self._columns:
            labels = list(self._columns)
            hint = nearest_hint(label, labels) or f"columns are {', '.join(labels)}"
            raise UsageError(f"there is no column {label[:LONGEST_NAME]}; {hint}")
        return self._columns[label]

    def unit(self, label: str) -> str:
        """The unit of a column; "" where it has none."""
        self[label]
        return next(h.unit for h in self._headings[VARIANTS] if h.label == label)

    @property
    def overview(self) -> Overview:
        """Counts of verdicts, and least, largest and mean values of the columns."""
        headings = self._headings[VARIANTS]
        return overview([self._columns], headings, VARIANT.label, VERDICTS[1].label)

    @property
    def listing(self) -> Listing:
        """The overview as a table."""
        seen = self.overview
        rows = tuple(
            (
                s.label,
                s.unit,
                *(f"{value:.6g}" for value in (s.least, s.mean, s.largest, s.deviation)),
            )
            for s in seen.spreads
        )
        verdicts = ", ".join(f"{count} {word}" for word, count in seen.verdicts.items())
        head = f"{self.name}: {seen.variants} variants, {verdicts}"
        labels = ("column", "unit", "least", "mean", "largest", "deviation")
        return Listing(head, labels, rows, tuple(map(str, self.diagnostics)))

    def to_pandas(self, table: str = VARIANTS) -> pandas.DataFrame:
        """`variants` or `rows` as a DataFrame; `attrs["units"]` has the unit of each column.

        Raises:
            UsageError: pandas is not installed, or there is no such table.
        """
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas needs pandas: pip install 'mechkin[pandas]'") from None
        if a_text("table", table, f'"{VARIANTS}"') not in self._headings:
            raise UsageError(
                f"there is no table {table[:LONGEST_NAME]}; tables are {', '.join(self._headings)}"
            )
        columns: Any = self._columns if table == VARIANTS else self.rows
        order = [heading.label for heading in self._headings[table]]
        frame = pandas.DataFrame({label: columns[label] for label in order})
        frame.attrs |= {"units": {h.label: h.unit for h in self._headings[table]}}
        return frame
