"""What is said of a run: the report, the line that shows it again, and assert_maps."""

from __future__ import annotations

import json
import shlex
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import msgspec
import pytest

import topo_verify as tv
from tests.campaign.test_run import WORLD, mistaken, right
from tests.helpers import EMPTY, path, worlds
from tests.python import python
from topo_verify.algorithms import Policies
from topo_verify.campaign.judge import Report, judge, judge_trace, replay_line, world_argument
from topo_verify.campaign.targets import one_target
from topo_verify.checkers import CLAIMS, Judgement, check
from topo_verify.errors import InternalError
from topo_verify.faults import FAULTS
from topo_verify.programs.loader import Mapper, Target
from topo_verify.robot.events import Augment, Pose
from topo_verify.robot.simulator import SimulatedRobot

OURS = {"PYTHONPATH": str(Path(__file__).parents[2])}


def test_a_report_says_how_much_of_what_holds() -> None:
    report = tv.examine("enhancement-i", WORLD)
    n = len(report.claims)
    assert report.ok
    assert str(report) == f"enhancement-i in m2/5, 2 edge traversals: {n} of {n} claims hold"
    assert str(tv.examine("basic", tv.World.from_id("m1/0"))).startswith(
        "basic in m1/0, 1 edge traversal: "
    )


def test_a_report_shows_what_fails_and_how_to_see_it_again() -> None:
    report = tv.examine(mistaken, WORLD)
    lines = str(report).splitlines()
    assert lines[0].startswith("tests.campaign.test_run:mistaken in m2/5, 0 edge traversals: ")
    assert " fail, " in lines[0]
    assert lines[0].endswith(" not declared")
    assert lines[1] == (
        "  map-isomorphic (event 1): the map (2 vertices, 1 edge) is not isomorphic to the"
        " true map (2 vertices, 2 edges)"
    )
    assert lines[2].startswith("  cost-within-bound: a cost of 0 is outside 2 …")
    assert lines[-1] == (
        "  again: topo-verify replay m2/5 --target tests.campaign.test_run:mistaken"
    )


def test_a_report_shows_the_first_finding_of_a_claim_and_how_many_more_there_are() -> None:
    report = tv.examine(mistaken, WORLD)
    first, second, *others = report.findings
    assert second.claim != first.claim
    many: Any = report.with_findings([*[first] * 36, second, *others])
    lines = str(many).splitlines()
    assert lines[1].startswith("  map-isomorphic (event 1): the map")
    assert lines[2] == "    … and 35 more"
    assert lines[3].startswith("  cost-within-bound: a cost of 0")
    assert many._repr_html_().count("is not isomorphic to the true map") == 1
    assert " … and 35 more</li>" in many._repr_html_()
    assert str(many).count(" more") == 1


def test_the_text_of_a_report_shows_the_walk() -> None:
    report = tv.examine(lambda robot: robot.move(9), tv.World.from_id("m3/8"))
    assert "asked for door 9 at a vertex with 1 door" in str(report)
    assert "The robot stands at v0:0 (w0:0), a vertex with 1 door:" in str(report).splitlines()


def test_the_walk_stays_with_a_report_and_is_no_part_of_its_data() -> None:
    report = tv.examine(lambda robot: robot.move(9), tv.World.from_id("m3/8"))
    fewer = report.with_findings(report.findings[:1])
    assert fewer.run is report.run
    assert "_run" not in json.loads(report.to_json())
    read = msgspec.json.decode(report.to_json(), type=Report)
    assert (read.run, read.playback) == (None, None)
    assert "The robot stands" not in str(read)


def test_a_report_is_one_json_object() -> None:
    report = tv.examine(mistaken, WORLD, where="corner.json")
    told = json.loads(report.to_json())
    assert list(told) == ["world", "target", "ok", "cost", "claims", "findings", "judgements"]
    assert set(told["findings"][0]) >= {
        "claim", "world", "event", "expected", "seen", "message", "replay",
    }  # fmt: skip
    assert told["findings"][0]["world"] == told["world"] == "corner.json"
    assert told["claims"]["no-false-confirm"] == "not-declared"


def test_the_replay_line_names_a_target_that_finds_the_mapper_again() -> None:
    (finding, *_) = tv.examine(mistaken, WORLD).findings
    words = shlex.split(finding.replay)
    assert words[:2] == ["topo-verify", "replay"]
    assert tv.World.from_id(words[2]).code == WORLD.code
    assert one_target(words[words.index("--target") + 1]).mapper is mistaken


def test_the_replay_line_of_a_script_names_its_file(tmp_path: Path) -> None:
    script = tmp_path / "mine.py"
    script.write_text(
        "import topo_verify as tv\n"
        "def mapper(robot): return 7\n"
        "if __name__ == '__main__':\n"
        "    print(tv.examine(mapper, tv.World.from_id('m1/0')).findings[0].replay)\n"
    )
    done = python("mine.py", check=True, cwd=tmp_path, environment=OURS)
    target = shlex.split(done.stdout)[-1]
    assert Path(target.partition(":")[0]).name == "mine.py"
    found = one_target(f"{tmp_path / target.partition(':')[0]}:mapper")
    assert found.mapper(SimulatedRobot(WORLD, 0)) == 7


SESSION = """
import topo_verify as tv
def mapper(robot): return 7
report = tv.examine(mapper, tv.World.from_id('m1/0'))
print([finding.replay for finding in report.findings], 'again' in str(report))
"""


@pytest.mark.parametrize("words", [["-"], ["script.py"]], ids=["a notebook", "a script"])
def test_where_no_command_finds_the_mapper_again_none_is_shown(
    words: list[str], tmp_path: Path
) -> None:
    """A notebook has no file. A script with no guard would do its work again when it is loaded."""
    (tmp_path / "script.py").write_text(SESSION)
    done = python(*words, input=SESSION, check=True, cwd=tmp_path, environment=OURS)
    assert done.stdout == "[''] False\n"


def test_the_replay_line_carries_policies_limits_and_odd_names() -> None:
    assert replay_line("a b.json", "basic", Policies("last", "random(3)")) == (
        "topo-verify replay 'a b.json' --target basic --pick last --order 'random(3)'"
    )
    lazy_limits = tv.Limits(budget=1)
    (finding, *_) = tv.examine("basic", WORLD, pick="first", limits=lazy_limits).findings
    assert finding.replay == ("topo-verify replay m2/5 --target basic --pick first --budget 1")


def test_a_large_world_is_named_by_its_family_or_a_file() -> None:
    assert world_argument(path(300, marker=0)) == "world.json"
    lattice = tv.families.lattice(12, 12)
    assert world_argument(lattice) == f"family:{lattice.name}"
    other = replace(lattice, name="lattice(12,13)")
    assert world_argument(other) == "lattice(12,13).json"
    assert world_argument(WORLD) == "m2/5"


def test_a_trace_from_elsewhere_is_judged_like_a_run() -> None:
    run = tv.explore(WORLD, "basic")
    report = judge_trace(WORLD, run.trace, target="basic")
    assert report == judge(run) == tv.examine("basic", WORLD)
    assert isinstance(report, Report)
    again = judge_trace(WORLD, run.trace[:-1], target="basic", replay_command="look at it")
    assert {finding.replay for finding in again.findings} == {"look at it"}


# ---------------------------------------------------------------- assert_maps


def test_assert_maps_lets_a_right_mapper_pass() -> None:
    tv.assert_maps(right, WORLD)
    tv.assert_maps(
        "enhancement-ii", WORLD, pick="last", order="oldest", limits=tv.Limits(budget=50)
    )


def test_assert_maps_fails_like_an_assertion_with_the_report_as_its_text() -> None:
    with pytest.raises(AssertionError) as failed:
        tv.assert_maps(mistaken, WORLD)
    assert isinstance(failed.value, tv.ClaimFailed)
    assert str(failed.value) == str(tv.examine(mistaken, WORLD))
    assert failed.value.__cause__ is None


def test_assert_maps_shows_the_mappers_own_exception_as_the_cause() -> None:
    mine = KeyError("dart 7")

    def fail(_robot: tv.Robot) -> object:
        raise mine

    with pytest.raises(tv.ClaimFailed) as failed:
        tv.assert_maps(fail, WORLD)
    assert failed.value.__cause__ is mine


def test_assert_maps_ends_a_run_at_its_first_false_augmentation() -> None:
    def never_ends(robot: tv.Robot) -> object:
        robot.declare(Augment(0, "new", 3, 9))
        while True:
            robot.declare(Pose(3, ()))

    with pytest.raises(tv.ClaimFailed, match="no map was delivered: its 'augment' at event 1 is"):
        tv.assert_maps(never_ends, WORLD)


def test_assert_maps_does_not_pass_what_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    def half_decided(*args: Any, **options: Any) -> list[Judgement]:
        *others, last = check(*args, **options)
        return [*others, msgspec.structs.replace(last, status="undecided", judged=last.of - 1)]

    monkeypatch.setattr("topo_verify.campaign.judge.check", half_decided)
    with pytest.raises(AssertionError) as raised:
        tv.assert_maps(right, WORLD)
    assert isinstance(raised.value, tv.ClaimUndecided)
    assert "decisions-entailed is not decided: " in str(raised.value)
    with pytest.raises(tv.ClaimFailed):  # what fails weighs more
        tv.assert_maps(mistaken, WORLD)


def test_assert_maps_refuses_what_is_no_mapper() -> None:
    with pytest.raises(tv.InputError, match="no algorithm 'nobody'"):
        tv.assert_maps("nobody", WORLD)


def test_the_witness_is_run_with_the_limits_of_the_run() -> None:
    runs = iter([FAULTS["confirms-what-is-alone"]])

    def mapper(robot: tv.Robot) -> object:
        lucky = next(runs, None)
        if lucky is not None:
            return lucky(robot)
        while True:
            robot.move(0)

    report = tv.examine(mapper, tv.World.from_id("m2/1"), limits=tv.Limits(budget=7))
    (told,) = [f.message for f in report.findings if f.claim == "map-entailed"]
    assert "run there, the mapper asked for more than 7 moves, its budget" in told


def lucky(robot: tv.Robot) -> object:
    return FAULTS["confirms-what-is-alone"](robot)


def test_a_finding_says_that_the_map_was_right_by_luck_and_how_to_see_it_wrong() -> None:
    report = tv.examine(lucky, "m2/1")
    assert report.claims["map-isomorphic"] == "ok"
    (message,) = [f.message for f in report.findings if f.claim == "map-entailed"]
    assert "; the map is right here by luck, for another world shows the same" in message
    again = replay_line("m5/98", one_target(lucky).text)
    assert message.endswith(f"; witness m5/98: run there, the mapper is wrong: {again}")
    assert tv.examine(lucky, "m5/98").claims["map-isomorphic"] == "failed"


def test_where_the_map_is_wrong_there_is_no_word_of_luck() -> None:
    messages = [f.message for f in tv.examine(lucky, "m5/98").findings]
    assert messages
    assert not any("by luck" in message for message in messages)


def test_a_world_is_not_told_as_its_own_witness() -> None:
    def single_edge(_robot: tv.Robot) -> object:
        return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}

    told = {w: tv.examine(single_edge, w).findings for w in ("m1/0", "m2/0")}
    assert any("witness m2/0" in finding.message for finding in told["m1/0"])
    assert not any("witness" in finding.message for finding in told["m2/0"])


@pytest.mark.parametrize(
    "wrong_order",
    [
        (tv.explore, "basic", WORLD),
        (tv.explore, lucky, "m3/5"),
        (tv.examine, WORLD, "basic"),
        (tv.assert_maps, "m3/5", "basic"),
    ],
)
def test_world_and_mapper_in_the_wrong_order_are_named(wrong_order: tuple[Any, Any, Any]) -> None:
    function, first, second = wrong_order
    with pytest.raises(tv.InputError, match="world and mapper have changed places: write"):
        function(first, second)


@pytest.mark.parametrize("function", [tv.explore, tv.examine])
def test_a_number_in_the_place_of_limits_is_refused(function: Any) -> None:
    asked = (WORLD, "basic") if function is tv.explore else ("basic", WORLD)
    with pytest.raises(tv.InputError, match=r"limits=5: expected tv.Limits, as in"):
        function(*asked, limits=cast("Any", 5))


def test_a_text_names_a_world_as_on_the_command_line(tmp_path: Path) -> None:
    WORLD.save(tmp_path / "world.json")
    for text in (WORLD.id, str(tmp_path / "world.json")):
        assert tv.explore(text, "basic").world == WORLD
        assert tv.examine("basic", text).ok
    with pytest.raises(tv.InputError, match="expected a World or a text that names one"):
        tv.explore(cast("Any", 5))
    entry: Any = tv.search(mistaken, edges=1)
    with pytest.raises(tv.InputError, match=r"got Counterexample\(.*\); give its \.world$"):
        tv.examine(mistaken, entry.counterexample)
    with pytest.raises(tv.InputError, match="no such world: 'm3/x'"):
        tv.examine("basic", "m3/x")


# ---------------------------------------------------------------- text of unknown origin

HOSTILE = "\x1b[31m\u202eboom\n  again: nothing to see"


def test_no_text_that_a_mapper_brings_controls_a_terminal() -> None:
    def raises(_robot: object) -> None:
        raise ValueError(HOSTILE)

    run = tv.explore(WORLD, raises)
    report = judge(run, where=HOSTILE)
    with pytest.raises(tv.ClaimFailed) as failed:
        tv.assert_maps(raises, WORLD)
    texts = [str(run.stopped), *(finding.message for finding in report.findings)]
    texts += [*str(report).splitlines(), *str(failed.value).splitlines()]
    assert all(text.isprintable() for text in texts)
    assert "\\x1b[31m\\u202eboom\\n  again: nothing to see" in str(failed.value)


def test_no_name_of_a_file_controls_a_terminal(tmp_path: Path) -> None:
    file = tmp_path / "a\x1b[31m.py"
    file.write_text("def explore(robot): return None\n")
    report = tv.examine(f"{file}:explore", WORLD)
    assert all(line.isprintable() for line in str(report).splitlines())
    (replay,) = {finding.replay for finding in report.findings}
    assert f"{file}:explore" in shlex.split(replay)  # for scripts it is the line itself


def test_no_sentence_about_bad_input_controls_a_terminal(tmp_path: Path) -> None:
    file = tmp_path / "a\x1b[31m.py"
    file.touch()
    for bad in (f"{file}:explore", f"{file}x:explore", "a\x1b[31m", "a\x1b[31m:explore"):
        with pytest.raises(tv.InputError) as refused:
            tv.examine(bad, WORLD)
        assert str(refused.value).isprintable()


# ---------------------------------------------------------------- below the least cost of a proof


@pytest.fixture
def all_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    """Checkers with a fault: every claim holds of every run."""

    def check(*_: object, strict: bool) -> list[Judgement]:
        assert not strict
        return [Judgement(claim, "ok", 1, 1) for claim in CLAIMS]

    monkeypatch.setattr("topo_verify.campaign.judge.check", check)


def steps(world: tv.World, moves: int) -> Mapper:
    """A mapper that is given the map, and walks this much of a cheapest walk that proves it."""

    def walk(robot: tv.Robot) -> object:
        for door in world.proof_tour()[:moves]:
            robot.move(door)
        return world

    return walk


@pytest.mark.usefixtures("all_hold")
def test_no_run_is_right_below_the_least_cost_of_a_proof() -> None:
    for world in worlds([1, 2, 3]):
        least = world.least_cost()
        report = tv.examine(steps(world, least - 1), world)
        (wrong,) = report.findings
        assert not report.ok
        assert (wrong.claim, wrong.expected, wrong.seen) == (
            "cost-within-bound",
            f"at least {least}",
            least - 1,
        )
        assert report.claims["cost-within-bound"] == "failed"
        assert report.cost == least - 1
        assert "somebody changed the checkers" in str(report)
        assert wrong.world == world.id


@pytest.mark.usefixtures("all_hold")
def test_an_algorithm_of_the_catalogue_below_it_is_a_bug_of_ours_in_a_named_world() -> None:
    world = tv.World.from_id("m3/14")
    cheap = Target("basic", steps(world, 3))
    why = f"m3/14, basic: no claim fails at a cost of 3, and .* is {world.least_cost()}"
    with pytest.raises(InternalError, match=why):
        tv.examine(cheap, world)


def test_a_run_at_the_least_cost_of_a_proof_is_right() -> None:
    for world in (EMPTY, *worlds([1, 2, 3])):
        assert tv.examine(steps(world, world.least_cost()), world).ok


def test_a_report_on_a_world_without_an_id_says_how_to_write_its_file() -> None:
    report = tv.examine("basic", path(300, marker=0), limits=tv.Limits(budget=1))
    assert "(write the file first: world.save('world.json'))" in str(report)
    assert "world.save" not in str(tv.examine("basic", "m2/4", limits=tv.Limits(budget=1)))
