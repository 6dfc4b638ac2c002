"""A run as text: the moves and decisions before a finding, and S beside the truth.

It holds at any width from 50 columns on. S is listed vertex by vertex, the darts of each clockwise,
with the truth in brackets:

    0-1        dart 0 is explored, its other end is dart 1; so it is in the world
    2-?[4]     dart 2 is unexplored, and leads to dart 4
    2-?[w3:9]  dart 2 is unexplored, and leads to a place that S does not have: vertex 3, dart 9
    2-6![4]    S is false: it has dart 2 lead to dart 6, and it leads to dart 4
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

from topo_verify.checkers import Finding
from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.errors import LINE, InputError, plural, shortened, shown
from topo_verify.pictures.detours import circle, turns
from topo_verify.pictures.narrator import Narrator
from topo_verify.pictures.remarks import either_place, map_place, remarks, world_place
from topo_verify.pictures.scenes import DeclaredMap, Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.event_words import listed, percept_words
from topo_verify.world.rooted_map import World

WIDTH = 80

NARROW = 50

MOVES = 10

MOST_VERTICES = 12

MOST_DARTS = 40

_ON_S = (
    "A place is named by the dart by which the robot came in: v2:7 is dart 7 of the map S, at its"
    " vertex v2; where S lacks it, w1:4 is dart 4 of the world, at its vertex 1. Edge 7 is the edge"
    " of dart 7 of S."
)
_IN_WORLD = (
    "A place is named by the dart by which the robot came in: w1:4 is dart 4 of the world, at its"
    " vertex 1. v0 is the marker's vertex."
)
_SEES = "sees: the degree, and the door of the marker."

_WIDE = ("event", "door", "out by", "sees", "arrives by", "in world", "cost", "for")
_FEW = ("event", "door", "out by", "sees", "by", "cost")
_LEFT = {"out by", "sees", "arrives by", "by", "in world", "for"}
"""The columns that are flush left."""

_LONG = 60


@dataclass(frozen=True, slots=True)
class Extent:
    """The part of a run that is shown.

    Attributes:
        first: the first event; None: some moves before the finding.
        to_end: show the events after the finding, too.
    """

    first: int | None = None
    to_end: bool = False


BRIEF = Extent()


def lines(playback: Playback, width: int = WIDTH, extent: Extent = BRIEF) -> Iterator[str]:
    """The last moves of a run before its first finding, and S there beside the truth."""
    view = _View(playback, max(width, NARROW))
    end = len(playback.trace) - 1
    last = end if extent.to_end else view.focus
    first = view.first if extent.first is None else min(extent.first, last)
    yield from view.legend(playback.moments[first : last + 1])
    yield from view.table(playback.moments[first : last + 1])
    yield from view.more(last)
    yield from view.end(at_end=last == end)
    if playback.first_finding is not None:
        yield ""
        yield from view.map()


def parting(
    playback: Playback, at: int, sides: Sequence[tuple[str, str]], width: int = WIDTH
) -> Iterator[str]:
    """Two runs that differ: their common walk, what each does then, and S at that moment.

    Args:
        playback: one of the runs; both are equal before event `at`.
        sides: the name of each mapper, and what it does.
    """
    view = _View(playback, max(width, NARROW), focus=at - 1)
    yield from view.legend(playback.moments[view.first : at])
    yield from view.table(playback.moments[view.first : at])
    yield "Here they part:"
    for name, does in sides:
        yield from view.wrapped(f"{name}: {does}", "  ", "    ")
    yield ""
    yield from view.map()


def is_shown(playback: Playback, finding: Finding, extent: Extent = BRIEF) -> bool:
    """Does the view hold this finding?"""
    first = playback.first_finding
    return finding.event is None or extent.to_end or (first and first.event) == finding.event


class _View:
    def __init__(self, playback: Playback, width: int, focus: int | None = None) -> None:
        self.playback, self.width = playback, width
        self.narrator = Narrator(playback)
        self.turns, self.circle = turns(playback), circle(playback)
        self.focus = self._focus() if focus is None else focus

    def _focus(self) -> int:
        finding = self.playback.first_finding
        if finding is not None and finding.event is not None:
            return finding.event
        return len(self.playback.trace) - 1 if self.circle is None else self.circle.last

    @property
    def first(self) -> int:
        remaining = MOVES
        for number in range(self.focus, 3, -1):
            remaining -= isinstance(self.playback.trace[number], ev.Move)
            if not remaining:
                return number
        return 0

    # ------------------------------------------------------------ the table

    def legend(self, moments: Sequence[Moment]) -> Iterator[str]:
        """The sentence that explains the places in the table; nothing if the robot never moves."""
        if any(isinstance(moment.event, ev.Move) for moment in moments):
            names = _ON_S if _declares_map(self.playback) else _IN_WORLD
            yield from self.wrapped(f"{names} {_SEES}")
            yield ""

    def table(self, moments: Sequence[Moment]) -> Iterator[str]:
        columns, gap, rows = self._laid_out(moments)
        widths = [max(map(len, column)) for column in zip(columns, *rows.values(), strict=True)]
        yield _line(columns, columns, widths, gap)
        indent = " " * (widths[0] + len(gap))
        if moments and moments[0].number:
            yield from self.wrapped(f"… {self._before(moments[0])}", indent)
        for moment in moments:
            number = f"{moment.number:>{widths[0]}}{gap}"
            if moment.number in rows:
                yield _line(columns, rows[moment.number], widths, gap)
            else:
                yield from self.wrapped(self.narrator.line(moment), number, indent)
            for remark in remarks(self.playback, moment, self.turns.get(moment.number)):
                yield from self.wrapped(f"({remark})", indent, f"{indent} ")
            for finding in moment.findings:
                yield from self.wrapped(
                    _found(finding, self.playback.world), indent, f"{indent}   "
                )

    def _laid_out(
        self, moments: Sequence[Moment]
    ) -> tuple[Sequence[str], str, dict[int, tuple[str, ...]]]:
        has_row = (ev.Start, ev.Move)
        rows = {m.number: self._row(m) for m in moments if isinstance(m.event, has_row)}
        wide = _WIDE if any(row[-1] for row in rows.values()) else _WIDE[:-1]
        cut = {number: row[: len(wide)] for number, row in rows.items()}
        need = sum(max(map(len, column)) for column in zip(wide, *cut.values(), strict=True))
        if need + 2 * (len(wide) - 1) <= self.width:
            return wide, "  ", cut
        return _FEW, " ", {number: (*row[:5], row[6]) for number, row in rows.items()}

    def _row(self, moment: Moment) -> tuple[str, ...]:
        event, door, out, purpose = moment.event, "start", "", ""
        assert isinstance(event, ev.Start | ev.Move)
        if isinstance(event, ev.Move):
            door, purpose = str(event.door), event.purpose or ""
            out = either_place(self.playback, moment.through, moment.left_by)
        return (
            str(moment.number),
            door,
            out,
            percept_words(event.percept),
            either_place(self.playback, moment.known, moment.position),
            world_place(self.playback, moment.position),
            str(moment.spent.cost),
            purpose,
        )

    def _before(self, moment: Moment) -> str:
        before = self.playback.moments[moment.number - 1]
        words = f"{plural(moment.number, 'event')} before, {plural(before.spent.cost, 'move')}"
        return words if before.edge is None else f"{words}; it asks where edge {before.edge} leads"

    # ------------------------------------------------------------ below the table

    def more(self, last: int) -> list[str]:
        following, words, repeated = len(self.playback.trace) - 1 - last, "", self.circle
        if repeated is not None and last == repeated.last:
            words = f"{str(repeated).capitalize()}."
        elif following:
            start, show = self.playback.trace[0], "topo-verify replay --all shows"
            if isinstance(start, ev.Start) and "<" in (start.algorithm or ""):  # of a notebook
                show = "tv.explore(world, mapper).save('run.html') plays"
            words = f"{plural(following, 'more event')}: {show} the whole run."
            if repeated is not None:
                moves = plural(repeated.period, "move")
                words += f" From event {repeated.first} on the robot walks in a circle of {moves}."
        return self.wrapped(words)

    def end(self, *, at_end: bool) -> Iterator[str]:
        for finding in self.playback.about_the_run:
            yield from self.wrapped(_found(finding, self.playback.world), "", "   ")
        if not self.playback.about_the_run:
            yield from self.wrapped(self.playback.stopped or "", "", "   ")
        illegal = self.playback.replayed.illegal
        if illegal is not None and (at_end or self.focus == illegal):
            stands: int | None = illegal - 1
        else:
            finished = isinstance(self.playback.trace[-1], ev.Finish)
            if at_end and finished and illegal is None:
                yield from self._delivered()
            ends_here = at_end and not finished and illegal is None and self.circle is None
            stands = len(self.playback.trace) - 1 if ends_here else None
        if stands is not None:
            doors = doors_of(self.playback, stands)
            yield from chain.from_iterable(self.wrapped(line, "", "    ") for line in doors)

    def _delivered(self) -> Iterator[str]:
        last = len(self.playback.trace) - 1
        claims = {finding.claim for finding in self.playback.findings if finding.event == last}
        if "map-isomorphic" in claims:
            yield from self.wrapped(difference_of_maps(self.playback) or "")
        if "map-entailed" in claims:
            yield from self.wrapped(never_crossed(self.playback) or "")

    def map(self) -> Iterator[str]:
        if not _declares_map(self.playback):
            yield "The mapper has declared nothing about its map S."
            return
        head = f"S after event {self.focus}, vertex by vertex, clockwise; in brackets what is so"
        yield from self.wrapped(f"{head} in the world, where S does not say it:")
        for line in known_map(self.playback, self.playback.moments[self.focus]):
            yield from self.wrapped(line, "  ", "      ")

    def wrapped(self, text: str, indent: str = "", further: str | None = None) -> list[str]:
        return textwrap.wrap(
            shortened(shown(text, limit=LINE)),
            self.width,
            initial_indent=indent,
            subsequent_indent=indent if further is None else further,
            break_on_hyphens=False,
        )


def _line(columns: Sequence[str], cells: Sequence[str], widths: Sequence[int], gap: str) -> str:
    padded: Iterable[str] = (
        cell.ljust(width) if column in _LEFT else cell.rjust(width)
        for column, cell, width in zip(columns, cells, widths, strict=True)
    )
    return gap.join(padded).rstrip()


def _found(finding: Finding, world: World) -> str:
    words, witness = f"!! {finding.claim}: {finding.message}", finding.witness
    if not witness or witness in words or len(witness) > _LONG or witness == world.text:
        return words
    return f"{words} (in {witness} the same is seen so far, and it is false there)"


# ---------------------------------------------------------------- S, with the truth in brackets


def known_map(playback: Playback, moment: Moment) -> Iterator[str]:
    """S after an event as declared, with the truth in brackets: a line a vertex."""
    declared = playback.map_at(moment.number)
    other = {a: b for edge in declared.edges for a, b in (edge, edge[::-1])}
    chosen = _chosen(declared, moment)
    for number in chosen:
        first, degree = declared.vertices[number]
        darts = range(first, first + min(degree, MOST_DARTS))
        ends = [_end(playback, dart, other.get(dart), moment.number) for dart in darts]
        at = (
            playback.map.phi.get(KnownDart(first))
            if _is_known(playback, first, moment.number)
            else None
        )
        name = "no such vertex" if at is None else world_place(playback, at).partition(":")[0]
        more = " …" if degree > MOST_DARTS else ""
        yield f"v{number} ({name}): {'  '.join(ends) or 'no dart'}{more}"
    if remaining := len(declared.vertices) - len(chosen):
        yield f"and {plural(remaining, 'vertex', 'vertices')} more"


def _is_known(playback: Playback, dart: int, number: int) -> bool:
    return 0 <= dart < len(playback.map.born) and playback.map.born[dart] <= number


def _end(playback: Playback, dart: int, says: int | None, number: int) -> str:
    words = f"{dart}-{'?' if says is None else says}"
    if not _is_known(playback, dart, number):
        return words
    leads = playback.map.end(KnownDart(dart))
    known = playback.known(leads, number)
    true = world_place(playback, leads) if known is None else str(known)
    if says is None:
        return f"{words}[{true}]"
    return words if str(says) == true else f"{words}![{true}]"


def _chosen(declared: DeclaredMap, moment: Moment) -> list[int]:
    everything = [*range(len(declared.vertices))]
    if len(everything) <= MOST_VERTICES:
        return everything
    event = moment.event
    about = {moment.edge, moment.known, *moment.hypotheses[:MOST_VERTICES]}
    if isinstance(event, ev.Reject | ev.Confirm):
        about.add(event.hypothesis)
    if isinstance(event, ev.Augment):
        about |= {event.edge, event.dart}
    darts = [dart for dart in about if dart is not None]
    return [
        vertex
        for vertex, (first, degree) in enumerate(declared.vertices)
        if any(first <= dart < first + degree for dart in darts)
    ]


# ---------------------------------------------------------------- a place and its doors


def doors_of(playback: Playback, number: int) -> Iterator[str]:
    """The vertex where the robot stands after an event, and where each of its doors leads."""
    stands = playback.replayed.positions[number]
    degree = playback.map.seen_at(stands).degree
    known = playback.known(stands, number)
    at = world_place(playback, stands)
    at = at if known is None else f"{map_place(playback, known)} ({at})"
    yield f"The robot stands at {at}, a vertex with {plural(degree, 'door')}:"
    for door in range(min(degree, MOST_DARTS)):
        far = playback.map.beyond(stands, door)
        back = "back, " if door == 0 and number else ""
        yield f"  door {door}: {back}to {_named(playback, far, number)}"
    if degree > MOST_DARTS:
        yield f"  and {degree - MOST_DARTS} more"


def _named(playback: Playback, dart: WorldDart, number: int) -> str:
    known = playback.known(dart, number)
    there = world_place(playback, dart)
    if known is None:
        return f"{there}, not on S" if _declares_map(playback) else there
    return f"{map_place(playback, known)} ({there})"


def _declares_map(playback: Playback) -> bool:
    return any(isinstance(event, ev.Augment) for event in playback.trace)


def never_crossed(playback: Playback) -> str | None:
    """A sentence that lists the edges of the world never crossed, or None."""
    last = len(playback.trace)
    uncrossed = [
        " to ".join(
            either_place(playback, playback.known(WorldDart(dart), last), WorldDart(dart))
            for dart in (a, b)
        )
        for a, b in playback.world.edges
        if a not in playback.replayed.crossings
    ]
    return f"Never crossed: {listed(uncrossed)}." if uncrossed else None


def difference_of_maps(playback: Playback) -> str | None:
    """Where the delivered map first differs from the world; None without a difference or a map."""
    finish = playback.trace[-1]
    if not isinstance(finish, ev.Finish):
        return None
    try:
        delivered = World.from_map(finish.map)
    except InputError:
        return None
    ours, theirs = playback.world.code, delivered.code
    if ours != theirs == playback.world.mirror().code:
        return "The map is the world's mirror image: list the darts of each vertex clockwise."
    head = "Both numbered breadth-first and clockwise from the marker on:"
    for vertex, (one, other) in enumerate(zip(ours[0], theirs[0], strict=False)):
        if one != other:
            return f"{head} vertex {vertex} has degree {one} in the world and {other} in the map."
    for dart, (one, other) in enumerate(zip(ours[1], theirs[1], strict=False)):
        if one != other:
            return f"{head} dart {dart} leads to {one} in the world and to {other} in the map."
    return None
