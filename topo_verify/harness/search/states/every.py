"""What a search with every choice does with one world: its runs, and the range of its costs.

    worlds of up to 3 edges; any rule    the states are found by running the mapper: each choice
                                         lies on a run that is judged by every claim
    larger; `none`, `prefix`, `history`  the states are found by the kernel, which judges claims 3
                                         and 4 in each; the cheapest and the dearest run are made by
                                         the mapper and judged by every claim, claim 7 among them
    4 edges; any other rule              as in smaller worlds

The kernel is not trusted. If the mapper's two runs do not cost what the kernel says, that is a bug
of ours. If the kernel finds something wrong, the world is searched by running the mapper, which
must find it, too.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import cast

import msgspec

from topo_verify.algorithms import REFERENCE, Algorithm
from topo_verify.errors import InputError, InternalError
from topo_verify.harness.judge import Report, world_argument
from topo_verify.harness.run import explore
from topo_verify.harness.search.states import table
from topo_verify.harness.search.states.graph import StateGraph
from topo_verify.harness.search.states.ranges import CostRange, cost_range
from topo_verify.harness.search.states.script import ChoicePoint, Chooser, choices_text, scripted
from topo_verify.harness.second_try import Tried
from topo_verify.harness.tally import CostPair, PolicyCosts
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World

MOST_BY_RUNS, MOST_BY_KERNEL = 4, 6
"""The largest worlds that are searched by running the mapper, and by the kernel."""

EACH_JUDGED = 3
"""Up to so many edges each choice of every algorithm lies on a judged run."""

Run = Callable[[Target], Tried]
"""Runs a mapper in the world at hand and judges it."""


def require_edges(text: str, algorithm: Algorithm, edges: int) -> None:
    """Raise an InputError unless every choice can be searched in worlds with so many edges."""
    known = table.is_known(algorithm)
    most = MOST_BY_KERNEL if known else MOST_BY_RUNS
    if edges > most:
        reason = "larger ones take days" if known else "its rule remembers what it saw"
        raise InputError(
            f"--policies every, --edges {edges}: for {text} it goes to {most} edges ({reason}); ask"
            f" for --edges {most}, or for --policies all"
        )
    if known and edges > EACH_JUDGED:
        table.require_kernel()


def judged_by(algorithm: Algorithm, edges: int) -> str:
    """What judged the choices in worlds with so many edges, in words."""
    if edges <= EACH_JUDGED or not table.is_known(algorithm):
        return "every claim, on a run for each choice"
    return "claims 3 and 4 in each state, by the kernel; every claim on the two extreme runs"


def every_choice(
    target: Target,
    world: World,
    run: Run,
    limits: Limits,
    note: Callable[[PolicyCosts], None] | None = None,
) -> Iterator[Tried]:
    """Runs in a world; if a claim fails, first the one with the fewest choices up to there.

    Args:
        target: an algorithm and its name.
        note: called with the range of the costs, if no claim fails.
    Raises:
        InternalError: the kernel and the mapper differ, or a state is no state.
    """
    algorithm = cast("Algorithm", target.mapper)
    if len(world.edges) <= EACH_JUDGED or not table.is_known(algorithm):
        found, runs = _by_running(target.text, algorithm, world, run, limits)
    else:
        found, runs = _by_kernel(target.text, algorithm, world, run, limits)
    if note is not None and found is not None:
        usual = Target(target.text, replace(algorithm, policies=REFERENCE))
        reference = explore(world, usual, limits=limits).cost
        note(_policy_costs(world, found, reference))
    yield from runs


def _policy_costs(world: World, found: CostRange, reference: int) -> PolicyCosts:
    saved = CostPair(world_argument(world), reference, found.cheapest)
    return PolicyCosts(
        1, found.states, found.choices, found.cheapest, reference, found.dearest, saved
    )


def _by_running(
    text: str, algorithm: Algorithm, world: World, run: Run, limits: Limits
) -> tuple[CostRange | None, list[Tried]]:
    graph = StateGraph(algorithm, world, lambda mapper: run(Target(text, mapper)))
    graph.search()
    shortest = graph.shortest_failing()
    paths = graph.paths if shortest is None else [shortest, *graph.paths]
    runs = [replayable(path.tried, text, path.choices, limits) for path in paths]
    return (cost_range(graph) if shortest is None else None), runs


def _by_kernel(
    text: str, algorithm: Algorithm, world: World, run: Run, limits: Limits
) -> tuple[CostRange | None, list[Tried]]:
    found = table.found_in(world, algorithm)
    if found.wrong:
        return _require_failing(world, *_by_running(text, algorithm, world, run, limits))
    runs: list[Tried] = []
    for order, cost in ((found.cheap, found.cheapest), (found.dear, found.dearest)):
        made = RecordedChoices(table.Ordered(world, order))
        tried = run(Target(text, scripted(algorithm, made)))
        if not tried.report.ok:  # here, by other choices than the kernel judged
            return _by_running(text, algorithm, world, run, limits)
        if tried.run.cost != cost:
            raise InternalError(
                f"{text} in {world_argument(world)} costs {tried.run.cost} where the kernel says"
                f" {cost}: --choices {choices_text(made.choices)}"
            )
        runs.append(tried)
    return CostRange(found.states, found.choices, found.cheapest, found.dearest, (), ()), runs


def _require_failing(
    world: World, found: CostRange | None, runs: list[Tried]
) -> tuple[CostRange | None, list[Tried]]:
    if found is not None:
        raise InternalError(
            f"the kernel finds a claim false in {world_argument(world)}, and no run of the mapper"
            " shows it"
        )
    return found, runs


# ---------------------------------------------------------------- runs that can be had again


class RecordedChoices:
    """Makes the choices of another chooser and keeps their numbers.

    Attributes:
        choices: those made so far, as `--choices` takes them.
        words: the same, to be read.
    """

    def __init__(self, chooser: Chooser) -> None:
        self._chooser = chooser
        self.choices: list[int] = []
        self.words: list[str] = []

    def __call__(self, moment: ChoicePoint) -> int:
        """What the other chooser takes."""
        number = self._chooser(moment)
        self.choices.append(number)
        self.words.append(f"{'e' if moment.e is None else 'h'} = {moment.ways[number]}")
        return number


def replayable(tried: Tried, text: str, choices: tuple[int, ...], limits: Limits) -> Tried:
    """The run; its findings name the command that makes the same choices again."""
    if tried.report.ok:
        return tried
    return tried._replace(report=with_choices(tried.report, text, choices, limits))


def with_choices(report: Report, text: str, choices: tuple[int, ...], limits: Limits) -> Report:
    """The report; its findings name the command that makes the same choices again."""
    chosen = choices_text(choices)
    words = ["topo-verify", "explore", report.world, "--algorithm", text, "--choices", chosen]
    replay = shlex.join([*words, *limits.options])
    changed = [
        msgspec.structs.replace(
            finding, message=f"{finding.message} (choices: {chosen})", replay=replay
        )
        for finding in report.findings
    ]
    return report.with_findings(tuple(changed))
