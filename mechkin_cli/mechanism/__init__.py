"""The mechanism in SI units: links, joint pairs, curves, motion, loads and responses, as records.

Knows geometry and mechanics of pairs (`pairs`: one table entry for each); knows nothing of files,
graphs or solving.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.mechanism.constraint import *
    from mechkin_cli.mechanism.curve import *
    from mechkin_cli.mechanism.derived import *
    from mechkin_cli.mechanism.held import *
    from mechkin_cli.mechanism.joint import *
    from mechkin_cli.mechanism.long_run import *
    from mechkin_cli.mechanism.model import (
        UPPER_HALF as UPPER_HALF,
        Amount as Amount,
        Bushing as Bushing,
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
    from mechkin_cli.mechanism.motion import *
    from mechkin_cli.mechanism.pair_type import *
    from mechkin_cli.mechanism.pairs import *
    from mechkin_cli.mechanism.problem import *
    from mechkin_cli.mechanism.quantities import *
    from mechkin_cli.mechanism.relation import *
    from mechkin_cli.mechanism.response import *
    from mechkin_cli.mechanism.track import *
    from mechkin_cli.mechanism.vectors import *
    from mechkin_cli.mechanism.wanted import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "constraint": "Constraint DistanceConstraint InputConstraint PairConstraint",
        "curve": "CoordinateLaw Curve Ends ExpressionOf Interpolation joined_curve LoadLaw "
        "smooth_curve",
        "derived": "COEFFICIENT_KINDS DERIVED_KINDS DRIVEN_KINDS FINITE_KINDS INSTANT_KINDS Input "
        "LEDGER_KINDS ORIENTATION_KINDS POWER_KINDS QUATERNION TRANSMISSION_KINDS accelerated "
        "base_name base_quantity driving_joint hint_in_plane hint_of is_of_motion reference_point",
        "held": "LockedFreedom is_turn is_unnamed slide_name turn_name",
        "joint": "GROUND_NAME Joint counted far_link frame_on is_told is_written stop_of "
        "told_coordinates",
        "long_run": "LongRun in_pieces long_motion with_ends",
        "model": "Amount Bushing Damper Drives JointLoad LinkLoad Load Mechanism RigidLink Spring "
        "Tensor UPPER_HALF Varying diagonal without_effort",
        "motion": "Assembly CellKind Course DrivenInput ExactMotion Limit Moments MotionInputs "
        "ORDERS Parameter Rest SpacedMoments Span",
        "pair_type": "Attached Condition Coordinate Drawing DrawnDirection ELEMENTARY FIRST "
        "FrictionLaw JointType Loss Motion Part Rubbing SECOND Screw rubbing_words screws_at",
        "pairs": "FREE JOINT_TYPES PLANE_JOINT_TYPES PLAY PLAY_ANGLE dimension_of guide_letter "
        "is_angle joint_type seat_letter",
        "problem": "Laws Problem differentiation law_value quantities_read read_by "
        "response_problem undefined_laws",
        "quantities": "ACTUATION BEARING_KINDS REACTION_LEVEL REST_SHARE SELF_LOCKING "
        "TIME_OF_ROW bearing_load coordinate_quantities effort_quantity friction_states read_for "
        "response_quantities resting_quantities strands_of",
        "relation": "Arm Extent Fleet Follower Mesh Relation Swing Tension Term",
        "response": "AnyBalance CrossingEnd Cycle DeadCentreEnd DrivenRows EquilibriumSearch "
        "Flywheel Harmonics LoadWork ResponseProblem SlopeEnd StartValue Stop TurnsEnd",
        "track": "Track",
        "vectors": "Frame GROUND Line Vector ZERO add cross dot eliminated frame_about norm "
        "perpendicular scale subtract turned_shortest turned_tensor unit upright",
        "wanted": "Wanted",
    },
)
