"""Tables and the short summary of a run for a person.

Tables are aligned columns that fit the terminal, long ones shortened in the middle. The last line
of the summary says how many digits of all cells are right.
"""

from __future__ import annotations

import shutil
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis import ended
from mechkin_cli.assembly import NEAR
from mechkin_cli.diagnostics import legible
from mechkin_cli.errors import WORDS
from mechkin_cli.kernel.functions import INSTRUCTIONS, width, widths
from mechkin_cli.mechanism import (
    COEFFICIENT_KINDS,
    DERIVED_KINDS,
    POWER_KINDS,
    accelerated,
    is_told,
    is_written,
    quantities_read,
)
from mechkin_cli.plan import REACTION_KINDS, Demand
from mechkin_cli.record import replace
from mechkin_cli.structure import listed
from mechkin_cli.sweep import RunVerdicts
from mechkin_cli.tables import (
    ALL_COLUMNS,
    AT_DEAD_CENTRE,
    ZERO,
    Columns,
    TableColumn,
    Words,
    column_texts,
    counted,
    joined_column,
    summary_table,
)
from mechkin_cli.units import TIME
from mechkin_cli.verdict import SWEEP, Status

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis, Ended, Solvable, Stream
    from mechkin_cli.mechanism import Joint, Problem, Wanted
    from mechkin_cli.structure import SolverGraph
    from mechkin_cli.sweep import Result
    from mechkin_cli.tables import ColumnErrors, Summary
    from mechkin_cli.units import UnitSystem


MOST_ROWS = 60
"""Longer tables are shown with this many rows."""

HEAD_LINES = 2
"""Lines above the cells of a column: its label and its unit."""

GAP_MARK = "..."
"""In the first column, where rows are left out."""

GAP = "  "


def shown_tables(tables: Iterable[Columns], rows: int, folder: Path) -> Iterator[str]:
    """Each table of a run as text that ends in an empty line; the files in `folder` hold all of
    its rows."""
    chosen = _chosen_rows(rows)
    for table in tables:
        yield _shown(table, chosen, rows, folder)


def shown_ends(first: Columns, last: Columns, rows: int, folder: Path) -> str:
    """A table of which only the first and the last rows are held, as `shown_tables` has it."""
    columns = [joined_column(both) for both in zip(first.columns, last.columns, strict=True)]
    ends = replace(last, columns=tuple(columns))
    return _shown(ends, _chosen_rows(rows), rows, folder, held=range(columns[0].rows))


def shown_summary(name: str, title: str, summary: Summary) -> str:
    """What stands below a table of which no rows are shown."""
    below = summary_table(name, title, summary)
    lines = [f"{below.name}: {_one_line(below.title)}"]
    width = shutil.get_terminal_size((80, 24)).columns
    columns = [["summary", "", *summary.lines]]
    for each in summary.columns:
        unit = f"[{each.unit}]" if each.unit else ""
        columns.append([_one_line(each.label), unit, *summary.texts(each)])
    for group in _side_by_side(columns, width):
        lines += ["", *group]
    notes = summary.written_notes(_one_line)
    lines += [line for note in notes for line in wrap(f"({note})", width)]
    return "\n".join(lines) + "\n\n"


def _shown(
    table: Columns, chosen: Sequence[int], rows: int, folder: Path, held: Sequence[int] = ()
) -> str:
    """Some rows of a table, which are its rows `held`, if it has not all of them."""
    width = shutil.get_terminal_size((80, 24)).columns
    title = _one_line(table.title)
    heading = f"{table.name}: {title}" if title != table.name else table.name
    lines = wrap(heading, width)
    for group in _grouped(table, chosen, width, held):
        lines += ["", *group]
    left_out = rows - len(chosen)
    if left_out:
        lines.append(f"({left_out} of {rows} rows left out here; all are in {folder})")
    if table.summary is not None:
        notes = table.summary.written_notes(_one_line)
        lines += [line for note in notes for line in wrap(f"({note})", width)]
    return "\n".join(lines) + "\n\n"


def shown_table(table: Columns, count: int) -> str:
    """All rows of one table, without its title."""
    width = shutil.get_terminal_size((80, 24)).columns
    groups = _grouped(table, range(count), width)
    return "\n\n".join("\n".join(group) for group in groups) + "\n"


def _grouped(
    table: Columns, rows: Sequence[int], width: int, held: Sequence[int] = ()
) -> Iterator[list[str]]:
    """The lines of the columns that fit side by side, group by group."""
    columns = [_texts(column, held or rows) for column in table.columns]
    gaps = [k for k in range(1, len(rows)) if rows[k] != rows[k - 1] + 1]
    for gap in reversed(gaps):
        for number, cells in enumerate(columns):
            cells.insert(HEAD_LINES + gap, "" if number else GAP_MARK)
    if table.summary is not None:
        columns = _with_summary(columns, table.summary)
    yield from _side_by_side(columns, width)


def _side_by_side(columns: list[list[str]], width: int) -> Iterator[list[str]]:
    """The lines of columns of cells, those that fit side by side group by group."""
    padded = [[cell.rjust(max(map(len, cells))) for cell in cells] for cells in columns]
    for group in _groups(padded, width):
        yield [GAP.join(row).rstrip() for row in zip(*group, strict=True)]


def _with_summary(columns: list[list[str]], summary: Summary) -> list[list[str]]:
    """The columns with what stands below them; its words stand in the first column, or in one of
    their own where that is summed up itself."""
    below = {each.number: summary.texts(each) for each in summary.columns}
    words, gap = list(summary.lines), len(summary.lines) * [""]
    if 0 in below:
        columns = [len(columns[0]) * [""], *columns]
        below = {number + 1: texts for number, texts in below.items()}
    below[0] = words
    return [[*cells, "", *below.get(number, gap)] for number, cells in enumerate(columns)]


def _one_line(text: str) -> str:
    return legible(" ".join(text.split()), also="")


def _chosen_rows(rows: int) -> list[int]:
    if rows <= MOST_ROWS:
        return list(range(rows))
    half = MOST_ROWS // 2
    return [*range(half), *range(rows - half, rows)]


def _texts(column: TableColumn, chosen: Sequence[int]) -> list[str]:
    """Label, unit and cells of a column."""
    if isinstance(column.values, Words):
        texts = column.values.texts(chosen)
    else:
        part = column.part(chosen)
        texts = part.texts(column_texts(part.numbers, part.decimals, part.rounding))
    return [_one_line(column.label), f"[{column.unit}]" if column.unit else "", *texts]


def _groups(columns: list[list[str]], width: int) -> Iterator[list[list[str]]]:
    """Columns side by side within the width; the first column leads every group."""
    group = columns[:1]
    for cells in columns[1:]:
        taken = sum(len(c[0]) + len(GAP) for c in group)
        if len(group) > 1 and taken + len(cells[0]) > width:
            yield group
            group = columns[:1]
        group.append(cells)
    yield group


IDLE_SHOWN = 2
"""Idle freedoms that are named one by one."""


def summary(file: str, analysis: Analysis, *, errors: bool = False) -> list[str]:
    """Lines: driven freedoms, loops, branch, rows, worst residual and power error; of a response
    what is free, and how it ended; with `errors` how many digits are right."""
    result = analysis.result
    name = analysis.model.name
    if analysis.run == SWEEP:
        rows = [("driven", _driven(analysis.model.problem))]
    else:
        word = "equilibria" if _rests(analysis) else "response"
        name = f"{name}, {word} {analysis.run}"
        rows = [("free", _free(analysis.model, analysis.run))]
    rows.append(("loops", _loops(analysis.model.problem, result.graph)))
    if result.mode:
        rows.append(("branch", _branch(result.mode, result.how)))
    verdicts = RunVerdicts.of(result)
    if analysis.run != SWEEP:
        off = np.asarray(result.quantity(f"row.{result.measure}").value)
        verdicts.measure(result.measure.replace("_", " "), off)
    rows += [("rows", _rows(verdicts)), ("worst", _worst(verdicts.worst))]
    if analysis.run == SWEEP and result.is_certified:
        rows.append(("proof", analysis.certificate.words))
    if _rests(analysis):
        rows.insert(-1, ("found", _found(result)))
    elif analysis.run != SWEEP:
        rows.insert(-1, ("ended", _ended(result.units, ended(result), result.rows)))
    if errors:
        rows.append(("errors", errors_line(analysis)))
    return [f"{name} ({file})", *(_line(*row) for row in rows)]


def streamed_summary(file: str, stream: Stream) -> list[str]:
    """The lines of `summary` for a run whose rows are not held."""
    model, verdicts = stream.model, stream.verdicts
    name, lines = model.name, [("driven", _driven(model.problem))]
    if stream.run != SWEEP:
        name = f"{name}, response {stream.run}"
        lines = [("free", _free(model, stream.run))]
    lines.append(("loops", _loops(model.problem, stream.source.session.graph)))
    lines += [("branch", _branch(*stream.branch))] if stream.branch[0] else []
    lines.append(("rows", _rows(verdicts)))
    if stream.run != SWEEP:
        lines.append(("ended", _ended(model.problem.units, stream.ended, stream.run_rows)))
    lines.append(("worst", _worst(verdicts.worst)))
    return [f"{name} ({file})", *(_line(*line) for line in lines)]


def files_line(folder: Path, written: Sequence[Path], removed: Sequence[str]) -> str:
    """Where the files are, how many of each kind, and those of the run before that went."""
    kinds = Counter(file.suffix.removeprefix(".") for file in written)
    counts = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
    gone = f"; removed from the run before: {listed(removed)}" if removed else ""
    return _line("files", f"{folder} ({counts}){gone}")


def _line(name: str, text: str) -> str:
    return f"  {name:<9}{text}"


def _free(model: Solvable, run: str) -> str:
    """How many freedoms move under forces, where they start, what is driven and what acts."""
    own = model.design.response(run)
    noun = "freedom" if len(own.independent) == 1 else "freedoms"
    names = ", ".join(f"{joint}.{name}" for joint, name in own.independent)
    parts = [f"{len(own.independent)} {noun} from {names}"]
    if own.efforts:
        parts.append(f"efforts on {', '.join(one.name for one in own.efforts)}")
    if own.driven:
        parts.append(f"driven: {', '.join(one.name for one in own.driven)}")
    return "; ".join(parts)


def _rests(analysis: Analysis) -> bool:
    """Whether a run is one of equilibria."""
    own = analysis.model.design
    return analysis.run != SWEEP and own.response(analysis.run).search is not None


def _found(result: Result) -> str:
    """How many equilibria there are, and of which kinds."""
    kinds = Counter(event.partition(" ")[0] for event in result.events if event)
    count = sum(kinds.values())
    if not count:
        return "no equilibrium"
    words = ", ".join(f"{number} {kind}" for kind, number in kinds.items())
    return f"{count} equilibri{'um' if count == 1 else 'a'}: {words}"


def _ended(units: UnitSystem, end: Ended | None, run_rows: int) -> str:
    """By which stop, or at the last moment asked for, or before it."""
    unit = units.label(TIME)
    if end is None:
        return "before it began"
    at = f"at {end.time:.9g} {unit}"
    if end.event:
        return f"{at}: {end.event}"
    if end.row == run_rows - 1 or end.behind is None:
        return f"{at}, the last moment"
    return f"at {end.over:.9g} {unit}: {end.behind.label}"


def _branch(mode: str, how: str) -> str:
    """The mode by its letter where that is known, and how it was found."""
    if mode == NEAR:
        return how
    return f"mode {mode} ({how})" if how else mode


def _driven(problem: Problem) -> str:
    """How many freedoms are driven, by which inputs, and Kutzbach's count where it differs."""
    mechanism = problem.mechanism
    count = mechanism.kutzbach
    rest = problem.motion.rest
    free = () if rest is None else rest.inputs
    every = problem.motion.inputs
    inputs = [one.name for number, one in enumerate(every) if number not in free]
    resting = [every[number].name for number in free]
    plural = "freedom" if len(inputs) == 1 else "freedoms"
    text = f"{len(inputs)} {plural} by {', '.join(inputs)}" if inputs else "nothing"
    words = [spin.idle_words for spin in mechanism.told_spins]
    several = Counter(held.words for held in problem.held if held.idle)
    words += [text if n == 1 else f"{text} ({n} freedoms)" for text, n in several.items()]
    idle = "".join(f"; {text}" for text in words[:IDLE_SHOWN])
    more = len(words) - IDLE_SHOWN
    idle += f"; and {more} more idle" if more > 0 else ""
    if resting:
        text += f", at rest: {', '.join(resting)}"
    return (text if count == len(every) else f"{text} (Kutzbach's count: {count})") + idle


def _loops(problem: Problem, graph: SolverGraph) -> str:
    """Loops of the file's own joints and cylinders, and what couples them; what a cable is made of
    is no loop that a file has."""
    mechanism = problem.mechanism
    if not graph.closings:
        return "none (open chain)"
    labels = [c.label for c in graph.closings if not c.terms and is_written(c.name)]
    eyes = [c.name.partition(".")[0] for c in graph.closings if not is_written(c.name)]
    lifts = [
        f"cylinder {name}"
        for name in eyes
        if name in mechanism.joints and mechanism.joints[name].is_telescope
    ]
    closed = ", ".join(dict.fromkeys((*labels, *lifts)))
    coupled = ", ".join(
        f"cable {c.owner}" if mechanism.couplings[c.owner].extents else c.owner
        for c in graph.closings
        if c.terms
    )
    words = (f"closed at {closed}" * bool(closed), f"coupled by {coupled}" * bool(coupled))
    sizes = " then ".join(str(len(block.unknowns)) for block in graph.blocks)
    unknowns = f"{sizes} unknown{'s' * (sizes != '1')}"
    return f"{mechanism.told_loops or 'none'}, {', '.join(filter(None, words))}; {unknowns}"


def _rows(verdicts: RunVerdicts) -> str:
    text = f"{verdicts.solved} of {verdicts.rows} solved"
    others = [f"{n} {one.label}" for one, n in verdicts.counts.items() if one != Status.ok]
    return f"{text} ({', '.join(others)})" if others else text


def _worst(measured: Mapping[str, float]) -> str:
    parts = [f"{name} {value:.1e}" for name, value in measured.items()]
    return ", ".join(parts) or "nothing was solved"


COLUMNS_SHOWN = 3
"""Columns that are named one by one."""

_NO_GAP = {ZERO, WORDS}
"""Columns of which everything is known that there is."""


def errors_line(analysis: Analysis) -> str:
    """`every cell right to 12 digits; worst: alpha4 at 202, 3e-13`, and what was not repeated."""
    errors = analysis.errors
    parts: list[str] = []
    worst = errors.worst
    if worst is None:
        parts.append("no cell was repeated")
    else:
        said = f"every cell right to {errors.digits} digits"
        if any(c.why and c.why not in _NO_GAP for c in errors.columns):
            said = f"every cell repeated is right to {errors.digits} digits"
        parts.append(f"{said}; worst: {_place(analysis, worst)}")
    zero = [c for c in errors.columns if c.why == ZERO]
    parts += [f"{ZERO}: {_named(zero)}"] if zero else []
    parts += _left_out([c for c in errors.columns if c.why and c.why not in _NO_GAP])
    words = [c for c in errors.columns if c.why == WORDS]
    parts += [f"words, which have no error: {_named(words)}"] if words else []
    bounds = sum(int(np.count_nonzero(c.is_bound)) for c in errors.columns)
    parts += [f"{bounds} cells right to at least the digits given"] if bounds else []
    for why in dict.fromkeys(c.lost_why for c in errors.columns if c.lost):
        lost = sum(c.lost for c in errors.columns if c.lost_why == why)
        parts.append(f"{counted(lost, 'cell')} not measured ({why})")
    empty = sum(int(np.count_nonzero(c.at_dead_centre)) for c in errors.columns)
    parts += [f"{counted(empty, 'cell')} without a figure ({AT_DEAD_CENTRE})"] if empty else []
    return "; ".join(parts)


def _place(analysis: Analysis, column: ColumnErrors) -> str:
    """The worst cell of a column: its label, where, and the error in parts of the largest."""
    row = column.worst
    inputs = list(analysis.result.inputs.values())
    at = f"{inputs[0][row]:.12g}" if inputs else f"row {row + 1}"
    return f"{legible(column.label)} at {at}, {column.relative[row]:.0e}"


def _left_out(columns: list[ColumnErrors]) -> list[str]:
    """Which columns were not repeated, by the reasons why."""
    reasons = dict.fromkeys(column.why for column in columns)
    return [
        f"not repeated: {_named([c for c in columns if c.why == why])} ({why})" for why in reasons
    ]


def _named(columns: list[ColumnErrors]) -> str:
    """The labels of some columns, the first of them one by one."""
    names = (column.table if column.label == ALL_COLUMNS else column.label for column in columns)
    labels = list(dict.fromkeys(map(legible, names)))
    more = len(labels) - COLUMNS_SHOWN
    return ", ".join(labels[:COLUMNS_SHOWN]) + (f" and {more} more" if more > 0 else "")


# `--explain`: the solver graph, what is computed and what is skipped, as text.


def explanation(analysis: Analysis) -> str:
    """Tree, cut joints, blocks and the demand plan."""
    graph = analysis.result.graph
    of = analysis.model.name if analysis.run == SWEEP else f"the start of {analysis.run}"
    lines = [f"solver graph of {of}", "  tree"]
    told = analysis.result.problem.mechanism.told_name
    for edge in graph.edges:
        if not is_told(edge.child):
            continue
        words = "" if edge.forward else ", passed from its second link to its first"
        words = ", hung between its spheres" if edge.hung else words
        by = _joint(edge.joint, words) if is_told(edge.joint.name) else told(edge.joint.name)
        lines.append(f"    {told(edge.parent)} -> {edge.child} by {by}")
    closed = [pair for pair in zip(graph.closings, graph.loops, strict=True) if not pair[0].terms]
    lines.append("  loops closed at" if closed else "  no loops")
    for closing, passed in closed:
        name, is_own = told(closing.joint.name), is_told(closing.joint.name)
        others = dict.fromkeys(told(graph.edges[k].joint.name) for k, _ in passed)
        loop = ", ".join(other for other in others if other != name)
        equations = f", {counted(closing.equations, 'equation')}"
        if closing.words and is_own:
            equations += f": {closing.words}"
        shown = _joint(closing.joint, equations) if is_own else f"{name} ({equations[2:]})"
        lines.append(f"    {shown}" + f" with {loop}" * bool(loop))
    coupled = [closing for closing in graph.closings if closing.terms]
    lines += ["  coupled by"] * bool(coupled)
    lines += [f"    {closing.name}, {closing.words}" for closing in coupled]
    if graph.blocks:
        lines.append("  blocks, solved in this order")
    for number, block in enumerate(graph.blocks, 1):
        names = _unknowns([(graph.edges[k].joint, f) for k, f in block.unknowns], told)
        unknowns = f"{counted(len(block.unknowns), 'unknown')} {', '.join(names)}"
        more = block.equations > len(block.unknowns)
        of = f" from {counted(block.equations, 'equation')}"
        lines.append(f"    {number}: {unknowns}" + of * more)
    lines.append("demand plan")
    lines += [f"  {line}" for line in _demand_lines(analysis)]
    return "\n".join(lines) + "\n"


def _unknowns(freedoms: list[tuple[Joint, int]], told: Callable[[str], str]) -> list[str]:
    """Their names; those of one stretch of a cable together."""
    found: dict[str, list[str]] = {}
    for joint, freedom in freedoms:
        if is_told(joint.name):
            found[_freedom(joint, freedom)] = []
        else:
            known = found.setdefault(told(joint.name), [])
            known.append("length" if joint.type.slides[freedom] else "turn")
    return [f"{_of_stretch(kinds)} of {name}" if kinds else name for name, kinds in found.items()]


def _of_stretch(kinds: list[str]) -> str:
    turns = kinds.count("turn")
    words = ("turns" if turns > 1 else "turn") * bool(turns), "length" * ("length" in kinds)
    return " and ".join(filter(None, words))


def _freedom(joint: Joint, freedom: int) -> str:
    """A coordinate's name; turns of a sphere have none of their own."""
    names = {number: name for name, number in reversed(joint.type.freedom_of.items())}
    if freedom in names:
        return f"{joint.name}.{names[freedom]}"
    turns = [f for f, slide in enumerate(joint.type.slides) if not slide]
    return f"{joint.name} (turn {turns.index(freedom) + 1} of {len(turns)})"


def _joint(joint: Joint, words: str) -> str:
    kind = "six unknowns" if joint.type.is_free else joint.letter
    return f"{joint.name} ({kind}{words})"


def _demand_lines(analysis: Analysis) -> list[str]:
    result = analysis.result
    problem = analysis.model.problem if analysis.run == SWEEP else result.problem
    demand, mechanism = result.demand, problem.mechanism
    massless = not any(link.has_mass for link in mechanism.links.values())
    forces = bool(demand & Demand.FORCES)
    known = problem.quantities()
    asked = [known[name] for name in result.columns if name in known]
    reactions = any(quantity.kind in REACTION_KINDS for quantity in asked)
    lines = [
        f"first assembly: {result.how or 'none found'}",
        _positions(analysis),
        _part_line("velocities", bool(demand & Demand.VELOCITY), "no column reads a rate"),
        _part_line("accelerations", bool(demand & Demand.ACCELERATION), _without(forces, massless)),
        _part_line("input efforts and closing wrenches", forces, "no column reads a force"),
        _part_line("joint wrenches", reactions, "no column reads a reaction"),
        _part_line("condition of each row", bool(demand & Demand.CONDITION), "not asked for"),
        _part_line(
            "power balance of each row",
            bool(demand & Demand.POWER),
            "no rates are computed" if forces else "no column reads a force",
        ),
    ]
    if forces and problem.load_laws:
        read = ", ".join(quantities_read(problem))
        lines.append(f"loads that vary: evaluated with the forces, from {read}")
    lines += _derived_lines(asked)
    if forces and massless:
        lines.append("inertia: skipped, no link has mass")
    return [*lines, _width_line()]


def _positions(analysis: Analysis) -> str:
    result = analysis.result
    if analysis.run == SWEEP:
        nodes = f"{counted(result.nodes, 'node')} followed, the rest filled in between"
        return f"positions: {result.rows} rows, {nodes}"
    response = analysis.model.design.response(analysis.run)
    if response.search is not None:
        return f"positions: {result.rows} places, found where the loads balance"
    step = f"a tolerance of {response.tolerance:g}"
    if response.fixed_step is not None:
        step = f"steps of {response.fixed_step:g} s"
    return f"motion: {result.rows} rows, integrated in {result.nodes} steps with {step}"


def _width_line() -> str:
    known = ", ".join(f"{lanes} ({INSTRUCTIONS[lanes]})" for lanes in widths())
    return f"width: {width()} rows at a time; this machine has {known}"


def _derived_lines(asked: list[Wanted]) -> list[str]:
    lines = []
    plain = DERIVED_KINDS - POWER_KINDS - COEFFICIENT_KINDS
    simple = [quantity.name for quantity in asked if quantity.kind in plain]
    if simple:
        lines.append(f"derived from positions and rates: {', '.join(simple)}")
    if any(quantity.kind == "mechanical_advantage" for quantity in asked):
        lines.append("mechanical advantages: one more run, with unit rate of one input")
    linear = {accelerated(quantity) for quantity in asked if quantity.kind in COEFFICIENT_KINDS}
    if linear:
        lines.append(f"coefficients of accelerations: one more run for each input, {len(linear)}")
    angles = sum(quantity.kind == "transmission_angle" for quantity in asked)
    if angles:
        lines.append(f"transmission angles: static runs with a unit load, {angles} in all")
    return lines


def _without(forces: bool, massless: bool) -> str:
    if forces and massless:
        return "no link has mass and no column reads an acceleration"
    return "no column reads an acceleration or a force"


def _part_line(what: str, computed: bool, why_not: str) -> str:
    return f"{what}: computed" if computed else f"{what}: skipped, {why_not}"
