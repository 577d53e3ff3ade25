"""`docs/stress.md`: what a large run found, and a small set that is computed again to check it."""

from __future__ import annotations

import re
from collections.abc import Sequence

from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.tables import TOTAL, tables
from benchmarks.stress.tally import Tally
from mechkin_cli.bench.report import ReportTable

SMALL_ROWS = 2_000
SECTION = re.compile(
    r"<!-- rows (?P<rows>\d+), seed (?P<seed>\d+) -->\n(?P<text>.*?)\n<!-- end -->", re.DOTALL
)

HEAD = """\
# Hard mechanisms

How often does mechkin give a wrong row, and how often no row although one exists? This page
answers with random hard mechanisms, each family hard in one way. In the table below, *false
ok* is the number to look at first: wrong rows reported as right.

Every row is judged in double-double arithmetic (about 31 digits) by code that shares no line
with the solver: by a closed form, or, for loops that have none, by their closing equations,
followed from the drawing. The page is written in the repository's root by `python -m benchmarks
--stress --rows {rows} --seed {seed} --page docs/stress.md`; with `--check` the same command
computes the small set at the end again and compares it. The numbers depend on rows and seed
alone, not on the machine. To see a mechanism, `python -m benchmarks --stress --family NAME --only
K` prints mechanism K of a family as a file. `mechkin bench --stress` runs one mechanism of each
family except long sweeps. The families share the rows evenly, except that slow loops get fewer
(spatial loops a quarter, many loops a tenth) and that long sweeps come on top.

{families}

The possible outcomes of a row (u = 2^-53, the rounding of a double; k is the row's own condition):

- *Right*: the place is within {wrong} u k of the true one, or right to nine digits (responses:
  within {tolerances} tolerances), and it is nearer to the true assembly than to the other.
  *Right, warned*: right as well, but the row says `near-singular` or `rank-unclear`.
- *Rightly none*: the branch has ended before this row, and the row is empty and says so.
- *Undecided*: rounding the file's numbers (by up to 64 units in the last place) decides whether
  there is a row at all.
- *As drawn*: one of the faults below, in a run whose notes (`nearly-common`, `conventional`,
  `undriven-freedom`, `input-locked`) say that axes or points less than 1e-7 apart, or loops that
  are dependent to 1e-6, are treated as coinciding (`COMMON_MOTION`, `LOOP_RANK`), because numbers
  of nine digits cannot say more. The row is that of a mechanism in which they coincide. A
  documented limit.
- *Rates lost*: the place is right and the row ok, but a rate is off by more than {wrong} u k^2, or
  an acceleration or a force by more than {wrong} u k^3, and by more than 1e-9 of the row's
  largest. The direction of a rod that is short compared with the mechanism is known only to u
  over its length, and `row.condition`, a measure of places, does not show that. A documented
  limit.
- *Wrong, warned*: a wrong place, with a warning.
- *False alarm*: the row exists but stays empty, with a status that says why. Known: change
  points 47 of seed 7 is `branch-lost` after 23 rows.
- *False ok*: a wrong place, or one that cannot exist, in a row that is ok.

The outcomes of [`--certify`](verdicts.md#proofs) for the same rows; enclosures of places, rates,
accelerations and forces must contain the true values for the numbers written in the file:

- *Proven*, or *proven to closure*: as on the page of verdicts. *Not proven*: the row exists, and
  nothing is claimed about it. *Proven elsewhere*: a proven enclosure that does not contain
  the true value.
- In most families every row is tried; in some, whose mechanisms make many turns between
  two rows and need up to 25 000 tubes, only one mechanism in so many; responses are not tried,
  since there are no proofs for them.
"""


def page(large: Sequence[Tally], small: Sequence[Tally], rows: int, seed: int) -> str:
    """The page of a run and of the small set with the same seed."""
    from mechkin_cli.bench.runs import WRONG, WRONG_TOLERANCES

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


def _markdown(table: ReportTable) -> str:
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
