"""Tries the choices that the paper leaves open: which e comes next, in which order H is tried.

reference    the reference policies alone (and a mapper without policies)
all          every named pick policy with every named order policy
every        every choice that any policy could make, by searching states (`states/`): a vertex
with four loops has over a hundred million runs
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache
from itertools import product
from typing import Literal, get_args

from topo_verify.algorithms import Algorithm
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.campaign.attempt import Attempt, attempt
from topo_verify.campaign.campaign import Campaign
from topo_verify.campaign.judge import Report, world_argument
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.studies.search.states.every import every_choice, require_edges
from topo_verify.world.rooted_map import World

Choices = Literal["reference", "all", "every"]

CHOICES: tuple[Choices, ...] = get_args(Choices)

SHARD: dict[Choices, int] = {"reference": 400, "all": 12, "every": 8}
"""Average number of worlds in a shard, a fraction of a second of work."""

WAYS: dict[Choices, str | None] = {
    "reference": None,
    "all": f"{__name__}:by_name",
    "every": f"{__name__}:every",
}
"""The `ways` of a campaign."""

SEEDS = 3

Once = Callable[[Target], Attempt]
"""Makes one run of a mapper in the world at hand, and judges it."""


def by_name(target: Target, _world: World, once: Once) -> Iterator[Attempt]:
    """A run for each pair of named policies."""
    return map(once, named(target))


def every(target: Target, world: World, once: Once) -> Iterator[Attempt]:
    """Runs on which each choice lies; the last says what any choices can cost."""
    return every_choice(target, world, once, named(target))


def require_choices(targets: Iterable[Target], choices: Choices, edges: int) -> None:
    """Raise an InputError unless each mapper has choices and the worlds are small enough."""
    if choices not in CHOICES:
        raise InputError(f"no policies {choices!r}: a search goes through {', '.join(CHOICES)}")
    for target in targets:
        if not isinstance(target.mapper, Algorithm):
            raise InputError(
                f"{target.text} has no policies: --policies {choices} is for algorithms of the"
                " catalogue; leave it out"
            )
        if choices == "every":
            require_edges(target.text, edges)


def reports_of(campaign: Campaign, target: Target, world: World) -> Iterator[Report]:
    """The reports of a mapper in a world, one for each way of choosing."""
    ways = {WAYS["all"]: by_name, WAYS["every"]: every}[campaign.ways]

    def once(variant: Target) -> Attempt:
        where = world_argument(world)
        return attempt(world, variant, campaign.limits, where=where, witness=False)

    return (run.report for run in ways(target, world, once))


@cache
def named(target: Target) -> tuple[Target, ...]:
    """The mapper with each pair of named policies, reference first."""
    mapper = target.mapper
    assert isinstance(mapper, Algorithm)
    random = [f"random({seed})" for seed in range(SEEDS)]
    pairs = product([*PICKS, *random], [*ORDERS, *random])
    return tuple(
        Target(target.text, mapper.with_policies(pick=pick, order=order)) for pick, order in pairs
    )
