"""Registers three types and three profiles with Hypothesis.

    st.from_type          World, Algorithm and Policies draw from the strategies of their names
    topo                  the profile in force (on a build server `ci`) without a deadline
    topo-ci               the same examples everywhere, no deadline
    topo-nightly          new examples every time, fifty times as many

They leave out the phase that explains: it traces the mapper, which makes long runs much slower, and
names lines of this package.

Hypothesis calls `register` at import, in every program, so it imports nothing that `import
topo_verify` does not.
"""

from __future__ import annotations

from typing import Any

from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st

# the package: its import of Hypothesis may have called this
from topo_verify import strategies
from topo_verify.algorithms import Algorithm
from topo_verify.robot.events import Policies
from topo_verify.world.rooted_map import World


def register() -> None:
    """Register the types and the profiles; repeatable."""
    st.register_type_strategy(World, lambda _: strategies.worlds())
    st.register_type_strategy(Algorithm, lambda _: strategies.mappers())
    st.register_type_strategy(Policies, lambda _: strategies.policies())
    # speed depends on the machine and the world
    calm: dict[str, Any] = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
    calm["phases"] = [phase for phase in Phase if phase != Phase.explain]
    settings.register_profile("topo", **calm)
    for name, examples in (("topo-ci", 100), ("topo-nightly", 5_000)):
        settings.register_profile(
            name,
            max_examples=examples,
            derandomize=name == "topo-ci",
            print_blob=True,
            **calm,
        )
