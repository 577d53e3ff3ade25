"""From results to columns, and from columns to CSV, JSON, Markdown, LaTeX, Parquet and Arrow.

Files are written whole or not at all. Knows nothing of how results are computed: `TableSource` is
all it needs of them. Also compares with printed tables.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.tables.arrow import *
    from mechkin_cli.tables.columns import *
    from mechkin_cli.tables.compare import *
    from mechkin_cli.tables.csv import *
    from mechkin_cli.tables.errata import *
    from mechkin_cli.tables.errors import *
    from mechkin_cli.tables.folder import *
    from mechkin_cli.tables.json import *
    from mechkin_cli.tables.layout import *
    from mechkin_cli.tables.markup import *
    from mechkin_cli.tables.print import *
    from mechkin_cli.tables.results import *
    from mechkin_cli.tables.stream import *
    from mechkin_cli.tables.summary import *
    from mechkin_cli.tables.table import *
    from mechkin_cli.tables.writers import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "arrow": "ArrowTable parquet_blocks parquet_bytes pyarrow_for",
        "columns": "FloatArray RunParameter TableColumn Words column_of column_of_numbers "
        "column_texts joined_column moving_input row_words run_parameter size_kinds size_of_rate "
        "solved_rows table_sizes unique_cells words_of",
        "compare": "compare_files read_committed report stale_in",
        "csv": "COMMITTED_DIGITS CsvStyle TextRoom csv_bytes",
        "errata": "MARK NAME OVERVIEW_PAGE OverviewRow PAGE PrintedTable against_print "
        "against_print_record counts disagreements_csv errata_page overview_page",
        "errors": "ALL_COLUMNS AT_DEAD_CENTRE ColumnErrors LOST ZERO clashing column_errors "
        "least_digits not_repeated worst_column",
        "folder": "Claim OutputFile OutputFolder write_files",
        "json": "json_text runs_record",
        "layout": "CoefficientsLayout ColumnLayout PrintedSource ROW_EVENT ROW_NUMBERS ROW_PROOF "
        "ROW_TEXTS Remark TableLayout chosen counted default_table effort_names "
        "resting_table row_texts",
        "markup": "markdown_bytes rows_table",
        "print": "read_table_text",
        "results": "Results",
        "stream": "TableHeading TableStream TableWriter heading_of metadata_of stream_of "
        "write_table",
        "summary": "Extreme OVER_THE_WAY REDUCTIONS Reduction RunningStatistics RunningSummary "
        "Statistics Summary "
        "mean root_mean_square row_weights statistics summary_of",
        "table": "Columns Heading evaluate summary_table",
        "writers": "STREAM_FORMATS USUAL_FORMATS WRITERS refuse_without_library write_results "
        "written_files",
    },
)
