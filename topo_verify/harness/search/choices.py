"""Tries the choices that the paper leaves open: which e comes next, in which order H is tried.

A claim must hold for all of them. A search goes through

    reference    the reference policies alone (and a mapper that has no policies as it is)
    all          every named pick policy with every named order policy, `random` with a few seeds
    every        every choice that any policy could make

`every` searches the states of each world: `states/`. Before that it went through runs one by one,
which grow beyond all bounds that matter (a vertex with four loops has over a hundred million).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cache, partial
from itertools import product

from topo_verify.algorithms import Algorithm
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.errors import InputError
from topo_verify.harness.judge import Report, judge
from topo_verify.harness.run import Exploration
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.search.states.every import every_choice, require_edges
from topo_verify.harness.second_try import Tried, tried
from topo_verify.harness.tally import PolicyCosts
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World

SEEDS = 3
"""How many seeds of `random` are among all policies."""


def examinations(
    target: Target,
    plan: Plan,
    world: World,
    beat: Callable[[], None],
    note: Callable[[PolicyCosts], None] | None = None,
) -> Iterator[Tried]:
    """The mapper's runs in a world, one for each way of choosing, each with its report.

    With `every` these are so many runs that each choice lies on one of them, or two: `every.py`.

    Args:
        beat: called before anything that may take long.
        note: called once, with `every`, with what any choices can cost, if no claim fails.
    """
    if plan.choices == "every":
        run = partial(_examined, limits=plan.limits, world=world, beat=beat)
        yield from every_choice(target, world, run, plan.limits, note)
    else:
        for variant in _variants(target, named=plan.choices == "all"):
            yield _examined(variant, plan.limits, world, beat)


def require_choices(targets: Iterable[Target], plan: Plan) -> None:
    """Raise an InputError unless each mapper has these choices and the worlds are small enough."""
    if plan.choices == "reference":
        return
    for target in targets:
        if not isinstance(target.mapper, Algorithm):
            raise InputError(
                f"{target.text} has no policies: --policies {plan.choices} is for algorithms of the"
                " catalogue; leave it out"
            )
        if plan.choices == "every":
            require_edges(target.text, target.mapper, plan.edges)


def _examined(target: Target, limits: Limits, world: World, beat: Callable[[], None]) -> Tried:
    def judged(run: Exploration) -> Report:
        beat()
        if not isinstance(target.mapper, Algorithm):
            # Choices are made for this world alone: they cannot be repeated in a witness world.
            run = replace(run, mapper=None)
        return judge(run, options=limits.options)

    beat()
    return tried(world, target, limits, judged)


# ---------------------------------------------------------------- named policies


def _variants(target: Target, *, named: bool) -> tuple[Target, ...]:
    """The mapper with each pair of named policies; without `named`, as it is."""
    if not named or not isinstance(target.mapper, Algorithm):
        return (target,)  # not from a cache, which would keep the process of a program alive
    return _named(target.text, target.mapper)


@cache
def _named(text: str, mapper: Algorithm) -> tuple[Target, ...]:
    """An algorithm with each pair of named policies."""
    random = [f"random({seed})" for seed in range(SEEDS)]
    pairs = product([*PICKS, *random], [*ORDERS, *random])
    return tuple(
        Target(text, mapper.with_policies(pick=pick, order=order)) for pick, order in pairs
    )
