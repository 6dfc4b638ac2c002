"""The mapper that is proved and the mapper that runs take the same doors.

Coq extracts the mapper of coq/Mapper.v, with the rules, motions and policies of its algorithms, as
a program in OCaml. It is a second implementation of docs/semantics.md, sections 2 to 7, and what is
proved of it is proved of the doors that are compared here.

Of random policies it is told what Python's generator chose: it is proved for any choices. The
`folding` in Coq folds its whole log anew after each mismatch, by another program than Python's.

What this does not show: that the two declare the same decisions; anything about `planar`, which is
not written in Coq.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any, ClassVar, NamedTuple

import pytest

from tests.helpers import PAPER, doors, trace_of, worlds
from tests.proofs.mechanised.conftest import LIMIT, extracted
from topo_verify import CATALOGUE, World
from topo_verify.algorithms import policies as choices
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.enhancement_iii import RecordsRule
from topo_verify.algorithms.folding import FoldingRule
from topo_verify.algorithms.motion import Choice, Executed, Hypothesis, overlap, retrace
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.events import MapDart
from topo_verify.world.resolve import resolve_world

PROVED = (*PAPER, "folding")
"""The algorithms that are written in Coq."""

FAMILIES = (
    "family:lattice(3,4)", "family:lattice(4,4,holes=0.2,seed=7)", "family:torus(2,3)",
    "family:wheel(5)", "family:random_tree(8,seed=1)", "family:random_genus(9,2,seed=3)",
)  # fmt: skip
"""Worlds of some size that differ in kind."""

TELLING = "family:lattice(6,6)"
"""A world in which no two of the algorithms and policies take the same doors."""

LARGER = (
    "nyc", "family:lattice(8,8,holes=0.2,seed=7)", "family:torus(4,4)",
    "family:triangular_torus(3,3)", "family:hexagonal_torus(3,3)", "family:dense(9,0.5,seed=1)",
    "family:king(4,4)", "family:random_genus(20,3,seed=5)",
)  # fmt: skip
"""Worlds with hundreds or thousands of moves; nyc is the street network."""


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


def taken_in_coq(mappers: Path, jobs: Sequence[Job]) -> list[list[int]]:
    """The doors that the proved mapper takes in each job."""
    lines = [str(len(jobs)), *map(told, jobs)]
    ran = toolchain.run([str(mappers)], mappers.parent, timeout=LIMIT, stdin="\n".join(lines))
    assert ran.accepted, ran.output
    taken = [line.removeprefix("doors").split() for line in ran.output.splitlines()]
    return [[int(door) for door in row] for row in taken]


def taken_here(job: Job) -> list[int]:
    """The doors that the mapper of the catalogue takes."""
    algorithm = CATALOGUE[job.algorithm].with_policies(pick=job.pick, order=job.order)
    return doors(trace_of(job.world, algorithm))


def differing(mappers: Path, jobs: Iterable[Job]) -> list[Job]:
    """The jobs in which the two take different doors."""
    todo = list(jobs)
    pairs = zip(todo, taken_in_coq(mappers, todo), strict=True)
    return [job for job, taken in pairs if taken != taken_here(job)]


@pytest.mark.parametrize("name", PROVED)
def test_both_take_the_same_doors_in_small_worlds(mappers: Path, name: str) -> None:
    small = [*worlds(range(4)), *map(resolve_world, (*FAMILIES, TELLING))]
    assert differing(mappers, (Job(name, world) for world in small)) == []


@pytest.mark.parametrize("name", PROVED)
def test_both_take_the_same_doors_in_every_world_to_5_edges(mappers: Path, name: str) -> None:
    every = [Job(name, world) for world in worlds(range(6))]
    assert len(every) == 8_955
    assert differing(mappers, every) == []


@pytest.mark.parametrize("name", PROVED)
def test_both_take_the_same_doors_in_large_worlds(mappers: Path, name: str) -> None:
    assert differing(mappers, (Job(name, resolve_world(world)) for world in LARGER)) == []


@pytest.mark.parametrize("pick", ["nearest", "first", "last"])
@pytest.mark.parametrize("order", ["shortest", "oldest", "newest"])
def test_both_take_the_same_doors_with_every_policy(mappers: Path, pick: str, order: str) -> None:
    some = [*worlds(range(4)), *map(resolve_world, FAMILIES[:3])]
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


def told_choices(world: World, name: str, seed: int) -> tuple[Job, list[int]]:
    """A run with random policies, told with the choices that were made, and its doors."""
    Recorded.picks.clear()
    Recorded.deals.clear()
    taken = taken_here(Job(name, world, f"random({seed})", f"random({seed})"))
    deals = (f"{len(deal)} {' '.join(map(str, deal))}" for deal in Recorded.deals)
    pick = f"random {len(Recorded.picks)} {' '.join(map(str, Recorded.picks))}"
    order = f"random {len(Recorded.deals)} {' '.join(deals)}"
    return Job(name, world, pick, order), taken


@pytest.mark.parametrize("name", PROVED)
def test_both_take_the_same_doors_with_what_the_generator_chose(
    mappers: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(choices, "Random", Recorded)
    some = [*worlds(range(4)), *map(resolve_world, FAMILIES)]
    runs = [told_choices(world, name, seed) for seed in range(2) for world in some]
    assert taken_in_coq(mappers, [job for job, _ in runs]) == [taken for _, taken in runs]
    (job, one), (_, other) = (told_choices(resolve_world(TELLING), name, s) for s in range(2))
    assert taken_in_coq(mappers, [job]) == [one] != [other]


def test_other_algorithms_and_policies_take_other_doors(mappers: Path) -> None:
    world = resolve_world(TELLING)
    jobs = [Job(name, world) for name in PROVED]
    jobs += [Job("basic", world, pick=pick) for pick in ("first", "last")]
    jobs += [Job("basic", world, order=order) for order in ("oldest", "newest")]
    assert len(set(map(tuple, taken_in_coq(mappers, jobs)))) == len(jobs)


class Oblivious(RecordsRule):
    """A rule with a fault: it writes no record."""

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Does nothing, where it ought to record."""


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
        ("enhancement-iii-all", {"rule": Oblivious}),
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
    assert differing(mappers, [Job(name, resolve_world(TELLING))])


def test_a_fault_in_a_policy_is_seen(mappers: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(choices.PICKS, "nearest", highest_of_ties)
    assert differing(mappers, (Job("basic", world) for world in worlds([3])))
