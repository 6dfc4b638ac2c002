"""What the page finds again from the doors is what the checkers' replay says, event by event.

And what it says of an event is what the narrator says.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from tests.browser import Open
from tests.faults.every import EVERY
from tests.pictures.played import played
from topo_verify import CATALOGUE, Percept, World, families
from topo_verify.checkers.map_in_world import NEVER
from topo_verify.pictures.narrator import Narrator
from topo_verify.pictures.page import player_page
from topo_verify.pictures.recording import PlayedRun
from topo_verify.pictures.scenes import Moment, Playback
from topo_verify.robot.events import Reject

TOLD = """
JSON.parse(byId('recording').textContent).runs.map((recorded) => {
  const run = new Run(new Picture(JSON.parse(byId('recording').textContent).worlds[0]), recorded);
  const events = run.events.map((one, when) => {
    const doors = one.rule === 'folding' ? [] : one.evidence;
    const round = run.rounds[when];
    const found = one.type === 'reject' ? run.evidence(when) : null;
    const left = round && when < round.to ? round.hypotheses.filter((h) => h.out > when) : [];
    return {
      position: run.position[when],
      left: run.left[when],
      spent: run.costs.map((row) => row[when]),
      hypotheses: left.map((h) => h.dart),
      learned: one.records ?? [],
      evidence: found && [doors, found.real.at, found.believed.at, found.believed.rest.length],
    };
  });
  const said = events.map((_, when) => run.said(when));
  return { events, said, darts: run.map.darts.map((d) => [d.image, d.born, d.joined]) };
})
"""
"""What the scripts of the page make of each run in it."""


def expected(moment: Moment, *, cites_records: bool) -> dict[str, Any]:
    """The same of one event, by the replay of the checkers."""
    found, evidence = moment.mismatch, None
    if found is not None:
        beyond = 0 if found.leaves is None else len(found.doors) - len(found.traced) + 1
        at = found.traced[-1] if found.leaves is None else found.leaves
        evidence = [list(found.doors), found.trail[-1], at, beyond]
    return {
        "position": -1 if moment.position is None else moment.position,
        "left": -1 if moment.left_by is None else moment.left_by,
        "spent": list(moment.spent),
        "hypotheses": list(moment.hypotheses),
        "learned": [dart for dart, _ in moment.recorded] if cites_records else [],
        "evidence": evidence,
    }


def percept(seen: Percept | None) -> list[int | None] | None:
    """A percept as the page has it."""
    return None if seen is None else [seen.degree, seen.marker]


def compare(told: dict[str, Any], run: PlayedRun, playback: Playback) -> None:
    """Assert that the page and the checkers agree on a run."""
    replayed = playback.replayed
    cites_records = any(isinstance(e, Reject) and e.rule == "records" for e in run.trace)
    end = len(run.trace) if replayed.spoiled is None else replayed.spoiled
    for event, moment in zip(told["events"], playback.moments[:end], strict=False):
        wanted = expected(moment, cites_records=cites_records)
        if wanted["evidence"] is None:
            event["evidence"] = None  # it cites what is not there: the page shows what it can
        assert event == wanted, f"{run.name}, event {moment.number}"
    for said, saying in zip(told["said"], Narrator(playback).sayings, strict=True):
        assert said == {
            "kind": saying.kind,
            "title": saying.title,
            "text": saying.text,
            "sees": percept(saying.seen),
            "should": percept(saying.expected),
            "labels": list(saying.labels),
        }
    drawn = replayed.map
    for dart, image in drawn.phi.items():
        if drawn.born[dart] < end:
            joined = drawn.joined[dart]
            told_joined = told["darts"][dart][2]
            assert told["darts"][dart][:2] == [image, drawn.born[dart]]
            assert joined in (told_joined, NEVER), f"{run.name}, dart {dart}"


def compare_all(show: Open, world: World, runs: Sequence[PlayedRun]) -> None:
    """Assert that the page and the checkers agree on runs in one world."""
    told = show(player_page(world, runs)).evaluate(TOLD)
    for one, run in zip(told, runs, strict=True):
        compare(one, run, Playback(world, run.trace, run.judgements, run.stopped))


@pytest.mark.long
@pytest.mark.parametrize(
    "world", [pytest.param("lattice", marks=pytest.mark.nightly), "m3/8", "m4/41", "m2/9", "m5/17"]
)
def test_the_page_and_the_checkers_agree_on_every_algorithm(show: Open, world: str) -> None:
    drawn = families.lattice(3, 4) if world == "lattice" else World.from_id(world)
    compare_all(show, drawn, [played(drawn, name) for name in CATALOGUE])


SHORT = 500
"""Events of a run that is compared here: a wrong mapper may go on and on."""


@pytest.mark.nightly
@pytest.mark.parametrize("world", ["m3/8", "m2/1"])
def test_the_page_and_the_checkers_agree_on_wrong_mappers(show: Open, world: str) -> None:
    drawn = World.from_id(world)
    runs = [played(drawn, fault.mapper, name) for name, fault in EVERY.items()]
    compare_all(show, drawn, [run for run in runs if len(run.trace) <= SHORT])
