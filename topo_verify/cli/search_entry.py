"""What a search found, as the entry of `results` that `searched.py` shows."""

from __future__ import annotations

from typing import cast

from topo_verify.algorithms import Algorithm
from topo_verify.cli.output import Result
from topo_verify.cli.searched import (
    ByEdges,
    Counterexample,
    EveryCost,
    FailingClaim,
    Lost,
    MostSaved,
    SearchEntry,
)
from topo_verify.harness.search.compiled_shard import JUDGED_BY
from topo_verify.harness.search.exhaustive import SearchResult, Size
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.search.states.every import judged_by
from topo_verify.harness.tally import CostTotals, Failure, PolicyCosts, joint_judgements
from topo_verify.harness.targets import one_target


def search_result(found: SearchResult, *, compare: bool) -> Result[SearchEntry]:
    """The entry of `results` for a search, and whether it failed or is incomplete.

    Args:
        compare: whether the costs of two mappers are compared.
    """
    first = found.counterexample
    tally = found.tally
    # A claim that some runs were judged on is not listed, even if others declared nothing.
    silent = (
        c
        for c, seen in tally.statuses.items()
        if seen and seen.keys() <= {"not-declared", "not-asked"}
    )
    entry = SearchEntry(
        target=",".join(found.plan.targets),
        kind=found.plan.kind,
        edges=found.plan.edges,
        policies=found.plan.choices,
        engine=found.plan.engine,
        judged_by=_judged_by(found.plan),
        by_checkers=tally.by_checkers if found.plan.engine == "compiled" else tally.worlds,
        checked=found.checked,
        total=found.total,
        verdict=found.verdict,
        from_ledger=found.from_ledger,
        lost=tuple(Lost(one.world, one.how) for one in found.lost),
        run_again=found.again,
        counterexample=None if first is None else _counterexample(first),
        by_edges=tuple(_by_edges(size, found.plan, compare=compare) for size in found.by_edges),
        claims=tuple(
            FailingClaim(claim, failing.worlds, _counterexample(failing.smallest))
            for claim, failing in found.claims.items()
        ),
        not_declared=tuple(silent),
        judgements=joint_judgements(tally.statuses, tally.shares, ()),
    )
    return Result(entry, failed=found.verdict == "REFUTED", incomplete=found.verdict == "UNKNOWN")


def _judged_by(plan: Plan) -> str:
    if plan.engine == "compiled":
        return JUDGED_BY
    if plan.choices == "every":
        return judged_by(cast("Algorithm", one_target(plan.targets[0]).mapper), plan.edges)
    return "the checkers"


def _counterexample(failure: Failure) -> Counterexample:
    return Counterexample(
        failure.world, failure.edges, failure.claim, failure.message, failure.replay
    )


def _by_edges(size: Size, plan: Plan, *, compare: bool) -> ByEdges:
    costs = size.tally.costs.get(plan.targets[0], CostTotals())
    return ByEdges(
        edges=size.edges,
        checked=size.checked,
        total=size.total,
        failing=size.failing,
        undecided=size.tally.undecided,
        runs=costs.runs,
        max_cost=costs.most,
        total_cost=costs.total,
        attained=costs.attained,
        worst=costs.worst,
        compare=size.tally.compared if compare else None,
        every=_every(size, plan) if plan.choices == "every" else None,
    )


def _every(size: Size, plan: Plan) -> EveryCost:
    """The range of the costs of the first mapper in the worlds of one size."""
    target = plan.targets[0]
    costs = size.tally.policy_costs.get(target, PolicyCosts())
    saved = costs.most_saved
    algorithm = one_target(target).mapper
    return EveryCost(
        worlds=costs.worlds,
        states=costs.states,
        choices=costs.choices,
        cheapest=costs.cheapest,
        reference=costs.reference,
        dearest=costs.dearest,
        most_saved=None if saved is None else MostSaved(saved.world, saved.cost, saved.other),
        judged_by=judged_by(cast("Algorithm", algorithm), size.edges),
    )
