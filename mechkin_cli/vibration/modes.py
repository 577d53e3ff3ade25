"""Natural motions of M q'' + C q' + K q = 0.

Without damping and gyroscopic terms, and with a symmetric K, they are those of K x = omega^2 M x.
Else they are eigenvalues of the first-order system in the coordinates of those modes, in which
inertia is one and the time is scaled by the fastest of them, so that no unit matters.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple
from mechkin_cli.statics import summed
from mechkin_cli.vibration.arithmetic import times, turned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.show import Floats


class NaturalMotions(NamedTuple):
    """Natural motions x exp(lambda t), by rising |lambda|: of each pair of conjugate eigenvalues
    the one that turns forwards, and every real one.

    Attributes:
        values: lambda (modes,), 1/s.
        shapes: x (coordinates, modes), x^H M x = 1.
    """

    values: NDArray[np.complex128]
    shapes: NDArray[np.complex128]


def natural_motions(
    inertia: Floats, damping: Floats, stiffness: Floats, coordinates: Sequence[str]
) -> NaturalMotions:
    """The natural motions of three matrices (coordinates, coordinates).

    Raises:
        UsageError: some motion has no inertia, or forces have no values about the place.
    """
    if not all(np.isfinite(matrix).all() for matrix in (inertia, damping, stiffness)):
        raise UsageError("loads have no value about this place, so nothing is known of its motion")
    symmetric = 0.5 * (stiffness + stiffness.T)
    found = _kernel.symmetric_eigen(symmetric, inertia)
    if found is None:
        raise UsageError(_without_inertia(inertia, coordinates))
    squares, basis = found
    size = float(np.abs(squares).max(initial=0.0))
    rest = times(turned(basis), times(stiffness - symmetric, basis))
    damps = times(turned(basis), times(damping, basis))
    slight = tolerances.SYMMETRIC_STIFFNESS
    if np.abs(rest).max(initial=0.0) <= slight * size and not (
        np.abs(damps).max(initial=0.0) > slight * np.sqrt(size)
    ):
        return _undamped(squares, basis)
    return _damped(times(turned(basis), times(stiffness, basis)), damps, basis, size)


def _undamped(squares: Floats, basis: Floats) -> NaturalMotions:
    values: list[complex] = []
    columns: list[int] = []
    size = float(np.abs(squares).max(initial=0.0))
    for number, square in enumerate(squares):
        if abs(square) <= tolerances.RIGID_MOTION * size:
            own = [0j]
        elif square > 0.0:
            own = [1j * float(np.sqrt(square))]
        else:
            root = float(np.sqrt(-square))
            own = [complex(-root), complex(root)]
        values += own
        columns += [number] * len(own)
    order = sorted(range(len(values)), key=lambda k: abs(values[k].real) + abs(values[k].imag))
    shapes = np.stack([_turned_real(basis[:, columns[k]]) for k in order], axis=1)
    return NaturalMotions(np.array([values[k] for k in order]), shapes.astype(complex))


def _turned_real(shape: Floats) -> Floats:
    """A shape whose largest number is positive."""
    return shape if shape[int(np.argmax(np.abs(shape)))] > 0.0 else -shape


def _damped(stiffness: Floats, damping: Floats, basis: Floats, size: float) -> NaturalMotions:
    """In coordinates in which the inertia is one; `basis` leads from them to those named."""
    count = len(stiffness)
    pace = float(np.sqrt(size)) if size > 0.0 else float(np.abs(damping).max()) or 1.0
    system = np.zeros((2 * count, 2 * count))
    system[:count, count:] = np.eye(count)
    system[count:, :count] = -stiffness / (pace * pace)
    system[count:, count:] = -damping / pace
    found = _kernel.eigen(system)
    assert found is not None
    real, imaginary, vectors, others = found
    slight = tolerances.RIGID_MOTION
    values, shapes = [], []
    for k in range(2 * count):
        if imaginary[k] < 0.0:
            continue
        whole = vectors[:count, k], others[:count, k]
        length = np.sqrt(summed(whole[0] * whole[0] + whole[1] * whole[1]))
        if not length > 0.0:
            continue
        # the number that moves most is real and positive
        sizes = whole[0] ** 2 + whole[1] ** 2
        most = int(np.argmax(sizes))
        c, s = (part[most] / np.sqrt(sizes[most]) for part in whole)
        one, two = (whole[0] * c + whole[1] * s) / length, (whole[1] * c - whole[0] * s) / length
        shape = times(basis, np.stack([one, two], axis=1))
        rigid = abs(real[k]) <= slight and abs(imaginary[k]) <= slight
        values.append(0j if rigid else pace * complex(real[k], imaginary[k]))
        shapes.append(shape[:, 0] + 1j * shape[:, 1])
    return NaturalMotions(np.array(values), np.stack(shapes, axis=1))


def _without_inertia(inertia: Floats, coordinates: Sequence[str]) -> str:
    """Words for an inertia that is not positive: the coordinates that have least of it."""
    least = coordinates[int(np.argmin(np.abs(np.diag(inertia))))]
    what = "" if len(coordinates) == 1 else f"some motion of {', '.join(coordinates)}"
    return (
        f"{what or least} has no inertia, and so no natural frequency: give a mass to a link that "
        f"moves with {least}"
    )
