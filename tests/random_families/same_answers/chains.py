"""The chains of random mechanisms: links, joints, masses, points and parameters."""

from __future__ import annotations

FREEDOMS = {
    "R": 1,
    "P": 1,
    "H": 1,
    "C": 2,
    "U": 2,
    "Ss": 2,
    "S": 3,
    "E": 3,
    "Sc": 3,
    "Sg": 4,
    "Cp": 4,
    "Sp": 5,
}
COORDINATES = {
    "R": ["theta"], "P": ["s"], "C": ["theta", "s"], "H": ["theta", "s"], "S": [], "Sp": [], "Sg": ["s"],
    "U": ["theta1", "theta2"], "E": ["x", "y", "theta"], "Ss": ["theta1", "theta2"],
    "Sc": ["s", "theta1", "theta2"], "Cp": ["theta1", "theta2", "x", "y"], "W": [], "Ps": ["theta", "s"],
}  # fmt: skip
PLANE_FREEDOMS = {"R": 1, "P": 1, "Ps": 2}


class Mechanism:
    """A file being drawn: its sections, the files beside it, and what may be asked of it."""

    def __init__(self, rng):
        self.rng = rng
        self.data = {"format": 1}
        self.files = {}
        self.plane = False
        self.joints = {}
        self.links = {}
        self.inputs = []
        self.responses = []
        self.named = []
        self.scale = 100.0

    # -- numbers

    def vector(self, spread=1.0, about=None):
        n = 2 if self.plane else 3
        about = about or [0.0] * n
        digits = self.rng.choice([0, 1, 3])
        return [round(a + self.rng.uniform(-1, 1) * spread, digits) for a in about]

    def direction(self):
        rng = self.rng
        n = 2 if self.plane else 3
        if rng.random() < 0.5:
            one = [0] * n
            one[rng.randrange(n)] = rng.choice([1, 1, -1])
            return one
        while True:
            found = [rng.randint(-4, 4) for _ in range(n)]
            if any(found):
                return found

    def is_angle(self, coordinate):
        return coordinate.split(".")[1].startswith("theta")

    # -- structure

    def link(self, name=None):
        name = name or f"k{len(self.links) + 1}"
        self.links[name] = {}
        return name

    def joint(self, kind, first, second, point):
        rng = self.rng
        name = f"{'ABDEFGJKLMNQ'[len(self.joints) % 12]}{len(self.joints) // 12 or ''}"
        one = {"type": kind, "links": [first, second]}
        if kind != "W":
            one["point"] = point
        if kind in ("R", "P", "C", "H") and not (self.plane and kind == "R"):
            one["axis"] = self.direction()
        if kind == "H":
            one["lead"] = f"{rng.choice([5, -8, 12.5])} mm"
        if kind == "Sp":
            one["normal"] = self.direction()
        if kind == "Sg":
            one["groove"] = self.direction()
        if kind == "Ps":
            one["slot"] = self.direction()
        pair = rng.choice(
            [
                ([0, 0, 1], [1, 0, 0]),
                ([1, 0, 0], [0, 1, 0]),
                ([0, 1, 1], [1, 0, 0]),
                ([1, 2, 0], [2, -1, 0]),
            ]
        )
        for first_key, second_key, kinds in (
            ("axis", "axis2", "U"), ("normal", "x", "E"), ("slot", "pin", "Ss"), ("axis", "pin", "Sc"), ("axis", "normal", "Cp"),
        ):  # fmt: skip
            if kind == kinds:
                one[first_key], one[second_key] = pair
        if rng.random() < 0.1 and kind not in ("W",):
            one["links"].reverse()
        self.joints[name] = one
        return name

    def coordinates(self):
        return [
            f"{name}.{c}" for name, one in self.joints.items() for c in COORDINATES[one["type"]]
        ]

    def chain(self, first, last, kinds, start, end, closed):
        """Joints of these kinds from one link to another over new links; drawn closed or not."""
        links = [first] + [self.link() for _ in kinds[1:]] + [last]
        made = []
        for place, kind in enumerate(kinds):
            part = place / max(1, len(kinds) - 1)
            about = [a + (b - a) * part for a, b in zip(start, end)]
            point = self.vector(0.6 * self.scale, about)
            made.append(self.joint(kind, links[place], links[place + 1], point))
        if not closed:
            one = self.joints[made[-1]]
            if one["type"] != "W":
                one["point"] = {
                    n: self.vector(0.1 * self.scale, one["point"]) for n in one["links"]
                }
        return made


def kinds_with(rng, table, total, weights, least=2):
    """Kinds whose freedoms sum up to a total."""
    while True:
        kinds, left = [], total
        while left > 0:
            fitting = [k for k in table if table[k] <= left]
            kinds.append(rng.choices(fitting, [weights.get(k, 1) for k in fitting])[0])
            left -= table[kinds[-1]]
        if least <= len(kinds) <= 7:
            rng.shuffle(kinds)
            return kinds


SPACE_WEIGHTS = {
    "R": 10,
    "P": 4,
    "C": 5,
    "H": 2,
    "S": 4,
    "Sp": 1,
    "Sg": 1.5,
    "U": 2,
    "E": 1,
    "Ss": 0.7,
    "Sc": 0.7,
    "Cp": 0.7,
}
PLANE_WEIGHTS = {"R": 6, "P": 2, "Ps": 1.5}


def structure(m):
    """Links and joints; gives how many inputs they need."""
    rng = m.rng
    m.plane = rng.random() < 0.4
    n = 2 if m.plane else 3
    origin = [0.0] * n
    table, weights, held = (
        (PLANE_FREEDOMS, PLANE_WEIGHTS, 3) if m.plane else (FREEDOMS, SPACE_WEIGHTS, 6)
    )
    form = rng.random()
    closed = rng.random() < 0.85
    if form < 0.12:  # an open chain
        kinds = [
            rng.choice(["R", "P"] if m.plane else ["R", "P", "C", "H", "U"])
            for _ in range(rng.randint(1, 3))
        ]
        before = "ground"
        for kind in kinds:
            after = m.link()
            m.joint(kind, before, after, m.vector(m.scale))
            before = after
        return sum(table[k] for k in kinds)
    if form < 0.22 and not m.plane:  # planar or spherical loop in space, overconstrained
        point = [0.0, 0.0, 0.0]
        links = ["ground", m.link(), m.link(), m.link()]
        spherical = rng.random() < 0.4
        corners = [
            [0, 0, 0],
            [40, 0, 0],
            [120, rng.randint(60, 100), 0],
            [rng.randint(100, 130), 0, 0],
        ]
        axes = [[0, 0, 1], [1, 0, 3], [2, 3, 4], [4, 0, 1]]
        for i in range(4):
            name = m.joint("R", links[i], links[(i + 1) % 4], point if spherical else corners[i])
            m.joints[name]["axis"] = axes[i] if spherical else [0, 0, 1]
        if rng.random() < 0.3 and not spherical:
            last = list(m.joints)[3]
            m.joints[last]["type"] = "P"
            m.joints[last]["axis"] = [1, 0, 0]
        return 1
    if form < 0.34 and not m.plane:  # a rocker driven over a leg, S-S or S-P-S
        crank, rod, rocker = m.link(), m.link(), m.link()
        m.joint("R", "ground", crank, m.vector(20))
        m.joint("S", crank, rod, m.vector(20, [40, 10, 0]))
        inputs = 1
        if rng.random() < 0.3:
            inner = m.link()
            a, b = m.vector(20, [40, 10, 0]), m.vector(20, [150, 60, 40])
            list(m.joints.values())[-1]["point"] = a
            name = m.joint("P", rod, inner, a)
            m.joints[name]["axis"] = [round(y - x, 6) for x, y in zip(a, b)]
            m.joint("S", inner, rocker, b)
            inputs = 2
        else:
            m.joint("S", rod, rocker, m.vector(20, [150, 60, 40]))
        m.joint(rng.choice(["R", "R", "R", "P", "H"]), "ground", rocker, m.vector(20, [140, 0, 30]))
        return inputs
    freedoms = rng.choices([1, 2], [4, 1])[0]
    kinds = kinds_with(rng, table, held + freedoms, weights)
    if rng.random() < 0.8 and not {"R", "P"} & {kinds[0]}:
        for i, kind in enumerate(kinds):
            if kind in ("R", "P"):
                kinds[0], kinds[i] = kinds[i], kinds[0]
                break
    end = [1.5 * m.scale] + [0.0] * (n - 1)
    m.chain("ground", "ground", kinds, origin, end, closed)
    more = rng.choices([0, 1, 2], [5, 2, 1] if not m.plane else [3, 2, 1])[0]
    for _ in range(more):
        wanted = rng.choices([0, 1], [6, 1])[0]
        freedoms += wanted
        kinds = kinds_with(rng, table, held + wanted, weights)
        first, last = rng.sample(["ground", *m.links], 2)
        start = m.vector(m.scale)
        m.chain(first, last, kinds, start, m.vector(m.scale, start), closed)
    if rng.random() < 0.06:  # a weld, or a link that hangs on
        m.joint("W", rng.choice(list(m.links)), m.link(), None)
    if rng.random() < 0.06:
        m.joint("R", rng.choice(list(m.links)), m.link(), m.vector(m.scale))
        freedoms += 1
    return freedoms


def masses(m):
    rng = m.rng
    if rng.random() < 0.25:
        return
    for one in m.links.values():
        if rng.random() < 0.6:
            one["mass"] = round(rng.uniform(0.1, 5), 2)
            one["center_of_mass"] = m.vector(m.scale)
            if rng.random() < 0.6:
                i = round(rng.uniform(100, 5000), 1)
                one["inertia"] = (
                    i if m.plane else {"xx": i, "yy": round(1.2 * i, 1), "zz": round(0.9 * i, 1)}
                )


def marks(m):
    rng = m.rng
    points = {}
    for i in range(rng.randint(0, 3)):
        link = rng.choice([*m.links, "ground"]) if m.links else "ground"
        points[f"p{i}"] = {"link": link, "at": m.vector(m.scale)}
    if points:
        m.data["points"] = points
    if rng.random() < 0.3 and m.links:
        m.data["directions"] = {"d0": {"link": rng.choice(list(m.links)), "vector": m.direction()}}
    m.points = points


def parameters(m):
    """Some numbers of the drawing become parameters."""
    rng = m.rng
    m.parameters = {}
    if rng.random() < 0.35:
        return
    names = ["r", "q", "h", "w"]
    places = [
        (j, i) for j in m.joints for i in range(2) if isinstance(m.joints[j].get("point"), list)
    ]
    rng.shuffle(places)
    for name, (joint, i) in zip(names[: rng.randint(1, 4)], places):
        value = m.joints[joint]["point"][i]
        unit = m.data["units"].get("length", "mm") if rng.random() < 0.98 else ""
        m.parameters[name] = f"{value} {unit}".strip()
        form = rng.random()
        m.joints[joint]["point"][i] = (
            name if form < 0.6 else f"{name} + 0 mm" if form < 0.8 else f"2*{name}/2"
        )
    if m.parameters and rng.random() < 0.3:
        first = next(iter(m.parameters))
        m.parameters["z"] = f"{first}*2 + 1 mm"  # nothing uses it, which is a note
    if rng.random() < 0.3:
        m.parameters["k"] = "2 N/mm"
    if rng.random() < 0.1:
        m.parameters["unused"] = "3 deg"
    if m.parameters:
        m.data["parameters"] = m.parameters
