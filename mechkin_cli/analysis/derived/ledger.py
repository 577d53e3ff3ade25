"""The energy ledger of a sweep in time: what efforts and loads put in, and what dampers took.

    T + V - (T + V at the first row) = work - dissipated

T and V are those of each row; work and dissipation are integrals of their powers over the rows
(`quadrature`), so that what is missing tells how well the rows resolve them. Where joints rub that
tells nothing: their powers jump where a slip turns round and bend where a contact changes sides, in
work and dissipation alike. There the powers are integrated between the rows (`powers_between`), and
what these integrals may be off counts as missing, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.analysis.derived.load_powers import (
    dissipates,
    effort_powers,
    friction_power,
    is_stored,
    load_powers,
)
from mechkin_cli.analysis.derived.quadrature import running_integral

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def ledger(run: Reading) -> dict[str, Floats]:
    """`work`, `dissipated` (J) and `energy_error` over the rows (rows,)."""
    problem = run.session.problem
    time = problem.motion.time
    assert time is not None
    known = problem.quantities()
    energies = [known["row.kinetic_energy"], known["row.potential_energy"]]
    found = run.result.evaluated(energies)
    kinetic, potential = (found[energy.name][0] for energy in energies)
    powers = _powers(run)
    moments = time.values
    step = float(moments[-1] - moments[0]) / max(moments.size - 1, 1)
    if problem.mechanism.frictions and moments.size > 1:
        from mechkin_cli.analysis.derived.powers_between import running_integrals

        (work, dissipated), off = running_integrals(run, _powers, powers, step)
    else:
        work, dissipated = (running_integral(power, step) for power in powers)
        off = np.zeros(work.size)
    return {"work": work, "dissipated": dissipated} | {
        "energy_error": _missing(kinetic, potential - potential[0], work, dissipated, off)
    }


def _powers(run: Reading) -> Floats:
    """What efforts and loads put in, and what is dissipated (2, rows) in W."""
    put_in, taken = np.zeros((2, run.inputs.rates.shape[1]))
    for power in effort_powers(run, run.session.inputs).values():
        put_in += power
    for load, power in load_powers(run):
        if dissipates(load):
            taken -= power
        elif not is_stored(load):
            put_in += power
    rubbed = friction_power(run, run.session.inputs)
    if rubbed is not None:
        taken -= rubbed
    return np.stack([put_in, taken])


def _missing(
    kinetic: Floats, potential: Floats, work: Floats, dissipated: Floats, off: Floats
) -> Floats:
    """What is missing of the balance, or may be `off` of work or dissipation, in parts of the
    largest energy over all rows; nan where nothing moves or works."""
    rest = np.abs((kinetic - kinetic[0]) + potential - (work - dissipated)) + off
    sizes = np.abs(np.stack([kinetic, potential, work, dissipated]))
    size = float(np.max(sizes[np.isfinite(sizes)], initial=0.0))
    found: Floats = rest / size if size > 0.0 else np.full(rest.size, np.nan)
    return found
