"""Numbers that the pages name are those of the tables."""

import csv
import re

from documents.reading import page
from references import RCSR, exact, published

import mechkin_cli as mk


def test_the_torque_where_print_is_wrong() -> None:
    (right, wrong) = re.findall(
        r"torque at 150 degrees is (\S+) \S+ \S+, not (\S+)\.", page("docs/errata/dissertation.md")
    )[0]
    assert published("table_18")["MIN"][0] == wrong
    assert f"{float(exact('rcsr')['ne_MIN'][0]):.2f}" == right
    with (RCSR.parent / "rcsr/table_18.csv").open(newline="", encoding="utf-8") as file:
        assert f"{float(next(csv.DictReader(file))['MIN']):.2f}" == right


def test_unknowns_of_the_rcsr_mechanism() -> None:
    (count,) = re.findall(r"RCSR: (\d+) unknowns", page("docs/numerics.md"))
    (block,) = mk.load(RCSR).graph.blocks
    assert block.equations == int(count)
