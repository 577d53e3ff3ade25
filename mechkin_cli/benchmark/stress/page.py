"""`docs/stress.md`: what a large run found, and a small set that is computed again to check it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from mechkin_cli.benchmark.report import Table
from mechkin_cli.benchmark.stress.families.table import FAMILIES
from mechkin_cli.benchmark.stress.tables import TOTAL, tables
from mechkin_cli.benchmark.stress.tally import Tally

SMALL_ROWS = 2_000
SECTION = re.compile(
    r"<!-- rows (?P<rows>\d+), seed (?P<seed>\d+) -->\n(?P<text>.*?)\n<!-- end -->", re.DOTALL
)

HEAD = """\
# Hard mechanisms

Written by `mechkin bench --stress --rows {rows} --seed {seed} --page docs/stress.md`; `--check`
computes the small set again and compares the page. Families of random mechanisms, each hard in one
way. Every row is decided in double-double arithmetic (about 31 digits) by code of which no line is
the solver's: a closed form, or for loops that have none the closing equations, followed from the
drawing. `mechkin bench --stress --family NAME --only K` writes mechanism K of a family as a file.
Families share the rows evenly, but for loops that take long: spatial loops have a quarter of that,
many loops a tenth; long sweeps come on top. Numbers depend on rows and seed alone, not on the
machine.

{families}

- *Right*: within {wrong} u k of the true place, u = 2^-53 and k the row's own condition, or to nine
  digits (responses: within {tolerances} tolerances), and nearer to it than to the other assembly;
  *warned*: the row says `near-singular` or `rank-unclear`.
- *Rightly none*: the branch has ended before, and the row is empty and says so.
- *Undecided*: rounding of the file's numbers, 64 units in the last place, decides whether there is
  a row.
- *As drawn*: a fault of the next kinds in a run whose notes say (`nearly-common`, `conventional`,
  `undriven-freedom`, `input-locked`) that axes or points which differ by less than 1e-7, or loops
  that are dependent but for 1e-6, are taken for coinciding (`COMMON_MOTION`, `LOOP_RANK`): numbers
  of nine digits leave that much. The row is one of such a mechanism. A documented limit.
- *Rates lost*: the place is right and says ok, a rate is off by more than {wrong} u k^2, an
  acceleration or a force by more than {wrong} u k^3, and by more than 1e-9 of the row's largest. A
  rod that is short beside the mechanism has its direction to u over its length only, which
  `row.condition`, a measure of places, does not see. A documented limit.
- *Proven*: rows are proven by `--certify`, too, and enclosures of places, rates, accelerations and
  forces must contain what is true of the numbers that the file says. *Not proven*: there is a row,
  of which nothing is claimed. *Elsewhere*: an enclosure that is proven, and does not contain it.
  Every row of most families; one mechanism of some where the way between two rows is many turns,
  which take up to 25 000 tubes; none of responses, of which there are no proofs.
- *Wrong, warned*: another place, with a warning. *False alarm*: there is a row, and it stays empty,
  with a status that says why. Known: change points 47 of seed 7 is `branch-lost` after 23 rows.
  *False ok*: a wrong place, or one that cannot be, that says ok.
"""


def page(large: Sequence[Tally], small: Sequence[Tally], rows: int, seed: int) -> str:
    """The page of a run and of the small set with the same seed."""
    from mechkin_cli.benchmark.stress.judge import WRONG, WRONG_TOLERANCES

    families = "\n".join(
        [
            "| family | what it is |",
            "|---|---|",
            *(f"| {family.name} | {family.what} |" for family in FAMILIES.values()),
        ]
    )
    head = HEAD.format(
        rows=rows,
        seed=seed,
        families=families,
        wrong=f"{WRONG:.0f}",
        tolerances=f"{WRONG_TOLERANCES:.0f}",
    )
    return "\n".join(
        [
            head,
            f"## {rows} rows\n",
            f"<!-- rows {rows}, seed {seed} -->",
            _sections(large),
            "<!-- end -->\n",
            f"## The small set: {SMALL_ROWS} rows\n",
            _sections(small),
            "",
        ]
    )


def of_page(text: str) -> tuple[int, int] | None:
    """Rows and seed of the run that a page tells of; None where it is none."""
    found = SECTION.search(text)
    return (int(found["rows"]), int(found["seed"])) if found else None


def is_current(text: str, small: Sequence[Tally]) -> bool:
    """Whether a page has the form that would be written now, and its small set's numbers."""
    found, known = SECTION.search(text), of_page(text)
    if found is None or known is None:
        return False
    fresh = page(small, small, *known)
    inner = SECTION.search(fresh)
    assert inner is not None
    form = _without_numbers(found["text"]) == _without_numbers(inner["text"])
    same = fresh.replace(inner["text"], found["text"], 1)
    return form and _without_gains(same) == _without_gains(text)


def _without_gains(text: str) -> str:
    """A page without what may get better with no row changed: bounds, in the last column of errors,
    and how many rows are proven (to closure) and how many not."""
    errors = re.compile(r"^(\| .* \| (?:u k|tolerances) \|.*)\|[^|]*\|$", re.MULTILINE)
    number, family = r" *\d* \|", "|".join(FAMILIES)
    proofs = re.compile(
        rf"^(\| (?:{family}|{TOTAL}) \|{number}{number}){number * 3}({number}{number})$",
        re.MULTILINE,
    )
    return proofs.sub(r"\1\2", errors.sub(r"\1|", text))


def _without_numbers(text: str) -> list[str]:
    """What of a run's section does not depend on its numbers: heads of tables, and families."""
    names = "|".join(FAMILIES)
    kept = []
    for line in text.splitlines():
        row = re.match(rf"\| ({names}) \|", line)
        if row:
            kept.append(row[1])
        elif line.startswith(("###", "|---", "| family", "| condition")):
            kept.append(line)
    return kept


def _sections(tallies: Sequence[Tally]) -> str:
    return "\n\n".join(_markdown(table) for table in tables(tallies))


def _markdown(table: Table) -> str:
    labels = [
        column.label.replace("-\n", "").replace("\n", " ").strip() for column in table.columns
    ]
    rules = [
        "---" if column.kind == "text" and k < 2 else "---:"
        for k, column in enumerate(table.columns)
    ]
    lines = [f"### {table.title}", "", _line(labels), "|" + "|".join(rules) + "|"]
    lines += [_line(cells) for cells in table.texts()]
    notes = [f"- {note}" for note in table.notes]
    return "\n".join([*lines, *([""] if notes else []), *notes])


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"
