"""Compares a mapper with a baseline, in its worlds and under its limits.

Each world is of the first kind that fits:

| kind | meaning |
| --- | --- |
| `undecided` | the mapper was out of time, or declined, or was not run |
| `wrong` | a claim fails, whatever the baseline says |
| `newly_right` | no claim fails, but in the baseline one did, or the world was undecided |
| `dearer`, `cheaper` | right in both, at another cost |
| `other_decisions` | right in both, at the same cost, by other moves or decisions |
| `equal` | nothing has changed |

If the baseline declares nothing in a world, only moves are compared there. The tolerance of P
percent is exceeded where 100·after > (100 + P)·before, in exact arithmetic.
Source: docs/baselines.md.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import zip_longest
from typing import Literal, NamedTuple, get_args

import msgspec

from topo_verify.campaign.campaign import MAX_TIMEOUTS
from topo_verify.campaign.row import Row
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Policies
from topo_verify.studies.baseline.file import Baseline, BaselineEntry, world_of
from topo_verify.studies.baseline.record import entry_of, replay_command
from topo_verify.studies.corpus import NETWORKS
from topo_verify.world import io
from topo_verify.world.rooted_map import World

ChangeKind = Literal[
    "wrong", "dearer", "cheaper", "other_decisions", "newly_right", "undecided", "equal"
]
KINDS: tuple[ChangeKind, ...] = get_args(ChangeKind)

Property = Literal["edges", "genus", "shape"]

SIZES = (0, 1, 2, 3, 4, 5, 10, 20, 50, 100, 200)

HANDLES = 3
"""From this genus on worlds are one class."""

EXAMPLES = 5
"""Worlds kept of each kind."""


class Change(msgspec.Struct, frozen=True):
    """A world in which the mapper does something else than in the baseline.

    Attributes:
        kind: what has changed.
        before, after: costs, in edge traversals; null where the run was not right.
        percent: the increase, to a tenth; null without both costs.
        beyond: it exceeds the tolerance.
        undeclared: right in both, and declares nothing where the baseline does.
        message: what is wrong or has changed; "" where the costs say it.
    """

    world: str
    kind: ChangeKind
    edges: int
    genus: int
    before: int | None
    after: int | None
    percent: float | None
    beyond: bool
    undeclared: bool
    message: str
    replay: str


class Group(msgspec.Struct, frozen=True):
    """The numbers and costs of the worlds of one class.

    Attributes:
        by, value: the property and its value: edges 6-10, genus 1, shape simple.
        before, after: summed costs where the mapper is right then and now.
        kinds: the number of worlds of each kind.
    """

    by: Property
    value: str
    worlds: int
    before: int
    after: int
    kinds: dict[ChangeKind, int]

    @property
    def changed(self) -> bool:
        """Whether a world is of another kind than `equal`."""
        return self.kinds["equal"] < self.worlds


class CostChange(msgspec.Struct, frozen=True):
    """Total edge traversals over the worlds in which the mapper is right then and now.

    Attributes:
        before, after: in the baseline, and now.
    """

    before: int
    after: int


class BaselineSummary(msgspec.Struct, frozen=True):
    """The baseline: its file, its mapper and its corpus.

    Attributes:
        tool: the version of topo-verify that recorded it.
        corpus, digest: the worlds, in words and as a digest.
    """

    file: str
    target: str
    tool: str
    policies: Policies | None
    corpus: str
    digest: str


class Comparison(msgspec.Struct, frozen=True, kw_only=True):
    """One comparison: an entry of `results`.

    Attributes:
        worlds: those of the baseline; the sum of the seven numbers that follow.
        tolerance: in percent, as given.
        beyond: the number of worlds whose cost exceeds the tolerance.
        undeclared: where it is right and declares nothing, and the baseline does: claims about
            decisions are not judged there any more.
        groups: the same numbers by class of worlds.
        examples: of each kind but `equal`, largest changes of cost first, else smallest worlds.
        wrong: where a claim fails.
        dearer, cheaper: where the cost has changed.
        other_decisions: where the cost is equal and a move or a decision is not.
        equal: where nothing has changed.
        newly_right: where a claim failed in the baseline.
        undecided: where the run was not decided.
    """

    target: str
    worlds: int
    equal: int
    wrong: int
    dearer: int
    cheaper: int
    other_decisions: int
    newly_right: int
    undecided: int
    tolerance: str
    beyond: int
    undeclared: int
    cost: CostChange
    baseline: BaselineSummary
    groups: tuple[Group, ...]
    examples: tuple[Change, ...]

    @property
    def kinds(self) -> dict[ChangeKind, int]:
        """The number of worlds of each kind."""
        return {kind: getattr(self, kind) for kind in KINDS}

    @property
    def regressed(self) -> bool:
        """Whether a claim fails, a cost is too high, or declared decisions are missing."""
        return self.wrong > 0 or self.beyond > 0 or self.undeclared > 0


class BaselineWorlds:
    """The worlds of a baseline with their names; InputError if an entry names no world."""

    def __init__(self, baseline: Baseline, name: str = "baseline") -> None:
        self._baseline, self._name = baseline, name
        for _ in self:
            pass  # each must be readable before a mapper runs

    def __iter__(self) -> Iterator[tuple[str, World]]:
        for line, entry in enumerate(self._baseline.entries, 2):
            yield _argument(entry), world_of(entry, name=self._name, line=line)


def compare(
    baseline: Baseline,
    target: Target,
    rows: Iterable[Row],
    *,
    tolerance: str | Fraction = "0",
    name: str = "baseline",
) -> Comparison:
    """Compare a baseline with the rows of a mapper.

    Args:
        rows: in the order of the baseline; fewer, if the runs ended early.
        tolerance: in percent; a float may be inexact.
    """
    changes: list[Change] = []
    classes: dict[_Class, list[Change]] = defaultdict(list)
    for entry, row in zip_longest(baseline.entries, rows):
        world = io.from_text(entry.world)
        replay = replay_command(target, _argument(entry), baseline.header.limits)
        changes.append(_change(entry, world, row, Fraction(tolerance), replay))
        for world_class in _classes(world):
            classes[world_class].append(changes[-1])
    before, after, kinds = _summed(changes)
    header = baseline.header
    return Comparison(
        target=target.text,
        worlds=len(changes),
        **kinds,
        tolerance=str(tolerance),
        beyond=sum(change.beyond for change in changes),
        undeclared=sum(change.undeclared for change in changes),
        cost=CostChange(before, after),
        baseline=BaselineSummary(
            name, header.target, header.tool, header.policies, header.corpus, header.digest
        ),
        groups=tuple(
            Group(world_class.by, world_class.value, len(members), *_summed(members))
            for world_class, members in sorted(classes.items())
        ),
        examples=tuple(_examples(changes)),
    )


def _summed(changes: Sequence[Change]) -> tuple[int, int, dict[ChangeKind, int]]:
    """Costs before and after where both are right; the number of worlds of each kind."""
    right = [(c.before, c.after) for c in changes if c.before is not None and c.after is not None]
    kinds = Counter(change.kind for change in changes)
    before, after = sum(cost for cost, _ in right), sum(cost for _, cost in right)
    return before, after, {kind: kinds[kind] for kind in KINDS}


def _examples(changes: Sequence[Change]) -> Iterator[Change]:
    """The largest changes of each kind but `equal`, each world once."""
    for kind in KINDS:
        if kind != "equal":
            alike = dict.fromkeys(change for change in changes if change.kind == kind)
            yield from sorted(alike, key=_weight)[:EXAMPLES]


def _argument(entry: BaselineEntry) -> str:
    known = entry.name in NETWORKS or entry.name.startswith("family:")
    return entry.name if known or entry.world.startswith("{") else entry.world


# ---------------------------------------------------------------- one world


def _change(
    then: BaselineEntry, world: World, row: Row | None, tolerance: Fraction, replay: str
) -> Change:
    now = None if row is None else entry_of(row, world)
    kind = _kind(then, now)
    before = then.cost if then.right else None
    after = now.cost if now is not None and now.right else None
    undeclared = now is not None and _undeclared(then, now)
    percent, beyond = None, False
    if before and after is not None:
        increase = Fraction(100 * (after - before), before)
        percent, beyond = float(round(increase, 1)), increase > tolerance
    return Change(
        world=then.called,
        kind=kind,
        edges=len(world.edges),
        genus=world.genus,
        before=before,
        after=after,
        percent=percent,
        beyond=beyond,
        undeclared=undeclared,
        message=_message(kind, then, row, undeclared=undeclared),
        replay=replay,
    )


def _kind(then: BaselineEntry, now: BaselineEntry | None) -> ChangeKind:
    if now is None or now.undecided:
        return "undecided"
    if now.failed:
        return "wrong"
    if not then.right:
        return "newly_right"
    if now.cost != then.cost:
        return "dearer" if now.cost > then.cost else "cheaper"
    if then.moves != now.moves or then.decisions not in (None, now.decisions):
        return "other_decisions"
    return "equal"


def _undeclared(then: BaselineEntry, now: BaselineEntry) -> bool:
    return then.right and now.right and then.decisions is not None and now.decisions is None


def _message(kind: ChangeKind, then: BaselineEntry, row: Row | None, *, undeclared: bool) -> str:
    if row is None:
        return f"not run: the mapper was out of time {MAX_TIMEOUTS} times before"
    if kind == "other_decisions":
        if undeclared:
            return "declares nothing now"
        return "the same moves, other decisions" if then.moves == row.moves else "other moves"
    for finding in row.findings:
        return f"{finding.claim}: {finding.message}"
    return row.undecided or ""


def _weight(change: Change) -> tuple[float, int]:
    if change.kind in ("dearer", "cheaper"):
        assert change.before is not None
        assert change.after is not None
        return -abs(change.after - change.before), change.edges
    return change.edges, 0


# ---------------------------------------------------------------- classes of worlds


class _Class(NamedTuple):
    """A class of worlds, shown in the order of (by, place)."""

    by: Property
    place: int
    value: str


def _classes(world: World) -> Iterator[_Class]:
    edges = len(world.edges)
    place = next((place for place, most in enumerate(SIZES) if edges <= most), len(SIZES))
    least = SIZES[place - 1] + 1 if place else 0
    most = SIZES[place] if place < len(SIZES) else None
    sizes = f"{least} or more" if most is None else f"{least}-{most}" if least < most else f"{most}"
    yield _Class("edges", place, sizes)
    genus = min(world.genus, HANDLES)
    yield _Class("genus", genus, f"{genus} or more" if genus == HANDLES else f"{genus}")
    if world.is_simple:
        yield _Class("shape", 0, "simple")
    elif world.is_loopless:
        yield _Class("shape", 1, "parallel edges, no loop")
    else:
        yield _Class("shape", 2, "with loops")
