"""The judge's fold by itself: what is rolled back is as it was, and its planar face test is right.

The kernels run as plain Python. Each test is seen to fail on mistakes planted line by line.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

pytest.importorskip("numba", reason="the compiled engine needs numba")

from tests.compiled.judged import plant, sampled
from topo_verify import InputError, World
from topo_verify.compiled.judging import fold, layout
from topo_verify.compiled.workspace import P
from topo_verify.robot.events import MapData


def fold_of(degrees: tuple[int, ...]) -> list[int]:
    """A fold with nodes of these degrees, all darts open, none with the marker."""
    J = [0] * layout.JUDGE_SIZE  # noqa: N806  the name of the kernels
    fold.start_judge_fold(J, degrees[0] * P)
    for degree in degrees[1:]:
        fold.visit(J, degree * P)
    return J


def known(J: list[int]) -> tuple[object, ...]:  # noqa: N803  the name of the kernels
    """Everything that the fold says: who stands for whom, and the ends of the doors."""
    nodes, doors = range(J[layout.F_NODES]), range(J[layout.F_DOORS])
    ends = [J[layout.F_END_NODE + d] for d in doors]
    darts = [J[layout.F_END_DART + d] for d in doors if ends[d] >= 0]
    rows = (
        [J[row + n] for n in nodes] for row in (layout.F_PARENT, layout.F_OFFSET, layout.F_WEIGHT)
    )
    return J[layout.F_UNDOS], ends, darts, *rows


def draw_changes(J: list[int], draw: Random, number: int) -> None:  # noqa: N803  (the same)
    """Make places one and join ends, as the dice fall, contradictions and all."""
    for _ in range(number):
        a, b = (draw.randrange(J[layout.F_NODES]) for _ in range(2))
        i, j = (draw.randrange(J[layout.F_DEGREE + node]) for node in (a, b))
        draw.choice([fold.make_one, fold.join_ends, fold.join_ends])(J, a, i, b, j)


def not_restored() -> list[int]:
    """The seeds with which a fold is not what it was, once it is rolled back."""
    wrong: list[int] = []
    for seed in range(60):
        draw = Random(seed)
        J = fold_of(tuple(draw.choice([2, 3, 3]) for _ in range(8)))  # noqa: N806  (the same)
        draw_changes(J, draw, 3)
        before, mark = known(J), J[layout.F_UNDOS]
        draw_changes(J, draw, 4)
        fold.roll_back(J, mark)
        if known(J) != before:
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
    J = fold_of(world.degrees)  # noqa: N806  (the same)
    for dart, other in enumerate(world.alpha):
        if dart not in opened:
            vertex, end = world.vertex_of[dart], world.vertex_of[other]
            first, end_first = world.vertices[vertex][0], world.vertices[end][0]
            fold.put_end(J, vertex, dart - first, end, other - end_first)
    assert J[layout.F_BASE] == 0
    assert fold.lay_out(J) == len(opened)
    return fold.is_planar_fold(J)


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
        (not_restored, "roll_back", "-= J[F_WEIGHT + node]", "-= 1"),
        (not_restored, "roll_back", "J[F_PARENT + node] = node", "pass"),
        (not_restored, "roll_back", "J[F_OFFSET + node] = 0", "pass"),
        (not_restored, "roll_back", "J[F_UNDOS] = at", "pass"),
        (not_restored, "put_end", "J[F_UNDOS] += 1", "pass"),
        (not_restored, "make_one", "J[F_UNDO + J[F_UNDOS]] = 2 * a", "pass"),
        (misjudged, "is_planar_fold", "vertices += 1", "vertices += 2"),
        (misjudged, "is_planar_fold", "open_darts += 1", "open_darts += 2"),
        (misjudged, "is_planar_fold", "faces += 1", "faces = 1"),
        (misjudged, "is_planar_fold", "if J[F_ALPHA + at] >= 0:", "if J[F_ALPHA + at] > 0:"),
        (misjudged, "is_planar_fold", "at = J[F_ALPHA + at]", "pass"),
        (misjudged, "is_planar_fold", "at = J[F_NUMBER + node]", "at = 0"),
        (misjudged, "is_planar_fold", "+ J[F_DEGREE + node]:", "+ 2:"),
        (misjudged, "is_planar_fold", "(J[F_SIZE] + open_darts) // 2", "J[F_SIZE] // 2"),
        (misjudged, "is_planar_fold", "faces == 2", "faces <= 2"),
        (misjudged, "lay_out", "J[F_NUMBER + end] + end_dart", "J[F_NUMBER + end]"),
        (misjudged, "lay_out", "+ dart - J[F_NUMBER + node]", "+ dart"),
        (misjudged, "lay_out", "J[F_NUMBER + node] = size", "J[F_NUMBER + node] = 0"),
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
