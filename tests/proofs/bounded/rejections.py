"""False rejections by a faulty rule, repeated in the simulator without a solver.

The faulty rule, written a second time as code on the map, finds an unexpected percept; rejecting h
must fail `true-hypothesis-kept`.
"""

from __future__ import annotations

from collections.abc import Iterator

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import common_prefix
from topo_verify.proofs.bounded.encoding import RuleFault
from topo_verify.proofs.bounded.replay import (
    BoundedCounterexample,
    Disagreement,
    DoorWord,
    EarlierExcursion,
    ReplayedCounterexample,
    Replayer,
    way_of,
)
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

PerceptPairs = Iterator[tuple[int, Percept, Percept]]
"""(step, expected percept, compared percept)."""


class _Rejecting(Replayer):
    def __init__(self, example: BoundedCounterexample) -> None:
        super().__init__(example)
        self.recorded: tuple[ev.MapDart, int] | None = None
        self.recorded_percepts: tuple[Percept, ...] = ()

    def excursion(self, word: DoorWord) -> None:
        """Go out and back, and forget that the reference dart is turned."""
        self.out(word)
        self.pilot.back(0)
        self.pilot.turned = 0

    def learn(self, behind: EarlierExcursion, fault: RuleFault) -> None:
        self.draw(behind.explored)
        self.cross(behind.e)
        self.out(behind.word)
        self.recorded_percepts = tuple(self.pilot.percepts[1:])
        entry = self.world.alpha[behind.e]
        self.augment(behind.e, entry)
        vertex = self.chart.vertex[entry]
        way = _traced(
            self.chart, self.chart.first[vertex] if fault == "first-dart" else entry, behind.word
        )
        if len(way) <= len(behind.word):
            self.recorded = self.chart.turn(way[-1], behind.word[len(way) - 1]), len(way) - 1


def replay_rejection(
    example: BoundedCounterexample, rule: str, fault: RuleFault
) -> ReplayedCounterexample:
    """Replay a false rejection by `trace`, `prefix`, `history` or `records`.

    Raises:
        Disagreement: the rejection does not happen.
    """
    run = _Rejecting(example)
    if example.earlier is not None:
        run.learn(example.earlier, fault)
    run.draw(example.explored)
    run.cross(example.e)
    if example.turned is not None:
        run.excursion((example.turned,))
    run.out(example.word)
    for step, expected, observed in _compared(run, example, rule, fault):
        if expected != observed:
            evidence = ev.Evidence(step, expected, observed)
            return run.judge(
                ev.Reject(example.e, example.h, "motion", evidence),
                "true-hypothesis-kept",
            )
    raise Disagreement(f"{example}: the rule {rule} with the fault {fault!r} rejects nothing")


def _compared(
    run: _Rejecting, example: BoundedCounterexample, rule: str, fault: RuleFault
) -> PerceptPairs:
    if rule == "records":
        return _records(run, example)
    if rule == "prefix":
        return _prefix(run, example, fault)
    way = _traced(run.chart, example.h, example.word, fault) if rule == "history" else None
    return _along(run, way or way_of(run.chart, example.h, example.word), fault)


def _along(run: _Rejecting, way: list[ev.MapDart], fault: RuleFault) -> PerceptPairs:
    later = int(fault == "shifted")
    for step, (at, observed) in enumerate(zip(way, run.pilot.percepts[later:], strict=False)):
        yield step, run.chart.percepts[at], observed


def _prefix(run: _Rejecting, example: BoundedCounterexample, fault: RuleFault) -> PerceptPairs:
    way = way_of(run.chart, example.h, example.own)
    shared = common_prefix(example.own, example.word) + int(fault == "one-more")
    for step in range(1, min(shared, len(example.own), len(example.word)) + 1):
        yield step, run.chart.percepts[way[step]], run.pilot.percepts[step]


def _records(run: _Rejecting, example: BoundedCounterexample) -> PerceptPairs:
    """The records behind the dart where tracing ends, as deep as the doors agree."""
    assert example.earlier is not None
    # One entry for vu and one for each door on S: door `step` leaves S.
    step = len(_traced(run.chart, example.h, example.word))
    if run.recorded is None or step > len(example.word):
        return
    crossed = _traced(run.chart, example.h, example.word)[-1]
    d, place = run.recorded
    if run.chart.turn(crossed, example.word[step - 1]) != d:
        return
    written = example.earlier.word[place + 1 :]
    deep = 1 + common_prefix(written, example.word[step:])
    for level in range(deep if example.levels is None else min(deep, example.levels)):
        yield step + level, run.recorded_percepts[place + level], run.pilot.percepts[step + level]


def _traced(
    chart: Chart, at: ev.MapDart, word: DoorWord, fault: RuleFault = ""
) -> list[ev.MapDart]:
    way = [at]
    for door in word:
        here = chart.first[chart.vertex[way[-1]]] if fault == "absolute-doors" else way[-1]
        leave = chart.turn(here, door)
        arrive = chart.alpha[leave]
        if arrive is None and fault != "through-unexplored":
            break
        way.append(leave if arrive is None else arrive)
    return way
