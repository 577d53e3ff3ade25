"""One mass on a slide: `S.s` against ground, with what else the file holds."""

from __future__ import annotations

MASS = 2.0


def slider(loads: str, response: str, mass: float = MASS, name: str = "slider") -> str:
    """The text of a mass on a horizontal slide."""
    return f"""format: 1
name: {name}
links:
  block: {{mass: {mass}, center_of_mass: [0, 0, 0.1]}}
joints:
  S: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}
points:
  post: {{link: ground, at: [0, 0.75, 0]}}
  pin: {{link: block, at: [0, 0, 0]}}
loads:
{loads}
responses:
  run:
{response}
"""


def lines(*rows: str, indent: int = 2) -> str:
    """Rows of a list or a mapping, indented."""
    return "\n".join(" " * indent + row for row in rows)
