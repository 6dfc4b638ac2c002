"""The judge's fold by itself: what is rolled back is as it was, and its planar face test is right.

The kernels run as plain Python. Each test is seen to fail on mistakes planted line by line.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

pytest.importorskip("numba", reason="the compiled engine needs numba")

from tests.extra.fast.kernels.judged import plant, sampled
from topo_verify import InputError, World
from topo_verify.extra.fast.kernels.judging import fold, layout
from topo_verify.extra.fast.kernels.judging.layout import FoldWords
from topo_verify.extra.fast.kernels.workspace import P
from topo_verify.robot.events import MapData


def fold_of(degrees: tuple[int, ...]) -> FoldWords:
    """A fold with nodes of these degrees, all darts open, none with the marker."""
    seen = FoldWords([0] * layout.JUDGE_SIZE)
    fold.start_judge_fold(seen, degrees[0] * P)
    for degree in degrees[1:]:
        fold.visit(seen, degree * P)
    return seen


def known(seen: FoldWords) -> tuple[object, ...]:
    """Everything that the fold says: who stands for whom, and the ends of the doors."""
    nodes, doors = range(seen.nodes), range(seen.doors)
    ends = [seen.end_node[d] for d in doors]
    darts = [seen.end_dart[d] for d in doors if ends[d] >= 0]
    rows = ([row[n] for n in nodes] for row in (seen.parent, seen.offset, seen.weight))
    return seen.undos, ends, darts, *rows


def draw_changes(seen: FoldWords, draw: Random, number: int) -> None:
    """Make places one and join ends, as the dice fall, contradictions and all."""
    for _ in range(number):
        a, b = (draw.randrange(seen.nodes) for _ in range(2))
        i, j = (draw.randrange(seen.degree[node]) for node in (a, b))
        draw.choice([fold.make_one, fold.join_ends, fold.join_ends])(seen, a, i, b, j)


def not_restored() -> list[int]:
    """The seeds with which a fold is not what it was, once it is rolled back."""
    wrong: list[int] = []
    for seed in range(60):
        draw = Random(seed)
        seen = fold_of(tuple(draw.choice([2, 3, 3]) for _ in range(8)))
        draw_changes(seen, draw, 3)
        before, mark = known(seen), seen.undos
        draw_changes(seen, draw, 4)
        fold.roll_back(seen, mark)
        if known(seen) != before:
            wrong.append(seed)
    return wrong


def misjudged() -> list[str]:
    """The worlds, some edges left open, of which the face test does not say what the genus says."""
    wrong: list[str] = []
    for edges in (2, 3, 4, 5):
        draw = Random(edges)
        for world in sampled(edges, 20):
            opened = {d for e in world.edges if draw.random() < 0.25 for d in e}
            genus_0 = is_planar_with_leaves(world, opened)
            if genus_0 is not None and says_planar(world, opened) != genus_0:
                wrong.append(world.id)
    return wrong


def is_planar_with_leaves(world: World, opened: set[int]) -> bool | None:
    """Whether the map is planar with a leaf on each of these darts; None if it falls apart."""
    leaves = {dart: len(world.alpha) + k for k, dart in enumerate(sorted(opened))}
    vertices = (*(tuple(v) for v in world.vertices), *((leaf,) for leaf in leaves.values()))
    kept = tuple(edge for edge in world.edges if edge[0] not in opened)
    try:
        return World.from_map(MapData(vertices, (*kept, *leaves.items()), world.root)).is_planar
    except InputError:
        return None


def says_planar(world: World, opened: set[int]) -> bool:
    """What the kernel says of this map."""
    seen = fold_of(world.degrees)
    for dart, other in enumerate(world.alpha):
        if dart not in opened:
            vertex, end = world.vertex_of[dart], world.vertex_of[other]
            first, end_first = world.vertices[vertex][0], world.vertices[end][0]
            fold.put_end(seen, vertex, dart - first, end, other - end_first)
    assert seen.base[0] == 0
    assert fold.lay_out(seen) == len(opened)
    return fold.is_planar_fold(seen)


def test_what_is_rolled_back_is_as_it_was() -> None:
    assert not_restored() == []


def test_the_face_test_says_what_the_genus_says() -> None:
    assert misjudged() == []


@pytest.mark.parametrize(
    ("seen_by", "kernel", "right", "wrong"),
    [
        (not_restored, "roll_back", "while at > mark:", "while at > mark + 1:"),
        (not_restored, "roll_back", "= -1", "= 0"),
        (not_restored, "roll_back", "(change >> 1)] = -1", "(change >> 2)] = -1"),
        (not_restored, "roll_back", "-= fold.weight[node]", "-= 1"),
        (not_restored, "roll_back", "fold.parent[node] = node", "pass"),
        (not_restored, "roll_back", "fold.offset[node] = 0", "pass"),
        (not_restored, "roll_back", "fold.undos = at", "pass"),
        (not_restored, "put_end", "fold.undos += 1", "pass"),
        (not_restored, "make_one", "fold.undo[fold.undos] = 2 * a", "pass"),
        (misjudged, "is_planar_fold", "vertices += 1", "vertices += 2"),
        (misjudged, "is_planar_fold", "open_darts += 1", "open_darts += 2"),
        (misjudged, "is_planar_fold", "faces += 1", "faces = 1"),
        (misjudged, "is_planar_fold", "if fold.alpha[at] >= 0:", "if fold.alpha[at] > 0:"),
        (misjudged, "is_planar_fold", "at = fold.alpha[at]", "pass"),
        (misjudged, "is_planar_fold", "at = fold.number[node]", "at = 0"),
        (misjudged, "is_planar_fold", "+ fold.degree[node]:", "+ 2:"),
        (misjudged, "is_planar_fold", "(fold.size + open_darts) // 2", "fold.size // 2"),
        (misjudged, "is_planar_fold", "faces == 2", "faces <= 2"),
        (misjudged, "lay_out", "fold.number[end] + end_dart", "fold.number[end]"),
        (misjudged, "lay_out", "+ dart - fold.number[node]", "+ dart"),
        (misjudged, "lay_out", "fold.number[node] = size", "fold.number[node] = 0"),
    ],
)
def test_a_mistake_in_the_fold_is_seen(
    monkeypatch: pytest.MonkeyPatch,
    seen_by: Callable[[], list[object]],
    kernel: str,
    right: str,
    wrong: str,
) -> None:
    plant(monkeypatch, f"fold.{kernel}", right, wrong)
    try:
        found = bool(seen_by())
    except (AssertionError, IndexError):
        found = True
    assert found
