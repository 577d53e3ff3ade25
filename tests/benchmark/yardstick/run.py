"""Yardstick: the throw-away C kernel (kern.c) on one thread, microseconds per position.

    python run.py            # rcsr, rssr, sevenr
    python run.py --json     # the same as JSON

Levels: 0 position, 1 + velocity and acceleration, 2 + effort and all joint wrenches. Two Newton
steps
from a second-order predictor, 2048 positions a call. kern.c knows R and P joints and one closing
joint only, has no error handling and no convergence test. It marks what the machine can do; it is
not a base to build on. Needs gcc and numpy.
"""

import ctypes as ct
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mechs
import numpy as np
from prep import chain, prep

HERE = Path(__file__).resolve().parent
MAXJ, Double, Int = 16, ct.c_double, ct.c_int
Doubles = ct.POINTER(Double)
COMMON = "-D_GNU_SOURCE -fno-math-errno -shared -fPIC"
NO_CONTRACTION = " -ffp-contract=off"
WIDE = "-O3 -march=native -mprefer-vector-width=512 -DOWNSC"


class Mech(ct.Structure):
    """`Mech` of kern.c."""

    _fields_ = (
        *((name, Int) for name in ("n", "nu", "point", "jL", "jR")),
        *((name, Int * MAXJ) for name in ("type", "par", "hasb")),
        ("nL", Int),
        ("nR", Int),
        ("chL", Int * MAXJ),
        ("chR", Int * MAXJ),
        ("C", Double * 9 * MAXJ),
        ("c", Double * 3 * MAXJ),
        ("m", Double * MAXJ),
        ("com", Double * 3 * MAXJ),
        ("I", Double * 9 * MAXJ),
        *((name, Double * 3) for name in ("xL", "xR")),
        *((name, Double * 9) for name in ("EL", "ER")),
        ("g", Double * 3),
    )


def to_c(P):
    """The data of `prep` as the structure of kern.c."""
    s = Mech()
    s.n, s.nu, s.point, s.jL, s.jR = P["n"], P["n"] - 1, int(P["point"]), P["jL"], P["jR"]
    left, right = chain(P, P["jL"]), chain(P, P["jR"])
    s.nL, s.nR = len(left), len(right)
    s.chL[: len(left)] = left
    s.chR[: len(right)] = right
    for k in range(P["n"]):
        s.type[k] = 0 if P["type"][k] == "R" else 1
        s.par[k] = P["parent"][k]
        s.hasb[k] = int(k in P["body"])
        s.C[k][:] = list(P["C"][k].ravel())
        s.c[k][:] = list(P["c"][k])
        if k in P["body"]:
            m, c, tensor = P["body"][k]
            s.m[k] = m
            s.com[k][:] = list(c)
            s.I[k][:] = list(tensor.ravel())
    for name in ("xL", "xR"):
        getattr(s, name)[:] = list(P[name])
    for name in ("EL", "ER"):
        getattr(s, name)[:] = list(P[name].ravel())
    s.g[:] = list(mechs.G)
    return s


def widths():
    """(name, lanes, contraction, options) of the builds that this machine can run."""
    flags = Path("/proc/cpuinfo").read_text()
    kinds = [
        ("scalar -O2", 1, False, "-O2"),
        ("2 lanes SSE2", 2, False, "-O3 -DOWNSC"),
    ]
    if " avx2" in flags:
        kinds.append(("4 lanes AVX2", 4, False, "-O3 -mavx2 -DOWNSC"))
        kinds.append(("4 lanes AVX2 fma", 4, True, "-O3 -mavx2 -mfma -DOWNSC"))
    if " avx512f" in flags:
        kinds.append(("8 lanes AVX-512", 8, False, WIDE))
        kinds.append(("8 lanes AVX-512 fma", 8, True, WIDE))
    return kinds


def build(folder, lanes, contraction, options):
    """Compiles kern.c for one width; returns its `run`. Raises OSError or CalledProcessError."""
    library = Path(folder) / f"yardstick{lanes}{'c' if contraction else ''}.so"
    command = f"gcc {COMMON} {options}{'' if contraction else NO_CONTRACTION} -DLANES={lanes}"
    source = str(HERE / "kern.c")
    subprocess.run(
        [*command.split(), "-DFN(x)=x##_f", source, "-o", str(library), "-lm"], check=True
    )
    run = ct.CDLL(str(library)).run_f
    run.argtypes = [
        ct.POINTER(Mech),
        ct.c_long,
        Doubles,
        Doubles,
        Double,
        Double,
        Int,
        Int,
        Doubles,
    ]
    return run


def call(run, K, q1, U, its, level, out, w=mechs.OMEGA, al=mechs.ALPHA):
    """Positions q1 (N) from guesses U (nu, N) with `its` Newton steps into out (`slots`, N)."""
    x, u, o = (array.ctypes.data_as(Doubles) for array in (q1, U, out))
    run(ct.byref(K), q1.size, x, u, w, al, its, level, o)


def slots(nu):
    """Rows of the output: unknowns, two derivatives, effort, closing force, joint wrenches."""
    return 3 * nu + 4 + 6 * (nu + 1)


def _at(run, K, x, u):
    """The position next to u, with first and second derivatives by the input."""
    nu = K.nu
    out = np.zeros(slots(nu))
    guess = np.ascontiguousarray(np.array(u, float)[:, None])
    call(run, K, np.array([x]), guess, 12, 1, out, 1.0, 0.0)
    return out[:nu].copy(), out[nu : 2 * nu].copy(), out[2 * nu : 3 * nu].copy()


def positions(run, m, K):
    """Unknowns and their two derivatives at every input position, by continuation."""
    q, seed = np.asarray(m["input"]), m["q_seed"]
    q0, u = seed if seed is not None else (q[0], _start(run, K, q[0]))
    found = {}
    for part in (q[q >= q0], q[q < q0][::-1]):
        x, (s, d, dd) = q0, _at(run, K, q0, u)
        for y in part:
            for z in np.linspace(x, y, max(2, int(abs(y - x) / 0.004) + 2))[1:]:
                h = z - x
                s, d, dd = _at(run, K, z, s + h * d + 0.5 * h * h * dd)
                x = z
            found[y] = (s, d, dd)
    return q, *(np.array([found[x][i] for x in q]) for i in range(3))


def _start(run, K, q0):
    rng = np.random.default_rng(1)
    for _ in range(500):
        guess = rng.uniform(-3, 3, (K.nu, 1))
        out = np.zeros(slots(K.nu))
        call(run, K, np.array([q0]), guess, 60, 0, out)
        found = out[: K.nu].copy()
        call(run, K, np.array([q0]), np.ascontiguousarray(found[:, None]), 1, 0, out)
        if np.all(np.isfinite(found)) and np.abs(out[: K.nu] - found).max() < 1e-12:
            return found
    raise SystemExit("no start found")


def case(run, name, count=2048):
    """(structure, inputs, guesses, exact unknowns): the sweep's positions repeated to `count`."""
    m = mechs.MECHS[name]()
    K = to_c(prep(m))
    q, u, du, ddu = positions(run, m, K)
    h = np.diff(q)[:, None]
    start = u.copy()
    start[1:] = u[:-1] + h * du[:-1] + 0.5 * h * h * ddu[:-1]
    times = -(-count // q.size)
    x = np.tile(q, times)[:count].copy()
    U = np.ascontiguousarray(np.tile(start, (times, 1))[:count].T)
    return K, x, U, np.tile(u, (times, 1))[:count].T


def _best(run, K, x, U, level, out):
    call(run, K, x, U, 2, level, out)
    best = 1e9
    for _ in range(40):
        start = time.perf_counter()
        call(run, K, x, U, 2, level, out)
        best = min(best, time.perf_counter() - start)
    return best


def measure():
    """One record per mechanism, build and level."""
    records = []
    with tempfile.TemporaryDirectory() as folder:
        builds = [(name, build(folder, *kind)) for name, *kind in widths()]
        for mechanism in mechs.MECHS:
            K, x, U, exact = case(builds[0][1], mechanism)
            out = np.zeros((slots(K.nu), x.size))
            for name, run in builds:
                for level in (0, 1, 2):
                    seconds = _best(run, K, x, U, level, out)
                    records.append(
                        {
                            "mechanism": mechanism,
                            "kernel": name,
                            "level": level,
                            "us": round(seconds / x.size * 1e6, 4),
                            "position_error": float(np.abs(out[: K.nu] - exact).max()),
                        }
                    )
    return records


def main():
    records = measure()
    if "--json" in sys.argv:
        print(json.dumps(records, indent=1))
        return
    for r in records:
        name = f"{r['mechanism']:8s} {r['kernel']:19s} level {r['level']}"
        print(f"{name}  {r['us']:7.3f} us/position  error {r['position_error']:.1e}")


if __name__ == "__main__":
    main()
