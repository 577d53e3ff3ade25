"""The compiled core; see python/module.cpp. Batched arrays are (columns, rows), C-contiguous
float64; in double-double (columns, 2, rows), high and low."""

from collections.abc import Callable, Sequence
from enum import IntEnum, IntFlag
from typing import Any, Final, TypedDict

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Triple = Sequence[float]

widest: Final[int]
instructions: Final[dict[int, str]]

class JointTableRow(TypedDict):
    letter: str
    code: int
    equations: int
    lengths: int

class TreeTableRow(TypedDict):
    code: int
    freedoms: int
    states: int
    slides: int

CONSTANT_LENGTH: Final[int]
CONSTANT_SIZE: Final[int]

class TreeCode(IntEnum):
    R = 0
    P = 1
    H = 2
    C = 3
    S = 4
    W = 5
    L = 6
    G = 7
    A = 8

class FreeCode(IntEnum):
    ALONG = ...
    SQUARE = ...
    ALL = ...

class ReadCode(IntEnum):
    OUTPUT = 0
    ANGLE = 1
    TIME = 2

class LoadCode(IntEnum):
    FORCE_GROUND = 0
    FORCE_LINK = 1
    TORQUE_GROUND = 2
    TORQUE_LINK = 3
    COORDINATE = 4
    SPRING = 5
    DAMPER = 6
    COORDINATE_SPRING = 7
    COORDINATE_DAMPER = 8
    BUSHING = ...
    BUSHING_DAMPER = ...

class OutputCode(IntEnum):
    STATE = 0
    RATE = 1
    ACCELERATION = 2
    CLOSING = 3
    SLIP = 4
    POINT = 5
    VECTOR = 6
    OMEGA = 7
    ALPHA = 8
    JOINT_FORCE = 9
    JOINT_MOMENT = 10
    JOINT_MOMENT_ORIGIN = 11
    EFFORT = 12
    SHAKING_FORCE = 13
    SHAKING_MOMENT = 14
    INERTIA_FORCE = 15
    INERTIA_MOMENT = 16
    HOLDING_MOMENT = 17
    REACTION_LEVEL = ...
    KINETIC_ENERGY = 20
    POTENTIAL_ENERGY = 21
    LOAD_POWER = 22
    MOTOR = ...
    ACTUATION = ...
    TOTAL_FORCE = ...
    TOTAL_MOMENT = ...
    CARRIED_FORCE = ...
    CARRIED_MOMENT = ...
    JERK = 18
    NORMAL_LOAD = ...
    FRICTION_FORCE = ...
    FRICTION_MOMENT = ...
    FRICTION_POWER = ...
    FRICTION_STATE = ...
    SELF_LOCKING = ...
    MULTIPLIER = ...
    MESH_FORCE = ...
    TENSION = ...
    BUSHING_FORCE = ...
    BUSHING_MOMENT = ...
    BUSHING_SHIFT = ...
    BUSHING_TURN = ...
    REST_SHARE = ...

class ContactCode(IntEnum):
    RADIAL = 0
    ALONG = 1
    TOTAL = 2
    TRANSMITTED = 3

class FrictionState(IntEnum):
    DECIDED = 0
    AT_REST = 1
    NOT_UNIQUE = 2
    NOT_SOLVED = 3

class FrictionTold(IntEnum):
    NOTHING = 0
    FORCE = 1
    OPEN = 2
    IMMOBILE = 3

class Demand(IntFlag):
    POSITION = 0
    VELOCITY = 1
    ACCELERATION = 2
    FORCES = 4
    CONDITION = 8
    POWER = 16
    JERK = 32
    SINGULAR = 64

class RowFlag(IntFlag):
    GOOD = 0
    NOT_CONVERGED = 1
    SIDE_CONDITION = 2

class TrackEnd(IntEnum):
    FINISHED = 0
    STALLED = 1
    EXHAUSTED = 2
    START_NOT_CLOSED = 3

class PassageEnd(IntEnum):
    THROUGH = 0
    DEAD_CENTRE = 1
    BRANCH_POINT = 2
    LOST = 3

class Operation(IntEnum):
    SIN = 0
    COS = 1
    TAN = 2
    ASIN = 3
    ACOS = 4
    ATAN = 5
    ATAN2 = 6
    EXP = 7
    LOG = 8
    POWER = 9

def joint_table() -> list[JointTableRow]: ...
def tree_table() -> list[TreeTableRow]: ...
def elementwise(operation: int, x: Floats, y: Floats, lanes: int = 0) -> Floats: ...
def number_text(x: float, significant_digits: int = 0) -> str: ...

WordColumn = tuple[NDArray[np.int32], Sequence[str]]
DecimalColumn = tuple[Floats, bool, int, bool]

def decimal_texts(column: DecimalColumn) -> list[str]: ...
def csv_header(labels: Sequence[str], decimal_comma: bool = False) -> str: ...
def csv_lines(
    columns: Sequence[Floats | WordColumn],
    first: int,
    room: NDArray[np.uint8],
    significant_digits: int = 0,
    quoted_empty: bool = False,
    decimal_comma: bool = False,
    threads: int = 1,
) -> tuple[int, list[tuple[int, int]]]: ...
def json_lines(
    keys: Sequence[str],
    columns: Sequence[Floats | WordColumn],
    first: int,
    room: NDArray[np.uint8],
    whole: Sequence[bool],
    threads: int = 1,
) -> tuple[int, list[tuple[int, int]]]: ...
def markdown_text(
    headers: Sequence[str], columns: Sequence[DecimalColumn | WordColumn], threads: int = 1
) -> bytes: ...
def json_list(column: Floats | WordColumn, threads: int = 1) -> bytes: ...
def extremes(numbers: Floats) -> tuple[int, int, float, float]:
    """Of some numbers (rows,): how many are there (no nan), how many are infinite, the largest and
    the smallest; -inf and inf of none."""

def available_processors() -> int: ...
def keep_freed_memory(megabytes: int) -> None:
    """Lets the process keep so much freed memory for its next arrays; only glibc gives it back."""

def output_width(type: int) -> int: ...
def output_demand(type: int, order: int = 0) -> Demand: ...
def enclose(plan: Plan, **arguments: Any) -> None: ...

class Tape:
    def __init__(
        self,
        inputs: int,
        constants: Floats,
        operations: NDArray[np.uint8],
        operands: NDArray[np.int32],
        outputs: NDArray[np.int32],
        guards: NDArray[np.int32],
        expected: NDArray[np.uint8],
        advice: NDArray[np.uint8],
    ) -> None: ...
    def replay(self, inputs: Floats, lanes: int = 0) -> tuple[Floats, NDArray[np.uint8]]: ...
    def replay_precise(
        self, inputs: Floats, second: Floats | None = None, lanes: int = 0
    ) -> tuple[Floats, NDArray[np.uint8]]: ...
    def jets(self, inputs: Floats, ways: Floats) -> Floats: ...

class Course:
    def __init__(
        self,
        tape: Tape,
        pieces: Sequence[tuple[int, int, float, float, float, float]],
        constants: Floats,
        ways: Floats,
        units: Floats,
        parameter: Floats,
    ) -> None: ...
    def at(self, piece: int, sigma: float) -> Floats: ...
    def sigma(self, piece: int, parameter: float) -> float: ...
    def parameter(self, piece: int, sigma: float) -> float: ...

class PlanBuilder:
    def __init__(self, length: float, origin: Triple, size: float) -> None: ...
    @property
    def states(self) -> int: ...
    @property
    def columns(self) -> int: ...
    def add_tree_joint(self, type: int, parent: int, pitch: float, at: Sequence[float]) -> None: ...
    def add_closing_joint(
        self,
        type: int,
        first: int,
        second: int,
        on_first: Sequence[float],
        on_second: Sequence[float],
        parameter: float,
        loop: Sequence[tuple[int, float]],
    ) -> None: ...
    def add_hung_links(
        self,
        body: int,
        rod: int,
        first: int,
        second: int,
        on_first: Sequence[float],
        on_second: Sequence[float],
        length: float,
        line: Triple,
        slide_sign: float,
        loop: Sequence[tuple[int, float]],
    ) -> None: ...
    def add_function(
        self,
        arguments: int,
        curves: Sequence[tuple[int, bool, int]],
        knots: Sequence[float],
        constants: Sequence[float],
        operations: Sequence[int],
        operands: Sequence[tuple[int, int, int]],
        instructions: Sequence[int],
        outputs: Sequence[int],
        output_ends: Sequence[int],
    ) -> int: ...
    def add_relation(
        self,
        length: bool,
        terms: Sequence[tuple[int, float, int, int, int]],
        factors: Sequence[float],
        arguments: Sequence[float],
        sum: float,
    ) -> None: ...
    def add_mesh(
        self,
        carrier: int,
        point: Triple,
        along: Triple,
        apart: Triple,
        path: Sequence[tuple[int, float]],
    ) -> None: ...
    def add_force(self, point: Triple, along: Triple, apart: Triple) -> None: ...
    def add_place(
        self, reference: int, first: int, second: int, point_on: int, point: Triple, sign: float
    ) -> int: ...
    def add_axis(
        self, place: int, slide: bool, link: int, vector: Triple, other: int, other_vector: Triple
    ) -> int: ...
    def set_course(self, joint: int, function: int, axes: Sequence[int]) -> None: ...
    def add_free_motion(
        self, place: int, slide: bool, code: int, link: int, vector: Triple
    ) -> None: ...
    def add_block(
        self,
        closing_joints: int,
        joints: Sequence[int],
        unknown: Sequence[int],
        charts: int = 0,
    ) -> None: ...
    def set_rest(self, joints: Sequence[int]) -> None: ...
    def add_input(self, column: int, axis: int, scale: float) -> None: ...
    def set_inertia(
        self, link: int, mass: float, centre: Triple, tensor: Sequence[float]
    ) -> None: ...
    def set_gravity(self, g: Triple) -> None: ...
    def add_load(
        self,
        type: int,
        link: int,
        other: int,
        freedom: int,
        point: Triple,
        other_point: Triple,
        vector: Triple,
        varying: bool = False,
    ) -> None: ...
    def add_bushing(
        self,
        damps: bool,
        first: int,
        second: int,
        on_first: Sequence[float],
        on_second: Sequence[float],
        matrix: Sequence[float],
        free: Sequence[float],
    ) -> None: ...
    def set_load_program(
        self,
        reads: Sequence[tuple[int, int, int, int, int]],
        numbers: Sequence[float],
        curves: Sequence[tuple[int, float, float, int]],
        knots: Sequence[float],
        constants: Sequence[float],
        operations: Sequence[int],
        operands: Sequence[tuple[int, int, int]],
        outputs: Sequence[int],
        kinks: Sequence[int],
    ) -> None: ...
    def set_driven(self, inputs: int) -> None: ...
    def add_actuator(self, axis: int, reference: int, freedom: int) -> None: ...
    def add_input_constraint(self, input: int, leader: int) -> None: ...
    def add_friction(
        self,
        place: int,
        turns: int,
        slides: int,
        link: int,
        falls: bool,
        axis: Triple,
        radius: float,
        pitch: float,
        at_rest: float,
        sliding: float,
        speed: float,
        course: int,
    ) -> None: ...
    def add_contact(
        self,
        code: int,
        weight: float,
        share: float,
        tilt: float,
        roll: float,
        direction: Triple,
    ) -> None: ...
    def add_size_point(self, link: int, point: Triple) -> None: ...
    def finish(self) -> Plan: ...

class Outputs:
    def __init__(
        self, plan: Plan, records: Sequence[tuple[int, int, int, int, Triple, float]]
    ) -> None: ...
    @property
    def slots(self) -> int: ...
    @property
    def demand(self) -> Demand: ...
    @property
    def constants(self) -> Floats: ...
    def with_constants(self, constants: Floats) -> Outputs: ...

class Plan:
    @property
    def states(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def charts(self) -> int: ...
    @property
    def inputs(self) -> int: ...
    @property
    def load_values(self) -> int: ...
    @property
    def input_constraints(self) -> int: ...
    @property
    def blocks(self) -> int: ...
    @property
    def equations(self) -> int: ...
    @property
    def size(self) -> float: ...
    @property
    def constants(self) -> Floats: ...
    def with_constants(self, constants: Floats) -> Plan: ...
    def with_size(self, size: float) -> Plan: ...
    def assembly_size(
        self,
        *,
        inputs: Floats,
        guess: Floats,
        iterations: int = 0,
        tests: tuple[float, float, float],
    ) -> float: ...
    def run(
        self,
        *,
        inputs: Floats,
        guess: Floats,
        rates: Floats | None = None,
        accelerations: Floats | None = None,
        jerks: Floats | None = None,
        constraint_rates: Floats | None = None,
        turned: Floats | None = None,
        chart: Floats | None = None,
        chart_origin: Floats | None = None,
        chart_place: Floats | None = None,
        chart_rates: Floats | None = None,
        chart_accelerations: Floats | None = None,
        friction_told: Floats | None = None,
        whole: Floats | None = None,
        full: Floats | None = None,
        time: Floats | None = None,
        outputs: Outputs | None = None,
        states: Floats,
        values: Floats | None = None,
        first: Floats | None = None,
        second: Floats | None = None,
        residual: Floats,
        correction: Floats,
        side: Floats | None = None,
        condition: Floats | None = None,
        power_error: Floats | None = None,
        flags: NDArray[np.uint8],
        loads: Floats | None = None,
        chart_forces: Floats | None = None,
        turn: Floats | None = None,
        undefined: NDArray[np.uint8] | None = None,
        demand: int = 0,
        shift: int = 0,
        iterations: int = 0,
        tests: tuple[float, float, float],
        only: int | None = None,
        limit: Floats | None = None,
        most_condition: tuple[float] | None = None,
        lanes: int = 0,
        threads: int = 1,
    ) -> bool: ...
    def run_precise(
        self,
        *,
        inputs: Floats | None,
        guess: Floats | None,
        rates: Floats | None = None,
        accelerations: Floats | None = None,
        jerks: Floats | None = None,
        constraint_rates: Floats | None = None,
        turned: Floats | None = None,
        chart: Floats | None = None,
        chart_rates: Floats | None = None,
        chart_accelerations: Floats | None = None,
        friction_told: Floats | None = None,
        whole: Floats | None = None,
        full: Floats | None = None,
        time: Floats | None = None,
        outputs: Outputs | None = None,
        low: Floats | None = None,
        low_outputs: Floats | None = None,
        states: Floats,
        values: Floats | None = None,
        first: Floats | None = None,
        second: Floats | None = None,
        residual: Floats,
        correction: Floats,
        side: Floats | None = None,
        power_error: Floats | None = None,
        flags: NDArray[np.uint8],
        loads: Floats | None = None,
        chart_forces: Floats | None = None,
        undefined: NDArray[np.uint8] | None = None,
        demand: int = 0,
        shift: int = 0,
        iterations: int = 0,
        tests: tuple[float, float, float],
        lanes: int = 0,
        threads: int = 1,
    ) -> None: ...
    def balance(
        self,
        *,
        free: Sequence[tuple[int, int, float]],
        cyclic: Sequence[int],
        inputs: Floats,
        states: Floats,
        stiffness: Floats,
        turned: Floats,
        time: Floats,
        constraint_rates: Floats | None = None,
        given: int = 0,
        known: int = 0,
        limits: tuple[float, float, float, float],
        steps: int,
        outputs: Outputs,
        iterations: int = 0,
        tests: tuple[float, float, float],
        lanes: int = 0,
        threads: int = 1,
    ) -> int: ...
    def search(
        self,
        *,
        block: int,
        inputs: Floats,
        states: Floats,
        residual: Floats,
        flags: NDArray[np.uint8],
        iterations: int = 0,
        tests: tuple[float],
        lanes: int = 0,
        threads: int = 1,
    ) -> None: ...

class VariantEnd(IntEnum):
    COMPLETE = 0
    OTHER_WAY = 1
    LOST = 2
    INCOMPLETE = 3

class Variants:
    """Many variants of one plan; see core/stepping/variants.hpp. Tables are (inputs, rows)."""

    def __init__(
        self,
        *,
        tape: Tape,
        plan: Plan,
        outputs: Outputs,
        parameters: Floats,
        inputs: Floats,
        whole: Floats,
        full: Floats,
        time: Floats,
        rates: Floats,
        accelerations: Floats,
        jerks: Floats,
        state: Floats,
        size: float,
        start_row: int,
        demand: int,
        iterations: int,
        continuation: StepLimits,
        following: StepLimits,
        angles: Sequence[tuple[int, int, bool]],
        half_turn_side: float,
        ways: Sequence[tuple[int, Sequence[int], Floats, Course | None]] = ...,
    ) -> None: ...
    def run(
        self, parameters: Floats, lanes: int = 0, threads: int = 1
    ) -> tuple[Floats, Floats, Floats, NDArray[np.int32]]:
        """Outputs (variants, slots, rows), residual and condition (variants, rows), ends.

        `parameters` (parameters, variants); nan where a variant is not complete.
        """
    def start(self, parameters: Floats) -> tuple[int, float, Floats]:
        """How the continuation ended, size (m) and states of one variant's first assembly."""

class Positions:
    """Single positions near known rows; see core/stepping/positions.hpp. Tables are
    (columns, rows)."""

    def __init__(
        self,
        *,
        plan: Plan,
        outputs: Outputs,
        inputs: Floats,
        whole: Floats,
        rates: Floats,
        accelerations: Floats,
        jerks: Floats,
        states: Floats,
        turns: Floats,
        demand: int,
        iterations: int,
        limits: StepLimits,
        angles: Sequence[tuple[int, int, bool]],
    ) -> None: ...
    def solve(
        self, inputs: Sequence[float], whole: Sequence[float], full: Sequence[float]
    ) -> tuple[list[float], float] | None:
        """The outputs' slots in SI, and the condition where it is demanded, else 0; None where the
        branch does not lead there."""

class StepLimits:
    """What a step along a path may do; see StepLimits in core/stepping/stepper.hpp.

    ValueError for a cosine beyond 1, another number below 0 or nan, more than a million steps.
    """

    def __init__(
        self,
        *,
        turn_cosine: float,
        turn: float,
        bend: float,
        jump: float,
        infill: float,
        longest_step: float,
        least_step: float,
        most_steps: int,
        tight: float,
        coarse: float,
        accept: float,
        pivot: float,
        iterations: int,
        same_line: float,
        knot: float,
        corner_cosine: float,
        stray: float,
        angle_step: float,
        angle_miss: float,
        angle_bend: float,
        plan_step: float,
        arc_pivot: float,
        radius: float,
        narrow: float,
        arc_steps: int,
        arc_work: float,
        straight: bool,
    ) -> None: ...

class Node:
    """A closed place on a branch with its derivatives by sigma.

    `first` and `second` are of the columns; per block `side` (sign of a square block's determinant)
    and `pivot` (the least one); `jacobian` has the blocks' matrices one after the other.
    """

    @property
    def sigma(self) -> float: ...
    @property
    def correction(self) -> float: ...
    @property
    def inputs(self) -> Floats: ...
    @property
    def state(self) -> Floats: ...
    @property
    def first(self) -> Floats: ...
    @property
    def second(self) -> Floats: ...
    @property
    def side(self) -> Floats: ...
    @property
    def pivot(self) -> Floats: ...
    @property
    def jacobian(self) -> Floats: ...
    @property
    def turn(self) -> Floats: ...

class Stepper:
    """One step along a path: predict, close, judge; see core/stepping/stepper.hpp."""

    @staticmethod
    def straight(
        plan: Plan, inputs: Sequence[float], direction: Sequence[float], limits: StepLimits
    ) -> Stepper:
        """Along inputs + sigma * direction."""
    @staticmethod
    def along(
        plan: Plan | Callable[[float], Plan],
        at: Callable[[float], tuple[Sequence[float], Sequence[float], Sequence[float]]],
        varies: bool,
        limits: StepLimits,
    ) -> Stepper:
        """Along any path: `at(sigma)` are the inputs and their two derivatives.

        With `varies` the plan is a function of sigma in [0, 1], too; its plans have one layout.
        Neither function may use the stepper: ValueError.
        """
    def close(self, sigma: float, guess: Sequence[float]) -> Node | None: ...
    def predict(self, node: Node, h: float) -> Floats: ...
    def judge(self, a: Node, b: Node) -> bool: ...
    def step(self, node: Node, h: float) -> Node | None: ...
    def to_target(self, start: Sequence[float]) -> Node | None:
        """The branch from `start` at sigma 0 to sigma 1; None where it ends before."""
    def wanted_step(self, node: Node) -> float: ...

MOST_PATH_STEPS: int
"""Steps of one path at most."""

def symmetric_eigen(a: Floats, b: Floats) -> tuple[Floats, Floats] | None:
    """Values (n,), rising, and vectors (n, n) as columns of A x = lambda B x with symmetric (n, n)
    matrices, x^T B x = 1; None where B is not positive definite or a number is not finite."""

def eigen(a: Floats) -> tuple[Floats, Floats, Floats, Floats] | None:
    """Real and imaginary parts of the values (n,) of a real matrix (n, n), by rising size, and of
    the vectors (n, n) as columns of unit length; None where a number is not finite."""

def closing_turns(plan: Plan) -> list[tuple[int, int, int, int]]:
    """(closing joint, freedom, first slot, slots) of the turns that following carries along.

    Freedom -1 is an orientation, four slots.
    """

def tree_turns(plan: Plan) -> list[tuple[int, int]]:
    """(state, slot) of the tree's angles whose whole turns following counts; after the former."""

def follow_rows(
    plan: Plan,
    inputs: Floats,
    whole: Floats | None,
    start: Sequence[float],
    turn: Sequence[float],
    every_row: bool,
    limits: StepLimits,
    guess: Floats,
    limit: Floats,
    turns: Floats | None,
    course: Course | None = None,
) -> tuple[
    int,
    int,
    int,
    int,
    Floats,
    Floats,
    Floats,
    Floats,
    tuple[int, int, Floats, Floats, Floats, Floats, float, Floats, Floats] | None,
    list[tuple[int, Floats]],
    int,
    float,
]:
    """Fills guess, limit and turns, which share no memory with one another or with inputs.

    `inputs` are without the `whole` turns of angles, integers, where these are given.

    Returns how it ended (`TrackEnd`), rows reached, steps taken and rejected, and inputs, state,
    turn and direction at the last place; what ended the branch if it is known (`PassageEnd`, block,
    inputs, states, columns' derivatives by arclength, second ones, that of the path's parameter,
    inputs and states beyond); the branch points that were passed (first row behind, inputs); on the
    course its piece, else -1, and parameter there.
    """

def integrate_tape(
    tape: Tape,
    freedoms: int,
    quadratures: int,
    switches: Sequence[tuple[bool, bool, bool]],
    time: Floats,
    state: Floats,
    parameters: Floats,
    rows: Floats,
    scales: Sequence[float],
    bounce: float,
    reach: float,
    tolerance: float,
    fixed_step: float,
    least_step: float,
    most_steps: int,
    dense_rows: int,
    method: int,
) -> tuple[Floats, list[dict[str, object]], list[tuple[int, int, bool, float, list[float]]], int]:
    """Integrates x'' = f, w' = g in lanes, see `tape_motion.hpp` for what the tape takes and gives.

    `switches`: whether each is a kink, whether it moves, and whether it ends a lane. `state`
    (x, v, w) and `parameters` are (components, lanes); `scales` are those of the charts, one step
    each, which go no farther than `reach`; where a switch moves, v is multiplied by `bounce`.
    Returns the states (rows, components, lanes), a report for each lane (`LaneReport`), the events
    (lane, switch, rising, time, state) and how many rows were interpolated. ValueError for what
    fits no motion.
    """

def respond(
    *,
    plans: Sequence[Plan],
    state: Floats,
    first: Floats,
    tangent: Floats,
    begin: float,
    times: Floats,
    spaced: SpacedTimes | None = None,
    stops: Sequence[tuple[int, int, int, float, int, int]],
    driven: DrivenLaws | None,
    tolerance: float,
    fixed_step: float,
    most_steps: int,
    dense_rows: int,
    method: int,
    tests: Sequence[float],
    iterations: int,
    jump: float,
    radius: float,
    straight: bool,
    lanes: int,
    threads: int,
    block: int = 0,
    taker: Callable[[int, int, list[Any]], bool] | None = None,
    some: tuple[int, int] = (0, -1),
    parts: int = 1,
    last: float | None = None,
) -> tuple[Any, ...]: ...

class SpacedTimes:
    """Equally spaced moments in s, none of which is held: number k is (first + k step) / over, in
    whole numbers; where `over` is 0, first + k step, and `last` the last one; then over the
    divisor, or times the multiplier where that is 1."""

    def __init__(
        self,
        count: int,
        first: float,
        step: float,
        over: float,
        last: float,
        multiplier: float,
        divisor: float,
    ) -> None: ...
    def at(self, row: int) -> float: ...

class DrivenLaws:
    def __init__(
        self,
        tape: Tape | None,
        edges: Sequence[float],
        constants: Sequence[float],
        ways: Sequence[float],
        units: Sequence[float],
        time_unit: float,
        held: Sequence[float],
    ) -> None: ...
    def at(self, time: float) -> list[tuple[float, float, float]]: ...
    def over(self, times: Floats) -> Floats: ...

def prove_boxes(
    plan: Plan,
    *,
    states: Floats,
    off: Floats,
    radii: Plan | None = None,
    follows: bytes | None = None,
    least: Floats | None = None,
    radius: Floats,
    contraction: Floats,
    beyond: Floats,
    proven: NDArray[np.uint8],
) -> None:
    """Whether there is exactly one position in a box about each of some states (states, places),
    whose inputs are `off` (inputs, places) at most; `follows` (equations,) says which hold where
    the others do; see core/proofs/proving_unit.hpp."""

def prove_tubes(
    plan: Plan,
    *,
    place: Floats,
    inputs: Floats,
    off: Floats,
    states: Floats,
    after: Floats,
    before: Floats,
    radius: Floats,
    proven: NDArray[np.uint8],
    bends: NDArray[np.uint8],
    radii: Plan | None = None,
    follows: bytes | None = None,
    joined: NDArray[np.uint8],
    width: Floats,
) -> tuple[int, int]:
    """Joins boxes by tubes along a way: how many there are, and how many were tried; see
    core/proofs/tubes.hpp."""
