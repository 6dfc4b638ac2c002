"""What each event of a run means, in sentences that the replay bears out.

A saying is in plain words: a vertex is a place, an edge a road, a dart an exit, a hypothesis a
guess. A line of the text walk has the field's terms. A decision that has a finding, is false in the
world or rests on a false map is reported as the mapper's word: `it says`.

What this does not show: whether a decision follows from the history. The findings say that.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Literal, NamedTuple, assert_never, get_args

from topo_verify.checkers.darts import KnownDart
from topo_verify.errors import InputError, plural, shown
from topo_verify.pictures.detours import SupposedWalk, tested_guesses
from topo_verify.pictures.fold_places import FoldPlaces, fold_places
from topo_verify.pictures.remarks import Homeward, homeward, map_place, world_place
from topo_verify.pictures.scenes import Mismatch, Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.event_words import cited_words, door_words, event_words, rejection_words
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import World

Sense = Literal["", "ask", "ok", "bad"]
SENSES: tuple[Sense, ...] = get_args(Sense)

SEES, SAW = ("it sees", "it should see"), ("it saw", "it should see")
"""The labels of two percepts, where the robot stands now and where it was before."""

EARLIER = {
    "prefix": "the walk just made",
    "history": "a walk made before",
    "records": "what it saw behind an open exit",
}


class Saying(NamedTuple):
    """The narration of a moment.

    Attributes:
        kind: its colour: a question, right, wrong, or none.
        seen, expected: two percepts to compare, or None.
        labels: the words below the two percepts.
    """

    kind: Sense
    title: str
    sentences: tuple[str, ...] = ()
    seen: Percept | None = None
    expected: Percept | None = None
    labels: tuple[str, str] = SEES

    @property
    def text(self) -> str:
        """The sentences as one text."""
        return " ".join(self.sentences)


class Narrator:
    """The sentences of one run."""

    def __init__(self, playback: Playback) -> None:
        self.playback, self.map = playback, playback.map

    @cached_property
    def folded(self) -> FoldPlaces:
        """The fold of the history, if the mapper rejects by folding."""
        rules = {event.rule for event in self.playback.trace if isinstance(event, ev.Reject)}
        return fold_places(self.playback.moments if "folding" in rules else ())

    # ------------------------------------------------------------ for everybody

    @cached_property
    def sayings(self) -> tuple[Saying, ...]:
        """The narration of each moment, in order."""
        return tuple(self._sayings())

    def _sayings(self) -> Iterator[Saying]:
        tested, ghost = tested_guesses(self.playback.moments), SupposedWalk(self.playback)
        guesses: Mapping[int, int] = {}
        percept: Percept | None = None
        for moment in self.playback.moments:
            event, goal = moment.event, tested.get(moment.number)
            if isinstance(event, ev.Pose):
                guesses = {h: number for number, h in enumerate(event.hypotheses, 1)}
            elif isinstance(event, ev.Start | ev.Move):
                percept = event.percept
            at = ghost.place(moment, goal)
            expected = None if at is None else self.map.seen_at(self.map.phi[at])
            if goal is not None and goal in guesses and moment.position is not None:
                saying = _testing(guesses[goal], percept, expected)
            else:
                saying = self._saying(moment, guesses, percept)
            if moment.number in self.folded.identified:
                text = "By its history it recognises places that it saw before."
                saying = saying._replace(sentences=(*saying.sentences, text))
            yield saying
            if isinstance(event, ev.Augment):
                guesses = {}

    def _saying(self, moment: Moment, guesses: Mapping[int, int], seen: Percept | None) -> Saying:
        event, illegal = moment.event, self.playback.replayed.illegal
        if illegal is not None and moment.number >= illegal:
            return self._lost(moment, illegal)
        match event:
            case ev.Start(percept=percept):
                saying = _started(percept)
            case ev.Move():
                saying = self._moved(moment, event)
            case ev.Pose():
                saying = self._posed(moment, event)
            case ev.Reject(_, h):
                saying = self._rejected(moment, event, _name(guesses, h))
            case ev.Confirm(_, h):
                saying = self._confirmed(moment, event, _name(guesses, h))
            case ev.Augment():
                saying = self._grown(moment, event, guessed=bool(guesses))
            case ev.Finish():
                saying = self._finished(moment, event)
            case _:
                assert_never(event)
        if self._is_claim(moment):
            saying = saying._replace(title=f"{saying.title}, it says")
        shows = saying.seen is not None or isinstance(event, ev.Reject)
        return saying if shows else saying._replace(seen=seen)

    def _is_claim(self, moment: Moment) -> bool:
        """Is the decision the mapper's word alone?"""
        event, spoiled = moment.event, self.playback.replayed.spoiled
        if not isinstance(event, ev.Reject | ev.Confirm | ev.Augment):
            return False
        if moment.findings or (spoiled is not None and spoiled <= moment.number):
            return True
        if isinstance(event, ev.Augment) or not self.map.is_open(event.edge, moment.number):
            return False
        true = self.map.number.get(self.map.end(event.edge)) == event.hypothesis
        return true == isinstance(event, ev.Reject)

    def _lost(self, moment: Moment, illegal: int) -> Saying:
        if moment.number > illegal:
            text = "It took a door that is not there, so where it stands is unknown."
            return Saying("bad", "The robot is lost", (text,))
        assert isinstance(moment.event, ev.Move)
        degree = self.map.seen_at(self.playback.replayed.positions[illegal - 1]).degree
        doors = f"doors 0 to {degree - 1}" if degree > 1 else "door 0" if degree else "no door"
        text = f"It takes door {moment.event.door}, but the place has {_exits(degree)}: {doors}."
        return Saying("bad", "No such door", (text,))

    def _moved(self, moment: Moment, move: ev.Move) -> Saying:
        assert moment.position is not None
        crossing = self.playback.replayed.crossing(moment.position)
        is_first = self.playback.replayed.crossings[crossing] == moment.number
        match move.purpose:
            case "cross" if is_first:
                text = "It takes a road that it has never walked. Where does it come out?"
                return Saying("ask", "Into the unknown", (text,))
            case "cross" if self._leaves_map(moment):
                text = "It walked this road before, but its map does not say where it leads."
                return Saying("ask", "A road that its map lacks", (text,))
            case "retrace":
                text = "It returns to the place that it is asking about."
                return Saying("", "Back the way it came", (text,))
            case "walk" if not is_first:
                text = "It takes a road that it has walked before."
                return Saying("", "On to the next open exit", (text,))
            case "validate" if moment.edge is not None:
                return Saying("", "A test", ("It walks on to tell its guesses apart.",))
            case _:
                before = "never walked" if is_first else "that it has walked"
                sees = f"It leaves by door {move.door}.", f"It sees {_sight(move.percept)}."
                return Saying("", f"A road {before} before", sees)

    def _leaves_map(self, moment: Moment) -> bool:
        return moment.through is not None and self.map.is_open(moment.through, moment.number)

    def _posed(self, moment: Moment, pose: ev.Pose) -> Saying:
        is_open = self.map.is_open(pose.edge, moment.number)
        if not (is_open and moment.position == self.map.end(KnownDart(pose.edge))):
            text = "It stands elsewhere now, and tells where the road leads by what it saw since."
            return Saying("ask", "A road crossed before", (text,))
        if not pose.hypotheses:
            text = "It finds no place on its map with an open exit that looks like this."
            return Saying("", "It takes the place for new", (text,))
        exits = plural(len(pose.hypotheses), "open exit")
        text = f"{exits} on its map could be the one that it came in by."
        return Saying("ask", "Was it here before?", (text, "Or the place is new."))

    def _rejected(self, moment: Moment, reject: ev.Reject, name: str) -> Saying:
        cited = reject.evidence
        if reject.rule == "planar":
            text = "Its exit lies on another face of the map, and this world is said to be planar."
            return Saying("bad", f"{name} is on the other side", (text,))
        if cited.contradiction is not None:
            return self._contradicted(moment.number, cited.contradiction, name)
        is_walked = reject.rule == "motion"
        title = f"{name} is wrong" + ("" if is_walked else " too, without a step")
        labels = SEES if is_walked else SAW
        if cited.observed is None or cited.expected is None or moment.mismatch is None:
            text = "What it cites is not to be found in its walk."
            return Saying("bad", title, (text,), cited.observed, cited.expected, labels)
        sentences = tuple(self._evidence(moment, reject, moment.mismatch))
        return Saying("bad", title, sentences, cited.observed, cited.expected, labels)

    def _evidence(self, moment: Moment, reject: ev.Reject, mismatch: Mismatch) -> Iterator[str]:
        observed, expected = reject.evidence.observed, reject.evidence.expected
        assert observed is not None, "the caller has looked"
        assert expected is not None, "the caller has looked"
        if reject.rule in EARLIER:
            yield f"It replays {EARLIER[reject.rule]}."
        is_seen = self.map.seen_at(mismatch.trail[-1]) == observed
        there = self.map.seen_at(self.map.phi[mismatch.traced[-1]])
        recorded = reject.evidence.record is not None
        known = there == expected if mismatch.leaves is None else recorded
        is_sure = known and is_seen and not moment.findings
        if is_sure and observed.signature == expected.signature:
            yield "At the dashed ring the marker would have to point another way."
            return
        sees = "sees" if reject.rule == "motion" else "saw"
        at = "At" if is_sure else "It says that at"
        yield f"{at} the dashed ring it would see {_sight(expected)}."
        yield f"It {sees if is_seen else 'says that it saw'} {_sight(observed)}."

    def _contradicted(self, number: int, contradiction: str, name: str) -> Saying:
        title, why = f"{name} is wrong", shown(contradiction)
        if number not in self.folded.clashes:
            return Saying("bad", title, (f"With it, the history would contradict itself: {why}.",))
        one, other = map(self.map.seen_at, self.folded.clashes[number])
        text = f"With it, two places that it saw would be one: {why}."
        return Saying("bad", title, (text,), one, other, ("one place", "the other"))

    def _confirmed(self, moment: Moment, confirm: ev.Confirm, name: str) -> Saying:
        title, way = f"{name} is right", homeward(self.playback, moment)
        if confirm.rule != "motion":
            return Saying("ok", title, ("No other end is left for its road, it says.",))
        if way is None:
            return Saying("ok", title, ("It says that it has walked the way home.",))
        if way.proves:
            looked = "Every place on the way looked as it should"
            text = f"{looked}, and the marker at the end points the right way."
            return Saying("ok", title, (text,))
        if way.expected == way.seen:
            return Saying("bad", title, _not_home(way))
        labels = SEES if way.step == len(moment.word) else SAW
        return Saying("bad", title, _differs(way), way.seen, way.expected, labels)

    def _grown(self, moment: Moment, augment: ev.Augment, *, guessed: bool) -> Saying:
        true = moment.growth is not None and moment.growth.true
        loop = augment.kind == "loop"
        title = "The road closes a circle" if loop else "A new place for the map"
        if true is False:
            return Saying("bad", title, ("In the world it is not so.",))
        if loop:
            text = "Both ends of the road are on its map now: two open exits fewer."
        elif guessed:
            text = "Every guess was refuted, it says, so it was never here before."
        else:
            more = plural(augment.degree - 1, "more open exit")
            text = f"Now its map has {more}." if augment.degree > 1 else "It is a dead end."
        return Saying("ok", title, (text,))

    def _finished(self, moment: Moment, finish: ev.Finish) -> Saying:
        world = self.playback.world
        least = f"With the map in hand, a proof takes {world.least_cost()}."
        cost = f"{plural(moment.spent.cost, 'move')} for {plural(len(world.edges), 'road')}."
        if self.playback.findings or not _is_map_of(world, finish.map):
            return Saying("", "It delivers its map", (cost, least))
        return Saying("ok", "The map is complete", (cost, least, "The map is the world."))

    # ------------------------------------------------------------ exactly

    def line(self, moment: Moment) -> str:
        """An event in one exact sentence; a rejection with the place of its evidence."""
        if isinstance(moment.event, ev.Reject):
            return self._rejects(moment.number, moment.event, moment.mismatch)
        return event_words(moment.event, brief=True)

    def _rejects(self, number: int, event: ev.Reject, mismatch: Mismatch | None) -> str:
        cited, spoiled = event.evidence, self.playback.replayed.spoiled
        if cited.contradiction is not None:
            return event_words(event)
        words = rejection_words(event)
        if mismatch is None:
            why = "cannot be found in the walk"
            if spoiled is not None and spoiled < number:
                why = f"is not looked for: the mapper's map is false since event {spoiled}"
            return f"{words}{cited_words(cited)} at step {cited.step}, which {why}"
        start = map_place(self.playback, mismatch.traced[0])
        behind = f"behind {door_words(mismatch.doors)} from {start}"
        behind = behind if mismatch.doors else "behind the edge"
        of = "" if mismatch.sequence is None else f" (sequence {mismatch.sequence})"
        at = world_place(self.playback, mismatch.trail[-1])
        return f"{words}{behind}{of} it {cited_words(cited)} at {at}"


def _testing(guess: int, percept: Percept | None, expected: Percept | None) -> Saying:
    text = "The ring is where it would be now, if that guess were right."
    if expected is None:
        text = "By these doors it would leave its map, which expects nothing there."
    return Saying("", f"Testing guess {guess}", (text,), percept, expected)


def _started(percept: Percept) -> Saying:
    sees = f"It sees {_sight(percept)}."
    if percept.marker is None:
        return Saying("", "The robot wakes up", (sees,))
    alone = "All that it can recognise is the marker, the red arrow."
    sentences = sees, "Dotted roads are unknown to it.", alone
    return Saying("", "The robot wakes up beside the marker", sentences)


def _not_home(way: Homeward) -> tuple[str, ...]:
    home, took = plural(len(way.home), "road"), plural(len(way.took), "road")
    return (f"The way home from there takes {home}, to the marker.", f"It walked {took}.")


def _differs(way: Homeward) -> tuple[str, ...]:
    where = f"After {plural(way.step, 'road')} of its walk" if way.step else "Behind the new road"
    if way.seen.signature == way.expected.signature:
        return (f"{where} the marker would have to point another way.",)
    return (f"{where} it would see {_sight(way.expected)}.", f"It saw {_sight(way.seen)}.")


def _is_map_of(world: World, delivered: ev.MapData) -> bool:
    try:
        return World.from_map(delivered).code == world.code
    except InputError:
        return False


def _name(guesses: Mapping[int, int], h: int) -> str:
    return f"Guess {guesses[h]}" if h in guesses else "A guess"


def _exits(degree: int) -> str:
    return plural(degree, "exit")


def _sight(percept: Percept) -> str:
    return _exits(percept.degree) + ("" if percept.marker is None else " and the marker")
