"""`links:` - the rigid bodies: mass, mass centre and inertia in the home drawing."""

from typing import Any, ClassVar

from mechkin_cli.schema.base import Section, refuse
from mechkin_cli.schema.places import NamedOrGiven
from mechkin_cli.schema.scalars import DirectionVector, Inertia, Mass


class InertiaAxes(Section):
    """The axes in which an inertia tensor is written, drawn in ground axes of the home drawing.

    They are normalised, must be square to one another to 1e-9, and z = x cross y.
    """

    advice: ClassVar[dict[str, str]] = {"z": "leave it out: z = x cross y"}

    x: DirectionVector
    """First axis, [x, y, z]."""
    y: DirectionVector
    """Second axis, [x, y, z]."""


class LinkInertia(Section):
    """The inertia tensor about the mass centre; an entry that is left out is zero.

    `xy` is the entry as it stands in the tensor (minus the integral of x*y).
    """

    xx: Inertia = "0"
    """Moment of inertia about x through the mass centre."""
    yy: Inertia = "0"
    """Moment of inertia about y through the mass centre."""
    zz: Inertia = "0"
    """Moment of inertia about z through the mass centre."""
    xy: Inertia = "0"
    """Entry xy of the tensor: minus the integral of x*y."""
    xz: Inertia = "0"
    """Entry xz of the tensor: minus the integral of x*z."""
    yz: Inertia = "0"
    """Entry yz of the tensor: minus the integral of y*z."""
    axes: InertiaAxes | None = None
    """Axes of the tensor; left out, those of the ground in the home drawing."""


class BodyWithMass(Section):
    """What links in space and in a plane have in common."""

    editors: ClassVar[dict[str, Any]] = {
        "dependentRequired": {"mass": ["center_of_mass"], "center_of_mass": ["mass"]}
    }
    advice: ClassVar[dict[str, str]] = {
        "centre_of_mass": "the key is spelled center_of_mass",
        "com": "the key is spelled center_of_mass",
    }

    mass: Mass | None = None
    """Mass of the link; left out, it has none."""

    def check(self) -> None:
        """Mass and centre come together."""
        centre = getattr(self, "center_of_mass", None)
        if self.mass is not None and centre is None:
            raise refuse("mass-without-centre", "a mass needs a center_of_mass", "add it", "mass")
        if self.mass is None and centre is not None:
            hint = "add the mass (0 for none)"
            raise refuse(
                "centre-without-mass", "a center_of_mass needs a mass", hint, "center_of_mass"
            )


class Link(BodyWithMass):
    """A rigid body. All its keys may be left out: `{}` is a link without mass."""

    center_of_mass: NamedOrGiven | None = None
    """Mass centre in the home drawing, [x, y, z] in ground axes or the name of a point of the link;
    left out, the link has no mass."""
    inertia: LinkInertia | None = None
    """Inertia tensor about the mass centre; left out, zero."""
