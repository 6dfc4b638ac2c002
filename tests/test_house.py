"""The house as a whole: no circle of imports, few arrows between rooms, one name for one type.

A module's imports are read from its source, late ones and type-only ones included: a circle that
only a type checker walks still makes two files one. `.venv/bin/python -m pytest -s` with the first
test prints the rooms and their arrows.

What this does not show: names that travel at run time, as in tests/test_layers.py.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator, Mapping
from statistics import median

import networkx as nx
import pytest

from tests.test_layers import CONVENIENCES, FLOORS, every_source, imports, room_of, sources

OUTSIDE = {"errors", "extras", "native", "", "__main__", "search_entry", "pytest_plugin"}
"""What is no room: the ground that every room stands on, and the root files."""

MOST_ROOMS, MOST_ARROWS = 13, 45
TYPICAL = 200
"""Lines of a file in the median; test_layers.py has the most."""


def graph(modules: Mapping[str, str]) -> nx.DiGraph[str]:
    """Which module imports which, by their dotted names; a package is its `__init__`."""
    arrows: nx.DiGraph[str] = nx.DiGraph()
    arrows.add_nodes_from(modules)
    for module, source in modules.items():
        for found in imports(source, module):
            if module == "topo_verify.world.rooted_map" and found.scope in CONVENIENCES:
                continue
            holder = found.target.rpartition(".")[0]
            other = found.target if found.target in modules else holder
            if other in modules and other != module:
                arrows.add_edge(module, other)
    return arrows


def circles(modules: Mapping[str, str]) -> list[list[str]]:
    """The modules that import each other, in groups."""
    components = nx.strongly_connected_components(graph(modules))
    return sorted(sorted(group) for group in components if len(group) > 1)


def room_arrows(modules: Mapping[str, str]) -> set[tuple[str, str]]:
    """Which room imports which other room; `OUTSIDE` left out."""
    pairs = {(room_of(a), room_of(b)) for a, b in graph(modules).edges}
    return {(a, b) for a, b in pairs if a != b and not {a, b} & OUTSIDE}


def types_of(source: str) -> Iterator[str]:
    """The public top-level types of a file: classes, and aliases such as `Name = int`."""
    for node in ast.parse(source).body:
        match node:
            case ast.ClassDef(name=name):
                pass
            case ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)):
                if name.isupper() or not name[:1].isupper():
                    continue
            case _:
                continue
        if not name.startswith("_"):
            yield name


def namesakes(modules: Mapping[str, str]) -> dict[str, list[str]]:
    """The type names that more than one module defines, with those modules."""
    homes: dict[str, list[str]] = defaultdict(list)
    for module, source in modules.items():
        for name in types_of(source):
            homes[name].append(module)
    return {name: where for name, where in sorted(homes.items()) if len(where) > 1}


@pytest.mark.nightly
def test_the_rooms_and_their_arrows_can_be_drawn_from_memory() -> None:
    rooms = {room_of(module) for module in sources()} - OUTSIDE
    arrows = room_arrows(sources())
    for room in sorted(rooms, key=lambda name: (-FLOORS[name], name)):
        below = ", ".join(sorted(b for a, b in arrows if a == room))
        print(f"floor {FLOORS[room]}  {room:<11} -> {below or '(nothing)'}")  # noqa: T201  shown with -s
    print(f"{len(rooms)} rooms, {len(arrows)} arrows")  # noqa: T201  the same
    assert len(rooms) <= MOST_ROOMS
    assert len(arrows) <= MOST_ARROWS


def test_no_floor_is_a_fraction() -> None:
    assert all(isinstance(floor, int) for floor in FLOORS.values())


@pytest.mark.long
def test_no_modules_import_each_other_in_a_circle() -> None:
    assert circles(every_source()) == []


@pytest.mark.parametrize(
    "back",
    [
        "import p.a",
        "from p import a",
        "from p.a import x",
        "def f():\n    from p.a import x",
        "if TYPE_CHECKING:\n    from p.a import x",
    ],
)
def test_a_planted_circle_is_seen(back: str) -> None:
    modules = {"p": "", "p.a": "from p.b import y", "p.b": "from p.c import z", "p.c": back}
    assert circles(modules) == [["p.a", "p.b", "p.c"]]
    assert circles({**modules, "p.c": ""}) == []


def test_a_circle_through_a_package_is_seen() -> None:
    modules = {"p": "from p.a import x", "p.a": "from p import y"}
    assert circles(modules) == [["p", "p.a"]]


@pytest.mark.long
def test_one_name_means_one_type() -> None:
    assert namesakes(every_source()) == {}


@pytest.mark.parametrize(
    "twin", ["class Fold: ...", "Fold = int", "Fold: TypeAlias = int", 'Fold = Literal["a"]']
)
def test_a_planted_namesake_is_seen(twin: str) -> None:
    assert namesakes({"p.a": "class Fold: ...", "p.b": twin}) == {"Fold": ["p.a", "p.b"]}
    assert (
        namesakes({"p.a": "class _Fold: ...\nFOLD = 1", "p.b": "class _Fold: ...\nFOLD = 2"}) == {}
    )


def test_files_are_short() -> None:
    assert median(len(text.splitlines()) for text in every_source().values()) < TYPICAL
