"""Codes that the kernel's plan uses (kernel/src/plan.hpp)."""

from __future__ import annotations

from enum import IntEnum, IntFlag


class LoadCode(IntEnum):
    """Kinds of loads."""

    FORCE_GROUND = 0
    FORCE_LINK = 1
    TORQUE_GROUND = 2
    TORQUE_LINK = 3
    COORDINATE = 4
    SPRING = 5
    DAMPER = 6
    COORDINATE_SPRING = 7
    COORDINATE_DAMPER = 8


class OutputCode(IntEnum):
    """Kinds of outputs."""

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
    JERK = 18


class Demand(IntFlag):
    """What a run computes beyond positions."""

    POSITION = 0
    VELOCITY = 1
    ACCELERATION = 2
    FORCES = 4
    CONDITION = 8
    POWER = 16
    JERK = 32
    SINGULAR = 64


class RowFlag(IntFlag):
    """Why a row of a run is not good."""

    GOOD = 0
    NOT_CONVERGED = 1
    SIDE_CONDITION = 2
