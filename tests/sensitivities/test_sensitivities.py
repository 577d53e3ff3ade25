"""Sensitivities against closed forms at 50 digits, against differences of plain runs on every
mechanism kept here, and against the same mechanism written otherwise."""

from __future__ import annotations

from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.units.dimension import LENGTH

RIGHT = 1e-10
"""In parts of the largest of a column."""


def off(found: np.ndarray, true: object) -> float:
    """How far from the true ones, in parts of the largest."""
    expected = np.array(true, dtype=float)
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def derivative(function: object, place: str, order: int = 1) -> float:
    """At 50 digits, by mpmath's own differences."""
    with mp.workdps(50):
        return float(mp.diff(function, mp.mpf(place), order))


def stand(theta: float, crank: object, rod: object) -> object:
    angle = mp.radians(mp.mpf(theta))
    return crank * mp.cos(angle) + mp.sqrt(rod**2 - (crank * mp.sin(angle)) ** 2) - crank - rod


def test_a_slider_crank() -> None:
    model = mk.load(FILE_OF["slider_crank"])
    s = model.sensitivities(["D.s", "A.effort"], at=[30, 70, 200])
    by_crank = [derivative(lambda r, t=t: stand(t, r, mp.mpf("0.35")), "0.1") for t in s.place]
    by_rod = [derivative(lambda rod, t=t: stand(t, mp.mpf("0.1"), rod), "0.35") for t in s.place]
    bent = [derivative(lambda r, t=t: stand(t, r, mp.mpf("0.35")), "0.1", 2) for t in s.place]
    assert off(s["D.s", "crank"], by_crank) < RIGHT
    assert off(s["D.s", "rod"], by_rod) < RIGHT
    assert off(s.curvature("D.s", "crank"), bent) < 1e-5
    assert s.unit("D.s", "crank") == "m/m"

    def torque(theta: float, crank: object) -> object:
        """d/dt dT/dw - dT/dtheta - Q, by angle derivatives of where the slider stands."""
        rod, angle = mp.mpf("0.35"), mp.radians(mp.mpf(theta))

        def slide(a: object) -> object:
            return crank * mp.cos(a) + mp.sqrt(rod**2 - (crank * mp.sin(a)) ** 2)

        first, second = mp.diff(slide, angle), mp.diff(slide, angle, 2)
        acceleration = first * 5 + second * 400
        return mp.mpf("0.02") * 5 + (mp.mpf("1.5") * acceleration + 100) * first

    true = [derivative(lambda r, t=t: torque(t, r), "0.1") for t in s.place]
    assert off(s["A.effort", "crank"], true) < RIGHT


def rocker(theta: float, lengths: dict[str, object]) -> object:
    """The rocker of a crank-rocker from the ground's line, its home along y, in degrees."""
    a, b, c, d = (lengths[k] for k in "abcd")
    angle = mp.radians(mp.mpf(theta))
    x, y = a * mp.cos(angle) - d, a * mp.sin(angle)
    far = mp.sqrt(x**2 + y**2)
    bend = mp.acos((far**2 + c**2 - b**2) / (2 * c * far))
    return mp.degrees(mp.atan2(y, x) - bend)


def test_a_four_bar() -> None:
    model = mk.load(FILE_OF["planar_four_bar"])
    s = model.sensitivities(["C.theta"], at=["30 deg", 105, 240])
    own = {"a": 40, "b": 120, "c": 90, "d": 130}
    for name, value in own.items():
        true = [
            derivative(lambda v, t=t, n=name: rocker(t, {**own, n: v}), str(value)) for t in s.place
        ]
        assert off(s["C.theta", name], true) < RIGHT
        assert s.verdict("C.theta", name).tolist() == ["ok"] * 3


def spatial_rocker(theta: float, sign: int, p: dict[str, object]) -> object:
    """The rocker of the RSSR from its drawing, by the distance of both spheres."""
    r, x, y, z, d, tilt = (p[k] for k in ("r", "x", "y", "z", "d", "tilt"))
    rod = mp.sqrt((x - r) ** 2 + y**2 + z**2)
    angle, lean = mp.radians(mp.mpf(theta)), mp.radians(tilt)
    axis = (mp.sin(lean), mp.mpf(0), mp.cos(lean))
    arm = (x - d, y, mp.mpf(0))
    along = sum(u * v for u, v in zip(axis, arm, strict=True))
    level = [along * u for u in axis]
    e1 = [u - v for u, v in zip(arm, level, strict=True)]
    e2 = [
        axis[1] * arm[2] - axis[2] * arm[1],
        axis[2] * arm[0] - axis[0] * arm[2],
        axis[0] * arm[1] - axis[1] * arm[0],
    ]
    pin = (r * mp.cos(angle), r * mp.sin(angle), mp.mpf(0))
    q = [d + level[0] - pin[0], level[1] - pin[1], z + level[2] - pin[2]]

    def dot(u: object, v: object) -> object:
        return sum(a * b for a, b in zip(u, v, strict=True))

    cosine, sine = 2 * dot(q, e1), 2 * dot(q, e2)
    rest = rod**2 - dot(q, q) - dot(e1, e1)
    return mp.degrees(mp.atan2(sine, cosine) + sign * mp.acos(rest / mp.hypot(cosine, sine)))


def test_an_rssr() -> None:
    model = mk.load(FILE_OF["rssr"])
    s = model.sensitivities(["O4.theta"], at=[20, 140, 300])
    own = {"r": 40, "x": 140, "y": 100, "z": 60, "d": 160, "tilt": 15}
    value = s.value("O4.theta")
    here = {k: mp.mpf(v) for k, v in own.items()}
    signs = [
        min(
            (-1, 1), key=lambda g, t=t, v=v: abs(mp.sin(mp.radians(spatial_rocker(t, g, here) - v)))
        )
        for t, v in zip(s.place, value, strict=True)
    ]
    for name, number in own.items():
        true = [
            derivative(
                lambda v, t=t, g=g, n=name: spatial_rocker(t, g, {**here, n: v}), str(number)
            )
            for t, g in zip(s.place, signs, strict=True)
        ]
        assert off(s["O4.theta", name], true) < RIGHT, name


def read_by_tables(model: mk.Model) -> list[str]:
    """The first columns of each table that are numbers."""
    texts = []
    for table in (one for one in model.tables if one.run == "sweep"):
        texts += [
            c.expression.text for c in table.columns if not c.expression.text.startswith("row")
        ]
    return list(dict.fromkeys(texts))[:: max(1, len(texts) // 9)]


@pytest.mark.parametrize("path", FILE_OF.values(), ids=lambda path: path.stem)
def test_differences_of_plain_runs(path: Path) -> None:
    model = mk.load(path)
    if not model.problem.parameters or "sweep" not in model.runs:
        pytest.skip("no parameters that a sweep depends on")
    if model.problem.motion.rest is not None:
        pytest.skip("places at which loads balance have no sensitivities")
    quantities = read_by_tables(model)
    # a step decides how many rows there are, which is no slope
    names = [name for name in model.problem.parameters if name != "step"][:6]
    if not names:
        pytest.skip("no parameters that rows depend on")
    s = model.sensitivities(quantities, names)
    units, size = model.problem.units, model.session.layout.length
    compared = 0
    for name in names:
        known = model.problem.parameters[name]
        own = float(units.from_si(known.value, known.dimension))
        scale = (
            float(units.from_si(size, LENGTH)) if known.dimension == LENGTH else max(abs(own), 1)
        )
        step = 2e-5 * scale
        try:
            runs = [
                model.with_parameters({name: own + k * step}).analyze(tables=[])
                for k in (1, -1, 2, -2)
            ]
        except mk.InvalidFile:
            continue
        for text in quantities:
            found = s[text, name]
            try:
                a, b, c, d = (run[text] for run in runs)
            except mk.MechkinError:
                continue
            if a.shape != found.shape:
                continue
            plain = (8 * (a - b) - (c - d)) / (12 * step)
            both = np.isfinite(plain) & np.isfinite(found)
            if not both.any() or (
                model.session.is_redundant and set(s.verdict(text, name)) != {"ok"}
            ):
                continue
            # what doubles leave of cells and of the changes
            rounding = 1e-13 * float(np.nanmax(np.abs(s.value(text)))) / step + 1e-10
            allowed = 1e-6 * float(np.abs(found[both]).max()) + rounding
            assert np.abs(found - plain)[both].max() < allowed, (text, name)
            compared += 1
    assert compared or model.session.is_redundant


TEXT = FILE_OF["planar_four_bar"].read_text(encoding="utf-8")
ASKED = ["C.theta", "O.effort", "pen.position.x", "norm(B.force)"]


def of(text: str, names: list[str]) -> mk.Sensitivities:
    return mk.loads(text).sensitivities(ASKED, names)


def same(found: np.ndarray, expected: np.ndarray) -> None:
    assert np.abs(found - expected).max() <= 1e-13 * np.abs(expected).max()


def test_renamed_split_unused_and_scaled() -> None:
    base = of(TEXT, ["b"])
    split = TEXT.replace("b: 120 mm,", "b: b1 + b2, b1: 50 mm, b2: 70 mm, idle: 3 mm,")
    s = of(split, ["b", "b1", "b2", "idle"])
    renamed = of(TEXT.replace("b: 120 mm,", "bee: 120 mm,").replace("a + b", "a + bee"), ["bee"])
    metres = of(TEXT.replace("b: 120 mm,", "b: 0.12 m,"), ["b"])
    for text in ASKED:
        same(s[text, "b1"], base[text, "b"])
        same(s[text, "b2"], base[text, "b"])
        same(s[text, "b"], base[text, "b"])
        same(renamed[text, "bee"], base[text, "b"])
        same(metres[text, "b"], base[text, "b"])
        assert not s[text, "idle"].any()
        assert set(s.verdict(text, "idle")) == {"ok"}


def test_backwards_and_chosen_rows() -> None:
    base = of(TEXT, ["a", "c"])
    backwards = of(TEXT.replace("from: 0, to: 360", "from: 360, to: 0"), ["a", "c"])
    some = mk.loads(TEXT).sensitivities(ASKED, ["a", "c"], at=[45, "225 deg"])
    for text in ASKED:
        same(backwards[text, "a"][::-1], base[text, "a"])
        same(some[text, "c"], base[text, "c"][[3, 15]])


def test_a_varied_model() -> None:
    model = mk.loads(TEXT)
    varied = model.with_parameters({"a": 42}).sensitivities(ASKED, ["a", "b"], at=[60])
    anew = mk.loads(TEXT.replace("a: 40 mm", "a: 42 mm")).sensitivities(ASKED, ["a", "b"], at=[60])
    for text in ASKED:
        for name in "ab":
            same(varied[text, name], anew[text, name])


def test_inputs_that_are_written_with_parameters() -> None:
    """The rows are the file's: they move with what they are written with."""
    text = TEXT.replace("from: 0,", "from: start,").replace("a: 40 mm", "start: 0 deg, a: 40 mm")
    s = mk.loads(text).sensitivities(["O.theta", "C.theta"], ["start"])
    assert np.abs(s["O.theta", "start"] - 1.0).max() < 1e-15


def test_lengths_of_a_bennett_linkage_do_not_change_alone() -> None:
    s = mk.load(FILE_OF["bennett"]).sensitivities(["C.theta"], ["a", "b", "alpha"])
    assert set(s.verdict("C.theta", "a")) == {"ok"}  # b goes with it, as it is written
    # at 180 deg all links lie in line, as drawn, whatever their lengths are
    others = s.place != 180.0
    assert set(s.verdict("C.theta", "b")[others]) == {"not-closed"}
    assert np.isnan(s["C.theta", "b"][others]).all()
    assert set(s.verdict("C.theta", "alpha")) == {"ok"}


def test_inputs_are_told_where_the_row_is() -> None:
    """An input has its value whether the loops close or not, and a row that does not has none."""
    s = mk.load(FILE_OF["bennett"]).sensitivities(["A.theta", "C.theta"], ["a", "b"])
    for name in "ab":
        words = s.verdict("C.theta", name).tolist()
        assert s.verdict("A.theta", name).tolist() == words
        told = np.isfinite(s["A.theta", name])
        assert told.tolist() == [word == "ok" for word in words]


def test_loops_that_are_left_out_and_a_file_that_is_built_anew() -> None:
    """With another axis the building decides something otherwise, so the file is built anew; the
    first loop, which alone is followed, feels nothing of it."""
    text = FILE_OF["rcsr_csr_loop_one"].read_text(encoding="utf-8")
    text = text.replace("  P1: 0.5 in\n", "  P1: 0.5 in\n  tilt: 0\n")
    joint = text[text.index("  O7:") :]
    tilted = joint.replace("sin(alpha8)*sin(theta_c1),", "sin(alpha8)*sin(theta_c1) + tilt,", 1)
    assert tilted != joint
    s = mk.loads(text.replace(joint, tilted)).sensitivities(["O4.theta"], ["P1", "tilt"])
    assert s.why("O4.theta", "tilt") == ""
    assert not s["O4.theta", "tilt"].any()
    plain = mk.load(FILE_OF["rcsr_csr_loop_one"]).sensitivities(["O4.theta"], ["P1"])
    same(s["O4.theta", "P1"], plain["O4.theta", "P1"])


def test_a_position_that_is_zero_throughout_is_not_bent() -> None:
    """The cross of a Hooke joint stays in the origin, to within rounding, whatever the angle."""
    s = mk.load(FILE_OF["hooke"]).sensitivities(["U.point", "norm(U.point)"], ["angle"])
    assert set(s.verdict("U.point", "angle")) == {"ok"}
    assert np.abs(s["U.point", "angle"]).max() < 1e-20


def test_kinks_and_structure() -> None:
    text = TEXT.replace("a: 40 mm,", "a: 40 mm, tilt: 0 deg,")
    text = text.replace("at: [100, 80]", 'at: [100, "2*max(a, 40 mm)"]')
    s = mk.loads(text).sensitivities(["pen.position.x", "C.theta"], ["a"], at=[60])
    assert s.verdict("pen.position.x", "a").tolist() == ["bent"]
    assert np.isnan(s["pen.position.x", "a"]).all()
    assert s.verdict("C.theta", "a").tolist() == ["ok"]


def test_a_row_beside_a_dead_centre() -> None:
    """A rod of 1 m on a crank of 1.5 m: half way round the crank there is a dead centre of the
    crank where it turns by asin(1/1.5); s there goes as the root of what is left."""
    text = FILE_OF["slider_crank"].read_text(encoding="utf-8")
    text = text.replace("crank: 0.1 m", "crank: 0.5 m").replace(
        "to: 360, step: 10", "to: 40, step: 40"
    )
    edge = float(mp.mpf("0.5") * mp.sin(mp.radians(40)))
    for gap, word in ((1e-3, "ok"), (1e-11, "bent")):
        s = mk.loads(text.replace("rod: 0.35 m", f"rod: {edge + gap!r} m")).sensitivities(
            ["D.s"], ["rod"], at=[40]
        )
        rod = mp.mpf(edge + gap)
        true = derivative(lambda v: stand(40, mp.mpf("0.5"), v), repr(edge + gap))
        if word == "ok":
            assert off(s["D.s", "rod"], [true]) < RIGHT
            # of a root the ratio of slope and curvature is twice what is left
            left = abs(true / float(s.curvature("D.s", "rod")[0])) / 2
            assert 0.5 * gap < left < 2 * gap
            assert s.reach("D.s", "rod")[0] < gap / 2
            assert "D.s: near 40 deg, as beside a dead centre, the first-order" in repr(s)
        else:
            assert s.verdict("D.s", "rod")[0] in ("bent", "near-singular", "no-position"), rod


def test_far_from_a_dead_centre_no_slope_soon_bends() -> None:
    """Not even those of rows at which a slope is zero."""
    s = mk.loads(TEXT).sensitivities(["C.theta", "pen.position.x"])
    assert "first-order" not in repr(s)
    rod = mk.load(FILE_OF["slider_crank"]).sensitivities(["D.s"], ["rod"])
    assert np.abs(rod["D.s", "rod"]).min() < 1e-12
    assert "first-order" not in repr(rod)


def test_what_is_refused() -> None:
    model = mk.loads(TEXT)
    for call, words in (
        (lambda: model.sensitivities(["C.theta"], ["e"]), "there is no parameter e"),
        (lambda: model.sensitivities(["row.status"]), "words"),
        (lambda: model.sensitivities(["C.theta"], at=31), "the nearest stand at 30 and 45 deg"),
        (lambda: model.sensitivities("C.theta"), "a list of texts"),
        (
            lambda: mk.load(FILE_OF["rspr"]).sensitivities(["row.time"]),
            "no parameters",
        ),
    ):
        with pytest.raises(mk.UsageError, match=words):
            call()
    friction = model.sensitivities(["row.condition"], ["a"])
    assert friction.why("row.condition", "a") == "a verdict"
    assert set(friction.verdict("row.condition", "a")) == {"not-repeated"}


def test_how_they_are_read() -> None:
    s = mk.load(FILE_OF["rcsr"]).sensitivities(["theta4", "O3.force"], ["P1", "alpha1"])
    assert s["O3.force", "P1"].shape == (27, 3)
    assert s.matrix("O3.force").shape == (81, 2)
    frame = s.to_pandas()
    assert frame.attrs["units"]["d theta4 / d P1"] == "deg/in"
    assert list(frame)[:2] == ["O1.theta", "d theta4 / d P1"]
    assert "theta4" in repr(s)
    assert "<table>" in s._repr_html_()
    change = 1e-6
    plain = mk.load(FILE_OF["rcsr"], {"P1": f"{0.5 + change} in"}).analyze()["O4.theta"]
    told = s["theta4", "P1"] * change + s.value("theta4")
    second = s.curvature("theta4", "P1") * change**2 / 2
    assert np.abs(told + second - plain).max() < 1e-11


def test_play_in_a_pin_is_a_parameter() -> None:
    """The pin of the rocker moved in a direction, against the closed form with its pivot moved."""
    text = TEXT.replace("a: 40 mm,", "e: 0 mm, phi: 90 deg, a: 40 mm,")
    text = text.replace("point: [d, 0]}", "point: [d + e*cos(phi), e*sin(phi)]}")
    s = mk.loads(text).sensitivities(["C.theta"], ["e", "phi"], at=[60])

    def moved(e: object) -> object:
        x, y = 40 * mp.cos(mp.pi / 3) - 130, 40 * mp.sin(mp.pi / 3) - e
        arm, far = 90 - e, mp.hypot(x, y)
        bend = mp.acos((far**2 + arm**2 - 120**2) / (2 * arm * far))
        return mp.degrees(mp.atan2(y, x) - bend)

    assert off(s["C.theta", "e"], [derivative(moved, "0")]) < RIGHT
    assert not s["C.theta", "phi"].any()  # nothing is played yet
