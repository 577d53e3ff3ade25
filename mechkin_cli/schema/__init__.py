"""What may be written in a mechanism file of format 1: one chapter for each section.

The records are the contract of the file: keys, kinds of values, fixed lengths, names. Numbers stay
text; units, expressions and references are checked in `building`. The same records give editors
their JSON Schema.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.schema.base import *
    from mechkin_cli.schema.couplings import *
    from mechkin_cli.schema.curves import *
    from mechkin_cli.schema.cylinders import *
    from mechkin_cli.schema.file import *
    from mechkin_cli.schema.json_schema import *
    from mechkin_cli.schema.limits import *
    from mechkin_cli.schema.links_joints import *
    from mechkin_cli.schema.loads import *
    from mechkin_cli.schema.motion import *
    from mechkin_cli.schema.plane import *
    from mechkin_cli.schema.renamed import *
    from mechkin_cli.schema.responses import *
    from mechkin_cli.schema.scalars import *
    from mechkin_cli.schema.study import *
    from mechkin_cli.schema.tables import *
    from mechkin_cli.schema.validation import *
    from mechkin_cli.schema.view import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "base": "OLD_KEYS Renamed fields_of section_of section_with",
        "couplings": "AnyCoupling BeltCoupling CableCoupling ChainCoupling Flanks FollowerSection "
        "FunctionCoupling GearCoupling LinearCoupling PathPart RackCoupling ScrewCoupling "
        "TableCoupling",
        "curves": "Curve Surface",
        "cylinders": "Cylinder",
        "file": "AnyFile MechanismFile",
        "json_schema": "SCHEMAS json_schema_text",
        "limits": "LimitSection",
        "links_joints": "AnyAxisJoint AnyJoint AxisJoint ChainRow CylinderPlaneJoint HelicalJoint "
        "InertiaAxes Link LinkInertia PlanarJoint PointJoint SlottedSphereJoint "
        "SphereCylinderJoint SphereGrooveJoint SpherePlaneJoint TwoTurnJoint UniversalJoint "
        "WeldJoint",
        "loads": "AnyLoad BushingBetweenLinks BushingDamping BushingFree BushingStiffness "
        "DamperAtJoint DamperBetweenPoints FallingCoefficient ForceOnJoint ForceOnLink "
        "FrictionAtJoint Gravity SpringAtJoint SpringBetweenPoints TableValue TorqueOnJoint "
        "TorqueOnLink",
        "motion": "AssemblySection ConstantAcceleration ConstantRate ExpressionLaw FollowingInput "
        "HeldInput InputMotion Law ListedInput MotionSection Polynomial Rise Segment Sequence Sine "
        "SweptInput TableLaw TimeSection WithRates",
        "plane": "in_space",
        "renamed": "up_to_date",
        "responses": "CoordinateWindow Equilibrium HeldCoordinate ListedTime Response",
        "scalars": "DirectionOfLink JoinedTable PointOfLink UnitsSection",
        "study": "StudyFile validate_study",
        "tables": "Coefficients",
        "validation": "InvalidDataError RESERVED form_of validate",
        "view": "PartBetween ShapeOfLink ViewSection",
    },
)
