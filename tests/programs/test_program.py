"""A program behind protocol 1: one process for many worlds, judged as any mapper."""

# pyright: reportPrivateUsage=false

from __future__ import annotations

import os
import shlex
import signal
import sys
import threading
import time
import weakref
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from itertools import islice
from pathlib import Path

import pytest

from tests.faults.every import EVERY
from tests.helpers import some, worlds
from tests.processes import alive, gone
from tests.programs.programs import ROOT, misbehaving, python, served
from tests.python import python as ran
from topo_verify import World, examine, explore
from topo_verify.campaign.run import HUNG
from topo_verify.campaign.targets import target_arguments, target_text, targets
from topo_verify.errors import InputError
from topo_verify.programs.child import Child, ReaperProcess, Silent
from topo_verify.programs.misbehaviour import Misbehaved
from topo_verify.programs.program import Program
from topo_verify.robot.events import Move
from topo_verify.robot.limits import Limits
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.robot.stopwatch import Stopwatch

TELLS = """
import json, os, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "stop":
        open("stopped", "w").write(str(os.getpid()))
        break
    print(json.dumps({"type": "move", "door": 0}), flush=True)
    sys.stdin.readline()
    if os.path.exists("extra"):
        print(open("extra").read(), flush=True)
        continue
    print(json.dumps({"type": "error", "why": str(os.getpid())}), flush=True)
"""
"""A program that gives every world up, telling its process; at the end it says that it was told."""

PROCESSORS = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else None
"""Where this thread may run, as read before any test plays a world."""


EDGE = World.from_id("m1/0")


def program(target: str, **more: bool) -> Program:
    return Program(target.removeprefix("--cmd "), **more)


@pytest.fixture
def tells(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    return python("-c", TELLS)


def said(player: Program) -> str:
    """What the program says when it gives the world up."""
    run = explore(EDGE, player.target)
    assert run.map is None
    return str(player.misbehaved)


# ---------------------------------------------------------------- as in Python


@pytest.mark.long
def test_through_the_pipe_every_run_is_the_same_as_in_process() -> None:
    for name in ("basic", "enhancement-iii-all+i", "folding"):
        with program(served(name)) as player:
            for world in worlds(range(1, 4)):
                inside, outside = explore(world, name), explore(world, player.target)
                assert outside.map == inside.map
                assert outside.cost == inside.cost
                assert _aimless(outside.trace) == _aimless(inside.trace)


def _aimless(trace: tuple[object, ...]) -> list[object]:
    """The trace without what moves are for, which no message says, and without its head."""
    return [
        (event.door, event.percept) if isinstance(event, Move) else event for event in trace[1:]
    ]


def test_the_world_without_a_dart_is_played_too() -> None:
    with program(served("basic")) as player:
        assert examine(player.target, World((), (), None)).ok


REACHES = "takes-back-two-moves"
"""The fault that changes the trace: behind a pipe it finds none."""


def test_behind_the_pipe_no_mapper_changes_its_trace() -> None:
    inside = examine(EVERY[REACHES], EDGE)
    assert inside.findings[0].message.startswith("the robot made 3 moves and the trace holds 1")
    with program(served(EVERY[REACHES].target)) as player:
        outside = explore(EDGE, player.target)
    assert sum(isinstance(event, Move) for event in outside.trace) == outside.cost == 3


def differences(name: str, tried: Iterable[World], limits: Limits) -> list[str]:
    """The worlds in which a seeded fault is not found through the pipe just as in process."""
    fault = EVERY[name]
    found: list[str] = []
    with program(served(fault.target)) as player:
        for world in tried:
            inside = examine(fault, world, limits=limits)
            outside = examine(player.target, world, limits=limits)
            told = [[(f.claim, f.event) for f in one.findings] for one in (inside, outside)]
            if outside.claims != inside.claims or told[0] != told[1]:
                found.append(world.id)
    return found


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in EVERY if name != REACHES])
def test_a_seeded_fault_is_found_through_the_pipe_just_as_in_process(name: str) -> None:
    limits = Limits(budget=60)
    wrong = (w for w in worlds(range(1, 4)) if not examine(EVERY[name], w, limits=limits).ok)
    tried = [EDGE, *islice(wrong, 2), World.from_id("m3/73")]
    assert not differences(name, tried, limits)


@pytest.mark.nightly
@pytest.mark.parametrize("name", [name for name in EVERY if name != REACHES])
def test_so_it_is_in_every_world_of_three_and_four_edges(name: str) -> None:
    assert not differences(name, worlds([3, 4]), Limits(budget=200))


# ---------------------------------------------------------------- one process, many worlds


def test_one_process_plays_many_worlds(tells: str) -> None:
    with program(tells) as player:
        assert len({said(player) for _ in range(5)}) == 1


def test_a_fresh_process_plays_after_a_failed_world(tells: str) -> None:
    with program(tells) as player:
        first = said(player)
        Path("extra").write_text("garbage")
        explore(EDGE, player.target)
        assert some(player.misbehaved).kind == "not-json"
        Path("extra").unlink()
        assert said(player) != first


def test_at_the_end_the_program_is_told_to_stop(tells: str) -> None:
    with program(tells) as player:
        process = said(player).split()[-1]
    assert Path("stopped").read_text() == process


def test_a_program_that_does_not_stop_is_ended() -> None:
    loop = 'import sys, time\nfor line in sys.stdin: print(\'{"type": "skip"}\', flush=True)\n'
    player = program(python("-c", loop + "time.sleep(60)"))
    explore(EDGE, player.target)
    player.close()  # or this test takes a minute


def test_limits_hold_in_other_threads_too() -> None:
    stopped: list[str | None] = []

    def play() -> None:
        with program(misbehaving("hangs")) as player:
            limits = Limits(move_timeout=0.5)
            stopped.append(explore(World.from_id("m1/1"), player.target, limits=limits).stopped)

    thread = threading.Thread(target=play)
    thread.start()
    thread.join(30)
    assert stopped == [f"the mapper did not move for 0.5 s; {HUNG}"]


def test_a_map_that_was_not_flushed_is_among_the_causes() -> None:
    lines = (
        "import sys, time",
        "input()",
        'print(\'{"type": "move", "door": 0}\', flush=True)',
        "input()",
        'sys.stdout.write(\'{"type": "done"\')',
        "time.sleep(60)",
    )
    with program(python("-c", "\n".join(lines))) as player:
        stopped = explore(EDGE, player.target, limits=Limits(move_timeout=0.5)).stopped
    assert "not flushed" in some(stopped)


KILLED = """
import os, signal, sys
from topo_verify import World, explore
from topo_verify.programs.program import Program
player = Program(sys.argv[1])
explore(World.from_id("m1/0"), player.target)
print(str(player.misbehaved).split()[-1], flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no /proc here")
def test_a_harness_that_is_killed_leaves_no_program_behind(tells: str) -> None:
    deaf = "import time\n" + TELLS.replace("for line in sys.stdin", "for line in [input()]")
    command = shlex.join([sys.executable, "-c", deaf + "sys.stdin.readline()\ntime.sleep(60)\n"])
    assert command not in tells
    done = ran("-c", KILLED, command)
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert gone(int(done.stdout))


def test_a_program_object_that_is_forgotten_ends_its_program(tells: str) -> None:
    player = program(tells)
    process = int(said(player).split()[-1])
    assert alive(process)
    del player
    assert gone(process)


def test_it_is_forgotten_at_once_though_its_program_misbehaved(tells: str) -> None:
    player = program(tells)
    Path("extra").write_text("garbage")
    explore(EDGE, player.target)
    assert player.misbehaved is not None
    known = weakref.ref(player)
    del player
    assert known() is None


@pytest.mark.parametrize("by", ["Popen", "the caller"])
def test_a_process_that_was_reaped_elsewhere_is_closed_in_silence(tells: str, by: str) -> None:
    """In a circle of references `Popen.__del__` may run first, and reaps a process that crashed."""
    player = program(tells)
    player.start()
    child = some(player._child)
    os.kill(child.process, signal.SIGSEGV)
    os.waitid(os.P_PID, child.process, os.WEXITED | os.WNOWAIT)
    if by == "Popen":
        with pytest.warns(ResourceWarning):
            child._process.__del__()
    else:
        os.waitpid(child.process, 0)
    assert child.exit_status() is not None
    assert (child.signal() == "SIGSEGV") == (by == "Popen")
    player.close()
    assert player.process is None


def test_a_text_names_a_program_in_python_too(tells: str) -> None:
    run = explore(EDGE, tells)
    assert run.algorithm == tells
    process = int(str(run.stopped).split()[-1])
    assert alive(process)
    del run
    assert gone(process)
    assert examine(served("basic"), World.from_id("m3/14")).ok


# ---------------------------------------------------------------- --validate


@pytest.mark.parametrize(
    ("line", "kind"),
    [
        ('{"type": "move", "door": 0, "dor": 1}', "unknown-field"),
        ('{"type": "move", "door": 5, "door": 0}', "doubled-field"),
    ],
)
def test_validate_refuses_what_the_protocol_passes_over(tells: str, line: str, kind: str) -> None:
    Path("extra").write_text(line)
    with program(tells, validate=True) as player:
        explore(EDGE, player.target, limits=Limits(budget=50))
        assert player.misbehaved is not None
        assert player.misbehaved.kind == kind
        assert line in str(player.misbehaved)
    with program(tells) as player:
        assert explore(EDGE, player.target, limits=Limits(budget=50, move_timeout=1)).cost > 1


def test_a_right_program_passes_with_validate() -> None:
    with program(served("enhancement-iii-all"), validate=True) as player:
        assert examine(player.target, World.from_id("m4/41")).ok


# ---------------------------------------------------------------- what it is called


def test_a_program_is_named_by_its_command() -> None:
    (target,) = targets("--cmd './my mapper' --fast")
    assert isinstance(target.mapper, Program)
    assert target.mapper.command == ("./my mapper", "--fast")
    assert target.text == "--cmd './my mapper' --fast"
    assert target_arguments(target.text) == ("--cmd", "'./my mapper' --fast")
    assert [found.text for found in targets("basic,folding")] == ["basic", "folding"]
    assert target_arguments("basic") == ("basic",)


def test_one_target_is_named_and_not_two() -> None:
    assert target_text("basic", None) == "basic"
    assert target_text(None, "./mapper  --fast") == "--cmd ./mapper --fast"
    for target, command in ((None, None), ("basic", "./mapper")):
        with pytest.raises(InputError, match="one of them"):
            target_text(target, command)


@pytest.mark.parametrize(("command", "why"), [("", "name a program"), ("a 'b", "quote")])
def test_a_command_that_is_none_is_refused(command: str, why: str) -> None:
    with pytest.raises(InputError, match=why):
        Program(command)


def test_a_program_that_cannot_be_started_is_bad_input(tmp_path: Path) -> None:
    text = tmp_path / "text"
    text.write_text("no program")
    for command in (str(tmp_path / "nowhere"), str(text)):
        player = Program([command])
        with pytest.raises(InputError, match="cannot start"):
            player.start()


def test_misbehaviour_is_an_exception_that_a_mapper_cannot_swallow() -> None:
    assert not issubclass(Misbehaved, Exception)


# ---------------------------------------------------------------- serve


def test_serve_says_what_is_wrong_with_its_argument() -> None:
    for arguments, words_ in (([], "usage"), (["no-such"], "no attribute 'NAMED.no-such'")):
        done = ran("-m", "topo_verify.programs.serve", *arguments, cwd=ROOT)
        assert done.returncode == 1
        assert words_ in done.stderr


def test_what_a_served_mapper_prints_is_no_message(tmp_path: Path) -> None:
    (tmp_path / "chatty.py").write_text(
        "import topo_verify as tv\n"
        "def explore(robot):\n"
        "    print('hello')\n"
        "    return tv.CATALOGUE['basic'](robot)\n"
    )
    with program(served(f"{tmp_path}/chatty.py:explore")) as player:
        assert examine(player.target, World.from_id("m3/14")).ok


def test_the_thread_that_plays_may_run_everywhere_again_after_a_world() -> None:
    if PROCESSORS is None:
        pytest.skip("this system does not keep a thread on a processor")
    with program(served("basic")) as mapper:
        for world in ("m2/0", "m3/14"):
            assert explore(World.from_id(world), mapper.target).map is not None
            assert os.sched_getaffinity(0) == PROCESSORS


@contextmanager
def running(code: str) -> Generator[Child]:
    """A child that runs this Python code; it is ended at the end of the block."""
    reaper = ReaperProcess()
    child = Child([sys.executable, "-c", code], reaper)
    try:
        yield child
    finally:
        child.end()
        reaper.close()


class StandsStill(Stopwatch):
    """The stopwatch of a program that waits for a processor all the time."""

    def seconds(self) -> float:
        return 0.0


def test_a_program_that_dies_slowly_on_a_busy_machine_has_crashed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("topo_verify.programs.child.Stopwatch", StandsStill)
    monkeypatch.setattr("topo_verify.programs.child.LAST_WORDS", 0.01)
    dies = "import os, time\nos.close(1)\ntime.sleep(0.3)\nos._exit(3)"
    with pytest.raises(Misbehaved, match="ended with exit code 3 before it delivered a map"):
        program(python("-c", dies))(SimulatedRobot(World.from_id("m1/0"), 9))


def test_a_time_in_which_the_harness_did_not_run_is_no_silence_of_a_program(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    began = time.monotonic()

    def frozen() -> float:
        """The clock of a machine that stood still for an hour."""
        now = time.monotonic()
        return now if now < began + 0.2 else now + 3600

    monkeypatch.setattr("topo_verify.robot.stopwatch.monotonic", frozen)
    with running("import time; time.sleep(0.5); print('yes')") as program:
        assert program.line(seconds=60) == b"yes"


def test_a_program_that_sleeps_is_not_looked_at_in_vain_while_others_want_the_processor(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A stopwatch excuses what we wait for a processor: looking would give the program time."""
    looks: list[float] = []

    def busy() -> None:
        looks.append(0.002)
        time.sleep(0.002)

    with running("import time; time.sleep(60)") as program:
        with pytest.raises(Silent):
            program.line(seconds=0.3)  # alone on its processor, it is looked at all the time
        monkeypatch.setattr("os.sched_yield", busy)
        with pytest.raises(Silent):
            program.line(seconds=0.3)
    assert len(looks) < 50
