"""The pytest plugin: a mapper becomes tests, one for each claim.

    @pytest.mark.topo(target="my_mapper:explore")     each claim is a test of this function's
    def test_my_mapper() -> None: ...

    pytest --topo-target my_mapper.py:explore         the same without a file of tests

The first test of a mapper runs it once in every world of 1 to N edges (`--topo-edges`). A test
passes if its claim holds in every world. It fails, with the first such world and its replay
command, if the claim fails or is undecided. It is skipped if in some world the mapper declared
no decision that the claim is about.

The results travel in the `user_properties` of the test reports, for JUnit files and
pytest-xdist. Pytest loads this file in every session, so it imports no room before there is a
mapper to test.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, field
from types import TracebackType
from typing import TYPE_CHECKING, Any

import pytest

from topo_verify.errors import InputError, InternalError, TopoVerifyError, shown

if TYPE_CHECKING:
    from topo_verify.campaign.judge import Report
    from topo_verify.programs.loader import Mapper, Target
    from topo_verify.robot.simulator import SimulatedRobot
    from topo_verify.studies.verify.by_claim import ClaimResults
    from topo_verify.world.rooted_map import World

EDGES = 4  # 792 worlds, about a second
_CASE = "_topo_case"


@dataclass(frozen=True, slots=True)
class ClaimTest:
    """The question of one test: does the claim hold in every world of 1 to `edges` edges?"""

    target: Target
    edges: int
    claim: str


@dataclass
class _Cache:
    """What one session has loaded and run."""

    targets: dict[str, tuple[Target, ...]] = field(default_factory=dict[str, Any])
    results: dict[tuple[int, int], ClaimResults] = field(default_factory=dict[Any, Any])
    """By the mapper's `id`, stable while the tests hold the mapper, and by edges."""


_CACHE = pytest.StashKey[_Cache]()


# ---------------------------------------------------------------- options


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of the plugin to those of pytest."""
    group = parser.getgroup("topo-verify", "topo-verify (mappers with one robot and one marker)")
    group.addoption(
        "--topo-target",
        metavar="TARGET",
        help="Test this mapper: package.module:attribute, path/file.py:attribute, '--cmd program"
        " args' or the name of an algorithm. Also the target of marks without one.",
    )
    group.addoption(
        "--topo-edges",
        metavar="N",
        type=_parse_edges,
        default=EDGES,
        help=f"Run the mapper in every world of 1 to N edges.  [default: {EDGES}]",
    )
    for name, extent, seconds in (("move", "between two moves", 5), ("world", "in a world", 60)):
        group.addoption(
            f"--topo-{name}-timeout",
            metavar="SECONDS",
            type=_parse_seconds,
            default=float(seconds),
            help=f"The most time of a mapper {extent}.  [default: {seconds}]",
        )


def _parse_edges(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"expected a number of edges, 1 or more, got {text!r}")
    return int(text)


def _parse_seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 0 < seconds <= 10**6:
        raise argparse.ArgumentTypeError(f"expected seconds in (0, 1000000], got {text!r}")
    return seconds


def pytest_configure(config: pytest.Config) -> None:
    """Refuse options given twice, and register the mark."""
    _require_once(config)
    config.stash[_CACHE] = _Cache()
    config.addinivalue_line(
        "markers",
        "topo(target=--topo-target, edges=--topo-edges): one test a claim of the mapper `target`"
        " (a text as for --topo-target, or the callable) in every world of 1 to `edges` edges;"
        " then the body runs.",
    )


def _require_once(config: pytest.Config) -> None:
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for name in ("target", "edges", "move-timeout", "world-timeout"):
        parser.add_argument(f"--topo-{name}", dest=f"--topo-{name}", action="append", default=[])
    options, _ = parser.parse_known_args(list(map(str, config.invocation_params.args)))
    for name, values in vars(options).items():
        if len(values) > 1:
            got = " and ".join(repr(shown(value)) for value in values)
            raise pytest.UsageError(f"expected {name} at most once, got {got}: leave one out")


# ---------------------------------------------------------------- collecting


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make one test for each claim from a marked function."""
    mark = metafunc.definition.get_closest_marker("topo")
    if mark is not None:
        try:
            cases = _read_mark(metafunc.config, mark)
        except pytest.Collector.CollectError as error:
            raise pytest.Collector.CollectError(f"{metafunc.definition.nodeid}: {error}") from error
        several = len({case.target.text for case in cases}) > 1
        names = [f"{case.target.text}-{case.claim}" if several else case.claim for case in cases]
        metafunc.fixturenames.append(_CASE)
        metafunc.parametrize(_CASE, cases, ids=names)


def _read_mark(config: pytest.Config, mark: pytest.Mark) -> list[ClaimTest]:
    """The tests that a mark asks for; CollectError if it is wrong."""
    others = dict(mark.kwargs)
    target = others.pop("target", config.option.topo_target)
    edges = others.pop("edges", config.option.topo_edges)
    usage = '@pytest.mark.topo(target="package.module:attribute", edges=4)'
    if mark.args or others:
        unknown = [*map(repr, mark.args)] + [f"{name}=…" for name in others]
        raise pytest.Collector.CollectError(
            f"the mark topo does not take {', '.join(unknown)}: write {usage}"
        )
    if target is None:
        raise pytest.Collector.CollectError(
            f"the mark topo names no mapper: write {usage}, or call pytest with --topo-target"
        )
    if not isinstance(edges, int) or isinstance(edges, bool) or edges < 1:
        raise pytest.Collector.CollectError(
            f"the mark topo: expected a number of edges, 1 or more, got edges={edges!r}"
        )
    return _list_tests(config, target, edges)


def _list_tests(config: pytest.Config, target: str | Mapper, edges: int) -> list[ClaimTest]:
    """One test for each mapper and claim; CollectError if that is impossible."""
    from topo_verify.campaign.targets import one_target, targets
    from topo_verify.checkers import CLAIMS
    from topo_verify.studies.corpus import MOST_ENUMERATED

    if edges > MOST_ENUMERATED:
        raise pytest.Collector.CollectError(
            f"expected at most {MOST_ENUMERATED} edges, got {edges}: there are too many worlds"
        )
    loaded = config.stash[_CACHE].targets
    try:
        if not isinstance(target, str):
            mappers: tuple[Target, ...] = (one_target(target),)
        elif target in loaded:
            mappers = loaded[target]
        else:
            mappers = loaded[target] = targets(target)
    except InputError as error:
        raise pytest.Collector.CollectError(str(error)) from error
    return [ClaimTest(mapper, edges, claim) for mapper in mappers for claim in CLAIMS]


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Let the session collect the tests of --topo-target, besides those of files."""
    report = yield
    text = collector.config.option.topo_target
    if isinstance(collector, pytest.Session) and text is not None:
        name = shown(text)
        mappers = MapperCollector.from_parent(collector, name=name, nodeid=name)  # pyright: ignore[reportUnknownMemberType]  untyped
        report.result.append(mappers)
    return report


class MapperCollector(pytest.Collector):
    """The tests of --topo-target, named by the option's text."""

    def collect(self) -> Iterator[ClaimItem]:
        """One test for each mapper and claim."""
        options = self.config.option
        cases = _list_tests(self.config, options.topo_target, options.topo_edges)
        several = len({case.target.text for case in cases}) > 1
        for case in cases:
            name = f"{shown(case.target.text)}::{case.claim}" if several else case.claim
            yield ClaimItem.from_parent(self, name=name, case=case)  # pyright: ignore[reportUnknownMemberType]  untyped


class ClaimItem(pytest.Item):
    """A test of one claim of one mapper, made from no function."""

    def __init__(self, *, case: ClaimTest, **kwargs: Any) -> None:
        super().__init__(**kwargs)  # pyright: ignore[reportUnknownMemberType]  untyped
        self.case = case
        self.add_marker(pytest.mark.topo)

    def runtest(self) -> None:
        """Pass, fail or skip by the claim's verdict."""
        _judge(self, self.case)

    def reportinfo(self) -> tuple[Any, int | None, str]:
        """A node id in place of a line in a file."""
        return self.path, None, self.nodeid


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Refuse a mark on a test that was not parametrized."""
    for item in items:
        if item.get_closest_marker("topo") and _find_case(item) is None:
            raise pytest.UsageError(
                f"{item.nodeid}: the mark topo is for functions and for methods of plain classes,"
                " not for those of unittest.TestCase: move it"
            )


def _find_case(item: pytest.Item) -> ClaimTest | None:
    if isinstance(item, ClaimItem):
        return item.case
    callspec = getattr(item, "callspec", None)
    return None if callspec is None else callspec.params.get(_CASE)


# ---------------------------------------------------------------- running


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Generator[None, object, object]:
    """Judge the claim of a marked function, then run its body."""
    case = _find_case(pyfuncitem)
    if case is not None:
        _judge(pyfuncitem, case)
    return (yield)


def _judge(item: pytest.Item, case: ClaimTest) -> None:
    from topo_verify.robot.limits import Limits
    from topo_verify.studies.verify.by_claim import by_claim

    cached = item.config.stash[_CACHE].results
    key = (id(case.target.mapper), case.edges)
    if key not in cached:
        options: argparse.Namespace = item.config.option
        limits = Limits(None, options.topo_move_timeout, options.topo_world_timeout)
        cached[key] = by_claim(case.target, case.edges, limits)
    results = cached[key]
    item.user_properties += results.properties(case.target.text)
    match results.verdict(case.claim):
        case "fails" | "undecided":
            pytest.fail(results.text(case.claim), pytrace=False)
        case "not-declared":
            pytest.skip(results.text(case.claim))
        case "holds":
            pass


# ---------------------------------------------------------------- what is reported


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> None:
    """Report an exception of ours with the user's frames alone; --full-trace shows all."""
    error = call.excinfo
    if error is None or item.config.getoption("fulltrace", default=False):
        return
    users = _copy_without_ours(error.tb) if _is_deliberate(error.value) else None
    if users is not None:
        shorter = (error.type, error.value, users)
        call.excinfo = pytest.ExceptionInfo[BaseException].from_exc_info(shorter)


def _is_deliberate(error: BaseException) -> bool:
    """Whether we raise it on purpose, so that its message says all; a bug of ours is not."""
    from topo_verify.robot.limits import MapperStopped

    ours = isinstance(error, TopoVerifyError | MapperStopped)
    return ours and not isinstance(error, InternalError)


def _copy_without_ours(traceback: TracebackType | None) -> TracebackType | None:
    entries: list[TracebackType] = []
    while traceback is not None:
        if not str(traceback.tb_frame.f_globals.get("__name__")).startswith("topo_verify."):
            entries.append(traceback)
        traceback = traceback.tb_next
    copy = None
    for entry in reversed(entries):
        copy = TracebackType(copy, entry.tb_frame, entry.tb_lasti, entry.tb_lineno)
    return copy


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Write a line for each mapper: the worlds tried, and the counterexamples."""
    by_mapper: dict[tuple[object, ...], dict[str, Any]] = {}
    for report in itertools.chain(*terminalreporter.stats.values()):
        facts: dict[str, Any] = dict(getattr(report, "user_properties", ()))
        if "topo_target" in facts:
            by_mapper.setdefault((facts["topo_target"], facts["topo_edges"]), facts)
    if by_mapper:
        terminalreporter.write_sep("=", "topo-verify")
    for facts in by_mapper.values():
        from topo_verify.studies.verify.by_claim import summary

        for line in summary(facts):
            terminalreporter.write_line(line)


# ---------------------------------------------------------------- fixtures
# Session scope: Hypothesis refuses function scope. They import what they run before the first
# example of a property test, which has a deadline.


@pytest.fixture(scope="session")
def topo_robot() -> Callable[..., SimulatedRobot]:
    """`topo_robot(world, budget=None)`: a robot at the marker of a world.

    The world is a `World` or a command-line argument ("m5/17", "nyc"); the default budget, in
    moves, is the bound of claim 7. The robot has `percept`, `move`, `declare`, `cost` and `events`.
    """
    from topo_verify.robot.simulator import SimulatedRobot
    from topo_verify.world.resolve import resolve_world

    def place_robot(world: World | str, budget: int | None = None) -> SimulatedRobot:
        resolved = resolve_world(world) if isinstance(world, str) else world
        return SimulatedRobot(resolved, resolved.cost_bound if budget is None else budget)

    return place_robot


@pytest.fixture(scope="session")
def topo_examine() -> Callable[..., Report]:
    """`topo_examine(mapper, world)`: the report on a run, judged by every claim.

    The world is a `World` or a command-line argument. A report has `ok`, `undecided`, `cost`,
    `claims`, `findings`; its text lists violations and the replay command: `assert report.ok and
    not report.undecided, str(report)`.
    """
    from topo_verify.campaign.judge import examine

    def examine_named(mapper: Mapper | str, world: World | str, **options: Any) -> Report:
        if isinstance(world, str):
            options.setdefault("where", world)
        return examine(mapper, world, **options)

    return examine_named
