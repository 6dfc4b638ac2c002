"""Runs a command, prints its results on stdout, and derives its exit code.

A command is a generator of `Result`s. `Output.run` keeps what it yielded before Ctrl-C or a
broken pipe in an `Outcome`. Exit code, first line, JSON and files are functions of that: files of
--report, --junit and --badge are written first, each whole or not at all, then one of three forms
on stdout: `pretty` for people, `json` (docs/semantics.md, section 16), `markdown`. What a mapper
prints goes to stderr.
"""

from __future__ import annotations

import json
import os
import platform
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import cached_property
from importlib import metadata
from pathlib import Path
from threading import Lock, Timer
from time import perf_counter
from typing import TYPE_CHECKING, Any, Generic, TextIO, TypeVar

import click
import msgspec

from topo_verify.checkers.findings import Verdict
from topo_verify.cli import ExitCode, say, silence, version
from topo_verify.cli.runs import FoundRuns
from topo_verify.errors import HelperLost, InputError, WriteError, plural, shown
from topo_verify.programs import interruption
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
class Outcome(Generic[E]):
    """The results of a command, and what is missing; exit code and verdict are functions of it.

    Attributes:
        more: further fields of the JSON envelope.
        timing: figures that differ from run to run.
        finished: all that was asked for was tried.
        unwritten: why files, or standard output, could not be written, a sentence each.
    """

    command: str
    more: dict[str, Any]
    timing: dict[str, Any]
    begin: float = field(default_factory=perf_counter)
    results: list[Result[E]] = field(default_factory=list[Result[E]])
    seconds: list[float] = field(default_factory=list[float])
    finished: bool = False
    unwritten: list[str] = field(default_factory=list[str])

    @property
    def entries(self) -> list[E]:
        """The entries of the results."""
        return [result.entry for result in self.results]

    @property
    def code(self) -> ExitCode:
        """The exit code of the command."""
        if any(result.failed for result in self.results):
            return ExitCode.CLAIM_FAILED
        if self.unwritten:
            return ExitCode.BAD_INPUT
        complete = self.finished and not any(result.incomplete for result in self.results)
        return ExitCode.NOTHING_FOUND if complete else ExitCode.INCOMPLETE

    def extent(self, judged: acc.JudgedExtent) -> acc.JudgedExtent:
        """The extent of the results, with the verdict of the exit code."""
        words = judged.words + ("" if self.finished else ", interrupted")
        words += ", not written everywhere" if self.unwritten else ""
        return acc.JudgedExtent(_VERDICTS.get(self.code, judged.verdict), words)

    @property
    def json(self) -> str:
        """The object that --format json prints."""
        took = perf_counter() - self.begin
        envelope = {
            "format": f"topo-verify/{self.command}",
            "version": VERSION,
            "tool": version(),
            "ok": self.code == 0,
            "exit": int(self.code),
            **self.more,
            "results": msgspec.to_builtins(self.entries),
            "timing": {"seconds": took, "results": self.seconds, **self.timing},
        }
        return json.dumps(envelope) + "\n"

    @property
    def ending(self) -> acc.Ending:
        """What files say beside the account."""
        return acc.Ending(
            command=self.command,
            again=command_line(click.get_current_context().obj or ()),
            code=int(self.code),
            finished=self.finished,
            unwritten=tuple(self.unwritten),
            date=datetime.now(UTC),
            seconds=perf_counter() - self.begin,
            by_suite=self.seconds,
            timing=self.timing,
            versions=versions(),
        )


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
        self.stdout = sys.stdout
        self._stdout_file = _file_behind(self.stdout)
        self._is_read_no_more = False
        self._prints_data = style != "pretty"
        self.progress = ProgressBar(quiet=quiet)
        self._files: list[tuple[str, str]] = []

    def ask(self, **files: str | None) -> None:
        """Have files written at the end, each keyed by its option of `FORMS`."""
        self._files += _places(files)

    def require_places(self, **files: str | None) -> None:
        """Raise InputError if one of these files, keyed by its option, cannot be written."""
        _places(files)

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
        outcome: Outcome[E] = Outcome(command, more, self.timing)
        # JSON and Markdown are one document each.
        live = live if self.style == "pretty" else None

        def accounted(account: Callable[[Sequence[E]], acc.Account]) -> acc.Account:
            summary = account(outcome.entries)
            return replace(
                summary,
                about=summary.about or command,  # no entry names a mapper
                extent=outcome.extent(summary.extent),
                blocks=summary.blocks or tuple(show(outcome.entries)),
                exhibits=self.found.exhibits,
                left_out=self.found.left_out,
            )

        def last() -> Iterator[Block]:
            if account is not None and self.style == "markdown":
                summary = accounted(account)
                yield Text(f"{summary.extent.verdict}: {summary.about}, {summary.extent.words}")
            yield from (live.end if live else show)(outcome.entries)
            yield from self.found.blocks() if walk else ()
            if more.get("in_process"):
                yield Text("")
                yield Text("In process: a mapper of your own could see what judges it.")

        def pages() -> list[str]:
            if account is None or not self._files:
                return []
            summary, ending = accounted(account), outcome.ending
            return [FORMS[option](summary, ending) for option, _ in self._files]

        self._collect(outcome, results, live)
        interruption.end()
        self._write(
            outcome, pages, lambda: outcome.json if self.style == "json" else self._text(last())
        )
        for sentence in outcome.unwritten:
            say(f"topo-verify: {sentence}")
        if not (outcome.finished or self._is_read_no_more):
            words = extent(outcome.entries) if extent else plural(len(outcome.results), "result")
            say(f"topo-verify: interrupted after {words}")
        return outcome.code

    def _collect(
        self,
        outcome: Outcome[E],
        results: Callable[[], Iterator[Result[E]]],
        live: Live[E] | None,
    ) -> None:
        try:
            if live is not None:
                self._print(self._text(live.head))
            begin = perf_counter()
            for result in results():
                outcome.results.append(result)
                outcome.seconds.append(perf_counter() - begin)
                if live is not None:
                    self.progress.clear()
                    self._print(self._text(live.each(result.entry)))
                begin = perf_counter()
            interruption.check()
            outcome.finished = True
        except (KeyboardInterrupt, _ReaderGone):
            pass
        except WriteError as error:
            if not outcome.results:
                raise
            outcome.unwritten.append(str(error))
        except HelperLost as error:
            say(f"topo-verify: {error}")
        except Exception:
            if not interruption.is_noted():
                raise
        finally:
            self.progress.clear()

    def _write(
        self, outcome: Outcome[E], pages: Callable[[], list[str]], text: Callable[[], str]
    ) -> None:
        """Write the files, then standard output; all again if one fails, since that is exit 2.

        What a pipe has received cannot be taken back, so pipes come last.
        """
        self._files.sort(key=lambda file: Path(file[1]).is_fifo())
        while True:
            contents, printed = pages(), "" if self._is_read_no_more else text()
            for file, content in zip(tuple(self._files), contents, strict=bool(contents)):
                try:
                    files.write(file[1], content)
                except WriteError as error:
                    outcome.unwritten.append(str(error))
                    self._files.remove(file)
                    break
            else:
                try:
                    return self._print(printed)
                except _ReaderGone:
                    return None
                except WriteError as error:
                    outcome.unwritten.append(str(error))

    def _text(self, blocks: Iterable[Block]) -> str:
        blocks = tuple(blocks)
        self._prints_data |= any(isinstance(block, Raw) for block in blocks)
        return markdown(blocks) if self.style == "markdown" else pretty(blocks, self.stdout)

    def _print(self, text: str) -> None:
        """Write to standard output: data as UTF-8, text for people in the locale's encoding."""
        out = self.stdout
        if text and _file_behind(out) != self._stdout_file:
            self._is_read_no_more = True
            raise WriteError(
                "cannot write to standard output: a mapper with --in-process closed it"
            )
        if (reconfigure := getattr(out, "reconfigure", None)) is not None:
            # for an encoding without one of our letters
            encoding = "utf-8" if self._prints_data else None
            reconfigure(encoding=encoding, errors="backslashreplace")
        try:
            out.write(text)
            out.flush()  # at Python's exit a failure could not be reported
        except OSError as error:
            silence(out)
            self._is_read_no_more = True
            if isinstance(error, BrokenPipeError):
                raise _ReaderGone from None
            raise WriteError(f"cannot write to standard output: {error.strerror}") from error


def _file_behind(stream: TextIO) -> tuple[int, int] | None:
    """What tells a stream's file from others; None if it has none."""
    try:
        status = os.fstat(stream.fileno())
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino


_VERDICTS: dict[ExitCode, Verdict] = {
    ExitCode.CLAIM_FAILED: "REFUTED",
    ExitCode.BAD_INPUT: "UNKNOWN",  # not all could be written
    ExitCode.INCOMPLETE: "UNKNOWN",
}


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
        """Show the current task, the steps done and their total; KeyboardInterrupt if it is due."""
        interruption.check()
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


def _places(files: Mapping[str, str | None]) -> list[tuple[str, str]]:
    named = [(f"--{option}", name) for option, name in files.items() if name is not None]
    for option, name in named:
        if (objection := _objection(name)) is not None:
            raise InputError(f"{option} {shown(name)}: {objection}; name a file to be written")
    places = [os.path.realpath(name) for _, name in named]
    regular = [place for place in places if not Path(place).exists() or Path(place).is_file()]
    if len(set(regular)) < len(regular):
        options = " and ".join(option for option, _ in named)
        raise InputError(f"expected different files for {options}: one would overwrite the other")
    return named


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
