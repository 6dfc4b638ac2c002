"""The paper's figures as data: families of graphs, sizes, lines, and the numbers in its text.

H. Wang, M. Jenkin and P. Dymond, section IV. The text states the families, 20 % holes, 30 graphs
a point, and costs for the 10×10 lattice alone. The other sizes, the degree of the regular
graphs, the marker's place and the policies are our choice.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from typing import Literal

from topo_verify.errors import InputError

GRAPHS = 30
"""A point, as in the paper."""

QUICK_GRAPHS = 10

SEEDS = 1000
"""Graph g of a point is drawn with seed `SEEDS·seed + g`, so two seeds share no graph."""

EDGES, LEAST = "edges", "least-cost"
YARDSTICKS = (EDGES, LEAST)

SettingName = Literal["lattice", "dense"]


@dataclass(frozen=True)
class Setting:
    """A family of graphs that grows.

    Attributes:
        measure: what `size` counts.
        family: the WORLD argument for a size and a seed.
        sizes, quick, large: sizes of the points; with `--quick`; for the compiled engine.
    """

    name: SettingName
    measure: str
    family: Callable[[int, int], str]
    sizes: tuple[int, ...]
    quick: tuple[int, ...]
    large: tuple[int, ...] = ()


LATTICE = Setting(
    "lattice",
    "side of the lattice (nodes before holes)",
    lambda size, seed: f"family:lattice({size},{size},holes=0.2,seed={seed})",
    (4, 6, 8, 10, 12, 15, 20),
    (4, 6, 8, 10),
    (30, 40, 60, 80, 100),
)

DENSE = Setting(
    "dense",
    "nodes before holes, each of degree 8",
    lambda size, seed: f"family:regular({size},8,holes=0.2,seed={seed})",
    (20, 40, 60, 80, 100),
    (20, 40),
)


@dataclass(frozen=True)
class Stated:
    """A cost that the paper states for a point, in edge traversals and in words."""

    cost: int
    words: str


@dataclass(frozen=True)
class Figure:
    """One figure of the paper, with our yardsticks.

    Attributes:
        lines: the algorithms; `YARDSTICKS` come after them.
        stated: what the text states, by algorithm and size.
    """

    name: str
    title: str
    setting: Setting
    lines: tuple[str, ...]
    stated: dict[tuple[str, int], Stated]


_BASIC = {("basic", 10): Stated(14000, "14,000")}
_MORE = {("basic", 10): Stated(10000, "more than 10,000")}
_ALL = {**_BASIC, ("enhancement-iii-all", 10): Stated(4500, "about 4,500")}


def _figure(
    name: str, title: str, setting: Setting, stated: dict[tuple[str, int], Stated], *lines: str
) -> Figure:
    return Figure(name, title, setting, ("basic", *lines, "folding"), stated)


FIRST = "enhancement-i"
SECOND, ONE_LEVEL, ALL_LEVEL = (
    (rule, f"{rule}+i") for rule in ("enhancement-ii", "enhancement-iii-one", "enhancement-iii-all")
)

FIGURES = {
    figure.name: figure
    for figure in (
        _figure("3", "basic algorithm, lattices with 20 % holes", LATTICE, _MORE),
        _figure("6a", "Enhancement I, lattices", LATTICE, _BASIC, FIRST),
        _figure("6b", "Enhancement II, lattices", LATTICE, _BASIC, *SECOND),
        _figure("6c", "Enhancement III one-level, lattices", LATTICE, _BASIC, *ONE_LEVEL),
        _figure("6d", "Enhancement III all-level, lattices", LATTICE, _ALL, *ALL_LEVEL),
        _figure("6e", "Enhancements I and II, densely connected graphs", DENSE, {}, FIRST, *SECOND),
        _figure(
            "6f", "Enhancement III, densely connected graphs", DENSE, {}, *ONE_LEVEL, *ALL_LEVEL
        ),
    )
}
"""In the order of the paper."""


def chosen_figures(text: str) -> list[Figure]:
    """The figures that `--figure` names with commas: `all`, `3`, `6` for 6a to 6f, `6d`."""
    chosen: dict[str, Figure] = {}
    for word in (part.strip().lower() for part in text.split(",")):
        fitting = {
            name: figure
            for name, figure in FIGURES.items()
            if word in ("all", name, name.rstrip("abcdef"))
        }
        if not fitting:
            raise InputError(
                f"--figure {word!r}: expected all, 6 or one of {', '.join(FIGURES)}; several with"
                " commas"
            )
        chosen |= fitting
    return [figure for name, figure in FIGURES.items() if name in chosen]


# ---------------------------------------------------------------- policies


@dataclass(frozen=True, order=True)
class PolicyPair:
    """A pick policy and an order policy."""

    pick: str
    order: str

    def __str__(self) -> str:
        return f"{self.pick}/{self.order}"


REFERENCE = PolicyPair("nearest", "shortest")

PAIRS = (
    *(
        PolicyPair(*pair)
        for pair in product(("nearest", "last", "first"), ("shortest", "oldest", "newest"))
    ),
    PolicyPair("random(0)", "random(0)"),
)
"""Every deterministic pair, and a random one."""


# ---------------------------------------------------------------- the plan


@dataclass(frozen=True)
class FigureExtent:
    """How much of the figures is run; `graphs` counts those of a point."""

    graphs: int = GRAPHS
    quick: bool = False
    policies: tuple[PolicyPair, ...] = (REFERENCE,)
    seed: int = 0
    large: bool = False

    def sizes(self, setting: Setting) -> tuple[int, ...]:
        """The sizes of the points in a setting."""
        sizes = setting.quick if self.quick else setting.sizes
        return (*sizes, *setting.large) if self.large else sizes

    def worlds(self, setting: Setting, size: int) -> Iterator[str]:
        """The graphs of one point."""
        for graph in range(self.graphs):
            yield setting.family(size, SEEDS * self.seed + graph)
