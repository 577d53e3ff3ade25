"""What a sound file means, against the file read by hand."""

from pathlib import Path

import pytest

from mechkin_cli.building.source import open_file
from mechkin_cli.schema.links_joints import JOINT_LETTERS, HelicalJoint
from mechkin_cli.schema.motion import HeldInput, SweptInput

GOOD = Path(__file__).parent / "good"


@pytest.mark.parametrize("path", sorted(GOOD.glob("*.yaml")), ids=lambda path: path.stem)
def test_is_accepted(path: Path) -> None:
    file, document = open_file(path)
    assert document.file == str(path)
    assert file.format == 1


def test_the_documented_example() -> None:
    file, _ = open_file(GOOD / "rcsr_one_line_style.yaml")
    assert file.name == "RCSR"
    assert (file.units.length, file.units.force, file.units.time) == ("in", "lbm*in/s^2", "s")
    assert file.parameters == {"alpha1": "12 deg", "P1": "0.5 in"}
    assert file.links["crank"].center_of_mass == ("-4.5", "1", "1")
    assert file.links["rocker"].mass is None
    inertia = file.links["coupler"].inertia
    assert inertia is not None
    assert (inertia.xx, inertia.yz, inertia.xz) == (".01", "0", ".4")
    assert inertia.axes is not None
    assert inertia.axes.x == ("cos(alpha1)", "0", "sin(alpha1)")
    assert {name: joint.type for name, joint in file.joints.items()} == {
        "O1": "R",
        "O2": "C",
        "O3": "S",
        "O4": "R",
    }
    assert file.joints["O3"].point == {"coupler": ("-5", "-1.3", "0"), "rocker": ("0", ".9", "0")}
    assert file.motion is not None
    swept = file.motion.inputs["O1.theta"]
    assert isinstance(swept, SweptInput)
    assert (swept.first, swept.last, swept.step, swept.count) == ("150", "202", "2", None)
    assert (swept.rate, swept.acceleration, swept.jerk) == ("0.1 rad/s", "0.2 rad/s^2", "0")
    assert file.assembly is not None
    assert file.assembly.near == {"O2.theta": "-104", "O2.s": "-9", "O4.theta": "37"}
    columns = [(column.label, column.value, column.decimals) for column in file.tables[0].columns]
    assert columns == [
        ("theta1", "O1.theta", 0),
        ("FB", "det(O3.force, C, D)/det(B, C, D)", None),
        ("O4.theta", "O4.theta", None),
    ]


def test_every_key() -> None:
    file, _ = open_file(GOOD / "every_key.yaml")
    assert file.parameters == {"on": "1e-3", "alpha": "12 deg", "half": "alpha / 2", "m": "010"}
    assert sorted(joint.type for joint in file.joints.values()) == sorted(JOINT_LETTERS)
    assert isinstance(file.joints["jH"], HelicalJoint)
    assert file.joints["jH"].lead == "5 mm"
    assert [row.link for row in file.chain] == ["l1", "ground"]
    assert file.motion is not None
    assert isinstance(file.motion.inputs["jE.x"], HeldInput)
    assert len({type(load) for load in file.loads}) == 9
    assert [table.title for table in file.tables] == ["1986", None]
    assert (file.follow, file.accept, file.idle) == (("jR", "c1"), ("unphysical-inertia",), "hold")


def test_what_is_left_out() -> None:
    file, _ = open_file(GOOD / "smallest.yaml")
    units = file.units
    assert (units.length, units.angle, units.mass, units.force, units.time, units.angular_rate) == (
        "m",
        "deg",
        "kg",
        "N",
        "s",
        "rad/s",
    )
    assert (file.motion, file.assembly, file.follow, file.idle) == (None, None, None, None)
    assert (file.loads, file.tables, file.chain, file.accept) == ((), (), (), ())
