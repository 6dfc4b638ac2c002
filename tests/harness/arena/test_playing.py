"""Every mapper that has a name can be played in a process of its own, where its memory is seen."""

from __future__ import annotations

import pytest

from topo_verify import families
from topo_verify.harness.arena.playing import peak_memory
from topo_verify.robot.limits import Limits


@pytest.mark.parametrize("name", ["basic", "planner"])
def test_the_memory_of_a_named_mapper_is_measured(name: str) -> None:
    found = peak_memory(name, families.lattice(3, 3), Limits())
    assert found is None or found > 1000  # a Python process takes more than a mebibyte
