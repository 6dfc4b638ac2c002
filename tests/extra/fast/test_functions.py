"""A function that numba compiles as a mapper: the runs of the reference, and its misdeeds."""

from __future__ import annotations

import pytest

from tests.programs.natives import HOSTILE_NUMBA as HOSTILE
from tests.programs.natives import ROOT
from topo_verify import InputError, World, examine, explore, extras
from topo_verify.campaign.targets import each_text, one_target

pytestmark = pytest.mark.skipif(not extras.usable_engines(), reason="numba is not installed")

EXAMPLE = ROOT / "examples" / "native_numba" / "mapper.py"

MISDEEDS = {
    "crash": "SIGSEGV",
    "leave": "exit code 0",
    "double_itself": "SIGABRT",
    "give_up": "None (is a `return` missing?) has no 'vertices'",
    "no_map": "a map of -1 vertices",
}
"""Each misdeed of hostile_numba.py, and what is said of it behind the pipe."""


@pytest.mark.long
def test_the_example_makes_the_events_of_basic_and_the_wrong_one_does_not() -> None:
    target = one_target(f"{EXAMPLE}:explore")
    assert target.text == f"--library {EXAMPLE}:explore"
    for name in ("m1/0", "m2/5", "m3/14", "m4/700", "m8/1000000"):
        world = World.from_id(name)
        assert explore(world, target).trace[1:] == explore(world, "basic").trace[1:]
    assert examine(target, World.from_id("m3/5")).ok
    assert not examine(one_target(f"{EXAMPLE}:wrong"), World.from_id("m3/5")).ok


@pytest.mark.long
@pytest.mark.parametrize("deed", MISDEEDS)
def test_a_misdeed_is_a_finding_in_its_world(deed: str) -> None:
    target = one_target(f"{HOSTILE}:{deed}")
    assert examine(target, World.from_id("m1/1")).ok
    assert MISDEEDS[deed] in str(explore(World.from_id("m2/9"), target).stopped)
    assert examine(target, World.from_id("m1/1")).ok


@pytest.mark.long
def test_what_is_no_native_mapper_is_refused_in_one_sentence() -> None:
    for name, words in (
        (f"--library {HOSTILE}:plain", "expected a function compiled by numba, got function"),
        (f"--library {HOSTILE}:none", "has no attribute 'none'"),
        (f"--library {HOSTILE}:half_words", "expected a row of int64 without gaps, got array"),
        (f"{HOSTILE}:found_late.there", f"give it as --library {HOSTILE}:found_late.there"),
    ):
        with pytest.raises(InputError, match=words) as seen:
            explore("m1/0", one_target(name, in_process=False))
        assert "\n" not in str(seen.value)


def test_a_target_is_a_native_mapper_if_its_source_says_so() -> None:
    jitted, plain = f"{HOSTILE}:crash", f"{HOSTILE}:plain"
    assert each_text(f"basic,{jitted},{plain}") == ("basic", f"--library {jitted}", plain)
    assert each_text("no_file.py:explore") == ("no_file.py:explore",)
