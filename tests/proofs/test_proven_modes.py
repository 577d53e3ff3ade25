"""Modes that are proven to exist, and to be different."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.proofs.boxes import prove_modes
from mechkin_cli.verdict import Proof


def test_modes_exist_and_differ() -> None:
    for name, count in {"rcsr": 2, "sevenr": 4, "rssr": 2}.items():
        found = mk.load(FILE_OF[name]).modes(certify=True)
        assert found.proofs is not None
        assert found.proofs.modes == (Proof.proven,) * count
        assert found.proofs.all_different
    assert mk.load(RCSR).modes().proofs is None


def test_one_mode_twice_is_no_other_mode() -> None:
    """Whole turns, and the other sign of a quaternion, are the same place."""
    for name in ("rcsr", "five_link_suspension"):
        model = mk.load(FILE_OF[name])
        session, result = model.session, model.analyze(tables=[]).result
        state = result.row_states.states[:, 0]
        other = state.copy()
        for carrier in session.layout.carriers:
            if carrier.part.type.is_ball:
                other[carrier.state : carrier.state + 4] *= -1.0
            elif any(freedom.is_cyclic for freedom in carrier.part.type.freedoms):
                other[carrier.state] += 2 * np.pi
        place = session.inputs.values[:, 0]
        found = prove_modes(session, place, np.stack([state, other], axis=1))
        assert found.modes == (Proof.proven,) * 2
        assert not found.all_different


def test_a_place_that_does_not_close_is_no_mode() -> None:
    model = mk.load(RCSR)
    result = model.analyze(tables=[]).result
    states = result.row_states.states[:, [0, 0]].copy()
    states[1:, 1] += 0.4
    found = prove_modes(model.session, model.session.inputs.values[:, 0], states)
    assert found.modes == (Proof.proven, Proof.not_proven)
    assert found.sentence == "1 of 2 proven to exist"


def test_the_command() -> None:
    command = [sys.executable, "-P", "-m", "mechkin_cli", "modes", str(RCSR), "--certify"]
    run = subprocess.run([*command, "--json"], check=True, capture_output=True, text=True)
    answer = json.loads(run.stdout)
    assert [mode["proof"] for mode in answer["modes"]] == ["proven", "proven"]
    assert answer["proofs"] == "2 of 2 proven to exist, all of them proven to be different"
    plain = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "proofs: 2 of 2 proven to exist" in plain.stderr
