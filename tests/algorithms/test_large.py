"""Nothing recurses over the map, and nothing that is walked once is walked twice."""

from __future__ import annotations

import pytest

from tests.helpers import SURE, path
from topo_verify import examine


@pytest.mark.long
@pytest.mark.parametrize("name", SURE)
@pytest.mark.no_cover
def test_a_path_of_5000_vertices_is_walked_once(name: str) -> None:
    report = examine(name, path(5000, marker=0))
    assert report.ok, str(report)
    assert report.cost == 4999


@pytest.mark.no_cover
def test_a_path_of_5000_vertices_with_the_marker_in_its_middle_is_walked_to_both_ends() -> None:
    report = examine("enhancement-iii-all+i", path(5000, marker=2500))
    assert report.ok, str(report)
    assert report.cost == 4999 + 2500
