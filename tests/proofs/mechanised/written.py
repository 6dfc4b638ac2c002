"""Traces on one line, as the extracted mappers of extracted/main.ml write them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from topo_verify.robot import events as ev


def written(trace: Iterable[ev.Event]) -> str:
    """All events but the start, in their order.

    Of a rejection by motion the step stands there; evidence of rules and purposes do not.
    """
    return ";".join(
        " ".join(map(str, _words(event))) for event in trace if not isinstance(event, ev.Start)
    )


def _words(event: ev.Event) -> Iterator[object]:
    match event:
        case ev.Move(door, percept):
            marker = -1 if percept.marker is None else percept.marker
            yield from ("move", door, percept.degree, marker)
        case ev.Pose(edge, hypotheses):
            yield from ("pose", edge, *hypotheses)
        case ev.Reject(edge, hypothesis, "motion", evidence):
            yield from ("reject", edge, hypothesis, evidence.step)
        case ev.Reject(edge, hypothesis):
            yield from ("reject", edge, hypothesis)
        case ev.Confirm(edge, hypothesis, rule):
            yield from ("confirm", edge, hypothesis, *(["motion"] if rule == "motion" else []))
        case ev.Augment(edge, kind, dart, degree):
            yield from (kind, edge, dart, degree)
        case ev.Finish(cost, delivered):
            rows = [(row, row[1:] + row[:1]) for row in delivered.vertices]
            after = {d: e for row, turned in rows for d, e in zip(row, turned, strict=True)}
            yield from ("map", len(after), *(after[d] for d in sorted(after)))
            yield from (d for edge in delivered.edges for d in edge)
            yield from (-1 if delivered.marker is None else delivered.marker, cost)
        case _:
            raise AssertionError(event)
