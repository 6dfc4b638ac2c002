"""Draws algorithms of the catalogue, with all the policies that the paper leaves open.

    strategy   draws                                          its simplest value
    policies   which edge next, which hypothesis first        nearest, shortest: the reference
    mappers    an algorithm of the catalogue with policies    basic with the reference policies

Every claim holds for every mapper drawn, so a test of a claim may draw any. (Those that assume a
planar world are drawn on request only.)
"""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.errors import InputError
from topo_verify.robot.events import Policies
from topo_verify.strategies.naming import shown_as_called

_MAX_SEED = 10**6


@shown_as_called
def policies(*, random: bool = True) -> SearchStrategy[Policies]:
    """Pick and order, by name.

    Args:
        random: also draw `random(seed)`.
    """
    return st.builds(Policies, pick=_named(PICKS, random), order=_named(ORDERS, random))


@shown_as_called
def mappers(
    *,
    algorithms: Iterable[str] | None = None,
    policies: SearchStrategy[Policies] | None = None,
    planar: bool = False,
) -> SearchStrategy[Algorithm]:
    """An algorithm of the catalogue with its policies. Shrinks to the first, then to the reference.

    Args:
        algorithms: names; all of the catalogue if None.
        policies: which ones; all if None. `st.just(Policies())` for the reference policies.
        planar: if no algorithms are named, also draw those that are right in planar worlds only.
    Raises:
        InputError: no such algorithm, or none at all.
    """
    if algorithms is None:
        names = [name for name, a in CATALOGUE.items() if planar or a.assumes is None]
    else:
        names = list(algorithms)
    unknown = [name for name in names if name not in CATALOGUE]
    if unknown or not names:
        problem = f"no algorithm {unknown[0]!r}" if unknown else "algorithms is empty"
        raise InputError(f"mappers: {problem}: there are {', '.join(CATALOGUE)}")
    chosen = _all_policies() if policies is None else policies
    return st.builds(_with_policies, st.sampled_from(names), chosen)


def _all_policies() -> SearchStrategy[Policies]:
    return policies()


def _with_policies(name: str, chosen: Policies) -> Algorithm:
    return CATALOGUE[name].with_policies(pick=chosen.pick, order=chosen.order)


def _named(names: Iterable[str], random: bool) -> SearchStrategy[str]:  # noqa: FBT001  private
    known = st.sampled_from(list(names))
    return known | st.integers(0, _MAX_SEED).map("random({})".format) if random else known
