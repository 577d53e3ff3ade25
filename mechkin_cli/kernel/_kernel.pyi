"""The compiled core; see src/module.cpp. Batched arrays are (columns, rows), C-contiguous
float64."""

from collections.abc import Sequence
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

WordColumn = tuple[NDArray[np.int32], Sequence[str]]
DecimalColumn = tuple[Floats, bool, int, bool]

def decimal_texts(column: DecimalColumn) -> list[str]: ...
def csv_text(
    labels: Sequence[str],
    columns: Sequence[Floats | WordColumn],
    missing: NDArray[np.bool_] | None = None,
    significant_digits: int = 0,
    quoted_empty: bool = False,
    threads: int = 1,
) -> bytes: ...
def markdown_text(
    headers: Sequence[str], columns: Sequence[DecimalColumn | WordColumn], threads: int = 1
) -> bytes: ...
def json_list(column: Floats | WordColumn, threads: int = 1) -> bytes: ...

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
    def track(
        self,
        x0: Sequence[float],
        u: Sequence[float],
        sigma: Floats,
        start: Floats,
        guess: Floats,
        limit: Floats,
        last: Floats,
        limits: Sequence[float],
    ) -> tuple[int, int, int, int, float, float]: ...
