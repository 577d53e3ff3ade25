"""Mobility: Kutzbach's count against the finite freedom, what makes them differ, and what the
inputs do to the freedoms.

With n links (ground too), j joints and freedoms f, the count is 6 (n - 1 - j) + sum f: all freedoms
less six for every loop; in a plane less three, 3 (n - 1) - 2 j where all joints have one freedom.
Every coupling takes one more.
The freedom of first order is sum f less the rank of the loops' screws at the first configuration;
the finite freedom is the dimension of the assembled configurations next to it (`dimension`). The
difference of sum f less the rank at a general configuration and the count is the number of
redundant constraints. Inputs may be locked, dependent, or too few (`input_notes`); `check` reports
what is known of them from the drawing alone, without a search (`drawn_faults`).

Redundant constraints (`redundancies`): which joints carry them, as which forces and moments, and a
cure. A stress is a set of joint wrenches in equilibrium without load: a null vector of the
transposed screws of the loops. In a single loop every joint carries the same wrench, which no joint
of the loop gives way to.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import is_home_singular
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mechanism import Joint, Problem, is_written, joint_type
from mechkin_cli.mobility.configurations import Body, Configuration, assembled, first_row, home
from mechkin_cli.mobility.dimension import LocalFreedom, freedom_of
from mechkin_cli.mobility.families import MotionFamily, families_of
from mechkin_cli.mobility.idle import IdleFreedom, Motions, idle_freedoms
from mechkin_cli.plan import home_inputs, home_state
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.session import moves_freely
from mechkin_cli.show import Listed, Listing
from mechkin_cli.structure import listed

if TYPE_CHECKING:
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


def count_of_freedoms(number: int) -> str:
    """A number of freedoms in words.

    >>> count_of_freedoms(1), count_of_freedoms(2)
    ('one freedom', '2 freedoms')
    """
    return "one freedom" if number == 1 else f"{number} freedoms"


def meeting(dimensions: tuple[int, ...]) -> str:
    """Dimensions of components that meet, the least first."""
    return " and ".join(str(number) for number in sorted(dimensions))


def input_notes(problem: Problem, motions: Motions, idle: int) -> list[Diagnostic]:
    """Inputs that are locked, depend on each other, or leave freedoms undriven."""
    driven = problem.motion.driven
    if not driven:
        return []
    rates = motions.rates[[motions.body.column(*each) for each in driven]]
    doubt = max(motions.doubt, tolerances.RANK_ZERO)
    notes = []
    names = [f"{name}.{coordinate}" for name, coordinate in driven]
    still = np.abs(rates).max(axis=1, initial=0.0) < doubt
    locked = [name for name, is_still in zip(names, still, strict=True) if is_still]
    for name in locked:
        message = f"the input {name} is locked: no motion changes it"
        notes.append(Diagnostic("input-locked", "error", message, hint="drive another coordinate"))
    _, values, right = np.linalg.svd(rates)
    rank = int(np.count_nonzero(values > doubt))
    if rank < len(driven) - len(locked):
        notes.append(
            Diagnostic(
                "inputs-dependent",
                "error",
                f"the inputs {', '.join(names)} are not independent",
                measured=f"{len(driven)} inputs drive {count_of_freedoms(rank)}",
                hint="drive fewer coordinates",
            )
        )
    left = motions.rates @ right[rank:].T
    moving = motions.body.coordinates(np.abs(left).max(axis=1, initial=0.0) > doubt)
    return [*notes, *undriven_notes(motions.mobility, idle, rank, moving)]


def undriven_notes(
    freedoms: int, idle: int, driven: int, candidates: tuple[str, ...] = ()
) -> list[Diagnostic]:
    """Freedoms that neither spin idly nor are driven; `candidates` are coordinates that they
    move."""
    left = freedoms - driven - idle
    if left <= 0:
        return []
    message = f"{count_of_freedoms(left)} {'is' if left == 1 else 'are'} not driven"
    if candidates:
        message += f"; candidates: {listed(candidates)}"
    measured = f"{count_of_freedoms(freedoms)}, {idle} idle, {driven} driven"
    hint = "add inputs under motion"
    return [Diagnostic("undriven-freedom", "warning", message, measured=measured, hint=hint)]


@dataclass(frozen=True, repr=False)
class Mobility(Listed):
    """What can move.

    `count` is Kutzbach's; `mobility` the finite freedom, None where it is unknown (no assembly, or
    unclear); `dimensions` are those of all components of motion that meet at the first
    configuration, the largest first, which is `mobility`. `first_order` is the freedom of small
    moves there, larger than `mobility` where part of it goes no finite way. `loops` counts
    independent loops, `inputs` the driven coordinates; `fixed` are the coordinates that never
    move; `families` are the components of motion where several meet, or where the first order has
    more everywhere.
    """

    name: str
    count: int
    loops: int
    inputs: tuple[str, ...]
    mobility: int | None = None
    first_order: int | None = None
    dimensions: tuple[int, ...] = ()
    configurations: int = 0
    idle: tuple[IdleFreedom, ...] = ()
    redundant: tuple[Redundancy, ...] = ()
    fixed: tuple[str, ...] = ()
    families: tuple[MotionFamily, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def listing(self) -> Listing:
        """The verdict, and what is idle, redundant or fixed."""
        notes = [f"{self.count} by Kutzbach's count, {self.loops} loops"]
        notes += [f"idle: {item.sentence}" for item in self.idle]
        notes += [f"redundant: {item.sentence}" for item in self.redundant]
        notes += [f"fixed: {', '.join(self.fixed)} never move"] if self.fixed else []
        notes += [f"family: {family.sentence}" for family in self.families]
        return Listing(f"Mobility of {self.name}: {self.verdict}", notes=tuple(notes))

    @property
    def useful(self) -> int | None:
        """Freedoms beside the idle ones."""
        return None if self.mobility is None else self.mobility - len(self.idle)

    @property
    def verdict(self) -> str:
        """The finite freedom and Kutzbach's count, in one sentence."""
        if self.mobility is None:
            return f"mobility unclear; the count says {self.count}"
        return f"{self._moves()}; {self._compared()}"

    def _moves(self) -> str:
        if not self.mobility:
            text = "nothing can move"
            return f"{text} but to first order" if self.first_order else text
        if len(self.dimensions) > 1:
            text = f"motions of {meeting(self.dimensions)} freedoms meet"
        else:
            text = count_of_freedoms(self.mobility)
        if self.first_order != self.mobility:
            text += f" ({self.first_order} to first order)"
        return text + (f", {len(self.idle)} of them idle" if self.idle else "")

    def _compared(self) -> str:
        redundant = sum(item.number for item in self.redundant)
        constraints = "one constraint is" if redundant == 1 else f"{redundant} constraints are"
        if self.mobility == self.count:
            # what the count allows needs no exact dimensions, whatever the rank is
            says = "as Kutzbach's count says"
            return f"{says}, though {constraints} redundant to first order" if redundant else says
        count = f"Kutzbach's count is {self.count}"
        if not redundant or not self.mobility:
            return count
        return f"{count}: {constraints} redundant, so it moves only while the dimensions are exact"


def find_mobility(problem: Problem, session: Session | None = None) -> Mobility:
    """The mobility of a mechanism; its inputs count as free. `session` of the problem, where it can
    be solved as it is driven, gives the first row's assembly."""
    mechanism = problem.mechanism
    inputs = tuple(item.name for item in problem.motion.inputs)
    counted = Mobility(mechanism.name, mechanism.kutzbach, mechanism.told_loops, inputs)
    body = Body(mechanism)
    start = (session and first_row(session, body)) or assembled(body)
    if start is None:
        return replace(counted, diagnostics=(_not_assembled(body),))
    random = RandomStarts()
    driven = problem.motion.driven
    freedoms = [
        (part, freedom_of(part, start.state, random).driven_first(part.driven(body, driven)))
        for part in body.parts
    ]
    first_order = body.free.size + sum(freedom.first.motions.shape[1] for _, freedom in freedoms)
    doubts = [freedom for _, freedom in freedoms if freedom.doubt]
    if any(not freedom.first.clear for freedom in doubts):
        return replace(counted, diagnostics=(_rank_unclear(doubts),))
    if doubts:
        return replace(counted, first_order=first_order, diagnostics=(_unclear(doubts[0]),))
    motion = Motions(body, start, freedoms)
    idle = _idle(motion, driven)
    families = families_of(start, freedoms, driven)
    # inputs that drive one of several families are neither locked nor too few
    fits = any(f.inputs == inputs and f.dimension == len(inputs) + len(idle) for f in families)
    seen = tuple(item for item in idle if any(map(is_written, item.links)))
    unseen = len(idle) - len(seen)
    told = frozenset(mechanism.coordinates)
    return replace(
        counted,
        mobility=motion.mobility - unseen,
        first_order=first_order - unseen,
        dimensions=tuple(number - unseen for number in motion.dimensions),
        configurations=1 + motion.places,
        idle=seen,
        redundant=redundancies(motion.general, motion.stresses, {name for name, _ in driven}),
        fixed=tuple(name for name in motion.fixed if name in told),
        families=families,
        diagnostics=() if inputs and fits else tuple(input_notes(problem, motion, len(idle))),
    )


def _idle(motion: Motions, driven: Sequence[tuple[str, str]]) -> tuple[IdleFreedom, ...]:
    """Freedoms that are idle wherever the mechanism goes."""
    idle = idle_freedoms(motion.general, driven) if motion.mobility else ()
    for other in motion.others if idle else ():
        there = Counter(item.links for item in idle_freedoms(other, driven))
        here: Counter[tuple[str, ...]] = Counter()
        common = []
        for item in idle:
            here[item.links] += 1
            if here[item.links] <= there[item.links]:
                common.append(item)
        idle = tuple(common)
    return idle


def _not_assembled(body: Body) -> Diagnostic:
    return Diagnostic(
        "not-assembled",
        "error",
        f"{body.mechanism.name} could not be assembled, so only the count is known",
        measured=f"from the drawing the loops close to {home(body).closed().miss:.2g} of the size",
        limit=f"{tolerances.MOBILITY_CLOSED:g}",
        hint="check the dimensions; those of an overconstrained loop must be exact "
        "(write expressions)",
    )


def _rank_unclear(unclear: list[LocalFreedom]) -> Diagnostic:
    return Diagnostic(
        "rank-unclear",
        "error",
        "the rank of the constraints is not clear",
        measured=f"a gap of {min(item.first.gap for item in unclear):.3g} between singular values",
        limit=f"{tolerances.RANK_GAP:g}",
        hint="write exact dimensions (expressions), or another position of the inputs",
    )


def _unclear(unclear: LocalFreedom) -> Diagnostic:
    return Diagnostic(
        "mobility-unclear",
        "error",
        "it is not clear how many freedoms allow finite motion",
        measured=unclear.doubt,
        hint="write exact dimensions (expressions), or draw it in another position",
    )


def drawn_faults(session: Session) -> list[Diagnostic]:
    """Inputs that are locked, dependent or too few, as warnings; none where the drawing is not
    assembled or a special position."""
    problem, layout = session.problem, session.layout
    drawn = home_inputs(layout), home_state(layout)
    if not is_home_singular(session) and moves_freely(session, *drawn):
        return []  # the inputs determine all, and each of them moves
    body = Body(problem.mechanism)
    start, random = home(body), RandomStarts()
    if not start.assembled:
        return []
    freedoms = [(p, freedom_of(p, start.state, random, regular=True)) for p in body.parts]
    if any(freedom.doubt for _, freedom in freedoms):
        return []
    motions = Motions(body, start, freedoms)
    driven = problem.motion.driven
    idle = len(idle_freedoms(motions.general, driven)) if motions.mobility else 0
    if not driven:
        return undriven_notes(motions.mobility, idle, 0)
    return [note._replace(severity="warning") for note in input_notes(problem, motions, idle)]


class Redundancy(NamedTuple):
    """`number` redundant constraints that `joints` (and couplings) carry together, as `wrenches`
    (words, empty where they differ from joint to joint), and a `cure` (None if none of the usual
    ones does)."""

    number: int
    joints: tuple[str, ...]
    wrenches: str
    cure: str | None

    @property
    def sentence(self) -> str:
        """The redundancy in words."""
        who = ", ".join(self.joints)
        carry = f"the loop through {who} carries" if self.wrenches else f"{who} carry"
        text = f"{carry} {self.number} redundant constraint{'s' * (self.number > 1)}"
        text += f": {self.wrenches}" if self.wrenches else ""
        return f"{text}; {self.cure}" if self.cure else text


def redundancies(
    configuration: Configuration, stresses: Floats, driven: Container[str]
) -> tuple[Redundancy, ...]:
    """The redundant constraints, one entry per group of joints that stress each other.

    A cure leaves the `driven` joints alone.
    """
    if stresses.shape[1] == 0:
        return ()
    mechanism = configuration.body.mechanism
    joints = list(mechanism.joints.values())
    places = {joint.name: list(range(6 * k, 6 * k + 6)) for k, joint in enumerate(joints)}
    places |= {name: [6 * len(joints) + k] for k, name in enumerate(mechanism.couplings)}
    # an orthonormal basis (6 joints and couplings, count) of the wrenches that the joints carry,
    # and the efforts of couplings
    of_cuts, of_couplings = np.split(stresses, [configuration.body.loops.cut_rows])
    cuts = of_cuts.reshape(-1, 6, stresses.shape[1])
    rows = []
    for joint in joints:
        signs = configuration.body.signs[joint.name]
        passing = np.flatnonzero(signs)
        rows.append(np.add.reduce(signs[passing, None, None] * cuts[passing]))
    carried = np.linalg.qr(np.concatenate([*rows, of_couplings]))[0]
    found = []
    for names in _groups(places, carried):
        every = [i for name in names for i in places[name]]
        number = round(float(np.sum(carried[every] ** 2)))
        if number:
            group = [mechanism.joints[name] for name in names if name in mechanism.joints]
            words = ""
            if len(group) == len(names):
                words = _wrenches(configuration, group, carried[places[names[0]]], number)
            softer = [joint for joint in group if joint.name not in driven]
            cure = _cure(configuration, softer, number)
            found.append(Redundancy(number, names, words, cure))
    return tuple(found)


_STRESSED_TOGETHER = 64
"""Joints whose stresses are compared with all at a time."""


def _groups(places: dict[str, list[int]], carried: Floats) -> Iterator[tuple[str, ...]]:
    """Joints and couplings that carry stresses, in groups that do not stress each other."""
    names = list(places)
    starts = [rows[0] for rows in places.values()]

    # which ones each stresses, for some of them at a time: all at once would take much memory
    touched: list[list[int]] = []
    ends = [*starts[1:], len(carried)]
    for first in range(0, len(names), _STRESSED_TOGETHER):
        last = min(first + _STRESSED_TOGETHER, len(names))
        shares = np.abs(carried[starts[first] : ends[last - 1]] @ carried.T)
        here = np.array(starts[first:last]) - starts[first]
        most = np.maximum.reduceat(np.maximum.reduceat(shares, here, axis=0), starts, axis=1)
        touched += [np.flatnonzero(one).tolist() for one in most > tolerances.MOBILITY_NO_WRENCH]
    seen: set[int] = set()
    for first in range(len(names)):
        if first in seen or first not in touched[first]:
            continue
        group = [first]
        seen.add(first)
        for member in group:
            more = [k for k in touched[member] if k not in seen]
            seen.update(more)
            group += more
        yield tuple(names[k] for k in sorted(group))


def _wrenches(
    configuration: Configuration, group: list[Joint], carried: Floats, number: int
) -> str:
    """The stress of a single loop in words, of what its first joint carries (6, count); empty for
    several loops."""
    links = {link for joint in group for link in (joint.first, joint.second)}
    if len(links) != len(group):
        return ""
    left, _, _ = np.linalg.svd(carried)
    return _described(left[:, :number], configuration)


def _described(wrenches: Floats, configuration: Configuration) -> str:
    """A space of wrenches (6, count; moment first, scaled, about the centre) as forces and
    moments."""
    left, values, right = np.linalg.svd(wrenches[3:])
    forces = int(np.count_nonzero(values > tolerances.MOBILITY_NO_WRENCH))
    moments = (wrenches @ right[forces:].T)[:3]
    parts = []
    if moments.shape[1]:
        parts.append(_directions("moment", "about", np.linalg.svd(moments)[0], moments.shape[1]))
    if forces == 1 and not moments.shape[1]:
        parts.append(_line(wrenches[:, 0]))
    elif forces:
        place = "" if moments.shape[1] else _point(wrenches, configuration)
        parts.append(_directions("force", "along", left, forces) + place)
    return ", ".join(parts)


def _directions(noun: str, word: str, basis: Floats, count: int) -> str:
    """A space of directions: the first `count` columns of an orthonormal basis."""
    if count == 3:
        return f"{noun}s {word} all axes"
    if count == 1:
        return f"{noun} {word} {_axis(basis[:, 0])}"
    normal = basis[:, 2]
    named = [
        name
        for name, part in zip("xyz", normal, strict=True)
        if abs(part) < tolerances.MOBILITY_NO_WRENCH
    ]
    if len(named) == 2:
        return f"{noun}s {word} {' and '.join(named)}"
    return f"{noun}s {word} axes square to {_axis(normal)}"


def _line(wrench: Floats) -> str:
    """A single wrench by its axis and pitch (moment / force)."""
    moment, force = wrench[:3], wrench[3:]
    square = float(force @ force)
    pitch = float(force @ moment) / square
    axis = f"along {_axis(force / np.sqrt(square))}"
    if abs(pitch) < tolerances.MOBILITY_NO_WRENCH:
        return f"force {axis}"
    return f"force {axis} together with a moment about it"


def _point(wrenches: Floats, configuration: Configuration) -> str:
    """Through which point all the forces go, or that they go through none."""
    # p x force as a matrix on p
    rows = np.array(
        [row for x, y, z in wrenches[3:].T for row in ((0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0))]
    )
    moments = wrenches[:3].T.ravel()
    point = np.linalg.lstsq(rows, moments, rcond=None)[0]
    if np.abs(rows @ point - moments).max() > tolerances.MOBILITY_NO_WRENCH:
        return ", each with a moment of its own"
    near = [
        joint.name
        for joint in configuration.body.mechanism.joints.values()
        if np.abs(configuration.point(joint) - point).max() < tolerances.MOBILITY_NO_WRENCH
    ]
    return f" through {near[0]}" if near else " through one point"


def _axis(direction: Floats) -> str:
    for name, part in zip("xyz", direction, strict=True):
        if abs(part) > 1.0 - tolerances.MOBILITY_NO_WRENCH:
            return name
    sign = 1.0 if direction[np.argmax(np.abs(direction))] > 0.0 else -1.0
    parts = np.where(np.abs(direction) > tolerances.MOBILITY_NO_WRENCH, sign * direction, 0.0)
    return "(" + ", ".join(f"{part:.4g}" for part in parts) + ")"


def _cure(configuration: Configuration, group: list[Joint], number: int) -> str | None:
    """The fewest softer joints that take away all redundancy and free no motion."""
    options = [(joint, letter) for joint in group for letter in joint.type.softer]
    frees = [joint_type(letter).freedoms - joint.type.freedoms for joint, letter in options]
    counts = [
        count
        for count in range(1, tolerances.MOST_CHANGES + 1)
        if options and count * min(frees) <= number <= count * max(frees)
    ]
    rank = _rank(configuration.jacobian) if counts else 0
    for count in counts:
        for changes in combinations(options, count):
            freed = sum(
                joint_type(letter).freedoms - joint.type.freedoms for joint, letter in changes
            )
            if freed != number or len({joint.name for joint, _ in changes}) < count:
                continue
            softer = [configuration.wider(joint, letter) for joint, letter in changes]
            if _rank(np.concatenate([configuration.jacobian, *softer], axis=1)) == rank + number:
                words = (f"{joint.name} as {letter}" for joint, letter in changes)
                return f"none is left with {' and '.join(words)}"
    return None


def _rank(matrix: Floats) -> int:
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.count_nonzero(values > tolerances.RANK_ZERO * values.max(initial=0.0)))
