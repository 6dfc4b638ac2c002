"""Every claim, of every algorithm with every policy, in worlds of every strategy.

Twice: by a second opinion (eight of them), or as statements that can be read on their own (the two
of `statements.py`); and as the checkers judge it.
(In every small world the claims are asked elsewhere: here worlds are larger, and drawn; but what is
said of all worlds is read in small ones, where all can be gone through.)
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.checkers.second_opinion import failing_claims
from tests.helpers import EIGHT, SURE, any_world
from tests.properties.statements import STATEMENTS
from tests.properties.worlds import STRATEGIES, runs
from topo_verify import CATALOGUE, Exploration, World, explore
from topo_verify.campaign.judge import judge
from topo_verify.checkers import CLAIMS
from topo_verify.robot import events as ev
from topo_verify.strategies import observe, policies

every_strategy = pytest.mark.parametrize("strategy", STRATEGIES)

few = settings(max_examples=settings().max_examples // 4)
"""A quarter for each of eight strategies: twice as many in all, in any profile."""


def test_every_claim_has_a_second_opinion() -> None:
    assert EIGHT | STATEMENTS.keys() == CLAIMS.keys()


@pytest.mark.long
@every_strategy
@given(data=st.data())
def test_every_claim_is_true_of_every_run(strategy: str, data: st.DataObject) -> None:
    run = data.draw(runs(STRATEGIES[strategy]))
    assert not failing_claims(run.world, run.trace)
    assert run.cost >= run.world.least_cost()


@pytest.mark.long
@pytest.mark.parametrize("claim", STATEMENTS)
@given(run=runs(any_world(max_edges=3)))
def test_what_a_run_says_of_all_worlds_is_true_of_those_of_about_its_size(
    claim: str, run: Exploration
) -> None:
    STATEMENTS[claim](run)


# ---------------------------------------------------------------- as the checkers judge it


def judged(run: Exploration) -> dict[str, str]:
    """The status of each claim; the run is told to whoever looks at a failure."""
    observe(run)
    return dict(judge(run).claims)


@pytest.mark.long
@every_strategy
@pytest.mark.parametrize("name", SURE)
@few
@given(data=st.data())
def test_every_claim_of_every_algorithm_holds_in_the_worlds_of_every_strategy(
    strategy: str, name: str, data: st.DataObject
) -> None:
    world, chosen = data.draw(STRATEGIES[strategy]), data.draw(policies())
    run = explore(world, name, pick=chosen.pick, order=chosen.order)
    assert judged(run) == dict.fromkeys(CLAIMS, "ok")


@given(chosen=policies(), world=any_world(max_edges=40))
@example(ev.Policies(), World.from_id("m15/56783627632649097"))
def test_every_claim_of_folding_holds_whatever_it_meets_first(
    chosen: ev.Policies, world: World
) -> None:
    """In the example the fold cites what is met behind a vertex that would be itself, turned."""
    run = explore(world, "folding", pick=chosen.pick, order=chosen.order)
    assert judged(run) == dict.fromkeys(CLAIMS, "ok")


@pytest.mark.long
@pytest.mark.parametrize("strategy", ["planar_worlds", "tree_worlds", "lattices"])
@given(data=st.data())
def test_every_claim_of_what_assumes_a_plane_holds_in_planar_worlds(
    strategy: str, data: st.DataObject
) -> None:
    world, chosen = data.draw(STRATEGIES[strategy]), data.draw(policies())
    (name,) = (name for name in CATALOGUE if name not in SURE)
    run = explore(world, name, pick=chosen.pick, order=chosen.order)
    assert judged(run) == dict.fromkeys(CLAIMS, "ok")


# ---------------------------------------------------------------- the statements can fail


RUN = explore(World.from_id("m4/300"), "basic")
"""Behind edge 5 darts 1, 2, 3 are posed, and 3 is true; behind edge 2 a walk confirms dart 6."""


def without_the_last_moves() -> ev.Trace:
    """The trace without the last two moves, from which the last confirmation follows.

    Without the last one alone no world with up to one edge more shows that it does not follow.
    """
    moves = [when for when, event in enumerate(RUN.trace) if isinstance(event, ev.Move)]
    return tuple(event for when, event in enumerate(RUN.trace) if when not in moves[-2:])


@pytest.mark.parametrize("claim", STATEMENTS)
def test_every_statement_is_true_of_a_run_and_false_of_a_lie(claim: str) -> None:
    STATEMENTS[claim](RUN)
    with pytest.raises(AssertionError):
        STATEMENTS[claim](replace(RUN, trace=without_the_last_moves()))
