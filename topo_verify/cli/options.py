"""Options that several commands share."""

from __future__ import annotations

import logging
import math
import sys
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import (
    AbstractContextManager,
    contextmanager,
    nullcontext,
    redirect_stdout,
)
from copy import copy
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from topo_verify.campaign.backend import MapperCampaign
from topo_verify.campaign.campaign import close
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import policies_of
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import one_target, start, target_text, targets
from topo_verify.checkers.claims import LARGE
from topo_verify.cli import epilog
from topo_verify.cli.output import Output
from topo_verify.errors import InputError, plural, shown
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loaded import watch
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Policies
from topo_verify.robot.limits import MOST_SECONDS, Limits


class OnceCommand(click.Command):
    """A command that refuses a single-valued option given twice; click takes the last value."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Check the arguments, then parse them."""
        if not ctx.resilient_parsing:  # a shell that completes a line
            self._require_once(ctx, args)
        return super().parse_args(ctx, args)

    def _require_once(self, ctx: click.Context, args: Sequence[str]) -> None:
        options = [
            parameter for parameter in self.get_params(ctx) if isinstance(parameter, click.Option)
        ]
        parser = self.make_parser(ctx)
        for option in options:
            collecting = copy(option)
            collecting.multiple = True  # the parser keeps every value
            collecting.add_to_parser(parser, ctx)
        given, _, _ = parser.parse_args(list(args))  # click empties the list
        if any(option.is_eager and option.name in given for option in options):
            return  # --help is always answered
        for option in options:
            values = given.get(option.name, ())
            if len(values) > 1 and not option.multiple:
                name, times = "/".join(option.opts), len(values)
                got = "it twice" if times == 2 else f"it {times} times"
                if not option.is_flag:
                    *rest, last = (repr(shown(value, limit=80)) for value in values)
                    got = f"{', '.join(rest)} and {last}"
                leave = "leave one out" if times == 2 else "leave out all but one"
                ctx.fail(f"expected {name} at most once, got {got}: {leave}")


def command(
    *examples: str, reports: bool = False, group: click.Group | None = None, name: str | None = None
) -> Callable[[Callable[..., int]], click.Command]:
    """Make a command that gets an `Output`, and whose --help ends with examples.

    `reports` adds --report, --junit and --badge.
    """
    make = click.command if group is None else group.command

    def decorate(run: Callable[..., int]) -> click.Command:
        @wraps(run)
        def wrapper(
            style: str,
            quiet: bool,  # noqa: FBT001  click passes it by name
            report: str | None = None,
            junit: str | None = None,
            badge: str | None = None,
            **kwargs: Any,
        ) -> int:
            output = Output(style, quiet=quiet)
            with redirect_stdout(sys.stderr), _remarks(output):  # what a mapper prints
                output.ask(report=report, junit=junit, badge=badge)
                return run(output, **kwargs)

        command = make(name, cls=OnceCommand, epilog=epilog(*examples))(wrapper)
        command.params += OUTPUT_OPTIONS + (REPORT_OPTIONS if reports else [])
        return command

    return decorate


@contextmanager
def _remarks(output: Output) -> Generator[None]:
    """Print what readers of files log as notes, each sentence once."""
    said: set[str] = set()

    class Notes(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            sentence = record.getMessage()
            if sentence not in said:  # a file may be read twice
                said.add(sentence)
                output.note(sentence)

    logger, notes = logging.getLogger("topo_verify"), Notes()
    logger.addHandler(notes)
    logger.setLevel(logging.INFO)
    try:
        yield
    finally:
        logger.setLevel(logging.NOTSET)
        logger.removeHandler(notes)


OUTPUT_OPTIONS: list[click.Parameter] = [
    click.Option(
        ["--format", "style"],
        type=click.Choice(["pretty", "json", "markdown"]),
        default="pretty",
        show_default=True,
        help="How results are printed.",
    ),
    click.Option(["--quiet"], is_flag=True, help="No progress, no warnings."),
]

REPORT_OPTIONS: list[click.Parameter] = [
    click.Option(["--report"], metavar="FILE.html", help="Write one self-contained page."),
    click.Option(
        ["--junit"], metavar="FILE.xml", help="Write a JUnit file, a case a judged thing."
    ),
    click.Option(["--badge"], metavar="FILE.svg", help="Write a badge: verdict, and of how much."),
]


def _seconds(_context: click.Context, _option: click.Parameter, value: str) -> float:
    try:
        seconds = float(value)
    except ValueError:
        seconds = math.nan  # fails the comparison below, as "nan" does
    if not 0 < seconds <= MOST_SECONDS:
        raise click.BadParameter(f"expected seconds in (0, {MOST_SECONDS}], got {value!r}")
    return seconds


def number(
    *names: str,
    meaning: str,
    least: int = 0,
    most: int | None = None,
    metavar: str = "N",
    default: int | None = None,
    shows_default: bool = True,
    required: bool = False,
) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Add an integer option."""
    # Click takes an explicit default of None for a value.
    given: dict[str, Any] = {} if default is None else {"default": default}
    integer = click.IntRange(least, most)
    # in "'x' is not a valid …"
    integer.name = f"integer {metavar}: {meaning.partition('.')[0]}"
    return click.option(
        *names,
        type=integer,
        metavar=metavar,
        show_default=shows_default and bool(given),
        required=required,
        help=meaning,
        **given,
    )


def seed(meaning: str, default: int = 0) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Add --seed with this help text."""
    return number("--seed", meaning=meaning, default=default)


def limits(command: Callable[..., int]) -> Callable[..., int]:
    """Add the limits of a run; the command gets them as `limits`."""
    usual = Limits()

    @number(
        "--budget",
        meaning="Most moves in one world.  [default: the bound of claim cost-within-bound]",
    )
    @click.option(
        "--move-timeout",
        callback=_seconds,
        default=f"{usual.move_timeout:g}",
        show_default=True,
        metavar="SECONDS",
        help="Longest time between two moves.",
    )
    @click.option(
        "--world-timeout",
        callback=_seconds,
        default=f"{usual.world_timeout:g}",
        show_default=True,
        metavar="SECONDS",
        help="Longest time in one world.",
    )
    @wraps(command)
    def wrapper(
        *args: Any, budget: int | None, move_timeout: float, world_timeout: float, **kwargs: Any
    ) -> int:
        return command(*args, limits=Limits(budget, move_timeout, world_timeout), **kwargs)

    return wrapper


def policies(command: Callable[..., int]) -> Callable[..., int]:
    """Add the policies of catalogue algorithms; the command gets `pick` and `order`."""
    pick = click.option(
        "--pick",
        metavar="POLICY",
        help="Next edge: nearest, last, first, random(SEED).  [default: nearest]",
    )
    order = click.option(
        "--order",
        metavar="POLICY",
        help="Next hypothesis: shortest, oldest, newest, random(SEED).  [default: shortest]",
    )
    return pick(order(command))


marker = click.option(
    "--marker", type=int, metavar="DART", help="Let the marker point at this DART instead."
)


player = click.option(
    "--player", metavar="FILE", help="Write a page that shows the run in a browser, step by step."
)


MAX_EDGES = 1000
"""Most edges of a world that is counted or drawn at random: more take minutes."""


def _joined(_context: click.Context, _option: click.Parameter, values: tuple[str, ...]) -> str:
    return ",".join(values)


world_class = click.option(
    "--class",
    "kind",
    multiple=True,
    default=["any"],
    show_default=True,
    callback=_joined,
    metavar="CLASS",
    help="any, planar, genus:G, genus<=G, simple, loopless, min-degree:D, max-degree:D, regular:D;"
    " several with commas.",
)


def make_folder(name: str, option: str) -> Path:
    """The folder that an option names, made if missing."""
    try:
        Path(name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{option} {name}: cannot create this folder: {error.strerror}") from error
    return Path(name)


in_process = click.option(
    "--in-process",
    is_flag=True,
    help="Run your own mapper in this process: faster, but it could see its judge.",
)


@dataclass(frozen=True)
class Mappers:
    """The TARGETs of a command line, and how they run."""

    texts: tuple[str, ...]
    in_process: bool
    pick: str | None = None
    order: str | None = None

    def load(self, *, at_once: bool = True) -> tuple[Target, ...]:
        """All of these mappers; unless `at_once`, a single one starts in its first world."""
        found = tuple(
            target
            for text in self.texts
            for target in targets(
                text, pick=self.pick, order=self.order, in_process=self.in_process
            )
        )
        if at_once or len(found) > 1:
            start(found)
        return found

    def load_one(self, usual: Policies | None = None) -> Target:
        """The only mapper, with the `usual` policies unless others are given."""
        how: dict[str, Any] = {"pick": self.pick, "order": self.order}
        target = one_target(self.texts[0], in_process=self.in_process, **how)
        start((target,))
        if usual is None or policies_of(target) is None:
            return target
        return one_target(target, pick=self.pick or usual.pick, order=self.order or usual.order)

    @contextmanager
    def opened(self, usual: Policies | None = None) -> Generator[Target]:
        """The mapper of `load_one`; a program runs until the block ends."""
        target = self.load_one(usual)
        try:
            yield target
        finally:
            close((target,))


def given() -> list[str]:
    """The parameters of this command that stand on the command line."""
    context = click.get_current_context()
    return [
        parameter.opts[0]
        for parameter in context.command.params
        if context.get_parameter_source(parameter.name or "") is ParameterSource.COMMANDLINE
    ]


_ARGUMENT = click.argument("target", required=False, metavar="[TARGET]")

_PROGRAM = (
    click.option(
        "--cmd", metavar="'PROGRAM ARGS'", help="Run this program as the TARGET, without a shell."
    ),
    click.option(
        "--library",
        metavar="FILE[:SYMBOL]",
        help="Run this native mapper, or FILE.py:NAME compiled first.  [default SYMBOL: map_world]",
    ),
    in_process,
)


def mappers(
    default: str | None = None,
    *,
    required: bool = True,
    meaning: str = "",
    several: bool = False,
    with_policies: bool = False,
) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Add the options that name a mapper; the command gets `mappers`.

    Args:
        default: the TARGET if none is given.
        required: without a default, a TARGET must be given.
        meaning: the help of the option --target; empty: TARGET is an argument.
        several: --target may be repeated.
        with_policies: add --pick and --order.
    """
    option = click.option(
        "--target",
        multiple=several,
        metavar="TARGET",
        help=f"{meaning}  [default: {default}]",
    )

    def decorate(run: Callable[..., int]) -> Callable[..., int]:
        @wraps(run)
        def wrapper(
            *args: Any,
            target: str | tuple[str, ...] | None,
            cmd: str | None,
            library: str | None,
            in_process: bool,
            **kwargs: Any,
        ) -> int:
            texts = list(target) if isinstance(target, tuple) else []
            if isinstance(target, str):
                texts.append(target)
            if cmd is not None and library is not None:
                raise InputError(
                    f"expected one TARGET, got --cmd {cmd} and --library {library}; leave one out"
                )
            command = cmd if library is None else LIBRARY + library
            if required or texts or command is not None:
                texts[:1] = [target_text(texts[0] if texts else None, command, default)]
            names = ("pick", "order") if with_policies else ()  # else they are another mapper's
            how = {name: kwargs.pop(name) for name in names}
            return run(*args, mappers=Mappers(tuple(texts), in_process, **how), **kwargs)

        added = [option if meaning else _ARGUMENT, *_PROGRAM]
        command = policies(wrapper) if with_policies else wrapper
        for add in reversed(added):
            command = add(command)
        return command

    return decorate


titles = click.option(
    "--name",
    "titles",
    multiple=True,
    metavar="TARGET=NAME",
    help="The name of a TARGET, program or library in what is shown; may be repeated.",
)


def names_of(titles: Sequence[str], mappers: Sequence[str]) -> dict[str, str]:
    """The names that --name gives to mappers, by TARGET."""
    names: dict[str, str] = {}
    for title in titles:
        target, _, name = title.rpartition("=")
        found = [text for text in mappers if target in {text, text.partition(" ")[2]}]
        if not (found and name.strip()):
            raise InputError(
                f"--name {title}: expected TARGET=NAME with one of {', '.join(mappers)}, as in"
                " './mapper=Team A'"
            )
        names[found[0]] = name.strip()
    if len({names.get(text, text) for text in mappers}) < len(set(mappers)):
        raise InputError("--name: two mappers have one name: give each its own")
    return names


def workers(default: int | None = None) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Add --workers; None means one worker per processor."""
    usual = "one per processor" if default is None else default
    meaning = f"Number of worker processes; 0: only this one.  [default: {usual}]"
    return number("--workers", meaning=meaning, default=default, shows_default=False)


store = click.option(
    "--store", metavar="FILE", help="Keep finished runs in FILE and resume from it."
)


strict = click.option(
    "--strict", is_flag=True, help=f"Ask every claim in worlds over {LARGE} edges, too."
)


# ---------------------------------------------------------------- stores of runs

STORE = "runs.db"
"""The file in the folder of `--out` that keeps the runs."""


def open_store(folder: Path | None) -> AbstractContextManager[Store | None]:
    """The store in a folder; None without a folder."""
    return nullcontext() if folder is None else Store(folder / STORE)


def opened(path: str | None) -> AbstractContextManager[Store | None]:
    """The store in a file; None without a file."""
    if path is None:
        return nullcontext()
    watch()  # before a mapper is loaded
    return Store(path)


def stored_rows(
    output: Output, campaigns: Sequence[MapperCampaign], workers: int, store: Store | None
) -> Iterator[Row]:
    """The rows of all campaigns; missing ones are made and kept in the store."""
    total = sum(campaign.total for campaign in campaigns)
    if store is not None:
        stored = sum(campaign.stored for campaign in campaigns)
        output.timing["from_store"] = output.timing.get("from_store", 0) + stored
        if stored:
            output.note(f"{stored} of {plural(total, 'run')} are in {store.path}")
    try:
        for campaign in campaigns:
            yield from campaign.rows(workers, output.progress)
    except KeyboardInterrupt:
        if store is not None:
            stored = sum(campaign.stored for campaign in campaigns)
            output.note(
                f"{stored} of {plural(total, 'run')} are kept in {store.path}; the same command"
                " goes on"
            )
        raise
