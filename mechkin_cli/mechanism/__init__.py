"""The mechanism in SI units: links, joint pairs, curves, motion, loads and responses, as records.

Knows geometry and mechanics of pairs (`pairs`: one table entry for each); knows nothing of files,
graphs or solving.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.mechanism.constraint import (
        Constraint as Constraint,
        DistanceConstraint as DistanceConstraint,
        InputConstraint as InputConstraint,
        PairConstraint as PairConstraint,
    )
    from mechkin_cli.mechanism.curve import (
        Curve as Curve,
        Ends as Ends,
        Interpolation as Interpolation,
        LoadLaw as LoadLaw,
        joined_curve as joined_curve,
    )
    from mechkin_cli.mechanism.derived import (
        COEFFICIENT_KINDS as COEFFICIENT_KINDS,
        DERIVED_KINDS as DERIVED_KINDS,
        FINITE_KINDS as FINITE_KINDS,
        INSTANT_KINDS as INSTANT_KINDS,
        LEDGER_KINDS as LEDGER_KINDS,
        ORIENTATION_KINDS as ORIENTATION_KINDS,
        POWER_KINDS as POWER_KINDS,
        QUATERNION as QUATERNION,
        TRANSMISSION_KINDS as TRANSMISSION_KINDS,
        Input as Input,
        accelerated as accelerated,
        base_name as base_name,
        base_quantity as base_quantity,
        driving_joint as driving_joint,
        hint_in_plane as hint_in_plane,
        hint_of as hint_of,
        is_of_motion as is_of_motion,
        reference_point as reference_point,
    )
    from mechkin_cli.mechanism.held import (
        LockedFreedom as LockedFreedom,
        is_turn as is_turn,
        is_unnamed as is_unnamed,
        slide_name as slide_name,
        turn_name as turn_name,
    )
    from mechkin_cli.mechanism.joint import (
        GROUND_NAME as GROUND_NAME,
        Joint as Joint,
        frame_on as frame_on,
        is_written as is_written,
        stop_of as stop_of,
    )
    from mechkin_cli.mechanism.model import (
        Amount as Amount,
        Damper as Damper,
        Drives as Drives,
        JointLoad as JointLoad,
        LinkLoad as LinkLoad,
        Load as Load,
        Mechanism as Mechanism,
        RigidLink as RigidLink,
        Spring as Spring,
        Tensor as Tensor,
        Varying as Varying,
        diagonal as diagonal,
        without_effort as without_effort,
    )
    from mechkin_cli.mechanism.motion import (
        ORDERS as ORDERS,
        Assembly as Assembly,
        CellKind as CellKind,
        Course as Course,
        DrivenInput as DrivenInput,
        ExactMotion as ExactMotion,
        Moments as Moments,
        MotionInputs as MotionInputs,
        Parameter as Parameter,
    )
    from mechkin_cli.mechanism.pair_type import (
        ELEMENTARY as ELEMENTARY,
        FIRST as FIRST,
        SECOND as SECOND,
        Attached as Attached,
        Condition as Condition,
        Coordinate as Coordinate,
        Drawing as Drawing,
        DrawnDirection as DrawnDirection,
        FrictionLaw as FrictionLaw,
        JointType as JointType,
        Motion as Motion,
        Part as Part,
        Rubbing as Rubbing,
        Screw as Screw,
        screws_at as screws_at,
    )
    from mechkin_cli.mechanism.pairs import (
        FREE as FREE,
        JOINT_TYPES as JOINT_TYPES,
        PLANE_JOINT_TYPES as PLANE_JOINT_TYPES,
        dimension_of as dimension_of,
        guide_letter as guide_letter,
        is_angle as is_angle,
        joint_type as joint_type,
        seat_letter as seat_letter,
    )
    from mechkin_cli.mechanism.problem import (
        Laws as Laws,
        Problem as Problem,
        differentiation as differentiation,
        law_value as law_value,
        quantities_read as quantities_read,
        read_by as read_by,
        response_problem as response_problem,
        undefined_laws as undefined_laws,
    )
    from mechkin_cli.mechanism.quantities import (
        ACTUATION as ACTUATION,
        BEARING_KINDS as BEARING_KINDS,
        REACTION_LEVEL as REACTION_LEVEL,
        SELF_LOCKING as SELF_LOCKING,
        TIME_OF_ROW as TIME_OF_ROW,
        bearing_load as bearing_load,
        coordinate_quantities as coordinate_quantities,
        effort_quantity as effort_quantity,
        friction_states as friction_states,
        read_for as read_for,
        response_quantities as response_quantities,
    )
    from mechkin_cli.mechanism.response import (
        AnyBalance as AnyBalance,
        CrossingEnd as CrossingEnd,
        Cycle as Cycle,
        DeadCentreEnd as DeadCentreEnd,
        Flywheel as Flywheel,
        Harmonics as Harmonics,
        LoadWork as LoadWork,
        ResponseProblem as ResponseProblem,
        StartValue as StartValue,
        Stop as Stop,
        TurnsEnd as TurnsEnd,
    )
    from mechkin_cli.mechanism.vectors import (
        GROUND as GROUND,
        ZERO as ZERO,
        Frame as Frame,
        Line as Line,
        Vector as Vector,
        add as add,
        cross as cross,
        dot as dot,
        frame_about as frame_about,
        norm as norm,
        perpendicular as perpendicular,
        scale as scale,
        subtract as subtract,
        turned_shortest as turned_shortest,
        turned_tensor as turned_tensor,
        unit as unit,
        upright as upright,
    )
    from mechkin_cli.mechanism.wanted import Wanted as Wanted

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "constraint": "Constraint DistanceConstraint InputConstraint PairConstraint",
        "curve": "Curve Ends Interpolation LoadLaw joined_curve",
        "derived": "COEFFICIENT_KINDS DERIVED_KINDS FINITE_KINDS INSTANT_KINDS Input LEDGER_KINDS "
        "ORIENTATION_KINDS POWER_KINDS QUATERNION TRANSMISSION_KINDS accelerated base_name "
        "base_quantity driving_joint hint_in_plane hint_of is_of_motion reference_point",
        "held": "LockedFreedom is_turn is_unnamed slide_name turn_name",
        "joint": "GROUND_NAME Joint frame_on is_written stop_of",
        "model": "Amount Damper Drives JointLoad LinkLoad Load Mechanism RigidLink Spring Tensor "
        "Varying diagonal without_effort",
        "motion": "Assembly CellKind Course DrivenInput ExactMotion Moments MotionInputs ORDERS "
        "Parameter",
        "pair_type": "Attached Condition Coordinate Drawing DrawnDirection ELEMENTARY FIRST "
        "FrictionLaw JointType Motion Part Rubbing SECOND Screw screws_at",
        "pairs": "FREE JOINT_TYPES PLANE_JOINT_TYPES dimension_of guide_letter is_angle joint_type "
        "seat_letter",
        "problem": "Laws Problem differentiation law_value quantities_read read_by "
        "response_problem undefined_laws",
        "quantities": "ACTUATION BEARING_KINDS REACTION_LEVEL SELF_LOCKING TIME_OF_ROW "
        "bearing_load coordinate_quantities effort_quantity friction_states read_for "
        "response_quantities",
        "response": "AnyBalance CrossingEnd Cycle DeadCentreEnd Flywheel Harmonics LoadWork "
        "ResponseProblem StartValue Stop TurnsEnd",
        "vectors": "Frame GROUND Line Vector ZERO add cross dot frame_about norm perpendicular "
        "scale subtract turned_shortest turned_tensor unit upright",
        "wanted": "Wanted",
    },
)
