"""What may be written in a mechanism file of format 1: one chapter for each section.

The records are the contract of the file: keys, kinds of values, fixed lengths, names. Numbers stay
text; units, expressions and references are checked in `building`. The same records give editors
their JSON Schema.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.schema.base import fields_of as fields_of, section_of as section_of
    from mechkin_cli.schema.couplings import (
        AnyCoupling as AnyCoupling,
        GearCoupling as GearCoupling,
        LinearCoupling as LinearCoupling,
        RackCoupling as RackCoupling,
    )
    from mechkin_cli.schema.file import (
        AnyFile as AnyFile,
        MechanismFile as MechanismFile,
    )
    from mechkin_cli.schema.json_schema import (
        SCHEMAS as SCHEMAS,
        json_schema_text as json_schema_text,
    )
    from mechkin_cli.schema.links_joints import (
        AnyAxisJoint as AnyAxisJoint,
        AnyJoint as AnyJoint,
        AxisJoint as AxisJoint,
        ChainRow as ChainRow,
        CylinderPlaneJoint as CylinderPlaneJoint,
        HelicalJoint as HelicalJoint,
        Link as Link,
        LinkInertia as LinkInertia,
        PlanarJoint as PlanarJoint,
        PointJoint as PointJoint,
        SlottedSphereJoint as SlottedSphereJoint,
        SphereCylinderJoint as SphereCylinderJoint,
        SphereGrooveJoint as SphereGrooveJoint,
        SpherePlaneJoint as SpherePlaneJoint,
        TwoTurnJoint as TwoTurnJoint,
        UniversalJoint as UniversalJoint,
        WeldJoint as WeldJoint,
    )
    from mechkin_cli.schema.loads import (
        AnyLoad as AnyLoad,
        DamperAtJoint as DamperAtJoint,
        DamperBetweenPoints as DamperBetweenPoints,
        FallingCoefficient as FallingCoefficient,
        ForceOnJoint as ForceOnJoint,
        ForceOnLink as ForceOnLink,
        FrictionAtJoint as FrictionAtJoint,
        Gravity as Gravity,
        SpringAtJoint as SpringAtJoint,
        SpringBetweenPoints as SpringBetweenPoints,
        TableValue as TableValue,
        TorqueOnJoint as TorqueOnJoint,
        TorqueOnLink as TorqueOnLink,
    )
    from mechkin_cli.schema.motion import (
        AssemblySection as AssemblySection,
        ConstantAcceleration as ConstantAcceleration,
        ConstantRate as ConstantRate,
        Cycloidal as Cycloidal,
        FollowingInput as FollowingInput,
        Harmonic as Harmonic,
        HeldInput as HeldInput,
        InputMotion as InputMotion,
        Law as Law,
        ListedInput as ListedInput,
        MotionSection as MotionSection,
        Polynomial as Polynomial,
        SweptInput as SweptInput,
        TableLaw as TableLaw,
        TimeSection as TimeSection,
        WithRates as WithRates,
    )
    from mechkin_cli.schema.plane import in_space as in_space
    from mechkin_cli.schema.responses import (
        HeldCoordinate as HeldCoordinate,
        ListedTime as ListedTime,
    )
    from mechkin_cli.schema.scalars import (
        DirectionOfLink as DirectionOfLink,
        JoinedTable as JoinedTable,
        PointOfLink as PointOfLink,
        UnitsSection as UnitsSection,
    )
    from mechkin_cli.schema.study import StudyFile as StudyFile, validate_study as validate_study
    from mechkin_cli.schema.tables import Coefficients as Coefficients
    from mechkin_cli.schema.validation import (
        InvalidDataError as InvalidDataError,
        validate as validate,
    )
    from mechkin_cli.schema.view import ShapeOfLink as ShapeOfLink, ViewSection as ViewSection

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "base": "fields_of section_of",
        "couplings": "AnyCoupling GearCoupling LinearCoupling RackCoupling",
        "file": "AnyFile MechanismFile",
        "json_schema": "SCHEMAS json_schema_text",
        "links_joints": "AnyAxisJoint AnyJoint AxisJoint ChainRow CylinderPlaneJoint HelicalJoint "
        "Link LinkInertia PlanarJoint PointJoint SlottedSphereJoint SphereCylinderJoint "
        "SphereGrooveJoint SpherePlaneJoint TwoTurnJoint UniversalJoint WeldJoint",
        "loads": "AnyLoad DamperAtJoint DamperBetweenPoints FallingCoefficient ForceOnJoint "
        "ForceOnLink FrictionAtJoint Gravity SpringAtJoint SpringBetweenPoints TableValue "
        "TorqueOnJoint TorqueOnLink",
        "motion": "AssemblySection ConstantAcceleration ConstantRate Cycloidal FollowingInput "
        "Harmonic HeldInput InputMotion Law ListedInput MotionSection Polynomial SweptInput "
        "TableLaw TimeSection WithRates",
        "plane": "in_space",
        "responses": "HeldCoordinate ListedTime",
        "scalars": "DirectionOfLink JoinedTable PointOfLink UnitsSection",
        "study": "StudyFile validate_study",
        "tables": "Coefficients",
        "validation": "InvalidDataError validate",
        "view": "ShapeOfLink ViewSection",
    },
)
