"""The runs of a league: one campaign for each mapper.

It ends at its first failing world, or after `MAX_TIMEOUTS` time-outs.

**Memory** is the peak resident set of a fresh process in which the mapper plays one world.

**Hidden worlds.** A mapper can read the store while others play. So in the rows of drawn worlds
a hash of the arena's seed and the world's name replaces the name, and the map is left out. A
finding still describes its world.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

import msgspec

from topo_verify.algorithms import NAMED
from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import Attempt
from topo_verify.campaign.backend import MapperCampaign, here
from topo_verify.campaign.identity import runs_here
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.store import Store
from topo_verify.errors import InputError, plural
from topo_verify.extra.arena.league import League
from topo_verify.programs import serve
from topo_verify.programs.loader import Target
from topo_verify.programs.program import Program
from topo_verify.world.resolve import resolve_world

Tell = Callable[[str], None]


def _silent(_sentence: str) -> None:
    pass


MEMORY = "memory of "
"""The beginning of the name of a campaign that measures memory."""


def matches(league: League, store: Store | None, tell: Tell = _silent) -> list[MapperCampaign]:
    """The campaign of each mapper.

    `tell` gets a sentence about each mapper that has changed; its runs are made again.
    InputError: the store's runs were made with other options, or another topo-verify.
    """
    every = {name for mapper in league.mappers for name in league.worlds_of(mapper)}
    worlds = {name: resolve_world(name) for name in every}
    campaigns: list[MapperCampaign] = []
    for mapper in league.mappers:
        names = league.worlds_of(mapper)
        campaign = c.Campaign(
            worlds=c.ListedWorlds(len(names)),
            mappers=(mapper.text,),
            limits=league.limits,
            in_process=runs_here(mapper),
            stop=c.Stop(failing=1, timeouts=c.MAX_TIMEOUTS),
            timed=True,
        )
        kept = _kept(league, store, campaign, mapper, tell)
        campaigns.append(MapperCampaign(campaign, [(name, worlds[name]) for name in names], kept))
    return campaigns


def _kept(
    league: League,
    store: Store | None,
    campaign: c.Campaign,
    mapper: Target,
    tell: Tell,
    prefix: str = "",
) -> _Hidden | None:
    if store is None:
        return None
    name = f"{prefix}{mapper.text}"
    kept = store.resumed(campaign, [mapper], name=name, all_rows=True, renew=tell)
    return _Hidden(kept, league.seed)


def not_shown(campaigns: Sequence[MapperCampaign], store: Store) -> str:
    """A sentence about runs in the store that belong to none of these campaigns, or ""."""
    planned: set[tuple[str, str]] = set()
    for campaign in campaigns:
        assert isinstance(campaign.store, _Hidden), "it was made by `matches`"
        shards = map(campaign.store.hidden, c.listed_shards(campaign.worlds))
        planned |= {(campaign.campaign.mappers[0], shard.key) for shard in shards}
    others = Counter(name for name, _ in store.places.keys() - planned)
    runs = [
        f"{plural(number, 'run')} of {name}"
        for name, number in sorted(others.items())
        if not name.startswith(MEMORY)
    ]
    words = (
        f"In {store.path} and not shown: {', '.join(runs)}. To show them, name every mapper, suite"
    )
    return f"{words} and the seed." if runs else ""


# ---------------------------------------------------------------- hidden worlds


@dataclass(frozen=True)
class _Hidden:
    """A store in which drawn worlds cannot be recognised."""

    memory: c.ShardMemory
    seed: int

    @property
    def path(self) -> str:
        return self.memory.path

    def known(self) -> list[c.Shard]:
        return self.memory.known()

    def get(self, shard: c.Shard) -> c.ShardResult | None:
        result = self.memory.get(self.hidden(shard))
        if result is None:
            return None
        name = shard.listed[0][0]
        return _renamed(result, self._mark(name), name)

    def put(self, shard: c.Shard, result: c.ShardResult) -> None:
        name = shard.listed[0][0]
        mark = self._mark(name)
        if mark != name:
            rows = tuple(msgspec.structs.replace(row, map=None) for row in result.rows)
            tally = msgspec.structs.replace(result.tally, digest="")  # it covers the name
            bare = msgspec.structs.replace(result, tally=tally, rows=rows)
            result = _renamed(bare, name, mark)
        self.memory.put(self.hidden(shard), result)

    def hidden(self, shard: c.Shard) -> c.Shard:
        """The shard under the name of its world in the store."""
        ((name, code),) = shard.listed
        mark = self._mark(name)
        listed = ((mark, code if mark == name else ((), ())),)
        return msgspec.structs.replace(shard, listed=listed)

    def _mark(self, name: str) -> str:
        if not self.seed or ",seed=" not in name:
            return name
        return f"hidden-{sha256(f'{self.seed} {name}'.encode()).hexdigest()[:32]}"


def _renamed(result: c.ShardResult, name: str, other: str) -> c.ShardResult:
    """The result of a world under another name, also in findings."""
    text = msgspec.json.encode(result).decode().replace(name, other)
    return msgspec.json.decode(text, type=c.ShardResult)


# ---------------------------------------------------------------- memory


def measure(league: League, store: Store | None, tell: Progress) -> None:
    """Note the memory of each ranked mapper in its most expensive world."""
    ranked = [entry for entry in league.entries() if entry.place is not None]
    for done, entry in enumerate(ranked):
        assert entry.dearest is not None, "it was in every world"
        name, text = entry.dearest.world, entry.mapper
        (mapper,) = (target for target in league.mappers if target.text == text)
        alone = serve.CATALOGUE.format(text) if text in NAMED else text
        campaign = c.Campaign(
            worlds=c.ListedWorlds(1), mappers=(alone,), limits=league.limits, in_process=False
        )
        kept = _kept(league, store, campaign, mapper, _silent, MEMORY)
        worlds = [(name, resolve_world(name))]
        with suppress(InputError):
            for _, result in c.results(campaign, here(look=_peak), worlds, store=kept):
                league.peaks[text, name] = result.rows[0].note
        tell("memory", done + 1, len(ranked))


def _peak(attempt: Attempt) -> int | None:
    """The mapper's peak in kibibytes; None: unknown."""
    process = attempt.run.mapper.process if isinstance(attempt.run.mapper, Program) else None
    with suppress(OSError):
        status = Path(f"/proc/{process}/status").read_text(encoding="ascii", errors="replace")
        if (peak := re.search(r"^VmHWM:\s+(\d+) kB$", status, re.MULTILINE)) is not None:
            return int(peak[1])
    return None
