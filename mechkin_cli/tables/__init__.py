"""Tables: from what an analysis found to columns, to CSV, Markdown and JSON text, to files.

Nothing here knows how results are computed; `mechkin_cli.tables.source.Source` is all it asks of
them.
"""
