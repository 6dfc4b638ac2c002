"""A mapper against a baseline: each world falls into one kind, and all are counted."""

from __future__ import annotations

from fractions import Fraction

import msgspec
import pytest

from tests.faults.every import EVERY
from tests.studies.baseline.recording import recording
from topo_verify import Robot
from topo_verify.campaign.targets import one_target
from topo_verify.errors import InputError
from topo_verify.programs.loader import Mapper, Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.baseline import compare as study
from topo_verify.studies.baseline.compare import compare as join
from topo_verify.studies.baseline.file import Baseline
from topo_verify.studies.baseline.record import baseline_runs

WORLDS = ("edges<=3", "m9/67076232", "m13/15648481438039", "nyc")


def recorded(mapper: Mapper | str | Target, *worlds: str, limits: Limits | None = None) -> Baseline:
    return recording(one_target(mapper), *(worlds or WORLDS), limits=limits)


def compare(
    baseline: Baseline, target: Target, *, tolerance: Fraction | str = "0", name: str = "baseline"
) -> study.Comparison:
    """Run the mapper in the baseline's worlds and say what has changed."""
    worlds, limits = study.BaselineWorlds(baseline, name), baseline.header.limits
    runs = baseline_runs(target, worlds, len(baseline.entries), limits=limits)
    return join(baseline, target, runs.rows(0), tolerance=tolerance)


def kinds(comparison: study.Comparison) -> dict[str, int]:
    """The kinds that occur."""
    return {kind: number for kind, number in comparison.kinds.items() if number}


@pytest.fixture(scope="module")
def basic() -> Baseline:
    return recorded("basic")


# ---------------------------------------------------------------- kinds


def test_a_mapper_is_equal_to_itself(basic: Baseline) -> None:
    found = compare(basic, one_target("basic"))
    assert kinds(found) == {"equal": 89}
    assert found.cost.before == found.cost.after
    assert (found.beyond, found.examples) == (0, ())
    assert not [group for group in found.groups if group.changed]


def test_a_cheaper_mapper_is_cheaper_and_the_other_way_round_dearer(basic: Baseline) -> None:
    found = compare(basic, one_target("enhancement-i"))
    assert kinds(found) == {"cheaper": 3, "equal": 86}
    back = compare(recorded("enhancement-i"), one_target("basic"))
    assert kinds(back) == {"dearer": 3, "equal": 86}
    assert (back.cost.before, back.cost.after) == (found.cost.after, found.cost.before)


def test_the_largest_change_comes_first(basic: Baseline) -> None:
    found = compare(basic, one_target("enhancement-i"))
    rows = [
        (change.world, change.before, change.after, change.percent) for change in found.examples
    ]
    assert rows == [
        ("nyc", 1468, 982, -33.1),
        ("m9/67076232", 64, 36, -43.8),
        ("m13/15648481438039", 46, 38, -17.4),
    ]
    assert found.examples[0].replay == "topo-verify replay nyc --target enhancement-i"


def test_other_policies_are_other_decisions_where_the_cost_is_the_same(basic: Baseline) -> None:
    found = compare(basic, one_target("basic", pick="last"))
    assert found.kinds["other_decisions"] > 0
    (first, *_) = [c for c in found.examples if c.kind == "other_decisions"]
    assert first.before == first.after
    assert first.message == "other moves"
    assert first.replay.endswith("--pick last")


def test_a_mapper_that_no_longer_declares_is_a_regression(basic: Baseline) -> None:
    silent = one_target(EVERY["declares-nothing"])
    found = compare(basic, silent)
    assert kinds(found) == {"other_decisions": 89}
    assert (found.undeclared, found.regressed) == (89, True)
    assert {change.message for change in found.examples} == {"declares nothing now"}
    dearer = compare(recorded("enhancement-i"), silent, tolerance="100")
    assert (dearer.dearer, dearer.undeclared) == (3, 89)


def test_a_baseline_that_declares_nothing_is_compared_by_its_moves() -> None:
    found = compare(recorded(one_target(EVERY["declares-nothing"])), one_target("basic"))
    assert kinds(found) == {"equal": 89}
    assert (found.undeclared, found.regressed) == (0, False)


def test_other_moves_are_seen_where_nothing_is_declared() -> None:
    found = compare(
        recorded(one_target(EVERY["declares-nothing"])), one_target("basic", pick="last")
    )
    assert found.kinds["other_decisions"] > 0
    assert {c.message for c in found.examples if c.kind == "other_decisions"} == {"other moves"}


def test_the_same_moves_for_other_reasons_are_other_decisions() -> None:
    world = "m10/1957360526"
    found = compare(recorded("basic", world), one_target("enhancement-i"))
    assert kinds(found) == {"other_decisions": 1}
    assert found.examples[0].message == "the same moves, other decisions"


def guess(robot: Robot) -> object:
    robot.move(0)
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}


def test_a_wrong_mapper_is_wrong_whatever_the_baseline_says(basic: Baseline) -> None:
    for baseline, right in ((basic, "other_decisions"), (recorded(guess), "equal")):
        found = compare(baseline, one_target(guess))
        assert kinds(found) == {"wrong": 88, right: 1}
        worlds = [change.world for change in found.examples if change.kind == "wrong"]
        assert worlds == ["m1/1", "m2/0", "m2/1", "m2/2", "m2/3"]
        assert len(worlds) == study.EXAMPLES
        assert "not isomorphic" in found.examples[0].message
        assert found.cost == study.CostChange(1, 1)  # m1/0 alone is right in both


def test_a_mapper_that_was_wrong_may_be_right_now() -> None:
    found = compare(recorded(guess), one_target("basic"))
    assert kinds(found) == {"newly_right": 88, "equal": 1}


def test_a_mapper_that_hangs_leaves_the_rest_undecided() -> None:
    def hang(_robot: Robot) -> object:
        while True:
            pass

    limits = Limits(move_timeout=0.06)
    found = compare(recorded("basic", "edges<=2", limits=limits), one_target(hang))
    assert kinds(found) == {"wrong": 3, "undecided": 9}
    (*_, last) = found.examples
    assert last.message == "not run: the mapper was out of time 3 times before"


def test_the_limits_are_those_of_the_baseline() -> None:
    baseline = recorded("enhancement-i", "nyc", limits=Limits(budget=1000))
    found = compare(baseline, one_target("basic"))  # which needs 1468 moves there
    assert kinds(found) == {"wrong": 1}
    assert "more than 1000 moves" in found.examples[0].message
    assert found.examples[0].replay.endswith("--budget 1000")


@pytest.mark.long
def test_the_worlds_are_those_of_the_file() -> None:
    baseline = recorded("basic", "family:lattice(11,11)")  # too large for an id
    text = baseline.entries[0].world
    assert text.startswith("{")
    hidden = msgspec.structs.replace(baseline.entries[0], name="a world that is gone")
    found = compare(Baseline(baseline.header, (hidden,)), one_target("basic"))
    assert kinds(found) == {"equal": 1}


def test_an_entry_without_a_world_is_refused_before_anything_runs(basic: Baseline) -> None:
    entries = (*basic.entries[:3], msgspec.structs.replace(basic.entries[3], world="m2/99"))
    with pytest.raises(InputError, match=r"old\.gz, line 5: .*m2/99"):
        compare(Baseline(basic.header, entries), one_target("basic"), name="old.gz")


# ---------------------------------------------------------------- tolerance


@pytest.mark.parametrize(
    ("tolerance", "beyond"),
    [("0", 3), ("21", 3), ("49", 2), ("49.5", 1), ("77.7", 1), ("77.8", 0), ("100", 0)],
)
def test_the_tolerance_is_asked_of_each_world(tolerance: str, beyond: int) -> None:
    """Dearer by 28/36 = 77.8 %, 486/982 = 49.49 % and 8/38 = 21.05 %."""
    found = compare(recorded("enhancement-i"), one_target("basic"), tolerance=Fraction(tolerance))
    assert found.kinds["dearer"] == 3
    assert found.beyond == sum(change.beyond for change in found.examples) == beyond


def test_the_tolerance_is_exact_at_its_border() -> None:
    baseline = recorded("enhancement-i", "m9/67076232")
    border = Fraction(100 * 28, 36)
    for tolerance, beyond in ((border, 0), (border - Fraction(1, 10**9), 1)):
        assert compare(baseline, one_target("basic"), tolerance=tolerance).beyond == beyond


# ---------------------------------------------------------------- classes of worlds


def test_every_world_is_in_one_class_of_each_property(basic: Baseline) -> None:
    found = compare(basic, one_target("enhancement-i"))
    for by in ("edges", "genus", "shape"):
        groups = [group for group in found.groups if group.by == by]
        assert sum(group.worlds for group in groups) == len(basic.entries)
        assert sum(group.before for group in groups) == found.cost.before
        assert sum(group.after for group in groups) == found.cost.after
        for kind in study.KINDS:
            assert sum(group.kinds[kind] for group in groups) == found.kinds[kind]


def test_classes_come_in_their_order_and_say_what_changed(basic: Baseline) -> None:
    found = compare(basic, one_target("enhancement-i"))
    names = [(group.by, group.value) for group in found.groups]
    assert names[:6] == [("edges", v) for v in ("1", "2", "3", "6-10", "11-20", "51-100")]
    assert names[6:8] == [("genus", "0"), ("genus", "1")]
    assert [v for by, v in names if by == "shape"] == [
        *("simple", "parallel edges, no loop", "with loops")
    ]
    changed = {(group.by, group.value) for group in found.groups if group.changed}
    assert ("edges", "51-100") in changed
    assert ("edges", "3") not in changed


@pytest.mark.long
def test_classes_of_the_extremes_have_names() -> None:
    large = ("family:lattice(11,11)", "family:random_genus(12,4)")
    found = compare(recorded("basic", *large), one_target("basic"))
    names = {(group.by, group.value) for group in found.groups}
    assert names >= {("edges", "201 or more"), ("genus", "3 or more")}


def test_a_world_that_comes_twice_is_shown_once() -> None:
    found = compare(recorded("basic", "nyc", "nyc"), one_target("enhancement-i"))
    assert kinds(found) == {"cheaper": 2}
    assert len(found.examples) == 1
