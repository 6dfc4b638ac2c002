"""One mapper in every small world: a verdict for each claim, and its first world."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.faults.every import EVERY
from topo_verify import CATALOGUE, Robot, World
from topo_verify.campaign.targets import one_target, targets
from topo_verify.checkers import CLAIMS, Judgement, Status, check
from topo_verify.errors import InputError
from topo_verify.robot.limits import Limits
from topo_verify.studies.verify.by_claim import ClaimResults, by_claim

MAPPERS = Path(__file__).parents[2] / "cli" / "mappers.py"


def of(name: str, edges: int = 2, limits: Limits | None = None) -> ClaimResults:
    (target,) = targets(f"{MAPPERS}:{name}")
    return by_claim(target, edges, limits or Limits())


def statuses(outcome: ClaimResults) -> dict[str, set[str]]:
    """The claims by what became of them."""
    found: dict[str, set[str]] = {}
    for claim in CLAIMS:
        found.setdefault(outcome.verdict(claim), set()).add(claim)
    return found


def test_every_claim_holds_for_a_right_mapper() -> None:
    outcome = of("right", 3)
    assert statuses(outcome) == {"holds": set(CLAIMS)}
    assert (outcome.part.checked, outcome.part.verdict) == (86, "EXHAUSTED")
    assert outcome.text("cost-honest") == "cost-honest holds in 86 worlds of 1 to 3 edges"


def test_each_claim_that_fails_has_its_own_first_world() -> None:
    outcome = of("guesses", 3)
    assert statuses(outcome)["fails"] == {"map-isomorphic", "cost-within-bound", "map-entailed"}
    assert outcome.first["map-isomorphic"].world == "m1/1"
    assert outcome.first["cost-within-bound"].world == "m2/0"
    told = outcome.text("cost-within-bound")
    assert "!! cost-within-bound: a cost of 1 is outside 2 … 30" in told  # the walk in m2/0
    assert told.startswith("cost-within-bound fails in 84 of 86 worlds of 1 to 3 edges, first in ")
    assert told.endswith(f"again: topo-verify replay m2/0 --target {MAPPERS}:guesses")


def test_the_first_world_is_kept_even_if_many_have_failed_before() -> None:
    """A report keeps the findings of the first failing runs only."""
    outcome = of("ignores_direction", 3)
    kept = {finding.claim for finding in outcome.part.findings}
    failing = {claim for claim in CLAIMS if outcome.verdict(claim) == "fails"}
    assert failing == outcome.first.keys() >= kept


def test_what_is_not_declared_is_neither_holding_nor_failing() -> None:
    outcome = of("silent")
    found = statuses(outcome)
    assert outcome.part.ok
    assert outcome.part.summary.endswith("5 of 10 claims hold, 5 not declared")
    assert len(found["not-declared"]) == 5
    assert found.keys() == {"holds", "not-declared"}


def declares_at_leaves(robot: Robot) -> object:
    """Right; it declares its decisions only where the marker lies at a leaf."""
    silent = EVERY["declares-nothing"]
    return CATALOGUE["basic"](robot) if robot.percept.degree == 1 else silent(robot)


def test_what_is_declared_in_some_worlds_only_is_told_apart() -> None:
    outcome = by_claim(one_target(declares_at_leaves), 2, Limits())
    assert outcome.verdict("no-false-confirm") == "not-declared"
    assert "in 3 of 12 worlds, where it holds" in outcome.text("no-false-confirm")


def test_the_line_at_which_a_mapper_raised_is_told() -> None:
    told = of("raises").text("map-isomorphic")
    assert "the mapper raised ValueError: no\\x1b[31m way\\nat all" in told
    assert f"raised at: {MAPPERS}:" in told
    assert "raised at" not in of("guesses").text("map-isomorphic")


def test_a_mapper_out_of_time_is_undecided() -> None:
    outcome = of("strolls", limits=Limits(world_timeout=0.02))
    assert statuses(outcome) == {"undecided": set(CLAIMS)}
    assert (outcome.part.verdict, outcome.part.ok, outcome.part.findings) == ("UNKNOWN", False, ())
    assert "3 runs out of time" in outcome.text("map-isomorphic")
    assert not outcome.first


def test_what_a_checker_leaves_undecided_in_one_world_does_not_hold(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def once_undecided(world: World, *args: Any, **options: Any) -> list[Judgement]:
        *others, last = check(world, *args, **options)
        status: Status = "undecided" if world.id == "m2/3" else last.status
        return [*others, msgspec.structs.replace(last, status=status)]

    monkeypatch.setattr("topo_verify.campaign.judge.check", once_undecided)
    outcome = of("right")
    assert statuses(outcome)["undecided"] == {"decisions-entailed"}
    assert "decisions-entailed is undecided: 11 of 12 worlds" in outcome.text("decisions-entailed")
    assert outcome.part.verdict == "UNKNOWN"


def test_a_mapper_that_hangs_fails_where_it_did_and_is_undecided_elsewhere() -> None:
    outcome = of("loops", limits=Limits(move_timeout=0.06))
    assert statuses(outcome)["fails"] == {"map-isomorphic"}
    assert statuses(outcome)["undecided"] == set(CLAIMS) - {"map-isomorphic"}


def test_more_edges_than_are_enumerated_are_refused() -> None:
    with pytest.raises(InputError, match="from 1 to 9"):
        of("right", 10)
