"""Searches every choice in one world: the runs, and the range of their costs.

The mapper decides: each choice lies on a run of it that is judged by every claim (`graph.py`).
Named policies run, too: the script replaces their code.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Literal, NamedTuple, cast

import msgspec

from topo_verify.algorithms import Algorithm
from topo_verify.campaign.attempt import Attempt
from topo_verify.campaign.judge import Report, world_argument
from topo_verify.campaign.row import MostSaved, PolicyCosts
from topo_verify.campaign.run import Exploration
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.states import script as sc
from topo_verify.studies.search.states.graph import StateGraph
from topo_verify.world.rooted_map import World

Decider = Literal["mapper"]

BY_EVERY_CLAIM = "every claim, on a run for each choice"

MOST_EDGES = 4

Run = Callable[[Target], Attempt]
"""Runs a mapper in the world at hand and judges it."""


class CostRange(NamedTuple):
    """What a mapper can cost in one world, in edge traversals, by what is chosen.

    `states` have more than one way; `choices` counts their ways.
    """

    states: int
    choices: int
    cheapest: int
    dearest: int


def require_edges(text: str, edges: int) -> None:
    """Raise an InputError unless every choice can be searched in such worlds."""
    if edges > MOST_EDGES:
        raise InputError(
            f"--policies every, --edges {edges}: it goes to {MOST_EDGES} edges, where {text} itself"
            f" makes each choice; ask for --edges {MOST_EDGES}, or for --policies all (beyond,"
            " `python -m research.every` searches a model, in a checkout of the project)"
        )


def every_choice(
    target: Target,
    world: World,
    run: Run,
    named: Sequence[Target],
) -> Iterator[Attempt]:
    """Runs in a world; if a claim fails, first the one with the fewest choices before the failure.

    If none fails, the last run says what any choices can cost. `named` is the algorithm with
    named policies, the reference first.
    """
    algorithm = cast("Algorithm", target.mapper)
    costs, runs = _by_running(target.text, algorithm, world, run)
    by_name = [run(variant) for variant in named]
    if costs is not None and all(attempt.report.ok for attempt in by_name):
        reference = by_name[0].run.cost
        saved = MostSaved(world_argument(world), reference, costs.cheapest)
        policy_costs = PolicyCosts(1, *costs[:3], reference, costs.dearest, saved)
        by_name[-1] = replace(by_name[-1], choices=policy_costs)
    yield from (*runs, *by_name)


def cost_range(graph: StateGraph) -> CostRange:
    """The range of the costs of a completed graph, whose states include the cost so far."""
    costs = [path.tried.run.cost for path in graph.paths]
    return CostRange(len(graph.nodes), graph.choices, min(costs), max(costs))


def _by_running(
    text: str, algorithm: Algorithm, world: World, run: Run
) -> tuple[CostRange | None, list[Attempt]]:
    graph = StateGraph(algorithm, world, lambda mapper: run(Target(text, mapper)))
    graph.search()
    shortest = graph.shortest_failing()
    paths = graph.paths if shortest is None else [shortest, *graph.paths]
    runs = [replayable(path.tried, text, path.choices) for path in paths]
    return (cost_range(graph) if shortest is None else None), runs


# ---------------------------------------------------------------- runs that can be had again


def replayable(tried: Attempt, text: str, choices: tuple[int, ...]) -> Attempt:
    """The run, whose findings name the command that makes the same choices."""
    if tried.report.ok:
        return tried
    report = with_choices(tried.report, text, choices, tried.run.limits)
    return replace(tried, report=report)


def with_choices(report: Report, text: str, choices: tuple[int, ...], limits: Limits) -> Report:
    """The report, whose findings name the command that makes the same choices."""
    chosen = sc.choices_text(choices)
    words = ["topo-verify", "explore", report.world, "--target", text, "--choices", chosen]
    replay = shlex.join([*words, *limits.options])
    changed = [
        msgspec.structs.replace(
            finding, message=f"{finding.message} (choices: {chosen})", replay=replay
        )
        for finding in report.findings
    ]
    return report.with_findings(tuple(changed))


class ListedChoices:
    """The choices of one run, as `0,2,1`: run `target`, then `checked`, then `named`."""

    def __init__(self, target: Target, text: str) -> None:
        if not isinstance(target.mapper, Algorithm):
            raise InputError(
                f"--choices {text}: {target.text} leaves no choices open; it is for algorithms of"
                " the catalogue"
            )
        self._choices = sc.choices_of(text)
        self._listed = sc.Listed(self._choices)
        self.target = Target(target.text, sc.scripted(target.mapper, self._listed))

    def checked(self, run: Exploration) -> Exploration:
        """The run; InputError if there were fewer ways, or fewer choices to be made.

        It cannot be repeated in a witness world.
        """
        self._listed.require_all()
        return replace(run, mapper=None)

    def named(self, report: Report, limits: Limits) -> Report:
        """The report, whose findings name the command that repeats the choices of this run."""
        return with_choices(report, self.target.text, self._choices, limits)
