"""mechkin: positions, rates, reactions and tables of spatial mechanisms from one text file.

import mechkin_cli as mk

m = mk.load("rcsr.yaml")               a Model: the checked file; also a dict of its sections
m = mk.loads(text)                     the same from a text
r = m.analyze()                        an Analysis: the sweep; m.respond("NAME"): a response

Of a model
    m.parameters                       values by name in the file's units; m.parameters.unit("P1")
    m.analyze()  m.respond()           the runs; m.analyses(): all of the file; m.run_free("NAME")
    m.equilibrium()                    where loads balance; m.vibration(): how it vibrates there
    m.stream(rows=4096)                the sweep block by block, in constant memory
    m.modes()                          the ways to assemble it
    m.ranges()                         how far an input can go: dead centres, circuits
    m.cam("K")                         the cam of a coupling with a follower: profile, undercut
    m.mobility()                       what can move
    m.solve({"O1.theta": 161.5})       one position
    m.with_parameters({"P1": 0.48})    the model with other values
    m.vary({"P1": [0.46, 0.48]})       many variants at once
    m.study("study.yaml", out="lengths")   a hundred thousand of them, written to disk
    m.sensitivities(["O4.theta"])      what a change of a parameter does to any quantity
    m.tolerances({"P1": 0.01}, [...])  what tolerances add up to, with samples
    m.fit({"of": "pen.position", "is": points}, {"a": (30, 50)})   dimensions that fit
    m.certify()                        proofs of the sweep's rows
    m.view()                           a page that shows it in motion; m.widget(): in a notebook

Of an analysis
    r["O4.theta"]  r["norm(O3.force)"] any quantity or expression over the rows, in the file's units
    list(r)  "O4.theta" in r  r.keys() the quantities there are; r.unit("O4.theta"): the unit of one
    r.tables["NAME"]  r.balances       tables as the file lays them out
    r.to_pandas("NAME")                a table as a DataFrame
    r.summary()  r.peak("O1.effort")   extremes with their places, means
    r.plot()  r.picture()              curves, drawn or as plain data
    r.errors  r.certificate            true errors of all cells; proofs
    r.diagnostics  r.complete          messages of the run; whether every row is solved

Every exception is a MechkinError: InvalidFile has one Diagnostic per fault with its place,
UsageError is raised for a name or an argument that is wrong, ExpressionError for a quantity
that does not exist. Status has the verdicts of rows. `help(mk.Model)` and `help(mk.Analysis)` list
all methods.
"""

from __future__ import annotations

TYPE_CHECKING = False  # typing is not loaded for its flag alone

if TYPE_CHECKING:
    from typing import Any

    from mechkin_cli.analysis import Analysis, Stream
    from mechkin_cli.diagnostics import Diagnostic, InvalidFile, MechkinError, UsageError
    from mechkin_cli.expressions import ExpressionError
    from mechkin_cli.model import Model, load, loads
    from mechkin_cli.verdict import Status, __version__ as __version__


_PLACES = {
    "Analysis": "analysis",
    "Diagnostic": "diagnostics",
    "ExpressionError": "expressions",
    "InvalidFile": "diagnostics",
    "MechkinError": "diagnostics",
    "Model": "model",
    "Status": "verdict",
    "Stream": "analysis",
    "UsageError": "diagnostics",
    "__version__": "verdict",
    "load": "model",
    "loads": "model",
}

__all__ = [
    "Analysis",
    "Diagnostic",
    "ExpressionError",
    "InvalidFile",
    "MechkinError",
    "Model",
    "Status",
    "Stream",
    "UsageError",
    "load",
    "loads",
]


def __getattr__(name: str) -> Any:
    """Imports the public names when they are first used, so that start-up stays short."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"{__name__}.{_PLACES[name]}"), name)


def __dir__() -> list[str]:
    """The public names, for `dir(mk)` and tab completion."""
    return list(__all__)
