"""Nothing on the way to a cell uses functions whose bits change with the machine.

Allowed are IEEE + - * / sqrt and the kernel's elementary functions. The C library's functions,
NumPy's elementary functions, sums and products, linear algebra and powers of floats are not; every
exception stands below with its reason.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from architecture.package import FILES, ROOT, of_every, room, tree

ROOMS = {
    "kernel",
    "units",
    "tape",
    "expressions",
    "mechanism",
    "idle",
    "structure",
    "plan",
    "session",
    "search",
    "building",
    "assembly",
    "modes",
    "derived",
    "balances",
    "statics",
    "vibration",
    "proofs",
    "sweep",
    "response",
    "errors",
    "tables",
}
EXACT_MATH = {"sqrt", "pi", "tau", "inf", "nan", "isnan", "isfinite", "isinf", "floor", "ceil"}
EXACT_MATH |= {
    "trunc",
    "copysign",
    "frexp",
    "ldexp",
    "gcd",
    "comb",
    "prod",
    "nextafter",
    "ulp",
    "fabs",
    "isqrt",
}
INEXACT_NUMPY = {
    *(
        "sin",
        "cos",
        "tan",
        "arcsin",
        "arccos",
        "arctan",
        "arctan2",
        "sinh",
        "cosh",
        "tanh",
        "hypot",
    ),
    *("exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "power", "float_power", "cbrt"),
    *("dot", "vdot", "inner", "outer", "matmul", "tensordot", "einsum", "cross", "linalg", "fft"),
    *("sum", "nansum", "mean", "average", "std", "var", "prod", "trapezoid", "interp", "polyfit"),
    *("deg2rad", "rad2deg", "radians", "degrees", "unwrap", "convolve", "logspace", "geomspace"),
}
INEXACT_METHODS = {"sum", "mean", "std", "var", "dot", "prod"}
# random deviates that come from logarithms of the C library
INEXACT_METHODS |= {"standard_normal", "normal", "standard_exponential", "exponential"}

FRACTIONS = "exact fractions and whole exponents"
ACCEPTED = {
    ("response/integration.py", "np.linalg"): "eigenvectors for a message",
    ("building/joints.py", "np.linalg"): "eigenvalues for a warning",
    ("building/bushings.py", "np.linalg"): "an eigenvalue for a message",
    (
        "building/spacing.py",
        "10 ** max(0, *(-exponent for exponent in exponents))",
    ): "whole numbers",
    ("tape/identities.py", "pow(rest, -1, whole)"): "whole numbers",
    ("tape/identities.py", "prime ** (count // 2)"): "whole numbers",
    ("response/result.py", "TIME ** order"): FRACTIONS,
    ("response/rows.py", "TIME ** order"): FRACTIONS,
    ("building/fields.py", "TIME ** order"): FRACTIONS,
    ("session/double_double.py", "TIME ** order"): FRACTIONS,
    ("building/law_reading.py", "self.over.dimension ** order"): FRACTIONS,
    ("building/law_reading.py", "self.over.dimension ** (have - want)"): FRACTIONS,
    ("building/law_reading.py", "fields.units.unit(variable) ** (-k)"): FRACTIONS,
    ("building/fields.py", "units.time ** (-2)"): FRACTIONS,
    ("expressions/operations.py", "base.dimension ** count"): FRACTIONS,
    ("expressions/functions.py", "operand.dimension ** Fraction(1, 2)"): FRACTIONS,
    ("units/units.py", "UNITS[symbol].factor ** int(exponent)"): FRACTIONS,
    ("units/units.py", "UNITS[symbol].dimension ** exponent"): FRACTIONS,
    ("units/units.py", "self.force ** reduced.mass"): FRACTIONS,
    ("units/units.py", "self.time ** time"): FRACTIONS,
    ("units/units.py", "angle_unit ** angle"): FRACTIONS,
    ("units/units.py", "self.mass ** reduced.mass"): FRACTIONS,
    ("units/units.py", "self.length ** length"): FRACTIONS,
    ("units/units.py", "rate ** angle"): FRACTIONS,
    ("units/units.py", "_SECOND ** (time + angle)"): FRACTIONS,
}
"""(file, expression) -> why it is exact or reaches no cell."""


def numpy_attribute(node: ast.Attribute) -> bool:
    return isinstance(node.value, ast.Name) and node.value.id == "np" and node.attr in INEXACT_NUMPY


def inexact(node: ast.AST) -> bool:
    """Whether a piece of source may round differently on another machine."""
    if isinstance(node, ast.BinOp):
        if isinstance(node.op, ast.MatMult):
            return True
        return isinstance(node.op, ast.Pow) and not whole_constants(node)
    if isinstance(node, ast.ImportFrom):
        return node.module == "math" and any(a.name not in EXACT_MATH for a in node.names)
    if (
        isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "math"
    ):
        return node.attr not in EXACT_MATH
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        return node.func.attr in INEXACT_METHODS
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return node.func.id in ("pow", "fsum")
    return isinstance(node, ast.Attribute) and numpy_attribute(node)


def whole_constants(power: ast.BinOp) -> bool:
    """Squares are multiplications; powers of whole constants are whole numbers."""
    if not isinstance(power.right, ast.Constant):
        return False
    base = power.left.value if isinstance(power.left, ast.Constant) else None
    return power.right.value == 2 or (isinstance(base, int) and isinstance(power.right.value, int))


def findings(path: Path) -> list[tuple[str, str]]:
    name = str(path.relative_to(ROOT))
    return [(name, ast.unparse(node)) for node in ast.walk(tree(path)) if inexact(node)]


CELL_FILES = [path for path in FILES if room(path) in ROOMS]  # `mobility/`: words and whole numbers


@of_every(CELL_FILES)
def test_only_exact_arithmetic(path: Path) -> None:
    assert [found for found in findings(path) if found not in ACCEPTED] == []


def test_accepted_exceptions_exist() -> None:
    everything = {found for path in CELL_FILES for found in findings(path)}
    assert set(ACCEPTED) <= everything


INEXACT_SOURCES = """
a @ b
math.sin(x)
np.sin(x)
np.sum(x)
x.sum()
np.linalg.norm(x)
np.dot(a, b)
x ** 3
x ** 0.5
10.0 ** n
pow(x, y)
from math import hypot
r.standard_normal(3)
"""


@pytest.mark.parametrize("source", INEXACT_SOURCES.strip().splitlines())
def test_inexact_source_is_seen(source: str) -> None:
    assert any(inexact(node) for node in ast.walk(ast.parse(source)))
