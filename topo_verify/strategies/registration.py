"""Registers three types and three profiles with Hypothesis, as soon as both are installed.

    st.from_type(World)   draws from `worlds()`, so World may stand in any annotation; so may
                          Algorithm (`mappers()`) and Policies (`policies()`)
    topo                  a profile: Hypothesis's own, with no deadline; the pytest plugin loads it
                          for property tests of mappers where the user has loaded none
    topo-ci               a profile: the same examples everywhere, no deadline
    topo-nightly          a profile: new examples every time, fifty times as many

Hypothesis calls `register` when it is imported (entry point, group `hypothesis`), in every program
of the environment. So it makes no strategy and imports nothing that `import topo_verify` does not.
"""

from __future__ import annotations

from pathlib import Path

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.internal import scrutineer

# The package, not its names: it may be the one whose import of Hypothesis brought us here.
from topo_verify import strategies
from topo_verify.algorithms import Algorithm
from topo_verify.robot.events import Policies
from topo_verify.world.rooted_map import World

PACKAGE = Path(__file__).parent.parent


def register() -> None:
    """Register the types and the profiles. A second call changes nothing."""
    st.register_type_strategy(World, lambda _: strategies.worlds())
    st.register_type_strategy(Algorithm, lambda _: strategies.mappers())
    st.register_type_strategy(Policies, lambda _: strategies.policies())
    # A line of ours that only failing examples run says nothing of the user's mapper.
    ours = [f"/topo_verify/{path.name}{'/**' * path.is_dir()}" for path in PACKAGE.iterdir()]
    known = scrutineer.UNHELPFUL_LOCATIONS
    # By `vars`, since its type says how many names there are.
    scrutineer.__dict__["UNHELPFUL_LOCATIONS"] = (*known, *(n for n in ours if n not in known))
    # How long an example takes depends on the load of the machine, and on the world.
    settings.register_profile("topo", deadline=None, suppress_health_check=[HealthCheck.too_slow])
    for name, examples in (("topo-ci", 100), ("topo-nightly", 5_000)):
        settings.register_profile(
            name,
            max_examples=examples,
            derandomize=name == "topo-ci",
            deadline=None,
            print_blob=True,
            # How fast examples are drawn depends on the load of the machine, not on the code.
            suppress_health_check=[HealthCheck.too_slow],
        )
