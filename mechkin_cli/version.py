"""Which mechkin this is, and which format of files it reads: what every JSON output begins with."""

from __future__ import annotations

FORMAT = 1
"""The version of the file format, as files say it in `format:`."""

UNKNOWN = "(source folder, not installed)"


def version() -> str:
    """The version of the installed package."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("mechkin")
    except PackageNotFoundError:
        return UNKNOWN


def versions() -> dict[str, object]:
    """Program and format as the first two keys of a JSON object."""
    return {"mechkin": version(), "format": FORMAT}
