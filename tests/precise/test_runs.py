"""Runs in double-double against the oracle: legs, springs and dampers, overconstrained loops; the
same bits however rows are packed and split."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from mechanisms.runs import model, run
from oracle import assemble, condition_of, mp, newton_euler, read
from oracle_checks.legs import rssr, stewart, suspension
from properties.expected import expected

import mechkin_cli as mk
from mechkin_cli.analysis.sweep import Result
from mechkin_cli.kernel.width import widths
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.precise_run import PreciseBatch, in_parts, run_precise

ALL = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES
