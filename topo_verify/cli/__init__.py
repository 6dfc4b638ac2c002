"""The command line: one file a command; arguments, progress, printing and exit codes.

runs.py       worlds as the user names them; judged runs, findings and walks as shown
options.py    options that commands share, and the stores that they name
output.py     results on stdout and in files
failures.py   exit codes, and the sentences that go with them
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from typing import Any, NoReturn, TextIO

import click
from click.shell_completion import shell_complete

from topo_verify.cli.failures import ExitCode, epilog, explain, say, silence, version
from topo_verify.programs.isolation import own_arguments

__all__ = ["main"]

_COMPLETE = "_TOPO_VERIFY_COMPLETE"


SHORT_HELPS = {
    "verify": "Check the catalogue, or a mapper of your own, in one report.",
    "explore": "Run algorithms in given worlds: costs and verdicts.",
    "world": "Show, list, convert, count, sample and draw worlds.",
    "search": "Find the smallest counterexample among all worlds of up to N edges.",
    "prove": "Prove the theorems behind the claims: Z3 and Coq.",
    "faults": "Show which check finds which mistake, in faulty mappers.",
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
"""The commands, most important first, with their lines in --help."""


class Commands(Mapping[str, click.Command]):
    """The commands by name; a module is imported when its command is called."""

    def __getitem__(self, name: str) -> click.Command:
        short_help = SHORT_HELPS[name]
        command: click.Command = getattr(import_module(f"topo_verify.cli.{name}"), name)
        command.short_help = short_help
        return command

    def __iter__(self) -> Iterator[str]:
        return iter(SHORT_HELPS)

    def __len__(self) -> int:
        return len(SHORT_HELPS)


class CommandLine(click.Group):
    """The group of all commands.

    Unlike click's own `main`, it exits 1 only if a claim fails, not on an interrupt or a closed
    pipe.
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
        """The command; if a TARGET stands in its place, the error names `verify`."""
        if args[0] not in self.commands and (":" in args[0] or args[0].endswith(".py")):
            ctx.fail(f"no such command {args[0]!r}, did you mean verify {args[0]}")
        return super().resolve_command(ctx, args)

    def main(  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]  it always exits
        self, args: Sequence[str] | None = None, prog_name: str | None = None, **extra: Any
    ) -> NoReturn:
        """Run the command line and exit."""
        name = prog_name or "topo-verify"
        if args is None:
            own_arguments()  # hide them from mappers in other processes
            # As Ctrl-C: finished work is kept and printed; exit code 3.
            signal.signal(signal.SIGTERM, signal.default_int_handler)
        if instruction := os.environ.get(_COMPLETE):
            sys.exit(shell_complete(self, extra, name, _COMPLETE, instruction))
        sys.exit(self._code(list(sys.argv[1:] if args is None else args), name, extra))

    def _code(self, arguments: list[str], name: str, extra: dict[str, Any]) -> int:
        try:
            # A copy: click empties the list, which reports still need.
            with self.make_context(name, arguments.copy(), obj=arguments, **extra) as context:
                code = self.invoke(context)
        except click.exceptions.Exit as done:
            code = done.exit_code
        except (click.Abort, KeyboardInterrupt):
            say("topo-verify: interrupted before the first result")
            code = ExitCode.INCOMPLETE
        except BrokenPipeError:  # --help was cut off
            silence(sys.stdout)
            code = ExitCode.NOTHING_FOUND
        except Exception as error:  # noqa: BLE001  all are reported
            code = explain(error, arguments)
        return _flushed(int(code))


def _flushed(code: int) -> int:
    out: TextIO | None = sys.stdout  # it is None after >&-
    try:
        if out is not None:
            out.flush()
    except BrokenPipeError:
        silence(out)
    except OSError as error:
        silence(out)
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
