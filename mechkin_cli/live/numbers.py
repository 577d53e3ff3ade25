"""A file, built once more with some of its numbers as parameters.

What they lead to can then be recorded as that of any parameter.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from copy import deepcopy
from itertools import islice
from typing import Any

from mechkin_cli.analysis import Design
from mechkin_cli.building import FileNumber, build, file_numbers, open_data
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.record import NamedTuple


class WithNumbers(NamedTuple):
    """A design in which numbers of the file are parameters, and these numbers by parameter."""

    design: Design
    numbers: Mapping[str, FileNumber]


def with_numbers(design: Design, most: int) -> WithNumbers | None:
    """The design of a file, with at most so many numbers of it as parameters beside its own; None
    where it has none."""
    built = design.built
    document, units = built.document, built.problem.units
    found = list(islice(file_numbers(document), most))
    if not found:
        return None
    data: dict[Any, Any] = deepcopy(document.data)
    words = set(re.findall(r"\w+", document.text))
    numbers, parameters = {}, {}
    for number in found:
        parameter = "_".join(re.sub(r"\W", "_", str(step)) for step in number.path)
        while parameter in words or parameter in numbers:
            parameter += "_"
        numbers[parameter] = number
        parameters[parameter] = f"{number.text.strip()} {units.label(number.dimension)}"
        *way, last = number.path
        holder: Any = data
        for step in way:
            holder = holder[step]
        holder[last] = parameter
    tables = document.tables
    try:
        source = open_data(
            {**data, "parameters": {**data.get("parameters", {}), **parameters}},
            document.file,
            {},
            document.folder,
            tables,
        )
        return WithNumbers(Design(build(*source, {}, built.problem.stopped), design.stem), numbers)
    except InvalidFile:
        return None  # a place may be read where a parameter may not
