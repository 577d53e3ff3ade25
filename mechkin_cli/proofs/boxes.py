"""Proofs of positions by the kernel: boxes about places, and tubes along a path of the inputs.

A box is as wide as rounding leaves the position; a tube is a box at every place between two places
of the path (docs/numerics.md, Proofs). The mechanism's constants are enclosed (`Enclosed`), places
along the path are `Nodes`; `differences` measures how far places are from each other.
Assembly modes are proven by boxes alone: that each exists, and that no two are the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand, Layout
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, RowInputs, Session, equations_that_follow
from mechkin_cli.tape import TraceLost
from mechkin_cli.verdict import Proof

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.show import Bools, Floats


FULL_TURN = 2.0 * np.pi


def about_high(parts: Iterable[Floats]) -> Floats:
    """Radii about high parts, of numbers as high parts, low parts and radii about both."""
    _, low, radius = parts
    widened: Floats = np.nextafter(np.abs(low) + radius, np.inf)
    return np.where((low == 0.0) & (radius == 0.0), 0.0, widened)


class Enclosed(NamedTuple):
    """A session's mechanism with its constants enclosed.

    Attributes:
        session: the mechanism in doubles.
        plan: its plan at the constants' high parts.
        radii: a plan of their radii about these; None where the doubles are taken as they are.
        constants: high and low parts and radii about their sums (constants, 3); None likewise.
        of_text: whether these constants enclose the numbers of the file's text.
        follows: which closing equations follow from others of their joint, one byte
            each; None where none does.
    """

    session: Session
    plan: Plan
    radii: Plan | None
    constants: Floats | None
    of_text: bool
    follows: bytes | None

    @classmethod
    def of(cls, session: Session) -> Enclosed:
        """Of the file's text; of the doubles where it cannot be followed to all constants."""
        try:
            constants = session.precise.enclosed_constants(session)
        except (LookupError, ValueError, TraceLost):
            return cls(session, session.plan, None, None, False, None)
        scale = [_kernel.CONSTANT_LENGTH, _kernel.CONSTANT_SIZE]
        middle, radius = constants[:, 0].copy(), about_high(constants.T)
        radius[scale] = middle[scale]  # of units, which are conventions
        plan = session.plan.with_constants(middle)
        follows = bytes(equations_that_follow(session)) if session.is_redundant else None
        return cls(session, plan, plan.with_constants(radius), constants, True, follows)


@remembered
def enclosed_of(session: Session) -> Enclosed:
    """As `Enclosed.of`."""
    return Enclosed.of(session)


class Boxes(NamedTuple):
    """Boxes about places, arrays over these.

    Attributes:
        proven: whether the box holds exactly one solution of the equations solved for.
        radius: of the box by columns (columns, places), rad and lengths of the kernel; of an
            orientation of the increments that turn it.
        contraction: at most the part of a box that the operator leaves, below 1 where proven.
        beyond: at most the size of the closing equations beyond those solved for; 0 where there
            are none, or where they follow or hold exactly.
    """

    proven: Bools
    radius: Floats
    contraction: Floats
    beyond: Floats

    def part(self, places: slice) -> Boxes:
        """Some of the places."""
        radius = np.ascontiguousarray(self.radius[:, places])
        return Boxes(self.proven[places], radius, self.contraction[places], self.beyond[places])


MEASURED = 1.0 + 1.0 / 1024.0
"""Above what a distance in double-double may be off, and what sums of bounds lose by rounding."""


class Nodes(NamedTuple):
    """Places along a path of the inputs in the kernel's units, straight from each to the next;
    arrays over the places.

    Attributes:
        values: of the inputs with their whole turns (inputs, nodes).
        reduced: without them, likewise.
        states: (states, nodes).
        off: how far the inputs may be from what is meant (inputs, nodes).
        least: boxes are at least so wide (columns, nodes).
    """

    values: Floats
    reduced: Floats
    states: Floats
    off: Floats
    least: Floats

    @classmethod
    def of(cls, session: Session, values: Floats, reduced: Floats, states: Floats) -> Nodes:
        """Places whose inputs are as near to the file's as rounding leaves them, with boxes as
        narrow as can be proven."""
        least = np.zeros((session.plan.columns, values.shape[1]))
        return cls(values, reduced, states, input_rounding(session, values), least)

    def part(self, nodes: slice) -> Nodes:
        """Some of the places."""
        return Nodes(*(array[:, nodes] for array in self))

    def between(self, before: NDArray[np.intp], values: Floats, states: Floats) -> Nodes:
        """Other places, each between one of these and the next, whose inputs are as far off as
        those of both; values with whole turns (inputs, places)."""
        return Nodes(
            values,
            self.reduced[:, before] + (values - self.values[:, before]),
            states,
            np.maximum(self.off[:, before], self.off[:, before + 1]),
            np.zeros((len(self.least), before.size)),
        )

    def inserted(self, before: NDArray[np.intp], places: Nodes) -> Nodes:
        """These and other places behind some of them."""
        pairs = zip(self, places, strict=True)
        return Nodes(*(np.insert(own, before + 1, more, axis=1) for own, more in pairs))

    def then(self, places: Nodes) -> Nodes:
        """These and then other places."""
        return Nodes(*(np.concatenate(pair, axis=1) for pair in zip(self, places, strict=True)))


def input_rounding(session: Session, values: Floats) -> Floats:
    """How far inputs may be from those of the file's text, of the same shape: by their largest
    values over the rows, since one near zero may be what two large ones leave."""
    largest = np.abs(session.inputs.values).max(axis=1, initial=0.0, keepdims=True)
    rounding = tolerances.INPUT_ROUNDING * np.maximum(largest, np.abs(values))
    rounding = np.maximum(rounding, tolerances.LEAST_INPUT_ROUNDING)
    return np.asarray(np.maximum(rounding, _off_the_text(session)))


@remembered
def _off_the_text(session: Session) -> Floats:
    """How far the inputs (inputs, 1) are from the text in some row, measured in double-double; zero
    where the text cannot be followed to them. Laws and expressions may cancel."""
    own = session.inputs
    try:
        precise = session.precise.inputs(session)
    except (LookupError, ValueError, TraceLost):
        return np.zeros((len(own.values), 1))
    pairs = ((own.values, precise.values), (own.reduced, precise.reduced))
    off = [distance(text[:, 0], text[:, 1], mine) for mine, text in pairs]
    largest: Floats = np.maximum(*off).max(axis=1, initial=0.0, keepdims=True)
    return largest * MEASURED


def distance(high: Floats, low: Floats, other: Floats) -> Floats:
    """How far numbers high + low are from doubles next to them: but for one rounding of it, since
    those of nearly the same size differ exactly."""
    return np.asarray(np.abs((high - other) + low))


def prove_boxes(enclosed: Enclosed, nodes: Nodes) -> Boxes:
    """Boxes about the one position near each node's states."""
    plan, places = enclosed.plan, nodes.states.shape[1]
    radius, proven = np.empty((plan.columns, places)), np.empty(places, dtype=np.uint8)
    contraction, beyond = np.empty(places), np.empty(places)
    _kernel.prove_boxes(
        plan,
        states=np.ascontiguousarray(nodes.states),
        off=np.ascontiguousarray(nodes.off),
        least=np.ascontiguousarray(nodes.least),
        radii=enclosed.radii,
        follows=enclosed.follows,
        radius=radius,
        contraction=contraction,
        beyond=beyond,
        proven=proven,
    )
    return Boxes(proven.astype(bool), radius, contraction, beyond)


def prove_tubes(enclosed: Enclosed, nodes: Nodes, boxes: Boxes) -> tuple[Bools, int]:
    """Joins nodes by tubes, those whose box is not proven to none: whether each is joined to the
    next (nodes - 1,), and how many tubes there are."""
    session, count = enclosed.session, nodes.states.shape[1]
    step = np.diff(nodes.values, axis=1)
    length = np.sqrt(sum((one * one for one in step), np.zeros(count - 1)))
    direction = step / np.where(length > 0.0, length, 1.0)
    after = np.concatenate([direction, direction[:, -1:]], axis=1)
    before = np.concatenate([direction[:, :1], direction], axis=1)
    bends = (np.abs(after - before) > tolerances.STRAIGHT_WAY).any(axis=0)
    first = _derivatives(session, nodes, after)
    joined = np.empty(count, dtype=np.uint8)
    number, _ = _kernel.prove_tubes(
        enclosed.plan,
        radii=enclosed.radii,
        follows=enclosed.follows,
        place=np.concatenate([[0.0], np.cumsum(length)]),
        inputs=np.ascontiguousarray(nodes.values),
        off=np.ascontiguousarray(nodes.off),
        states=np.ascontiguousarray(nodes.states),
        after=first,
        before=_derivatives(session, nodes, before) if bends.any() else first,
        radius=boxes.radius,
        proven=boxes.proven.astype(np.uint8),
        bends=bends.astype(np.uint8),
        joined=joined,
        width=np.empty(count),
    )
    return joined[:-1].astype(bool), number


def _derivatives(session: Session, nodes: Nodes, direction: Floats) -> Floats:
    """Derivatives of the columns (columns, nodes) by the path's length."""
    rows = RowInputs(nodes.reduced, nodes.states, rates=direction)
    batch = session.run(rows, Ask(Demand.VELOCITY, derivatives=True))
    assert batch.first is not None
    return batch.first


def differences(layout: Layout, one: Floats, others: Floats) -> Floats:
    """How far a place (states,) is from others (columns, places), in rad and lengths of the kernel:
    angles up to whole turns; of an orientation the largest of the increments x that turn it by
    (1, x / 2), in all three columns."""
    sizes = np.zeros((sum(len(c.part.type.freedoms) for c in layout.carriers), others.shape[1]))
    for carrier in layout.carriers:
        kind, row, column = carrier.part.type, carrier.state, carrier.column
        if kind.is_ball:
            turn = _increments(one[row : row + 4], others[row : row + 4])
            sizes[column : column + 3] = turn
            continue
        for number, freedom in enumerate(kind.freedoms):
            off = others[row + number] - one[row + number]
            if freedom.is_cyclic:
                off -= FULL_TURN * np.rint(off / FULL_TURN)
            sizes[column + number] = np.abs(off)
    return sizes


def _increments(a: Floats, b: Floats) -> Floats:
    """Largest of the increments that turn an orientation to others (places,)."""
    w = np.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3])
    x = a[0] * b[1] - b[0] * a[1] - a[2] * b[3] + a[3] * b[2]
    y = a[0] * b[2] - b[0] * a[2] - a[3] * b[1] + a[1] * b[3]
    z = a[0] * b[3] - b[0] * a[3] - a[1] * b[2] + a[2] * b[1]
    size = 2.0 * np.maximum(np.maximum(np.abs(x), np.abs(y)), np.abs(z))
    # half a turn has no finite increments
    return np.asarray(size / np.maximum(w, np.finfo(float).eps))


class ModeProofs(NamedTuple):
    """What is proven of each mode, and whether all of those that are proven are different."""

    modes: tuple[Proof, ...]
    all_different: bool

    @property
    def sentence(self) -> str:
        """In words."""
        proven = [proof for proof in self.modes if proof is not Proof.not_proven]
        if not self.modes:
            return "there is no mode to prove"
        if not proven:
            return "no mode could be proven to exist"
        exist = all(proof is Proof.proven for proof in proven)
        words = "proven to exist" if exist else "proven to closure"
        text = f"{len(proven)} of {len(self.modes)} {words}"
        if len(proven) < 2:
            return text
        different = "all of them proven to be different"
        return f"{text}, {different if self.all_different else 'some may be the same'}"


def prove_modes(session: Session, place: Floats, states: Floats) -> ModeProofs:
    """Proofs of assemblies (states, modes) at some inputs (inputs,) in kernel units."""
    count = states.shape[1]
    inputs = np.repeat(place[:, None], count, axis=1)
    enclosed = enclosed_of(session)
    boxes = prove_boxes(enclosed, Nodes.of(session, inputs, inputs, states))
    proven = np.flatnonzero(boxes.proven)
    different = all(
        _apart(session.layout, states, boxes, int(one), proven[k + 1 :]).all()
        for k, one in enumerate(proven)
    )
    proofs = (
        Proof.not_proven if not ok else Proof.proven if beyond == 0.0 else Proof.proven_to_closure
        for ok, beyond in zip(boxes.proven, boxes.beyond, strict=True)
    )
    return ModeProofs(tuple(proofs), different)


def _apart(
    layout: Layout, states: Floats, boxes: Boxes, one: int, others: NDArray[np.intp]
) -> Bools:
    """Which other boxes have no place in common with one of them."""
    off = differences(layout, states[:, one], states[:, others])
    reach = boxes.radius[:, one, None] + boxes.radius[:, others]
    for carrier in layout.carriers:
        if carrier.part.type.is_ball:
            columns = slice(carrier.column, carrier.column + 3)
            reach[columns] = 2.0 * reach[columns].max(axis=0)
    return np.asarray((off > reach + tolerances.SAME_BOX * (1.0 + off)).any(axis=0))
