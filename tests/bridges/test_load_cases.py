"""Load cases: each link is in equilibrium, by the laws of Newton and Euler on its own motion, and
CalculiX reads its steps."""

from __future__ import annotations

import csv
import io
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import Exported, ExportOptions, exported
from mechkin_cli.units import FORCE, LENGTH, MOMENT

MECHANISMS = Path(__file__).parents[2] / "mechanisms"


def cases_of(name: str, **options: Any) -> tuple[mk.Model, Exported]:
    model = mk.load(MECHANISMS / f"{name}.yaml")
    return model, exported(model, "loads", ExportOptions(**options))


def read(found: Exported, axes: str) -> dict[tuple[int, str], list[dict[str, Any]]]:
    """Loads by row and link; vectors as arrays, in the file's units."""
    loads: dict[tuple[int, str], list[dict[str, Any]]] = {}
    for line in csv.DictReader(io.StringIO(found.files[f"loads_{axes}.csv"].decode())):
        one: dict[str, Any] = {"kind": line["kind"], "name": line["name"]}
        for word in ("point", "force", "moment"):
            cells = [cell for label, cell in line.items() if label.startswith(f"{word} ")]
            one[word] = np.array([float(cell or "nan") for cell in cells])
        loads.setdefault((int(line["row"]), line["link"]), []).append(one)
    return loads


@pytest.mark.parametrize(
    "name", ["dissertation/rcsr", "plane/planar_four_bar", "dissertation/sevenr", "classics/rssr"]
)
def test_every_link_is_in_equilibrium(name: str) -> None:
    model, found = cases_of(name, rows=(1, 5))
    size = model.problem.mechanism.box_diagonal() / model.problem.units.to_si(1.0, LENGTH)
    scale = model.problem.units.to_si(1.0, LENGTH) * model.problem.units.to_si(1.0, FORCE)
    scale /= model.problem.units.to_si(1.0, MOMENT)
    assert not found.notes
    both = [*read(found, "link").items(), *read(found, "ground").items()]
    assert len(both) == 4 * (
        len(model.problem.mechanism.links) - ("ground" in model.problem.mechanism.links)
    )
    for key, loads in both:
        force = sum(one["force"] for one in loads)
        moment = sum(one["moment"] + np.cross(one["point"], one["force"]) * scale for one in loads)
        largest = max(np.linalg.norm(one["force"]) for one in loads)
        largest = max(largest, max(np.linalg.norm(one["moment"]) for one in loads) / size)
        assert np.abs(force).max() < 1e-9 * largest, key
        assert np.abs(moment).max() < 1e-9 * largest * size * scale, key


def test_inertia_is_that_of_differences_of_positions() -> None:
    """-m a of the mass centre of a coupler, from places of three rows that stand close."""
    text = (MECHANISMS / "dissertation/rcsr.yaml").read_text(encoding="utf-8")
    step = 0.02
    text = text.replace(
        "from: 150, to: 202, step: 2", f"from: {170 - step}, to: 170.03, step: {step}"
    )
    model = mk.loads(text, "rcsr.yaml", folder=MECHANISMS / "dissertation")
    loads = read(exported(model, "loads", ExportOptions(rows=(2,))), "ground")
    (inertia,) = [one for one in loads[2, "coupler"] if one["kind"] == "inertia"]
    body = model.problem.mechanism.links["coupler"]
    inch = float(model.problem.units.to_si(1.0, LENGTH))
    centre = [float(x) / inch for x in body.center_of_mass]
    (driven,) = model.problem.motion.inputs
    rate, acceleration = float(driven.rates[1]), float(driven.accelerations[1])
    added = text.replace("points:", f"points:\n  centre: {{link: coupler, at: {centre}}}", 1)
    places = mk.loads(added, "rcsr.yaml").analyze(["centre.position"], tables=[])["centre.position"]
    h = np.radians(step)
    slope, bend = (places[2] - places[0]) / (2 * h), (places[2] - 2 * places[1] + places[0]) / h**2
    expected = -5.0 * (bend * rate**2 + slope * acceleration)
    assert np.abs(inertia["force"] - expected).max() < 1e-4 * np.abs(expected).max()


def test_what_gears_do_is_the_remainder() -> None:
    """Spur gears of pitch radii 20 and 40 mm, 2 N m at the pinion: 100 N along the tangent, and
    that by the cosine of the pressure angle along the line of action, at each wheel's bearing."""
    _, found = cases_of("couplings/spur_gears", rows=(2,))
    assert [note.code for note in found.notes] == ["remainder"]
    loads = read(found, "ground")
    pinion, wheel = (
        next(one for one in loads[2, name] if one["kind"] == "remainder")
        for name in ("pinion", "wheel")
    )
    assert np.allclose(pinion["point"], [0, 0, 0])
    assert np.allclose(wheel["point"], [60, 0, 0])
    assert np.abs(pinion["force"] + wheel["force"]).max() < 1e-9
    assert np.linalg.norm(pinion["force"]) == pytest.approx(100.0 / np.cos(np.radians(20.0)))
    assert np.abs(pinion["moment"]) == pytest.approx([0, 0, 2000.0])
    assert np.abs(wheel["moment"]) == pytest.approx([0, 0, 4000.0])


def test_reactions_that_are_not_unique_are_empty_and_named() -> None:
    _, found = cases_of("plane/slider_crank", rows=(3,))
    (note,) = [note for note in found.notes if note.code == "empty-load"]
    assert "are not unique" in str(note)
    assert "plane: xy" in str(note)


def bar(at: dict[str, np.ndarray]) -> Iterator[str]:
    """The mesh: a beam between the reference points of two joints, in two elements."""
    first, last = at.values()
    yield "*NODE, NSET=NALL"
    for number in range(5):
        place = first + 0.25 * number * (last - first)
        yield f"{number + 1}, {', '.join(f'{x:.9g}' for x in place)}"
    yield from ("*ELEMENT, TYPE=B32, ELSET=EALL", "1, 1, 2, 3", "2, 3, 4, 5")
    for name, node in zip(at, (1, 5), strict=True):
        yield from (f"*NSET, NSET={name}_REF", str(node))


def test_calculix_reads_a_step(tmp_path: Path) -> None:
    """The forces of a massless beam, held in its middle, come out as its reaction."""
    ccx = shutil.which("ccx")
    if ccx is None:
        pytest.skip("no CalculiX: apt-get install calculix-ccx")
    model, found = cases_of("dissertation/rcsr", rows=(20,))
    loads = [one for one in read(found, "link")[20, "coupler"] if one["kind"] == "joint"]
    inch = 1000.0 * float(model.problem.units.to_si(1.0, LENGTH))
    newton = float(model.problem.units.to_si(1.0, FORCE))
    at = {one["name"]: one["point"] * inch for one in loads}
    step = found.files["coupler_row_20.inp"].decode()
    # moments of shell and solid meshes go to the rotation node, those of a beam to its own
    step = "\n".join(line for line in step.splitlines() if "_ROT, " not in line)
    (tmp_path / "step.inp").write_text(step.replace("S\n", "S\n*NODE PRINT, NSET=HELD\nRF\n"))
    mesh = [
        *bar(at),
        "*NSET, NSET=HELD",
        "3",
        "*MATERIAL, NAME=STEEL",
        *("*ELASTIC", "210000, 0.3", "*DENSITY", "1e-20"),
        "*BEAM SECTION, ELSET=EALL, MATERIAL=STEEL, SECTION=RECT",
        *("2., 2.", "1., 0., 0.", "*BOUNDARY", "HELD, 1, 6", "*INCLUDE, INPUT=step.inp"),
    ]
    (tmp_path / "beam.inp").write_text("\n".join(mesh) + "\n")
    done = subprocess.run([ccx, "beam"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "Job finished" in done.stdout, done.stdout[-1500:]
    assert "*ERROR" not in done.stdout
    numbers = [line.split() for line in (tmp_path / "beam.dat").read_text().splitlines()]
    reaction = np.array([[float(x) for x in line[1:4]] for line in numbers if len(line) == 4])
    expected = -sum(one["force"] for one in loads) * newton
    assert np.abs(reaction.sum(axis=0) - expected).max() < 1e-5 * np.abs(expected).max()
