"""What is asked of a random chain: motion, responses, loads, expressions and tables."""

from __future__ import annotations


def angle_or_length(m, coordinate, least, most):
    if m.is_angle(coordinate):
        return round(m.rng.uniform(least, most), m.rng.choice([0, 1]))
    return round(m.rng.uniform(least, most) * 0.3, 1)


def followed(m, coordinate, other):
    """An expression of another coordinate in the dimension of this one."""
    if m.is_angle(coordinate) == m.is_angle(other):
        return f"2*{other}"
    return f"{other}/(10 mm)*(1 rad)" if m.is_angle(coordinate) else f"20 mm*sin({other})"


def motion(m, count):
    rng = m.rng
    free = m.coordinates()
    if not free:
        return
    helical = {f"{n}.s" for n, one in m.joints.items() if one["type"] == "H"}
    free = [c for c in free if c not in helical]
    if rng.random() < 0.75:  # the first ones, where a motor would sit
        chosen = free[:count]
    else:
        chosen = rng.sample(free, min(count, len(free)))
    if rng.random() < 0.05 and len(free) > count:
        chosen = [*chosen, free[-1]]
    rows = rng.choice([1, 3, 5, 9, 13])
    timed = rng.random() < 0.3
    inputs = {}
    for i, c in enumerate(chosen):
        span = rng.choice([10, 40, 40, 90, 360])
        begin = 0 if rng.random() < 0.6 else angle_or_length(m, c, -30, 30)
        to = begin + (span if m.is_angle(c) else round(0.3 * min(span, 90), 2))
        if timed:
            law = rng.choice(
                [
                    "constant-rate",
                    "constant-acceleration",
                    "polynomial",
                    "harmonic",
                    "cycloidal",
                    "table",
                ]
            )
            rate = "rad/s" if m.is_angle(c) else "mm/s"
            one = {"law": law}
            if law == "constant-rate":
                one |= {"at": begin, "rate": f"{rng.choice([0.5, 1, -2])} {rate}"}
            elif law == "constant-acceleration":
                one |= {"at": begin, "rate": f"0.2 {rate}", "acceleration": f"0.7 {rate}^2"}
            elif law == "polynomial":
                one["coefficients"] = [begin, f"0.4 {rate}", f"0.3 {rate}^2", f"-0.1 {rate}^3"]
            elif law in ("harmonic", "cycloidal"):
                one |= {"from": begin, "to": to}
                if rng.random() < 0.4:
                    one |= {"start": "0.1 s", "duration": "0.5 s"}
            else:
                one["file"] = f"law{i}.csv"
                m.files[f"law{i}.csv"] = "t,x\n" + "".join(
                    f"{t},{round(begin + (to - begin) * (t / 1.0) ** 2, 4)}\n"
                    for t in (0, 0.25, 0.5, 0.75, 1.0)
                )
                if rng.random() < 0.5:
                    one["interpolation"] = rng.choice(["spline", "monotone", "linear"])
                if rng.random() < 0.3:
                    one["ends"] = rng.choice(["natural", "clamped", "not-a-knot"])
            if i and rng.random() < 0.35:
                one = {
                    "with": rng.choice(
                        [
                            followed(m, c, chosen[0]),
                            f"{followed(m, c, chosen[0])} + {'3 deg' if m.is_angle(c) else '3 mm'}*sin(2 rad/s*time)",
                        ]
                    )
                }
        else:
            form = rng.random()
            if form < 0.7:
                one = {"from": begin, "to": to, "count": rows}
                if rng.random() < 0.1:
                    one = {"from": begin, "to": to, "step": max(1, round((to - begin) / 7, 1))}
            elif form < 0.85:
                one = {
                    "values": [
                        round(begin + (to - begin) * k / max(1, rows - 1), 3) for k in range(rows)
                    ]
                }
            else:
                one = {"at": begin}
            if i and rng.random() < 0.3:
                one = {
                    "with": rng.choice(
                        [
                            followed(m, c, chosen[0]),
                            f"-{followed(m, c, chosen[0])}",
                            f"{followed(m, c, chosen[0])} + {'2 deg' if m.is_angle(c) else '1 mm'}",
                        ]
                    )
                }
                if rng.random() < 0.5:
                    one["drive"] = rng.choice(["tie", "own"])
            elif rng.random() < 0.7:
                one["rate"] = rng.choice([1, 0.5, "2 rad/s" if m.is_angle(c) else "10 mm/s"])
                if rng.random() < 0.3:
                    one["acceleration"] = rng.choice([1, -0.5])
                if rng.random() < 0.1:
                    one["jerk"] = 0.3
        inputs[c] = one
    m.inputs = chosen
    section = {"inputs": inputs}
    if timed:
        section["time"] = {"from": 0, "to": "1 s", "count": rows}
    if rng.random() < 0.93:
        m.data["motion"] = section
    m.timed = timed
    others = [c for c in free if c not in chosen]
    if others and rng.random() < 0.25:
        c = rng.choice(others)
        m.data["assembly"] = {"near": {c: angle_or_length(m, c, -120, 120)}}
    elif rng.random() < 0.08:
        m.data["assembly"] = {"mode": rng.choice("AB")}
    elif rng.random() < 0.08:
        m.data["assembly"] = {"at_branch_points": "straight"}
    if rng.random() < 0.08:
        m.data.setdefault("assembly", {})["turns"] = rng.choice([0, 2])
    if others and rng.random() < 0.06:
        m.data["actuators"] = rng.sample(others, min(len(others), count))
    if rng.random() < 0.1 and m.joints:
        m.data["follow"] = [rng.choice(list(m.joints))]


def responses(m, count):
    rng = m.rng
    if rng.random() > 0.22 or not m.coordinates():
        return
    made = {}
    for name in ["fall", "swing"][: rng.choice([1, 1, 2])]:
        start = {
            c: 0 if rng.random() < 0.7 else angle_or_length(m, c, -20, 20)
            for c in (m.inputs or m.coordinates())[:count]
        }
        first = next(iter(start), None)
        if first and rng.random() < 0.5:
            start[f"{first}_dot"] = "0.5 rad/s" if m.is_angle(first) else "10 mm/s"
        one = {
            "start": start,
            "time": rng.choice([{"from": 0, "to": 0.2, "count": 5}, {"values": [0, 0.05, 0.2]}]),
        }
        if first and rng.random() < 0.4:
            one["efforts"] = {
                first: rng.choice(["3 N*m", "2 N*m - 0.1 N*m*s/rad*" + first + "_dot"])
                if m.is_angle(first)
                else rng.choice(["5 N", f"5 N - 0.1 N/mm*{first}"])
            }
        if first and rng.random() < 0.3:
            one["stop"] = [
                rng.choice(
                    [
                        {"value": first, "at": 5},
                        {"dead_centre": first},
                        {"value": "time - 0.1 s", "direction": "up"},
                    ]
                )
            ]
        if len(start) > 1 and rng.random() < 0.3:
            driven = [c for c in start if not c.endswith("_dot")][-1]
            if driven != first:
                del start[driven]
                one["driven"] = {
                    driven: rng.choice([{"at": 0}, {"law": "harmonic", "from": 0, "to": 5}])
                }
        if rng.random() < 0.2:
            one["fixed_step"] = "5 ms"
        elif rng.random() < 0.2:
            one["tolerance"] = 1e-8
        made[name] = one
    m.data["responses"] = made
    m.responses = list(made)


def loads(m):
    rng = m.rng
    found = []
    vec = 2 if m.plane else 3
    names = list(m.joints)
    turning = [n for n in names if m.joints[n]["type"] in ("R", "C")]
    sliding = [n for n in names if m.joints[n]["type"] in ("P", "C")]
    first = (m.inputs or [None])[0]
    if rng.random() < 0.5:
        found.append({"type": "gravity", "g": rng.choice(["standard", [0] * (vec - 1) + [-9810]])})
    for _ in range(rng.choice([0, 0, 1, 1, 2, 3])):
        form = rng.randrange(9)
        if form == 0 and m.links:
            force = [round(rng.uniform(-20, 20), 1) for _ in range(vec)]
            if rng.random() < 0.4 and first:
                force[0] = (
                    f"5 N*{'sin' if rng.random() < 0.5 else 'cos'}({first})"
                    if m.is_angle(first)
                    else f"0.3 N/mm*{first}"
                )
            found.append(
                {
                    "type": "force",
                    "link": rng.choice(list(m.links)),
                    "point": m.vector(m.scale),
                    "force": force,
                }
            )
            if rng.random() < 0.3:
                found[-1]["axes"] = "link"
        elif form == 1 and m.links:
            found.append(
                {
                    "type": "torque",
                    "link": rng.choice(list(m.links)),
                    "torque": 120 if m.plane else m.vector(300),
                }
            )
        elif form == 2 and turning:
            n = rng.choice(turning)
            value = rng.choice(
                [
                    10,
                    "2 N*m",
                    f"1 N*m*sin(2*{n}.theta)",
                    f"3 N*m - 0.1 N*m*s/rad*{n}.theta_dot",
                    f"if({n}.theta > 5 deg, 2 N*m, 1 N*m)",
                ]
            )
            if rng.random() < 0.2:
                m.files["load.csv"] = "x,y\n" + "".join(
                    f"{x},{round(0.01 * x * x, 3)}\n" for x in range(-400, 401, 100)
                )
                value = {"table": "load.csv"}
                if rng.random() < 0.5:
                    value["interpolation"] = rng.choice(["linear", "monotone", "spline"])
            found.append({"type": "torque", "joint": n, "value": value})
        elif form == 3 and sliding:
            n = rng.choice(sliding)
            value = rng.choice([10, "20 N", f"20 N - 0.5 N/mm*{n}.s", "5 N*sign(" + n + ".s_dot)"])
            if getattr(m, "timed", False) and rng.random() < 0.3:
                value = "10 N*time/(1 s)"
            found.append({"type": "force", "joint": n, "value": value})
        elif form == 4 and len(m.points) > 1:
            a, b = rng.sample(list(m.points), 2)
            stiff = "k" if "k" in m.parameters else "0.5 N/mm"
            found.append({"type": "spring", "between": [a, b], "stiffness": stiff, "free": "50 mm"})
        elif form == 5 and len(m.points) > 1:
            a, b = rng.sample(list(m.points), 2)
            found.append({"type": "damper", "between": [a, b], "damping": "0.2 N*s/mm"})
        elif form == 6 and turning:
            found.append(
                {
                    "type": "spring",
                    "joint": rng.choice(turning),
                    "coordinate": "theta",
                    "stiffness": "3 N*m/rad",
                    "free": 10,
                    "preload": "0.1 N*m",
                }
            )
        elif form == 7 and sliding:
            found.append(
                {
                    "type": "damper",
                    "joint": rng.choice(sliding),
                    "coordinate": "s",
                    "damping": "0.2 N*s/mm",
                }
            )
        elif form == 8:
            n = rng.choice(names)
            kind = m.joints[n]["type"]
            if kind in ("R", "P", "C", "H", "S", "Sp", "Sg", "Ps"):
                one = {
                    "type": "friction",
                    "joint": n,
                    "coefficient": rng.choice(
                        [0.1, 0.05, {"static": 0.15, "sliding": 0.1, "speed": "5 mm/s"}]
                    ),
                }
                if kind in ("R", "C", "H", "S"):
                    one["radius"] = "4 mm"
                if kind in ("R", "C") and not m.plane and rng.random() < 0.4:
                    one["length"] = "60 mm"
                found.append(one)
    for one in found:
        if m.responses and rng.random() < 0.15:
            one["runs"] = [rng.choice(["sweep", *m.responses])]
    if found:
        m.data["loads"] = found
    if rng.random() < 0.15 and not m.plane:
        m.data["idle"] = "hold"


def expressions(m):
    """Quantities and expressions that a column may have."""
    rng = m.rng
    found = list(m.coordinates())
    found += [f"{c}_dot" for c in found] + [f"{c}_ddot" for c in found[:2]]
    for name, one in m.joints.items():
        found += [
            f"norm({name}.force)",
            f"{name}.force.x",
            f"{name}.point.y" if one["type"] != "W" else "pi",
        ]
        if one["type"] in ("R", "P", "C", "H"):
            found += [f"{name}.radial_force"]
        if one["type"] == "S":
            found += [f"{name}.q0", f"norm({name}.turn)" if rng.random() < 0.5 else f"{name}.q3"]
    for p in m.points:
        found += [f"{p}.position.x", f"norm({p}.velocity)", f"{p}.acceleration.y"]
    for k in list(m.links)[:2]:
        found += [f"{k}.omega" if m.plane else f"norm({k}.omega)", f"{k}.finite_angle"]
    for c in m.inputs:
        found += [f"{c}.effort", f"{c}.reduced_inertia"]
    found += [
        "row.condition",
        "row.residual",
        "row.kinetic_energy",
        "row.potential_energy",
        "row.power_error",
        "row.status",
        "row.mode",
    ]
    found += ["row.error_bound", "norm(ground.shaking_force)", *m.named]
    if getattr(m, "timed", False):
        found += ["time", "row.work", "row.energy_error"]
    others = [c for c in m.coordinates() if c not in m.inputs]
    if m.inputs and others:
        c = rng.choice(others)
        found += [
            f"derivative({c}, {m.inputs[0]})",
            f"{c}_ddot.per_acceleration",
            f"{c}_ddot.without_acceleration",
        ]
        if rng.random() < 0.5:
            found += [
                f"{c}.mechanical_advantage",
                f"{c}.dynamic_transmission_angle",
                f"{c}.transmission_angle",
            ]
    return found


def tables(m):
    rng = m.rng
    if rng.random() < 0.2 and m.coordinates():
        c = rng.choice(m.coordinates())
        m.data["quantities"] = {"g1": rng.choice([f"2*{c}", f"{c}_dot^2", f"max({c}, 2*{c})"])}
        if rng.random() < 0.5:
            m.data["quantities"]["g2"] = "g1*3"
        m.named = list(m.data["quantities"])
    pool = expressions(m)
    if rng.random() < 0.75:
        made = []
        for i in range(rng.choice([1, 1, 2, 3])):
            columns = []
            calm = [t for t in pool if "transmission" not in t and "advantage" not in t]
            for text in (lambda p: rng.sample(p, min(len(p), rng.randint(2, 7))))(
                pool if rng.random() < 0.3 else calm
            ):
                one = text
                if rng.random() < 0.6 or "(" in text:
                    one = {"label": f"c{len(columns)} {text}"[:30], "value": text}
                    if rng.random() < 0.4 and text not in ("row.status", "row.mode"):
                        one["decimals"] = rng.randint(0, 9)
                columns.append(one)
            table = {"name": f"table_{i + 1}", "columns": columns}
            if rng.random() < 0.3:
                table["title"] = "A table | of *things*"
            if rng.random() < 0.3:
                table["summary"] = rng.sample(
                    ["max", "min", "peak", "mean", "rms", "range"], rng.randint(1, 6)
                )
            if m.responses and rng.random() < 0.7:
                table["run"] = rng.choice(["sweep", *m.responses])
            made.append(table)
        m.data["tables"] = made
    turn = (
        m.inputs
        and m.is_angle(m.inputs[0])
        and m.data.get("motion", {}).get("inputs", {}).get(m.inputs[0], {})
    )
    if (
        rng.random() < (0.5 if turn and turn.get("to", 0) - turn.get("from", 0) == 360 else 0.02)
        and m.inputs
    ):
        made = [{"type": "work", "name": "work"}]
        if rng.random() < 0.5:
            made.append({"type": "harmonics", "name": "harm", "of": [rng.choice(m.coordinates())]})
        if rng.random() < 0.5:
            made.append({"type": "flywheel", "name": "fly", "unevenness": 0.02})
        m.data["balances"] = made
    if rng.random() < 0.06 and not m.plane:
        m.data["coefficients"] = [{"name": "dense", "row": 1}]
    if rng.random() < 0.1:
        m.data["view"] = {"speed": "4 s", "forces": rng.choice(["shown", "hidden"])}
        if m.links:
            m.data["view"]["hidden"] = [rng.choice(list(m.links))]
