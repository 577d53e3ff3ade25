"""From results to columns, and from columns to CSV, Markdown, LaTeX and JSON.

Files are written whole or not at all. Knows nothing of how results are computed: `TableSource` is
all it needs of them. Also compares with printed tables.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.tables.columns import (
        FloatArray as FloatArray,
        RunParameter as RunParameter,
        TableColumn as TableColumn,
        Words as Words,
        column_of as column_of,
        column_of_numbers as column_of_numbers,
        column_texts as column_texts,
        row_words as row_words,
        run_parameter as run_parameter,
        solved_rows as solved_rows,
        unique_cells as unique_cells,
        words_of as words_of,
    )
    from mechkin_cli.tables.compare import (
        compare_files as compare_files,
        read_committed as read_committed,
        report as report,
        stale_in as stale_in,
    )
    from mechkin_cli.tables.csv import COMMITTED_DIGITS as COMMITTED_DIGITS, csv_bytes as csv_bytes
    from mechkin_cli.tables.errata import (
        MARK as MARK,
        NAME as NAME,
        OVERVIEW_PAGE as OVERVIEW_PAGE,
        PAGE as PAGE,
        OverviewRow as OverviewRow,
        PrintedTable as PrintedTable,
        against_print as against_print,
        against_print_record as against_print_record,
        counts as counts,
        disagreements_csv as disagreements_csv,
        errata_page as errata_page,
        overview_page as overview_page,
    )
    from mechkin_cli.tables.errors import (
        ALL_COLUMNS as ALL_COLUMNS,
        AT_DEAD_CENTRE as AT_DEAD_CENTRE,
        LOST as LOST,
        ZERO as ZERO,
        ColumnErrors as ColumnErrors,
        clashing as clashing,
        column_errors as column_errors,
        least_digits as least_digits,
        not_repeated as not_repeated,
        worst_column as worst_column,
    )
    from mechkin_cli.tables.json import json_text as json_text, runs_record as runs_record
    from mechkin_cli.tables.layout import (
        ROW_NUMBERS as ROW_NUMBERS,
        ROW_PROOF as ROW_PROOF,
        ROW_TEXTS as ROW_TEXTS,
        CoefficientsLayout as CoefficientsLayout,
        ColumnLayout as ColumnLayout,
        PrintedSource as PrintedSource,
        Remark as Remark,
        TableLayout as TableLayout,
        chosen as chosen,
        counted as counted,
        default_table as default_table,
        effort_names as effort_names,
        row_texts as row_texts,
    )
    from mechkin_cli.tables.markup import (
        markdown_bytes as markdown_bytes,
        rows_table as rows_table,
    )
    from mechkin_cli.tables.print import read_table_text as read_table_text
    from mechkin_cli.tables.results import Results as Results
    from mechkin_cli.tables.summary import (
        OVER_THE_WAY as OVER_THE_WAY,
        REDUCTIONS as REDUCTIONS,
        Extreme as Extreme,
        Reduction as Reduction,
        Statistics as Statistics,
        Summary as Summary,
        mean as mean,
        root_mean_square as root_mean_square,
        row_weights as row_weights,
        statistics as statistics,
        summary_of as summary_of,
    )
    from mechkin_cli.tables.table import (
        Columns as Columns,
        evaluate as evaluate,
        summary_table as summary_table,
    )
    from mechkin_cli.tables.writers import (
        USUAL_FORMATS as USUAL_FORMATS,
        WRITERS as WRITERS,
        Claim as Claim,
        OutputFolder as OutputFolder,
        write_files as write_files,
        written_files as written_files,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "columns": "FloatArray RunParameter TableColumn Words column_of column_of_numbers "
        "column_texts row_words run_parameter solved_rows unique_cells words_of",
        "compare": "compare_files read_committed report stale_in",
        "csv": "COMMITTED_DIGITS csv_bytes",
        "errata": "MARK NAME OVERVIEW_PAGE OverviewRow PAGE PrintedTable against_print "
        "against_print_record counts disagreements_csv errata_page overview_page",
        "errors": "ALL_COLUMNS AT_DEAD_CENTRE ColumnErrors LOST ZERO clashing column_errors "
        "least_digits not_repeated worst_column",
        "json": "json_text runs_record",
        "layout": "CoefficientsLayout ColumnLayout PrintedSource ROW_NUMBERS ROW_PROOF ROW_TEXTS "
        "Remark TableLayout chosen counted default_table effort_names row_texts",
        "markup": "markdown_bytes rows_table",
        "print": "read_table_text",
        "results": "Results",
        "summary": "Extreme OVER_THE_WAY REDUCTIONS Reduction Statistics Summary mean "
        "root_mean_square row_weights statistics summary_of",
        "table": "Columns evaluate summary_table",
        "writers": "Claim OutputFolder USUAL_FORMATS WRITERS write_files written_files",
    },
)
