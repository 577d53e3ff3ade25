"""Variants of chains of dyads about dead centres and branch points, against their closed form.

A file has one row, whose input is a parameter; base and variants stand at a place, beside it by
1e-14 to 1e-1, and far from it. The branch goes on along the straight line from the base.
"""

from __future__ import annotations

import random
from collections import Counter

import numpy as np
from random_families.dyad_chains.case import Long
from random_families.dyad_chains.drawn import Sweep, sweep
from random_families.dyad_chains.judge import HAVE, UNDECIDED, Judged, Reach, parts_of, where

import mechkin_cli as mk


def varied(number: int, variants: int = 40) -> Sweep | None:
    """The base, then its variants, as the values of a sweep; None where there is no place."""
    case = sweep(number, 6)
    if case is None:
        return None
    rng = random.Random(f"varied {number}")
    place = rng.choice(case.places)
    inward = place.inward or (1 if case.start > place.at else -1)
    others = [abs(one.at - place.at) for one in case.places if one is not place]
    far = min([0.3, *(0.9 * x for x in others if x > 1e-6)])

    def beside(least: float, most: float) -> float:
        return place.at + inward * min(10 ** rng.uniform(least, most), far)

    base = [place.at, beside(-13, -9), beside(-9, -3), beside(-3, -1)][rng.randrange(4)]
    values = [place.at, *(beside(-14, -1) for _ in range(variants))]
    if rng.random() < 0.2:
        values += [2 * place.at - value for value in values[1:6]]
    inside = Long(base) + inward * Long("1e-3") * min(1, far) if base == place.at else Long(base)
    known, _, left = case.chain.judged(np.array([inside]))
    if not left.min() > 1e3 * (base == place.at):
        return None
    near = ", ".join(f"{case.chain.name(k + 1)}: {float(x)!r}" for k, x in enumerate(known[:, 0]))
    text = case.chain.text("values: [p]", near, straight=False)
    unit = "rad" if case.chain.first.turns else "m"
    text = text.replace("links:", f"parameters: {{p: {base!r} {unit}}}\nlinks:", 1)
    what = f"{case.what.split()[0]} varied"
    return Sweep(case.chain, text, (base, *values), base, case.places, False, what)


def judge_variants(case: Sweep) -> Judged:
    """Variants by class, and words on those lost and wrong."""
    names = [case.chain.name(k + 1) for k in range(len(case.chain.dyads))]
    unit = "rad" if case.chain.first.turns else "m"
    given = [f"{value!r} {unit}" for value in case.values[1:]]
    found = mk.loads(case.text).vary({"p": given}, names)
    values = np.array([found[name][:, 0] for name in names])
    at = np.array([Long(x) for x in case.values])
    left = case.chain.judged(at)[2]
    left = np.where(np.isnan(left), -np.inf, left)
    at, low, first = at[1:], left[:, 1:].min(axis=0), left[:, 0]
    off = parts_of(case.chain, at, values)
    either = [case.chain.flipped(k) for k in np.flatnonzero(first < UNDECIDED).tolist()]
    meets = [parts_of(other, at, values) for other in either]
    counts, lost, wrong = Counter[str](), [], []
    for number, value in enumerate(case.values[1:]):
        reach = Reach(case)
        verdict = reach.go(value, float(low[number]))
        if verdict == "known" and first.min() < UNDECIDED:
            verdict = "from a dead centre"
        status = str(found.status[number, 0])
        here = f"{case.start!r} to {value!r} ({first.min():.3g} to {low[number]:.3g}, {verdict})"
        here = f"{here}: {status}"
        if status not in HAVE:
            word = {"beyond": "refused", "undecided": "undecided"}.get(verdict, f"lost, {verdict}")
            counts[f"{word}: {status}"] += 1
            if word.startswith("lost"):
                lost.append(here)
            continue
        flipped = [parts_of(case.chain.flipped(k), at, values)[number] for k in reach.flipped]
        # a base in a dead centre does not know its branch, though `near` names it
        others = {
            "right, behind a branch point": flipped,
            "on the branch that near does not mean": [other[number] for other in meets],
        }
        word = where(verdict, off[number], others)
        counts[f"{word}: {status}"] += 1
        if word == "wrong":
            wrong.append(f"{here}, off by {off[number]:.2e} of its uncertainty")
    return Judged(counts, lost, wrong)
