"""Mutation test of the trusted core: every small change of the checkers must turn a test red.

A **mutant** is a file with one small change (mutations.py). The tests of the checkers run on it
until one fails, or takes over twenty times its time (and five seconds) of the processor; else it
has **survived**. Tests that are fast or have killed before run first.

Why no library? mutmut 3.8 leaves decorated functions alone, so every property; cosmic-ray 8.7
starts pytest anew for each mutant and changes annotations. Neither tests its list of equivalent
mutants.

    .venv/bin/python benchmarks/mutants.py                       every mutant of the checkers
    .venv/bin/python benchmarks/mutants.py --only entailment.py  those of one file
    .venv/bin/python benchmarks/mutants.py --list                only list them

Exit code 1 if a mutant survives that is not in `SAME`, or one of `SAME` is killed.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections import Counter
from collections.abc import Generator, Iterator, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from resource import RLIMIT_AS, setrlimit
from signal import ITIMER_VIRTUAL, SIGVTALRM, setitimer
from time import monotonic, process_time

os.environ |= {"HYPOTHESIS_NO_PLUGINS": "1", "HYPOTHESIS_PROFILE": "mutants"}

import hypothesis.strategies  # noqa: F401  only so that it is there
import pytest
from hypothesis import HealthCheck, Phase, settings
from mutations import Mutant, Planted, chosen, in_forks, mutants, report

ROOT = Path(__file__).resolve().parent.parent
MUTATED = ROOT / "topo_verify" / "checkers"
PACKAGE = "topo_verify.checkers"
OPTIONS = ("-x", "-q", "--tb=no", "--assert=plain", "-p", "no:cacheprovider")
TESTS = ("tests/checkers", "tests/studies/test_gap.py")

settings.register_profile(
    "mutants",  # the examples of profile ci; but who has failed is not asked for a smaller one
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    phases=(Phase.explicit, Phase.generate),
    report_multiple_bugs=False,
)

SECONDS = 30
"""Of the processor, until the first test begins."""

MEMORY = 4 << 30
"""Bytes; a mutant that asks for more gets a MemoryError, and a test fails."""

ENDLESS = "nobody, it comes to no end"

BY_SIZE = "whichever of two vertices stands for both, the classes are the same; sizes save time"
AT_A_ROOT = "the offset of a node is read only while it has a parent, and is set when it gets one"
BOTH_TWO = "both are pairs"
ONLY_QUICKER = "a later step gives the same result without this shortcut, more slowly"
ONLY_ROOM = "it changes how much memory a node takes, and no answer"
BELOW_0 = "every number below 0 says that there is no other end"
NO_TRY_LEFT = "where no try is left for a pair, none is left for the pairs behind it"
NO_OTHER_ORDER = "one event is not both an augmentation and a rejection"
BOTH_FALSE = "None is false, too"
AS_MANY = "both have as many"
FOR_GOOD = "once no world shows the history, none does"
FOLDED_LATER = "what looks different contradicts when it is folded"
NOT_POSED = "before the first pose no word is asked for"
SAME_PLACE = "a new place is identified with the known one"
UNCHANGED = "no line changes it"
TWO_ENDS = "no edge joins a dart to itself"
CODE_TELLS = "the canonical code says the same, and takes longer"
PLACEHOLDER = "the next round puts another number there"

SAME = {
    "claims.py _unmet: True -> False": BOTH_TWO,
    "entailment.py decision_conclusions: refuted.add((event.edge, event.hypothesis)) -> pass": (
        ONLY_QUICKER
    ),
    "entailment.py decision_conclusions: break -> continue": FOR_GOOD,
    "entailment.py _may_lead_to: is_other or end not in face or any(fold.contradictions(*places,"
    " apart)) -> end not in face or any(fold.contradictions(*places, apart))": FOLDED_LATER,
    "entailment.py decision_conclusions: type(event) is Move or not isinstance(event, CONCLUDED)"
    " -> not isinstance(event, CONCLUDED)": ONLY_QUICKER,
    "entailment.py map_conclusion: code or delivered_code(finish.map) ->"
    " delivered_code(finish.map)": ONLY_QUICKER,
    "folding.py Fold.are_apart: return i != j if a == b else not"
    " self._seen[a].is_like(self._seen[b]) -> return None": FOLDED_LATER,
    "entailment.py _planar_folding: break -> continue": NO_TRY_LEFT,
    "excursions.py Excursion.__init__: False -> True": NOT_POSED,
    "excursions.py Records.behind: since < when -> since <= when": NO_OTHER_ORDER,
    "folding.py : 64 -> 65": ONLY_ROOM,
    "folding.py Ends.add: degree > NARROW -> degree >= NARROW": ONLY_ROOM,
    "folding.py Ends.add: 0 -> 1": ONLY_ROOM,
    "folding.py Ends.add: 1 -> 2": BELOW_0,
    "entailment.py _doubt:  for h in on_fold.others(e) if (e, h) not in refuted"
    " ->  for h in on_fold.others(e)": ONLY_QUICKER,
    "folding.py Fold._visit: 0 -> 1": AT_A_ROOT,
    "folding.py Fold._visit: 1 -> 2": BY_SIZE,
    "folding.py Fold._merged: if self._size[a] > self._size[b]: -> if not self._size[a] >"
    " self._size[b]:": BY_SIZE,
    "folding.py Fold._merged: self._size[a] > self._size[b] -> self._size[a] >="
    " self._size[b]": BY_SIZE,
    "folding.py Fold._merged: self._size[b] += self._size[a] -> pass": BY_SIZE,
    "folding.py Fold.move: at_v0 or known or (self._visit(percept), 0) -> at_v0 or"
    " (self._visit(percept), 0)": SAME_PLACE,
    "map_in_world.py MapInWorld.is_world: edge[0] < edge[1] -> edge[0] <= edge[1]": TWO_ENDS,
    "map_in_world.py MapInWorld.is_world: 0 -> 1": CODE_TELLS,
    "map_in_world.py MapInWorld.is_world:  for edge in sorted(self.alpha.items()) if edge[0] <"
    " edge[1] ->  for edge in sorted(self.alpha.items())": CODE_TELLS,
    "map_in_world.py MapInWorld.is_world: return is_whole and delivered =="
    " MapData(tuple(self.vertices), edges, 0) -> return None": CODE_TELLS,
    "folding.py Fold.table: True -> False": AS_MANY,
    "folding.py Fold.table: 1 -> 2 (2)": BELOW_0,
    "folding.py Fold.table: -1 -> 1 (2)": PLACEHOLDER,
    "folding.py Fold.table: 1 -> 2 (5)": PLACEHOLDER,
    "map_in_world.py MapInWorld._add_vertex: True -> False": AS_MANY,
    "map_in_world.py MapInWorld._add_vertex: True -> False (2)": AS_MANY,
    "map_in_world.py MapInWorld.grow: return False -> return None": BOTH_FALSE,
    "map_in_world.py MapInWorld.grow: return False -> return None (2)": BOTH_FALSE,
    "replayed_trace.py Round: True -> False": UNCHANGED,
}
"""Equivalent mutants by their text, with the reason."""


# ---------------------------------------------------------------- who survives


@dataclass(slots=True)
class Tests:
    """Processor seconds of each test, and mutants killed; run in the order of seconds a kill."""

    seconds: dict[str, float] = field(default_factory=dict[str, float])
    kills: Counter[str] = field(default_factory=Counter[str])

    def cost(self, test: str) -> float:
        return max(self.seconds.get(test, 0.0), 0.001) / (self.kills[test] + 0.1)

    def limit(self, test: str) -> float:
        """Seconds after which it counts as endless; no limit the first time."""
        return 5 + 20 * self.seconds[test] if test in self.seconds else 0.0


class Watch:
    """Pytest plugin: orders the tests, stops endless ones, records results."""

    def __init__(self, tests: Tests) -> None:
        self.tests, self.failed = tests, ""
        self.seconds: dict[str, float] = {}

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        items.sort(key=lambda item: self.tests.cost(item.nodeid))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        setitimer(ITIMER_VIRTUAL, self.tests.limit(item.nodeid))
        begin = process_time()
        done = yield
        self.seconds[item.nodeid] = process_time() - begin
        return done

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed = self.failed or report.nodeid


Outcome = tuple[int, str, dict[str, float]]
"""Pytest's exit code, the test that failed, and seconds by test."""


def run_tests(tests: Tests, mutant: Mutant | None, pipe: Connection) -> None:
    setrlimit(RLIMIT_AS, (MEMORY, MEMORY))
    setitimer(ITIMER_VIRTUAL, SECONDS)
    watch = Watch(tests)
    if mutant is not None:
        Planted(mutant, PACKAGE, MUTATED)
    try:
        for path in sorted(MUTATED.glob("[!_]*.py")):  # the package does not import every one
            importlib.import_module(f"{PACKAGE}.{path.stem}")
    except Exception:  # noqa: BLE001  whatever a mutant raises
        pipe.send((pytest.ExitCode.TESTS_FAILED, "the import", {}))
        return
    if mutant is not None:
        module = sys.modules[f"{PACKAGE}.{Path(mutant.file).stem}"]
        assert isinstance(module.__loader__, Planted), "the mutant was not imported"
    with Path(os.devnull).open("w") as sink, redirect_stdout(sink), redirect_stderr(sink):
        code = pytest.main([*OPTIONS, *TESTS], [watch])
    pipe.send((int(code), watch.failed, watch.seconds))


Judged = tuple[Mutant | None, str, dict[str, float]]
"""A mutant, the test that killed it or "", and the seconds of the tests."""


def outcomes(wanted: Sequence[Mutant | None], tests: Tests, workers: int) -> Iterator[Judged]:
    for mutant, sent, exitcode in in_forks(wanted, partial(run_tests, tests), workers):
        if sent is None and exitcode != -SIGVTALRM:
            raise SystemExit(f"a test run ended with exit code {exitcode}")
        code, failed, seconds = sent or (pytest.ExitCode.TESTS_FAILED, ENDLESS, {})
        if code == pytest.ExitCode.OK:
            yield mutant, "", seconds
        elif code in (pytest.ExitCode.TESTS_FAILED, pytest.ExitCode.INTERRUPTED):
            # `-x` ends the collection with either code.
            yield mutant, failed or "the collection of the tests", seconds
        else:
            raise SystemExit(f"pytest ended with exit code {code}")


def judged(wanted: Sequence[Mutant], workers: int) -> Iterator[tuple[Mutant, str]]:
    """Each mutant, and the test that killed it or ""; a run without a mutant gives the times."""
    tests = Tests()
    ((_, killer, tests.seconds),) = outcomes([None], tests, 1)
    if killer:
        raise SystemExit(f"on the source as it is: killed by {killer}")
    begin = monotonic()
    for done, (mutant, killer, _) in enumerate(outcomes(wanted, tests, workers), 1):
        assert mutant is not None
        tests.kills[killer] += 1
        yield mutant, killer
        if done % 20 == 0:
            took = monotonic() - begin
            print(f"{done} of {len(wanted)}, {took:.0f} s", file=sys.stderr, flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--only", default="", help="mutants whose file or text has this in it")
    parser.add_argument("--list", action="store_true", help="list them, and do no more")
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    everyone = [mutant for path in sorted(MUTATED.glob("*.py")) for mutant in mutants(path)]
    wanted = chosen(everyone, options, SAME)
    os.chdir(ROOT)
    sys.path.insert(0, str(ROOT))
    for name in ("algorithms", "robot.simulator", "world"):
        importlib.import_module(f"topo_verify.{name}")
    assert not any(name.startswith("topo_verify.checkers") for name in sys.modules)
    return report(judged(wanted, options.workers), SAME)


if __name__ == "__main__":
    sys.exit(main())
