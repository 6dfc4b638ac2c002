"""The pytest plugin, in sessions of its own: what is collected, what fails, what is said.

A session in a process of its own is what users have; it also keeps the plugin that runs these tests
apart from the one that they are about.
"""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.python import python
from topo_verify import pytest_plugin as plugin
from topo_verify.checkers import CLAIMS

pytest_plugins = ["pytester"]

Session = Callable[..., pytest.RunResult]

MARKED = """
import pytest

@pytest.mark.topo(target="{target}", edges=2)
def test_mine() -> None:
    with open("body", "a") as file:
        file.write("x")
"""

DECLARED = (
    *("true-hypothesis-posed", "true-hypothesis-kept", "no-false-confirm"),
    *("rejection-justified", "decisions-entailed"),
)
"""The claims on what a mapper declares."""


@pytest.fixture
def session(pytester: pytest.Pytester) -> Session:
    """Call pytest in a folder with mappers.py; warnings are errors."""
    shutil.copy(Path(__file__).parent / "cli" / "mappers.py", pytester.path)

    def session(*arguments: str, test: str = "") -> pytest.RunResult:
        if test:
            pytester.makepyfile(test_it=test)
        # Hypothesis's plugin is imported when a session ends, which takes a second.
        usual = ("-W", "error", "--strict-markers", "-p", "no:hypothesispytest", "-rsf")
        return pytester.runpytest_subprocess(*usual, *arguments)

    return session


def said(result: pytest.RunResult) -> str:
    """What a session printed, in one line."""
    return " ".join(result.stdout.str().split())


# ---------------------------------------------------------------- the mark


@pytest.mark.long
def test_a_mark_may_name_a_program(session: Session) -> None:
    command = f"--cmd {sys.executable} -m topo_verify.programs.serve basic"
    result = session(test=MARKED.format(target=command))
    result.assert_outcomes(passed=len(CLAIMS))


def test_a_mark_turns_a_mapper_into_one_test_a_claim(session: Session) -> None:
    result = session("-v", test=MARKED.format(target="mappers:right"))
    result.assert_outcomes(passed=len(CLAIMS))
    for claim in CLAIMS:
        result.stdout.fnmatch_lines(f"test_it.py::test_mine[[]{claim}[]] PASSED*")
    result.stdout.fnmatch_lines(
        ["*= topo-verify =*", "mappers:right: 12 of 12 worlds of 1 to 2 edges, 0 counterexamples"]
    )


@pytest.mark.long
def test_the_mapper_runs_once_in_each_world_and_the_body_after_each_claim(
    session: Session, pytester: pytest.Pytester
) -> None:
    pytester.makepyfile(
        counting="""
        import mappers

        def explore(robot):
            with open("runs", "a") as file:
                file.write("x")
            return mappers.right(robot)
        """
    )
    result = session(test=MARKED.format(target="counting:explore"))
    result.assert_outcomes(passed=len(CLAIMS))
    assert len((pytester.path / "runs").read_text()) == 12
    assert len((pytester.path / "body").read_text()) == len(CLAIMS)


def test_a_wrong_mapper_fails_by_claim_with_the_world_and_the_line(session: Session) -> None:
    result = session(test=MARKED.format(target="mappers:guesses"))
    failing = ("map-isomorphic", "cost-within-bound", "map-entailed")
    result.assert_outcomes(passed=2, failed=3, skipped=5)
    for claim in failing:
        result.stdout.fnmatch_lines(f"FAILED test_it.py::test_mine[[]{claim}[]]*")
    assert "map-isomorphic fails in 11 of 12 worlds of 1 to 2 edges, first in m1/1" in said(result)
    result.stdout.fnmatch_lines(
        [
            "  world: m1/1",
            "  again: topo-verify replay m1/1 --target mappers:guesses",
            "mappers:guesses: 12 of 12 worlds*, 11 counterexamples, first m1/1",
        ]
    )
    assert "Traceback" not in result.stdout.str()


@pytest.mark.long
def test_what_is_not_declared_is_skipped_and_does_not_pass(session: Session) -> None:
    result = session("-v", test=MARKED.format(target="mappers:silent"))
    result.assert_outcomes(passed=5, skipped=5)
    for claim in DECLARED:
        assert f"{claim}: not judged, since the mapper declares none of its decisions" in said(
            result
        )


@pytest.mark.long
def test_a_mapper_that_raises_shows_where(session: Session) -> None:
    result = session("-k", "isomorphic", test=MARKED.format(target="mappers:raises"))
    result.assert_outcomes(failed=1, deselected=len(CLAIMS) - 1)
    assert "the mapper raised ValueError: no\\x1b[31m way\\nat all" in said(result)
    source = (Path(__file__).parent / "cli" / "mappers.py").read_text().splitlines()
    line = next(n for n, text in enumerate(source, 1) if "raise ValueError" in text)
    result.stdout.fnmatch_lines([f"  raised at: *mappers.py:{line}"])


@pytest.mark.long
def test_a_mapper_that_hangs_fails_and_leaves_the_rest_undecided(session: Session) -> None:
    test = MARKED.format(target="mappers:loops")
    result = session("--topo-move-timeout", "0.06", test=test)
    result.assert_outcomes(failed=len(CLAIMS))
    assert "map-isomorphic fails in 3 of 3 worlds" in said(result)
    assert "the mapper did not move for 0.06 s" in said(result)
    sentence = (
        "cost-honest is undecided: 3 of 12 worlds were tried; see map-isomorphic, which fails"
    )
    assert sentence in said(result)


@pytest.mark.long
def test_a_mapper_that_is_too_slow_never_passes(session: Session) -> None:
    test = MARKED.format(target="mappers:strolls")
    result = session("--topo-world-timeout", "0.02", test=test)
    result.assert_outcomes(failed=len(CLAIMS))
    assert "0 of 12 worlds of 1 to 2 edges, 0 counterexamples; not decided: 0 of 12" in said(result)


@pytest.mark.long
def test_a_mark_takes_a_callable_stands_on_classes_and_meets_parameters(session: Session) -> None:
    result = session(
        "-v",
        test="""
        import pytest
        from mappers import right

        @pytest.mark.topo(target=right, edges=1)
        class TestMine:
            @pytest.mark.parametrize("colour", ["red", "blue"])
            def test_one(self, colour: str, tmp_path) -> None:
                assert colour

            @pytest.mark.topo(target="basic,folding", edges=1)
            def test_two(self) -> None: ...
        """,
    )
    result.assert_outcomes(passed=4 * len(CLAIMS))
    result.stdout.fnmatch_lines(
        [
            "*TestMine::test_one[[]map-isomorphic-red[]]*",
            "*TestMine::test_two[[]folding-map-isomorphic[]]*",
            "mappers:right: 2 of 2 worlds of 1 to 1 edges*",
            "basic: 2 of 2 worlds of 1 to 1 edges*",
        ]
    )


MISTAKES = {
    'target="nix"': "no algorithm 'nix'",
    'target="mappers:nix"': "mappers has no attribute 'nix'",
    'target="nowhere:nix"': "cannot import 'nowhere'",
    "target=17": "expected a callable that takes a robot, got 17",
    "": "names no mapper: write @pytest.mark.topo(target=",
    '"basic"': "does not take 'basic'",
    'target="basic", worlds=3': "does not take worlds=…",
    'target="basic", edges=0': "expected a number of edges, 1 or more, got edges=0",
    'target="basic", edges=10': "expected at most 9 edges, got 10",
}
"""Arguments of a mark, and what is said to them."""


@pytest.mark.long
def test_a_mark_that_cannot_be_meant_is_an_error_of_one_sentence(
    session: Session, pytester: pytest.Pytester
) -> None:
    for number, mark in enumerate(MISTAKES):
        test = f"import pytest\n@pytest.mark.topo({mark})\ndef test_mine() -> None: ...\n"
        pytester.makepyfile(**{f"test_{number}": test})
    result = session()
    result.assert_outcomes(errors=len(MISTAKES))
    parts = re.split(r"(?m)^_+ ERROR collecting test_\d\.py _+$", result.stdout.str())
    for number, (part, told) in enumerate(zip(parts[1:], MISTAKES.values(), strict=True)):
        assert f"test_{number}.py::test_mine: " in part
        assert told in part
    assert "Traceback" not in result.stdout.str()


def test_a_mark_that_would_do_nothing_is_an_error(session: Session) -> None:
    result = session(
        test="""
        import pytest, unittest

        @pytest.mark.topo(target="basic")
        class TestOld(unittest.TestCase):
            def test_mine(self) -> None: ...
        """
    )
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    assert "TestOld::test_mine: the mark topo is for functions" in result.stderr.str()


# ---------------------------------------------------------------- options


def test_the_option_alone_collects_tests_without_a_file(session: Session) -> None:
    result = session("--topo-target", "mappers.py:right", "--topo-edges", "2")
    result.assert_outcomes(passed=len(CLAIMS))
    result.stdout.fnmatch_lines(
        [
            f"collected {len(CLAIMS)} items",
            "mappers.py:right ..........*",
            "mappers.py:right: 12 of 12 worlds of 1 to 2 edges, 0 counterexamples",
        ]
    )


@pytest.mark.long
def test_marks_without_a_target_mean_that_of_the_option(session: Session) -> None:
    test = "import pytest\npytestmark = pytest.mark.topo\ndef test_mine() -> None: ...\n"
    result = session("--topo-target", "basic,folding", "--topo-edges", "1", test=test)
    result.assert_outcomes(passed=4 * len(CLAIMS))


@pytest.mark.long
def test_the_mark_selects_the_tests_of_the_option(session: Session) -> None:
    option = ("--topo-target", "basic", "--topo-edges", "1")
    test = "def test_other() -> None: ...\n"
    session(*option, "-m", "topo", test=test).assert_outcomes(passed=len(CLAIMS), deselected=1)


@pytest.mark.long
def test_a_target_that_is_none_is_an_error_of_collection(session: Session) -> None:
    result = session("--topo-target", "nix")
    assert result.ret == pytest.ExitCode.INTERRUPTED
    assert "ERROR collecting nix" in result.stdout.str()
    assert "no algorithm 'nix': there are basic" in result.stdout.str()


@pytest.mark.parametrize(
    ("option", "first", "second"),
    [
        ("--topo-target", "mappers.py:guesses", "basic"),
        ("--topo-edges", "3", "1"),
        ("--topo-move-timeout", "1", "2"),
        ("--topo-world-timeout", "1", "2"),
    ],
)
def test_an_option_given_twice_is_refused(
    option: str, first: str, second: str, session: Session
) -> None:
    result = session(option, first, f"{option}={second}")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    words = f"expected {option} at most once, got {first!r} and {second!r}: leave one out"
    assert words in result.stderr.str()


def test_the_command_line_replaces_an_option_of_the_configuration(
    session: Session, pytester: pytest.Pytester
) -> None:
    pytester.makeini("[pytest]\naddopts = --topo-target folding --topo-edges 2")
    result = session("--topo-target", "basic", "--topo-edges", "1")
    result.assert_outcomes(passed=len(CLAIMS))
    result.stdout.fnmatch_lines(["basic: 2 of 2 worlds*"])


def test_numbers_that_cannot_be_meant_are_refused() -> None:
    parser = pytest.Parser(_ispytest=True)
    plugin.pytest_addoption(parser)
    usual = parser.parse([])
    assert (usual.topo_edges, usual.topo_move_timeout, usual.topo_world_timeout) == (4, 5, 60)
    assert parser.parse(["--topo-edges", "6"]).topo_edges == 6
    for option, texts in (
        ("--topo-edges", ("0", "-1", "1.5", "many", "")),
        ("--topo-move-timeout", ("0", "-1", "nan", "inf", "soon", "")),
        ("--topo-world-timeout", ("0",)),
    ):
        for text in texts:
            with pytest.raises(pytest.UsageError, match=f"{option}: expected .*, got '{text}'"):
                parser.parse([f"{option}={text}"])


@pytest.mark.long
def test_the_help_has_a_group_and_the_mark_is_known(session: Session) -> None:
    text = session("--help").stdout.str()
    group = text.partition("topo-verify (mappers with one robot and one marker):")[2]
    assert re.findall(r"--topo-[a-z-]+(?==)", group.partition("\n\n")[0]) == [
        *("--topo-target", "--topo-edges", "--topo-move-timeout", "--topo-world-timeout")
    ]
    session("--markers").stdout.fnmatch_lines("@pytest.mark.topo(target=*): one test a claim*")


# ---------------------------------------------------------------- fixtures


@pytest.mark.long
def test_the_fixtures_give_a_robot_and_a_report(session: Session) -> None:
    result = session(
        test="""
        import topo_verify as tv
        from hypothesis import given, settings

        settings.load_profile("topo")

        def test_robot(topo_robot) -> None:
            robot = topo_robot("m2/9")
            assert (robot.percept.degree, robot.move(3).marker) == (4, 0)
            assert robot.cost == 1
            assert topo_robot(tv.World.from_id("m1/0"), 1).percept.degree == 1

        def test_examine(topo_examine) -> None:
            assert topo_examine("basic", "nyc").world == "nyc"
            report = topo_examine("mappers:guesses", "m2/9")
            assert report.ok, str(report)

        @given(world=tv.strategies.worlds(max_edges=4))
        def test_property(topo_examine, world) -> None:
            assert topo_examine("basic", world).ok
        """
    )
    result.assert_outcomes(passed=2, failed=1)
    assert "again: topo-verify replay m2/9 --target mappers:guesses" in said(result)
    assert "topo-verify =" not in result.stdout.str()  # nothing to sum up


def test_the_fixtures_import_what_they_run_before_the_first_example(session: Session) -> None:
    """Hypothesis bounds the time of an example. Tests without them load nothing of ours."""
    result = session(
        test="""
        import sys
        from hypothesis import given, settings, strategies as st

        @settings(max_examples=1)
        @given(st.just(0))
        def test_other(_number):
            assert "topo_verify.campaign.judge" not in sys.modules

        @settings(max_examples=1)
        @given(st.just(0))
        def test_examine(topo_robot, topo_examine, _number):
            before = set(sys.modules)
            topo_robot("m1/0").move(0)
            topo_examine("basic", "m1/0")
            assert not [name for name in set(sys.modules) - before if "topo_verify" in name]
        """
    )
    result.assert_outcomes(passed=2)


# ---------------------------------------------------------------- Hypothesis's settings


@pytest.mark.parametrize(
    ("conftest", "profile", "deadline"),
    [
        ("", "default", "0:00:00.200000"),
        ("from hypothesis import settings\nsettings.load_profile('topo')", "topo", "None"),
    ],
)
def test_a_property_of_a_mapper_has_the_settings_that_its_user_loads(
    conftest: str,
    profile: str,
    deadline: str,
    session: Session,
    pytester: pytest.Pytester,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("CI", "GITHUB_ACTIONS", "GITLAB_CI"):  # where Hypothesis loads its profile `ci`
        monkeypatch.delenv(name, raising=False)
    pytester.makeconftest(conftest)
    result = session(
        test=f"""
        from hypothesis import given, settings, strategies as st
        import topo_verify

        @given(st.just(0))
        def test_example(_number):
            assert settings.get_current_profile_name() == "{profile}"

        def test_deadline():
            own = test_example._hypothesis_internal_use_settings
            assert str(own.deadline) == str(settings().deadline) == "{deadline}"
        """
    )
    result.assert_outcomes(passed=2)


# ---------------------------------------------------------------- tracebacks


@pytest.mark.nightly
def test_tracebacks_show_the_users_code_and_none_of_ours(session: Session) -> None:
    result = session(
        "--tb=short",
        test="""
        import topo_verify as tv
        from hypothesis import given, settings

        WORLD = tv.World.from_id("m2/4")

        def raises(robot):
            raise ValueError("boom")  # the mapper's line


        def test_claim() -> None:
            tv.assert_maps(lambda robot: 7, WORLD)  # line of claim

        def test_raises() -> None:
            tv.assert_maps(raises, WORLD)  # line of raises

        def test_door(topo_robot) -> None:
            topo_robot("m2/4").move(99)  # line of door

        @settings(max_examples=1, deadline=None)
        @given(tv.strategies.worlds(max_edges=5))
        def test_drawn(world) -> None:
            tv.assert_maps(raises, world)  # line of drawn

        def test_name() -> None:
            tv.explore(WORLD, "bassic")  # line of name

        def test_bounds() -> None:
            tv.strategies.worlds(max_edges=-1)  # line of bounds

        def test_world() -> None:
            tv.World.from_id("m2")  # line of world
        """,
    )
    result.assert_outcomes(failed=7)
    text = result.stdout.str()
    for test in ("claim", "raises", "door", "drawn", "name", "bounds", "world"):
        assert f"# line of {test}" in text
    assert "# the mapper's line" in text
    assert not re.findall(r"topo_verify/\S+\.py:\d+: ", text)


FAILING = """
import sys
import topo_verify as tv

def test_claim() -> None:
    tv.assert_maps(lambda robot: 7, "m2/4")

def test_modules() -> None:
    ours = [vars(module) for name, module in sys.modules.items() if name.startswith("topo_verify")]
    assert not any("__tracebackhide__" in names for names in ours)

def test_other() -> None:
    tv.World.from_rotations((1 // 0 for _ in "v"), [], marker=0)
"""


@pytest.mark.parametrize(("option", "is_whole"), [("--tb=short", False), ("--full-trace", True)])
def test_only_the_report_of_a_failed_test_leaves_frames_of_ours_out(
    option: str, is_whole: bool, session: Session
) -> None:
    """The modules stay as they are, and so does the traceback of an exception that is not ours."""
    result = session(option, test=FAILING)
    result.assert_outcomes(passed=1, failed=2)
    claim, other = re.split(r"(?m)^_+ test_other _+$", result.stdout.str())
    assert bool(re.findall(r"topo_verify/\S+\.py:\d+: ", claim)) is is_whole
    assert re.findall(r"topo_verify/\S+\.py:\d+: ", other)


@pytest.mark.long
def test_the_traceback_of_a_bug_of_ours_is_shown_whole(session: Session) -> None:
    result = session(
        "--tb=short",
        test="""
        import topo_verify as tv
        from topo_verify.campaign import judge

        def test_bug(monkeypatch) -> None:
            monkeypatch.setattr(judge, "check", None)
            tv.assert_maps("basic", tv.World.from_id("m2/4"))

        def test_contradiction(monkeypatch) -> None:
            def contradict(*_, **__):
                raise tv.InternalError("two parts differ")
            monkeypatch.setattr(judge, "check", contradict)
            tv.assert_maps("basic", tv.World.from_id("m2/4"))
        """,
    )
    result.assert_outcomes(failed=2)
    assert len(re.findall(r"campaign/judge\.py:\d+: in judge_trace", result.stdout.str())) == 2


# ---------------------------------------------------------------- beside others


def test_nothing_heavy_is_imported_until_a_mapper_is_tested(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text("def test_it() -> None: ...\n")
    heavy = ("z3", "hypothesis", "networkx", "numpy", "rich", "click")
    code = (
        "import sys, pytest\n"
        "pytest.main(['-q', '-p', 'no:hypothesispytest', '-p', 'no:cacheprovider'])\n"
        f"print('loaded', [name for name in {heavy!r} if name in sys.modules],\n"
        "      'topo_verify.campaign' in sys.modules, 'topo_verify.pytest_plugin' in sys.modules)"
    )
    done = python("-c", code, cwd=tmp_path)
    assert done.stdout.splitlines()[-1] == "loaded [] False True", done.stdout + done.stderr


@pytest.mark.long
def test_a_junit_file_has_the_worlds_and_the_line(
    session: Session, pytester: pytest.Pytester
) -> None:
    session("--junitxml=junit.xml", test=MARKED.format(target="mappers:guesses"))
    tree = ET.parse(pytester.path / "junit.xml")  # noqa: S314  written a moment ago
    (case,) = [c for c in tree.iter("testcase") if c.get("name") == "test_mine[map-isomorphic]"]
    facts = {p.get("name"): p.get("value") for p in case.iter("property")}
    assert facts == {
        "topo_target": "mappers:guesses",
        "topo_edges": "2",
        "topo_verdict": "REFUTED",
        "topo_checked": "12",
        "topo_total": "12",
        "topo_failing": "11",
        "topo_world": "m1/1",
        "topo_replay": "topo-verify replay m1/1 --target mappers:guesses",
    }
    assert case.find("failure") is not None


@pytest.mark.nightly
@pytest.mark.skipif(find_spec("xdist") is None, reason="pytest-xdist is not installed")
@pytest.mark.parametrize("how", ["load", "loadscope"])
def test_the_summary_is_the_same_with_several_processes(session: Session, how: str) -> None:
    test = MARKED.format(target="mappers:guesses")
    option = ("--topo-target", "basic", "--topo-edges", "3")
    result = session("-n", "2", "--dist", how, *option, test=test)
    result.assert_outcomes(passed=12, failed=3, skipped=5)
    summary = result.stdout.str().partition("= topo-verify =")[2].splitlines()[1:4]
    assert sorted(summary) == [
        "  again: topo-verify replay m1/1 --target mappers:guesses",
        "basic: 86 of 86 worlds of 1 to 3 edges, 0 counterexamples",
        "mappers:guesses: 12 of 12 worlds of 1 to 2 edges, 11 counterexamples, first m1/1",
    ]


@pytest.mark.skipif(find_spec("pytest_cov") is None, reason="pytest-cov is not installed")
def test_the_lines_of_the_mapper_are_covered_beside_pytest_cov(
    session: Session, pytester: pytest.Pytester
) -> None:
    pytester.makepyfile(
        mine="import mappers\n\n\ndef explore(robot):\n    return mappers.right(robot)\n"
    )
    result = session("--cov=mine", "--cov-report=term", test=MARKED.format(target="mine:explore"))
    result.assert_outcomes(passed=len(CLAIMS))
    result.stdout.re_match_lines(r"mine\.py +3 +0 +100%")


# ---------------------------------------------------------------- text of unknown origin


@pytest.mark.nightly
def test_no_text_of_a_mapper_or_its_file_controls_a_terminal(
    session: Session, pytester: pytest.Pytester
) -> None:
    (pytester.path / "a\x1b[31m.py").write_text(
        "def explore(robot):\n    raise ValueError('\\x1b[31m')\n"
    )
    target = "a\x1b[31m.py:explore"
    for arguments, test in [
        (("--topo-target", target), ""),
        (("--topo-target", f"{target}r"), ""),
        ((), MARKED.format(target=target.replace("\x1b", "\\x1b"))),
    ]:
        result = session("-v", "--color=no", *arguments, test=test)
        assert "failed" in (outcomes := result.parseoutcomes()) or "errors" in outcomes
        assert "a\\x1b[31m.py:explore" in said(result)
        assert "\x1b" not in result.stdout.str() + result.stderr.str()
