"""Engines: what runs and judges the worlds of a campaign.

The main house has one engine, the reference: a mapper runs with a robot, and the checkers judge its
trace. An extra may bring a faster one, found by its name through topo_verify/extras.py. It is not
trusted: a claim or an event that it does not know it leaves open, and the checkers judge that.

    engine_of("reference")                       # -> Engine

`Engine` is the reference itself, and another engine replaces its methods. What it does with the
shards of a campaign, and what a lost worker means there, is in examiner.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

import msgspec

from topo_verify import extras
from topo_verify.checkers import Judgement
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Event
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World


class EngineSeconds(msgspec.Struct, frozen=True):
    """Processor seconds of another engine than the reference, and of the checkers beside it."""

    engine: float = 0.0
    checkers: float = 0.0

    def __add__(self, other: EngineSeconds) -> EngineSeconds:
        return EngineSeconds(self.engine + other.engine, self.checkers + other.checkers)


class Checks(Protocol):
    """A function that gives the judgements of `check`, perhaps faster."""

    def __call__(
        self, world: World, trace: Sequence[Event], stopped: str | None = None, *, strict: bool
    ) -> Sequence[Judgement]:
        """Judge as `check` does."""
        ...


class Engine:
    """The reference engine; another one replaces what it does otherwise.

    Attributes:
        examiner: `module:function` that makes the `Examiner` of a campaign; None: the reference's.
    """

    name = "reference"
    examiner: str | None = None

    def is_usual(self, mappers: Sequence[Target], worlds: int) -> bool:
        """Whether a search of this number of worlds uses this engine unless another is named."""
        del mappers, worlds
        return False

    def shard(self, mappers: Sequence[Target]) -> int | None:
        """Average number of worlds in a shard of a search; None: as its policies need."""
        del mappers
        return None

    def require(self, mappers: Sequence[Target], limits: Limits) -> None:
        """Raise an InputError unless it runs these mappers in single worlds under these limits."""

    def require_search(self, mappers: Sequence[Target], limits: Limits, choices: str) -> None:
        """Raise an InputError unless it searches for these mappers with these policies."""

    def mapper(self, target: Target) -> Target:
        """The same mapper, as this engine runs it in single worlds."""
        return target

    def checks(self) -> Checks | None:
        """What judges many runs in small worlds; None: the checkers."""
        return None


REFERENCE_ENGINE = Engine()

ENGINES = (REFERENCE_ENGINE.name, *extras.ENGINES)
"""The names of all engines."""


def engine_of(name: str) -> Engine:
    """The engine of this name; InputError if there is none."""
    if name not in ENGINES:
        raise InputError(f"engine={name!r}: expected one of {', '.join(ENGINES)}")
    if name == REFERENCE_ENGINE.name:
        return REFERENCE_ENGINE
    engine: Engine = extras.engine(name)
    return engine


def usual_engine(mappers: Sequence[Target], worlds: int) -> str:
    """The engine of a search of these worlds if none is named: one whose packages are here."""
    for name in extras.usable_engines():
        if engine_of(name).is_usual(mappers, worlds):
            return name
    return REFERENCE_ENGINE.name


def on_engine(name: str, targets: Iterable[Target], limits: Limits) -> tuple[Target, ...]:
    """The same mappers for single worlds by this engine; InputError if it cannot run one."""
    engine, mappers = engine_of(name), tuple(targets)
    engine.require(mappers, limits)
    return tuple(map(engine.mapper, mappers))
