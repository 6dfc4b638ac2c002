"""What was observed in worlds, as hashes: to tell whether the same happens when they are run again.

    Observation     one world: whether a claim failed there, and a hash of its runs
    digest          one hash over any number of worlds, whatever their order; digests add up

The hash of a run covers the statuses of all claims, the cost, and every door in its order. Of a run
that was out of time it covers no more than that: how far it came depends on the machine.

What this does not show: evidence and wording of declared decisions, and the numbering of the map.
A mapper that changes nothing else is taken for the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from hashlib import sha256

import msgspec

from topo_verify.harness.judge import Report
from topo_verify.harness.run import Exploration
from topo_verify.robot.events import Move

SAMPLE = 50
"""How many failing worlds, and how many others, are kept to be run again."""

_BITS = 256


class Observation(msgspec.Struct, frozen=True, array_like=True):
    """What happened in one world.

    Attributes:
        key: decides which worlds are kept for a sample: those with the least keys.
        edges, rank: of the world.
        fails: a claim failed there.
        runs: the hash of its runs; the same in another process if the mapper is deterministic.
    """

    key: str
    edges: int
    rank: int
    fails: bool
    runs: str

    @property
    def world(self) -> str:
        """The id of the world."""
        return f"m{self.edges}/{self.rank}"


class Sampler(msgspec.Struct, frozen=True):
    """Which worlds are kept as a sample, by a seed: the same ones whoever examines them.

    Attributes:
        seed: another one draws another sample.
        total: how many worlds there are in all.
    """

    seed: int
    total: int

    def key(self, edges: int, rank: int) -> str:
        """The key of a world: evenly distributed, drawn by the seed."""
        return sha256(f"{self.seed} m{edges}/{rank}".encode()).hexdigest()[:12]

    def wants(self, seen: Observation) -> bool:
        """Whether a world may be among the kept ones.

        Of the worlds without a failure most are dropped at once, so that a small part of the worlds
        carries only its share; twice what is needed is kept, so that hardly ever one is missing.
        """
        return seen.fails or int(seen.key, 16) * self.total < 2 * SAMPLE << 48


def sampled(seen: Iterable[Observation]) -> tuple[Observation, ...]:
    """The `SAMPLE` failing worlds and the `SAMPLE` others that have the least keys."""
    kept: list[Observation] = []
    ranked = sorted(set(seen), key=lambda one: (one.key, one.edges, one.rank))
    for fails in (True, False):
        kept += [one for one in ranked if one.fails == fails][:SAMPLE]
    return tuple(kept)


def run_hash(run: Exploration, report: Report) -> bytes:
    """The hash of one run; see above."""
    what: list[object] = [run.algorithm]
    if run.limit == "world-timeout":
        what.append("out of time")
    else:
        doors = [event.door for event in run.trace if isinstance(event, Move)]
        what += [list(report.claims.items()), run.cost, doors]
    return sha256(msgspec.json.encode(what)).digest()


def world_hash(runs: Iterable[bytes]) -> str:
    """The hash of a world, of those of its runs in their order."""
    return sha256(b"".join(runs)).hexdigest()[:32]


def digest(seen: Observation) -> str:
    """The digest of one world."""
    return sha256(f"{seen.world} {seen.fails} {seen.runs}".encode()).hexdigest()


def added(one: str, other: str) -> str:
    """The digest of all worlds of two digests; the empty text is the digest of none."""
    if not one or not other:
        return one or other
    total = (int(one, 16) + int(other, 16)) % (1 << _BITS)
    return f"{total:0{_BITS // 4}x}"
