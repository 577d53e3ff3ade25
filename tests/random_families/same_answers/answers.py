"""Answers to a question as plain lines, in which a single bit shows."""

from __future__ import annotations

import copy
import json
import pickle
import tempfile
from collections.abc import Mapping
from enum import Enum
from pathlib import Path

import numpy as np


def plain(value, depth=0):
    """An answer as text: every bit of every number, and no object's address."""
    if value is None or (isinstance(value, (bool, int, str)) and not isinstance(value, Enum)):
        return repr(value)
    if isinstance(value, Enum):
        return f"<{value.name}>"
    if isinstance(value, (float, np.floating)):
        return float(value).hex() if value == value else "nan"
    if isinstance(value, np.integer):
        return repr(int(value))
    if isinstance(value, np.bool_):
        return repr(bool(value))
    if isinstance(value, np.ndarray):
        if value.dtype.kind == "f":
            whole = ",".join(
                "nan" if x != x else x.hex() for x in value.ravel().astype(float).tolist()
            )
        else:
            whole = repr(value.tolist())
        return f"array{value.dtype.str}{value.shape}[{whole}]"
    if depth > 8:
        return "..."
    if hasattr(value, "record") and hasattr(value, "severity"):  # a diagnostic
        names = (
            "code",
            "count",
            "hint",
            "index",
            "limit",
            "measured",
            "message",
            "numbers",
            "place",
            "severity",
        )
        return (
            "{"
            + ", ".join(f"{n}={plain(getattr(value, n), depth + 1)}" for n in names)
            + plain(value.record(), depth + 1)
            + "}"
        )
    if isinstance(value, Mapping):
        return (
            "{"
            + ", ".join(f"{plain(k, depth + 1)}: {plain(v, depth + 1)}" for k, v in value.items())
            + "}"
        )
    if hasattr(value, "_fields"):
        return (
            "("
            + ", ".join(f"{n}={plain(getattr(value, n), depth + 1)}" for n in value._fields)
            + ")"
        )
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(plain(v, depth + 1) for v in value) + "]"
    if isinstance(value, (set, frozenset)):
        return "set" + plain(sorted(value), depth + 1)
    if isinstance(value, Path):
        return f"path {value.name}"
    if hasattr(value, "__dataclass_fields__"):
        return (
            "("
            + ", ".join(
                f"{n}={plain(getattr(value, n), depth + 1)}" for n in value.__dataclass_fields__
            )
            + ")"
        )
    return f"?{type(value).__name__}"


def tried(call):
    """What a call gives, or what it raises, as text."""
    try:
        return plain(call())
    except Exception as error:
        found = f"!{type(error).__name__}: {error}"
        for name in ("diagnostics", "offset", "hint"):
            if hasattr(error, name):
                found += f" {name}={plain(getattr(error, name))}"
        return found


def told(lines, name, call):
    lines.append(f"{name} = {tried(call)}")


def tell(lines, thing, *names):
    for name in names:
        told(lines, name, lambda name=name: getattr(thing, name))


def of_table(table):
    return {
        "name": table.name, "title": table.title,
        "columns": [{n: getattr(c, n) for n in ("label", "unit", "values")} for c in table.columns], "summary": table.summary,
    }  # fmt: skip


def analysis_lines(r, quantities=()):
    lines = []
    tell(lines, r, "run", "rows", "complete", "diagnostics", "balances")
    told(lines, "keys", r.keys)
    told(lines, "len", lambda: (len(r), list(r)))
    told(lines, "tables", lambda: [of_table(t) for t in r.tables])
    told(lines, "table names", lambda: list(r.tables.keys()))
    told(lines, "coefficients", lambda: [of_table(t) for t in r.coefficients])
    told(lines, "balance_tables", lambda: [of_table(t) for t in r.balance_tables])
    told(lines, "summary", r.summary)
    told(lines, "status", lambda: r["row.status"])
    for q in quantities or ():
        told(lines, q, lambda q=q: r[q])
        told(lines, f"unit {q}", lambda q=q: r.unit(q))
    told(lines, "repr", lambda: repr(r))
    return lines


def ask_analyze(m, q, knobs):
    r = m.analyze(q["quantities"], tables=q["tables"], mode=q["mode"], **closed(q), **knobs)
    return analysis_lines(r, q["quantities"])


def closed(q):
    return {"closed_at": q["closed_at"]} if "closed_at" in q else {}


def ask_read(m, q, knobs, kept=None):
    """Values of a run; the shared side reads them from a run that is kept."""
    key = repr((q["mode"], q.get("closed_at"), q["run"]))
    if kept is not None and key in kept:
        r = kept[key]
    elif q["run"]:
        r = m.respond(q["run"], mode=q["mode"], **knobs)
    else:
        r = m.analyze(mode=q["mode"], **closed(q), **knobs)
    if kept is not None:
        kept[key] = r
    lines = []
    for one in q["quantities"]:
        told(lines, one, lambda one=one: r[one])
        told(lines, f"unit {one}", lambda one=one: r.unit(one))
        told(lines, f"peak {one}", lambda one=one: r.peak(one))
        told(lines, f"in {one}", lambda one=one: one in r)
    tell(lines, r, "rows", "complete", "diagnostics")
    return lines


def ask_respond(m, q, knobs):
    return analysis_lines(
        m.respond(q["run"], q["quantities"], mode=q["mode"], **knobs), q["quantities"]
    )


def ask_modes(m, q, knobs):
    found, lines = m.modes(q["at"], run=q["run"], certify=q["certify"]), []
    tell(
        lines,
        found,
        "bound",
        "chance",
        "closed",
        "complete",
        "confidence",
        "diagnostics",
        "inputs",
        "modes",
        "picked",
        "proofs",
        "sentence",
        "starts",
        "turns",
    )
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_ranges(m, q, knobs):
    found, lines = m.ranges(q["input"], q["outputs"]), []
    tell(lines, found, "at", "circuits", "diagnostics", "input", "ranges", "unit")
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_mobility(m, q, knobs):
    found, lines = m.mobility(), []
    names = "configurations count diagnostics dimensions first_order fixed idle inputs loops mobility name redundant useful verdict"
    tell(lines, found, *names.split())
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_solve(m, q, knobs):
    found = m.solve(q["inputs"], q["quantities"])
    return [f"{k} = {plain(v)}" for k, v in found.items()] + [f"status = {plain(found.status)}"]


def ask_vary(m, q, knobs):
    found, lines = m.vary(q["parameters"], q["quantities"], q["reduce"], run=q["run"], **knobs), []
    tell(lines, found, "codes", "complete", "errors", "parameters", "status")
    told(
        lines,
        "values",
        lambda: {k: found[k] for k in (q["quantities"] or sorted(m.quantities)[:5])},
    )
    return lines


def ask_errors(m, q, knobs):
    r = m.analyze(mode=q["mode"], **closed(q), **knobs)
    found, lines = r.errors, []
    tell(lines, found, "digits", "why", "states")
    told(
        lines,
        "columns",
        lambda: [
            {
                n: getattr(c, n)
                for n in (
                    "table",
                    "label",
                    "unit",
                    "values",
                    "error",
                    "relative",
                    "digits",
                    "is_bound",
                    "largest",
                    "lost",
                    "lost_why",
                    "worst",
                    "why",
                )
            }
            for c in found.columns
        ],
    )
    told(lines, "repr", lambda: repr(found))
    return lines


def ask_certify(m, q, knobs):
    found, lines = m.certify(mode=q["mode"], **closed(q), **knobs), []
    tell(lines, found, "closure", "diagnostics", "is_one_branch", "status", "tubes", "words")
    told(lines, "dead_centres", lambda: len(found.dead_centres))
    for c in sorted(k for k in m.quantities if k.endswith((".theta", ".s", ".effort")))[:3]:
        told(lines, f"enclosure {c}", lambda c=c: found.enclosure(c))
        told(lines, f"not enclosed {c}", lambda c=c: found.not_enclosed(c))
    return lines


def ask_sensitivities(m, q, knobs):
    s, lines = m.sensitivities(q["quantities"], q["parameters"], q["at"]), []
    tell(lines, s, "along", "along_unit", "parameters", "place", "quantities", "rows", "texts")
    for a in q["quantities"]:
        told(lines, f"value {a}", lambda a=a: s.value(a))
        for b in s.parameters:
            told(
                lines,
                f"{a} {b}",
                lambda a=a, b=b: (
                    s[a, b],
                    s.unit(a, b),
                    s.curvature(a, b),
                    s.reach(a, b),
                    s.verdict(a, b),
                    s.why(a, b),
                ),
            )
    derived = s.model
    told(lines, "model", lambda: derived.analyze()["row.status"])
    told(lines, "repr", lambda: repr(s))
    return lines


def ask_tolerances(m, q, knobs):
    t, lines = m.tolerances(q["tolerances"], q["quantities"], samples=q["samples"]), []
    tell(lines, t, "bands", "samples")
    for a in q["quantities"]:
        for name in (
            "drawn",
            "left_out",
            "lost_ends",
            "inaccurate",
            "nominal",
            "root_sum_square",
            "sampled",
            "scatter",
            "shares",
            "worst",
        ):
            told(lines, f"{name} {a}", lambda a=a, name=name: getattr(t, name)(a))
    told(lines, "repr", lambda: repr(t))
    return lines


def ask_study(m, q, knobs):
    found, lines = m.study(q["study"]), []
    tell(lines, found, "diagnostics", "overview", "rows")
    told(lines, "columns", lambda: {k: found[k] for k in found.to_pandas().columns})
    return lines


def ask_fit(m, q, knobs):
    f, lines = (
        m.fit(q["targets"], {k: tuple(v) for k, v in q["bounds"].items()}, starts=1, generations=2),
        [],
    )
    tell(
        lines,
        f,
        "at_bounds",
        "constraints",
        "cost",
        "costs",
        "evaluations",
        "exact_taken",
        "parameters",
        "reason",
        "rows_not_ok",
        "slopes",
        "status",
        "targets",
        "units",
        "yaml",
    )
    told(lines, "model", lambda: analysis_lines(f.model.analyze()))
    return lines


def ask_view(m, q, knobs):
    with tempfile.TemporaryDirectory() as folder:
        page = m.view(Path(folder) / "page.html", run=q["run"], modes=q["modes"])
        return ["page = " + page.read_text(encoding="utf-8")]


def ask_listing(m, q, knobs):
    lines = []
    tell(lines, m, "name", "source", "runs", "diagnostics")
    told(lines, "quantities", lambda: m.quantities)
    told(lines, "tables", lambda: [t.name for t in m.tables])
    told(lines, "repr", lambda: repr(m))
    told(lines, "html", lambda: m._repr_html_())
    return lines


def ask_picture(m, q, knobs):
    r = m.analyze()
    return ["picture = " + tried(lambda: r.picture(q["y"]))]


def ask_given(m, q, knobs):
    """Objects that came from elsewhere: an analysis through a pickle, the model of an analysis."""
    r = pickle.loads(pickle.dumps(m.analyze()))
    lines = analysis_lines(r)
    told(lines, "again", lambda: analysis_lines(r.model.analyze()))
    return lines


ASK = {name[4:]: call for name, call in globals().items() if name.startswith("ask_")}


def reached(model, steps):
    for step in steps:
        if step[0] == "with":
            model = model.with_parameters(step[1])
        elif step[0] == "pickle":
            model = pickle.loads(pickle.dumps(model))
        else:
            model = getattr(copy, step[0])(model)
    return model


def loaded(info, folder):
    import mechkin_cli as mk

    return mk.loads(info["text"], "m.yaml", folder=folder)


def answer(model, q, kept=None, knobs=None):
    """Lines of the answer of a model to a question."""
    lines = []

    def call():
        made = reached(model, q["via"]) if kept is None else kept.model(model, q["via"])
        runs = None if kept is None else kept.runs(q["via"])
        given = q.get("knobs", {}) if knobs is None else knobs
        if q["ask"] == "read":
            lines.extend(ask_read(made, q, given, runs))
        else:
            lines.extend(ASK[q["ask"]](made, q, given))

    told(lines, "answer", call)
    return lines


class Kept:
    """The shared model's derived models and runs, by the way they came about; some are made anew."""

    def __init__(self, rng):
        self.rng, self.models, self.all_runs = rng, {}, {}

    def model(self, model, steps):
        key = ""
        for step in steps:
            key += json.dumps(step)
            if key not in self.models or self.rng.random() < 0.15:
                self.models[key] = reached(model, [step])
                self.all_runs.pop(key, None)
            model = self.models[key]
        return model

    def runs(self, steps):
        return self.all_runs.setdefault("".join(json.dumps(s) for s in steps), {})
