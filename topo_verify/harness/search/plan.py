"""The plan of a search and its shards, as data for workers and the ledger."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Literal, get_args

import msgspec

from topo_verify.errors import InputError
from topo_verify.harness.engines import Engine
from topo_verify.harness.observed import Sampler
from topo_verify.robot.limits import Limits
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass

Choices = Literal["reference", "all", "every"]
"""Which policies a search goes through; see `choices.py`."""

CHOICES: tuple[Choices, ...] = get_args(Choices)

SHARD: dict[Choices, int] = {"reference": 400, "all": 12, "every": 8}
"""How many worlds a shard has on average: a fraction of a second of work, where one world is."""

COMPILED_SHARD = 500_000
"""How many worlds a shard of the compiled engine has on average: about two seconds of work."""


class Shard(msgspec.Struct, frozen=True):
    """The worlds of the class with so many edges and ranks start … stop-1 (ranks in `any`)."""

    edges: int
    start: int
    stop: int


class Plan(msgspec.Struct, frozen=True, kw_only=True):
    """What a search goes through, and when it stops.

    Attributes:
        targets: mappers by their texts; each runs in every world.
        edges: worlds of 1 to this many.
        kind: the class of worlds, as text.
        choices: which policies.
        keep_going: do not stop at the first counterexample.
        max_timeouts: stop after about so many time-outs; None: never.
        limits: of one run.
        seed: of what is drawn: the worlds that are run again.
        in_process: mappers that are not of the catalogue share the process of the harness.
        engine: what runs the algorithms of the catalogue.
    """

    targets: tuple[str, ...]
    edges: int
    kind: str = "any"
    choices: Choices = "reference"
    keep_going: bool = False
    max_timeouts: int | None = None
    limits: Limits = Limits()
    seed: int = 0
    in_process: bool = True
    engine: Engine = "reference"

    def __post_init__(self) -> None:
        if self.edges < 1:
            raise InputError(f"edges={self.edges}: a search goes through worlds of 1 edge and more")
        if self.choices not in CHOICES:
            raise InputError(
                f"no policies {self.choices!r}: a search goes through {', '.join(CHOICES)}"
            )
        if self.engine == "compiled" and self.choices != "reference":
            raise InputError(
                f"--engine compiled with --policies {self.choices}: it knows the reference policies"
                " only; leave one of the two out"
            )

    @property
    def world_class(self) -> WorldClass:
        """The class of worlds."""
        return WorldClass.parse(self.kind)

    def totals(self) -> dict[int, int]:
        """How many worlds there are of each size, counted without listing them in this order.

        Raises:
            InputError: there is no way to count them.
        """
        kind = self.world_class
        _total(kind, self.edges)  # if there is no way, this size says so first
        return {edges: _total(kind, edges) for edges in range(1, self.edges + 1)}

    @property
    def sampler(self) -> Sampler:
        """Which worlds are run again."""
        return Sampler(self.seed, sum(self.totals().values()))

    @property
    def shard(self) -> int:
        """How many worlds a shard has on average."""
        return COMPILED_SHARD if self.engine == "compiled" else SHARD[self.choices]

    def shards(self) -> Iterator[Shard]:
        """The shards. They depend on the plan alone, so a later search finds them in a ledger."""
        for edges, worlds in self.totals().items():
            ranks = rank_order.count(edges)
            width = max(1, ranks * self.shard // max(1, worlds))
            for start in range(0, ranks, width):
                yield Shard(edges, start, min(start + width, ranks))


@cache
def _total(kind: WorldClass, edges: int) -> int:
    return kind.count(edges)
