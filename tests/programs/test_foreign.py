"""A Python mapper in a process of its own: judged as in this one, and kept from what judges it."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import NoReturn

import pytest

from tests.helpers import some, worlds
from tests.processes import alive, gone
from tests.studies.search.searching import search_of
from topo_verify import Limits, World, examine, explore
from topo_verify.campaign.targets import one_target, start, targets
from topo_verify.errors import InputError
from topo_verify.programs.foreign import Foreign, Unlisted
from topo_verify.programs.loader import Target
from topo_verify.programs.misbehaviour import Misbehaved
from topo_verify.programs.program import Program
from topo_verify.robot.events import Robot

WORLD = World.from_id("m3/14")

MAPPERS = """
import asyncio, io, json, os, signal, sys, time
import topo_verify as tv

basic = tv.CATALOGUE["basic"]

def explore(robot):
    return basic(robot)

def chats(robot):
    print("by print")
    sys.stderr.write("on stderr\\n")
    os.write(1, b"by hand\\n")
    return basic(robot)

def fails(robot):
    raise ValueError("boom")

def fails_and_reads_no_more(robot):
    def told(_frame, event, function):
        written = event == "c_return" and function.__name__ == "flush"
        if written and isinstance(function.__self__, io.BufferedWriter):
            time.sleep(60)

    sys.setprofile(told)
    raise ValueError("boom")

def cancels(robot):
    raise asyncio.CancelledError

def interrupts(robot):
    raise KeyboardInterrupt("mine")

def generates(robot):
    raise GeneratorExit

def parsed(text):
    return json.loads(text)

def parses(robot):
    return parsed("{")

def exits(robot):
    os._exit(3)

def crashes(robot):
    os.kill(os.getpid(), signal.SIGSEGV)

def own_alarm(robot):
    signal.signal(signal.SIGALRM, lambda *_: None)
    signal.setitimer(signal.ITIMER_REAL, 0.01, 0.01)
    while True:
        time.sleep(0.01)

def debugs(robot):
    breakpoint()
    return basic(robot)

def waits(robot):
    time.sleep(60)

def swallows(robot):
    while True:
        try:
            robot.move(99)
        except BaseException:
            pass

def no_door(robot):
    robot.move("left")

def no_purpose(robot):
    robot.move(0, "fun")

def no_decision(robot):
    robot.declare({"type": "pose", "edge": "e"})
    robot.move(0)

def no_json(robot):
    robot.declare({"type": object()})

def no_map(robot):
    return 7

def huge(robot):
    return {"vertices": [[2**70]], "edges": [], "marker": None}

def unreadable(robot):
    class Lazy:
        @property
        def vertices(self):
            raise KeyError("later")
    return Lazy()

def degree(robot):
    return robot.degree

def looks(robot):
    names = sorted(name for name in dir(robot) if not name.startswith("_"))
    raise LookupError(f"{names} events={hasattr(robot.move.__self__, 'events')}")

def reads(robot):
    with open("data.txt") as file:
        assert file.read()
    return basic(robot)
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with the mappers."""
    (tmp_path / "mine.py").write_text(MAPPERS)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    return tmp_path


def why(name: str, *, limits: Limits | None = None, in_process: bool = False) -> str | None:
    """Why a mapper delivers no map."""
    target = one_target(f"mine.py:{name}", in_process=in_process)
    return explore(WORLD, target, limits=limits).stopped


# ---------------------------------------------------------------- as in this process


def test_a_run_in_a_child_is_the_run_in_this_process() -> None:
    with Foreign("mine.py:explore") as mapper:
        for world in worlds([1, 2]):
            inside, outside = explore(world, "basic"), explore(world, mapper.target)
            assert outside.trace[1:] == inside.trace[1:]  # with the purposes of the moves
            assert examine(mapper.target, world).ok


WAYS = (
    "fails cancels generates no_door no_purpose no_decision no_json no_map huge unreadable swallows"
)


@pytest.mark.parametrize("name", WAYS.split())
def test_what_keeps_it_from_a_map_is_said_in_the_same_words(name: str) -> None:
    limits = Limits(budget=3)
    if name == "swallows":  # in this process nothing but the clock stops it
        hung = str(why(name, limits=Limits(move_timeout=0.3)))
        assert hung.startswith("the mapper did not move for 0.3 s; it was at mine.py, line ")
        return
    told = why(name, limits=limits)
    assert told == why(name, limits=limits, in_process=True)
    assert told


@pytest.mark.parametrize(
    ("name", "error"),
    [
        ("fails", "ValueError: boom"),
        ("cancels", "CancelledError"),
        ("interrupts", "KeyboardInterrupt: mine"),
        ("generates", "GeneratorExit"),
        ("degree", "AttributeError: the robot has percept, move and declare, but no 'degree'"),
    ],
)
def test_every_exception_is_told_with_its_line(folder: Path, name: str, error: str) -> None:
    lines = (folder / "mine.py").read_text().splitlines()
    line = lines.index(f"def {name}(robot):") + 2
    assert why(name) == f"the mapper raised {error} (mine.py, line {line})"


def test_a_debugger_without_an_input_names_the_options_that_give_it_one() -> None:
    told = str(why("debugs"))
    assert told.startswith("the mapper raised BdbQuit (mine.py, line ")
    assert told.endswith("; a debugger needs --in-process --move-timeout 9999 --world-timeout 9999")


def test_the_line_is_the_innermost_one_of_the_users_own_files(folder: Path) -> None:
    line = (folder / "mine.py").read_text().splitlines().index("    return json.loads(text)") + 1
    told = str(why("parses"))
    assert told.startswith("the mapper raised JSONDecodeError: ")
    assert told.endswith(f" (mine.py, line {line})")


def test_a_child_that_dies_names_the_signal_and_the_line(folder: Path) -> None:
    line = (folder / "mine.py").read_text().splitlines().index("def crashes(robot):") + 2
    with Foreign("mine.py:crashes") as mapper:
        run = explore(WORLD, mapper.target)
        assert run.misbehaved is not None
        assert (run.misbehaved.kind, run.misbehaved.signal) == ("crashed", "SIGSEGV")
        assert run.stopped == f"the mapper was ended by SIGSEGV at mine.py, line {line}"
        assert not explore(WORLD, mapper.target).map  # by a fresh process
    assert str(why("exits")).startswith("the program ended with exit code 3")


@pytest.mark.parametrize("in_process", [False, True])
def test_the_line_of_a_hang_is_told(folder: Path, in_process: bool) -> None:
    limits = Limits(move_timeout=0.3)
    line = (folder / "mine.py").read_text().splitlines().index("def waits(robot):") + 2
    told = why("waits", limits=limits, in_process=in_process)
    assert told == f"the mapper did not move for 0.3 s; it was at mine.py, line {line}"


@pytest.mark.parametrize("in_process", [False, True])
@pytest.mark.parametrize("name", ["no_door", "no_purpose", "no_decision", "no_json"])
def test_the_line_of_a_misuse_is_told(folder: Path, name: str, in_process: bool) -> None:
    line = (folder / "mine.py").read_text().splitlines().index(f"def {name}(robot):") + 2
    told = some(why(name, in_process=in_process))
    assert told.endswith(f"; it was at mine.py, line {line}")


def test_the_clock_ends_a_mapper_that_uses_the_alarm_itself() -> None:
    told = str(why("own_alarm", limits=Limits(move_timeout=0.3)))
    assert told.startswith("the mapper did not move for 0.3 s; it was at mine.py, line ")


# ---------------------------------------------------------------- what it is given


@pytest.mark.parametrize("in_process", [False, True])
def test_a_mapper_gets_percept_move_and_declare(*, in_process: bool) -> None:
    told = str(why("looks", in_process=in_process))
    assert "['declare', 'move', 'percept']" in told or "'misuse'" in told
    assert f"events={in_process}" in told


def test_what_it_prints_is_marked_on_our_standard_error(capfd: pytest.CaptureFixture[str]) -> None:
    with Foreign("mine.py:chats") as mapper:
        assert examine(mapper.target, WORLD).ok
    out, err = capfd.readouterr()
    assert out == ""
    marked = {f"mine.py:chats: {words}" for words in ("by print", "on stderr", "by hand")}
    assert set(err.splitlines()) == marked


def test_a_fatal_error_is_copied_once(capfd: pytest.CaptureFixture[str], folder: Path) -> None:
    (folder / "once.py").write_text(MAPPERS)
    for _ in range(2):
        with Foreign("once.py:crashes") as mapper:
            assert explore(WORLD, mapper.target).misbehaved
    assert capfd.readouterr().err.count("Fatal Python error: ") == 1


def test_loaded_names_the_files_that_it_imported_and_read(folder: Path) -> None:
    (folder / "data.txt").write_text("1")
    (folder / "helper.py").write_text("")
    (folder / "mine.py").write_text("import helper, msgspec\n" + MAPPERS)
    with Foreign("mine.py:reads") as mapper:
        before = mapper.loaded()
        assert {Path(path).name for path in before.files} == {"mine.py", "helper.py"}
        assert "msgspec" in before.distributions
        assert explore(WORLD, mapper.target).map
        after = mapper.loaded()
    assert {Path(path).name for path in after.files} == {"mine.py", "helper.py", "data.txt"}
    assert {len(digest) for digest in after.files.values()} == {64}


# ---------------------------------------------------------------- its process


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("mine.py:nope", "mine.py has no attribute 'nope'"),
        ("there.py:explore", "there is no file 'there.py'"),
        ("no.such.module:explore", "cannot import 'no.such.module'"),
        ("mine.py:sys", "expected a callable that takes a robot, got module"),
    ],
)
def test_a_text_that_names_no_mapper_is_refused_at_once(text: str, words: str) -> None:
    with pytest.raises(InputError, match="target ") as refused:
        start(targets(text, in_process=False))
    assert words in str(refused.value)


def test_a_mapper_that_ends_its_process_while_it_is_loaded_is_bad_input(folder: Path) -> None:
    (folder / "ends.py").write_text("import os\nos._exit(4)\n")
    with pytest.raises(InputError, match="its process ended with exit code 4 before it was loaded"):
        start(targets("ends.py:explore", in_process=False))


def test_a_mapper_that_cannot_be_loaded_again_fails_in_that_world(folder: Path) -> None:
    (folder / "once.py").write_text(
        "import os\nfirst = not os.path.exists('ran')\nopen('ran', 'w').close()\n"
        "def explore(robot):\n    os._exit(3)\nassert first"
    )
    with Foreign("once.py:explore") as mapper:
        told = [str(explore(WORLD, mapper.target).stopped) for _ in range(3)]
        assert told[0].startswith("the program ended with exit code 3")
        assert "'once.py' fails: AssertionError" in told[1]
        assert told[1] == told[2]
        with pytest.raises(Unlisted, match=r"'once\.py' fails: AssertionError"):
            mapper.loaded()


def test_a_name_of_the_catalogue_needs_no_process() -> None:
    assert not isinstance(one_target("basic", in_process=False).mapper, Program)


def test_a_failure_that_was_told_stands_though_the_child_does_not_read_on() -> None:
    with Foreign("mine.py:fails_and_reads_no_more") as mapper:
        report = examine(mapper.target, WORLD, limits=Limits(move_timeout=0.3, world_timeout=0.3))
    assert not report.ok
    assert "boom" in report.findings[0].message


def test_one_process_plays_all_worlds_though_a_mapper_raises(folder: Path) -> None:
    (folder / "once.py").write_text(
        "import os\ndef explore(robot):\n    raise OSError(os.getpid())"
    )
    with Foreign("once.py:explore") as mapper:
        assert len({explore(WORLD, mapper.target).stopped for _ in range(3)}) == 1
        assert str(os.getpid()) not in str(explore(WORLD, mapper.target).stopped)


INTERRUPTED = """
import itertools, os, sys
import topo_verify as tv

worlds, turns = itertools.count(), itertools.count()
basic = tv.CATALOGUE["basic"]

def descends(robot):
    sys.setrecursionlimit(200)
    def walk():
        robot.move(0)
        walk()
    def padded(frames):
        padded(frames - 1) if frames else walk()
    padded(next(worlds) % 16)

POINTS = [("call", "write"), ("return", "write"), ("call", "flush"), ("return", "flush"),
          ("call", "readline"), ("return", "readline"), ("call", "decode"), ("return", "decode")]

def interrupted(robot):
    event, name = POINTS[next(worlds) % len(POINTS)]
    def strike(_frame, seen, function):
        if seen == f"c_{event}" and function.__name__ == name:
            sys.setprofile(None)
            raise ValueError(f"{event} of {name}")
    robot.move(0)
    sys.setprofile(strike)
    robot.move(0)

def goes_on(robot):
    try:
        interrupted(robot)
    except ValueError:
        pass
    return basic(robot)

def right(robot):
    return (interrupted if next(turns) % 2 else basic)(robot)
"""


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("descends", "the mapper raised RecursionError"),
        ("interrupted", "the mapper raised ValueError"),
        ("goes_on", "an exception interrupted robot.move: the robot does not go on"),
    ],
)
@pytest.mark.parametrize("fresh", [False, True])
def test_an_exception_in_the_middle_of_a_move_ends_that_world_and_no_other(
    folder: Path, name: str, why: str, *, fresh: bool
) -> None:
    (folder / "struck.py").write_text(INTERRUPTED)
    with Foreign(f"struck.py:{name}", fresh=fresh) as mapper:
        processes: set[int | None] = set()
        for _ in range(16):
            run = explore(WORLD, mapper.target, limits=Limits(budget=1000))
            assert str(run.stopped).startswith(why)
            assert some(run.misbehaved).kind == "no-map"
            processes.add(mapper.process)
        assert len(processes) == 1
        if not fresh:
            assert {Path(path).name for path in mapper.loaded().files} == {"struck.py"}


def test_the_world_after_an_interrupted_move_is_judged_like_any_other(folder: Path) -> None:
    (folder / "struck.py").write_text(INTERRUPTED)
    with Foreign("struck.py:right") as mapper:
        runs = [explore(WORLD, mapper.target) for _ in range(16)]
    assert [run.map is not None for run in runs] == [True, False] * 8
    assert {run.trace[1:] for run in runs[::2]} == {explore(WORLD, "basic").trace[1:]}


STOPPED = """
import os

def noted(name):
    with open("processes", "a") as file:
        file.write(f"{name} {os.getpid()} {os.getppid()}\\n")

def walks(robot):
    noted("walks")
    while True:
        robot.move(0)

def clings(robot):
    noted("clings")
    try:
        walks(robot)
    finally:
        robot.move(0)

def delivers(robot):
    noted("delivers")
    try:
        walks(robot)
    except BaseException:
        return {"vertices": [[]], "edges": [], "marker": None}

def declares_nonsense(robot):
    noted("declares_nonsense")
    robot.declare({"type": "pose", "edge": "e"})
    robot.move(0)

def declares_and_delivers(robot):
    noted("declares_and_delivers")
    robot.declare({"type": "pose", "edge": "e"})
    return {"vertices": [[]], "edges": [], "marker": None}

def stays(robot):
    noted("stays")
    while True:
        try:
            robot.move(0)
        except BaseException:
            pass
"""


def processes(folder: Path, name: str, *, fresh: bool = False) -> tuple[set[str], set[str]]:
    """The processes that played three worlds until the robot stopped, and their parents."""
    (folder / "stopped.py").write_text(STOPPED)
    with Foreign(f"stopped.py:{name}", fresh=fresh) as mapper:
        runs = [explore(WORLD, mapper.target, limits=Limits(budget=7)) for _ in range(3)]
    assert {(run.stopped, run.cost) for run in runs} == {(runs[0].stopped, runs[0].cost)}
    assert runs[0].cost == (0 if "declares" in name else 7)
    assert runs[0].stopped
    assert ("7 moves" in runs[0].stopped) == (runs[0].cost == 7)
    rows = [row.split() for row in (folder / "processes").read_text().splitlines()]
    mine = [row for row in rows if row[0] == name]
    assert len(mine) == 3
    return {own for _, own, _ in mine}, {parent for _, _, parent in mine}


@pytest.mark.parametrize(
    "name", ["walks", "clings", "delivers", "declares_nonsense", "declares_and_delivers"]
)
def test_one_process_plays_all_worlds_though_the_robot_stops(folder: Path, name: str) -> None:
    assert len(processes(folder, name)[0]) == 1


@pytest.mark.long
def test_a_mapper_that_does_not_come_back_is_ended(folder: Path) -> None:
    assert len(processes(folder, "stays")[0]) == 3


@pytest.mark.parametrize("name", ["walks", "declares_and_delivers"])
def test_each_world_has_a_process_of_its_own_though_the_robot_stops(
    folder: Path, name: str
) -> None:
    own, parents = processes(folder, name, fresh=True)
    assert (len(own), len(parents)) == (3, 1)


@pytest.mark.parametrize(
    ("begin", "once", "loadings"), [("0", False, 1), ("thread.start()", False, 3), ("0", True, 3)]
)
def test_a_fresh_process_has_loaded_the_mapper_and_run_no_world(
    folder: Path, begin: str, loadings: int, *, once: bool
) -> None:
    """A mapper with threads, which no fork would have, is loaded anew for each world."""
    (folder / "loads.py").write_text(
        "import threading, time\n"
        "with open('loadings', 'a') as file: file.write('.')\n"
        "thread = threading.Thread(target=time.sleep, args=(60,), daemon=True)\n"
        f"{begin}\n"
        "worlds = []\n"
        "def explore(robot):\n"
        "    worlds.append(1)\n"
        f"    assert thread.is_alive() == {begin != '0'}\n"
        "    raise OSError(len(worlds))\n"
    )
    with Foreign("loads.py:explore", fresh=True, once=once) as mapper:
        stopped = [str(explore(WORLD, mapper.target).stopped) for _ in range(3)]
    assert [text.partition(" (")[0] for text in stopped] == ["the mapper raised OSError: 1"] * 3
    assert len((folder / "loadings").read_text()) == loadings


def test_its_process_ends_with_the_last_object_that_uses_it(folder: Path) -> None:
    text = "import os\ndef explore(robot):\n    raise OSError(os.getpid())\n"
    (folder / "tells.py").write_text(text)
    target = one_target("tells.py:explore", in_process=False)
    study = search_of(target, edges=1, in_process=False)
    study.work()
    failure = some(study.entry().counterexample)
    process = int(failure.message.split("OSError: ")[1].split()[0])
    assert alive(process)
    del target, study
    assert gone(process)


class Babbling(Program):
    """Writes no message of the protocol, and is at some line when it is read."""

    def __call__(self, robot: Robot) -> NoReturn:
        del robot
        raise Misbehaved("malformed", "no message")

    def line(self) -> str:
        return "mine.py, line 3"


def test_no_line_is_told_of_a_mapper_that_no_time_limit_stopped() -> None:
    target = Target("babbling", Babbling([sys.executable]))
    assert explore(World.from_id("m1/0"), target).stopped == "no message"
