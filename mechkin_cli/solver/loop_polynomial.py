"""The one equation to which a small loop is reduced, each of its roots one assembly.

- A sphere and three motions: `sphere_loop`.
- A leg and one motion: the distance of two points, of second degree.
- Two motions in a plane and a turn square to it at the closing joint: the first keeps the distance
  of that joint's point from its axis, or line; of second degree.
- Two parallel turns and a slide square to them at the closing joint: the sum of the turns is given,
  so that the offset from the slide's line is of first degree in (cos, sin) of one of them.
- A turn through the centre of two crossed axes at the closing joint (Hooke): their angle.
- Two turns and a turn at the closing joint, axes through one point, or with slides along every axis
  (RCCC): the direction of the closing axis, R(t1) R(t2) z2 = z1, hence z_t1 . R(t2) z2 =
  z_t1 . z1, of first degree in (cos, sin).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli import tolerances
from mechkin_cli.mechanism.vectors import Vector, add, cross, dot, norm, scale, subtract
from mechkin_cli.solver.loop_chain import Chain, Motion, are_parallel, square_to
from mechkin_cli.solver.real_roots import Trigonometric
from mechkin_cli.solver.sphere_loop import Reduced, heights, squares, with_sphere

if TYPE_CHECKING:
    from mechkin_cli.mechanism.frames import Frame

MOST_OF_A_PLANE_LOOP = 2
"""Two circles, or a circle and a line."""

MOST_BY_DIRECTION = 2
"""Two roots of the direction's equation."""


def reduced(chain: Chain) -> Reduced | None:
    """The equation of a chain; None for loops of other kinds."""
    if chain.distance is not None:
        return _of_leg(chain)
    motions = [freedom.motion for freedom in chain.joint.type.chain]
    if motions[:3] == ["ball"] * 3:
        slides = _slides(chain, len(motions) - 3)
        return with_sphere((*chain.motions, *slides), chain)
    if motions == ["turn"] and len(chain.motions) == 2 and _is_planar(chain):
        return _in_plane(chain)
    if motions == ["turn"] and len(chain.motions) == 2 and _is_spherical(chain):
        return _directed(chain)
    if motions == ["turn", "slide"] and len(chain.motions) == 4:
        return _directed(chain)
    if motions == ["slide"]:
        return _sliding(chain)
    if motions == ["turn", "turn"]:
        return _crossed(chain)
    return None


def _slides(chain: Chain, count: int) -> tuple[Motion, ...]:
    """The closing joint's slides beside its sphere."""
    frame = chain.second
    axes = {0: (), 1: (frame.z,), 2: (frame.x, frame.y)}[count]
    return tuple(Motion(True, axis, frame.o) for axis in axes)


def _of_leg(chain: Chain) -> Reduced | None:
    """|x p - a|^2 = distance^2."""
    if len(chain.motions) != 1 or chain.distance is None:
        return None
    (x,) = chain.motions
    constant, first, second = squares(x, chain.second.o, chain.first.o)
    row = (constant - chain.distance * chain.distance, first, second)
    return Reduced(row if x.slide else Trigonometric(*row), 1.0, 2)


def _is_planar(chain: Chain) -> bool:
    """Whether all turns are about, and all slides square to, the closing joint's axis, and its two
    halves lie in one plane."""
    normal, limit = chain.first.z, tolerances.PARALLEL
    if dot(normal, chain.second.z) < 0.0 or not are_parallel(normal, chain.second.z, limit):
        return False
    if abs(dot(normal, subtract(chain.first.o, chain.second.o))) > limit:
        return False
    if any(x.slide and abs(dot(x.axis, normal)) > limit for x in chain.motions):
        return False
    return all(x.slide or are_parallel(x.axis, normal, limit) for x in chain.motions)


def _is_spherical(chain: Chain) -> bool:
    """Whether the turns' axes and both halves of the closing joint meet in one point."""
    if any(x.slide for x in chain.motions):
        return False
    one, other = chain.motions
    across = cross(one.axis, other.axis)
    square = dot(across, across)
    if square < tolerances.ROOT_REGULAR**2:
        return False
    between = subtract(other.point, one.point)
    along = dot(cross(between, other.axis), across) / square
    centre = subtract(one.point, scale(-along, one.axis))
    limit = tolerances.PARALLEL
    heights = []
    for axis, point in (
        (other.axis, other.point),
        (chain.first.z, chain.first.o),
        (chain.second.z, chain.second.o),
    ):
        arm = subtract(point, centre)
        heights.append(dot(arm, axis))
        if norm(square_to(axis, arm)) > limit:
            return False
    return abs(heights[1] - heights[2]) < limit


def _in_plane(chain: Chain) -> Reduced:
    """The first motion keeps the distance from its axis, or from its line, of the closing point."""
    x1, x2 = chain.motions
    if x1.slide:
        across = cross(chain.first.z, x1.axis)
        constant, *turned = heights(x2, chain.second.o, across)
        constant -= dot(across, chain.first.o)
    else:
        constant, *turned = squares(x2, chain.second.o, x1.point)
        arm = subtract(chain.first.o, x1.point)
        constant -= dot(arm, arm)
    row = (constant, turned[0], turned[1])
    regularity = 1.0 if x1.slide or x2.slide else min(norm(_between(x1, x2)), 1.0)
    return Reduced(row if x2.slide else Trigonometric(*row), regularity, MOST_OF_A_PLANE_LOOP)


def _between(x1: Motion, x2: Motion) -> Vector:
    """From one parallel axis to another."""
    return square_to(x1.axis, subtract(x2.point, x1.point))


def _directed(chain: Chain) -> Reduced | None:
    """By the direction of the closing axis."""
    turns = [x for x in chain.motions if not x.slide]
    if len(turns) != 2:
        return None
    one, other = turns
    arm = square_to(other.axis, chain.second.z)
    still = dot(other.axis, chain.second.z) * dot(one.axis, other.axis)
    constant = still - dot(one.axis, chain.first.z)
    turned = dot(one.axis, arm), dot(one.axis, cross(other.axis, arm))
    # sines of the angles between axes: of parallel ones nothing can be told
    sines = arm, square_to(one.axis, chain.first.z), square_to(one.axis, other.axis)
    regularity = min(norm(sine) for sine in sines)
    return Reduced(Trigonometric(constant, *turned), regularity, MOST_BY_DIRECTION)


def _sliding(chain: Chain) -> Reduced | None:
    """By the offset from the closing slide's line, in a plane."""
    if len(chain.motions) != 2 or any(x.slide for x in chain.motions):
        return None
    (one, other), limit = chain.motions, tolerances.PARALLEL
    normal, first, second = one.axis, chain.first, chain.second
    tilt = subtract(first.components(normal), second.components(normal))
    heights = dot(normal, first.z), dot(normal, subtract(first.o, second.o))
    if not are_parallel(normal, other.axis, limit) or norm(tilt) > limit:
        return None
    if max(abs(height) for height in heights) > limit:
        return None
    # the second link's orientation is known: where its point is from the other turn's axis
    arm = _frame_vector(first, second.components(subtract(second.o, other.point)))
    between = _between(one, other)
    across = cross(normal, first.z)
    constant = dot(across, arm) + dot(across, subtract(one.point, first.o))
    turned = dot(across, between), dot(across, cross(normal, between))
    regularity = min(norm(between), 1.0)
    return Reduced(Trigonometric(constant, *turned), regularity, MOST_OF_A_PLANE_LOOP)


def _frame_vector(frame: Frame, components: Vector) -> Vector:
    x, y, z = components
    return add(add(scale(x, frame.x), scale(y, frame.y)), scale(z, frame.z))


def _crossed(chain: Chain) -> Reduced | None:
    """By the angle between the two axes of the closing joint, about its centre."""
    if len(chain.motions) != 1 or chain.motions[0].slide:
        return None
    (x,), limit = chain.motions, tolerances.PARALLEL
    for end in (chain.first, chain.second):
        if norm(square_to(x.axis, subtract(end.o, x.point))) > limit:
            return None
    if abs(dot(x.axis, subtract(chain.first.o, chain.second.o))) > limit:
        return None
    joint, arm = chain.joint, square_to(x.axis, chain.second.z)
    still = dot(x.axis, chain.second.z) * dot(x.axis, chain.first.z)
    constant = still - dot(joint.on_first.z, joint.on_second.z)
    turned = dot(chain.first.z, arm), dot(chain.first.z, cross(x.axis, arm))
    regularity = min(norm(arm), norm(square_to(x.axis, chain.first.z)))
    return Reduced(Trigonometric(constant, *turned), regularity, MOST_BY_DIRECTION)
