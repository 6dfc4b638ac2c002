"""Runs a command, prints its results on stdout, and derives its exit code.

A command is a generator of `Result`s. `Output.run` keeps what it yielded before Ctrl-C or a
broken pipe, and prints one of three forms: `pretty` for people, `json` (docs/semantics.md,
section 16), `markdown`. What a mapper prints goes to stderr. Files of --report, --junit and
--badge are checked before the work begins, and written at the end, each whole or not at all.
"""

from __future__ import annotations

import json
import os
import platform
import shlex
import sys
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import cached_property
from importlib import metadata
from pathlib import Path
from threading import Lock, Timer
from time import perf_counter
from typing import IO, TYPE_CHECKING, Any, Generic, TypeVar

import click
import msgspec

from topo_verify.checkers.findings import Verdict
from topo_verify.cli import ExitCode, say, silence, version
from topo_verify.cli.runs import FoundRuns
from topo_verify.errors import InputError, plural, shown
from topo_verify.report import account as acc
from topo_verify.report.badge import badge
from topo_verify.report.blocks import Block, Cell, Raw, Text, TextTable
from topo_verify.report.junit import junit
from topo_verify.report.markdown import markdown
from topo_verify.report.page import report_page
from topo_verify.report.terminal import pretty
from topo_verify.world.formats import files

if TYPE_CHECKING:
    from rich.progress import Progress as Bar


E = TypeVar("E", bound=msgspec.Struct)
T = TypeVar("T")

VERSION = 1


@dataclass(frozen=True)
class Result(Generic[E]):
    """One entry of `results` and its effect on the exit code.

    Attributes:
        failed: a claim fails in it.
        incomplete: part of what was asked for was not done.
    """

    entry: E
    failed: bool = False
    incomplete: bool = False


@dataclass
class _Done(Generic[E]):
    results: list[Result[E]] = field(default_factory=list[Result[E]])
    seconds: list[float] = field(default_factory=list[float])
    finished: bool = False

    @property
    def entries(self) -> list[E]:
        return [result.entry for result in self.results]

    @property
    def code(self) -> ExitCode:
        if any(result.failed for result in self.results):
            return ExitCode.CLAIM_FAILED
        complete = self.finished and not any(result.incomplete for result in self.results)
        return ExitCode.NOTHING_FOUND if complete else ExitCode.INCOMPLETE


@dataclass(frozen=True)
class Live(Generic[E]):
    """How entries are printed one by one: a head, each entry, an end."""

    head: Iterable[Block]
    each: Callable[[E], Iterable[Block]]
    end: Callable[[Sequence[E]], Iterable[Block]]


def entry_of(kind: type[E], *sources: object, **more: object) -> E:
    """An entry with each field from `more`, else from the first source with that attribute."""
    fields = dict(more)
    for name in kind.__struct_fields__:
        for source in () if name in more else sources:
            if (value := getattr(source, name, fields)) is not fields:
                fields[name] = value
                break
    return msgspec.convert(fields, kind, from_attributes=True)


class Rows(Generic[T]):
    """Things that become the rows of a table."""

    def __init__(self, things: Iterable[T]) -> None:
        self._things = tuple(things)

    def table(
        self, *columns: tuple[str, Callable[[T], object]], title: str = "", headed: bool = True
    ) -> TextTable:
        """The table of these columns: a title, and a function that makes a cell."""
        rows = [tuple(_cell(value(thing)) for _, value in columns) for thing in self._things]
        return TextTable(tuple(name for name, _ in columns), rows, title, headed=headed)


def _cell(value: object) -> str | Cell:
    return "-" if value is None else value if isinstance(value, Cell) else str(value)


def written(text: str | None, **row: str | None) -> Block:
    """The text for stdout; without one, a table that names the file."""
    return TextTable(tuple(row), [tuple(map(str, row.values()))]) if text is None else Raw(text)


class _ReaderGone(Exception):
    pass


class Output:
    """How one command prints.

    Attributes:
        timing: figures that differ from run to run, for `timing` in the JSON.
    """

    def __init__(self, style: str, *, quiet: bool) -> None:
        self.timing: dict[str, Any] = {}
        self.style, self.quiet = style, quiet
        self.stdout: IO[str] = sys.stdout or _nowhere()
        self.progress = ProgressBar(quiet=quiet)
        self._files: list[tuple[str, str]] = []

    def ask(self, **files: str | None) -> None:
        """Have files written at the end, each keyed by its option of `FORMS`."""
        named = [(f"--{option}", name) for option, name in files.items() if name is not None]
        _require_files(named)
        self._files += named

    @property
    def exhibits(self) -> bool:
        """Whether a page is requested, which shows counterexamples."""
        return any(option == "--report" for option, _ in self._files)

    @cached_property
    def found(self) -> FoundRuns:
        """The counterexamples that the command finds."""
        return FoundRuns(people=self.style != "json", page=self.exhibits)

    def note(self, sentence: str) -> None:
        """Print a warning or a remark on stderr, unless --quiet."""
        if not self.quiet:
            self.progress.clear()
            say(f"topo-verify: {sentence}")

    def run(
        self,
        command: str,
        results: Callable[[], Iterator[Result[E]]],
        show: Callable[[Sequence[E]], Iterable[Block]],
        *,
        live: Live[E] | None = None,
        account: Callable[[Sequence[E]], acc.Account] | None = None,
        walk: bool = True,
        extent: Callable[[Sequence[E]], str] | None = None,
        **more: Any,
    ) -> int:
        """Run the command, print its results and return the exit code.

        Args:
            live: prints entries one by one in `pretty` form, in place of `show`.
            account: sums up the entries for --report, --junit and --badge.
            walk: show the walk of the first counterexample.
            extent: how much was done before Ctrl-C; default: the number of results.
            more: further fields of the JSON envelope.
        """
        done: _Done[E] = _Done()
        # JSON and Markdown are one document each.
        live = live if self.style == "pretty" else None

        def accounted(account: Callable[[Sequence[E]], acc.Account]) -> acc.Account:
            """The account with the verdict of the exit code."""
            summary = account(done.entries)
            words = summary.extent.words + ("" if done.finished else ", interrupted")
            return replace(
                summary,
                about=summary.about or command,  # no entry names a mapper
                extent=acc.JudgedExtent(_VERDICTS.get(done.code, summary.extent.verdict), words),
                blocks=summary.blocks or tuple(show(done.entries)),
                exhibits=self.found.exhibits,
                left_out=self.found.left_out,
            )

        def last() -> Iterator[Block]:
            if account is not None and self.style == "markdown":
                summary = accounted(account)
                yield Text(f"{summary.extent.verdict}: {summary.about}, {summary.extent.words}")
            yield from (live.end if live else show)(done.entries)
            yield from self.found.blocks() if walk else ()
            if more.get("in_process"):
                yield Text("")
                yield Text("In process: a mapper of your own could see what judges it.")

        begin = perf_counter()
        try:
            if live is not None:
                self._pretty(live.head)
            self._collect(done, results(), live)
            self._print(command, done, last(), perf_counter() - begin, more)
            if not done.finished:
                words = extent(done.entries) if extent else plural(len(done.results), "result")
                say(f"topo-verify: interrupted after {words}")
        except _ReaderGone:
            pass  # files are still written
        if account is not None and self._files:
            ending = acc.Ending(
                command=command,
                again=command_line(click.get_current_context().obj or ()),
                code=int(done.code),
                finished=done.finished,
                date=datetime.now(UTC),
                seconds=perf_counter() - begin,
                by_suite=done.seconds,
                timing=self.timing,
                versions=versions(),
            )
            summary = accounted(account)
            for option, name in self._files:
                files.write(name, FORMS[option](summary, ending))
        return done.code

    def _collect(self, done: _Done[E], results: Iterator[Result[E]], live: Live[E] | None) -> None:
        begin = perf_counter()
        try:
            for result in results:
                done.results.append(result)
                done.seconds.append(perf_counter() - begin)
                if live is not None:
                    self.progress.clear()
                    self._pretty(live.each(result.entry))
                begin = perf_counter()
            done.finished = True
        except KeyboardInterrupt:
            pass
        finally:
            self.progress.clear()

    def _print(
        self,
        command: str,
        done: _Done[E],
        blocks: Iterable[Block],
        seconds: float,
        more: dict[str, Any],
    ) -> None:
        if self.style == "pretty":
            self._pretty(blocks)
            return
        with _reader(self.stdout, "utf-8") as out:
            if self.style == "json":
                envelope = {
                    "format": f"topo-verify/{command}",
                    "version": VERSION,
                    "tool": version(),
                    "ok": done.code == 0,
                    "exit": int(done.code),
                    **more,
                    "results": msgspec.to_builtins(done.entries),
                    "timing": {"seconds": seconds, "results": done.seconds, **self.timing},
                }
                out.write(json.dumps(envelope) + "\n")
            else:
                out.write(markdown(blocks))

    def _pretty(self, blocks: Iterable[Block]) -> None:
        blocks = tuple(blocks)
        is_data = any(isinstance(block, Raw) for block in blocks)
        with _reader(self.stdout, "utf-8" if is_data else None) as out:
            pretty(blocks, out)


@contextmanager
def _reader(out: IO[str], encoding: str | None = None) -> Generator[IO[str]]:
    """Standard output, in this encoding; by default in the locale's."""
    if (reconfigure := getattr(out, "reconfigure", None)) is not None:
        # for an encoding without one of our letters
        reconfigure(encoding=encoding, errors="backslashreplace")
    try:
        yield out
        out.flush()  # at Python's exit a failure could not be reported
    except BrokenPipeError:
        silence(out)
        raise _ReaderGone from None
    except OSError as error:
        silence(out)
        raise InputError(f"cannot write to standard output: {error.strerror}") from error


_VERDICTS: dict[ExitCode, Verdict] = {
    ExitCode.CLAIM_FAILED: "REFUTED",
    ExitCode.INCOMPLETE: "UNKNOWN",
}


def _nowhere() -> IO[str]:
    return Path(os.devnull).open("w", encoding="utf-8")


DELAY = 1.0
"""Seconds of work before the bar appears."""


class ProgressBar:
    """A bar that appears when work takes long and leaves no trace on the terminal.

    Call it as a progress callback; `clear` it before anything is printed.
    """

    def __init__(self, *, quiet: bool) -> None:
        self._wanted = not quiet and sys.stderr is not None and sys.stderr.isatty()
        self._state = ("", 0, 0)
        self._lock = Lock()
        self._timer: Timer | None = None
        self._bar: Bar | None = None

    def __call__(self, task: str, done: int, total: int) -> None:
        """Show the current task, the steps done and their total."""
        if not self._wanted:
            return
        self._state = (task, done, total)
        if self._timer is None:
            # A timer, because one long run may not call again for a while.
            self._timer = Timer(DELAY, self._appear)
            self._timer.daemon = True
            self._timer.start()
        with self._lock:
            self._show()

    def clear(self) -> None:
        """Remove the bar from the terminal."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer.join()  # it may be about to show the bar
            self._timer = None
        if self._bar is not None:
            self._bar.stop()
            self._bar = None

    def _appear(self) -> None:
        with self._lock:
            self._bar = _bar()
            self._bar.add_task("")
            self._show()
            self._bar.start()

    def _show(self) -> None:
        if self._bar is not None:
            task, done, total = self._state
            self._bar.update(self._bar.task_ids[0], description=task, completed=done, total=total)


def _bar() -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    return Bar(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
        redirect_stdout=False,
        redirect_stderr=False,
    )


# ---------------------------------------------------------------- --report, --junit, --badge

TAKE_PART = ("z3-solver", "hypothesis", "msgspec", "networkx", "numpy", "scipy")
"""Libraries on whose version a result may depend."""

_PRINTING = {"--report": 1, "--junit": 1, "--badge": 1, "--format": 1, "--quiet": 0}
"""Options that only change how results are shown, and the number of words after each."""


FORMS: dict[str, Callable[[acc.Account, acc.Ending], str]] = {
    "--report": report_page,
    "--junit": junit,
    "--badge": lambda account, _: badge(account),
}


def _require_files(named: Sequence[tuple[str, str]]) -> None:
    for option, name in named:
        if (objection := _objection(name)) is not None:
            raise InputError(f"{option} {shown(name)}: {objection}; name a file to be written")
    places = [os.path.realpath(name) for _, name in named]
    regular = [place for place in places if not Path(place).exists() or Path(place).is_file()]
    if len(set(regular)) < len(regular):
        options = " and ".join(option for option, _ in named)
        raise InputError(f"expected different files for {options}: one would overwrite the other")


def _objection(name: str) -> str | None:
    if name == "-":
        return "standard output is for the results"
    try:
        place = Path(os.path.realpath(name))
        if place.is_dir():
            return "this is a folder"
        if not place.parent.is_dir():
            return f"there is no folder {shown(place.parent)}"
        # A regular file is replaced, so the folder's permission decides.
        target = place if place.exists() and not place.is_file() else place.parent
        if not os.access(target, os.W_OK):
            return "no permission to write there"
    except (OSError, ValueError) as error:  # a null character
        return str(error)
    return None


def command_line(arguments: Sequence[str]) -> str:
    """The command line without the options of `_PRINTING`."""
    words, rest = ["topo-verify"], iter(arguments)
    for word in rest:
        option, equals, _ = word.partition("=")
        if option not in _PRINTING:
            words.append(word)
        elif not equals and _PRINTING[option]:
            next(rest, None)
    return shlex.join(words)


def versions() -> dict[str, str]:
    """The versions of the package, of Python and of `TAKE_PART`."""
    own = {"topo-verify": version(), platform.python_implementation(): platform.python_version()}
    return own | {name: metadata.version(name) for name in TAKE_PART}
