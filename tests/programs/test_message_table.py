"""Every message of the protocol in every state: it is allowed there, or a finding says what came.

The lines lie in a file, and `cat` is the program that writes them: topo-verify reads them one by
one and answers each in its turn, so that every line comes at its moment.
"""

from __future__ import annotations

import json
import shlex
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import msgspec
import pytest

from tests.programs.messages import LINES, MESSAGES
from topo_verify import Limits, World
from topo_verify.campaign.campaign import Campaign, ListedWorlds
from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.errors import InputError
from topo_verify.programs import protocol as ms
from topo_verify.programs.foreign import Foreign, Unlisted
from topo_verify.programs.misbehaviour import Misbehaved
from topo_verify.programs.program import Program
from topo_verify.robot.limits import BudgetExceeded
from topo_verify.studies.conform.batch import BatchProgram

EDGE = World.from_id("m1/0")

ENDS = "out-of-turn"
"""What comes of an end of the world where the program goes on."""

OURS = {"move": None, "declare": None, "done": ENDS, "undelivered": ENDS}
"""What our own child may say in a world, and what comes of it."""

THEIRS = {"move": None, "declare": None, "done": ENDS, "skip": ENDS, "error": ENDS}
"""What any other program may say in a world."""

BEFORE: dict[str, tuple[str, ...]] = {
    "before a move": (),
    "after a move": ("move",),
    "after a decision": ("move", "declare"),
}
"""What was written in a world before the line that is tried."""


def test_the_table_has_a_message_of_every_type() -> None:
    names = [name for name in dir(ms) if name.endswith("Message") and not name.startswith("_")]
    by_type = {name.removesuffix("Message").lower(): getattr(ms, name) for name in names}
    assert by_type.keys() == MESSAGES.keys() - {"teleport", "nothing", "run"}
    for name, kind in by_type.items():
        msgspec.json.decode(json.dumps(MESSAGES[name]), type=kind)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder."""
    if shutil.which("cat") is None:
        pytest.skip("no cat here")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def written(*lines: str) -> tuple[str, ...]:
    """The command of a program that writes these lines and ends."""
    Path("lines").write_bytes(b"".join(LINES[line] for line in lines))
    return ("cat", "lines")


@pytest.fixture
def child() -> Iterator[Foreign]:
    """A child of ours, whose mapper writes what the file `lines` holds."""
    with Foreign("mine.py:explore") as foreign:
        foreign.command = written()
        yield foreign


@pytest.fixture
def program() -> Iterator[Program]:
    """Another program that writes what the file `lines` holds."""
    with Program(written()) as found:
        yield found


def kind(player: Program, *lines: str) -> str | None:
    """What a program that writes these lines does in place of a map; it is a finding."""
    written(*lines)
    run = explore(EDGE, player.target)
    if run.misbehaved is None:
        assert run.map is not None
        return None
    assert str(run.misbehaved) in judge(run).findings[0].message
    return run.misbehaved.kind


def expected(allowed: dict[str, str | None]) -> dict[str, str | None]:
    """What becomes of each line in a state where these messages are allowed."""
    broken = {"no JSON": "not-json", "not UTF-8": "not-utf8", "nested": "nested"}
    untyped = {"nothing": "malformed", "run": "malformed"}
    return {**dict.fromkeys(LINES, "unknown-type"), **broken, **untyped, **allowed}


# ---------------------------------------------------------------- in a world


@pytest.mark.parametrize("state", BEFORE)
def test_in_a_world_every_line_is_allowed_or_a_finding(
    child: Foreign, program: Program, state: str
) -> None:
    before = BEFORE[state]
    ours = {name: kind(child, "ready", *before, name, "done") for name in LINES}
    assert ours == expected(OURS)
    theirs = {name: kind(program, *before, name, "done") for name in LINES}
    assert theirs == expected(THEIRS)


@pytest.mark.parametrize("end", ["done", "undelivered"])
def test_after_a_world_every_line_of_our_child_is_out_of_turn(child: Foreign, end: str) -> None:
    assert {kind(child, "ready", "move", end, name) for name in LINES} == {"out-of-turn"}


@pytest.mark.parametrize("end", ["done", "skip", "error"])
def test_after_a_world_every_line_of_a_program_is_out_of_turn(program: Program, end: str) -> None:
    assert {kind(program, "move", end, name) for name in LINES} == {"out-of-turn"}


def test_a_world_that_is_over_stays_what_it_is_whatever_our_child_writes(child: Foreign) -> None:
    for name in LINES:
        written("ready", "move", "move", name, "undelivered", "done")
        run = explore(EDGE, child.target, limits=Limits(budget=1))
        assert (run.stopped, run.cost) == (str(BudgetExceeded(1)), 1), name


# ---------------------------------------------------------------- outside of a world


def refusals(child: Foreign, ask: Callable[[], object], *before: str) -> dict[str, str]:
    """How each line is refused as the answer to what is asked; those that are not are left out."""
    told: dict[str, str] = {}
    for name in sorted(LINES, key="ready".__eq__):  # once loaded, it is not refused any more
        written(*before, name)
        try:
            ask()
        except InputError as error:
            told[name] = str(error)
        child.close()
    return told


@pytest.mark.long
def test_while_a_mapper_is_loaded_every_line_but_one_is_bad_input(child: Foreign) -> None:
    told = refusals(child, child.start)
    assert told.keys() == LINES.keys() - {"ready"}
    assert told.pop("refused") == "no such mapper"
    assert all(text.startswith("target 'mine.py:explore': ") for text in told.values())


@pytest.mark.long
def test_between_worlds_every_line_but_what_is_loaded_is_unlisted(child: Foreign) -> None:
    told = refusals(child, child.loaded, "ready")
    assert told.keys() == LINES.keys() - {"loaded"}
    assert all(text.startswith("target 'mine.py:explore': ") for text in told.values())


def test_a_child_that_ends_in_place_of_an_answer_is_told_by_what_it_had_yet_to_do(
    child: Foreign,
) -> None:
    with pytest.raises(InputError, match="ended with exit code 0 before it was loaded"):
        child.start()
    written("ready")
    with pytest.raises(Unlisted, match="ended with exit code 0 before it said what it had loaded"):
        child.loaded()


# ---------------------------------------------------------------- batch


def batch_answer(program: BatchProgram, *lines: str) -> str | None:
    """The kind of what a program that writes these lines answers to a batch of one world."""
    written(*lines)
    answer = program.answers([("m1/0", World.from_id("m1/0"))])[0]
    return answer.kind if isinstance(answer, Misbehaved) else None


def test_in_a_batch_every_line_but_a_run_is_a_finding() -> None:
    mapper = f"--cmd {shlex.join(written())}"
    with BatchProgram(Campaign(worlds=ListedWorlds(1), mappers=(mapper,))) as program:
        first = {name: batch_answer(program, name) for name in LINES}
        last = {batch_answer(program, "run", name) for name in LINES}
    by_its_type = expected({"run": None})
    # A run has no type, so the field counts as unknown and the run lacks its fields.
    assert first == {
        name: "malformed" if why == "unknown-type" else why for name, why in by_its_type.items()
    }
    assert last == {"unknown-world"}
