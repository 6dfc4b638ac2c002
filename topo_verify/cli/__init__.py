"""The command line: one file a command; arguments, progress, printing and exit codes.

front.py      the process that the user starts, and its child
runs.py       worlds as the user names them; judged runs and walks as shown
options.py    options that commands share, and the stores that they name
output.py     results on stdout and in files
"""

from __future__ import annotations

import errno
import os
import platform
import shlex
import sys
import traceback
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from enum import IntEnum
from importlib import import_module
from pathlib import Path
from typing import IO, Any, NoReturn, TextIO

import click
from click.shell_completion import shell_complete

from topo_verify import extras
from topo_verify.cli import front
from topo_verify.errors import LINE, HelperLost, InputError, shown
from topo_verify.programs import interruption
from topo_verify.programs.isolation import own_arguments

__all__ = ["main"]

_COMPLETE = "_TOPO_VERIFY_COMPLETE"

# ---------------------------------------------------------------- exit codes and failures

TRACEBACK = "TOPO_VERIFY_TRACEBACK"
"""If this environment variable is 1, a bug is reported with its traceback."""


class ExitCode(IntEnum):
    """The exit codes of every command; nothing but a failing claim ever exits 1."""

    NOTHING_FOUND = 0
    CLAIM_FAILED = 1
    BAD_INPUT = 2
    INCOMPLETE = 3
    OUR_BUG = 70


def epilog(*examples: str) -> str:
    """The end of a --help: examples, then the exit codes."""
    # \b tells click to keep the line breaks.
    lines = "\n".join(f"  topo-verify {example}" for example in examples)
    return f"""\b
Examples:
{lines}

\b
Exit codes: 0 nothing found; 1 a claim fails; 2 bad usage or input;
  3 incomplete (time-out, Ctrl-C, memory); 70 a bug of topo-verify."""


def version() -> str:
    """The version of the package; importing importlib.metadata takes as long as all of --help."""
    return str(sys.modules["topo_verify"].__version__)


def say(sentence: str) -> None:
    """Print a sentence as one line on stderr, control characters escaped."""
    line = shown(sentence, limit=LINE)
    try:
        # A file's name may hold bytes that are not UTF-8.
        click.echo(line.encode(errors="backslashreplace").decode(), err=True)
        sys.stderr.flush()
    except (OSError, ValueError):  # a full disk, a closed stream
        silence(sys.stderr)


def silence(stream: IO[str] | None) -> None:
    """Point a stream at the null device, so that Python's flush at exit cannot fail."""
    if stream is not None:
        with suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def explain(error: Exception, arguments: Sequence[str]) -> ExitCode:
    """Print on stderr why a command ended and how to mend it; return the exit code."""
    if isinstance(error, InputError | HelperLost):
        say(f"topo-verify: {error}")
        return ExitCode.BAD_INPUT if isinstance(error, InputError) else ExitCode.INCOMPLETE
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        click.echo(error.message, err=True)
        return ExitCode.BAD_INPUT
    if isinstance(error, click.ClickException):
        say(_usage(error))
        return ExitCode.BAD_INPUT
    if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
        say(
            "topo-verify: out of memory before the end: give it more (ulimit -v), a smaller input"
            " or fewer --workers"
        )
        return ExitCode.INCOMPLETE
    if (refusal := _refusal_by_the_system(error)) is not None:
        say(f"topo-verify: {refusal}")
        return ExitCode.BAD_INPUT
    return _unexpected(error, arguments)


def _refusal_by_the_system(error: Exception) -> str | None:
    if isinstance(error, FileNotFoundError) and not _has_working_folder():
        return "the working folder was removed: change to another folder"
    full = getattr(error, "errno", None) in (errno.ENOSPC, errno.EROFS, errno.EDQUOT)
    if full or (isinstance(error, OSError) and "temporary directory" in str(error)):
        return f"the system refuses: {error}; is the disk full, or TMPDIR no folder?"
    return None


def _has_working_folder() -> bool:
    try:
        return bool(Path.cwd())
    except FileNotFoundError:
        return False


FORMER = {
    "faults": "in a checkout of the project, type `python -m tests.faults.table`",
    "explore --marker all --svg": (
        "in a checkout of the project, type `python -m research.heat -o FILE`"
    ),
    "arena --game": "in a checkout of the project, type `python -m research.game M`",
    "--algorithm": "type --target",
    "--target": "TARGET is an argument here: type it without --target",
}
"""Options that version 0.4 dropped, of one command or of all, each with what to type now."""


def former(spelling: str) -> str:
    """What to type in place of a former command, or option of a command; "" for any other."""
    if spelling not in FORMER:
        return ""
    name = spelling.partition(" ")[2] or spelling
    return f"{name} went with version 0.4: {FORMER[spelling]}"


def _usage(error: click.ClickException) -> str:
    context = error.ctx if isinstance(error, click.UsageError) else None
    path = context.command_path if context else "topo-verify"
    option = getattr(error, "option_name", "")
    command = path.removeprefix("topo-verify ")
    if gone := former(f"{command} {option}") or former(option):
        return f"{path}: {gone}"
    # Click ends with a full stop or a question; here the sentence continues.
    objection = " ".join(error.format_message().split()).removesuffix(".")
    objection = objection.replace("'. Did you", "', did you").removesuffix("?")
    return f"{path}: {objection[:1].lower()}{objection[1:]}; {path} --help shows the usage"


def _unexpected(error: Exception, arguments: Sequence[str]) -> ExitCode:
    if os.environ.get(TRACEBACK) == "1":
        click.echo("".join(traceback.format_exception(error)), err=True, nl=False)
    if "--in-process" in arguments:
        say(
            f"topo-verify: {type(error).__name__}: {error}; the mapper may have damaged this"
            " process (its limits, files or modules), so nothing is decided: leave --in-process out"
        )
        return ExitCode.INCOMPLETE
    last = traceback.extract_tb(error.__traceback__)[-1:]
    file = "".join(frame.filename.replace(os.sep, "/") for frame in last)
    # Paths are cut at the package: a report must not reveal the user's folders.
    ours = "topo_verify" + file.rpartition("topo_verify")[2]
    place = "".join(f" ({ours if 'topo_verify' in file else file}:{f.lineno})" for f in last)
    command = shlex.join(["topo-verify", *arguments])
    say(
        f"topo-verify: a bug of topo-verify, not of your input: {type(error).__name__}: {error}"
        f"{place}; please report it with this line, the command line {command!r} and the versions"
        f" topo-verify {version()}, Python {platform.python_version()}, {sys.platform}"
        f" ({TRACEBACK}=1 adds the traceback)"
    )
    return ExitCode.OUR_BUG


# ---------------------------------------------------------------- the commands

SHORT_HELPS = {
    "verify": "Check the catalogue, or a mapper of your own, in one report.",
    "explore": "Run algorithms in given worlds: costs and verdicts.",
    "world": "Show, list, convert, count, sample and draw worlds.",
    "search": "Find the smallest counterexample among all worlds of up to N edges.",
    "prove": "Prove the theorems behind the claims: Z3 and Coq.",
    "conform": "Compare an implementation, in any language, with the reference.",
    "record": "Write a mapper's costs and decisions to a file, for compare.",
    "compare": "Show what has changed since a baseline was recorded.",
    "replay": "Show a counterexample again, or judge a trace again.",
    "play": "Show runs in a browser, step by step, two side by side.",
    "certify": "Judge a log with no world: is its map proved?",
    "tour": "Print the cheapest walk that proves the map of a known world.",
    "arena": "Rank mappers by cost, only sound ones.",
    "header": "Print the C interface of native mappers, topo_verify.h.",
    "reproduce": "The paper's figures, side by side with its numbers.",
}
"""The commands, those of extras among them, most important first, with their lines in --help."""


class Commands(Mapping[str, click.Command]):
    """The commands by name; a module is imported when its command is called."""

    def __getitem__(self, name: str) -> click.Command:
        short_help = SHORT_HELPS[name]
        command: click.Command = (
            extras.command(name)
            if name in extras.COMMANDS
            else getattr(import_module(f"topo_verify.cli.{name}"), name)
        )
        command.short_help = short_help
        return command

    def __iter__(self) -> Iterator[str]:
        return iter(SHORT_HELPS)

    def __len__(self) -> int:
        return len(SHORT_HELPS)


class CommandLine(click.Group):
    """The group of all commands.

    Unlike click's `main`, it does not exit 1 on an interrupt or a closed pipe.
    """

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  click's signature
        """The names of the commands."""
        return list(self.commands)

    def format_commands(
        self,
        ctx: click.Context,  # noqa: ARG002  click's signature
        formatter: click.HelpFormatter,
    ) -> None:
        """Write the commands into --help without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(SHORT_HELPS.items()))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command; the error for a TARGET in its place or a former command names the mend."""
        if gone := former(args[0]):
            raise InputError(gone)
        if args[0] not in self.commands and (":" in args[0] or args[0].endswith(".py")):
            ctx.fail(f"no such command {args[0]!r}, did you mean verify {args[0]}")
        return super().resolve_command(ctx, args)

    def main(  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]  it always exits
        self, args: Sequence[str] | None = None, prog_name: str | None = None, **extra: Any
    ) -> NoReturn:
        """Run the command line and exit."""
        name = prog_name or "topo-verify"
        if instruction := os.environ.get(_COMPLETE):
            sys.exit(shell_complete(self, extra, name, _COMPLETE, instruction))
        if args is not None:
            sys.exit(self._code(list(args), name, extra))
        _open_closed_streams()
        own_arguments()  # hide them from mappers in other processes
        sys.exit(front.run(lambda: self._code(sys.argv[1:], name, extra), say))

    def _code(self, arguments: list[str], name: str, extra: dict[str, Any]) -> int:
        try:
            _require_stdout()
            # A copy: click empties the list, which reports still need.
            with self.make_context(name, arguments.copy(), obj=arguments, **extra) as context:
                code = self.invoke(context)
            interruption.end()
        except click.exceptions.Exit as done:
            code = done.exit_code
        except (click.Abort, KeyboardInterrupt):
            code = _interrupted()
        except BrokenPipeError:  # --help was cut off
            silence(sys.stdout)
            code = ExitCode.NOTHING_FOUND
        except Exception as error:  # noqa: BLE001  all are reported
            interruption.end()
            # A signal may have become another exception on its way.
            code = _interrupted() if interruption.is_noted() else explain(error, arguments)
        return _flushed(int(code))


def _require_stdout() -> None:
    out: TextIO | None = sys.stdout  # it is None after >&-
    if out is None:
        raise InputError("standard output is closed: open it, or send it to a file")


def _interrupted() -> ExitCode:
    interruption.end()
    say("topo-verify: interrupted before the first result")
    return ExitCode.INCOMPLETE


def _open_closed_streams() -> None:
    """Put the null device in the place of a closed stream, before another file takes its number."""
    for place in range(3):
        try:
            os.fstat(place)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    if sys.stderr is None:
        sys.stderr = os.fdopen(2, "w", encoding="utf-8")


def _flushed(code: int) -> int:
    interruption.end()
    try:
        if code != ExitCode.BAD_INPUT:
            sys.stdout.flush()
    except BrokenPipeError:
        silence(sys.stdout)
    except OSError as error:
        silence(sys.stdout)
        say(f"topo-verify: cannot write to standard output: {error.strerror}")
        return ExitCode.BAD_INPUT
    return code


@click.group(
    "topo-verify",
    cls=CommandLine,
    context_settings={"help_option_names": ["-h", "--help"]},
    commands=Commands(),
    epilog=epilog("verify", "verify my_mapper.py:explore", "explore nyc"),
)
@click.version_option(version(), message="%(prog)s %(version)s")
def main() -> None:
    """Check algorithms by which a robot with one marker maps an unknown graph.

    The mapper is not trusted: it runs in a world, and every claim about it is judged on its trace.
    """
