"""The suites of the arena: named sets of worlds, the same for every user.

The **families** of a suite weigh the same. A family is drawn (a call with seeds 0, 1, …) or
**exact**: every world of a finite class, without sampling error. An arena seed other than 0
draws new worlds, which no mapper can have met before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from topo_verify.errors import InputError, close_name
from topo_verify.studies.corpus import CorpusPart, corpus_from, drawn_names
from topo_verify.world.enumeration import rank_order

DEFAULT = "default"


@dataclass(frozen=True)
class SuiteFamily:
    """Worlds of one kind.

    Attributes:
        listed: the worlds' WORLD arguments, given the seed of the arena.
        exact: they are every world of a finite class.
    """

    name: str
    size: int
    listed: Callable[[int], Sequence[str]]
    exact: bool = False
    planar: bool = False


@dataclass(frozen=True)
class Suite:
    """A named set of worlds."""

    name: str
    about: str
    families: tuple[SuiteFamily, ...]

    @property
    def size(self) -> int:
        """The number of worlds."""
        return sum(family.size for family in self.families)

    @property
    def planar(self) -> bool:
        """Whether all worlds are planar."""
        return all(family.planar for family in self.families)

    @property
    def exact(self) -> bool:
        """Whether these are finite classes."""
        return all(family.exact for family in self.families)

    def worlds(self, seed: int) -> list[str]:
        """The worlds' WORLD arguments, family by family."""
        return [text for family in self.families for text in family.listed(seed)]


def drawn(call: str, number: int, *, planar: bool = False) -> SuiteFamily:
    """A family with a seed, by its call without one."""
    return SuiteFamily(call, number, partial(drawn_names, call, number), planar=planar)


def alike(call: str, *markers: int) -> SuiteFamily:
    """A family whose worlds differ in their marker alone."""
    head = call.removesuffix(")")
    texts = [f"family:{head},marker={dart})" for dart in markers] or [f"family:{call}"]
    return SuiteFamily(call, len(texts), lambda _seed: texts, exact=True)


def every(edges: int) -> SuiteFamily:
    """Every world of 1 to `edges` edges, in the order of their ids."""
    counts = {m: rank_order.count(m) for m in range(1, edges + 1)}
    return SuiteFamily(
        f"edges<={edges}",
        sum(counts.values()),
        lambda _seed: [f"m{m}/{rank}" for m, count in counts.items() for rank in range(count)],
        exact=True,
    )


LATTICE = "lattice(10,10,holes=0.2)"

SUITES = {
    suite.name: suite
    for suite in (
        Suite(
            DEFAULT,
            "a small mixture",
            (
                every(3),
                drawn(LATTICE, 10, planar=True),
                drawn("king(8,8)", 3),
                alike("torus(6,6)"),
                drawn("regular(40,8,holes=0.2)", 5),
            ),
        ),
        Suite("tiny", "every world of up to 4 edges", (every(4),)),
        Suite(
            "lattices",
            "planar grids with holes",
            (drawn(LATTICE, 30, planar=True), drawn("lattice(20,20,holes=0.2)", 8, planar=True)),
        ),
        Suite("king", "grids with diagonals: high genus", (drawn("king(10,10)", 10),)),
        Suite(
            "king-torus",
            "kings whose borders are joined",
            (drawn("king_torus(10,10,holes=0.2)", 8),),
        ),
        Suite("torus", "a grid without a border", (alike("torus(10,10)"),)),
        Suite("regular", "random graphs of degree 8", (drawn("regular(80,8,holes=0.2)", 30),)),
    )
}


def chosen_suites(text: str) -> list[Suite]:
    """The suites that a text names with commas, or `all`; InputError if one is unknown."""
    names = list(SUITES) if text == "all" else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in SUITES:
            raise InputError(
                f"--suite {name!r}: no such suite{close_name(name, SUITES) or ':'} there are"
                f" {', '.join(SUITES)} and all; several are given with commas. Worlds of your own"
                " are named with --worlds"
            )
    if len(set(names)) < len(names):
        raise InputError(f"--suite {text!r}: a suite is named twice: name each once")
    return [SUITES[name] for name in names]


def own_suite(texts: Sequence[str], seed: int = 0) -> Suite:
    """The suite `own`: the worlds that these WORLDS name, a family each."""
    parts = corpus_from(texts, seed=seed).parts
    return Suite("own", "worlds of your own", tuple(map(_own, parts)))


def _own(part: CorpusPart) -> SuiteFamily:
    named = list(part.listed())
    for at in named:
        if at.replay_arguments != ("--worlds", at.name):
            raise InputError(
                f"--worlds {part.text}: {at.name} has no name that another command knows; name"
                " files, ids, families or edges<=N"
            )
    names = [at.name for at in named]
    planar = all(at.world.genus == 0 for at in named)
    return SuiteFamily(part.text, len(names), lambda _seed: names, not part.sample, planar)
