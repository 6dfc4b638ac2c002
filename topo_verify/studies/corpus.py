"""WORLDS: the worlds to try an implementation on, as the command line names them.

| text | worlds |
| --- | --- |
| `corpus` | every world of 1 to 4 edges, 20 of each strategy, the street network |
| `edges<=5` | every world of 1 to 5 edges, in the order of their ids |
| `generated:200` | 200 worlds, spread evenly over the strategies |
| `generated:200:STRATEGY` | 200 worlds of one, e.g. `planar_worlds(max_edges=20)` |
| `drawn:30:FAMILY` | 30 worlds of a family with seeds, e.g. `lattice(10,10,holes=0.2)` |
| a folder | its world files, by name |
| any WORLD | this world: a path, `family:…`, an id, `nyc`; all graphs of a file of planar_code |

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

from topo_verify.errors import InputError, is_utf8, shown
from topo_verify.world import io
from topo_verify.world.enumeration import rank_order
from topo_verify.world.formats import files, planar_code
from topo_verify.world.resolve import NoSuchWorld, resolve_world
from topo_verify.world.rooted_map import World

DEFAULT = ("corpus",)

FORMS = (
    "corpus, edges<=N, generated:N, generated:N:STRATEGY, drawn:N:FAMILY, a folder, a file, an id"
    " (m5/17), a family (family:lattice(3,4,seed=7)) or nyc"
)
"""The forms of a text of WORLDS, for a refusal."""

SMALL = "edges<=4"

GENERATED = 160

NETWORKS = ("nyc",)

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
"""The strategies of `generated:N`, in this order."""

MOST_GENERATED = 1_000_000
MOST_ENUMERATED = 9

SUFFIXES = (".json", ".graphml", ".net.xml", ".pc", ".plc")


@dataclass(frozen=True, slots=True)
class Named:
    """A world of a corpus.

    Attributes:
        name: a WORLD if it has an id or a file, else a unique text.
        group: the text of WORLDS that names it.
    """

    name: str
    world: World
    group: str
    replay_arguments: tuple[str, ...]


@dataclass(frozen=True)
class CorpusPart:
    """The worlds that one text names; each call of `listed` lists them anew.

    Attributes:
        finite: they are every world of a finite class.
        sample: they are drawn; another seed draws others.
    """

    text: str
    total: int
    listed: Callable[[], Iterator[Named]]
    finite: bool = False
    sample: bool = False


@dataclass(frozen=True)
class Corpus:
    """Worlds in a fixed order, to be iterated any number of times."""

    parts: tuple[CorpusPart, ...]

    def __iter__(self) -> Iterator[Named]:
        for part in self.parts:
            yield from part.listed()

    @property
    def total(self) -> int:
        """The number of worlds, without listing any."""
        return sum(part.total for part in self.parts)

    @property
    def finite(self) -> bool:
        """Whether these are all worlds of finite classes."""
        return all(part.finite for part in self.parts)

    @property
    def description(self) -> str:
        """Each text with its number of worlds."""
        return ", ".join(f"{part.text} ({part.total:,})" for part in self.parts)

    @cached_property
    def digest(self) -> str:
        """A hash of the worlds in order; the text `edges<=N` stands for its worlds."""
        digest = sha256(b"topo-verify/corpus 1")
        for part in self.parts:
            digest.update(msgspec.json.encode([part.text if part.finite else "", part.total]))
            for at in () if part.finite else part.listed():
                digest.update(msgspec.json.encode(at.world.code))
        return digest.hexdigest()


class CorpusWorlds:
    """The worlds of a corpus with their names."""

    def __init__(self, corpus: Corpus) -> None:
        self._corpus = corpus
        self._placed = enumerate(corpus)
        self._last: tuple[int, Named] | None = None

    def __iter__(self) -> Iterator[tuple[str, World]]:
        return ((at.name, at.world) for at in self._corpus)

    def at(self, place: int) -> Named:
        """The world at a place; places must not decrease."""
        while self._last is None or self._last[0] < place:
            self._last = next(self._placed)
        return self._last[1]


def corpus_from(texts: Sequence[str] = DEFAULT, *, seed: int = 0) -> Corpus:
    """The worlds that these texts name, in order. InputError if a text names none."""
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
    elif text.startswith("drawn:"):
        yield _drawn(text, seed)
    elif text == "-":
        raise _no_worlds(text, "standard input is read only once")
    elif _is_folder(text):
        yield _folder(text)
    else:
        yield _listed(text, _file(text, text))


def _no_worlds(text: str, why: str) -> InputError:
    return InputError(f"--worlds {shown(text)!r}: {why}; expected one of {FORMS}")


# ---------------------------------------------------------------- all of a size


def _enumerated(text: str) -> CorpusPart:
    match = re.fullmatch(r"edges<=([0-9]{1,3})", text)
    most = int(match[1]) if match else 0
    if not 1 <= most <= MOST_ENUMERATED:
        why = f"'edges<=N' is every world of 1 to N edges, with N from 1 to {MOST_ENUMERATED}"
        raise _no_worlds(text, why)

    def listed() -> Iterator[Named]:
        for edges in range(1, most + 1):
            # Much faster than unranking each id.
            for rank, table in enumerate(rank_order.tables(edges)):
                name = f"m{edges}/{rank}"
                yield Named(name, World.from_code(table), text, ("--worlds", name))

    return CorpusPart(text, sum(map(rank_order.count, range(1, most + 1))), listed, finite=True)


# ---------------------------------------------------------------- drawn


def _generated(text: str, seed: int) -> CorpusPart:
    match = re.fullmatch(r"generated:([0-9]{1,9})(?::(.+))?", text, re.DOTALL)
    number = int(match[1]) if match else 0
    if match is None or not 1 <= number <= MOST_GENERATED:
        why = (
            f"'generated:N' and 'generated:N:STRATEGY' have N from 1 to {MOST_GENERATED:,}, as in"
            " 'generated:200:planar_worlds(max_edges=20)'"
        )
        raise _no_worlds(text, why)
    strategies = STRATEGIES if match[2] is None else (match[2],)
    each, more = divmod(number, len(strategies))
    worlds: list[World] = []
    for place, strategy in enumerate(strategies):
        worlds += drawn(f"--worlds {text!r}", strategy, each + (place < more), seed)
    arguments = ("--worlds", text, "--seed", str(seed))
    named = [_named(f"{text}#{i}", world, text, arguments) for i, world in enumerate(worlds)]
    return _listed(text, named, sample=True)


def drawn(asked: str, strategy: str, number: int, seed: int) -> list[World]:
    """Worlds of a strategy; InputError, which begins with `asked`, if it draws none."""
    from hypothesis.errors import HypothesisException

    from topo_verify.strategies.sample import resolve_strategy, sample

    if number == 0:
        return []
    try:
        return sample(resolve_strategy(strategy), number, start=seed)
    except HypothesisException as error:
        raise InputError(f"{asked}: {strategy} draws no worlds: {error}") from error


def _drawn(text: str, seed: int) -> CorpusPart:
    match = re.fullmatch(r"drawn:([0-9]{1,9}):(.+\))", text, re.DOTALL)
    number = int(match[1]) if match else 0
    if match is None or not 1 <= number <= MOST_GENERATED:
        why = (
            f"'drawn:N:FAMILY' has N from 1 to {MOST_GENERATED:,}, as in"
            " 'drawn:30:lattice(10,10,holes=0.2)'"
        )
        raise _no_worlds(text, why)
    if re.search(r"\bseed\s*=", match[2]):
        raise InputError(
            f"--worlds {text!r}: the seeds are drawn; leave out seed= from the call, and give"
            " --seed for other worlds"
        )
    names = drawn_names(match[2].removeprefix("family:"), number, seed)
    _by_name(names[0], text)  # refuse a wrong call early
    return CorpusPart(text, number, lambda: (_by_name(name, text) for name in names), sample=True)


def drawn_names(call: str, number: int, seed: int) -> list[str]:
    """The worlds of a family with seeds 0, 1, …, or with others for a `seed` other than 0."""
    head = call.removesuffix(")")
    seeds = range(number) if seed == 0 else [_drawn_seed(seed, call, k) for k in range(number)]
    return [f"family:{head},seed={drawn})" for drawn in seeds]


def _drawn_seed(seed: int, call: str, place: int) -> int:
    return int.from_bytes(sha256(f"{seed} {call} {place}".encode()).digest()[:6])


# ---------------------------------------------------------------- named


def _listed(text: str, worlds: Sequence[Named], *, sample: bool = False) -> CorpusPart:
    return CorpusPart(text, len(worlds), lambda: iter(worlds), sample=sample)


def _by_name(name: str, group: str) -> Named:
    _require_utf8(name)
    try:
        world = resolve_world(name)
    except NoSuchWorld:
        raise _no_worlds(name, "no such world or file") from None
    return Named(name, world, group, ("--worlds", name))


def _require_utf8(name: str) -> None:
    if not is_utf8(name):  # results keep the name as JSON
        raise InputError(
            f"--worlds {name!r}: expected a name in UTF-8; rename the file or the folder"
        )


def _named(name: str, world: World, group: str, arguments: tuple[str, ...]) -> Named:
    if len(world.edges) > rank_order.MAX_ID_EDGES:
        return Named(name, world, group, arguments)
    return Named(world.id, world, group, ("--worlds", world.id))


def _is_folder(text: str) -> bool:
    try:
        return Path(text).is_dir()
    except (OSError, ValueError):  # the text cannot be a file name
        return False


def _folder(text: str) -> CorpusPart:
    names = sorted(_world_files(Path(text)))
    if not names:
        raise InputError(
            f"--worlds {shown(text)}: expected a folder with world files, whose names end in"
            f" {', '.join(SUFFIXES)}; this one has none"
        )
    return _listed(text, [named for name in names for named in _file(name, text)])


def _file(name: str, group: str) -> list[Named]:
    """The world of this name; of a file of planar_code with several graphs, all of them."""
    worlds = [*planar_code.worlds(name)] if _is_planar_code(name) else []
    if len(worlds) < 2:
        return [_by_name(name, group)]
    _require_utf8(name)
    names = [f"{name}:{number}" for number in range(len(worlds))]
    return [Named(n, w, group, ("--worlds", n)) for n, w in zip(names, worlds, strict=True)]


def _is_planar_code(name: str) -> bool:
    if not Path(name).is_file():
        return False
    if io.format_of_name(name) == "planar_code":
        return True
    return files.unpacked(files.read(name), name).startswith(io.PLANAR_CODE)


def _world_files(folder: Path) -> Iterable[str]:
    try:
        return [
            str(path)
            for path in folder.iterdir()
            if path.is_file() and files.unpacked_name(path.name).lower().endswith(SUFFIXES)
        ]
    except OSError as error:
        raise InputError(f"cannot read the folder {shown(folder)}: {error.strerror}") from error
