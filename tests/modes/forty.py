"""A platform on six legs with forty real assemblies, as many as are possible.

Dimensions: Dietmaier, The Stewart-Gough platform of general geometry can have 40 real postures,
Advances in Robot Kinematics 1998.
"""

from __future__ import annotations

FEET = (
    (0.0, 0.0, 0.0),
    (1.107915, 0.0, 0.0),
    (0.549094, 0.756063, 0.0),
    (0.735077, -0.223935, 0.525991),
    (0.514188, -0.526063, -0.368418),
    (0.590473, 0.094733, -0.205018),
)
HEADS = (
    (0.0, 0.0, 0.0),
    (0.542805, 0.0, 0.0),
    (0.956919, -0.528915, 0.0),
    (0.665885, -0.353482, 1.402538),
    (0.478359, 1.158742, 0.107672),
    (-0.137087, -0.235121, 0.353913),
)
LENGTHS = (1.0, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071)


def drawing() -> str:
    """Every rod is drawn along x from its foot, the body at the origin."""
    links = "".join(f", rod{k}: {{}}" for k in range(6))
    joints = ""
    for k, (foot, head, length) in enumerate(zip(FEET, HEADS, LENGTHS, strict=True)):
        tip = [foot[0] + length, foot[1], foot[2]]
        joints += f"  A{k}: {{type: S, links: [ground, rod{k}], point: {list(foot)}}}\n"
        joints += (
            f"  B{k}: {{type: S, links: [rod{k}, body], "
            f"point: {{rod{k}: {tip}, body: {list(head)}}}}}\n"
        )
    return f"format: 1\nlinks: {{body: {{}}{links}}}\njoints:\n{joints}"
