"""The compiled core; see src/module.cpp. Batched arrays are (columns, rows), C-contiguous
float64."""

from collections.abc import Callable, Sequence
from typing import Final, TypedDict

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Triple = Sequence[float]

widest: Final[int]

class JointTableRow(TypedDict):
    letter: str
    code: int
    parts: str
    coordinates: str
    equations: int

class TreeTableRow(TypedDict):
    code: int
    freedoms: int
    states: int
    slides: int

def joint_table() -> list[JointTableRow]: ...
def tree_table() -> list[TreeTableRow]: ...
def elementwise(operation: int, x: Floats, y: Floats, lanes: int = 0) -> Floats: ...
def number_text(x: float, significant_digits: int = 0) -> str: ...
def fixed_texts(values: Floats, decimals: int) -> list[str]: ...
def csv_text(
    labels: Sequence[str],
    columns: Sequence[Floats | tuple[NDArray[np.int32], Sequence[str]]],
    missing: NDArray[np.bool_] | None = None,
    significant_digits: int = 0,
) -> bytes: ...

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

class Plan:
    def __init__(self, length: float, origin: Triple, size: float) -> None: ...
    @property
    def states(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def slots(self) -> int: ...
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
    def add_leg(
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
    def add_place(
        self, reference: int, first: int, second: int, point_on: int, point: Triple, sign: float
    ) -> int: ...
    def add_axis(
        self, place: int, slide: bool, link: int, vector: Triple, other: int, other_vector: Triple
    ) -> int: ...
    def add_block(
        self, closing_joints: int, joints: Sequence[int], unknown: Sequence[int]
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
    def add_output(
        self, type: int, index: int, freedom: int, order: int, data: Triple, factor: float
    ) -> int: ...
    def finish(self) -> None: ...
    def run(
        self,
        inputs: Floats,
        rates: Floats | None,
        accelerations: Floats | None,
        guess: Floats,
        states: Floats,
        outputs: Floats | None,
        first: Floats | None,
        second: Floats | None,
        residual: Floats,
        correction: Floats,
        orientation: Floats | None,
        condition: Floats | None,
        power_error: Floats | None,
        flags: NDArray[np.uint8],
        demand: int,
        shift: int,
        iterations: int,
        tests: tuple[float, float, float],
        lanes: int,
        loads: Floats | None = None,
        jerks: Floats | None = None,
    ) -> None: ...
    def search(
        self,
        block: int,
        inputs: Floats,
        states: Floats,
        residual: Floats,
        flags: NDArray[np.uint8],
        iterations: int,
        accept: float,
        lanes: int,
    ) -> None: ...

class StepLimits:
    """What a step along a path may do; see StepLimits in src/stepper.hpp."""

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
        plan_step: float,
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
    """One step along a path: predict, close, judge; see src/stepper.hpp."""

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

        With `varies` the plan is a function of sigma in [0, 1], too.
        """
    def close(self, sigma: float, guess: Sequence[float]) -> Node | None: ...
    def predict(self, node: Node, h: float) -> Floats: ...
    def judge(self, a: Node, b: Node) -> bool: ...
    def step(self, node: Node, h: float) -> Node | None: ...
    def wanted_step(self, node: Node) -> float: ...

def closing_turns(plan: Plan) -> list[tuple[int, int, int, int]]:
    """(closing joint, freedom, first slot, slots) of the turns that following carries along.

    Freedom -1 is an orientation, four slots.
    """

def follow_rows(
    plan: Plan,
    inputs: Floats,
    start: Sequence[float],
    turn: Sequence[float],
    every_row: bool,
    limits: StepLimits,
    guess: Floats,
    limit: Floats,
    turns: Floats | None,
) -> tuple[int, int, int, int, Floats, Floats, Floats, Floats]:
    """Fills guess, limit and turns.

    Returns how it ended (`TrackEnd`), rows reached, steps taken and rejected, and inputs, state,
    turn and direction at the last place.
    """
