"""What a robot does behind an edge, reduced; and what is remembered of it."""

from __future__ import annotations

from itertools import takewhile

import pytest

from tests.helpers import trace_of, worlds
from topo_verify import families
from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.excursions import Records, Step
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.robot.events import Augment, Move, Pose, Reject
from topo_verify.robot.percept import Percept


@pytest.mark.parametrize("algorithm", ["basic", "enhancement-iii-all"])
def test_a_sequence_ends_at_a_mismatch_that_was_walked_to(algorithm: str) -> None:
    """A confirmation ends none, nor does a mismatch that is seen where the robot stands."""
    confirmed = rejected_standing = 0
    for world in worlds(range(1, 4)):
        trace = trace_of(world, algorithm)
        for event, when, sequences in (
            (r.event, r.when, r.sequences) for r in ReplayedTrace(world, trace).rounds
        ):
            if not isinstance(event, Augment):
                continue
            behind = list(takewhile(lambda e: not isinstance(e, Pose), reversed(trace[:when])))
            mismatches = [e for e in behind if isinstance(e, Reject) and e.rule == "motion"]
            walked = any(isinstance(e, Move) for e in behind)
            assert len(sequences) == (len(mismatches) if walked else 0)
            assert all(sequences)
            confirmed += event.kind == "loop" and walked
            rejected_standing += bool(mismatches) and not walked
    assert min(confirmed, rejected_standing) > 0


def test_a_record_is_kept_behind_a_dart_that_the_very_next_event_explores() -> None:
    drawn = MapInWorld(families.path(3))
    records = Records(drawn)
    leaf = Percept(1, None)
    assert drawn.grow(1, Augment(0, "new", 1, 2))
    assert drawn.grow(2, Augment(2, "new", 3, 1))
    records.add(1, KnownDart(0), [(Step(0, Percept(2, None)), Step(1, leaf))])
    assert records.behind(KnownDart(2), (), 3) == leaf
