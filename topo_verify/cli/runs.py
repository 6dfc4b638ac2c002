"""Worlds as the user names them; judged runs, findings and walks as shown.

A search keeps the run of a counterexample. Where only its world and its claim are known, the
mapper runs there again, and its walk is shown if the same claim fails again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from io import BytesIO
from itertools import count
from pathlib import Path

import msgspec

from topo_verify.campaign.attempt import attempt
from topo_verify.campaign.judge import (
    Report,
    in_words,
    judge,
    replay_line,
    strict_option,
    undecided,
)
from topo_verify.campaign.run import Exploration, explore
from topo_verify.checkers import CLAIMS, Finding, Judgement, Status
from topo_verify.checkers.claims import LARGE
from topo_verify.errors import InputError, plural
from topo_verify.pictures import walk
from topo_verify.pictures.recording import PlayedRun
from topo_verify.programs.loader import Target
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Bullets, Command, Text, View
from topo_verify.robot.events import Finish
from topo_verify.robot.limits import Limits
from topo_verify.world.formats import files
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World


@dataclass(frozen=True)
class NamedWorld:
    """A world, with its marker as the options say, and the arguments that name it."""

    world: World
    text: str
    marker: int | None = None

    @property
    def name(self) -> str:
        """The world's name in results: its own, else its id, else "world"."""
        return self.world.name or self.world.known_id or "world"

    @cached_property
    def argument(self) -> str:
        """A WORLD argument for a later call; a large one from standard input is saved."""
        if self.text == "-":
            return self.world.known_id or _saved(self.world)
        return f"./{self.text}" if self.text.startswith("-") else self.text

    @property
    def options(self) -> tuple[str, ...]:
        """The options that go with `argument`."""
        return () if self.marker is None or self.text == "-" else ("--marker", str(self.marker))


def named_world(
    text: str,
    marker: int | None = None,
    stdin: bytes | None = None,
    *,
    largest_part: bool = False,
) -> NamedWorld:
    """The world that the user names; `stdin` is standard input, if already read.

    Args:
        largest_part: keep only the largest part of a drawing, and remark what is left out.
    """
    stream = None if stdin is None else BytesIO(stdin)
    world = resolve_world(text, stdin=stream, largest_part=largest_part)
    if marker is not None:
        named_by_id = world.name == text
        try:
            world = world.with_marker(marker)
        except InputError as error:
            raise InputError(f"--marker {marker} in {text}: {error}") from error
        if named_by_id and not text.startswith("family:"):
            world = replace(world, name="")  # its id has changed
    return NamedWorld(world, text, marker)


def named_worlds(
    texts: Sequence[str],
    marker: int | None = None,
    *,
    largest_part: bool = False,
) -> list[NamedWorld]:
    """The worlds that the user names, all read before any is used."""
    if texts.count("-") > 1:
        raise InputError(
            "expected '-' at most once, since standard input holds one world; name files instead"
        )
    return [named_world(text, marker, largest_part=largest_part) for text in texts]


def _saved(world: World) -> str:
    text = world.to_json() + "\n"
    # Named by its content, so equal worlds give equal output.
    stem = f"world-{sha256(text.encode()).hexdigest()[:12]}"
    for number in count(1):
        path = Path(f"{stem}.json" if number == 1 else f"{stem}-{number}.json")
        if _is_saved(path, text):
            return str(path)
    raise AssertionError("count() never ends")


def _is_saved(path: Path, text: str) -> bool:
    try:
        # "x" never overwrites a file of the user's.
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        return path.is_file() and path.read_bytes() == text.encode()
    except OSError as error:
        raise InputError(
            f"the world from standard input cannot be saved as {path}: {error.strerror}; run this"
            " in a writable folder, or name a file as the WORLD"
        ) from error
    return True


# ---------------------------------------------------------------- judging


def judged(
    target: Target,
    at: NamedWorld,
    limits: Limits,
    *,
    strict: bool = False,
    before_judging: Callable[[Exploration], Exploration] = lambda run: run,
) -> tuple[Exploration, Report, bool]:
    """A run, its report, and whether it is undecided; made again as in a campaign (`attempt`)."""
    tried = attempt(
        at.world, target, limits, where=at.text, strict=strict, before_judging=before_judging
    )
    run, report = replace(tried.run, stopped=tried.lost_why or tried.run.stopped), tried.report
    # Its findings would only say that it has no map.
    if tried.is_lost or undecided(run, report):
        return run, report.with_findings(()), True
    if not report.findings:
        return run, report, False
    words = (*at.options, *limits.options, *strict_option(at.world, strict=strict))
    replay_command = replay_line(at.argument, run.algorithm, run.policies, words)
    findings = tuple(
        msgspec.structs.replace(finding, world=at.argument, replay=replay_command)
        for finding in report.findings
    )
    return run, report.with_findings(findings), False


# ---------------------------------------------------------------- showing


def claims_cell(claims: Mapping[str, Status], *, incomplete: bool = False) -> str:
    """How many claims fail, else how many hold."""
    failed = sum(status == "failed" for status in claims.values())
    if incomplete and "undecided" not in claims.values():
        return "not decided"
    if failed:
        return plural(failed, "fails", "fail")
    return claims_in_words(claims)


def claims_in_words(claims: Mapping[str, Status]) -> str:
    """How many claims hold, and how many have each other status."""
    return f"{len(claims)} hold" if {*claims.values()} == {"ok"} else in_words(claims, "hold")


def unjudged(mapper: str, world: str, judgements: Iterable[Judgement]) -> Iterator[Text]:
    """Sentences that name the claims not fully judged, with the reason."""
    claims: dict[str, list[Judgement]] = {reason: [] for reason in _REASONS.values()}
    judgements = tuple(judgements)
    # only decisions before the first false one are judged
    is_wrong = any(
        judgement.status == "failed" and CLAIMS[judgement.claim][1] not in ((), (Finish,))
        for judgement in judgements
    )
    so_far = " before its first wrong step" if is_wrong else ""
    for judgement in judgements:
        reasons = _REASONS | _WITHOUT_A_MAP if judgement.claim == "map-entailed" else _REASONS
        if judgement.status in reasons:
            claims.setdefault(reasons[judgement.status], []).append(judgement)
    for reason, of_reason in claims.items():
        if of_reason:
            names = [judgement.claim for judgement in of_reason]
            if of_reason[0].status in ("partial", "undecided"):
                names = [
                    f"{judgement.claim} {judgement.judged} of {judgement.of}"
                    for judgement in of_reason
                ]
            text = reason.format(mapper=mapper, world=world, size=LARGE, so_far=so_far)
            yield Text(f"{text}: {', '.join(names)}.")


_REASONS: dict[Status, str] = {
    "not-declared": "Not judged, because {mapper} declares nothing about it{so_far}",
    "partial": (
        "Judged in part, because {mapper} left decisions undeclared or ended early in {world}"
    ),
    "undecided": "Neither proved nor refuted in {world}",
    "not-asked": "Not asked in worlds over {size} edges without --strict",
}

_WITHOUT_A_MAP: dict[Status, str] = {
    "not-declared": "Not judged, because {mapper} delivers no map",
    "partial": "Judged in part, because {mapper} delivers no map in some of {world}",
}


def finding_blocks(
    findings: Iterable[Finding], about: str = "", *, shown: int = 5
) -> Iterator[Block]:
    """Blocks for findings, at most `shown` of a run, grouped by replay command."""
    runs: dict[str, list[Finding]] = {}
    for finding in findings:
        runs.setdefault(finding.replay, []).append(finding)
    for replay_command, of_run in runs.items():
        yield Text(f"{about or of_run[0].world}:")
        lines = [finding_line(finding) for finding in of_run[:shown]]
        if len(of_run) > shown:
            lines.append(f"and {len(of_run) - shown} more: --format json shows them")
        yield Bullets(tuple(lines))
        yield Command(replay_command, "again: ")


def finding_line(finding: Finding) -> str:
    """Claim, event and message of a finding."""
    event = "" if finding.event is None else f", event {finding.event}"
    return f"{finding.claim}{event}: {finding.message}"


# ---------------------------------------------------------------- walks

OTHERS = 5


def walk_view(report: Report, extent: walk.Extent = walk.BRIEF) -> Iterator[Block]:
    """The walk to the first finding of a run."""
    playback = report.playback
    if playback is not None:
        yield View(lambda width: walk.lines(playback, width, extent))


def other_findings(report: Report, extent: walk.Extent) -> Iterator[Block]:
    """The findings that the walk does not show."""
    playback = report.playback
    others = [
        finding
        for finding in report.findings
        if playback is None or not walk.is_shown(playback, finding, extent)
    ]
    if others:
        yield Text("")
        yield Text("Also wrong:")
        lines = [finding_line(finding) for finding in others[:OTHERS]]
        if len(others) > OTHERS:
            lines.append(f"and {len(others) - OTHERS} more: --format json shows them")
        yield Bullets(tuple(lines))


def require_one_world(file: str | None, number: int) -> None:
    """Raise InputError if the file cannot be a page, or the number of worlds is not 1."""
    if file == "-":
        raise InputError("--player -: standard output is for the results; name a file")
    if file is not None and number != 1:
        raise InputError(f"--player {file}: expected one WORLD, got {number}; name one")
    if file is not None:
        from topo_verify.pictures.page import require_page

        require_page(file)


def write_page(file: str, world: World, name: str, runs: Sequence[PlayedRun]) -> None:
    """Write the page that shows these runs in a world of this name."""
    from topo_verify.pictures.page import player_page

    files.write(file, player_page(world, runs, name=name))


MOST_EXHIBITS = 12
"""Most counterexamples in a page; others are counted."""


class FoundRuns:
    """The counterexamples of a command: the walk of the first, and exhibits for a page."""

    def __init__(self, *, people: bool, page: bool) -> None:
        self._people = people
        self._most = MOST_EXHIBITS if page else int(people)
        self._alone = page
        self._report: Report | None = None
        self._exhibits: dict[tuple[str, str], acc.Exhibit] = {}
        self._seen: set[tuple[str, str]] = set()
        self._late = False

    def keep(self, report: Report) -> None:
        """Keep the report of a run if it has findings, and if it is the first or a page is due."""
        if self._most and report.findings and (self._report is None or self._alone):
            self._report = self._report or report
            self.show(exhibit_of(report))

    def walk(self, report: Report | None) -> None:
        """Show people the walk of this run, unless another is kept already."""
        if self._people:
            self._report = self._report or report

    def show(self, exhibit: acc.Exhibit | None) -> None:
        """Keep an exhibit for the page."""
        if exhibit is not None:
            place = (exhibit.title, exhibit.name)
            self._seen.add(place)
            if len(self._exhibits) < self._most:
                self._exhibits.setdefault(place, exhibit)

    def run_again(
        self,
        targets: Sequence[Target],
        world: str,
        claim: str,
        limits: Limits,
        message: str = "",
        *,
        reports: Callable[[Target, World], Iterator[Report]] | None = None,
    ) -> None:
        """Run the mappers in a counterexample's world; keep a run in which the claim fails again.

        If it does not fail again (a randomised mapper), the world is shown without a run. Worlds
        in files are ignored, since a file may change. `reports` makes the reports of a mapper
        with several runs.
        """
        if not self._most or (self._report is not None and not self._alone):
            return
        try:
            fixed = world == "nyc" or world.startswith("family:")
            there = resolve_world(world) if fixed else World.from_id(world)
        except InputError:
            return

        def once(target: Target, _there: World) -> Iterator[Report]:
            run = explore(there, target, limits=limits)
            self._late = run.limit in ("move-timeout", "world-timeout")
            yield judge(run, where=world, options=limits.options)

        if len(self._exhibits) < self._most and not self._late and claim in CLAIMS:
            for target in targets:
                if (target_title(target.text, world), world) in self._exhibits:
                    continue
                for report in (reports or once)(target, there):
                    if any(finding.claim == claim for finding in report.findings):
                        self.keep(report)
                        return
        who = ",".join(target.text for target in targets)
        self.show(acc.Exhibit(target_title(who, world), there, world, (f"{claim}: {message}",)))

    @property
    def exhibits(self) -> tuple[acc.Exhibit, ...]:
        """The counterexamples for the page."""
        return tuple(self._exhibits.values()) if self._alone else ()

    @property
    def left_out(self) -> int:
        """The number of counterexamples beyond `MOST_EXHIBITS`."""
        return len(self._seen) - len(self._exhibits)

    def blocks(self) -> Iterator[Block]:
        """The walk with its title and its replay command."""
        if self._report is None or not self._people:
            return
        yield Text("")
        yield Text(f"The walk of {self._report.target} in {self._report.world}:")
        yield Text("")
        yield from walk_view(self._report)
        yield Text("")
        replay_command = self._report.findings[0].replay
        if replay_command:
            yield Command(replay_command, "again: ")


def target_title(target: str, world: str) -> str:
    """The title of an exhibit: mapper and world."""
    return f"{target} in {world}"


def _not_found(report: Report) -> tuple[str, ...]:
    """Why the run ended without a map, where that is no finding."""
    stopped = report.run and report.run.stopped
    told = any(finding.event is None for finding in report.findings)
    return () if told or not stopped else (stopped,)


def exhibit_of(report: Report, *others: PlayedRun) -> acc.Exhibit | None:
    """A run with its findings and other runs beside it, or None."""
    if report.run is None:
        return None
    run = PlayedRun(report.target, tuple(report.run.trace), report.judgements, report.run.stopped)
    return acc.Exhibit(
        title=target_title(report.target, report.world),
        world=report.run.world,
        name=report.world,
        notes=(*map(finding_line, report.findings[:OTHERS]), *_not_found(report)),
        runs=(run, *others),
        again=report.findings[0].replay if report.findings else "",
    )
