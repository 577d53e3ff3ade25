"""What is asked of loads, against what their kinds are: a spring is an elastic, a damper a viscous
element; a law gives its force by the rows, and by rates where it reads them."""

import pytest

from mechkin_cli.mechanism.model import Damper, JointLoad, LinkLoad, Load, Spring, Varying
from mechkin_cli.mechanism.pair_type import Attached

ENDS = Attached("arm", (1.0, 0.0, 0.0)), Attached("ground", (0.0, 2.0, 0.0))
STILL, MOVING = Varying(3), Varying(5, moving=True)
LOADS: dict[str, Load] = {
    "force": LinkLoad("force", "arm", (1.0, STILL, 0.0)),
    "force by rates": LinkLoad("force", "arm", (MOVING, 0.0, STILL)),
    "torque": LinkLoad("torque", "arm", (0.0, 0.0, 2.0)),
    "at a joint": JointLoad("A", "theta", 1.5),
    "at a joint by rates": JointLoad("A", "s", MOVING),
    "spring": Spring(ENDS, None, None, 100.0, 0.5, 0.0),
    "spring at a joint": Spring(None, "A", "theta", 100.0, 0.5, 0.0),
    "damper": Damper(ENDS, None, None, 10.0),
    "damper at a joint": Damper(None, "A", "s", 10.0),
}


@pytest.mark.parametrize("name", LOADS)
def test_energy_and_rates(name: str) -> None:
    load = LOADS[name]
    assert load.has_potential == name.startswith("spring")
    assert load.dissipates == name.startswith("damper")
    assert load.reads_rates == (name.startswith("damper") or name.endswith("by rates"))


@pytest.mark.parametrize("name", LOADS)
def test_where_it_acts(name: str) -> None:
    load = LOADS[name]
    coordinate = {
        "at a joint": ("A", "theta"),
        "at a joint by rates": ("A", "s"),
        "spring at a joint": ("A", "theta"),
        "damper at a joint": ("A", "s"),
    }
    assert load.acts_at == coordinate.get(name)
    assert load.ends == (ENDS if name in ("spring", "damper") else ())


def test_laws_under_other_numbers() -> None:
    numbers = {3: 0, 5: 1}
    moved = {name: load.renumbered(numbers) for name, load in LOADS.items()}
    assert moved["force by rates"] == LinkLoad(
        "force", "arm", (Varying(1, moving=True), 0.0, Varying(0))
    )
    assert moved["at a joint by rates"] == JointLoad("A", "s", Varying(1, moving=True))
    assert all(moved[name] == load for name, load in LOADS.items() if not load.varying)
