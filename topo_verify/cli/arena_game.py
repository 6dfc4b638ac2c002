"""`topo-verify arena --game M`: the best robot in all worlds with up to M edges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from topo_verify.cli import options
from topo_verify.cli.output import Output, Result, entry_of
from topo_verify.errors import InputError, InternalError
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.studies.game.values import (
    MOST_EDGES,
    PLAYERS,
    GameValue,
    MapperCosts,
    game_values,
    least_costs,
    mapper_costs,
)


class CostsOfRobot(msgspec.Struct, frozen=True):
    """What a robot pays in the worlds of a game.

    Attributes:
        worst, mean: over these worlds.
        worst_is_value, mean_is_value: false where the search was cut short: it is a lower bound.
    """

    worst: int
    mean: float
    worst_is_value: bool = True
    mean_is_value: bool = True


class ValueEntry(msgspec.Struct, frozen=True, kw_only=True, tag_field="of", tag="value"):
    """The value of a game: an entry of `results`.

    Attributes:
        game: the edges of each world.
        knows: what the robot is told: nothing, n, planar, m, m and n, m and planar.
        drawn: which of these worlds count: any, planar.
        worlds: how many that are.
        value: what the best robots pay, one for the worst case and one for the mean.
        least: the same with the map in hand: the least cost of a proof.
        states: how many states were searched.
    """

    game: int
    knows: str
    drawn: str
    worlds: int
    value: CostsOfRobot
    least: CostsOfRobot
    states: int


class MapperEntry(msgspec.Struct, frozen=True, kw_only=True, tag_field="of", tag="mapper"):
    """A mapper in a game: an entry of `results`.

    Attributes:
        game, knows, drawn, worlds: as of a value; `knows` is what the mapper assumes.
        mapper: a name of the catalogue.
        worst, mean: its costs; null if a claim fails.
        value: what the best robots pay that know as much; null where it was not searched.
        failing: the first world in which a claim fails, or null.
    """

    game: int
    mapper: str
    knows: str
    drawn: str
    worlds: int
    worst: int | None
    mean: float | None
    value: CostsOfRobot | None
    failing: str | None


GameEntry = ValueEntry | MapperEntry


ALLOWED = {"--game", "texts", "--target", "--format", "--quiet"}
"""The parameters of `arena` that mean something to `--game`."""


def game_of_catalogue(output: Output, edges: int, names: Sequence[str]) -> int:
    """Do what `arena --game M [TARGET]...` asks for; no name or `all`: the whole catalogue.

    Returns: the exit code: 1 if a claim fails, 3 if a search was cut short.
    Raises:
        InputError: there is no such game or mapper, or another option was given.
    """
    if others := [name for name in options.given() if name not in ALLOWED]:
        raise InputError(f"{others[0]} means nothing to --game: leave out one of them")
    asked = [name for text in names for name in text.split(",") if name != "all"]
    for name in asked:
        if name not in PLAYERS:
            known = ", ".join(PLAYERS)
            raise InputError(f"target {name!r}: --game plays mappers of the catalogue: {known}")
    return play_game(output, edges, asked or PLAYERS)


def play_game(output: Output, edges: int, mappers: Sequence[str] = PLAYERS) -> int:
    """Print the values of the games with 1 to `edges` edges, and how far the mappers are from them.

    Args:
        mappers: names of the catalogue.
    Returns: the exit code: 1 if a claim fails, 3 if a search was cut short.
    Raises:
        InputError: there is no such game.
    """
    if not 1 <= edges <= MOST_EDGES:
        raise InputError(
            f"--game {edges}: expected 1 to {MOST_EDGES} edges; with more, the search has no end"
        )
    return output.run("arena", lambda: _results(output, edges, mappers), _show, game=edges)


def _results(output: Output, edges: int, mappers: Sequence[str]) -> Iterator[Result[GameEntry]]:
    for m in range(1, edges + 1):
        found = dict[tuple[str, str], CostsOfRobot]()
        for value in game_values(m):
            output.progress(f"{m} edges, knowing {value.knows}", m - 1, edges)
            entry = _value_entry(value)
            found[value.knows, value.drawn] = entry.value
            yield Result(entry, incomplete=not (value.worst.is_value and value.total.is_value))
        for name in mappers:
            costs = mapper_costs(name, m)
            best = found.get((costs.knows, costs.drawn))
            yield Result(_mapper_entry(costs, best), failed=costs.failing is not None)


def _value_entry(value: GameValue) -> ValueEntry:
    least = least_costs(value.edges, value.drawn)
    worst, total = value.worst, value.total
    return entry_of(
        ValueEntry,
        value,
        game=value.edges,
        value=CostsOfRobot(worst.cost, value.mean, worst.is_value, total.is_value),
        least=CostsOfRobot(max(least), sum(least) / len(least)),
    )


def _mapper_entry(costs: MapperCosts, best: CostsOfRobot | None) -> MapperEntry:
    is_sound = costs.failing is None
    if is_sound and best and (costs.worst < best.worst or costs.mean < best.mean):
        raise InternalError(
            f"{costs.mapper} costs less than the value of the game with {costs.edges} edges, and"
            " every claim holds"
        )
    return entry_of(
        MapperEntry,
        costs,
        game=costs.edges,
        worst=costs.worst if is_sound else None,
        mean=costs.mean if is_sound else None,
        value=best,
    )


# ---------------------------------------------------------------- for people


def _show(entries: Sequence[GameEntry]) -> Iterator[Block]:
    values = [entry for entry in entries if isinstance(entry, ValueEntry)]
    yield _mapper_table([entry for entry in entries if isinstance(entry, MapperEntry)])
    yield Text("")
    yield _map_table([entry for entry in values if entry.knows == "nothing"])
    yield Text("")
    yield _knowledge_table(values)
    if not all(entry.value.worst_is_value and entry.value.mean_is_value for entry in values):
        yield Text("")
        yield Text("≥: the search was cut short; no robot pays less, perhaps none so little.")


def _mapper_table(entries: Sequence[MapperEntry]) -> TextTable:
    rows = [
        (
            str(entry.game),
            entry.mapper,
            entry.drawn,
            str(entry.worst) if entry.failing is None else f"fails in {entry.failing}",
            _worst(entry.value) if entry.value else "-",
            "-" if entry.mean is None else f"{entry.mean:.2f}",
            _mean(entry.value) if entry.value else "-",
            _more(entry.mean, entry.value),
        )
        for entry in entries
    ]
    return TextTable(
        (">m", "mapper", "worlds", ">worst", ">best", ">mean", ">best", ">dearer by"),
        rows,
        "Mappers and the best robot that knows as much",
    )


def _map_table(entries: Sequence[ValueEntry]) -> TextTable:
    rows = [
        (
            str(entry.game),
            f"{entry.worlds} {entry.drawn}",
            str(entry.least.worst),
            _worst(entry.value),
            f"{entry.least.mean:.2f}",
            _mean(entry.value),
            _more(entry.value.mean, entry.least, least=not entry.value.mean_is_value),
        )
        for entry in entries
    ]
    return TextTable(
        (
            ">m",
            "worlds",
            ">worst, map in hand",
            ">best",
            ">mean, map in hand",
            ">best",
            ">dearer by",
        ),
        rows,
        "What not knowing the map costs at best",
    )


def _knowledge_table(entries: Sequence[ValueEntry]) -> TextTable:
    base = {(entry.game, entry.drawn): entry for entry in entries if entry.knows == "nothing"}
    rows = [
        (
            str(entry.game),
            entry.drawn,
            entry.knows,
            _worst(entry.value),
            _mean(entry.value),
            _saved(entry.value, base[entry.game, entry.drawn].value),
        )
        for entry in entries
    ]
    return TextTable(
        (">m", "worlds", "knows", ">worst", ">mean", ">saves"),
        rows,
        "What the best robot pays, and what it saves to know more",
    )


def _worst(costs: CostsOfRobot) -> str:
    return f"{'' if costs.worst_is_value else '≥ '}{costs.worst}"


def _mean(costs: CostsOfRobot) -> str:
    return f"{'' if costs.mean_is_value else '≥ '}{costs.mean:.2f}"


def _more(mean: float | None, than: CostsOfRobot | None, *, least: bool = False) -> str:
    """Excess of one mean over another in percent, with ≥ or ≤ if either is only a bound."""
    if mean is None or than is None:
        return "-"
    sign = "≥ " if least else "" if than.mean_is_value else "≤ "
    return f"{sign}{100 * (mean / than.mean - 1):.1f} %"


def _saved(costs: CostsOfRobot, nothing: CostsOfRobot) -> str:
    """How far a mean is below that of the robot that is told nothing, in percent.

    Where the lower mean is itself only a bound, the difference is not even bounded: `-`.
    """
    if costs is nothing or not costs.mean_is_value:
        return "-"
    sign = "" if nothing.mean_is_value else "≥ "
    return f"{sign}{100 * (1 - costs.mean / nothing.mean):.1f} %"
