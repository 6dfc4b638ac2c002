"""Tries every check on every seeded fault: does it find the fault, how fast, in which world?

    search       every world of 1, 2, … edges up to the first size in which a claim fails
    properties   property tests on two strategies, five seeds each

A fault is caught if each requested check finds it; a harmless difference must be found by none.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from statistics import median
from typing import Literal, get_args

import msgspec

from topo_verify.campaign.progress import Progress
from topo_verify.campaign.run import Engine, explore, planted, require_compiled
from topo_verify.checkers import CLAIMS
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.errors import InputError
from topo_verify.faults import FAULTS, Fault
from topo_verify.faults.fault import ForwardingRobot
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Augment, Decision, Move, Robot
from topo_verify.robot.limits import Limits
from topo_verify.studies.beside import Beside
from topo_verify.studies.search.search import SearchEntry, search
from topo_verify.world.rooted_map import World

Check = Literal["search", "properties"]
CHECKS: tuple[Check, ...] = get_args(Check)

LARGEST_HARMLESS, LARGEST_THOROUGH = 4, 5
"""Most edges for a harmless difference: usually; if thorough."""


class Caught(msgspec.Struct, frozen=True):
    """One fault and what each check found.

    Attributes:
        name, part, why, claim, harmless, target: of the fault.
        search, properties: null if the check was not requested.
        asked: the number of checks that apply to it.
        undecided: nothing is wrong, but a run was out of time.
        ok: every requested check caught the fault; none, for a harmless difference.
    """

    name: str
    part: str
    why: str
    claim: str | None
    harmless: bool
    target: str
    search: Smallest | None
    properties: Examples | None
    asked: int
    undecided: bool
    ok: bool


def named_faults(names: Sequence[str]) -> list[Fault]:
    """The faults with these names; without names all. InputError for an unknown name."""
    unknown = [name for name in names if name not in FAULTS]
    if unknown:
        raise InputError(
            f"expected the name of a fault, got {unknown[0]!r}; the faults are {', '.join(FAULTS)}"
        )
    return [FAULTS[name] for name in names] or list(FAULTS.values())


def mapper_of(entry: Caught) -> Target:
    """The mapper with the fault of an entry."""
    return Target(entry.target, FAULTS[entry.name].mapper)


def warm(faults: Iterable[Fault]) -> None:
    """Compile the kernels with these mistakes for the cache."""
    require_compiled((), Limits())
    if mapper := next(filter(None, (planted(fault.name) for fault in faults)), None):
        explore(World.from_id("m1/0"), Target(mapper.name, mapper))


def try_faults(
    faults: Iterable[Fault],
    *,
    by: Sequence[Check] = CHECKS,
    workers: int = 0,
    thorough: bool = False,
    engine: Engine = "reference",
    tell: Progress | None = None,
) -> Iterator[Caught]:
    """Try the checks on each of these faults, in order.

    If `thorough`, failing worlds of every size are counted, and harmless differences are tried
    up to 5 edges. `engine` runs faults that have a kernel in worlds of up to `COUNTED` edges.
    """
    faults = list(faults)
    # A worker finds a fault by its name.
    known = all(FAULTS.get(fault.name) is fault for fault in faults)
    if workers and known and len(faults) > 1:
        names = [fault.name for fault in faults]
        arguments = tuple(by), thorough, engine
        with Beside(tried, names, arguments, result=Caught, workers=workers) as beside:
            for fault in faults:
                entry = beside.result(fault.name)
                yield _to_the_end(fault, entry, workers, thorough=thorough, tell=tell)
    else:
        for fault in faults:
            entry = tried(fault, by, thorough, engine)
            yield _to_the_end(fault, entry, workers, thorough=thorough, tell=tell)


def tried(fault: Fault | str, by: Sequence[Check], thorough: bool, engine: Engine) -> Caught:  # noqa: FBT001  called in a worker
    """What the checks find of a fault, without the larger worlds; a worker gets its name."""
    if isinstance(fault, str):
        fault = FAULTS[fault]
    last = (LARGEST_THOROUGH if thorough else LARGEST_HARMLESS) if fault.harmless else COUNTED
    return entry_of(
        fault,
        smallest(fault, largest=last, engine=engine) if "search" in by else None,
        examples(fault) if "properties" in by else None,
    )


def _to_the_end(
    fault: Fault, entry: Caught, workers: int, *, thorough: bool, tell: Progress | None
) -> Caught:
    if fault.harmless or entry.search is None or entry.search.failing:
        return entry
    larger = smallest(fault, first=COUNTED + 1, workers=workers, thorough=thorough, tell=tell)
    return entry_of(fault, larger, entry.properties)


def entry_of(fault: Fault, searched: Smallest | None, drawn: Examples | None) -> Caught:
    """The entry of a fault, given the results of the checks."""
    asked: list[bool | None] = []
    if searched is not None:
        caught = bool(searched.failing) if fault.harmless else fault.claim in searched.claims
        asked.append(_finds_what_it_must(fault, caught, searched.undecided))
    if drawn is not None:
        caught = drawn.found if fault.harmless else drawn.median_examples is not None
        asked.append(_finds_what_it_must(fault, caught, drawn.undecided))
    return Caught(
        name=fault.name,
        part=fault.part,
        why=fault.why,
        claim=fault.claim,
        harmless=fault.harmless,
        target=fault.target,
        search=searched,
        properties=drawn,
        asked=len(asked),
        undecided=None in asked and False not in asked,
        ok=all(asked),
    )


def _finds_what_it_must(fault: Fault, caught: bool, undecided: int) -> bool | None:  # noqa: FBT001  private
    if caught:
        return not fault.harmless
    return None if undecided else fault.harmless


# ---------------------------------------------------------------- one fault and one check

LARGEST = 7

COUNTED = 5
"""Most edges of worlds in which all failing ones are counted, unless thorough."""

SEEDS = range(5)
EXAMPLES = 100

STRATEGIES = (
    "worlds(max_edges=30)",
    "worlds(min_edges=16,max_edges=24,max_degree=4,simple=True)",
)
"""Any worlds, mostly small; and street networks whose ways home lead through known places."""

A_SECOND = Limits(move_timeout=1, world_timeout=1)
"""A mapper that circles on its map without moving fills the memory in a minute."""

TIMEOUT = 20.0
"""Seconds for a question to the solver."""


class Smallest(msgspec.Struct, frozen=True):
    """The worlds of the smallest size in which a claim fails.

    Attributes:
        edges: that size; the largest that was searched if nothing was found.
        failing, checked, total: numbers of worlds of that size.
        undecided: number of searched worlds in which a run was out of time.
        claims: for each failing claim, the number of worlds.
        world: the first of them.
        convicting: the first that claims 9 and 10 alone convict.
        message, replay: what is wrong in `world`, and the command line that shows it again.
    """

    edges: int
    failing: int
    checked: int
    total: int
    undecided: int = 0
    claims: dict[str, int] = {}
    world: str | None = None
    convicting: str | None = None
    message: str = ""
    replay: str = ""


class Examples(msgspec.Struct, frozen=True):
    """What property tests found.

    Attributes:
        median_examples: examples needed with the first strategy that succeeds with all seeds.
        strategy: that strategy.
        examples: by strategy, for each seed; null where nothing was found.
        most: the number of examples after which a test gives up.
        undecided: the number of examples that were cut off.
    """

    median_examples: int | None
    strategy: str | None
    examples: dict[str, tuple[int | None, ...]]
    most: int
    undecided: int = 0

    @property
    def found(self) -> bool:
        """Whether any test fails."""
        return any(number is not None for row in self.examples.values() for number in row)


# ---------------------------------------------------------------- exhaustive search


def smallest(
    fault: Fault,
    *,
    first: int = 1,
    largest: int = LARGEST,
    workers: int = 0,
    thorough: bool = False,
    engine: Engine = "reference",
    tell: Progress | None = None,
) -> Smallest:
    """Search the worlds of 1, 2, … edges up to the first size in which a claim fails.

    `first` is the first size at which to stop. If `thorough`, failing worlds are counted also
    beyond `COUNTED` edges.
    """
    target = Target(fault.target, (planted(fault.name) if engine == "compiled" else None) or fault)
    limits = A_SECOND if fault.harmless else None
    edges = first - 1
    while True:
        edges += 1
        counted = thorough or edges <= COUNTED
        # From one edge on each time, so `undecided` counts all sizes.
        entry = search(
            target,
            edges=edges if counted else largest,
            keep_going=counted,
            limits=limits,
            workers=workers,
            tell=tell,
        )
        if entry.counterexample is not None or entry.edges == largest:
            return _smallest(entry)


def _smallest(entry: SearchEntry) -> Smallest:
    first = entry.counterexample
    size = entry.by_edges[-1 if first is None else first.edges - 1]
    convicting = (
        claim.smallest.world
        for claim in entry.claims
        if claim.claim in ("map-entailed", "decisions-entailed")
    )
    return Smallest(
        edges=size.edges,
        failing=size.failing,
        checked=size.checked,
        total=size.total,
        undecided=sum(size.undecided for size in entry.by_edges),
        claims={claim.claim: claim.failing for claim in entry.claims},
        world=first.world if first else None,
        convicting=min(convicting, key=lambda world: int(world.partition("/")[2]), default=None),
        message=first.message if first else "",
        replay=first.replay if first else "",
    )


# ---------------------------------------------------------------- property tests


class _Failed(Exception):
    pass


def examples(fault: Fault, *, seeds: Sequence[int] = SEEDS, most: int = EXAMPLES) -> Examples:
    """The examples that property tests take to find the fault, by strategy and seed."""
    numbers: dict[str, tuple[int | None, ...]] = {}
    undecided = 0
    for strategy in STRATEGIES:
        row = [examples_to_detection(fault, strategy, seed, most=most) for seed in seeds]
        numbers[strategy] = tuple(number for number, _ in row)
        undecided += sum(late for _, late in row)
        numbers_found = [number for number, _ in row if number is not None]
        if len(numbers_found) == len(seeds):
            return Examples(round(median(numbers_found)), strategy, numbers, most, undecided)
    return Examples(None, None, numbers, most, undecided)


def examples_to_detection(
    fault: Fault, strategy: str, seed: int, *, most: int = EXAMPLES
) -> tuple[int | None, int]:
    """After how many examples a property test fails, or None; and how many were undecided.

    Hypothesis's default settings, but without example database, shrinking, and literals of modules.
    """
    import hypothesis

    from topo_verify.strategies.sample import drawing_no_literals, resolve_strategy

    tried = undecided = 0
    failed_after: int | None = None
    failing: World | None = None

    @hypothesis.seed(seed)
    @hypothesis.settings(
        max_examples=most,
        phases=[hypothesis.Phase.generate],
        database=None,
        deadline=None,
        derandomize=False,
        suppress_health_check=[
            hypothesis.HealthCheck.too_slow,
            hypothesis.HealthCheck.filter_too_much,
        ],
        report_multiple_bugs=False,
    )
    @hypothesis.given(resolve_strategy(strategy))
    def every_claim_holds(world: World) -> None:
        nonlocal tried, failed_after, failing, undecided
        if world == failing:  # once more, to be shown
            raise _Failed
        tried += 1
        wrong = fails(fault, world)
        undecided += wrong is None
        if wrong:
            failed_after, failing = failed_after or tried, world
            raise _Failed

    with drawing_no_literals(), suppress(_Failed):
        every_claim_holds()
    return failed_after, undecided


def fails(fault: Fault, world: World) -> bool | None:
    """Whether a claim fails in this world; None: the run was cut off, which says nothing.

    Declaring more edges than there are is failing: a wrong map S may grow without end. A faulty
    mapper may make 4m² moves, twice what the catalogue is known to need.
    """
    edges = len(world.edges)
    bound = world.cost_bound
    budget = bound if fault.harmless else min(bound, 4 * edges**2)
    limits = replace(A_SECOND, budget=budget)
    target = Target(fault.target, lambda robot: fault(_Counting(robot, edges)))
    run = explore(world, target, limits=limits)
    # Only the bound of claim 7 counts against a mapper.
    if run.limit is not None and (run.limit != "budget" or budget < bound):
        return None
    if run.map is None or run.cost != sum(isinstance(event, Move) for event in run.trace):
        return True
    replayed = ReplayedTrace(world, run.trace, run.stopped)
    return any(True for claim, _ in CLAIMS.values() for _ in claim(replayed))


class _Counting(ForwardingRobot):
    def __init__(self, robot: Robot, edges: int) -> None:
        super().__init__(robot)
        self.edges_left = edges

    def declare(self, event: Decision) -> None:
        self.edges_left -= isinstance(event, Augment)
        if self.edges_left < 0:
            raise _Failed
        super().declare(event)
