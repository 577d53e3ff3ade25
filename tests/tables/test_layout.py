"""The table of a file that declares none."""

import pytest

from mechkin_cli.tables.layout import default_table, effort_names


def test_coordinates_rates_efforts():
    table = default_table(["O1.theta", "O2.theta", "O2.s"], ["O1.theta"])
    assert table.name == "sweep"
    expected = ["O1.theta", "O2.theta", "O2.s", "O1.theta_dot", "O2.theta_dot", "O2.s_dot"]
    expected.append("O1.effort")
    assert [column.label for column in table.columns] == expected
    assert [column.expression.text for column in table.columns] == expected


@pytest.mark.parametrize(
    ("inputs", "names"),
    [
        ([], []),
        (["O1.theta"], ["O1.effort"]),
        (["O1.theta", "O3.s"], ["O1.effort", "O3.effort"]),
        (
            ["O2.theta", "O1.theta", "O2.s"],
            ["O2.theta.effort", "O1.effort", "O2.s.effort"],
        ),
    ],
)
def test_a_joint_with_two_inputs_names_the_coordinate(inputs, names):
    assert effort_names(inputs) == names
