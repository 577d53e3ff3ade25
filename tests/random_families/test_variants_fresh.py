"""Random variants of the mechanisms kept here, against files with the new values written in.

The file written anew takes the assembly nearest to a place; a chain of such files, each with the
coordinates of the one before as `near`, stays on the branch without knowing of variants.
`MECHKIN_RANDOM` multiplies the number of variants.
"""

from __future__ import annotations

import os
import re

import numpy as np
import pytest
from means import mean_over_the_way, rms_over_the_way
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
NUMBER = re.compile(r"^  (\w+): *([\d.]+) (\w+) *(#.*)?$", re.M)
UNFOLLOWED = {"rcsr_csr_loop_one"}
"""Follows fewer loops than all its quantities need."""

STEPS = 4
TOLERANCE = 1e-9
"""Of a quantity, in parts of the largest of its kind, for each unit of condition."""

NOISE = 1e-6
"""Of the file's units: below it a quantity that is zero is rounding."""

SUFFIXES = ("theta", "s", "theta_dot", "s_dot", "theta_ddot", "position", "effort", "omega")


def kept() -> list[str]:
    """Files with parameters and a sweep."""
    texts = {path.stem: path.read_text(encoding="utf-8") for path in FILE_OF.values()}
    needed = {"parameters:", "motion:"}
    return sorted(stem for stem, text in texts.items() if needed <= set(text.splitlines()))


def without_tables(stem: str) -> str:
    """The file up to its tables."""
    text = FILE_OF[stem].read_text(encoding="utf-8")
    return re.split("^tables:", text, flags=re.M)[0]


def plain(text: str) -> dict[str, tuple[float, str]]:
    """Parameters that are a number with a unit."""
    block = re.split(r"^\w+:", text.split("\nparameters:\n")[1], maxsplit=1, flags=re.M)[0]
    found = NUMBER.findall(block)
    # a step decides how many rows there are, and all variants have equally many
    return {name: (float(value), unit) for name, value, unit, _ in found if name != "step"}


def written(text: str, values: dict[str, tuple[float, str]], near: dict[str, float]) -> str:
    """The file with other parameters, near a place."""
    for name, (value, unit) in values.items():
        text = re.sub(rf"^  {name}: .*$", f"  {name}: {value!r} {unit}", text, count=1, flags=re.M)
    text = re.sub(r"^assembly:.*\n(  .*\n)*", "", text, flags=re.M)
    place = ", ".join(f"{name}: {value!r}" for name, value in near.items())
    return f"{text}\nassembly: {{near: {{{place}}}}}\n"


@pytest.mark.parametrize("stem", [stem for stem in kept() if stem not in UNFOLLOWED])
@pytest.mark.parametrize("seed", range(TIMES))
def test_a_variant_is_the_file_with_its_values_written_in(stem: str, seed: int) -> None:
    """Status of all rows, and what is known of motion and effort."""
    rng = np.random.default_rng([seed, *stem.encode()])
    text = without_tables(stem)
    model = mk.loads(text, stem)
    known = plain(text)
    names = [str(name) for name in rng.permutation(list(known))[: rng.integers(1, 4)]]
    target = {name: known[name][0] * (1 + 0.05 * rng.uniform(-1, 1)) for name in names}
    asked = sorted(q for q in model.quantities if q.split(".")[-1] in SUFFIXES)
    varied = model.vary({name: [value] for name, value in target.items()}, asked)
    base = model.analyze(tables=[])
    driven = set(re.findall(r"^    (\w+\.\w+): \{", text.split("motion:")[1], re.M))
    places = {q for q in asked if re.fullmatch(r"\w+\.(theta|s)", q)} - driven
    near = {q: float(base[q][0]) for q in sorted(places)}
    for part in range(1, STEPS + 1):
        values = {
            name: (known[name][0] + part / STEPS * (target[name] - known[name][0]), known[name][1])
            for name in names
        }
        if part == STEPS:
            values = {name: (target[name], known[name][1]) for name in names}
        fresh = mk.loads(written(text, values, near), stem).analyze(asked, tables=[])
        near = {q: float(fresh[q][0]) for q in near}
    assert varied.status[0].tolist() == fresh["row.status"].tolist()
    sizes: dict[str, float] = {}
    for name in asked:
        kind = name.split(".")[-1]
        sizes[kind] = max(sizes.get(kind, NOISE), float(np.nanmax(np.abs(fresh[name]), initial=0)))
    condition = np.nan_to_num(np.maximum(fresh["row.condition"], 1), nan=1.0)
    for name in asked:
        one, other = varied[name][0], fresh[name]
        assert (np.isnan(one) == np.isnan(other)).all(), name
        away = np.abs(one - other) / sizes[name.split(".")[-1]]
        allowed = condition if away.ndim == 1 else condition[:, None]
        assert float(np.nanmax(away / allowed, initial=0)) < TOLERANCE, (name, target)


REDUCTIONS = {
    "max": lambda rows: rows.max(axis=1),
    "min": lambda rows: rows.min(axis=1),
    "peak": lambda rows: np.abs(rows).max(axis=1),
    "range": lambda rows: rows.max(axis=1) - rows.min(axis=1),
}


@pytest.mark.parametrize("stem", [stem for stem in kept() if stem not in UNFOLLOWED])
@pytest.mark.parametrize("seed", range(TIMES))
def test_bytes_do_not_depend_on_the_call(stem: str, seed: int) -> None:
    """Order, parts, lanes, threads, quantities; reductions are those of the rows."""
    rng = np.random.default_rng([seed, 1, *stem.encode()])
    text = without_tables(stem)
    model = mk.loads(text, stem)
    known = plain(text)
    names = [str(name) for name in rng.permutation(list(known))[:2]]
    values = {name: known[name][0] * (1 + 0.1 * rng.uniform(-1, 1, 11)) for name in names}
    for name in names:
        values[name][0] = known[name][0]
        values[name][7] = values[name][3]
    numbers = sorted(model.quantities - {"row.status", "row.mode"})
    asked = [str(name) for name in rng.choice(numbers, 5, replace=False)]
    whole = model.vary(values, asked)
    order = rng.permutation(11)
    lanes, threads = int(rng.choice(widths())), int(rng.choice([1, 2, 3]))
    mixed = model.vary(
        {name: values[name][order] for name in names[::-1]},
        asked[::-1],
        lanes=lanes,
        threads=threads,
    )
    base = mk.loads(text, stem).analyze(asked, tables=[])
    alone = model.with_parameters({name: float(values[name][2]) for name in names})
    single = alone.analyze(asked, tables=[])
    for name in asked:
        assert mixed[name].tobytes() == whole[name][order].tobytes(), name
        assert base[name].tobytes() == whole[name][0].tobytes(), name
        assert single[name].tobytes() == whole[name][2].tobytes(), name
        assert whole[name][3].tobytes() == whole[name][7].tobytes(), name
    for kind, function in REDUCTIONS.items():
        reduced = model.vary(values, asked, reduce=kind)
        for name in asked:
            rows = np.ma.masked_invalid(whole[name])
            mine = np.ma.filled(function(rows), np.nan)
            size = float(np.nanmax(np.abs(whole[name]), initial=1e-300))
            assert np.allclose(reduced[name], mine, rtol=0, atol=1e-12 * size, equal_nan=True)
    moving = [text for text, at in base.result.inputs.items() if np.ptp(at) > 0]
    places = model.vary(values, moving[:1])[moving[0]] if moving else np.zeros(whole.codes.shape)
    for kind, over in (("mean", mean_over_the_way), ("rms", rms_over_the_way)):
        reduced = model.vary(values, asked, reduce=kind)
        for name in asked:
            rows = whole[name] if whole[name].ndim == 3 else whole[name][..., None]
            mine = np.array(
                [[over(one, at) for one in row.T] for row, at in zip(rows, places, strict=True)]
            ).reshape(reduced[name].shape)
            size = float(np.nanmax(np.abs(whole[name]), initial=1e-300))
            assert np.allclose(reduced[name], mine, rtol=0, atol=1e-12 * size, equal_nan=True)
