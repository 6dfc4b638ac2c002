"""Draws algorithms of the catalogue with all policies that the paper leaves open, and door words.

Every claim holds for every mapper drawn.
"""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.errors import InputError
from topo_verify.robot.events import Policies
from topo_verify.robot.percept import Door
from topo_verify.robot.simulator import exit_dart
from topo_verify.strategies.draws import draw_bytes, shown_as_called
from topo_verify.strategies.shapes import LARGEST, integer
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

_MAX_SEED = 10**6


@shown_as_called
def policies(*, random: bool = True) -> SearchStrategy[Policies]:
    """Pick and order, by name.

    Args:
        random: also draw `random(seed)`.
    """
    return st.builds(Policies, pick=_named(PICKS, random), order=_named(ORDERS, random))


_all_policies = policies


@shown_as_called
def mappers(
    *,
    algorithms: Iterable[str] | None = None,
    policies: SearchStrategy[Policies] | None = None,
    planar: bool = False,
) -> SearchStrategy[Algorithm]:
    """An algorithm of the catalogue with its policies. Shrinks to the first, then to the reference.

    Args:
        algorithms: names; default: all of the catalogue.
        policies: default: all; `st.just(Policies())` for the reference policies.
        planar: if no algorithms are named, also draw those that are right in planar worlds only.
    """
    if algorithms is None:
        names = [name for name, a in CATALOGUE.items() if planar or a.assumes is None]
    else:
        names = list(algorithms)
    unknown = [name for name in names if name not in CATALOGUE]
    if unknown or not names:
        problem = f"no algorithm {unknown[0]!r}" if unknown else "algorithms is empty"
        raise InputError(f"mappers: {problem}: there are {', '.join(CATALOGUE)}")
    drawn = _all_policies() if policies is None else policies

    def with_policies(name: str, chosen: Policies) -> Algorithm:
        return CATALOGUE[name].with_policies(pick=chosen.pick, order=chosen.order)

    return st.builds(with_policies, st.sampled_from(names), drawn)


def _named(names: Iterable[str], random: bool) -> SearchStrategy[str]:  # noqa: FBT001
    known = st.sampled_from(list(names))
    return known | st.integers(0, _MAX_SEED).map("random({})".format) if random else known


@shown_as_called
def door_words(
    world: World | str, *, min_length: int = 0, max_length: int = 100
) -> SearchStrategy[tuple[Door, ...]]:
    """Sequences of doors, each less than the degree of the vertex that it leads out of.

    Shrinks to few doors, then to low ones. Of more than 256 doors only the first 256 are drawn.

    Args:
        world: where the robot walks, from the marker on; or a text, as on the command line.
        min_length, max_length: the number of doors.
    Example:
        >>> from hypothesis import find
        >>> find(door_words(World.from_id("m2/0"), min_length=2), lambda doors: True)
        (0, 0)
    """
    least = integer("door_words", "min_length", min_length)
    most = integer("door_words", "max_length", max_length)
    if not least <= most <= LARGEST:
        raise InputError(
            f"door_words: min_length={least}, max_length={most}, expected"
            f" min_length <= max_length <= {LARGEST}"
        )
    world = resolve_world(world) if isinstance(world, str) else world
    if not world.alpha:
        if least:
            raise InputError(
                f"door_words: expected min_length=0 in a world without doors, got {least}"
            )
        most = 0
    return _door_words(world, least, most)


@st.composite
def _door_words(draw: st.DrawFn, world: World, least: int, most: int) -> tuple[Door, ...]:
    doors: list[Door] = []
    at = world.root or 0
    for byte in draw_bytes(draw, least, most):
        # so every string of bytes is a walk
        doors.append(byte % world.degrees[world.vertex_of[at]])
        at = world.alpha[exit_dart(world, at, doors[-1])]
    return tuple(doors)
