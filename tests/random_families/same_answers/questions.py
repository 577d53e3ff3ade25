"""Random questions about a mechanism."""

from __future__ import annotations

HEAVY = {
    "fit": 0.15,
    "tolerances": 0.4,
    "study": 0.6,
    "view": 0.8,
    "sensitivities": 0.7,
    "errors": 0.8,
    "certify": 0.8,
    "ranges": 1,
    "modes": 1.5,
}


def another(rng, value):
    """A value near that of a parameter, as a setting."""
    text = str(value)
    number = "".join(c for c in text if c in "0123456789.-eE+").strip()
    try:
        number = float(number)
    except ValueError:
        return rng.choice([1, "2 mm"])
    unit = text.lstrip("0123456789.-+ ") if isinstance(value, str) else ""
    new = round(
        number * rng.choice([1.0, 1.001, 1.01, 0.98, 1.1, 0.5]) + rng.choice([0, 0, 0.01]), 5
    )
    if rng.random() < 0.03:
        return rng.choice(["1e9 m", "nan", "3 kg", "x", 0])
    return f"{new} {unit}".strip() if rng.random() < 0.6 and unit else new


def via(rng, info):
    """How the model asked comes from the one loaded."""
    steps = []
    for _ in range(rng.choices([0, 1, 2, 3], [6, 3, 1.5, 0.7])[0]):
        form = rng.random()
        if form < 0.6 and info["parameters"]:
            name = rng.choice(list(info["parameters"]))
            steps.append(["with", {name: another(rng, info["parameters"][name])}])
        else:
            steps.append([rng.choice(["pickle", "copy", "deepcopy"])])
    return steps


def named(rng, info, most, solved=False):
    """Names of quantities alone, as `analyze`, `respond` and `solve` take them."""
    plain_names = [t for t in info["expressions"] if not set(t) & set("()*+ ^,")]
    plain_names = [t.rsplit(".", 1)[0] if t[-2:] in (".x", ".y", ".z") else t for t in plain_names]
    if solved and rng.random() < 0.95:
        plain_names = [
            t
            for t in plain_names
            if not t.startswith("row.")
            and "transmission" not in t
            and "advantage" not in t
            and "per" not in t
        ]
    return rng.sample(plain_names, min(len(plain_names), rng.randint(1, most)))


def question(rng, info, words=None):
    some = lambda least, most: rng.sample(
        info["expressions"], min(len(info["expressions"]), rng.randint(least, most))
    )
    words = words or {
        "analyze": 5, "read": 6, "respond": 3 if info["responses"] else 0.1, "modes": 1, "ranges": 0.8, "mobility": 1, "solve": 3, "vary": 3 if info["parameters"] else 0.1,
        "errors": 1, "certify": 1, "sensitivities": 1 if info["parameters"] else 0.05, "tolerances": 0.4 if info["parameters"] else 0.03,
        "study": 0.4 if info["parameters"] else 0.03, "fit": 0.12 if info["parameters"] else 0.01, "view": 0.4, "listing": 1, "picture": 0.5,
        "given": 0.6,
    }  # fmt: skip
    word = rng.choices(list(words), list(words.values()))[0]
    q = {"ask": word, "via": via(rng, info)}
    mode = rng.choices([None, "A", "B", "C", "Z"], [8, 2, 1, 0.5, 0.2])[0]
    response = (
        rng.choice(info["responses"])
        if info["responses"] and rng.random() < 0.97
        else rng.choice([None, "fall"])
    )
    knobs = {"lanes": rng.choice([0, 0, 2, 4]), "threads": rng.choice([0, 1, 2])}
    if word in ("analyze", "errors", "certify", "read"):
        q |= {"mode": mode, "knobs": knobs}
        if rng.random() < 0.12:
            q["closed_at"] = rng.sample(
                info["joints"], min(len(info["joints"]), rng.choice([1, 1, 2]))
            )
    if word == "analyze":
        q["quantities"] = rng.choice([None, named(rng, info, 4), named(rng, info, 8)])
        q["tables"] = rng.choice(
            [None, None, [], info["tables"][:1], ["nosuch"] if rng.random() < 0.1 else None]
        )
    if word == "read":
        q["quantities"] = some(1, 6)
        q["run"] = response if info["responses"] and rng.random() < 0.2 else None
    if word == "respond":
        q |= {
            "run": response,
            "mode": mode,
            "quantities": rng.choice([None, named(rng, info, 3)]),
            "knobs": knobs,
        }
    if word == "modes":
        q |= {
            "run": response if rng.random() < 0.2 and info["responses"] else None,
            "certify": rng.random() < 0.3,
        }
        q["at"] = rng.choice(
            [None, None, 10, "0.3 rad", {info["inputs"][0]: 20} if info["inputs"] else 3]
        )
    if word == "ranges":
        q |= {
            "input": rng.choice([None, *info["inputs"]]),
            "outputs": rng.sample(
                info["coordinates"], min(len(info["coordinates"]), rng.choice([0, 0, 1]))
            ),
        }
    if word == "solve":
        q["inputs"] = {
            c: rng.choice([1, 5, 12.5, "0.2 rad", "3 mm"])
            for c in info["inputs"]
            if rng.random() < 0.8
        }
        q["quantities"] = rng.choice([None, named(rng, info, 4, True)])
    if word == "vary":
        names = rng.sample(
            list(info["parameters"]), min(len(info["parameters"]), rng.choice([1, 1, 2]))
        )
        size = rng.choice([1, 2, 5])
        q |= {
            "parameters": {
                n: [another(rng, info["parameters"][n]) for _ in range(size)] for n in names
            },
            "quantities": rng.choice([None, some(1, 3)]),
        }
        q |= {
            "reduce": rng.choice([None, None, "peak", ["max", "mean"], ["rms", "range"]]),
            "knobs": knobs,
        }
        q["run"] = response if info["responses"] and rng.random() < 0.2 else "sweep"
    if word == "sensitivities":
        q |= {
            "quantities": some(1, 2),
            "parameters": list(info["parameters"])[:1] or None,
            "at": rng.choice([None, None, 0]),
        }
    if word == "tolerances":
        q |= {
            "tolerances": {n: rng.choice([0.01, "0.02 mm"]) for n in list(info["parameters"])[:2]},
            "quantities": some(1, 2),
            "samples": 8,
        }
    if word == "study":
        n = next(iter(info["parameters"]), "r")
        value = info["parameters"].get(n, 1)
        q["study"] = {
            "vary": {
                n: rng.choice([[another(rng, value) for _ in range(3)], {"tolerance": "0.5 mm"}])
            },
            "keep": [
                {"of": t, "as": rng.choice(["max", ["peak", "rms"], "place_of_max"])}
                for t in some(1, 2)
            ],
        }
        if isinstance(q["study"]["vary"][n], dict):
            q["study"]["sample"] = {"count": 5, "seed": rng.randint(0, 3)}
        if rng.random() < 0.3:
            q["study"]["dead_centres"] = "place"
    if word == "fit":
        n = next(iter(info["parameters"]), "r")
        try:
            base = float(
                "".join(c for c in str(info["parameters"].get(n, 1)) if c in "0123456789.-")
            )
        except ValueError:
            base = 1.0
        c = rng.choice(info["coordinates"]) if info["coordinates"] else "A.theta"
        q |= {
            "targets": rng.choice([{"of": c, "least": "peak"}, {"of": c, "least": "rms"}]),
            "bounds": {n: [base - 2, base + 2]},
        }
    if word == "view":
        q |= {"run": None, "modes": rng.random() < 0.5}
    if word == "picture":
        q["y"] = some(1, 2)
    return q
