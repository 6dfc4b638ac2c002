"""Traces that lie: real ones, with a few things changed at random."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, cast, get_args

import msgspec
from hypothesis import strategies as st

from tests.helpers import PAPER, any_world, trace_of
from topo_verify import World
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

integers = st.integers(0, 9) | st.sampled_from([-1, -10, 10, 1000, 2**63 - 1, -(2**63)])
percepts = st.builds(Percept, integers, st.none() | integers)
rows = st.lists(integers, max_size=4).map(tuple)
rules = st.sampled_from([rule for rule in get_args(ev.RuleName) if rule != "folding"])
"""Not `folding`, whose rejections are judged by folding the history: see test_folding.py."""

records = st.builds(ev.Record, integers, rows)
evidences = st.builds(
    ev.Evidence,
    integers,
    percepts,
    percepts,
    sequence=st.none() | integers,
    at=st.none() | integers,
    record=st.none() | records,
)
maps = st.builds(
    ev.MapData,
    st.lists(rows, max_size=4).map(tuple),
    st.lists(rows, max_size=4).map(tuple),
    st.none() | integers,
)

FIELDS: dict[str, st.SearchStrategy[Any]] = {
    "door": integers,
    "percept": percepts,
    "edge": integers,
    "hypotheses": rows,
    "hypothesis": integers,
    "rule": rules,
    "evidence": evidences,
    "kind": st.sampled_from(["new", "loop"]),
    "dart": integers,
    "degree": integers,
    "cost": st.none() | integers,
    "map": maps,
    "step": integers,
    "expected": percepts,
    "observed": percepts,
    "sequence": st.none() | integers,
    "at": st.none() | integers,
    "record": st.none() | records,
    "doors": rows,
    "vertices": st.lists(rows, max_size=4).map(tuple),
    "edges": st.lists(rows, max_size=4).map(tuple),
    "marker": st.none() | integers,
}
"""What each field of an event may be changed into. Other fields are not judged."""

decisions = st.one_of(
    st.builds(ev.Pose, integers, rows),
    st.builds(ev.Reject, integers, integers, rules, evidences),
    st.builds(ev.Confirm, integers, integers, rules),
    st.builds(ev.Augment, integers, FIELDS["kind"], integers, integers),
    st.builds(ev.Move, integers, percepts),
)


finishes = st.builds(ev.Finish, st.none() | integers, maps)
starts = st.builds(ev.Start, percept=percepts)


class Doctored(NamedTuple):
    """A trace in the world where it should have happened."""

    world: World
    real: ev.Trace
    trace: ev.Trace


@st.composite
def doctored(draw: st.DrawFn, *, max_edges: int = 5, changes: int = 3) -> Doctored:
    """A real trace with 1 … `changes` changes, in a world with 1 … max_edges edges."""
    world = draw(any_world(max_edges=max_edges))
    name = draw(st.sampled_from(PAPER))
    real = trace_of(world, name)
    trace = list(real)
    for _ in range(draw(st.integers(1, changes))):
        draw(st.sampled_from(CHANGES))(draw, trace)
    return Doctored(world, real, tuple(trace))


def edit(draw: st.DrawFn, trace: list[ev.Event]) -> None:
    """Change one field of one event, or of what stands in it."""
    index = draw(st.integers(0, len(trace) - 1))
    trace[index] = _edited(draw, trace[index])


def _edited(draw: st.DrawFn, struct: Any) -> Any:
    names = [name for name in struct.__struct_fields__ if name in FIELDS]
    name = draw(st.sampled_from(names))
    value = getattr(struct, name)
    if isinstance(value, ev.Evidence | ev.Record | ev.MapData | Percept) and draw(st.booleans()):
        return msgspec.structs.replace(struct, **{name: _edited(draw, value)})
    return msgspec.structs.replace(struct, **{name: draw(_near(name, value))})


def _near(name: str, value: object) -> st.SearchStrategy[Any]:
    """Something else for this field: a neighbour of what it was, more often than anything."""
    if isinstance(value, int):
        return st.sampled_from([value - 1, value + 1]) | FIELDS[name]
    if isinstance(value, tuple) and value:
        row = cast("tuple[object, ...]", value)
        shorter = st.integers(0, len(row) - 1).map(lambda i: row[:i] + row[i + 1 :])
        return shorter | st.permutations(row).map(tuple) | FIELDS[name]
    return FIELDS[name]


def drop(draw: st.DrawFn, trace: list[ev.Event]) -> None:
    """Leave one event out."""
    if len(trace) > 1:
        del trace[draw(st.integers(1, len(trace) - 1))]


def insert(draw: st.DrawFn, trace: list[ev.Event]) -> None:
    """Put something in that never happened."""
    trace.insert(draw(st.integers(1, len(trace) - _over(trace))), draw(decisions))


def repeat(draw: st.DrawFn, trace: list[ev.Event]) -> None:
    """Let something happen again, somewhere else."""
    inner = range(1, len(trace) - _over(trace))
    if inner:
        event = trace[draw(st.sampled_from(inner))]
        trace.insert(draw(st.integers(1, len(trace) - _over(trace))), event)


def swap(draw: st.DrawFn, trace: list[ev.Event]) -> None:
    """Exchange two neighbours."""
    inner = range(1, len(trace) - _over(trace) - 1)
    if inner:
        index = draw(st.sampled_from(inner))
        trace[index : index + 2] = trace[index + 1], trace[index]


def cut(draw: st.DrawFn, trace: list[ev.Event]) -> None:
    """Let the trace end early."""
    del trace[draw(st.integers(1, len(trace))) :]


def reject_more(draw: st.DrawFn, trace: list[ev.Event]) -> None:
    """Give the evidence of one rejection for another hypothesis, or at another time."""
    rejects = [event for event in trace if isinstance(event, ev.Reject)]
    poses = [event for event in trace if isinstance(event, ev.Pose) and event.hypotheses]
    if rejects and poses:
        pose = draw(st.sampled_from(poses))
        lie = msgspec.structs.replace(
            draw(st.sampled_from(rejects)),
            edge=pose.edge,
            hypothesis=draw(st.sampled_from(pose.hypotheses)),
        )
        trace.insert(draw(st.integers(1, len(trace) - _over(trace))), lie)


def _over(trace: Sequence[ev.Event]) -> int:
    """1 if the trace is finished: nothing comes after that."""
    return isinstance(trace[-1], ev.Finish)


CHANGES: list[Callable[[st.DrawFn, list[ev.Event]], None]] = [
    edit, edit, edit, drop, insert, repeat, swap, cut, reject_more,
]  # fmt: skip
