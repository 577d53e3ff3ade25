"""The mechanisms of the how-to pages against closed forms and virtual work."""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.precise import DEGREE, Number, mp
from mechanisms.runs import model, run, worst, worst_angle

LIMIT = 1e-12
G = mp.mpf("9.80665")

Place = tuple[Number, Number]


def read(name: str, quantity: str) -> np.ndarray:
    """A quantity or an expression over the rows."""
    return np.asarray(run(name)[quantity], dtype=np.float64)


def floats(values: list[Number]) -> np.ndarray:
    return np.array([float(value) for value in values])


def apart(p: Place, q: Place) -> Number:
    return mp.sqrt((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2)


def place(x: str | float, y: str | float) -> Place:
    return mp.mpf(x), mp.mpf(y)


def meet(p: Place, r: Number, q: Place, s: Number, like: Place) -> Place:
    """Where circles about p and q meet, on the side of the line pq on which `like` lies."""
    d = apart(p, q)
    ex, ey = (q[0] - p[0]) / d, (q[1] - p[1]) / d
    along = (d * d + r * r - s * s) / (2 * d)
    across = mp.sqrt(r * r - along * along)
    if ex * (like[1] - p[1]) - ey * (like[0] - p[0]) < 0:
        across = -across
    return p[0] + along * ex - across * ey, p[1] + along * ey + across * ex


def turned(p: Place, about: Place, angle: Number) -> Place:
    x, y = p[0] - about[0], p[1] - about[1]
    c, s = mp.cos(angle), mp.sin(angle)
    return about[0] + c * x - s * y, about[1] + s * x + c * y


def angle_of(p: Place, about: Place) -> Number:
    return mp.atan2(p[1] - about[1], p[0] - about[0])


# The press: Lagrange's equation of the crank.


PRESS_ROWS = [1, 4, 8, 11]


def press_rows() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Height in mm, its slope, and the torque in N*m."""
    r, rod, rate = mp.mpf(60), mp.mpf(300), 2 * mp.pi

    def tilt(angle: Number) -> Number:
        return mp.asin(r * mp.sin(angle) / rod)

    def height(angle: Number) -> Number:
        return r + rod - r * mp.cos(angle) - rod * mp.cos(tilt(angle))

    def potential(angle: Number) -> Number:
        """Weights at their heights, in kg mm."""
        shaft = -r / 4 * mp.cos(angle)
        rod_link = -r * mp.cos(angle) - rod / 3 * mp.cos(tilt(angle))
        return 40 * shaft + 25 * rod_link + 120 * height(angle)

    def kinetic(angle: Number) -> Number:
        """At a rate of 1 rad/s, in kg mm^2."""
        x = mp.diff(lambda a: r * mp.sin(a) * mp.mpf(2) / 3, angle)
        y = mp.diff(lambda a: -r * mp.cos(a) - rod / 3 * mp.cos(tilt(a)), angle)
        link = 25 * (x * x + y * y) + 230000 * mp.diff(tilt, angle) ** 2
        shaft = 40 * (r / 4) ** 2 + 90000
        return (link + shaft + 120 * mp.diff(height, angle) ** 2) / 2

    heights, slopes, torques = [], [], []
    for degrees in read("press", "O.theta")[PRESS_ROWS]:
        angle = round(degrees) * DEGREE
        h, slope = height(angle), mp.diff(height, angle)
        work = 80 if h < 12 and slope * rate < -1 else 0
        with mp.workdps(32):
            torque = mp.diff(kinetic, angle) * rate**2 + G * 1000 * mp.diff(potential, angle)
        heights.append(h)
        slopes.append(slope)
        torques.append(torque / 1000000 - work * slope)
    return floats(heights), floats(slopes), floats(torques)


def test_press() -> None:
    heights, slopes, torques = press_rows()
    for quantity, expected in (
        ("S.s", heights),
        ("S.s_dot", slopes * 2 * np.pi),
        ("O.effort/(1 N*m)", torques),
    ):
        assert worst(read("press", quantity)[PRESS_ROWS], expected) <= LIMIT


# The toggle clamp: a four-bar, and forces by virtual work.


def spindle(angle: Number) -> Number:
    """Its height in mm over the handle's angle."""
    o, c = place(0, 0), place(40, 75)
    a = turned(place(0, 25), o, angle)
    b = meet(a, mp.mpf(50), c, mp.mpf(40), place(-100, 75))
    turn = angle_of(b, c) - angle_of(place(0, 75), c)
    return turned(place(100, 60), c, mp.atan2(mp.sin(turn), mp.cos(turn)))[1]


def test_toggle_clamp() -> None:
    angles = [round(degrees) * DEGREE for degrees in read("toggle_clamp", "O.theta")]
    openings = floats([spindle(angle) - 60 for angle in angles])
    hands = floats([1500 * mp.diff(spindle, angle) / 160 for angle in angles])
    assert worst(read("toggle_clamp", "opening"), openings) <= LIMIT
    assert worst(read("toggle_clamp", "hand_force"), hands) <= LIMIT


# The scissor lift: heights by the cosine rule, its force by virtual work.


def test_scissor_lift() -> None:
    length = mp.sqrt(1500**2 + mp.mpf(400) ** 2)
    foot, eye = mp.mpf(1400), mp.mpf("0.4") * length

    def height(cylinder: Number) -> Number:
        cosine = (foot**2 + eye**2 - cylinder**2) / (2 * foot * eye)
        return 2 * length * mp.sqrt(1 - cosine**2)

    def lifted(cylinder: Number) -> Number:
        """Weights at their heights, in kN mm: arms at a quarter and three quarters."""
        h = height(cylinder)
        return h * (10 + G * (150 + 2 * 30 * (mp.mpf(1) / 4 + mp.mpf(3) / 4)) / 1000)

    def moving(cylinder: Number) -> Number:
        """Kinetic energy at a rate of 1 mm/s, in kN mm for that rate's square."""
        angle = mp.diff(lambda s: mp.asin(height(s) / (2 * length)), cylinder)
        rise = mp.diff(height, cylinder)
        across = mp.diff(lambda s: mp.sqrt(length**2 - height(s) ** 2 / 4), cylinder)
        arms = 4 * (30 * across**2 / 4 + 6000000 * angle**2)
        arms += 2 * 30 * rise**2 * (mp.mpf(1) + 9) / 16
        return (arms + 150 * rise**2) / 2 / 1000000

    cylinders = [mp.mpf(round(value)) for value in read("scissor_lift", "lift.s")]
    heights = floats([height(one) for one in cylinders])
    speeds = floats([40 * mp.diff(height, one) for one in cylinders])
    assert worst(read("scissor_lift", "top.position.y"), heights) <= LIMIT
    assert worst(read("scissor_lift", "top.velocity.y"), speeds) <= LIMIT
    energy = [mp.diff(lambda s: lifted(s) + 1600 * moving(s), one) for one in cylinders]
    assert worst(read("scissor_lift", "lift.force"), floats(energy)) <= LIMIT


# The wiper: turning places of its arm by the cosine rule, its torque by power.


def blade(angle: Number) -> Number:
    """Angle of the driver's arm from the drawing."""
    d, b = place(300, 0), place(300, -60)
    a = turned(place(0, 40), place(0, 0), angle)
    rod = apart(place(0, 40), b)
    return angle_of(meet(a, rod, d, mp.mpf(60), place(150, -500)), d) + mp.pi / 2


def test_wiper() -> None:
    angles = [round(degrees) * DEGREE for degrees in read("wiper", "M.theta")]
    rate = 45 * 2 * mp.pi / 60
    values = floats([blade(angle) / DEGREE for angle in angles])
    slopes = [mp.diff(blade, angle) for angle in angles]
    assert worst_angle(read("wiper", "D.theta"), values) <= LIMIT
    assert worst(read("wiper", "D.theta_dot"), floats([rate * one for one in slopes])) <= LIMIT
    inertia = mp.mpf(2) * (45000 + mp.mpf("0.9") * 250**2) + mp.mpf("0.3") * 60**2
    torques = []
    for angle, slope in zip(angles, slopes, strict=True):
        inert = inertia * rate**2 * slope * mp.diff(blade, angle, 2) / 1000000
        torques.append(inert + 2 * 9 * abs(slope))
    assert worst(read("wiper", "M.effort/(1 N*m)"), floats(torques)) <= LIMIT


def test_wiper_turns_back_where_crank_and_rod_are_in_line() -> None:
    """The numbers of the page: limits of the arm, by the cosine rule."""
    rod = apart(place(0, 40), place(300, -60))
    ends = []
    for reach in (rod - 40, rod + 40):
        cosine = (300**2 + 60**2 - reach**2) / (mp.mpf(2) * 300 * 60)
        ends.append(float((mp.acos(cosine) - mp.pi / 2) / DEGREE))
    (found, *_) = model("wiper").ranges(outputs=["D.theta"]).ranges
    values = [extreme.value for extreme in found.extremes]
    assert sorted(values) == pytest.approx(sorted(ends), abs=1e-9)


# The excavator: triangles, and each cylinder's force by moments about its pin.


def test_excavator() -> None:
    a, b, c = place(0, 0), place(4, 2), place("4.5", "-0.5")
    teeth = place("4.9", "-1.4")

    def opened(eye: Place, foot: Place, pin: Place, length: Number) -> Number:
        """Turn of what carries the eye, that the cylinder has a length."""
        place_of = meet(pin, apart(pin, eye), foot, length, eye)
        return angle_of(place_of, pin) - angle_of(eye, pin)

    boom_foot, boom_eye = place("0.6", "-0.6"), place(2, "1.6")
    stick_foot, stick_eye = place("1.8", 2), place("3.7", "2.7")
    bucket_foot, bucket_eye = place("4.3", "1.6"), place("4.95", "-0.35")
    crowd = opened(stick_eye, stick_foot, b, mp.mpf("2.2"))
    curl = opened(bucket_eye, bucket_foot, c, mp.mpf("2.1"))
    masses = [(900, 0, place("1.9", "1.3")), (450, 1, place("4.1", "1.1"))]
    masses.append((700, 2, place("4.9", "-0.9")))

    def work(lift: Number) -> tuple[Place, Number]:
        """Where the teeth are, and the height of all weights less the soil's work, in kN m."""
        turn = opened(boom_eye, boom_foot, a, lift)

        def now(p: Place, depth: int) -> Place:
            for about, angle in [(c, curl), (b, crowd), (a, turn)][2 - depth :]:
                p = turned(p, about, angle)
            return p

        weights = mp.fsum(m * G / 1000 * now(p, depth)[1] for m, depth, p in masses)
        at = now(teeth, 2)
        return at, weights - 30 * at[0]

    lifts = [mp.mpf(f"{value:.1f}") for value in read("excavator", "lift.s")]
    places = [work(one)[0] for one in lifts]
    forces = floats([mp.diff(lambda s: work(s)[1], one) for one in lifts])
    assert worst(read("excavator", "teeth.position.x"), floats([x for x, _ in places])) <= LIMIT
    assert worst(read("excavator", "teeth.position.y"), floats([y for _, y in places])) <= LIMIT
    assert worst(read("excavator", "lift.force"), forces) <= LIMIT


# The walking leg: circles that meet, from lengths as drawn.


def toe(angle: Number) -> Place:
    drawn: dict[str, Place] = {
        "C": place(15, 0),
        "B": place(-38, "-7.8"),
        "D": place("-24.014", "31.272"),
        "E": place("-74.794", "8.143"),
        "F": place("-26.952", "-45.515"),
        "G": place("-59.232", "-28.053"),
        "toe": place("-43.160", "-91.757"),
    }
    now = {"B": drawn["B"], "C": turned(drawn["C"], place(0, 0), angle)}

    def add(name: str, first: str, second: str) -> None:
        """A point at its drawn distances from two others, on its drawn side of their line."""
        p, q = drawn[first], drawn[second]
        side = (q[0] - p[0]) * (drawn[name][1] - p[1]) - (q[1] - p[1]) * (drawn[name][0] - p[0])
        x, y = now[first], now[second]
        sign = 1 if side > 0 else -1
        like = x[0] - sign * (y[1] - x[1]), x[1] + sign * (y[0] - x[0])
        now[name] = meet(x, apart(p, drawn[name]), y, apart(q, drawn[name]), like)

    for name, first, second in ("DCB", "EBD", "FCB", "GEF"):
        add(name, first, second)
    add("toe", "G", "F")
    return now["toe"]


def test_walking_leg() -> None:
    angles = [round(degrees) * DEGREE for degrees in read("walking_leg", "O.theta")]
    places = [toe(angle) for angle in angles]
    assert worst(read("walking_leg", "toe.position.x"), floats([x for x, _ in places])) <= LIMIT
    assert worst(read("walking_leg", "toe.position.y"), floats([y for _, y in places])) <= LIMIT
    slopes = floats([mp.diff(lambda a: toe(a)[1], angle) for angle in angles])
    ground = np.where(floats([y for _, y in places]) < -89.0, 20.0, 0.0)
    assert worst(read("walking_leg", "O.effort"), -ground * slopes) <= LIMIT


# The wishbone: the upright's six coordinates from the six distances, by another solver.


def wishbone(height: float) -> dict[str, float]:
    """Track, camber and toe at a height of the wheel's centre, in mm and degrees, with the strut's
    length and the contact's height."""
    from scipy.optimize import root
    from scipy.spatial.transform import Rotation

    ground = np.array(
        [[100, 380, 203], [-100, 380, 197], [90, 440, 445], [-110, 440, 455], [-120, 400, 250]]
    )
    balls = np.array([[0, 700, 190], [-12, 660, 465], [-130, 690, 248], [0, 760, 310]], float)
    pairs = [(0, 0), (1, 0), (2, 1), (3, 1), (4, 2)]
    lengths = np.array([np.linalg.norm(ground[i] - balls[j]) for i, j in pairs])

    def moved(x: np.ndarray, p: np.ndarray) -> np.ndarray:
        return Rotation.from_rotvec(x[3:] / 100.0).apply(p - balls[3]) + balls[3] + x[:3]

    def closure(x: np.ndarray) -> np.ndarray:
        now = moved(x, balls)
        found = [np.linalg.norm(ground[i] - now[j]) for i, j in pairs]
        return np.append(np.array(found) - lengths, now[3, 2] - height)

    found = root(closure, np.array([0, 0, height - 310.0, 0, 0, 0]), tol=1e-14)
    assert np.max(np.abs(found.fun)) <= 1e-10
    x = found.x
    spindle = Rotation.from_rotvec(x[3:] / 100.0).apply([0.0, 1.0, 0.0])
    contact = moved(x, np.array([0.0, 762.0, 0.0]))
    ball = moved(x, balls[0])
    # the strut's foot turns with the lower arm: in the frame of the arm's two bushes and its ball
    drawn, now = (_frame(ground[0], ground[1], p) for p in (balls[0], ball))
    foot = ground[0] + now @ (drawn.T @ (np.array([0.0, 600.0, 205.0]) - ground[0]))
    return {
        "track": contact[1] - 762.0,
        "camber": -np.degrees(np.arcsin(spindle[2])),
        "toe": np.degrees(np.arctan2(spindle[0], spindle[1])),
        "strut": float(np.linalg.norm(np.array([0.0, 480.0, 620.0]) - foot)),
        "y": contact[1],
        "z": contact[2],
    }


def _frame(p: np.ndarray, q: np.ndarray, ball: np.ndarray) -> np.ndarray:
    x = (q - p) / np.linalg.norm(q - p)
    z = np.cross(x, ball - p)
    z /= np.linalg.norm(z)
    return np.column_stack([x, np.cross(z, x), z])


@pytest.mark.parametrize("row", [0, 3, 8])
def test_double_wishbone(row: int) -> None:
    height = 230.0 + 20.0 * row
    expected = wishbone(height)
    for name in ("track", "camber", "toe", "strut"):
        found = read("double_wishbone", name)[row]
        assert found == pytest.approx(expected[name], abs=1e-8), name
    step = 1e-3
    before, after = wishbone(height - step), wishbone(height + step)

    def slope(name: str) -> float:
        return (after[name] - before[name]) / (2 * step)

    ratio = read("double_wishbone", "motion_ratio")[row]
    assert ratio == pytest.approx(-slope("strut"), abs=1e-6)
    centre = expected["z"] + expected["y"] * slope("y") / slope("z")
    assert read("double_wishbone", "roll_centre")[row] == pytest.approx(centre, abs=1e-3)
