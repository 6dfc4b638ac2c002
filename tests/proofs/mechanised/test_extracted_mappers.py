"""The mapper that is proved and the mapper that runs leave the same trace.

Coq extracts the mapper of coq/Mapper.v, told with its decisions as in coq/Declared.v, with the
rules, motions and policies of its algorithms, as a program in OCaml. It is a second implementation
of docs/semantics.md, sections 2 to 8. Compared are all events, in their order: doors and percepts,
hypotheses, rejections (by motion, with the step, or by the rule), confirmations, augmentations, and
the delivered map.

Of random policies it is told what Python's generator chose: it is proved for any choices. The
`folding` in Coq folds its whole log anew after each mismatch, by another program than Python's.

What this does not show: that the evidence of a rejection by rule is right, and the purposes of
moves, which Coq's mapper does not declare (claim 8 checks the former in each run); anything about
`planar`, which is not written in Coq.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any, ClassVar, NamedTuple

import pytest

from tests.helpers import PAPER, trace_of, worlds
from tests.proofs.mechanised.conftest import LIMIT, RARE, extracted
from tests.proofs.mechanised.written import written
from topo_verify import CATALOGUE, World
from topo_verify.algorithms import policies as choices
from topo_verify.algorithms.beyond.folding import FoldingRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Choice, Executed, Hypothesis, overlap, retrace
from topo_verify.algorithms.rules import PrefixRule, RecordsRule
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.events import MapDart
from topo_verify.world.resolve import resolve_world

PROVED = (*PAPER, "folding")
"""The algorithms that are written in Coq."""

OFTEN = ("basic", "enhancement-iii-all+i")
"""Those that `make coq` runs in every world to 5 edges: without a rule, and with every one."""

FAMILIES = (
    "family:lattice(3,4)", "family:lattice(4,4,holes=0.2,seed=7)", "family:torus(2,3)",
    "family:wheel(5)", "family:random_tree(8,seed=1)", "family:random_genus(9,2,seed=3)",
)  # fmt: skip
"""Worlds of some size that differ in kind."""

TELLING = "family:lattice(6,6)"
"""A world in which no two of the algorithms and policies take the same doors."""

TELLING_GENUS = ("family:random_genus(14,2,seed=13)", "family:random_genus(10,1,seed=28)")
"""Worlds in which records with a fault lead through other doors."""

LARGER = (
    "nyc", "family:lattice(8,8,holes=0.2,seed=7)", "family:torus(4,4)",
    "family:triangular_torus(3,3)", "family:hexagonal_torus(3,3)", "family:dense(9,0.5,seed=1)",
    "family:king(4,4)", "family:random_genus(20,3,seed=5)",
)  # fmt: skip
"""Worlds with hundreds or thousands of moves; nyc is the street network."""

LONG = ("family:regular(30,4,seed=0)", "family:lattice(2,20)", "family:torus(2,14)")
"""Over 800 moves by each algorithm, and over 1,900 in the first; distances up to 20."""

LONG_FOLDED = ("family:lattice(2,16)",)
"""For `folding`, which takes minutes in Coq in the others: over 700 moves, distances up to 16."""


class Job(NamedTuple):
    """A run: the algorithm, its policies with their choices, the world."""

    algorithm: str
    world: World
    pick: str = "nearest"
    order: str = "shortest"


@pytest.fixture(scope="module")
def mappers(library: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The extracted program."""
    return extracted(library, tmp_path_factory.mktemp("mappers"), "Mappers", "main")


def told(job: Job) -> str:
    """A job as the program reads it. The canonical numbering makes dart 0 the root."""
    world = World.from_code(job.world.code)
    rows = (f"{len(row)} {' '.join(map(str, row))}" for row in (world.sigma, world.alpha))
    return f"{job.algorithm} {job.pick} {job.order} {' '.join(rows)}"


def traces_in_coq(mappers: Path, jobs: Sequence[Job]) -> list[str]:
    """The trace of the proved mapper in each job, on one line."""
    lines = [str(len(jobs)), *map(told, jobs)]
    ran = toolchain.run([str(mappers)], mappers.parent, timeout=LIMIT, stdin="\n".join(lines))
    assert ran.accepted, ran.output
    return ran.output.splitlines()


def trace_here(job: Job) -> str:
    """The trace of the mapper of the catalogue, written as the program writes it."""
    algorithm = CATALOGUE[job.algorithm].with_policies(pick=job.pick, order=job.order)
    return written(trace_of(job.world, algorithm))


def differing(mappers: Path, jobs: Iterable[Job]) -> list[Job]:
    """The jobs in which the two leave different traces."""
    todo = list(jobs)
    pairs = zip(todo, traces_in_coq(mappers, todo), strict=True)
    return [job for job, trace in pairs if trace != trace_here(job)]


@pytest.mark.parametrize("name", PROVED)
def test_both_leave_the_same_trace_in_small_worlds(mappers: Path, name: str) -> None:
    small = [*worlds(range(4)), *map(resolve_world, (*FAMILIES, *TELLING_GENUS, TELLING))]
    assert differing(mappers, (Job(name, world) for world in small)) == []


@pytest.mark.parametrize(
    "name",
    [name if name in OFTEN else pytest.param(name, marks=RARE) for name in PROVED],
)
def test_both_leave_the_same_trace_in_every_world_to_5_edges(mappers: Path, name: str) -> None:
    every = [Job(name, world) for world in worlds(range(6))]
    assert len(every) == 8_955
    assert differing(mappers, every) == []


@pytest.mark.parametrize("name", PROVED)
def test_both_leave_the_same_trace_in_large_worlds(mappers: Path, name: str) -> None:
    assert differing(mappers, (Job(name, resolve_world(world)) for world in LARGER)) == []


@pytest.mark.parametrize("name", PROVED)
def test_both_leave_the_same_trace_in_long_worlds(mappers: Path, name: str) -> None:
    long = LONG_FOLDED if name == "folding" else LONG
    assert differing(mappers, (Job(name, resolve_world(world)) for world in long)) == []


@pytest.mark.parametrize("pick", ["nearest", "first", "last"])
@pytest.mark.parametrize("order", ["shortest", "oldest", "newest"])
def test_both_leave_the_same_trace_with_every_policy(mappers: Path, pick: str, order: str) -> None:
    some = [*worlds(range(4)), *map(resolve_world, (*FAMILIES[:3], *TELLING_GENUS))]
    jobs = (Job(name, world, pick, order) for name in PROVED for world in some)
    assert differing(mappers, jobs) == []


class Recorded(Random):
    """A generator that keeps its choices, edge by edge: places in what it chose from."""

    picks: ClassVar[list[int]] = []
    deals: ClassVar[list[list[int]]] = []
    """For each pick those that shuffled the hypotheses; none where there was no hypothesis."""

    def choice(self, seq: Any) -> Any:
        """An element, as always."""
        taken = super().choice(seq)
        self.picks.append(seq.index(taken))
        self.deals.append([])
        return taken

    def shuffle(self, x: Any) -> None:
        """Shuffles, as always."""
        left = list(x)
        super().shuffle(x)
        for one in x:
            self.deals[-1].append(left.index(one))
            left.remove(one)


def told_choices(world: World, name: str, seed: int) -> tuple[Job, str]:
    """A run with random policies, told with the choices that were made, and its trace."""
    Recorded.picks.clear()
    Recorded.deals.clear()
    trace = trace_here(Job(name, world, f"random({seed})", f"random({seed})"))
    deals = (f"{len(deal)} {' '.join(map(str, deal))}" for deal in Recorded.deals)
    pick = f"random {len(Recorded.picks)} {' '.join(map(str, Recorded.picks))}"
    order = f"random {len(Recorded.deals)} {' '.join(deals)}"
    return Job(name, world, pick, order), trace


@pytest.mark.parametrize("name", PROVED)
def test_both_leave_the_same_trace_with_what_the_generator_chose(
    mappers: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(choices, "Random", Recorded)
    some = [*worlds(range(4)), *map(resolve_world, FAMILIES)]
    runs = [told_choices(world, name, seed) for seed in range(2) for world in some]
    assert traces_in_coq(mappers, [job for job, _ in runs]) == [trace for _, trace in runs]
    (job, one), (_, other) = (told_choices(resolve_world(TELLING), name, s) for s in range(2))
    assert traces_in_coq(mappers, [job]) == [one] != [other]


def test_other_algorithms_and_policies_leave_other_traces(mappers: Path) -> None:
    world = resolve_world(TELLING)
    jobs = [Job(name, world) for name in PROVED]
    jobs += [Job("basic", world, pick=pick) for pick in ("first", "last")]
    jobs += [Job("basic", world, order=order) for order in ("oldest", "newest")]
    assert len(set(traces_in_coq(mappers, jobs))) == len(jobs)


class Oblivious(RecordsRule):
    """A rule with a fault: it writes no record."""

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Does nothing, where it ought to record."""


class Directionless(RecordsRule):
    """A rule with a fault: its records lose the marker's direction."""

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        """The first recorded percept whose signature the sequence contradicts, if any."""
        refuted = super().beyond(exit_dart, sequence, step, number)
        expected, observed = (
            (None, None)
            if refuted is None
            else (refuted.evidence.expected, refuted.evidence.observed)
        )
        same = expected and observed and expected.signature == observed.signature
        return None if same else refuted


class Forgetful(RecordsRule):
    """A rule with a fault: a later record replaces an earlier one."""

    def _record(self, exit_dart: MapDart, sequence: Executed, step: int) -> None:
        self.records.pop(exit_dart, None)
        super()._record(exit_dart, sequence, step)


class Unrefuting(PrefixRule):
    """A rule with a fault: it refutes nothing."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """None, where it ought to refute."""
        del chart, hypothesis, sequences
        return None


class Hasty(FoldingRule):
    """A rule with a fault: it concludes the last hypothesis, though vu may be new."""

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The last hypothesis, whatever else is possible."""
        return remaining[0] if len(remaining) == 1 else None


class Patient(FoldingRule):
    """A rule with a fault: it concludes nothing, and walks what it could know."""

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """None, where it ought to conclude."""
        del remaining
        return None


def last_of_ties(hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
    """A motion with a fault: of those that tie it takes the last."""
    return overlap(hypotheses[::-1], last)


def highest_of_ties(chart: Chart, at: int) -> int:
    """A pick policy with a fault: of the darts at the nearest vertex it takes the highest."""
    dart = choices.nearest(chart, at)
    return max(d for d in chart.darts(chart.vertex[dart]) if d in chart.unexplored)


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("enhancement-i", {"rule": Unrefuting}),
        ("enhancement-iii-all", {"rule": Oblivious}),
        ("enhancement-iii-all+i", {"rule": Directionless}),
        ("enhancement-iii-all", {"rule": Forgetful}),
        ("enhancement-ii+i", {"motion": last_of_ties}),
        ("enhancement-ii+i", {"motion": retrace}),
        ("folding", {"rule": Hasty}),
        ("folding", {"rule": Patient}),
        ("folding", {"motion": retrace}),
    ],
)
def test_a_fault_in_a_rule_or_a_motion_is_seen(
    mappers: Path, monkeypatch: pytest.MonkeyPatch, name: str, fault: dict[str, Any]
) -> None:
    monkeypatch.setitem(CATALOGUE, name, replace(CATALOGUE[name], **fault))
    told_apart = (TELLING, *TELLING_GENUS, *LONG[:1]) if name != "folding" else (TELLING,)
    assert differing(mappers, (Job(name, resolve_world(world)) for world in told_apart))


def test_a_fault_in_a_policy_is_seen(mappers: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(choices.PICKS, "nearest", highest_of_ties)
    assert differing(mappers, (Job("basic", world) for world in worlds([3])))
