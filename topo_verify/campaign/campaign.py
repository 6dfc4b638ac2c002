"""A campaign as data (worlds, mappers, limits, what is kept), and its results in order.

    for shard, result in results(campaign, backend):
        tally += result.tally
        rows += result.rows

A backend examines shards of worlds in any order and process; `results` restores the order and
drops what lies behind the world at which a campaign stops. So results depend on the campaign
alone.

`examine` is the only loop over worlds and mappers. A study extends it by functions named
`module:function`: `look` notes more about a run, `ways` makes several runs of a mapper in a
world.

A mapper that knew the order of a list could be right by counting worlds, so a seed shuffles each
`BLOCK` of them. What this does not show: that a mapper does not know its block.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Generator, Iterable, Iterator, Sequence
from contextlib import closing
from functools import cache, partial
from hashlib import sha256
from itertools import chain, islice
from random import Random
from typing import Any, Literal, Protocol

import msgspec

from topo_verify.campaign.attempt import Attempt, Look, attempt, row_of
from topo_verify.campaign.engine import Checks, EngineSeconds, on_engine
from topo_verify.campaign.judge import CheckedTraces
from topo_verify.campaign.loss import Loss
from topo_verify.campaign.progress import Progress, ProgressRate
from topo_verify.campaign.row import Row, with_lost
from topo_verify.campaign.tally import Counts, Notable, Tally
from topo_verify.campaign.targets import targets
from topo_verify.campaign.worker import Beat, function_at, no_beat
from topo_verify.errors import InputError, WriteError
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target
from topo_verify.programs.program import OPTIONS, Program
from topo_verify.robot.limits import Limits, telling_moves
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import ranked_tables
from topo_verify.world.rooted_map import Code, World

BLOCK = 10_000
"""Listed worlds that are shuffled together."""

MAX_LOST = 3
"""Worlds that may cost a worker each until a library's other worlds are left."""

MAX_TIMEOUTS = 3
"""Time-outs, and in some studies failing worlds, after which a mapper's other worlds are left."""

AGAIN = 200
"""Least number of stored worlds that a resumed campaign examines again."""

NamedCodes = tuple[tuple[str, Code], ...]
"""Worlds of a list, by name."""

Ways = Callable[[Target, World, Callable[[Target], Attempt]], Iterator[Attempt]]
"""Makes the runs of a mapper in a world; the function that makes one run is passed in."""


class Shard(msgspec.Struct, frozen=True):
    """Worlds that are examined together.

    Attributes:
        edges: their size; 0 if they are listed.
        start, stop: their ranks, or their places in the list.
        listed: the name and the code of each listed world.
    """

    edges: int
    start: int
    stop: int
    listed: NamedCodes = ()

    @property
    def key(self) -> str:
        """The shard's name in a store: its ranks, or a hash of its worlds."""
        if not self.listed:
            return f"m{self.edges}/{self.start}-{self.stop}"
        return f"listed-{sha256(msgspec.json.encode(self.listed)).hexdigest()}"


MOST_WORLDS = 10**18
"""Most worlds of a search: at a million worlds a second they take 30,000 years."""


class Ranks(msgspec.Struct, frozen=True, tag="ranks"):
    """Every world of a class with 1 to `edges` edges; a shard has `shard` worlds on average."""

    edges: int
    kind: str = "any"
    shard: int = 400

    def __post_init__(self) -> None:
        most = rank_order.MAX_ID_EDGES
        if type(self.edges) is not int or not 1 <= self.edges <= most:
            raise InputError(
                f"edges={self.edges!r}: expected an integer from 1 to {most}; a search goes through"
                " the worlds of 1 edge and more"
            )

    @property
    def world_class(self) -> WorldClass:
        """The class of worlds."""
        return WorldClass.parse(self.kind)

    def totals(self) -> dict[int, int]:
        """The number of worlds of each size.

        InputError: no formula counts the class, or it has more than MOST_WORLDS worlds.
        """
        _total(self.world_class, self.edges)  # if there is no way, this size says so first
        totals: dict[int, int] = {}
        for edges in range(1, self.edges + 1):
            totals[edges] = _total(self.world_class, edges)
            if sum(totals.values()) > MOST_WORLDS:
                raise InputError(
                    f"--edges {self.edges}: class {self.kind} has over {MOST_WORLDS:,} worlds with"
                    f" up to {edges} edges, and no search of them ends: expected at most"
                    f" {edges - 1} edges"
                )
        return totals

    def shards(self) -> Iterator[Shard]:
        """The shards; they depend on the class alone, so another campaign finds them in a store."""
        for edges, ranks, width in self.widths():
            for start in range(0, ranks, width):
                yield Shard(edges, start, min(start + width, ranks))

    def widths(self) -> Iterator[tuple[int, int, int]]:
        """Of each size: the edges, the number of ranks, and of ranks in a shard."""
        for edges, worlds in self.totals().items():
            ranks = rank_order.count(edges)
            yield edges, ranks, max(1, ranks * self.shard // max(1, worlds))

    def worlds(self, shard: Shard) -> Iterator[tuple[int, str, World]]:
        """Rank, id and world of each world in a shard."""
        for rank, code in ranked_tables(shard.edges, self.world_class, shard.start, shard.stop):
            world = World.from_code(code, rank=rank)
            yield rank, world.id, world


@cache
def _total(kind: WorldClass, edges: int) -> int:
    return kind.count(edges)


class ListedWorlds(msgspec.Struct, frozen=True, tag="listed"):
    """Worlds of a list, each a shard. The list itself stays with the caller."""

    total: int

    def totals(self) -> dict[int, int]:
        """The number of worlds of all sizes together, under the key 0."""
        return {0: self.total}

    def worlds(self, shard: Shard) -> Iterator[tuple[int, str, World]]:
        """Place, name and world of each world in a shard."""
        for place, (name, code) in enumerate(shard.listed, shard.start):
            yield place, name, World.from_code(code)


NamedWorlds = Iterable[tuple[str, World]]
"""The worlds of a list, by name; iterated twice."""


def listed_shards(worlds: NamedWorlds) -> Iterator[Shard]:
    """One shard for each world of a list."""
    for place, (name, world) in enumerate(worlds):
        yield Shard(0, place, place + 1, ((name, world.code),))


class Stop(msgspec.Struct, frozen=True):
    """Numbers of failing worlds and of time-outs that end a campaign.

    Attributes:
        still: number of worlds after which a mapper that stood still in each of them is left.
        lost: worlds that cost a worker each.
    """

    failing: int | None = None
    timeouts: int | None = None
    still: int | None = None
    lost: int | None = None

    def reached(self, numbers: Tally | Counts) -> bool:
        """Whether these numbers end the campaign."""
        fails = self.failing is not None and numbers.failing >= self.failing
        slow = self.timeouts is not None and numbers.timeouts >= self.timeouts
        hangs = numbers.worlds == numbers.timeouts and not numbers.undecided
        costly = self.lost is not None and numbers.lost >= self.lost
        return (
            fails
            or slow
            or costly
            or (self.still is not None and hangs and numbers.worlds >= self.still)
        )


class Campaign(msgspec.Struct, frozen=True, kw_only=True):
    """What is to be run, as data that can be hashed, stored and sent.

    Attributes:
        engine: the name of what runs and judges.
        in_process: a user's mapper shares the process of the harness.
        strict: ask claim 10 in worlds of more than 2,000 edges, too.
        validate: refuse unknown and repeated fields in a program's messages.
        record: keep the messages of a program in each `Attempt`.
        look, asked: `module:function` of a `Look`, and its arguments.
        ways: `module:function` of `Ways`; None: one run of each mapper in each world.
        seed: of the sample, and of the order of a list.
        drawn: shuffle the list.
        timed: measure the processor time of each run.
    """

    worlds: Ranks | ListedWorlds
    mappers: tuple[str, ...]
    pick: str | None = None
    order: str | None = None
    engine: str = "reference"
    limits: Limits = Limits()
    in_process: bool = True
    strict: bool = False
    validate: bool = False
    record: bool = False
    stop: Stop = Stop()
    keep: Literal["all", "notable"] = "all"
    look: str | None = None
    asked: tuple[str, ...] = ()
    ways: str | None = None
    seed: int = 0
    drawn: bool = False
    timed: bool = False

    def load(self) -> tuple[Target, ...]:
        """The mappers, as `targets` has them. InputError if the engine cannot run them."""
        find = partial(targets, pick=self.pick, order=self.order, in_process=self.in_process)
        mappers = tuple(target for text in self.mappers for target in find(text))
        for mapper in (target.mapper for target in mappers):
            # The messages of a mapper in Python are ours.
            if isinstance(mapper, Program) and not isinstance(mapper, Foreign):
                mapper.validate, mapper.record = self.validate, self.record
        listed = isinstance(self.worlds, ListedWorlds)
        return on_engine(self.engine, mappers, self.limits) if listed else mappers

    def identity(self, sources: str) -> dict[str, str]:
        """Everything that changes a row: a store with the same identity can be resumed.

        The extent is left out, so that a finished campaign can be extended. `sources` is a hash
        of the mappers' sources.
        """
        known: dict[str, Any] = msgspec.to_builtins(self)
        worlds = known.pop("worlds")
        chosen = {"target": ",".join(known.pop("mappers")), "hash": sources}
        if isinstance(self.worlds, Ranks):
            chosen["class"] = worlds["kind"]
        for name in ("drawn", "keep", "record", "timed"):  # no row depends on them
            del known[name]
        if not any(":" in text and not text.startswith(OPTIONS) for text in self.mappers):
            del known["in_process"]  # it is about a user's mapper in Python alone
        if isinstance(self.worlds, Ranks):
            known["shard"] = worlds["shard"]  # the last, since options decide it
        return chosen | {
            name.replace("_", "-"): value
            if isinstance(value, str)
            else msgspec.json.encode(value).decode()
            for name, value in known.items()
        }


class ShardResult(msgspec.Struct, frozen=True):
    """The result of a shard; `loaded` is None if the mappers were not asked what they load."""

    tally: Tally = Tally()
    rows: tuple[Row, ...] = ()
    loaded: Loaded | None = None
    seconds: EngineSeconds = EngineSeconds()

    def with_loss(self, row: Row) -> ShardResult:
        """The same with a lost worker's row, in the place of the run that passed."""
        tally, rows = self.tally.amended(row), tuple(with_lost(self.rows, row))
        return msgspec.structs.replace(self, tally=tally, rows=rows)


ShardResults = Generator[tuple[Shard, ShardResult]]
"""Shards, each with its result."""

InFlight = Beat
"""Receives, from time to time, the number of finished runs in unfinished shards."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C within a shard; `result` covers its finished worlds."""

    def __init__(self, shard: Shard, result: ShardResult) -> None:
        super().__init__()
        self.shard, self.result = shard, result


# ---------------------------------------------------------------- the loop


def examine(  # noqa: PLR0913  an argument an option
    campaign: Campaign,
    mappers: Sequence[Target],
    shard: Shard,
    beat: Beat = no_beat,
    look: Look | None = None,
    known: Checks | None = None,
    drawn: Container[str] = (),
    *,
    witness: bool = True,
) -> ShardResult:
    """Run every mapper in every world of a shard; Ctrl-C raises `Interrupted`.

    `look` replaces the campaign's, `known` the checkers; `drawn` worlds are to be run again;
    `witness` is as in `attempt`.
    """
    counts, kept, rows = Counts(), Notable(campaign.seed), list[Row]()
    first_runs: dict[str, str] = {}

    def result() -> ShardResult:
        tally = msgspec.structs.replace(counts.tally(), first_runs=first_runs)
        return ShardResult(tally, (*rows, *kept.rows()))

    if look is None and campaign.look is not None:
        look = function_at(campaign.look)(*campaign.asked)
    ways: Ways = _one_way if campaign.ways is None else function_at(campaign.ways)
    done = 0
    try:
        for place, name, world in campaign.worlds.worlds(shard):
            world_rows: list[Row] = []
            several = len(mappers) > 1 or campaign.ways is not None
            checks = CheckedTraces() if several else known
            for target in mappers:
                tell = partial(beat, done)
                ours = target.mapper if witness else None
                once = partial(_attempt, campaign, world, name, checks, tell, ours=ours)
                with telling_moves(partial(beat, done, name)):
                    for run in ways(target, world, once):
                        world_rows.append(row_of(run, name, place, len(world_rows), look))
                done += 1
            counts.enter(world_rows)
            if name in drawn:
                first_runs[name] = world_rows[0].digest
            if campaign.keep == "all":
                rows += world_rows
            else:
                kept.enter(world_rows)
            if campaign.stop.reached(counts):
                break
    except KeyboardInterrupt:
        raise Interrupted(shard, result()) from None
    return result()


def _attempt(
    campaign: Campaign,
    world: World,
    name: str,
    known: Checks | None,
    beat: Callable[[], None],
    target: Target,
    *,
    ours: object,
) -> Attempt:
    # Choices that are made for one world cannot be repeated in a witness world.
    witness = target.mapper is ours or (ours is not None and campaign.ways is None)
    return attempt(
        world,
        target,
        campaign.limits,
        where=name,
        strict=campaign.strict,
        witness=witness,
        known=known,
        timed=campaign.timed,
        beat=beat,
    )


def _one_way(target: Target, _world: World, once: Callable[[Target], Attempt]) -> Iterator[Attempt]:
    yield once(target)


def close(mappers: Iterable[Target]) -> None:
    """End the processes of mappers that have one."""
    for target in mappers:
        if isinstance(target.mapper, Program):
            target.mapper.close()


# ---------------------------------------------------------------- shards in order


Backend = Callable[[Campaign, Iterator[Shard], InFlight], ShardResults]
"""Examines shards and yields each once finished: in this process, in workers, on a cluster."""


def _idle(_campaign: Campaign, _shards: Iterator[Shard], _in_flight: InFlight) -> ShardResults:
    yield from ()


class ShardMemory(Protocol):
    """Keeps the results of finished shards; a `Store` provides one."""

    @property
    def path(self) -> str:
        """The path of its file."""
        ...

    def get(self, shard: Shard) -> ShardResult | None:
        """The result of a shard; None if it is not finished."""
        ...

    def put(self, shard: Shard, result: ShardResult) -> None:
        """Keep the result of a finished shard."""
        ...

    def known(self) -> list[Shard]:
        """The finished shards of a class, in order."""
        ...


def results(
    campaign: Campaign,
    backend: Backend,
    worlds: NamedWorlds = (),
    *,
    store: ShardMemory | None = None,
    tell: Progress | None = None,
) -> ShardResults:
    """Yield each shard with its result, in order, until the last or until the campaign stops.

    After Ctrl-C, the finished worlds are yielded before KeyboardInterrupt is raised. InputError:
    a shard of the store, examined again, has another result.
    """
    order = _Order(campaign, backend, worlds, store, tell)
    if store is not None and isinstance(campaign.worlds, Ranks):
        order.examine_again(store)
    return order.results()


class _Order:
    def __init__(
        self,
        campaign: Campaign,
        backend: Backend,
        worlds: NamedWorlds,
        store: ShardMemory | None,
        tell: Progress | None,
    ) -> None:
        self._campaign, self._backend, self._worlds = campaign, backend, worlds
        self._store = store
        self._ahead: dict[tuple[int, int], ShardResult] = {}
        self._finished = Tally()
        self._ended_again: dict[tuple[int, int], list[Row]] = {}
        total = sum(campaign.worlds.totals().values())
        self._rate = ProgressRate(", ".join(campaign.mappers), total, tell)

    def _shards(self) -> Iterator[Shard]:
        worlds = self._campaign.worlds
        return worlds.shards() if isinstance(worlds, Ranks) else listed_shards(self._worlds)

    def _todo(self) -> Iterator[Shard]:
        """The shards that the store lacks, in the order in which they begin."""
        campaign = self._campaign
        for shard in self._met():
            if isinstance(campaign.worlds, Ranks) and campaign.stop.reached(self._finished):
                return
            known = None if self._store is None else self._store.get(shard)
            if known is None:
                yield shard
            else:
                for row in self._ended_again.get((shard.edges, shard.start), ()):
                    why = row.lost or row.stopped
                    loss = row.loss or Loss("process", "silent", "right")
                    lost = msgspec.structs.replace(
                        row, findings=(), undecided=why, loss=loss, lost=why
                    )
                    known = known.with_loss(lost)
                self._ahead[shard.edges, shard.start] = known
                self._rate.known(known.tally.worlds)

    def _met(self) -> Iterator[Shard]:
        shards = self._shards()
        if not self._campaign.drawn:
            yield from shards
            return
        random = Random(self._campaign.seed)
        while block := list(islice(shards, BLOCK)):
            remaining = dict(enumerate(block))
            drawn = list(remaining)
            random.shuffle(drawn)
            while remaining:
                # Once the campaign stops, in order: it ends at the same world each time.
                late = self._campaign.stop.reached(self._finished)
                place = next(iter(remaining)) if late else drawn.pop()
                if place in remaining:
                    yield remaining.pop(place)

    def results(self) -> ShardResults:
        self._rate.in_flight(0)
        tally = Tally()
        todo = self._todo()
        try:
            # A backend loads mappers and starts workers, so only if there is work.
            tasks = [shard for shard in (next(todo, None),) if shard is not None]
            backend = self._backend if tasks else _idle
            with closing(
                backend(self._campaign, chain(tasks, todo), self._rate.in_flight)
            ) as finished:
                for shard in self._shards():
                    place = shard.edges, shard.start
                    while place not in self._ahead and (done := next(finished, None)):
                        self._take(*done)
                    result = self._ahead.pop(place)
                    tally += result.tally
                    yield shard, result
                    if self._campaign.stop.reached(tally):
                        return
                next(finished, None)
        except (KeyboardInterrupt, WriteError) as cut:
            if isinstance(cut, Interrupted):
                self._ahead[cut.shard.edges, cut.shard.start] = cut.result
            for shard in self._shards():
                if not self._ahead:
                    break
                if (shard.edges, shard.start) in self._ahead:
                    yield shard, self._ahead.pop((shard.edges, shard.start))
            raise

    def _take(self, shard: Shard, result: ShardResult) -> None:
        self._ahead[shard.edges, shard.start] = result
        self._finished += result.tally
        if self._store is not None and self._is_kept(result.tally):
            self._store.put(shard, result)
        self._rate.finished(result.tally.worlds)

    def _is_kept(self, tally: Tally) -> bool:
        """Whether a store keeps a result: no later run replaces an earlier one.

        In a list, where no verdict is about all worlds, what the machine may have ended is left.
        """
        return isinstance(self._campaign.worlds, Ranks) or not (tally.lost or tally.timeouts)

    def examine_again(self, store: ShardMemory) -> None:
        """Examine some stored shards again, since no list of what a mapper rests on is complete.

        A run that the machine may have ended now leaves its world undecided.
        """
        drawn = self._drawn_again(store)
        with closing(self._backend(self._campaign, drawn, no_beat)) as examined:
            for shard, result in examined:
                known = store.get(shard)
                ended = [row for row in result.rows if row.is_lost or row.timed_out]
                if ended:
                    self._ended_again[shard.edges, shard.start] = ended
                elif known is not None and known.tally.digest != result.tally.digest:
                    raise InputError(
                        f"store {store.path}: examined again, some world of m{shard.edges}/"
                        f"{shard.start} … {shard.stop - 1} has another verdict, other doors or"
                        " another cost than recorded. The mapper or something that it depends on"
                        " has changed, or it does not do the same each time: remove the file and"
                        " start anew"
                    )

    def _drawn_again(self, store: ShardMemory) -> Iterator[Shard]:
        """Shards of every size, drawn by the seed, of at least `AGAIN` worlds."""
        assert isinstance(self._campaign.worlds, Ranks)
        drawn = [shard for shard in store.known() if shard.edges <= self._campaign.worlds.edges]
        Random(f"{self._campaign.seed} {len(drawn)}").shuffle(drawn)
        sizes: set[int] = set()
        worlds = 0
        for shard in drawn:
            if shard.edges in sizes and worlds >= AGAIN:
                continue
            known = store.get(shard)
            # What is undecided stays so. How far a run comes in its time depends on the machine.
            if known is None or known.tally.timeouts or known.tally.undecided:
                continue
            if known.tally.worlds:
                sizes.add(shard.edges)
                worlds += known.tally.worlds
                yield shard
