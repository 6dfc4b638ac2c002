"""The judgements of `check`, by the compiled judge, which is not trusted.

The checkers judge each run that it leaves open or convicts, so each finding is one of theirs.

What this does not show: that the compiled judge convicts every run that the checkers convict; tests
compare them.
"""

from __future__ import annotations

from collections.abc import Sequence
from zlib import crc32

from topo_verify.campaign.tally import KEPT_WORST
from topo_verify.checkers import CLAIMS, Judgement, Status, check
from topo_verify.checkers.claims import LARGE
from topo_verify.errors import InternalError
from topo_verify.extra.fast.kernels.events import ABSENT, words
from topo_verify.extra.fast.kernels.explore import place_map, place_world, workspace, write, zeros
from topo_verify.extra.fast.kernels.judging.layout import JUDGE_SIZE, LONG, LONG_SIZE, CaseWords
from topo_verify.extra.fast.kernels.judging.verdict import FIRST_PART, LAST_PART, judge_part
from topo_verify.extra.fast.kernels.kernel import compiled
from topo_verify.extra.fast.kernels.workspace import SMALL, TRACE
from topo_verify.robot.events import Augment, Confirm, Event, Finish, Move, Pose, Reject, Start
from topo_verify.robot.simulator import first_percept
from topo_verify.world.rooted_map import World

STATUSES: tuple[Status, ...] = ("ok", "failed", "partial", "not-declared", "undecided")
"""The names of the numbers of statuses in `judging/layout.py`."""

ALL_CLAIMS = len(CLAIMS)
"""The judge's level for all claims."""

_DECISIONS = {Reject, Confirm, Augment}
_KINDS = {Move, Pose, *_DECISIONS}
_CITING = {"folding": 1, "planar": 2}


SAMPLE = 1000
"""Average number of worlds between two that the checkers judge as well."""


class SampledChecks:
    """Judges runs by the compiled judge, and some of them by the checkers.

    The checkers judge what it leaves open or convicts, a sample drawn by the seed, and each run
    that costs at least as much as all before it, since a search names the most expensive worlds.

    Attributes:
        worlds: number of worlds that the checkers judged.
    Raises (by a call):
        InternalError: the two disagree.
    """

    def __init__(self, judge: CompiledChecks, seed: int) -> None:
        self._judge, self._seed = judge, seed
        self._most = self._equal = self.worlds = 0
        self._last: World | None = None

    def __call__(
        self, world: World, trace: Sequence[Event], stopped: str | None = None, *, strict: bool
    ) -> Sequence[Judgement]:
        """The judgements of `check`."""
        passed = None if stopped is not None else self._judge.unchecked(world, trace, strict=strict)
        is_open = passed is None or any(j.status == "failed" for j in passed)
        if passed is not None and not (
            is_open or self._may_be_named(trace) or self._is_drawn(world)
        ):
            return passed
        self.worlds += world is not self._last
        self._last = world
        judgements = check(world, trace, stopped, strict=strict)
        if passed is not None and _statuses(passed) != _statuses(judgements):
            raise InternalError(
                f"{world.known_id}: the compiled judge says {_statuses(passed)}, the checkers say"
                f" {_statuses(judgements)}"
            )
        return judgements

    def _may_be_named(self, trace: Sequence[Event]) -> bool:
        cost = sum(type(event) is Move for event in trace)
        if cost > self._most:
            self._most, self._equal = cost, 0
        self._equal += cost == self._most
        return cost == self._most and self._equal <= KEPT_WORST

    def _is_drawn(self, world: World) -> bool:
        return crc32(f"{self._seed} {world.known_id}".encode()) % SAMPLE == 0


def _statuses(judgements: Sequence[Judgement]) -> list[Status]:
    return [judgement.status for judgement in judgements]


class CompiledChecks:
    """Judges runs as `check` does.

    Args:
        is_long: in worlds of up to 16,384 edges, part by part; else in worlds of up to 12 edges.
        part: number of events in a part.
    """

    def __init__(self, *, is_long: bool = False, part: int = 1024) -> None:
        self._layout = LONG if is_long else SMALL
        self._room = 1 << 22 if is_long else TRACE
        self._part = part if is_long else TRACE
        self._space = workspace(self._layout, self._room)
        self._case = zeros(LONG_SIZE if is_long else JUDGE_SIZE)
        self._judge = compiled(judge_part, self._layout)

    def __call__(
        self, world: World, trace: Sequence[Event], stopped: str | None = None, *, strict: bool
    ) -> Sequence[Judgement]:
        """The judgements of `check`."""
        judgements = None if stopped is not None else self.unchecked(world, trace, strict=strict)
        if judgements is None or any(j.status == "failed" for j in judgements):
            return check(world, trace, stopped, strict=strict)
        return judgements

    def unchecked(
        self, world: World, trace: Sequence[Event], *, strict: bool = False
    ) -> Sequence[Judgement] | None:
        """The judgements of the compiled judge, without findings; None: it leaves them open."""
        case = CaseWords(self._case)
        case.level = ALL_CLAIMS if strict or len(world.edges) <= LARGE else ALL_CLAIMS - 1
        if not self._is_judged(world, trace):
            return None
        judgements = [
            Judgement(claim, STATUSES[case.status[k]], int(case.judged[k]), int(case.of[k]))
            for k, claim in enumerate(CLAIMS)
        ]
        if case.level < ALL_CLAIMS:
            declared = any(type(event) in _DECISIONS for event in trace)
            status: Status = "not-asked" if declared else "not-declared"
            judgements[-1] = Judgement(judgements[-1].claim, status, 0, judgements[-1].of)
        return judgements

    def _is_judged(self, world: World, trace: Sequence[Event]) -> bool:
        start, finish, layout = trace[0], trace[-1], self._layout
        if (
            len(world.alpha) > layout.constants["WORLD_DARTS"]
            or not (isinstance(start, Start) and start.percept == first_percept(world))
            or not isinstance(finish, Finish)
            or finish.cost == ABSENT
        ):
            return False
        case = CaseWords(self._case)
        case.darts, case.vertices = len(world.alpha), len(world.vertices)
        case.bound, case.delivered = world.cost_bound, 1
        place_world(self._space, layout, world)
        try:
            case.reported = ABSENT if finish.cost is None else finish.cost
            return place_map(self._space, layout, finish.map) and self._judge_parts(trace) >= 0
        except (ValueError, OverflowError):
            return False

    def _judge_parts(self, trace: Sequence[Event]) -> int:
        """A mask of the failing claims; -1: open."""
        last, asked, verdict = len(trace) - 1, 0, -1
        for event in trace:
            if type(event) is Reject:
                asked = max(asked, _CITING.get(event.rule, 0))
        at = self._layout.at("trace.word")
        for begin in range(1, max(last, 2), self._part):
            end = min(begin + self._part, last)
            events = trace[begin:end]
            row = words(events)
            if not _KINDS.issuperset(map(type, events)) or len(row) > self._room:
                return -1
            self._space[at : at + len(row)] = row
            write(self._space, self._layout, "trace", size=len(row))
            part = (begin == 1) * FIRST_PART + (end == last) * LAST_PART
            verdict = self._judge(self._space, self._case, part, asked)
            if verdict < 0:
                break
        return verdict
