"""Vibrations of a mechanism about a row of a run, as users ask for them.

All numbers are in SI units (rad, m, kg, N, N*m, s) but frequencies in Hz, whatever the units of the
file are: rates of coordinates are rates then, and programs for control need that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError, nearest_hint
from mechkin_cli.expressions import ExpressionError
from mechkin_cli.kernel.functions import atan2
from mechkin_cli.mechanism import JointLoad, LinkLoad, is_angle
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response import with_loads
from mechkin_cli.session import input_unit
from mechkin_cli.show import Listed, Listing
from mechkin_cli.statics import Forces, summed
from mechkin_cli.vibration.arithmetic import inverse, solved, times
from mechkin_cli.vibration.modes import NaturalMotions, natural_motions
from mechkin_cli.vibration.place import Freed

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import Load
    from mechkin_cli.show import Floats
    from mechkin_cli.vibration.linear import Motions, Values

    Complex = NDArray[np.complex128]


class StateSpace(NamedTuple):
    """x' = A x + B u, y = C x + D u, in SI units.

    Attributes:
        A, B, C, D: arrays, as `scipy.signal.StateSpace(*s.matrices)` and `control.ss` take them.
        states: names of the states: coordinates, driven inputs, their rates.
        inputs: names of the inputs; of a driven coordinate its acceleration.
        outputs: names of the outputs, what they are beyond their value at the place.
    """

    A: Floats
    B: Floats
    C: Floats
    D: Floats
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]

    @property
    def matrices(self) -> tuple[Floats, Floats, Floats, Floats]:
        """A, B, C, D."""
        return self.A, self.B, self.C, self.D


class FrequencyResponse(NamedTuple):
    """The answer of quantities to a harmonic input.

    Attributes:
        frequencies: Hz (frequencies,).
        values: complex amplitudes per amplitude of the input (outputs, frequencies), SI.
        input: its name.
        outputs: names of the outputs.
    """

    frequencies: Floats
    values: Complex
    input: str
    outputs: tuple[str, ...]

    @property
    def amplitude(self) -> Floats:
        """Sizes of the amplitudes (outputs, frequencies)."""
        real, imaginary = self.values.real, self.values.imag
        return np.sqrt(real * real + imaginary * imaginary)

    @property
    def phase(self) -> Floats:
        """Phases against the input (outputs, frequencies), degrees; negative where it lags."""
        parts = (part.ravel() for part in (self.values.imag, self.values.real))
        return np.asarray(atan2(*parts)).reshape(self.values.shape) * (180.0 / pi)


class Source(Protocol):
    """What small motions are made from."""

    def vibration(self) -> Vibration:
        """The same small motions."""
        ...

    def again(self, parameter: str, factor: float) -> Vibration:
        """Those with another value of a parameter, a factor of its own."""
        ...

    def pictured(self, found: Vibration) -> str:
        """A picture of the modes."""
        ...

    def shown(self, found: Vibration, path: str | PathLike[str] | None) -> Any:
        """A page in which the modes are played."""
        ...


class Vibration(Listed):
    """Small motions about a row of a run, as `Model.vibration` gives them, in SI units.

    Attributes:
        coordinates: that name the motion.
        mass, damping, stiffness: matrices M, C, K (coordinates, coordinates) of
            M q'' + C q' + K q = forces along the coordinates; damping has the gyroscopic terms of
            drives that move.
        holding: what has to act along each coordinate to keep the place, which is taken as constant
            (of a sweep along its inputs): zero at equilibria.
        driven: coordinates that drives hold or move.
    """

    def __init__(self, freed: Freed, source: Source | None = None) -> None:
        self._freed, self._source = freed, source
        self._small = freed.motions
        self.coordinates: tuple[str, ...] = freed.motions.coordinates
        self.driven: tuple[str, ...] = freed.driven
        self.holding: Floats = freed.motions.efforts
        self.stiffness, self.damping, self.mass = freed.motions.matrices

    # Natural motions.

    @cached_property
    def _natural(self) -> NaturalMotions:
        return natural_motions(self.mass, self.damping, self.stiffness, self.coordinates)

    @property
    def eigenvalues(self) -> Complex:
        """Of each mode (modes,), 1/s: of conjugate ones the one with a positive imaginary part."""
        return self._natural.values

    @cached_property
    def frequencies(self) -> Floats:
        """Natural frequencies (modes,), Hz, rising: sizes of the eigenvalues over 2 pi. A real
        eigenvalue is a mode of its own."""
        return _sizes(self.eigenvalues) / (2.0 * pi)

    @cached_property
    def damping_ratios(self) -> Floats:
        """Parts of critical damping (modes,): 1 where a mode creeps back, negative where it grows,
        nan where it has no stiffness."""
        sizes = _sizes(self.eigenvalues)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(0.0 - self.eigenvalues.real / sizes)

    @property
    def shapes(self) -> Complex | Floats:
        """Mode shapes (coordinates, modes) with x^H M x = 1; real where all of them are."""
        shapes = self._natural.shapes
        return shapes if shapes.imag.any() else shapes.real

    @cached_property
    def participation(self) -> Floats:
        """Parts of a mode's kinetic energy that go with each coordinate (coordinates, modes); each
        column adds up to 1."""
        shapes = self._natural.shapes
        real, imaginary = shapes.real, shapes.imag
        own = real * times(self.mass, real) + imaginary * times(self.mass, imaginary)
        return np.asarray(own / summed(own))

    @property
    def is_stable(self) -> bool:
        """Whether no mode grows, and each has stiffness."""
        return bool(np.all(self.damping_ratios >= 0.0))

    def effective_stiffness(self, quantity: str) -> float:
        """The force that moves a coordinate or a component of a place by one, and does work on it
        alone: of an angle a moment per rad. All else follows freely.

        Raises:
            UsageError: it is no such quantity, or some mode has no stiffness.
        """
        # refuses what no force acts along, as a rate
        self._load(quantity)
        by_place = self._small.gradient(self._reader([quantity]))
        with np.errstate(invalid="ignore", divide="ignore"):  # refused below
            moved = times(by_place, solved(self.stiffness, by_place.T))[0, 0]
        if not np.isfinite(moved):
            raise UsageError("some mode has no stiffness")
        return float(1.0 / moved) if moved else float("inf")

    # What acts, and what is read.

    def state_space(self, inputs: Sequence[str] = (), outputs: Sequence[str] = ()) -> StateSpace:
        """The first-order system of small motions.

        Args:
            inputs: coordinates, along which a force or moment acts; components of places of points,
                such as `P.position.z`, of a force; driven coordinates, whose acceleration is the
                input: their places and rates are further states.
            outputs: quantities and expressions; left out, the states.

        Raises:
            UsageError: an unknown name, or one that has no such meaning.
        """
        moved = [name for name in inputs if name in self.driven]
        n, m = len(self.coordinates), len(moved)
        back = inverse(self.mass)
        by = {name: self._by_driven(name) for name in moved}
        size = n + m
        a, b = np.zeros((2 * size, 2 * size)), np.zeros((2 * size, len(inputs)))
        a[:size, size:] = np.eye(size)
        a[size : size + n, :n] = -times(back, self.stiffness)
        a[size : size + n, size : size + n] = -times(back, self.damping)
        second = np.zeros((n, len(inputs)))
        for k, name in enumerate(inputs):
            if name in by:
                place, rate, acceleration = by[name]
                w = n + moved.index(name)
                a[size : size + n, w] = -times(back, place[:, None])[:, 0]
                a[size : size + n, size + w] = -times(back, rate[:, None])[:, 0]
                second[:, k] = -times(back, acceleration[:, None])[:, 0]
                b[size + w, k] = 1.0
            else:
                second[:, k] = times(back, self._force(name)[:, None])[:, 0]
        b[size : size + n] = second
        states = (*self.coordinates, *moved)
        names = (*states, *(f"{name}_dot" for name in states))
        if not outputs:
            none = np.zeros((2 * size, len(inputs)))
            return StateSpace(a, b, np.eye(2 * size), none, names, tuple(inputs), names)
        by_place, by_rate, by_second = self._small.derivatives(self._reader(outputs))
        c = np.zeros((len(by_place), 2 * size))
        c[:, :n], c[:, size : size + n] = by_place, by_rate
        c += times(by_second, a[size : size + n])
        d = times(by_second, second)
        for k, name in enumerate(inputs):
            if name in by:
                w = n + moved.index(name)
                place, rate, acceleration = self._by_driven(name, outputs)
                c[:, w] += place
                c[:, size + w] += rate
                d[:, k] += acceleration
            else:
                d[:, k] += self._direct(name, outputs)
        return StateSpace(a, b, c, d, names, tuple(inputs), self._names(outputs))

    def response(
        self, frequencies: Sequence[float] | Floats, input: str, outputs: str | Sequence[str]
    ) -> FrequencyResponse:
        """Amplitudes of quantities by a harmonic input of amplitude one.

        Args:
            frequencies: Hz.
            input: as of `state_space`; of a driven coordinate its place, not its acceleration.
            outputs: quantities and expressions.

        Raises:
            UsageError: as `state_space`.
        """
        outputs = [outputs] if isinstance(outputs, str) else list(outputs)
        told = np.array(frequencies, dtype=np.float64).reshape(-1)
        if not (np.isfinite(told) & (told >= 0.0)).all():
            raise UsageError("frequencies: expected finite numbers of Hz, 0 or more")
        omega = 2.0 * pi * told
        by_place, by_rate, by_second = self._small.derivatives(self._reader(outputs))
        own: tuple[Floats, Floats, Floats]
        if input in self.driven:
            place, rate, acceleration = self._by_driven(input)
            force = _harmonic(-place, -rate, -acceleration, omega)
            own = self._by_driven(input, outputs)
        else:
            still = np.zeros(len(self.coordinates))
            force = _harmonic(self._force(input), still, still, omega)
            direct = self._direct(input, outputs)
            own = (direct, 0.0 * direct, 0.0 * direct)
        real = self.stiffness - (omega * omega)[:, None, None] * self.mass
        imaginary = omega[:, None, None] * self.damping
        # (real + i imaginary) (x + i y) = force, as one system of real numbers
        top = np.concatenate([real, -imaginary], axis=-1)
        bottom = np.concatenate([imaginary, real], axis=-1)
        whole = solved(
            np.concatenate([top, bottom], axis=-2), np.concatenate(force, axis=0).T[:, :, None]
        )[..., 0]
        x, y = whole[:, : len(self.coordinates)].T, whole[:, len(self.coordinates) :].T
        at_rest = by_place[:, :, None] - (omega * omega) * by_second[:, :, None]
        turning = omega * by_rate[:, :, None]
        direct_part = _harmonic(*own, omega)
        values = summed(np.moveaxis(at_rest * x - turning * y, 1, 0)) + direct_part[0]
        others = summed(np.moveaxis(at_rest * y + turning * x, 1, 0)) + direct_part[1]
        return FrequencyResponse(told, values + 1j * others, input, self._names(outputs))

    def sensitivity(self, parameter: str) -> Floats:
        """Derivatives of the frequencies (modes,) by a parameter, Hz per SI unit; the place goes
        with it, as of an equilibrium that is found again.

        Raises:
            UsageError: there is no such parameter, it is zero, or the modes are others beside it.
        """
        if self._source is None:
            raise UsageError("these small motions are not those of a model")
        known = self._freed.session.problem.parameters
        if parameter not in known:
            hint = nearest_hint(parameter, list(known)) or "the file has no such parameter"
            raise UsageError(f"{parameter[:LONGEST_NAME]} is no parameter; {hint}")
        value = float(np.asarray(known[parameter].value))
        if value == 0.0:
            raise UsageError(f"{parameter} is zero; write what it is added to as a parameter")
        step = tolerances.PARAMETER_STEP
        found = []
        for k in (-2, -1, 1, 2):
            other = self._source.again(parameter, 1.0 + k * step).frequencies
            if len(other) != len(self.frequencies):
                raise UsageError(f"beside this {parameter} there are other modes")
            found.append(other)
        slope = 8.0 * (found[2] - found[1]) - (found[3] - found[0])
        return np.asarray(slope / (12.0 * step * value))

    # How names are read.

    def _expressions(self, names: Sequence[str]) -> list[Expression]:
        problem = self._freed.session.problem
        found = []
        for name in names:
            try:
                expression = problem.definitions.parse(name)
            except ExpressionError as error:
                raise UsageError(f"{name[:LONGEST_NAME]}: {error.message}") from None
            for used in expression.names:
                if used not in self._small.known and used not in problem.parameters:
                    hint = nearest_hint(used, list(self._small.known)) or "see m.quantities"
                    raise UsageError(f"there is no quantity {used[:LONGEST_NAME]}; {hint}")
            found.append(expression)
        return found

    def _reader(self, names: Sequence[str]) -> Callable[[Motions], Values]:
        return self._small.reader(self._expressions(names))

    def _names(self, outputs: Sequence[str]) -> tuple[str, ...]:
        """Names of numbers, with those of the components of vectors."""
        named: list[str] = []
        still = self._small.still()
        for name in outputs:
            count = len(self._reader([name])(still)[0])
            quantity = self._small.known.get(name)
            if count == 1:
                named.append(name)
            else:
                places = range(3) if quantity is None else quantity.places
                named += [f"{name}.{'xyz'[place]}" for place in places]
        return tuple(named)

    def _load(self, name: str) -> Load | None:
        """The unit load along a coordinate or a component of a point's place; None for what no load
        does alone."""
        mechanism = self._freed.session.problem.mechanism
        named = self._named(name)
        if named is not None:
            return named
        first, _, last = name.rpartition(".")
        if first in mechanism.joints and last in mechanism.joints[first].type.coordinates:
            joint = mechanism.joints[first]
            return JointLoad(first, last, 1.0) if joint.carries else None
        point, _, word = first.rpartition(".")
        if word == "position" and point in mechanism.points and last in ("x", "y", "z"):
            at = mechanism.points[point]
            x, y, z = (1.0 if axis == last else 0.0 for axis in "xyz")
            return LinkLoad("force", at.link, (x, y, z), "ground", at.vector)
        hint = (
            "name a coordinate, a component such as P.position.z, a driven coordinate, or a force "
            "or torque of loads: by its name"
        )
        raise UsageError(f"no input {name[:LONGEST_NAME]}; {hint}")

    def _named(self, name: str) -> Load | None:
        """The load of that name, of one along its direction; None where there is none.

        Raises:
            UsageError: it has no direction.
        """
        loads = self._freed.session.problem.mechanism.loads
        found = next((load for load in loads if name and load.called == name), None)
        if found is not None and found.of_one is None:
            raise UsageError(
                f"the load {name} has no direction of its own: name a coordinate, or a component "
                "such as P.position.z"
            )
        return None if found is None else found.of_one

    def _loaded(self, load: Load) -> Forces:
        """The forces with one load more."""
        problem = self._freed.session.problem
        mechanism = problem.mechanism
        more = replace(problem, mechanism=replace(mechanism, loads=(*mechanism.loads, load)))
        return Forces(with_loads(self._freed.session, more), self._small.driven)

    def _force(self, name: str) -> Floats:
        """What acts along the coordinates (coordinates,) by a unit force along a quantity, which
        does work on that alone."""
        load = self._load(name)
        if load is not None and load.called:
            return self._small.acting(self._loaded(load))
        gradient: Floats = self._small.gradient(self._reader([name]))[0]
        return gradient

    def _direct(self, name: str, outputs: Sequence[str]) -> Floats:
        """What a unit force adds to outputs (numbers,) before anything moves."""
        load = self._load(name)
        read, still = self._reader(outputs), self._small.still()
        without, _ = read(still)
        if load is None:
            return np.zeros(len(without))
        small = self._small.with_forces(self._loaded(load))
        with_load, _ = small.reader(self._expressions(outputs))(still)
        return np.asarray(with_load[:, 0] - without[:, 0])

    def _by_driven(
        self, name: str, outputs: Sequence[str] | None = None
    ) -> tuple[Floats, Floats, Floats]:
        """What the coordinates need, or outputs gain, by a driven coordinate, its rate and its
        acceleration, per SI unit."""
        number = self.driven.index(name)
        session = self._freed.session
        unit = input_unit(session.layout, session.problem.motion.inputs[number])
        read = None if outputs is None else self._reader(outputs)
        found = self._small.driven_derivatives(number, read)
        return found[0] / unit, found[1] / unit, found[2] / unit

    # How it is shown.

    def view(self, path: str | PathLike[str] | None = None) -> Any:
        """Makes a page in which the modes are played, each as a run of one period, swung as far as
        is seen well; arguments and answers are those of `Model.view`.

        Raises:
            UsageError: the page cannot be written there, or the loops do not close beside the
                place.
        """
        assert self._source is not None
        return self._source.shown(self, path)

    def picture(self) -> str:
        """The modes on one picture, as the text of an SVG file: a panel for each, where the
        mechanism stands as in the row, with arrows along which its points, joints and mass centres
        move. Of a mode with imaginary parts it is the moment at which what moves most is
        outermost; of very many modes the lowest are shown."""
        assert self._source is not None
        return self._source.pictured(self)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as what it is made from."""
        assert self._source is not None
        return self._source.vibration, ()

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What was left out, and what is held."""
        found = []
        if self._freed.friction:
            text = "friction is left out of small motions: it does not go with small rates"
            hint = "add dampers for what it takes"
            found.append(Diagnostic("friction-left-out", "note", text, None, hint=hint))
        if self._small.bends:
            text = "loads bend or jump at this place, so stiffness or damping is not what it says"
            hint = "write laws that are smooth where the mechanism stands or rests"
            found.append(Diagnostic("bent-loads", "warning", text, None, hint=hint))
        if not self._freed.motions.is_balanced:
            efforts = ", ".join(
                f"{float(x):.4g} {'N*m' if unit == 'rad' else 'N'} at {name}"
                for name, x, unit in zip(self.coordinates, self.holding, self.units, strict=True)
            )
            text = f"loads do not balance in this row: constant efforts hold it, {efforts}"
            hint = "equilibria: finds where they balance"
            found.append(Diagnostic("held-by-efforts", "note", text, None, hint=hint))
        return tuple(found)

    @property
    def units(self) -> tuple[str, ...]:
        """The SI units of the coordinates: rad or m."""
        names = (name.rpartition(".")[2] for name in self.coordinates)
        return tuple("rad" if is_angle(name) else "m" for name in names)

    @property
    def listing(self) -> Listing:
        """The modes."""
        rows = tuple(
            (f"{k + 1}", f"{frequency:.6g} Hz", f"{ratio:.4g}", *self._leading(k))
            for k, (frequency, ratio) in enumerate(
                zip(self.frequencies, self.damping_ratios, strict=True)
            )
        )
        count = "1 mode" if len(rows) == 1 else f"{len(rows)} modes"
        title = f"{count} of {', '.join(self.coordinates)}"
        return Listing(title, ("mode", "frequency", "damping ratio", "moves most"), rows)

    def _leading(self, mode: int) -> tuple[str]:
        """The coordinate that has most of a mode's energy."""
        return (self.coordinates[int(np.argmax(self.participation[:, mode]))],)


def _sizes(values: Complex) -> Floats:
    return np.sqrt(values.real * values.real + values.imag * values.imag)


def _harmonic(
    place: Floats, rate: Floats, acceleration: Floats, omega: Floats
) -> tuple[Floats, Floats]:
    """Real and imaginary parts (numbers, frequencies) of place + i omega rate - omega^2
    acceleration."""
    real = place[:, None] - (omega * omega) * acceleration[:, None]
    return real, omega * rate[:, None]
