"""Twins: two different worlds that look the same to every robot without the marker's direction.

Such a robot senses the degree, and whether the marker is here (`undirected`), or the degree alone
(`none`). Two darts are **alike** if no walk from them senses a difference.

**Making a twin.** Exchanging the far ends of two edges with alike darts changes nothing that a
robot senses. A connected result that is not isomorphic to the original is a twin. Without a marker,
two copies of the world, joined crosswise at an edge on a cycle, are one.

**No twin.** A world that looks like W covers W's quotient by alike darts with N sheets as W does,
because the mark lies on one vertex. Only one such world exists if N = 1, if W has at most one
cycle, or if N = 2 and the quotient has no cycle. Otherwise, up to 6 edges, one exchange makes a
twin (`research/twins.py`); beyond, this is not proved. Without a marker only trees are
determined.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import combinations, islice
from typing import Literal, get_args

from topo_verify.errors import InputError, InternalError
from topo_verify.world.rooted_map import Dart, World, cycles

MarkerModel = Literal["undirected", "none"]

MODELS: tuple[MarkerModel, ...] = get_args(MarkerModel)

MOST_TRIED = 500
"""Candidates tried for a twin of another genus."""


def find_twin(world: World, model: MarkerModel) -> tuple[World | None, str]:
    """A twin and ""; or None and the reason."""
    if model not in MODELS:
        raise InputError(f"expected one of {', '.join(MODELS)}, got {model!r}")
    if why := no_twin(world, model):
        return None, why
    candidates = _exchanged(world) if model == "undirected" else _doubled(world)
    others = (other for other in candidates if not world.is_isomorphic(other))
    twin = next(others, None)
    if twin is None:
        return None, "no exchange of two edges makes one"
    if twin.genus == world.genus and model == "undirected":
        later = islice(others, MOST_TRIED)
        twin = next((other for other in later if other.genus != world.genus), twin)
    if not look_alike(world, twin, model):
        raise InternalError(f"{world!r} and its twin {twin!r} do not look the same")
    return twin, ""


def no_twin(world: World, model: MarkerModel) -> str:
    """Why no other world looks the same; "" if that is not known."""
    n, m = len(world.vertices), len(world.edges)
    if m < n:
        return "a tree is determined by its degrees and their order"
    if model == "none":
        return ""
    classes = alike_darts(world, model)
    sheets = len(classes) // len(set(classes))
    if sheets == 1:
        return "no two darts look alike"
    if m == n:
        return "it has only one cycle"
    if sheets == 2 and not _has_cycle(world, classes):
        return "its darts look alike in pairs, and folded along them it is a tree"
    return ""


def alike_darts(world: World, model: MarkerModel) -> list[int]:
    """The class of each dart."""
    classes, count = _numbered(sensed(world, model)), 0
    while count != (count := len(set(classes))):
        pairs = zip(classes, world.sigma, world.alpha, strict=True)
        classes = _numbered((own, classes[after], classes[end]) for own, after, end in pairs)
    return classes


def sensed(world: World, model: MarkerModel) -> list[tuple[int, bool]]:
    """The degree at each dart, and whether the marker is sensed there."""
    marked = world.marker_vertex if model == "undirected" else None
    return [(world.degrees[v], v == marked) for v in world.vertex_of]


def look_alike(world: World, other: World, model: MarkerModel) -> bool:
    """Whether every walk senses the same in both worlds."""
    here, there = sensed(world, model), sensed(other, model)
    pairs = [(world.root or 0, other.root or 0)]
    known = set(pairs)
    for a, b in pairs:
        if here[a] != there[b]:
            return False
        for end in (
            (world.sigma[a], other.sigma[b]),
            (world.alpha[a], other.alpha[b]),
        ):
            if end not in known:
                known.add(end)
                pairs.append(end)
    return True


def _numbered(keys: Iterable[Hashable]) -> list[int]:
    number: dict[Hashable, int] = {}
    return [number.setdefault(key, len(number)) for key in keys]


def _has_cycle(world: World, classes: Sequence[int]) -> bool:
    representative = {own: dart for dart, own in enumerate(classes)}
    sigma = [classes[world.sigma[representative[own]]] for own in range(len(representative))]
    edges = {frozenset((classes[a], classes[b])) for a, b in world.edges}
    return sum(len(edge) == 2 for edge in edges) >= len(cycles(sigma))


def _joined(alpha: list[Dart], pairs: Iterable[tuple[Dart, Dart]], world: World) -> World | None:
    for a, b in pairs:
        alpha[a], alpha[b] = b, a
    copies = len(alpha) // len(world.alpha)
    sigma = [s + k * len(world.alpha) for k in range(copies) for s in world.sigma]
    try:
        return World(tuple(alpha), tuple(sigma), world.root)
    except InputError:
        return None


def _exchanged(world: World) -> Iterator[World]:
    alpha, classes = world.alpha, alike_darts(world, "undirected")
    for d, e in combinations(range(len(alpha)), 2):
        if classes[d] == classes[e] and e != alpha[d]:
            other = _joined([*alpha], [(d, alpha[e]), (e, alpha[d])], world)
            if other is not None:
                yield other


def _doubled(world: World) -> Iterator[World]:
    size = len(world.alpha)
    for d, e in world.edges:
        copies = [end + k * size for k in range(2) for end in world.alpha]
        other = _joined(copies, [(d, e + size), (e, d + size)], world)
        if other is not None:
            yield other
