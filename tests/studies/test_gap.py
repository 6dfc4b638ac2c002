"""How far each rule is from the best possible."""

from __future__ import annotations

import pytest

from tests.helpers import trace_of, worlds
from topo_verify import CATALOGUE
from topo_verify.studies.gap import Gap, gap


def total(name: str, edges: int) -> Gap:
    """The gaps of all worlds of a size together."""
    gaps = [gap(trace_of(world, name)) for world in worlds([edges])]
    false, walked, refutable = (
        sum(getattr(one, name) for one in gaps) for name in ("false", "walked", "refutable")
    )
    return Gap(false, walked, refutable, refutable / (false or 1))


def test_the_complete_rule_has_none() -> None:
    for edges in (1, 2, 3, 4):
        assert total("folding", edges).refutable == 0


@pytest.mark.nightly
def test_the_basic_algorithm_has_the_largest() -> None:
    gaps = {name: total(name, 4) for name in CATALOGUE if "planar" not in name}
    assert len({g.false for g in gaps.values()}) == 1
    assert max(gaps.values(), key=lambda g: g.share) == gaps["basic"]
    assert gaps["basic"].refutable > gaps["enhancement-iii-all+i"].refutable > 0


def test_where_no_false_hypothesis_is_posed_there_is_no_gap() -> None:
    assert gap(trace_of("m1/0")) == Gap(0, 0, 0, 0.0)
