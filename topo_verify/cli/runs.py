"""What `explore`, `replay` and `verify` share: worlds as the user names them, findings as shown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from io import BytesIO
from itertools import count
from pathlib import Path

import msgspec

from topo_verify.checkers import Finding
from topo_verify.cli.layout import Block, Bullets, Command, Text
from topo_verify.errors import InputError
from topo_verify.harness.run import Exploration, Report, judge, replay_line, undecided
from topo_verify.robot.limits import Limits
from topo_verify.text import plural
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.resolve import world_from
from topo_verify.world.rooted_map import World


@dataclass(frozen=True)
class NamedWorld:
    """A world, and the words of the command line that lead to it.

    Attributes:
        world: with the marker where it was asked for.
        text: the WORLD argument.
        marker: the --marker option, if it was given.
    """

    world: World
    text: str
    marker: int | None = None

    @property
    def name(self) -> str:
        """What results call it: the name in the file, else the id, else the file's stem."""
        if self.world.name:
            return self.world.name
        return self.world.id if self._has_id else "world"

    @property
    def _has_id(self) -> bool:
        return len(self.world.edges) <= MAX_ID_EDGES

    @cached_property
    def argument(self) -> str:
        """A WORLD argument that leads here another time.

        A world from standard input is gone: its id leads to it, or a file that is written now.
        """
        if self.text == "-":
            return self.world.id if self._has_id else _kept(self.world)
        return f"./{self.text}" if self.text.startswith("-") else self.text

    @property
    def options(self) -> tuple[str, ...]:
        """The options that belong to the argument."""
        return () if self.marker is None or self.text == "-" else ("--marker", str(self.marker))


def named_world(text: str, marker: int | None = None, stdin: bytes | None = None) -> NamedWorld:
    """The world that the user names.

    Args:
        stdin: what came from standard input, if it was read already.
    Raises:
        InputError: no such world, no such dart.
    """
    world = world_from(text, stdin=None if stdin is None else BytesIO(stdin))
    if marker is not None:
        named_by_id = world.name == text
        try:
            world = world.with_marker(marker)
        except InputError as error:
            raise InputError(f"--marker {marker} in {text}: {error}") from error
        if named_by_id and not text.startswith("family:"):
            world = replace(world, name="")  # with its marker elsewhere it has another id
    return NamedWorld(world, text, marker)


def named_worlds(texts: Sequence[str], marker: int | None = None) -> list[NamedWorld]:
    """The worlds that the user names, all of them read before anything is done with one."""
    if texts.count("-") > 1:
        raise InputError("the WORLD '-' is given twice: standard input holds one world")
    return [named_world(text, marker) for text in texts]


def _kept(world: World) -> str:
    """The name of a file in the current folder that holds this world; written if there is none."""
    text = world.to_json() + "\n"
    stem = f"world-{sha256(text.encode()).hexdigest()[:12]}"
    for number in count(1):
        path = Path(f"{stem}.json" if number == 1 else f"{stem}-{number}.json")
        if _holds(path, text):
            return str(path)
    raise AssertionError("there are names enough")


def _holds(path: Path, text: str) -> bool:
    """Is this text in the file? If there is no such file, it is made."""
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        return path.is_file() and path.read_bytes() == text.encode()
    except OSError as error:
        raise InputError(
            f"the world from standard input cannot be kept as {path}: {error.strerror}; call this"
            " in a folder that can be written, or name a file as the WORLD"
        ) from error
    return True


# ---------------------------------------------------------------- judging


def judged(
    run: Exploration, at: NamedWorld, limits: Limits, *, strict: bool = False
) -> tuple[Report, bool]:
    """The report on a run, and whether it is incomplete: out of time, and nothing else wrong."""
    report = judge(run, where=at.text, strict=strict)
    if undecided(run, report):
        return msgspec.structs.replace(report, findings=()), True
    if not report.findings:
        return report, False
    words = (*at.options, *limits.options)
    replay_command = replay_line(at.argument, run.algorithm, run.policies, words)
    findings = tuple(
        msgspec.structs.replace(finding, world=at.argument, replay=replay_command)
        for finding in report.findings
    )
    return msgspec.structs.replace(report, findings=findings), False


# ---------------------------------------------------------------- showing


def claims_cell(claims: Mapping[str, str], *, incomplete: bool = False) -> str:
    """How the claims stand, in a word or two."""
    failed = sum(status == "failed" for status in claims.values())
    if incomplete:
        return "out of time"
    return plural(failed, "fails", "fail") if failed else f"{held(claims)} hold"


def held(claims: Mapping[str, str]) -> int:
    """How many claims hold."""
    return sum(status == "ok" for status in claims.values())


def silent(claims: Mapping[str, str]) -> list[str]:
    """The claims that nothing was declared about."""
    return [claim for claim, status in claims.items() if status == "not-declared"]


def undeclared(mapper: str, claims: Iterable[str]) -> str:
    """What was not judged, and why."""
    return f"Not judged, for {mapper} declares nothing on it: {', '.join(claims)}."


def finding_blocks(
    findings: Iterable[Finding], about: str = "", *, shown: int = 5
) -> Iterator[Block]:
    """Findings by the command line that shows them again.

    Args:
        shown: how many findings of a run a person is shown; JSON has them all.
    """
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
    """Claim, event and message."""
    where = "" if finding.event is None else f", event {finding.event}"
    return f"{finding.claim}{where}: {finding.message}"
