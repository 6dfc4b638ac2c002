"""WORLDS: what an implementation is tried on, as the command line names it.

| text | worlds |
| --- | --- |
| `corpus` | every world of 1 to 4 edges, 20 of each strategy, the street network |
| `edges<=5` | every world of 1 to 5 edges, in the order of their ids |
| `generated:200` | so many worlds, of every strategy the same number (as far as that goes) |
| `generated:200:STRATEGY` | so many worlds of one strategy, `planar_worlds(max_edges=20)` |
| a folder | the world files in it, in the order of their names |
| any WORLD | that world: a path, `family:…`, an id, `nyc` |

    corpus = corpus_from(["edges<=3", "nyc"])
    corpus.total, corpus.digest          # 87, and a hash that names exactly these worlds
    for at in corpus: at.name, at.world

A corpus is listed anew each time it is gone through and holds no enumerated world, so it may be
larger than memory. A world that two texts name comes twice.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path

import msgspec

from topo_verify.errors import InputError
from topo_verify.text import shown
from topo_verify.world.enumeration import rank_order
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

DEFAULT = ("corpus",)
"""Which worlds are meant where none are named."""

SMALL = "edges<=4"
"""The part of the default corpus that is exhaustive."""

GENERATED = 160
"""How many worlds of the default corpus are generated."""

NETWORKS = ("nyc",)
"""The real networks that come with the package."""

STRATEGIES = (
    "worlds(min_edges=1, max_edges=24)",
    "planar_worlds(min_edges=1, max_edges=24)",
    "nonplanar_worlds(max_edges=24)",
    "tree_worlds(min_edges=1, max_edges=24)",
    "lattices(min_edges=1, max_edges=40)",
    "dense_worlds(min_edges=1, max_edges=24)",
    "symmetric_worlds(min_edges=1, max_edges=24)",
    "uniform_worlds(edges=12)",
)
"""What `generated:N` draws from, in turn."""

MOST_GENERATED = 1_000_000
MOST_ENUMERATED = 9
"""No more is asked for by a text: 576,037,442 worlds have 9 edges."""

SUFFIXES = (".json", ".graphml", ".net.xml", ".pc", ".plc")
"""Which files in a folder are worlds."""


@dataclass(frozen=True, slots=True)
class Named:
    """A world of a corpus.

    Attributes:
        name: how the command line names it: a WORLD, wherever it has an id or a file.
        world: the world.
        group: the text that led to it.
        replay_arguments: the arguments of a command line that name this world.
    """

    name: str
    world: World
    group: str
    replay_arguments: tuple[str, ...]


@dataclass(frozen=True)
class CorpusPart:
    """The worlds that one text names; `finite`: all of their kind, to be exhausted."""

    text: str
    total: int
    listed: Callable[[], Iterator[Named]]
    finite: bool = False


@dataclass(frozen=True)
class Corpus:
    """Worlds, in an order that is always the same; go through them as often as you like."""

    parts: tuple[CorpusPart, ...]

    def __iter__(self) -> Iterator[Named]:
        for part in self.parts:
            yield from part.listed()

    @property
    def total(self) -> int:
        """How many worlds there are, counted without listing them."""
        return sum(part.total for part in self.parts)

    @property
    def finite(self) -> bool:
        """Is this every world of a finite class?"""
        return all(part.finite for part in self.parts)

    @property
    def description(self) -> str:
        """What is in it, in words."""
        return ", ".join(f"{part.text} ({part.total:,})" for part in self.parts)

    @cached_property
    def digest(self) -> str:
        """A hash that is equal for the same worlds in the same order, and for no others.

        Enumerated worlds are named by their bounds alone: their order is part of the format.
        """
        made = sha256(b"topo-verify/corpus 1")
        for part in self.parts:
            made.update(msgspec.json.encode([part.text if part.finite else "", part.total]))
            for at in () if part.finite else part.listed():
                made.update(msgspec.json.encode(at.world.code))
        return made.hexdigest()


def corpus_from(texts: Sequence[str] = DEFAULT, *, seed: int = 0) -> Corpus:
    """The worlds that these texts name, in their order; the default corpus if there are none.

    Args:
        seed: draws the generated worlds.
    Raises:
        InputError: a text names no worlds, or a file among them holds none.
    """
    parts = [part for text in texts or DEFAULT for part in _parts(text, seed)]
    return Corpus(tuple(parts))


def _parts(text: str, seed: int) -> Iterator[CorpusPart]:
    if text == "corpus":
        yield _enumerated(SMALL)
        yield _generated(f"generated:{GENERATED}", seed)
        for name in NETWORKS:
            yield _listed(name, [_by_name(name, name)])
    elif text.startswith("edges"):
        yield _enumerated(text)
    elif text.startswith("generated"):
        yield _generated(text, seed)
    elif text == "-":
        raise InputError("--worlds -: worlds are read more than once; name a file or a folder")
    elif _is_folder(text):
        yield _folder(text)
    else:
        yield _listed(text, [_by_name(text, text)])


# ---------------------------------------------------------------- all of a size


def _enumerated(text: str) -> CorpusPart:
    found = re.fullmatch(r"edges<=([0-9]{1,3})", text)
    most = int(found[1]) if found else 0
    if not 1 <= most <= MOST_ENUMERATED:
        raise InputError(
            f"--worlds {text!r}: every world of 1 to N edges is 'edges<=N', N from 1 to"
            f" {MOST_ENUMERATED}"
        )

    def listed() -> Iterator[Named]:
        for edges in range(1, most + 1):
            for rank, table in enumerate(rank_order.tables(edges)):
                name = f"m{edges}/{rank}"
                yield Named(name, World.from_code(table), text, ("--worlds", name))

    return CorpusPart(text, sum(map(rank_order.count, range(1, most + 1))), listed, finite=True)


# ---------------------------------------------------------------- drawn


def _generated(text: str, seed: int) -> CorpusPart:
    found = re.fullmatch(r"generated:([0-9]{1,9})(?::(.+))?", text, re.DOTALL)
    number = int(found[1]) if found else 0
    if found is None or not 1 <= number <= MOST_GENERATED:
        raise InputError(
            f"--worlds {text!r}: so many worlds are 'generated:N' or 'generated:N:STRATEGY', N from"
            f" 1 to {MOST_GENERATED:,}, as in 'generated:200:planar_worlds(max_edges=20)'"
        )
    strategies = STRATEGIES if found[2] is None else (found[2],)
    each, more = divmod(number, len(strategies))
    worlds: list[World] = []
    for place, strategy in enumerate(strategies):
        worlds += _drawn(text, strategy, each + (place < more), seed)
    arguments = ("--worlds", text, "--seed", str(seed))
    named = [_named(f"{text}#{i}", world, text, arguments) for i, world in enumerate(worlds)]
    return _listed(text, named)


def _drawn(text: str, strategy: str, number: int, seed: int) -> list[World]:
    from hypothesis.errors import HypothesisException

    from topo_verify.strategies.resolve import resolve_strategy
    from topo_verify.strategies.sample import sample

    if number == 0:
        return []
    try:
        return sample(resolve_strategy(strategy), number, start=seed)
    except HypothesisException as error:
        raise InputError(f"--worlds {text!r}: {strategy} draws no worlds: {error}") from error


# ---------------------------------------------------------------- named


def _listed(text: str, worlds: Sequence[Named]) -> CorpusPart:
    return CorpusPart(text, len(worlds), lambda: iter(worlds))


def _by_name(name: str, group: str) -> Named:
    return Named(name, resolve_world(name), group, ("--worlds", name))


def _named(name: str, world: World, group: str, arguments: tuple[str, ...]) -> Named:
    """Called by its id, if it is small enough to have one."""
    if len(world.edges) > rank_order.MAX_ID_EDGES:
        return Named(name, world, group, arguments)
    return Named(world.id, world, group, ("--worlds", world.id))


def _is_folder(text: str) -> bool:
    try:
        return Path(text).is_dir()
    except (OSError, ValueError):  # a name that no file can have
        return False


def _folder(text: str) -> CorpusPart:
    names = sorted(_world_files(Path(text)))
    if not names:
        raise InputError(
            f"--worlds {shown(text)}: no world in this folder; its files of worlds end in"
            f" {', '.join(SUFFIXES)}"
        )
    return _listed(text, [_by_name(name, text) for name in names])


def _world_files(folder: Path) -> Iterable[str]:
    try:
        return [
            str(path)
            for path in folder.iterdir()
            if path.is_file() and path.name.lower().endswith(SUFFIXES)
        ]
    except OSError as error:
        raise InputError(f"cannot read the folder {shown(folder)}: {error.strerror}") from error
