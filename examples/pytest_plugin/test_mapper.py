"""The tests of a mapper, to be put beside it: here, of examples/mapper_python/mapper.py."""

import pytest


@pytest.mark.topo(target="mapper:explore", edges=3)
def test_mapper():
    """One test a claim, each about every world of 1 to 3 edges."""


@pytest.mark.parametrize("world", ["nyc", "family:lattice(5,5,holes=0.2,seed=7)"])
def test_mapper_in_larger_worlds(topo_examine, world):
    report = topo_examine("mapper:explore", world)
    assert report.ok, str(report)


def test_a_loop_is_one_door_out_and_another_in(topo_robot):
    robot = topo_robot("m1/1")
    assert robot.percept.degree == 2
    assert robot.move(0).marker == 1  # the marked door is the next one
    assert robot.cost == 1
